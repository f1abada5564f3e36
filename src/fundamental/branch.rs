//! Quadrature of the half-plane's surface kernel times a smooth function of the wave speed.
//!
//! The kernel is a sum of branches. Each branch is a square root times a rational function whose poles are the roots of
//! the Rayleigh polynomial. On each branch a variable s removes the square root, and pieces are halved until the nearest
//! singularity is distant enough for a Gauss rule. Two poles may be arbitrarily close to the path of integration; they
//! are subtracted and integrated in closed form. The Rayleigh root is on the path (principal value). For small Poisson's
//! ratios, the root near the pressure wave is close to the path. Further symbols: see `half_plane` and `rayleigh`.
//!
//! | symbol | meaning |
//! |---|---|
//! | τ, u | `c_S` t/x, and the speed 1/τ = x/(`c_S` t) |
//! | z | τ² − a² |
//! | s | √(τ²−a²), √(τ²−1), √(1−τ²), or u in the tail |

use crate::fundamental::rayleigh::Rayleigh;
use crate::linalg::{Complex, gauss};

/// Weight of the kernel in an integral: a smooth function A of the speed u.
pub(crate) trait KernelWeight {
    /// Weight A at the speed u.
    fn value(&self, u: f64) -> f64;
    /// Quotient A(u)/u.
    fn value_over_speed(&self, u: f64) -> f64;
    /// Whether A(u)/u is smooth at u = 0.
    fn vanishes_at_zero(&self) -> bool;
}

/// Weight A = τ^power.
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

/// Branches of the kernel of one soil, with their ends and singularities.
#[derive(Debug, Clone)]
pub(crate) struct Branches {
    pub(crate) rayleigh: Rayleigh,
    /// a: τ at the arrival of the pressure wave.
    pub(crate) pressure_arrival: f64,
    /// τ between `OddLow` and `OddHigh`.
    odd_division: f64,
    /// τ at the start of the tail.
    tail_start: f64,
    /// `c_S`/`c_R`: τ at the arrival of the Rayleigh wave.
    pub(crate) rayleigh_arrival: f64,
    /// Strength of the Rayleigh pulse of zx.
    pub(crate) rayleigh_pulse: f64,
    /// Distance a² − y of the root y near the pressure wave; `None` if this root is not subtracted.
    near_root: Option<f64>,
    /// Singularities of each branch that are not subtracted, in the variable s; they limit the length of pieces.
    distant_singularities: [[[f64; 2]; 4]; 5],
    /// The Rayleigh pole in the variables of `Pressure` and `Shear`.
    rayleigh_poles: [f64; 2],
}

/// Singularities that are subtracted on a piece and integrated in closed form.
#[derive(Default)]
struct SubtractedTerms {
    /// Residue of both components at the Rayleigh pole.
    residue: Option<[f64; 2]>,
    near_root: Option<NearRootTerm>,
}

/// Term factor · s²/(s²+c) of the root near the path, for both components.
struct NearRootTerm {
    factor: [f64; 2],
    c: f64,
}

/// Distance that replaces zero for a piece that ends at the Rayleigh pole: the terms of both pieces at the pole cancel.
const MIN_POLE_DISTANCE: f64 = 1e-30;

impl SubtractedTerms {
    /// Adds the integrals of the subtracted terms over the piece.
    fn add_integrals(&self, pole: Option<f64>, [low, high]: [f64; 2], sum: &mut [f64; 2]) {
        if let (Some(residue), Some(s)) = (self.residue, pole) {
            let high_distance = (high - s).abs().max(MIN_POLE_DISTANCE);
            let low_distance = (low - s).abs().max(MIN_POLE_DISTANCE);
            let log = (high_distance / low_distance).ln();
            sum[0] += residue[0] * log;
            sum[1] += residue[1] * log;
        }
        if let Some(NearRootTerm { factor, c }) = self.near_root {
            let delta = c.sqrt();
            let angle = ((high - low) * delta).atan2(c + low * high);
            sum[0] -= factor[0] * delta * angle;
            sum[1] -= factor[1] * delta * angle;
        }
    }
}

