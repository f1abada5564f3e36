//! Static limit of the boundary equation, by Kelvin's solution.
//!
//! With time the functions of [`super::step_integrals`] tend to D = (c₂⁻²−c₁⁻²)/2, Q = c⁻², and
//! L₁ + L₂ to −(c₁⁻²+c₂⁻²) ln(r/L₀). The static plane does not determine the length L₀.

use super::Boundary;
use super::pair_classes::SegmentPairClasses;
use crate::error::Result;
use crate::soil::Soil;

/// Primitives of displacement (dd, dn, nn) and traction (dd, dn, nd, nn) at one end of an element.
///
/// Displacements are in units of 1/2πρ, tractions in units of μ/2πρ. `slowness_squared` is c₁⁻² and c₂⁻²,
/// `reference_length` is L₀.
fn primitive(
    slowness_squared: [f64; 2],
    lame_ratio: f64,
    s: f64,
    h: f64,
    reference_length: f64,
) -> [f64; 7] {
    let r = s.hypot(h);
    let d = 0.5 * (slowness_squared[1] - slowness_squared[0]);
    let log_factor = -(slowness_squared[0] + slowness_squared[1]);
    let logarithm = (r / reference_length).ln();
    let angle = if h == 0.0 { 0.0 } else { (s / h).atan() };
    let logarithm_integral = s * logarithm - s + h * angle;
    let isotropic_part = 0.5 * (log_factor * logarithm_integral - d * s);
    let dd = isotropic_part + d * (s - h * angle);
    let nn = isotropic_part + d * h * angle;
    let dn = d * h * logarithm;
    // D and Q are constants, so these integrals give the tractions.
    let h_over_r2 = angle;
    let s_over_r2 = logarithm;
    let sh2_over_r4 = -0.5 * (h / r).powi(2);
    let h3_over_r4 = 0.5 * (h * s / (r * r) + angle);
    let dyadic_factor = 8.0 * d + 2.0 * (slowness_squared[0] - slowness_squared[1]);
    let shear_part = 2.0 * d * s_over_r2 - dyadic_factor * sh2_over_r4;
    [
        dd,
        dn,
        nn,
        (2.0 * d - slowness_squared[1]) * h_over_r2 - dyadic_factor * (h_over_r2 - h3_over_r4),
        shear_part - slowness_squared[1] * s_over_r2,
        shear_part - lame_ratio * slowness_squared[0] * s_over_r2,
        (6.0 * d - 2.0 * slowness_squared[1] - lame_ratio * slowness_squared[0]) * h_over_r2
            - dyadic_factor * h3_over_r4,
    ]
}

/// Static displacements of the contact elements per unit traction on them.
///
/// A 2Q × 2Q matrix in the order of contact vectors; all other elements are free.
pub(super) fn static_compliance(
    soil: Soil,
    boundary: &Boundary,
    reference_length: f64,
    matrix: &mut [f64],
) -> Result<()> {
    let segments = boundary.segments();
    let layout = boundary.layout();
    let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
    let slowness_squared = speeds.map(|c| 1.0 / (c * c));
    let lame_ratio = 2.0 * soil.poisson() / (1.0 - 2.0 * soil.poisson());
    let unit = 1.0 / (2.0 * std::f64::consts::PI * soil.density());
    let mut g = vec![0.0; layout.matrix_len()];
    let mut h = vec![0.0; layout.matrix_len()];
    SegmentPairClasses::new(segments).fill(segments, &mut g, &mut h, 0.5, |view| {
        let end_values = view
            .ends
            .map(|s| primitive(slowness_squared, lame_ratio, s, view.height, reference_length));
        let mut integrals = [0.0; 7];
        for (k, integral) in integrals.iter_mut().enumerate() {
            *integral = unit * (end_values[1][k] - end_values[0][k]);
        }
        let [dd, dn, nn, t_dd, t_dn, t_nd, t_nn] = integrals;
        let mu = soil.shear_modulus();
        [[[dd, dn], [dn, nn]], [[mu * t_dd, mu * t_nd], [mu * t_dn, mu * t_nn]]]
    });
    let contact_compliance = boundary.contact_compliance(&g, &h)?;
    boundary.compliance(&contact_compliance.columns, matrix);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::full_plane::step_integrals::{WaveConstants, step_integrals};

    /// The response long after a load was switched on, without its growth in time, is the static limit.
    #[test]
    fn a_constant_load_leads_to_the_static_limit() {
        let soil = Soil::new(1.0, 0.2, 1.0).unwrap();
        let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
        let slowness_squared = speeds.map(|c| 1.0 / (c * c));
        let waves = WaveConstants { speeds, lame_ratio: 0.4 / 0.6 };
        for (ends, h) in [([0.3, 1.1], 0.0), ([-0.4, 0.9], 0.6), ([1.0, 2.0], -0.5)] {
            let end_values = ends.map(|s| primitive(slowness_squared, waves.lame_ratio, s, h, 1.0));
            let late = step_integrals(&waves, ends, h, 1e4);
            let t = late.traction.as_flattened();
            let u = late.displacement;
            // ½ Σ c⁻² ln(2 c t) of each displacement.
            let growth: f64 =
                (0..2).map(|k| 0.5 * slowness_squared[k] * (2e4 * speeds[k]).ln()).sum();
            let growth_integral = growth * (ends[1] - ends[0]);
            let computed =
                [u[0] - growth_integral, u[1], u[2] - growth_integral, t[0], t[1], t[2], t[3]];
            for k in 0..7 {
                let expected = end_values[1][k] - end_values[0][k];
                let value = computed[k];
                assert!((value - expected).abs() < 2e-7, "{ends:?} {k}: {value} {expected}");
            }
        }
    }
}
