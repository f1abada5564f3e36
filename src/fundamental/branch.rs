//! Quadrature of the half-plane surface kernel against a polynomial in the speed of waves.
//!
//! The kernel is a sum of branches, each a square root times a rational function whose poles are
//! the roots of the Rayleigh polynomial. On each branch a variable s removes the square root, and
//! pieces are subdivided until the nearest singularity is far enough for a Gauss rule. Two poles may come
//! arbitrarily close to the path; they are subtracted and integrated in closed form. The Rayleigh root lies
//! on the path (principal value). For small Poisson's ratios, the root near the pressure wave lies next to
//! the path.
//!
//! | symbol | meaning |
//! |---|---|
//! | τ, u | `c_S` t/x, and the speed 1/τ = x/(`c_S` t) |
//! | z | τ² − a² |
//! | s | √(τ²−a²), √(τ²−1), √(1−τ²), or u in the tail |

use crate::fundamental::rayleigh::Rayleigh;
use crate::linalg::{Complex, gauss};

/// Weight under which the kernel is integrated: a smooth function A of the speed u.
pub(crate) trait KernelWeight {
    /// A(u).
    fn value(&self, u: f64) -> f64;
    /// A(u)/u.
    fn value_over_speed(&self, u: f64) -> f64;
    /// Whether A(u)/u is smooth at u = 0.
    fn vanishes_at_zero(&self) -> bool;
}

/// A = τ^power.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Power(pub(crate) i32);

impl KernelWeight for Power {
    fn value(&self, u: f64) -> f64 {
        u.powi(-self.0)
    }

    fn value_over_speed(&self, u: f64) -> f64 {
        u.powi(-self.0 - 1)
    }

    fn vanishes_at_zero(&self) -> bool {
        self.0 < 0
    }
}

/// Branch of the kernel, with the variable s that removes its square root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Branch {
    /// zz and xx behind the pressure wave: s = √(τ²−a²).
    Pressure,
    /// zz and xx behind the shear wave: s = √(τ²−1).
    Shear,
    /// zx near the pressure wave: s = √(τ²−a²).
    OddLow,
    /// zx near the shear wave: s = √(1−τ²).
    OddHigh,
    /// zz and xx behind the Rayleigh wave, both branches: s = u.
    Tail,
}

/// Branches of the kernel of one soil: their ends and their singularities.
#[derive(Debug, Clone)]
pub(crate) struct Branches {
    pub(crate) rayleigh: Rayleigh,
    /// a: τ when the pressure wave arrives.
    pub(crate) pressure_arrival: f64,
    /// τ between `OddLow` and `OddHigh`.
    odd_division: f64,
    /// τ where the tail begins.
    tail_start: f64,
    /// `c_S`/`c_R`: τ when the Rayleigh wave arrives.
    pub(crate) rayleigh_arrival: f64,
    /// Strength of the Rayleigh pulse of zx.
    pub(crate) rayleigh_pulse: f64,
    /// a² − y for the root near the pressure wave, when it is subtracted.
    near_root: Option<f64>,
    /// Singularities of each branch for which pieces are subdivided, and which are not subtracted.
    distant_singularities: [[[f64; 2]; 4]; 5],
    /// The Rayleigh pole in the variables of `Pressure` and `Shear`.
    rayleigh_poles: [f64; 2],
}

/// Singularities that are subtracted on a piece and integrated in closed form.
#[derive(Default)]
struct SubtractedTerms {
    /// Residue at the Rayleigh pole.
    residue: Option<[f64; 2]>,
    /// Factor of s²/(s²+c) at the root beside the path, and c.
    near_root: Option<([f64; 2], f64)>,
}

