//! Rigid motions of a structure, which cause no strain.

use crate::error::Result;
use crate::linalg::{Partition, SparseMatrix, dot};
use crate::structure::{BaseNode, SpringSupportedBase, max_diagonal_stiffness};

/// Fraction of a motion's norm below which a part counts as at rest.
const RESTING_PART_FRACTION: f64 = 1e-8;
/// A motion is linearly dependent if its norm after orthogonalisation is below this fraction.
const DEPENDENT_MOTION_FRACTION: f64 = 1e-6;

/// Returns an error for contact nodes with degrees of freedom of at least `n`.
pub(super) fn check_rows(contact_nodes: &[BaseNode], n: usize) -> Result<()> {
    let mut rows = contact_nodes.iter().flat_map(BaseNode::rows);
    rows.try_for_each(|row| row.check("degree of freedom of a contact node", n))
}

/// Momenta M r of the rigid motions r of every part that stiffness connects.
///
/// The motions are translations and rotations, orthonormal with respect to M. A motion without strain follows from the
/// motion of the contact nodes, whatever the degrees of freedom mean: K r + γ Nᵀ(N r − t) = 0, where N gives the nodes'
/// displacements and t their prescribed values.
pub(super) fn rigid_momenta(
    contact_nodes: &[BaseNode],
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
) -> Result<Vec<Vec<f64>>> {
    let n = mass.order();
    check_rows(contact_nodes, n)?;
    let node_count = contact_nodes.len().max(1) as f64;
    let center = [
        contact_nodes.iter().map(|node| node.x).sum::<f64>() / node_count,
        contact_nodes.iter().map(|node| node.y).sum::<f64>() / node_count,
    ];
    let supported_base =
        SpringSupportedBase::new(contact_nodes, stiffness, max_diagonal_stiffness(stiffness));
    let mut factor = supported_base.factor()?;
    let mut base_forces = supported_base.translation_forces();
    base_forces.extend(supported_base.rotation_forces(contact_nodes.iter(), center));
    let mut coupled_parts = Partition::new(n);
    coupled_parts.couple(stiffness);
    let parts = coupled_parts.sets();
    let mut rigid_motions = OrthonormalMotions::default();
    for mut whole_motion in base_forces {
        factor.solve(&mut whole_motion);
        let whole_norm = mass.form(&whole_motion, &whole_motion).sqrt();
        for part in &parts {
            let mut part_motion = vec![0.0; n];
            for &dof in part {
                part_motion[dof] = whole_motion[dof];
            }
            let part_norm = mass.form(&part_motion, &part_motion).sqrt();
            if part_norm.is_nan() || part_norm <= RESTING_PART_FRACTION * whole_norm {
                continue;
            }
            for displacement in &mut part_motion {
                *displacement /= part_norm;
            }
            rigid_motions.add(part_motion, mass);
        }
    }
    Ok(rigid_motions.momenta)
}

/// Motions that are orthonormal with respect to a mass matrix, and their momenta.
#[derive(Default)]
struct OrthonormalMotions {
    motions: Vec<Vec<f64>>,
    momenta: Vec<Vec<f64>>,
}

impl OrthonormalMotions {
    /// Adds the part of a normalised motion that is orthogonal to the others, unless it is negligible.
    fn add(&mut self, mut motion: Vec<f64>, mass: &SparseMatrix) {
        for (other_motion, momentum) in self.motions.iter().zip(&self.momenta) {
            let coefficient = dot(momentum, &motion);
            motion.iter_mut().zip(other_motion).for_each(|(x, y)| *x -= coefficient * y);
        }
        let orthogonal_norm = mass.form(&motion, &motion).sqrt();
        if orthogonal_norm > DEPENDENT_MOTION_FRACTION {
            for displacement in &mut motion {
                *displacement /= orthogonal_norm;
            }
            let mut momentum = vec![0.0; motion.len()];
            mass.multiply_add(1.0, &motion, &mut momentum);
            self.motions.push(motion);
            self.momenta.push(momentum);
        }
    }
}
