//! Axes, colours and ranges that all charts share.

use plotters::prelude::*;

use super::svg::{Area, Drawing};

/// Colours of curves, in their order.
pub(super) const COLORS: [RGBColor; 7] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(255, 140, 0),
    RGBColor(148, 103, 189),
    RGBColor(90, 90, 90),
    RGBColor(23, 190, 207),
];

pub(super) const TITLE: (&str, u32) = ("sans-serif", 22);
pub(super) const LABEL: (&str, u32) = ("sans-serif", 15);
pub(super) const DESCRIPTION: (&str, u32) = ("sans-serif", 17);

pub(super) type Chart<'a, 'b> = ChartContext<
    'a,
    SVGBackend<'b>,
    Cartesian2d<plotters::coord::types::RangedCoordf64, plotters::coord::types::RangedCoordf64>,
>;

/// Magnitudes beyond this are not drawn: the chart's own arithmetic would overflow.
const LARGEST: f64 = 1e60;

/// Whether a chart can show a value.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() < LARGEST
}

/// From the lowest to the highest value that can be drawn, with a margin; never empty.
///
/// Spans below 1e-9 of the values, or 1/`LARGEST`, count as none.
pub(super) fn range_of(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
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

/// Number format for labels over a range.
pub(super) fn label(range: &std::ops::Range<f64>) -> impl Fn(&f64) -> String + use<> {
    let span = (range.end - range.start).abs();
    let large = range.end.abs().max(range.start.abs());
    move |value: &f64| {
        // Ticks that miss zero by rounding.
        let value = if value.abs() < 1e-9 * span { 0.0 } else { *value };
        if !(1e-3..1e6).contains(&large) && value != 0.0 {
            format!("{value:.1e}")
        } else if span >= 20.0 {
            format!("{value:.0}")
        } else if span >= 2.0 {
            format!("{value:.1}")
        } else if span >= 0.2 {
            format!("{value:.2}")
        } else {
            format!("{value:.4}")
        }
    }
}

/// A chart with title and axes.
pub(super) fn chart<'a, 'b>(
    area: &'a Area<'b>,
    title: &str,
    x: (std::ops::Range<f64>, &str),
    y: (std::ops::Range<f64>, &str),
    grid: bool,
) -> Drawing<Chart<'a, 'b>> {
    let (x_label, y_label) = (label(&x.0), label(&y.0));
    let mut chart = ChartBuilder::on(area)
        .caption(title, TITLE)
        .margin(14)
        .margin_right(24)
        .x_label_area_size(48)
        .y_label_area_size(88)
        .build_cartesian_2d(x.0, y.0)?;
    let mut mesh = chart.configure_mesh();
    if !grid {
        mesh.disable_mesh();
    }
    mesh.x_desc(x.1)
        .y_desc(y.1)
        .x_label_formatter(&x_label)
        .y_label_formatter(&y_label)
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
    style: ShapeStyle,
) -> Drawing<()> {
    let pieces = points.split(|(x, y)| !(drawable(*x) && drawable(*y)));
    let lines = pieces.filter(|piece| !piece.is_empty());
    chart.draw_series(lines.map(|piece| PathElement::new(piece.to_vec(), style)))?;
    Ok(())
}
