//! Horizontal cut of a finite-element model: forces of the elements above on the part below.

use crate::error::{Error, Result, finite};
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
        let (tolerance, up) = (mesh.tolerance(), mesh.up());
        let sides = |points: &[[f64; 3]]| {
            let above = points.iter().any(|point| point[up] > height + tolerance);
            let below = points.iter().any(|point| point[up] < height - tolerance);
            (above, below)
        };
        let is_above = |points: &[[f64; 3]]| sides(points) == (true, false);
        let fault =
            |needed| Error::Input { quantity: "height of the section", value: height, needed };
        let mut all = mesh.elements().map(|element| sides(&mesh.coordinates(element.nodes())));
        if all.clone().any(|side| side == (true, true)) {
            return Err(fault("a height that no element crosses"));
        }
        let cut = mesh.nodes_at_height(height, tolerance)?;
        if cut.is_empty() || !all.any(|side| side == (true, false)) {
            return Err(fault("the height of a row of nodes with elements above it"));
        }
        let mut is_below: Vec<bool> =
            mesh.nodes().iter().map(|node| node[up] <= height + tolerance).collect();
        // A rigid body that reaches down to the cut hands on the forces of the elements on all its nodes.
        if let Some(links) = &model.links {
            links.mark_bodies(&mut is_below);
        }
        let sum = |quantity, factor: f64| {
            let mut matrix = Triplets::new(model.numbering.dofs());
            assemble(mesh, &model.numbering, quantity, -factor, is_above, &mut matrix);
            matrix
        };
        let matrices = [
            vec![sum(MatrixKind::Stiffness, 1.0), sum(MatrixKind::GeometricStiffness, 1.0)],
            vec![
                sum(MatrixKind::Stiffness, model.damping.stiffness()),
                sum(MatrixKind::Damping, 1.0),
            ],
            vec![sum(MatrixKind::Mass(model.mass_kind), 1.0)],
        ];
        Ok(Self { model, height, reference, is_below, matrices })
    }

    /// Resultant in `direction` on the part below, times `sign`.
    pub(super) fn rows(&self, direction: Direction, sign: f64) -> SectionRows {
        let (model, [x, y]) = (self.model, self.reference);
        let number = |node, own| model.numbering.dof(node, own);
        let has_depth = model.mesh.has_depth();
        let point = if has_depth { [x, y, self.height] } else { [x, self.height, 0.0] };
        // The work of the cut's forces on a rigid motion is their resultant.
        let mut motion = vec![0.0; model.numbering.dofs()];
        model.fill_rigid_motion(direction, point, &mut motion, number);
        let mut weights = vec![0.0; motion.len()];
        for node in (0..self.is_below.len()).filter(|&node| self.is_below[node]) {
            for dof in model.mesh.directions().iter().filter_map(|&own| number(node, own)) {
                weights[dof] = sign * motion[dof];
            }
        }
        let [displacement, velocity, acceleration] = [0, 1, 2]
            .map(|order| model.remaining_row(weighted_rows(&weights, &self.matrices[order])));
        let unit = match (direction.is_rotation(), has_depth) {
            (false, false) => "N/m",
            (true, false) => "N·m/m",
            (false, true) => "N",
            (true, true) => "N·m",
        };
        SectionRows { unit, displacement, velocity, acceleration }
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
