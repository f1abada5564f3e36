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
//! Beyond a front the primitives have their values at the front: A = `arc` = ±π/2, R = L = 0.

use std::f64::consts::FRAC_PI_2;

/// Displacements and tractions integrated over an element, in its axes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct SegmentIntegrals {
    /// Integrated displacements dd, dn = nd, nn, in units of 1/2πρ.
    pub(super) displacement: [f64; 3],
    /// Integrated tractions `t[i][j]`, component i for a load j (d, n), in units of μ/2πρ.
    pub(super) traction: [[f64; 2]; 2],
}

impl SegmentIntegrals {
    /// Adds `factor` times `other`.
    pub(super) fn add_scaled(&mut self, factor: f64, other: &Self) {
        for (a, b) in self.displacement.iter_mut().zip(other.displacement) {
            *a += factor * b;
        }
        for (a, b) in self.traction.as_flattened_mut().iter_mut().zip(other.traction.as_flattened())
        {
            *a += factor * b;
        }
    }
}

/// Wave speeds and elastic constants of the kernel.
#[derive(Debug, Clone, Copy)]
pub(super) struct WaveConstants {
    /// Wave speeds c₁ and c₂, m/s.
    pub(super) speeds: [f64; 2],
    /// Ratio λ/μ.
    pub(super) lame_ratio: f64,
}

/// Functions of one wave at one end of the element.
#[derive(Clone, Copy)]
struct Front {
    /// Whether the wave has passed the point of the element's line nearest to the load.
    is_present: bool,
    /// Whether the wave has passed this end.
    is_past_end: bool,
    /// Travel T of the wave.
    travel: f64,
    /// Root R.
    root: f64,
    /// Logarithm arcosh(T/r).
    logarithm: f64,
    /// Angle asin(s/√(T²−h²)).
    arc: f64,
    /// Angle A.
    angle: f64,
}

impl Front {
    fn new(speed: f64, time: f64, s: f64, height: f64, r: f64) -> Self {
        let travel = speed * time;
        let is_present = travel > height;
        let is_past_end = r < travel;
        if is_past_end {
            let root = ((travel - r) * (travel + r)).sqrt();
            let arc = s.atan2(root);
            let angle = (s * travel).atan2(height * root);
            return Self {
                is_present,
                is_past_end,
                travel,
                root,
                logarithm: (root / r).asinh(),
                arc,
                angle,
            };
        }
        let quarter_turn = if is_present { FRAC_PI_2.copysign(s) } else { 0.0 };
        Self {
            is_present,
            is_past_end,
            travel,
            root: 0.0,
            logarithm: 0.0,
            arc: quarter_turn,
            angle: quarter_turn,
        }
    }
}

/// Largest |y| for which (y − atan y)/y³ is computed by its series, without cancellation.
const MAX_DEFECT_SERIES_ARGUMENT: f64 = 0.5;
/// Number of terms of this series, with an error of 1e-17 at y = ½.
const DEFECT_TERM_COUNT: u32 = 26;

/// Function (y − atan y)/y³.
fn arctangent_defect(y: f64) -> f64 {
    if y.abs() > MAX_DEFECT_SERIES_ARGUMENT {
        return (y - y.atan()) / (y * y * y);
    }
    let square = y * y;
    // The series Σ (−y²)^k/(2k+3).
    (0..DEFECT_TERM_COUNT)
        .rev()
        .fold(0.0, |sum, k| 1.0 / f64::from(2 * k + 3) - square * sum)
}

/// Difference between the two waves' values over c².
fn wave_difference(slowness_squared: [f64; 2], values: [f64; 2]) -> f64 {
    slowness_squared[0] * values[0] - slowness_squared[1] * values[1]
}

