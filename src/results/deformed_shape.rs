//! The visible shape of a structure: points that its degrees of freedom move, and cells between them.

use crate::error::{Error, Result, finite, positive};
use crate::fem::Direction;
use crate::structure::{DofCombination, FemModel, RigidBlock, ShearBuilding, Structure};

/// A point of a [`DeformedShape`]: its place, and its displacement as weighted sums of degrees of freedom.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapePoint {
    /// Coordinates [x, y] at rest, m.
    pub position: [f64; 2],
    /// Horizontal displacement (to the right).
    pub horizontal: DofCombination,
    /// Vertical displacement (up).
    pub vertical: DofCombination,
}

/// Points and cells of a structure, for pictures and for ParaView.
///
/// Made before the structure goes into the builder:
/// ```
/// use basemat::results::DeformedShape;
/// use basemat::structure::RigidBlock;
/// let block = RigidBlock::new(4.0, 10.0, 2000.0)?;
/// let shape = DeformedShape::of_block(&block, 10.0)?;
/// assert_eq!(shape.points()[2].position, [2.0, 10.0]);
/// // A turn by 0.01 to the left moves the upper right corner by (−0.1, 0.02).
/// let moved = shape.displacements(&[0.0, 0.0, 0.01])?;
/// assert!((moved[2][0] + 0.1).abs() < 1e-15 && (moved[2][1] - 0.02).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DeformedShape {
    points: Vec<ShapePoint>,
    cells: Vec<Vec<usize>>,
}

impl DeformedShape {
    /// Points, and cells as indices of points: 1 a point, 2 a line, 3 a triangle, 4 a quadrilateral
    /// (all the way round); 6 a triangle, 8 or 9 a quadrilateral with its corners first; other
    /// numbers a polygon.
    ///
    /// # Errors
    /// [`Error::Size`] without points or for an empty cell, [`Error::Index`] for a cell with a point
    /// that does not exist, [`Error::Input`] for a number that is not finite.
    pub fn new(points: Vec<ShapePoint>, cells: Vec<Vec<usize>>) -> Result<Self> {
        if points.is_empty() {
            return Err(Error::Size {
                quantity: "points of a deformed shape",
                found: 0,
                needed: 1,
            });
        }
        for point in &points {
            for value in point.position {
                finite("coordinate of a deformed shape", value)?;
            }
            for &(_, weight) in point.horizontal.iter().chain(point.vertical.iter()) {
                finite("weight of a deformed shape", weight)?;
            }
        }
        for cell in &cells {
            if cell.is_empty() {
                return Err(Error::Size {
                    quantity: "cell of a deformed shape",
                    found: 0,
                    needed: 1,
                });
            }
            if let Some(&index) = cell.iter().find(|&&index| index >= points.len()) {
                let quantity = "point of a deformed shape's cell";
                return Err(Error::Index { quantity, index, bound: points.len() });
            }
        }
        Ok(Self { points, cells })
    }

    /// Nodes and elements of a finite-element model.
    pub fn of_model(model: &FemModel) -> Self {
        // Of a follower of a rigid link, what it follows; a node without degrees of freedom stays.
        let row = |node, direction| model.row(node, direction).unwrap_or_default();
        let point = |(node, position): (usize, &[f64; 2])| ShapePoint {
            position: *position,
            horizontal: row(node, Direction::X),
            vertical: row(node, Direction::Y),
        };
        let elements = model.mesh().elements();
        Self {
            points: model.mesh().nodes().iter().enumerate().map(point).collect(),
            cells: elements.map(|element| element.nodes().to_vec()).collect(),
        }
    }

    /// A rigid block as a rectangle of this height (m).
    ///
    /// # Errors
    /// [`Error::Input`] unless the height is positive.
    pub fn of_block(block: &RigidBlock, height: f64) -> Result<Self> {
        positive("height of the rectangle", height)?;
        let base = block.contact_nodes();
        let corner = |x: f64, y: f64| ShapePoint {
            position: [x, y],
            horizontal: block.horizontal_at(y),
            vertical: block.vertical_at(x),
        };
        let ends = [base[0].x, base[base.len() - 1].x];
        let [left, right] = ends;
        let points = vec![
            corner(left, 0.0),
            corner(right, 0.0),
            corner(right, height),
            corner(left, height),
        ];
        Ok(Self { points, cells: vec![vec![0, 1, 2, 3]] })
    }

    /// Floors and columns of a shear building.
    ///
    /// # Errors
    /// None that a valid building gives.
    pub fn of_building(building: &ShearBuilding) -> Result<Self> {
        let base = building.contact_nodes();
        let (mut points, mut cells) = (Vec::new(), Vec::new());
        let mut height = 0.0;
        for level in 0..=building.storeys().len() {
            for end in &base {
                let horizontal = match level.checked_sub(1) {
                    None => end.horizontal.clone(),
                    Some(storey) => building.floor(storey)?.into(),
                };
                let vertical = end.vertical.clone();
                points.push(ShapePoint { position: [end.x, height], horizontal, vertical });
            }
            let first = 2 * level;
            cells.push(vec![first, first + 1]);
            if let Some(storey) = building.storeys().get(level) {
                height += storey.height;
                cells.push(vec![first, first + 2]);
                cells.push(vec![first + 1, first + 3]);
            }
        }
        Self::new(points, cells)
    }

    /// The points.
    pub fn points(&self) -> &[ShapePoint] {
        &self.points
    }

    /// The cells.
    pub fn cells(&self) -> &[Vec<usize>] {
        &self.cells
    }

    /// [horizontal, up] of every point (m, or m/s) for these degrees of freedom (or their rates).
    ///
    /// # Errors
    /// [`Error::Index`] if a point is moved by a degree of freedom that is not there.
    pub fn displacements(&self, dofs: &[f64]) -> Result<Vec<[f64; 2]>> {
        let sum = |row: &DofCombination| {
            row.iter().try_fold(0.0, |sum, &(index, weight)| {
                let value = dofs.get(index).ok_or(Error::Index {
                    quantity: "degree of freedom of a deformed shape",
                    index,
                    bound: dofs.len(),
                })?;
                Ok::<f64, Error>(sum + weight * value)
            })
        };
        self.points
            .iter()
            .map(|point| Ok([sum(&point.horizontal)?, sum(&point.vertical)?]))
            .collect()
    }

    /// Corners of a cell, in order round it.
    #[cfg(feature = "plot")]
    pub(crate) fn corners(cell: &[usize]) -> &[usize] {
        match cell.len() {
            6 => &cell[..3],
            8 | 9 => &cell[..4],
            _ => cell,
        }
    }
}
