//! Axes and ranges common to all charts.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::drawing::{Area, Drawing, Stroke};
use super::text_width::{fitted, width};

pub(super) const LABEL: (&str, u32) = ("sans-serif", 15);
const DESCRIPTION: (&str, u32) = ("sans-serif", 17);

/// Space around the plotting area, pixels: left with marks and description, right with half a mark.
pub(super) const LEFT: u32 = 104;
pub(super) const RIGHT: u32 = 38;
pub(super) const ABOVE: u32 = 10;
pub(super) const BELOW: u32 = 62;
/// Space for a mark along x and y, pixels.
const MARK: [f64; 2] = [82.0, 40.0];

/// Linear axis with marks at given places.
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

/// Largest magnitude that is drawn: above it the arithmetic of the chart would overflow.
const LARGEST: f64 = 1e60;

/// Whether a chart can show a value.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() < LARGEST
}

/// Range from the lowest to the highest value that can be drawn, with a margin; never empty.
///
/// Spans below 1e-9 of the values, or below 1/`LARGEST`, count as zero.
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

/// Places of the marks.
#[derive(Debug, Clone, PartialEq)]
enum Scale {
    Linear,
    /// The chart is drawn in logarithms of the values (base 10).
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

    /// Axis over logarithms of the values in `range`, which are above zero.
    pub(super) fn logarithmic(range: Range<f64>, description: &str) -> Self {
        let logarithms = range.start.log10()..range.end.log10();
        let scale = Scale::Logarithmic(range);
        Self { range: logarithms, description: description.into(), scale }
    }

    /// Axis with these marks.
    pub(super) fn marked(range: Range<f64>, marks: Vec<(f64, String)>, description: &str) -> Self {
        Self { range, description: description.into(), scale: Scale::Marked(marks) }
    }

    /// Marks that do not overlap on an axis of this length (pixels), and the description.
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

/// Name of the mark nearest to a value.
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

/// A curve in pieces, interrupted where values cannot be drawn.
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
    draw_markers(chart, points, stroke)
}

/// The markers of a stroke along a curve, if it has any.
pub(super) fn draw_markers(
    chart: &mut Chart<'_, '_>,
    points: &[(f64, f64)],
    stroke: Stroke,
) -> Drawing<()> {
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

/// Largest number of letters of a mark; if more are needed, marks are written as differences.
const LETTERS: usize = 9;

/// Marks of an axis: places and names.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    pub(super) marks: Vec<(f64, String)>,
    /// Offset to be added to the names; `None` if it is zero.
    pub(super) offset: Option<String>,
}

/// The next number at or above `least` that is 1, 2 or 5 times a power of ten.
pub(super) fn nice(least: f64) -> f64 {
    let power = 10.0_f64.powf(least.log10().floor());
    // Rounding must not skip a step.
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps.into_iter().find(|step| *step >= (1.0 - 1e-9) * least).unwrap_or(10.0 * power)
}

/// Multiples of a rounded step in a range, about `count` or fewer.
fn multiples(range: &Range<f64>, count: usize) -> (f64, Vec<f64>) {
    let step = nice((range.end - range.start) / count.max(1) as f64);
    let (first, last) = ((range.start / step - 1e-6).ceil(), (range.end / step + 1e-6).floor());
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "count and less")]
    let number = (last - first).clamp(0.0, 2.0 * count as f64) as usize;
    // Adding zero removes a negative sign of zero.
    (step, (0..=number).map(|k| (first + k as f64) * step + 0.0).collect())
}

/// Marks at multiples of 1, 2 or 5 times a power of ten, at most about `count`.
pub(super) fn linear(range: &Range<f64>, count: usize) -> Ticks {
    let (mut step, mut places) = multiples(range, count);
    if places.len() < 2 {
        // One mark alone shows no scale.
        (step, places) = multiples(range, 3 * count);
    }
    let write = |values: &[f64]| values.iter().map(|v| number(*v, step)).collect::<Vec<_>>();
    let (mut names, mut offset) = (write(&places), None);
    if names.iter().any(|name| name.chars().count() > LETTERS) {
        offset = Some(names[0].clone());
        names = write(&places.iter().map(|value| value - places[0]).collect::<Vec<_>>());
    }
    Ticks { marks: places.into_iter().zip(names).collect(), offset }
}

/// Power of ten of a number.
fn exponent(value: f64) -> i32 {
    #[allow(clippy::cast_possible_truncation, reason = "-324 to 308")]
    let exponent = (value.abs().log10() + 1e-9).floor() as i32;
    exponent
}

/// A multiple of `step` with the digits that distinguish it from its neighbours.
fn number(value: f64, step: f64) -> String {
    // Multiples that are not zero only because of rounding.
    if value.abs() < 1e-3 * step {
        return "0".to_owned();
    }
    let digits = |number: i32| usize::try_from(number).unwrap_or(0);
    let plain = format!("{value:.*}", digits(-exponent(step)));
    // Numbers far from one are written with powers of ten.
    if value.abs() < 1e6 && (step >= 1e-4 || value.abs() >= 1.0) {
        return plain;
    }
    let short = format!("{value:.*e}", digits(exponent(value) - exponent(step)));
    if plain.len() <= short.len().max(6) { plain } else { short }
}

