//! Views of a structure: projection of its points, and the order of cells that hide each other.

use crate::results::DeformedShape;

const COS_30_DEGREES: f64 = 0.866_025_403_784_438_6;
const SIN_30_DEGREES: f64 = 0.5;

/// Directions from which a structure is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StructureView {
    /// View along y: x to the right, height up.
    AlongY,
    /// View against x: y to the right, height up.
    AgainstX,
    /// Isometric view from the front, the right and above.
    ///
    /// Towards the right, x falls and y rises by 30 degrees, all at one scale.
    Slanted,
}

impl StructureView {
    /// Elevations of a structure whose axis `up` points up: one for each axis of the surface.
    pub(super) fn elevations(up: usize) -> &'static [Self] {
        &[Self::AlongY, Self::AgainstX][..up]
    }

    /// The single view that shows all axes of a structure whose axis `up` points up.
    pub(super) fn overview(up: usize) -> Self {
        [Self::AlongY, Self::Slanted][up - 1]
    }

    /// Projection of a point (x, height, y), m: to the right and up in the picture.
    pub(super) fn project(self, [x, up, y]: [f64; 3]) -> [f64; 2] {
        match self {
            Self::AlongY => [x, up],
            Self::AgainstX => [y, up],
            Self::Slanted => [(x + y) * COS_30_DEGREES, up + (y - x) * SIN_30_DEGREES],
        }
    }

    /// Projections of points (x, height, y), m.
    pub(super) fn project_all(self, points: &[[f64; 3]]) -> Vec<[f64; 2]> {
        points.iter().map(|point| self.project(*point)).collect()
    }

    /// Distance of a point (x, height, y) from the origin towards the viewer.
    fn nearness(self, [x, up, y]: [f64; 3]) -> f64 {
        match self {
            Self::AlongY => -y,
            Self::AgainstX => x,
            Self::Slanted => x - y + up,
        }
    }

    /// Cells of a shape, the farthest from the viewer first: each cell hides the cells before it.
    ///
    /// Distances are means of the corners at rest. A shape without faces keeps its order.
    pub(super) fn far_to_near(self, shape: &DeformedShape) -> Vec<&[usize]> {
        let cells = shape.cells().iter().map(|cell| DeformedShape::corners(cell));
        let mut cells: Vec<&[usize]> = cells.collect();
        if shape.has_faces() {
            cells.sort_by(|a, b| {
                self.mean_nearness(shape, a).total_cmp(&self.mean_nearness(shape, b))
            });
        }
        cells
    }

    /// Mean distance of the corners of a cell, at rest, towards the viewer.
    fn mean_nearness(self, shape: &DeformedShape, cell: &[usize]) -> f64 {
        let distances = cell.iter().map(|&corner| self.nearness(shape.points()[corner].place()));
        distances.sum::<f64>() / cell.len() as f64
    }
}
