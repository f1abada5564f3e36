//! A finished picture.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axes::{ABOVE, BELOW, LEFT, RIGHT};
use super::drawing::{Area, Drawing};
use super::key::Key;
use super::text_width::lines;
use crate::error::{Error, Result};
use crate::text::file::write_file;

/// Size of the pictures, pixels; they are higher if title or key need it.
const SIZE: (u32, u32) = (1100, 560);
const TITLE: (&str, u32) = ("sans-serif", 22);
/// Largest number of title lines; pixels per line, and above and below them.
const TITLE_LINES: usize = 2;
const TITLE_LINE: u32 = 26;
const TITLE_ROOM: u32 = 16;

/// Text of a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Svg(String);

impl Svg {
    /// Replaces characters that XML 1.0 does not allow (its section 2.2) by replacement characters.
    pub(super) fn new(text: String) -> Self {
        let unknown = |c| matches!(c, '\0'..='\x08' | '\x0b' | '\x0c' | '\x0e'..='\x1f' | '\u{fffe}' | '\u{ffff}');
        Self(if text.contains(unknown) { text.replace(unknown, "\u{fffd}") } else { text })
    }

    /// The SVG's text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Writes the picture to a file; its folder is made if it does not exist.
    ///
    /// The text is SVG for any file name; programs expect `.svg`. For bitmaps use `Svg::save_png` (feature
    /// `png`).
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        write_file(path.as_ref(), &self.0)
    }
}

/// Title and key, with the room between them.
pub(super) struct Sheet {
    title: Vec<String>,
    key: Key,
    height: u32,
}

impl Sheet {
    pub(super) fn new(title: &str, key: Key) -> Self {
        let title = lines(title, TITLE.1, f64::from(SIZE.0) - 40.0, TITLE_LINES);
        let mut sheet = Self { title, key, height: SIZE.1 };
        let top = sheet.top();
        sheet.height = (SIZE.1 + top - TITLE_LINE - TITLE_ROOM).max(top + sheet.key.height());
        sheet
    }

    /// Height of the title, pixels.
    fn top(&self) -> u32 {
        TITLE_ROOM + TITLE_LINE * u32::try_from(self.title.len()).unwrap_or(1)
    }

    /// Width and height between the axes of a chart, pixels.
    pub(super) fn room(&self) -> [f64; 2] {
        [
            f64::from(SIZE.0 - self.key.width() - LEFT - RIGHT),
            f64::from(self.height - self.top() - ABOVE - BELOW),
        ]
    }

    /// Draws title, key and the result of `chart` on a white sheet.
    pub(super) fn picture(&self, chart: impl FnOnce(&Area<'_>) -> Drawing<()>) -> Result<Svg> {
        let mut text = String::new();
        {
            let area = SVGBackend::with_string(&mut text, (SIZE.0, self.height));
            let area = area.into_drawing_area();
            let drawn = self.draw(&area, chart);
            let done = drawn.and_then(|()| area.present().map_err(Into::into));
            done.map_err(|_| Error::Scene {
                quantity: "picture",
                needed: "values that a chart can show: finite, and not all too large",
            })?;
        }
        Ok(Svg::new(text))
    }

    fn draw(&self, area: &Area<'_>, chart: impl FnOnce(&Area<'_>) -> Drawing<()>) -> Drawing<()> {
        area.fill(&WHITE)?;
        let style = TextStyle::from(TITLE.into_font()).pos(Pos::new(HPos::Center, VPos::Center));
        let middle = i32::try_from(SIZE.0 / 2).unwrap_or(0);
        let mut y = 24;
        for line in self.title.iter().filter(|line| !line.is_empty()) {
            area.draw(&Text::new(line.clone(), (middle, y), style.clone()))?;
            y += i32::try_from(TITLE_LINE).unwrap_or(0);
        }
        let (_, body) = area.split_vertically(self.top());
        let (left, strip) = body.split_horizontally(SIZE.0 - self.key.width());
        self.key.draw(&strip)?;
        chart(&left)
    }
}

/// Text of an element of XML or HTML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Path of a closed polygon.
pub(super) fn polygon(corners: &[[f64; 2]]) -> String {
    let points: Vec<String> = corners.iter().map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
    format!("M{}Z", points.join("L"))
}

/// Animates an attribute with values for equal parts of the time; only changes are written.
pub(super) fn changes(attribute: &str, values: &[String], duration: &str) -> String {
    let new = |k: &usize| *k == 0 || values[*k] != values[*k - 1];
    let at: Vec<usize> = (0..values.len()).filter(new).collect();
    if at.len() < 2 {
        return String::new();
    }
    let times: Vec<String> =
        at.iter().map(|k| format!("{:.5}", *k as f64 / values.len() as f64)).collect();
    let values: Vec<&str> = at.iter().map(|k| &values[*k][..]).collect();
    format!(
        "<animate attributeName=\"{attribute}\" calcMode=\"discrete\" dur=\"{duration}\" \
         repeatCount=\"indefinite\" keyTimes=\"{}\" values=\"{}\"/>",
        times.join(";"),
        values.join(";")
    )
}
