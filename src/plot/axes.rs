//! Axes and ranges that all charts share.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::key::Stroke;
use super::svg::{Area, Drawing};
use super::text::{fitted, width};
use super::ticks::{Ticks, linear, logarithmic};

pub(super) const LABEL: (&str, u32) = ("sans-serif", 15);
const DESCRIPTION: (&str, u32) = ("sans-serif", 17);

/// Pixels around the plotting area: left with marks and description, right with half a mark.
pub(super) const LEFT: u32 = 104;
pub(super) const RIGHT: u32 = 38;
pub(super) const ABOVE: u32 = 10;
pub(super) const BELOW: u32 = 62;
/// Pixels for a mark, along x and y.
const MARK: [f64; 2] = [82.0, 40.0];

/// A linear axis with marks where we want them.
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

pub(super) type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<Coordinate, Coordinate>>;

/// Magnitudes beyond this are not drawn: the chart's own arithmetic would overflow.
const LARGEST: f64 = 1e60;

/// Whether a chart can show a value.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() < LARGEST
}

/// From the lowest to the highest value that can be drawn, with a margin; never empty.
///
/// Spans below 1e-9 of the values, or 1/`LARGEST`, count as none.
pub(super) fn range_of(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values.filter(|value| drawable(*value)) {
        low = low.min(value);
        high = high.max(value);
    }
    if low > high {
        return 0.0..1.0;
    }
    let least = (1e-9 * low.abs().max(high.abs())).max(1.0 / LARGEST);
    let margin = if high - low > least { 0.06 * (high - low) } else { low.abs().max(1.0) };
    low - margin..high + margin
}

/// Where marks are.
#[derive(Debug, Clone, PartialEq)]
enum Scale {
    Linear,
    /// The chart is drawn in the values' logarithms (base 10).
    Logarithmic(Range<f64>),
    Marked(Vec<(f64, String)>),
}

/// Range, description and marks of an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    range: Range<f64>,
    description: String,
    scale: Scale,
}

impl Axis {
    pub(super) fn linear(range: Range<f64>, description: &str) -> Self {
        Self { range, description: description.into(), scale: Scale::Linear }
    }

    /// Over logarithms of the values in `range`, which are above zero.
    pub(super) fn logarithmic(range: Range<f64>, description: &str) -> Self {
        let logarithms = range.start.log10()..range.end.log10();
        let scale = Scale::Logarithmic(range);
        Self { range: logarithms, description: description.into(), scale }
    }

    /// With these marks.
    pub(super) fn marked(range: Range<f64>, marks: Vec<(f64, String)>, description: &str) -> Self {
        Self { range, description: description.into(), scale: Scale::Marked(marks) }
    }

    /// Marks on an axis of so many pixels that do not touch each other, and the description.
    fn layout(&self, pixels: f64, vertical: bool) -> (Vec<(f64, String)>, String) {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some tens")]
        let count = ((pixels / MARK[usize::from(vertical)]) as usize).clamp(2, 14);
        let Ticks { mut marks, offset } = match &self.scale {
            Scale::Linear => linear(&self.range, count),
            Scale::Logarithmic(values) => logarithmic(values, count),
            Scale::Marked(marks) => Ticks { marks: marks.clone(), offset: None },
        };
        let scale = pixels / (self.range.end - self.range.start);
        let room = |name: &str| if vertical { 9.0 } else { 0.5 * width(name, LABEL.1) + 4.0 };
        let mut end = f64::NEG_INFINITY;
        marks.retain(|(place, name)| {
            let middle = scale * (place - self.range.start);
            let free = middle - room(name) > end;
            if free {
                end = middle + room(name);
            }
            free
        });
        let mut description = self.description.clone();
        if let Some(offset) = offset {
            description = format!("{description} (plus {offset})");
        }
        (marks, fitted(&description, DESCRIPTION.1, pixels))
    }
}

/// Name of the mark that is nearest to a value.
fn name(marks: &[(f64, String)], value: f64) -> String {
    let away = |mark: &&(f64, String)| (mark.0 - value).abs();
    let nearest = marks.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.map_or_else(String::new, |mark| mark.1.clone())
}

/// A chart with axes.
pub(super) fn chart<'a, 'b>(
    area: &'a Area<'b>,
    x: &Axis,
    y: &Axis,
    grid: bool,
) -> Drawing<Chart<'a, 'b>> {
    let (wide, high) = area.dim_in_pixel();
    let pixels = |all: u32, room: u32| f64::from(all.saturating_sub(room).max(1));
    let (x_marks, x_description) = x.layout(pixels(wide, LEFT + RIGHT), false);
    let (y_marks, y_description) = y.layout(pixels(high, ABOVE + BELOW), true);
    let coordinate = |axis: &Axis, marks: &[(f64, String)]| Coordinate {
        range: axis.range.clone().into(),
        marks: marks.iter().map(|mark| mark.0).collect(),
    };
    let mut chart = ChartBuilder::on(area)
        .margin_left(14)
        .margin_right(RIGHT)
        .margin_top(ABOVE)
        .margin_bottom(14)
        .x_label_area_size(BELOW - 14)
        .y_label_area_size(LEFT - 14)
        .build_cartesian_2d(coordinate(x, &x_marks), coordinate(y, &y_marks))?;
    let mut mesh = chart.configure_mesh();
    if !grid {
        mesh.disable_mesh();
    }
    mesh.x_desc(x_description)
        .y_desc(y_description)
        .x_label_formatter(&|value| name(&x_marks, *value))
        .y_label_formatter(&|value| name(&y_marks, *value))
        .label_style(LABEL)
        .axis_desc_style(DESCRIPTION)
        .light_line_style(WHITE)
        .draw()?;
    Ok(chart)
}

/// A curve in pieces, broken where values cannot be drawn.
pub(super) fn draw_curve(
    chart: &mut Chart<'_, '_>,
    points: &[(f64, f64)],
    stroke: Stroke,
    width: u32,
) -> Drawing<()> {
    let style = stroke.color.stroke_width(width);
    let pieces = points.split(|(x, y)| !(drawable(*x) && drawable(*y)));
    let lines = pieces.filter(|piece| !piece.is_empty());
    chart.draw_series(lines.map(|piece| PathElement::new(piece.to_vec(), style)))?;
    if let Some(marker) = stroke.marker {
        let places = stroke.marked(points.len()).map(|k| points[k]);
        let places = places.filter(|(x, y)| drawable(*x) && drawable(*y));
        let style = stroke.color.filled();
        chart.draw_series(
            places.map(|at| EmptyElement::at(at) + Polygon::new(marker.to_vec(), style)),
        )?;
    }
    Ok(())
}
