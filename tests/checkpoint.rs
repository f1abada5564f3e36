//! A run that is saved and resumed is the run that was never interrupted, to the last bit.

#[path = "support/scenes.rs"]
mod scenes;

use std::any::Any;
use std::sync::Arc;

use basemat::bem::{
    ContactElement, Ground, HalfPlaneGround, History, PatchKernel, SpringGround, Strip,
};
use basemat::coupled::{Checkpoint, SimulationBuilder, State};
use basemat::history::{ConvolutionHistory, DirectHistory, ExponentialHistory, RelaxedFftHistory};
use basemat::interface::Bonded;
use basemat::structure::{
    ContactNode, ModalDamping, RigidBlock, Structure, StructureGroup, Triplets, WithSprings,
};
use basemat::{CheckpointError, Error, Result, Simulation};
use scenes::{Rider, SI, block, friction, scene, soil, states, tower};

/// Longer than the window of the exponentials and several leaves of the transforms.
const STEPS: usize = 260;

fn half_plane(history: History) -> HalfPlaneGround {
    HalfPlaneGround::graded_strip(soil(SI), -2.0..2.0, 6).unwrap().with_history_kind(history)
}

fn spring_bed() -> SpringGround {
    SpringGround::new(-2.0..2.0, 8, 5e7, 4e7).unwrap().with_dashpots(4e5, 3e5).unwrap()
}

/// Rigid block whose weak spring against rotation slips: it has a memory of its own.
struct Sticky {
    block: RigidBlock,
    anchor: f64,
}

impl Structure for Sticky {
    fn unknowns(&self) -> usize {
        self.block.unknowns()
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.block.contact_nodes()
    }

    fn mass(&self, matrix: &mut Triplets) {
        self.block.mass(matrix);
    }

    fn stiffness(&self, matrix: &mut Triplets) {
        self.block.stiffness(matrix);
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn nonlinear_force(&self, u: &[f64], force: &mut [f64]) {
        force[2] += 1e5 * (u[2] - self.anchor);
    }

    fn nonlinear_tangent(&self, _: &[f64], matrix: &mut Triplets) {
        matrix.add(2, 2, 1e5);
    }

    fn commit(&mut self, u: &[f64]) {
        self.anchor += 0.1 * (u[2] - self.anchor);
    }

    fn save(&self) -> Result<Vec<f64>> {
        Ok(vec![self.anchor])
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            [anchor] => self.anchor = *anchor,
            _ => return Err(CheckpointError::Corrupt { quantity: "anchor" }.into()),
        }
        Ok(())
    }
}

