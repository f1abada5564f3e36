//! Quadrature of the half-plane surface kernel against a polynomial in the slowness.
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
//! | τ, u | `c_S` t/x and 1/τ |
//! | z | τ² − a² |
//! | s | √(τ²−a²), √(τ²−1), √(1−τ²), or u in the tail |

use crate::fundamental::rayleigh::Rayleigh;
use crate::linalg::{Complex, gauss};

/// Weight under which the kernel is integrated: a smooth function A of the slowness u.
pub(crate) trait Weight {
    /// A(u).
    fn at(&self, u: f64) -> f64;
    /// A(u)/u.
    fn over(&self, u: f64) -> f64;
    /// Whether A(u)/u is smooth at u = 0.
    fn vanishes(&self) -> bool;
}

/// A = τ^power.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Power(pub(crate) i32);

impl Weight for Power {
    fn at(&self, u: f64) -> f64 {
        u.powi(-self.0)
    }

    fn over(&self, u: f64) -> f64 {
        u.powi(-self.0 - 1)
    }

    fn vanishes(&self) -> bool {
        self.0 < 0
    }
}

/// Branch of the kernel, in its own variable.
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
    /// a.
    pub(crate) first: f64,
    /// τ between `OddLow` and `OddHigh`.
    pub(crate) middle: f64,
    /// τ where the tail begins.
    pub(crate) tail: f64,
    /// `c_S`/`c_R`.
    pub(crate) arrival: f64,
    /// Strength of the Rayleigh pulse of zx.
    pub(crate) pulse: f64,
    /// a² − y for the root near the pressure wave, when it is subtracted.
    near: Option<f64>,
    /// Singularities of each branch for which pieces are subdivided, and which are not subtracted.
    regular: [[[f64; 2]; 4]; 5],
    /// The Rayleigh pole in the variables of `Pressure` and `Shear`.
    pole: [f64; 2],
}

/// Singularities that are subtracted on a piece and integrated in closed form.
#[derive(Default)]
struct Singular {
    /// Residue at the Rayleigh pole.
    residue: Option<[f64; 2]>,
    /// Factor of s²/(s²+c) at the root beside the path, and c.
    near: Option<([f64; 2], f64)>,
}

impl Singular {
    /// Adds the integrals over the piece.
    fn add(&self, pole: Option<f64>, [low, high]: [f64; 2], sum: &mut [f64; 2]) {
        if let (Some(residue), Some(s)) = (self.residue, pole) {
            // The lower limit 1e-30 replaces a zero distance when a piece ends at the pole; the next piece cancels
            // it.
            let log = ((high - s).abs().max(1e-30) / (low - s).abs().max(1e-30)).ln();
            sum[0] += residue[0] * log;
            sum[1] += residue[1] * log;
        }
        if let Some((side, c)) = self.near {
            let delta = c.sqrt();
            let angle = ((high - low) * delta).atan2(c + low * high);
            sum[0] -= side[0] * delta * angle;
            sum[1] -= side[1] * delta * angle;
        }
    }
}

/// A root nearer than this to a² is subtracted.
const NEAR: f64 = 0.01;

/// A pole within this reach of a piece is subtracted.
const SUBTRACT: f64 = 3.0;

impl Branches {
    pub(crate) fn new(rayleigh: Rayleigh) -> Self {
        let r = rayleigh;
        let first = r.a2.sqrt();
        let arrival = r.arrival();
        let discriminant = r.discriminant();
        let (one, two) = r.shifted_roots(discriminant, 0.0);
        let near = (discriminant > 0.0 && -one.re < NEAR).then_some(-one.re);
        let at = |z: Complex| {
            let s = z.sqrt();
            [s.re, s.im]
        };
        let shifted =
            |z: Complex, sign: f64, offset: f64| at(z.scale(sign) + Complex::real(offset));
        let one_pressure = if near.is_some() { at(two) } else { at(one) };
        let zp = r.z.sqrt();
        let zs = r.excess.sqrt();
        let h = r.h;
        let regular = [
            [[0.0, first], one_pressure, at(two), [-zp, 0.0]],
            [[0.0, 1.0], shifted(one, 1.0, -h), shifted(two, 1.0, -h), [-zs, 0.0]],
            [[0.0, first], one_pressure, at(two), [h.sqrt(), 0.0]],
            [[0.0, zs], shifted(one, -1.0, h), shifted(two, -1.0, h), [h.sqrt(), 0.0]],
            [[1.0 / arrival, 0.0]; 4],
        ];
        Self {
            rayleigh,
            first,
            middle: (r.a2 + 0.5 * h).sqrt(),
            tail: 1.6 * arrival,
            arrival,
            pulse: r.pulse(),
            near,
            regular,
            pole: [zp, zs],
        }
    }

