//! Distinguishes the columns of a table from one series along the lines.

/// Largest difference of printed times from equal steps, relative to the step, in a few lines.
const EVEN_STEP_TOLERANCE: f64 = 0.01;
/// Number of lines from which times may be rounded to a whole step: a series then has no such column by chance.
const LINES_WITH_ROUNDED_TIMES: usize = 16;
/// Number of lines from which steps may be other than whole numbers.
const LINES_WITH_ANY_STEP: usize = 4;
/// Number of lines from which differences are compared.
const LINES_TO_COMPARE: usize = 8;
/// Ratio of differences below which a series continues from line to line.
///
/// The ratio is the mean square of the differences over line ends, divided by the one down the columns. A smooth series
/// has at most a quarter, columns of one signal have one.
const CONTINUATION_RATIO: f64 = 0.5;
/// Ratio of differences above which columns are different quantities: it is one for numbers at random.
const JUMP_RATIO: f64 = 4.0;
/// The same in fewer lines than [`LINES_TO_COMPARE`].
const JUMP_RATIO_OF_FEW_LINES: f64 = 16.0;

/// Numbers of lines with equally many fields each.
#[derive(Default)]
pub(super) struct NumberTable {
    columns: usize,
    values: Vec<f64>,
}

impl NumberTable {
    /// Appends a line; all have as many numbers as the first one.
    pub(super) fn push(&mut self, numbers: &[f64]) {
        self.columns = numbers.len();
        self.values.extend(numbers);
    }

    /// Mean step of a column, counted from 0, whose steps are equal: a count, a time, or a constant.
    fn equal_step(&self, column: usize) -> Option<f64> {
        let values: Vec<f64> =
            self.values.iter().skip(column).step_by(self.columns).copied().collect();
        let first = *values.first()?;
        let last = *values.last()?;
        let lines = values.len();
        let step = (last - first) / lines.saturating_sub(1).max(1) as f64;
        let may_be_rounded = lines >= LINES_WITH_ROUNDED_TIMES;
        let tolerance = if may_be_rounded { 1.0 } else { EVEN_STEP_TOLERANCE } * step.abs();
        let has_enough_lines = lines >= LINES_WITH_ANY_STEP || lines > 1 && step.fract() == 0.0;
        if !has_enough_lines || step < 0.0 || step.is_nan() {
            return None;
        }
        let steps_are_equal =
            values.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() <= tolerance);
        let lies_on_a_line = values
            .iter()
            .zip(0_u32..)
            .all(|(value, line)| (value - first - f64::from(line) * step).abs() <= tolerance);
        (steps_are_equal && lies_on_a_line).then_some(step)
    }

    /// The first column of counts, times or a constant, beside another one that does not have equal steps.
    pub(super) fn even_column(&self) -> Option<EvenColumn> {
        let steps: Vec<Option<f64>> =
            (0..self.columns).map(|column| self.equal_step(column)).collect();
        if steps.iter().all(Option::is_some) {
            return None;
        }
        let first = steps.iter().position(Option::is_some)?;
        Some(EvenColumn { number: first + 1, step: steps[first]? })
    }

    /// Mean square of the differences over line ends, relative to the one down the columns.
    fn continuation_ratio(&self) -> f64 {
        let columns = self.columns;
        let mut over_line_ends = 0.0;
        let mut down_columns = 0.0;
        let line_ends = (columns.max(1) - 1..).step_by(columns.max(1));
        for (end, line) in line_ends.zip(self.values.chunks(columns.max(1)).skip(1)) {
            over_line_ends += squared_difference(self.values[end], line[0]);
            let line_above = &self.values[end + 1 - columns..=end];
            let down_this_line: f64 =
                line_above.iter().zip(line).map(|(a, b)| squared_difference(*a, *b)).sum();
            down_columns += down_this_line / columns as f64;
        }
        over_line_ends / down_columns
    }

    /// Whether the numbers change less over the line ends than down the columns, as one series along the lines does.
    pub(super) fn continues_along_lines(&self) -> bool {
        let lines = self.values.len() / self.columns.max(1);
        self.columns > 1
            && lines >= LINES_TO_COMPARE
            && self.continuation_ratio() < CONTINUATION_RATIO
    }

    /// Whether the numbers jump over the line ends and change little down the columns, as different quantities do.
    pub(super) fn jumps_over_line_ends(&self) -> bool {
        let lines = self.values.len() / self.columns.max(1);
        let min_ratio = if lines < LINES_TO_COMPARE { JUMP_RATIO_OF_FEW_LINES } else { JUMP_RATIO };
        self.columns > 1 && lines > 1 && self.continuation_ratio() > min_ratio
    }
}

