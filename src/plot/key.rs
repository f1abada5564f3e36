//! Key to a picture's colours, in a separate strip at the right.

use super::drawing::{Area, Drawing, Stroke};
use super::text_width::{width, wrapped_lines};
use plotters::prelude::*;

/// Font of the names.
const KEY_FONT: (&str, u32) = ("sans-serif", 15);
/// Largest width of a line of a name, pixels; longer lines break.
const MAX_NAME_WIDTH: f64 = 230.0;
/// Largest number of lines of a name; the rest is cut.
const MAX_NAME_LINES: usize = 3;
/// Largest number of names in the key; the last line counts further names.
const MAX_ENTRIES: usize = 42;
/// Width beside the names, pixels.
const SPACE_BESIDE_NAMES: u32 = 52;
/// Height of a line of a name, pixels.
const LINE_HEIGHT: i32 = 18;
/// Height between two names, pixels.
const NAME_GAP: i32 = 6;
/// Distance of the middle of the first line from the top of the strip, pixels.
const FIRST_LINE_Y: i32 = 18;
/// Distance of the names from the left edge of the strip, pixels.
const NAME_X: i32 = 38;
/// Distance of the middle of the samples from the left edge of the strip, pixels.
const SAMPLE_MIDDLE_X: i32 = 18;
/// Height above and below all names together, pixels.
const STRIP_PADDING: u32 = 24;

/// Sample of colour beside a name.
#[derive(Clone, Copy)]
pub(super) enum KeySample {
    /// A piece of a curve.
    Line(Stroke),
    /// A measured point.
    Point(Stroke),
    /// A filled rectangle.
    Area(RGBColor),
    /// The outline of a rectangle.
    Outline(RGBColor),
    /// No sample: the name is a remark.
    Nothing,
}

/// Names in lines, with their samples.
pub(super) struct PictureKey(Vec<(Vec<String>, KeySample)>);

impl PictureKey {
    /// Key with these names and samples.
    pub(super) fn new<'n>(entries: impl IntoIterator<Item = (&'n str, KeySample)>) -> Self {
        let entries: Vec<_> = entries.into_iter().collect();
        // A line "and 1 more" would need as much space as the name itself.
        let entry_count = if entries.len() > MAX_ENTRIES + 1 { MAX_ENTRIES } else { entries.len() };
        let mut lines_and_samples = Vec::with_capacity(entry_count + 1);
        for (name, sample) in &entries[..entry_count] {
            lines_and_samples.push((name_lines(name), *sample));
        }
        if entry_count < entries.len() {
            let remark = format!("… and {} more", entries.len() - entry_count);
            lines_and_samples.push((name_lines(&remark), KeySample::Nothing));
        }
        Self(lines_and_samples)
    }

    /// Key of curves with these names, in the order of their strokes.
    pub(super) fn of_curves<'n>(names: impl IntoIterator<Item = &'n str>) -> Self {
        let names = names.into_iter().enumerate();
        Self::new(names.map(|(k, name)| (name, KeySample::Line(Stroke::nth(k)))))
    }

    /// Width of the strip, pixels.
    pub(super) fn width(&self) -> u32 {
        let widths = self.0.iter().flat_map(|(name, _)| name).map(|line| width(line, KEY_FONT.1));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
        let max_width = widths.fold(0.0, f64::max).ceil() as u32;
        SPACE_BESIDE_NAMES + max_width
    }

    /// Height of the strip, pixels.
    pub(super) fn height(&self) -> u32 {
        let line_count: usize = self.0.iter().map(|(name, _)| name.len()).sum();
        let text_height =
            LINE_HEIGHT.unsigned_abs() * u32::try_from(line_count).unwrap_or(u32::MAX / 100);
        text_height
            + NAME_GAP.unsigned_abs() * u32::try_from(self.0.len()).unwrap_or(0)
            + STRIP_PADDING
    }

    /// Draws the key from the top of the strip.
    pub(super) fn draw(&self, strip: &Area<'_>) -> Drawing<()> {
        let mut y = FIRST_LINE_Y;
        for (name, sample) in &self.0 {
            match *sample {
                KeySample::Line(stroke) => {
                    let style = stroke.color.stroke_width(3);
                    strip.draw(&PathElement::new([(4, y), (32, y)], style))?;
                    draw_marker(strip, stroke, y)?;
                }
                KeySample::Point(stroke) => draw_marker(strip, stroke, y)?,
                KeySample::Area(color) => {
                    strip.draw(&Rectangle::new([(6, y - 7), (30, y + 7)], color.filled()))?;
                }
                KeySample::Outline(color) => {
                    strip.draw(&Rectangle::new([(6, y - 7), (30, y + 7)], color))?;
                }
                KeySample::Nothing => {}
            }
            for line in name {
                strip.draw(&Text::new(line.clone(), (NAME_X, y - 6), KEY_FONT))?;
                y += LINE_HEIGHT;
            }
            y += NAME_GAP;
        }
        Ok(())
    }
}

/// Draws the marker of a stroke, if it has one, at this height of the strip.
fn draw_marker(strip: &Area<'_>, stroke: Stroke, y: i32) -> Drawing<()> {
    if let Some(marker) = stroke.marker {
        let corners =
            marker.iter().map(|(dx, dy)| (SAMPLE_MIDDLE_X + dx, y + dy)).collect::<Vec<_>>();
        strip.draw(&Polygon::new(corners, stroke.color.filled()))?;
    }
    Ok(())
}

/// A name in lines that fit into the strip.
fn name_lines(name: &str) -> Vec<String> {
    wrapped_lines(name, KEY_FONT.1, MAX_NAME_WIDTH, MAX_NAME_LINES)
}
