//! Rocking of a foundation: moment, rotation, settlement, and the equivalent damping of a cycle.

use std::f64::consts::PI;
use std::ops::Range;

use super::{Quantity, TimeSeries};
use crate::error::{Error, Result, at_least, finite, require, require_part, same_length};

/// Largest distance between the ends of a closed cycle, over the range of the cycle.
///
/// A cycle that leaves residual rotation does not close exactly.
const MAX_CLOSURE_RATIO: f64 = 0.25;
/// Distance from an extreme of the rotation within which a cycle turns, over the range of the cycle.
///
/// Smaller reversals between the extremes do not count as cycles.
const TURN_DISTANCE_RATIO: f64 = 0.25;
/// Fraction of the times at the ends of a window that counts as rounding.
const TIME_TOLERANCE: f64 = 1e-9;

/// Rocking of one foundation about one axis, over a run or a part of it.
///
/// Each slice has a number for each kept step. Signs and units as in [`Quantity`].
/// [`TimeSeries::rocking`] has an example.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Rocking<'a> {
    /// Times, s.
    pub times: &'a [f64],
    /// Rotation of the foundation since the static state, rad.
    pub rotation: &'a [f64],
    /// Moment on the soil about the middle of the foundation, static part included, N·m/m; in plan N·m.
    pub moment: &'a [f64],
    /// Settlement of the centre since the static state, positive downwards, m.
    pub settlement: &'a [f64],
    /// Work of the moment on the soil since t = 0, J/m; in plan J.
    pub work: &'a [f64],
    /// Whether the ground is one in plan: moments and works are then of the whole body.
    pub in_plan: bool,
}

impl TimeSeries {
    /// Time series of a quantity of one foundation at [`TimeSeries::times`].
    ///
    /// Foundations are numbered from 0, in the order of [`Run::foundations`](super::Run::foundations); their moments are
    /// about their middles. The series is empty in the plane for quantities that exist only in plan.
    ///
    /// # Errors
    /// [`Error::Index`] if there is no such foundation. With several foundations or a moment center, [`Error::Scene`]
    /// unless [`Recorder::foundations`](super::Recorder::foundations)
    /// was called.
    pub fn foundation_series(&self, foundation: usize, quantity: Quantity) -> Result<&[f64]> {
        let foundation_values = self.foundations.find(foundation, quantity)?;
        Ok(foundation_values.unwrap_or_else(|| self.series(quantity)))
    }

    /// Rocking of a foundation, counter-clockwise; in plan about the axis along y.
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::Load;
    /// use basemat::interface::Yielding;
    /// use basemat::results::Recorder;
    /// use basemat::structure::{DofCombination, RigidBlock};
    /// use basemat::Simulation;
    ///
    /// // Soil that yields under a block, which a moment turns to and fro in 4 s.
    /// let moment = |time: f64| 2.6e5 * (std::f64::consts::TAU * time / 4.0).sin();
    /// let mut simulation = Simulation::builder(0.01)
    ///     .structure(RigidBlock::new(4.0, 5.0, 2000.0)?)
    ///     .ground(SpringGround::new(-2.0..2.0, 40, 4e7, 4e7)?)
    ///     .interface(Yielding::new(1.5e5, 0.6)?)
    ///     .load(Load::new(DofCombination::from(2), moment))
    ///     .build()?;
    /// let mut time_series = Recorder::new().start(&simulation)?;
    /// simulation.run(1200, |state| time_series.record(state))?;
    ///
    /// let rocking = time_series.rocking(0)?;
    /// assert!(rocking.settlement[1200] > 3e-3);
    /// // The last cycle, from peak to peak.
    /// let cycle = rocking.between(5.0..9.0)?;
    /// let damping = cycle.equivalent_damping()?;
    /// assert!(damping > 0.03 && damping < 0.06);
    /// // Several cycles are not one.
    /// assert!(rocking.between(1.0..9.0)?.equivalent_damping().is_err());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`TimeSeries::foundation_series`].
    pub fn rocking(&self, foundation: usize) -> Result<Rocking<'_>> {
        self.rocking_about_axis(
            foundation,
            Quantity::BaseRotation,
            Quantity::BaseMoment,
            Quantity::RockingWork,
        )
    }

    /// In plan: rocking of a foundation about the axis along x.
    ///
    /// # Errors
    /// As for [`TimeSeries::foundation_series`], and [`Error::Scene`] in the plane.
    pub fn rocking_across(&self, foundation: usize) -> Result<Rocking<'_>> {
        let needed = "a ground in plan: in the plane a base rocks about one axis";
        require_part("rocking about the axis along x", self.in_plan(), needed)?;
        self.rocking_about_axis(
            foundation,
            Quantity::RotationAcross,
            Quantity::MomentAcross,
            Quantity::RockingWorkAcross,
        )
    }

    /// Rocking about one axis, from the quantities of its rotation, moment and work.
    fn rocking_about_axis(
        &self,
        foundation: usize,
        rotation: Quantity,
        moment: Quantity,
        work: Quantity,
    ) -> Result<Rocking<'_>> {
        Ok(Rocking {
            times: self.times(),
            rotation: self.foundation_series(foundation, rotation)?,
            moment: self.foundation_series(foundation, moment)?,
            settlement: self.foundation_series(foundation, Quantity::Settlement)?,
            work: self.foundation_series(foundation, work)?,
            in_plan: self.in_plan(),
        })
    }
}

