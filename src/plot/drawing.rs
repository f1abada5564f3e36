//! Areas on which charts are drawn, values that they can show, and strokes of curves.

use std::ops::Range;

use plotters::prelude::*;

/// Area on which a chart is drawn.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Result of drawing into memory, with any error.
pub(super) type Drawing<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// Largest magnitude that is drawn: above it the arithmetic of the chart would overflow.
const MAX_DRAWN_VALUE: f64 = 1e60;

/// Margin of a range at each end, relative to the span of its values.
pub(super) const RANGE_MARGIN_RATIO: f64 = 0.06;
/// Span of values that is due to rounding, relative to their magnitude.
const SPAN_TOLERANCE_RATIO: f64 = 1e-9;

/// Whether a chart can show a value.
pub(super) fn is_drawable(value: f64) -> bool {
    value.abs() < MAX_DRAWN_VALUE
}

/// Range of the values that can be drawn, with a margin; never empty.
///
/// Spans below 1e-9 of the values, or below 1/`MAX_DRAWN_VALUE`, are treated as zero.
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
    let min_span = (SPAN_TOLERANCE_RATIO * low.abs().max(high.abs())).max(1.0 / MAX_DRAWN_VALUE);
    let margin = if high - low > min_span {
        RANGE_MARGIN_RATIO * (high - low)
    } else {
        low.abs().max(1.0)
    };
    low - margin..high + margin
}

/// Colours of curves, in the order of the curves.
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

/// Markers of curves: a square, a triangle, a diamond, a triangle upside down, an hourglass.
const CURVE_MARKERS: [Marker; 5] = [
    &[(-4, -4), (4, -4), (4, 4), (-4, 4)],
    &[(0, -6), (5, 4), (-5, 4)],
    &[(0, -6), (6, 0), (0, 6), (-6, 0)],
    &[(0, 6), (5, -4), (-5, -4)],
    &[(-5, -5), (5, -5), (-5, 5), (5, 5)],
];

/// Number of markers along a curve.
const MARKERS_PER_CURVE: usize = 9;

/// Phase of the markers of the first curve.
const FIRST_MARKER_PHASE: f64 = 0.1;
/// Increment of the phase from curve to curve.
///
/// It is the fractional part of the golden ratio, whose multiples are spread evenly.
const PHASE_INCREMENT: f64 = 0.618;

/// Colour and markers of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    pub(super) color: RGBColor,
    pub(super) marker: Option<Marker>,
    /// Distance from the start of the curve to its first marker, over the distance between markers.
    ///
    /// The phase differs between curves, so that markers rarely overlap.
    phase: f64,
}

impl Stroke {
    /// Stroke without markers.
    pub(super) fn plain(color: RGBColor) -> Self {
        Self { color, marker: None, phase: 0.0 }
    }

    /// Stroke of curve number `k`: the first seven have no markers.
    pub(super) fn nth(k: usize) -> Self {
        let marker = (k / CURVE_COLORS.len())
            .checked_sub(1)
            .map(|cycle| CURVE_MARKERS[cycle % CURVE_MARKERS.len()]);
        // The remainder limits the rounding of the phase.
        let phase = (FIRST_MARKER_PHASE + PHASE_INCREMENT * (k % 100) as f64).fract();
        Self { color: CURVE_COLORS[k % CURVE_COLORS.len()], marker, phase }
    }

    /// Stroke of set number `k` of measured points; the first sets have other colours than the first curves.
    pub(super) fn points(k: usize) -> Self {
        let marker = Some(CURVE_MARKERS[k % CURVE_MARKERS.len()]);
        let color = CURVE_COLORS[CURVE_COLORS.len() - 2 - k % (CURVE_COLORS.len() - 1)];
        Self { color, marker, phase: 0.0 }
    }

    /// Indices of the points with a marker, in a curve of `point_count` points.
    pub(super) fn marked_points(self, point_count: usize) -> impl Iterator<Item = usize> {
        (0..MARKERS_PER_CURVE.min(point_count)).map(move |k| {
            let fraction = (k as f64 + self.phase) / MARKERS_PER_CURVE as f64;
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "below point_count"
            )]
            let index = (fraction * point_count as f64) as usize;
            index.min(point_count.saturating_sub(1))
        })
    }
}
