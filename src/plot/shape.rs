//! The structure at some instants.

use plotters::prelude::*;

use super::axes::{Axis, chart, draw_curve, drawable};
use super::key::{Key, Sample};
use super::stroke::Stroke;
use super::svg::{Sheet, Svg};
use super::text::short;
use crate::error::{Error, Result, finite, positive};
use crate::results::{DeformedShape, MotionFrame, TimeSeries};

/// Places of the points, m: displacements relative to the free field, magnified.
pub(super) fn places(
    shape: &DeformedShape,
    frame: &MotionFrame<'_>,
    magnification: f64,
) -> Result<Vec<[f64; 2]>> {
    let moved = shape.displacements(frame.displacement)?;
    let place = |(point, u): (&crate::results::ShapePoint, [f64; 2])| {
        [0, 1].map(|k| point.position[k] + magnification * u[k])
    };
    let places: Vec<[f64; 2]> = shape.points().iter().zip(moved).map(place).collect();
    match places.iter().flatten().find(|value| !drawable(**value)) {
        None => Ok(places),
        Some(&value) => {
            let (quantity, needed) = ("magnified coordinate", "below 1e60 m");
            Err(Error::Input { quantity, value, needed })
        }
    }
}

/// The soil below its surface, which is y = 0, and the surface itself.
pub(super) const SOIL: RGBColor = RGBColor(238, 229, 214);
pub(super) const SURFACE: RGBColor = RGBColor(125, 98, 62);

/// Least and largest coordinates [x, y].
pub(super) fn bounds(places: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for place in places {
        for k in 0..2 {
            bounds[0][k] = bounds[0][k].min(place[k]);
            bounds[1][k] = bounds[1][k].max(place[k]);
        }
    }
    bounds
}

/// Outlines of a deformed shape's cells at these places, end to end, broken by NaN.
fn outlines(shape: &DeformedShape, places: &[[f64; 2]]) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for cell in shape.cells() {
        let corners = DeformedShape::corners(cell);
        points.extend(corners.iter().map(|&k| (places[k][0], places[k][1])));
        if corners.len() > 2 {
            points.push((places[corners[0]][0], places[corners[0]][1]));
        }
        points.push((f64::NAN, f64::NAN));
    }
    points
}

/// The structure at rest and at the kept instants nearest to `times` (s), displacements relative to
/// the ground and times `magnification`, at one scale in both directions.
///
/// # Errors
/// [`Error::Scene`] if no motion was kept ([`crate::results::Recorder::motion`]), [`Error::Size`]
/// without times, [`Error::Input`] unless times are finite and the magnification positive,
/// [`Error::Index`] if `shape` belongs to another structure.
pub fn deformed_shapes(
    title: &str,
    shape: &DeformedShape,
    histories: &TimeSeries,
    times: &[f64],
    magnification: f64,
) -> Result<Svg> {
    positive("magnification", magnification)?;
    if times.is_empty() {
        return Err(Error::Size { quantity: "times of deformed shapes", found: 0, needed: 1 });
    }
    let rest: Vec<[f64; 2]> = shape.points().iter().map(|point| point.position).collect();
    let mut drawn = vec![("at rest".to_owned(), rest)];
    for &time in times {
        finite("time of a deformed shape", time)?;
        let away = |frame: &MotionFrame<'_>| (frame.time - time).abs();
        let nearest = histories.motion_frames().min_by(|a, b| away(a).total_cmp(&away(b)));
        let frame = nearest.ok_or(Error::Scene {
            quantity: "deformed shape",
            needed: "tell the recorder to keep the motion",
        })?;
        let name = format!("t = {:.2} s", frame.time);
        drawn.push((name, places(shape, &frame, magnification)?));
    }
    let mut all: Vec<[f64; 2]> = drawn.iter().flat_map(|(_, places)| places.clone()).collect();
    all.push([all[0][0], 0.0]);
    let stroke = |k: usize| match k.checked_sub(1) {
        None => Stroke::plain(RGBColor(170, 170, 170)),
        Some(k) => Stroke::nth(k),
    };
    let lines = (0..drawn.len()).map(|k| (drawn[k].0.as_str(), Sample::Line(stroke(k))));
    let scale = format!("displacements × {}", short(magnification));
    let rest = [("soil", Sample::Area(SOIL)), (&scale, Sample::Nothing)];
    let sheet = Sheet::new(title, Key::of(lines.chain(rest)));
    let [x, y] = ranges(bounds(&all), sheet.room());
    sheet.picture(|area| {
        let axes = (Axis::linear(x.clone(), "x, m"), Axis::linear(y.clone(), "y, m"));
        let mut chart = chart(area, &axes.0, &axes.1, false)?;
        let soil = Rectangle::new([(x.start, y.start), (x.end, 0.0)], SOIL.filled());
        chart.draw_series([soil])?;
        draw_curve(&mut chart, &[(x.start, 0.0), (x.end, 0.0)], Stroke::plain(SURFACE), 2)?;
        for (k, (_, places)) in drawn.iter().enumerate() {
            draw_curve(&mut chart, &outlines(shape, places), stroke(k), 1)?;
        }
        Ok(())
    })
}

/// Ranges of both axes at one scale, in a room of [width, height] pixels.
fn ranges([low, high]: [[f64; 2]; 2], [width, height]: [f64; 2]) -> [std::ops::Range<f64>; 2] {
    let span = [0, 1].map(|k| (high[k] - low[k]).max(1e-6) * 1.1);
    let scale = (span[0] / width).max(span[1] / height);
    let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
    let half = [0.5 * scale * width, 0.5 * scale * height];
    let range = |k: usize| middle[k] - half[k]..middle[k] + half[k];
    [range(0), range(1)]
}
