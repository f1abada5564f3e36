//! Damping laws and horizontal layers.

use std::sync::Arc;

use basemat::Soil;
use basemat::soil::{
    Bedrock, Elastic, GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson, Relaxation,
    SoilLayer, SoilProfile,
};
use pyo3::prelude::*;

use crate::array::Numbers;
use crate::error::OrRaise;
use crate::list_arguments::{ListOf, type_error};
use crate::names::preformatted;
use crate::soil::PySoil;
use crate::structure::PyStressAtRest;

/// Damping of a soil: its complex shear modulus over frequency.
#[pyclass(name = "DampingLaw", module = "basemat", frozen, dict)]
pub(crate) struct PyDampingLaw(Arc<dyn Relaxation>);

/// A damping law of the core as an object of Python.
fn new_damping_law(law: basemat::Result<impl Relaxation + 'static>) -> PyResult<PyDampingLaw> {
    Ok(PyDampingLaw(Arc::new(law.or_raise()?)))
}

#[pymethods]
impl PyDampingLaw {
    /// No damping.
    #[staticmethod]
    fn elastic() -> PyResult<Self> {
        new_damping_law(Ok(Elastic))
    }

    /// Generalised Maxwell body with the damping ``ratio`` (0.05: 5 %) over a ``band`` (lowest and highest frequency,
    /// Hz; 0.1 to 30 by default) and the soil's modulus at the frequency ``reference`` (Hz; 1 by default): the usual
    /// choice in the time domain.
    #[pyo3(signature = (ratio, band=[0.1, 30.0], reference=1.0), text_signature = "(ratio, band=(0.1, 30.0), reference=1.0)")]
    #[staticmethod]
    fn constant_q(ratio: f64, band: [f64; 2], reference: f64) -> PyResult<Self> {
        new_damping_law(GeneralizedMaxwell::constant_q(ratio, band, reference))
    }

    /// Generalised Maxwell body of m mechanisms. ``long_term``: ratio of its long-term modulus to the modulus of the
    /// soil. ``ratios``: ratios of the moduli of the mechanisms to the modulus of the soil (array of shape (m,)).
    /// ``rates``: their relaxation rates (array of shape (m,), 1/s).
    #[staticmethod]
    fn maxwell(long_term: f64, ratios: Numbers, rates: Numbers) -> PyResult<Self> {
        new_damping_law(GeneralizedMaxwell::new(long_term, ratios.0, rates.0))
    }

    /// Kelvin–Voigt body with the damping ``ratio`` at ``frequency`` (Hz).
    #[staticmethod]
    fn kelvin_voigt(ratio: f64, frequency: f64) -> PyResult<Self> {
        new_damping_law(KelvinVoigt::with_ratio(ratio, frequency))
    }

    /// Exactly constant damping ``ratio`` (Kjartansson 1979) with the soil's modulus at the frequency ``reference``
    /// (Hz; 1 by default).
    #[pyo3(signature = (ratio, reference=1.0))]
    #[staticmethod]
    fn kjartansson(ratio: f64, reference: f64) -> PyResult<Self> {
        new_damping_law(Kjartansson::new(ratio, reference))
    }

    /// Damping ``ratio`` that is the same at all frequencies, as usual in the frequency domain. It is not causal: for
    /// impedances only.
    #[staticmethod]
    fn hysteretic(ratio: f64) -> PyResult<Self> {
        new_damping_law(Hysteretic::new(ratio))
    }
}

/// Soil of a layer: linear elastic.
struct FarFieldSoil(Soil);

extracts!(FarFieldSoil, object => {
    if let Ok(soil) = object.cast::<PySoil>() {
        return Ok(Self(soil.get().0));
    }
    let requirement = "a Soil: the far field is linear, and soil that yields is a material of a Mesh";
    Err(type_error(&object, requirement))
});

/// A horizontal soil layer with its ``soil`` (`Soil`), its ``thickness`` (m), its ``damping`` (`DampingLaw`; none
/// unless given). It is linear: soil that yields is a material of a `Mesh`.
#[pyclass(name = "SoilLayer", module = "basemat", frozen, dict)]
pub(crate) struct PySoilLayer(SoilLayer);