impl SubtractedTerms {
    /// Adds the integrals of the subtracted terms over the piece.
    fn add_integrals(&self, pole: Option<f64>, [low, high]: [f64; 2], sum: &mut [f64; 2]) {
        if let (Some(residue), Some(s)) = (self.residue, pole) {
            // The lower limit 1e-30 replaces a zero distance when a piece ends at the pole; the next piece cancels
            // it.
            let log = ((high - s).abs().max(1e-30) / (low - s).abs().max(1e-30)).ln();
            sum[0] += residue[0] * log;
            sum[1] += residue[1] * log;
        }
        if let Some((factor, c)) = self.near_root {
            let delta = c.sqrt();
            let angle = ((high - low) * delta).atan2(c + low * high);
            sum[0] -= factor[0] * delta * angle;
            sum[1] -= factor[1] * delta * angle;
        }
    }
}

/// A root whose distance from a² is below this is subtracted.
const NEAR_ROOT_DISTANCE: f64 = 0.01;

/// A pole within this reach of a piece, in the sense of [`gauss::reach`], is subtracted.
const SUBTRACTION_REACH: f64 = 3.0;

/// Largest number of successive halvings of a piece.
const MAX_PIECE_HALVINGS: u32 = 60;

/// Kernel of a branch at one point.
struct BranchKernel {
    /// zz and xx; or zx and 0.
    values: [f64; 2],
    u: f64,
}

/// √(sign·z + offset) as a point of the complex plane.
fn root_of_shifted(z: Complex, sign: f64, offset: f64) -> [f64; 2] {
    let s = (z.scale(sign) + Complex::real(offset)).sqrt();
    [s.re, s.im]
}

impl Branches {
    /// Branches for a soil with these roots of the Rayleigh polynomial.
    pub(crate) fn new(rayleigh: Rayleigh) -> Self {
        let r = rayleigh;
        let pressure_arrival = r.a2.sqrt();
        let rayleigh_arrival = r.arrival();
        let discriminant = r.discriminant();
        let roots = r.shifted_roots(discriminant, 0.0);
        let is_near = discriminant > 0.0 && -roots[0].re < NEAR_ROOT_DISTANCE;
        let near_root = is_near.then_some(-roots[0].re);
        let second_point = root_of_shifted(roots[1], 1.0, 0.0);
        let first_point =
            if near_root.is_some() { second_point } else { root_of_shifted(roots[0], 1.0, 0.0) };
        let pressure_pole = r.z.sqrt();
        let shear_pole = r.excess.sqrt();
        let h = r.h;
        let distant_singularities = [
            [[0.0, pressure_arrival], first_point, second_point, [-pressure_pole, 0.0]],
            [
                [0.0, 1.0],
                root_of_shifted(roots[0], 1.0, -h),
                root_of_shifted(roots[1], 1.0, -h),
                [-shear_pole, 0.0],
            ],
            [[0.0, pressure_arrival], first_point, second_point, [h.sqrt(), 0.0]],
            [
                [0.0, shear_pole],
                root_of_shifted(roots[0], -1.0, h),
                root_of_shifted(roots[1], -1.0, h),
                [h.sqrt(), 0.0],
            ],
            [[1.0 / rayleigh_arrival, 0.0]; 4],
        ];
        Self {
            rayleigh,
            pressure_arrival,
            odd_division: (r.a2 + 0.5 * h).sqrt(),
            tail_start: 1.6 * rayleigh_arrival,
            rayleigh_arrival,
            rayleigh_pulse: r.pulse(),
            near_root,
            distant_singularities,
            rayleigh_poles: [pressure_pole, shear_pole],
        }
    }

    /// Interval of τ on which a branch is integrated.
    fn interval(&self, branch: Branch) -> [f64; 2] {
        match branch {
            Branch::Pressure => [self.pressure_arrival, self.tail_start],
            Branch::Shear => [1.0, self.tail_start],
            Branch::OddLow => [self.pressure_arrival, self.odd_division],
            Branch::OddHigh => [self.odd_division, 1.0],
            Branch::Tail => [self.tail_start, f64::INFINITY],
        }
    }

