//! Picture of push-overs: load over displacement.

use super::drawing::is_drawable;
use super::lines::Curve;
use super::paths::PathChart;
use super::svg::Svg;
use crate::analyses::PushOver;
use crate::error::{Result, at_least, require};

/// Unit of a load factor that is a force, in N.
const FORCE_FACTOR: f64 = 1e-3;
/// Name of the uplift in the key.
const UPLIFT_NAME: &str = "uplift begins";

/// Load over displacement of one or more push-overs, with the point at which the foundation begins to lift off.
///
/// `curves` have names. The load is in thousands of the unit of its factor (kN for a force), the displacement in m or rad,
/// as the controlled degree of freedom. A mark on each curve that lifts off shows its first point with open elements.
///
/// ```
/// use basemat::analyses::push_over_by_displacement;
/// use basemat::bem::SpringGround;
/// use basemat::interface::Coulomb;
/// use basemat::structure::RigidBlock;
/// use basemat::{Simulation, plot};
///
/// let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
/// let top = block.horizontal_at(6.0);
/// let builder = Simulation::builder(0.01)
///     .ground(SpringGround::under(&block, 16, 4e7, 3e7)?)
///     .structure(block)
///     .interface(Coulomb::new(0.7)?);
/// let curve = push_over_by_displacement(builder, &top, &top, &[0.01, 0.03, 0.1, 0.3])?;
/// let picture = plot::push_over("Block", &[("pushed at its top", &curve)])?;
/// for text in ["displacement, m or rad", "load factor / 1000", "pushed at its top", "uplift begins"] {
///     assert!(picture.as_str().contains(text));
/// }
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without a curve; [`Error::Item`](crate::Error::Item) names the curve that has no point,
/// or a point that cannot be drawn.
pub fn push_over(title: &str, curves: &[(&str, &PushOver)]) -> Result<Svg> {
    at_least("push-overs of a picture", curves.len(), 1)?;
    let mut paths = Vec::with_capacity(curves.len());
    let mut uplift = Curve { name: UPLIFT_NAME.to_owned(), points: Vec::new() };
    for (name, curve) in curves {
        let points =
            drawn_points(curve).map_err(|error| error.within(format!("push-over {name:?}")))?;
        let is_closed = curve.points[0].uplifted_fraction == 0.0;
        let first_open = curve.points.iter().position(|point| point.uplifted_fraction > 0.0);
        uplift.points.extend(first_open.filter(|_| is_closed).map(|index| points[index]));
        paths.push(Curve { name: (*name).to_owned(), points });
    }
    let measured_points = if uplift.points.is_empty() { Vec::new() } else { vec![uplift] };
    let chart = PathChart {
        paths,
        measured_points,
        x_description: "displacement, m or rad".to_owned(),
        y_description: "load factor / 1000".to_owned(),
        is_downward: false,
    };
    chart.picture(title)
}

/// Displacements and loads of a curve in the units of the picture.
fn drawn_points(curve: &PushOver) -> Result<Vec<(f64, f64)>> {
    at_least("points of a push-over", curve.points.len(), 1)?;
    let needed = "finite, and below 1e57 in magnitude";
    let mut points = Vec::with_capacity(curve.points.len());
    for point in &curve.points {
        let force = FORCE_FACTOR * point.force;
        require("displacement", point.displacement, is_drawable(point.displacement), needed)?;
        require("load factor", point.force, is_drawable(force), needed)?;
        points.push((point.displacement, force));
    }
    Ok(points)
}
