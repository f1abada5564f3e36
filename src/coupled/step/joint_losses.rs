//! Energy lost by friction and impact in each joint.

use crate::coupled::scene::Scene;
use crate::coupled::state::State;

/// Energy lost in each joint since t = 0, J/m.
#[derive(Clone)]
pub(crate) struct JointLosses(pub(super) Vec<f64>);

impl JointLosses {
    /// No losses of the joints of a scene.
    pub(super) fn new(scene: &Scene) -> Self {
        Self(vec![0.0; scene.base.joints().len()])
    }

    /// Adds the loss of an element to its joint, if it belongs to one.
    #[inline]
    pub(super) fn add(&mut self, scene: &Scene, element: usize, loss: f64) {
        if element >= scene.base.elements().len() {
            self.0[scene.base.joint_of(element)] += loss;
        }
    }

    /// Sets the energies of the joints of a state; NaN without losses.
    pub(crate) fn set(losses: Option<&Self>, state: &mut State) {
        for (k, joint) in state.joints.iter_mut().enumerate() {
            joint.contact_energy = losses.map_or(f64::NAN, |losses| losses.0[k]);
        }
    }
}
