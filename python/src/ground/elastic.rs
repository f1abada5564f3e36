//! Elastic soil, homogeneous or layered.

use std::path::PathBuf;

use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, SharedKernels, Strip};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::soil::SoilProfile;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::PyGround;
use super::impedance::{PyImpedances, contact};
use super::strip::{Strips, grading};
use crate::array::{Numbers, whole};
use crate::error::{OrRaise, no_such};
use crate::profile::PySoilProfile;
use crate::soil::PySoil;
use crate::structure;
use crate::ticker::watched;

/// Kernels that grounds of equal soil and elements share: evaluated once for all simulations that
/// are built with the same object. A copy in another process begins empty; ``len()`` counts them.
#[pyclass(name = "SharedKernels", module = "basemat", frozen)]
#[derive(Default)]
pub(crate) struct PySharedKernels(SharedKernels);

#[pymethods]
impl PySharedKernels {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// A copy in another process begins empty.
    #[allow(clippy::unused_self, reason = "a method of Python")]
    fn __getnewargs__<'py>(&self, py: Python<'py>) -> Bound<'py, PyTuple> {
        PyTuple::empty(py)
    }

    fn __len__(&self) -> usize {
        self.0.count()
    }
}

/// Elastic half-plane of a ``soil`` (:class:`Soil`), or its layers (:class:`SoilProfile`), with contact
/// elements on its surface: ``strips`` is a :class:`Strip` or a list of them.
///
/// ``history``: how the response to all past tractions is summed: "auto" (the default: whichever takes
/// least time), "direct", "relaxed fft" or, without layers and damping, "exponentials".
/// ``history_tolerance``: relative error, 1e-12 to 1e-2, that exponentials may have (1e-12 unless
/// given, 1e-10 where they were asked for); ``history_memory``: bytes that the history may take (1 GiB
/// unless given). ``kernels``: :class:`SharedKernels` of several simulations; own ones unless given.
/// Of layers and damping: ``stages``: 2 or 3 Runge–Kutta stages (the rule's choice unless given);
/// ``tolerance``: relative error of the element compliances, 1e-13 to 1e-4 (1e-10 unless given);
/// ``kernel_file``: path of a file that keeps them (none unless given).
#[pyclass(name = "ElasticGround", module = "basemat", extends = PyGround, frozen)]
pub(crate) struct PyElasticGround {
    make: Box<dyn Fn() -> basemat::Result<ElasticGround> + Send + Sync>,
}

/// Of a soil or a profile.
struct Profile(SoilProfile);

impl<'py> FromPyObject<'_, 'py> for Profile {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(soil) = object.cast::<PySoil>() {
            return Ok(Self(soil.get().0.into()));
        }
        match object.cast::<PySoilProfile>() {
            Ok(profile) => Ok(Self(profile.get().0.clone())),
            Err(_) => Err(no_such(&object, "a Soil or a SoilProfile")),
        }
    }
}

/// Step coefficients and history of the ground.
#[derive(Clone)]
struct Options {
    kind: HistoryMethod,
    history_tolerance: Option<f64>,
    memory: Option<usize>,
    stages: Option<Stages>,
    tolerance: Option<f64>,
    file: Option<PathBuf>,
    kernels: Option<SharedKernels>,
}

impl Options {
    fn new(
        kind: &str,
        history_tolerance: Option<f64>,
        memory: Option<usize>,
        stages: Option<usize>,
        tolerance: Option<f64>,
        file: Option<PathBuf>,
        kernels: Option<&Bound<'_, PySharedKernels>>,
    ) -> PyResult<Self> {
        let kind = kind.parse().or_raise()?;
        let stages = stages.map(Stages::from_count).transpose().or_raise()?;
        let kernels = kernels.map(|kernels| kernels.get().0.clone());
        Ok(Self { kind, history_tolerance, memory, stages, tolerance, file, kernels })
    }