#[pymethods]
impl PySoilLayer {
    #[pyo3(signature = (soil, thickness, damping=None))]
    #[new]
    fn new(soil: FarFieldSoil, thickness: f64, damping: Option<&PyDampingLaw>) -> Self {
        Self(SoilLayer { soil: soil.0, thickness, damping: law_or_elastic(damping) })
    }

    /// `Soil` of the layer.
    #[getter]
    fn soil(&self) -> PySoil {
        PySoil(self.0.soil)
    }

    /// Thickness of the layer, m.
    #[getter]
    fn thickness(&self) -> f64 {
        self.0.thickness
    }
}

/// Damping law of an optional argument; elastic without one.
pub(crate) fn law_or_elastic(damping: Option<&PyDampingLaw>) -> Arc<dyn Relaxation> {
    damping.map_or_else(|| Arc::new(Elastic) as Arc<dyn Relaxation>, |law| Arc::clone(&law.0))
}

/// Horizontal soil layers on a half-plane or on rigid bedrock.
///
/// ``layers``: list of `SoilLayer` from the surface down. They lie on a half-plane of the soil ``bedrock``, or on rigid
/// bedrock if ``bedrock`` is not given. ``bedrock_damping``: `DampingLaw` of the bedrock; none unless given. Printed,
/// it is a table.
#[pyclass(name = "SoilProfile", module = "basemat", frozen, dict)]
pub(crate) struct PySoilProfile(pub(crate) SoilProfile);

#[pymethods]
impl PySoilProfile {
    #[pyo3(signature = (layers, bedrock=None, *, bedrock_damping=None))]
    #[new]
    fn new(
        layers: ListOf<'_, PySoilLayer>,
        bedrock: Option<&PySoil>,
        bedrock_damping: Option<&PyDampingLaw>,
    ) -> PyResult<Self> {
        let layers = layers.iter().map(|layer| layer.get().0.clone()).collect();
        let bedrock = match bedrock {
            Some(soil) => {
                Bedrock::HalfPlane { soil: soil.0, damping: law_or_elastic(bedrock_damping) }
            }
            None => Bedrock::Rigid,
        };
        Ok(Self(SoilProfile::new(layers, bedrock).or_raise()?))
    }

    /// The layers from the surface down: list of `SoilLayer`.
    #[getter]
    fn layers(&self) -> Vec<PySoilLayer> {
        self.0.layers().iter().cloned().map(PySoilLayer).collect()
    }

    /// The `Soil` of the half-plane under the layers; None on rigid bedrock.
    #[getter]
    fn bedrock(&self) -> Option<PySoil> {
        match self.0.bedrock() {
            Bedrock::HalfPlane { soil, .. } => Some(PySoil(*soil)),
            Bedrock::Rigid => None,
        }
    }

    /// `StressAtRest` of these soils, for finite elements that begin with it.
    ///
    /// ``gravity``: m/s². ``ratio``: K₀ of all soils, the horizontal over the vertical pressure; ν/(1 − ν) of each soil, as
    /// for a trench, unless given. The last layer on rigid bedrock extends to any depth.
    #[pyo3(signature = (gravity, ratio=None))]
    fn stress_at_rest(&self, gravity: f64, ratio: Option<f64>) -> PyResult<PyStressAtRest> {
        self.0.stress_at_rest(gravity, ratio).or_raise().map(PyStressAtRest)
    }

    /// Total thickness of the layers, m.
    #[getter]
    fn depth(&self) -> f64 {
        self.0.depth()
    }

    /// First natural frequency of the layers, Hz; None without layers.
    #[getter]
    fn first_frequency(&self) -> Option<f64> {
        self.0.first_frequency()
    }

    /// Travel time of a shear wave through all layers, s.
    #[getter]
    fn travel_time(&self) -> f64 {
        self.0.travel_time()
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

/// An argument that is a `SoilProfile` or a `Soil`.
#[derive(Clone)]
pub(crate) struct Profile(pub(crate) SoilProfile);

extracts!(Profile, object => {
    if let Ok(soil) = object.cast::<PySoil>() {
        return Ok(Self(soil.get().0.into()));
    }
    match object.cast::<PySoilProfile>() {
        Ok(profile) => Ok(Self(profile.get().0.clone())),
        Err(_) => Err(type_error(&object, "a Soil or a SoilProfile")),
    }
});
