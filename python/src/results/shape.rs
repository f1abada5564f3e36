//! Shapes of structures for pictures.

use std::path::PathBuf;

use basemat::io::paraview;
use basemat::results::{DeformedShape, ShapePoint};
use basemat::structure::DofCombination;
use pyo3::prelude::*;

use crate::array::{Numbers, Points, Rows, whole_numbers};
use crate::error::{OrRaise, input_error};
use crate::joint::PyJoint;
use crate::list_arguments::{ListOf, type_error};
use crate::row::RowLike;
use crate::structure::{
    PyFemModel, PyReducedModel, PyShearBuilding, PyStoreyBuilding, PyStructureGroup,
    PyWithElements, PyWithModalDamping, PyWithSprings, PyWithWalls, structure_recipe,
};

/// Points and outlines of a ``structure`` for pictures and for ParaView.
///
/// The degrees of freedom of the structure move the points.
///
/// A `FemModel` is drawn by its elements, a `ShearBuilding` or `StoreyBuilding` by floors and columns; reduced, damped,
/// grouped and embedded structures by the structures that they consist of. An object with a method ``deformed_shape()``
/// is drawn by the result, as the structures of `basemat.opensees.structure` are. Any other structure is drawn as a box
/// of this ``height`` (m) on its base; it is an error unless ``height`` is given. ``height`` may be a list of one for each
/// structure of a group. ``joints``: list of `Joint` of the structure, whose sides are drawn as thick lines; none unless given.
#[pyclass(name = "DeformedShape", module = "basemat", frozen, dict)]
pub(crate) struct PyDeformedShape {
    pub(super) shape: DeformedShape,
    /// Number of the first cell of the joints, which come last.
    first_joint_cell: usize,
}

impl From<DeformedShape> for PyDeformedShape {
    fn from(shape: DeformedShape) -> Self {
        let first_joint_cell = shape.cells().len();
        Self { shape, first_joint_cell }
    }
}

/// Height of the boxes that represent structures without a shape, m: one, or one for each structure of a group.
pub(crate) enum BoxHeights {
    Same(f64),
    Each(Vec<Option<f64>>),
}

extracts!(BoxHeights, object => match object.extract() {
    Ok(height) => Ok(Self::Same(height)),
    Err(_) => Ok(Self::Each(object.extract().map_err(|_: PyErr| {
        type_error(&object, "a number of metres, or a list of one for each structure of a group")
    })?)),
});

/// Shape of a structure; a box of one of these heights for each structure without a shape.
fn shape_of(object: &Bound<'_, PyAny>, heights: Option<&BoxHeights>) -> PyResult<DeformedShape> {
    match heights {
        None => shape(object, None),
        Some(BoxHeights::Same(height)) => shape(object, Some(*height)),
        Some(BoxHeights::Each(heights)) => match object.cast::<PyStructureGroup>() {
            Ok(group) => group_shape(group.get(), object.py(), heights),
            Err(_) => Err(input_error("a list of heights is for a StructureGroup")),
        },
    }
}

/// Shape of a structure; a box of this `height` if the structure has no shape.
pub(super) fn shape(object: &Bound<'_, PyAny>, height: Option<f64>) -> PyResult<DeformedShape> {
    let py = object.py();
    if let Ok(shape) = object.cast::<PyDeformedShape>() {
        return Ok(shape.get().shape.clone());
    }
    if let Ok(model) = object.cast::<PyFemModel>() {
        return Ok(DeformedShape::of_model(&model.get().0));
    }
    if let Ok(building) = object.cast::<PyShearBuilding>() {
        return DeformedShape::of_building(&building.get().model()?).or_raise();
    }
    if let Ok(building) = object.cast::<PyStoreyBuilding>() {
        return DeformedShape::of_storeys(&building.get().model()?).or_raise();
    }
    if let Ok(with_springs) = object.cast::<PyWithSprings>() {
        return shape(with_springs.get().0.bind(py), height);
    }
    if let Ok(with_elements) = object.cast::<PyWithElements>() {
        return shape(with_elements.get().0.bind(py), height);
    }
    if let Ok(with_damping) = object.cast::<PyWithModalDamping>() {
        return shape(with_damping.get().structure.bind(py), height);
    }
    if let Ok(with_walls) = object.cast::<PyWithWalls>() {
        let with_walls = with_walls.get();
        let surface_shape = shape(with_walls.structure.bind(py), height)?;
        return mapped_points(&surface_shape, [0.0, -with_walls.depth], Ok).and_then(new_shape);
    }
    if let Ok(model) = object.cast::<PyReducedModel>() {
        let recovery = model.get().model.recovery();
        let full_shape = shape(model.get().structure.bind(py), height)?;
        return mapped_points(&full_shape, [0.0; 2], |row| recovery.row(row)).and_then(new_shape);
    }
    if let Ok(group) = object.cast::<PyStructureGroup>() {
        let group = group.get();
        return group_shape(group, py, &vec![height; group.members.len()]);
    }
    if let Some(method) = object.getattr_opt("deformed_shape")? {
        let returned_object = method.call0()?;
        let shape = returned_object.cast::<PyDeformedShape>().map_err(|_| {
            input_error("deformed_shape() of the structure must return a DeformedShape")
        })?;
        return Ok(shape.get().shape.clone());
    }
    let requirement = "give the height of the box that represents the structure";
    let height = height.ok_or_else(|| input_error(requirement))?;
    DeformedShape::of_block(structure_recipe(object)?().or_raise()?.as_ref(), height).or_raise()
}

