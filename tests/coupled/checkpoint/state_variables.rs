//! GOAL: state variables of interface laws are saved and resumed.
//! SCENE: friction that falls with the distance slid, a bond that breaks once, and pads that soften, on springs and
//! half-plane.
//! REFERENCE: the uninterrupted run, to the last bit; typed errors for other state variables.

use basemat::Simulation;
use basemat::coupled::CheckpointError;
use basemat::coupled::SimulationBuilder;
use basemat::history::HistoryMethod;
use basemat::interface::InPlane;
use serde_json::Value;

use super::sum::sealed;
use super::{RUN_STEPS, half_plane, resume_error, spring_bed, through_text};
use basemat_problems::laws_with_memory::{BreakingBond, SlipWeakening, SofteningPads};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

const SLIP_WEAKENING: SlipWeakening = SlipWeakening { first: 0.35, residual: 0.15, distance: 0.05 };
const BREAKING_BOND: BreakingBond =
    BreakingBond { friction: 0.3, strength: 2e4, breaks_by_sliding: true };
const SOFTENING_PADS: SofteningPads = SofteningPads { stiffness: [6e7, 3e7], softening: 2e5 };

fn on_springs() -> SimulationBuilder {
    scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).ground(spring_bed())
}

/// State variables of all elements.
fn all_state_variables(simulation: &Simulation) -> Vec<f64> {
    let count = simulation.ground().elements().len();
    (0..count).flat_map(|e| simulation.state().state_variables(e).to_vec()).collect()
}

#[test]
fn state_variables_resume_to_the_last_bit() {
    type NamedScene = (&'static str, fn() -> SimulationBuilder);
    let scenes: [NamedScene; 4] = [
        ("weakening", || on_springs().interface(SLIP_WEAKENING)),
        ("bond", || {
            on_springs().ground(half_plane(HistoryMethod::Direct)).interface(BREAKING_BOND)
        }),
        ("pads", || on_springs().interface(InPlane(SOFTENING_PADS))),
        ("no energy balance", || {
            on_springs().interface(InPlane(SOFTENING_PADS)).without_energy_balance()
        }),
    ];
    for (name, builder) in scenes {
        let mut uninterrupted_simulation = builder().build().unwrap();
        let mut checkpoints = vec![uninterrupted_simulation.checkpoint().unwrap()];
        let mut variables = vec![all_state_variables(&uninterrupted_simulation)];
        for steps in [60, RUN_STEPS / 2 - 60, RUN_STEPS - RUN_STEPS / 2] {
            uninterrupted_simulation.run(steps, |_| {}).unwrap();
            checkpoints.push(uninterrupted_simulation.checkpoint().unwrap());
            variables.push(all_state_variables(&uninterrupted_simulation));
        }
        assert!(variables[1] != variables[3], "{name}: state variables do not change");
        for (checkpoint, saved_variables) in checkpoints.iter().zip(&variables) {
            // In a new simulation, and in one that was used before.
            let mut used_simulation = builder().build().unwrap();
            used_simulation.run(RUN_STEPS, |_| {}).unwrap();
            for mut resumed in [builder().build().unwrap(), used_simulation] {
                resumed.resume(&through_text(checkpoint)).unwrap();
                assert_eq!(&all_state_variables(&resumed), saved_variables, "{name}");
                resumed.run(RUN_STEPS - checkpoint.steps(), |_| {}).unwrap();
                assert_eq!(
                    resumed.state().contact,
                    uninterrupted_simulation.state().contact,
                    "{name}"
                );
                assert_eq!(resumed.checkpoint().unwrap(), checkpoints[3], "{name}");
            }
        }
    }
}

#[test]
fn other_state_variables_are_errors() {
    let mut simulation = on_springs().interface(SLIP_WEAKENING).build().unwrap();
    simulation.run(20, |_| {}).unwrap();
    let quantity = "state variables of the interface laws";
    for other_scene in
        [on_springs().interface(BREAKING_BOND), on_springs().interface(friction(0.3))]
    {
        let checkpoint = other_scene.build().unwrap().checkpoint().unwrap();
        let error = resume_error(&mut simulation, &checkpoint);
        assert_eq!(error, CheckpointError::OtherScene { quantity });
    }
}

#[test]
fn damaged_state_variables_are_errors() {
    let mut simulation = on_springs().interface(SLIP_WEAKENING).build().unwrap();
    simulation.run(20, |_| {}).unwrap();
    let intact_form = serde_json::to_value(simulation.checkpoint().unwrap()).unwrap();
    for damage in 0..3 {
        let mut form = intact_form.clone();
        let list = form["laws"].as_array_mut().unwrap();
        match damage {
            0 => list.truncate(list.len() - 1),
            1 => list.push(Value::from(0_u64)),
            _ => list[1] = Value::from(f64::NAN.to_bits()),
        }
        let damaged_checkpoint = sealed(form).unwrap();
        let quantity = "state variables of the interface laws";
        assert_eq!(
            resume_error(&mut simulation, &damaged_checkpoint),
            CheckpointError::Corrupt { quantity }
        );
    }
}
