//! Areas on which charts are drawn, strokes of curves, text and the key to the colours.

use crate::text::table::wrapped;
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

// Width of text, and cutting of text that is too long.
//
// The program that shows the SVG chooses the font. Widths are estimates for a wide font (DejaVu Sans, not
// condensed), so that other fonts fit as well.

/// Factor by which plotters divides font sizes.
const FONT_SCALE: f64 = 1.24;

/// Width of a letter over the font's size.
fn letter(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | 'I' | '|' | '!' | '.' | ',' | ':' | ';' | '\'' | ' ' => 0.37,
        'm' | 'w' | 'M' | 'W' | '%' | '@' | '—' | '…' | 'Æ' | 'Œ' | 'Ω' => 1.01,
        '0'..='9' | 'a'..='z' => 0.64,
        // Hangul, Kana, Chinese characters, symbols and pictures are square.
        '\u{1100}'..='\u{115f}' | '\u{2e80}'.. => 1.1,
        _ => 0.82,
    }
}

/// Width of a text, pixels, in plotters' font of this size in points.
pub(super) fn width(text: &str, size: u32) -> f64 {
    text.chars().map(letter).sum::<f64>() * f64::from(size) / FONT_SCALE
}

/// The text in lines of at most `room` pixels, as [`wrapped`].
pub(super) fn lines(text: &str, size: u32, room: f64, most: usize) -> Vec<String> {
    wrapped(text, room, most, |text| width(text, size))
}

/// The text, cut where it is wider than `room` pixels.
pub(super) fn fitted(text: &str, size: u32, room: f64) -> String {
    lines(text, size, room, 1).swap_remove(0)
}

/// A number in four digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        format!("{value:.3e}").parse::<f64>().unwrap_or(value).to_string()
    } else {
        format!("{value:.1e}")
    }
}

// The key to a chart's colours, in a separate strip at the right, where it hides nothing.

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words_and_end_in_a_sign_if_cut() {
        assert_eq!(lines("", 15, 100.0, 2), [""]);
        assert_eq!(lines("base shear", 15, 400.0, 2), ["base shear"]);
        assert_eq!(lines("base shear", 15, 60.0, 2), ["base", "shear"]);
        assert_eq!(fitted("base shear", 15, 60.0), "base s…");
        let long = "x".repeat(1000);
        let three = lines(&long, 15, 80.0, 3);
        assert_eq!(three.len(), 3);
        assert!(three[2].ends_with('…') && !three[1].ends_with('…'));
        assert!(three.iter().all(|line| width(line, 15) <= 80.0));
        // A word too long for a line is broken, and the text after it is not lost.
        let broken = lines(&format!("{} end", "x".repeat(15)), 15, 80.0, 9);
        assert_eq!(broken.concat().replace(' ', ""), format!("{}end", "x".repeat(15)));
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (50.0, "50"),
            (1.0 / 3.0, "0.3333"),
            (123_456.0, "123500"),
            (1.234e-7, "1.2e-7"),
            (2e9, "2.0e9"),
        ] {
            assert_eq!(short(value), text);
        }
    }
}