    /// Interval of τ that belongs to a part.
    fn range(&self, part: Branch) -> [f64; 2] {
        match part {
            Branch::Pressure => [self.first, self.tail],
            Branch::Shear => [1.0, self.tail],
            Branch::OddLow => [self.first, self.middle],
            Branch::OddHigh => [self.middle, 1.0],
            Branch::Tail => [self.tail, f64::INFINITY],
        }
    }

    /// The variable s of a part at τ.
    fn variable(&self, part: Branch, tau: f64) -> f64 {
        match part {
            Branch::Pressure | Branch::OddLow => {
                ((tau - self.first).max(0.0) * (tau + self.first)).sqrt()
            }
            Branch::Shear => ((tau - 1.0).max(0.0) * (tau + 1.0)).sqrt(),
            Branch::OddHigh => ((1.0 - tau).max(0.0) * (1.0 + tau)).sqrt(),
            Branch::Tail => 1.0 / tau,
        }
    }

    /// Adds ∫ f(τ) A(1/τ) dτ over `from` < τ < `to` (the part of it inside this branch) to `sum`:
    /// zz and xx, or zx first.
    pub(crate) fn add(
        &self,
        part: Branch,
        from: f64,
        to: f64,
        a: &impl Weight,
        sum: &mut [f64; 2],
    ) {
        let [begin, end] = self.range(part);
        let from = from.max(begin);
        let to = to.min(end);
        if from >= to {
            return;
        }
        let one = self.variable(part, from);
        let two = self.variable(part, to);
        self.piece(part, [one.min(two), one.max(two)], a, sum, 0);
    }