    /// The variable s of a branch at τ.
    fn variable(&self, branch: Branch, tau: f64) -> f64 {
        match branch {
            Branch::Pressure | Branch::OddLow => {
                ((tau - self.pressure_arrival).max(0.0) * (tau + self.pressure_arrival)).sqrt()
            }
            Branch::Shear => ((tau - 1.0).max(0.0) * (tau + 1.0)).sqrt(),
            Branch::OddHigh => ((1.0 - tau).max(0.0) * (1.0 + tau)).sqrt(),
            Branch::Tail => 1.0 / tau,
        }
    }

    /// Adds the integral of a branch under a weight to `sum`.
    ///
    /// ∫ f(τ) A(1/τ) dτ over the part of `start` < τ < `end` inside the branch; zz and xx, or zx first.
    pub(crate) fn add_integral(
        &self,
        branch: Branch,
        start: f64,
        end: f64,
        weight: &impl KernelWeight,
        sum: &mut [f64; 2],
    ) {
        let interval = self.interval(branch);
        let start = start.max(interval[0]);
        let end = end.min(interval[1]);
        if start >= end {
            return;
        }
        let one = self.variable(branch, start);
        let two = self.variable(branch, end);
        self.add_piece(branch, [one.min(two), one.max(two)], weight, sum, 0);
    }

    /// Adds the integral over a piece of s, which is halved until a Gauss rule is accurate.
    fn add_piece(
        &self,
        branch: Branch,
        [low, high]: [f64; 2],
        weight: &impl KernelWeight,
        sum: &mut [f64; 2],
        halvings: u32,
    ) {
        if high <= low {
            return;
        }
        let pole = match branch {
            Branch::Pressure => Some(self.rayleigh_poles[0]),
            Branch::Shear => Some(self.rayleigh_poles[1]),
            _ => None,
        };
        // No node may come near the pole: end the piece there.
        if let Some(s) = pole
            && s > low
            && s < high
        {
            self.add_piece(branch, [low, s], weight, sum, halvings);
            self.add_piece(branch, [s, high], weight, sum, halvings);
            return;
        }
        let (subtracted, reach) = self.singularities(branch, [low, high], weight, pole);
        let rule = match gauss::rule_for(reach) {
            Some(rule) => rule,
            None if halvings < MAX_PIECE_HALVINGS => {
                let middle = 0.5 * (low + high);
                self.add_piece(branch, [low, middle], weight, sum, halvings + 1);
                self.add_piece(branch, [middle, high], weight, sum, halvings + 1);
                return;
            }
            None => gauss::largest(),
        };
        let center = 0.5 * (low + high);
        let half_length = 0.5 * (high - low);
        for (node, node_weight) in rule.nodes.iter().zip(&rule.weights) {
            let s = center + half_length * node;
            let node_weight = node_weight * half_length;
            let kernel = self.kernel_without_pole(branch, s, pole);
            let weight_value = if branch == Branch::Tail {
                weight.value_over_speed(kernel.u)
            } else {
                weight.value(kernel.u)
            };
            let mut value = kernel.values.map(|value| value * weight_value);
            if let Some(residue) = subtracted.residue {
                value[0] -= residue[0];
                value[1] -= residue[1];
            }
            if let Some(pole) = pole {
                let inverse = 1.0 / (s - pole);
                value[0] *= inverse;
                value[1] *= inverse;
            }
            if let Some((factor, c)) = subtracted.near_root {
                let ratio = if c == 0.0 { 0.0 } else { c / (s * s + c) };
                value[0] += ratio * factor[0];
                value[1] += ratio * factor[1];
            }
            sum[0] += node_weight * value[0];
            sum[1] += node_weight * value[1];
        }
        subtracted.add_integrals(pole, [low, high], sum);
    }

