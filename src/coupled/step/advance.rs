//! Advance of the state to the end of an accepted step.

use crate::contact::SearchMethod;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scene::Scene;
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::state::foundation::{ContactSums, Foundation, FoundationChecks};
use crate::coupled::state::{Context, Origin, State, Transition};
use crate::coupled::step::forcing::Forcing;
use crate::coupled::step::increment::Increment;
use crate::error::Result;
use crate::interface::{ContactState, PreviousContact, PreviousContacts};

impl State {
    /// The static state.
    pub(crate) fn at_rest(scene: &Scene) -> Result<Self> {
        let model = &scene.model;
        let count = scene.count();
        let at = &scene.static_state;
        let contact: Vec<_> = (0..count)
            .map(|e| {
                ContactState::from_components(
                    |component| if component == 0 { at.gap[e] } else { -0.0 },
                    |component| at.traction[scene.layout().place(component, e)],
                    scene.layout().is_plan(),
                )
            })
            .collect();
        let modes = at.modes_with(&scene.laws);
        let start: Vec<_> = (0..count)
            .map(|e| {
                let start = PreviousContact::new(contact[e], modes[e], scene.time_step);
                start.with_state_variables(at.state_variables.get(e).map_or(&[], Vec::as_slice))
            })
            .collect();
        let start = PreviousContacts::new(&scene.laws, &start)?;
        let foundations = scene.base.foundations();
        let foundations =
            foundations.map(|(_, elements)| Foundation { elements, ..Foundation::default() });
        let mut state = Self {
            step: 0,
            time: 0.0,
            checks: vec![FoundationChecks::default(); scene.context.footings.len()],
            origin: Origin::new(),
            context: scene.context.clone(),
            kinematics: Kinematics::new(model),
            contact,
            modes,
            transitions: Vec::with_capacity(count),
            probes: vec![0.0; scene.context.probes.len()],
            base_shear: 0.0,
            base_moment: 0.0,
            normal_force: 0.0,
            uplifted_fraction: 0.0,
            mean_slip: 0.0,
            base_rotation: 0.0,
            foundations: foundations.collect(),
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
    /// Buffers of displacements, velocities and accelerations are swapped with the buffers of `increment`.
    pub(crate) fn advance(&mut self, scene: &Scene, forcing: &Forcing, increment: &mut Increment) {
        self.step += 1;
        self.time = self.step as f64 * scene.time_step;
        let kinematics = &mut self.kinematics;
        std::mem::swap(&mut kinematics.displacement, &mut increment.end);
        std::mem::swap(&mut kinematics.velocity, &mut increment.velocity);
        std::mem::swap(&mut kinematics.acceleration, &mut increment.acceleration);
        kinematics.translations.copy_from_slice(&forcing.translations);
        kinematics.changed();
        let free_field = scene.base.mean(&forcing.free_field);
        self.free_field = [free_field[0], free_field[1]];
        self.free_field_across = free_field[2];
        self.contact.copy_from_slice(&increment.contact);
        self.transitions.clear();
        let step = self.step;
        let time = self.time;
        for (element, (from, &to)) in self.modes.iter_mut().zip(&increment.modes).enumerate() {
            if *from != to {
                self.transitions.push(Transition { step, time, element, from: *from, to });
                *from = to;
            }
        }
        self.start.advance(&self.contact, &self.modes, &increment.state_variables);
        self.trials = increment.trials;
        self.method = increment.method;
        self.update_resultants(scene);
        for (k, foundation) in self.foundations.iter_mut().enumerate() {
            foundation.add_rocking_work(scene.base.rotations(k, &increment.displacement));
        }
    }

    /// Computes resultants and probes from the present state.
    pub(crate) fn update_resultants(&mut self, scene: &Scene) {
        let state = self;
        let Kinematics { displacement, velocity, acceleration, .. } = &state.kinematics;
        let mut total = [0.0; 3];
        let mut sums = ContactSums::default();
        state.base_rotation = 0.0;
        for (k, foundation) in state.foundations.iter_mut().enumerate() {
            let Context { elements, friction, footings, .. } = &*state.context;
            let footing = &footings[k];
            let (foundation_sums, checks) =
                foundation.update(footing, elements, friction, &state.contact, &state.modes);
            sums.area += foundation_sums.area;
            sums.open_area += foundation_sums.open_area;
            sums.slip += foundation_sums.slip;
            let lever = foundation.normal_force * footing.center[0];
            let moment = foundation.base_moment + footing.rotation_sign * lever;
            let forces = [foundation.base_shear, foundation.normal_force, moment];
            for (sum, force) in total.iter_mut().zip(forces) {
                *sum += force;
            }
            let components = [
                &mut foundation.base_rotation,
                &mut foundation.rotation_across,
                &mut foundation.twist,
            ];
            for (component, rotation) in
                components.into_iter().zip(scene.base.rotations(k, displacement))
            {
                *component = rotation;
            }
            foundation.settlement = scene.base.settlement(k, displacement);
            state.checks[k] = checks;
            if foundation.base_rotation.abs() > state.base_rotation.abs() {
                state.base_rotation = foundation.base_rotation;
            }
        }
        [state.base_shear, state.normal_force, state.base_moment] = total;
        state.uplifted_fraction = sums.open_area / sums.area;
        state.mean_slip = sums.slip / sums.area;
        let translations = &state.kinematics.translations;
        for (value, probe) in state.probes.iter_mut().zip(&scene.probe_rows) {
            let [u, v, a] = &probe.rows;
            let carried = probe.carried.iter().zip(translations).map(|(r, translation)| {
                let y = translation.displacement;
                r[0] * y[0] + r[1] * y[1] + r[2] * y[2]
            });
            let carried: f64 = carried.sum();
            *value = u.of(displacement) + v.of(velocity) + a.of(acceleration) + carried;
        }
    }
}
