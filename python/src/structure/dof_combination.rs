//! Weighted sums of degrees of freedom in Python: arithmetic, conversion and comparison.

use basemat::structure::{Base, DofCombination, Structure};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

use super::structure_recipe;
use crate::array::{Array, Count, Numbers};
use crate::error::{OrRaise, input_error};
use crate::row::{PyDofCombination, RowLike, python_rows};

impl PyDofCombination {
    /// The structure of this row; an error unless it is in the plane.
    fn plane_structure(&self, structure: &Bound<'_, PyAny>) -> PyResult<Box<dyn Structure>> {
        let structure = structure_recipe(structure)?().or_raise()?;
        if matches!(structure.base(), Base::Faces(_)) {
            let hint = "in plan subtract a row of DofCombination.of_base";
            return Err(input_error(format!("the structure is not in the plane: {hint}")));
        }
        self.1.check("the row", structure.dofs())?;
        Ok(structure)
    }
}

#[pymethods]
impl PyDofCombination {
    #[new]
    fn new(terms: RowLike) -> Self {
        Self(terms.0, terms.1)
    }

    /// List of pairs ``(dof, weight)``.
    #[getter]
    fn terms(&self) -> Vec<(usize, f64)> {
        self.0.to_vec()
    }

    /// The sum for the values ``dofs`` of the degrees of freedom (array of shape (n,)), in their unit.
    fn value(&self, dofs: Numbers) -> PyResult<f64> {
        let Numbers(dofs) = dofs;
        self.1.check("the row", dofs.len())?;
        if let Some((dof, _)) = self.0.iter().find(|(dof, _)| *dof >= dofs.len()) {
            return Err(input_error(format!(
                "a row has the degree of freedom {dof}, but there are {}",
                dofs.len()
            )));
        }
        Ok(self.0.value(&dofs))
    }

    /// All weights as an array of shape (n,) for a number n of degrees of freedom, ``dofs``.
    fn weights(&self, dofs: Count) -> PyResult<Array> {
        let Count(dof_count) = dofs;
        self.1.check("the row", dof_count)?;
        let mut weights = Vec::new();
        weights.try_reserve_exact(dof_count).map_err(|_| {
            PyMemoryError::new_err(format!("an array of {dof_count} weights does not fit"))
        })?;
        weights.resize(dof_count, 0.0);
        for &(dof, weight) in &self.0 {
            *weights.get_mut(dof).ok_or_else(|| {
                input_error(format!(
                    "a row has the degree of freedom {dof}, but there are {dof_count}"
                ))
            })? += weight;
        }
        Ok(weights.into())
    }

    /// The three `DofCombination` of the displacements along x, along y and up of a point that moves with the base of
    /// the ``structure`` as one rigid body. ``place``: position from the middle of the base (x, y, height; m).
    #[staticmethod]
    fn of_base(structure: Bound<'_, PyAny>, place: [f64; 3]) -> PyResult<[Self; 3]> {
        let structure = structure_recipe(&structure)?().or_raise()?;
        Ok(python_rows(DofCombination::of_base(structure.as_ref(), place).or_raise()?))
    }

    /// This displacement to the right, relative to the middle of the base of the ``structure``; in plan subtract a row of
    /// `of_base`.
    fn relative_to_base(&self, structure: Bound<'_, PyAny>) -> PyResult<Self> {
        let structure = self.plane_structure(&structure)?;
        Ok(Self(self.0.relative_to_base(structure.as_ref()).or_raise()?, self.1))
    }

    /// This displacement to the right minus the rigid motion of the base of the ``structure``, whose rotation acts at
    /// ``height`` (m) above the base: the lateral deformation.
    fn total_drift(&self, structure: Bound<'_, PyAny>, height: f64) -> PyResult<Self> {
        let structure = self.plane_structure(&structure)?;
        Ok(Self(self.0.total_drift(structure.as_ref(), height).or_raise()?, self.1))
    }

    fn __add__(&self, other: RowLike) -> PyResult<Self> {
        Ok(Self(self.0.clone() + other.0, self.1.common_with(other.1)?))
    }

    fn __sub__(&self, other: RowLike) -> PyResult<Self> {
        Ok(Self(self.0.clone() - other.0, self.1.common_with(other.1)?))
    }

    fn __neg__(&self) -> Self {
        Self(-self.0.clone(), self.1)
    }

    fn __mul__(&self, factor: f64) -> Self {
        Self(factor * self.0.clone(), self.1)
    }

    fn __rmul__(&self, factor: f64) -> Self {
        self.__mul__(factor)
    }

    fn __truediv__(&self, divisor: f64) -> Self {
        self.__mul__(1.0 / divisor)
    }

    fn __repr__(&self) -> String {
        format!("DofCombination({:?})", &*self.0)
    }
}
