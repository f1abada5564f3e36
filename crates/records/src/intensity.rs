//! Peaks and intensities of records.

use super::integral::{Motion, quadratic_roots_within};
use super::{Record, STANDARD_GRAVITY};
use crate::error::{Result, positive, require};

impl Record {
    /// Peak ground acceleration, velocity and displacement (PGA, PGV, PGD).
    ///
    /// The largest magnitudes during the record, also between samples.
    pub fn peaks(&self) -> Motion {
        let mut velocity = max_magnitude(self.velocities().iter().copied());
        let mut displacement = max_magnitude(self.displacements().iter().copied());
        for index in 0..self.len() - 1 {
            let start = self.sample(index);
            let jerk = self.jerk(index);
            let a = start.acceleration;
            let v = start.velocity;
            // The velocity has an extreme where the acceleration vanishes.
            for elapsed_time in self.roots_in_step(a, jerk, 0.0) {
                velocity = velocity.max(start.after(elapsed_time, jerk).velocity.abs());
            }
            // The displacement has an extreme where the velocity vanishes.
            for elapsed_time in self.roots_in_step(v, a, jerk / 2.0) {
                displacement = displacement.max(start.after(elapsed_time, jerk).displacement.abs());
            }
        }
        Motion { acceleration: self.peak_acceleration(), velocity, displacement }
    }

    /// Roots of c₀ + c₁ s + c₂ s² within a time step.
    fn roots_in_step(&self, c0: f64, c1: f64, c2: f64) -> impl Iterator<Item = f64> {
        quadratic_roots_within(c0, c1, c2, self.time_step()).into_iter().flatten()
    }

    /// Largest |a|, m/s².
    pub(super) fn peak_acceleration(&self) -> f64 {
        max_magnitude(self.accelerations().iter().copied())
    }

    /// Arias intensity π/(2g) ∫ a² dt, m/s, with standard gravity.
    ///
    /// Arias, "A measure of earthquake intensity", in Hansen (ed.), *Seismic Design for Nuclear Power Plants*, MIT
    /// Press 1970, 438–483. Trapezoidal rule on the squared samples, as is usual; the square of the piecewise
    /// linear function has a smaller integral (by 4 % for El Centro at 0.02 s).
    ///
    /// ```
    /// let record = basemat::motion::el_centro_1940();
    /// assert!((record.arias_intensity() - 1.800979).abs() < 1e-6);
    /// ```
    pub fn arias_intensity(&self) -> f64 {
        let sum: f64 = self
            .accelerations()
            .windows(2)
            .map(|pair| f64::midpoint(pair[0] * pair[0], pair[1] * pair[1]))
            .sum();
        std::f64::consts::FRAC_PI_2 / STANDARD_GRAVITY * sum * self.time_step()
    }

    /// Times (s) at which the Arias intensity reaches two fractions of its final value.
    ///
    /// The significant duration is their difference, usually for 0.05 and 0.95. [`Record::trimmed`] cuts the
    /// record at these times.
    ///
    /// Trifunac & Brady, "A study on the duration of strong earthquake ground motion", Bull. Seism.
    /// Soc. Am. 65 (1975), 581–626. Linear between samples.
    ///
    /// ```
    /// let [start, end] = basemat::motion::el_centro_1940().significant_times(0.05, 0.95)?;
    /// assert!((start - 1.6688).abs() < 1e-4 && (end - 25.5121).abs() < 1e-4);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 ≤ `first_fraction` ≤ `second_fraction` ≤ 1 and the record is not
    /// zero throughout.
    pub fn significant_times(&self, first_fraction: f64, second_fraction: f64) -> Result<[f64; 2]> {
        let quantity = "fraction of the Arias intensity";
        let needed = "from 0 to 1, the second at least the first";
        require(quantity, first_fraction, (0.0..=1.0).contains(&first_fraction), needed)?;
        require(
            quantity,
            second_fraction,
            (first_fraction..=1.0).contains(&second_fraction),
            needed,
        )?;
        let peak = positive("peak acceleration of the record", self.peak_acceleration())?;
        // Relative to the peak: squares of tiny numbers vanish.
        let squares: Vec<f64> =
            self.accelerations().iter().map(|a| (a / peak) * (a / peak)).collect();
        let mut cumulative_sums = vec![0.0];
        for pair in squares.windows(2) {
            cumulative_sums
                .push(cumulative_sums[cumulative_sums.len() - 1] + f64::midpoint(pair[0], pair[1]));
        }
        let total = cumulative_sums[cumulative_sums.len() - 1];
        Ok([first_fraction, second_fraction]
            .map(|fraction| self.time_of_sum(fraction * total, &cumulative_sums)))
    }

    /// Time (s) at which `sums`, linear between samples, reach a value.
    fn time_of_sum(&self, value: f64, sums: &[f64]) -> f64 {
        let next_index = sums.partition_point(|&sum| sum < value).min(sums.len() - 1);
        if next_index == 0 {
            return 0.0;
        }
        let fraction = (value - sums[next_index - 1]) / (sums[next_index] - sums[next_index - 1]);
        (next_index as f64 - 1.0 + fraction.clamp(0.0, 1.0)) * self.time_step()
    }
}

/// Largest absolute value, or zero without values.
fn max_magnitude(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |max_so_far: f64, value| max_so_far.max(value.abs()))
}
