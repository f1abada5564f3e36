//! Build of a simulation, in the order of [`SimulationBuilder::build`].
//!
//! 1. `parts.rs`: the builder's parts, each checked separately;
//! 2. `model/assembled.rs`: matrices, base and influence vectors of the structure, in degrees of freedom;
//! 3. `at_rest.rs`, `static_stages.rs`: the static state under the weight, then under the loads at t = 0, by the search of
//!    `statics/equilibrium.rs`; if the elements may be too few, `flexible_base.rs` compares this state with that on twice
//!    the elements;
//! 4. `stepped.rs`: choice of the coordinates; matrices, base and operators in these coordinates. `vibration_modes.rs`
//!    computes all modes, `krylov.rs` and `many_forces.rs` compute Ritz modes;
//! 5. `scene.rs`: the scene; `initial_motion.rs`: the motion at t = 0.

mod at_rest;
mod backfilled;
mod buoyancy;
mod extended_subspace;
mod fixed_base_results;
mod flexible_base;
mod growing_weight;
mod initial_motion;
mod krylov;
mod many_forces;
mod p_delta_damping;
mod response_rows;
mod settled;
pub(crate) mod static_push;
mod static_stages;
mod step_response;
mod stepped;
mod subspace;
mod vibration_modes;
mod zero_mean_shape;

use std::cell::RefCell;

use crate::coupled::assembly::fixed_base_results::FixedBaseResults;
use crate::coupled::assembly::stepped::SteppedStructure;
use crate::coupled::base::tears;
use crate::coupled::builder::SimulationBuilder;
use crate::coupled::conditioning::conditioning;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::operators::Operators;
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
use crate::coupled::step::joint_losses::JointLosses;
use crate::coupled::step::solver::StepSolver;
use crate::error::Result;

impl Simulation {
    /// Starts a simulation with steps of `time_step` seconds.
    pub fn builder(time_step: f64) -> SimulationBuilder {
        SimulationBuilder::new(time_step)
    }
}

impl SimulationBuilder {
    /// Checks the parts, computes the static state and factors constant matrices.
    ///
    /// # Errors
    /// * the typed error of an invalid part, [`crate::Error::Scene`] for a missing part;
    /// * [`StructureError::Restrained`](crate::structure::StructureError::Restrained) for a structure with a support besides
    ///   the ground, [`StructureError::Detached`](crate::structure::StructureError::Detached) for a structure with a part
    ///   that is not connected to its base, [`crate::Error::Indefinite`] for a negative mass or damping, or a stiffness that
    ///   is negative with a fixed base;
    /// * [`crate::Error::Item`] and [`crate::Error::DuplicateName`] for a probe of a degree of freedom that does
    ///   not exist or a name that occurs twice;
    /// * [`crate::Error::Stability`] if the structure has no equilibrium under its weight and the loads at t = 0, or buckles
    ///   on its ground (P–Δ), also without gravity or a static state;
    ///   [`crate::Error::Preload`] if the search finds no equilibrium for an unknown reason;
    /// * [`crate::Error::CoarseBase`] for a flexible base on too few contact elements: twice as many change its static shape
    ///   by more than 30 %;
    /// * [`crate::Error::IllConditioned`] if double precision is insufficient for the scene;
    /// * [`crate::Error::Law`] for an interface law that returns numbers which are not finite;
    /// * [`crate::Error::Memory`] for more expected steps than fit into the memory of the ground's history;
    /// * [`crate::Error::Stopped`] by the observer.
    pub fn build(self) -> Result<Simulation> {
        let mut parts = Parts::new(self)?;
        let (assembled, fixed_factor) =
            Assembled::new(parts.structure.as_ref(), &parts.elements, &parts.joints)?;
        parts.spread_over_joints(&assembled.base);
        buoyancy::set_water_force(&mut parts, &assembled)?;
        let mut fixed_base = FixedBaseResults::new(&parts, &assembled, fixed_factor)?;
        let shared_compliance = RefCell::default();
        let static_state = at_rest::solve(
            &mut parts,
            &assembled,
            &mut fixed_base.condensation,
            &shared_compliance,
        )?;
        let structures = (&assembled, fixed_base.condensation.as_ref());
        let coarse_base_warning =
            flexible_base::check(&parts, structures, &static_state, &shared_compliance)?;
        let shifted_stiffness =
            shared_compliance.take().map(|compliance: Compliance| compliance.factor);
        let structure = parts.structure.as_ref();
        let positive_definite_stiffness =
            fixed_base.positive_definite_stiffness(&assembled, shifted_stiffness.as_deref());
        assembled.check_damping(structure, positive_definite_stiffness)?;
        let reduction = fixed_base.take_reduction_input(&assembled, shifted_stiffness);
        let is_connected_by_force = supports::parts_connected_by_force(
            structure,
            &assembled.stiffness,
            &assembled.influence,
            &static_state.displacement,
            &static_state.force,
        )?;
        let SteppedStructure { model, base, operators, step_compliance } =
            SteppedStructure::new(&parts, &assembled, reduction, &static_state)?;
        parts.step_compliance = step_compliance;
        let scene = Scene::new(&mut parts, model, base, static_state, is_connected_by_force);
        start(parts, &assembled, fixed_base, scene, operators, coarse_base_warning)
    }
}

