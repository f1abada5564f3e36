//! Axes and ranges common to all charts.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::drawing::{Area, Drawing, Stroke, is_drawable};
use super::text_width::{fitted, width};
use super::ticks::{Ticks, linear_ticks, logarithmic_ticks};

/// Font of the marks of an axis.
pub(super) const LABEL_FONT: (&str, u32) = ("sans-serif", 15);
/// Font of the description of an axis.
const DESCRIPTION_FONT: (&str, u32) = ("sans-serif", 17);

/// Space at the left of the plotting area, with marks and description, pixels.
pub(super) const SPACE_LEFT: u32 = 104;
/// Space at the right of the plotting area, with half a mark, pixels.
pub(super) const SPACE_RIGHT: u32 = 38;
/// Space above the plotting area, pixels.
pub(super) const SPACE_ABOVE: u32 = 10;
/// Space below the plotting area, with marks and description, pixels.
pub(super) const SPACE_BELOW: u32 = 62;
/// Space around all of these, pixels.
const OUTER_MARGIN: u32 = 14;
/// Smallest distance between marks along x and y, pixels.
const MARK_SPACING: [f64; 2] = [82.0, 40.0];

/// Half the height of a mark of a vertical axis, pixels.
const MARK_HALF_HEIGHT: f64 = 9.0;
/// Space beside a mark of a horizontal axis, pixels.
const MARK_PADDING: f64 = 4.0;
/// Smallest number of marks for which an axis is laid out.
const MIN_MARKS: usize = 2;
/// Largest number of marks: more would not be readable.
const MAX_MARKS: usize = 14;

/// Linear coordinate of a chart with marks at chosen values.
pub(super) struct Coordinate {
    range: RangedCoordf64,
    marks: Vec<f64>,
}

impl Ranged for Coordinate {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.marks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.range.range()
    }
}

/// Chart with axes, into which series are drawn.
pub(super) type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<Coordinate, Coordinate>>;

/// Scale of an axis, which determines its marks.
#[derive(Debug, Clone, PartialEq)]
enum AxisScale {
    Linear,
    /// The chart is drawn in logarithms of the values (base 10).
    Logarithmic(Range<f64>),
    /// Marks chosen by the caller.
    Marked(Vec<(f64, String)>),
}

/// Range, description and marks of an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ChartAxis {
    range: Range<f64>,
    description: String,
    scale: AxisScale,
}

impl ChartAxis {
    /// Axis with marks at round numbers.
    pub(super) fn linear(range: Range<f64>, description: &str) -> Self {
        Self { range, description: description.into(), scale: AxisScale::Linear }
    }

    /// Axis over logarithms of the values in `range`, which are above zero.
    pub(super) fn logarithmic(range: Range<f64>, description: &str) -> Self {
        let logarithms = range.start.log10()..range.end.log10();
        let scale = AxisScale::Logarithmic(range);
        Self { range: logarithms, description: description.into(), scale }
    }

    /// Axis with these marks: values and their names.
    pub(super) fn marked(range: Range<f64>, marks: Vec<(f64, String)>, description: &str) -> Self {
        Self { range, description: description.into(), scale: AxisScale::Marked(marks) }
    }

    /// Marks that do not overlap on an axis of this length (pixels), and the description.
    fn layout(&self, axis_pixels: f64, is_vertical: bool) -> AxisLayout {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some tens")]
        let mark_count = ((axis_pixels / MARK_SPACING[usize::from(is_vertical)]) as usize)
            .clamp(MIN_MARKS, MAX_MARKS);
        let Ticks { mut marks, offset } = match &self.scale {
            AxisScale::Linear => linear_ticks(&self.range, mark_count),
            AxisScale::Logarithmic(values) => logarithmic_ticks(values, mark_count),
            AxisScale::Marked(marks) => Ticks { marks: marks.clone(), offset: None },
        };
        let pixels_per_unit = axis_pixels / (self.range.end - self.range.start);
        let mut end_of_previous = f64::NEG_INFINITY;
        marks.retain(|(value, name)| {
            let half_width = if is_vertical {
                MARK_HALF_HEIGHT
            } else {
                0.5 * width(name, LABEL_FONT.1) + MARK_PADDING
            };
            let middle = pixels_per_unit * (value - self.range.start);
            let is_free = middle - half_width > end_of_previous;
            if is_free {
                end_of_previous = middle + half_width;
            }
            is_free
        });
        let mut description = self.description.clone();
        if let Some(offset) = offset {
            description = format!("{description} (plus {offset})");
        }
        let range = self.range.clone();
        AxisLayout {
            range,
            marks,
            description: fitted(&description, DESCRIPTION_FONT.1, axis_pixels),
        }
    }
}

