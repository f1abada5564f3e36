//! Responses of a structure with its base held, for reduced coordinates.

use crate::coupled::model::assembled::Assembled;
use crate::linalg::{SparseFactor, dot};
use crate::structure::{BaseNode, HeldBase, stiffest};

/// Responses of a structure with its base held.
#[derive(Default)]
pub(crate) struct HeldResponses {
    /// Responses to a rotation of each part's base: rigid rotations of parts that stand on one level.
    pub(super) rotations: Vec<f64>,
    /// Estimate of the lowest frequency, by Rayleigh's quotient.
    pub(super) lowest: f64,
}

impl HeldResponses {
    /// Responses by the factored stiffness with the base held.
    pub(crate) fn new(assembled: &Assembled, factor: &SparseFactor) -> Self {
        let [mass, _, stiffness] = assembled.matrices();
        let n = assembled.dofs();
        let translations = assembled.influence.translations(n);
        let held = HeldBase::new(assembled.base.nodes(), stiffness, stiffest(stiffness));
        let mut rotations = Vec::new();
        for part in assembled.influence.parts() {
            let nodes = part.nodes(&assembled.base);
            let mean = |place: fn(&BaseNode) -> f64| {
                nodes.iter().map(|node| place(node)).sum::<f64>() / nodes.len().max(1) as f64
            };
            let middle = [mean(|node| node.x), mean(|node| node.y)];
            rotations.extend(held.turns(nodes.iter().copied(), middle).concat());
        }
        factor.solve_many(&mut rotations);
        let inertia = mass.times(&translations);
        let mut bent = inertia.clone();
        factor.solve_many(&mut bent);
        let pairs = inertia.chunks_exact(n).zip(bent.chunks_exact(n));
        let squares = pairs.map(|(force, bent)| dot(force, bent) / mass.form(bent, bent));
        Self { rotations, lowest: squares.fold(f64::INFINITY, f64::min).max(0.0).sqrt() }
    }
}
