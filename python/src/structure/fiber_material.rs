//! Laws of fibres along a bar: concrete, steel, linear elastic, or written in Python.

use std::sync::Arc;

use basemat::fem::{BilinearSteel, Concrete, MenegottoPinto, UniaxialMaterial};
use pyo3::prelude::*;

use super::bilinear_moment::PyBilinearMoment;
use super::material::PyMaterial;
use crate::array::{Array, Numbers};
use crate::error::{OrRaise, WithOption, raise_user_exceptions};
use crate::user;

/// Concrete without tension, a law of fibres.
///
/// In compression the stress follows a parabola to the ``strength`` f_c (Pa) at the strain ``strength_strain``, then a straight
/// line to ``ultimate_stress`` (Pa) at ``ultimate_strain``, and is constant beyond. All four are positive. Unloading and
/// reloading follow one straight line to a residual strain (Kent and Park 1971; Scott, Park and Priestley 1982). It is OpenSees'
/// ``Concrete01``. Where concrete softens, results depend on the lengths of the elements.
#[pyclass(name = "Concrete", module = "basemat", frozen, dict)]
pub(crate) struct PyConcrete(Concrete);

#[pymethods]
impl PyConcrete {
    #[new]
    fn new(
        strength: f64,
        strength_strain: f64,
        ultimate_stress: f64,
        ultimate_strain: f64,
    ) -> PyResult<Self> {
        let concrete = Concrete::new(strength, strength_strain, ultimate_stress, ultimate_strain)
            .or_raise()?;
        Ok(Self(concrete))
    }
}

/// Steel with two straight branches and kinematic hardening, a law of fibres.
///
/// ``yield_stress`` and ``modulus``: Pa; ``hardening_ratio``: ratio of the hardening modulus to it, from 0 to below 1. It is
/// OpenSees' ``Steel01`` without isotropic hardening.
#[pyclass(name = "BilinearSteel", module = "basemat", frozen, dict)]
pub(crate) struct PyBilinearSteel(BilinearSteel);

#[pymethods]
impl PyBilinearSteel {
    #[new]
    fn new(yield_stress: f64, modulus: f64, hardening_ratio: f64) -> PyResult<Self> {
        Ok(Self(BilinearSteel::new(yield_stress, modulus, hardening_ratio).or_raise()?))
    }
}

/// Steel with curved branches and the Bauschinger effect, a law of fibres (Menegotto and Pinto 1973).
///
/// ``yield_stress`` and ``modulus``: Pa; ``hardening_ratio``: from 0 to below 1. ``transition``: exponent R₀ of the branches
/// and c₁ and c₂, by which it falls with the plastic strain of the last half cycle (three numbers; 15, 0.925 and 0.15 by
/// default). ``isotropic_hardening``: a₁ and a₂ for compression, a₃ and a₄ for tension (four numbers; none unless given), which
/// shift the asymptotes by a₁ f_y (Δε/(2 a₂ ε_y))^0.8 with the range Δε of strains at reversals. It is OpenSees' ``Steel02``
/// without initial stress.
#[pyclass(name = "MenegottoPinto", module = "basemat", frozen, dict)]
pub(crate) struct PyMenegottoPinto(MenegottoPinto);

#[pymethods]
impl PyMenegottoPinto {
    #[new]
    #[pyo3(signature = (yield_stress, modulus, hardening_ratio, *, transition=None, isotropic_hardening=None))]
    fn new(
        yield_stress: f64,
        modulus: f64,
        hardening_ratio: f64,
        transition: Option<[f64; 3]>,
        isotropic_hardening: Option<[f64; 4]>,
    ) -> PyResult<Self> {
        let steel = MenegottoPinto::new(yield_stress, modulus, hardening_ratio)
            .with(transition, |steel, [exponent, c1, c2]| steel.with_transition(exponent, c1, c2))
            .with(isotropic_hardening, MenegottoPinto::with_isotropic_hardening);
        Ok(Self(steel.or_raise()?))
    }
}

/// A law of fibres: of the package, linear elastic, or one written in Python.
pub(crate) struct FiberLaw(pub(super) Arc<dyn UniaxialMaterial>);

extracts!(FiberLaw, object => {
    if let Ok(material) = object.cast::<PyMaterial>() {
        return Ok(Self(Arc::new(material.get().0)));
    }
    if let Ok(concrete) = object.cast::<PyConcrete>() {
        return Ok(Self(Arc::new(concrete.get().0)));
    }
    if let Ok(steel) = object.cast::<PyBilinearSteel>() {
        return Ok(Self(Arc::new(steel.get().0)));
    }
    if let Ok(steel) = object.cast::<PyMenegottoPinto>() {
        return Ok(Self(Arc::new(steel.get().0)));
    }
    if let Ok(law) = object.cast::<PyBilinearMoment>() {
        return Ok(Self(Arc::new(law.get().0)));
    }
    user::uniaxial_material(&object).map(Self)
});

/// Stresses at the ``strains`` of a path through a law of fibres, which starts without strain: array of shape (n,), Pa.
///
/// ``material``: a `Concrete`, `BilinearSteel`, `MenegottoPinto`, `Material` or `UserUniaxialMaterial`. ``strains``: array of
/// shape (n,), tension positive; every state is committed.
#[pyfunction]
pub(crate) fn fiber_stress_path(material: FiberLaw, strains: Numbers) -> PyResult<Array> {
    let law = material.0;
    raise_user_exceptions(|| {
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(&mut variables);
        let mut stresses = Vec::with_capacity(strains.0.len());
        for strain in strains.0 {
            stresses.push(law.response(strain, &variables).or_raise()?.stress);
            law.commit(strain, &mut variables);
        }
        Ok(stresses.into())
    })
}
