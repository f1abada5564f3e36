//! Static limit of the boundary equation, by Kelvin's solution.
//!
//! As t → ∞, the functions D and Q of [`step_integrals`](super::step_integrals) tend to (c₂⁻²−c₁⁻²)/2 and c⁻². L₁ + L₂
//! tends to −(c₁⁻²+c₂⁻²) ln(r/L₀) plus a term that grows with ln t and is the same everywhere. The static problem
//! therefore does not determine the length L₀.
//!
//! s, h, r and the directions d and n are those of `step_integrals`; c₁ and c₂ are the speeds of pressure and shear
//! waves.

use super::Boundary;
use super::pair_classes::SegmentPairClasses;
use crate::error::Result;
use crate::soil::Soil;

/// Primitives of displacement (dd, dn, nn) and traction (dd, dn, nd, nn) at one end of an element.
///
/// Displacements are in units of 1/2πρ, tractions in units of μ/2πρ. `slowness_squared`: c₁⁻² and c₂⁻².
/// `lame_ratio`: λ/μ. `s`, `h`: coordinates of the end from the load, along and normal to the element, m.
/// `reference_length`: L₀.
fn primitive(
    slowness_squared: [f64; 2],
    lame_ratio: f64,
    s: f64,
    h: f64,
    reference_length: f64,
) -> [f64; 7] {
    let r = s.hypot(h);
    // The static D.
    let dyadic_limit = 0.5 * (slowness_squared[1] - slowness_squared[0]);
    let log_factor = -(slowness_squared[0] + slowness_squared[1]);
    let logarithm = (r / reference_length).ln();
    let angle = if h == 0.0 { 0.0 } else { (s / h).atan() };
    let logarithm_integral = s * logarithm - s + h * angle;
    let isotropic_part = 0.5 * (log_factor * logarithm_integral - dyadic_limit * s);
    let dd = isotropic_part + dyadic_limit * (s - h * angle);
    let nn = isotropic_part + dyadic_limit * h * angle;
    let dn = dyadic_limit * h * logarithm;
    // Integrals over s of h/r², s/r², s h²/r⁴ and h³/r⁴: with constant D and Q the tractions consist of them.
    let integral_h_over_r2 = angle;
    let integral_s_over_r2 = logarithm;
    let integral_sh2_over_r4 = -0.5 * (h / r).powi(2);
    let integral_h3_over_r4 = 0.5 * (h * s / (r * r) + angle);
    let dyadic_factor = 8.0 * dyadic_limit + 2.0 * (slowness_squared[0] - slowness_squared[1]);
    let shear_part = 2.0 * dyadic_limit * integral_s_over_r2 - dyadic_factor * integral_sh2_over_r4;
    [
        dd,
        dn,
        nn,
        (2.0 * dyadic_limit - slowness_squared[1]) * integral_h_over_r2
            - dyadic_factor * (integral_h_over_r2 - integral_h3_over_r4),
        shear_part - slowness_squared[1] * integral_s_over_r2,
        shear_part - lame_ratio * slowness_squared[0] * integral_s_over_r2,
        (6.0 * dyadic_limit - 2.0 * slowness_squared[1] - lame_ratio * slowness_squared[0])
            * integral_h_over_r2
            - dyadic_factor * integral_h3_over_r4,
    ]
}

/// Static displacements of the contact elements per unit traction on them.
///
/// Overwrites `matrix`: row-major, with two rows for each contact element, in the order of contact vectors. All other
/// elements are free of traction.
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
    let displacement_unit = 1.0 / (2.0 * std::f64::consts::PI * soil.density());
    let mut g = vec![0.0; layout.matrix_len()];
    let mut h = vec![0.0; layout.matrix_len()];
    SegmentPairClasses::new(segments).fill(segments, &mut g, &mut h, 0.5, |view| {
        let end_values = view
            .ends
            .map(|s| primitive(slowness_squared, lame_ratio, s, view.height, reference_length));
        let mut integrals = [0.0; 7];
        for (k, integral) in integrals.iter_mut().enumerate() {
            *integral = displacement_unit * (end_values[1][k] - end_values[0][k]);
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
            let late_integrals = step_integrals(&waves, ends, h, 1e4);
            let tractions = late_integrals.traction.as_flattened();
            let [dd, dn, nn] = late_integrals.displacement;
            // ½ Σ c⁻² ln(2 c t) of each displacement.
            let growth: f64 =
                (0..2).map(|k| 0.5 * slowness_squared[k] * (2e4 * speeds[k]).ln()).sum();
            let growth_integral = growth * (ends[1] - ends[0]);
            let displacements = [dd - growth_integral, dn, nn - growth_integral];
            let computed: Vec<f64> = displacements.iter().chain(tractions).copied().collect();
            for k in 0..7 {
                let expected = end_values[1][k] - end_values[0][k];
                let value = computed[k];
                assert!((value - expected).abs() < 2e-7, "{ends:?} {k}: {value} {expected}");
            }
        }
    }
}
