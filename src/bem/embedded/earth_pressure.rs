//! Pressure of the soil on the faces of a trench: at rest, and the limits of its strength.

use super::soil::TrenchSoil;
use crate::error::{Result, require};
use crate::interface::EarthPressure;
use crate::soil::{Soil, SoilStrength};

/// Difference of pressures that counts as rounding, relative to the pressure.
const PRESSURE_TOLERANCE_FACTOR: f64 = 1e-9;

/// One soil beside an element of a wall, over a height.
struct SoilPiece {
    /// Place of the soil in the profile; of backfill, 0.
    place: usize,
    soil: Soil,
    height: f64,
    /// Depth of its middle, m.
    middle: f64,
    /// Mass of the soil above its middle, kg/m².
    mass_above: f64,
}

impl SoilPiece {
    /// Pressure at rest over the pressure of the soil above.
    fn ratio_at_rest(&self, ratio: Option<f64>) -> f64 {
        ratio.unwrap_or(self.soil.poisson() / (1.0 - self.soil.poisson()))
    }

    /// Mass of the soil above the upper and the lower end, kg/m².
    fn masses_at_ends(&self) -> [f64; 2] {
        let half_mass = 0.5 * self.height * self.soil.density();
        [self.mass_above - half_mass, self.mass_above + half_mass]
    }
}

/// The soils beside each element of a wall, from the surface down.
fn soils_beside_wall(soil: &TrenchSoil) -> Vec<Vec<SoilPiece>> {
    let layers: Vec<(Soil, f64)> = match soil.fill() {
        Some(fill) => vec![(fill, f64::INFINITY)],
        None => soil.profile().soils_to().collect(),
    };
    let elements = soil.elements().wall().windows(2);
    elements.map(|ends| soils_beside_element(&layers, [ends[0], ends[1]])).collect()
}

/// The soils between two depths, from `layers` with their lower ends.
fn soils_beside_element(layers: &[(Soil, f64)], ends: [f64; 2]) -> Vec<SoilPiece> {
    let mut mass_above_layer = 0.0;
    let mut top = 0.0;
    let mut pieces = vec![];
    for (place, (soil, bottom)) in layers.iter().enumerate() {
        let bottom = bottom.min(ends[1]);
        let start = ends[0].clamp(top, bottom.max(top));
        let height = (bottom - start).max(0.0);
        let middle = start + 0.5 * height;
        let mass_above = mass_above_layer + soil.density() * (start - top + 0.5 * height);
        if height > 0.0 {
            pieces.push(SoilPiece { place, soil: *soil, height, middle, mass_above });
        }
        mass_above_layer += soil.density() * (bottom - top).max(0.0);
        top = bottom.max(top);
    }
    pieces
}

/// Values of all elements along the outline, from the values of a wall's elements and the base.
fn along_outline(soil: &TrenchSoil, wall: &[f64], base: f64) -> Vec<f64> {
    let base = std::iter::repeat_n(base, 2 * (soil.elements().base().len() - 1));
    wall.iter().copied().chain(base).chain(wall.iter().rev().copied()).collect()
}

/// Mean over the height of each element of a wall, from the integral over each piece.
fn means(soil: &TrenchSoil, integral: impl Fn(&SoilPiece) -> f64) -> Vec<f64> {
    let mut means = vec![];
    for (pieces, ends) in soils_beside_wall(soil).iter().zip(soil.elements().wall().windows(2)) {
        means.push(pieces.iter().map(&integral).sum::<f64>() / (ends[1] - ends[0]));
    }
    means
}

/// Pressure at rest on each element over gravity, kg/m², in the order of the outline.
///
/// The base carries all of the soil above it. `ratio`: K₀ of all soils; `None`: ν/(1 − ν) of each soil.
pub(super) fn at_rest(soil: &TrenchSoil, ratio: Option<f64>) -> Vec<f64> {
    let wall = means(soil, |piece| piece.ratio_at_rest(ratio) * piece.height * piece.mass_above);
    along_outline(soil, &wall, mass_above_base(soil))
}

