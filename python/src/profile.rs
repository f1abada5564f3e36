//! Damping laws and horizontal layers.

use std::sync::Arc;

use basemat::soil::{
    Base, Elastic, GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson, Relaxation, SoilLayer,
    SoilProfile,
};
use pyo3::prelude::*;

use crate::array::Numbers;
use crate::error::OrRaise;
use crate::html::preformatted;
use crate::several::{Several, no_such};
use crate::soil::PySoil;

/// Damping of a soil: how its shear modulus depends on frequency.
#[pyclass(name = "DampingLaw", module = "basemat", frozen, dict)]
pub(crate) struct PyDampingLaw(Arc<dyn Relaxation>);

/// Any of the core's laws.
fn damping(law: basemat::Result<impl Relaxation + 'static>) -> PyResult<PyDampingLaw> {
    Ok(PyDampingLaw(Arc::new(law.or_raise()?)))
}

members! {
    PyDampingLaw, own;
    /// No damping.
    elastic() = damping(Ok(Elastic));
    /// Generalised Maxwell body with the damping ``ratio`` (0.05: 5 %) over a ``band`` (lowest and highest
    /// frequency, Hz; 0.1 to 30 by default) and the soil's modulus at ``reference`` (Hz; 1 by
    /// default): the usual choice in time.
    #[pyo3(signature = (ratio, band=[0.1, 30.0], reference=1.0))]
    constant_q(ratio: f64, band: [f64; 2], reference: f64) =
        damping(GeneralizedMaxwell::constant_q(ratio, band, reference));
    /// Generalised Maxwell body: ``long_term`` modulus over that of the soil, ``ratios`` of the rest
    /// (array of shape (m,)) and their relaxation ``rates`` (array of shape (m,), 1/s).
    maxwell(long_term: f64, ratios: Numbers, rates: Numbers) =
        damping(GeneralizedMaxwell::new(long_term, ratios.0, rates.0));
    /// Kelvin–Voigt body with the damping ``ratio`` at ``frequency`` (Hz).
    kelvin_voigt(ratio: f64, frequency: f64) = damping(KelvinVoigt::with_ratio(ratio, frequency));
    /// Exactly constant damping ``ratio`` (Kjartansson 1979) with the soil's modulus at ``reference`` (Hz;
    /// 1 by default).
    #[pyo3(signature = (ratio, reference=1.0))]
    kjartansson(ratio: f64, reference: f64) = damping(Kjartansson::new(ratio, reference));
    /// The frequency domain's usual damping ``ratio``, the same at all frequencies: not causal, for
    /// impedances only.
    hysteretic(ratio: f64) = damping(Hysteretic::new(ratio));
}

/// A horizontal layer: its ``soil`` (:class:`Soil`), its ``thickness`` (m), its ``damping``
/// (:class:`DampingLaw`; none unless given).
#[pyclass(name = "SoilLayer", module = "basemat", frozen, dict)]
pub(crate) struct PySoilLayer(SoilLayer);

members! {
    PySoilLayer, own;
    #[pyo3(signature = (soil, thickness, damping=None))]
    new(soil: &PySoil, thickness: f64, damping: Option<&PyDampingLaw>) =
        Ok(Self(SoilLayer { soil: soil.0, thickness, damping: law(damping) }));
    /// :class:`Soil` of the layer.
    soil: PySoil = PySoil(own.0.soil);
    /// Thickness of the layer, m.
    thickness: f64 = own.0.thickness;
}

fn law(given: Option<&PyDampingLaw>) -> Arc<dyn Relaxation> {
    given.map_or_else(|| Arc::new(Elastic) as Arc<dyn Relaxation>, |law| Arc::clone(&law.0))
}

/// Horizontal ``layers`` (list of :class:`SoilLayer`) from the surface down, on a half-plane of the soil
/// ``base`` or, unless that is given, on a rigid base. ``base_damping``: :class:`DampingLaw` of the
/// base; none unless given. Printed, it is a table.
#[pyclass(name = "SoilProfile", module = "basemat", frozen, dict)]
pub(crate) struct PySoilProfile(pub(crate) SoilProfile);

members! {
    PySoilProfile, own;
    #[pyo3(signature = (layers, base=None, *, base_damping=None))]
    new(
        layers: Several<'_, PySoilLayer>,
        base: Option<&PySoil>,
        base_damping: Option<&PyDampingLaw>,
    ) = {
        let layers = layers.iter().map(|layer| layer.get().0.clone()).collect();
        let base = match base {
            Some(soil) => Base::HalfPlane { soil: soil.0, damping: law(base_damping) },
            None => Base::Rigid,
        };
        Ok(Self(SoilProfile::new(layers, base).or_raise()?))
    };
    /// The layers from the surface down: list of :class:`SoilLayer`.
    layers: Vec<PySoilLayer> = own.0.layers().iter().cloned().map(PySoilLayer).collect();
    /// The :class:`Soil` of the half-plane under the layers; None on a rigid base.
    base: Option<PySoil> = match own.0.base() {
        Base::HalfPlane { soil, .. } => Some(PySoil(*soil)),
        Base::Rigid => None,
    };
    /// Depth of all layers, m.
    depth: f64 = own.0.depth();
    /// First natural frequency of the layers, Hz; None without layers.
    first_frequency: Option<f64> = own.0.first_frequency();
    /// Time that a shear wave takes through all layers, s.
    travel_time: f64 = own.0.travel_time();
}

#[pymethods]
impl PySoilProfile {
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

extracts!(Profile, object => {
    if let Ok(soil) = object.cast::<PySoil>() {
        return Ok(Self(soil.get().0.into()));
    }
    match object.cast::<PySoilProfile>() {
        Ok(profile) => Ok(Self(profile.get().0.clone())),
        Err(_) => Err(no_such(&object, "a Soil or a SoilProfile")),
    }
});
