//! The structure at some instants.

use std::ops::Range;

use super::axes::{Axis, Chart, LEFT, RIGHT, chart, draw_curve, draw_markers, drawable};
use super::drawing::{Area, Drawing, Stroke};
use super::key::{Key, Sample};
use super::svg::{Sheet, Svg};
use super::text_width::short;
use super::trench;
use super::view::View;
use crate::error::{Error, Result, at_least, finite, positive, require, require_part};
use crate::geometry::{middle, span};
use crate::results::{DeformedShape, MotionFrame, ShapePoint, TimeSeries};
use plotters::prelude::*;
use plotters::style::RGBColor;

/// Error if only one of shape and ground is in plan.
pub(super) fn check_dimension(shape: &DeformedShape, time_series: &TimeSeries) -> Result<()> {
    let needed = "must be one in plan on a ground in plan, and one of the plane else";
    require_part("deformed shape", shape.up() == time_series.up(), needed)
}

/// Places of the points (x, height, y), m, with magnified displacements relative to the free field.
pub(super) fn places(
    shape: &DeformedShape,
    frame: &MotionFrame<'_>,
    magnification: f64,
) -> Result<Vec<[f64; 3]>> {
    let moved = shape.displacements(frame.displacement)?;
    let place = |(point, u): (&ShapePoint, [f64; 3])| {
        let at_rest = point.place();
        [0, 1, 2].map(|k| at_rest[k] + magnification * u[k])
    };
    let places: Vec<[f64; 3]> = shape.points().iter().zip(moved).map(place).collect();
    for value in places.iter().flatten() {
        require("magnified coordinate", *value, drawable(*value), "below 1e60 m")?;
    }
    Ok(places)
}

/// Colours of the soil below its surface y = 0, and of the surface.
pub(super) const SOIL: RGBColor = RGBColor(238, 229, 214);
pub(super) const SURFACE: RGBColor = RGBColor(125, 98, 62);

/// Smallest and largest coordinate along each axis.
pub(super) fn bounds(places: &[[f64; 2]]) -> [[f64; 2]; 2] {
    [0, 1].map(|axis| span(places.iter().map(|place| place[axis])))
}

/// Draws the cells of a shape at these places in a view; faces of elements hide those behind them.
fn draw_shape(
    chart: &mut Chart<'_, '_>,
    shape: &DeformedShape,
    (view, places): (View, &[[f64; 2]]),
    stroke: Stroke,
) -> Drawing<()> {
    let mut points = Vec::new();
    for cell in view.far_to_near(shape) {
        let mut outline: Vec<_> = cell.iter().map(|&k| (places[k][0], places[k][1])).collect();
        if cell.len() > 2 {
            if shape.has_faces() {
                chart.draw_series([Polygon::new(outline.clone(), WHITE.mix(OPACITY))])?;
            }
            outline.push(outline[0]);
        }
        draw_curve(chart, &outline, Stroke::plain(stroke.color), 1)?;
        points.append(&mut outline);
        points.push((f64::NAN, f64::NAN));
    }
    draw_markers(chart, &points, stroke)
}

/// Opacity of faces of elements.
pub(super) const OPACITY: f64 = 0.8;

/// Picture of the structure at rest and at some instants.
///
/// The kept frames nearest to `times` (s) are drawn. Displacements are relative to the ground and multiplied
/// by `magnification`, with one scale in both directions. In plan there are two views, along y on the left
/// and against x on the right. Shells and sides of solids of a model in space hide most of what lies behind them.
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
    let up = time_series.up();
    let views = View::elevations(up);
    // All views use the scale of the widest one.
    let [all, height] = sheet.room();
    let others = f64::from(LEFT + RIGHT) * (views.len() - 1) as f64;
    let room = [(all - others) / views.len() as f64, height];
    let elevation = |&view: &View| {
        let seen: Vec<Vec<[f64; 2]>> = drawn.iter().map(|(_, places)| view.all(places)).collect();
        let mut all = seen.concat();
        all.push([all[0][0], 0.0]);
        (view, ranges(bounds(&all), room), seen)
    };
    let mut elevations: Vec<Elevation> = views.iter().map(elevation).collect();
    let width = |own: &Elevation| own.1[0].end - own.1[0].start;
    let widest = elevations.iter().map(width).fold(0.0, f64::max);
    for own in &mut elevations {
        let ratio = widest / width(own);
        own.1 = own.1.clone().map(|Range { start, end }| {
            let (middle, half) = (middle([start, end]), 0.5 * ratio * (end - start));
            middle - half..middle + half
        });
    }
    let draw = |area: &Area<'_>, (view, [x, y], seen): &Elevation| -> Drawing<()> {
        let name = if *view == View::AlongX { "y, m" } else { "x, m" };
        let height = ["x, m", "y, m", "z, m"][up];
        let axes = (Axis::linear(x.clone(), name), Axis::linear(y.clone(), height));
        let mut chart = chart(area, &axes.0, &axes.1, false)?;
        draw_soil(&mut chart, (x, y.start), trench::outline(time_series.elements()))?;
        for (k, places) in seen.iter().enumerate() {
            draw_shape(&mut chart, shape, (*view, places), stroke(k))?;
        }
        Ok(())
    };
    sheet.picture(|area| {
        let areas = area.split_evenly((1, elevations.len()));
        areas.iter().zip(&elevations).try_for_each(|(area, own)| draw(area, own))
    })
}

/// Draws the soil and its surface, with the outline of a trench.
fn draw_soil(
    chart: &mut Chart<'_, '_>,
    (x, bottom): (&Range<f64>, f64),
    trench: Option<[[f64; 2]; 4]>,
) -> Drawing<()> {
    chart.draw_series([Rectangle::new([(x.start, bottom), (x.end, 0.0)], SOIL.filled())])?;
    let mut surface = vec![(x.start, 0.0), (x.end, 0.0)];
    if let Some(corners) = trench.map(|corners| corners.map(|[x, y]| (x, y))) {
        chart.draw_series([Polygon::new(corners, WHITE)])?;
        surface.splice(1..1, corners);
    }
    draw_curve(chart, &surface, Stroke::plain(SURFACE), 2)
}

/// The shape at rest and at the frames nearest to the times: names, and places of all points.
fn shapes_at(
    shape: &DeformedShape,
    time_series: &TimeSeries,
    times: &[f64],
    magnification: f64,
) -> Result<Vec<(String, Vec<[f64; 3]>)>> {
    let rest: Vec<[f64; 3]> = shape.points().iter().map(ShapePoint::place).collect();
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
