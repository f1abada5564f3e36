//! Forces and moments of shells: values, and rows for probes.

use std::cell::RefCell;
use std::collections::HashMap;

use basemat::fem::ShellResultants;
use basemat::structure::ShellRows;
use pyo3::prelude::*;

use super::PyFemModel;
use crate::array::{Array, Count, Numbers, Rows, whole_numbers};
use crate::error::{OrRaise, call_user_code, extract_returned, input_error, raise_user_exceptions};
use crate::row::PySectionRows;

/// Forces and moments of a shell at a point, per metre of width.
///
/// They refer to the `axes`. `FemModel.shell_resultants` and `ShellRows.value` return them.
#[pyclass(name = "ShellResultants", module = "basemat", frozen)]
pub(crate) struct PyShellResultants(ShellResultants);

#[pymethods]
impl PyShellResultants {
    /// Unit vectors e1, e2 and n, the normal of the element, as rows: array of shape (3, 3), numbers without unit.
    #[getter]
    fn axes(&self) -> Rows {
        unit_vectors(&self.0.axes)
    }

    /// Membrane forces n_11, n_22 and n_12: array of shape (3,), N/m; tension is positive.
    #[getter]
    fn membrane(&self) -> Array {
        Array::from(&self.0.membrane[..])
    }

    /// Moments m_11, m_22 and m_12: array of shape (3,), N·m/m; positive with tension on the side of −n.
    #[getter]
    fn moments(&self) -> Array {
        Array::from(&self.0.moments[..])
    }

    /// Larger and smaller principal moment: array of shape (2,), N·m/m.
    #[getter]
    fn principal_moments(&self) -> Array {
        Array::from(&self.0.principal_moments()[..])
    }

    /// Shear forces q_1 and q_2: array of shape (2,), N/m; on a section whose outward normal is e1 or e2, along n.
    #[getter]
    fn shears(&self) -> Array {
        Array::from(&self.0.shears[..])
    }

    /// The same forces and moments in other axes: e1 is the part of the vector ``along`` in the plane of the element, n the
    /// normal on the side of the vector ``outward`` (x, y and z, of any length).
    fn in_axes(&self, along: [f64; 3], outward: [f64; 3]) -> PyResult<Self> {
        self.0.in_axes(along, outward).or_raise().map(Self)
    }
}

/// Rows of the forces and moments of shells at a node, for `Probe.section`.
///
/// They are rows of displacements, per metre of width. `FemModel.shell_rows` returns them.
///
/// A probe records changes from the static state; the static part is the `value` for the ``static_displacement`` of the
/// simulation. The rows contain the elastic forces, without damping.
#[pyclass(name = "ShellRows", module = "basemat", frozen)]
pub(crate) struct PyShellRows(ShellRows);

#[pymethods]
impl PyShellRows {
    /// Number of the node.
    #[getter]
    fn node(&self) -> usize {
        self.0.node
    }

    /// Unit vectors e1, e2 and n as rows, means of the elements' axes: array of shape (3, 3), numbers without unit.
    #[getter]
    fn axes(&self) -> Rows {
        unit_vectors(&self.0.axes)
    }

    /// Three `SectionRows` of the membrane forces n_11, n_22 and n_12, N/m; tension is positive.
    #[getter]
    fn membrane(&self) -> [PySectionRows; 3] {
        self.0.membrane.clone().map(PySectionRows::from)
    }

    /// Three `SectionRows` of the moments m_11, m_22 and m_12, N·m/m; positive with tension on the side of −n.
    #[getter]
    fn moments(&self) -> [PySectionRows; 3] {
        self.0.moments.clone().map(PySectionRows::from)
    }

    /// Two `SectionRows` of the shear forces q_1 and q_2, N/m.
    #[getter]
    fn shears(&self) -> [PySectionRows; 2] {
        self.0.shears.clone().map(PySectionRows::from)
    }

    /// The `ShellResultants` for all n degrees of freedom, ``displacement``: array of shape (n,), m and rad.
    fn value(&self, displacement: Numbers) -> PyResult<PyShellResultants> {
        let Numbers(dofs) = displacement;
        let resultants = self.0.membrane.iter().chain(&self.0.moments).chain(&self.0.shears);
        let rows = resultants.flat_map(|resultant| resultant.displacement.iter());
        let max_dof = rows.map(|(dof, _)| *dof).max();
        match max_dof {
            Some(dof) if dof >= dofs.len() => {
                let dof_count = dofs.len();
                Err(input_error(format!(
                    "displacement has {dof_count} entries, but must have over {dof}"
                )))
            }
            _ => Ok(PyShellResultants(self.0.value(&dofs))),
        }
    }
}

/// Unit vectors as rows.
fn unit_vectors(axes: &[[f64; 3]; 3]) -> Rows {
    Rows(axes.iter().map(|axis| axis.to_vec()).collect())
}

/// Directions [along, outward] of the axes of shells.
type Directions = [[f64; 3]; 2];

/// Axes that a Python function returns for a position; NaN if it raises an exception.
fn axes_at(function: &Bound<'_, PyAny>, [x, y, z]: [f64; 3]) -> Directions {
    call_user_code([[f64::NAN; 3]; 2], |_| extract_returned("axes", &function.call1((x, y, z))?))
}

#[pymethods]
impl PyFemModel {
    /// The `ShellResultants` of the shell with the number ``element`` at its nodes, in its own axes, a list: for all n
    /// degrees of freedom, ``displacement`` (array of shape (n,), m and rad).
    ///
    /// The ``displacement`` of a state is the change from the ``static_displacement`` of the simulation.
    fn shell_resultants(
        &self,
        element: Count,
        displacement: Numbers,
    ) -> PyResult<Vec<PyShellResultants>> {
        let resultants = self.0.shell_resultants(element.0, &displacement.0).or_raise()?;
        Ok(resultants.into_iter().map(PyShellResultants).collect())
    }

    /// The `ShellRows` at every node of the shells with the numbers ``elements`` (a list), in ascending order of nodes:
    /// means over these shells, which should be those of one mat or one wall.
    ///
    /// ``axes``: two vectors ``(along, outward)`` (x, y and z), or a function of x, y and z (m) that returns them: e1 is the
    /// part of the first in the plane of a shell, and the normal n is on the side of the second.
    fn shell_rows(
        &self,
        #[pyo3(from_py_with = whole_numbers)] elements: Vec<usize>,
        axes: &Bound<'_, PyAny>,
    ) -> PyResult<Vec<PyShellRows>> {
        let shell_rows = if axes.is_callable() {
            // The function is called once for a node that several shells share.
            let axes_by_position: RefCell<HashMap<[u64; 3], Directions>> = RefCell::default();
            raise_user_exceptions(|| {
                let rows = self.0.shell_rows(&elements, |position: [f64; 3]| {
                    let mut axes_by_position = axes_by_position.borrow_mut();
                    let entry = axes_by_position.entry(position.map(f64::to_bits));
                    *entry.or_insert_with(|| axes_at(axes, position))
                });
                rows.or_raise()
            })?
        } else {
            let directions: Directions = axes.extract()?;
            self.0.shell_rows(&elements, |_| directions).or_raise()?
        };
        Ok(shell_rows.into_iter().map(PyShellRows).collect())
    }
}
