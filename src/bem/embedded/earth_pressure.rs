//! Earth pressure on the faces of a trench.
//!
//! At rest, and the limits by the strength of the soil. Below a water table pressures are effective: the soil weighs less by
//! the water that it displaces.

use super::soil::TrenchSoil;
use crate::error::{Result, require};
use crate::interface::EarthPressure;
use crate::soil::{Soil, SoilStrength, WaterTable};

/// Difference of pressures that counts as rounding, relative to the pressure.
const PRESSURE_TOLERANCE_FACTOR: f64 = 1e-9;

/// Soil around a trench, and the water table in it.
#[derive(Clone, Copy)]
pub(super) struct SoilAndWater<'a> {
    pub(super) soil: &'a TrenchSoil,
    pub(super) water: Option<WaterTable>,
}

/// Layer of a soil beside the walls, above or below the water table.
struct WallLayer {
    /// Index of the soil in the profile; 0 for backfill.
    soil_index: usize,
    soil: Soil,
    /// Density, below the water table less that of the water, kg/m³.
    density: f64,
    /// Depth of the lower end, m.
    bottom: f64,
}

impl SoilAndWater<'_> {
    /// Layers beside the walls, from the surface down.
    fn wall_layers(&self) -> Vec<WallLayer> {
        let soils: Vec<(Soil, f64)> = match self.soil.backfill_soil() {
            Some(fill) => vec![(fill, f64::INFINITY)],
            None => self.soil.profile().soils_to().collect(),
        };
        let mut layers = vec![];
        let mut top = 0.0;
        for (soil_index, (soil, bottom)) in soils.into_iter().enumerate() {
            let density = soil.density();
            match self.water {
                Some(water) if water.depth() < bottom => {
                    if water.depth() > top {
                        layers.push(WallLayer { soil_index, soil, density, bottom: water.depth() });
                    }
                    let density = density - water.density();
                    layers.push(WallLayer { soil_index, soil, density, bottom });
                }
                _ => layers.push(WallLayer { soil_index, soil, density, bottom }),
            }
            top = bottom;
        }
        layers
    }
}

/// One soil beside an element of a wall, over a height.
struct SoilPiece {
    /// Index of the soil in the profile; 0 for backfill.
    soil_index: usize,
    soil: Soil,
    /// Density, as in [`WallLayer`], kg/m³.
    density: f64,
    /// Height, m.
    height: f64,
    /// Depth of the middle of the piece, m.
    middle_depth: f64,
    /// Mass of the soil above the middle of the piece, kg/m².
    mass_above: f64,
}

impl SoilPiece {
    /// Pressure at rest over the vertical pressure: `k0`, or ν/(1 − ν).
    fn ratio_at_rest(&self, k0: Option<f64>) -> f64 {
        k0.unwrap_or(self.soil.poisson() / (1.0 - self.soil.poisson()))
    }

    /// Mass of the soil above both ends of the piece, upper end first, kg/m².
    fn masses_at_ends(&self) -> [f64; 2] {
        let half_mass = 0.5 * self.height * self.density;
        [self.mass_above - half_mass, self.mass_above + half_mass]
    }
}

/// Pieces of soil beside each element of a wall, from the surface down.
fn wall_pieces(ground: SoilAndWater<'_>) -> Vec<Vec<SoilPiece>> {
    let layers = ground.wall_layers();
    let elements = ground.soil.elements().wall_ends().windows(2);
    elements.map(|ends| element_pieces(&layers, ends[0], ends[1])).collect()
}

/// Pieces of soil beside an element between two depths.
fn element_pieces(layers: &[WallLayer], upper_end: f64, lower_end: f64) -> Vec<SoilPiece> {
    let mut mass_above_layer = 0.0;
    let mut layer_top = 0.0;
    let mut pieces = vec![];
    for &WallLayer { soil_index, soil, density, bottom: layer_bottom } in layers {
        let bottom = layer_bottom.min(lower_end);
        let top = upper_end.clamp(layer_top, bottom.max(layer_top));
        let height = (bottom - top).max(0.0);
        let middle_depth = top + 0.5 * height;
        let mass_above = mass_above_layer + density * (top - layer_top + 0.5 * height);
        if height > 0.0 {
            pieces.push(SoilPiece { soil_index, soil, density, height, middle_depth, mass_above });
        }
        mass_above_layer += density * (bottom - layer_top).max(0.0);
        layer_top = bottom.max(layer_top);
    }
    pieces
}

/// Values of all elements along the outline: left wall, base, right wall.
fn outline_values(soil: &TrenchSoil, wall_values: &[f64], base_value: f64) -> Vec<f64> {
    let base_count = 2 * (soil.elements().base_ends().len() - 1);
    let base_values = std::iter::repeat_n(base_value, base_count);
    let left_wall = wall_values.iter().copied();
    left_wall.clone().chain(base_values).chain(left_wall.rev()).collect()
}

