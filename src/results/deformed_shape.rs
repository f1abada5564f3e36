//! The visible shape of a structure: points that its degrees of freedom move, and cells between them.

use super::shape_cell::{ShapeCell, drawn_cells};
use crate::coupled::Joint;
use crate::error::{Result, at_least, finite, in_bounds, positive};
use crate::fem::Direction;
use crate::structure::{
    Base, BaseNode, DofCombination, FemModel, ShearBuilding, StoreyBuilding, Structure,
};

/// A point of a [`DeformedShape`]: its coordinates and its displacement.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShapePoint {
    /// Coordinates at rest, m: x, and the height above the surface.
    pub position: [f64; 2],
    /// Horizontal displacement (to the right).
    pub horizontal: DofCombination,
    /// Vertical displacement (up).
    pub vertical: DofCombination,
    /// In plan: coordinate y at rest, away from the reader, m.
    pub away: f64,
    /// In plan: displacement along y.
    pub across: DofCombination,
}

/// Points and cells of a structure, for pictures and for ParaView.
///
/// Make it before you pass the structure to the builder:
/// ```
/// use basemat::results::DeformedShape;
/// use basemat::structure::RigidBlock;
/// let block = RigidBlock::new(4.0, 10.0, 2000.0)?;
/// let shape = DeformedShape::of_block(&block, 10.0)?;
/// assert_eq!(shape.points()[2].position, [2.0, 10.0]);
/// // A counter-clockwise rotation by 0.01 moves the upper right corner by (−0.1, 0.02).
/// let corner_displacement = shape.displacements(&[0.0, 0.0, 0.01])?[2];
/// assert!((corner_displacement[0] + 0.1).abs() < 1e-15);
/// assert!((corner_displacement[1] - 0.02).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DeformedShape {
    points: Vec<ShapePoint>,
    /// Cells to be drawn, each as indices of points.
    cells: Vec<Vec<usize>>,
    /// Cells for ParaView.
    grid: Vec<ShapeCell>,
    /// Whether cells of three and more points are faces of elements in space, which hide the cells behind them.
    has_faces: bool,
}

impl DeformedShape {
    /// Shape from points, and cells as indices of points.
    ///
    /// A cell of 1 index is a point, 2 a line, 3 a triangle, 4 a quadrilateral (in order round it), 6 a triangle
    /// and 8 or 9 a quadrilateral with the corners first; other numbers a polygon.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) without points or for an empty cell, [`Error::Index`](crate::Error::Index)
    /// for a cell with a point that does not exist, [`Error::Input`](crate::Error::Input) for a number that is not
    /// finite.
    pub fn new(points: Vec<ShapePoint>, cells: Vec<Vec<usize>>) -> Result<Self> {
        at_least("points of a deformed shape", points.len(), 1)?;
        for point in &points {
            for value in point.position.into_iter().chain([point.away]) {
                finite("coordinate of a deformed shape", value)?;
            }
            let displacements = [&point.horizontal, &point.vertical, &point.across];
            for &(_, weight) in displacements.into_iter().flatten() {
                finite("weight of a deformed shape", weight)?;
            }
        }
        for cell in &cells {
            at_least("cell of a deformed shape", cell.len(), 1)?;
            for index in cell {
                in_bounds("point of a deformed shape's cell", *index, points.len())?;
            }
        }
        let grid = cells.iter().cloned().map(ShapeCell::flat).collect();
        Ok(Self { points, cells, grid, has_faces: false })
    }

    /// Nodes and elements of a finite-element model.
    ///
    /// Heights are measured from the nodes of the base, in a trench from the surface. In space solids are drawn by
    /// their outer sides; files for ParaView have all elements, in the order of the mesh.
    pub fn of_model(model: &FemModel) -> Self {
        let mesh = model.mesh();
        let up_direction = if mesh.has_depth() { Direction::Z } else { Direction::Y };
        let surface = model.surface_height();
        let mut points = Vec::with_capacity(mesh.nodes().len());
        for (node, &[x, y, z]) in mesh.nodes().iter().enumerate() {
            // A follower of a rigid link moves with its leader; a node without degrees of freedom does not move.
            let [x_displacement, y_displacement, upward_displacement] =
                [Direction::X, Direction::Y, up_direction]
                    .map(|direction| model.row(node, direction).unwrap_or_default());
            points.push(if mesh.has_depth() {
                ShapePoint::in_space(
                    [x, y, z - surface],
                    [x_displacement, y_displacement, upward_displacement],
                )
            } else {
                ShapePoint::in_plane([x, y - surface], x_displacement, upward_displacement)
            });
        }
        Self {
            points,
            cells: drawn_cells(mesh),
            grid: ShapeCell::of_elements(mesh),
            has_faces: mesh.has_depth(),
        }
    }

