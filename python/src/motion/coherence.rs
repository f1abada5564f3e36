//! Coherence of the ground motion at two points.

use std::sync::Arc;

use basemat::motion::{
    AbrahamsonCoherence, Coherence, LucoWong, mean_coherence as core_mean_coherence,
};
use pyo3::prelude::*;

use crate::array::Rows;
use crate::error::{
    OrRaise, call_user_code, extract_returned, has_stored_exception, input_error,
    raise_user_exceptions,
};
use crate::ground::PyGround;
use crate::names::choice;

/// Coherence Γ between the ground motions at two points: the correlation of their Fourier coefficients at a frequency,
/// without the delay of a wave that passes. A `LucoWong`, an `AbrahamsonCoherence`, or a function (`CoherenceFn`).
#[pyclass(name = "Coherence", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyCoherence(pub(super) Arc<dyn Coherence>);

#[pymethods]
impl PyCoherence {
    /// Coherence of the motions at the points ``first`` and ``second`` (x and y, m) at a ``frequency`` (Hz), a number.
    fn between(&self, frequency: f64, first: [f64; 2], second: [f64; 2]) -> PyResult<f64> {
        raise_user_exceptions(|| Ok(self.0.between(frequency, first, second)))
    }
}

/// A coherence that several motions read.
pub(super) struct SharedCoherence(pub(super) Arc<dyn Coherence>);

impl Coherence for SharedCoherence {
    fn between(&self, frequency: f64, first: [f64; 2], second: [f64; 2]) -> f64 {
        self.0.between(frequency, first, second)
    }

    fn is_homogeneous(&self) -> bool {
        self.0.is_homogeneous()
    }

    fn is_semi_definite(&self) -> bool {
        self.0.is_semi_definite()
    }

    fn max_distance(&self) -> f64 {
        self.0.max_distance()
    }
}

/// Coherence of Luco and Wong (1986): Γ = exp(−(α ω d/c)²) at a distance d, with ω = 2π times the frequency.
///
/// ``alpha``: the parameter α, a number, 0 or more. ``shear_wave_speed``: speed c of shear waves in the soil, m/s.
#[pyclass(name = "LucoWong", module = "basemat", extends = PyCoherence, frozen)]
pub(crate) struct PyLucoWong;

#[pymethods]
impl PyLucoWong {
    #[new]
    fn new(alpha: f64, shear_wave_speed: f64) -> PyResult<PyClassInitializer<Self>> {
        let coherence = LucoWong::new(alpha, shear_wave_speed).or_raise()?;
        Ok(PyClassInitializer::from(PyCoherence(Arc::new(coherence))).add_subclass(Self))
    }
}

/// Plane-wave coherence of Abrahamson (2007), up to distances of 150 m.
///
/// ``model``: "hard_rock_horizontal", "hard_rock_vertical", "soil_horizontal" (soil with shear waves of 180 to 290 m/s,
/// from frequencies up to 20 Hz) or "soil_vertical". Its matrices can have negative eigenvalues: give ``clipped=True`` to
/// `Incoherence`.
#[pyclass(name = "AbrahamsonCoherence", module = "basemat", extends = PyCoherence, frozen)]
pub(crate) struct PyAbrahamsonCoherence;

#[pymethods]
impl PyAbrahamsonCoherence {
    #[new]
    fn new(model: &str) -> PyResult<PyClassInitializer<Self>> {
        let choices = [
            ("hard_rock_horizontal", AbrahamsonCoherence::HardRockHorizontal),
            ("hard_rock_vertical", AbrahamsonCoherence::HardRockVertical),
            ("soil_horizontal", AbrahamsonCoherence::SoilHorizontal),
            ("soil_vertical", AbrahamsonCoherence::SoilVertical),
        ];
        let coherence = choice("model", model, &choices)?;
        Ok(PyClassInitializer::from(PyCoherence(Arc::new(coherence))).add_subclass(Self))
    }
}

/// A coherence that a function defines: give ``between`` or ``of_separation``.
///
/// ``between``: a function ``(frequency, first, second)`` of a frequency (Hz) and two points (tuples of x and y, m).
/// ``of_separation``: a function ``(frequency, separation)`` of the vector from one point to the other (tuple of x and y,
/// m), with the same value for the opposite vector; few of its values are needed for cells on a lattice. The functions
/// return the coherence, a number from −1 to 1. They are None unless given.
#[pyclass(name = "CoherenceFn", module = "basemat", extends = PyCoherence, frozen)]
pub(crate) struct PyCoherenceFn;

#[pymethods]
impl PyCoherenceFn {
    #[new]
    #[pyo3(signature = (between=None, *, of_separation=None))]
    fn new(
        between: Option<Bound<'_, PyAny>>,
        of_separation: Option<Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (function, is_homogeneous) = match (between, of_separation) {
            (Some(function), None) => (function, false),
            (None, Some(function)) => (function, true),
            _ => return Err(input_error("give between or of_separation, one of them")),
        };
        if !function.is_callable() {
            return Err(input_error("the coherence must be a function"));
        }
        let coherence = FunctionCoherence { function: function.unbind(), is_homogeneous };
        Ok(PyClassInitializer::from(PyCoherence(Arc::new(coherence))).add_subclass(Self))
    }
}

/// A coherence by a function of Python.
struct FunctionCoherence {
    function: Py<PyAny>,
    /// Whether the function takes the vector between two points instead of the points.
    is_homogeneous: bool,
}

impl Coherence for FunctionCoherence {
    fn between(&self, frequency: f64, first: [f64; 2], second: [f64; 2]) -> f64 {
        if has_stored_exception() {
            return f64::NAN;
        }
        call_user_code(f64::NAN, |py| {
            let returned_value = if self.is_homogeneous {
                let separation = (second[0] - first[0], second[1] - first[1]);
                self.function.call1(py, (frequency, separation))?
            } else {
                let points = ((first[0], first[1]), (second[0], second[1]));
                self.function.call1(py, (frequency, points.0, points.1))?
            };
            extract_returned("the function of the coherence", returned_value.bind(py))
        })
    }

    fn is_homogeneous(&self) -> bool {
        self.is_homogeneous
    }
}

/// Coherence between the means of the motion over the contact elements of a ``ground``: array of shape (elements, elements),
/// ratios.
///
/// It is the mean of the ``coherence`` (`Coherence`) at a ``frequency`` (Hz) over all pairs of points in two elements.
#[pyfunction]
pub(crate) fn mean_coherence(
    coherence: &Bound<'_, PyCoherence>,
    frequency: f64,
    ground: &Bound<'_, PyGround>,
) -> PyResult<Rows> {
    let coherence = coherence.get().0.as_ref();
    let elements = ground.get().contact_elements();
    let matrix =
        raise_user_exceptions(|| core_mean_coherence(coherence, frequency, elements).or_raise())?;
    Ok(Rows(matrix.chunks(elements.len()).map(<[f64]>::to_vec).collect()))
}
