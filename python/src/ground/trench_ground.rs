//! Ground with a trench in it.

use std::path::PathBuf;
use std::sync::Arc;

use basemat::Complex;
use basemat::bem::embedded::{KinematicMotion, TrenchGround};
use basemat::bem::layered::Stages;
use basemat::soil::Relaxation;
use numpy::Complex64;
use pyo3::prelude::*;

use super::superclass::history_options;
use super::{PyGround, PyImpedances, PySharedKernels, PyTrenchElements};
use crate::array::{Array, Numbers, numpy_complex, whole_numbers};
use crate::error::{OrRaise, WithOption};
use crate::interface::PyEarthPressure;
use crate::list_arguments::{ListOf, type_error};
use crate::profile::{Profile, PyDampingLaw, law_or_elastic};
use crate::soil::{PySoil, PySoilStrength, PyWaterTable};
use crate::ticker::with_progress;

/// A damping law that several grounds read.
#[derive(Debug, Clone)]
struct SharedRelaxation(Arc<dyn Relaxation>);

impl Relaxation for SharedRelaxation {
    fn modulus(&self, s: Complex) -> Complex {
        self.0.modulus(s)
    }

    fn moduli(&self, s: &[Complex], moduli: &mut [Complex]) {
        self.0.moduli(s, moduli);
    }

    fn describe(&self) -> String {
        self.0.describe()
    }

    fn is_causal(&self) -> bool {
        self.0.is_causal()
    }

    fn identity(&self) -> Option<Vec<f64>> {
        self.0.identity()
    }
}

/// Backfill beside the walls of a trench, from the tuple that describes it in Python.
struct BackfillArguments {
    /// Width beside each wall, m.
    width: f64,
    soil: PySoil,
    damping: SharedRelaxation,
}

extracts!(BackfillArguments, object => {
    if let Ok((width, soil)) = object.extract::<(f64, Bound<'_, PySoil>)>() {
        let damping = SharedRelaxation(law_or_elastic(None));
        return Ok(Self { width, soil: PySoil(soil.get().0), damping });
    }
    let requirement = "a tuple (width, Soil) or (width, Soil, DampingLaw)";
    match object.extract::<(f64, Bound<'_, PySoil>, Bound<'_, PyDampingLaw>)>() {
        Ok((width, soil, damping)) => {
            let damping = SharedRelaxation(law_or_elastic(Some(damping.get())));
            Ok(Self { width, soil: PySoil(soil.get().0), damping })
        }
        Err(_) => Err(type_error(&object, requirement)),
    }
});

/// Soil around a trench, in the plane.
///
/// It is a ``soil`` (`Soil` or `SoilProfile`) with the contact elements of walls and base, ``elements``
/// (`TrenchElements`).
///
/// The structure in the trench is a `WithWalls`, or a `FemModel` with ``in_trench``; the ground motion is a
/// `TrenchMotion`.
///
/// ``pressure_at_rest``: K₀, the ratio of the pressure on the walls at rest to the vertical pressure of the soil; ν/(1
/// − ν) of each soil unless given. ``backfill``: soil beside the walls from the surface to the base, a tuple of the
/// width (m) of the backfill, its `Soil` and, if it is damped, its `DampingLaw`; the soil of the profile unless given.
/// ``water_table``: a `WaterTable` that presses on base and walls; pressures of the soil are then effective, and densities
/// below it those of saturated soil; none unless given.
/// ``history``, ``history_tolerance``, ``history_memory``, ``stages``, ``kernel_file`` and ``kernels`` are as for
/// `ElasticGround`, and have its defaults unless given.
#[pyclass(name = "TrenchGround", module = "basemat", extends = PyGround, frozen)]
pub(crate) struct PyTrenchGround {
    pub(crate) make: Arc<dyn Fn() -> basemat::Result<TrenchGround> + Send + Sync>,
}

#[pymethods]
impl PyTrenchGround {
    #[new]
    #[pyo3(signature = (soil, elements, *, pressure_at_rest=None, backfill=None, water_table=None, history="auto", history_tolerance=None, history_memory=None, stages=None, kernel_file=None, kernels=None))]
    fn new(
        soil: Profile,
        elements: Bound<'_, PyTrenchElements>,
        pressure_at_rest: Option<f64>,
        backfill: Option<BackfillArguments>,
        water_table: Option<&Bound<'_, PyWaterTable>>,
        history: &str,
        history_tolerance: Option<f64>,
        #[pyo3(from_py_with = whole_numbers)] history_memory: Option<usize>,
        #[pyo3(from_py_with = whole_numbers)] stages: Option<usize>,
        kernel_file: Option<PathBuf>,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let options = history_options(history, history_tolerance, history_memory)?;
        let stages = stages.map(Stages::from_count).transpose().or_raise()?;
        let kernels = kernels.map(|kernels| kernels.get().0.clone());
        let water_table = water_table.map(|water| water.get().0);
        let elements = elements.get().0.clone();
        let make = move || {
            TrenchGround::new(soil.0.clone(), elements.clone())
                .with(pressure_at_rest, TrenchGround::with_pressure_at_rest)
                .with(backfill.as_ref(), |ground, backfill| {
                    ground.with_backfill(backfill.width, backfill.soil.0, backfill.damping.clone())
                })
                .with(water_table, TrenchGround::with_water_table)
                .and_then(|ground| ground.with_history(options))
                .with(stages, |ground, stages| Ok(ground.with_stages(stages)))
                .with(kernel_file.as_ref(), |ground, file| Ok(ground.with_kernel_file(file)))
                .with(kernels.as_ref(), |ground, kernels| Ok(ground.with_shared_kernels(kernels)))
        };
        let make = Arc::new(make);
        let make_ground = Arc::clone(&make);
        let superclass = PyGround::new(move || make_ground())?;
        Ok(PyClassInitializer::from(superclass).add_subclass(Self { make }))
    }