/// A column whose steps are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EvenColumn {
    /// Number of the column, counted from 1.
    pub(super) number: usize,
    /// Mean step down the column.
    pub(super) step: f64,
}

fn squared_difference(from: f64, to: f64) -> f64 {
    (to - from) * (to - from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(lines: usize, value: impl Fn(usize, usize) -> f64, columns: usize) -> NumberTable {
        let mut table = NumberTable::default();
        for line in 0..lines {
            let numbers: Vec<f64> = (0..columns).map(|column| value(line, column)).collect();
            table.push(&numbers);
        }
        table
    }

    fn wave(t: f64) -> f64 {
        (0.31 * t).sin() + 0.2 * (1.7 * t + 1.0).cos()
    }

    /// Twenty lines of evenly spaced times and a sine.
    fn times_and_sine(time: impl Fn(f64) -> f64) -> NumberTable {
        let value = |line: usize, column: usize| {
            let line = line as f64;
            if column == 1 { (0.9 * line).sin() } else { time(line) }
        };
        table(20, value, 2)
    }

    fn even_column(number: usize, step: f64) -> EvenColumn {
        EvenColumn { number, step }
    }

    #[test]
    fn a_series_along_lines_is_told_from_columns() {
        for columns in 2..10 {
            let series = table(40, |line, column| wave((line * columns + column) as f64), columns);
            assert!(series.continues_along_lines(), "{columns}");
            assert_eq!(series.even_column(), None, "{columns}");
            // The same signal in all columns, and another one in each.
            let same = table(40, |line, _| wave(line as f64), columns);
            assert!(!same.continues_along_lines(), "{columns}");
            let other = table(40, |line, column| wave(line as f64 + 2.9 * column as f64), columns);
            assert!(!other.continues_along_lines(), "{columns}");
            // Columns at another level.
            let level = table(40, |line, column| wave(line as f64) + 9.0 * column as f64, columns);
            assert!(level.jumps_over_line_ends() && !series.jumps_over_line_ends(), "{columns}");
            assert!(!same.jumps_over_line_ends(), "{columns}");
        }
    }

    #[test]
    fn counts_times_and_constants_are_found() {
        let quarters = times_and_sine(|line| 0.25 * line);
        assert_eq!(quarters.even_column(), Some(even_column(1, 0.25)));
        let zeros = times_and_sine(|line| 0.0 * line);
        assert_eq!(zeros.even_column(), Some(even_column(1, 0.0)));
        // 128 a second, printed to 1 ms.
        let rounded = times_and_sine(|line| (line / 0.128).round() * 1e-3);
        assert_eq!(rounded.even_column().map(|column| column.number), Some(1));
        // A ramp has equal steps in all columns.
        let ramp = table(20, |line, column| (8 * line + column) as f64, 8);
        assert_eq!(ramp.even_column(), None);
        let decimals = table(2, |line, column| [[0.1, 0.5], [0.2, 0.4]][line][column], 2);
        assert_eq!(decimals.even_column(), None);
        let constant = table(2, |line, column| [[9.0, 0.5], [9.0, 0.4]][line][column], 2);
        assert_eq!(constant.even_column(), Some(even_column(1, 0.0)));
    }
}
