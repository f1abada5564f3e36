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
use crate::error::OrRaise;
use crate::ground;
use crate::joint::PyJoint;
use crate::motion::PyFreeField;
use crate::names::DofNames;
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
    pub(super) joints: Vec<Py<PyJoint>>,
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

impl OptionGroups {
    /// Values of all groups; the defaults of those that are not given.
    pub(super) fn options(&self) -> Options {
        Options {
            initial: cloned_or_default(self.initial.as_ref()),
            solver: cloned_or_default(self.solver.as_ref()),
            results: cloned_or_default(self.results.as_ref()),
            limits: cloned_or_default(self.service_limits.as_ref()),
        }
    }
}

/// A builder, and the objects of Python that a simulation keeps.
pub(super) struct BuilderParts {
    pub(super) builder: SimulationBuilder,
    pub(super) structure: Py<PyAny>,
    pub(super) ground: Py<PyAny>,
    /// Laws of the structure's springs that are written in Python.
    pub(super) hysteresis: Vec<Py<PyAny>>,
    pub(super) dof_names: Option<DofNames>,
    /// Duration of the ground motion, s; `None` for a motion without an end.
    pub(super) motion_duration: Option<f64>,
}

/// The value of a group of options, or its default.
fn cloned_or_default<T>(group: Option<&Py<T>>) -> T
where
    T: PyClass<Frozen = True> + Sync + Clone + Default,
{
    group.map(|group| group.get().clone()).unwrap_or_default()
}

/// Builds a part for one simulation.
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
        arguments.set_item("joints", &self.joints)?;
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
        let law_recipes = interface::law_recipes(self.interface.bind(py))?;
        let laws = law_recipes.iter().map(|make| make()).collect::<Result<_>>().or_raise()?;
        user::take_made_springs();
        let (structure, structure_object) = structure::new_structure(self.structure.bind(py))?;
        let hysteresis = user::take_made_springs();
        let dof_count = structure.dofs();
        let dof_names = DofNames::from_structure(&structure_object, dof_count)?;
        let probes: Vec<_> = self.probes.iter().map(|probe| probe.bind(py).clone()).collect();
        let mut builder = Simulation::builder(self.time_step)
            .structure(structure)
            .ground(ground)
            .interfaces(laws)
            .probes(build::probes(probes.iter(), dof_count)?);
        builder = self.options.set(builder)?;
        for joint in &self.joints {
            builder = builder.joint(joint.bind(py).get().core(Some(dof_count))?);
        }
        for load_object in &self.loads {
            let load = load_object.bind(py).get();
            load.weight_count.check("a load", dof_count)?;
            builder = builder.load((load.make)().or_raise()?);
        }
        let motion_object = self.motion.as_ref().map(|object| object.bind(py));
        if let Some(motion_object) = motion_object {
            builder =
                builder.motion(make_part(&motion::free_field_object(motion_object)?.get().make)?);
        }
        if self.fixed_base {
            builder = builder.on_fixed_base();
        }
        let free_field = motion_object.and_then(|object| object.cast::<PyFreeField>().ok());
        let motion_duration = free_field.and_then(|field| field.get().duration);
        Ok(BuilderParts {
            builder,
            structure: structure_object.unbind(),
            ground: ground_object.unbind(),
            hysteresis,
            dof_names,
            motion_duration,
        })
    }
}
