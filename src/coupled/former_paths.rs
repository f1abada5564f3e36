//! Deprecated paths of the items of [`crate::analyses`].

use crate::Simulation;
use crate::coupled::SimulationBuilder;
use crate::error::Result;
use crate::structure::DofCombination;

/// [`crate::analyses::Refinement`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::Refinement`")]
pub type Refinement = crate::analyses::Refinement;
/// [`crate::analyses::Refinements`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::Refinements`")]
pub type Refinements = crate::analyses::Refinements;
/// [`crate::analyses::Setting`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::Setting`")]
pub type Setting = crate::analyses::Setting;
/// [`crate::analyses::PeakTwins`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::PeakTwins`")]
pub type PeakTwins = crate::analyses::PeakTwins;
/// [`crate::analyses::Sensitivity`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::Sensitivity`")]
pub type Sensitivity = crate::analyses::Sensitivity;
/// [`crate::analyses::Interaction`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::Interaction`")]
pub type Interaction = crate::analyses::Interaction;
/// [`crate::analyses::SystemMode`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::SystemMode`")]
pub type SystemMode = crate::analyses::SystemMode;
/// [`crate::analyses::PushControl`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::PushControl`")]
pub type PushControl = crate::analyses::PushControl;
/// [`crate::analyses::PushOver`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::PushOver`")]
pub type PushOver = crate::analyses::PushOver;
/// [`crate::analyses::PushPoint`].
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::PushPoint`")]
pub type PushPoint = crate::analyses::PushPoint;

/// [`crate::analyses::refine()`].
///
/// # Errors
/// As for that function.
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::refine`")]
pub fn refine(
    elements: usize,
    time_step: f64,
    scene: impl FnMut(usize, f64) -> Result<Vec<f64>>,
) -> Result<crate::analyses::Refinement> {
    crate::analyses::refine(elements, time_step, scene)
}

/// [`crate::analyses::refine_each`].
///
/// # Errors
/// As for that function.
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::refine_each`")]
pub fn refine_each<N: Into<String>>(
    elements: usize,
    time_step: f64,
    scene: impl FnMut(usize, f64) -> Result<Vec<(N, f64)>>,
) -> Result<crate::analyses::Refinements> {
    crate::analyses::refine_each(elements, time_step, scene)
}

/// [`crate::analyses::sensitivity()`].
///
/// # Errors
/// As for that function.
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::sensitivity`")]
pub fn sensitivity<N: Into<String>>(
    elements: usize,
    time_step: f64,
    scene: impl FnMut(usize, f64) -> Result<Vec<(N, f64)>>,
) -> Result<crate::analyses::Sensitivity> {
    crate::analyses::sensitivity(elements, time_step, scene)
}

/// [`crate::analyses::largest_convergent_step`].
///
/// # Errors
/// As for that function.
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::largest_convergent_step`")]
pub fn largest_convergent_step(
    time_step: f64,
    duration: f64,
    scene: impl FnMut(f64) -> Result<Simulation>,
) -> Result<Option<f64>> {
    crate::analyses::largest_convergent_step(time_step, duration, scene)
}

/// [`crate::analyses::interaction()`].
///
/// # Errors
/// As for that function.
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::interaction`")]
pub fn interaction(
    duration: f64,
    scene: impl FnMut() -> Result<SimulationBuilder>,
) -> Result<crate::analyses::Interaction> {
    crate::analyses::interaction(duration, scene)
}

/// [`crate::analyses::push_over()`].
///
/// # Errors
/// As for that function.
#[deprecated(since = "0.5.0", note = "use `basemat::analyses::push_over`")]
pub fn push_over(
    control: &DofCombination,
    path: &crate::analyses::PushControl,
    scene: impl FnMut(f64) -> Result<Simulation>,
) -> Result<crate::analyses::PushOver> {
    crate::analyses::push_over(control, path, scene)
}
