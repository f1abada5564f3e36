//! Text broken into lines.

/// Replaces the rest of a text that was cut.
const CUT: char = '…';

/// The text in lines of at most the `width` `room`, broken between words where possible.
///
/// A text that needs more than `most` lines is cut, and ends in "…".
pub(crate) fn wrapped(
    text: &str,
    room: f64,
    most: usize,
    width: impl Fn(&str) -> f64,
) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut cut = false;
    'all: for word in text.split_whitespace() {
        let mut line = lines.len() - 1;
        if !lines[line].is_empty() {
            // The last line takes as much of the word as fits.
            let fits = width(&format!("{} {word}", lines[line])) <= room;
            if fits || lines.len() == most {
                lines[line].push(' ');
            } else {
                lines.push(String::new());
                line += 1;
            }
        }
        for c in word.chars() {
            let wider = width(&format!("{}{c}", lines[line])) > room;
            if wider && lines.len() == most {
                cut = true;
                break 'all;
            }
            if wider {
                lines.push(String::new());
                line += 1;
            }
            lines[line].push(c);
        }
    }
    if let (true, Some(last)) = (cut, lines.last_mut()) {
        while !last.is_empty() && width(&format!("{last}{CUT}")) > room {
            last.pop();
        }
        *last = format!("{}{CUT}", last.trim_end());
    }
    lines
}

/// The text in lines of at most `most` characters, without control characters.
pub(crate) fn in_columns(text: &str, most: usize) -> Vec<String> {
    let plain = text.replace(|sign: char| sign.is_control() && !sign.is_whitespace(), "");
    wrapped(&plain, most as f64, usize::MAX, |line| line.chars().count() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_break() {
        assert_eq!(in_columns("one two\n three", 7), ["one two", "three"]);
        assert_eq!(in_columns("abcdefgh\u{7} ij", 3), ["abc", "def", "gh", "ij"]);
        assert_eq!(in_columns("", 3), [""]);
    }
}