/// Number of nodes of a triangle with midside nodes.
const CURVED_TRIANGLE_NODES: usize = 6;
/// Number of nodes of a quadrilateral with midside nodes.
const CURVED_QUAD_NODES: usize = 8;
/// Number of nodes of a quadrilateral with midside nodes and a node in the middle.
const CURVED_QUAD_NODES_WITH_CENTER: usize = 9;

/// Points, and cells by the indices of their points.
type PointsAndCells = (Vec<ShapePoint>, Vec<Vec<usize>>);

fn new_shape((points, cells): PointsAndCells) -> PyResult<DeformedShape> {
    DeformedShape::new(points, cells).or_raise()
}

/// Points and cells of a shape moved by `shift` (right, up; m), for another structure.
///
/// `convert_row` converts the rows of its points to rows of that structure.
fn mapped_points(
    shape: &DeformedShape,
    shift: [f64; 2],
    convert_row: impl Fn(DofCombination) -> basemat::Result<DofCombination>,
) -> PyResult<PointsAndCells> {
    let map_row = |row: &DofCombination| {
        if row.is_empty() { Ok(DofCombination::default()) } else { convert_row(row.clone()) }
    };
    let points = shape.points().iter().map(|point| {
        Ok(ShapePoint {
            position: [point.position[0] + shift[0], point.position[1] + shift[1]],
            horizontal: map_row(&point.horizontal)?,
            vertical: map_row(&point.vertical)?,
            away: point.away,
            across: map_row(&point.across)?,
        })
    });
    let points = points.collect::<basemat::Result<_>>().or_raise()?;
    Ok((points, shape.cells().to_vec()))
}

/// Shape of a group: the shapes of all its members, with these heights of boxes.
fn group_shape(
    group: &PyStructureGroup,
    py: Python<'_>,
    heights: &[Option<f64>],
) -> PyResult<DeformedShape> {
    let member_count = group.members.len();
    if heights.len() != member_count {
        let height_count = heights.len();
        return Err(input_error(format!(
            "height has {height_count} entries, but must have {member_count}, one for each structure of the group"
        )));
    }
    let group_model = (group.make)().or_raise()?;
    let mut points = Vec::new();
    let mut cells = Vec::new();
    for (member, (structure, offset)) in group.members.iter().enumerate() {
        let member_shape = shape(structure.bind(py), heights[member])?;
        let first_point = points.len();
        let (member_points, member_cells) =
            mapped_points(&member_shape, *offset, |row| group_model.row(member, row))?;
        points.extend(member_points);
        for cell in member_cells {
            cells.push(cell.into_iter().map(|point| first_point + point).collect());
        }
    }
    new_shape((points, cells))
}

/// A point at a `position` [x, y, z] with the rows of its displacements; an error unless there is one row per axis.
fn shape_point(position: [f64; 3], rows: Vec<RowLike>, axis_count: usize) -> PyResult<ShapePoint> {
    let row_count = rows.len();
    let [x, y, z] = position;
    let mut rows = rows.into_iter().map(|row| row.0);
    let combinations = [rows.next(), rows.next(), rows.next()];
    match combinations {
        [Some(horizontal), Some(vertical), None] if axis_count == 2 => {
            Ok(ShapePoint { position: [x, y], horizontal, vertical, ..ShapePoint::default() })
        }
        [Some(horizontal), Some(across), Some(vertical)] if row_count == axis_count => {
            Ok(ShapePoint { position: [x, z], horizontal, vertical, away: y, across })
        }
        _ => Err(input_error(format!("a point has {row_count} rows, but must have {axis_count}"))),
    }
}