/// Largest distance of a subtracted root from a²; for a more distant root halved pieces are accurate.
const NEAR_ROOT_DISTANCE: f64 = 0.01;
/// Largest [`gauss::ellipse_size`] of a pole that is subtracted; for a more distant pole a Gauss rule is accurate.
const MAX_SUBTRACTION_ELLIPSE: f64 = 3.0;
/// Start of the tail relative to the Rayleigh arrival, at which the Rayleigh pole is distant enough for a Gauss rule.
const TAIL_START_FACTOR: f64 = 1.6;
/// Largest number of successive halvings of a piece: its length is then a rounding error.
const MAX_PIECE_HALVINGS: u32 = 60;

/// Values of a branch of the kernel at one point.
struct BranchKernel {
    /// zz and xx; or zx and 0.
    values: [f64; 2],
    /// Speed.
    u: f64,
}

/// √(sign·z + offset) as a point `[re, im]` of the complex plane.
fn shifted_square_root(z: Complex, sign: f64, offset: f64) -> [f64; 2] {
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
        let second_point = shifted_square_root(roots[1], 1.0, 0.0);
        let first_point = if near_root.is_some() {
            second_point
        } else {
            shifted_square_root(roots[0], 1.0, 0.0)
        };
        let pressure_pole = r.z.sqrt();
        let shear_pole = r.excess.sqrt();
        let h = r.h;
        let distant_singularities = [
            [[0.0, pressure_arrival], first_point, second_point, [-pressure_pole, 0.0]],
            [
                [0.0, 1.0],
                shifted_square_root(roots[0], 1.0, -h),
                shifted_square_root(roots[1], 1.0, -h),
                [-shear_pole, 0.0],
            ],
            [[0.0, pressure_arrival], first_point, second_point, [h.sqrt(), 0.0]],
            [
                [0.0, shear_pole],
                shifted_square_root(roots[0], -1.0, h),
                shifted_square_root(roots[1], -1.0, h),
                [h.sqrt(), 0.0],
            ],
            [[1.0 / rayleigh_arrival, 0.0]; 4],
        ];
        Self {
            rayleigh,
            pressure_arrival,
            odd_division: (r.a2 + 0.5 * h).sqrt(),
            tail_start: TAIL_START_FACTOR * rayleigh_arrival,
            rayleigh_arrival,
            rayleigh_pulse: r.pulse(),
            near_root,
            distant_singularities,
            rayleigh_poles: [pressure_pole, shear_pole],
        }
    }

    /// Interval of τ of a branch.
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

    /// Adds the integral of a branch with a weight to `sum`: zz and xx, or zx and 0.
    ///
    /// The integral is ∫ f(τ) A(1/τ) dτ over the part of `start` < τ < `end` inside the branch.
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
        let start_s = self.variable(branch, start);
        let end_s = self.variable(branch, end);
        self.add_piece(branch, [start_s.min(end_s), start_s.max(end_s)], weight, sum, 0);
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
        // Points of a rule must not be near the pole, so the piece is divided at the pole.
        if let Some(pole) = pole
            && pole > low
            && pole < high
        {
            self.add_piece(branch, [low, pole], weight, sum, halvings);
            self.add_piece(branch, [pole, high], weight, sum, halvings);
            return;
        }
        let (subtracted_terms, ellipse) = self.singularities(branch, [low, high], weight, pole);
        let rule = match gauss::rule_for(ellipse) {
            Some(rule) => rule,
            None if halvings < MAX_PIECE_HALVINGS => {
                let middle = 0.5 * (low + high);
                self.add_piece(branch, [low, middle], weight, sum, halvings + 1);
                self.add_piece(branch, [middle, high], weight, sum, halvings + 1);
                return;
            }
            None => gauss::largest_rule(),
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
            if let Some(residue) = subtracted_terms.residue {
                value[0] -= residue[0];
                value[1] -= residue[1];
            }
            if let Some(pole) = pole {
                let inverse = 1.0 / (s - pole);
                value[0] *= inverse;
                value[1] *= inverse;
            }
            if let Some(NearRootTerm { factor, c }) = subtracted_terms.near_root {
                let ratio = if c == 0.0 { 0.0 } else { c / (s * s + c) };
                value[0] += ratio * factor[0];
                value[1] += ratio * factor[1];
            }
            sum[0] += node_weight * value[0];
            sum[1] += node_weight * value[1];
        }
        subtracted_terms.add_integrals(pole, [low, high], sum);
    }

    /// Subtracted singularities on a piece, and the ellipse size of the nearest other singularity.
    fn singularities(
        &self,
        branch: Branch,
        [low, high]: [f64; 2],
        weight: &impl KernelWeight,
        pole: Option<f64>,
    ) -> (SubtractedTerms, f64) {
        let mut min_ellipse = f64::INFINITY;
        for &point in &self.distant_singularities[branch as usize] {
            min_ellipse = min_ellipse.min(gauss::ellipse_size(point, low, high));
        }
        if branch == Branch::Tail && !weight.vanishes_at_zero() {
            min_ellipse = min_ellipse.min(gauss::ellipse_size([0.0, 0.0], low, high));
        }
        let mut subtracted_terms = SubtractedTerms::default();
        if let Some(s) = pole {
            let pole_ellipse = gauss::ellipse_size([s, 0.0], low, high);
            if pole_ellipse < MAX_SUBTRACTION_ELLIPSE {
                let kernel = self.kernel_without_pole(branch, s, pole);
                let weight_value = weight.value(kernel.u);
                subtracted_terms.residue = Some(kernel.values.map(|value| value * weight_value));
            } else {
                min_ellipse = min_ellipse.min(pole_ellipse);
            }
        }
        if let (Some(c), Branch::Pressure | Branch::OddLow) = (self.near_root, branch) {
            let root_ellipse = gauss::ellipse_size([0.0, c.sqrt()], low, high);
            if root_ellipse < MAX_SUBTRACTION_ELLIPSE {
                let factor = self.near_root_factor(branch, c, weight);
                subtracted_terms.near_root = Some(NearRootTerm { factor, c });
            } else {
                min_ellipse = min_ellipse.min(root_ellipse);
            }
        }
        (subtracted_terms, min_ellipse)
    }

    /// Kernel times dτ/ds at `s`, without its factor 1/(s − pole) if there is a pole; and u.
    fn kernel_without_pole(&self, branch: Branch, s: f64, pole: Option<f64>) -> BranchKernel {
        let r = &self.rayleigh;
        let square = s * s;
        let sixteen_h = 16.0 * r.h;
        match branch {
            Branch::Pressure | Branch::Shear => {
                let is_pressure = branch == Branch::Pressure;
                let z = if is_pressure { square } else { square + r.h };
                let y = if is_pressure { square + r.a2 } else { square + 1.0 };
                let u = 1.0 / y.sqrt();
                let common = square * u / (sixteen_h * (s + pole.unwrap_or(0.0)) * r.pair(z));
                let k2 = (r.g - 2.0 * z).powi(2);
                let values = if is_pressure {
                    [common * k2, common * 4.0 * y * (z - r.h)]
                } else {
                    [common * 4.0 * y * z, common * k2]
                };
                BranchKernel { values, u }
            }
            Branch::OddLow | Branch::OddHigh => {
                let is_low = branch == Branch::OddLow;
                let z = if is_low { square } else { r.h - square };
                let root = if is_low { r.h - square } else { z }.max(0.0).sqrt();
                let value =
                    2.0 * (r.g - 2.0 * z) * square * root / (sixteen_h * (z - r.z) * r.pair(z));
                BranchKernel { values: [value, 0.0], u: 1.0 / (z + r.a2).sqrt() }
            }
            Branch::Tail => {
                let ka = 1.0 - r.a2 * square;
                let kb = 1.0 - square;
                let pair = (ka + r.sum * square) * ka + r.product * square * square;
                let common = 1.0 / (sixteen_h * (1.0 - r.square * square) * pair);
                let sa = ka.sqrt();
                let sb = kb.sqrt();
                let k2 = (2.0 - square).powi(2);
                let zz = common * (k2 * sa + 4.0 * ka * sb);
                let xx = common * (4.0 * kb * sa + k2 * sb);
                BranchKernel { values: [zz, xx], u: s }
            }
        }
    }

    /// Factor of s²/(s²+c) for the root s² = −c near the path.
    fn near_root_factor(&self, branch: Branch, c: f64, weight: &impl KernelWeight) -> [f64; 2] {
        let r = &self.rayleigh;
        let y = r.a2 - c;
        let u = 1.0 / y.sqrt();
        // At z = −c the quadratic factor of the pair, without its zero factor, is c₂ − c with c + c₂ = σ.
        let common = weight.value(u) / (16.0 * r.h * (-c - r.z) * (r.sum - 2.0 * c));
        let k = r.g + 2.0 * c;
        if branch == Branch::Pressure {
            [common * u * k * k, common * u * 4.0 * y * (-c - r.h)]
        } else {
            [common * 2.0 * k * (r.h + c).sqrt(), 0.0]
        }
    }
}
