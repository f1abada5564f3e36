//! GOAL: what interface laws remember is saved and resumed.
//! SCENE: friction that falls with the distance slid, glue that breaks once, and pads that soften, on
//! springs and half-plane.
//! REFERENCE: the uninterrupted run, to the last bit; typed errors for other memories.

use basemat::Simulation;
use basemat::coupled::CheckpointError;
use basemat::coupled::SimulationBuilder;
use basemat::history::HistoryMethod;
use basemat::interface::InPlane;

use super::{STEPS, carried, half_plane, refusal, spring_bed};
use basemat_problems::laws_with_memory::{Adhesion, SlipWeakening, SofteningPads};
use basemat_problems::scenes::{SI, block, friction, scene};

const WEAKENING: SlipWeakening = SlipWeakening { first: 0.35, residual: 0.15, distance: 0.05 };
const GLUE: Adhesion = Adhesion { friction: 0.3, strength: 2e4, breaks_by_sliding: true };
const PADS: SofteningPads = SofteningPads { stiffness: [6e7, 3e7], softening: 2e5 };

fn base() -> SimulationBuilder {
    scene(SI, 0.6).structure(block(SI)).ground(spring_bed())
}

#[test]
fn memories_resume_to_the_last_bit() {
    type Kind = (&'static str, Box<dyn Fn() -> Simulation>);
    let on_half_plane = || base().ground(half_plane(HistoryMethod::Direct));
    let kinds: [Kind; 4] = [
        ("weakening", Box::new(|| base().interface(WEAKENING).build().unwrap())),
        ("glue", Box::new(move || on_half_plane().interface(GLUE).build().unwrap())),
        ("pads", Box::new(|| base().interface(InPlane(PADS)).build().unwrap())),
        (
            "no energy balance",
            Box::new(|| base().interface(InPlane(PADS)).without_energy_balance().build().unwrap()),
        ),
    ];
    for (name, build) in kinds {
        let memory = |simulation: &Simulation| -> Vec<f64> {
            let count = simulation.ground().elements().len();
            (0..count).flat_map(|e| simulation.state().state_variables(e).to_vec()).collect()
        };
        let mut whole = build();
        let mut saved = vec![whole.checkpoint().unwrap()];
        let mut memories = vec![memory(&whole)];
        for part in [60, STEPS / 2 - 60, STEPS - STEPS / 2] {
            whole.run(part, |_| {}).unwrap();
            saved.push(whole.checkpoint().unwrap());
            memories.push(memory(&whole));
        }
        assert!(memories[1] != memories[3], "{name}: nothing was remembered");
        for (checkpoint, memory_then) in saved.iter().zip(&memories) {
            // New, and used and then put back.
            let mut used = build();
            used.run(STEPS, |_| {}).unwrap();
            for mut other in [build(), used] {
                other.resume(&carried(checkpoint)).unwrap();
                assert_eq!(&memory(&other), memory_then, "{name}");
                other.run(STEPS - checkpoint.steps(), |_| {}).unwrap();
                assert_eq!(other.state().contact, whole.state().contact, "{name}");
                assert_eq!(other.checkpoint().unwrap(), saved[3], "{name}");
            }
        }
    }
}

#[test]
fn other_memories_are_refused() {
    let mut simulation = base().interface(WEAKENING).build().unwrap();
    simulation.run(20, |_| {}).unwrap();
    let quantity = "state variables of the interface laws";
    for other in [base().interface(GLUE), base().interface(friction(0.3))] {
        let checkpoint = other.build().unwrap().checkpoint().unwrap();
        let found = refusal(&mut simulation, &checkpoint);
        assert_eq!(found, CheckpointError::OtherScene { quantity });
    }
}

#[test]
fn damaged_memories_are_refused() {
    use super::sum::sealed;
    use serde_json::Value;

    let mut simulation = base().interface(WEAKENING).build().unwrap();
    simulation.run(20, |_| {}).unwrap();
    let good = serde_json::to_value(simulation.checkpoint().unwrap()).unwrap();
    for damage in 0..3 {
        let mut value = good.clone();
        let list = value["laws"].as_array_mut().unwrap();
        match damage {
            0 => list.truncate(list.len() - 1),
            1 => list.push(Value::from(0_u64)),
            _ => list[1] = Value::from(f64::NAN.to_bits()),
        }
        let bad = sealed(value).unwrap();
        let quantity = "state variables of the interface laws";
        assert_eq!(refusal(&mut simulation, &bad), CheckpointError::Corrupt { quantity });
    }
}
