//! Soil that begins with its stresses at rest.

use basemat::fem::{Mesh, StressAtRest};
use pyo3::prelude::*;

use super::mesh::PyMesh;
use crate::array::{Pairs, Rows};
use crate::error::OrRaise;

/// Stresses of level soil at rest: its weight, and K₀ times its weight sideways.
///
/// The vertical pressure at a depth is the weight of all soil above; the horizontal pressure is K₀ times as large in both
/// horizontal directions, without shear. The surface is at y = 0, and y points up. `Mesh.with_stress_at_rest` makes
/// elements begin with these stresses, `SoilProfile.stress_at_rest` has those of a profile. For sand with drainage below
/// the water table, take the density under buoyancy: the stresses are those of the grains.
///
/// ``gravity``: m/s². ``density``: kg/m³. ``ratio``: K₀, the horizontal over the vertical pressure.
#[pyclass(name = "StressAtRest", module = "basemat", frozen, dict)]
pub(crate) struct PyStressAtRest(pub(crate) StressAtRest);

#[pymethods]
impl PyStressAtRest {
    #[new]
    fn new(gravity: f64, density: f64, ratio: f64) -> PyResult<Self> {
        StressAtRest::new(gravity, density, ratio).or_raise().map(Self)
    }

    /// These stresses with other soil below a ``depth`` (m), of a ``density`` (kg/m³) and a ``ratio`` K₀. The depth lies below
    /// the upper ends of all layers so far.
    fn with_soil_below(&self, depth: f64, density: f64, ratio: f64) -> PyResult<Self> {
        self.0.clone().with_soil_below(depth, density, ratio).or_raise().map(Self)
    }

    /// Stresses at ``positions``: array of shape (n, 4) of xx, yy, zz and xy, Pa. Tension is positive, and zero above the
    /// surface. ``positions``: array of shape (n, 2), x and y, m.
    fn at(&self, positions: Pairs) -> Rows {
        Rows(positions.0.iter().map(|position| self.0.at(*position).to_vec()).collect())
    }
}

#[pymethods]
impl PyMesh {
    /// A copy of this mesh in which all present elements are soil that begins at rest, with the stresses ``stress``
    /// (`StressAtRest`).
    ///
    /// The elements are quadrilaterals of four or eight nodes below the surface y = 0; elements that are added later, such
    /// as a foundation on the soil, have their weight. Stresses at rest, the weight of the soil and the pressures at rest
    /// around it are in equilibrium, and all three are left out of a run: the soil does not move on any mesh, it has
    /// inertia but no weight, and tractions on the trench are changes from the state at rest. The material yields under the
    /// whole stress, which `Simulation.solid_points` returns. ``FemModel(mesh, on_soil_at_rest=True)`` takes such a mesh: the
    /// soil fills a trench, and its sides touch the trench, the surface or other soil at rest.
    ///
    /// A stress at rest outside the yield surface is an error with its element and depth.
    fn with_stress_at_rest(&self, stress: &PyStressAtRest) -> PyResult<Self> {
        Mesh::with_stress_at_rest(self.0.clone(), &stress.0).or_raise().map(Self)
    }
}
