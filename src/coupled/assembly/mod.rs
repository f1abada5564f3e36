//! Build of a simulation, in the order of [`SimulationBuilder::build`].
//!
//! 1. `parts.rs`: the builder's parts, each checked alone;
//! 2. `model/assembled.rs`: matrices, base and influence vectors of the structure, in its own degrees of freedom;
//! 3. `at_rest.rs`, `static_stages.rs`: weight first, then the loads at t = 0, by the search of `statics/equilibrium.rs`;
//!    `flexible_base.rs` compares the result with the static state on twice the elements if these may be too few;
//! 4. `stepped.rs`: choice of the coordinates; matrices, base and operators in them; `vibration_modes.rs` computes
//!    all modes, `krylov.rs` and `many_forces.rs` Ritz modes;
//! 5. `scene.rs`: the scene; `initial_motion.rs`: the motion at t = 0.

mod at_rest;
mod backfilled;
mod fixed_base_results;
mod flexible_base;
mod growing_weight;
mod initial_motion;
mod krylov;
mod many_forces;
mod p_delta_damping;
mod settled;
mod static_stages;
mod step_response;
mod stepped;
mod subspace;
mod unseen_shape;
mod vibration_modes;

use std::cell::RefCell;

use crate::coupled::assembly::fixed_base_results::FixedBaseResults;
use crate::coupled::assembly::stepped::Stepped;
use crate::coupled::base::tears;
use crate::coupled::builder::SimulationBuilder;
use crate::coupled::conditioning::conditioning;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::supports;
use crate::coupled::parts::Parts;
use crate::coupled::run::mistake::Mistake;
use crate::coupled::run::warning::Warning;
use crate::coupled::run::{Weight, wall_pressure};
use crate::coupled::scene::Scene;
use crate::coupled::simulation::Simulation;
use crate::coupled::state::State;
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::statics::compliance::Compliance;
use crate::coupled::step::energy_accumulator::EnergyAccumulator;
use crate::coupled::step::forcing::Forcing;
use crate::coupled::step::increment::Increment;
use crate::coupled::step::solver::Solver;
use crate::error::Result;

impl Simulation {
    /// Starts a simulation with steps of `time_step` seconds.
    pub fn builder(time_step: f64) -> SimulationBuilder {
        SimulationBuilder::new(time_step)
    }
}

impl SimulationBuilder {
    /// Checks the parts against each other, finds the static state and factors constant matrices.
    ///
    /// # Errors
    /// * the typed error of a part that is wrong, [`crate::Error::Scene`] for a missing part;
    /// * [`StructureError::Restrained`](crate::structure::StructureError::Restrained) for a structure held by more than the ground, [`StructureError::Detached`](crate::structure::StructureError::Detached) for
    ///   one with a part that is not connected to its base, [`crate::Error::Indefinite`] for a negative mass or
    ///   damping, or a stiffness that is negative with the base held;
    /// * [`crate::Error::Item`] and [`crate::Error::DuplicateName`] for a probe of a degree of freedom that does
    ///   not exist or a name that occurs twice;
    /// * [`crate::Error::Stability`] if the structure cannot stand under weight and the loads at t = 0, or buckles on its
    ///   ground (P–Δ), without gravity and without a static state too;
    ///   [`crate::Error::Preload`] if no equilibrium was found for another reason;
    /// * [`crate::Error::CoarseBase`] for a flexible base on so few contact elements that twice as many change its
    ///   static shape by more than 30 %;
    /// * [`crate::Error::IllConditioned`] if double precision is insufficient for the scene;
    /// * [`crate::Error::Law`] for an interface law that returns numbers which are not finite;
    /// * [`crate::Error::Memory`] for more expected steps than fit into the memory of the ground's history;
    /// * [`crate::Error::Stopped`] by the observer.
    pub fn build(self) -> Result<Simulation> {
        let mut parts = Parts::new(self)?;
        let (assembled, fixed_factor) = Assembled::new(parts.structure.as_ref(), &parts.elements)?;
        let mut fixed_base = FixedBaseResults::new(&parts, &assembled, fixed_factor)?;
        let shared = RefCell::default();
        let at_rest = at_rest::solve(&mut parts, &assembled, &mut fixed_base.condensed, &shared)?;
        let models = (&assembled, fixed_base.condensed.as_ref());
        let coarse = flexible_base::check(&parts, models, &at_rest, &shared)?;
        let floating = shared.take().map(|compliance: Compliance| compliance.floating);
        let structure = parts.structure.as_ref();
        let positive_definite = fixed_base.positive_definite(&assembled, floating.as_deref());
        assembled.check_damping(structure, positive_definite)?;
        let reduction = fixed_base.take_for_reduction(&assembled, floating);
        let Assembled { stiffness, influence, .. } = &assembled;
        let motion: [&[f64]; 2] = [&at_rest.displacement, &at_rest.force];
        let joined = supports::joined_by_force(structure, stiffness, influence, motion)?;
        let Stepped { model, base, operators } =
            Stepped::choose(&parts, &assembled, reduction, &at_rest)?;
        let scene = Scene::new(&mut parts, model, base, at_rest, joined);

        let Parts { mut structure, ground, description, builder, first_order_ground, .. } = parts;
        let mut solver = Solver::new(&scene, operators, builder.search);
        let mut state = State::at_rest(&scene)?;
        let compliant = scene.is_compliant(&state.start)?;
        let mass = &assembled.mass;
        initial_motion::set_in_motion(&builder, mass, &scene, structure.as_mut(), &mut state)?;
        let mut energy = None;
        if builder.energy_balance {
            energy = Some(EnergyAccumulator::new(&scene, structure.as_ref(), &state, compliant)?);
        }
        state.energy_balance =
            energy.as_ref().map_or(EnergyBalance::LEFT_OUT, |energy| energy.energy_balance);
        let mut warnings =
            Warning::of_scene(&scene, &description, builder.motion.as_ref(), fixed_base.period);
        warnings.extend(first_order_ground.then_some(Warning::Mistake(Mistake::FirstOrderGround)));
        let weight = Weight::new(builder.gravity, &assembled);
        let soils = &description.soils;
        Warning::add_mistakes(&mut warnings, &scene, soils, structure.as_ref(), &weight);
        warnings.extend(Warning::of_tears(tears(&structure.base())?));
        warnings.extend(coarse);
        let pressures_above =
            wall_pressure::pressures_above(&scene, &description.mass_above, builder.gravity);
        let conditioning = conditioning(&scene, &mut solver, &state.start)?;
        // Checked last: stiffnesses too far apart for double precision look like a mechanism.
        fixed_base.is_firm?;
        Ok(Simulation {
            forcing: Forcing::new(&scene),
            increment: Increment::new(&scene, &state, compliant && builder.energy_balance),
            energies: energy,
            motion: builder.motion,
            structure,
            ground,
            scene,
            solver,
            state,
            conditioning,
            warnings,
            pressures_above,
            drag: assembled.drag(),
            rotation_limit: builder.rotation_limit,
            expected_steps: builder.steps,
            prepared: builder.steps,
        })
    }
}
