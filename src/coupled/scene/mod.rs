//! A scene: all that does not change while a simulation runs.

pub(crate) mod base;
pub(crate) mod conditioning;
pub(crate) mod influence;
pub(crate) mod krylov;
pub(crate) mod laws;
mod mechanism;
pub(crate) mod modal_basis;
pub(crate) mod model;
pub(crate) mod operators;
mod proximal;
pub(crate) mod stages;
mod standing;
pub(crate) mod static_state;
pub(crate) mod step_response;
pub(crate) mod stepped_row;
mod subspace;
mod supports;
pub(crate) mod translation_check;

use std::sync::Arc;

use crate::bem::ContactElement;
use crate::coupled::run::Serviceability;
use crate::interface::{InterfaceLaw, law_of};
use crate::linalg::matrix::{Thinned, spread};
use base::Base;
use influence::Part;
use model::Model;
use static_state::StaticState;
use stepped_row::SteppedRow;

use super::load::SteppedLoad;
use super::scheme::SchemeCoefficients;
use crate::structure::probe::Probe;

/// Structure, base, laws and static state as a step sees them, read-only once built.
///
/// The parts that have a state of their own stand beside it: structure, ground and motion.
pub(crate) struct Scene {
    pub(crate) time_step: f64,
    pub(crate) coefficients: SchemeCoefficients,
    /// Whether the scheme takes no energy of its own.
    pub(crate) conserves_energy: bool,
    pub(crate) model: Model,
    pub(crate) base: Base,
    pub(crate) elements: Vec<ContactElement>,
    pub(crate) laws: Vec<Box<dyn InterfaceLaw>>,
    /// Coefficients for the factor of safety against sliding: one for all elements, one each, or none.
    pub(crate) safety_friction: Vec<f64>,
    /// Limits that runs are held against.
    pub(crate) serviceability: Serviceability,
    /// Whether any law stores energy in its elements.
    pub(crate) compliant: bool,
    pub(crate) static_state: StaticState,
    /// External loads beside the structure's own.
    pub(crate) loads: Vec<SteppedLoad>,
    /// Weight as a load, in stepped coordinates, where the run begins without a static state; else empty.
    pub(crate) weight: Vec<f64>,
    /// Parts that the nonlinear force joins with others.
    pub(crate) joined: Vec<bool>,
    /// Instantaneous operator of the ground, 2Q × 2Q.
    pub(crate) soil: Arc<Thinned>,
    /// Free field at t = 0, from which it is measured, 2Q.
    pub(crate) start_motion: Vec<f64>,
    pub(crate) probes: Vec<Probe>,
    /// Displacement, velocity and acceleration of each probe.
    pub(crate) probe_rows: Vec<ProbeRows>,
    /// Element midpoints relative to the point of the base moment.
    pub(crate) arms: Vec<f64>,
}

/// A probe in the coordinates that are stepped.
pub(crate) struct ProbeRows {
    pub(crate) rows: [SteppedRow; 3],
    /// Displacement by a translation of 1 m of each part `[right, up]`, where it is absolute.
    pub(crate) carried: Vec<[f64; 2]>,
}

impl ProbeRows {
    pub(crate) fn new(probe: &Probe, model: &Model) -> Self {
        let rows = probe.rows().map(|row| SteppedRow::new(row.terms(), model.modes.as_deref()));
        let parts = model.influence.parts().iter().filter(|_| probe.absolute);
        let carried = parts
            .map(|part| [0, 1].map(|k| rows[0].of(&spread(&part.vectors[k], model.coordinates))));
        Self { carried: carried.collect(), rows }
    }
}

impl Scene {
    /// Number of contact elements Q.
    pub(crate) fn count(&self) -> usize {
        self.elements.len()
    }

    /// The law of an element.
    pub(crate) fn law(&self, element: usize) -> &dyn InterfaceLaw {
        law_of(&self.laws, element)
    }

    /// Subtracts the mean translation of each part's base from a displacement, before K acts on it.
    ///
    /// A translation strains nothing, but in unknowns K would only find that out by cancellation,
    /// with an error that grows with the stiffness times the displacement. In modes it has no
    /// stiffness to begin with.
    pub(crate) fn subtract_base(&self, displacement: &mut [f64], means: &mut [f64]) {
        if self.model.modes.is_some() {
            return;
        }
        self.base.means(displacement, means);
        let influence = &self.model.influence;
        let parts = influence.parts().iter().map(|part| part.mean(&self.base, means));
        influence.translate(-1.0, parts, displacement);
    }

    /// Makes of a relative displacement the one that a nonlinear force sees: each part's measured
    /// from the mean translation of its base, so that it stays small. Parts that the force joins are
    /// measured from that of the first of them, with the distances between them as they are. The static
    /// displacement is added. `translations` are those of the parts' free fields.
    pub(crate) fn seen_by_force(
        &self,
        displacement: &mut [f64],
        means: &mut [f64],
        translations: impl Iterator<Item = [f64; 2]> + Clone,
    ) {
        self.base.means(displacement, means);
        let influence = &self.model.influence;
        let mean = |part: &Part| part.mean(&self.base, means);
        let parts = || influence.parts().iter().zip(&self.joined);
        let first = parts().zip(translations.clone()).find(|((_, joined), _)| **joined);
        let first = first.map(|((part, _), y)| (mean(part), y));
        let shifts = parts().zip(translations).map(|((part, joined), y)| match first {
            Some((own, reference)) if *joined => [0, 1].map(|k| (y[k] - reference[k]) - own[k]),
            _ => mean(part).map(|own| -own),
        });
        influence.translate(1.0, shifts, displacement);
        for (seen, at_rest) in displacement.iter_mut().zip(&self.static_state.displacement) {
            *seen += at_rest;
        }
    }

    /// Whether [`Scene::add_loads`] has anything to add.
    pub(crate) fn has_loads(&self) -> bool {
        !(self.weight.is_empty() && self.loads.is_empty())
    }

    /// Adds the weight and the external loads at `time`, less those of the static state, to `force`,
    /// up to a load that is not finite: its number and its value.
    pub(crate) fn add_loads(&self, time: f64, force: &mut [f64]) -> Option<(usize, f64)> {
        force.iter_mut().zip(&self.weight).for_each(|(force, weight)| *force += weight);
        let mut added = self.loads.iter().map(|load| load.add(time, force)).enumerate();
        added.find(|(_, value)| !value.is_finite())
    }
}