/// Mean of a quantity over the height of each wall element.
///
/// `integral`: of the quantity over the height of a piece.
fn element_means(ground: SoilAndWater<'_>, integral: impl Fn(&SoilPiece) -> f64) -> Vec<f64> {
    let mut means = vec![];
    let elements = ground.soil.elements().wall_ends().windows(2);
    for (pieces, ends) in wall_pieces(ground).iter().zip(elements) {
        means.push(pieces.iter().map(&integral).sum::<f64>() / (ends[1] - ends[0]));
    }
    means
}

/// Pressure at rest on each element, divided by gravity, kg/m².
///
/// The elements are in the order of the outline.
///
/// The pressure on the base is the weight of all soil above it. `k0`: K₀ of all soils; `None`: ν/(1 − ν) of each soil.
pub(super) fn pressures_at_rest(ground: SoilAndWater<'_>, k0: Option<f64>) -> Vec<f64> {
    let wall_pressures =
        element_means(ground, |piece| piece.ratio_at_rest(k0) * piece.height * piece.mass_above);
    outline_values(ground.soil, &wall_pressures, mass_above_base(ground))
}

/// Mass of the soil above the base less that of the water, kg/m².
fn mass_above_base(SoilAndWater { soil, water }: SoilAndWater<'_>) -> f64 {
    let depth = soil.elements().trench().depth();
    let profile_above = soil.profile().above(depth);
    let layers = profile_above.layers().iter();
    let soil_mass: f64 = layers.map(|layer| layer.soil.density() * layer.thickness).sum();
    soil_mass - water.map_or(0.0, |water| water.mass_above(depth))
}

/// Mean mass of the soil above each element, kg/m².
///
/// The elements are in the order of the outline.
pub(super) fn masses_above(ground: SoilAndWater<'_>) -> Vec<f64> {
    let wall_masses = element_means(ground, |piece| piece.height * piece.mass_above);
    outline_values(ground.soil, &wall_masses, mass_above_base(ground))
}

/// Depth of the resultant at rest below the middle of each element, m.
///
/// The elements are in the order of the outline.
pub(super) fn resultant_depths(ground: SoilAndWater<'_>, k0: Option<f64>) -> Vec<f64> {
    let mut distances = vec![];
    let elements = ground.soil.elements().wall_ends().windows(2);
    for (pieces, ends) in wall_pieces(ground).iter().zip(elements) {
        let middle = 0.5 * (ends[0] + ends[1]);
        let mut moment = 0.0;
        let mut thrust = 0.0;
        for piece in pieces {
            let ratio = piece.ratio_at_rest(k0);
            let piece_thrust = ratio * piece.height * piece.mass_above;
            // Mass grows linearly over the piece.
            let moment_about_middle = ratio * piece.density * piece.height.powi(3) / 12.0;
            moment += piece_thrust * (piece.middle_depth - middle) + moment_about_middle;
            thrust += piece_thrust;
        }
        distances.push(if thrust > 0.0 { moment / thrust } else { 0.0 });
    }
    outline_values(ground.soil, &distances, 0.0)
}

/// Mean of the positive part of a quantity that is linear between two ends.
fn mean_of_positive_part(end_values: [f64; 2]) -> f64 {
    let min_value = end_values[0].min(end_values[1]);
    let max_value = end_values[0].max(end_values[1]);
    if min_value >= 0.0 {
        0.5 * (min_value + max_value)
    } else if max_value <= 0.0 {
        0.0
    } else {
        0.5 * max_value * max_value / (max_value - min_value)
    }
}