    /// Shape of a rigid block in the plane, or of rigid bodies in plan.
    ///
    /// A block is a rectangle of this height (m), a body in plan a prism on each face of its base. Other
    /// structures are drawn as if their base carried such a body.
    ///
    /// ```
    /// use basemat::results::DeformedShape;
    /// use basemat::structure::RigidBody;
    /// let body = RigidBody::cuboid([8.0, 6.0, 10.0], 2400.0)?;
    /// let shape = DeformedShape::of_block(&body, 10.0)?;
    /// let top = shape.points()[6].clone();
    /// assert_eq!((top.position, top.away), ([4.0, 10.0], 3.0));
    /// // A rotation by 0.01 about x moves this point to the front and up.
    /// let [_, up, along_y] = shape.displacements(&[0.0, 0.0, 0.0, 0.01, 0.0, 0.0])?[6];
    /// assert!((along_y + 0.1).abs() < 1e-14 && (up - 0.03).abs() < 1e-14);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the height is positive; as for [`DofCombination::of_base`].
    pub fn of_block(block: &dyn Structure, height: f64) -> Result<Self> {
        positive("height of the rectangle", height)?;
        // The result is not needed: the call checks the base.
        DofCombination::of_base(block, [0.0, 0.0, height])?;
        let mut points = Vec::new();
        let mut cells = Vec::new();
        match block.base() {
            Base::Faces(faces) => {
                for face in faces {
                    add_prism(&mut points, &mut cells, &face, height);
                }
            }
            Base::Lines(lines) => {
                let nodes = lines.concat();
                if let [first_node, .., last_node] = &nodes[..] {
                    let center_x = 0.5 * (first_node.x + last_node.x);
                    let lowest_z =
                        nodes.iter().fold(0.0_f64, |lowest_z, node| lowest_z.min(node.z));
                    let corners = [
                        (first_node.x, 0.0),
                        (last_node.x, 0.0),
                        (last_node.x, height),
                        (first_node.x, height),
                    ];
                    for (x, corner_height) in corners {
                        let [horizontal, _, vertical] =
                            DofCombination::of_base(block, [x - center_x, 0.0, corner_height])?;
                        let position = [x, lowest_z + corner_height];
                        points.push(ShapePoint::in_plane(position, horizontal, vertical));
                    }
                    cells.push(vec![0, 1, 2, 3]);
                }
            }
        }
        Self::new(points, cells)
    }

    /// Mat, floors and columns of a building in plan.
    ///
    /// Floors have the outline of the mat, and tilt with it.
    ///
    /// # Errors
    /// None for a valid building.
    pub fn of_storeys(building: &StoreyBuilding) -> Result<Self> {
        let center = building.center();
        let base_nodes = building.base().into_nodes();
        let mut points: Vec<ShapePoint> = base_nodes.iter().map(point_at).collect();
        let mut cells = Vec::new();
        add_outline(&mut cells, 0, base_nodes.len());
        let mut height = 0.0;
        for (storey, storey_height) in building.heights().enumerate() {
            height += storey_height;
            let first_point = points.len();
            for corner in &base_nodes {
                let floor_position = [corner.x - center[0], corner.y - center[1]];
                let [x_displacement, y_displacement, _] = building.floor(storey, floor_position)?;
                let displacements = [x_displacement, y_displacement, corner.vertical.clone()];
                points.push(ShapePoint::in_space([corner.x, corner.y, height], displacements));
            }
            add_outline(&mut cells, first_point, base_nodes.len());
            add_columns(&mut cells, first_point - base_nodes.len(), base_nodes.len());
        }
        Self::new(points, cells)
    }

    /// Floors and columns of a shear building.
    ///
    /// # Errors
    /// None for a valid building.
    pub fn of_building(building: &ShearBuilding) -> Result<Self> {
        let base_nodes = building.base().into_nodes();
        let mut points = Vec::new();
        let mut cells = Vec::new();
        let mut height = 0.0;
        for level in 0..=building.storeys().len() {
            for base_node in &base_nodes {
                let horizontal = match level.checked_sub(1) {
                    None => base_node.horizontal.clone(),
                    Some(storey) => building.floor(storey)?.into(),
                };
                let vertical = base_node.vertical.clone();
                points.push(ShapePoint::in_plane([base_node.x, height], horizontal, vertical));
            }
            let first_point = 2 * level;
            cells.push(vec![first_point, first_point + 1]);
            if let Some(storey) = building.storeys().get(level) {
                height += storey.height;
                cells.push(vec![first_point, first_point + 2]);
                cells.push(vec![first_point + 1, first_point + 3]);
            }
        }
        Self::new(points, cells)
    }

    /// Lowers all points by a `depth` (m), for a structure in [`WithWalls`](crate::structure::WithWalls).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a depth that is not finite.
    pub fn lowered(mut self, depth: f64) -> Result<Self> {
        finite("depth of a deformed shape", depth)?;
        for point in &mut self.points {
            point.position[1] -= depth;
        }
        Ok(self)
    }

