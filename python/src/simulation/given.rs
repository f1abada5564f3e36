//! Parts and settings of a simulation as Python gave them, of which it can be made more than once.

use basemat::coupled::SimulationBuilder;
use basemat::{Result, Simulation};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::options::{
    Options, PyInitialConditions, PyResultOptions, PyServiceLimits, PySolverOptions,
};
use super::{PyLoad, build};
use crate::dof_names::DofNames;
use crate::error::OrRaise;
use crate::ground;
use crate::motion::PyFreeField;
use crate::probe::PyProbe;
use crate::recipe::Recipe;
use crate::{interface, motion, structure, user};

/// Parts and settings of a simulation.
pub(super) struct Given {
    pub(super) time_step: f64,
    pub(super) structure: Py<PyAny>,
    pub(super) ground: Py<PyAny>,
    pub(super) interface: Py<PyAny>,
    pub(super) motion: Option<Py<PyAny>>,
    pub(super) probes: Vec<Py<PyProbe>>,
    pub(super) loads: Vec<Py<PyLoad>>,
    pub(super) options: Options,
    /// The groups that `options` were read from.
    pub(super) groups: Groups,
    pub(super) fixed_base: bool,
}

/// Groups of options as Python gave them.
pub(super) struct Groups {
    pub(super) initial: Option<Py<PyInitialConditions>>,
    pub(super) solver: Option<Py<PySolverOptions>>,
    pub(super) results: Option<Py<PyResultOptions>>,
    pub(super) service_limits: Option<Py<PyServiceLimits>>,
}

/// A builder, and what a simulation keeps of its parts.
pub(super) struct Made {
    pub(super) builder: SimulationBuilder,
    pub(super) structure: Py<PyAny>,
    pub(super) ground: Py<PyAny>,
    /// Laws of the structure's springs that are written in Python.
    pub(super) hysteresis: Vec<Py<PyAny>>,
    pub(super) names: Option<DofNames>,
    /// Length of the motion, s.
    pub(super) duration: Option<f64>,
}

/// A part for one simulation.
fn made<T: ?Sized>(recipe: &Recipe<T>) -> PyResult<Box<T>> {
    recipe().or_raise()
}

impl Given {
    /// All arguments of the simulation by their names.
    pub(super) fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let arguments = PyDict::new(py);
        arguments.set_item("time_step", self.time_step)?;
        arguments.set_item("structure", &self.structure)?;
        arguments.set_item("ground", &self.ground)?;
        arguments.set_item("interface", &self.interface)?;
        arguments.set_item("motion", &self.motion)?;
        arguments.set_item("loads", &self.loads)?;
        arguments.set_item("probes", &self.probes)?;
        arguments.set_item("initial", &self.groups.initial)?;
        arguments.set_item("solver", &self.groups.solver)?;
        arguments.set_item("results", &self.groups.results)?;
        arguments.set_item("service_limits", &self.groups.service_limits)?;
        arguments.set_item("fixed_base", self.fixed_base)?;
        Ok(arguments)
    }

    /// A builder of parts of its own.
    pub(super) fn made(&self, py: Python<'_>) -> PyResult<Made> {
        let (ground, own_ground) = ground::made(self.ground.bind(py))?;
        let laws = interface::recipes(self.interface.bind(py))?;
        let laws = laws.iter().map(|make| make()).collect::<Result<_>>().or_raise()?;
        user::made_springs();
        let (structure, object) = structure::made(self.structure.bind(py))?;
        let hysteresis = user::made_springs();
        let dofs = structure.dofs();
        let names = DofNames::from_structure(&object, dofs)?;
        let probes: Vec<_> = self.probes.iter().map(|probe| probe.bind(py).clone()).collect();
        let mut builder = Simulation::builder(self.time_step)
            .structure(structure)
            .ground(ground)
            .interfaces(laws)
            .probes(build::probes(probes.iter(), dofs)?);
        builder = self.options.set(builder)?;
        for load in &self.loads {
            let load = load.bind(py).get();
            load.order.check("a load", dofs)?;
            builder = builder.load((load.make)().or_raise()?);
        }
        let motion = self.motion.as_ref().map(|motion| motion.bind(py));
        if let Some(motion) = motion {
            builder = builder.motion(made(&motion::given(motion)?.get().make)?);
        }
        if self.fixed_base {
            builder = builder.on_fixed_base();
        }
        let motion = motion.and_then(|motion| motion.cast::<PyFreeField>().ok());
        let duration = motion.and_then(|motion| motion.get().duration);
        let (structure, ground) = (object.unbind(), own_ground.unbind());
        Ok(Made { builder, structure, ground, hysteresis, names, duration })
    }
}