/// Laws of the elements of a wall, from the surface down.
///
/// Their limits are means of the limits of the soils beside an element.
/// `strengths`: one for all soils, or one each. `k0`: as for [`pressures_at_rest`].
pub(super) fn wall_laws(
    ground: SoilAndWater<'_>,
    strengths: &[SoilStrength],
    gravity: f64,
    k0: Option<f64>,
) -> Result<Vec<EarthPressure>> {
    let strength = |piece: &SoilPiece| {
        if strengths.len() == 1 { strengths[0] } else { strengths[piece.soil_index] }
    };
    // Active and passive limit of the thrust of a piece. Where the active pressure would be below zero, the soil stands
    // without the wall.
    let thrust_limits = |piece: &SoilPiece| {
        let end_pressures =
            piece.masses_at_ends().map(|mass| strength(piece).pressures(gravity * mass));
        [0, 1].map(|limit| {
            let end_values = end_pressures.map(|pressures| pressures[limit]);
            piece.height * mean_of_positive_part(end_values)
        })
    };
    let active = element_means(ground, |piece| thrust_limits(piece)[0]);
    let passive = element_means(ground, |piece| thrust_limits(piece)[1]);
    let friction = element_means(ground, |piece| piece.height * strength(piece).wall_friction());
    let pressure_at_rest = element_means(ground, |piece| {
        gravity * piece.ratio_at_rest(k0) * piece.height * piece.mass_above
    });
    let mut laws = Vec::with_capacity(active.len());
    for element in 0..active.len() {
        let limits = active[element] * (1.0 - PRESSURE_TOLERANCE_FACTOR)
            ..=passive[element] * (1.0 + PRESSURE_TOLERANCE_FACTOR);
        let is_between_limits = limits.contains(&pressure_at_rest[element]);
        let needed = "between active and passive pressure: see `with_pressure_at_rest`";
        let law = require("pressure at rest", pressure_at_rest[element], is_between_limits, needed)
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

    /// Thrust ∫K₀ m dz by hand: a layer of 2 m with ρ = 1000, over ρ = 2000.
    #[test]
    fn thrust_of_two_layers() {
        let upper = Soil::from_shear_wave_speed(200.0, 0.25, 1000.0).unwrap();
        let lower = Soil::from_shear_wave_speed(200.0, 0.25, 2000.0).unwrap();
        let profile = SoilProfile::on_half_plane(lower).with_layer(upper, 2.0).unwrap();
        let elements = Trench::new(-3.0..3.0, 5.0).unwrap().elements(4, 3).unwrap();
        let lengths: Vec<f64> = elements.elements().iter().map(ContactElement::length).collect();
        let soil = TrenchSoil::new(profile, elements).unwrap();
        for (k0, ratio) in [(None, 1.0 / 3.0), (Some(0.5), 0.5)] {
            let pressures = pressures_at_rest(SoilAndWater { soil: &soil, water: None }, k0);
            assert_eq!(pressures.len(), 10);
            assert_eq!(pressures[3..7], [8000.0; 4]);
            for wall in [0..3, 7..10] {
                let thrust: f64 = wall.map(|e| pressures[e] * lengths[e]).sum();
                // 1000 · 2²/2 + 2000 · 3 + 2000 · 3²/2.
                assert!((thrust - ratio * 17_000.0).abs() < 1e-8, "{thrust}");
            }
            assert!((pressures[0] - pressures[9]).abs() < 1e-12 * pressures[0]);
        }
    }

    /// Effective thrust by hand: as above, with water from 1 m down.
    #[test]
    fn thrust_under_water() {
        let upper = Soil::from_shear_wave_speed(200.0, 0.25, 1600.0).unwrap();
        let lower = Soil::from_shear_wave_speed(200.0, 0.25, 2000.0).unwrap();
        let profile = SoilProfile::on_half_plane(lower).with_layer(upper, 2.0).unwrap();
        let elements = Trench::new(-3.0..3.0, 5.0).unwrap().elements(4, 3).unwrap();
        let lengths: Vec<f64> = elements.elements().iter().map(ContactElement::length).collect();
        let soil = TrenchSoil::new(profile, elements).unwrap();
        let water = Some(WaterTable::at_depth(1.0).unwrap());
        let ground = SoilAndWater { soil: &soil, water };
        let pressures = pressures_at_rest(ground, Some(0.5));
        // σ'/g: 1600 at 1 m, then 600 a metre to 2200 at 2 m, then 1000 a metre to 5200 at 5 m.
        assert_eq!(pressures[3..7], [5200.0; 4]);
        let thrust: f64 = (0..3).map(|e| pressures[e] * lengths[e]).sum();
        assert!((thrust - 0.5 * (800.0 + 1900.0 + 3.0 * 3700.0)).abs() < 1e-8, "{thrust}");
        let depths = resultant_depths(ground, Some(0.5));
        let elements = soil.elements().elements();
        let moment: f64 = (0..3)
            .map(|e| pressures[e] * lengths[e] * (depths[e] - elements[e].center()[2]))
            .sum();
        // Thrust times depth of the triangle, and of rectangle and triangle below it, twice.
        let expected =
            800.0 * 2.0 / 3.0 + 1600.0 * 1.5 + 300.0 * 5.0 / 3.0 + 6600.0 * 3.5 + 4500.0 * 4.0;
        assert!((moment - 0.5 * expected).abs() < 1e-8, "{moment} {expected}");
        let active =
            wall_laws(ground, &[SoilStrength::new(0.5).unwrap()], 10.0, Some(0.5)).unwrap();
        let ratio = SoilStrength::new(0.5).unwrap().pressure_ratios()[0];
        for (law, pressure) in active.iter().zip(&pressures) {
            assert!((law.pressures()[0] / (10.0 * ratio * pressure / 0.5) - 1.0).abs() < 1e-12);
        }
    }
}
