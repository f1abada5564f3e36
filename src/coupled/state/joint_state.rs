//! One joint after a step: contact of its elements, forces and motion.

use super::transition::Transition;
use crate::coupled::base::PlacedBase;
use crate::coupled::base::joint_line::PlacedJoint;
use crate::geometry::{ContactElement, enclosing_interval, middle};
use crate::interface::{ContactState, Mode};

/// Contact, forces and motion of one joint.
///
/// Forces act from the upper side **on the lower side**, per metre of thickness. See [`Joint`](crate::coupled::Joint) for
/// the sense of slip and shear.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct JointState {
    /// Opening and total traction of each element.
    pub contact: Vec<ContactState>,
    /// Mode of each element.
    pub modes: Vec<Mode>,
    /// Changes of modes in this step; elements count from 0 in the joint.
    pub transitions: Vec<Transition>,
    /// Total pressure, positive in compression, N/m.
    pub normal_force: f64,
    /// Force along the joint, in the sense of its nodes, N/m.
    pub shear_force: f64,
    /// Moment of the pressures about the middle of the joint, N·m/m.
    ///
    /// Positive if the pressure is larger before the middle, in the sense of the nodes: counter-clockwise on the lower
    /// side of a horizontal joint that is listed from left to right.
    pub moment: f64,
    /// Length of open elements over the length of the joint.
    pub open_fraction: f64,
    /// Slip averaged over the length of the joint, m.
    pub mean_slip: f64,
    /// Largest gap of an element, m.
    pub largest_gap: f64,
    /// Energy lost by friction and impact since t = 0, J/m.
    ///
    /// It is NaN if the energy balance is omitted. It is the joint's part of
    /// [`EnergyBalance::contact`](crate::coupled::EnergyBalance::contact).
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub contact_energy: f64,
}

impl JointState {
    /// Contact of all joints at rest, from that of all elements.
    pub(crate) fn all_at_rest(
        base: &PlacedBase,
        contact: &[ContactState],
        modes: &[Mode],
    ) -> Vec<Self> {
        base.joints().iter().map(|joint| Self::at_rest(joint, contact, modes)).collect()
    }

    /// Contact of a joint at rest.
    fn at_rest(joint: &PlacedJoint, contact: &[ContactState], modes: &[Mode]) -> Self {
        let elements = joint.elements.clone();
        Self {
            contact: contact[elements.clone()].to_vec(),
            modes: modes[elements.clone()].to_vec(),
            transitions: Vec::with_capacity(elements.len()),
            ..Self::default()
        }
    }

    /// Sets the contact at the end of a step from that of all elements.
    pub(crate) fn advance(
        &mut self,
        joint: &PlacedJoint,
        contact: &[ContactState],
        modes: &[Mode],
        step: usize,
        time: f64,
    ) {
        self.contact.copy_from_slice(&contact[joint.elements.clone()]);
        self.transitions.clear();
        let ends = modes[joint.elements.clone()].iter();
        for (element, (from, &to)) in self.modes.iter_mut().zip(ends).enumerate() {
            if *from != to {
                self.transitions.push(Transition { step, time, element, from: *from, to });
                *from = to;
            }
        }
    }

    /// Computes forces, opening and slip from the contact of the elements.
    pub(crate) fn update_resultants(&mut self, joint: &PlacedJoint, base: &PlacedBase) {
        let areas = &base.areas()[joint.elements.clone()];
        let elements = joint.line.elements();
        let length: f64 = areas.iter().sum();
        let joint_middle = middle(enclosing_interval(elements.iter().map(ContactElement::span)));
        let mut sums = Self::default();
        for ((element, area), (state, mode)) in
            elements.iter().zip(areas).zip(self.contact.iter().zip(&self.modes))
        {
            sums.normal_force += area * state.pressure;
            sums.shear_force += area * state.shear;
            sums.moment -= area * state.pressure * (middle(element.span()) - joint_middle);
            sums.mean_slip += area * state.slip / length;
            sums.largest_gap = sums.largest_gap.max(state.gap);
            if !mode.is_closed() {
                sums.open_fraction += area / length;
            }
        }
        let Self {
            normal_force, shear_force, moment, open_fraction, mean_slip, largest_gap, ..
        } = sums;
        self.normal_force = normal_force;
        self.shear_force = shear_force;
        self.moment = moment;
        self.open_fraction = open_fraction;
        self.mean_slip = mean_slip;
        self.largest_gap = largest_gap;
    }
}
