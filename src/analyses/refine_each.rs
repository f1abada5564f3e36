//! Discretization errors and run times of several peak responses.

use std::fmt;

use crate::analyses::refine::{Refinement, Setting, run_settings, table};
use crate::error::{Error, Result, at_least, same_length};

/// Label of the peak list in error messages.
pub(crate) const PEAK_LIST_LABEL: &str = "list of a scene's peaks";

/// Discretization errors and run times of several peaks, from [`refine_each`].
///
/// They print as one table.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Refinements {
    /// Name and refinement of each peak, in the order of the scene.
    pub peaks: Vec<(String, Refinement)>,
}

/// Names of a scene's peaks; every run must return them in the same order.
#[derive(Default)]
pub(crate) struct PeakNames(pub(crate) Vec<String>);

impl PeakNames {
    /// Checks the names of one run's peaks, and returns the values.
    ///
    /// The first call stores the names. Later calls return an error for other names.
    pub(crate) fn check_and_take_values<N: Into<String>>(
        &mut self,
        peaks: Vec<(N, f64)>,
    ) -> Result<Vec<f64>> {
        at_least(PEAK_LIST_LABEL, peaks.len(), 1)?;
        let (names, values): (Vec<String>, Vec<f64>) =
            peaks.into_iter().map(|(name, value)| (name.into(), value)).unzip();
        if self.0.is_empty() {
            for (k, name) in names.iter().enumerate() {
                if names[..k].contains(name) {
                    return Err(Error::DuplicateName { quantity: "peak", name: name.clone() });
                }
            }
            self.0 = names;
            return Ok(values);
        }
        same_length(PEAK_LIST_LABEL, names.len(), self.0.len())?;
        match names.iter().zip(&self.0).find(|(name, expected)| name != expected) {
            None => Ok(values),
            Some((name, _)) => Err(Error::no_name("peak", name, self.0.iter())),
        }
    }
}

/// Estimates the errors of several peaks of a scene.
///
/// The estimates follow from six runs with different meshes and time steps. [`refine`](super::refine()) does this for
/// one result.
///
/// `scene` builds and runs a simulation with a number of elements and a time step (s), and returns peaks by name. Each
/// peak is extrapolated separately. Their units may differ, and a peak that does not converge does not affect the
/// others.
///
/// ```
/// use basemat::bem::ElasticGround;
/// use basemat::interface::Bonded;
/// use basemat::motion::RickerDisplacement;
/// use basemat::structure::RigidBlock;
/// use basemat::{Simulation, Soil, analyses};
///
/// let refinements = analyses::refine_each(4, 0.02, |elements, time_step| {
///     let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
///     let mut simulation = Simulation::builder(time_step)
///         .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &block, elements)?)
///         .structure(block)
///         .interface(Bonded)
///         .motion(RickerDisplacement::new(0.01, 0.2, 1.0)?)
///         .build()?;
///     let run = simulation.run(simulation.steps_for(4.0), |_| {})?;
///     let peaks = [&run.whole.base_shear, &run.whole.base_moment].map(|extremes| extremes.magnitude());
///     Ok(vec![("shear, N/m", peaks[0]), ("moment, N·m/m", peaks[1])])
/// })?;
/// println!("{refinements}");
/// let shear = refinements.peak("shear, N/m")?;
/// assert!(shear.settings.len() == 6 && shear.extrapolated[0] > 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// As for [`refine`](super::refine()); [`Error::DuplicateName`] for a name that occurs twice, [`Error::Name`] for
/// a name that another setting did not return.
pub fn refine_each<N: Into<String>>(
    elements: usize,
    time_step: f64,
    mut scene: impl FnMut(usize, f64) -> Result<Vec<(N, f64)>>,
) -> Result<Refinements> {
    let mut names = PeakNames::default();
    let mut run = |elements: usize, step: f64| names.check_and_take_values(scene(elements, step)?);
    let settings = run_settings(elements, time_step, &mut run)?;
    Ok(Refinements::from_settings(names.0, &settings))
}

