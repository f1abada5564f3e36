//! GOAL: a structure of one's own, linear and nonlinear, and one that wraps another.
//! SCENE: a mass on a hardening spring on a rigid base; a wrapped block.
//! REFERENCE: the linear limit; the block itself; one commit per accepted step.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::Simulation;
use basemat::interface::Coulomb;
use basemat::structure::{Base, BaseNode, NonlinearForce, Structure, Triplets};

use super::scene::{assert_same_motion, run, shaken};
use basemat_problems::block_on_springs::{bed, block};
use basemat_problems::own_force;
use basemat_problems::wrapped::Bare;

/// A mass on a hardening spring on a rigid base: force k d + 4 d³ · k per m².
pub(crate) struct Hardening {
    pub(crate) cubic: f64,
    pub(crate) commits: Arc<AtomicUsize>,
}

pub(crate) const SPRING: f64 = 4.0e6;

/// Drift: displacement of the mass, minus the displacement of the base, plus height × rotation.
const DRIFT: [(usize, f64); 3] = [(3, 1.0), (0, -1.0), (2, 3.0)];

impl Hardening {
    fn drift(displacement: &[f64]) -> f64 {
        DRIFT.iter().map(|&(index, weight)| weight * displacement[index]).sum()
    }
}

impl Structure for Hardening {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        for (unknown, mass) in [1.0e4, 3.0e4, 8.0e4, 2.0e4].into_iter().enumerate() {
            matrix.add(unknown, unknown, mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer(DRIFT, SPRING);
        Ok(())
    }

    own_force!();
}

impl NonlinearForce for Hardening {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        let f = self.cubic * Self::drift(displacement).powi(3);
        for (index, weight) in DRIFT {
            force[index] += weight * f;
        }
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer(DRIFT, 3.0 * self.cubic * Self::drift(displacement).powi(2));
        Ok(())
    }

    fn commit(&mut self, displacement: &[f64]) {
        assert_eq!(displacement.len(), 4);
        self.commits.fetch_add(1, Ordering::Relaxed);
    }
}

#[test]
fn own_structure_linear_and_nonlinear() {
    let commits = Arc::new(AtomicUsize::new(0));
    let structure = |cubic| Hardening { cubic, commits: Arc::clone(&commits) };
    let scene = || shaken().ground(bed(6)).interface(Coulomb::new(0.5).unwrap());
    let (_, linear) = run(scene().structure(Bare(structure(0.0))));
    assert_eq!(commits.load(Ordering::Relaxed), 0, "a wrapper without `commit`");
    let (_, soft) = run(scene().structure(structure(0.0)));
    assert_eq!(
        commits.load(Ordering::Relaxed),
        601,
        "for the static state, and once per accepted step"
    );
    assert_same_motion(&linear, &soft, 1e-7);
    let (run, hard) = run(scene().structure(structure(1.0e4 * SPRING)));
    let drift =
        |simulation: &Simulation| Hardening::drift(simulation.state().absolute_displacement());
    assert!((drift(&hard) - drift(&soft)).abs() > 1e-5, "the cubic term acts: {run}");
}

#[test]
fn a_wrapped_block_is_the_block() {
    let scene = || shaken().ground(bed(4)).interface(Coulomb::new(0.4).unwrap());
    let (_, own) = run(scene().structure(Bare(block())));
    let (_, plain) = run(scene().structure(block()));
    assert_same_motion(&own, &plain, 0.0);
}
