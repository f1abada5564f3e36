//! Parts and settings of a simulation, from which it can be built more than once.

use basemat::coupled::SimulationBuilder;
use basemat::{Result, Simulation};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
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
pub(super) struct SimulationParts {
    pub(super) time_step: f64,
    pub(super) structure: Py<PyAny>,
    pub(super) ground: Py<PyAny>,
    pub(super) interface: Py<PyAny>,
    pub(super) motion: Option<Py<PyAny>>,
    pub(super) probes: Vec<Py<PyProbe>>,
    pub(super) loads: Vec<Py<PyLoad>>,
    pub(super) options: Options,
    /// The groups that `options` were read from.
    pub(super) groups: OptionGroups,
    pub(super) fixed_base: bool,
}

/// Python's objects of the groups of options.
pub(super) struct OptionGroups {
    pub(super) initial: Option<Py<PyInitialConditions>>,
    pub(super) solver: Option<Py<PySolverOptions>>,
    pub(super) results: Option<Py<PyResultOptions>>,
    pub(super) service_limits: Option<Py<PyServiceLimits>>,
}

/// A builder, and the objects of Python that a simulation keeps.
pub(super) struct BuilderParts {
    pub(super) builder: SimulationBuilder,
    pub(super) structure: Py<PyAny>,
    pub(super) ground: Py<PyAny>,
    /// Laws of the structure's springs that are written in Python.
    pub(super) hysteresis: Vec<Py<PyAny>>,
    pub(super) names: Option<DofNames>,
    /// Length of the motion, s.
    pub(super) duration: Option<f64>,
}

/// The value of a group of options, or its default.
pub(super) fn cloned_or_default<T>(group: Option<&Py<T>>) -> T
where
    T: PyClass<Frozen = True> + Sync + Clone + Default,
{
    group.map(|group| group.get().clone()).unwrap_or_default()
}

/// A part for one simulation.
fn make_part<T: ?Sized>(recipe: &Recipe<T>) -> PyResult<Box<T>> {
    recipe().or_raise()
}

impl SimulationParts {
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

    /// A builder with new parts.
    pub(super) fn builder_parts(&self, py: Python<'_>) -> PyResult<BuilderParts> {
        let (ground, ground_object) = ground::new_ground(self.ground.bind(py))?;
        let laws = interface::law_recipes(self.interface.bind(py))?;
        let laws = laws.iter().map(|make| make()).collect::<Result<_>>().or_raise()?;
        user::take_made_springs();
        let (structure, structure_object) = structure::new_structure(self.structure.bind(py))?;
        let hysteresis = user::take_made_springs();
        let dofs = structure.dofs();
        let names = DofNames::from_structure(&structure_object, dofs)?;
        let probes: Vec<_> = self.probes.iter().map(|probe| probe.bind(py).clone()).collect();
        let mut builder = Simulation::builder(self.time_step)
            .structure(structure)
            .ground(ground)
            .interfaces(laws)
            .probes(build::probes(probes.iter(), dofs)?);
        builder = self.options.set(builder)?;
        for load in &self.loads {
            let load = load.bind(py).get();
            load.weight_count.check("a load", dofs)?;
            builder = builder.load((load.make)().or_raise()?);
        }
        let motion = self.motion.as_ref().map(|motion| motion.bind(py));
        if let Some(motion) = motion {
            builder = builder.motion(make_part(&motion::free_field_object(motion)?.get().make)?);
        }
        if self.fixed_base {
            builder = builder.on_fixed_base();
        }
        let motion = motion.and_then(|motion| motion.cast::<PyFreeField>().ok());
        let duration = motion.and_then(|motion| motion.get().duration);
        Ok(BuilderParts {
            builder,
            structure: structure_object.unbind(),
            ground: ground_object.unbind(),
            hysteresis,
            names,
            duration,
        })
    }
}
