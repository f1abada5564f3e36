//! Horizontal section of a finite-element model: forces of the elements above on the part below.

use crate::error::{Error, Result, finite, require};
use crate::fem::{Direction, MatrixKind, Mesh, assemble};
use crate::structure::{FemModel, SectionRows, Triplets};

/// Horizontal section of a model, from which its resultants are computed.
pub(super) struct SectionCut<'a> {
    model: &'a FemModel,
    /// Height of the section, m.
    height: f64,
    /// Reference point [x, y] of the moments, m; y is unused in the plane.
    reference: [f64; 2],
    /// Whether each node belongs to the part below, which includes the nodes at the height of the section.
    is_below: Vec<bool>,
    /// Stiffness matrices of the elements above, times −1; resultants use their sum.
    stiffness: Vec<Triplets>,
    /// Damping matrices of the elements above, times −1; resultants use their sum.
    damping: Vec<Triplets>,
    /// Mass matrix of the elements above, times −1.
    mass: Vec<Triplets>,
}

impl<'a> SectionCut<'a> {
    /// Section at `height` (m) with moments about `reference`.
    ///
    /// # Errors
    /// [`Error::Input`] when a number is not finite, when no node lies at the height, when no element lies above it,
    /// or when an element crosses it; [`Error::Part`] when an element above it has internal variables.
    pub(super) fn new(model: &'a FemModel, height: f64, reference: [f64; 2]) -> Result<Self> {
        for coordinate in reference {
            finite("reference point of the section", coordinate)?;
        }
        finite("height of the section", height)?;
        let mesh = &model.mesh;
        let tolerance = mesh.height_tolerance();
        let up_axis = mesh.up_axis();
        let level = SectionLevel { height, tolerance, up_axis };
        let mut positions =
            mesh.elements().map(|element| level.position(&mesh.coordinates(element.nodes())));
        let is_crossed = positions.clone().any(|position| position == ElementPosition::Across);
        let needed = "a height that no element crosses";
        require("height of the section", height, !is_crossed, needed)?;
        let section_nodes = mesh.nodes_at_height(height, tolerance)?;
        let has_part_above = positions.any(|position| position == ElementPosition::Above);
        let needed = "the height of a row of nodes with elements above it";
        let divides_model = !section_nodes.is_empty() && has_part_above;
        require("height of the section", height, divides_model, needed)?;
        check_no_internal_variables_above(mesh, &level)?;
        let mut is_below: Vec<bool> =
            mesh.nodes().iter().map(|node| node[up_axis] <= height + tolerance).collect();
        // A rigid body with a node below transfers the element forces on all its nodes to the part below.
        if let Some(links) = &model.links {
            links.mark_bodies(&mut is_below);
        }
        let matrix_above = |kind, factor: f64| {
            let mut matrix = Triplets::new(model.numbering.dofs());
            let is_above = |points: &[[f64; 3]]| level.position(points) == ElementPosition::Above;
            assemble(mesh, &model.numbering, kind, -factor, is_above, &mut matrix);
            matrix
        };
        let stiffness = vec![
            matrix_above(MatrixKind::Stiffness, 1.0),
            matrix_above(MatrixKind::GeometricStiffness, 1.0),
        ];
        let damping = vec![
            matrix_above(MatrixKind::DampedStiffness, model.damping.stiffness()),
            matrix_above(MatrixKind::Damping, 1.0),
        ];
        let mass = vec![matrix_above(MatrixKind::Mass(model.mass_kind), 1.0)];
        Ok(Self { model, height, reference, is_below, stiffness, damping, mass })
    }

    /// Rows of the resultant in `direction` on the part below, times `sign`.
    ///
    /// The resultant is the sum of their products with displacement, velocity and acceleration.
    pub(super) fn rows(&self, direction: Direction, sign: f64) -> SectionRows {
        let model = self.model;
        let x = self.reference[0];
        let is_in_space = model.mesh.has_depth();
        let point =
            if is_in_space { [x, self.reference[1], self.height] } else { [x, self.height, 0.0] };
        // The work of the section's forces on a unit rigid motion is their resultant.
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
        let unit = match (direction.is_rotation(), is_in_space) {
            (false, false) => "N/m",
            (true, false) => "N·m/m",
            (false, true) => "N",
            (true, true) => "N·m",
        };
        SectionRows {
            unit,
            displacement: model.remaining_row(weighted_row_sum(&weights, &self.stiffness)),
            velocity: model.remaining_row(weighted_row_sum(&weights, &self.damping)),
            acceleration: model.remaining_row(weighted_row_sum(&weights, &self.mass)),
        }
    }
}

/// Returns an error if an element with internal variables lies above the section.
fn check_no_internal_variables_above(mesh: &Mesh, level: &SectionLevel) -> Result<()> {
    let mut elements = mesh.elements().enumerate();
    let inelastic_element = elements.find(|(_, element)| {
        element.inelastic().is_some()
            && level.position(&mesh.coordinates(element.nodes())) == ElementPosition::Above
    });
    let Some((index, _)) = inelastic_element else { return Ok(()) };
    let reason = format!(
        "element {index} above it has internal variables: its force is no weighted sum of displacements"
    );
    Err(Error::part(format!("section at height {} m", level.height), reason))
}

/// Position of an element relative to a section.
#[derive(PartialEq)]
enum ElementPosition {
    Above,
    Across,
    /// Below the section, or with all nodes in it.
    NotAbove,
}

/// Height of a section along the coordinate `up_axis`, with the tolerance within which a node lies at it.
struct SectionLevel {
    height: f64,
    tolerance: f64,
    up_axis: usize,
}

impl SectionLevel {
    /// Position of an element with nodes at these points.
    fn position(&self, points: &[[f64; 3]]) -> ElementPosition {
        let has_node_above =
            points.iter().any(|point| point[self.up_axis] > self.height + self.tolerance);
        let has_node_below =
            points.iter().any(|point| point[self.up_axis] < self.height - self.tolerance);
        match (has_node_above, has_node_below) {
            (true, true) => ElementPosition::Across,
            (true, false) => ElementPosition::Above,
            (false, _) => ElementPosition::NotAbove,
        }
    }
}

/// Nonzero entries of wᵀ A, with the `weights` w and the sum A of `matrices`.
fn weighted_row_sum(weights: &[f64], matrices: &[Triplets]) -> Vec<(usize, f64)> {
    let mut sums = vec![0.0; weights.len()];
    for &(row, column, value) in matrices.iter().flat_map(Triplets::entries) {
        if let (Some(weight), Some(sum)) = (weights.get(row), sums.get_mut(column)) {
            *sum += weight * value;
        }
    }
    sums.into_iter().enumerate().filter(|&(_, value)| value != 0.0).collect()
}
