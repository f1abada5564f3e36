//! Soil–structure interaction: a scene on its ground and on a fixed base, and its first mode on both.

use std::fmt;

use crate::analyses::free_vibration::{FixedBaseMode, free_vibration};
use crate::coupled::SimulationBuilder;
use crate::coupled::run::quantity_row::ShownIn;
use crate::error::{Result, not_negative};
use crate::geometry::axis_name;
use crate::results::{Extremes, Quantity, Run};
use crate::text::readable_number::{PrintedUnit, number, printed_unit, whole_body_unit};
use crate::text::table::Table;

/// Vibration mode of a structure on a fixed base and on its ground.
///
/// Period lengthening and damping as in ASCE 7, ch. 19.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct SystemMode {
    /// In plan: axis along which the mode has the largest participating mass, `x` or `y`.
    #[cfg_attr(feature = "serde", serde(default))]
    pub axis: Option<char>,
    /// Period T on a fixed base, s.
    pub fixed_period: f64,
    /// Damping ratio β on a fixed base.
    pub fixed_damping: f64,
    /// Period T̃ of the soil–structure system, s.
    pub period: f64,
    /// Damping ratio β₀ of the soil–structure system.
    pub damping: f64,
}

impl SystemMode {
    /// Period lengthening T̃/T.
    pub fn period_ratio(&self) -> f64 {
        self.period / self.fixed_period
    }

    /// Foundation damping β_f = β₀ − β/(T̃/T)²: radiation and the damping of the soil.
    pub fn foundation_damping(&self) -> f64 {
        self.damping - self.fixed_damping / self.period_ratio().powi(2)
    }
}

/// A scene on its ground and on a fixed base, made by [`interaction`].
///
/// It prints as a table.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Interaction {
    /// The run on the ground.
    pub on_ground: Run,
    /// The run of the same structure, loads and motion on a fixed base.
    pub on_fixed_base: Run,
    /// The mode with the largest participating mass along x, in plan also along y; empty for a rigid structure.
    pub modes: Vec<SystemMode>,
}

/// Runs a scene on its ground and on a fixed base, and compares both.
///
/// The function also computes T̃/T and the system's damping.
///
/// `scene` must return a builder of the same scene at each call; both runs last `duration` (s). The second run uses
/// [`SimulationBuilder::on_fixed_base`], with the same model, loads and motion.
///
/// T and β belong to the mode with the largest participating mass along an axis, with fixed contact nodes. For a
/// nonlinear structure they follow from its initial tangent. For T̃ and β₀ the structure is bonded to its ground,
/// deflected in this mode and released. T̃ and β₀ are the period and the damping ratio of the free vibration that
/// follows, computed with Midpoint steps of T/40 or shorter. The soil is linear: use its moduli at the strains of the
/// design motion (ASCE 7, table 19.3-2). Springs in series give a period for comparison: T̃/T = √(1 + k/k_x + k
/// h²/k_θ).
///
/// ```
/// use basemat::analyses::interaction;
/// use basemat::bem::ElasticGround;
/// use basemat::coupled::Probe;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::results::Quantity;
/// use basemat::structure::{ShearBuilding, Storey};
/// use basemat::{Simulation, Soil};
///
/// let comparison = interaction(6.0, || {
///     let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
///     let building =
///         ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?.with_stiffness_damping(0.05)?;
///     Ok(Simulation::builder(0.01)
///         .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &building, 10)?)
///         .probe(Probe::displacement("drift", building.drift(0)?))
///         .structure(building)
///         .interface(Coulomb::new(0.5)?)
///         .motion(el_centro_1940()))
/// })?;
/// println!("{comparison}");
/// let mode = &comparison.modes[0];
/// assert!(mode.period_ratio() > 1.05 && mode.damping > mode.fixed_damping);
/// assert!(comparison.ratio(Quantity::BaseShear) < 1.0);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless the duration is finite and not negative;
/// [`Error::Scene`](crate::Error::Scene) if the vibration after the deflection is not one decaying mode, for
/// example because the structure itself defines a load; as for [`SimulationBuilder::build`] and
/// [`Simulation::run`](crate::Simulation::run).
pub fn interaction(
    duration: f64,
    mut scene: impl FnMut() -> Result<SimulationBuilder>,
) -> Result<Interaction> {
    not_negative("duration", duration)?;
    let on_ground = run_for(duration, scene()?)?;
    let on_fixed_base = run_for(duration, scene()?.on_fixed_base())?;
    let mut modes = Vec::new();
    for axis in on_ground.axes() {
        let builder = scene()?;
        let Some(structure) = builder.structure.as_deref() else { continue };
        let Some(fixed_base_mode) = FixedBaseMode::dominant(structure, axis)? else {
            continue;
        };
        let vibration = free_vibration(builder, &fixed_base_mode)?;
        modes.push(SystemMode {
            axis: axis_name(on_ground.in_plan, axis),
            fixed_period: fixed_base_mode.period,
            fixed_damping: fixed_base_mode.damping,
            period: vibration.period,
            damping: vibration.damping,
        });
    }
    Ok(Interaction { on_ground, on_fixed_base, modes })
}

