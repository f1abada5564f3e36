//! What each foundation of a run came to.

use std::ops::Range;

use super::Extremes;
use super::safety::{against_overturning, against_sliding};
use crate::bem::ContactElement;
use crate::coupled::{Foundation, Peak, State};

/// One foundation of a run: what stands on it gave to the soil, and how its base moved.
///
/// Moments are about the middle of its own elements, so that of several structures each has its own.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FoundationSummary {
    /// Its elements, as indices of all.
    pub elements: Range<usize>,
    /// Its left and right end, m.
    pub ends: [f64; 2],
    /// Normal force at the start: the weight on it, N/m.
    pub static_normal_force: f64,
    /// Base shear, N/m.
    pub base_shear: Extremes,
    /// Base moment about its middle, static part included, N·m/m.
    pub base_moment: Extremes,
    /// Normal force, N/m.
    pub normal_force: Extremes,
    /// Rotation of its chord, rad.
    pub base_rotation: Extremes,
    /// Largest uplifted fraction.
    pub uplifted_fraction: Peak,
    /// Slip averaged over its elements, m.
    pub mean_slip: Extremes,
    /// That slip at the end, m.
    pub residual_slip: f64,
    /// Least factor of safety against sliding; `None` without a friction coefficient.
    pub least_sliding_safety: Option<Peak>,
    /// Least factor of safety against overturning.
    pub least_overturning_safety: Peak,
}

/// A foundation while the run goes on.
#[derive(Debug, Clone)]
pub(super) struct FootingTally {
    pub(super) summary: FoundationSummary,
    /// Factors of safety against sliding (NaN without a friction coefficient) and overturning now.
    safety: [f64; 2],
}

impl FootingTally {
    /// As it stands at the start, for one friction coefficient for all elements, one each, or none.
    fn start(
        state: &State,
        foundation: &Foundation,
        friction: &[f64],
        elements: &[ContactElement],
    ) -> Self {
        let time = state.time;
        let at_start = |value| Extremes::of(value, time);
        let own = &elements[foundation.elements.clone()];
        let safety = safety(state, foundation, friction, elements);
        let [sliding, overturning] = safety.map(|value| Peak { value, time });
        Self {
            summary: FoundationSummary {
                elements: foundation.elements.clone(),
                ends: [own.first().map_or(0.0, |e| e.left), own.last().map_or(0.0, |e| e.right)],
                static_normal_force: foundation.normal_force,
                base_shear: at_start(foundation.shear),
                base_moment: at_start(foundation.moment),
                normal_force: at_start(foundation.normal_force),
                base_rotation: at_start(foundation.rotation),
                uplifted_fraction: Peak { value: foundation.uplifted_fraction, time },
                mean_slip: at_start(foundation.mean_slip),
                residual_slip: foundation.mean_slip,
                least_sliding_safety: (!friction.is_empty()).then_some(sliding),
                least_overturning_safety: overturning,
            },
            safety,
        }
    }

    fn see(
        &mut self,
        state: &State,
        foundation: &Foundation,
        friction: &[f64],
        elements: &[ContactElement],
    ) {
        let (summary, time) = (&mut self.summary, state.time);
        summary.base_shear.see(foundation.shear, time);
        summary.base_moment.see(foundation.moment, time);
        summary.normal_force.see(foundation.normal_force, time);
        summary.base_rotation.see(foundation.rotation, time);
        summary.uplifted_fraction.see(foundation.uplifted_fraction, time);
        summary.mean_slip.see(foundation.mean_slip, time);
        summary.residual_slip = foundation.mean_slip;
        self.safety = safety(state, foundation, friction, elements);
        let [sliding, overturning] = self.safety;
        if let Some(least) = &mut summary.least_sliding_safety {
            fall(least, sliding, time);
        }
        fall(&mut summary.least_overturning_safety, overturning, time);
    }
}

/// All foundations at the start.
pub(super) fn start(
    state: &State,
    friction: &[f64],
    elements: &[ContactElement],
) -> Vec<FootingTally> {
    let own = state.foundations.iter();
    own.map(|foundation| FootingTally::start(state, foundation, friction, elements)).collect()
}

/// Whether the state's foundations are these.
pub(super) fn fit(footings: &[FootingTally], state: &State) -> bool {
    footings.len() == state.foundations.len()
        && footings
            .iter()
            .zip(&state.foundations)
            .all(|(own, other)| own.summary.elements == other.elements)
}

/// Takes in a step.
pub(super) fn see(
    footings: &mut [FootingTally],
    state: &State,
    friction: &[f64],
    elements: &[ContactElement],
) {
    for (footing, foundation) in footings.iter_mut().zip(&state.foundations) {
        footing.see(state, foundation, friction, elements);
    }
}

/// The least factors of safety now, those in flight left out; NaN if all are.
pub(super) fn least(footings: &[FootingTally]) -> [f64; 2] {
    let lesser = |least: [f64; 2], own: &FootingTally| {
        [least[0].min(own.safety[0]), least[1].min(own.safety[1])]
    };
    footings.iter().fold([f64::NAN; 2], lesser)
}

fn safety(
    state: &State,
    foundation: &Foundation,
    friction: &[f64],
    elements: &[ContactElement],
) -> [f64; 2] {
    let own = foundation.elements.clone();
    let (elements, contact) = (&elements[own.clone()], &state.contact[own.clone()]);
    let sliding = match friction.len() {
        0 => f64::NAN,
        1 => against_sliding(friction, elements, contact),
        _ => against_sliding(&friction[own], elements, contact),
    };
    [sliding, against_overturning(elements, contact)]
}

/// A NaN, of a base in flight, is left out.
fn fall(least: &mut Peak, value: f64, time: f64) {
    if value < least.value || least.value.is_nan() {
        *least = Peak { value, time };
    }
}
