//! Error against run time of a scene, by six settings of mesh and step.

use std::fmt;
use std::time::Duration;

use crate::coupled::run::clock;
use crate::error::{Result, all_finite, at_least, positive, same_length};
use crate::text::table::Table;

/// Plausible orders of convergence: the methods in use have two, and results with a kink have less.
const CONVERGENCE_ORDERS: std::ops::RangeInclusive<f64> = 0.5..=4.0;

/// Refinement of a setting relative to the coarsest one.
#[derive(Clone, Copy)]
struct Halvings {
    /// Number of halvings of the element length.
    mesh: u32,
    /// Number of halvings of the time step.
    step: u32,
}

/// Refinement of each of the six settings.
const SETTING_HALVINGS: [Halvings; 6] = [
    Halvings { mesh: 0, step: 0 },
    Halvings { mesh: 0, step: 1 },
    Halvings { mesh: 0, step: 2 },
    Halvings { mesh: 1, step: 0 },
    Halvings { mesh: 2, step: 0 },
    Halvings { mesh: 1, step: 1 },
];

/// Name of a scene's results in errors.
const RESULTS_NAME: &str = "list of a scene's results";

/// Setting of a [`Refinement`].
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Setting {
    /// Number of elements; if the scene counts cells along a side, number of these cells.
    pub elements: usize,
    /// Time step, s.
    pub time_step: f64,
    /// Estimated relative error of the results, in the norm of the root of the sum of squares.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub error: f64,
    /// Wall time of building and running; zero without a clock (WebAssembly).
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::seconds"))]
    pub wall: Duration,
    /// The results.
    pub results: Vec<f64>,
}

/// Error against run time at six settings, made by [`refine`]; it prints as a table.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Refinement {
    /// The six settings, coarsest first.
    ///
    /// They are the coarsest setting, a half and a quarter of its step, two and four times its elements, and twice its
    /// elements with half its step.
    pub settings: Vec<Setting>,
    /// Results extrapolated to infinitely many elements and steps.
    pub extrapolated: Vec<f64>,
    /// Observed order of convergence in the element length; NaN if the results do not depend on it.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub mesh_order: f64,
    /// Observed order of convergence in the time step; NaN if the results do not depend on it.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub step_order: f64,
    /// Relative difference between the last setting's results and their prediction.
    ///
    /// The prediction adds the errors of mesh and step. Estimated errors below the mismatch are not reliable.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub mismatch: f64,
}

/// Runs a scene at six settings and estimates the error of each by Richardson's extrapolation.
///
/// L. F. Richardson, 1911; orders observed from three settings as in P. J. Roache, *Verification and Validation in
/// Computational Science and Engineering*, 1998, § 5.
///
/// `scene` builds and runs a simulation with a number of elements and a time step (s), and returns results: a peak,
/// some peaks, or a time series at the times of the coarsest setting. Twice the number of elements must halve their
/// length: in plan, use the number of cells along the shorter side, as in
/// [`ElasticGround::under`](crate::bem::ElasticGround::under). With few cells and long steps the errors of mesh and
/// step may compensate each other: refine both. The error is the root of the sum of squares relative to the
/// extrapolated results, so use separate calls for results of different units. Time series converge evenly; peaks, and
/// quantities that depend on the instant of an impact, less evenly.
///
/// The last run, twice the elements with half the step, checks the estimate ([`Refinement::mismatch`]). An
/// estimate that passes the check may still be too low if the base slides or opens: by a factor of 2.4 for one of
/// six settings of a sliding block. [`sensitivity`](super::sensitivity()) finds peaks that no setting determines.
///
/// On layered ground [`Stages::for_profile`](crate::bem::layered::Stages::for_profile) chooses two or three
/// Runge–Kutta stages by the error at 15 Hz, a frequency that is not scaled with the scene. A refined or rescaled
/// scene may therefore change its number of stages, and its results then do not converge evenly:
/// [`with_stages`](crate::bem::ElasticGround::with_stages) fixes the number.
///
/// [`refine_each`](super::refine_each) estimates the errors of several peaks in one call.
///
/// ```
/// use basemat::bem::SpringGround;
/// use basemat::interface::Bonded;
/// use basemat::motion::RickerDisplacement;
/// use basemat::structure::RigidBlock;
/// use basemat::{Simulation, analyses};
///
/// let refinement = analyses::refine(4, 0.02, |elements, time_step| {
///     let mut simulation = Simulation::builder(time_step)
///         .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///         .ground(SpringGround::new(-2.0..2.0, elements, 2e7, 1e7)?)
///         .interface(Bonded)
///         .motion(RickerDisplacement::new(0.5, 0.4, 2.0)?)
///         .build()?;
///     // The rotation of the base every 0.02 s.
///     let mut rotation = Vec::new();
///     simulation.run(simulation.steps_for(4.0), |state| {
///         let sample = state.time / 0.02;
///         if (sample - sample.round()).abs() < 1e-6 {
///             rotation.push(state.base_rotation);
///         }
///     })?;
///     Ok(rotation)
/// })?;
/// println!("{refinement}");
/// assert!((refinement.mesh_order - 2.0).abs() < 0.2 && (refinement.step_order - 2.0).abs() < 0.2);
/// assert!(refinement.is_regular() && refinement.settings[5].error < refinement.settings[0].error / 4.0);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless there is an element and the time step is above zero,
/// [`Error::Size`](crate::Error::Size) unless every run returns the same number of results, at least one,
/// [`Error::NotFinite`](crate::Error::NotFinite) if one of them is not finite, and any error of `scene`.
pub fn refine(
    elements: usize,
    time_step: f64,
    mut scene: impl FnMut(usize, f64) -> Result<Vec<f64>>,
) -> Result<Refinement> {
    run_settings(elements, time_step, &mut scene).map(Refinement::from_settings)
}