/// Values of `pole` and of (`pole` + s D)/2h at one end.
fn pole_terms(fronts: &[Front; 2], time: f64, s: f64, height: f64, r: f64, d: f64) -> [f64; 2] {
    let p = &fronts[0];
    let q = &fronts[1];
    let square = time * time;
    if !p.is_present {
        return [0.0; 2];
    }
    if !q.is_present {
        // Only here may A be a quarter turn that does not cancel; h is not small then.
        let pole = square * p.angle / height;
        return [pole, (pole + s * d) / (2.0 * height)];
    }
    if !p.is_past_end {
        return [0.0; 2];
    }
    if !q.is_past_end {
        let slope = p.root / (s.abs() * p.travel);
        let w = height * slope;
        let defect = slope * w * slope * arctangent_defect(w);
        let pole = -(slope - height * height * slope * slope * slope * arctangent_defect(w));
        let half_sum = 0.5 * (defect - w / (r * r));
        return [square * pole, square * half_sum]
            .map(|value| if s < 0.0 { -value } else { value });
    }
    let travel_product = p.travel * q.travel;
    let root_product = p.root * q.root;
    let denominator = height * height * root_product + s * s * travel_product;
    // −X of tan(A₁ − A₂) = h X; D = t² k/(q₁+q₂).
    let x = -s * (r * r) * d * travel_product / (square * denominator);
    let y = height * x;
    let cubic = x * y * y * arctangent_defect(y);
    // T₁T₂ − R₁R₂ without cancellation.
    let u1 = (r / p.travel).powi(2);
    let u2 = (r / q.travel).powi(2);
    let product_difference =
        travel_product * (u1 + u2 - u1 * u2) / (1.0 + root_product / travel_product);
    let cubic_over_height = x * x * y * arctangent_defect(y);
    let half_sum =
        -0.5 * (square * cubic_over_height + s * d * height * product_difference / denominator);
    [square * (x - cubic), half_sum]
}

/// Value of D at one end.
fn end_value(fronts: &[Front; 2], slowness_squared: [f64; 2], r: f64) -> f64 {
    match (fronts[0].is_past_end, fronts[1].is_past_end) {
        (true, true) => {
            let q = [0, 1].map(|k| fronts[k].root / fronts[k].travel);
            (slowness_squared[1] - slowness_squared[0]) / (q[0] + q[1])
        }
        (true, false) => slowness_squared[0] * fronts[0].travel / r * (fronts[0].root / r),
        _ => 0.0,
    }
}

/// Primitives at one end.
fn primitive(waves: &WaveConstants, s: f64, h: f64, time: f64) -> SegmentIntegrals {
    let height = h.abs();
    let sign = if h == 0.0 { 0.0 } else { h.signum() };
    let r = s.hypot(height);
    let fronts = waves.speeds.map(|c| Front::new(c, time, s, height, r));
    let slowness_squared = waves.speeds.map(|c| 1.0 / (c * c));
    let d = end_value(&fronts, slowness_squared, r);
    let pole_terms = pole_terms(&fronts, time, s, height, r, d);
    let pole = pole_terms[0];

    let angles = wave_difference(slowness_squared, fronts.map(|f| f.angle));
    let arcs = wave_difference(slowness_squared, fronts.map(|f| f.travel * f.arc));
    let logarithms = wave_difference(slowness_squared, fronts.map(|f| f.logarithm));
    // ∫ D, ∫ D s²/r², ∫ D s h/r².
    let d0 = pole - arcs;
    let ds2 = 0.5 * (pole - s * d + height * angles) - arcs;
    let dsh = 0.5 * h * (logarithms - d);
    let growth: f64 = (0..2)
        .map(|k| {
            let f = &fronts[k];
            slowness_squared[k] * (s * f.logarithm + f.travel * f.arc - height * f.angle)
        })
        .sum();
    let isotropic_part = 0.5 * (growth - d0);
    let displacement = [isotropic_part + ds2, dsh, isotropic_part + d0 - ds2];

    // ∫ D h/r², ∫ D s/r², ∫ D s h²/r⁴, ∫ D h³/r⁴.
    let dh = sign * (pole_terms[1] - 0.5 * angles);
    let ds = 0.5 * (logarithms - d);
    let sin2 = (height / r).powi(2);
    let sin_cos = height * s / (r * r);
    let sh2 = fronts.map(|f| sin2 * f.root / f.travel + (height / f.travel).powi(2) * f.logarithm);
    let sh2 = wave_difference(slowness_squared, sh2);
    let dsh2 = -0.25 * sin2 * d + 0.125 * sh2;
    let reduced_angles = fronts.map(|f| (1.0 - (height / f.travel).powi(2)) * f.angle);
    let reduced_angles = wave_difference(slowness_squared, reduced_angles);
    let root_ratios = wave_difference(slowness_squared, fronts.map(|f| f.root / f.travel));
    let dh3 = 0.75 * dh + 0.125 * sign * (sin_cos * (2.0 * d - root_ratios) + reduced_angles);
    // The same of Q₁, Q₂ and of Q₁ − Q₂.
    let qh = [0, 1].map(|k| sign * slowness_squared[k] * fronts[k].angle);
    let qs = [0, 1].map(|k| -slowness_squared[k] * fronts[k].logarithm);
    let qsh2 = -0.5 * sh2;
    let h3 = fronts.map(|f| {
        0.5 * (sin_cos * f.root / f.travel + (1.0 + (height / f.travel).powi(2)) * f.angle)
    });
    let qh3 = sign * wave_difference(slowness_squared, h3);
    let shear_part = 2.0 * ds - 8.0 * dsh2 - 2.0 * qsh2;
    let lame_ratio = waves.lame_ratio;
    let traction = [
        [2.0 * dh - qh[1] - 8.0 * (dh - dh3) - 2.0 * (qh[0] - qh[1] - qh3), shear_part - qs[1]],
        [
            shear_part - lame_ratio * qs[0],
            6.0 * dh - 2.0 * qh[1] - lame_ratio * qh[0] - 8.0 * dh3 - 2.0 * qh3,
        ],
    ];
    SegmentIntegrals { displacement, traction }
}

