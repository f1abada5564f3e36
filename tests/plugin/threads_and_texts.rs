//! GOAL: all parts can be printed, and a simulation can be moved to another thread.
//! SCENE: a block on springs, and parts by themselves.
//! REFERENCE: the words of the texts; a run on the other thread.

use std::fmt::Debug;
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

use super::scene::{TIME_STEP, push, shaken, soil};
use basemat_problems::block_on_springs::{bed, block};

/// Checks that the text of a part is short and contains these words.
fn assert_text(part: &dyn Debug, words: &[&str]) {
    let text = format!("{part:?}");
    assert!(text.len() < 2000, "{text}");
    for word in words {
        assert!(text.contains(word), "{word} in {text}");
    }
}

fn bonded_block() -> SimulationBuilder {
    shaken().structure(block()).interface(Bonded)
}

fn half_plane() -> ElasticGround {
    ElasticGround::new(soil(), Strip::uniform(-2.0..2.0, 6).unwrap()).unwrap()
}

#[test]
fn all_parts_can_be_printed() {
    let words = ["time_step: 0.002", "structure: true", "ground: false", "gravity: 9.81"];
    assert_text(&bonded_block(), &words);
    // The error of a scene that cannot be built can be unwrapped.
    let error = bonded_block().build().unwrap_err();
    assert!(matches!(error, Error::Scene { quantity: "ground", .. }));
    let mut simulation = bonded_block().ground(bed(4)).build().unwrap();
    simulation.step().unwrap();
    assert_text(&simulation, &["dofs: 3", "elements: 4", "step: 1"]);
    assert_text(&half_plane(), &["Soil", "elements: 6"]);
    let elements = half_plane().elements().to_vec();
    let kernel = Arc::new(PatchKernel::new(soil(), elements, TIME_STEP).unwrap());
    assert_text(&DirectHistory::new(kernel), &["elements: 6", "steps: 0"]);
    assert_text(&WithSprings::new(block()), &["dofs: 3", "springs: 0"]);
    assert_text(&StructureGroup::new(), &["structures: 0"]);
    assert_text(&TravellingWave::new(push(), 500.0, 1.0).unwrap(), &["500.0", "origin: 1.0"]);
    assert_text(&Sweep::new(3), &["count: 3"]);
    let sweep = Sweep::grid([Parameter::texts("record", ["El Centro"])]).unwrap();
    assert_text(&sweep, &["count: 1", "El Centro"]);
    let table = sweep.table(["slip_m"], |case| {
        assert_text(case, &["index: 0"]);
        Ok::<_, Error>([0.25])
    });
    let table = table.unwrap();
    assert_text(&table, &["slip_m", "0.25"]);
    assert_text(&table.rows().next().unwrap(), &["case: 0"]);
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
    let mut simulation = bonded_block().ground(bed(4)).build().unwrap();
    let thread = std::thread::spawn(move || {
        simulation.run(10, |_| {}).unwrap();
        simulation.state().step
    });
    assert_eq!(thread.join().unwrap(), 10);
}
