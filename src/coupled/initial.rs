//! Where a run begins: the static state, and what moves at t = 0.

use super::load::{Load, SteppedLoad};
use super::scene::Scene;
use super::scene::base::Base;
use super::scene::model::Model;
use super::scene::stages::{self, Placement};
use super::scene::static_state::StaticState;
use super::scene::stepped_row::SteppedRow;
use super::state::State;
use crate::bem::Ground;
use crate::error::{Error, Result, all_finite, finite, same_length};
use crate::interface::{InterfaceLaw, Mode, StepStart, StepStarts};
use crate::linalg::matrix::SparseMatrix;
use crate::linalg::{SparseFactor, largest};
use crate::motion::STANDARD_GRAVITY;
use crate::structure::{Structure, Triplets};

/// Gap relative to the largest displacement below which an element is closed.
const CLOSED: f64 = 1e-12;

/// Weight, loads and initial motion.
pub(super) struct Beginning {
    pub(super) gravity: f64,
    pub(super) placement: Placement,
    pub(super) loads: Vec<Load>,
    /// Displacement and velocity of the unknowns at t = 0; empty for none.
    pub(super) displacement: Vec<f64>,
    pub(super) velocity: Vec<f64>,
}

impl Default for Beginning {
    fn default() -> Self {
        Self {
            gravity: STANDARD_GRAVITY,
            placement: Placement::default(),
            loads: Vec::new(),
            displacement: Vec::new(),
            velocity: Vec::new(),
        }
    }
}

impl Beginning {
    /// Refuses loads and motions of other unknowns than the structure's, and numbers that are not
    /// finite.
    pub(super) fn check(&self, unknowns: usize) -> Result<()> {
        let mut loads = self.loads.iter().enumerate();
        loads.try_for_each(|(index, load)| load.check(index, unknowns))?;
        for (values, quantity) in
            [(&self.displacement, "initial displacement"), (&self.velocity, "initial velocity")]
        {
            if !values.is_empty() {
                same_length(quantity, values.len(), unknowns)?;
                all_finite(quantity, values)?;
            }
        }
        Ok(())
    }

    /// Whether weight and loads are there before the run begins.
    fn is_static(&self) -> bool {
        self.gravity > 0.0 && self.placement != Placement::Unloaded
    }

    /// The state under weight and the loads at t = 0; trivial without gravity.
    pub(super) fn static_state(
        &self,
        laws: &[Box<dyn InterfaceLaw>],
        structure: &mut dyn Structure,
        ground: &dyn Ground,
        base: &Base,
        model: &Model,
    ) -> Result<StaticState> {
        let unknowns = model.unknowns;
        let mut state = StaticState::weightless(base.lengths().len(), unknowns);
        if self.is_static() {
            let mut own = vec![0.0; unknowns];
            structure.load(0.0, &mut own)?;
            all_finite("load of the structure at t = 0", &own)?;
            let mut load = own.clone();
            for external in &self.loads {
                SteppedRow::new(external.row().terms(), None).add(external.value(0.0), &mut load);
            }
            let weight = self.weight(model);
            all_finite("weight", &weight)?;
            all_finite("load at t = 0", &load)?;
            let stage = (model, &*structure, base);
            state = stages::solve(stage, ground, laws, self.placement, [&weight, &load])?;
            state.load = own;
            if let Some(force) = structure.nonlinear_mut() {
                force.commit(&state.displacement);
            }
        }
        (state.force, state.energy) = model.nonlinear_state(structure, &state.displacement)?;
        all_finite("nonlinear force at t = 0", &state.force)?;
        if let Some(energy) = &state.energy {
            finite("energy that the nonlinear force stores at t = 0", energy.stored)?;
            finite("energy that the nonlinear force has dissipated at t = 0", energy.dissipated)?;
        }
        Ok(state)
    }

    fn weight(&self, model: &Model) -> Vec<f64> {
        let mut weight = vec![0.0; model.coordinates];
        let [_, up] = model.influence.of_all(model.coordinates);
        model.mass.multiply_add(-self.gravity, &up, &mut weight);
        weight
    }

    /// Weight as a load, in stepped coordinates, if it is one.
    pub(super) fn stepped_weight(&self, model: &Model) -> Vec<f64> {
        let acts = self.gravity > 0.0 && self.placement == Placement::Unloaded;
        if acts { self.weight(model) } else { Vec::new() }
    }

    /// The loads in stepped coordinates.
    pub(super) fn stepped_loads(&mut self, model: &Model) -> Vec<SteppedLoad> {
        let is_static = self.is_static();
        let loads = std::mem::take(&mut self.loads).into_iter();
        loads.map(|load| SteppedLoad::new(load, model.modes.as_deref(), is_static)).collect()
    }

    /// Gravity as the laws may count on it at the start: zero where nothing presses.
    pub(super) fn static_gravity(&self) -> f64 {
        if self.is_static() { self.gravity } else { 0.0 }
    }

