//! Breaks texts into lines.

/// Character at the end of a truncated text.
const TRUNCATION_MARK: char = '…';

/// Lines of a text, no wider than `max_width`, broken between words where possible.
///
/// `width`: function that measures a text. A text that needs more than `max_lines` is truncated, and ends in "…".
pub fn wrapped(
    text: &str,
    max_width: f64,
    max_lines: usize,
    width: impl Fn(&str) -> f64,
) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut is_truncated = false;
    'words: for word in text.split_whitespace() {
        let mut line_index = lines.len() - 1;
        if !lines[line_index].is_empty() {
            // A word that does not fit starts the next line, or on the last allowed line is truncated.
            let word_fits = width(&format!("{} {word}", lines[line_index])) <= max_width;
            if word_fits || lines.len() == max_lines {
                lines[line_index].push(' ');
            } else {
                lines.push(String::new());
                line_index += 1;
            }
        }
        for character in word.chars() {
            let is_too_wide = width(&format!("{}{character}", lines[line_index])) > max_width;
            if is_too_wide && lines.len() == max_lines {
                is_truncated = true;
                break 'words;
            }
            if is_too_wide {
                lines.push(String::new());
                line_index += 1;
            }
            lines[line_index].push(character);
        }
    }
    if is_truncated && let Some(last_line) = lines.last_mut() {
        while !last_line.is_empty() && width(&format!("{last_line}{TRUNCATION_MARK}")) > max_width {
            last_line.pop();
        }
        *last_line = format!("{}{TRUNCATION_MARK}", last_line.trim_end());
    }
    lines
}

/// Lines of a text, each of at most `max_characters` characters, without control characters.
pub fn broken_lines(text: &str, max_characters: usize) -> Vec<String> {
    let printable_text =
        text.replace(|character: char| character.is_control() && !character.is_whitespace(), "");
    wrapped(&printable_text, max_characters as f64, usize::MAX, |line| line.chars().count() as f64)
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
