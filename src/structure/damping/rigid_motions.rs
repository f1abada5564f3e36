//! The motions of a structure that strain nothing.

use crate::error::Result;
use crate::linalg::{Partition, SparseMatrix, dot};
use crate::structure::{ContactNode, HeldBase, stiffest};

/// A part of a rigid motion with less of its momentum than this is rounding.
const NOTHING: f64 = 1e-8;
/// Remainder of a rigid motion beside the others, if it depends on them.
const DEPENDENT: f64 = 1e-6;

/// Momenta M r of the rigid motions r, with r·M r = 1 and all others zero: to the right, upwards and
/// turning, of every part of the structure that its stiffness connects.
///
/// A motion that strains nothing follows from that of the contact nodes, whatever the degrees of freedom
/// mean: K r + γ Nᵀ(N r − t) = 0, where N gives the nodes' displacements and t their prescribed values.
pub(super) fn rigid_momenta(
    contact: &[ContactNode],
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
) -> Result<Vec<Vec<f64>>> {
    let n = mass.order();
    for node in contact {
        node.horizontal.check("unknown of a contact node", n)?;
        node.vertical.check("unknown of a contact node", n)?;
    }
    let center = contact.iter().map(|node| node.x).sum::<f64>() / contact.len().max(1) as f64;
    let held = HeldBase::new(contact, stiffness, stiffest(stiffness));
    let mut factor = held.factor()?;
    let [right, up] = held.pulls();
    let mut coupled = Partition::new(n);
    coupled.couple(stiffness);
    let parts = coupled.sets();
    let (mut motions, mut momenta): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    for mut all in [right, up, held.turn(contact, center)] {
        factor.solve(&mut all);
        let whole = mass.form(&all, &all).sqrt();
        for part in &parts {
            let mut motion = vec![0.0; n];
            for &i in part {
                motion[i] = all[i];
            }
            let norm = mass.form(&motion, &motion).sqrt();
            if norm.is_nan() || norm <= NOTHING * whole {
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
            if rest > DEPENDENT {
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
