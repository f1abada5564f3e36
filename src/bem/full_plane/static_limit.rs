//! Static limit of the boundary equation (Kelvin's solution).
//!
//! With time the functions of [`super::step_integrals`] tend to D = (c₂⁻²−c₁⁻²)/2, Q = c⁻², and
//! L₁ + L₂ to −(c₁⁻²+c₂⁻²) ln(r/L₀), L₀ a length that no static plane fixes.

use super::Boundary;
use super::pair_classes::PairClasses;
use crate::error::Result;
use crate::soil::Soil;

/// The primitives of displacement (dd, dn, nn; 1/2πρ) and traction (μ/2πρ) at one end.
fn primitive(square: [f64; 2], lame: f64, s: f64, h: f64, datum: f64) -> [f64; 7] {
    let r = s.hypot(h);
    let d = 0.5 * (square[1] - square[0]);
    let growth = -(square[0] + square[1]);
    let log = (r / datum).ln();
    let angle = if h == 0.0 { 0.0 } else { (s / h).atan() };
    let logs = s * log - s + h * angle;
    let middle = 0.5 * (growth * logs - d * s);
    let dd = middle + d * (s - h * angle);
    let nn = middle + d * h * angle;
    let dn = d * h * log;
    // ∫ h/r², s/r², s h²/r⁴, h³/r⁴; D and Q are constants.
    let one = angle;
    let two = log;
    let three = -0.5 * (h / r).powi(2);
    let four = 0.5 * (h * s / (r * r) + angle);
    let bend = 8.0 * d + 2.0 * (square[0] - square[1]);
    let across = 2.0 * d * two - bend * three;
    [
        dd,
        dn,
        nn,
        (2.0 * d - square[1]) * one - bend * (one - four),
        across - square[1] * two,
        across - lame * square[0] * two,
        (6.0 * d - 2.0 * square[1] - lame * square[0]) * one - bend * four,
    ]
}

/// Static displacements of the contact elements per unit traction on them.
///
/// A 2Q × 2Q matrix in the order of contact vectors; all other elements are free.
pub(super) fn static_compliance(
    soil: Soil,
    boundary: &Boundary,
    datum: f64,
    matrix: &mut [f64],
) -> Result<()> {
    let segments = boundary.segments();
    let layout = boundary.layout();
    let square = [soil.pressure_wave_speed(), soil.shear_wave_speed()].map(|c| 1.0 / (c * c));
    let lame = 2.0 * soil.poisson() / (1.0 - 2.0 * soil.poisson());
    let unit = 1.0 / (2.0 * std::f64::consts::PI * soil.density());
    let mut g = vec![0.0; layout.square()];
    let mut h = vec![0.0; layout.square()];
    PairClasses::new(segments).fill(segments, &mut g, &mut h, 0.5, |ends, height| {
        let [low, high] = ends.map(|s| primitive(square, lame, s, height, datum));
        let at = |k: usize| unit * (high[k] - low[k]);
        let mu = soil.shear_modulus();
        [[[at(0), at(1)], [at(1), at(2)]], [[mu * at(3), mu * at(5)], [mu * at(4), mu * at(6)]]]
    });
    let (_, mobility) = boundary.mobility(&g, &h)?;
    boundary.compliance(&mobility, matrix);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::full_plane::step_integrals::{Medium, step_integrals};

    /// Response to a load that was switched on long ago, without its growth in time.
    #[test]
    fn a_held_load_tends_to_the_static_limit() {
        let soil = Soil::new(1.0, 0.2, 1.0).unwrap();
        let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
        let square = speeds.map(|c| 1.0 / (c * c));
        let medium = Medium { speeds, lame: 0.4 / 0.6 };
        for (ends, h) in [([0.3, 1.1], 0.0), ([-0.4, 0.9], 0.6), ([1.0, 2.0], -0.5)] {
            let [low, high] = ends.map(|s| primitive(square, medium.lame, s, h, 1.0));
            let late = step_integrals(&medium, ends, h, 1e4);
            let t = late.traction.as_flattened();
            let [dd, dn, nn] = late.displacement;
            // ½ Σ c⁻² ln(2 c t) of each displacement.
            let growth: f64 = (0..2).map(|k| 0.5 * square[k] * (2e4 * speeds[k]).ln()).sum();
            let rise = growth * (ends[1] - ends[0]);
            let found = [dd - rise, dn, nn - rise, t[0], t[1], t[2], t[3]];
            for k in 0..7 {
                let wanted = high[k] - low[k];
                assert!((found[k] - wanted).abs() < 2e-7, "{ends:?} {k}: {} {wanted}", found[k]);
            }
        }
    }
}