/// Runs the scene at the six settings; their errors are not yet set.
pub(crate) fn run_settings(
    elements: usize,
    time_step: f64,
    scene: &mut dyn FnMut(usize, f64) -> Result<Vec<f64>>,
) -> Result<Vec<Setting>> {
    positive("number of elements", elements as f64)?;
    positive("time step", time_step)?;
    let mut settings: Vec<Setting> = Vec::with_capacity(SETTING_HALVINGS.len());
    for Halvings { mesh, step } in SETTING_HALVINGS {
        let setting_elements = elements.saturating_mul(1 << mesh);
        let setting_step = time_step / f64::from(1 << step);
        let start = clock();
        let results = scene(setting_elements, setting_step)?;
        let wall = start.map_or(Duration::ZERO, |start| start.elapsed());
        at_least(RESULTS_NAME, results.len(), 1)?;
        if let Some(first_setting) = settings.first() {
            same_length(RESULTS_NAME, results.len(), first_setting.results.len())?;
        }
        all_finite(RESULTS_NAME, &results)?;
        settings.push(Setting {
            elements: setting_elements,
            time_step: setting_step,
            error: f64::NAN,
            wall,
            results,
        });
    }
    Ok(settings)
}

/// Errors of three settings, each with half the element length or half the step of the previous one.
struct SeriesErrors {
    /// Errors of the results of each setting.
    errors: [Vec<f64>; 3],
    /// Observed order of convergence; NaN if the results do not change.
    order: f64,
}

impl SeriesErrors {
    /// Extrapolates the results of three settings.
    fn of(coarse_setting: &Setting, middle_setting: &Setting, fine_setting: &Setting) -> Self {
        let results = [&coarse_setting.results, &middle_setting.results, &fine_setting.results];
        let order = (distance(results[0], results[1]) / distance(results[1], results[2])).log2();
        // The error of the finest result is the change by infinitely many halvings with this order.
        let clamped_order = if order.is_nan() {
            1.0
        } else {
            order.clamp(*CONVERGENCE_ORDERS.start(), *CONVERGENCE_ORDERS.end())
        };
        let extrapolation_factor = (clamped_order.exp2() - 1.0).recip();
        let errors = results.map(|values| {
            let mut setting_errors = Vec::with_capacity(values.len());
            for (k, value) in values.iter().enumerate() {
                let last_change = results[1][k] - results[2][k];
                setting_errors.push(value - results[2][k] + extrapolation_factor * last_change);
            }
            setting_errors
        });
        Self { errors, order }
    }
}

/// Euclidean norm of the difference of two lists of results.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(a.iter().zip(b).map(|(a, b)| a - b))
}

/// Root of the sum of squares, without overflow.
fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::hypot)
}

/// Distance of two results relative to their norm; zero for equal results, also of norm zero.
fn relative(distance: f64, results_norm: f64) -> f64 {
    if distance == 0.0 { 0.0 } else { distance / results_norm }
}

/// Whether an observed order is plausible, or the results do not change.
fn is_regular_order(order: f64) -> bool {
    order.is_nan() || CONVERGENCE_ORDERS.contains(&order)
}

impl Refinement {
    /// Extrapolates the results of the six settings and sets the settings' errors.
    pub(crate) fn from_settings(mut settings: Vec<Setting>) -> Self {
        let steps = SeriesErrors::of(&settings[0], &settings[1], &settings[2]);
        let meshes = SeriesErrors::of(&settings[0], &settings[3], &settings[4]);
        let mut extrapolated = settings[0].results.clone();
        for (k, value) in extrapolated.iter_mut().enumerate() {
            *value = *value - meshes.errors[0][k] - steps.errors[0][k];
        }
        // Results of twice the elements with half the step, if both errors add up.
        let mut predicted_results = extrapolated.clone();
        for (k, value) in predicted_results.iter_mut().enumerate() {
            *value = *value + meshes.errors[1][k] + steps.errors[1][k];
        }
        let results_norm = norm(extrapolated.iter().copied());
        let mismatch = relative(distance(&settings[5].results, &predicted_results), results_norm);
        for (setting, Halvings { mesh, step }) in settings.iter_mut().zip(SETTING_HALVINGS) {
            let error_pairs = meshes.errors[mesh as usize].iter().zip(&steps.errors[step as usize]);
            setting.error = relative(norm(error_pairs.map(|(a, b)| a + b)), results_norm);
        }
        let mesh_order = meshes.order;
        let step_order = steps.order;
        Self { settings, extrapolated, mesh_order, step_order, mismatch }
    }

