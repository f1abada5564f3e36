//! Damping laws and horizontal layers.

use std::sync::Arc;

use basemat::soil::{
    Base, Elastic, GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson, Relaxation, SoilLayer,
    SoilProfile,
};
use pyo3::prelude::*;

use crate::array::Numbers;
use crate::error::OrRaise;
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

    /// Generalised Maxwell body with the damping ``ratio`` over a ``band`` (lowest and highest
    /// frequency, Hz) and the soil's modulus at ``reference`` (Hz): the usual choice in time.
    #[staticmethod]
    #[pyo3(signature = (ratio, band=[0.1, 30.0], reference=1.0))]
    fn constant_q(ratio: f64, band: [f64; 2], reference: f64) -> PyResult<Self> {
        Ok(Self(Arc::new(GeneralizedMaxwell::constant_q(ratio, band, reference).or_raise()?)))
    }

    /// Generalised Maxwell body of a long-term modulus ratio, shares and relaxation rates (1/s).
    #[staticmethod]
    fn maxwell(long_term: f64, shares: Numbers, rates: Numbers) -> PyResult<Self> {
        Ok(Self(Arc::new(GeneralizedMaxwell::new(long_term, shares.0, rates.0).or_raise()?)))
    }

    /// Kelvin–Voigt body with the damping ``ratio`` at ``frequency`` (Hz).
    #[staticmethod]
    fn kelvin_voigt(ratio: f64, frequency: f64) -> PyResult<Self> {
        Ok(Self(Arc::new(KelvinVoigt::with_ratio(ratio, frequency).or_raise()?)))
    }

    /// Exactly constant damping (Kjartansson 1979) with the soil's modulus at ``reference`` (Hz).
    #[staticmethod]
    #[pyo3(signature = (ratio, reference=1.0))]
    fn kjartansson(ratio: f64, reference: f64) -> PyResult<Self> {
        Ok(Self(Arc::new(Kjartansson::new(ratio, reference).or_raise()?)))
    }

    /// The frequency domain's usual damping: not causal, for impedances only.
    #[staticmethod]
    fn hysteretic(ratio: f64) -> PyResult<Self> {
        Ok(Self(Arc::new(Hysteretic::new(ratio).or_raise()?)))
    }

    fn __repr__(&self) -> String {
        format!("DampingLaw({})", self.0.describe())
    }
}

/// A horizontal layer: its soil, its thickness (m), its damping (none unless given).
#[pyclass(name = "SoilLayer", module = "basemat", frozen, dict)]
pub(crate) struct PySoilLayer(SoilLayer);

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

/// Horizontal layers from the surface down, on a half-plane of the soil ``base`` or, with
/// ``base=None``, on a rigid base.
#[pyclass(name = "SoilProfile", module = "basemat", frozen, dict)]
pub(crate) struct PySoilProfile(pub(crate) SoilProfile);

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

    /// Depth of all layers, m.
    #[getter]
    fn depth(&self) -> f64 {
        self.0.depth()
    }

    /// First natural frequency of the layers, Hz; None without layers.
    #[getter]
    fn first_frequency(&self) -> Option<f64> {
        self.0.first_frequency()
    }

    /// Time that a shear wave takes through all layers, s.
    #[getter]
    fn travel_time(&self) -> f64 {
        self.0.travel_time()
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("SoilProfile({} layers, {} m)", self.0.layers().len(), self.0.depth())
    }
}
