//! GOAL: a checkpoint read from text is resumed or refused, never a panic.
//! SCENE: texts with numbers missing or not finite under a check sum that is right, damaged texts, any
//! bytes (feature `serde`).
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
use super::{half_plane, refusal};
use basemat_problems::scenes::{SI, block, friction, scene};

fn simulation(history: HistoryMethod) -> Simulation {
    let base = scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
    base.ground(half_plane(history)).build().unwrap()
}

/// Places of all leaves of a value.
fn leaves(value: &mut Value) -> Vec<&mut Value> {
    match value {
        Value::Array(list) => list.iter_mut().flat_map(leaves).collect(),
        Value::Object(map) => map.values_mut().flat_map(leaves).collect(),
        leaf => vec![leaf],
    }
}

#[test]
fn numbers_missing_or_not_finite_are_refused() {
    for history in [HistoryMethod::Direct, HistoryMethod::RelaxedFft, HistoryMethod::Exponentials] {
        let mut simulation = simulation(history);
        simulation.run(70, |_| {}).unwrap();
        let good = serde_json::to_value(simulation.checkpoint().unwrap()).unwrap();
        for name in ["state", "ground"] {
            for damage in 0..3 {
                let mut value = good.clone();
                let list = value[name].as_array_mut().unwrap();
                match damage {
                    0 => list.truncate(list.len() - 1),
                    1 => list.push(Value::from(0_u64)),
                    _ => list[1] = Value::from(f64::NAN.to_bits()),
                }
                let bad = sealed(value).unwrap();
                let found = refusal(&mut simulation, &bad);
                assert!(matches!(found, CheckpointError::Corrupt { .. }), "{found}");
            }
        }
        for (name, wrong) in
            [("format", 99_u64), ("steps", 71), ("steps", 1 << 40), ("steps", u64::MAX / 2)]
        {
            let mut value = good.clone();
            value[name] = Value::from(wrong);
            let bad = sealed(value).unwrap();
            refusal(&mut simulation, &bad);
        }
    }
}

#[test]
fn a_damaged_kind_of_history_is_refused() {
    let mut whole = auto(10, 1 << 30).build().unwrap();
    whole.run(100, |_| {}).unwrap();
    let good = serde_json::to_value(whole.checkpoint().unwrap()).unwrap();
    let changed = |other: f64| -> Checkpoint {
        let mut value = good.clone();
        value["ground"][0] = Value::from(other.to_bits());
        sealed(value).unwrap()
    };
    let wrong = [1e300, -1e300, -2.0, 0.5, 2.5, 3.0, 1e20, f64::INFINITY, f64::NAN];
    for wrong in wrong {
        let bad = changed(wrong);
        let mut fresh = auto(10, 1 << 30).build().unwrap();
        for simulation in [&mut fresh, &mut whole] {
            let before = simulation.ground().description().history;
            let found = refusal(simulation, &bad);
            assert!(matches!(found, CheckpointError::Corrupt { .. }), "{wrong}");
            assert_eq!(simulation.ground().description().history, before);
        }
    }
    // Numbers that mean something, but something else: other kinds, and exponentials of a longer horizon.
    for kind in [0.0, 1.0, 2.0] {
        let mut fresh = auto(10, 1 << 30).build().unwrap();
        let found = refusal(&mut fresh, &changed(kind));
        assert_eq!(found, CheckpointError::OtherScene { quantity: "kind of history" });
    }
    let mut fresh = auto(10, 1 << 30).build().unwrap();
    assert!(fresh.resume(&changed(1e10)).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(
            "proptest-regressions/checkpoint/text.txt",
        ))),
        ..ProptestConfig::with_cases(60)
    })]

    /// Whatever a file says, it is read, refused, or marched from, without a panic.
    #[test]
    fn damaged_checkpoints_do_not_panic(
        which in 0_usize..3,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u64>()), 1..6),
    ) {
        let history = [HistoryMethod::Direct, HistoryMethod::RelaxedFft, HistoryMethod::Exponentials][which];
        let mut simulation = simulation(history);
        simulation.run(40, |_| {}).unwrap();
        let mut value = serde_json::to_value(simulation.checkpoint().unwrap()).unwrap();
        let mut leaves = leaves(&mut value);
        for (place, bits) in changes {
            let place = place.index(leaves.len());
            *leaves[place] = Value::from(bits);
        }
        if let Ok(checkpoint) = sealed(value)
            && simulation.resume(&checkpoint).is_ok()
        {
            let _ = simulation.step();
        }
    }

    /// The text itself: cut, with characters exchanged, put in or taken out.
    #[test]
    fn damaged_texts_do_not_panic(
        which in 0_usize..3,
        cut in prop::option::weighted(0.2, any::<prop::sample::Index>()),
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), 0_usize..3, prop::sample::select(b"0123456789,[]{}:-.e\"n ".to_vec())),
            1..6,
        ),
    ) {
        let history = [HistoryMethod::Direct, HistoryMethod::RelaxedFft, HistoryMethod::Exponentials][which];
        let mut simulation = simulation(history);
        simulation.run(20, |_| {}).unwrap();
        let mut text = serde_json::to_vec(&simulation.checkpoint().unwrap()).unwrap();
        for (place, kind, sign) in changes {
            let at = place.index(text.len());
            match kind {
                0 => text[at] = sign,
                1 => text.insert(at, sign),
                _ => drop(text.remove(at)),
            }
        }
        if let Some(cut) = cut {
            text.truncate(cut.index(text.len()));
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
            let _ = simulation(HistoryMethod::Direct).resume(&checkpoint);
        }
    }
}
