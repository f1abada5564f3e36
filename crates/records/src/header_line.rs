//! Lines before the numbers of a file, and the titles of columns in them.

use std::collections::VecDeque;
use std::ops::RangeInclusive;

use super::AccelerationUnit;
use super::column_title::{
    acceleration_unit, check_acceleration, check_time, first_word, is_unit_alone, time_unit,
};
use super::fault::FaultResult;
use super::lines::is_all_digits;
use super::unit_name::is_unit;
use crate::text::decimal::finite;

/// Largest number of lines before the numbers in which titles are sought.
const MAX_TITLE_LINES: usize = 100;

/// The lines before the numbers of a file with columns.
#[derive(Default)]
pub(super) struct HeaderLines(VecDeque<String>);

impl HeaderLines {
    /// Adds a line.
    pub(super) fn add(&mut self, line: &str) {
        let line = line.trim_start_matches('#').trim();
        // A `%` without a space may begin a unit.
        let comment_marks = ["% ", "// ", "! ", "; ", "* "];
        let line = comment_marks.iter().find_map(|mark| line.strip_prefix(mark)).unwrap_or(line);
        if line.contains(char::is_alphabetic) {
            if self.0.len() == MAX_TITLE_LINES {
                self.0.pop_front();
            }
            self.0.push_back(line.to_owned());
        }
    }

    /// The titles in each line.
    ///
    /// The number of columns may be any of a range, as the last cells of a line may be empty.
    pub(super) fn titles(&self, columns: &RangeInclusive<usize>) -> ColumnTitles {
        ColumnTitles(self.0.iter().map(|line| LineTitles::read(line, columns)).collect())
    }
}

/// Titles of columns, line by line.
pub(super) struct ColumnTitles(Vec<LineTitles>);

impl ColumnTitles {
    /// Returns an error if a title of a column of times names another unit than the second.
    ///
    /// `column`: number of the column, from 1.
    pub(super) fn check_time(&self, column: usize) -> FaultResult<()> {
        let mut titles = self.titles(column, |first_word| matches!(first_word, "t" | "time"));
        titles.find(|title| time_unit(title).is_some()).map_or(Ok(()), check_time)
    }

    /// Returns an error if a title of a column of accelerations names another unit or quantity.
    ///
    /// `column`: number of the column, from 1.
    pub(super) fn check_acceleration(
        &self,
        column: usize,
        expected_unit: AccelerationUnit,
    ) -> FaultResult<()> {
        if let Some(name) = self.name(column) {
            check_acceleration(name, expected_unit)?;
        }
        let mut titles = self.titles(column, |first_word| {
            first_word.starts_with("acc") || matches!(first_word, "unit" | "units")
        });
        let title = titles.find(|title| acceleration_unit(title).is_some());
        title.map_or(Ok(()), |title| check_acceleration(title, expected_unit))
    }

    /// Titles of a column, counted from 1, from the last line to the first.
    ///
    /// A line that is a single title belongs to the column if `is_key` accepts its first word.
    fn titles(&self, column: usize, is_key: fn(&str) -> bool) -> impl Iterator<Item = &str> {
        let lines = self.0.iter().rev();
        lines.filter_map(move |line| line.title(column).or_else(|| line.single_title(is_key)))
    }

    /// Whether a line has a title for each column.
    pub(super) fn name_all_columns(&self) -> bool {
        self.0.iter().any(|line| matches!(line, LineTitles::All(_)))
    }

    /// Names of columns of accelerations.
    ///
    /// Returns an error if a title names a unit other than `expected_unit`.
    pub(super) fn acceleration_names(
        &self,
        columns: &[usize],
        expected_unit: AccelerationUnit,
    ) -> FaultResult<Vec<String>> {
        let mut names = Vec::new();
        for &column in columns {
            self.check_acceleration(column, expected_unit)?;
            names.push(self.name(column).map_or_else(|| format!("column {column}"), str::to_owned));
        }
        Ok(names)
    }

    /// The name of a column, counted from 1.
    ///
    /// It is the last title that is more than a unit.
    fn name(&self, column: usize) -> Option<&str> {
        let mut titles = self.0.iter().rev().filter_map(|line| line.title(column));
        titles.find(|title| !is_unit_alone(title))
    }
}

