//! Box of soil of finite elements around a foundation.

use basemat::bem::embedded::NearField;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{PySharedKernels, PyTrench, PyTrenchGround, is_base_element};
use crate::array::Count;
use crate::error::{OrRaise, WithOption, call_user_code, extract_returned, raise_user_exceptions};
use crate::profile::Profile;
use crate::structure::PyMesh;

/// Box of soil around a foundation at the surface, as finite elements that may yield.
///
/// The box begins at rest (`Mesh.with_stress_at_rest`) and fills a trench, to which it is bonded: the law of the trench is
/// `Bonded`. The foundation is added to `mesh` by common nodes at the surface, or stands on it by a joint
/// (`Joint.around_nodes`); `ground` is the soil around the box, which stays linear. Elements must be shorter than an
/// eighth of the shortest wave of interest, and have no viscous damping, whatever that of the profile.
///
/// ``soil``: `Soil` or `SoilProfile`. ``half_width``: half the width of the foundation, whose middle is x = 0, m.
/// ``size``: half width and depth of the box (m), 2 and 1 times the half width of the foundation unless given.
/// ``foundation_elements``: number of elements under the foundation, an even number; 6 unless given.
/// ``pressure_at_rest``: gravity (m/s²) and K₀, the ratio of horizontal to vertical pressure at rest; standard gravity and
/// ν/(1 − ν) of each soil unless given. ``strength_profile``: a function of the depth (m) that returns the strength s_u of
/// clay without drainage (Pa), which is `Iwan.hyperbolic` with the constants of the profile, and reaches s_u at a strain of
/// 200 s_u/G; the soil is elastic unless given.
#[pyclass(name = "NearField", module = "basemat", frozen, dict)]
pub(crate) struct PyNearField {
    near_field: NearField,
    /// The argument `soil`.
    soil: Py<PyAny>,
}

#[pymethods]
impl PyNearField {
    #[new]
    #[pyo3(signature = (soil, half_width, *, size=None, foundation_elements=None, pressure_at_rest=None, strength_profile=None))]
    fn new(
        soil: Bound<'_, PyAny>,
        half_width: f64,
        size: Option<[f64; 2]>,
        foundation_elements: Option<Count>,
        pressure_at_rest: Option<[f64; 2]>,
        strength_profile: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let Profile(profile) = soil.extract()?;
        let mut near_field = NearField::new(profile, half_width)
            .with(size, |near_field, [half_width, depth]| near_field.with_size(half_width, depth))
            .with(foundation_elements, |near_field, count| {
                near_field.with_foundation_elements(count.0)
            })
            .with(pressure_at_rest, |near_field, [gravity, ratio]| {
                near_field.with_pressure_at_rest(gravity, ratio)
            })
            .or_raise()?;
        if let Some(function) = strength_profile {
            near_field = near_field.with_strength_profile(move |depth| {
                // A strength that is no number is an error of the core, in place of which the exception is raised.
                call_user_code(f64::NAN, |py| {
                    let returned_value = function.bind(py).call1((depth,))?;
                    extract_returned("strength_profile", &returned_value)
                })
            });
        }
        Ok(Self { near_field, soil: soil.unbind() })
    }

    /// `Mesh` of the box at rest, whose surface has nodes at both ends of the foundation; for a
    /// ``FemModel(mesh, on_soil_at_rest=True)``.
    fn mesh(&self) -> PyResult<PyMesh> {
        raise_user_exceptions(|| self.near_field.mesh().or_raise().map(PyMesh))
    }

    /// Numbers of the nodes of the surface under the foundation, from left to right: list. ``mesh``: a `Mesh` that begins with
    /// that of `mesh`. A welded foundation has these nodes in common with the soil; a joint takes them as its lower side.
    fn foundation_nodes(&self, mesh: &PyMesh) -> PyResult<Vec<usize>> {
        self.near_field.foundation_nodes(&mesh.0).or_raise()
    }

    /// `TrenchGround` of the soil around the box. ``kernels``: `SharedKernels` of several grounds; none unless given.
    #[pyo3(signature = (*, kernels=None))]
    fn ground<'py>(
        &self,
        py: Python<'py>,
        kernels: Option<Bound<'py, PySharedKernels>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let ground = self.near_field.ground().or_raise()?;
        let trench = ground.trench_elements().trench();
        let [left, right] = trench.sides();
        let elements = ground.trench_elements().elements();
        let base_count = elements.iter().filter(|element| is_base_element(element)).count();
        let wall_count = (elements.len() - base_count) / 2;
        // The objects of Python store the arguments of their construction.
        let elements = py
            .get_type::<PyTrench>()
            .call1((left, right, trench.depth()))?
            .call_method1("elements", (base_count, wall_count))?;
        let options = PyDict::new(py);
        options.set_item("kernels", kernels)?;
        py.get_type::<PyTrenchGround>().call((self.soil.bind(py), elements), Some(&options))
    }
}
