//! Distinguishes the columns of a table from one series along the lines.

/// Largest difference of printed times from equal steps, relative to the step, in a few lines.
const EQUAL_STEP_TOLERANCE: f64 = 0.01;
/// Number of lines from which times may be rounded by a whole step.
///
/// A series along so many lines has no such column by chance.
const MIN_LINES_WITH_ROUNDED_TIMES: usize = 16;
/// Number of lines from which equal steps may be fractions.
///
/// In fewer lines only counts have equal steps.
const MIN_LINES_WITH_FRACTIONAL_STEPS: usize = 4;
/// Number of lines from which the mean of the differences is a reliable measure.
const MIN_LINES_FOR_MEAN: usize = 8;
/// Ratio of differences below which a series continues from line to line.
///
/// The ratio is the mean square of the differences over line ends, divided by the mean square down the columns. It is
/// at most a quarter for a smooth series, and one for columns of one signal.
const MAX_CONTINUATION_RATIO: f64 = 0.5;
/// Ratio of differences above which columns are different quantities; it is one for random numbers.
const MIN_JUMP_RATIO: f64 = 4.0;
/// Ratio of differences above which columns of fewer lines than [`MIN_LINES_FOR_MEAN`] are different quantities.
const MIN_JUMP_RATIO_OF_FEW_LINES: f64 = 16.0;

/// Numbers of lines with equally many fields each.
#[derive(Default)]
pub(super) struct NumberTable {
    /// Number of columns.
    column_count: usize,
    /// Numbers, line by line.
    values: Vec<f64>,
}

impl NumberTable {
    /// Appends a line; all have as many numbers as the first one.
    pub(super) fn push(&mut self, numbers: &[f64]) {
        self.column_count = numbers.len();
        self.values.extend(numbers);
    }

    /// Mean step of a column of counts, times or a constant.
    ///
    /// `None` for other columns.
    ///
    /// `column`: index of the column, from 0.
    fn equal_step(&self, column: usize) -> Option<f64> {
        let values: Vec<f64> =
            self.values.iter().skip(column).step_by(self.column_count).copied().collect();
        let first_value = *values.first()?;
        let last_value = *values.last()?;
        let line_count = values.len();
        let step = (last_value - first_value) / line_count.saturating_sub(1).max(1) as f64;
        let may_have_rounded_times = line_count >= MIN_LINES_WITH_ROUNDED_TIMES;
        let tolerance =
            if may_have_rounded_times { 1.0 } else { EQUAL_STEP_TOLERANCE } * step.abs();
        let has_enough_lines =
            line_count >= MIN_LINES_WITH_FRACTIONAL_STEPS || line_count > 1 && step.fract() == 0.0;
        if !has_enough_lines || step < 0.0 || step.is_nan() {
            return None;
        }
        let steps_are_equal =
            values.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() <= tolerance);
        let is_linear = values
            .iter()
            .zip(0_u32..)
            .all(|(value, line)| (value - first_value - f64::from(line) * step).abs() <= tolerance);
        (steps_are_equal && is_linear).then_some(step)
    }

    /// The first column with equal steps; `None` if no column has them, or if all have.
    pub(super) fn equal_step_column(&self) -> Option<EqualStepColumn> {
        let steps: Vec<Option<f64>> =
            (0..self.column_count).map(|column| self.equal_step(column)).collect();
        if steps.iter().all(Option::is_some) {
            return None;
        }
        let first_index = steps.iter().position(Option::is_some)?;
        Some(EqualStepColumn { number: first_index + 1, step: steps[first_index]? })
    }

    /// Mean square of the differences over line ends, relative to the mean square down the columns.
    fn continuation_ratio(&self) -> f64 {
        let column_count = self.column_count;
        let mut line_end_sum = 0.0;
        let mut column_sum = 0.0;
        let line_end_indices = (column_count.max(1) - 1..).step_by(column_count.max(1));
        for (end_index, line) in
            line_end_indices.zip(self.values.chunks(column_count.max(1)).skip(1))
        {
            line_end_sum += squared_difference(self.values[end_index], line[0]);
            let previous_line = &self.values[end_index + 1 - column_count..=end_index];
            let line_sum: f64 = previous_line
                .iter()
                .zip(line)
                .map(|(previous_value, value)| squared_difference(*previous_value, *value))
                .sum();
            column_sum += line_sum / column_count as f64;
        }
        line_end_sum / column_sum
    }

    /// Whether the numbers are one series along the lines.
    ///
    /// Such a series changes less over the line ends than down the columns.
    pub(super) fn continues_along_lines(&self) -> bool {
        let line_count = self.values.len() / self.column_count.max(1);
        self.column_count > 1
            && line_count >= MIN_LINES_FOR_MEAN
            && self.continuation_ratio() < MAX_CONTINUATION_RATIO
    }

    /// Whether the columns are different quantities.
    ///
    /// Such numbers jump over the line ends and change little down the columns.
    pub(super) fn jumps_over_line_ends(&self) -> bool {
        let line_count = self.values.len() / self.column_count.max(1);
        let min_ratio = if line_count < MIN_LINES_FOR_MEAN {
            MIN_JUMP_RATIO_OF_FEW_LINES
        } else {
            MIN_JUMP_RATIO
        };
        self.column_count > 1 && line_count > 1 && self.continuation_ratio() > min_ratio
    }
}

