//! Estimated width of text in pictures, and line breaks.
//!
//! The program that shows the SVG chooses the font. Widths are estimates for a wide font (DejaVu Sans, not
//! condensed), so that other fonts fit as well.

use crate::text::line_breaks::wrapped;

/// Factor by which plotters divides font sizes.
const FONT_SCALE: f64 = 1.24;

/// Width of a letter over the font's size.
fn letter_width(letter: char) -> f64 {
    match letter {
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
    text.chars().map(letter_width).sum::<f64>() * f64::from(size) / FONT_SCALE
}

/// The text in lines of at most `max_width` pixels, as [`wrapped`].
pub(super) fn wrapped_lines(
    text: &str,
    size: u32,
    max_width: f64,
    max_lines: usize,
) -> Vec<String> {
    wrapped(text, max_width, max_lines, |text| width(text, size))
}

/// The text, cut at a width of `max_width` pixels.
pub(super) fn fitted(text: &str, size: u32, max_width: f64) -> String {
    wrapped_lines(text, size, max_width, 1).swap_remove(0)
}

/// Text of a number with at most four digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        format!("{value:.3e}").parse::<f64>().unwrap_or(value).to_string()
    } else {
        format!("{value:.1e}")
    }
}

/// Text of a length in m, or in mm below half a metre.
pub(super) fn length_text(length: f64) -> String {
    if length < 0.5 {
        format!("{} mm", short(1e3 * length))
    } else {
        format!("{} m", short(length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words_and_end_in_a_sign_if_cut() {
        assert_eq!(wrapped_lines("", 15, 100.0, 2), [""]);
        assert_eq!(wrapped_lines("base shear", 15, 400.0, 2), ["base shear"]);
        assert_eq!(wrapped_lines("base shear", 15, 60.0, 2), ["base", "shear"]);
        assert_eq!(fitted("base shear", 15, 60.0), "base s…");
        let long_text = "x".repeat(1000);
        let three_lines = wrapped_lines(&long_text, 15, 80.0, 3);
        assert_eq!(three_lines.len(), 3);
        assert!(three_lines[2].ends_with('…') && !three_lines[1].ends_with('…'));
        assert!(three_lines.iter().all(|line| width(line, 15) <= 80.0));
        // A word too long for a line is broken, and the text after it is not lost.
        let broken_lines = wrapped_lines(&format!("{} end", "x".repeat(15)), 15, 80.0, 9);
        assert_eq!(broken_lines.concat().replace(' ', ""), format!("{}end", "x".repeat(15)));
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
