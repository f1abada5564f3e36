//! Extremes of each contact element.

use crate::bem::ContactElement;
use crate::coupled::run::Extremes;
use crate::coupled::{Peak, State};

/// Envelopes of one contact element; tractions are means over it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct ElementEnvelope {
    /// Where it is.
    pub element: ContactElement,
    /// Pressure at the start, Pa.
    pub static_pressure: f64,
    /// Smallest and largest pressure, Pa.
    pub pressure: Extremes,
    /// Shear traction of largest magnitude, with its sign, Pa.
    pub shear: Peak,
    /// Largest gap, m.
    pub gap: Peak,
    /// Slip of largest magnitude, with its sign, m.
    pub slip: Peak,
    /// Time open, s.
    pub open: f64,
}

/// Of every element, at the start.
pub(super) fn start(elements: &[ContactElement], state: &State) -> Vec<ElementEnvelope> {
    let envelope = |(element, contact): (&ContactElement, &crate::interface::ContactState)| {
        let peak = |value| Peak { value, time: state.time };
        ElementEnvelope {
            element: *element,
            static_pressure: contact.pressure,
            pressure: Extremes::of(contact.pressure, state.time),
            shear: peak(contact.shear),
            gap: peak(contact.gap),
            slip: peak(contact.slip),
            open: 0.0,
        }
    };
    elements.iter().zip(&state.contact).map(envelope).collect()
}

/// Of every element, after a step of length `step`.
pub(super) fn see(envelopes: &mut [ElementEnvelope], state: &State, step: f64) {
    let modes = state.modes.iter();
    for ((envelope, contact), mode) in envelopes.iter_mut().zip(&state.contact).zip(modes) {
        envelope.pressure.see(contact.pressure, state.time);
        envelope.shear.see(contact.shear, state.time);
        envelope.gap.see(contact.gap, state.time);
        envelope.slip.see(contact.slip, state.time);
        if !mode.is_closed() {
            envelope.open += step;
        }
    }
}