/// Starts the simulation of a scene at t = 0.
fn start(
    parts: Parts,
    assembled: &Assembled,
    fixed_base: FixedBaseResults,
    scene: Scene,
    operators: Operators,
    coarse_base_warning: Option<Warning>,
) -> Result<Simulation> {
    let water_below_base = buoyancy::warning(&parts);
    let Parts { mut structure, ground, description, builder, is_first_order_ground, .. } = parts;
    let mut solver = StepSolver::new(&scene, operators, builder.search);
    let mut state = State::at_rest(&scene)?;
    let is_compliant = scene.is_compliant(&state.start)?;
    let mass = &assembled.mass;
    initial_motion::set_initial_motion(&builder, mass, &scene, structure.as_mut(), &mut state)?;
    let mut energies = None;
    if builder.has_energy_balance {
        energies = Some(EnergyAccumulator::new(&scene, structure.as_ref(), &state, is_compliant)?);
    }
    JointLosses::set(energies.as_ref().map(|energies| &energies.joint_losses), &mut state);
    state.energy_balance =
        energies.as_ref().map_or(EnergyBalance::ALL_NAN, |energies| energies.energy_balance);
    let mut warnings =
        Warning::of_scene(&scene, &description, builder.motion.as_ref(), fixed_base.period);
    warnings.extend(is_first_order_ground.then_some(Warning::Mistake(Mistake::FirstOrderGround)));
    let weight = Weight::new(builder.gravity, assembled);
    let soils = &description.soils;
    Warning::add_mistakes(&mut warnings, &scene, soils, structure.as_ref(), &weight);
    warnings.extend(Warning::of_tears(tears(&structure.base())?));
    warnings.extend(coarse_base_warning);
    warnings.extend(water_below_base);
    let pressures_above =
        wall_pressure::pressures_above(&scene, &description.mass_above, builder.gravity);
    let conditioning = conditioning(&scene, &mut solver, &state.start)?;
    // The check for mechanisms comes last. Stiffnesses too different for double precision look like a mechanism and
    // have an error of their own.
    fixed_base.mechanism_check?;
    Ok(Simulation {
        forcing: Forcing::new(&scene),
        increment: Increment::new(&scene, &state, is_compliant && builder.has_energy_balance),
        energies,
        motion: builder.motion,
        structure,
        ground,
        scene,
        solver,
        state,
        conditioning,
        warnings,
        pressures_above,
        translation_damping_rate: assembled.translation_damping_rate(),
        rotation_limit: builder.rotation_limit,
        expected_steps: builder.expected_steps,
        prepared_steps: builder.expected_steps,
    })
}