/// Titles of columns in a line.
enum LineTitles {
    /// Titles of all columns.
    All(Vec<String>),
    /// The text of a line with a title of one column, or with none.
    One(String),
}

impl LineTitles {
    /// Reads a line as titles of a number of columns in this range.
    fn read(line: &str, columns: &RangeInclusive<usize>) -> Self {
        let separator = [';', ','].into_iter().find(|&separator| line.contains(separator));
        let mut readings = Vec::new();
        if let Some(separator) = separator {
            readings.push(with_brackets(cells(line, separator)));
        }
        readings.push(titles_of_words(line));
        readings.push(words(line, |character| character == '\t', 1));
        readings.push(words(line, char::is_whitespace, 2));
        readings.push(split_after_brackets(line));
        let with_units: Vec<_> = readings.iter().map(|titles| with_units(titles)).collect();
        readings.extend(with_units);
        readings.push(vec![line.to_owned()]);
        match readings.into_iter().find(|titles| are_titles_of(columns, titles)) {
            Some(titles) => Self::All(titles),
            None => Self::One(line.to_owned()),
        }
    }

    /// The title of a column, counted from 1, if the line has one.
    fn title(&self, column: usize) -> Option<&str> {
        let Self::All(titles) = self else { return None };
        titles
            .get(column.checked_sub(1)?)
            .map(String::as_str)
            .filter(|title| !title.is_empty())
    }

    /// The line, if it is a single title and `is_key` accepts its first word.
    fn single_title(&self, is_key: fn(&str) -> bool) -> Option<&str> {
        let Self::One(line) = self else { return None };
        (is_key(&first_word(line)) && !states_a_number(line)).then_some(line)
    }
}

/// Whether texts may be the titles of a number of columns in this range.
fn are_titles_of(columns: &RangeInclusive<usize>, titles: &[String]) -> bool {
    let last_index = titles.iter().rposition(|title| !title.is_empty());
    last_index.is_some_and(|index| columns.contains(&(index + 1)))
        && !titles.iter().any(|title| states_a_number(title))
}

/// Splits a line into titles of one word each, with the brackets after it.
pub(super) fn titles_of_words(line: &str) -> Vec<String> {
    with_brackets(words(line, char::is_whitespace, 1))
}

/// Splits a line into cells at each `separator` outside brackets; cells may be empty.
fn cells(line: &str, separator: char) -> Vec<String> {
    let mut depth = 0;
    let cells = line.split(|character| {
        depth = depth_after(character, depth);
        character == separator && depth == 0
    });
    cells.map(|cell| cell.trim().to_owned()).collect()
}

/// Splits a line into words at `min_separators` or more separators outside brackets.
fn words(line: &str, is_separator: fn(char) -> bool, min_separators: usize) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut depth = 0;
    let mut gap = String::new();
    for character in line.chars() {
        depth = depth_after(character, depth);
        if is_separator(character) && depth == 0 {
            gap.push(character);
            continue;
        }
        if gap.chars().count() >= min_separators {
            words.push(String::new());
        } else if let Some(word) = words.last_mut() {
            word.push_str(&gap);
        }
        gap.clear();
        if let Some(word) = words.last_mut() {
            word.push(character);
        }
    }
    let words = words.into_iter().map(|word| word.trim().to_owned());
    words.filter(|word| !word.is_empty()).collect()
}

/// Number of open brackets after a character; `depth` is the number before it.
fn depth_after(character: char, depth: usize) -> usize {
    match character {
        '(' | '[' | '{' | '（' => depth + 1,
        ')' | ']' | '}' | '）' => depth.saturating_sub(1),
        _ => depth,
    }
}

/// Characters that open a bracket.
const OPENING_BRACKETS: [char; 4] = ['(', '[', '{', '（'];

/// Joins each title with the brackets after it, unless the title has brackets already.
fn with_brackets(titles: Vec<String>) -> Vec<String> {
    let mut merged_titles: Vec<String> = Vec::new();
    for title in titles {
        let last_title = merged_titles.last_mut();
        match last_title.filter(|title| !title.is_empty() && !title.contains(OPENING_BRACKETS)) {
            Some(last_title) if title.starts_with(OPENING_BRACKETS) => {
                last_title.push(' ');
                last_title.push_str(&title);
            }
            _ => merged_titles.push(title),
        }
    }
    merged_titles
}

