//! Motion that differs from element to element at random.

use std::sync::Arc;

use basemat::bem::ContactElement;
use basemat::motion::{FreeField, Incoherence, IncoherentMotion, Record, Triaxial};
use pyo3::prelude::*;

use super::coherence::{PyCoherence, SharedCoherence};
use super::waves::{cloned_record, latest_end};
use super::{PyFreeField, PyRecord};
use crate::array::whole_numbers;
use crate::error::{OrRaise, WithOption, input_error, raise_user_exceptions};
use crate::ground::PyGround;

/// Incoherence of the ground motion under a base; `motion` makes an `IncoherentMotion` of records.
///
/// ``coherence``: a `Coherence` of the motions at two points. ``vertical``: that of the vertical motion; the same unless
/// given. ``apparent_velocity`` (m/s) and ``azimuth`` (rad, counter-clockwise from x as seen from above; 0 by default): of a
/// wave that passes, which delays each element; all elements move at once unless given. ``reference``: the point
/// (x and y, m) that moves as the records; the middle of the base unless given. ``bandwidth``: interval between frequencies
/// with independent phases, Hz; 0.5 by default. ``seed``: number of the sample; 0 by default. The same seed gives the same
/// motion on every machine. ``clipped``: whether negative eigenvalues of the coherence are replaced by zero instead of being
/// errors; False by default.
#[pyclass(name = "Incoherence", module = "basemat", frozen, dict)]
pub(crate) struct PyIncoherence(Incoherence);

#[pymethods]
impl PyIncoherence {
    #[new]
    #[pyo3(signature = (coherence, *, vertical=None, apparent_velocity=None, azimuth=0.0, reference=None, bandwidth=0.5, seed=0, clipped=false))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        coherence: &Bound<'_, PyCoherence>,
        vertical: Option<&Bound<'_, PyCoherence>>,
        apparent_velocity: Option<f64>,
        azimuth: f64,
        reference: Option<[f64; 2]>,
        bandwidth: f64,
        #[pyo3(from_py_with = whole_numbers)] seed: u64,
        clipped: bool,
    ) -> PyResult<Self> {
        if apparent_velocity.is_none() && azimuth != 0.0 {
            return Err(input_error("the azimuth is that of a wave: give its apparent_velocity"));
        }
        let shared =
            |coherence: &Bound<'_, PyCoherence>| SharedCoherence(Arc::clone(&coherence.get().0));
        let mut incoherence = Incoherence::new(shared(coherence)).with_seed(seed);
        if let Some(vertical) = vertical {
            incoherence = incoherence.with_vertical(shared(vertical));
        }
        if clipped {
            incoherence = incoherence.clipped();
        }
        Ok(incoherence)
            .with(apparent_velocity, |incoherence, velocity| {
                incoherence.with_passage(velocity, azimuth)
            })
            .with(reference, Incoherence::with_reference)
            .and_then(|incoherence| incoherence.with_bandwidth(bandwidth))
            .or_raise()
            .map(Self)
    }

    /// The `IncoherentMotion` of the contact elements of a ``ground`` on the surface, with the records ``x`` (to the right),
    /// ``y`` (away, in plan) and ``up`` (each a `Record`) at the reference point; a component is zero unless given.
    ///
    /// The records must end at rest and begin with quiet time, 3 s or more: `Record.with_baseline` and `Record.padded`.
    #[pyo3(signature = (ground, x=None, y=None, up=None))]
    fn motion(
        &self,
        py: Python<'_>,
        ground: &Bound<'_, PyGround>,
        x: Option<Bound<'_, PyRecord>>,
        y: Option<Bound<'_, PyRecord>>,
        up: Option<Bound<'_, PyRecord>>,
    ) -> PyResult<Py<PyIncoherentMotion>> {
        let records = Triaxial {
            x: cloned_record(x.as_ref()),
            y: cloned_record(y.as_ref()),
            up: cloned_record(up.as_ref()),
        };
        let duration = latest_end([records.x.as_ref(), records.y.as_ref(), records.up.as_ref()]);
        if duration.is_none() {
            return Err(input_error("give a record along x, along y or up"));
        }
        let elements = ground.get().contact_elements();
        let motion =
            py.detach(|| raise_user_exceptions(|| self.0.motion(&records, elements).or_raise()))?;
        let motion = Arc::new(motion);
        let min_eigenvalue = motion.min_eigenvalue();
        let make = Arc::new(move || Ok(Box::new(SharedMotion(Arc::clone(&motion))) as _));
        let superclass = PyFreeField { make, duration, wave: None };
        let initializer = PyClassInitializer::from(superclass);
        Py::new(py, initializer.add_subclass(PyIncoherentMotion { min_eigenvalue }))
    }
}

/// Free field that differs from element to element at random, with a given coherence: `Incoherence.motion`.
///
/// It is defined at the centres of the elements of one ground, and NaN elsewhere.
#[pyclass(name = "IncoherentMotion", module = "basemat", extends = PyFreeField, frozen)]
pub(crate) struct PyIncoherentMotion {
    min_eigenvalue: f64,
}

#[pymethods]
impl PyIncoherentMotion {
    /// Most negative eigenvalue of the coherence that was replaced by zero, a number; zero if none was.
    #[getter]
    fn min_eigenvalue(&self) -> f64 {
        self.min_eigenvalue
    }
}

/// A motion that several simulations read.
struct SharedMotion(Arc<IncoherentMotion>);

impl FreeField for SharedMotion {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        self.0.displacement(x, time)
    }

    fn displacement_at(&self, place: [f64; 2], time: f64) -> [f64; 3] {
        self.0.displacement_at(place, time)
    }

    fn elements(&self) -> Option<&[ContactElement]> {
        self.0.elements()
    }

    fn moves_across(&self) -> bool {
        self.0.moves_across()
    }

    fn records(&self) -> Vec<&Record> {
        self.0.records()
    }
}
