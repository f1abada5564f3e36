//! Comparison of time series.

use super::table::ReferenceTable;

/// The whole number nearest to a number that is not negative.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and positive")]
pub fn nearest_integer(number: f64) -> usize {
    number.round() as usize
}

/// A column of a table at equally spaced times, starting at zero.
pub struct TabledSeries {
    step: f64,
    values: Vec<f64>,
}

impl TabledSeries {
    pub fn new(table: &ReferenceTable, column: &str) -> Self {
        let times = table.column("t");
        Self { step: times[1] - times[0], values: table.column(column) }
    }

    /// Time between samples.
    pub fn step(&self) -> f64 {
        self.step
    }

    pub fn duration(&self) -> f64 {
        self.step * (self.values.len() - 1) as f64
    }

    /// Value by the cubic through the four samples around `time`.
    pub fn at(&self, time: f64) -> f64 {
        let position = time / self.step;
        if (position - position.round()).abs() < 1e-6 {
            return self.values[nearest_integer(position)];
        }
        let first = nearest_integer(position.floor()).clamp(1, self.values.len() - 3) - 1;
        (0..4)
            .map(|i| {
                let weight: f64 = (0..4)
                    .filter(|j| *j != i)
                    .map(|j| (position - (first + j) as f64) / (i as f64 - j as f64))
                    .product();
                weight * self.values[first + i]
            })
            .sum()
    }

    /// Mean over the step of length `step` that ends at `time`, by Simpson's rule.
    ///
    /// It is the reference of a force that is constant over the step.
    pub fn mean(&self, time: f64, step: f64) -> f64 {
        (self.at(time - step) + 4.0 * self.at(time - 0.5 * step) + self.at(time)) / 6.0
    }
}

/// Euclidean norm of an error, relative to the norm of the reference.
#[derive(Debug, Clone, Copy, Default)]
pub struct RelativeError {
    error_square: f64,
    expected_square: f64,
}

impl RelativeError {
    pub fn add(&mut self, computed: f64, expected: f64) {
        self.error_square += (computed - expected).powi(2);
        self.expected_square += expected * expected;
    }

    pub fn relative(self) -> f64 {
        (self.error_square / self.expected_square).sqrt()
    }
}

/// Prints a line of a table of errors.
pub fn print_errors(scene: &str, names: &[&str], errors: &[f64]) {
    let fields: Vec<String> =
        names.iter().zip(errors).map(|(name, error)| format!("{name} {error:.2e}")).collect();
    println!("{scene:<44} {}", fields.join("  "));
}

/// Prints the errors and asserts that each is at most its limit.
#[track_caller]
pub fn assert_within(scene: &str, names: &[&str], errors: &[f64], limits: &[f64]) {
    print_errors(scene, names, errors);
    assert_eq!(errors.len(), limits.len());
    for ((name, error), limit) in names.iter().zip(errors).zip(limits) {
        assert!(error <= limit, "{scene}: error of {name} {error:.2e} above {limit:.2e}");
    }
}
