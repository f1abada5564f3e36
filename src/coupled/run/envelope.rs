//! Extremes of each contact element in a run.

use crate::bem::ContactElement;
use crate::coupled::run::Extremes;
use crate::coupled::run::peak::Peak;
use crate::coupled::state::ResultContext;
use crate::coupled::{State, Warning};
use crate::interface::{ContactState, Mode};

/// Envelopes of one contact element in a run; tractions are means over the element.
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
    /// Time during which the element is open, s.
    pub open: f64,
    /// In plan: shear traction along y of largest magnitude, Pa; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub shear_across: Peak,
    /// In plan: slip along y of largest magnitude, m; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slip_across: Peak,
}

impl ElementEnvelope {
    fn start(element: &ContactElement, contact: &ContactState, time: f64) -> Self {
        Self {
            element: *element,
            static_pressure: contact.pressure,
            pressure: Extremes::single(contact.pressure, time),
            shear: Peak { value: contact.shear, time },
            gap: Peak { value: contact.gap, time },
            slip: Peak { value: contact.slip, time },
            open: 0.0,
            shear_across: Peak { value: contact.shear_across, time },
            slip_across: Peak { value: contact.slip_across, time },
        }
    }

    /// Length of the shortest side of the element, m.
    pub(crate) fn shortest_side(&self) -> f64 {
        let sides = self.element.sides().into_iter().take(self.element.directions().len() - 1);
        sides.fold(f64::INFINITY, f64::min)
    }
}

/// Warning of the largest tension under elements that cannot open.
///
/// `None` if the tension is below the limit, or without static pressures.
pub(crate) fn tension_warning(
    envelope: &[ElementEnvelope],
    in_plan: bool,
    can_open: impl Fn(usize) -> bool,
) -> Option<Warning> {
    let pressures = envelope.iter().map(|element| element.static_pressure);
    let max_pressure = pressures.clone().fold(0.0, f64::max);
    // Water may lift a bonded base everywhere.
    let max_tension = pressures.fold(0.0, |tension: f64, pressure| tension.max(-pressure));
    let reference = if max_pressure > 0.0 { max_pressure } else { max_tension };
    let limit = Warning::TENSION_LIMIT * reference;
    let elements_without_opening = envelope.iter().enumerate().filter(|(e, _)| !can_open(*e));
    let tensioned_element = elements_without_opening
        .map(|(_, element)| element)
        .min_by(|a, b| a.pressure.lowest.value.total_cmp(&b.pressure.lowest.value))?;
    let tension = -tensioned_element.pressure.lowest.value;
    let time = tensioned_element.pressure.lowest.time;
    let center = tensioned_element.element.center();
    let y = in_plan.then_some(center[1]);
    let has_walls = ContactElement::any_wall(envelope.iter().map(|element| &element.element));
    let z = has_walls.then_some(center[2]);
    let warning = Warning::Tension { tension, x: center[0], y, z, time };
    (limit > 0.0 && tension > limit).then_some(warning)
}

/// Envelopes of the elements of the ground, and of each joint, at the start of a run.
pub(crate) fn start(state: &State) -> (Vec<ElementEnvelope>, Vec<Vec<ElementEnvelope>>) {
    let start = |elements: &[ContactElement], contact: &[ContactState]| {
        let pairs = elements.iter().zip(contact);
        pairs
            .map(|(element, contact)| ElementEnvelope::start(element, contact, state.time))
            .collect()
    };
    let ResultContext { elements, joint_elements, .. } = state.context.as_ref();
    let joints = joint_elements.iter().zip(&state.joints);
    let joint_envelopes = joints.map(|(elements, joint)| start(elements, &joint.contact));
    (start(elements, &state.contact), joint_envelopes.collect())
}

/// Extends envelopes of elements by a step of `step_duration` (s) with this contact at its end, at `time` (s).
pub(crate) fn update(
    envelopes: &mut [ElementEnvelope],
    (contact, modes): (&[ContactState], &[Mode]),
    time: f64,
    step_duration: f64,
) {
    for ((envelope, contact), mode) in envelopes.iter_mut().zip(contact).zip(modes) {
        envelope.pressure.update(contact.pressure, time);
        envelope.shear.update(contact.shear, time);
        envelope.gap.update(contact.gap, time);
        envelope.slip.update(contact.slip, time);
        envelope.shear_across.update(contact.shear_across, time);
        envelope.slip_across.update(contact.slip_across, time);
        if !mode.is_closed() {
            envelope.open += step_duration;
        }
    }
}