    /// Dynamic stiffness of a rigid body bonded to walls and base, `Impedances`, at ``frequencies`` (array of shape
    /// (m,), Hz).
    ///
    /// It refers to the middle of the base. Frequency 0 is the static stiffness, on rigid bedrock.
    fn impedances(&self, py: Python<'_>, frequencies: Numbers) -> PyResult<PyImpedances> {
        let ground = (self.make)().or_raise()?;
        let result = py.detach(move || {
            with_progress(None, |observer| ground.impedances(&frequencies.0, observer))
        });
        result.map(PyImpedances)
    }

    /// Interface laws of all elements, a list for `Simulation`: the law ``base`` for the base (an `InterfaceLaw` or an object
    /// with the methods of `UserLaw`), and an `EarthPressure` for each element of the walls.
    ///
    /// ``strengths``: a `SoilStrength` of all soils, or a list of one for each soil from the surface down, the
    /// half-plane last; with backfill, the strength of the backfill alone. ``gravity``: acceleration of gravity, as for
    /// `InitialConditions`, m/s².
    #[pyo3(signature = (base, strengths, *, gravity=9.80665))]
    fn interfaces(
        &self,
        py: Python<'_>,
        base: Py<PyAny>,
        strengths: ListOf<'_, PySoilStrength>,
        gravity: f64,
    ) -> PyResult<Vec<Py<PyAny>>> {
        let ground = (self.make)().or_raise()?;
        let strengths: Vec<_> = strengths.iter().map(|strength| strength.get().0).collect();
        let wall_laws = ground.wall_laws(&strengths, gravity).or_raise()?;
        let class = py.get_type::<PyEarthPressure>();
        let mut python_wall_laws: Vec<Py<PyAny>> = Vec::with_capacity(wall_laws.len());
        for law in &wall_laws {
            let [active, passive] = law.pressures();
            python_wall_laws.push(class.call1((active, passive, law.friction()))?.unbind());
        }
        // Both walls have the same laws, from the surface down to the base.
        let element_count = ground.trench_elements().elements().len();
        let mut laws = Vec::with_capacity(element_count);
        for element in 0..element_count {
            let depth_index = element.min(element_count - 1 - element);
            laws.push(python_wall_laws.get(depth_index).unwrap_or(&base).clone_ref(py));
        }
        Ok(laws)
    }

    /// Motion of a rigid body without mass in the trench, `KinematicMotions`, at ``frequencies`` (array of shape (m,), Hz).
    ///
    /// Shear and pressure waves travel vertically. A ground with backfill raises an error, since waves in it do not
    /// travel vertically.
    fn kinematic_motions(
        &self,
        py: Python<'_>,
        frequencies: Numbers,
    ) -> PyResult<PyKinematicMotions> {
        let ground = (self.make)().or_raise()?;
        let result = py.detach(move || {
            with_progress(None, |observer| ground.kinematic_motions(&frequencies.0, observer))
        });
        result.map(PyKinematicMotions)
    }
}

/// Harmonic motion of a rigid body without mass in a trench.
///
/// It is relative to a unit motion e^(iωt) of the surface of the free field.
///
/// It is the input motion of a structure on springs and dashpots. The arrays are complex, of shape (m,), one value per
/// frequency. Translations are those of the middle of the base, vertical translations positive down; a positive
/// rotation lowers the right end.
#[pyclass(name = "KinematicMotions", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyKinematicMotions(Vec<KinematicMotion>);

#[pymethods]
impl PyKinematicMotions {
    /// Frequencies: array of shape (m,), Hz.
    #[getter]
    fn frequency(&self) -> Array {
        self.0.iter().map(|motion| motion.frequency).collect()
    }

    /// Horizontal translation due to horizontal motion (shear waves): complex array of shape (m,), a ratio.
    #[getter]
    fn horizontal(&self) -> Array<Complex64> {
        self.0.iter().map(|motion| numpy_complex(motion.horizontal)).collect()
    }

    /// Rotation due to horizontal motion (shear waves): complex array of shape (m,), 1/m.
    #[getter]
    fn rotation(&self) -> Array<Complex64> {
        self.0.iter().map(|motion| numpy_complex(motion.rotation)).collect()
    }

    /// Vertical translation due to vertical motion (pressure waves): complex array of shape (m,), a ratio.
    #[getter]
    fn vertical(&self) -> Array<Complex64> {
        self.0.iter().map(|motion| numpy_complex(motion.vertical)).collect()
    }
}