impl Rocking<'_> {
    /// The steps between two times (s), both included.
    ///
    /// # Errors
    /// [`Error::Input`] for a time that is not finite, [`Error::Size`] if no kept step lies between them.
    pub fn between(self, times: Range<f64>) -> Result<Self> {
        finite("first time of a part of a run", times.start)?;
        finite("last time of a part of a run", times.end)?;
        let rounding = TIME_TOLERANCE * times.start.abs().max(times.end.abs());
        let first_step = self.times.partition_point(|time| *time < times.start - rounding);
        let end_step = self.times.partition_point(|time| *time <= times.end + rounding);
        at_least("list of kept steps between two times", end_step.saturating_sub(first_step), 1)?;
        let steps = first_step..end_step;
        // The slices are public and may have been replaced by shorter slices.
        Ok(Self {
            times: self.times.get(steps.clone()).unwrap_or_default(),
            rotation: self.rotation.get(steps.clone()).unwrap_or_default(),
            moment: self.moment.get(steps.clone()).unwrap_or_default(),
            settlement: self.settlement.get(steps.clone()).unwrap_or_default(),
            work: self.work.get(steps).unwrap_or_default(),
            in_plan: self.in_plan,
        })
    }

    /// Equivalent viscous damping ratio of one cycle, ξ = E/(2π M θ).
    ///
    /// E is the work of the moment in the cycle, summed over all steps, also those that were not kept. M and θ are half the
    /// ranges of moment and rotation (Chopra, *Dynamics of Structures*, section 3.9; Gajan and Kutter, J. Geotech.
    /// Geoenviron. Eng. 134, 2008, 1129). For a spring and a dashpot in parallel ξ = ½ sin φ, where φ is the phase by which
    /// the moment leads the rotation.
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than three steps, [`Error::Input`] unless the steps are one closed cycle: rotation and
    /// moment vary, end within a quarter of their ranges from their first values, and the rotation turns once
    /// at each extreme.
    pub fn equivalent_damping(&self) -> Result<f64> {
        let cycle = Cycle::new(self.rotation, self.moment)?;
        same_length("list of works of a cycle", self.work.len(), self.rotation.len())?;
        let work = self.work[self.work.len() - 1] - self.work[0];
        Ok(cycle.damping(work))
    }
}

/// Equivalent viscous damping ratio of one measured cycle of rotations (rad) and moments, ξ = E/(2π M θ).
///
/// E is the area of the polygon of the measured points, positive if the points run clockwise in a diagram of moment
/// over rotation. M and θ are half the ranges. Moments may have any unit. [`Rocking::equivalent_damping`] computes the
/// damping of a simulated cycle.
///
/// ```
/// use basemat::results::equivalent_damping;
/// // A rectangle: E = 4 M θ.
/// let rotation = [-1.0, -1.0, 1.0, 1.0, -1.0];
/// let damping = equivalent_damping(&rotation, &[-5.0, 5.0, 5.0, -5.0, -5.0])?;
/// assert!((damping - 2.0 / std::f64::consts::PI).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// As for [`Rocking::equivalent_damping`]; [`Error::Size`] for slices of different lengths, [`Error::NotFinite`].
pub fn equivalent_damping(rotation: &[f64], moment: &[f64]) -> Result<f64> {
    let cycle = Cycle::new(rotation, moment)?;
    let mut work = 0.0;
    for k in 1..rotation.len() {
        work += 0.5 * (moment[k] + moment[k - 1]) * (rotation[k] - rotation[k - 1]);
    }
    Ok(cycle.damping(work))
}

