//! Horizontal cut of a finite-element model: forces of the elements above on the part below.

use crate::error::{Result, finite, require};
use crate::fem::{Direction, MatrixKind, assemble};
use crate::structure::{FemModel, SectionRows, Triplets};

/// Horizontal cut of a model.
pub(super) struct Cut<'a> {
    model: &'a FemModel,
    height: f64,
    /// Point of the moments; its y does not matter in the plane.
    reference: [f64; 2],
    /// Whether a node belongs to the part below; nodes of the cut do.
    is_below: Vec<bool>,
    /// Matrices of the elements above times −1: of displacements, velocities and accelerations.
    matrices: [Vec<Triplets>; 3],
}

impl<'a> Cut<'a> {
    /// Cut at `height` with moments about `reference`.
    ///
    /// # Errors
    /// [`Error::Input`] when a number is not finite, when no node lies at the height, when no element lies above it,
    /// or when an element crosses it.
    pub(super) fn new(model: &'a FemModel, height: f64, reference: [f64; 2]) -> Result<Self> {
        for place in reference {
            finite("reference point of the section", place)?;
        }
        finite("height of the section", height)?;
        let mesh = &model.mesh;
        let tolerance = mesh.tolerance();
        let up = mesh.up();
        let level = Level { height, tolerance, up };
        let mut positions =
            mesh.elements().map(|element| level.position(&mesh.coordinates(element.nodes())));
        let crosses = positions.clone().any(|position| position == Position::Across);
        let needed = "a height that no element crosses";
        require("height of the section", height, !crosses, needed)?;
        let cut = mesh.nodes_at_height(height, tolerance)?;
        let is_cut = !cut.is_empty() && positions.any(|position| position == Position::Above);
        let needed = "the height of a row of nodes with elements above it";
        require("height of the section", height, is_cut, needed)?;
        let mut is_below: Vec<bool> =
            mesh.nodes().iter().map(|node| node[up] <= height + tolerance).collect();
        // A rigid body that reaches down to the cut hands on the forces of the elements on all its nodes.
        if let Some(links) = &model.links {
            links.mark_bodies(&mut is_below);
        }
        let matrix_above = |kind, factor: f64| {
            let mut matrix = Triplets::new(model.numbering.dofs());
            let is_above = |points: &[[f64; 3]]| level.position(points) == Position::Above;
            assemble(mesh, &model.numbering, kind, -factor, is_above, &mut matrix);
            matrix
        };
        let matrices = [
            vec![
                matrix_above(MatrixKind::Stiffness, 1.0),
                matrix_above(MatrixKind::GeometricStiffness, 1.0),
            ],
            vec![
                matrix_above(MatrixKind::Stiffness, model.damping.stiffness()),
                matrix_above(MatrixKind::Damping, 1.0),
            ],
            vec![matrix_above(MatrixKind::Mass(model.mass_kind), 1.0)],
        ];
        Ok(Self { model, height, reference, is_below, matrices })
    }

    /// Resultant in `direction` on the part below, times `sign`.
    pub(super) fn rows(&self, direction: Direction, sign: f64) -> SectionRows {
        let model = self.model;
        let x = self.reference[0];
        let has_depth = model.mesh.has_depth();
        let point =
            if has_depth { [x, self.reference[1], self.height] } else { [x, self.height, 0.0] };
        // The work of the cut's forces on a rigid motion is their resultant.
        let mut motion = vec![0.0; model.numbering.dofs()];
        model.fill_rigid_motion(direction, point, &mut motion, |node, axis| {
            model.numbering.dof(node, axis)
        });
        let mut weights = vec![0.0; motion.len()];
        for node in (0..self.is_below.len()).filter(|&node| self.is_below[node]) {
            for &axis in model.mesh.directions() {
                if let Some(dof) = model.numbering.dof(node, axis) {
                    weights[dof] = sign * motion[dof];
                }
            }
        }
        let [of_displacement, of_velocity, of_acceleration] = &self.matrices;
        let unit = match (direction.is_rotation(), has_depth) {
            (false, false) => "N/m",
            (true, false) => "N·m/m",
            (false, true) => "N",
            (true, true) => "N·m",
        };
        SectionRows {
            unit,
            displacement: model.remaining_row(weighted_rows(&weights, of_displacement)),
            velocity: model.remaining_row(weighted_rows(&weights, of_velocity)),
            acceleration: model.remaining_row(weighted_rows(&weights, of_acceleration)),
        }
    }
}

/// Position of an element relative to a cut.
#[derive(PartialEq)]
enum Position {
    Above,
    Across,
    /// Below, or all in the cut.
    NotAbove,
}

/// Height of a cut along the axis `up` of the coordinates.
struct Level {
    height: f64,
    tolerance: f64,
    up: usize,
}

impl Level {
    /// Position of an element with nodes at these points.
    fn position(&self, points: &[[f64; 3]]) -> Position {
        let is_above = points.iter().any(|point| point[self.up] > self.height + self.tolerance);
        let is_below = points.iter().any(|point| point[self.up] < self.height - self.tolerance);
        match (is_above, is_below) {
            (true, true) => Position::Across,
            (true, false) => Position::Above,
            (false, _) => Position::NotAbove,
        }
    }
}

/// wᵀ A for the sum A of `matrices`, without zeros.
fn weighted_rows(weights: &[f64], matrices: &[Triplets]) -> Vec<(usize, f64)> {
    let mut sums = vec![0.0; weights.len()];
    for &(row, column, value) in matrices.iter().flat_map(Triplets::entries) {
        if let (Some(weight), Some(sum)) = (weights.get(row), sums.get_mut(column)) {
            *sum += weight * value;
        }
    }
    sums.into_iter().enumerate().filter(|&(_, value)| value != 0.0).collect()
}
