//! Closed-form integrals of the full-plane solution over a straight element, for a load H(t).
//!
//! The field point is y = x + s d + h n with the element's direction d and outward normal n; the load acts at
//! x. On the element h is constant and s runs from one end to the other. Every integral is therefore the
//! difference of a primitive at the two ends. With the functions of [`crate::fundamental::FullPlane`] the
//! solution is, up to 1/2πρ and μ/2πρ,
//!
//! * `u_ij` = ½(−D + L₁ + L₂) `δ_ij` + D `e_i` `e_j`
//! * r `t_ij` = (2D − Q₂)(`δ_ij` `r_n` + `e_i` `n_j`) + 2D `n_i` `e_j`
//!   − (8D + 2(Q₁−Q₂)) `e_i` `e_j` `r_n` − (λ/μ) Q₁ `n_i` `e_j`
//!
//! | symbol | meaning |
//! |---|---|
//! | T, R, q | c t, √(T²−r²), R/T; for each wave |
//! | D | T₁R₁/(c₁r)² − T₂R₂/(c₂r)² = (c₂⁻² − c₁⁻²)/(q₁+q₂) once both waves have passed |
//! | L, Q | arcosh(T/r)/c², T/(R c²) |
//! | A, `arc` | atan(sT/(hR)), asin(s/√(T²−h²)) |
//! | `pole` | (t²/h)(A₁ − A₂), formed without the 1/h |
//!
//! Beyond a front the primitives take their values at the front: A = `arc` = ±π/2, R = L = 0.

use std::f64::consts::FRAC_PI_2;

/// Displacements and tractions integrated over an element, in its axes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Integrals {
    /// dd, dn = nd, nn; in units of 1/2πρ.
    pub(super) displacement: [f64; 3],
    /// `t[i][j]`: component i for a load j (d, n); in units of μ/2πρ.
    pub(super) traction: [[f64; 2]; 2],
}

impl Integrals {
    /// Adds `factor` times `other`.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        for (a, b) in self.displacement.iter_mut().zip(other.displacement) {
            *a += factor * b;
        }
        for (a, b) in self.traction.as_flattened_mut().iter_mut().zip(other.traction.as_flattened())
        {
            *a += factor * b;
        }
    }
}

/// Constants of the soil in the kernel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Medium {
    /// c₁, c₂.
    pub(super) speeds: [f64; 2],
    /// λ/μ.
    pub(super) lame: f64,
}

/// Front of a wave at one end of the element.
#[derive(Clone, Copy)]
struct Front {
    /// Whether the wave has passed the point of the element's line nearest to the load.
    present: bool,
    /// Whether the wave has passed this end.
    covered: bool,
    reach: f64,
    root: f64,
    logarithm: f64,
    arc: f64,
    angle: f64,
}

impl Front {
    fn new(speed: f64, time: f64, s: f64, height: f64, r: f64) -> Self {
        let reach = speed * time;
        let present = reach > height;
        let covered = r < reach;
        if covered {
            let root = ((reach - r) * (reach + r)).sqrt();
            let arc = s.atan2(root);
            let angle = (s * reach).atan2(height * root);
            return Self {
                present,
                covered,
                reach,
                root,
                logarithm: (root / r).asinh(),
                arc,
                angle,
            };
        }
        let quarter = if present { FRAC_PI_2.copysign(s) } else { 0.0 };
        Self { present, covered, reach, root: 0.0, logarithm: 0.0, arc: quarter, angle: quarter }
    }
}

/// (y − atan y)/y³.
fn arctangent_defect(y: f64) -> f64 {
    if y.abs() > 0.5 {
        return (y - y.atan()) / (y * y * y);
    }
    let square = y * y;
    // Σ (−y²)^k/(2k+3); the error of 26 terms is 1e-17 at ½.
    (0..26).rev().fold(0.0, |sum, k| 1.0 / f64::from(2 * k + 3) - square * sum)
}