    /// Sets `state`, which is at rest, and the structure's internal variables in motion.
    pub(super) fn set_in_motion(
        &self,
        scene: &Scene,
        structure: &mut dyn Structure,
        state: &mut State,
    ) -> Result<()> {
        let falls = !scene.weight.is_empty();
        if self.displacement.is_empty() && self.velocity.is_empty() && !falls {
            return Ok(());
        }
        let mut mass = None;
        for (given, own) in [
            (&self.displacement, &mut state.motion.displacement),
            (&self.velocity, &mut state.motion.velocity),
        ] {
            if given.is_empty() {
                continue;
            }
            let Some(modes) = &scene.model.modes else {
                own.copy_from_slice(given);
                continue;
            };
            // Φᵀ M u.
            let mass = match &mass {
                Some(mass) => mass,
                None => mass.insert(assembled_mass(structure, given.len())?),
            };
            let mut momentum = vec![0.0; given.len()];
            mass.multiply_add(1.0, given, &mut momentum);
            modes.project(&momentum, own);
        }
        self.set_contact(scene, state)?;
        if let Some(force) = structure.nonlinear_mut() {
            force.commit(&seen(scene, state));
        }
        let c = &scene.coefficients;
        if [c.displacement, c.velocity, c.acceleration, c.new_velocity, c.new_acceleration]
            .iter()
            .any(|row| row[2] != 0.0)
        {
            state.motion.acceleration = acceleration(scene, structure, state)?;
        }
        state.motion.changed();
        state.update_resultants(scene);
        Ok(())
    }

    /// Gaps, slips and modes of the displaced base.
    fn set_contact(&self, scene: &Scene, state: &mut State) -> Result<()> {
        let count = scene.count();
        let [mut moved, mut rate] = [(); 2].map(|()| vec![0.0; 2 * count]);
        scene.base.means(&state.motion.displacement, &mut moved);
        scene.base.means(&state.motion.velocity, &mut rate);
        let closed = CLOSED * largest(&self.displacement);
        let moves = moved.iter().find(|means| means.abs() > closed);
        if let Some(&value) = moves.filter(|_| self.is_static()) {
            return Err(Error::Input {
                quantity: "initial displacement of the base, m",
                value,
                needed: "zero where weight holds it on the ground (begin with \
                         `Placement::Unloaded`, or with a load that is released)",
            });
        }
        if !self.is_static() {
            let mut starts = Vec::with_capacity(count);
            for (e, (contact, mode)) in state.contact.iter_mut().zip(&mut state.modes).enumerate() {
                contact.gap = -moved[e];
                contact.slip = moved[count + e];
                if contact.gap < -closed {
                    return Err(Error::Input {
                        quantity: "gap of an element under the initial displacement, m",
                        value: contact.gap,
                        needed: "zero or more",
                    });
                }
                if contact.gap > closed {
                    if !scene.law(e).modes().contains(&Mode::Open) {
                        return Err(Error::Scene {
                            quantity: "initial displacement",
                            needed: "must leave the base on the ground where the interface law \
                                     does not open",
                        });
                    }
                    *mode = Mode::Open;
                }
                starts.push(StepStart::new(*contact, *mode, scene.time_step));
            }
            state.start = StepStarts::new(&scene.laws, &starts)?;
        }
        state.start.slip_rates_mut().zip(&rate[count..]).for_each(|(own, rate)| *own = *rate);
        Ok(())
    }
}

/// The displacement that the nonlinear force sees at t = 0.
pub(super) fn seen(scene: &Scene, state: &State) -> Vec<f64> {
    let mut seen = state.motion.displacement.clone();
    let mut means = vec![0.0; 2 * scene.count()];
    let translations = state.motion.translations.iter().map(|y| y.displacement);
    scene.seen_by_force(&mut seen, &mut means, translations);
    seen
}

fn assembled_mass(structure: &dyn Structure, unknowns: usize) -> Result<SparseMatrix> {
    SparseMatrix::assembled("mass matrix", unknowns, &|m| structure.mass(m))
}

/// a of M a + C v + K u + f(u) = p at t = 0, before the soil has answered.
fn acceleration(scene: &Scene, structure: &dyn Structure, state: &State) -> Result<Vec<f64>> {
    let model = &scene.model;
    let mut force = vec![0.0; model.coordinates];
    let mut scratch = vec![0.0; model.unknowns];
    model.load(structure, 0.0, &scene.static_state.load, &mut scratch, &mut force)?;
    scene.add_loads(0.0, &mut force);
    let mut displacement = state.motion.displacement.clone();
    scene.subtract_base(&mut displacement, &mut vec![0.0; 2 * scene.count()]);
    model.stiffness.multiply_add(-1.0, &displacement, &mut force);
    model.damping.multiply_add(-1.0, &state.motion.velocity, &mut force);
    let (nonlinear, _) = model.nonlinear_state(structure, &seen(scene, state))?;
    for (force, (now, at_rest)) in
        force.iter_mut().zip(nonlinear.iter().zip(&scene.static_state.force))
    {
        *force -= now - at_rest;
    }
    if model.modes.is_none() {
        let mut mass = Triplets::new(model.unknowns);
        model.mass.add_to(1.0, &mut mass);
        SparseFactor::new("mass matrix, for the acceleration at t = 0", &mass)?.solve(&mut force);
    }
    Ok(force)
}
