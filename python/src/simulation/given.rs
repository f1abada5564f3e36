//! Parts and settings of a simulation as Python gave them, of which it can be made more than once.

use basemat::coupled::SimulationBuilder;
use basemat::{Result, Simulation};
use pyo3::prelude::*;

use super::options::Options;
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
    pub(super) fixed_base: bool,
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
    /// A builder of parts of its own.
    pub(super) fn made(&self, py: Python<'_>) -> PyResult<Made> {
        let (ground, own_ground) = ground::made(self.ground.bind(py))?;
        let in_plan = ground.elements().first().is_some_and(|own| own.directions().len() == 3);
        let laws = interface::recipes(self.interface.bind(py), in_plan)?;
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