/// Marks at 1, 2, 5, 10, … of a logarithmic axis; places are powers of ten.
pub(super) fn logarithmic(range: &Range<f64>, count: usize) -> Ticks {
    let (low, high) = (range.start * (1.0 - 1e-9), range.end * (1.0 + 1e-9));
    let within = |factors: &[f64]| -> Vec<f64> {
        let powers = exponent(low)..=exponent(high);
        powers
            .flat_map(|power| factors.iter().map(move |factor| factor * 10.0_f64.powi(power)))
            .filter(|value| (low..=high).contains(value))
            .collect()
    };
    let few = [&[1.0, 2.0, 5.0][..], &[1.0, 3.0], &[1.0]].map(within);
    let fits = few.iter().find(|values| values.len() <= count && values.len() > 1);
    // On a short axis marks give way to each other, where powers of ten alone would be too few.
    let values = fits.or(few.iter().find(|values| values.len() > 1)).cloned().unwrap_or_default();
    if values.len() < 3 && range.end < 10.0 * range.start {
        let marks = linear(range, count.min(5));
        let place = |(value, name): (f64, String)| (value.log10(), name);
        let above = marks.marks.into_iter().filter(|mark| mark.0 > 0.0);
        return Ticks { marks: above.map(place).collect(), ..marks };
    }
    let name = |value: f64| (value.log10(), number(value, 10.0_f64.powi(exponent(value))));
    Ticks { marks: values.into_iter().map(name).collect(), offset: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(range: Range<f64>) -> (Vec<String>, Option<String>) {
        let ticks = linear(&range, 5);
        for mark in &ticks.marks {
            assert!(range.start - 1e-3 <= mark.0 && mark.0 <= range.end + 1e-3);
            assert!(mark.1.chars().count() <= LETTERS, "{mark:?}");
        }
        (ticks.marks.into_iter().map(|mark| mark.1).collect(), ticks.offset)
    }

    #[test]
    fn no_two_marks_read_the_same() {
        let expected = |range, list: &[&str], offset: Option<&str>| {
            assert_eq!(
                names(range),
                (list.iter().map(|&s| s.to_owned()).collect(), offset.map(Into::into))
            );
        };
        expected(0.0..10.0, &["0", "2", "4", "6", "8", "10"], None);
        expected(-0.1..0.11, &["-0.10", "-0.05", "0", "0.05", "0.10"], None);
        expected(1.0..1.004, &["1.000", "1.001", "1.002", "1.003", "1.004"], None);
        let tiny = ["0", "2e-6", "4e-6", "6e-6", "8e-6", "1.0e-5"];
        expected(
            1.000_01..1.000_02,
            &["1.000010", "1.000012", "1.000014", "1.000016", "1.000018", "1.000020"],
            None,
        );
        expected(100.000_01..100.000_02, &tiny, Some("100.000010"));
        expected(1e6..1e6 + 4.0, &["1000000", "1000001", "1000002", "1000003", "1000004"], None);
        expected(0.0..3e6, &["0", "1e6", "2e6", "3e6"], None);
        // Steps of five would leave one mark.
        let four = linear(&(-4.8..4.8), 4).marks;
        assert_eq!(
            four.iter().map(|mark| mark.0).collect::<Vec<_>>(),
            [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0]
        );
        expected(-2e-9..2e-9, &["-2e-9", "-1e-9", "0", "1e-9", "2e-9"], None);
        for range in [-1e60..1e60, 1e-60..3e-60, 1e12..1e12 + 2000.0, -1e-300..2e59] {
            let (mut list, _) = names(range.clone());
            let count = list.len();
            assert!((2..=11).contains(&count), "{range:?} {list:?}");
            list.dedup();
            assert_eq!(list.len(), count, "{range:?} {list:?}");
        }
    }

    #[test]
    fn logarithmic_marks() {
        let names = |range| {
            logarithmic(&range, 14).marks.into_iter().map(|mark| mark.1).collect::<Vec<_>>()
        };
        assert_eq!(names(0.05..2.0), ["0.05", "0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(names(1.1..1.35), ["1.10", "1.15", "1.20", "1.25", "1.30", "1.35"]);
        assert_eq!(names(1e-6..1e6).len(), 13);
        // A narrow picture has room for few, and one mark alone would say nothing.
        let narrow =
            |range| logarithmic(&range, 3).marks.into_iter().map(|mark| mark.1).collect::<Vec<_>>();
        assert_eq!(narrow(0.05..3.0), ["0.1", "1"]);
        assert_eq!(narrow(0.2..3.0), ["0.3", "1", "3"]);
        assert_eq!(narrow(0.05..1.1), ["0.1", "0.3", "1"]);
    }
}
