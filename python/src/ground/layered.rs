//! Layered, damped ground.

use std::path::PathBuf;

use basemat::bem::layered::{LayeredGround, Stages};
use basemat::bem::{Grading, SharedKernels};
use basemat::history::History;
use pyo3::prelude::*;

use super::PyGround;
use super::history::PySharedKernels;
use super::impedance::{PyImpedances, contact};
use super::strip::{PyStrip, grading, strips};
use crate::array::{Numbers, whole};
use crate::error::OrRaise;
use crate::profile::PySoilProfile;
use crate::structure;

/// Horizontal layers with damping, with one strip of contact elements or several.
///
/// ``stages``: 2 or 3 Runge–Kutta stages (the rule's choice unless given); ``tolerance``: of the
/// step coefficients; ``kernel_file``: a file that keeps them; ``history``: "auto", "direct" or
/// "relaxed fft"; ``kernels``: to be shared between simulations.
#[pyclass(name = "LayeredGround", module = "basemat", extends = PyGround, frozen)]
pub(crate) struct PyLayeredGround {
    make: Box<dyn Fn() -> basemat::Result<LayeredGround> + Send + Sync>,
}

/// Step coefficients and history of the ground.
#[derive(Clone)]
struct Options {
    stages: Option<Stages>,
    tolerance: Option<f64>,
    file: Option<PathBuf>,
    kind: History,
    kernels: Option<SharedKernels>,
}

impl Options {
    fn new(
        stages: Option<usize>,
        tolerance: Option<f64>,
        file: Option<PathBuf>,
        kind: &str,
        kernels: Option<&Bound<'_, PySharedKernels>>,
    ) -> PyResult<Self> {
        let stages = stages.map(Stages::from_count).transpose().or_raise()?;
        let kernels = kernels.map(|kernels| kernels.get().0.clone());
        Ok(Self { stages, tolerance, file, kind: kind.parse().or_raise()?, kernels })
    }

    fn of(&self, ground: LayeredGround) -> basemat::Result<LayeredGround> {
        let mut ground = ground.with_history_kind(self.kind);
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
    make: impl Fn() -> basemat::Result<LayeredGround> + Clone + Send + Sync + 'static,
    options: Options,
) -> PyResult<PyClassInitializer<PyLayeredGround>> {
    let make = move || options.of(make()?);
    let base = PyGround::new(make.clone())?;
    Ok(PyClassInitializer::from(base).add_subclass(PyLayeredGround { make: Box::new(make) }))
}

#[pymethods]
impl PyLayeredGround {
    #[new]
    #[pyo3(signature = (profile, strips, *, stages=None, tolerance=None, kernel_file=None, history="auto", kernels=None))]
    fn new(
        profile: &PySoilProfile,
        strips: Vec<Bound<'_, PyStrip>>,
        #[pyo3(from_py_with = whole)] stages: Option<usize>,
        tolerance: Option<f64>,
        kernel_file: Option<PathBuf>,
        history: &str,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let options = Options::new(stages, tolerance, kernel_file, history, kernels.as_ref())?;
        let (profile, strips) = (profile.0.clone(), self::strips(&strips));
        ground(move || LayeredGround::new(profile.clone(), &strips), options)
    }

    /// One strip from ``left`` to ``right`` (m) of ``count`` elements.
    #[staticmethod]
    #[pyo3(signature = (profile, left, right, count, *, grading="cosine", stages=None, tolerance=None, kernel_file=None, history="auto", kernels=None))]
    fn strip(
        py: Python<'_>,
        profile: &PySoilProfile,
        left: f64,
        right: f64,
        #[pyo3(from_py_with = whole)] count: usize,
        grading: &str,
        #[pyo3(from_py_with = whole)] stages: Option<usize>,
        tolerance: Option<f64>,
        kernel_file: Option<PathBuf>,
        history: &str,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<Py<Self>> {
        let options = Options::new(stages, tolerance, kernel_file, history, kernels.as_ref())?;
        let (profile, grading) = (profile.0.clone(), self::grading(grading)?);
        let make = move || match grading {
            Grading::Uniform => LayeredGround::uniform_strip(profile.clone(), left..right, count),
            _ => LayeredGround::strip(profile.clone(), left..right, count),
        };
        Py::new(py, ground(make, options)?)
    }

    /// Strips of ``count`` elements under each foundation of a structure, as wide as that is.
    #[staticmethod]
    #[pyo3(signature = (profile, structure, count, *, grading="cosine", stages=None, tolerance=None, kernel_file=None, history="auto", kernels=None))]
    fn under(
        profile: &PySoilProfile,
        structure: Bound<'_, PyAny>,
        #[pyo3(from_py_with = whole)] count: usize,
        grading: &str,
        #[pyo3(from_py_with = whole)] stages: Option<usize>,
        tolerance: Option<f64>,
        kernel_file: Option<PathBuf>,
        history: &str,
        kernels: Option<Bound<'_, PySharedKernels>>,
    ) -> PyResult<Py<Self>> {
        let options = Options::new(stages, tolerance, kernel_file, history, kernels.as_ref())?;
        let (profile, grading) = (profile.0.clone(), self::grading(grading)?);
        let py = structure.py();
        let structure = structure::recipe(&structure)?;
        let make = move || match grading {
            Grading::Uniform => {
                LayeredGround::uniform_under(profile.clone(), &*structure()?, count)
            }
            _ => LayeredGround::under(profile.clone(), &*structure()?, count),
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
