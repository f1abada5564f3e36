//! Peaks and intensities of records.

use super::integral::quadratic_roots_within;
use super::{Record, STANDARD_GRAVITY};

impl Record {
    /// Peak ground acceleration (PGA): largest |a|, m/s².
    pub fn peak_acceleration(&self) -> f64 {
        largest(self.accelerations().iter().copied())
    }

    /// Peak ground velocity (PGV): largest |v| at any time, between samples too, m/s.
    pub fn peak_velocity(&self) -> f64 {
        let between = (0..self.len() - 1).flat_map(|index| {
            let start = self.sample(index);
            let jerk = self.jerk(index);
            quadratic_roots_within(start.acceleration, jerk, 0.0, self.time_step())
                .into_iter()
                .flatten()
                .map(move |elapsed| start.after(elapsed, jerk).velocity)
        });
        largest(self.velocities().iter().copied().chain(between))
    }

    /// Peak ground displacement (PGD): largest |u| during the record, between samples too, m.
    pub fn peak_displacement(&self) -> f64 {
        let between = (0..self.len() - 1).flat_map(|index| {
            let start = self.sample(index);
            let jerk = self.jerk(index);
            let (v, a) = (start.velocity, start.acceleration);
            quadratic_roots_within(v, a, jerk / 2.0, self.time_step())
                .into_iter()
                .flatten()
                .map(move |elapsed| start.after(elapsed, jerk).displacement)
        });
        largest(self.displacements().iter().copied().chain(between))
    }

    /// Arias intensity π/(2g) ∫ a² dt, m/s, with standard gravity.
    ///
    /// Arias, "A measure of earthquake intensity", in Hansen (ed.), *Seismic Design for Nuclear
    /// Power Plants*, MIT Press 1970, 438–483. Trapezoidal rule on the squared samples, as is the
    /// custom; the square of the piecewise linear function has a smaller integral (by 4 % for El
    /// Centro at 0.02 s).
    ///
    /// ```
    /// let record = basemat::motion::el_centro_1940();
    /// assert!((record.arias_intensity() - 1.800979).abs() < 1e-6);
    /// ```
    pub fn arias_intensity(&self) -> f64 {
        let sum: f64 =
            self.accelerations().windows(2).map(|a| f64::midpoint(a[0] * a[0], a[1] * a[1])).sum();
        std::f64::consts::FRAC_PI_2 / STANDARD_GRAVITY * sum * self.time_step()
    }
}

/// Largest absolute value.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, value| most.max(value.abs()))
}
