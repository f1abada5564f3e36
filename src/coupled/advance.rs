//! Moving the state to the end of an accepted step.

use super::energy_balance::EnergyBalance;
use super::motion::Motion;
use super::scene::Scene;
use super::state::{Foundation, Origin, State, Transition};
use super::step::{Forcing, Increment};
use crate::contact::SearchMethod;
use crate::error::Result;
use crate::interface::{ContactState, PreviousContact, PreviousContacts};

impl State {
    /// The static state.
    pub(super) fn at_rest(scene: &Scene) -> Result<Self> {
        let (model, count) = (&scene.model, scene.count());
        let at = &scene.static_state;
        let contact: Vec<_> = (0..count)
            .map(|e| {
                let jump = |component| if component == 0 { at.gap[e] } else { -0.0 };
                let traction = |component| at.traction[scene.layout().place(component, e)];
                ContactState::from_components(jump, traction, scene.layout().is_plan())
            })
            .collect();
        let modes = at.modes_with(&scene.laws);
        let start: Vec<_> = (0..count)
            .map(|e| {
                let start = PreviousContact::new(contact[e], modes[e], scene.time_step);
                start.with_memory(at.memory.get(e).map_or(&[], Vec::as_slice))
            })
            .collect();
        let start = PreviousContacts::new(&scene.laws, &start)?;
        let foundations = scene.base.foundations();
        let foundations =
            foundations.map(|(_, elements)| Foundation { elements, ..Foundation::default() });
        let mut state = Self {
            step: 0,
            time: 0.0,
            origin: Origin::new(),
            context: scene.context.clone(),
            motion: Motion::new(model),
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

    /// Goes to the end of the step that `increment` solved; its buffers of displacements,
    /// velocities and accelerations are swapped.
    pub(super) fn advance(&mut self, scene: &Scene, forcing: &Forcing, increment: &mut Increment) {
        self.step += 1;
        self.time = self.step as f64 * scene.time_step;
        let motion = &mut self.motion;
        std::mem::swap(&mut motion.displacement, &mut increment.end);
        std::mem::swap(&mut motion.velocity, &mut increment.velocity);
        std::mem::swap(&mut motion.acceleration, &mut increment.acceleration);
        motion.translations.copy_from_slice(&forcing.translations);
        motion.changed();
        let [right, up, away] = scene.base.mean(&forcing.free_field);
        (self.free_field, self.free_field_across) = ([right, up], away);
        self.contact.copy_from_slice(&increment.contact);
        self.transitions.clear();
        let (step, time) = (self.step, self.time);
        for (element, (from, &to)) in self.modes.iter_mut().zip(&increment.modes).enumerate() {
            if *from != to {
                self.transitions.push(Transition { step, time, element, from: *from, to });
                *from = to;
            }
        }
        self.start.advance(&self.contact, &self.modes, &increment.memory);
        (self.trials, self.method) = (increment.trials, increment.method);
        self.update_resultants(scene);
    }

    /// Resultants and probes from the present state.
    pub(super) fn update_resultants(&mut self, scene: &Scene) {
        let state = self;
        let Motion { displacement, velocity, acceleration, .. } = &state.motion;
        let areas = scene.base.areas();
        let (mut total, mut all_open, mut all_slip, mut base) = ([0.0; 3], 0.0, 0.0, 0.0);
        state.base_rotation = 0.0;
        let footings = scene.context.footings.iter();
        for (k, (foundation, footing)) in state.foundations.iter_mut().zip(footings).enumerate() {
            let [mut shear, mut across, mut normal] = [0.0; 3];
            let [mut moment, mut moment_across, mut torque] = [0.0; 3];
            let [mut open, mut slip, mut slip_across, mut width] = [0.0; 4];
            for (e, [dx, dy]) in foundation.elements.clone().zip(&footing.arms) {
                let (contact, area) = (&state.contact[e], areas[e]);
                width += area;
                shear += area * contact.shear;
                across += area * contact.shear_across;
                normal += area * contact.pressure;
                slip += area * contact.slip;
                slip_across += area * contact.slip_across;
                moment -= area * contact.pressure * scene.arms[e];
                moment_across -= area * contact.pressure * dy;
                torque += area * (dx * contact.shear_across - dy * contact.shear);
                if !state.modes[e].is_closed() {
                    open += area;
                }
            }
            for (sum, own) in total.iter_mut().zip([shear, normal, moment]) {
                *sum += own;
            }
            all_open += open;
            all_slip += slip;
            base += width;
            let mut rotations = [0.0; 3];
            let found = scene.base.rotations(k, displacement);
            rotations.iter_mut().zip(found).for_each(|(own, rotation)| *own = rotation);
            let [base_rotation, rotation_across, twist] = rotations;
            *foundation = Foundation {
                elements: foundation.elements.clone(),
                base_shear: shear,
                base_moment: moment + normal * footing.center[0],
                normal_force: normal,
                uplifted_fraction: open / width,
                mean_slip: slip / width,
                base_rotation,
                shear_across: across,
                moment_across,
                torque,
                mean_slip_across: slip_across / width,
                rotation_across,
                twist,
            };
            if base_rotation.abs() > state.base_rotation.abs() {
                state.base_rotation = base_rotation;
            }
        }
        [state.base_shear, state.normal_force, state.base_moment] = total;
        state.uplifted_fraction = all_open / base;
        state.mean_slip = all_slip / base;
        let translations = &state.motion.translations;
        for (value, probe) in state.probes.iter_mut().zip(&scene.probe_rows) {
            let [u, v, a] = &probe.rows;
            let carried = probe.carried.iter().zip(translations);
            let by = |r: &[f64; 3], y: [f64; 3]| r[0] * y[0] + r[1] * y[1] + r[2] * y[2];
            let carried: f64 = carried.map(|(r, y)| by(r, y.displacement)).sum();
            *value = u.of(displacement) + v.of(velocity) + a.of(acceleration) + carried;
        }
    }
}
