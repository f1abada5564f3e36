//! Damping laws and horizontal layers.

use std::sync::Arc;

use basemat::soil::{
    Base, Elastic, GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson, Relaxation, SoilLayer,
    SoilProfile,
};
use pyo3::prelude::*;

use crate::array::Numbers;
use crate::error::{OrRaise, no_such};
use crate::results::preformatted;
use crate::soil::PySoil;

/// Damping of a soil: how its shear modulus depends on frequency.
#[pyclass(name = "DampingLaw", module = "basemat", frozen, dict)]
pub(crate) struct PyDampingLaw(Arc<dyn Relaxation>);

#[pymethods]
impl PyDampingLaw {
    /// No damping.
    #[staticmethod]
    fn elastic() -> Self {
        Self(Arc::new(Elastic))
    }

    /// Generalised Maxwell body with the damping ``ratio`` (0.05: 5 %) over a ``band`` (lowest and highest
    /// frequency, Hz; 0.1 to 30 by default) and the soil's modulus at ``reference`` (Hz; 1 by
    /// default): the usual choice in time.
    #[staticmethod]
    #[pyo3(signature = (ratio, band=[0.1, 30.0], reference=1.0))]
    fn constant_q(ratio: f64, band: [f64; 2], reference: f64) -> PyResult<Self> {
        Ok(Self(Arc::new(GeneralizedMaxwell::constant_q(ratio, band, reference).or_raise()?)))
    }

    /// Generalised Maxwell body: ``long_term`` modulus over that of the soil, ``shares`` of the rest
    /// (array of shape (m,)) and their relaxation ``rates`` (array of shape (m,), 1/s).
    #[staticmethod]
    fn maxwell(long_term: f64, shares: Numbers, rates: Numbers) -> PyResult<Self> {
        Ok(Self(Arc::new(GeneralizedMaxwell::new(long_term, shares.0, rates.0).or_raise()?)))
    }

    /// Kelvin–Voigt body with the damping ``ratio`` at ``frequency`` (Hz).
    #[staticmethod]
    fn kelvin_voigt(ratio: f64, frequency: f64) -> PyResult<Self> {
        Ok(Self(Arc::new(KelvinVoigt::with_ratio(ratio, frequency).or_raise()?)))
    }

    /// Exactly constant damping ``ratio`` (Kjartansson 1979) with the soil's modulus at ``reference`` (Hz;
    /// 1 by default).
    #[staticmethod]
    #[pyo3(signature = (ratio, reference=1.0))]
    fn kjartansson(ratio: f64, reference: f64) -> PyResult<Self> {
        Ok(Self(Arc::new(Kjartansson::new(ratio, reference).or_raise()?)))
    }

    /// The frequency domain's usual damping ``ratio``, the same at all frequencies: not causal, for
    /// impedances only.
    #[staticmethod]
    fn hysteretic(ratio: f64) -> PyResult<Self> {
        Ok(Self(Arc::new(Hysteretic::new(ratio).or_raise()?)))
    }

    fn __repr__(&self) -> String {
        format!("DampingLaw({})", self.0.describe())
    }
}

/// A horizontal layer: its ``soil`` (:class:`Soil`), its ``thickness`` (m), its ``damping``
/// (:class:`DampingLaw`; none unless given).
#[pyclass(name = "SoilLayer", module = "basemat", frozen, dict)]
pub(crate) struct PySoilLayer(SoilLayer);

getters! {
    PySoilLayer, own;
    /// Its :class:`Soil`.
    soil: PySoil = PySoil(own.0.soil);
    /// Its thickness, m.
    thickness: f64 = own.0.thickness;
}

#[pymethods]
impl PySoilLayer {
    #[new]
    #[pyo3(signature = (soil, thickness, damping=None))]
    fn new(soil: &PySoil, thickness: f64, damping: Option<&PyDampingLaw>) -> Self {
        Self(SoilLayer { soil: soil.0, thickness, damping: law(damping) })
    }
}

fn law(given: Option<&PyDampingLaw>) -> Arc<dyn Relaxation> {
    given.map_or_else(|| Arc::new(Elastic) as Arc<dyn Relaxation>, |law| Arc::clone(&law.0))
}

/// Horizontal ``layers`` (list of :class:`SoilLayer`) from the surface down, on a half-plane of the soil
/// ``base`` or, unless that is given, on a rigid base. ``base_damping``: :class:`DampingLaw` of the
/// base; none unless given. Printed, it is a table.
#[pyclass(name = "SoilProfile", module = "basemat", frozen, dict)]
pub(crate) struct PySoilProfile(pub(crate) SoilProfile);

getters! {
    PySoilProfile, own;
    /// The layers from the surface down: list of :class:`SoilLayer`.
    layers: Vec<PySoilLayer> = own.0.layers().iter().cloned().map(PySoilLayer).collect();
    /// The :class:`Soil` of the half-plane under the layers; None on a rigid base.
    base: Option<PySoil> = match own.0.base() { Base::HalfPlane { soil,.. } => Some(PySoil(*soil)), Base::Rigid => None, };
    /// Depth of all layers, m.
    depth: f64 = own.0.depth();
    /// First natural frequency of the layers, Hz; None without layers.
    first_frequency: Option<f64> = own.0.first_frequency();
    /// Time that a shear wave takes through all layers, s.
    travel_time: f64 = own.0.travel_time();
}

#[pymethods]
impl PySoilProfile {
    #[new]
    #[pyo3(signature = (layers, base=None, *, base_damping=None))]
    fn new(
        layers: Vec<Bound<'_, PySoilLayer>>,
        base: Option<&PySoil>,
        base_damping: Option<&PyDampingLaw>,
    ) -> PyResult<Self> {
        let layers = layers.iter().map(|layer| layer.get().0.clone()).collect();
        let base = match base {
            Some(soil) => Base::HalfPlane { soil: soil.0, damping: law(base_damping) },
            None => Base::Rigid,
        };
        Ok(Self(SoilProfile::new(layers, base).or_raise()?))
    }

    fn _repr_html_(&self) -> String {
        preformatted(&self.0.to_string())
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("SoilProfile({} layers, {} m)", self.0.layers().len(), self.0.depth())
    }
}

/// A profile, given as such or as a soil.
#[derive(Clone)]
pub(crate) struct Profile(pub(crate) SoilProfile);

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
