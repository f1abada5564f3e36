//! Pressure of the soil at rest on the faces of a trench.

use super::soil::TrenchSoil;
use crate::soil::Soil;

/// Pressure at rest on each element over gravity, kg/m², in the order of the outline.
///
/// The base has all of the soil above it. `ratio`: K₀ of all soils; `None`: each soil has its own ν/(1 − ν).
pub(super) fn at_rest(soil: &TrenchSoil, ratio: Option<f64>) -> Vec<f64> {
    let layers: Vec<(Soil, f64)> = match soil.fill() {
        Some(fill) => vec![(fill, f64::INFINITY)],
        None => soil.profile().soils_to().collect(),
    };
    let wall: Vec<f64> = soil
        .elements()
        .wall()
        .windows(2)
        .map(|ends| {
            let (mut above, mut top, mut sum) = (0.0, 0.0, 0.0);
            for (own, bottom) in &layers {
                let bottom = bottom.min(ends[1]);
                let ratio = ratio.unwrap_or(own.poisson() / (1.0 - own.poisson()));
                // The part of the layer beside the element: mass above its middle.
                let from = ends[0].clamp(top, bottom.max(top));
                let height = (bottom - from).max(0.0);
                let middle = above + own.density() * (from - top + 0.5 * height);
                sum += ratio * height * middle;
                above += own.density() * (bottom - top).max(0.0);
                top = bottom.max(top);
            }
            sum / (ends[1] - ends[0])
        })
        .collect();
    let depth = soil.elements().trench().depth();
    let above = soil.profile().above(depth);
    let weight: f64 = above.layers().iter().map(|own| own.soil.density() * own.thickness).sum();
    let base = std::iter::repeat_n(weight, 2 * (soil.elements().base().len() - 1));
    wall.iter().copied().chain(base).chain(wall.iter().rev().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::ContactElement;
    use crate::bem::embedded::Trench;
    use crate::soil::SoilProfile;

    /// Two layers of 2 m and more, ρ = 1000 and 2000: the thrust by hand, ∫K₀ m dz.
    #[test]
    fn thrust_of_two_layers() {
        let soil = |density| Soil::from_shear_wave_speed(200.0, 0.25, density).unwrap();
        let profile =
            SoilProfile::on_half_plane(soil(2000.0)).with_layer(soil(1000.0), 2.0).unwrap();
        let elements = Trench::new(-3.0..3.0, 5.0).unwrap().elements(4, 3).unwrap();
        let lengths: Vec<f64> = elements.elements().iter().map(ContactElement::length).collect();
        let soil = TrenchSoil::new(profile, elements).unwrap();
        for (ratio, k) in [(None, 1.0 / 3.0), (Some(0.5), 0.5)] {
            let pressures = at_rest(&soil, ratio);
            assert_eq!(pressures.len(), 10);
            assert_eq!(pressures[3..7], [8000.0; 4]);
            for wall in [0..3, 7..10] {
                let thrust: f64 = wall.map(|e| pressures[e] * lengths[e]).sum();
                // 1000 · 2²/2 + 2000 · 3 + 2000 · 3²/2.
                assert!((thrust - k * 17_000.0).abs() < 1e-8, "{thrust}");
            }
            assert!((pressures[0] - pressures[9]).abs() < 1e-12 * pressures[0]);
        }
    }
}
