//! Axes and ranges common to all charts.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::drawing::{Area, Drawing, Stroke, is_drawable};
use super::text_width::{fitted, width};

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
/// Space for a mark along x and y, pixels.
const MARK_SPACING: [f64; 2] = [82.0, 40.0];

/// Linear axis with marks at chosen places.
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

/// Places of the marks.
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
    pub(super) fn linear(range: Range<f64>, description: &str) -> Self {
        Self { range, description: description.into(), scale: AxisScale::Linear }
    }

    /// Axis over logarithms of the values in `range`, which are above zero.
    pub(super) fn logarithmic(range: Range<f64>, description: &str) -> Self {
        let logarithms = range.start.log10()..range.end.log10();
        let scale = AxisScale::Logarithmic(range);
        Self { range: logarithms, description: description.into(), scale }
    }

    /// Axis with these marks.
    pub(super) fn marked(range: Range<f64>, marks: Vec<(f64, String)>, description: &str) -> Self {
        Self { range, description: description.into(), scale: AxisScale::Marked(marks) }
    }

    /// Marks that do not overlap on an axis of this length (pixels), and the description.
    fn layout(&self, pixels: f64, is_vertical: bool) -> AxisLayout {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some tens")]
        let count = ((pixels / MARK_SPACING[usize::from(is_vertical)]) as usize).clamp(2, 14);
        let Ticks { mut marks, offset } = match &self.scale {
            AxisScale::Linear => linear(&self.range, count),
            AxisScale::Logarithmic(values) => logarithmic(values, count),
            AxisScale::Marked(marks) => Ticks { marks: marks.clone(), offset: None },
        };
        let pixels_per_unit = pixels / (self.range.end - self.range.start);
        let mut end_of_previous = f64::NEG_INFINITY;
        marks.retain(|(place, name)| {
            let half_width = if is_vertical { 9.0 } else { 0.5 * width(name, LABEL_FONT.1) + 4.0 };
            let middle = pixels_per_unit * (place - self.range.start);
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
        AxisLayout { range, marks, description: fitted(&description, DESCRIPTION_FONT.1, pixels) }
    }
}

/// Marks and description of an axis of known length.
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
        let nearest =
            self.marks.iter().min_by(|a, b| (a.0 - value).abs().total_cmp(&(b.0 - value).abs()));
        nearest.map_or_else(String::new, |mark| mark.1.clone())
    }
}

/// A chart with axes.
pub(super) fn chart<'a, 'b>(
    area: &'a Area<'b>,
    x: &ChartAxis,
    y: &ChartAxis,
    has_grid: bool,
) -> Drawing<Chart<'a, 'b>> {
    let pixels = area.dim_in_pixel();
    let x = x.layout(remaining_pixels(pixels.0, SPACE_LEFT + SPACE_RIGHT), false);
    let y = y.layout(remaining_pixels(pixels.1, SPACE_ABOVE + SPACE_BELOW), true);
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
        let places = stroke.marked(points.len()).map(|k| points[k]);
        let places = places.filter(|(x, y)| is_drawable(*x) && is_drawable(*y));
        let style = stroke.color.filled();
        chart.draw_series(
            places.map(|place| EmptyElement::at(place) + Polygon::new(marker.to_vec(), style)),
        )?;
    }
    Ok(())
}

/// Largest number of letters of a mark; if more are needed, marks are written as differences.
const MAX_MARK_LETTERS: usize = 9;

/// Marks of an axis: places and names.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    pub(super) marks: Vec<(f64, String)>,
    /// Offset to be added to the names; `None` if it is zero.
    pub(super) offset: Option<String>,
}

/// The next number at or above `value` that is 1, 2 or 5 times a power of ten.
pub(super) fn rounded_step(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.log10().floor());
    // Rounding must not skip a step.
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps.into_iter().find(|step| *step >= (1.0 - 1e-9) * value).unwrap_or(10.0 * power)
}

/// Multiples of a rounded step in a range.
struct Multiples {
    step: f64,
    values: Vec<f64>,
}

/// Multiples of a rounded step in a range, about `count` or fewer.
fn multiples(range: &Range<f64>, count: usize) -> Multiples {
    let step = rounded_step((range.end - range.start) / count.max(1) as f64);
    let first = (range.start / step - 1e-6).ceil();
    let last = (range.end / step + 1e-6).floor();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "count and less")]
    let number = (last - first).clamp(0.0, 2.0 * count as f64) as usize;
    // Adding zero removes a negative sign of zero.
    let values = (0..=number).map(|k| (first + k as f64) * step + 0.0).collect();
    Multiples { step, values }
}

/// Marks at multiples of 1, 2 or 5 times a power of ten, at most about `count`.
pub(super) fn linear(range: &Range<f64>, count: usize) -> Ticks {
    let mut multiples_in_range = multiples(range, count);
    if multiples_in_range.values.len() < 2 {
        // One mark alone shows no scale.
        multiples_in_range = multiples(range, 3 * count);
    }
    let Multiples { step, values } = multiples_in_range;
    let mut names: Vec<String> = values.iter().map(|value| number(*value, step)).collect();
    let mut offset = None;
    if names.iter().any(|name| name.chars().count() > MAX_MARK_LETTERS) {
        offset = Some(names[0].clone());
        names = values.iter().map(|value| number(value - values[0], step)).collect();
    }
    Ticks { marks: values.into_iter().zip(names).collect(), offset }
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
    let decimals = usize::try_from(-exponent(step)).unwrap_or(0);
    let plain = format!("{value:.decimals$}");
    // Numbers far from one are written with powers of ten.
    if value.abs() < 1e6 && (step >= 1e-4 || value.abs() >= 1.0) {
        return plain;
    }
    let digits = usize::try_from(exponent(value) - exponent(step)).unwrap_or(0);
    let with_exponent = format!("{value:.digits$e}");
    if plain.len() <= with_exponent.len().max(6) { plain } else { with_exponent }
}

