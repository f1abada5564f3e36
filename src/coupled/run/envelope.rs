//! Extremes of each contact element in a run.

use crate::bem::ContactElement;
use crate::coupled::run::Extremes;
use crate::coupled::run::peak::Peak;
use crate::coupled::{State, Warning};
use crate::geometry::Patch;
use crate::interface::ContactState;

/// Envelopes of one contact element; tractions are means over the element.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct ElementEnvelope {
    /// The element.
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
    /// In plan: shear traction along y of largest magnitude, Pa; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub shear_across: Peak,
    /// In plan: slip along y of largest magnitude, m; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slip_across: Peak,
}

/// Warning of the largest tension under elements that cannot open.
///
/// `None` if it is below the limit, or without static pressures.
pub(crate) fn tension(
    envelope: &[ElementEnvelope],
    in_plan: bool,
    opens: impl Fn(usize) -> bool,
) -> Option<Warning> {
    let pressures = envelope.iter().map(|element| element.static_pressure);
    let limit = Warning::TENSION_LIMIT * pressures.fold(0.0, f64::max);
    let held = envelope.iter().enumerate().filter(|(e, _)| !opens(*e));
    let least = |own: &ElementEnvelope| own.pressure.lowest.value;
    let (_, own) = held.min_by(|(_, a), (_, b)| least(a).total_cmp(&least(b)))?;
    let (tension, time) = (-least(own), own.pressure.lowest.time);
    let [x, y, z] = own.element.center();
    let y = in_plan.then_some(y);
    let walls = ContactElement::any_wall(envelope.iter().map(|own| &own.element));
    let z = walls.then_some(z);
    (limit > 0.0 && tension > limit).then_some(Warning::Tension { tension, x, y, z, time })
}

/// Envelopes of all elements at the start of a run.
pub(crate) fn start(elements: &Patch, state: &State) -> Vec<ElementEnvelope> {
    let envelope = |(element, contact): (&ContactElement, &ContactState)| {
        let peak = |value| Peak { value, time: state.time };
        ElementEnvelope {
            element: *element,
            static_pressure: contact.pressure,
            pressure: Extremes::single(contact.pressure, state.time),
            shear: peak(contact.shear),
            gap: peak(contact.gap),
            slip: peak(contact.slip),
            open: 0.0,
            shear_across: peak(contact.shear_across),
            slip_across: peak(contact.slip_across),
        }
    };
    elements.iter().zip(&state.contact).map(envelope).collect()
}

/// Extends the envelopes by a step of duration `step`.
pub(crate) fn see(envelopes: &mut [ElementEnvelope], state: &State, step: f64) {
    let modes = state.modes.iter();
    for ((envelope, contact), mode) in envelopes.iter_mut().zip(&state.contact).zip(modes) {
        envelope.pressure.see(contact.pressure, state.time);
        envelope.shear.see(contact.shear, state.time);
        envelope.gap.see(contact.gap, state.time);
        envelope.slip.see(contact.slip, state.time);
        envelope.shear_across.see(contact.shear_across, state.time);
        envelope.slip_across.see(contact.slip_across, state.time);
        if !mode.is_closed() {
            envelope.open += step;
        }
    }
}
