//! Columns of fixed width, as Fortran prints numbers.

/// Most numbers in a line, and widest of them, that a format may ask for.
const MOST: usize = 1000;

/// A Fortran format of one repeated item, such as `(8F10.5)` or `(1E15.6)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FixedColumns {
    /// Numbers in a full line.
    pub(super) repeat: usize,
    /// Characters of each.
    pub(super) width: usize,
}

impl FixedColumns {
    /// The last format in brackets that `text` has, or the one after `format=` without brackets;
    /// none if it is not one repeated item, or has a scale factor (`1P`).
    pub(super) fn find(text: &str) -> Option<Self> {
        let inside = |piece: &str| Self::parse(piece.split_once(')')?.0);
        let bare = || Self::parse(text.to_ascii_lowercase().split_once("format=")?.1);
        text.rsplit('(').find_map(inside).or_else(bare)
    }

    /// `8F10.5`, `10I8`, `1E15.6E2`.
    fn parse(item: &str) -> Option<Self> {
        let item = item.trim();
        let letter = item.find(|sign: char| !sign.is_ascii_digit())?;
        let (repeat, rest) = item.split_at(letter);
        let width = rest.strip_prefix(['F', 'f', 'E', 'e', 'G', 'g', 'D', 'd', 'I', 'i'])?;
        let (whole, decimals) = width.split_once('.').unwrap_or((width, ""));
        if !decimals.chars().all(|sign| sign.is_ascii_digit() || matches!(sign, 'E' | 'e')) {
            return None;
        }
        let repeat = if repeat.is_empty() { 1 } else { repeat.parse().ok()? };
        let width = whole.parse().ok()?;
        let known = (1..=MOST).contains(&repeat) && (1..=MOST).contains(&width);
        known.then_some(Self { repeat, width })
    }

    /// The fields of a line, as it stands in the file but for white space at its end.
    ///
    /// None if the line is not in these columns: longer than they are, not ASCII, or with white
    /// space inside a number.
    pub(super) fn fields(self, line: &str) -> Option<Vec<&str>> {
        if !line.is_ascii() || line.len() > self.repeat * self.width {
            return None;
        }
        let starts = (0..line.len()).step_by(self.width);
        let fields = starts.map(|start| line[start..line.len().min(start + self.width)].trim());
        let fields: Vec<_> = fields.collect();
        let whole = |field: &&str| !field.is_empty() && !field.contains(char::is_whitespace);
        fields.iter().all(whole).then_some(fields)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_found() {
        let columns = |repeat, width| Some(FixedColumns { repeat, width });
        for (text, known) in [
            ("4 points, in cm/sec2. (8f10.6)", columns(8, 10)),
            ("units=cm/s^2 (4),Format=(10F8.5)", columns(10, 8)),
            ("units=cm/sec2(04),Format=(1E15.6)", columns(1, 15)),
            ("Format= ( 6F13.6 )", columns(6, 13)),
            ("(E15.7E3)", columns(1, 15)),
            ("(10I8)", columns(10, 8)),
            ("(1P8E10.3)", None),
            ("(8F10.5,2X)", None),
            ("(*)", None),
            ("(4)", None),
            ("(0F8.5) (F0.5)", None),
            ("(99999999999999999999F8.5)", None),
            ("units=g,Format= 8F10.5", columns(8, 10)),
            ("8F10.5", None),
            ("", None),
        ] {
            assert_eq!(FixedColumns::find(text), known, "{text}");
        }
    }

    #[test]
    fn lines_are_cut() {
        let columns = FixedColumns { repeat: 3, width: 4 };
        assert_eq!(columns.fields("12345678"), Some(vec!["1234", "5678"]));
        assert_eq!(columns.fields("   1-2.312"), Some(vec!["1", "-2.3", "12"]));
        assert_eq!(columns.fields(""), Some(vec![]));
        for other in ["1 2 3", "1234        1", "123456781234 ", "é"] {
            assert_eq!(columns.fields(other), None, "{other}");
        }
    }
}
