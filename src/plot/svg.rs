//! Pictures as SVG text, and pages of text and pictures.

use std::fmt::Display;
use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axes::{SPACE_ABOVE, SPACE_BELOW, SPACE_LEFT, SPACE_RIGHT};
use super::drawing::{Area, Drawing};
use super::key::PictureKey;
use super::text_width::wrapped_lines;
use crate::error::{Error, Result};
use crate::text::file::write_file;

/// Width of the pictures, pixels.
const PICTURE_WIDTH: u32 = 1100;
/// Smallest height of the pictures, pixels; a long title or key makes them higher.
const MIN_PICTURE_HEIGHT: u32 = 560;
/// Font of the title.
const TITLE_FONT: (&str, u32) = ("sans-serif", 22);
/// Width of the margins left and right of the title together, pixels.
const TITLE_SIDE_MARGINS: f64 = 40.0;
/// Distance of the center of the first title line from the upper edge, pixels.
const FIRST_TITLE_LINE_Y: i32 = 24;
/// Largest number of lines of the title; the rest is cut.
const MAX_TITLE_LINES: usize = 2;
/// Height of a line of the title, pixels.
const TITLE_LINE_HEIGHT: u32 = 26;
/// Height above and below the title, pixels.
const TITLE_PADDING: u32 = 16;

/// Picture in the format SVG.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Svg(String);

impl Svg {
    /// Makes a picture from SVG text and replaces forbidden characters.
    ///
    /// XML 1.0 forbids these characters (section 2.2).
    pub(super) fn new(text: String) -> Self {
        let has_forbidden = text.contains(is_forbidden_in_xml);
        Self(if has_forbidden { text.replace(is_forbidden_in_xml, "\u{fffd}") } else { text })
    }

    /// The SVG's text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Writes the picture to a file and creates its folder.
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

/// Whether XML 1.0 forbids a character.
fn is_forbidden_in_xml(character: char) -> bool {
    matches!(
        character,
        '\0'..='\x08' | '\x0b' | '\x0c' | '\x0e'..='\x1f' | '\u{fffe}' | '\u{ffff}'
    )
}

/// Title and key of a picture, and the space for its charts.
pub(super) struct PictureLayout {
    title: Vec<String>,
    key: PictureKey,
    height: u32,
}

impl PictureLayout {
    /// Layout of the height that title and key need.
    pub(super) fn new(title: &str, key: PictureKey) -> Self {
        let max_width = f64::from(PICTURE_WIDTH) - TITLE_SIDE_MARGINS;
        let title = wrapped_lines(title, TITLE_FONT.1, max_width, MAX_TITLE_LINES);
        let mut layout = Self { title, key, height: MIN_PICTURE_HEIGHT };
        let title_height = layout.title_height();
        let height_of_one_line = TITLE_LINE_HEIGHT + TITLE_PADDING;
        layout.height = (MIN_PICTURE_HEIGHT + title_height - height_of_one_line)
            .max(title_height + layout.key.height());
        layout
    }

    /// Height of the title, pixels.
    fn title_height(&self) -> u32 {
        TITLE_PADDING + TITLE_LINE_HEIGHT * u32::try_from(self.title.len()).unwrap_or(1)
    }

    /// Width and height between the axes of a chart, pixels.
    pub(super) fn chart_size(&self) -> [f64; 2] {
        [
            f64::from(PICTURE_WIDTH - self.key.width() - SPACE_LEFT - SPACE_RIGHT),
            f64::from(self.height - self.title_height() - SPACE_ABOVE - SPACE_BELOW),
        ]
    }

    /// Picture of title and key, and of the charts that `draw_charts` draws.
    pub(super) fn picture(
        &self,
        draw_charts: impl FnOnce(&Area<'_>) -> Drawing<()>,
    ) -> Result<Svg> {
        let mut text = String::new();
        {
            let backend = SVGBackend::with_string(&mut text, (PICTURE_WIDTH, self.height));
            let area = backend.into_drawing_area();
            let result = self.draw(&area, draw_charts);
            let result = result.and_then(|()| area.present().map_err(Into::into));
            result.map_err(|_| Error::Scene {
                quantity: "picture",
                needed: "values that a chart can show: finite, and not all too large",
            })?;
        }
        Ok(Svg::new(text))
    }

    fn draw(
        &self,
        area: &Area<'_>,
        draw_charts: impl FnOnce(&Area<'_>) -> Drawing<()>,
    ) -> Drawing<()> {
        area.fill(&WHITE)?;
        let style =
            TextStyle::from(TITLE_FONT.into_font()).pos(Pos::new(HPos::Center, VPos::Center));
        let center_x = i32::try_from(PICTURE_WIDTH / 2).unwrap_or(0);
        let mut y = FIRST_TITLE_LINE_Y;
        for line in self.title.iter().filter(|line| !line.is_empty()) {
            area.draw(&Text::new(line.clone(), (center_x, y), style.clone()))?;
            y += i32::try_from(TITLE_LINE_HEIGHT).unwrap_or(0);
        }
        let body = area.split_vertically(self.title_height()).1;
        let (chart_area, key_strip) = body.split_horizontally(PICTURE_WIDTH - self.key.width());
        self.key.draw(&key_strip)?;
        draw_charts(&chart_area)
    }
}

/// Text with the special characters of XML and HTML escaped.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// SVG path of a closed polygon with these corners, pixels.
pub(super) fn polygon(corners: &[[f64; 2]]) -> String {
    let points: Vec<String> = corners.iter().map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
    format!("M{}Z", points.join("L"))
}

/// SMIL animation of an attribute, by values at equal intervals.
///
/// Equal successive values are written once.
pub(super) fn discrete_animation(attribute: &str, values: &[String], duration: &str) -> String {
    let mut times = Vec::new();
    let mut changed_values: Vec<&str> = Vec::new();
    for (k, value) in values.iter().enumerate() {
        if k == 0 || *value != values[k - 1] {
            times.push(format!("{:.5}", k as f64 / values.len() as f64));
            changed_values.push(value);
        }
    }
    if changed_values.len() < 2 {
        return String::new();
    }
    format!(
        "<animate attributeName=\"{attribute}\" calcMode=\"discrete\" dur=\"{duration}\" \
         repeatCount=\"indefinite\" keyTimes=\"{}\" values=\"{}\"/>",
        times.join(";"),
        changed_values.join(";")
    )
}

/// HTML page of a text with pictures below it, all in one file.
///
/// `text` is anything printed in columns, such as a [`Run`](crate::results::Run) or an
/// [`Interaction`](crate::analyses::Interaction). A browser opens and prints the page without other files.
///
/// ```
/// use basemat::plot;
///
/// let ramp = [plot::Curve { name: "ramp".to_owned(), points: vec![(0.0, 0.0), (1.0, 2.0)] }];
/// let picture = plot::curves("Tilt", "time, s", "mrad", &ramp)?;
/// let page = plot::page("Run 7", &"friction < 0.4", &[picture]);
/// assert_eq!((page.matches("<svg").count(), page.matches("&lt; 0.4").count()), (1, 1));
/// # Ok::<(), basemat::Error>(())
/// ```
pub fn page(title: &str, text: &dyn Display, pictures: &[Svg]) -> String {
    let title = escaped(title);
    let text = escaped(&text.to_string());
    let pictures: String = pictures.iter().map(Svg::as_str).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
         <style>svg {{ max-width: 100%; height: auto }}</style></head>\n\
         <body><h1>{title}</h1>\n<pre>{text}</pre>\n{pictures}</body></html>\n"
    )
}
