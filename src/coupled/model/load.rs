//! External loads: a weighted sum of degrees of freedom times a function of time.

use crate::coupled::base::transformation::{Transformation, Weights};
use crate::error::{Error, Result, at_least, finite, positive, same_length};
use crate::motion::Record;
use crate::structure::DofCombination;
use std::fmt;

/// External force on a structure: wind, machinery, blast, impact.
///
/// The force on each degree of freedom is its weight in `row` times the load's value. The work of the load is therefore
/// value × Δ(row). For the [`DofCombination`] of a displacement the value is a force (N, in the plane N/m), for a
/// rotation a moment. The value at t = 0 belongs to the static state, as if it had grown slowly after the weight
/// ([`GravityStage`](crate::coupled::GravityStage)). A sudden load is zero at t = 0.
///
/// `build` evaluates a load at t = 0, more than once. Each attempted step from t to t + Δt then evaluates it once,
/// at the time of the scheme's equation of motion: t + Δt/2 for
/// [`Midpoint`](crate::coupled::Midpoint) and [`DissipativeMidpoint`](crate::coupled::DissipativeMidpoint), t + Δt
/// for [`Newmark`](crate::coupled::Newmark). All iterations of a nonlinear structure use this value. If a failed step is
/// tried again, the load is evaluated again. Between the steps, [`set_load`](crate::Simulation::set_load) sets a force
/// that depends on the state, for example the force of a controller.
///
/// ```
/// use basemat::Simulation;
/// use basemat::bem::ElasticGround;
/// use basemat::coupled::{Load, Probe};
/// use basemat::interface::Coulomb;
/// use basemat::structure::RigidBlock;
/// use basemat::Soil;
///
/// let block = RigidBlock::new(6.0, 9.0, 2000.0)?;
/// let roof = block.horizontal_at(9.0);
/// // A force of 100 kN/m at the roof is released at t = 0.
/// let mut simulation = Simulation::builder(0.005)
///     .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &block, 8)?)
///     .structure(block)
///     .interface(Coulomb::new(0.5)?)
///     .load(Load::released(roof.clone(), 100.0e3))
///     .probe(Probe::displacement("roof", roof))
///     .build()?;
/// assert!((simulation.state().base_shear - 100.0e3).abs() < 1.0);
/// let run = simulation.run(400, |_| {})?;
/// // The block swings to the other side.
/// assert!(run.probes[0].extremes.lowest.value < -5e-3);
/// assert!(run.whole.base_shear.lowest.value < 0.0 && run.energy_error < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct Load {
    row: DofCombination,
    value: Box<dyn Fn(f64) -> f64 + Send>,
    /// Whether the load is applied with the weight.
    is_weight: bool,
}

impl Load {
    /// Load of `value(t)`, t in seconds, on `row`.
    ///
    /// A value that is not finite ends the step with an error.
    pub fn new(
        row: impl Into<DofCombination>,
        value: impl Fn(f64) -> f64 + Send + 'static,
    ) -> Self {
        Self { row: row.into(), value: Box::new(value), is_weight: false }
    }

