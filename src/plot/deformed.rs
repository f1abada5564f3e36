//! Pictures of the structure at some instants.

use std::ops::Range;

use super::axes::{Chart, ChartAxis, SPACE_LEFT, SPACE_RIGHT, chart, draw_curve, draw_markers};
use super::drawing::{Area, Drawing, Stroke, is_drawable};
use super::key::{KeySample, PictureKey};
use super::svg::{PictureLayout, Svg};
use super::text_width::short;
use super::view::StructureView;
use crate::bem::ContactElement;
use crate::error::{Error, Result, at_least, finite, positive, require, require_part};
use crate::geometry::{enclosing_interval, middle, span};
use crate::results::{DeformedShape, MotionFrame, ShapePoint, TimeSeries};
use plotters::prelude::*;
use plotters::style::RGBColor;

/// Error unless the shape has the dimension of the ground.
pub(super) fn check_dimension(shape: &DeformedShape, time_series: &TimeSeries) -> Result<()> {
    let needed = "must be in space on a ground in plan, and in the plane on a ground in the plane";
    require_part("deformed shape", shape.up() == time_series.up(), needed)
}

/// Points (x, height, y), m, with magnified displacements relative to the free field.
pub(super) fn displaced_points(
    shape: &DeformedShape,
    frame: &MotionFrame<'_>,
    magnification: f64,
) -> Result<Vec<[f64; 3]>> {
    let displacements = shape.displacements(frame.displacement)?;
    let mut points = Vec::with_capacity(displacements.len());
    for (point, displacement) in shape.points().iter().zip(displacements) {
        let rest_position = point.place();
        points.push([0, 1, 2].map(|k| rest_position[k] + magnification * displacement[k]));
    }
    for value in points.iter().flatten() {
        require("magnified coordinate", *value, is_drawable(*value), "below 1e60 m")?;
    }
    Ok(points)
}

/// Opacity of faces of elements.
pub(super) const FACE_OPACITY: f64 = 0.8;
/// Colour of the soil below its surface y = 0.
pub(super) const SOIL_COLOR: RGBColor = RGBColor(238, 229, 214);
/// Colour of the surface of the soil.
pub(super) const SURFACE_COLOR: RGBColor = RGBColor(125, 98, 62);

/// Smallest side of a drawn structure, m, so that the scale is finite.
pub(super) const MIN_DRAWN_SIDE: f64 = 1e-6;
/// Size of the chart over the size of the shapes.
const SHAPE_MARGIN_FACTOR: f64 = 1.1;

/// Smallest and largest coordinate along each axis.
pub(super) fn bounds(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    [0, 1].map(|axis| span(points.iter().map(|point| point[axis])))
}

/// Draws the cells of a shape in a view; faces hide the cells behind them.
///
/// `projections` are those of the shape's points, m.
fn draw_shape(
    chart: &mut Chart<'_, '_>,
    shape: &DeformedShape,
    view: StructureView,
    projections: &[[f64; 2]],
    stroke: Stroke,
) -> Drawing<()> {
    let mut points = Vec::new();
    for cell in view.far_to_near(shape) {
        let mut outline: Vec<_> =
            cell.iter().map(|&k| (projections[k][0], projections[k][1])).collect();
        if cell.len() > 2 {
            if shape.has_faces() {
                chart.draw_series([Polygon::new(outline.clone(), WHITE.mix(FACE_OPACITY))])?;
            }
            outline.push(outline[0]);
        }
        draw_curve(chart, &outline, Stroke::plain(stroke.color), 1)?;
        points.append(&mut outline);
        points.push((f64::NAN, f64::NAN));
    }
    draw_markers(chart, &points, stroke)
}

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
    let shapes = shapes_at(shape, time_series, times, magnification)?;
    let mut key = Vec::new();
    for (k, named_shape) in shapes.iter().enumerate() {
        key.push((named_shape.name.as_str(), KeySample::Line(shape_stroke(k))));
    }
    key.push(("soil", KeySample::Area(SOIL_COLOR)));
    let scale_text = format!("displacements × {}", short(magnification));
    key.push((&scale_text, KeySample::Nothing));
    let layout = PictureLayout::new(title, PictureKey::new(key));
    let elevations = elevations(&shapes, time_series.up(), layout.chart_size());
    layout.picture(|area| {
        let areas = area.split_evenly((1, elevations.len()));
        for (area, elevation) in areas.iter().zip(&elevations) {
            draw_elevation(area, shape, time_series, elevation)?;
        }
        Ok(())
    })
}

/// Stroke of the shape at rest (0) or at an instant.
fn shape_stroke(k: usize) -> Stroke {
    k.checked_sub(1).map_or(Stroke::plain(RGBColor(170, 170, 170)), Stroke::nth)
}

/// The shapes in one view.
struct Elevation {
    view: StructureView,
    /// Ranges of the horizontal and the vertical axis, m.
    ranges: [Range<f64>; 2],
    /// Projections of all points at every instant, m.
    shapes: Vec<Vec<[f64; 2]>>,
}

impl Elevation {
    /// Width of the horizontal range, m.
    fn width(&self) -> f64 {
        self.ranges[0].end - self.ranges[0].start
    }
}

