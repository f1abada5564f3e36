//! The structure at some instants, and the views in which it is drawn.

use std::ops::Range;

use super::axes::{Axis, LEFT, RIGHT, chart, draw_curve, drawable};
use super::drawing::{Area, Drawing, Stroke};
use super::key::{Key, Sample};
use super::svg::{Sheet, Svg};
use super::text_width::short;
use crate::error::{Error, Result, at_least, finite, positive, require, require_part};
use crate::geometry::{middle, span};
use crate::results::{DeformedShape, MotionFrame, ShapePoint, TimeSeries};
use plotters::prelude::*;
use plotters::style::RGBColor;

/// Directions of view of a structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum View {
    /// View along y: x to the right, height up.
    AlongY,
    /// View against x: y to the right, height up.
    AlongX,
    /// Isometric view from the front, the right and above.
    ///
    /// Towards the right, x falls and y rises by 30 degrees, all at one scale.
    Slanted,
}

impl View {
    /// Place in the picture of a point (x, height, y), m.
    pub(super) fn project(self, [x, up, y]: [f64; 3]) -> [f64; 2] {
        match self {
            Self::AlongY => [x, up],
            Self::AlongX => [y, up],
            Self::Slanted => [(x + y) * COS, up + (y - x) * SIN],
        }
    }

    /// Places in the picture of all points.
    pub(super) fn all(self, places: &[[f64; 3]]) -> Vec<[f64; 2]> {
        places.iter().map(|place| self.project(*place)).collect()
    }
}

/// Cosine of 30 degrees.
const COS: f64 = 0.866_025_403_784_438_6;
const SIN: f64 = 0.5;

/// Error if only one of shape and ground is in plan.
pub(super) fn check_dimension(shape: &DeformedShape, time_series: &TimeSeries) -> Result<()> {
    let needed = "must be one in plan on a ground in plan, and one of the plane else";
    require_part("deformed shape", shape.in_plan() == time_series.in_plan(), needed)
}

/// Places of the points (x, height, y), m, with magnified displacements relative to the free field.
pub(super) fn places(
    shape: &DeformedShape,
    frame: &MotionFrame<'_>,
    magnification: f64,
) -> Result<Vec<[f64; 3]>> {
    let moved = shape.displacements(frame.displacement)?;
    let place = |(point, u): (&ShapePoint, [f64; 3])| {
        let at_rest = at_rest(point);
        [0, 1, 2].map(|k| at_rest[k] + magnification * u[k])
    };
    let places: Vec<[f64; 3]> = shape.points().iter().zip(moved).map(place).collect();
    for value in places.iter().flatten() {
        require("magnified coordinate", *value, drawable(*value), "below 1e60 m")?;
    }
    Ok(places)
}

fn at_rest(point: &ShapePoint) -> [f64; 3] {
    let [x, height] = point.position;
    [x, height, point.away]
}

/// Colours of the soil below its surface y = 0, and of the surface.
pub(super) const SOIL: RGBColor = RGBColor(238, 229, 214);
pub(super) const SURFACE: RGBColor = RGBColor(125, 98, 62);

/// Smallest and largest coordinate along each axis.
pub(super) fn bounds(places: &[[f64; 2]]) -> [[f64; 2]; 2] {
    [0, 1].map(|axis| span(places.iter().map(|place| place[axis])))
}

/// Outlines of a deformed shape's cells at these places in one list, separated by NaN.
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

