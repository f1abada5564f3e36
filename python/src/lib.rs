//! The compiled half of the Python package `basemat`: descriptions of soils, structures, laws and
//! motions, the simulation made of them, and its results.

/// Getters `name: type = value;` of a `$class`, whose values may ask for the object by the name `$own`.
macro_rules! getters {
    ($class:ident, $own:ident; $($(#[doc = $doc:tt])+ $name:ident: $type:ty = $value:expr;)+) => {
        #[pyo3::pymethods]
        impl $class {
            $(
                $(#[doc = $doc])+
                #[getter]
                pub(crate) fn $name(&self) -> $type {
                    let $own = self;
                    $value
                }
            )+
        }
    };
}

mod array;
mod cases;
mod dof_names;
mod error;
mod ground;
mod interface;
mod motion;
mod names;
mod probe;
mod profile;
mod recipe;
mod refine;
mod restored;
mod results;
mod row;
mod simulation;
mod site;
mod soil;
mod structure;
mod ticker;
mod user;

#[pyo3::pymodule]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    const STANDARD_GRAVITY: f64 = basemat::motion::STANDARD_GRAVITY;

    #[pymodule_export]
    use crate::{
        array::{memory_limit, set_memory_limit},
        cases::{case_numbers, merge_cases, save_cases},
        ground::{
            PyElasticGround, PyGround, PyImpedances, PyPlan, PySharedKernels, PySpringGround,
            PyStrip,
        },
        interface::{
            PyBonded, PyCohesive, PyCoulomb, PyInterfaceLaw, PyThinLayer, PyVariableFriction,
            PyYielding,
        },
        motion::{
            PyColumn, PyFreeField, PyInclinedWave, PyPlaneWave, PyRecord, PySpectrum,
            el_centro_1940, free_field, log_spaced, ricker, travelling_wave, triaxial,
            vertical_incidence,
        },
        probe::PyProbe,
        profile::{PyDampingLaw, PySoilLayer, PySoilProfile},
        refine::{PyRefinement, refine},
        restored::restored,
        results::{PyEnergyBalance, PyExtremes, PyPeak, PyRun, PyServiceCheck, PySummary},
        row::{PyDofCombination, PySectionRows},
        simulation::{
            PyCheckpoint, PyFoundation, PyLoad, PySimulation, PyState, PySteps, PyTimeScheme,
        },
        site::{PyEquivalentLinear, PyStrainCurves},
        soil::PySoil,
        structure::{
            PyBilinear, PyBoucWen, PyContactNode, PyFaceNode, PyFemModel, PyFrictionPendulum,
            PyGmshMesh, PyHysteresis, PyLayer, PyLeadRubber, PyMaterial, PyMatrixModel, PyMesh,
            PyPlanStorey, PyRayleighDamping, PyReducedModel, PyRigidBlock, PyRigidBody,
            PyShearBuilding, PyStorey, PyStoreyBuilding, PyStructure, PyStructureGroup,
            PyWithModalDamping, PyWithSprings,
        },
        ticker::cancel_when,
        user::{PyCondition, PyContactState, PyLimits, PyPreviousContact, PyTolerance},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("MODES", crate::names::MODES.map(|(_, name)| name))?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
