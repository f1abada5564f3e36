//! GOAL: structures of a user work, linear and nonlinear, and where they wrap another.
//! SCENE: a mass on a hardening spring on a rigid base; a wrapped block.
//! REFERENCE: the linear limit; the block itself; one commit per accepted step.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::Simulation;
use basemat::interface::Coulomb;
use basemat::structure::{Base, BaseNode, NonlinearForce, Structure, Triplets};

use super::scene::{CompletedRun, assert_same_motion, complete_run, shaken};
use basemat_problems::block_on_springs::{bed, block};
use basemat_problems::own_force;
use basemat_problems::wrapped::MinimalStructure;

/// A mass on a hardening spring on a rigid base: force k d + k₃ d³.
pub(crate) struct HardeningOscillator {
    pub(crate) cubic_stiffness: f64,
    /// Number of committed steps.
    pub(crate) commits: Arc<AtomicUsize>,
}

/// Linear stiffness k of the spring, N/m.
pub(crate) const SPRING_STIFFNESS: f64 = 4.0e6;

/// Weights of the drift: displacement of the mass, minus the displacement of the base, plus height × rotation.
const DRIFT_WEIGHTS: [(usize, f64); 3] = [(3, 1.0), (0, -1.0), (2, 3.0)];

impl HardeningOscillator {
    fn drift(displacement: &[f64]) -> f64 {
        DRIFT_WEIGHTS.iter().map(|&(index, weight)| weight * displacement[index]).sum()
    }
}

impl Structure for HardeningOscillator {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        for (dof, mass) in [1.0e4, 3.0e4, 8.0e4, 2.0e4].into_iter().enumerate() {
            matrix.add(dof, dof, mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer(DRIFT_WEIGHTS, SPRING_STIFFNESS);
        Ok(())
    }

    own_force!();
}

impl NonlinearForce for HardeningOscillator {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        let spring_force = self.cubic_stiffness * Self::drift(displacement).powi(3);
        for (index, weight) in DRIFT_WEIGHTS {
            force[index] += weight * spring_force;
        }
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        let tangent = 3.0 * self.cubic_stiffness * Self::drift(displacement).powi(2);
        matrix.add_outer(DRIFT_WEIGHTS, tangent);
        Ok(())
    }

    fn commit(&mut self, displacement: &[f64]) {
        assert_eq!(displacement.len(), 4);
        self.commits.fetch_add(1, Ordering::Relaxed);
    }
}

/// Run of a structure on six springs with friction.
fn run_on_springs(structure: impl Structure + 'static) -> CompletedRun {
    let law = Coulomb::new(0.5).unwrap();
    complete_run(shaken().ground(bed(6)).interface(law).structure(structure))
}

fn drift(simulation: &Simulation) -> f64 {
    HardeningOscillator::drift(simulation.state().absolute_displacement())
}

#[test]
fn structures_of_a_user_are_linear_or_nonlinear() {
    let commits = Arc::new(AtomicUsize::new(0));
    let oscillator =
        |cubic_stiffness| HardeningOscillator { cubic_stiffness, commits: Arc::clone(&commits) };
    let linear_simulation = run_on_springs(MinimalStructure(oscillator(0.0))).simulation;
    assert_eq!(commits.load(Ordering::Relaxed), 0, "a wrapper without `commit`");
    let soft_simulation = run_on_springs(oscillator(0.0)).simulation;
    let count = commits.load(Ordering::Relaxed);
    assert_eq!(count, 601, "for the static state, and once per accepted step");
    assert_same_motion(&linear_simulation, &soft_simulation, 1e-7);
    let hard_run = run_on_springs(oscillator(1.0e4 * SPRING_STIFFNESS));
    let difference = drift(&hard_run.simulation) - drift(&soft_simulation);
    assert!(difference.abs() > 1e-5, "the cubic term acts: {}", hard_run.run);
}

/// Motion of a structure on four springs with little friction.
fn motion_on_springs(structure: impl Structure + 'static) -> Simulation {
    let law = Coulomb::new(0.4).unwrap();
    complete_run(shaken().ground(bed(4)).interface(law).structure(structure)).simulation
}

#[test]
fn a_wrapped_block_is_the_block() {
    assert_same_motion(
        &motion_on_springs(MinimalStructure(block())),
        &motion_on_springs(block()),
        0.0,
    );
}
