//! Mechanisms: structures with a motion that nothing resists while their base is at rest.

use super::base::Base;
use crate::error::StandingError;
use crate::linalg::{SparseFactor, largest};
use crate::matrix::{Matrix, SparseMatrix};
use crate::structure::{ContactNode, Structure, Triplets, unknown_numbers};

const NAME: &str = "stiffness matrix with its base held";
/// Springs that hold the contact nodes, relative to the largest stiffness.
const HELD: f64 = 1.0;
/// Mass that keeps mechanisms regular, relative to what makes it as large as the stiffness.
const REGULAR: f64 = 1e-12;
/// Work of a mechanism on the stiffness, relative to that of its largest entries.
const FREE: f64 = 1e-12;
/// The same where no failure speaks for one. Elements added up leave 3e-17; a column of a thousand
/// beams one above the other has 1e-12.
const SURELY_FREE: f64 = f64::EPSILON;
/// Share of the largest displacement from which on an unknown takes part in a mechanism.
const TAKES_PART: f64 = 0.1;

/// Stiffness (tangent of the nonlinear force at rest included), mass and base of a structure.
#[derive(Clone, Copy)]
pub(super) struct AtRest<'a> {
    pub(super) structure: &'a dyn Structure,
    pub(super) stiffness: &'a SparseMatrix,
    pub(super) mass: &'a Matrix,
    pub(super) base: &'a Base,
}

impl AtRest<'_> {
    /// A mechanism, also where the loads do not set it in motion.
    pub(super) fn free_motion(&self) -> Option<StandingError> {
        self.motion(SURELY_FREE)
    }

    /// The mechanism behind a failure, if there is one.
    pub(super) fn mechanism(&self) -> Option<StandingError> {
        self.motion(FREE)
    }

    /// A displacement with the base at rest that does work of at most `free` on the stiffness.
    fn motion(&self, free: f64) -> Option<StandingError> {
        if self.base.unknowns().is_empty() {
            return None;
        }
        let mut held = Held::new(self)?;
        let n = self.stiffness.order();
        // Inverse iteration from a vector of all signs and sizes.
        let mut motion: Vec<f64> = (0..n).map(|i| (1.0 + i as f64).sin() + 0.5).collect();
        for _ in 0..3 {
            let mut force = vec![0.0; n];
            self.mass.multiply_add(1.0, &motion, &mut force);
            held.factor.solve(&mut force);
            let size = largest(&force);
            if !(size.is_finite() && size > 0.0) {
                return None;
            }
            motion = force.into_iter().map(|x| x / size).collect();
        }
        let mut work = 0.0;
        let mut around = 0.0;
        for &(row, column, value) in held.matrix.entries() {
            let product = motion[row] * value * motion[column];
            work += product;
            around += product.abs();
        }
        if work.abs() > free * around {
            return None;
        }
        let moves = |i: &usize| motion[*i].abs() > TAKES_PART;
        let unknowns: Vec<usize> = (0..n).filter(moves).collect();
        let place = self.structure.describe(&unknowns);
        let place = place.unwrap_or_else(|| unknown_numbers(&unknowns));
        Some(StandingError::Mechanism { unknowns, place })
    }
}

/// The stiffness at rest with springs under the contact nodes.
pub(super) struct Held {
    matrix: Triplets,
    spring: f64,
    factor: SparseFactor,
}

impl Held {
    pub(super) fn new(at_rest: &AtRest<'_>) -> Option<Self> {
        let AtRest { stiffness, mass, base, .. } = *at_rest;
        let stiffest = stiffness.entries().fold(0.0_f64, |m, (_, _, k)| m.max(k.abs()));
        let spring = HELD * if stiffest > 0.0 { stiffest } else { 1.0 };
        let (matrix, _) = base.held(stiffness, spring);
        let mut regular = matrix.clone();
        let heaviest = largest(&mass.diagonal());
        if heaviest > 0.0 {
            mass.add_to(REGULAR * spring / heaviest, &mut regular);
        }
        let factor = SparseFactor::new(NAME, &regular).ok()?;
        Some(Self { matrix, spring, factor })
    }

    /// r of a rotation of `nodes` by 1 rad about `middle`.
    pub(super) fn rotation(&mut self, nodes: &[&ContactNode], middle: f64) -> Vec<f64> {
        let mut rotation = vec![0.0; self.matrix.order()];
        for node in nodes {
            for &(i, weight) in &node.vertical {
                rotation[i] += self.spring * weight * (node.x - middle);
            }
        }
        self.factor.solve(&mut rotation);
        rotation
    }
}
