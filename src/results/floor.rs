//! Floor response spectra of points of the structure.

use super::TimeSeries;
use crate::coupled::Probe;
use crate::error::{Result, not_negative, positive, require, require_part, unobserved};
use crate::motion::{Record, SpectralOrdinate};

impl TimeSeries {
    /// The record of an acceleration probe (total acceleration, m/s²), from rest.
    ///
    /// With the midpoint and θ rules accelerations are means over steps. The record is then half a step late,
    /// which does not affect a spectrum. A floor's vibration should have ten steps or more in its period.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if no probe has this name; [`Error::Scene`](crate::Error::Scene) if the
    /// probe contains displacements or velocities, or if not every step is kept; as for [`Record::new`].
    pub fn acceleration_record(&self, probe: &str) -> Result<Record> {
        let index = self.probe_index(probe)?;
        let Probe { displacement, velocity, acceleration, .. } = &self.probes[index];
        let quantity = "floor spectrum";
        let has_acceleration_only =
            displacement.is_empty() && velocity.is_empty() && !acceleration.is_empty();
        let needed = "the probe must contain accelerations only";
        require_part(quantity, has_acceleration_only, needed)?;
        let keeps_every_step = self.recorder.every == 1;
        require_part(quantity, keeps_every_step, "the recorder must keep every step")?;
        let recorded_duration = (self.times().len().max(1) - 1) as f64 * self.time_step;
        let run_duration = self.sequence.last_time() - self.times()[0];
        // A missing step makes a difference of at least one time step.
        let is_complete = (recorded_duration - run_duration).abs() <= 0.5 * self.time_step;
        require_part(quantity, is_complete, "every step of the run must have been recorded")?;
        Record::new(self.time_step, self.probe_values[index].clone())
    }

    /// Floor (in-structure) response spectrum at the point of an acceleration probe.
    ///
    /// Returns the largest response of oscillators on that point, at `periods` (s) with the damping ratio `damping`. After
    /// the end of the time series each oscillator vibrates freely for one period, and the peaks of this vibration are
    /// included. In this period the point does not move: run until the floor is at rest.
    /// Periods of fewer than ten time steps are not exact: at a period of 0.05 s a step of 0.02 s reduces the
    /// response by 11 %. [`Record::coarse_spectrum`] warns of them. Use a shorter time step for such periods.
    ///
    /// # Errors
    /// As for [`TimeSeries::acceleration_record`] and [`Record::response_spectrum`].
    pub fn floor_spectrum(
        &self,
        probe: &str,
        periods: &[f64],
        damping: f64,
    ) -> Result<Vec<SpectralOrdinate>> {
        self.acceleration_record(probe)?.response_spectrum(periods, damping, &mut unobserved)
    }
}

/// `count` numbers from `first` to `last` with equal ratios, for periods.
///
/// ```
/// let periods = basemat::results::log_spaced(0.1, 10.0, 3)?;
/// assert!((periods[1] - 1.0).abs() < 1e-15 && periods[2] == 10.0);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless both are positive, and for fewer than two numbers or more than a million.
pub fn log_spaced(first: f64, last: f64, count: usize) -> Result<Vec<f64>> {
    positive("first of the numbers", first)?;
    positive("last of the numbers", last)?;
    let needed = "from two to a million";
    require("count of numbers", count as f64, (2..=1_000_000).contains(&count), needed)?;
    let mut numbers = Vec::with_capacity(count);
    for k in 0..count {
        let fraction = k as f64 / (count - 1) as f64;
        numbers.push(first.powf(1.0 - fraction) * last.powf(fraction));
    }
    numbers[0] = first;
    numbers[count - 1] = last;
    Ok(numbers)
}

/// A spectrum with peaks broadened to frequencies `fraction` lower and higher.
///
/// This covers uncertainty of soil and structure: 0.15 in U.S. NRC Regulatory Guide 1.122, rev. 1 (1978). The
/// ordinate at every frequency f is spread over (1 − fraction) f to (1 + fraction) f, and the largest ordinate at
/// each frequency counts. At the period T it is the largest of the spectrum between (1 − fraction) T and (1 +
/// fraction) T. Between its periods the spectrum is linear in the logarithm of the period.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless 0 ≤ `fraction` < 1 and the periods increase.
pub fn broadened(spectrum: &[SpectralOrdinate], fraction: f64) -> Result<Vec<SpectralOrdinate>> {
    not_negative("fraction of broadening", fraction)?;
    require("fraction of broadening", fraction, fraction < 1.0, "below one")?;
    let mut previous_period = 0.0;
    for ordinate in spectrum {
        positive("step to the next period of a spectrum", ordinate.period - previous_period)?;
        previous_period = ordinate.period;
    }
    Ok(spectrum
        .iter()
        .map(|center| broadened_ordinate(spectrum, center, fraction))
        .collect())
}

/// The largest values of a spectrum in a band around one of its ordinates.
fn broadened_ordinate(
    spectrum: &[SpectralOrdinate],
    center: &SpectralOrdinate,
    fraction: f64,
) -> SpectralOrdinate {
    let min_period = center.period * (1.0 - fraction);
    let max_period = center.period * (1.0 + fraction);
    let mut band_maximum = SpectralOrdinate {
        period: center.period,
        displacement: 0.0,
        pseudo_velocity: 0.0,
        pseudo_acceleration: 0.0,
        acceleration: 0.0,
    };
    let inner_ordinates = spectrum
        .iter()
        .filter(|ordinate| (min_period..=max_period).contains(&ordinate.period));
    let end_ordinates = [min_period, max_period]
        .into_iter()
        .filter_map(|period| interpolated(spectrum, period));
    for ordinate in inner_ordinates.copied().chain(end_ordinates) {
        band_maximum.displacement = band_maximum.displacement.max(ordinate.displacement);
        band_maximum.pseudo_velocity = band_maximum.pseudo_velocity.max(ordinate.pseudo_velocity);
        band_maximum.pseudo_acceleration =
            band_maximum.pseudo_acceleration.max(ordinate.pseudo_acceleration);
        band_maximum.acceleration = band_maximum.acceleration.max(ordinate.acceleration);
    }
    band_maximum
}

/// The ordinate at `period`; `None` outside the spectrum.
fn interpolated(spectrum: &[SpectralOrdinate], period: f64) -> Option<SpectralOrdinate> {
    let neighbours = spectrum
        .windows(2)
        .find(|neighbours| period >= neighbours[0].period && period <= neighbours[1].period)?;
    let fraction =
        (period / neighbours[0].period).ln() / (neighbours[1].period / neighbours[0].period).ln();
    let interpolate = |shorter_value: f64, longer_value: f64| {
        (1.0 - fraction) * shorter_value + fraction * longer_value
    };
    Some(SpectralOrdinate {
        period,
        displacement: interpolate(neighbours[0].displacement, neighbours[1].displacement),
        pseudo_velocity: interpolate(neighbours[0].pseudo_velocity, neighbours[1].pseudo_velocity),
        pseudo_acceleration: interpolate(
            neighbours[0].pseudo_acceleration,
            neighbours[1].pseudo_acceleration,
        ),
        acceleration: interpolate(neighbours[0].acceleration, neighbours[1].acceleration),
    })
}