    fn piece(
        &self,
        part: Branch,
        [low, high]: [f64; 2],
        a: &impl Weight,
        sum: &mut [f64; 2],
        depth: u32,
    ) {
        if high <= low {
            return;
        }
        let pole = match part {
            Branch::Pressure => Some(self.pole[0]),
            Branch::Shear => Some(self.pole[1]),
            _ => None,
        };
        // No node may come near the pole: end the piece there.
        if let Some(s) = pole
            && s > low
            && s < high
        {
            self.piece(part, [low, s], a, sum, depth);
            self.piece(part, [s, high], a, sum, depth);
            return;
        }
        let (singular, reach) = self.singularities(part, [low, high], a, pole);
        let rule = match gauss::rule_for(reach) {
            Some(rule) => rule,
            None if depth < 60 => {
                let middle = 0.5 * (low + high);
                self.piece(part, [low, middle], a, sum, depth + 1);
                self.piece(part, [middle, high], a, sum, depth + 1);
                return;
            }
            None => gauss::largest(),
        };
        let Singular { residue, near, .. } = singular;
        let center = 0.5 * (low + high);
        let half = 0.5 * (high - low);
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let s = center + half * node;
            let weight = weight * half;
            let [one, two, u] = self.smooth(part, s, pole);
            let covered = if part == Branch::Tail { a.over(u) } else { a.at(u) };
            let mut value = [one * covered, two * covered];
            if let Some(residue) = residue {
                value[0] -= residue[0];
                value[1] -= residue[1];
            }
            if let Some(pole) = pole {
                let inverse = 1.0 / (s - pole);
                value[0] *= inverse;
                value[1] *= inverse;
            }
            if let Some((side, c)) = near {
                let factor = if c == 0.0 { 0.0 } else { c / (s * s + c) };
                value[0] += factor * side[0];
                value[1] += factor * side[1];
            }
            sum[0] += weight * value[0];
            sum[1] += weight * value[1];
        }
        singular.add(pole, [low, high], sum);
    }

    /// Singularities that are subtracted on a piece, and the reach of the nearest other one.
    fn singularities(
        &self,
        part: Branch,
        [low, high]: [f64; 2],
        a: &impl Weight,
        pole: Option<f64>,
    ) -> (Singular, f64) {
        let mut reach = f64::INFINITY;
        for &point in &self.regular[part as usize] {
            reach = reach.min(gauss::reach(point, low, high));
        }
        if part == Branch::Tail && !a.vanishes() {
            reach = reach.min(gauss::reach([0.0, 0.0], low, high));
        }
        let mut singular = Singular::default();
        if let Some(s) = pole {
            let distance = gauss::reach([s, 0.0], low, high);
            if distance < SUBTRACT {
                let [one, two, u] = self.smooth(part, s, pole);
                let weight = a.at(u);
                singular.residue = Some([one * weight, two * weight]);
            } else {
                reach = reach.min(distance);
            }
        }
        if let (Some(c), Branch::Pressure | Branch::OddLow) = (self.near, part) {
            let distance = gauss::reach([0.0, c.sqrt()], low, high);
            if distance < SUBTRACT {
                singular.near = Some((self.beside(part, c, a), c));
            } else {
                reach = reach.min(distance);
            }
        }
        (singular, reach)
    }

    /// Kernel times dτ/ds at `s`, and u; the kernel's factor 1/(s − pole) is left out if there is a pole.
    fn smooth(&self, part: Branch, s: f64, pole: Option<f64>) -> [f64; 3] {
        let r = &self.rayleigh;
        let square = s * s;
        let sixteen = 16.0 * r.h;
        match part {
            Branch::Pressure | Branch::Shear => {
                let (z, y) = if part == Branch::Pressure {
                    (square, square + r.a2)
                } else {
                    (square + r.h, square + 1.0)
                };
                let u = 1.0 / y.sqrt();
                let common = square * u / (sixteen * (s + pole.unwrap_or(0.0)) * r.pair(z));
                let k2 = (r.g - 2.0 * z).powi(2);
                if part == Branch::Pressure {
                    [common * k2, common * 4.0 * y * (z - r.h), u]
                } else {
                    [common * 4.0 * y * z, common * k2, u]
                }
            }
            Branch::OddLow | Branch::OddHigh => {
                let low = part == Branch::OddLow;
                let z = if low { square } else { r.h - square };
                let root = if low { r.h - square } else { z }.max(0.0).sqrt();
                let value =
                    2.0 * (r.g - 2.0 * z) * square * root / (sixteen * (z - r.z) * r.pair(z));
                [value, 0.0, 1.0 / (z + r.a2).sqrt()]
            }
            Branch::Tail => {
                let ka = 1.0 - r.a2 * square;
                let kb = 1.0 - square;
                let pair = (ka + r.sum * square) * ka + r.product * square * square;
                let common = 1.0 / (sixteen * (1.0 - r.square * square) * pair);
                let sa = ka.sqrt();
                let sb = kb.sqrt();
                let k2 = (2.0 - square).powi(2);
                [common * (k2 * sa + 4.0 * ka * sb), common * (4.0 * kb * sa + k2 * sb), s]
            }
        }
    }

    /// Factor of s²/(s²+c) at the root s² = −c beside the path.
    fn beside(&self, part: Branch, c: f64, a: &impl Weight) -> [f64; 2] {
        let r = &self.rayleigh;
        let y = r.a2 - c;
        let u = 1.0 / y.sqrt();
        // The other factor of the pair at z = −c is c₂ − c, with c + c₂ = σ.
        let common = a.at(u) / (16.0 * r.h * (-c - r.z) * (r.sum - 2.0 * c));
        let k = r.g + 2.0 * c;
        if part == Branch::Pressure {
            [common * u * k * k, common * u * 4.0 * y * (-c - r.h)]
        } else {
            [common * 2.0 * k * (r.h + c).sqrt(), 0.0]
        }
    }
}