/// Marks and description of an axis that fit its length in pixels.
struct AxisLayout {
    range: Range<f64>,
    marks: Vec<(f64, String)>,
    description: String,
}

impl AxisLayout {
    fn coordinate(&self) -> Coordinate {
        let marks = self.marks.iter().map(|mark| mark.0).collect();
        Coordinate { range: self.range.clone().into(), marks }
    }

    /// Name of the mark nearest to a value.
    fn mark_name(&self, value: f64) -> String {
        let nearest_mark =
            self.marks.iter().min_by(|a, b| (a.0 - value).abs().total_cmp(&(b.0 - value).abs()));
        nearest_mark.map_or_else(String::new, |mark| mark.1.clone())
    }
}

/// Draws axes into an area, and returns the chart.
pub(super) fn chart<'a, 'b>(
    area: &'a Area<'b>,
    x: &ChartAxis,
    y: &ChartAxis,
    has_grid: bool,
) -> Drawing<Chart<'a, 'b>> {
    let area_pixels = area.dim_in_pixel();
    let x = x.layout(remaining_pixels(area_pixels.0, SPACE_LEFT + SPACE_RIGHT), false);
    let y = y.layout(remaining_pixels(area_pixels.1, SPACE_ABOVE + SPACE_BELOW), true);
    let mut chart = ChartBuilder::on(area)
        .margin_left(OUTER_MARGIN)
        .margin_right(SPACE_RIGHT)
        .margin_top(SPACE_ABOVE)
        .margin_bottom(OUTER_MARGIN)
        .x_label_area_size(SPACE_BELOW - OUTER_MARGIN)
        .y_label_area_size(SPACE_LEFT - OUTER_MARGIN)
        .build_cartesian_2d(x.coordinate(), y.coordinate())?;
    let mut mesh = chart.configure_mesh();
    if !has_grid {
        mesh.disable_mesh();
    }
    mesh.x_desc(x.description.clone())
        .y_desc(y.description.clone())
        .x_label_formatter(&|value| x.mark_name(*value))
        .y_label_formatter(&|value| y.mark_name(*value))
        .label_style(LABEL_FONT)
        .axis_desc_style(DESCRIPTION_FONT)
        .light_line_style(WHITE)
        .draw()?;
    Ok(chart)
}

/// Pixels of a side without the space around the plotting area.
fn remaining_pixels(side: u32, space: u32) -> f64 {
    f64::from(side.saturating_sub(space).max(1))
}

/// Draws a curve in pieces, interrupted where values cannot be drawn.
pub(super) fn draw_curve(
    chart: &mut Chart<'_, '_>,
    points: &[(f64, f64)],
    stroke: Stroke,
    width: u32,
) -> Drawing<()> {
    let style = stroke.color.stroke_width(width);
    let pieces = points.split(|(x, y)| !(is_drawable(*x) && is_drawable(*y)));
    let lines = pieces.filter(|piece| !piece.is_empty());
    chart.draw_series(lines.map(|piece| PathElement::new(piece.to_vec(), style)))?;
    draw_markers(chart, points, stroke)
}

/// Draws the markers of a stroke along a curve, if it has any.
pub(super) fn draw_markers(
    chart: &mut Chart<'_, '_>,
    points: &[(f64, f64)],
    stroke: Stroke,
) -> Drawing<()> {
    if let Some(marker) = stroke.marker {
        let marked_points = stroke
            .marked_points(points.len())
            .map(|k| points[k])
            .filter(|(x, y)| is_drawable(*x) && is_drawable(*y));
        let style = stroke.color.filled();
        chart.draw_series(
            marked_points
                .map(|point| EmptyElement::at(point) + Polygon::new(marker.to_vec(), style)),
        )?;
    }
    Ok(())
}
