//! Cells of a deformed shape: as they are drawn, and as VTK has them.

use std::collections::{BTreeSet, HashMap};

use crate::fem::{Element, ElementFace, Mesh};

/// Form of a cell; its number is that of VTK (vtkCellType.h).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CellForm {
    Point = 1,
    Line = 3,
    Triangle = 5,
    Polygon = 7,
    Quadrilateral = 9,
    Brick = 12,
    QuadraticTriangle = 22,
    QuadraticQuadrilateral = 23,
    BiquadraticQuadrilateral = 28,
    /// Convex solid of any form, by its points in any order.
    Solid = 41,
}

/// A cell by its form and its points, in VTK's order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShapeCell {
    pub(crate) form: CellForm,
    pub(crate) points: Vec<usize>,
}

impl ShapeCell {
    /// Point, line or surface, by the number of its points.
    pub(crate) fn flat(points: Vec<usize>) -> Self {
        let form = match points.len() {
            1 => CellForm::Point,
            2 => CellForm::Line,
            3 => CellForm::Triangle,
            4 => CellForm::Quadrilateral,
            6 => CellForm::QuadraticTriangle,
            8 => CellForm::QuadraticQuadrilateral,
            9 => CellForm::BiquadraticQuadrilateral,
            _ => CellForm::Polygon,
        };
        Self { form, points }
    }

    /// Cell of an element in space.
    ///
    /// A bar or mass has its nodes, a shell and a brick their corners, another solid its nodes.
    fn in_space(element: &dyn Element) -> Self {
        match &element.faces()[..] {
            [] => Self::flat(element.nodes().to_vec()),
            [shell] => Self::flat(shell.corners().to_vec()),
            sides => brick(sides, element.nodes()).map_or_else(
                || Self { form: CellForm::Solid, points: element.nodes().to_vec() },
                |points| Self { form: CellForm::Brick, points },
            ),
        }
    }

    /// Cells of all elements of a mesh, in their order.
    pub(super) fn of_elements(mesh: &Mesh) -> Vec<Self> {
        if mesh.has_depth() {
            return mesh.elements().map(Self::in_space).collect();
        }
        mesh.elements().map(|element| Self::flat(element.nodes().to_vec())).collect()
    }
}

/// Corners of a brick in VTK's order; `None` for another solid.
///
/// The corners around the lower side come first, then the corners above them.
///
/// The first node of the element comes first if it lies in its first side.
fn brick(sides: &[ElementFace], nodes: &[usize]) -> Option<Vec<usize>> {
    if sides.len() != 6 || sides.iter().any(|side| side.corners().len() != 4) {
        return None;
    }
    // Counter-clockwise seen from inside the brick.
    let mut points: Vec<usize> = sides[0].corners().iter().rev().copied().collect();
    let start = points.iter().position(|point| nodes.first() == Some(point)).unwrap_or(0);
    points.rotate_left(start);
    for k in 0..4 {
        let upper_point =
            sides.iter().find_map(|side| upper_corner(side, points[k], &points[..4]))?;
        points.push(upper_point);
    }
    let are_distinct = points.iter().collect::<BTreeSet<_>>().len() == 8;
    are_distinct.then_some(points)
}

/// The corner of a side next to a `corner` of the lower side, and above it; `None` if the side has no such corner.
fn upper_corner(side: &ElementFace, corner: usize, lower_points: &[usize]) -> Option<usize> {
    let corners = side.corners();
    let position = corners.iter().position(|point| *point == corner)?;
    let neighbours = [corners[(position + 1) % 4], corners[(position + 3) % 4]];
    neighbours.into_iter().find(|point| !lower_points.contains(point))
}

/// Cells of a mesh to be drawn, each as its nodes.
///
/// In the plane these are all elements. In space, elements with faces are drawn by the faces that no second element has.
pub(super) fn drawn_cells(mesh: &Mesh) -> Vec<Vec<usize>> {
    if !mesh.has_depth() {
        return mesh.elements().map(|element| element.nodes().to_vec()).collect();
    }
    let mut face_element_counts: HashMap<BTreeSet<usize>, usize> = HashMap::new();
    for face in mesh.elements().flat_map(faces) {
        *face_element_counts.entry(face.into_iter().collect()).or_default() += 1;
    }
    let mut cells = Vec::new();
    for element in mesh.elements() {
        let mut faces = faces(element);
        match faces.len() {
            0 => cells.push(element.nodes().to_vec()),
            1 => cells.append(&mut faces),
            _ => cells.extend(faces.into_iter().filter(|face| {
                let corners: BTreeSet<usize> = face.iter().copied().collect();
                face_element_counts[&corners] == 1
            })),
        }
    }
    cells
}

/// Corners of the faces of an element.
fn faces(element: &dyn Element) -> Vec<Vec<usize>> {
    element.faces().iter().map(|face| face.corners().to_vec()).collect()
}