/// Joins each title with the unit after it, as in `t in s  a in g`.
///
/// A title that has a unit already stays as it is.
fn with_units(titles: &[String]) -> Vec<String> {
    let mut merged_titles: Vec<String> = Vec::new();
    let mut has_unit = true;
    for title in titles {
        let is_preposition = title == "in";
        let may_belong_to_unit = is_preposition || is_unit(title);
        let last_title = merged_titles.last_mut().filter(|_| !has_unit && may_belong_to_unit);
        if let Some(last_title) = last_title {
            last_title.push(' ');
            last_title.push_str(title);
            has_unit = !is_preposition;
        } else {
            merged_titles.push(title.clone());
            has_unit = title.contains(OPENING_BRACKETS);
        }
    }
    merged_titles
}

/// Splits a line after each outer bracket: `Elapsed time [s] Ground acceleration [cm/s2]`.
fn split_after_brackets(line: &str) -> Vec<String> {
    let mut depth = 0;
    let parts = line.split_inclusive(|character| {
        let previous_depth = depth;
        depth = depth_after(character, depth);
        previous_depth > 0 && depth == 0
    });
    let parts = parts.map(|part| part.trim_matches([' ', '\t', ',', ';']).to_owned());
    parts.filter(|part| !part.is_empty()).collect()
}

/// Whether a text states a value, as in `PGA (g) 0.31`.
///
/// Numbers of channels and azimuths, as in `CH 1` and `H 090`, are names.
fn states_a_number(text: &str) -> bool {
    let mut words = text.split([' ', '\t', '=', ':', ',']).filter(|word| !word.is_empty());
    finite(text).is_some()
        || words.any(|word| finite(word).is_some() && !is_channel_or_azimuth(word))
}

/// Largest number of digits of a channel's number.
const MAX_CHANNEL_DIGITS: usize = 2;

/// Whether a word may be the number of a channel or an azimuth.
fn is_channel_or_azimuth(word: &str) -> bool {
    let is_azimuth = word.len() == 3 && (word.starts_with('0') || word == "180" || word == "270");
    is_all_digits(word) && (word.len() <= MAX_CHANNEL_DIGITS || is_azimuth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read_as_titles_in_many_ways() {
        for (line, titles) in [
            ("t,a", "t|a"),
            ("time (ms) a [cm/s2]", "time (ms)|a [cm/s2]"),
            ("(s),(cm/s2)", "(s)|(cm/s2)"),
            ("(s) (cm/s2)", "(s)|(cm/s2)"),
            ("time, (ms), a, (g)", "time (ms)|a (g)"),
            ("t (s), a (g, filtered)", "t (s)|a (g, filtered)"),
            (
                "Elapsed time [s] Ground acceleration [cm/s2]",
                "Elapsed time [s]|Ground acceleration [cm/s2]",
            ),
            ("Elapsed time\tGround acceleration", "Elapsed time|Ground acceleration"),
            ("Elapsed time  Ground acceleration", "Elapsed time|Ground acceleration"),
            ("t ms a cm/s2", "t ms|a cm/s2"),
            ("t in s a in g", "t in s|a in g"),
            ("Time, s; Acc, g", "Time, s|Acc, g"),
            ("Time, s, Acc, g", "Time s|Acc g"),
            ("t (s), CH 1 (g)", "t (s)|CH 1 (g)"),
            ("t,a,", "t|a|"),
        ] {
            let LineTitles::All(found) = LineTitles::read(line, &(2..=2)) else {
                panic!("{line}")
            };
            assert_eq!(found.join("|"), titles, "{line}");
        }
        for line in [
            "PGA (g) 0.31",
            "PGA (g): 312",
            "one two three",
            "dt = 0.02",
            "Station 1000",
            "time (s)",
        ] {
            assert!(matches!(LineTitles::read(line, &(2..=2)), LineTitles::One(_)), "{line}");
        }
    }
}
