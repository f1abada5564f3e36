//! Groups of options of a simulation.

use basemat::contact::ContactSearch;
use basemat::coupled::{Coordinates, GravityStage, SimulationBuilder};
use basemat::results::Serviceability;
use basemat::soil::WaterTable;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::PyTimeScheme;
use super::build::coordinates;
use crate::array::{Numbers, whole_numbers};
use crate::error::OrRaise;
use crate::soil::PyWaterTable;

/// Weight and motion at the start of a simulation.
///
/// Args:
///     gravity: acceleration of gravity, which determines the weight of the structure, m/s²; 9.80665 unless given. With
///         0 there is no static state: the base begins without pressure, and nothing resists uplift and sliding.
///     gravity_stage: friction while the weight of masses and `Load.weight` is applied; all other loads at t = 0 are
///         applied slowly after it, while the interface law acts. "frictionless" (the default): neither friction nor
///         cohesion, and the base sticks from then on; "frictional": the interface law acts, in one step;
///         "wished_in_place": walls and base in the ground replace soil at rest, for comparisons; "unloaded": there is
///         no static state, weight and loads act from t = 0 on, as for a block that is released.
///     water_table: `WaterTable` of a base on the surface: its pressure acts up on the base from the beginning, and contact
///         is effective; none unless given.
///     displacement: displacement of the n degrees of freedom at t = 0 from the static state, array of shape (n,), m
///         and rad; zero unless given. The base may be displaced only if ``gravity_stage`` is "unloaded".
///     velocity: velocity of the n degrees of freedom at t = 0, array of shape (n,), m/s and rad/s; zero unless given.
#[pyclass(name = "InitialConditions", module = "basemat", frozen, dict, from_py_object)]
#[derive(Clone, Default)]
pub(crate) struct PyInitialConditions {
    gravity: Option<f64>,
    gravity_stage: GravityStage,
    water_table: Option<WaterTable>,
    displacement: Option<Vec<f64>>,
    velocity: Option<Vec<f64>>,
}

#[pymethods]
impl PyInitialConditions {
    #[new]
    #[pyo3(signature = (*, gravity=None, gravity_stage="frictionless", water_table=None, displacement=None, velocity=None))]
    fn new(
        gravity: Option<f64>,
        gravity_stage: &str,
        water_table: Option<&Bound<'_, PyWaterTable>>,
        displacement: Option<Numbers>,
        velocity: Option<Numbers>,
    ) -> PyResult<Self> {
        Ok(Self {
            gravity,
            gravity_stage: gravity_stage.parse().or_raise()?,
            water_table: water_table.map(|water| water.get().0),
            displacement: displacement.map(|numbers| numbers.0),
            velocity: velocity.map(|numbers| numbers.0),
        })
    }
}

/// Numerical methods of a simulation.
///
/// Args:
///     scheme: a `TimeScheme`; the midpoint rule, which conserves energy, unless given.
///     coordinates: coordinates of the equations of motion of a linear structure. "auto" (the default): the choice of
///         "physical" and "modes" that takes less time; "physical": its degrees of freedom; "modes": its vibration
///         modes; a number: reduced coordinates, 200 to 400 Ritz vectors for thousands of degrees of freedom, with this
///         relative error of responses (above 0, below 1; "reduced(1e-6)" is the same as 1e-6).
///     expected_steps: number of steps that will be made. Memory and convolution weights of the ground are prepared for
///         them before the first step; unless given, for the steps of the first run. An error is raised if the steps do
///         not fit into the memory of the history of the ground.
///     rotation_limit: rotation of the base, about a horizontal axis, at which a run ends, rad; 1 unless given. A
///         further run continues; with ``math.inf`` the rotation ends no run.
///     flow_chart_iterations: searches contact modes by the flow chart of Patel and Spyrakos with at most this number
///         of iterations a step, for comparison with their paper; the robust search unless given.
#[pyclass(name = "SolverOptions", module = "basemat", frozen, dict, from_py_object)]
#[derive(Clone, Default)]
pub(crate) struct PySolverOptions {
    scheme: Option<PyTimeScheme>,
    coordinates: Option<Coordinates>,
    expected_steps: Option<usize>,
    rotation_limit: Option<f64>,
    search: Option<ContactSearch>,
}

#[pymethods]
impl PySolverOptions {
    #[new]
    #[pyo3(signature = (*, scheme=None, coordinates=None, expected_steps=None, rotation_limit=None, flow_chart_iterations=None))]
    fn new(
        scheme: Option<&Bound<'_, PyTimeScheme>>,
        coordinates: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = whole_numbers)] expected_steps: Option<usize>,
        rotation_limit: Option<f64>,
        #[pyo3(from_py_with = whole_numbers)] flow_chart_iterations: Option<usize>,
    ) -> PyResult<Self> {
        Ok(Self {
            scheme: scheme.map(|scheme| scheme.get().clone()),
            coordinates: coordinates.map(self::coordinates).transpose()?,
            expected_steps,
            rotation_limit,
            search: flow_chart_iterations.map(|iterations| ContactSearch::FlowChart { iterations }),
        })
    }
}