    fn of(&self, ground: ElasticGround) -> basemat::Result<ElasticGround> {
        let mut options = HistoryOptions { tolerance: self.history_tolerance, ..self.kind.into() };
        options.memory = self.memory.unwrap_or(options.memory);
        let mut ground = ground.with_history(options)?;
        if let Some(stages) = self.stages {
            ground = ground.with_stages(stages);
        }
        if let Some(tolerance) = self.tolerance {
            ground = ground.with_tolerance(tolerance)?;
        }
        if let Some(file) = &self.file {
            ground = ground.with_kernel_file(file);
        }
        Ok(match &self.kernels {
            Some(kernels) => ground.with_shared_kernels(kernels),
            None => ground,
        })
    }
}

fn ground(
    Profile(profile): Profile,
    strips: impl Fn() -> basemat::Result<Vec<Strip>> + Clone + Send + Sync + 'static,
    options: Options,
) -> PyResult<PyClassInitializer<PyElasticGround>> {
    let make = move || options.of(ElasticGround::new(profile.clone(), strips()?)?);
    let base = PyGround::new(make.clone())?;
    Ok(PyClassInitializer::from(base).add_subclass(PyElasticGround { make: Box::new(make) }))
}

#[pymethods]
impl PyElasticGround {
    #[new]
    #[pyo3(signature = (soil, strips, *, history="auto", history_tolerance=None, history_memory=None, stages=None, tolerance=None, kernel_file=None, kernels=None))]
    fn new(
        soil: Profile,
        strips: Strips,
        history: &str,
        history_tolerance: Option<f64>,
        #[pyo3(from_py_with = whole)] history_memory: Option<usize>,
        #[pyo3(from_py_with = whole)] stages: Option<usize>,
        tolerance: Option<f64>,
        kernel_file: Option<PathBuf>,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (memory, kernels) = (history_memory, kernels.as_ref());
        let options = Options::new(
            history,
            history_tolerance,
            memory,
            stages,
            tolerance,
            kernel_file,
            kernels,
        )?;
        ground(soil, move || Ok(strips.0.clone()), options)
    }

    /// Strips of ``count`` elements under each foundation of a ``structure``, as wide as that is.
    ///
    /// ``soil`` is that of the class, and so are the options, none of them needed: ``history``,
    /// ``history_tolerance``, ``history_memory``, ``stages``, ``tolerance``, ``kernel_file`` and
    /// ``kernels``. ``grading``: "cosine" (the default: short at the edges) or "uniform".
    #[staticmethod]
    #[pyo3(signature = (soil, structure, count, *, grading="cosine", history="auto", history_tolerance=None, history_memory=None, stages=None, tolerance=None, kernel_file=None, kernels=None))]
    fn under(
        soil: Profile,
        structure: Bound<'_, PyAny>,
        #[pyo3(from_py_with = whole)] count: usize,
        grading: &str,
        history: &str,
        history_tolerance: Option<f64>,
        #[pyo3(from_py_with = whole)] history_memory: Option<usize>,
        #[pyo3(from_py_with = whole)] stages: Option<usize>,
        tolerance: Option<f64>,
        kernel_file: Option<PathBuf>,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<Py<Self>> {
        let (memory, kernels) = (history_memory, kernels.as_ref());
        let options = Options::new(
            history,
            history_tolerance,
            memory,
            stages,
            tolerance,
            kernel_file,
            kernels,
        )?;
        let (py, grading) = (structure.py(), self::grading(grading)?);
        let structure = structure::recipe(&structure)?;
        Py::new(py, ground(soil, move || Strip::under(&*structure()?, count, grading), options)?)
    }

    /// Dynamic stiffness of all strips as one rigid body, :class:`Impedances`, at ``frequencies`` (array
    /// of shape (m,), Hz). ``contact``: "bonded" (the default: soil and strips move together) or
    /// "relaxed" (vertical motions without shear, horizontal ones without pressure).
    #[pyo3(signature = (frequencies, *, contact="bonded"))]
    fn impedances(
        &self,
        py: Python<'_>,
        frequencies: Numbers,
        contact: &str,
    ) -> PyResult<PyImpedances> {
        let (ground, contact) = ((self.make)().or_raise()?, self::contact(contact)?);
        let found = py.detach(move || {
            watched(None, |observer| ground.impedances_observed(&frequencies.0, contact, observer))
        });
        Ok(PyImpedances(found?))
    }
}
