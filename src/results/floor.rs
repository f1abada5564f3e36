//! Floor response spectra of points of the structure.

use super::TimeSeries;
use crate::coupled::Probe;
use crate::error::{Error, Result, not_negative, positive, require, unobserved};
use crate::motion::{Record, SpectralOrdinate};

impl TimeSeries {
    /// The record of an acceleration probe (total acceleration, m/s²), from rest.
    ///
    /// With the midpoint and θ rules accelerations are means over steps. The record is then half a step late,
    /// which does not affect a spectrum. A floor's vibration should have ten steps or more in its period.
    ///
    /// # Errors
    /// [`Error::Name`] if no probe has this name; [`Error::Scene`] if the probe contains displacements or
    /// velocities, or if not every step is kept; as for [`Record::new`].
    pub fn acceleration_record(&self, probe: &str) -> Result<Record> {
        let index = self.probe_index(probe)?;
        let Probe { displacement, velocity, acceleration, .. } = &self.probes[index];
        let refuse = |needed| Err(Error::Scene { quantity: "floor spectrum", needed });
        if !(displacement.is_empty() && velocity.is_empty()) || acceleration.is_empty() {
            return refuse("the probe must be one of acceleration, and nothing else");
        }
        if self.recorder.every != 1 {
            return refuse("the recorder must keep every step");
        }
        let kept = (self.times().len().max(1) - 1) as f64 * self.time_step;
        if (kept - (self.sequence.end() - self.times()[0])).abs() > 0.5 * self.time_step {
            return refuse("every step of the run must have been recorded");
        }
        Record::new(self.time_step, self.probe_values[index].clone())
    }

    /// Floor (in-structure) response spectrum at the point of an acceleration probe.
    ///
    /// The largest response of oscillators on that point, at `periods` (s) with the damping ratio `damping`. After the
    /// end of the time series each oscillator vibrates freely for one period, and the peaks of this vibration count
    /// too. In this period the point stands still: run until the floor is at rest.
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
/// [`Error::Input`] unless both are positive, and for fewer than two numbers or more than a million.
pub fn log_spaced(first: f64, last: f64, count: usize) -> Result<Vec<f64>> {
    positive("first of the numbers", first)?;
    positive("last of the numbers", last)?;
    let needed = "from two to a million";
    require("count of numbers", count as f64, (2..=1_000_000).contains(&count), needed)?;
    let fraction = |k: usize| k as f64 / (count - 1) as f64;
    let mut numbers: Vec<f64> =
        (0..count).map(|k| first.powf(1.0 - fraction(k)) * last.powf(fraction(k))).collect();
    numbers[0] = first;
    numbers[count - 1] = last;
    Ok(numbers)
}

/// A spectrum with peaks broadened to frequencies `fraction` lower and higher.
///
/// This covers uncertainty of soil and structure: 0.15 in U.S. NRC Regulatory Guide 1.122, rev. 1 (1978). The
/// ordinate at every frequency f is spread over (1 − fraction) f to (1 + fraction) f, and the largest ordinate at
/// each frequency counts. At the period T it is the largest of the given spectrum between (1 − fraction) T and (1
/// + fraction) T. Between the given periods the spectrum is linear in the logarithm of the period.
///
/// # Errors
/// [`Error::Input`] unless 0 ≤ `fraction` < 1 and the periods increase.
pub fn broadened(spectrum: &[SpectralOrdinate], fraction: f64) -> Result<Vec<SpectralOrdinate>> {
    not_negative("fraction of broadening", fraction)?;
    require("fraction of broadening", fraction, fraction < 1.0, "below one")?;
    let mut last = 0.0;
    for ordinate in spectrum {
        positive("step to the next period of a spectrum", ordinate.period - last)?;
        last = ordinate.period;
    }
    let widen = |centre: &SpectralOrdinate| {
        let (from, to) = (centre.period * (1.0 - fraction), centre.period * (1.0 + fraction));
        let largest = |value: &dyn Fn(&SpectralOrdinate) -> f64| {
            let inside = spectrum.iter().filter(|o| o.period >= from && o.period <= to);
            let ends = [from, to].map(|period| between(spectrum, period, value));
            inside.map(value).chain(ends).fold(0.0, f64::max)
        };
        SpectralOrdinate {
            period: centre.period,
            displacement: largest(&|o| o.displacement),
            pseudo_velocity: largest(&|o| o.pseudo_velocity),
            pseudo_acceleration: largest(&|o| o.pseudo_acceleration),
            acceleration: largest(&|o| o.acceleration),
        }
    };
    Ok(spectrum.iter().map(widen).collect())
}

/// The value at `period`; zero outside the spectrum.
fn between(
    spectrum: &[SpectralOrdinate],
    period: f64,
    value: &dyn Fn(&SpectralOrdinate) -> f64,
) -> f64 {
    spectrum.windows(2).find(|pair| period >= pair[0].period && period <= pair[1].period).map_or(
        0.0,
        |pair| {
            let way = (period / pair[0].period).ln() / (pair[1].period / pair[0].period).ln();
            (1.0 - way) * value(&pair[0]) + way * value(&pair[1])
        },
    )
}