/// Mass of the soil above the base, kg/m².
fn mass_above_base(soil: &TrenchSoil) -> f64 {
    let above = soil.profile().above(soil.elements().trench().depth());
    above.layers().iter().map(|layer| layer.soil.density() * layer.thickness).sum()
}

/// Mean mass of the soil above each element, kg/m², in the order of the outline.
pub(super) fn mass_above(soil: &TrenchSoil) -> Vec<f64> {
    let wall = means(soil, |piece| piece.height * piece.mass_above);
    along_outline(soil, &wall, mass_above_base(soil))
}

/// Distance (m) of the resultant at rest below the middle of each element, in the order of the outline.
pub(super) fn depth_below_middle(soil: &TrenchSoil, ratio: Option<f64>) -> Vec<f64> {
    let mut distances = vec![];
    for (pieces, ends) in soils_beside_wall(soil).iter().zip(soil.elements().wall().windows(2)) {
        let middle = 0.5 * (ends[0] + ends[1]);
        let mut moment = 0.0;
        let mut thrust = 0.0;
        for piece in pieces {
            let ratio = piece.ratio_at_rest(ratio);
            let piece_thrust = ratio * piece.height * piece.mass_above;
            // Mass grows linearly over the piece.
            let moment_about_middle = ratio * piece.soil.density() * piece.height.powi(3) / 12.0;
            moment += piece_thrust * (piece.middle - middle) + moment_about_middle;
            thrust += piece_thrust;
        }
        distances.push(if thrust > 0.0 { moment / thrust } else { 0.0 });
    }
    along_outline(soil, &distances, 0.0)
}

/// Mean of a quantity above zero that is linear between two ends.
fn mean_above_zero([one, other]: [f64; 2]) -> f64 {
    let low = one.min(other);
    let high = one.max(other);
    if low >= 0.0 {
        0.5 * (low + high)
    } else if high <= 0.0 {
        0.0
    } else {
        0.5 * high * high / (high - low)
    }
}

/// Law of each element of a wall, from the surface down: means of the limits of the soils beside it.
///
/// `strengths`: one for all soils, or one each. `ratio`: as for [`at_rest`].
pub(super) fn laws(
    soil: &TrenchSoil,
    strengths: &[SoilStrength],
    gravity: f64,
    ratio: Option<f64>,
) -> Result<Vec<EarthPressure>> {
    let strength = |piece: &SoilPiece| {
        if strengths.len() == 1 { strengths[0] } else { strengths[piece.place] }
    };
    // Active and passive limit of the thrust of a piece. Where the active pressure would be below zero, the soil stands
    // without the wall.
    let limits = |piece: &SoilPiece| {
        let at_ends = piece.masses_at_ends().map(|mass| strength(piece).pressures(gravity * mass));
        [0, 1].map(|limit| piece.height * mean_above_zero(at_ends.map(|limits| limits[limit])))
    };
    let active = means(soil, |piece| limits(piece)[0]);
    let passive = means(soil, |piece| limits(piece)[1]);
    let friction = means(soil, |piece| piece.height * strength(piece).wall_friction());
    let at_rest =
        means(soil, |piece| gravity * piece.ratio_at_rest(ratio) * piece.height * piece.mass_above);
    let mut laws = Vec::with_capacity(active.len());
    for element in 0..active.len() {
        let bounds = active[element] * (1.0 - PRESSURE_TOLERANCE_FACTOR)
            ..=passive[element] * (1.0 + PRESSURE_TOLERANCE_FACTOR);
        let fits = bounds.contains(&at_rest[element]);
        let needed = "between active and passive pressure: see `with_pressure_at_rest`";
        let law = require("pressure at rest", at_rest[element], fits, needed)
            .and_then(|_| EarthPressure::new(active[element], passive[element], friction[element]));
        laws.push(law.map_err(|error| error.within(format!("wall element {element}")))?);
    }
    Ok(laws)
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
        let upper = Soil::from_shear_wave_speed(200.0, 0.25, 1000.0).unwrap();
        let lower = Soil::from_shear_wave_speed(200.0, 0.25, 2000.0).unwrap();
        let profile = SoilProfile::on_half_plane(lower).with_layer(upper, 2.0).unwrap();
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
