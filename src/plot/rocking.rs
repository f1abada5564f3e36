//! Pictures of rocking: moment and settlement over the rotation, beside measured points.

use super::lines::{Curve, with_unit};
use super::paths::PathChart;
use super::svg::Svg;
use crate::error::{Result, at_least, require_part};
use crate::results::{Quantity, Rocking};

/// Moment on the soil over the rotation of a foundation, for one or more runs, with measured points.
///
/// Axes are in mrad and kN·m/m, in plan kN·m. `runs` have names and the rocking of a foundation
/// ([`TimeSeries::rocking`](crate::results::TimeSeries::rocking)), of a whole run or of a part of it. Points of
/// `measured_points` are (rotation, moment) in rad and N·m/m, in plan N·m; each is drawn by itself.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without a run or without a point; [`Error::Scene`](crate::Error::Scene) for runs in
/// the plane and in plan together, whose units differ.
pub fn moment_rotation(
    title: &str,
    runs: &[(&str, Rocking<'_>)],
    measured_points: &[Curve],
) -> Result<Svg> {
    rocking_chart(runs, measured_points, Quantity::BaseMoment)?.picture(title)
}

/// Settlement over the rotation of a foundation, for one or more runs, with measured points.
///
/// Axes are in mrad and mm; settlement increases downwards. `runs` and `measured_points` as for [`moment_rotation`],
/// with points (rotation, settlement) in rad and m.
///
/// # Errors
/// As for [`moment_rotation`].
pub fn settlement_rotation(
    title: &str,
    runs: &[(&str, Rocking<'_>)],
    measured_points: &[Curve],
) -> Result<Svg> {
    rocking_chart(runs, measured_points, Quantity::Settlement)?.picture(title)
}

/// Chart of the moment over the rotation, or of the settlement if that is the `quantity`.
fn rocking_chart(
    runs: &[(&str, Rocking<'_>)],
    measured_points: &[Curve],
    quantity: Quantity,
) -> Result<PathChart> {
    at_least("runs of a picture", runs.len(), 1)?;
    let in_plan = runs[0].1.in_plan;
    let needed = "the same in all runs: in the plane it is per metre";
    let have_same_unit = runs.iter().all(|(_, rocking)| rocking.in_plan == in_plan);
    require_part("unit of a moment", have_same_unit, needed)?;
    let rotation_unit = Quantity::BaseRotation.printed_unit(in_plan);
    let value_unit = quantity.printed_unit(in_plan);
    let is_downward = quantity == Quantity::Settlement;
    let y_factor = if is_downward { -value_unit.factor } else { value_unit.factor };
    let scaled = |x: &f64, y: &f64| (rotation_unit.factor * x, y_factor * y);
    let mut paths = Vec::with_capacity(runs.len());
    for (name, rocking) in runs {
        let values = if is_downward { rocking.settlement } else { rocking.moment };
        let points = rocking.rotation.iter().zip(values).map(|(x, y)| scaled(x, y)).collect();
        paths.push(Curve { name: (*name).to_owned(), points });
    }
    let mut scaled_points = Vec::with_capacity(measured_points.len());
    for Curve { name, points } in measured_points {
        let points = points.iter().map(|(x, y)| scaled(x, y)).collect();
        scaled_points.push(Curve { name: name.clone(), points });
    }
    Ok(PathChart {
        paths,
        measured_points: scaled_points,
        x_description: with_unit(Quantity::BaseRotation.name(), rotation_unit.symbol),
        y_description: with_unit(quantity.name(), value_unit.symbol),
        is_downward,
    })
}