impl Refinements {
    /// Splits a refinement into one refinement for each of its results.
    ///
    /// The results receive the `names` in order, and each has an error of its own.
    ///
    /// # Errors
    /// [`Error::Size`] unless there are as many names as results.
    pub fn named(names: Vec<String>, refinement: &Refinement) -> Result<Self> {
        same_length("list of names", names.len(), refinement.extrapolated.len())?;
        Ok(Self::from_settings(names, &refinement.settings))
    }

    /// Makes a refinement for each result of the settings.
    fn from_settings(names: Vec<String>, settings: &[Setting]) -> Self {
        let mut peaks = Vec::with_capacity(names.len());
        for (k, name) in names.into_iter().enumerate() {
            let mut peak_settings = settings.to_vec();
            for setting in &mut peak_settings {
                setting.results = vec![setting.results[k]];
            }
            peaks.push((name, Refinement::from_settings(peak_settings)));
        }
        Self { peaks }
    }

    /// The refinement of a peak, by its name.
    ///
    /// # Errors
    /// [`Error::Name`] if no peak has this name.
    pub fn peak(&self, name: &str) -> Result<&Refinement> {
        match self.peaks.iter().find(|(peak, _)| peak == name) {
            Some((_, refinement)) => Ok(refinement),
            None => Err(Error::no_name("peak", name, self.peaks.iter().map(|(peak, _)| peak))),
        }
    }
}

impl fmt::Display for Refinements {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named_refinements: Vec<_> =
            self.peaks.iter().map(|(name, refinement)| (name.as_str(), refinement)).collect();
        f.write_str(&table(&named_refinements))?;
        named_refinements
            .iter()
            .try_for_each(|(name, refinement)| write!(f, "\n{name}: {}", refinement.notes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each peak has the refinement that `refine` computes for this peak.
    #[test]
    fn peaks_are_refined_one_by_one() {
        let value = |k: usize, elements: usize, step: f64| match k {
            0 => 1e6 * (7.0 + 3.0 / (elements as f64).powi(2) - 0.5 * step),
            _ => 1e-3 * (2.0 - (elements as f64).recip() + step * step),
        };
        let refinements = refine_each(10, 0.1, |elements, step| {
            Ok([0, 1].map(|k| (format!("peak {k}"), value(k, elements, step))).to_vec())
        })
        .unwrap();
        for k in 0..2 {
            let separate_refinements =
                super::super::refine(10, 0.1, |elements, step| Ok(vec![value(k, elements, step)]));
            let mut joint = refinements.peaks[k].1.clone();
            let mut separate_refinements = separate_refinements.unwrap();
            for setting in joint.settings.iter_mut().chain(&mut separate_refinements.settings) {
                setting.wall = std::time::Duration::ZERO;
            }
            assert_eq!(joint, separate_refinements);
        }
        let report = refinements.to_string();
        for text in ["peak 0", "peak 1", "extrapolated", "peak 1: order of convergence: 1.0"] {
            assert!(report.contains(text), "{report}");
        }
        assert!(refinements.peak("peak 1").is_ok() && refinements.peak("peak").is_err());
    }

    #[test]
    fn names_must_be_one_list() {
        let mut calls = 0;
        let mut renamed_peak_scene = |_, _| {
            calls += 1;
            Ok(vec![(["a", "a", "b"][calls.min(2)], 1.0)])
        };
        assert!(matches!(refine_each(1, 0.1, &mut renamed_peak_scene), Err(Error::Name { .. })));
        let duplicate_result = refine_each(1, 0.1, |_, _| Ok(vec![("a", 1.0), ("a", 2.0)]));
        assert!(matches!(duplicate_result, Err(Error::DuplicateName { .. })));
        assert!(refine_each(1, 0.1, |_, _| Ok(Vec::<(&str, f64)>::new())).is_err());
        let peak_per_element = |n: usize, _| Ok((0..n).map(|k| (k.to_string(), 1.0)).collect());
        assert!(matches!(refine_each(1, 0.1, peak_per_element), Err(Error::Size { .. })));
    }
}
