//! The compiled part of the Python package `basemat`: descriptions of soils, structures, laws and motions, the
//! simulation made of them, and its results.

/// Converts a `$class` to Python: `$base` is the superclass object for the value `$value`.
macro_rules! extends {
    ($class:ty, $value:ident => $base:expr) => {
        impl $class {
            fn initializer(self) -> pyo3::PyResult<pyo3::PyClassInitializer<Self>> {
                let $value = &self;
                let superclass = $base;
                Ok(pyo3::PyClassInitializer::from(superclass).add_subclass(self))
            }
        }

        impl<'py> pyo3::IntoPyObject<'py> for $class {
            type Target = Self;
            type Output = pyo3::Bound<'py, Self>;
            type Error = pyo3::PyErr;

            fn into_pyobject(self, py: pyo3::Python<'py>) -> pyo3::PyResult<Self::Output> {
                pyo3::Bound::new(py, self.initializer()?)
            }
        }
    };
}

/// Implements the extraction of a `$type` from an `$object` of Python.
macro_rules! extracts {
    ($type:ty, $object:ident => $value:expr) => {
        impl<'py> pyo3::FromPyObject<'_, 'py> for $type {
            type Error = pyo3::PyErr;

            fn extract($object: pyo3::Borrowed<'_, 'py, pyo3::PyAny>) -> pyo3::PyResult<Self> {
                $value
            }
        }
    };
}

mod array;
mod base_node;
mod bearing_capacity;
mod cases;
mod error;
mod ground;
mod interface;
mod joint;
mod list_arguments;
mod motion;
mod names;
mod pickling;
mod probe;
mod profile;
mod recipe;
mod refine;
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
        base_node::{PyBaseFaces, PyBaseNode},
        bearing_capacity::{PyBearingFactors, PyShallowFooting},
        cases::{PyCaseFile, case_numbers, merge_cases},
        error::collect_warnings,
        ground::{
            PyElasticGround, PyGround, PyImpedances, PyKinematicMotions, PyNearField, PyPlan,
            PySharedKernels, PySpringGround, PyStrip, PyTrench, PyTrenchElements, PyTrenchGround,
        },
        interface::{
            PyBonded, PyCohesive, PyCoulomb, PyCyclicYielding, PyEarthPressure, PyInterfaceLaw,
            PyThinLayer, PyVariableFriction, PyYielding,
        },
        joint::PyJoint,
        motion::{
            PyAbrahamsonCoherence, PyCoherence, PyCoherenceFn, PyColumn, PyFreeField,
            PyInclinedWave, PyIncoherence, PyIncoherentMotion, PyLucoWong, PyPlaneWave, PyRecord,
            PySpectrum, PyTrenchMotion, el_centro_1940, free_field, log_spaced, mean_coherence,
            ricker, travelling_wave, triaxial, vertical_incidence,
        },
        pickling::restored,
        probe::PyProbe,
        profile::{PyDampingLaw, PySoilLayer, PySoilProfile},
        refine::{PyPeakTwins, PyRefinement, PyRefinements, PySensitivity, refine, sensitivity},
        results::{
            PyDeformedShape, PyEnergyBalance, PyExtremes, PyInteraction, PyJointResults, PyPeak,
            PyPushOver, PyRun, PyServiceCheck, PySummary, PySystemMode, equivalent_damping,
            joint_results,
        },
        row::{PyDofCombination, PySectionRows},
        simulation::{
            PyCheckpoint, PyFaceForces, PyFoundation, PyInitialConditions, PyJointState, PyLoad,
            PyResultOptions, PyServiceLimits, PySimulation, PySolverOptions, PyState, PySteps,
            PyTimeScheme,
        },
        site::{PyEquivalentLinear, PyStrainCurves},
        soil::{PySoil, PySoilStrength, PyWaterTable},
        structure::{
            PyAxialMomentSurface, PyBeamEndRows, PyBeamRows, PyBeamSection, PyBeamSections,
            PyBilinear, PyBilinearMoment, PyBilinearSteel, PyBoucWen, PyConcrete, PyDruckerPrager,
            PyFemModel, PyFiberSection, PyFrictionPendulum, PyGmshMesh, PyGmshSpaceMesh, PyGrid,
            PyHingeState, PyHysteresis, PyIwan, PyLayer, PyLeadRubber, PyMaterial, PyMatrixModel,
            PyMenegottoPinto, PyMesh, PyPendulumBearing, PyPlanStorey, PyRayleighDamping,
            PyReducedModel, PyRigidBlock, PyRigidBody, PyShearBuilding, PyShellResultants,
            PyShellRows, PySolidPoints, PyStorey, PyStoreyBuilding, PyStressAtRest, PyStructure,
            PyStructureGroup, PyWithElements, PyWithModalDamping, PyWithSprings, PyWithWalls,
            fiber_stress_path, stress_path,
        },
        ticker::cancel_when,
        user::{PyCondition, PyContactState, PyLimits, PyPreviousContact, PyTolerance},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("MODES", &*crate::names::MODES)?;
        module.add("_ELEMENT_UNITS", crate::results::element_units())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
