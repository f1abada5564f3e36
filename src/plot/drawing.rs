//! Areas on which charts are drawn, values that they can show, and strokes of curves.

use std::ops::Range;

use plotters::prelude::*;

/// Area on which a chart is drawn.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Result of drawing into memory, with any error.
pub(super) type Drawing<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// Largest magnitude that is drawn: above it the arithmetic of the chart would overflow.
const MAX_DRAWN_VALUE: f64 = 1e60;

/// Whether a chart can show a value.
pub(super) fn is_drawable(value: f64) -> bool {
    value.abs() < MAX_DRAWN_VALUE
}

/// Range from the lowest to the highest value that can be drawn, with a margin; never empty.
///
/// Spans below 1e-9 of the values, or below 1/`MAX_DRAWN_VALUE`, count as zero.
pub(super) fn range_of(values: impl Iterator<Item = f64>) -> Range<f64> {
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    for value in values.filter(|value| is_drawable(*value)) {
        low = low.min(value);
        high = high.max(value);
    }
    if low > high {
        return 0.0..1.0;
    }
    let min_span = (1e-9 * low.abs().max(high.abs())).max(1.0 / MAX_DRAWN_VALUE);
    let margin = if high - low > min_span { 0.06 * (high - low) } else { low.abs().max(1.0) };
    low - margin..high + margin
}

/// Colours of curves, in their order.
pub(super) const CURVE_COLORS: [RGBColor; 7] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(255, 140, 0),
    RGBColor(148, 103, 189),
    RGBColor(90, 90, 90),
    RGBColor(23, 190, 207),
];

/// Corners of a marker, pixels from its middle.
type Marker = &'static [(i32, i32)];

/// A square, a triangle, a diamond, a triangle upside down, an hourglass.
const CURVE_MARKERS: [Marker; 5] = [
    &[(-4, -4), (4, -4), (4, 4), (-4, 4)],
    &[(0, -6), (5, 4), (-5, 4)],
    &[(0, -6), (6, 0), (0, 6), (-6, 0)],
    &[(0, 6), (5, -4), (-5, -4)],
    &[(-5, -5), (5, -5), (-5, 5), (5, 5)],
];

/// Number of markers along a curve.
const MARKERS_PER_CURVE: usize = 9;

/// Colour and marker of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    pub(super) color: RGBColor,
    pub(super) marker: Option<Marker>,
    /// Distance of the first marker over the distance between markers.
    ///
    /// It differs between curves, so that markers rarely overlap.
    phase: f64,
}

impl Stroke {
    pub(super) fn plain(color: RGBColor) -> Self {
        Self { color, marker: None, phase: 0.0 }
    }

    /// Style of curve number `k`: the first seven have no markers; styles repeat after 42.
    pub(super) fn nth(k: usize) -> Self {
        let marker = (k / CURVE_COLORS.len())
            .checked_sub(1)
            .map(|round| CURVE_MARKERS[round % CURVE_MARKERS.len()]);
        let phase = (0.1 + 0.618 * (k % 100) as f64).fract();
        Self { color: CURVE_COLORS[k % CURVE_COLORS.len()], marker, phase }
    }

    /// Style of the measured points number `k`: a marker for each, in other colours than the first curves.
    pub(super) fn points(k: usize) -> Self {
        let marker = Some(CURVE_MARKERS[k % CURVE_MARKERS.len()]);
        let color = CURVE_COLORS[CURVE_COLORS.len() - 2 - k % (CURVE_COLORS.len() - 1)];
        Self { color, marker, phase: 0.0 }
    }

    /// Points of a curve of `count` points that have a marker.
    pub(super) fn marked(self, count: usize) -> impl Iterator<Item = usize> {
        (0..MARKERS_PER_CURVE.min(count)).map(move |k| {
            let fraction = (k as f64 + self.phase) / MARKERS_PER_CURVE as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "< count")]
            let index = (fraction * count as f64) as usize;
            index.min(count.saturating_sub(1))
        })
    }
}
