//! Cells of a mat in plan.

use basemat::bem::plan::{Plan, impedances_in_plan};
use numpy::{Complex64, PyArray3};
use pyo3::prelude::*;

use super::superclass::strip_contact;
use crate::array::{Count, Numbers, numpy_complex, whole_numbers};
use crate::error::{OrRaise, input_error};
use crate::profile::Profile;
use crate::ticker::with_progress;

/// Square contact cells under a mat, for an `ElasticGround` in plan.
///
/// They are the cells that the ``faces`` of the mat cover, convex polygons by their corners (list of lists of x and y,
/// m; a single face needs no list around it), with ``cells`` along the shorter side of all faces together. Oblique
/// edges cut the cells; at straight edges along x and y the cells extend beyond the edge by 0.105 of their side.
#[pyclass(name = "Plan", module = "basemat", frozen, dict)]
#[derive(Clone)]
pub(crate) struct PyPlan(pub(super) Plan);

/// An entry of a mask: true or false, or a number that is 1 or 0.
fn is_cell(entry: &Bound<'_, PyAny>) -> PyResult<bool> {
    match entry.extract::<f64>() {
        Ok(1.0) => Ok(true),
        Ok(0.0) => Ok(false),
        _ => {
            let entry_text = entry.repr()?;
            Err(input_error(format!(
                "mask has the entry {entry_text}, but must be of True and False, or of 1 and 0"
            )))
        }
    }
}

#[pymethods]
impl PyPlan {
    #[new]
    fn new(faces: Bound<'_, PyAny>, cells: Count) -> PyResult<Self> {
        let polygons: Vec<Vec<[f64; 2]>> = if let Ok(polygons) = faces.extract() {
            polygons
        } else {
            // A single face needs no list around it.
            let requirement = "faces: give a list of polygons, each a list of its corners (x, y)";
            vec![faces.extract().map_err(|_: PyErr| input_error(requirement))?]
        };
        Ok(Self(Plan::on_faces(&polygons, cells.0).or_raise()?))
    }

    /// Disc around ``center`` (x and y, m) of a ``radius`` (m), with ``cells`` along its diameter.
    #[staticmethod]
    fn disc(center: (f64, f64), radius: f64, cells: Count) -> PyResult<Self> {
        Plan::disc(center.into(), radius, cells.0).or_raise().map(Self)
    }

    /// Cells of the sides ``pitch`` (along x and y, m) where ``mask`` is True or 1, and not where it is False or 0. The
    /// mask is a list of rows in the direction of y, from the ``corner`` (x and y, m) on; each row is a list from left
    /// to right.
    #[staticmethod]
    fn masked(
        corner: [f64; 2],
        pitch: [f64; 2],
        mask: Vec<Vec<Bound<'_, PyAny>>>,
    ) -> PyResult<Self> {
        let column_count = mask.first().map_or(0, Vec::len);
        if mask.iter().any(|row| row.len() != column_count) {
            return Err(input_error(format!(
                "mask has rows of different lengths, but each must have {column_count} cells"
            )));
        }
        let cells = mask.iter().flatten().map(is_cell).collect::<PyResult<Vec<_>>>()?;
        Plan::masked(corner, pitch, column_count, &cells).or_raise().map(Self)
    }

    /// Sides of a cell along x and y, m.
    #[getter]
    fn pitch(&self) -> [f64; 2] {
        self.0.pitch()
    }

    /// Middle of the bounding rectangle, x and y, m: the reference point of impedances.
    #[getter]
    fn middle(&self) -> [f64; 2] {
        self.0.middle()
    }

    /// Area of the cells inside the outline minus the area of the faces, relative to the area of the faces.
    #[getter]
    fn area_error(&self) -> f64 {
        self.0.area_error()
    }

    /// The plan with contact elements that are rectangles of cells: the list ``along`` contains the numbers of columns
    /// that are united, ``across`` the numbers of rows. Under a rigid mat, sixteen cells united by 1, 2, 2, 3, 3, 2, 2,
    /// 1 are as accurate as separate cells.
    fn with_unions(
        &self,
        #[pyo3(from_py_with = whole_numbers)] along: Vec<usize>,
        #[pyo3(from_py_with = whole_numbers)] across: Vec<usize>,
    ) -> PyResult<Self> {
        Ok(Self(self.0.clone().with_unions(&along, &across).or_raise()?))
    }

    /// The plan with cells that end at the edges of the faces: for springs, for prescribed pressures and for flexible
    /// faces.
    fn without_overhang(&self) -> PyResult<Self> {
        Ok(Self(self.0.clone().without_overhang().or_raise()?))
    }

    fn __len__(&self) -> usize {
        self.0.count()
    }

    /// Dynamic stiffness of the mat as one rigid body on a ``soil``.
    ///
    /// It applies to a ``soil`` (`Soil` or `SoilProfile`) and motions e^(iωt) at ``frequencies`` (array of shape (m,),
    /// Hz): complex array of shape (m, 6, 6), forces along x, y and z (N) and moments about these axes (N m) per
    /// displacement (m) and rotation (rad) of the mat's middle. ``contact``: "bonded" (the default) or "relaxed"
    /// (vertical motions without shear, horizontal motions without pressure).
    #[pyo3(signature = (soil, frequencies, *, contact="bonded"))]
    pub(super) fn impedances<'py>(
        &self,
        py: Python<'py>,
        soil: Profile,
        frequencies: Numbers,
        contact: &str,
    ) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        let plan = &self.0;
        let contact = strip_contact(contact)?;
        let impedances = py.detach(move || {
            with_progress(None, |observer| {
                impedances_in_plan(&soil.0, plan, &frequencies.0, contact, observer)
            })
        });
        let matrices: Vec<Vec<Vec<_>>> = impedances?
            .iter()
            .map(|impedance| {
                impedance.matrix.iter().map(|row| row.map(numpy_complex).to_vec()).collect()
            })
            .collect();
        Ok(PyArray3::from_vec3(py, &matrices)?)
    }
}
