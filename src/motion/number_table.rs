//! Lines of equally many numbers: the columns of a table, or one series along the lines?

/// Largest difference from equal steps, relative to the step, of counts and printed times in a few lines.
const EVEN_STEP_TOLERANCE: f64 = 0.01;
/// Number of lines from which times may be rounded to a whole step: a series then has no such column by chance.
const LINES_WITH_ROUNDED_TIMES: usize = 16;
/// Smallest number of lines that show steps other than whole numbers.
const LINES_WITH_ANY_STEP: usize = 4;
/// Number of lines from which differences are compared.
const LINES_TO_COMPARE: usize = 8;
/// Mean square of the differences over line ends, relative to the one down the columns, below which a series
/// continues over the line ends. A smooth series has at most a quarter, columns of one signal have one.
const CONTINUATION_RATIO: f64 = 0.5;

/// The same ratio above which columns are different quantities: it is one for numbers at random.
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
        let (&first, &last) = (values.first()?, values.last()?);
        let lines = values.len();
        let step = (last - first) / lines.saturating_sub(1).max(1) as f64;
        let wide = lines >= LINES_WITH_ROUNDED_TIMES;
        let tolerance = if wide { 1.0 } else { EVEN_STEP_TOLERANCE } * step.abs();
        let known = lines >= LINES_WITH_ANY_STEP || lines > 1 && step.fract() == 0.0;
        let even = values.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() <= tolerance);
        let straight = values
            .iter()
            .zip(0_u32..)
            .all(|(v, k)| (v - first - f64::from(k) * step).abs() <= tolerance);
        (known && step >= 0.0 && even && straight).then_some(step)
    }

    /// The first column, counted from 1, that counts, or has times or a constant, beside another one that does not.
    ///
    /// The second number is the mean step of that column.
    pub(super) fn even_column(&self) -> Option<(usize, f64)> {
        let steps: Vec<Option<f64>> = (0..self.columns).map(|k| self.equal_step(k)).collect();
        let all = steps.iter().all(Option::is_some);
        let first = steps.iter().position(Option::is_some).filter(|_| !all)?;
        Some((first + 1, steps[first]?))
    }

    /// Mean square of the differences over line ends, relative to the one down the columns.
    fn continuation(&self) -> f64 {
        let columns = self.columns;
        let square = |from: f64, to: f64| (to - from) * (to - from);
        let mut over_ends = 0.0;
        let mut down = 0.0;
        let ends = (columns.max(1) - 1..).step_by(columns.max(1));
        for (end, line) in ends.zip(self.values.chunks(columns.max(1)).skip(1)) {
            over_ends += square(self.values[end], line[0]);
            let above = &self.values[end + 1 - columns..=end];
            let line_down: f64 = above.iter().zip(line).map(|(a, b)| square(*a, *b)).sum();
            down += line_down / columns as f64;
        }
        over_ends / down
    }

    /// Whether the numbers change less over the line ends than down the columns, as one series along the lines does.
    pub(super) fn continues_along_lines(&self) -> bool {
        let lines = self.values.len() / self.columns.max(1);
        self.columns > 1 && lines >= LINES_TO_COMPARE && self.continuation() < CONTINUATION_RATIO
    }

    /// Whether the numbers jump over the line ends and change little down the columns, as different quantities do.
    pub(super) fn jumps_over_line_ends(&self) -> bool {
        let lines = self.values.len() / self.columns.max(1);
        let few = lines < LINES_TO_COMPARE;
        let limit = if few { JUMP_RATIO_OF_FEW_LINES } else { JUMP_RATIO };
        self.columns > 1 && lines > 1 && self.continuation() > limit
    }
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

    #[test]
    fn a_series_along_lines_is_told_from_columns() {
        let wave = |t: f64| (0.31 * t).sin() + 0.2 * (1.7 * t + 1.0).cos();
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
        let wave = |line: usize| (0.9 * line as f64).sin();
        let times = |step: f64| {
            table(
                20,
                move |line, column| if column == 1 { wave(line) } else { step * line as f64 },
                2,
            )
        };
        assert_eq!(times(0.25).even_column(), Some((1, 0.25)));
        assert_eq!(times(0.0).even_column(), Some((1, 0.0)));
        // 128 a second, printed to 1 ms.
        let rounded = table(
            20,
            |line, column| {
                if column == 1 { wave(line) } else { (line as f64 / 0.128).round() * 1e-3 }
            },
            2,
        );
        assert_eq!(rounded.even_column().map(|(column, _)| column), Some(1));
        // A ramp has equal steps in all columns.
        assert_eq!(table(20, |line, column| (8 * line + column) as f64, 8).even_column(), None);
        assert_eq!(
            table(2, |line, column| [[0.1, 0.5], [0.2, 0.4]][line][column], 2).even_column(),
            None
        );
        assert_eq!(
            table(2, |line, column| [[9.0, 0.5], [9.0, 0.4]][line][column], 2).even_column(),
            Some((1, 0.0))
        );
    }
}