/// Builds a scene and runs it for `duration` seconds.
fn run_for(duration: f64, builder: SimulationBuilder) -> Result<Run> {
    let mut simulation = builder.build()?;
    simulation.run(simulation.steps_for(duration), |_| {})
}

/// Largest printed ratio of responses; above it the response on the fixed base is only rounding.
const MAX_PRINTED_RATIO: f64 = 1e6;

/// Ratio of largest magnitudes; NaN if both are zero.
fn magnitude_ratio(on_ground: &Extremes, on_fixed_base: &Extremes) -> f64 {
    on_ground.magnitude() / on_fixed_base.magnitude()
}

/// Row of the table: name, unit, largest magnitudes on the ground and on the fixed base, and their ratio.
fn comparison_row(
    name: &str,
    unit: PrintedUnit<'_>,
    on_ground: &Extremes,
    on_fixed_base: &Extremes,
) -> Vec<String> {
    let ratio = magnitude_ratio(on_ground, on_fixed_base);
    vec![
        name.to_owned(),
        unit.symbol.to_owned(),
        number(unit.factor * on_ground.magnitude()),
        number(unit.factor * on_fixed_base.magnitude()),
        if ratio < MAX_PRINTED_RATIO { format!("{ratio:.3}") } else { "–".to_owned() },
    ]
}

impl Interaction {
    /// Largest magnitude of a quantity on the ground over its value on the fixed base.
    ///
    /// NaN if both are zero.
    pub fn ratio(&self, quantity: Quantity) -> f64 {
        let on_ground = self.on_ground.whole.extremes(quantity);
        let on_fixed_base = self.on_fixed_base.whole.extremes(quantity);
        magnitude_ratio(&on_ground, &on_fixed_base)
    }

    /// Largest magnitude of a probe on the ground over its value on the fixed base.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if no probe is called `name`.
    pub fn probe_ratio(&self, name: &str) -> Result<f64> {
        Ok(magnitude_ratio(&self.on_ground.probe(name)?, &self.on_fixed_base.probe(name)?))
    }

    /// Table of forces and probes on the ground and on the fixed base.
    fn table(&self) -> Table {
        let Self { on_ground, on_fixed_base, .. } = self;
        let in_plan = on_ground.in_plan;
        let mut rows = Vec::new();
        for quantity in Quantity::shown(ShownIn::ComparisonTime, in_plan) {
            let ground = on_ground.whole.extremes(quantity);
            let fixed = on_fixed_base.whole.extremes(quantity);
            rows.push(comparison_row(
                quantity.name(),
                quantity.printed_unit(in_plan),
                &ground,
                &fixed,
            ));
        }
        for (ground, fixed) in on_ground.probes.iter().zip(&on_fixed_base.probes) {
            let unit = printed_unit(whole_body_unit(&ground.unit, in_plan));
            rows.push(comparison_row(&ground.name, unit, &ground.extremes, &fixed.extremes));
        }
        let heading = ["Largest", "unit", "on the ground", "fixed base", "ratio"];
        Table { heading: heading.map(str::to_owned).to_vec(), repeated_column_count: 1, rows }
    }
}

impl fmt::Display for Interaction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.table().text())?;
        for mode in &self.modes {
            let axis = mode.axis.map_or(String::new(), |axis| format!(" along {axis}"));
            let SystemMode { fixed_period, period, .. } = mode;
            write!(
                f,
                "\nFirst mode{axis}: T = {fixed_period:.3} s, T̃ = {period:.3} s, T̃/T = {:.3}; damping {:.1} % on a fixed \
                 base, {:.1} % on the ground, of it {:.1} % by the foundation",
                mode.period_ratio(),
                100.0 * mode.fixed_damping,
                100.0 * mode.damping,
                100.0 * mode.foundation_damping()
            )?;
        }
        if self.modes.is_empty() {
            write!(f, "\nNo first mode: the structure is rigid on its base")?;
        }
        Ok(())
    }
}