/// Quantities that a run evaluates; they do not change the motion.
///
/// Args:
///     moment_center: x of the reference point of the base moment, m; the middle of the base unless given.
///     energy_balance: whether energies are computed; True by default. Without them steps are faster, and
///         `Run.energy_error` is NaN.
///     safety_friction: friction coefficient for the factor of safety against sliding; the coefficient of the interface
///         law unless given.
///     label: text that checkpoints store and `Simulation.resume` compares; it should name the parts that are not
///         compared otherwise: interface law, ground motion and loads. Empty unless given.
#[pyclass(name = "ResultOptions", module = "basemat", frozen, dict, from_py_object)]
#[derive(Clone, Default)]
pub(crate) struct PyResultOptions {
    moment_center: Option<f64>,
    without_energy_balance: bool,
    safety_friction: Option<f64>,
    label: Option<String>,
}

#[pymethods]
impl PyResultOptions {
    #[new]
    #[pyo3(signature = (*, moment_center=None, energy_balance=true, safety_friction=None, label=None))]
    fn new(
        moment_center: Option<f64>,
        energy_balance: bool,
        safety_friction: Option<f64>,
        label: Option<String>,
    ) -> Self {
        let without_energy_balance = !energy_balance;
        Self { moment_center, without_energy_balance, safety_friction, label }
    }
}

/// Limits of service for `Run.serviceability`; they do not change the motion.
///
/// Args:
///     slip: limit of |mean slip|, m; none unless given.
///     gap: limit of the gap of any element, m; none unless given.
///     uplifted_fraction: limit of the ratio of the open length to the length of the base, in plan of areas, above 0
///         and at most 1; none unless given.
///     rotation: limit of the base's |rotation|, rad; none unless given.
///     settlement: limit of the base's settlement, m; none unless given.
#[pyclass(name = "ServiceLimits", module = "basemat", frozen, dict, from_py_object)]
#[derive(Clone, Default)]
pub(crate) struct PyServiceLimits(Serviceability);

#[pymethods]
impl PyServiceLimits {
    #[new]
    #[pyo3(signature = (*, slip=None, gap=None, uplifted_fraction=None, rotation=None, settlement=None))]
    fn new(
        slip: Option<f64>,
        gap: Option<f64>,
        uplifted_fraction: Option<f64>,
        rotation: Option<f64>,
        settlement: Option<f64>,
    ) -> Self {
        Self(Serviceability { slip, gap, uplifted_fraction, rotation, settlement })
    }
}

/// All groups of options of a simulation.
#[derive(Default)]
pub(super) struct Options {
    pub(super) initial: PyInitialConditions,
    pub(super) solver: PySolverOptions,
    pub(super) results: PyResultOptions,
    pub(super) limits: PyServiceLimits,
}

/// Calls those methods of a builder whose optional argument is present.
macro_rules! with_options {
    ($builder:ident, $($method:ident($option:expr)),+ $(,)?) => {
        $(if let Some(argument) = $option {
            $builder = $builder.$method(argument);
        })+
    };
}

impl Options {
    /// The builder with these options.
    pub(super) fn set(&self, builder: SimulationBuilder) -> PyResult<SimulationBuilder> {
        let Self { initial, solver, results, limits } = self;
        let mut builder = builder.gravity_stage(initial.gravity_stage).serviceability(limits.0);
        let scheme = solver.scheme.as_ref().map(|scheme| (scheme.make)().or_raise());
        with_options!(
            builder,
            gravity(initial.gravity),
            water_table(initial.water_table),
            initial_displacement(initial.displacement.clone()),
            initial_velocity(initial.velocity.clone()),
            scheme(scheme.transpose()?),
            contact_search(solver.search),
            coordinates(solver.coordinates),
            expected_steps(solver.expected_steps),
            rotation_limit(solver.rotation_limit),
            moment_center(results.moment_center),
            safety_friction(results.safety_friction.map(|coefficient| [coefficient])),
            label(results.label.clone()),
        );
        if results.without_energy_balance {
            builder = builder.without_energy_balance();
        }
        Ok(builder)
    }
}

/// Groups of options: the argument of the simulation, the class, and names of its options, as a user may pass them to
/// `Simulation` by mistake: some have a prefix.
const OPTION_GROUPS: [(&str, &str, &[&str]); 4] = [
    (
        "initial",
        "InitialConditions",
        &["gravity", "gravity_stage", "water_table", "initial_displacement", "initial_velocity"],
    ),
    (
        "solver",
        "SolverOptions",
        &["scheme", "coordinates", "expected_steps", "rotation_limit", "flow_chart_iterations"],
    ),
    (
        "results",
        "ResultOptions",
        &["moment_center", "energy_balance", "safety_friction", "label"],
    ),
    (
        "service_limits",
        "ServiceLimits",
        &["allowable_slip", "allowable_gap", "allowable_uplifted_fraction", "allowable_rotation"],
    ),
];

/// `TypeError` for an unknown argument of a simulation; for an option it names the group.
pub(super) fn reject_unknown_arguments(others: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
    let Some((name, _)) = others.and_then(|others| others.iter().next()) else {
        return Ok(());
    };
    let name = name.to_string();
    let group = OPTION_GROUPS.iter().find(|(.., options)| options.contains(&&*name));
    Err(PyTypeError::new_err(match group {
        Some((argument, class, _)) => {
            let option = name.strip_prefix("allowable_").unwrap_or(&name);
            let option = option.strip_prefix("initial_").unwrap_or(option);
            format!("Simulation has no argument '{name}': give {argument}={class}({option}=…)")
        }
        None => format!("Simulation has no argument '{name}'"),
    }))
}
