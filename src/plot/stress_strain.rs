//! Picture of stress–strain loops.

use super::drawing::is_drawable;
use super::lines::{Curve, with_unit};
use super::paths::PathChart;
use super::svg::Svg;
use crate::error::{Result, at_least, require};
use crate::text::readable_number::PrintedUnit;

/// Largest strain from which a chart is in per cent; smaller strains are in thousandths.
const MIN_PERCENT_STRAIN: f64 = 1e-3;
/// Unit of the shear stress.
const STRESS_UNIT: PrintedUnit<'static> = PrintedUnit { factor: 1e-3, symbol: "kPa" };

/// Shear stress over shear strain at points of a solid.
///
/// `points` have names and paths of [engineering shear strain, shear stress], in Pa, in the order of time. The axes are in
/// kPa and per cent; if no strain reaches 0.1 %, the strain is in 10⁻³.
///
/// ```
/// use basemat::plot;
///
/// let loop_of_sand = [[0.0, 0.0], [4e-3, 30e3], [3e-3, 5e3], [-4e-3, -30e3]];
/// let picture = plot::stress_strain("Sand", &[("3 m below the footing", &loop_of_sand)])?;
/// for text in ["shear strain, %", "shear stress, kPa", "3 m below the footing"] {
///     assert!(picture.as_str().contains(text));
/// }
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without a point of the solid. [`Error::Item`](crate::Error::Item) names the point
/// whose path is empty, or has a strain or stress that is not finite, or too large to be drawn.
pub fn stress_strain(title: &str, points: &[(&str, &[[f64; 2]])]) -> Result<Svg> {
    at_least("points of a solid", points.len(), 1)?;
    let mut max_strain = 0.0_f64;
    for (name, path) in points {
        let path_strain = checked_max_strain(path)
            .map_err(|error| error.within(format!("stress–strain path of {name:?}")))?;
        max_strain = max_strain.max(path_strain);
    }
    let strain_unit = strain_unit(max_strain);
    let mut paths = Vec::with_capacity(points.len());
    for (name, path) in points {
        let scaled_path = path
            .iter()
            .map(|[strain, stress]| (strain_unit.factor * strain, STRESS_UNIT.factor * stress));
        paths.push(Curve { name: (*name).to_owned(), points: scaled_path.collect() });
    }
    let chart = PathChart {
        paths,
        measured_points: Vec::new(),
        x_description: with_unit("shear strain", strain_unit.symbol),
        y_description: with_unit("shear stress", STRESS_UNIT.symbol),
        is_downward: false,
    };
    chart.picture(title)
}

/// Largest magnitude of the strains of a path.
///
/// Errors: an empty path, or a value that is not finite or too large to be drawn.
fn checked_max_strain(path: &[[f64; 2]]) -> Result<f64> {
    at_least("states of a point", path.len(), 1)?;
    let needed = "finite, and below 1e57 in magnitude";
    let mut max_strain = 0.0_f64;
    for &[strain, stress] in path {
        require("shear strain", strain, is_drawable(1e3 * strain), needed)?;
        require("shear stress", stress, is_drawable(1e3 * stress), needed)?;
        max_strain = max_strain.max(strain.abs());
    }
    Ok(max_strain)
}

/// Unit of a chart with strains of up to this magnitude.
fn strain_unit(max_strain: f64) -> PrintedUnit<'static> {
    if max_strain >= MIN_PERCENT_STRAIN {
        PrintedUnit { factor: 100.0, symbol: "%" }
    } else {
        PrintedUnit { factor: 1e3, symbol: "10⁻³" }
    }
}
