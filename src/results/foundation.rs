//! Results of each foundation of a run.

use std::ops::Range;

use super::safety::{against_overturning, against_sliding};
use super::{Extremes, Sliding};
use crate::bem::ContactElement;
use crate::coupled::{Foundation, Peak, State};

/// Most slip events of a base that memory is reserved for.
pub(super) const EVENTS: usize = 1000;

/// One foundation of a run: what stands on it gave to the soil, and how its base moved.
///
/// Moments are about the middle of its own elements, so that of several structures each has its own.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
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
    /// Distance and duration of its sliding, and the events.
    pub sliding: Sliding,
    /// Least factor of safety against sliding; `None` without a friction coefficient.
    pub least_sliding_safety: Option<Peak>,
    /// Least factor of safety against overturning.
    pub least_overturning_safety: Peak,
}

impl FoundationSummary {
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
        let [sliding, overturning] =
            safety(state, foundation, friction, elements).map(|value| Peak { value, time });
        Self {
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
            sliding: Sliding::with_capacity(EVENTS),
            least_sliding_safety: (!friction.is_empty()).then_some(sliding),
            least_overturning_safety: overturning,
        }
    }

    fn see(
        &mut self,
        state: &State,
        begin: f64,
        foundation: &Foundation,
        friction: &[f64],
        elements: &[ContactElement],
    ) {
        let time = state.time;
        self.base_shear.see(foundation.shear, time);
        self.base_moment.see(foundation.moment, time);
        self.normal_force.see(foundation.normal_force, time);
        self.base_rotation.see(foundation.rotation, time);
        self.uplifted_fraction.see(foundation.uplifted_fraction, time);
        let (modes, slip) = (&state.modes[self.elements.clone()], foundation.mean_slip);
        self.sliding.see(modes, slip - self.residual_slip, [begin, time]);
        self.mean_slip.see(foundation.mean_slip, time);
        self.residual_slip = foundation.mean_slip;
        let [sliding, overturning] = safety(state, foundation, friction, elements);
        if let Some(least) = &mut self.least_sliding_safety {
            fall(least, sliding, time);
        }
        fall(&mut self.least_overturning_safety, overturning, time);
    }
}

/// All foundations at the start.
pub(super) fn start(
    state: &State,
    friction: &[f64],
    elements: &[ContactElement],
) -> Vec<FoundationSummary> {
    let own = state.foundations.iter();
    own.map(|foundation| FoundationSummary::start(state, foundation, friction, elements)).collect()
}

/// Takes in a step that began at `begin`.
pub(super) fn see(
    summaries: &mut [FoundationSummary],
    state: &State,
    begin: f64,
    friction: &[f64],
    elements: &[ContactElement],
) {
    for (summary, foundation) in summaries.iter_mut().zip(&state.foundations) {
        summary.see(state, begin, foundation, friction, elements);
    }
}

/// The least factors of safety against sliding and overturning of a state, foundations in flight
/// left out; NaN if all are.
pub(super) fn least(state: &State, friction: &[f64], elements: &[ContactElement]) -> [f64; 2] {
    state.foundations.iter().fold([f64::NAN; 2], |least: [f64; 2], foundation| {
        let [sliding, overturning] = safety(state, foundation, friction, elements);
        [least[0].min(sliding), least[1].min(overturning)]
    })
}

/// Factors of safety against sliding (NaN without a friction coefficient) and overturning.
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
