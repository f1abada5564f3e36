//! Results of a structure with a fixed base, which several stages of the build need.

use std::rc::Rc;

use crate::coupled::assembly::at_rest;
use crate::coupled::base::fixed_base::is_fixed_base;
use crate::coupled::coordinates::Coordinates;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::parts::Parts;
use crate::coupled::statics::compliance::ShiftedStiffnessFactor;
use crate::error::Result;
use crate::linalg::{SparseFactor, SparseMatrix, dot};
use crate::structure::{SpringSupportedBase, max_diagonal_stiffness};

/// Results of a structure with a fixed base.
pub(super) struct FixedBaseResults {
    /// Period on a fixed base, s.
    pub(super) period: f64,
    /// An error if the structure is a mechanism.
    pub(super) mechanism_check: Result<()>,
    /// Input of reduced coordinates; `None` for other coordinates.
    pub(super) responses: Option<FixedBaseResponses>,
    /// The structure condensed on its base, if that is flexible and eliminated last.
    pub(super) condensation: Option<Condensed>,
}

impl FixedBaseResults {
    /// Computes the results from the factored stiffness with a fixed base.
    ///
    /// The factor is dropped if the structure is not condensed, since factors of large structures need most of the memory.
    pub(super) fn new(
        parts: &Parts,
        assembled: &Assembled,
        mut fixed_factor: SparseFactor,
    ) -> Result<Self> {
        let period = assembled.period_on_fixed_base(&mut fixed_factor);
        let at_rest = assembled.structure_at_rest(parts.structure.as_ref());
        let mechanism_check =
            if assembled.is_linear { at_rest.check(&mut fixed_factor) } else { Ok(()) };
        let is_reduced = matches!(parts.builder.coordinates, Coordinates::Reduced { .. });
        let responses = is_reduced.then(|| FixedBaseResponses::new(assembled, &fixed_factor));
        let is_condensed = assembled.base.is_flexible() && !is_fixed_base(parts.ground.as_ref());
        let condensation = if is_condensed {
            Condensed::new(assembled, fixed_factor, || at_rest::weight_and_load(parts, assembled))?
        } else {
            None
        };
        Ok(Self { period, mechanism_check, responses, condensation })
    }

    /// The stiffness, with or without a shift, if the static state's factor is positive definite.
    pub(super) fn positive_definite_stiffness<'a>(
        &self,
        assembled: &'a Assembled,
        shifted_stiffness: Option<&'a ShiftedStiffnessFactor>,
    ) -> Option<&'a SparseMatrix> {
        let stiffness = shifted_stiffness?.positive_definite()?;
        // For a condensed structure the factor is that of the condensed stiffness. The remaining part of K, which has
        // been factored with a fixed base, is positive definite too.
        Some(if self.condensation.is_some() { &assembled.stiffness } else { stiffness })
    }

    /// Moves the input of reduced coordinates out of `self`; `None` for other coordinates.
    ///
    /// The static state's factor is a part of the input.
    pub(super) fn take_reduction_input(
        &mut self,
        assembled: &Assembled,
        shifted_stiffness: Option<Rc<ShiftedStiffnessFactor>>,
    ) -> Option<(FixedBaseResponses, Option<Rc<ShiftedStiffnessFactor>>)> {
        let condensation = self.condensation.take();
        let responses = self.responses.take()?;
        let Some(condensation) = condensation else {
            return Some((responses, shifted_stiffness));
        };
        let expanded =
            shifted_stiffness.and_then(|factor| factor.expanded(assembled, condensation));
        Some((responses, expanded.map(Rc::new)))
    }
}

/// Responses of a structure with a fixed base, as input of reduced coordinates.
#[derive(Default)]
pub(crate) struct FixedBaseResponses {
    /// Responses to a rotation of each part's base.
    ///
    /// They are rigid rotations if the base has one level.
    pub(super) rotations: Vec<f64>,
    /// Lowest circular frequency, estimated by Rayleigh's quotient, 1/s.
    pub(super) lowest_frequency: f64,
}

impl FixedBaseResponses {
    /// Computes the responses with the factored stiffness on a fixed base.
    pub(crate) fn new(assembled: &Assembled, factor: &SparseFactor) -> Self {
        let mass: &SparseMatrix = &assembled.mass;
        let stiffness: &SparseMatrix = &assembled.stiffness;
        let dofs = assembled.dofs();
        let translations = assembled.influence.part_vectors(dofs);
        let springs = SpringSupportedBase::new(
            assembled.base.nodes(),
            stiffness,
            max_diagonal_stiffness(stiffness),
        );
        let mut rotations = Vec::new();
        for part in assembled.influence.parts() {
            let nodes = part.nodes(&assembled.base);
            let node_count = nodes.len().max(1) as f64;
            let middle_x = nodes.iter().map(|node| node.x).sum::<f64>() / node_count;
            let middle_y = nodes.iter().map(|node| node.y).sum::<f64>() / node_count;
            let middle = [middle_x, middle_y];
            rotations.extend(springs.rotation_forces(nodes.iter().copied(), middle).concat());
        }
        factor.solve_many(&mut rotations);
        let inertia = mass.times(&translations);
        let mut deflections = inertia.clone();
        factor.solve_many(&mut deflections);
        let pairs = inertia.chunks_exact(dofs).zip(deflections.chunks_exact(dofs));
        let squared_frequencies =
            pairs.map(|(force, shape)| dot(force, shape) / mass.form(shape, shape));
        let lowest_square = squared_frequencies.fold(f64::INFINITY, f64::min).max(0.0);
        Self { rotations, lowest_frequency: lowest_square.sqrt() }
    }
}
