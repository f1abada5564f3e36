//! The key to a chart's colours, in a strip of its own at the right: it hides nothing.

use plotters::prelude::*;

use super::svg::{Area, Drawing};
use super::text::{lines, width};

const FONT: (&str, u32) = ("sans-serif", 15);
/// Names wider than this go on in a second line, and are cut after a third.
const WIDEST: f64 = 230.0;
const LINES: usize = 3;
/// Names beyond these are counted only.
const ENTRIES: usize = 42;
/// Pixels beside the names, for a line of text, and between two names.
const SIDE: u32 = 52;
const LINE: i32 = 18;
const GAP: i32 = 6;

/// Sample beside a name.
#[derive(Clone, Copy)]
pub(super) enum Sample {
    Line(Stroke),
    Area(RGBColor),
    Nothing,
}

/// Names in lines, with their samples.
pub(super) struct Key(Vec<(Vec<String>, Sample)>);

impl Key {
    pub(super) fn of<'n>(entries: impl IntoIterator<Item = (&'n str, Sample)>) -> Self {
        let entries: Vec<_> = entries.into_iter().collect();
        // One line of a text is no better than the text itself.
        let shown = if entries.len() > ENTRIES + 1 { ENTRIES } else { entries.len() };
        let split = |name: &str| lines(name, FONT.1, WIDEST, LINES);
        let mut list: Vec<_> =
            entries[..shown].iter().map(|(name, sample)| (split(name), *sample)).collect();
        if shown < entries.len() {
            let rest = format!("… and {} more", entries.len() - shown);
            list.push((split(&rest), Sample::Nothing));
        }
        Self(list)
    }

    /// Curves in their order.
    pub(super) fn of_curves<'n>(names: impl IntoIterator<Item = &'n str>) -> Self {
        let names = names.into_iter().enumerate();
        Self::of(names.map(|(k, name)| (name, Sample::Line(Stroke::nth(k)))))
    }

    /// Width of the strip, pixels.
    pub(super) fn width(&self) -> u32 {
        let widths = self.0.iter().flat_map(|(name, _)| name).map(|line| width(line, FONT.1));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "to WIDEST")]
        let widest = widths.fold(0.0, f64::max).ceil() as u32;
        SIDE + widest
    }

    /// Height of the strip, pixels.
    pub(super) fn height(&self) -> u32 {
        let lines: usize = self.0.iter().map(|(name, _)| name.len()).sum();
        let text = LINE.unsigned_abs() * u32::try_from(lines).unwrap_or(u32::MAX / 100);
        text + GAP.unsigned_abs() * u32::try_from(self.0.len()).unwrap_or(0) + 24
    }

    /// Draws it from the top of the strip.
    pub(super) fn draw(&self, strip: &Area<'_>) -> Drawing<()> {
        let mut y = 18;
        for (name, sample) in &self.0 {
            match *sample {
                Sample::Line(stroke) => {
                    let style = stroke.color.stroke_width(3);
                    strip.draw(&PathElement::new([(4, y), (32, y)], style))?;
                    if let Some(marker) = stroke.marker {
                        let corners =
                            marker.iter().map(|(dx, dy)| (18 + dx, y + dy)).collect::<Vec<_>>();
                        strip.draw(&Polygon::new(corners, stroke.color.filled()))?;
                    }
                }
                Sample::Area(color) => {
                    strip.draw(&Rectangle::new([(6, y - 7), (30, y + 7)], color.filled()))?;
                }
                Sample::Nothing => {}
            }
            for line in name {
                strip.draw(&Text::new(line.clone(), (38, y - 6), FONT))?;
                y += LINE;
            }
            y += GAP;
        }
        Ok(())
    }
}

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

/// Corners of a sign, pixels from its middle.
type Marker = &'static [(i32, i32)];

/// A square, a triangle, a diamond, a triangle upside down, an hourglass.
const MARKERS: [Marker; 5] = [
    &[(-4, -4), (4, -4), (4, 4), (-4, 4)],
    &[(0, -6), (5, 4), (-5, 4)],
    &[(0, -6), (6, 0), (0, 6), (-6, 0)],
    &[(0, 6), (5, -4), (-5, -4)],
    &[(-5, -5), (5, -5), (-5, 5), (5, 5)],
];

/// Signs along a curve.
const SIGNS: usize = 9;

/// Colour and marker of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    pub(super) color: RGBColor,
    pub(super) marker: Option<Marker>,
    /// Where the first marker is, over the distance of markers: those of two curves seldom meet.
    phase: f64,
}

impl Stroke {
    pub(super) fn plain(color: RGBColor) -> Self {
        Self { color, marker: None, phase: 0.0 }
    }

    /// Of the curve number `k`: the first seven without markers; all alike after 42.
    pub(super) fn nth(k: usize) -> Self {
        let marker = (k / COLORS.len()).checked_sub(1).map(|round| MARKERS[round % MARKERS.len()]);
        let phase = (0.1 + 0.618 * (k % 100) as f64).fract();
        Self { color: COLORS[k % COLORS.len()], marker, phase }
    }

    /// Points of a curve of `count` that have a marker.
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
