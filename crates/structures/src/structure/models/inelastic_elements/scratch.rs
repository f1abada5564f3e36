//! Buffers of evaluations of all elements, and what further evaluations of a step take from them.

use super::element::InelasticElement;
use crate::structure::InternalEnergy;

/// Displacements, forces and matrix of one element, and what elements with a shared evaluation compute with their forces.
pub(super) struct Scratch {
    pub(super) displacements: [Vec<f64>; 3],
    pub(super) force: Vec<f64>,
    pub(super) matrix: Vec<f64>,
    /// Tangents of all elements with a shared evaluation, one after the other.
    pub(super) tangents: Vec<f64>,
    /// Displacement of the model to which `tangents` belong; empty for none.
    pub(super) tangent_displacement: Vec<f64>,
    /// Stresses of all elements with a shared evaluation, one after the other.
    pub(super) stresses: Vec<f64>,
    /// Whether the stresses are those of the last forces, as `tangents`.
    pub(super) has_midstep_stresses: bool,
    /// Displacement at the end of a step to which `stresses` and `end_energy` belong; empty for none.
    pub(super) end_displacement: Vec<f64>,
    pub(super) end_energy: InternalEnergy,
}

impl Scratch {
    /// Scratch for elements.
    pub(super) fn new(elements: &[InelasticElement]) -> Self {
        let max_order = elements.iter().map(|element| element.rows.len()).max().unwrap_or(0);
        let mut tangent_count = 0;
        let mut stress_count = 0;
        for element in elements.iter().filter(|element| element.has_shared_evaluation()) {
            tangent_count += element.rows.len() * element.rows.len();
            stress_count += element.stress_count();
        }
        let zeros = vec![0.0; max_order];
        Self {
            displacements: [zeros.clone(), zeros.clone(), zeros.clone()],
            force: zeros,
            matrix: vec![0.0; max_order * max_order],
            tangents: vec![0.0; tangent_count],
            tangent_displacement: Vec::new(),
            stresses: vec![0.0; stress_count],
            has_midstep_stresses: false,
            end_displacement: Vec::new(),
            end_energy: InternalEnergy::default(),
        }
    }

    /// Discards values of evaluations at other displacements or internal variables.
    pub(super) fn discard_evaluations(&mut self) {
        self.tangent_displacement.clear();
        self.has_midstep_stresses = false;
        self.end_displacement.clear();
    }

    /// Energy of all elements that the end of a step has found for this displacement.
    pub(super) fn end_energy_at(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        let is_known = !self.end_displacement.is_empty() && self.end_displacement == displacement;
        is_known.then_some(self.end_energy)
    }
}