/// `pole`, and (`pole` + s D)/2h.
fn pole_terms(fronts: &[Front; 2], time: f64, s: f64, height: f64, r: f64, d: f64) -> [f64; 2] {
    let [p, q] = fronts;
    let square = time * time;
    if !p.present {
        return [0.0; 2];
    }
    if !q.present {
        // Only here may A be a quarter turn that does not cancel; h is not small then.
        let pole = square * p.angle / height;
        return [pole, (pole + s * d) / (2.0 * height)];
    }
    if !p.covered {
        return [0.0; 2];
    }
    if !q.covered {
        let slope = p.root / (s.abs() * p.reach);
        let w = height * slope;
        let defect = slope * w * slope * arctangent_defect(w);
        let pole = -(slope - height * height * slope * slope * slope * arctangent_defect(w));
        let half = 0.5 * (defect - w / (r * r));
        return [(square * pole).copysign_of(s), (square * half).copysign_of(s)];
    }
    let reaches = p.reach * q.reach;
    let roots = p.root * q.root;
    let below = height * height * roots + s * s * reaches;
    // −X of tan(A₁ − A₂) = h X; D = t² k/(q₁+q₂).
    let x = -s * (r * r) * d * reaches / (square * below);
    let y = height * x;
    let cubic = x * y * y * arctangent_defect(y);
    // T₁T₂ − R₁R₂ without cancellation.
    let u1 = (r / p.reach).powi(2);
    let u2 = (r / q.reach).powi(2);
    let lost = reaches * (u1 + u2 - u1 * u2) / (1.0 + roots / reaches);
    let cubic_over_height = x * x * y * arctangent_defect(y);
    let half = -0.5 * (square * cubic_over_height + s * d * height * lost / below);
    [square * (x - cubic), half]
}

/// Changes the sign of `self` if the other number is negative.
trait CopySignOf {
    fn copysign_of(self, sign: f64) -> f64;
}

impl CopySignOf for f64 {
    fn copysign_of(self, sign: f64) -> f64 {
        if sign < 0.0 { -self } else { self }
    }
}

/// The primitives at one end.
fn primitive(medium: &Medium, s: f64, h: f64, time: f64) -> Integrals {
    let height = h.abs();
    let sign = if h == 0.0 { 0.0 } else { h.signum() };
    let r = s.hypot(height);
    let fronts = medium.speeds.map(|c| Front::new(c, time, s, height, r));
    let square = medium.speeds.map(|c| 1.0 / (c * c));
    let both = |f: &dyn Fn(&Front) -> f64| square[0] * f(&fronts[0]) - square[1] * f(&fronts[1]);
    let d = match (fronts[0].covered, fronts[1].covered) {
        (true, true) => {
            let q = fronts.map(|f| f.root / f.reach);
            (square[1] - square[0]) / (q[0] + q[1])
        }
        (true, false) => square[0] * fronts[0].reach / r * (fronts[0].root / r),
        _ => 0.0,
    };
    let [pole, half_pole] = pole_terms(&fronts, time, s, height, r, d);

    let angles = both(&|f| f.angle);
    let arcs = both(&|f| f.reach * f.arc);
    let logarithms = both(&|f| f.logarithm);
    let zero = pole - arcs;
    let two = 0.5 * (pole - s * d + height * angles) - arcs;
    let one = 0.5 * h * (logarithms - d);
    let growth: f64 = (0..2)
        .map(|k| {
            let f = &fronts[k];
            square[k] * (s * f.logarithm + f.reach * f.arc - height * f.angle)
        })
        .sum();
    let middle = 0.5 * (growth - zero);
    let displacement = [middle + two, one, middle + zero - two];

    // ∫ D h/r², ∫ D s/r², ∫ D s h²/r⁴, ∫ D h³/r⁴, and the same of Q.
    let dh = sign * (half_pole - 0.5 * angles);
    let ds = 0.5 * (logarithms - d);
    let share = (height / r).powi(2);
    let bend = |f: &Front| share * f.root / f.reach + (height / f.reach).powi(2) * f.logarithm;
    let dsh2 = -0.25 * share * d + 0.125 * both(&bend);
    let side = height * s / (r * r);
    let turned = both(&|f| (1.0 - (height / f.reach).powi(2)) * f.angle);
    let dh3 = 0.75 * dh + 0.125 * sign * (side * (2.0 * d - both(&|f| f.root / f.reach)) + turned);
    let qh = |k: usize| sign * square[k] * fronts[k].angle;
    let qs = |k: usize| -square[k] * fronts[k].logarithm;
    let qsh2 = -0.5 * both(&bend);
    let thirds =
        |f: &Front| 0.5 * (side * f.root / f.reach + (1.0 + (height / f.reach).powi(2)) * f.angle);
    let qh3 = sign * both(&thirds);
    let across = 2.0 * ds - 8.0 * dsh2 - 2.0 * qsh2;
    let traction = [
        [2.0 * dh - qh(1) - 8.0 * (dh - dh3) - 2.0 * (qh(0) - qh(1) - qh3), across - qs(1)],
        [
            across - medium.lame * qs(0),
            6.0 * dh - 2.0 * qh(1) - medium.lame * qh(0) - 8.0 * dh3 - 2.0 * qh3,
        ],
    ];
    Integrals { displacement, traction }
}

