//! GOAL: no checkpoint resumes with other numbers than were saved.
//! SCENE: a sliding block with a probe and laws with memory; every bit of every number, every bit of
//! every byte of the text (feature `serde`).
//! REFERENCE: the checkpoint as it was saved; the check sum worked out from its form.

use basemat::coupled::CheckpointError;
use basemat::coupled::{Checkpoint, Probe};
use basemat::interface::Cohesive;
use basemat::structure::RigidBlock;
use basemat::{Error, Simulation};
use serde_json::Value;

use super::sum::sum;
use basemat_problems::scenes::{SI, scene};

/// Three degrees of freedom on two springs.
fn simulation() -> Simulation {
    let block = RigidBlock::new(4.0, 3.0, 2000.0).unwrap();
    let ground = basemat::bem::SpringGround::new(-2.0..2.0, 2, 5e7, 4e7).unwrap();
    scene(SI, 0.6)
        .probe(Probe::displacement("top", block.horizontal_at(3.0)))
        .structure(block)
        .ground(ground.with_dashpots(4e5, 3e5).unwrap())
        .interface(Cohesive::new(1e3, 1e3, 0.3).unwrap())
        .build()
        .unwrap()
}

fn saved() -> (Simulation, Checkpoint) {
    let mut simulation = simulation();
    simulation.run(9, |_| {}).unwrap();
    let checkpoint = simulation.checkpoint().unwrap();
    (simulation, checkpoint)
}

/// Calls `visit` with each leaf in turn.
fn each_leaf(value: &mut Value, visit: &mut dyn FnMut(&mut Value)) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(|entry| each_leaf(entry, visit)),
        Value::Object(map) => map.values_mut().for_each(|entry| each_leaf(entry, visit)),
        leaf => visit(leaf),
    }
}

fn leaf(form: &mut Value, place: usize, change: impl FnOnce(&mut Value)) {
    let (mut count, mut change) = (0, Some(change));
    each_leaf(form, &mut |leaf| {
        if count == place {
            change.take().unwrap()(leaf);
        }
        count += 1;
    });
}

#[test]
fn the_sum_is_that_of_the_form() {
    let (_, checkpoint) = saved();
    let form = serde_json::to_value(&checkpoint).unwrap();
    assert_eq!(form["sum"], Value::from(sum(&form)));
    assert!(form["laws"].as_array().unwrap().iter().any(|number| number.as_u64() != Some(0)));
}

#[test]
fn every_flipped_bit_is_refused() {
    let (mut simulation, checkpoint) = saved();
    let form = serde_json::to_value(&checkpoint).unwrap();
    let mut leaves = 0;
    each_leaf(&mut form.clone(), &mut |_| leaves += 1);
    let before = simulation.state().clone();
    let mut refused = 0;
    for place in 0..leaves {
        for bit in 0..64 {
            let mut other = form.clone();
            let mut is_number = false;
            leaf(&mut other, place, |leaf| match leaf {
                Value::Number(number) => {
                    is_number = true;
                    *leaf = Value::from(number.as_u64().unwrap() ^ 1 << bit);
                }
                Value::Bool(flag) => *flag = !*flag,
                Value::String(text) => text.push('!'),
                other => panic!("{other}"),
            });
            // A format has 32 bits.
            if let Ok(damaged) = serde_json::from_value::<Checkpoint>(other) {
                let error = simulation.resume(&damaged).unwrap_err();
                let Error::Checkpoint(error) = error else { panic!("{error}") };
                let named = error == DAMAGED || matches!(error, CheckpointError::Format { .. });
                assert!(named, "leaf {place}, bit {bit}: {error}");
                refused += 1;
            }
            if !is_number {
                break;
            }
        }
    }
    assert!(refused > 64 * 50, "{refused} of {leaves} leaves");
    assert_eq!(simulation.state(), &before);
    simulation.resume(&checkpoint).unwrap();
}

#[test]
fn every_damaged_byte_of_a_text_is_refused() {
    let (mut simulation, checkpoint) = saved();
    let text = serde_json::to_vec(&checkpoint).unwrap();
    for place in 0..text.len() {
        for bit in 0..8 {
            let mut other = text.clone();
            other[place] ^= 1 << bit;
            if let Ok(damaged) = serde_json::from_slice::<Checkpoint>(&other) {
                let resumed = simulation.resume(&damaged).is_ok();
                assert!(!resumed || damaged == checkpoint, "byte {place}, bit {bit}");
            }
        }
    }
}

/// Contents that are not as they were saved.
const DAMAGED: CheckpointError = CheckpointError::Corrupt { quantity: "contents" };

#[test]
fn older_formats_are_refused_by_name() {
    let (mut simulation, checkpoint) = saved();
    let mut form = serde_json::to_value(&checkpoint).unwrap();
    form["format"] = Value::from(7);
    form.as_object_mut().unwrap().remove("sum");
    let older: Checkpoint = serde_json::from_value(form.clone()).unwrap();
    let error = simulation.resume(&older).unwrap_err();
    assert_eq!(error, CheckpointError::Format { found: 7, needed: 11 }.into());
    // Without a sum there is no checkpoint of this format.
    form["format"] = Value::from(11);
    let bare: Checkpoint = serde_json::from_value(form).unwrap();
    assert_eq!(simulation.resume(&bare).unwrap_err(), DAMAGED.into());
}
