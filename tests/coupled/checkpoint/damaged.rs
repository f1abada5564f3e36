//! GOAL: no checkpoint resumes with other numbers than were saved.
//! SCENE: a sliding block with a probe and laws with state variables; every bit of every number, every bit of every byte
//! of the text (feature `serde`).
//! REFERENCE: the checkpoint as it was saved; the check sum computed from its form.

use basemat::bem::SpringGround;
use basemat::coupled::CheckpointError;
use basemat::coupled::{Checkpoint, Probe};
use basemat::interface::Cohesive;
use basemat::structure::RigidBlock;
use basemat::{Error, Simulation};
use serde_json::Value;

use super::sum::sum;
use basemat_problems::scenes::{SI_UNITS, scene};

/// A block on two springs after nine steps.
fn block_after_nine_steps() -> Simulation {
    let block = RigidBlock::new(4.0, 3.0, 2000.0).unwrap();
    let ground = SpringGround::new(-2.0..2.0, 2, 5e7, 4e7).unwrap();
    let mut simulation = scene(SI_UNITS, 0.6)
        .probe(Probe::displacement("top", block.horizontal_at(3.0)))
        .structure(block)
        .ground(ground.with_dashpots(4e5, 3e5).unwrap())
        .interface(Cohesive::new(1e3, 1e3, 0.3).unwrap())
        .build()
        .unwrap();
    simulation.run(9, |_| {}).unwrap();
    simulation
}

/// Calls `visit` with each leaf of a value.
fn visit_leaves(value: &mut Value, visit: &mut dyn FnMut(&mut Value)) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(|entry| visit_leaves(entry, visit)),
        Value::Object(map) => map.values_mut().for_each(|entry| visit_leaves(entry, visit)),
        leaf => visit(leaf),
    }
}

/// Changes one bit of a number, or another leaf; returns whether it is a number.
fn damage(leaf: &mut Value, bit: u32) -> bool {
    match leaf {
        Value::Number(number) => {
            *leaf = Value::from(number.as_u64().unwrap() ^ 1 << bit);
            return true;
        }
        Value::Bool(flag) => *flag = !*flag,
        Value::String(text) => text.push('!'),
        other => panic!("{other}"),
    }
    false
}

/// Damages the leaf of this index; returns whether it is a number.
fn damage_leaf(form: &mut Value, index: usize, bit: u32) -> bool {
    let mut count = 0;
    let mut is_number = false;
    visit_leaves(form, &mut |leaf| {
        if count == index {
            is_number = damage(leaf, bit);
        }
        count += 1;
    });
    is_number
}

#[test]
fn the_sum_is_that_of_the_form() {
    let checkpoint = block_after_nine_steps().checkpoint().unwrap();
    let form = serde_json::to_value(&checkpoint).unwrap();
    assert_eq!(form["sum"], Value::from(sum(&form)));
    assert!(form["laws"].as_array().unwrap().iter().any(|number| number.as_u64() != Some(0)));
}

#[test]
fn every_flipped_bit_is_an_error() {
    let mut simulation = block_after_nine_steps();
    let checkpoint = simulation.checkpoint().unwrap();
    let form = serde_json::to_value(&checkpoint).unwrap();
    let mut leaves = 0;
    visit_leaves(&mut form.clone(), &mut |_| leaves += 1);
    let initial_state = simulation.state().clone();
    let mut error_count = 0;
    for index in 0..leaves {
        for bit in 0..64 {
            let mut damaged_form = form.clone();
            let is_number = damage_leaf(&mut damaged_form, index, bit);
            // A format has 32 bits.
            if let Ok(damaged) = serde_json::from_value::<Checkpoint>(damaged_form) {
                let error = simulation.resume(&damaged).unwrap_err();
                let Error::Checkpoint(error) = error else { panic!("{error}") };
                let is_format = matches!(error, CheckpointError::Format { .. });
                assert!(error == DAMAGED_CONTENTS || is_format, "leaf {index}, bit {bit}: {error}");
                error_count += 1;
            }
            if !is_number {
                break;
            }
        }
    }
    assert!(error_count > 64 * 50, "{error_count} of {leaves} leaves");
    assert_eq!(simulation.state(), &initial_state);
    simulation.resume(&checkpoint).unwrap();
}

#[test]
fn every_damaged_byte_of_a_text_is_an_error() {
    let mut simulation = block_after_nine_steps();
    let checkpoint = simulation.checkpoint().unwrap();
    let text = serde_json::to_vec(&checkpoint).unwrap();
    for place in 0..text.len() {
        for bit in 0..8 {
            let mut damaged_text = text.clone();
            damaged_text[place] ^= 1 << bit;
            if let Ok(damaged) = serde_json::from_slice::<Checkpoint>(&damaged_text) {
                let is_resumed = simulation.resume(&damaged).is_ok();
                assert!(!is_resumed || damaged == checkpoint, "byte {place}, bit {bit}");
            }
        }
    }
}

/// Error of contents that are not as they were saved.
const DAMAGED_CONTENTS: CheckpointError = CheckpointError::Corrupt { quantity: "contents" };

#[test]
fn older_formats_are_named_in_their_error() {
    let mut simulation = block_after_nine_steps();
    let checkpoint = simulation.checkpoint().unwrap();
    let mut form = serde_json::to_value(&checkpoint).unwrap();
    form["format"] = Value::from(7);
    form.as_object_mut().unwrap().remove("sum");
    let older_checkpoint: Checkpoint = serde_json::from_value(form.clone()).unwrap();
    let error = simulation.resume(&older_checkpoint).unwrap_err();
    assert_eq!(error, CheckpointError::Format { found: 7, needed: 14 }.into());
    // A checkpoint of this format needs a sum.
    form["format"] = Value::from(14);
    let without_sum: Checkpoint = serde_json::from_value(form).unwrap();
    assert_eq!(simulation.resume(&without_sum).unwrap_err(), DAMAGED_CONTENTS.into());
}
