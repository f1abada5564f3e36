//! GOAL: a checkpoint read from text is resumed or is an error, and never causes a panic.
//! SCENE: texts with a right check sum and numbers missing or not finite; damaged texts; any bytes (feature `serde`).
//! REFERENCE: typed errors, and a simulation that is unchanged.

use basemat::Simulation;
use basemat::coupled::Checkpoint;
use basemat::coupled::CheckpointError;
use basemat::history::HistoryMethod;
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;
use serde_json::Value;

use super::histories::auto;
use super::sum::sealed;
use super::{half_plane, resume_error};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

fn with_history(history: HistoryMethod) -> Simulation {
    let base = scene(SI_UNITS, 0.6).interface(friction(0.3)).structure(block(SI_UNITS));
    base.ground(half_plane(history)).build().unwrap()
}

/// Methods of the history whose checkpoints are damaged.
const HISTORY_METHODS: [HistoryMethod; 3] =
    [HistoryMethod::Direct, HistoryMethod::RelaxedFft, HistoryMethod::Exponentials];

/// All leaves of a value.
fn leaves(value: &mut Value) -> Vec<&mut Value> {
    match value {
        Value::Array(list) => list.iter_mut().flat_map(leaves).collect(),
        Value::Object(map) => map.values_mut().flat_map(leaves).collect(),
        leaf => vec![leaf],
    }
}

#[test]
fn numbers_missing_or_not_finite_are_errors() {
    for history in HISTORY_METHODS {
        let mut simulation = with_history(history);
        simulation.run(70, |_| {}).unwrap();
        let intact_form = serde_json::to_value(simulation.checkpoint().unwrap()).unwrap();
        for name in ["state", "ground"] {
            for damage in 0..3 {
                let mut form = intact_form.clone();
                let list = form[name].as_array_mut().unwrap();
                match damage {
                    0 => list.truncate(list.len() - 1),
                    1 => list.push(Value::from(0_u64)),
                    _ => list[1] = Value::from(f64::NAN.to_bits()),
                }
                let error = resume_error(&mut simulation, &sealed(form).unwrap());
                assert!(matches!(error, CheckpointError::Corrupt { .. }), "{error}");
            }
        }
        for (name, wrong) in
            [("format", 99_u64), ("steps", 71), ("steps", 1 << 40), ("steps", u64::MAX / 2)]
        {
            let mut form = intact_form.clone();
            form[name] = Value::from(wrong);
            resume_error(&mut simulation, &sealed(form).unwrap());
        }
    }
}

fn new_simulation() -> Simulation {
    auto(10, 1 << 30).build().unwrap()
}

/// A checkpoint of the form `intact` with another number for the kind of history.
fn with_kind(intact_form: &Value, kind: f64) -> Checkpoint {
    let mut form = intact_form.clone();
    form["ground"][0] = Value::from(kind.to_bits());
    sealed(form).unwrap()
}

#[test]
fn a_damaged_kind_of_history_is_an_error() {
    let mut used_simulation = new_simulation();
    used_simulation.run(100, |_| {}).unwrap();
    let intact_form = serde_json::to_value(used_simulation.checkpoint().unwrap()).unwrap();
    for kind in [1e300, -1e300, -2.0, 0.5, 2.5, 3.0, 1e20, f64::INFINITY, f64::NAN] {
        let damaged_checkpoint = with_kind(&intact_form, kind);
        for simulation in [&mut new_simulation(), &mut used_simulation] {
            let history = simulation.ground().description().history;
            let error = resume_error(simulation, &damaged_checkpoint);
            assert!(matches!(error, CheckpointError::Corrupt { .. }), "{kind}");
            assert_eq!(simulation.ground().description().history, history);
        }
    }
    // Numbers of other kinds, and of exponentials with a longer horizon.
    for kind in [0.0, 1.0, 2.0] {
        let error = resume_error(&mut new_simulation(), &with_kind(&intact_form, kind));
        assert_eq!(error, CheckpointError::OtherScene { quantity: "kind of history" });
    }
    assert!(new_simulation().resume(&with_kind(&intact_form, 1e10)).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(
            "proptest-regressions/checkpoint/text.txt",
        ))),
        ..ProptestConfig::with_cases(60)
    })]

    /// A file of any numbers is an error or is resumed without a panic.
    #[test]
    fn damaged_checkpoints_do_not_panic(
        which in 0_usize..3,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u64>()), 1..6),
    ) {
        let mut simulation = with_history(HISTORY_METHODS[which]);
        simulation.run(40, |_| {}).unwrap();
        let mut form = serde_json::to_value(simulation.checkpoint().unwrap()).unwrap();
        let mut leaves = leaves(&mut form);
        for (place, bits) in changes {
            let place = place.index(leaves.len());
            *leaves[place] = Value::from(bits);
        }
        if let Ok(checkpoint) = sealed(form)
            && simulation.resume(&checkpoint).is_ok()
        {
            let _ = simulation.step();
        }
    }

    /// A text that is truncated, with characters exchanged, inserted or removed, is an error or is resumed.
    #[test]
    fn damaged_texts_do_not_panic(
        which in 0_usize..3,
        length in prop::option::weighted(0.2, any::<prop::sample::Index>()),
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), 0_usize..3, prop::sample::select(b"0123456789,[]{}:-.e\"n ".to_vec())),
            1..6,
        ),
    ) {
        let mut simulation = with_history(HISTORY_METHODS[which]);
        simulation.run(20, |_| {}).unwrap();
        let mut text = serde_json::to_vec(&simulation.checkpoint().unwrap()).unwrap();
        for (place, kind, character) in changes {
            let index = place.index(text.len());
            match kind {
                0 => text[index] = character,
                1 => text.insert(index, character),
                _ => drop(text.remove(index)),
            }
        }
        if let Some(length) = length {
            text.truncate(length.index(text.len()));
        }
        if let Ok(checkpoint) = serde_json::from_slice::<Checkpoint>(&text)
            && simulation.resume(&checkpoint).is_ok()
        {
            let _ = simulation.step();
        }
    }

    #[test]
    fn any_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        if let Ok(checkpoint) = serde_json::from_slice::<Checkpoint>(&bytes) {
            let _ = with_history(HistoryMethod::Direct).resume(&checkpoint);
        }
    }
}
