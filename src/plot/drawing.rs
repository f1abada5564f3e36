//! Areas on which charts are drawn, and strokes of curves.

use plotters::prelude::*;

/// Area on which a chart is drawn.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Result of drawing into memory, with any error.
pub(super) type Drawing<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;

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

/// Corners of a marker, pixels from its middle.
type Marker = &'static [(i32, i32)];

/// A square, a triangle, a diamond, a triangle upside down, an hourglass.
const MARKERS: [Marker; 5] = [
    &[(-4, -4), (4, -4), (4, 4), (-4, 4)],
    &[(0, -6), (5, 4), (-5, 4)],
    &[(0, -6), (6, 0), (0, 6), (-6, 0)],
    &[(0, 6), (5, -4), (-5, -4)],
    &[(-5, -5), (5, -5), (-5, 5), (5, 5)],
];

/// Number of markers along a curve.
const SIGNS: usize = 9;

/// Colour and marker of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    pub(super) color: RGBColor,
    pub(super) marker: Option<Marker>,
    /// Distance of the first marker over the distance between markers; differs between curves so that markers
    /// rarely overlap.
    phase: f64,
}

impl Stroke {
    pub(super) fn plain(color: RGBColor) -> Self {
        Self { color, marker: None, phase: 0.0 }
    }

    /// Style of curve number `k`: the first seven have no markers; styles repeat after 42.
    pub(super) fn nth(k: usize) -> Self {
        let marker = (k / COLORS.len()).checked_sub(1).map(|round| MARKERS[round % MARKERS.len()]);
        let phase = (0.1 + 0.618 * (k % 100) as f64).fract();
        Self { color: COLORS[k % COLORS.len()], marker, phase }
    }

    /// Points of a curve of `count` points that have a marker.
    pub(super) fn marked(self, count: usize) -> impl Iterator<Item = usize> {
        let place = move |k: usize| {
            let share = (k as f64 + self.phase) / SIGNS as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "< count")]
            let place = (share * count as f64) as usize;
            place.min(count.saturating_sub(1))
        };
        (0..SIGNS.min(count)).map(place)
    }
}