/// A scene's name, and how it is built.
type Kind = (&'static str, Box<dyn Fn() -> Simulation>);

/// Scenes by name; each is built anew at every call.
fn kinds() -> Vec<Kind> {
    fn kind(name: &'static str, builder: impl Fn() -> SimulationBuilder + 'static) -> Kind {
        (name, Box::new(move || builder().build().unwrap()))
    }
    let base = || scene(SI, 0.6).interface(friction(0.3));
    vec![
        kind("direct", move || base().structure(block(SI)).ground(half_plane(History::Direct))),
        kind("transforms", move || {
            base().structure(tower(SI, None)).ground(half_plane(History::RelaxedFft))
        }),
        kind("transforms along the surface", move || {
            let ground = HalfPlaneGround::strip(soil(SI), -2.0..2.0, 9).unwrap();
            base().structure(block(SI)).ground(ground.with_history_kind(History::RelaxedFft))
        }),
        kind("exponentials", move || {
            base().structure(tower(SI, None)).ground(half_plane(History::Exponentials))
        }),
        kind("exponentials, bonded", move || {
            let base = scene(SI, 0.6).interface(Bonded);
            base.structure(block(SI)).ground(half_plane(History::Exponentials))
        }),
        kind("auto", move || base().structure(block(SI)).ground(half_plane(History::Auto))),
        kind("spring bed", move || base().structure(block(SI)).ground(spring_bed())),
        kind("nonlinear", move || {
            base().structure(Rider { block: block(SI) }).ground(spring_bed())
        }),
        kind("memory of its own", move || {
            let sticky = Sticky { block: block(SI), anchor: 0.0 };
            base().structure(sticky).ground(spring_bed())
        }),
    ]
}

/// Through a text format where the crate is built to do so.
#[cfg(feature = "serde")]
fn carried(checkpoint: &Checkpoint) -> Checkpoint {
    let text = serde_json::to_string(checkpoint).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[cfg(not(feature = "serde"))]
fn carried(checkpoint: &Checkpoint) -> Checkpoint {
    checkpoint.clone()
}

/// Everything but what belongs to the last step alone.
fn lasting(state: &State) -> State {
    let mut lasting = state.clone();
    lasting.transitions.clear();
    lasting.trials = 0;
    lasting.method = basemat::coupled::SearchMethod::ActiveSet;
    lasting
}

#[test]
fn resumed_runs_are_the_same_to_the_last_bit() {
    for (name, build) in kinds() {
        let whole = states(&mut build(), STEPS);
        let mut first = build();
        let mut saved = Vec::new();
        for step in 0..=STEPS {
            if [0, 1, 31, 64, 77, 128, 200].contains(&step) {
                saved.push((step, first.checkpoint().unwrap()));
            }
            first.step().unwrap();
        }
        // Saving changes nothing.
        assert_eq!(lasting(first.state()).step, STEPS + 1);
        let mut used = build();
        used.run(90, |_| {}).unwrap();
        for (step, checkpoint) in saved {
            assert_eq!(checkpoint.steps(), step);
            let checkpoint = carried(&checkpoint);
            // In a new simulation, and in one that has gone on in some other way.
            for other in [&mut build(), &mut used] {
                other.resume(&checkpoint).unwrap_or_else(|e| panic!("{name}, {step}: {e}"));
                assert_eq!(lasting(other.state()), lasting(&whole[step]), "{name}, {step}");
                // Before the first step, Auto has not chosen its history yet.
                if step > 0 {
                    assert_eq!(other.checkpoint().unwrap(), checkpoint, "{name}, {step}");
                }
                for wanted in &whole[step + 1..] {
                    assert_eq!(other.step().unwrap(), wanted, "{name}, saved after {step}");
                }
            }
        }
        let moved = whole[STEPS].displacement().iter().any(|u| *u != 0.0);
        assert!(
            moved && whole[STEPS].contact[0] != whole[0].contact[0],
            "{name}: nothing happened"
        );
    }
}

/// A block on equal elements whose ground chooses its history, in at most these bytes.
fn auto(elements: usize, memory: usize) -> SimulationBuilder {
    let ground = HalfPlaneGround::strip(soil(SI), -2.0..2.0, elements).unwrap();
    let base = scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
    base.ground(ground.with_history_memory(memory))
}

#[test]
fn what_auto_has_chosen_is_chosen_again() {
    const GIB: usize = 1 << 30;
    for (elements, memory, expected, steps, kind) in [
        // By wavenumbers and by pairs: their checkpoints are of unequal and equal sizes with the
        // direct sum.
        (10, GIB, 0, 50, History::Direct),
        (4, GIB, 0, 50, History::Direct),
        (10, GIB, 0, 100, History::RelaxedFft),
        (10, 10_000, 0, 100, History::Exponentials),
        // Their poles depend on the steps that were expected, which are no part of the scene.
        (10, 10_000, 1 << 30, 100, History::Exponentials),
    ] {
        let case = format!("{elements} elements, {memory} bytes, {expected} steps expected");
        let mut whole = auto(elements, memory).expected_steps(expected).build().unwrap();
        whole.run(steps, |_| {}).unwrap();
        let choice = whole.history_choice().unwrap();
        assert_eq!(choice.kind, kind, "{case}");
        let saved = carried(&whole.checkpoint().unwrap());
        let wanted = states(&mut whole, 40);
        let mut used = auto(elements, memory).build().unwrap();
        used.run(steps + 10, |_| {}).unwrap();
        for mut other in [auto(elements, memory).build().unwrap(), used] {
            other.resume(&saved).unwrap_or_else(|e| panic!("{case}: {e}"));
            assert_eq!(other.history_choice(), Some(choice), "{case}");
            assert_eq!(other.checkpoint().unwrap(), saved, "{case}");
            assert_eq!(states(&mut other, 40)[1..], wanted[1..], "{case}");
        }
    }
}

#[test]
fn where_nothing_was_chosen_the_choice_is_open_again() {
    let fresh = auto(10, 10_000).build().unwrap().checkpoint().unwrap();
    let mut used = auto(10, 10_000).build().unwrap();
    used.run(100, |_| {}).unwrap();
    assert_eq!(used.history_choice().unwrap().kind, History::Exponentials);
    used.resume(&fresh).unwrap();
    assert_eq!((used.history_choice(), used.state().step), (None, 0));
    used.run(50, |_| {}).unwrap();
    assert_eq!(used.history_choice().unwrap().kind, History::Direct);
}

#[test]
fn another_choice_is_refused_and_changes_nothing() {
    let run = |memory| {
        let mut simulation = auto(10, memory).build().unwrap();
        simulation.run(100, |_| {}).unwrap();
        simulation.checkpoint().unwrap()
    };
    let [transforms, exponentials] = [run(1 << 30), run(10_000)];
    let quantity = "kind of history";
    for (memory, checkpoint) in [(10_000, &transforms), (1 << 30, &exponentials)] {
        // It would choose another one.
        let mut fresh = auto(10, memory).build().unwrap();
        assert_eq!(refusal(&mut fresh, checkpoint), CheckpointError::OtherScene { quantity });
        assert_eq!(fresh.history_choice(), None);
        // It has chosen another one.
        fresh.run(50, |_| {}).unwrap();
        assert_eq!(refusal(&mut fresh, checkpoint), CheckpointError::OtherScene { quantity });
    }
}

#[test]
fn a_step_count_without_tractions_takes_no_memory() {
    // By pairs, and by wavenumbers.
    for count in [4, 10] {
        let elements = Strip::uniform(-2.0..2.0, count).unwrap().elements();
        let kernel = Arc::new(PatchKernel::new(soil(SI), elements, 0.01).unwrap());
        let corrupt = |history: &mut dyn ConvolutionHistory| {
            for steps in [1 << 40, 1 << 47, usize::MAX] {
                let error = history.restore(steps, &[0.0; 16]).unwrap_err();
                assert!(matches!(error, Error::Checkpoint(CheckpointError::Corrupt { .. })));
            }
        };
        corrupt(&mut DirectHistory::new(Arc::clone(&kernel)));
        corrupt(&mut RelaxedFftHistory::new(Arc::clone(&kernel)));
        corrupt(&mut ExponentialHistory::new(kernel, 1e-6).unwrap());
    }
}

fn refusal(simulation: &mut Simulation, checkpoint: &Checkpoint) -> CheckpointError {
    let before = simulation.checkpoint().unwrap();
    let error = simulation.resume(checkpoint).unwrap_err();
    assert_eq!(simulation.checkpoint().unwrap(), before, "a refusal must change nothing");
    match error {
        Error::Checkpoint(error) => error,
        other => panic!("{other}"),
    }
}

#[test]
fn other_scenes_are_refused() {
    let base = || scene(SI, 0.6).interface(friction(0.3));
    let plain = || base().structure(block(SI)).ground(spring_bed());
    let mut simulation = plain().build().unwrap();
    simulation.run(20, |_| {}).unwrap();
    let bed = |count, stiffness| SpringGround::new(-2.0..2.0, count, stiffness, 4e7).unwrap();
    let heavier = || RigidBlock::new(4.0, 6.0, 1600.0).unwrap();
    let probe = basemat::coupled::Probe::displacement("top", vec![(0, 1.0)]);
    for (quantity, other) in [
        ("number of unknowns", base().structure(Rider { block: block(SI) }).ground(spring_bed())),
        ("list of contact elements", base().structure(block(SI)).ground(bed(6, 5e7))),
        ("list of probes", plain().probe(probe)),
        ("structure", base().structure(heavier()).ground(spring_bed())),
        ("ground", base().structure(block(SI)).ground(bed(8, 6e7))),
        ("static state", plain().gravity(5.0)),
        ("time step or scheme", plain().scheme(basemat::coupled::Theta::new(0.6).unwrap())),
    ] {
        let checkpoint = other.build().unwrap().checkpoint().unwrap();
        let found = refusal(&mut simulation, &checkpoint);
        assert_eq!(found, CheckpointError::OtherScene { quantity });
    }
    let with = |history| base().structure(block(SI)).ground(half_plane(history)).build().unwrap();
    let direct = with(History::Direct).checkpoint().unwrap();
    let quantity = "kind of history";
    let found = refusal(&mut with(History::Exponentials), &direct);
    assert_eq!(found, CheckpointError::OtherScene { quantity });
}

/// A ground that says nothing of checkpoints.
struct Silent(SpringGround);

impl Ground for Silent {
    fn elements(&self) -> &[ContactElement] {
        self.0.elements()
    }

    fn prepare(&mut self, time_step: f64) -> Result<()> {
        self.0.prepare(time_step)
    }

    fn instantaneous(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.instantaneous(matrix)
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.0.history(displacement)
    }

    fn commit(&mut self, traction: &[f64]) {
        self.0.commit(traction);
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.static_compliance(matrix)
    }
}

#[test]
fn grounds_that_cannot_be_saved_say_so() {
    let base = || scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
    let mut silent = base().ground(Silent(spring_bed())).build().unwrap();
    silent.run(5, |_| {}).unwrap();
    let unsupported = Error::Checkpoint(CheckpointError::Unsupported { part: "ground" });
    assert_eq!(silent.checkpoint().unwrap_err(), unsupported);
    let other = base().ground(spring_bed()).build().unwrap().checkpoint().unwrap();
    assert_eq!(silent.resume(&other).unwrap_err(), unsupported);
    silent.run(5, |_| {}).unwrap();
}

/// A nonlinear structure without `save`: the default must not pretend that there is nothing to save.
struct Unsaved(Rider);

impl Structure for Unsaved {
    fn unknowns(&self) -> usize {
        self.0.unknowns()
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.0.contact_nodes()
    }

    fn mass(&self, matrix: &mut Triplets) {
        self.0.mass(matrix);
    }

    fn stiffness(&self, matrix: &mut Triplets) {
        self.0.stiffness(matrix);
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn nonlinear_force(&self, u: &[f64], force: &mut [f64]) {
        self.0.nonlinear_force(u, force);
    }

    fn nonlinear_tangent(&self, u: &[f64], matrix: &mut Triplets) {
        self.0.nonlinear_tangent(u, matrix);
    }
}

/// GOAL: what a structure remembers can be read during a run and after it.
#[test]
fn a_structure_comes_back_as_it_was_left() {
    let sticky = Sticky { block: block(SI), anchor: 0.0 };
    let builder = scene(SI, 0.6).interface(friction(0.3)).ground(spring_bed());
    let mut simulation = builder.structure(sticky).build().unwrap();
    let anchor = |structure: &dyn Any| structure.downcast_ref::<Sticky>().unwrap().anchor;
    let mut last = anchor(simulation.structure());
    for _ in 0..50 {
        let moved = simulation.step().unwrap().displacement()[2];
        let next = last + 0.1 * (simulation.static_displacement()[2] + moved - last);
        let found = anchor(simulation.structure());
        assert!((found - next).abs() < 1e-12, "{found:e} {next:e}");
        last = found;
    }
    assert!(last.abs() > 1e-9);
    let whole: Box<dyn Any> = simulation.into_structure();
    assert_eq!(whole.downcast::<Sticky>().unwrap().anchor, last);
}

#[test]
fn nonlinear_structures_that_cannot_be_saved_say_so() {
    let base = || scene(SI, 0.6).interface(friction(0.3)).ground(spring_bed());
    let unsaved = || Unsaved(Rider { block: block(SI) });
    let unsupported = Error::Checkpoint(CheckpointError::Unsupported { part: "structure" });
    let known = base().structure(Rider { block: block(SI) }).build().unwrap().checkpoint().unwrap();
    let wrapped: [Box<dyn Structure>; 4] = [
        Box::new(unsaved()),
        Box::new(WithSprings::new(unsaved())),
        Box::new(ModalDamping::new(&[0.05]).unwrap().on(unsaved()).unwrap()),
        Box::new(StructureGroup::new().with(unsaved(), 0.0).unwrap()),
    ];
    for (k, structure) in wrapped.into_iter().enumerate() {
        let mut silent = base().structure(structure).build().unwrap();
        silent.run(5, |_| {}).unwrap();
        assert_eq!(silent.checkpoint().unwrap_err(), unsupported, "{k}");
        if k == 0 {
            assert_eq!(silent.resume(&known).unwrap_err(), unsupported);
        }
        silent.run(5, |_| {}).unwrap();
    }
}

#[test]
fn an_approximate_history_is_in_the_ledger() {
    let run = |history, tolerance| {
        let ground = half_plane(history).with_history_tolerance(tolerance).unwrap();
        let base = scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
        base.ground(ground).build().unwrap().run(STEPS, |_| {}).unwrap()
    };
    let exact = run(History::Direct, 1e-3);
    assert_eq!(exact.history_error_bound(), 0.0);
    let mut last = f64::INFINITY;
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let run = run(History::Exponentials, tolerance);
        let bound = run.history_error_bound();
        println!("{tolerance:e}: soil {:e} within {bound:e}", run.ledger.soil);
        assert!(bound > 0.0 && bound < 100.0 * tolerance * run.ledger.soil);
        assert!(bound < 0.1 * last);
        assert!(run.ledger_residual < 1e-10, "{:e}", run.ledger_residual);
        assert!(run.to_string().contains("soil within"));
        last = bound;
    }
}

#[cfg(feature = "serde")]
mod text {
    use super::*;
    use proptest::prelude::*;
    use serde_json::Value;

    fn simulation(history: History) -> Simulation {
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
        for history in [History::Direct, History::RelaxedFft, History::Exponentials] {
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
                    let bad: Checkpoint = serde_json::from_value(value).unwrap();
                    let found = refusal(&mut simulation, &bad);
                    assert!(matches!(found, CheckpointError::Corrupt { .. }), "{found}");
                }
            }
            for (name, wrong) in
                [("format", 99_u64), ("steps", 71), ("steps", 1 << 40), ("steps", u64::MAX / 2)]
            {
                let mut value = good.clone();
                value[name] = Value::from(wrong);
                let bad: Checkpoint = serde_json::from_value(value).unwrap();
                refusal(&mut simulation, &bad);
            }
        }
    }

    #[test]
    fn a_damaged_choice_of_the_history_is_refused() {
        let mut whole = auto(10, 1 << 30).build().unwrap();
        whole.run(100, |_| {}).unwrap();
        let good = serde_json::to_value(whole.checkpoint().unwrap()).unwrap();
        let wrong = [1e300, -1e300, -2.0, 0.5, 2.5, 1e20, f64::INFINITY, f64::NAN];
        let kinds = [-1.0, 4.0].map(|kind| (0, kind));
        for (place, wrong) in wrong.iter().flat_map(|w| [(0, *w), (1, *w)]).chain(kinds) {
            let mut value = good.clone();
            value["ground"][place] = Value::from(wrong.to_bits());
            let bad: Checkpoint = serde_json::from_value(value).unwrap();
            let mut fresh = auto(10, 1 << 30).build().unwrap();
            for simulation in [&mut fresh, &mut whole] {
                let before = simulation.history_choice();
                let found = refusal(simulation, &bad);
                assert!(matches!(found, CheckpointError::Corrupt { .. }), "{place}, {wrong}");
                assert_eq!(simulation.history_choice(), before);
            }
        }
        // Numbers that mean something, but something else.
        for (place, other) in [(0, 0.0_f64), (0, 1.0), (0, 3.0), (1, 0.0), (1, 50.0), (1, 1e15)] {
            let mut value = good.clone();
            value["ground"][place] = Value::from(other.to_bits());
            let bad: Checkpoint = serde_json::from_value(value).unwrap();
            let mut fresh = auto(10, 1 << 30).build().unwrap();
            refusal(&mut fresh, &bad);
            assert_eq!(fresh.history_choice(), None);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        /// Whatever a file says, it is read, refused, or marched from, without a panic.
        #[test]
        fn damaged_checkpoints_do_not_panic(
            which in 0_usize..3,
            changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u64>()), 1..6),
        ) {
            let history = [History::Direct, History::RelaxedFft, History::Exponentials][which];
            let mut simulation = simulation(history);
            simulation.run(40, |_| {}).unwrap();
            let mut value = serde_json::to_value(simulation.checkpoint().unwrap()).unwrap();
            let mut leaves = leaves(&mut value);
            for (place, bits) in changes {
                let place = place.index(leaves.len());
                *leaves[place] = Value::from(bits);
            }
            if let Ok(checkpoint) = serde_json::from_value::<Checkpoint>(value)
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
            let history = [History::Direct, History::RelaxedFft, History::Exponentials][which];
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
                let _ = simulation(History::Direct).resume(&checkpoint);
            }
        }
    }
}
