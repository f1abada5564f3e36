//! Rigid motions of a structure, which strain nothing.

use crate::error::Result;
use crate::linalg::{Partition, SparseMatrix, dot};
use crate::structure::{BaseNode, HeldBase, stiffest};

/// A part counts as at rest if it has less than this fraction of a motion's norm.
const RESTING_PART_FRACTION: f64 = 1e-8;
/// A motion depends on the others if the rest after removing them is below this fraction.
const DEPENDENT_MOTION_FRACTION: f64 = 1e-6;

/// Error for contact nodes with degrees of freedom at `n` or beyond.
pub(super) fn check_rows(contact: &[BaseNode], n: usize) -> Result<()> {
    let mut rows = contact.iter().flat_map(BaseNode::rows);
    rows.try_for_each(|row| row.check("degree of freedom of a contact node", n))
}

/// Momenta M r of the rigid motions r of every part that stiffness connects.
///
/// Motions are to the right, upwards and turning, and orthonormal in M. A motion without strain follows from
/// the motion of the contact nodes, whatever the degrees of freedom mean: K r + γ Nᵀ(N r − t) = 0, where N
/// gives the nodes' displacements and t their prescribed values.
pub(super) fn rigid_momenta(
    contact: &[BaseNode],
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
) -> Result<Vec<Vec<f64>>> {
    let n = mass.order();
    check_rows(contact, n)?;
    let count = contact.len().max(1) as f64;
    let center = [
        contact.iter().map(|node| node.x).sum::<f64>() / count,
        contact.iter().map(|node| node.y).sum::<f64>() / count,
    ];
    let held = HeldBase::new(contact, stiffness, stiffest(stiffness));
    let mut factor = held.factor()?;
    let mut rigid = held.pulls();
    rigid.extend(held.turns(contact.iter(), center));
    let mut coupled = Partition::new(n);
    coupled.couple(stiffness);
    let parts = coupled.sets();
    let mut motions: Vec<Vec<f64>> = Vec::new();
    let mut momenta: Vec<Vec<f64>> = Vec::new();
    for mut all in rigid {
        factor.solve(&mut all);
        let whole = mass.form(&all, &all).sqrt();
        for part in &parts {
            let mut motion = vec![0.0; n];
            for &i in part {
                motion[i] = all[i];
            }
            let norm = mass.form(&motion, &motion).sqrt();
            if norm.is_nan() || norm <= RESTING_PART_FRACTION * whole {
                continue;
            }
            for x in &mut motion {
                *x /= norm;
            }
            for (other, momentum) in motions.iter().zip(&momenta) {
                let share = dot(momentum, &motion);
                motion.iter_mut().zip(other).for_each(|(x, y)| *x -= share * y);
            }
            let rest = mass.form(&motion, &motion).sqrt();
            if rest > DEPENDENT_MOTION_FRACTION {
                for x in &mut motion {
                    *x /= rest;
                }
                let mut momentum = vec![0.0; n];
                mass.multiply_add(1.0, &motion, &mut momentum);
                motions.push(motion);
                momenta.push(momentum);
            }
        }
    }
    Ok(momenta)
}
