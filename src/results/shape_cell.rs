//! Cells of a deformed shape: as they are drawn, and as VTK has them.

use std::collections::{BTreeSet, HashMap};

use crate::fem::{Element, ElementFace, Mesh};

/// Form of a cell; numbers are VTK's (vtkCellType.h).
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

    /// Cell of an element in space: a bar or mass by its nodes, a shell by its corners, a brick, another solid.
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

/// Corners of a brick in VTK's order: round the lower side, then those above them; `None` for another solid.
///
/// The first node of the element comes first if it lies in its first side.
fn brick(sides: &[ElementFace], nodes: &[usize]) -> Option<Vec<usize>> {
    if sides.len() != 6 || sides.iter().any(|side| side.corners().len() != 4) {
        return None;
    }
    // Counter-clockwise seen from inside the brick.
    let mut points: Vec<usize> = sides[0].corners().iter().rev().copied().collect();
    let first = points.iter().position(|point| nodes.first() == Some(point)).unwrap_or(0);
    points.rotate_left(first);
    for k in 0..4 {
        let (lower, corner) = (&points[..4], points[k]);
        let beside = |side: &ElementFace| {
            let own = side.corners();
            let at = own.iter().position(|point| *point == corner)?;
            [own[(at + 1) % 4], own[(at + 3) % 4]].into_iter().find(|point| !lower.contains(point))
        };
        let upper = sides.iter().find_map(beside)?;
        points.push(upper);
    }
    let distinct = points.iter().collect::<BTreeSet<_>>().len() == 8;
    distinct.then_some(points)
}

/// Nodes of the elements of a mesh; for elements with faces in space, of the faces that no second element has.
pub(super) fn drawn_cells(mesh: &Mesh) -> Vec<Vec<usize>> {
    let cells = mesh.elements().map(|element| element.nodes().to_vec());
    if !mesh.has_depth() {
        return cells.collect();
    }
    let faces = |element: &dyn Element| -> Vec<Vec<usize>> {
        element.faces().iter().map(|face| face.corners().to_vec()).collect()
    };
    let key = |corners: &[usize]| corners.iter().copied().collect::<BTreeSet<usize>>();
    let mut counts: HashMap<_, usize> = HashMap::new();
    for face in mesh.elements().flat_map(faces) {
        *counts.entry(key(&face)).or_default() += 1;
    }
    let outer = mesh.elements().zip(cells).flat_map(|(element, cell)| match faces(element) {
        own if own.is_empty() => vec![cell],
        own if own.len() == 1 => own,
        own => own.into_iter().filter(|face| counts[&key(face)] == 1).collect(),
    });
    outer.collect()
}