#[pymethods]
impl PyDeformedShape {
    #[new]
    #[pyo3(signature = (structure, *, height=None, joints=None))]
    fn new(
        structure: &Bound<'_, PyAny>,
        height: Option<BoxHeights>,
        joints: Option<ListOf<'_, PyJoint>>,
    ) -> PyResult<Self> {
        let mut drawn_shape = Self::from(shape_of(structure, height.as_ref())?);
        for joint in joints.iter().flat_map(|joints| joints.iter()) {
            drawn_shape.shape = drawn_shape.shape.with_joint(&joint.get().core(None)?);
        }
        Ok(drawn_shape)
    }

    /// Shape by its ``points``: array of shape (points, 2) in the plane, x and y, or of shape (points, 3) in space, x,
    /// y and z, m; heights are above the ground.
    ///
    /// ``rows``: for each point the rows of its displacements along these axes, two or three. ``cells``: list of the points
    /// of each line (2), triangle (3), quadrilateral (4) or polygon, by their numbers.
    #[staticmethod]
    fn of_points(
        points: Points,
        rows: Vec<Vec<RowLike>>,
        #[pyo3(from_py_with = whole_numbers)] cells: Vec<Vec<usize>>,
    ) -> PyResult<Self> {
        let axis_count = points.axis_count();
        let positions = points.coordinates();
        let point_count = positions.len();
        if rows.len() != point_count {
            let row_count = rows.len();
            return Err(input_error(format!(
                "rows has {row_count} entries, but must have {point_count}, one for each point"
            )));
        }
        let mut points = Vec::with_capacity(point_count);
        for (position, point_rows) in positions.into_iter().zip(rows) {
            points.push(shape_point(position, point_rows, axis_count)?);
        }
        new_shape((points, cells)).map(Self::from)
    }

    /// Coordinates of the points at rest: array of shape (points, 3), m: x, height and 0 in the plane; x, y and height
    /// in space.
    #[getter]
    fn points(&self) -> Rows {
        let coordinates = self.shape.points().iter().map(|point| {
            let [right, up] = point.position;
            self.axes([right, up, point.away])
        });
        Rows(coordinates.collect())
    }

    /// Outlines: list of the points of each line or polygon, by their numbers.
    #[getter]
    fn cells(&self) -> Vec<Vec<usize>> {
        // A curved cell has its corners first, then its midside nodes.
        let corners = self.shape.cells().iter().map(|cell| match cell.len() {
            CURVED_TRIANGLE_NODES => cell[..3].to_vec(),
            CURVED_QUAD_NODES..=CURVED_QUAD_NODES_WITH_CENTER => cell[..4].to_vec(),
            _ => cell.clone(),
        });
        corners.collect()
    }

    /// Number of the first of `cells` that is a side of a joint; the others follow.
    #[getter]
    fn _first_joint_cell(&self) -> usize {
        self.first_joint_cell
    }

    /// Whether the points move in three directions.
    #[getter]
    fn in_space(&self) -> bool {
        self.shape.points().iter().any(|point| !point.across.is_empty())
    }

    /// Displacements of the points along the axes of `points`: array of shape (points, 3), m.
    ///
    /// ``displacement``: all n degrees of freedom of the structure, array of shape (n,), m and rad: a row of
    /// ``run.motion["displacement"]``, a static displacement or a vibration mode.
    fn displacements(&self, displacement: Numbers) -> PyResult<Rows> {
        let displacements = self.shape.displacements(&displacement.0).or_raise()?;
        Ok(Rows(displacements.into_iter().map(|displacement| self.axes(displacement)).collect()))
    }

    /// Writes the shape with the displacements by ``displacement`` (array of shape (n,), m and rad) to the file at ``path``
    /// for ParaView, one grid (.vtu): a single state, such as the static one or a vibration mode.
    fn save_paraview_state(&self, path: PathBuf, displacement: Numbers) -> PyResult<()> {
        paraview::write_state(path, &self.shape, &displacement.0).or_raise()
    }
}

impl PyDeformedShape {
    /// A vector (right, up, away) along the axes of Python: x and y in the plane; x, y and z in space.
    fn axes(&self, [right, up, away]: [f64; 3]) -> Vec<f64> {
        if self.in_space() { vec![right, away, up] } else { vec![right, up, 0.0] }
    }
}
