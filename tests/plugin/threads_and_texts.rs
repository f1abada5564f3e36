//! GOAL: all parts can be printed, and a simulation can move to another thread.
//! SCENE: a block on springs, and parts by themselves.
//! REFERENCE: the words of the texts; a run on the other thread.

use std::sync::Arc;

use basemat::bem::{ElasticGround, Ground, PatchKernel, Strip};
use basemat::coupled::SimulationBuilder;
use basemat::history::DirectHistory;
use basemat::interface::Bonded;
use basemat::motion::TravellingWave;
use basemat::results::Run;
use basemat::structure::{StructureGroup, WithSprings};
use basemat::sweep::{Parameter, Sweep};
use basemat::{Error, Simulation};

use super::scene::{STEP, push, shaken, soil};
use basemat_problems::block_on_springs::{bed, block};

#[test]
fn all_parts_can_be_shown() {
    fn shown(part: &dyn std::fmt::Debug, words: &[&str]) {
        let text = format!("{part:?}");
        assert!(text.len() < 2000, "{text}");
        for word in words {
            assert!(text.contains(word), "{word} in {text}");
        }
    }
    let builder = || shaken().structure(block()).interface(Bonded);
    shown(&builder(), &["time_step: 0.002", "structure: true", "ground: false", "gravity: 9.81"]);
    // The error of a refused scene can be unwrapped.
    assert!(matches!(builder().build().unwrap_err(), Error::Scene { quantity: "ground", .. }));
    let mut simulation = builder().ground(bed(4)).build().unwrap();
    simulation.step().unwrap();
    shown(&simulation, &["dofs: 3", "elements: 4", "step: 1"]);
    let ground = || ElasticGround::new(soil(), Strip::uniform(-2.0..2.0, 6).unwrap()).unwrap();
    shown(&ground(), &["Soil", "elements: 6"]);
    let kernel = Arc::new(PatchKernel::new(soil(), ground().elements().to_vec(), STEP).unwrap());
    shown(&DirectHistory::new(kernel), &["elements: 6", "steps: 0"]);
    shown(&WithSprings::new(block()), &["dofs: 3", "springs: 0"]);
    shown(&StructureGroup::new(), &["structures: 0"]);
    shown(&TravellingWave::new(push(), 500.0, 1.0).unwrap(), &["500.0", "origin: 1.0"]);
    shown(&Sweep::new(3), &["count: 3"]);
    let sweep = Sweep::grid([Parameter::texts("record", ["El Centro"])]).unwrap();
    shown(&sweep, &["count: 1", "El Centro"]);
    let table = sweep.table(["slip_m"], |case| {
        shown(case, &["index: 0"]);
        Ok::<_, Error>([0.25])
    });
    let table = table.unwrap();
    shown(&table, &["slip_m", "0.25"]);
    shown(&table.rows().next().unwrap(), &["case: 0"]);
}

#[test]
fn simulations_can_move_between_threads() {
    fn is_send<T: Send>() {}
    fn is_sync<T: Sync>() {}
    is_send::<Simulation>();
    is_send::<SimulationBuilder>();
    is_send::<Run>();
    is_send::<basemat::coupled::State>();
    is_sync::<basemat::structure::ReducedModel>();
    let mut simulation =
        shaken().structure(block()).ground(bed(4)).interface(Bonded).build().unwrap();
    let moved = std::thread::spawn(move || {
        simulation.run(10, |_| {}).unwrap();
        simulation.state().step
    });
    assert_eq!(moved.join().unwrap(), 10);
}