/// Picture of the structure at rest and at some instants.
///
/// The kept frames nearest to `times` (s) are drawn. Displacements are relative to the ground and multiplied
/// by `magnification`, with one scale in both directions. In plan there are two views, along y on the left
/// and against x on the right.
///
/// # Errors
/// [`Error::Scene`] if no motion was kept ([`crate::results::Recorder::motion`]), [`Error::Size`] without
/// times, [`Error::Input`] unless times are finite and the magnification positive, [`Error::Index`] if
/// `shape` belongs to another structure, [`Error::Scene`] if it belongs to a structure of another dimension.
pub fn deformed_shapes(
    title: &str,
    shape: &DeformedShape,
    time_series: &TimeSeries,
    times: &[f64],
    magnification: f64,
) -> Result<Svg> {
    positive("magnification", magnification)?;
    at_least("times of deformed shapes", times.len(), 1)?;
    check_dimension(shape, time_series)?;
    let drawn = shapes_at(shape, time_series, times, magnification)?;
    let at_rest = Stroke::plain(RGBColor(170, 170, 170));
    let stroke = |k: usize| k.checked_sub(1).map_or(at_rest, Stroke::nth);
    let lines = (0..drawn.len()).map(|k| (drawn[k].0.as_str(), Sample::Line(stroke(k))));
    let scale = format!("displacements × {}", short(magnification));
    let rest = [("soil", Sample::Area(SOIL)), (&scale, Sample::Nothing)];
    let sheet = Sheet::new(title, Key::new(lines.chain(rest)));
    let elevation = |view: View, room: [f64; 2]| {
        let seen: Vec<Vec<[f64; 2]>> = drawn.iter().map(|(_, places)| view.all(places)).collect();
        let mut all = seen.concat();
        all.push([all[0][0], 0.0]);
        (view, ranges(bounds(&all), room), seen)
    };
    let draw = |area: &Area<'_>, (view, [x, y], seen): &Elevation| -> Drawing<()> {
        let name = if *view == View::AlongX { "y, m" } else { "x, m" };
        let height = if time_series.in_plan() { "z, m" } else { "y, m" };
        let axes = (Axis::linear(x.clone(), name), Axis::linear(y.clone(), height));
        let mut chart = chart(area, &axes.0, &axes.1, false)?;
        let soil = Rectangle::new([(x.start, y.start), (x.end, 0.0)], SOIL.filled());
        chart.draw_series([soil])?;
        draw_curve(&mut chart, &[(x.start, 0.0), (x.end, 0.0)], Stroke::plain(SURFACE), 2)?;
        for (k, places) in seen.iter().enumerate() {
            draw_curve(&mut chart, &outlines(shape, places), stroke(k), 1)?;
        }
        Ok(())
    };
    if !time_series.in_plan() {
        let one = elevation(View::AlongY, sheet.room());
        return sheet.picture(|area| draw(area, &one));
    }
    // Both views use the scale of the wider one.
    let [all, height] = sheet.room();
    let room = [0.5 * (all - f64::from(LEFT + RIGHT)), height];
    let mut both = [View::AlongY, View::AlongX].map(|view| elevation(view, room));
    let width = |own: &Elevation| own.1[0].end - own.1[0].start;
    let widest = width(&both[0]).max(width(&both[1]));
    for own in &mut both {
        let ratio = widest / width(own);
        own.1 = own.1.clone().map(|Range { start, end }| {
            let (middle, half) = (middle([start, end]), 0.5 * ratio * (end - start));
            middle - half..middle + half
        });
    }
    sheet.picture(|area| {
        let (left, right) = area.split_horizontally((50).percent_width());
        draw(&left, &both[0])?;
        draw(&right, &both[1])
    })
}

/// The shape at rest and at the frames nearest to the times: names, and places of all points.
fn shapes_at(
    shape: &DeformedShape,
    time_series: &TimeSeries,
    times: &[f64],
    magnification: f64,
) -> Result<Vec<(String, Vec<[f64; 3]>)>> {
    let rest: Vec<[f64; 3]> = shape.points().iter().map(at_rest).collect();
    let mut shapes = vec![("at rest".to_owned(), rest)];
    for &time in times {
        finite("time of a deformed shape", time)?;
        let away = |frame: &MotionFrame<'_>| (frame.time - time).abs();
        let nearest = time_series.motion_frames().min_by(|a, b| away(a).total_cmp(&away(b)));
        let frame = nearest.ok_or(Error::Scene {
            quantity: "deformed shape",
            needed: "tell the recorder to keep the motion",
        })?;
        let name = format!("t = {:.2} s", frame.time);
        shapes.push((name, places(shape, &frame, magnification)?));
    }
    Ok(shapes)
}

/// A view, ranges of its axes, and the places of all points in it at every instant.
type Elevation = (View, [Range<f64>; 2], Vec<Vec<[f64; 2]>>);

/// Ranges of both axes at one scale, in an area of [width, height] pixels.
fn ranges(bounds: [[f64; 2]; 2], room: [f64; 2]) -> [Range<f64>; 2] {
    let pixel = |k: usize| (bounds[k][1] - bounds[k][0]).max(1e-6) * 1.1 / room[k];
    let scale = pixel(0).max(pixel(1));
    [0, 1].map(|k| {
        let (middle, half) = (middle(bounds[k]), 0.5 * scale * room[k]);
        middle - half..middle + half
    })
}