    /// Adds both sides of a joint, each as lines between its nodes.
    ///
    /// The joint is one of the structure of this shape. A gap, an opening or a slip shows as a distance between both sides.
    #[must_use]
    pub fn with_joint(mut self, joint: &Joint) -> Self {
        for side in joint.line().sides() {
            let first_point = self.points.len();
            for node in side {
                let horizontal = node.horizontal.clone();
                let vertical = node.vertical.clone();
                self.points.push(ShapePoint::in_plane([node.x, node.z], horizontal, vertical));
            }
            for end in first_point + 1..self.points.len() {
                self.cells.push(vec![end - 1, end]);
                self.grid.push(ShapeCell::flat(vec![end - 1, end]));
            }
        }
        self
    }

    /// The points.
    pub fn points(&self) -> &[ShapePoint] {
        &self.points
    }

    /// The cells.
    pub fn cells(&self) -> &[Vec<usize>] {
        &self.cells
    }

    /// Cells for ParaView: for a model its elements, in the order of the mesh.
    #[cfg(feature = "io")]
    pub(crate) fn grid(&self) -> &[ShapeCell] {
        &self.grid
    }

    /// Whether cells of three and more points hide the cells behind them.
    #[cfg(feature = "plot")]
    pub(crate) fn has_faces(&self) -> bool {
        self.has_faces
    }

    /// Axis that points up: y (1) in the plane, z (2) if the shape moves along y too.
    pub(crate) fn up(&self) -> usize {
        1 + usize::from(self.points.iter().any(|point| !point.across.is_empty()))
    }

    /// Displacement of every point: [horizontal, up, along y].
    ///
    /// `dofs`: values of the degrees of freedom, or their rates; the result is in m, or m/s. In the plane nothing
    /// moves along y.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) if a degree of freedom of a point is missing in `dofs`.
    pub fn displacements(&self, dofs: &[f64]) -> Result<Vec<[f64; 3]>> {
        let mut displacements = Vec::with_capacity(self.points.len());
        for point in &self.points {
            displacements.push([
                weighted_sum(&point.horizontal, dofs)?,
                weighted_sum(&point.vertical, dofs)?,
                weighted_sum(&point.across, dofs)?,
            ]);
        }
        Ok(displacements)
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

/// Value of a combination of degrees of freedom.
fn weighted_sum(combination: &DofCombination, dofs: &[f64]) -> Result<f64> {
    let mut sum = 0.0;
    for &(index, weight) in combination {
        in_bounds("degree of freedom of a deformed shape", index, dofs.len())?;
        sum += weight * dofs[index];
    }
    Ok(sum)
}

impl ShapePoint {
    /// Point at (x, height), moved horizontally and vertically.
    fn in_plane(position: [f64; 2], horizontal: DofCombination, vertical: DofCombination) -> Self {
        Self { position, horizontal, vertical, ..Self::default() }
    }

    /// Point at (x, y, height), moved along x, along y and up.
    fn in_space(
        [x, away, height]: [f64; 3],
        [horizontal, across, vertical]: [DofCombination; 3],
    ) -> Self {
        Self { position: [x, height], horizontal, vertical, away, across }
    }

    /// Coordinates at rest (x, height, y), m.
    pub(crate) fn place(&self) -> [f64; 3] {
        [self.position[0], self.position[1], self.away]
    }
}

/// Point of the shape at a node of the base.
fn point_at(node: &BaseNode) -> ShapePoint {
    let displacements = [&node.horizontal, &node.across, &node.vertical].map(DofCombination::clone);
    ShapePoint::in_space([node.x, node.y, 0.0], displacements)
}

/// Adds a prism of this height on a face of the base.
fn add_prism(
    points: &mut Vec<ShapePoint>,
    cells: &mut Vec<Vec<usize>>,
    face: &[BaseNode],
    height: f64,
) {
    let first_point = points.len();
    let node_count = face.len();
    points.extend(face.iter().map(point_at));
    for node in face {
        let displacements = BaseNode::rigid_displacements(face, node.place(), height);
        points.push(ShapePoint::in_space([node.x, node.y, height], displacements));
    }
    add_outline(cells, first_point, node_count);
    add_outline(cells, first_point + node_count, node_count);
    add_columns(cells, first_point, node_count);
}

/// Adds a polygon of points from `first_point` on; single lines if a cell of this many points would be curved.
fn add_outline(cells: &mut Vec<Vec<usize>>, first_point: usize, point_count: usize) {
    if matches!(point_count, 6 | 8 | 9) {
        cells.extend(
            (0..point_count).map(|k| vec![first_point + k, first_point + (k + 1) % point_count]),
        );
    } else {
        cells.push((first_point..first_point + point_count).collect());
    }
}

/// Largest number of columns drawn between two floors: more lines would hide each other.
const MAX_COLUMNS: usize = 8;

/// Adds lines from points of one polygon to the points of the next, at most [`MAX_COLUMNS`].
fn add_columns(cells: &mut Vec<Vec<usize>>, first_point: usize, point_count: usize) {
    let columns = (0..point_count).step_by(point_count.div_ceil(MAX_COLUMNS).max(1));
    cells.extend(columns.map(|k| vec![first_point + k, first_point + point_count + k]));
}