/// A closed cycle of rotation and moment.
struct Cycle {
    rotation_range: f64,
    moment_range: f64,
    /// Work on a straight line from the end back to the beginning.
    closing_work: f64,
}

impl Cycle {
    fn new(rotation: &[f64], moment: &[f64]) -> Result<Self> {
        at_least("list of rotations of a cycle", rotation.len(), 3)?;
        same_length("list of moments of a cycle", moment.len(), rotation.len())?;
        let rotation_range = closed_range("rotation", rotation)?;
        let moment_range = closed_range("moment", moment)?;
        let count = cycle_count(rotation);
        require("number of cycles of the rotation", count as f64, count == 1, "one")?;
        let last_index = rotation.len() - 1;
        let closing_work =
            0.5 * (moment[0] + moment[last_index]) * (rotation[0] - rotation[last_index]);
        Ok(Self { rotation_range, moment_range, closing_work })
    }

    /// Damping ratio of the cycle, from its work up to its end.
    fn damping(&self, work: f64) -> f64 {
        2.0 * (work + self.closing_work) / (PI * self.rotation_range * self.moment_range)
    }
}

/// Range of values that vary and return to the first value.
fn closed_range(quantity: &'static str, values: &[f64]) -> Result<f64> {
    let mut min_value = f64::INFINITY;
    let mut max_value = f64::NEG_INFINITY;
    for (index, &value) in values.iter().enumerate() {
        if !value.is_finite() {
            return Err(Error::NotFinite { quantity, index, value });
        }
        min_value = min_value.min(value);
        max_value = max_value.max(value);
    }
    let range = max_value - min_value;
    let is_range = range > 0.0 && range.is_finite();
    require("range of rotation or moment in a cycle", range, is_range, "above zero and finite")?;
    let open_fraction = (values[values.len() - 1] - values[0]).abs() / range;
    let needed = "at most a quarter of its range: a cycle ends where it began";
    let is_closed = open_fraction <= MAX_CLOSURE_RATIO;
    require("change of rotation or moment over a cycle", open_fraction, is_closed, needed)?;
    Ok(range)
}

/// Number of rises of periodic values from near the minimum to near the maximum.
///
/// The values repeat: the first value follows the last one.
fn cycle_count(values: &[f64]) -> usize {
    let min_value = values.iter().copied().fold(f64::INFINITY, f64::min);
    let max_value = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let margin = TURN_DISTANCE_RATIO * (max_value - min_value);
    let mut rise_count = 0;
    let mut was_near_maximum = None;
    let mut began_near_maximum = None;
    for &value in values {
        let is_near_maximum = value >= max_value - margin;
        if is_near_maximum || value <= min_value + margin {
            rise_count += usize::from(is_near_maximum && was_near_maximum == Some(false));
            was_near_maximum = Some(is_near_maximum);
            began_near_maximum.get_or_insert(is_near_maximum);
        }
    }
    rise_count + usize::from(began_near_maximum == Some(true) && was_near_maximum == Some(false))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cycles_are_counted_around_the_end() {
        for (values, count) in [
            (&[0.0, 1.0, 0.0, -1.0, 0.0][..], 1),
            (&[1.0, -1.0, 1.0], 1),
            (&[-1.0, 1.0, -1.0], 1),
            (&[1.0, -1.0, 1.0, -1.0], 2),
            (&[0.0, 1.0, 0.3, 1.0, -1.0, -0.4, -1.0], 1),
            (&[1.0, 0.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0], 2),
        ] {
            assert_eq!(cycle_count(values), count, "{values:?}");
        }
    }
}
