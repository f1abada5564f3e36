//! Results of a structure with its base held.

use std::rc::Rc;

use crate::coupled::assembly::at_rest;
use crate::coupled::base::fixed_base::is_fixed_base;
use crate::coupled::coordinates::Coordinates;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::parts::Parts;
use crate::coupled::statics::compliance::Floating;
use crate::error::Result;
use crate::linalg::{SparseFactor, SparseMatrix, dot};
use crate::structure::{HeldBase, stiffest};

/// Results of a structure with its base held.
pub(super) struct FixedBaseResults {
    /// Period on a fixed base, s.
    pub(super) period: f64,
    /// Whether there is no mechanism.
    pub(super) is_firm: Result<()>,
    /// For reduced coordinates.
    pub(super) responses: Option<FixedBaseResponses>,
    /// The structure condensed on its base, with the factor; `None` unless the factor eliminates a flexible base last.
    pub(super) condensed: Option<Condensed>,
}

impl FixedBaseResults {
    /// Results of the factored stiffness with the base held.
    ///
    /// The factor is released if the structure is not condensed: factors of large structures take most of the memory.
    pub(super) fn new(
        parts: &Parts,
        assembled: &Assembled,
        mut fixed_factor: SparseFactor,
    ) -> Result<Self> {
        let period = assembled.period_on_fixed_base(&mut fixed_factor);
        let at_rest = assembled.at_rest(parts.structure.as_ref());
        let is_firm = if assembled.linear { at_rest.check(&mut fixed_factor) } else { Ok(()) };
        let is_reduced = matches!(parts.builder.coordinates, Coordinates::Reduced { .. });
        let responses = is_reduced.then(|| FixedBaseResponses::new(assembled, &fixed_factor));
        let is_condensed = assembled.base.is_flexible() && !is_fixed_base(parts.ground.as_ref());
        let condensed = if is_condensed {
            Condensed::new(assembled, fixed_factor, || at_rest::weight_and_load(parts, assembled))?
        } else {
            None
        };
        Ok(Self { period, is_firm, responses, condensed })
    }

    /// The stiffness, if it is positive definite on the springs of the static state's factor.
    pub(super) fn positive_definite<'a>(
        &self,
        assembled: &'a Assembled,
        floating: Option<&'a Floating>,
    ) -> Option<&'a SparseMatrix> {
        let stiffness = floating?.positive_definite()?;
        // The inner part of K, factored with the base held, is positive definite too.
        Some(if self.condensed.is_some() { &assembled.stiffness } else { stiffness })
    }

    /// Hands on the input of reduced coordinates, with the static state's factor; nothing for other coordinates.
    pub(super) fn take_for_reduction(
        &mut self,
        assembled: &Assembled,
        floating: Option<Rc<Floating>>,
    ) -> Option<(FixedBaseResponses, Option<Rc<Floating>>)> {
        let condensed = self.condensed.take();
        let responses = self.responses.take()?;
        let Some(condensed) = condensed else { return Some((responses, floating)) };
        let whole = floating.and_then(|floating| floating.of_whole(assembled, condensed));
        Some((responses, whole.map(Rc::new)))
    }
}

/// Responses of a structure with its base held.
#[derive(Default)]
pub(crate) struct FixedBaseResponses {
    /// Responses to a rotation of each part's base: rigid rotations of parts that stand on one level.
    pub(super) rotations: Vec<f64>,
    /// Estimate of the lowest frequency, by Rayleigh's quotient.
    pub(super) lowest: f64,
}

impl FixedBaseResponses {
    /// Responses by the factored stiffness with the base held.
    pub(crate) fn new(assembled: &Assembled, factor: &SparseFactor) -> Self {
        let mass: &SparseMatrix = &assembled.mass;
        let stiffness: &SparseMatrix = &assembled.stiffness;
        let n = assembled.dofs();
        let translations = assembled.influence.translations(n);
        let springs = HeldBase::new(assembled.base.nodes(), stiffness, stiffest(stiffness));
        let mut rotations = Vec::new();
        for part in assembled.influence.parts() {
            let nodes = part.nodes(&assembled.base);
            let count = nodes.len().max(1) as f64;
            let middle_x = nodes.iter().map(|node| node.x).sum::<f64>() / count;
            let middle_y = nodes.iter().map(|node| node.y).sum::<f64>() / count;
            let middle = [middle_x, middle_y];
            rotations.extend(springs.turns(nodes.iter().copied(), middle).concat());
        }
        factor.solve_many(&mut rotations);
        let inertia = mass.times(&translations);
        let mut deflections = inertia.clone();
        factor.solve_many(&mut deflections);
        let pairs = inertia.chunks_exact(n).zip(deflections.chunks_exact(n));
        let squares = pairs.map(|(force, shape)| dot(force, shape) / mass.form(shape, shape));
        Self { rotations, lowest: squares.fold(f64::INFINITY, f64::min).max(0.0).sqrt() }
    }
}
