//! Reliable digits of a scene's peaks, by comparison with similar runs that should give the same peaks.

use std::fmt;

use crate::analyses::refine_each::{PEAK_LIST_LABEL, PeakNames};
use crate::error::{Error, Result, all_finite, at_least, positive};
use crate::text::table::Table;

/// Time step of the first twin, relative to the run's time step: so near to 1 that peaks should agree.
const TWIN_STEP_FACTOR: f64 = 0.99;
/// Largest number of confirmed digits: agreement of three twins in more digits may be a coincidence.
const MAX_CONFIRMED_DIGITS: u32 = 6;

/// Value of a peak in a run and in its twins.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct PeakTwins {
    /// Name of the peak.
    pub name: String,
    /// Value of the run.
    pub value: f64,
    /// Value with a time step shorter by 1 %.
    pub shorter_step: f64,
    /// Value on three quarters of the elements, rounded up.
    pub three_quarters: f64,
    /// Value on half the elements, rounded up.
    pub half: f64,
}

impl PeakTwins {
    /// Largest difference between a twin and the run, in the unit of the peak.
    pub fn spread(&self) -> f64 {
        let twin_values = [self.shorter_step, self.three_quarters, self.half];
        twin_values
            .into_iter()
            .fold(0.0, |spread, twin_value| f64::max(spread, (twin_value - self.value).abs()))
    }

    /// Number of reliable significant digits, six at most.
    ///
    /// Half a unit of the last reliable digit is not smaller than the spread. The number is zero if the twins disagree
    /// on the first digit.
    pub fn digits(&self) -> u32 {
        let spread = self.spread();
        if spread == 0.0 {
            return MAX_CONFIRMED_DIGITS;
        }
        // Power of ten of the first significant digit.
        let exponent = self.value.abs().log10().floor();
        let digits = (exponent + 1.0 - (2.0 * spread).log10()).floor();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let digits = digits.clamp(0.0, f64::from(MAX_CONFIRMED_DIGITS)) as u32;
        digits
    }

    /// The value with its reliable digits; "–" if there are none.
    fn quoted(&self) -> String {
        match self.digits() {
            0 => "–".to_owned(),
            digits => format!("{:.*e}", digits as usize - 1, self.value),
        }
    }
}

/// Peaks of a run and of its twins, made by [`sensitivity`]; it prints as a table.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Sensitivity {
    /// The peaks, in the order of the scene.
    pub peaks: Vec<PeakTwins>,
}

/// Compares a scene's peaks with the peaks of three similar runs, its twins.
///
/// The twins have a time step shorter by 1 %, three quarters of the elements, and half of the elements. `scene` builds
/// a simulation and runs it for a duration, with a number of elements (in plan: of cells along the shorter side) and a
/// time step (s), and returns peaks by name, as for [`refine_each`](super::refine_each).
///
/// If a peak converges, its twins differ from it by about its error. A body that rocks and twists on its corners
/// may move chaotically: a negligible change decides on which corner it lands. Its peaks then belong to one motion out
/// of many, and no finer setting makes them converge; state the range over many motions. The three twins take less
/// time than two further runs, in plan about as much as one and a half. The six settings of `refine_each` take the time
/// of tens of runs. A comparison with changes in the last bits of a scene detects less, since such changes need many
/// impacts to grow.
///
/// ```
/// use basemat::bem::SpringGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
/// use basemat::{Simulation, analyses};
///
/// let sensitivity = analyses::sensitivity(16, 0.005, |elements, time_step| {
///     let mut simulation = Simulation::builder(time_step)
///         .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///         .ground(SpringGround::new(-2.0..2.0, elements, 2e7, 1e7)?.with_dashpots(4e5, 2e5)?)
///         .interface(Coulomb::new(0.4)?)
///         .motion(el_centro_1940())
///         .build()?;
///     let run = simulation.run(simulation.steps_for(8.0), |_| {})?;
///     Ok(vec![("shear, N/m", run.whole.base_shear.magnitude())])
/// })?;
/// println!("{sensitivity}");
/// assert!(sensitivity.peak("shear, N/m")?.digits() >= 1);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Size`] unless there are two elements or more and every run returns the same number of peaks, at least
/// one, [`Error::Input`] unless the time step is above zero, [`Error::NotFinite`] if a peak is not finite,
/// [`Error::DuplicateName`] for a name that occurs twice, [`Error::Name`] for a name that only a twin returns, and
/// any error of `scene`.
pub fn sensitivity<N: Into<String>>(
    elements: usize,
    time_step: f64,
    mut scene: impl FnMut(usize, f64) -> Result<Vec<(N, f64)>>,
) -> Result<Sensitivity> {
    at_least("list of elements", elements, 2)?;
    positive("time step", time_step)?;
    let mut names = PeakNames::default();
    let mut run = |elements: usize, step: f64| -> Result<Vec<f64>> {
        let values = names.check_and_take_values(scene(elements, step)?)?;
        all_finite(PEAK_LIST_LABEL, &values)?;
        Ok(values)
    };
    let value = run(elements, time_step)?;
    let shorter_step = run(elements, TWIN_STEP_FACTOR * time_step)?;
    let three_quarters = run(elements - elements / 4, time_step)?;
    let half = run(elements.div_ceil(2), time_step)?;
    let mut peaks = Vec::with_capacity(value.len());
    for (k, name) in names.0.into_iter().enumerate() {
        peaks.push(PeakTwins {
            name,
            value: value[k],
            shorter_step: shorter_step[k],
            three_quarters: three_quarters[k],
            half: half[k],
        });
    }
    Ok(Sensitivity { peaks })
}

