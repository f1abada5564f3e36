//! The compiled half of the Python package `basemat`: descriptions of soils, structures, laws and
//! motions, the simulation made of them, and its results.

mod array;
mod error;
mod ground;
mod interface;
mod motion;
mod names;
mod probe;
mod profile;
mod recipe;
mod results;
mod row;
mod simulation;
mod soil;
mod structure;
mod user;

use pyo3::prelude::*;

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("MODES", names::MODE_NAMES)?;
    module.add("STANDARD_GRAVITY", basemat::motion::STANDARD_GRAVITY)?;
    module.add_class::<soil::PySoil>()?;
    module.add_class::<profile::PyDampingLaw>()?;
    module.add_class::<profile::PySoilLayer>()?;
    module.add_class::<profile::PySoilProfile>()?;
    module.add_class::<row::PyRow>()?;
    module.add_class::<row::PySectionRows>()?;
    module.add_class::<probe::PyProbe>()?;
    module.add_class::<structure::PyStructure>()?;
    module.add_class::<structure::PyContactNode>()?;
    module.add_class::<structure::PyRigidBlock>()?;
    module.add_class::<structure::PyStorey>()?;
    module.add_class::<structure::PyShearBuilding>()?;
    module.add_class::<structure::PyMatrixModel>()?;
    module.add_class::<structure::PyRayleighDamping>()?;
    module.add_class::<structure::PyReducedModel>()?;
    module.add_class::<structure::PyStructureGroup>()?;
    module.add_class::<structure::PyWithModalDamping>()?;
    module.add_class::<structure::PyHysteresis>()?;
    module.add_class::<structure::PyBilinear>()?;
    module.add_class::<structure::PyBoucWen>()?;
    module.add_class::<structure::PyFrictionPendulum>()?;
    module.add_class::<structure::PyLeadRubber>()?;
    module.add_class::<structure::PyNonlinearShearBuilding>()?;
    module.add_class::<structure::PyWithSprings>()?;
    module.add_class::<structure::PyMaterial>()?;
    module.add_class::<structure::PyLayer>()?;
    module.add_class::<structure::PyMesh>()?;
    module.add_class::<structure::PyFemModel>()?;
    module.add_class::<structure::PyGmshMesh>()?;
    module.add_class::<ground::PyGround>()?;
    module.add_class::<ground::PyStrip>()?;
    module.add_class::<ground::PySharedKernels>()?;
    module.add_class::<ground::PyHalfPlaneGround>()?;
    module.add_class::<ground::PyLayeredGround>()?;
    module.add_class::<ground::PyImpedances>()?;
    module.add_class::<ground::PySpringGround>()?;
    module.add_class::<interface::PyInterfaceLaw>()?;
    module.add_class::<interface::PyBonded>()?;
    module.add_class::<interface::PyCoulomb>()?;
    module.add_class::<interface::PyAdhesive>()?;
    module.add_class::<interface::PyYielding>()?;
    module.add_class::<interface::PyThinLayer>()?;
    module.add_class::<interface::PyVariableFriction>()?;
    module.add_class::<user::PyStepStart>()?;
    module.add_class::<user::PyCondition>()?;
    module.add_class::<user::PyContactState>()?;
    module.add_class::<user::PyTolerance>()?;
    module.add_class::<motion::PyFreeField>()?;
    module.add_class::<motion::PyRecord>()?;
    module.add_class::<motion::PySpectrum>()?;
    module.add_class::<motion::PyPlaneWave>()?;
    module.add_class::<motion::PyColumn>()?;
    module.add_class::<motion::PyInclinedWave>()?;
    module.add_function(wrap_pyfunction!(motion::el_centro_1940, module)?)?;
    module.add_function(wrap_pyfunction!(motion::log_spaced, module)?)?;
    module.add_function(wrap_pyfunction!(motion::vertical_incidence, module)?)?;
    module.add_function(wrap_pyfunction!(motion::travelling_wave, module)?)?;
    module.add_function(wrap_pyfunction!(motion::ricker, module)?)?;
    module.add_class::<simulation::PyLoad>()?;
    module.add_class::<simulation::PyTimeScheme>()?;
    module.add_class::<simulation::PySimulation>()?;
    module.add_class::<simulation::PySteps>()?;
    module.add_class::<simulation::PyState>()?;
    module.add_class::<simulation::PyFoundation>()?;
    module.add_class::<simulation::PyCheckpoint>()?;
    module.add_function(wrap_pyfunction!(simulation::cancel_when, module)?)?;
    module.add_class::<results::PyRun>()?;
    module.add_class::<results::PyPeak>()?;
    module.add_class::<results::PyExtremes>()?;
    module.add_class::<results::PyLedger>()?;
    module.add_class::<results::PyFoundationSummary>()?;
    module.add_class::<results::PyServiceCheck>()?;
    Ok(())
}