    /// Singularities that are subtracted on a piece, and the reach of the nearest other one.
    fn singularities(
        &self,
        branch: Branch,
        [low, high]: [f64; 2],
        weight: &impl KernelWeight,
        pole: Option<f64>,
    ) -> (SubtractedTerms, f64) {
        let mut reach = f64::INFINITY;
        for &point in &self.distant_singularities[branch as usize] {
            reach = reach.min(gauss::reach(point, low, high));
        }
        if branch == Branch::Tail && !weight.vanishes_at_zero() {
            reach = reach.min(gauss::reach([0.0, 0.0], low, high));
        }
        let mut subtracted = SubtractedTerms::default();
        if let Some(s) = pole {
            let pole_reach = gauss::reach([s, 0.0], low, high);
            if pole_reach < SUBTRACTION_REACH {
                let kernel = self.kernel_without_pole(branch, s, pole);
                let weight_value = weight.value(kernel.u);
                subtracted.residue = Some(kernel.values.map(|value| value * weight_value));
            } else {
                reach = reach.min(pole_reach);
            }
        }
        if let (Some(c), Branch::Pressure | Branch::OddLow) = (self.near_root, branch) {
            let root_reach = gauss::reach([0.0, c.sqrt()], low, high);
            if root_reach < SUBTRACTION_REACH {
                subtracted.near_root = Some((self.near_root_factor(branch, c, weight), c));
            } else {
                reach = reach.min(root_reach);
            }
        }
        (subtracted, reach)
    }

    /// Kernel times dτ/ds at `s`, and u; the kernel's factor 1/(s − pole) is left out if there is a pole.
    fn kernel_without_pole(&self, branch: Branch, s: f64, pole: Option<f64>) -> BranchKernel {
        let r = &self.rayleigh;
        let square = s * s;
        let sixteen = 16.0 * r.h;
        match branch {
            Branch::Pressure | Branch::Shear => {
                let behind_pressure = branch == Branch::Pressure;
                let z = if behind_pressure { square } else { square + r.h };
                let y = if behind_pressure { square + r.a2 } else { square + 1.0 };
                let u = 1.0 / y.sqrt();
                let common = square * u / (sixteen * (s + pole.unwrap_or(0.0)) * r.pair(z));
                let k2 = (r.g - 2.0 * z).powi(2);
                let values = if behind_pressure {
                    [common * k2, common * 4.0 * y * (z - r.h)]
                } else {
                    [common * 4.0 * y * z, common * k2]
                };
                BranchKernel { values, u }
            }
            Branch::OddLow | Branch::OddHigh => {
                let low = branch == Branch::OddLow;
                let z = if low { square } else { r.h - square };
                let root = if low { r.h - square } else { z }.max(0.0).sqrt();
                let value =
                    2.0 * (r.g - 2.0 * z) * square * root / (sixteen * (z - r.z) * r.pair(z));
                BranchKernel { values: [value, 0.0], u: 1.0 / (z + r.a2).sqrt() }
            }
            Branch::Tail => {
                let ka = 1.0 - r.a2 * square;
                let kb = 1.0 - square;
                let pair = (ka + r.sum * square) * ka + r.product * square * square;
                let common = 1.0 / (sixteen * (1.0 - r.square * square) * pair);
                let sa = ka.sqrt();
                let sb = kb.sqrt();
                let k2 = (2.0 - square).powi(2);
                let zz = common * (k2 * sa + 4.0 * ka * sb);
                let xx = common * (4.0 * kb * sa + k2 * sb);
                BranchKernel { values: [zz, xx], u: s }
            }
        }
    }

    /// Factor of s²/(s²+c) at the root s² = −c beside the path.
    fn near_root_factor(&self, branch: Branch, c: f64, weight: &impl KernelWeight) -> [f64; 2] {
        let r = &self.rayleigh;
        let y = r.a2 - c;
        let u = 1.0 / y.sqrt();
        // The other factor of the pair at z = −c is c₂ − c, with c + c₂ = σ.
        let common = weight.value(u) / (16.0 * r.h * (-c - r.z) * (r.sum - 2.0 * c));
        let k = r.g + 2.0 * c;
        if branch == Branch::Pressure {
            [common * u * k * k, common * u * 4.0 * y * (-c - r.h)]
        } else {
            [common * 2.0 * k * (r.h + c).sqrt(), 0.0]
        }
    }
}