/// Integrals over s from `ends[0]` to `ends[1]` at signed height `h`, `time` after the load began.
///
/// The integrals are principal values if the load is on the element (h = 0).
pub(super) fn step_integrals(
    waves: &WaveConstants,
    ends: [f64; 2],
    h: f64,
    time: f64,
) -> SegmentIntegrals {
    let mut integrals = primitive(waves, ends[1], h, time);
    integrals.add_scaled(-1.0, &primitive(waves, ends[0], h, time));
    integrals
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Soil;
    use crate::fundamental::{FullPlane, FundamentalSolution, LoadHistory};
    use crate::linalg::gauss;

    /// ∫ f from `low` to `high`, with square-root singularities at both ends.
    fn singular_integral(low: f64, high: f64, f: &dyn Fn(f64) -> [f64; 7]) -> [f64; 7] {
        let rule = gauss::largest_rule();
        let mut sum = [0.0; 7];
        let piece_count = 12;
        for k in 0..piece_count {
            let a = f64::from(k) / f64::from(piece_count);
            let b = f64::from(k + 1) / f64::from(piece_count);
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
    fn integrals_by_quadrature(soil: Soil, ends: [f64; 2], h: f64, time: f64) -> [f64; 7] {
        let plane = FullPlane::new(soil);
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
            let piece_integral = singular_integral(pair[0], pair[1], &|s| {
                let u = plane.displacement([s, h], time, LoadHistory::Step).unwrap();
                let t = plane.traction([s, h], [0.0, 1.0], time, LoadHistory::Step).unwrap();
                [u[0][0], u[0][1], u[1][1], t[0][0], t[0][1], t[1][0], t[1][1]]
            });
            sum.iter_mut().zip(piece_integral).for_each(|(a, b)| *a += b);
        }
        sum
    }

    #[test]
    fn closed_forms_match_quadrature() {
        for poisson in [-0.3, 0.0, 0.25, 1.0 / 3.0, 0.48] {
            let soil = Soil::new(2.0, poisson, 1.3).unwrap();
            let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
            let lame_ratio = 2.0 * poisson / (1.0 - 2.0 * poisson);
            let waves = WaveConstants { speeds, lame_ratio };
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
                    let integrals = step_integrals(&waves, ends, h, time);
                    let u = integrals.displacement.map(|v| v * unit);
                    let scale = unit * soil.shear_modulus();
                    let t = integrals.traction.map(|row| row.map(|v| scale * v));
                    let computed = [u[0], u[1], u[2], t[0][0], t[0][1], t[1][0], t[1][1]];
                    let expected = integrals_by_quadrature(soil, ends, h, time);
                    for k in 0..7 {
                        let magnitude = if k < 3 { 0.5 } else { 1.0 };
                        assert!(
                            (computed[k] - expected[k]).abs() < 1e-11 * magnitude,
                            "nu {poisson} ends {ends:?} h {h} t {time}: {k}: {} {}",
                            computed[k],
                            expected[k]
                        );
                    }
                }
            }
        }
    }
}
