//! Elastic soil, homogeneous or layered.

use std::path::PathBuf;

use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, SharedKernels};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::strip::{ContactMesh, grading};
use super::superclass::{history_options, strip_contact};
use super::{PyGround, PyImpedances, PyPlan};
use crate::array::{Numbers, whole_numbers};
use crate::error::{OrRaise, WithOption};
use crate::profile::Profile;
use crate::ticker::with_progress;

/// Convolution weights that grounds of equal soil and elements share.
///
/// They are computed once for all simulations that are built with the same object. A copy in another process is empty;
/// ``len()`` is the number of stored sets.
#[pyclass(name = "SharedKernels", module = "basemat", frozen)]
#[derive(Default)]
pub(crate) struct PySharedKernels(pub(super) SharedKernels);

#[pymethods]
impl PySharedKernels {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// A pickle has no content: a copy in another process is empty.
    #[allow(clippy::unused_self, reason = "a method of Python")]
    fn __getnewargs__<'py>(&self, py: Python<'py>) -> Bound<'py, PyTuple> {
        PyTuple::empty(py)
    }

    fn __len__(&self) -> usize {
        self.0.count()
    }
}

/// Elastic ground, homogeneous or layered, with contact elements on its surface.
///
/// ``soil``: a `Soil` (a half-plane) or a `SoilProfile` (layers). ``strips``: a `Strip` or a list of them, or a `Plan`
/// in three dimensions.
///
/// ``history``: method that sums the response to all past tractions: "auto" (the default: exponentials on a half-plane
/// under strips, otherwise transforms), "direct", "relaxed_fft" or, without layers and damping, "exponentials".
/// ``history_tolerance``: permitted relative error of exponentials, 1e-12 to 1e-2 (unless given, 1e-12 with "auto" and
/// 1e-10 with "exponentials"); ``history_memory``: largest memory of the history, bytes (1 GiB unless given).
/// ``kernels``: `SharedKernels` of several simulations; not shared unless given. For layers and damping: ``stages``: 2
/// or 3 Runge–Kutta stages (chosen by a rule unless given); ``tolerance``: relative error of the element compliances,
/// 1e-13 to 1e-4 (1e-10 unless given); ``kernel_file``: path of a file that stores them (none unless given).
#[pyclass(name = "ElasticGround", module = "basemat", extends = PyGround, frozen)]
pub(crate) struct PyElasticGround {
    make: Box<dyn Fn() -> basemat::Result<ElasticGround> + Send + Sync>,
    plan: Option<(Profile, PyPlan)>,
}

#[pymethods]
impl PyElasticGround {
    #[new]
    #[pyo3(signature = (soil, strips, *, history="auto", history_tolerance=None, history_memory=None, stages=None, tolerance=None, kernel_file=None, kernels=None))]
    fn new(
        soil: Profile,
        strips: ContactMesh,
        history: &str,
        history_tolerance: Option<f64>,
        #[pyo3(from_py_with = whole_numbers)] history_memory: Option<usize>,
        #[pyo3(from_py_with = whole_numbers)] stages: Option<usize>,
        tolerance: Option<f64>,
        kernel_file: Option<PathBuf>,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let options = history_options(history, history_tolerance, history_memory)?;
        let stages = stages.map(Stages::from_count).transpose().or_raise()?;
        let kernels = kernels.map(|kernels| kernels.get().0.clone());
        let plan = match &strips {
            ContactMesh::Strips(_) => None,
            ContactMesh::Plan(plan) => Some((soil.clone(), PyPlan(plan.clone()))),
        };
        let make = move || {
            let ground = match &strips {
                ContactMesh::Strips(strips) => ElasticGround::new(soil.0.clone(), strips),
                ContactMesh::Plan(plan) => ElasticGround::in_plan(soil.0.clone(), plan.clone()),
            };
            ground
                .and_then(|ground| ground.with_history(options))
                .with(stages, |ground, stages| Ok(ground.with_stages(stages)))
                .with(tolerance, ElasticGround::with_tolerance)
                .with(kernel_file.as_ref(), |ground, file| Ok(ground.with_kernel_file(file)))
                .with(kernels.as_ref(), |ground, kernels| Ok(ground.with_shared_kernels(kernels)))
        };
        let superclass = PyGround::new(make.clone())?;
        Ok(PyClassInitializer::from(superclass).add_subclass(Self { make: Box::new(make), plan }))
    }

    /// Ground with contact elements under the foundations of a ``structure``.
    ///
    /// It has a strip of ``count`` elements under each foundation, as wide as the foundation; under a structure in plan
    /// a `Plan` with ``count`` cells along the shorter side of its base, cut at an outline that is oblique to them. A
    /// flexible base gets at least one element for each of its segments, or as many cells as it has faces; if
    /// necessary, ``count`` is raised for this. ``print(ground)`` shows its number of elements, which is also
    /// ``len(ground.elements)``.
    ///
    /// ``soil`` and the options are as in the class, whose defaults they have unless given: ``history``,
    /// ``history_tolerance``, ``history_memory``, ``stages``, ``tolerance``, ``kernel_file`` and ``kernels``.
    /// ``grading``: "cosine" (the default: short at the edges) or "uniform".
    #[staticmethod]
    #[pyo3(
        signature = (soil, structure, count, *, grading="cosine", **options),
        text_signature = "(soil, structure, count, *, grading='cosine', history='auto', history_tolerance=None, \
                          history_memory=None, stages=None, tolerance=None, kernel_file=None, kernels=None)"
    )]
    fn under<'py>(
        soil: Bound<'py, PyAny>,
        structure: Bound<'py, PyAny>,
        #[pyo3(from_py_with = whole_numbers)] count: usize,
        grading: &str,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let surface = soil.extract::<Profile>()?.0.surface();
        let elements = ContactMesh::under(&structure, count, self::grading(grading)?, surface)?;
        structure.py().get_type::<Self>().call((soil, elements), options)
    }

    /// Dynamic stiffness of all strips as one rigid body, `Impedances`, at ``frequencies`` (array of shape (m,), Hz);
    /// in plan the array of `Plan.impedances`. ``contact``: "bonded" (the default: soil and strips move together) or
    /// "relaxed" (vertical motions without shear, horizontal motions without pressure).
    #[pyo3(signature = (frequencies, *, contact="bonded"))]
    fn impedances(
        &self,
        py: Python<'_>,
        frequencies: Numbers,
        contact: &str,
    ) -> PyResult<Py<PyAny>> {
        if let Some((soil, plan)) = &self.plan {
            return plan.impedances(py, soil.clone(), frequencies, contact)?.into_py_any(py);
        }
        let ground = (self.make)().or_raise()?;
        let contact = strip_contact(contact)?;
        let impedances = py.detach(move || {
            with_progress(None, |observer| ground.impedances(&frequencies.0, contact, observer))
        });
        PyImpedances(impedances?).into_py_any(py)
    }
}
