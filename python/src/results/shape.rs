//! Shapes of structures for pictures.

use std::path::PathBuf;

use basemat::io::paraview;
use basemat::results::{DeformedShape, ShapePoint};
use basemat::structure::DofCombination;
use pyo3::prelude::*;

use crate::array::{Numbers, Points, Rows, whole};
use crate::error::{OrRaise, refuse};
use crate::row::RowLike;
use crate::structure::{
    PyFemModel, PyReducedModel, PyShearBuilding, PyStoreyBuilding, PyStructureGroup,
    PyWithModalDamping, PyWithSprings, PyWithWalls, recipe,
};

/// Points and outlines of a ``structure`` that its degrees of freedom move, for pictures and for ParaView.
///
/// A `FemModel` is drawn by its elements, a `ShearBuilding` or `StoreyBuilding` by floors and
/// columns; reduced, damped and grouped structures and those in the ground as the structures that they are made of. An object with a method
/// ``deformed_shape()`` gives its own, as the structures of `basemat.opensees.structure` do. Any other is drawn as a
/// box of this ``height`` (m) on its base; unless given, such a structure is an error.
#[pyclass(name = "DeformedShape", module = "basemat", frozen, dict)]
pub(crate) struct PyDeformedShape(pub(super) DeformedShape);

/// Shape of a structure, of one without a form of its own a box of this `height`.
pub(super) fn shape(object: &Bound<'_, PyAny>, height: Option<f64>) -> PyResult<DeformedShape> {
    let py = object.py();
    if let Ok(own) = object.cast::<PyDeformedShape>() {
        return Ok(own.get().0.clone());
    }
    if let Ok(own) = object.cast::<PyFemModel>() {
        return Ok(DeformedShape::of_model(&own.get().0));
    }
    if let Ok(own) = object.cast::<PyShearBuilding>() {
        return DeformedShape::of_building(&own.get().made()?).or_raise();
    }
    if let Ok(own) = object.cast::<PyStoreyBuilding>() {
        return DeformedShape::of_storeys(&own.get().made()?).or_raise();
    }
    if let Ok(own) = object.cast::<PyWithSprings>() {
        return shape(own.get().0.bind(py), height);
    }
    if let Ok(own) = object.cast::<PyWithModalDamping>() {
        return shape(own.get().structure.bind(py), height);
    }
    if let Ok(own) = object.cast::<PyWithWalls>() {
        let own = own.get();
        return mapped(&shape(own.structure.bind(py), height)?, [0.0, -own.depth], Ok)
            .and_then(made);
    }
    if let Ok(own) = object.cast::<PyReducedModel>() {
        let recovery = own.get().reduced.recovery();
        let full = shape(own.get().structure.bind(py), height)?;
        return mapped(&full, [0.0; 2], |row| recovery.row(row)).and_then(made);
    }
    if let Ok(own) = object.cast::<PyStructureGroup>() {
        return group(own.get(), py, height);
    }
    if let Some(own) = object.getattr_opt("deformed_shape")? {
        let own = own.call0()?;
        let own = own
            .cast::<PyDeformedShape>()
            .map_err(|_| refuse("deformed_shape() of the structure must return a DeformedShape"))?;
        return Ok(own.get().0.clone());
    }
    let needed = "height: give that of the box that stands for the structure";
    let height = height.ok_or_else(|| refuse(needed))?;
    DeformedShape::of_block(recipe(object)?().or_raise()?.as_ref(), height).or_raise()
}

/// Points, and cells by their indices.
type Parts = (Vec<ShapePoint>, Vec<Vec<usize>>);

fn made((points, cells): Parts) -> PyResult<DeformedShape> {
    DeformedShape::new(points, cells).or_raise()
}

/// A shape moved to the right and up by `shift` (m), whose points are moved by `row` of their own rows.
fn mapped(
    shape: &DeformedShape,
    shift: [f64; 2],
    row: impl Fn(DofCombination) -> basemat::Result<DofCombination>,
) -> PyResult<Parts> {
    let point = |own: &ShapePoint| {
        let moved = |of: &DofCombination| {
            if of.is_empty() { Ok(DofCombination::default()) } else { row(of.clone()) }
        };
        Ok(ShapePoint {
            position: [own.position[0] + shift[0], own.position[1] + shift[1]],
            horizontal: moved(&own.horizontal)?,
            vertical: moved(&own.vertical)?,
            away: own.away,
            across: moved(&own.across)?,
        })
    };
    let points = shape.points().iter().map(point).collect::<basemat::Result<_>>().or_raise()?;
    Ok((points, shape.cells().to_vec()))
}

