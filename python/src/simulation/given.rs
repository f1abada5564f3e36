//! Parts and settings of a simulation as Python gave them, of which it can be made more than once.

use basemat::contact::ContactSearch;
use basemat::coupled::{Coordinates, GravityStage, SimulationBuilder};
use basemat::results::Serviceability;
use basemat::{Result, Simulation};
use pyo3::prelude::*;

use super::{PyLoad, PyTimeScheme, build};
use crate::dof_names::DofNames;
use crate::error::OrRaise;
use crate::ground::PyGround;
use crate::motion::PyFreeField;
use crate::probe::PyProbe;
use crate::recipe::Recipe;
use crate::{interface, motion, structure, user};

/// Parts and settings of a simulation.
pub(super) struct Given {
    pub(super) time_step: f64,
    pub(super) structure: Py<PyAny>,
    pub(super) ground: Py<PyGround>,
    pub(super) interface: Py<PyAny>,
    pub(super) motion: Option<Py<PyAny>>,
    pub(super) probes: Vec<Py<PyProbe>>,
    pub(super) loads: Vec<Py<PyLoad>>,
    pub(super) gravity: Option<f64>,
    pub(super) gravity_stage: GravityStage,
    pub(super) initial_displacement: Option<Vec<f64>>,
    pub(super) initial_velocity: Option<Vec<f64>>,
    pub(super) scheme: Option<Py<PyTimeScheme>>,
    pub(super) coordinates: Option<Coordinates>,
    pub(super) expected_steps: Option<usize>,
    pub(super) moment_center: Option<f64>,
    pub(super) energy_balance: bool,
    pub(super) safety_friction: Option<f64>,
    pub(super) serviceability: Serviceability,
    pub(super) search: Option<ContactSearch>,
    pub(super) rotation_limit: Option<f64>,
    pub(super) fixed_base: bool,
}

/// A builder, and what a simulation keeps of its parts.
pub(super) struct Made {
    pub(super) builder: SimulationBuilder,
    pub(super) structure: Py<PyAny>,
    /// Laws of the structure's springs that are written in Python.
    pub(super) hysteresis: Vec<Py<PyAny>>,
    pub(super) names: Option<DofNames>,
    /// Length of the motion, s.
    pub(super) duration: Option<f64>,
}

/// Calls methods of a builder with the arguments that were given.
macro_rules! with_given {
    ($builder:ident, $($method:ident($given:expr)),+ $(,)?) => {
        $(if let Some(given) = $given {
            $builder = $builder.$method(given);
        })+
    };
}

/// A part for one simulation.
fn made<T: ?Sized>(recipe: &Recipe<T>) -> PyResult<Box<T>> {
    recipe().or_raise()
}

impl Given {
    /// A builder of parts of its own.
    pub(super) fn made(&self, py: Python<'_>) -> PyResult<Made> {
        let ground = made(&self.ground.bind(py).get().make)?;
        let laws = interface::recipes(self.interface.bind(py), ground.elements()[0].directions().len() == 3)?;
        let laws = laws.iter().map(|make| make()).collect::<Result<_>>().or_raise()?;
        user::made_springs();
        let (structure, object) = structure::made(self.structure.bind(py))?;
        let hysteresis = user::made_springs();
        let dofs = structure.dofs();
        let names = DofNames::of(&object, dofs)?;
        let probes: Vec<_> = self.probes.iter().map(|probe| probe.bind(py).clone()).collect();
        let mut builder = Simulation::builder(self.time_step)
            .structure(structure)
            .ground(ground)
            .interfaces(laws)
            .gravity_stage(self.gravity_stage)
            .serviceability(self.serviceability)
            .probes(build::probes(probes.iter(), dofs)?);
        for load in &self.loads {
            let load = load.bind(py).get();
            load.order.check("a load", dofs)?;
            builder = builder.load((load.make)().or_raise()?);
        }
        let motion = self.motion.as_ref().map(|motion| motion.bind(py));
        let scheme = self.scheme.as_ref().map(|scheme| made(&scheme.bind(py).get().make));
        with_given!(
            builder,
            motion(motion.map(|own| made(&motion::given(own)?.get().make)).transpose()?),
            gravity(self.gravity),
            initial_displacement(self.initial_displacement.clone()),
            initial_velocity(self.initial_velocity.clone()),
            scheme(scheme.transpose()?),
            contact_search(self.search),
            coordinates(self.coordinates),
            expected_steps(self.expected_steps),
            moment_center(self.moment_center),
            rotation_limit(self.rotation_limit),
            safety_friction(self.safety_friction.map(|coefficient| [coefficient])),
        );
        if !self.energy_balance {
            builder = builder.without_energy_balance();
        }
        if self.fixed_base {
            builder = builder.on_fixed_base();
        }
        let motion = motion.and_then(|motion| motion.cast::<PyFreeField>().ok());
        let duration = motion.and_then(|motion| motion.get().duration);
        Ok(Made { builder, structure: object.unbind(), hysteresis, names, duration })
    }
}
