//! Text broken into lines.

/// Character that replaces the rest of a text that was cut.
const CUT_MARK: char = '…';

/// The text in lines no wider than `max_width`, broken between words where possible.
///
/// `width`: function that measures a text. A text that needs more than `max_lines` is cut, and ends in "…".
pub fn wrapped(
    text: &str,
    max_width: f64,
    max_lines: usize,
    width: impl Fn(&str) -> f64,
) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut is_cut = false;
    'words: for word in text.split_whitespace() {
        let mut line = lines.len() - 1;
        if !lines[line].is_empty() {
            // The last line takes as much of the word as fits.
            let fits = width(&format!("{} {word}", lines[line])) <= max_width;
            if fits || lines.len() == max_lines {
                lines[line].push(' ');
            } else {
                lines.push(String::new());
                line += 1;
            }
        }
        for character in word.chars() {
            let is_too_wide = width(&format!("{}{character}", lines[line])) > max_width;
            if is_too_wide && lines.len() == max_lines {
                is_cut = true;
                break 'words;
            }
            if is_too_wide {
                lines.push(String::new());
                line += 1;
            }
            lines[line].push(character);
        }
    }
    if is_cut && let Some(last) = lines.last_mut() {
        while !last.is_empty() && width(&format!("{last}{CUT_MARK}")) > max_width {
            last.pop();
        }
        *last = format!("{}{CUT_MARK}", last.trim_end());
    }
    lines
}

/// The text in lines of limited length, without control characters.
pub fn broken_lines(text: &str, max_characters: usize) -> Vec<String> {
    let plain =
        text.replace(|character: char| character.is_control() && !character.is_whitespace(), "");
    wrapped(&plain, max_characters as f64, usize::MAX, |line| line.chars().count() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_break() {
        assert_eq!(broken_lines("one two\n three", 7), ["one two", "three"]);
        assert_eq!(broken_lines("abcdefgh\u{7} ij", 3), ["abc", "def", "gh", "ij"]);
        assert_eq!(broken_lines("", 3), [""]);
    }
}