/// Shapes of all members of a group.
fn group(own: &PyStructureGroup, py: Python<'_>, height: Option<f64>) -> PyResult<DeformedShape> {
    let (group, mut all) = ((own.make)().or_raise()?, Parts::default());
    for (member, (structure, shift)) in own.members.iter().enumerate() {
        let shape = shape(structure.bind(py), height)?;
        let (points, cells) = mapped(&shape, [*shift, 0.0], |row| group.row(member, row))?;
        let first = all.0.len();
        let moved = |cell: Vec<usize>| cell.into_iter().map(|point| first + point).collect();
        all.0.extend(points);
        all.1.extend(cells.into_iter().map(moved));
    }
    made(all)
}

#[pymethods]
impl PyDeformedShape {
    #[new]
    #[pyo3(signature = (structure, *, height=None))]
    fn new(structure: &Bound<'_, PyAny>, height: Option<f64>) -> PyResult<Self> {
        shape(structure, height).map(Self)
    }

    /// Shape of ``points`` of your own: array of shape (points, 2) in the plane, x and y, or of shape (points, 3) in space,
    /// x, y and z, m; heights are above the ground.
    ///
    /// ``rows``: for each point the rows of its displacements along these axes, two or three. ``cells``: list of the points
    /// of each line (2), triangle (3), quadrilateral (4) or polygon, by their numbers.
    #[staticmethod]
    fn of_points(
        points: Points,
        rows: Vec<Vec<RowLike>>,
        #[pyo3(from_py_with = whole)] cells: Vec<Vec<usize>>,
    ) -> PyResult<Self> {
        let (axes, places) = points.places();
        if rows.len() != places.len() {
            let (found, count) = (rows.len(), places.len());
            return Err(refuse(format!(
                "rows are {found}, but must be {count}: those of a point each"
            )));
        }
        let point = |([x, y, z], rows): ([f64; 3], Vec<RowLike>)| {
            let count = rows.len();
            let mut rows = rows.into_iter().map(|own| own.0);
            let mut next = || rows.next().unwrap_or_default();
            if count != axes {
                return Err(refuse(format!("a point has {count} rows, but must have {axes}")));
            }
            let (horizontal, second) = (next(), next());
            Ok(if axes == 2 {
                let position = [x, y];
                ShapePoint { position, horizontal, vertical: second, ..ShapePoint::default() }
            } else {
                let position = [x, z];
                ShapePoint { position, horizontal, vertical: next(), away: y, across: second }
            })
        };
        let points = places.into_iter().zip(rows).map(point).collect::<PyResult<_>>()?;
        made((points, cells)).map(Self)
    }

    /// Places at rest: array of shape (points, 3), m: x, height and 0 in the plane; x, y and height in space.
    #[getter]
    fn points(&self) -> Rows {
        let place = |own: &ShapePoint| self.axes([own.position[0], own.position[1], own.away]);
        Rows(self.0.points().iter().map(place).collect())
    }

    /// Outlines: list of the points of each line or polygon, by their numbers.
    #[getter]
    fn cells(&self) -> Vec<Vec<usize>> {
        // Of curved cells the corners come first.
        let corners = |own: &Vec<usize>| match own.len() {
            6 => own[..3].to_vec(),
            8 | 9 => own[..4].to_vec(),
            _ => own.clone(),
        };
        self.0.cells().iter().map(corners).collect()
    }

    /// Whether the points move in three directions.
    #[getter]
    fn in_space(&self) -> bool {
        self.0.points().iter().any(|point| !point.across.is_empty())
    }

    /// Displacements of the points along the axes of `points`: array of shape (points, 3), m.
    ///
    /// ``displacement``: all n degrees of freedom of the structure, array of shape (n,), m and rad: a row of
    /// ``run.motion["displacement"]``, a static displacement or a vibration mode.
    fn displacements(&self, displacement: Numbers) -> PyResult<Rows> {
        let found = self.0.displacements(&displacement.0).or_raise()?;
        Ok(Rows(found.into_iter().map(|own| self.axes(own)).collect()))
    }

    /// Writes the shape with the displacements by ``displacement`` (array of shape (n,), m and rad) to the file at ``path``
    /// for ParaView, one grid (.vtu): a single state, such as the static one or a vibration mode.
    fn save_paraview_state(&self, path: PathBuf, displacement: Numbers) -> PyResult<()> {
        paraview::write_state(path, &self.0, &displacement.0).or_raise()
    }
}

impl PyDeformedShape {
    /// A vector (right, up, away) along the axes of Python: x and y in the plane; x, y and z in space.
    fn axes(&self, [right, up, away]: [f64; 3]) -> Vec<f64> {
        if self.in_space() { vec![right, away, up] } else { vec![right, up, 0.0] }
    }
}
