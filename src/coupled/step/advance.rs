//! The state at rest, its advance to the end of a step, and its resultants.

use crate::contact::SearchMethod;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scene::Scene;
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::state::foundation::{ContactSums, Foundation, FoundationChecks};
use crate::coupled::state::joint_state::JointState;
use crate::coupled::state::{ResultContext, SimulationId, State, Transition};
use crate::coupled::step::forcing::Forcing;
use crate::coupled::step::increment::Increment;
use crate::error::Result;
use crate::interface::{ContactState, PreviousContact, PreviousContacts};

impl State {
    /// The state before the first step: the static state.
    pub(crate) fn at_rest(scene: &Scene) -> Result<Self> {
        let model = &scene.model;
        let element_count = scene.element_count();
        let static_state = &scene.static_state;
        let contact: Vec<_> = (0..element_count)
            .map(|e| {
                ContactState::from_components(
                    |component| if component == 0 { static_state.gap[e] } else { -0.0 },
                    |component| static_state.traction[scene.layout().index_of(component, e)],
                    scene.layout().is_plan(),
                )
            })
            .collect();
        let modes = static_state.initial_modes(&scene.laws);
        let previous_contacts: Vec<_> = (0..element_count)
            .map(|e| {
                let previous = PreviousContact::new(contact[e], modes[e], scene.time_step);
                let variables = static_state.state_variables.get(e);
                previous.with_state_variables(variables.map_or(&[], Vec::as_slice))
            })
            .collect();
        let start = PreviousContacts::new(&scene.laws, &previous_contacts)?;
        let mut foundations = Vec::new();
        for (_, elements) in scene.base.foundations() {
            foundations.push(Foundation { elements, ..Foundation::default() });
        }
        let ground_count = scene.base.elements().len();
        let mut state = Self {
            step: 0,
            time: 0.0,
            checks: vec![FoundationChecks::default(); scene.context.footings.len()],
            simulation: SimulationId::new(),
            context: scene.context.clone(),
            kinematics: Kinematics::new(model),
            contact: contact[..ground_count].to_vec(),
            modes: modes[..ground_count].to_vec(),
            transitions: Vec::with_capacity(element_count),
            probes: vec![0.0; scene.context.probes.len()],
            base_shear: 0.0,
            base_moment: 0.0,
            normal_force: 0.0,
            uplifted_fraction: 0.0,
            mean_slip: 0.0,
            base_rotation: 0.0,
            foundations,
            joints: JointState::all_at_rest(&scene.base, &contact, &modes),
            free_field: [0.0; 2],
            free_field_across: 0.0,
            energy_balance: EnergyBalance::default(),
            trials: 0,
            method: SearchMethod::ActiveSet,
            start,
        };
        state.update_resultants(scene);
        Ok(state)
    }

    /// Advances to the end of the step that `increment` solved.
    ///
    /// The buffers of displacement, velocity and acceleration are swapped with the buffers of `increment`.
    pub(crate) fn advance(&mut self, scene: &Scene, forcing: &Forcing, increment: &mut Increment) {
        self.step += 1;
        self.time = self.step as f64 * scene.time_step;
        let kinematics = &mut self.kinematics;
        std::mem::swap(&mut kinematics.displacement, &mut increment.end_displacement);
        std::mem::swap(&mut kinematics.velocity, &mut increment.end_velocity);
        std::mem::swap(&mut kinematics.acceleration, &mut increment.end_acceleration);
        kinematics.translations.copy_from_slice(&forcing.translations);
        kinematics.clear_dof_cache();
        let free_field = scene.base.mean_displacement(&forcing.free_field);
        self.free_field = [free_field[0], free_field[1]];
        self.free_field_across = free_field[2];
        let ground_count = self.contact.len();
        self.contact.copy_from_slice(&increment.contact[..ground_count]);
        self.transitions.clear();
        let step = self.step;
        let time = self.time;
        for (element, (from, &to)) in self.modes.iter_mut().zip(&increment.modes).enumerate() {
            if *from != to {
                self.transitions.push(Transition { step, time, element, from: *from, to });
                *from = to;
            }
        }
        let Increment { contact, modes, state_variables, .. } = &*increment;
        for (state, joint) in self.joints.iter_mut().zip(scene.base.joints()) {
            state.advance(joint, contact, modes, step, time);
        }
        self.start.advance(contact, modes, state_variables);
        self.trials = increment.trials;
        self.method = increment.method;
        self.update_resultants(scene);
        for (k, foundation) in self.foundations.iter_mut().enumerate() {
            foundation.add_rocking_work(scene.base.rotations(k, &increment.displacement));
        }
    }

    /// Computes the resultants, rotations and probes of the present state.
    pub(crate) fn update_resultants(&mut self, scene: &Scene) {
        let state = self;
        let Kinematics { displacement, velocity, acceleration, .. } = &state.kinematics;
        // Base shear, normal force and base moment.
        let mut resultants = [0.0; 3];
        let mut sums = ContactSums::default();
        state.base_rotation = 0.0;
        for (k, foundation) in state.foundations.iter_mut().enumerate() {
            let ResultContext { elements, friction, footings, .. } = &*state.context;
            let footing = &footings[k];
            let (foundation_sums, checks) =
                foundation.update(footing, elements, friction, &state.contact, &state.modes);
            sums.area += foundation_sums.area;
            sums.open_area += foundation_sums.open_area;
            sums.slip += foundation_sums.slip;
            let eccentric_moment = foundation.normal_force * footing.center[0];
            let moment = foundation.base_moment + footing.rotation_sign * eccentric_moment;
            let forces = [foundation.base_shear, foundation.normal_force, moment];
            for (sum, force) in resultants.iter_mut().zip(forces) {
                *sum += force;
            }
            let fields = [
                &mut foundation.base_rotation,
                &mut foundation.rotation_across,
                &mut foundation.twist,
            ];
            for (field, rotation) in fields.into_iter().zip(scene.base.rotations(k, displacement)) {
                *field = rotation;
            }
            foundation.settlement = scene.base.settlement(k, displacement);
            state.checks[k] = checks;
            if foundation.base_rotation.abs() > state.base_rotation.abs() {
                state.base_rotation = foundation.base_rotation;
            }
        }
        [state.base_shear, state.normal_force, state.base_moment] = resultants;
        state.uplifted_fraction = sums.open_area / sums.area;
        state.mean_slip = sums.slip / sums.area;
        for (joint_state, joint) in state.joints.iter_mut().zip(scene.base.joints()) {
            joint_state.update_resultants(joint, &scene.base);
        }
        let translations = &state.kinematics.translations;
        for (value, probe) in state.probes.iter_mut().zip(&scene.stepped_probes) {
            let [u, v, a] = &probe.weights;
            let pairs = probe.rigid_displacements.iter().zip(translations);
            let terms = pairs.map(|(r, translation)| {
                let y = translation.displacement;
                r[0] * y[0] + r[1] * y[1] + r[2] * y[2]
            });
            let rigid_displacement: f64 = terms.sum();
            *value = u.value(displacement)
                + v.value(velocity)
                + a.value(acceleration)
                + rigid_displacement;
        }
    }
}
