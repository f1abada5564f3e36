//! Key to a chart's colours, in a separate strip at the right.

use super::drawing::{Area, Drawing, Stroke};
use super::text_width::{lines, width};
use plotters::prelude::*;

const FONT: (&str, u32) = ("sans-serif", 15);

/// Widest line of a name, pixels, and largest number of its lines; the rest is cut.
const WIDEST: f64 = 230.0;

const LINES: usize = 3;

/// Largest number of names shown; further names are only counted.
const ENTRIES: usize = 42;

/// Pixels beside the names, per line of text, and between two names.
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
    pub(super) fn new<'n>(entries: impl IntoIterator<Item = (&'n str, Sample)>) -> Self {
        let entries: Vec<_> = entries.into_iter().collect();
        // A line "and 1 more" would need as much room as the name itself.
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
        Self::new(names.map(|(k, name)| (name, Sample::Line(Stroke::nth(k)))))
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

    /// Draws the key from the top of the strip.
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
