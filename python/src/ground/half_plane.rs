//! The elastic half-plane.

use basemat::bem::{Grading, HalfPlaneGround};
use pyo3::prelude::*;

use super::PyGround;
use super::history::{Options, PySharedKernels};
use super::impedance::{PyImpedances, contact};
use super::strip::{PyStrip, grading, strips};
use crate::array::{Numbers, whole};
use crate::error::OrRaise;
use crate::soil::PySoil;
use crate::structure;

/// Homogeneous elastic half-plane with one strip of contact elements or several.
///
/// ``history``: "auto", "direct", "relaxed fft" or "exponentials"; ``history_tolerance``: relative
/// error (1e-12 to 1e-2) that the history may have; ``history_memory``: bytes that it may take;
/// ``kernels``: to be shared between simulations.
#[pyclass(name = "HalfPlaneGround", module = "basemat", extends = PyGround, frozen)]
pub(crate) struct PyHalfPlaneGround {
    make: Box<dyn Fn() -> basemat::Result<HalfPlaneGround> + Send + Sync>,
}

fn ground(
    make: impl Fn() -> basemat::Result<HalfPlaneGround> + Clone + Send + Sync + 'static,
    options: Options,
) -> PyResult<PyClassInitializer<PyHalfPlaneGround>> {
    let make = move || options.of(make()?);
    let base = PyGround::new(make.clone())?;
    Ok(PyClassInitializer::from(base).add_subclass(PyHalfPlaneGround { make: Box::new(make) }))
}

#[pymethods]
impl PyHalfPlaneGround {
    #[new]
    #[pyo3(signature = (soil, strips, *, history="auto", history_tolerance=None, history_memory=None, kernels=None))]
    fn new(
        soil: Bound<'_, PySoil>,
        strips: Vec<Bound<'_, PyStrip>>,
        history: &str,
        history_tolerance: Option<f64>,
        #[pyo3(from_py_with = whole)] history_memory: Option<usize>,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let options = Options::new(history, history_tolerance, history_memory, kernels.as_ref())?;
        let (soil, strips) = (soil.get().0, self::strips(&strips));
        ground(move || HalfPlaneGround::new(soil, &strips), options)
    }

    /// One strip from ``left`` to ``right`` (m) of ``count`` elements.
    #[staticmethod]
    #[pyo3(signature = (soil, left, right, count, *, grading="cosine", history="auto", history_tolerance=None, history_memory=None, kernels=None))]
    fn strip(
        py: Python<'_>,
        soil: Bound<'_, PySoil>,
        left: f64,
        right: f64,
        #[pyo3(from_py_with = whole)] count: usize,
        grading: &str,
        history: &str,
        history_tolerance: Option<f64>,
        #[pyo3(from_py_with = whole)] history_memory: Option<usize>,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<Py<Self>> {
        let options = Options::new(history, history_tolerance, history_memory, kernels.as_ref())?;
        let (soil, grading) = (soil.get().0, self::grading(grading)?);
        let make = move || match grading {
            Grading::Uniform => HalfPlaneGround::uniform_strip(soil, left..right, count),
            _ => HalfPlaneGround::strip(soil, left..right, count),
        };
        Py::new(py, ground(make, options)?)
    }

    /// Strips of ``count`` elements under each foundation of a structure, as wide as that is.
    #[staticmethod]
    #[pyo3(signature = (soil, structure, count, *, grading="cosine", history="auto", history_tolerance=None, history_memory=None, kernels=None))]
    fn under(
        soil: Bound<'_, PySoil>,
        structure: Bound<'_, PyAny>,
        #[pyo3(from_py_with = whole)] count: usize,
        grading: &str,
        history: &str,
        history_tolerance: Option<f64>,
        #[pyo3(from_py_with = whole)] history_memory: Option<usize>,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<Py<Self>> {
        let options = Options::new(history, history_tolerance, history_memory, kernels.as_ref())?;
        let (soil, grading) = (soil.get().0, self::grading(grading)?);
        let py = structure.py();
        let structure = structure::recipe(&structure)?;
        let make = move || match grading {
            Grading::Uniform => HalfPlaneGround::uniform_under(soil, &*structure()?, count),
            _ => HalfPlaneGround::under(soil, &*structure()?, count),
        };
        Py::new(py, ground(make, options)?)
    }

    /// Dynamic stiffness of all strips as one rigid body at ``frequencies`` (array of shape (m,),
    /// Hz); ``contact``: "bonded" or "relaxed".
    #[pyo3(signature = (frequencies, *, contact="bonded"))]
    fn impedances(
        &self,
        py: Python<'_>,
        frequencies: Numbers,
        contact: &str,
    ) -> PyResult<PyImpedances> {
        let (ground, contact) = ((self.make)().or_raise()?, self::contact(contact)?);
        let found = py.detach(move || ground.impedances(&frequencies.0, contact));
        Ok(PyImpedances(found.or_raise()?))
    }
}