impl Sensitivity {
    /// A peak and its twins, by its name.
    ///
    /// # Errors
    /// [`Error::Name`] if no peak has this name.
    pub fn peak(&self, name: &str) -> Result<&PeakTwins> {
        let peak = self.peaks.iter().find(|peak| peak.name == name);
        peak.ok_or_else(|| Error::no_name("peak", name, self.peaks.iter().map(|peak| &peak.name)))
    }
}

impl fmt::Display for Sensitivity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let heading =
            ["Peak", "run", "step − 1 %", "¾ elements", "½ elements", "digits", "to quote"];
        let heading = heading.map(str::to_owned).to_vec();
        let mut rows = Vec::with_capacity(self.peaks.len());
        for peak in &self.peaks {
            let PeakTwins { value, shorter_step, three_quarters, half, .. } = peak;
            let values = [value, shorter_step, three_quarters, half];
            let mut cells = vec![peak.name.clone()];
            cells.extend(values.map(|value| format!("{value:.4e}")));
            cells.extend([peak.digits().to_string(), peak.quoted()]);
            rows.push(cells);
        }
        f.write_str(&Table { heading, repeated_column_count: 1, rows }.text())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn twins(value: f64, twin: f64) -> PeakTwins {
        let name = String::new();
        PeakTwins { name, value, shorter_step: twin, three_quarters: value, half: value }
    }

    #[test]
    fn digits_are_common_to_all_twins() {
        for (value, twin, digits, quoted) in [
            (3478.0, 3717.0, 1, "3e3"),
            (3478.0, 5916.0, 0, "–"),
            (-3478.0, -3500.0, 2, "-3.5e3"),
            (1.0, 1.0004, 4, "1.000e0"),
            (0.02, 0.02, 6, "2.00000e-2"),
            (0.0, 1e-9, 0, "–"),
        ] {
            let peak = twins(value, twin);
            assert_eq!((peak.digits(), peak.quoted().as_str()), (digits, quoted), "{value}");
        }
    }

    #[test]
    fn twins_change_step_and_elements_by_little() {
        let mut runs = Vec::new();
        let sensitivity_of_sum = sensitivity(9, 0.1, |elements, step| {
            runs.push((elements, step));
            Ok(vec![("sum", elements as f64 + step)])
        })
        .unwrap();
        let elements: Vec<usize> = runs.iter().map(|run| run.0).collect();
        assert_eq!(elements, [9, 9, 7, 5]);
        assert_eq!((runs[0].1, runs[1].1, runs[2].1), (0.1, 0.99 * 0.1, 0.1));
        let sum = sensitivity_of_sum.peak("sum").unwrap();
        assert_eq!((sum.value, sum.three_quarters, sum.half, sum.digits()), (9.1, 7.1, 5.1, 0));
        let page = sensitivity_of_sum.to_string();
        assert!(page.contains("½ elements") && sensitivity_of_sum.peak("none").is_err());
        for (elements, step) in [(1, 0.1), (4, 0.0), (4, f64::NAN)] {
            assert!(sensitivity(elements, step, |_, _| Ok(vec![("a", 1.0)])).is_err());
        }
        assert!(sensitivity(4, 0.1, |_, _| Ok(vec![("a", f64::NAN)])).is_err());
    }
}