/// A column whose steps are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EqualStepColumn {
    /// Number of the column, counted from 1.
    pub(super) number: usize,
    /// Mean step down the column.
    pub(super) step: f64,
}

fn squared_difference(first: f64, second: f64) -> f64 {
    (second - first) * (second - first)
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

    fn equal_step_column(number: usize, step: f64) -> EqualStepColumn {
        EqualStepColumn { number, step }
    }

    #[test]
    fn a_series_along_lines_is_distinguished_from_columns() {
        for columns in 2..10 {
            let series = table(40, |line, column| wave((line * columns + column) as f64), columns);
            assert!(series.continues_along_lines(), "{columns}");
            assert_eq!(series.equal_step_column(), None, "{columns}");
            // The same signal in all columns, and another one in each.
            let equal_columns = table(40, |line, _| wave(line as f64), columns);
            assert!(!equal_columns.continues_along_lines(), "{columns}");
            let shifted_columns =
                table(40, |line, column| wave(line as f64 + 2.9 * column as f64), columns);
            assert!(!shifted_columns.continues_along_lines(), "{columns}");
            // Columns at another level.
            let offset_columns =
                table(40, |line, column| wave(line as f64) + 9.0 * column as f64, columns);
            assert!(
                offset_columns.jumps_over_line_ends() && !series.jumps_over_line_ends(),
                "{columns}"
            );
            assert!(!equal_columns.jumps_over_line_ends(), "{columns}");
        }
    }

    #[test]
    fn counts_times_and_constants_are_found() {
        let quarters = times_and_sine(|line| 0.25 * line);
        assert_eq!(quarters.equal_step_column(), Some(equal_step_column(1, 0.25)));
        let zeros = times_and_sine(|line| 0.0 * line);
        assert_eq!(zeros.equal_step_column(), Some(equal_step_column(1, 0.0)));
        // 128 a second, printed to 1 ms.
        let rounded_times = times_and_sine(|line| (line / 0.128).round() * 1e-3);
        assert_eq!(rounded_times.equal_step_column().map(|column| column.number), Some(1));
        // A ramp has equal steps in all columns.
        let ramp = table(20, |line, column| (8 * line + column) as f64, 8);
        assert_eq!(ramp.equal_step_column(), None);
        let decimals = table(2, |line, column| [[0.1, 0.5], [0.2, 0.4]][line][column], 2);
        assert_eq!(decimals.equal_step_column(), None);
        let constant = table(2, |line, column| [[9.0, 0.5], [9.0, 0.4]][line][column], 2);
        assert_eq!(constant.equal_step_column(), Some(equal_step_column(1, 0.0)));
    }
}