    /// Constant `force` that is applied with the weight.
    ///
    /// The [gravity stage](crate::coupled::GravityStage) defines how the weight is applied. Use it for dead loads without
    /// mass in the structure: equipment, fill, a fixed tank. Other loads at t = 0 are applied after the weight, with the
    /// interface law.
    ///
    /// ```
    /// use basemat::bem::ElasticGround;
    /// use basemat::coupled::Load;
    /// use basemat::interface::Coulomb;
    /// use basemat::structure::RigidBlock;
    /// use basemat::{Simulation, Soil};
    ///
    /// let block = RigidBlock::new(8.0, 10.0, 1000.0)?;
    /// let ground = ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &block, 16)?;
    /// let up = block.vertical_at(0.0);
    /// let simulation = Simulation::builder(0.01)
    ///     .structure(block)
    ///     .ground(ground)
    ///     .interface(Coulomb::new(0.5)?)
    ///     .load(Load::weight(up, -400.0e3))
    ///     .build()?;
    /// // The base is placed without friction and has no shear. A constant load would cause a shear of 0.3 of the pressure.
    /// assert!(simulation.state().contact.iter().all(|element| element.shear.abs() < 1.0));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn weight(row: impl Into<DofCombination>, force: f64) -> Self {
        Self { is_weight: true, ..Self::constant(row, force) }
    }

    /// Constant `force`, which also acts in the static state.
    pub fn constant(row: impl Into<DofCombination>, force: f64) -> Self {
        Self::new(row, move |_| force)
    }

    /// A `force` of the static state that is released at t = 0 (snap-back test).
    ///
    /// Without a static state (no gravity, or [`GravityStage::Unloaded`](crate::coupled::GravityStage::Unloaded))
    /// the force never acts.
    pub fn released(row: impl Into<DofCombination>, force: f64) -> Self {
        Self::new(row, move |time| if time > 0.0 { 0.0 } else { force })
    }

    /// `force` times the accelerations of a record in m/s².
    ///
    /// The load is linear between the samples and zero beyond the ends of the record.
    pub fn record(row: impl Into<DofCombination>, record: &Record, force: f64) -> Self {
        let record = record.clone();
        Self::new(row, move |time| force * record.at(time).acceleration)
    }

    /// `forces` at `times` (s, ascending), linear between these times and zero before and after them.
    ///
    /// # Errors
    /// [`Error::Size`] for lists that differ in length or are empty, [`Error::Input`] for numbers
    /// that are not finite or times that do not ascend.
    pub fn table(row: impl Into<DofCombination>, times: &[f64], forces: &[f64]) -> Result<Self> {
        at_least("table of a load", times.len(), 1)?;
        same_length("table of a load", forces.len(), times.len())?;
        for (time, force) in times.iter().zip(forces) {
            finite("time of a load", *time)?;
            finite("value of a load", *force)?;
        }
        for pair in times.windows(2) {
            positive("time between two values of a load", pair[1] - pair[0])?;
        }
        let times = times.to_vec();
        let forces = forces.to_vec();
        Ok(Self::new(row, move |time| {
            let upper_index = times.partition_point(|t| *t <= time);
            match (upper_index.checked_sub(1), times.get(upper_index)) {
                (Some(k), Some(upper_time)) => {
                    let fraction = (time - times[k]) / (upper_time - times[k]);
                    // The difference of the forces may overflow.
                    (1.0 - fraction) * forces[k] + fraction * forces[upper_index]
                }
                (Some(k), None) if time <= times[k] => forces[k],
                _ => 0.0,
            }
        }))
    }

    /// Whether the load is applied with the weight.
    pub(crate) fn is_weight(&self) -> bool {
        self.is_weight
    }

    /// Weighted sum of degrees of freedom on which the load acts.
    pub(crate) fn row(&self) -> &DofCombination {
        &self.row
    }

    /// Force at `time` (s).
    pub fn value(&self, time: f64) -> f64 {
        (self.value)(time)
    }

    /// Checks the degrees of freedom, and that the value at t = 0 is finite.
    ///
    /// `index` is the load's number in errors.
    pub(crate) fn check(&self, index: usize, dofs: usize) -> Result<()> {
        self.row.check("degree of freedom of a load", dofs)?;
        let quantity = "external load at t = 0";
        let value = self.value(0.0);
        if value.is_finite() {
            Ok(())
        } else {
            Err(Error::NotFinite { quantity, index, value })
        }
    }
}

impl fmt::Debug for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Load").field("row", &self.row).finish_non_exhaustive()
    }
}

/// A load in stepping coordinates.
pub(crate) struct SteppedLoad {
    load: Load,
    weights: Weights,
    /// Force in the static state.
    static_force: f64,
    /// Force that replaces the value of the load's function.
    set_force: Option<f64>,
}

impl SteppedLoad {
    pub(crate) fn new(load: Load, transformation: &Transformation, is_static: bool) -> Self {
        let weights = transformation.weights(&load.row);
        let static_force = if is_static { load.value(0.0) } else { 0.0 };
        Self { load, weights, static_force, set_force: None }
    }

    /// Sets the force of further steps; `None` restores the load's function.
    pub(crate) fn set(&mut self, force: Option<f64>) {
        self.set_force = force;
    }

    /// Force that replaces the load's function; `None` if none was set.
    pub(crate) fn set_force(&self) -> Option<f64> {
        self.set_force
    }

    /// Adds the load at `time`, minus its static force, to the generalised `force`.
    ///
    /// Returns the difference of the load and its static force.
    pub(crate) fn add(&self, time: f64, force: &mut [f64]) -> f64 {
        let change = self.set_force.unwrap_or_else(|| self.load.value(time)) - self.static_force;
        if change != 0.0 {
            self.weights.add_scaled(change, force);
        }
        change
    }
}
