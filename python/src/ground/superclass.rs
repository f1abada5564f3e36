//! The superclass of grounds, and impedances of a rigid strip.

use std::sync::Arc;

use basemat::bem::layered::{StripContact, StripImpedance};
use basemat::bem::{ContactElement, Ground};
use basemat::history::{HistoryMethod, HistoryOptions};
use numpy::Complex64;
use pyo3::prelude::*;

use crate::array::{Array, Rows, numpy_complex};
use crate::error::OrRaise;
use crate::names::choice;
use crate::recipe::Recipe;

/// A ground: a description from which each simulation builds a separate ground.
#[pyclass(name = "Ground", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyGround {
    pub(crate) make: Recipe<dyn Ground>,
    elements: Vec<ContactElement>,
}

impl PyGround {
    /// A ground that `make` builds for each simulation. `make` is also called here, so that its errors are raised at
    /// once.
    pub(crate) fn new<G: Ground + 'static>(
        make: impl Fn() -> basemat::Result<G> + Send + Sync + 'static,
    ) -> PyResult<Self> {
        let ground = make().or_raise()?;
        let elements = ground.elements().to_vec();
        Ok(Self { make: Arc::new(move || Ok(Box::new(make()?))), elements })
    }

    /// The contact elements.
    pub(crate) fn contact_elements(&self) -> &[ContactElement] {
        &self.elements
    }
}

#[pymethods]
impl PyGround {
    /// Ends of the contact elements along x, from left to right in the plane: array of shape (elements, 2), m. Both
    /// ends are equal on a wall.
    #[getter]
    fn elements(&self) -> Rows {
        Rows(self.elements.iter().map(|element| vec![element.left(), element.right()]).collect())
    }

    /// Lower and upper end of the contact elements: array of shape (elements, 2), m above the surface; zero on it.
    #[getter]
    fn heights(&self) -> Rows {
        Rows(self.elements.iter().map(|element| element.heights().to_vec()).collect())
    }

    /// Front and back ends of the contact elements along y in plan: array of shape (elements, 2), m; −½ and ½, the
    /// metre of thickness, in the plane.
    #[getter]
    fn depths(&self) -> Rows {
        Rows(self.elements.iter().map(|element| element.depth().to_vec()).collect())
    }
}

/// Dynamic stiffness of a rigid base without mass, per metre of thickness.
///
/// It applies to motions e^(iωt). The arrays are complex, of shape (m,), one value per frequency; the imaginary part is
/// due to radiation and damping.
#[pyclass(name = "Impedances", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyImpedances(pub(super) Vec<StripImpedance>);

/// Options of a history from the arguments of a ground.
pub(super) fn history_options(
    method: &str,
    tolerance: Option<f64>,
    memory_bytes: Option<usize>,
) -> PyResult<HistoryOptions> {
    let method: HistoryMethod = method.parse().or_raise()?;
    let options = HistoryOptions { tolerance, ..method.into() };
    Ok(HistoryOptions { memory: memory_bytes.unwrap_or(options.memory), ..options })
}

/// The contact with this name, for impedances.
pub(super) fn strip_contact(name: &str) -> PyResult<StripContact> {
    choice("contact", name, &[("bonded", StripContact::Bonded), ("relaxed", StripContact::Relaxed)])
}

#[pymethods]
impl PyImpedances {
    /// Frequencies: array of shape (m,), Hz.
    #[getter]
    fn frequency(&self) -> Array {
        self.0.iter().map(|impedance| impedance.frequency).collect()
    }

    /// Ratio of horizontal force to horizontal translation: complex array of shape (m,), N/m².
    #[getter]
    fn horizontal(&self) -> Array<Complex64> {
        self.0.iter().map(|impedance| numpy_complex(impedance.horizontal)).collect()
    }

    /// Ratio of vertical force to vertical translation: complex array of shape (m,), N/m².
    #[getter]
    fn vertical(&self) -> Array<Complex64> {
        self.0.iter().map(|impedance| numpy_complex(impedance.vertical)).collect()
    }

    /// Ratio of moment to rotation: complex array of shape (m,), N.
    #[getter]
    fn rocking(&self) -> Array<Complex64> {
        self.0.iter().map(|impedance| numpy_complex(impedance.rocking)).collect()
    }

    /// Ratio of horizontal force to rotation: complex array of shape (m,), N/m.
    #[getter]
    fn coupling(&self) -> Array<Complex64> {
        self.0.iter().map(|impedance| numpy_complex(impedance.coupling)).collect()
    }
}