/// Integrals over s from `ends[0]` to `ends[1]` at signed height `h`, `time` after the load began.
///
/// They are principal values where the load lies on the element (h = 0).
pub(super) fn step_integrals(medium: &Medium, ends: [f64; 2], h: f64, time: f64) -> Integrals {
    let mut out = primitive(medium, ends[1], h, time);
    out.add(-1.0, &primitive(medium, ends[0], h, time));
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Soil;
    use crate::fundamental::{FullPlane, FundamentalSolution, LoadHistory};
    use crate::linalg::gauss;

    /// ∫ f from `low` to `high`, with square-root singularities at both ends.
    fn between(low: f64, high: f64, f: &dyn Fn(f64) -> [f64; 7]) -> [f64; 7] {
        let rule = gauss::largest();
        let mut sum = [0.0; 7];
        let pieces = 12;
        for k in 0..pieces {
            let a = f64::from(k) / f64::from(pieces);
            let b = f64::from(k + 1) / f64::from(pieces);
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                // The substitution s = low + (high − low) sin²θ removes both singularities.
                let theta = FRAC_PI_2 * (a + 0.5 * (b - a) * (1.0 + node));
                let s = low + (high - low) * theta.sin().powi(2);
                let slope = (high - low) * (2.0 * theta).sin();
                for (sum, value) in sum.iter_mut().zip(f(s)) {
                    *sum += 0.5 * (b - a) * FRAC_PI_2 * weight * slope * value;
                }
            }
        }
        sum
    }

    /// Integrals of an element and a step by quadrature of the fundamental solution between its fronts.
    fn by_quadrature(soil: Soil, ends: [f64; 2], h: f64, time: f64) -> [f64; 7] {
        let plane = FullPlane::new(soil);
        let f = |s: f64| {
            let u = plane.displacement([s, h], time, LoadHistory::Step).unwrap();
            let t = plane.traction([s, h], [0.0, 1.0], time, LoadHistory::Step).unwrap();
            [u[0][0], u[0][1], u[1][1], t[0][0], t[0][1], t[1][0], t[1][1]]
        };
        let mut nodes = vec![ends[0], ends[1]];
        if h == 0.0 {
            nodes.push(0.0);
        }
        for c in [soil.pressure_wave_speed(), soil.shear_wave_speed()] {
            let square = (c * time).powi(2) - h * h;
            if square > 0.0 {
                nodes.extend([square.sqrt(), -square.sqrt()]);
            }
        }
        nodes.retain(|s| *s >= ends[0] && *s <= ends[1]);
        nodes.sort_by(f64::total_cmp);
        let mut sum = [0.0; 7];
        for pair in nodes.windows(2) {
            let part = between(pair[0], pair[1], &f);
            sum.iter_mut().zip(part).for_each(|(a, b)| *a += b);
        }
        sum
    }

    #[test]
    fn closed_forms_match_quadrature() {
        for poisson in [-0.3, 0.0, 0.25, 1.0 / 3.0, 0.48] {
            let soil = Soil::new(2.0, poisson, 1.3).unwrap();
            let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
            let medium = Medium { speeds, lame: 2.0 * poisson / (1.0 - 2.0 * poisson) };
            let unit = 1.0 / (2.0 * std::f64::consts::PI * soil.density());
            for (ends, h) in [
                ([-0.5, 0.5], 0.3),
                ([-0.5, 0.5], -0.05),
                ([0.2, 1.2], 0.4),
                ([-2.0, -1.0], -0.7),
                ([0.5, 1.5], 0.0),
                ([-1.5, -0.5], 0.0),
                ([-0.4, 0.9], 1.1),
                ([1.0, 2.0], 1e-7),
            ] {
                for time in [0.1, 0.3, 0.5, 0.8, 1.2, 2.0] {
                    let found = step_integrals(&medium, ends, h, time);
                    let [dd, dn, nn] = found.displacement.map(|v| v * unit);
                    let t = found.traction.as_flattened();
                    let wanted = by_quadrature(soil, ends, h, time);
                    let scale = unit * soil.shear_modulus();
                    let found =
                        [dd, dn, nn, scale * t[0], scale * t[1], scale * t[2], scale * t[3]];
                    for k in 0..7 {
                        let size = if k < 3 { 0.5 } else { 1.0 };
                        assert!(
                            (found[k] - wanted[k]).abs() < 1e-11 * size,
                            "nu {poisson} ends {ends:?} h {h} t {time}: {k}: {} {}",
                            found[k],
                            wanted[k]
                        );
                    }
                }
            }
        }
    }
}