/// Marks at 1, 2, 5, 10, … of a logarithmic axis; places are powers of ten.
pub(super) fn logarithmic(range: &Range<f64>, count: usize) -> Ticks {
    let factors = [&[1.0, 2.0, 5.0][..], &[1.0, 3.0], &[1.0]];
    let candidates = factors.map(|factors| factors_of_ten(range, factors));
    let fits = candidates.iter().find(|values| values.len() <= count && values.len() > 1);
    // On a short axis some marks are left out later; powers of ten alone would be too few.
    let values = fits.or(candidates.iter().find(|values| values.len() > 1));
    let values = values.cloned().unwrap_or_default();
    if values.len() < 3 && range.end < 10.0 * range.start {
        let Ticks { mut marks, offset } = linear(range, count.min(5));
        marks.retain(|(value, _)| *value > 0.0);
        for (value, _) in &mut marks {
            *value = value.log10();
        }
        return Ticks { marks, offset };
    }
    let mut marks = Vec::with_capacity(values.len());
    for value in values {
        marks.push((value.log10(), number(value, 10.0_f64.powi(exponent(value)))));
    }
    Ticks { marks, offset: None }
}

/// The `factors` times powers of ten within a range.
fn factors_of_ten(range: &Range<f64>, factors: &[f64]) -> Vec<f64> {
    let low = range.start * (1.0 - 1e-9);
    let high = range.end * (1.0 + 1e-9);
    let mut values = Vec::new();
    for power in exponent(low)..=exponent(high) {
        for factor in factors {
            let value = factor * 10.0_f64.powi(power);
            if (low..=high).contains(&value) {
                values.push(value);
            }
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of the marks of a linear axis, and their offset.
    fn linear_names(range: Range<f64>) -> (Vec<String>, Option<String>) {
        let ticks = linear(&range, 5);
        for mark in &ticks.marks {
            assert!(range.start - 1e-3 <= mark.0 && mark.0 <= range.end + 1e-3);
            assert!(mark.1.chars().count() <= MAX_MARK_LETTERS, "{mark:?}");
        }
        (ticks.marks.into_iter().map(|mark| mark.1).collect(), ticks.offset)
    }

    fn assert_linear(range: Range<f64>, names: &[&str], offset: Option<&str>) {
        let names = names.iter().map(|&name| name.to_owned()).collect();
        assert_eq!(linear_names(range), (names, offset.map(Into::into)));
    }

    fn logarithmic_names(range: Range<f64>, count: usize) -> Vec<String> {
        logarithmic(&range, count).marks.into_iter().map(|mark| mark.1).collect()
    }

    #[test]
    fn no_two_marks_read_the_same() {
        assert_linear(0.0..10.0, &["0", "2", "4", "6", "8", "10"], None);
        assert_linear(-0.1..0.11, &["-0.10", "-0.05", "0", "0.05", "0.10"], None);
        assert_linear(1.0..1.004, &["1.000", "1.001", "1.002", "1.003", "1.004"], None);
        let tiny = ["0", "2e-6", "4e-6", "6e-6", "8e-6", "1.0e-5"];
        assert_linear(
            1.000_01..1.000_02,
            &["1.000010", "1.000012", "1.000014", "1.000016", "1.000018", "1.000020"],
            None,
        );
        assert_linear(100.000_01..100.000_02, &tiny, Some("100.000010"));
        let millions = ["1000000", "1000001", "1000002", "1000003", "1000004"];
        assert_linear(1e6..1e6 + 4.0, &millions, None);
        assert_linear(0.0..3e6, &["0", "1e6", "2e6", "3e6"], None);
        // Steps of five would leave one mark.
        let four = linear(&(-4.8..4.8), 4).marks;
        assert_eq!(
            four.iter().map(|mark| mark.0).collect::<Vec<_>>(),
            [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0]
        );
        assert_linear(-2e-9..2e-9, &["-2e-9", "-1e-9", "0", "1e-9", "2e-9"], None);
        for range in [-1e60..1e60, 1e-60..3e-60, 1e12..1e12 + 2000.0, -1e-300..2e59] {
            let mut names = linear_names(range.clone()).0;
            let count = names.len();
            assert!((2..=11).contains(&count), "{range:?} {names:?}");
            names.dedup();
            assert_eq!(names.len(), count, "{range:?} {names:?}");
        }
    }

    #[test]
    fn logarithmic_marks() {
        assert_eq!(logarithmic_names(0.05..2.0, 14), ["0.05", "0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(
            logarithmic_names(1.1..1.35, 14),
            ["1.10", "1.15", "1.20", "1.25", "1.30", "1.35"]
        );
        assert_eq!(logarithmic_names(1e-6..1e6, 14).len(), 13);
        // A narrow picture has room for few, and one mark alone would say nothing.
        assert_eq!(logarithmic_names(0.05..3.0, 3), ["0.1", "1"]);
        assert_eq!(logarithmic_names(0.2..3.0, 3), ["0.3", "1", "3"]);
        assert_eq!(logarithmic_names(0.05..1.1, 3), ["0.1", "0.3", "1"]);
    }
}