/// The elevations of the shapes, side by side, at one scale.
fn elevations(shapes: &[NamedShape], up: usize, chart_size: [f64; 2]) -> Vec<Elevation> {
    let views = StructureView::elevations(up);
    let space_between = f64::from(SPACE_LEFT + SPACE_RIGHT) * (views.len() - 1) as f64;
    let view_size = [(chart_size[0] - space_between) / views.len() as f64, chart_size[1]];
    let mut elevations = Vec::new();
    for &view in views {
        let projected_shapes: Vec<Vec<[f64; 2]>> =
            shapes.iter().map(|named_shape| view.project_all(&named_shape.points)).collect();
        let mut all_points = projected_shapes.concat();
        all_points.push([all_points[0][0], 0.0]);
        let ranges = equal_scale_ranges(bounds(&all_points), view_size);
        elevations.push(Elevation { view, ranges, shapes: projected_shapes });
    }
    // All views use the scale of the widest view.
    let max_width = elevations.iter().map(Elevation::width).fold(0.0, f64::max);
    for elevation in &mut elevations {
        let ratio = max_width / elevation.width();
        elevation.ranges = elevation.ranges.clone().map(|Range { start, end }| {
            let middle = middle([start, end]);
            let half_width = 0.5 * ratio * (end - start);
            middle - half_width..middle + half_width
        });
    }
    elevations
}

/// Draws the soil and all shapes in one view.
fn draw_elevation(
    area: &Area<'_>,
    shape: &DeformedShape,
    time_series: &TimeSeries,
    elevation: &Elevation,
) -> Drawing<()> {
    let x = &elevation.ranges[0];
    let y = &elevation.ranges[1];
    let horizontal_label = if elevation.view == StructureView::AgainstX { "y, m" } else { "x, m" };
    let vertical_label = ["x, m", "y, m", "z, m"][time_series.up()];
    let x_axis = ChartAxis::linear(x.clone(), horizontal_label);
    let y_axis = ChartAxis::linear(y.clone(), vertical_label);
    let mut chart = chart(area, &x_axis, &y_axis, false)?;
    draw_soil(&mut chart, x, y.start, trench_outline(time_series.elements()))?;
    for (k, projections) in elevation.shapes.iter().enumerate() {
        draw_shape(&mut chart, shape, elevation.view, projections, shape_stroke(k))?;
    }
    Ok(())
}

/// Draws the soil and its surface, with the outline of a trench.
fn draw_soil(
    chart: &mut Chart<'_, '_>,
    x: &Range<f64>,
    bottom: f64,
    trench: Option<[[f64; 2]; 4]>,
) -> Drawing<()> {
    chart.draw_series([Rectangle::new([(x.start, bottom), (x.end, 0.0)], SOIL_COLOR.filled())])?;
    let mut surface = vec![(x.start, 0.0), (x.end, 0.0)];
    if let Some(corners) = trench.map(|corners| corners.map(|[x, y]| (x, y))) {
        chart.draw_series([Polygon::new(corners, WHITE)])?;
        surface.splice(1..1, corners);
    }
    draw_curve(chart, &surface, Stroke::plain(SURFACE_COLOR), 2)
}

/// A shape at an instant.
struct NamedShape {
    /// The instant, for the key.
    name: String,
    /// All points (x, height, y), m.
    points: Vec<[f64; 3]>,
}

/// The shape at rest and at the frames nearest to the times.
fn shapes_at(
    shape: &DeformedShape,
    time_series: &TimeSeries,
    times: &[f64],
    magnification: f64,
) -> Result<Vec<NamedShape>> {
    let rest_positions = shape.points().iter().map(ShapePoint::place).collect();
    let mut shapes = vec![NamedShape { name: "at rest".to_owned(), points: rest_positions }];
    for &time in times {
        finite("time of a deformed shape", time)?;
        let nearest_frame = time_series
            .motion_frames()
            .min_by(|a, b| (a.time - time).abs().total_cmp(&(b.time - time).abs()));
        let frame = nearest_frame.ok_or(Error::Scene {
            quantity: "deformed shape",
            needed: "the recorder must keep the motion (`Recorder::motion`)",
        })?;
        let name = format!("t = {:.2} s", frame.time);
        shapes.push(NamedShape { name, points: displaced_points(shape, &frame, magnification)? });
    }
    Ok(shapes)
}

/// Ranges of both axes at one scale, in an area of [width, height] pixels.
fn equal_scale_ranges(bounds: [[f64; 2]; 2], size: [f64; 2]) -> [Range<f64>; 2] {
    let scales = [0, 1]
        .map(|k| (bounds[k][1] - bounds[k][0]).max(MIN_DRAWN_SIDE) * SHAPE_MARGIN_FACTOR / size[k]);
    let metres_per_pixel = scales[0].max(scales[1]);
    [0, 1].map(|k| {
        let middle = middle(bounds[k]);
        let half_width = 0.5 * metres_per_pixel * size[k];
        middle - half_width..middle + half_width
    })
}

/// Outline of the trench (x, height), m, from its upper left corner; `None` without walls.
pub(super) fn trench_outline(elements: &[ContactElement]) -> Option<[[f64; 2]; 4]> {
    if !ContactElement::any_wall(elements) {
        return None;
    }
    let [left, right] = enclosing_interval(elements.iter().map(|element| element.ends()[0]));
    let [bottom, top] = enclosing_interval(elements.iter().map(ContactElement::heights));
    Some([[left, top], [left, bottom], [right, bottom], [right, top]])
}