    /// Whether the estimate is reliable.
    ///
    /// Both orders must be between a half and four, unless the results do not depend on mesh or step. The coarsest
    /// error must be above the mismatch.
    pub fn is_regular(&self) -> bool {
        let coarsest_error = self.settings.first().map_or(0.0, |setting| setting.error);
        is_regular_order(self.mesh_order)
            && is_regular_order(self.step_order)
            && self.mismatch <= coarsest_error
    }

    /// Orders of convergence, and advice if they are irregular.
    pub(crate) fn notes(&self) -> String {
        let Self { mesh_order, step_order, mismatch, .. } = self;
        let mut notes = format!(
            "order of convergence: {mesh_order:.1} in the element length, {step_order:.1} in the \
             time step; mismatch {mismatch:.1e}"
        );
        if !self.is_regular() {
            notes += "\nnot regular: refine further before you trust these errors (on layered ground, fix the number of \
                      Runge–Kutta stages, which otherwise depends on the step)";
        }
        notes
    }
}

/// Table with a row for each setting, and value and error of each named refinement.
pub(crate) fn table(refinements: &[(&str, &Refinement)]) -> String {
    let mut heading = ["elements", "step, s", "run time, s"].map(String::from).to_vec();
    let settings = refinements.first().map_or(&[][..], |(_, first)| &first.settings);
    let mut rows = Vec::with_capacity(settings.len());
    for Setting { elements, time_step, wall, .. } in settings {
        let wall = format!("{:.3}", wall.as_secs_f64());
        rows.push(vec![elements.to_string(), format!("{time_step:.3e}"), wall]);
    }
    let mut last_row = vec!["extrapolated".to_owned(), String::new(), String::new()];
    let mut has_values = false;
    for (name, refinement) in refinements {
        // A time series does not fit into a cell.
        if let [extrapolated] = refinement.extrapolated[..] {
            has_values = true;
            heading.push((*name).to_owned());
            last_row.push(format!("{extrapolated:.4e}"));
            for (row, setting) in rows.iter_mut().zip(&refinement.settings) {
                row.extend(setting.results.iter().map(|value| format!("{value:.4e}")));
            }
        }
        heading.push("error".to_owned());
        last_row.push(String::new());
        for (row, setting) in rows.iter_mut().zip(&refinement.settings) {
            row.push(format!("{:.1e}", setting.error));
        }
    }
    if has_values {
        rows.push(last_row);
    }
    Table { heading, repeated_column_count: 2, rows }.text()
}

impl fmt::Display for Refinement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n{}", table(&[("result", self)]), self.notes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_known_orders_are_found() {
        // One result has the errors 3 h² and −0.5 Δt, the other h² and 2 Δt.
        let truth = [7.0, -2.0];
        let refinement = refine(10, 0.1, |elements, step| {
            let h = 1.0 / elements as f64;
            Ok(vec![truth[0] + 3.0 * h * h - 0.5 * step, truth[1] + h * h + 2.0 * step])
        })
        .unwrap();
        assert!(
            (refinement.mesh_order - 2.0).abs() < 1e-9
                && (refinement.step_order - 1.0).abs() < 1e-9
        );
        assert!(refinement.mismatch < 1e-12 && refinement.is_regular());
        for setting in &refinement.settings {
            let expected = distance(&setting.results, &truth) / norm(truth.into_iter());
            assert!((setting.error - expected).abs() < 1e-9 * expected, "{setting:?}");
        }
        assert!(distance(&refinement.extrapolated, &truth) < 1e-12);
    }

    #[test]
    fn results_that_do_not_converge_are_not_regular() {
        let mut calls = 0.0;
        let refinement = refine(10, 0.1, |_, _| {
            calls += 1.0;
            Ok(vec![1.0 + 0.1 * f64::sin(calls * calls)])
        })
        .unwrap();
        assert!(!refinement.is_regular() && refinement.to_string().contains("not regular"));
    }

    #[test]
    fn constant_results_have_no_error() {
        let refinement = refine(10, 0.1, |_, _| Ok(vec![0.0, 3.0])).unwrap();
        assert!(refinement.settings.iter().all(|setting| setting.error == 0.0));
        assert!(refinement.mesh_order.is_nan() && refinement.is_regular());
        assert_eq!(refinement.extrapolated, [0.0, 3.0]);
    }

    #[test]
    fn bad_results_are_errors() {
        assert!(refine(0, 0.1, |_, _| Ok(vec![1.0])).is_err());
        assert!(refine(1, f64::NAN, |_, _| Ok(vec![1.0])).is_err());
        assert!(refine(1, 0.1, |_, _| Ok(vec![])).is_err());
        assert!(refine(1, 0.1, |_, _| Ok(vec![f64::NAN])).is_err());
        assert!(refine(1, 0.1, |n, _| Ok(vec![1.0; n])).is_err());
    }
}
