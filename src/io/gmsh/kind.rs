//! Kinds of elements in a `.msh` file, with their numbers (Gmsh reference manual, "Low order elements").

use crate::error::FileFault;

/// Kind of an element that a reader accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ElementKind {
    Point,
    Line,
    /// Line with a node in its middle.
    SecondOrderLine,
    Triangle,
    Quadrilateral,
    /// Quadrilateral with a node in the middle of each side.
    SecondOrderQuadrilateral,
    Brick,
}

impl ElementKind {
    /// Name of one element.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Line | Self::SecondOrderLine => "line",
            Self::Triangle => "triangle",
            Self::Quadrilateral | Self::SecondOrderQuadrilateral => "quadrilateral",
            Self::Brick => "brick",
        }
    }

    /// Number of corners; nodes between corners follow them.
    pub(super) fn corner_count(self) -> usize {
        match self {
            Self::SecondOrderLine => 2,
            Self::SecondOrderQuadrilateral => 4,
            _ => self.node_count(),
        }
    }

    /// Number of nodes.
    pub(super) fn node_count(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::SecondOrderLine | Self::Triangle => 3,
            Self::Quadrilateral => 4,
            Self::SecondOrderQuadrilateral | Self::Brick => 8,
        }
    }

    /// Dimension of the element: 0 for a point, 3 for a solid in space.
    pub(super) fn dimension(self) -> usize {
        match self {
            Self::Point => 0,
            Self::Line | Self::SecondOrderLine => 1,
            Self::Triangle | Self::Quadrilateral | Self::SecondOrderQuadrilateral => 2,
            Self::Brick => 3,
        }
    }
}

/// Kinds of elements that a reader accepts.
#[derive(Debug)]
pub(super) struct AcceptedKinds {
    /// Each kind, with its number in the format.
    kinds_by_number: &'static [(u32, ElementKind)],
    /// The accepted kinds in words, for errors.
    kinds_text: &'static str,
    /// Numbers of kinds that are not accepted, and the setting of Gmsh that avoids them.
    remedies: &'static [(&'static [u32], &'static str)],
}

/// Kinds of a mesh in the plane.
pub(super) const KINDS_IN_PLANE: AcceptedKinds = AcceptedKinds {
    kinds_by_number: &[
        (15, ElementKind::Point),
        (1, ElementKind::Line),
        (8, ElementKind::SecondOrderLine),
        (3, ElementKind::Quadrilateral),
        (16, ElementKind::SecondOrderQuadrilateral),
    ],
    kinds_text: "lines and quadrilaterals of the first or second order",
    remedies: &[
        (&[2, 9], "let Gmsh recombine triangles (Mesh.RecombineAll = 1)"),
        (&[10], "Mesh.SecondOrderIncomplete = 1 leaves out the ninth node"),
    ],
};

/// Kinds of a mesh in space.
pub(super) const KINDS_IN_SPACE: AcceptedKinds = AcceptedKinds {
    kinds_by_number: &[
        (15, ElementKind::Point),
        (1, ElementKind::Line),
        (2, ElementKind::Triangle),
        (3, ElementKind::Quadrilateral),
        (5, ElementKind::Brick),
    ],
    kinds_text: "points, lines, triangles, quadrilaterals and bricks of the first order",
    remedies: &[
        (&[4, 6, 7], "let Gmsh make bricks (transfinite volumes, or extruded layers, recombined)"),
        (&[8, 9, 10, 11, 12, 13, 14, 16, 17, 18, 19], "Mesh.ElementOrder = 1"),
    ],
};

/// Names of several elements of the kinds 1 to 19, in errors.
const KIND_NAMES: [&str; 19] = [
    "lines",
    "triangles",
    "quadrilaterals",
    "tetrahedra",
    "bricks",
    "prisms",
    "pyramids",
    "lines of 3 nodes",
    "triangles of 6 nodes",
    "quadrilaterals of 9 nodes",
    "tetrahedra of 10 nodes",
    "bricks of 27 nodes",
    "prisms of 18 nodes",
    "pyramids of 14 nodes",
    "points",
    "quadrilaterals of 8 nodes",
    "bricks of 20 nodes",
    "prisms of 15 nodes",
    "pyramids of 13 nodes",
];

impl AcceptedKinds {
    /// The kind with this number in the format, or a fault that names the elements.
    ///
    /// `count`: number of elements of this kind.
    pub(super) fn kind(&self, kind_number: u32, count: u64) -> Result<ElementKind, FileFault> {
        if let Some((_, kind)) =
            self.kinds_by_number.iter().find(|(other, _)| *other == kind_number)
        {
            return Ok(*kind);
        }
        let name =
            (1..).zip(KIND_NAMES).find(|(other, _)| *other == kind_number).map(|(_, name)| name);
        let elements = format!("{count} {} (type {kind_number})", name.unwrap_or("elements"));
        let remedy = self.remedies.iter().find(|(numbers, _)| numbers.contains(&kind_number));
        let remedy_text = remedy.map_or(String::new(), |(_, setting)| format!(": {setting}"));
        Err(FileFault::format(elements, format!("{}{remedy_text}", self.kinds_text)))
    }
}
