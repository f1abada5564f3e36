//! GOAL: every kind of scene resumes to the last bit, and a structure comes back as it was left.
//! SCENE: every history, a spring bed, nonlinear structures; saved after 0 to 200 steps and resumed
//! in new and in used simulations.
//! REFERENCE: the states of the uninterrupted run.

use std::any::Any;

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::CheckpointError;
use basemat::coupled::{SimulationBuilder, State};
use basemat::history::HistoryMethod;
use basemat::interface::Bonded;
use basemat::structure::{NonlinearForce, RigidBlock, RigidBody, Structure, Triplets};
use basemat::{Result, Simulation};

use super::{STEPS, carried, half_plane, spring_bed};
use basemat_problems::scenes::{Rider, SI, block, friction, scene, soil, states, tower};
use basemat_problems::{needed_from, own_force};

/// Rigid block whose weak spring against rotation slips: it has a memory of its own.
struct Sticky {
    block: RigidBlock,
    anchor: f64,
}

impl Structure for Sticky {
    needed_from!(block);

    own_force!();
}

impl NonlinearForce for Sticky {
    fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
        force[2] += 1e5 * (u[2] - self.anchor);
        Ok(())
    }

    fn tangent(&self, _: &[f64], matrix: &mut Triplets) -> Result<()> {
        matrix.add(2, 2, 1e5);
        Ok(())
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
        kind("direct", move || {
            base().structure(block(SI)).ground(half_plane(HistoryMethod::Direct))
        }),
        kind("transforms", move || {
            base().structure(tower(SI, None)).ground(half_plane(HistoryMethod::RelaxedFft))
        }),
        kind("transforms along the surface", move || {
            let ground =
                ElasticGround::new(soil(SI), Strip::uniform(-2.0..2.0, 9).unwrap()).unwrap();
            base()
                .structure(block(SI))
                .ground(ground.with_history(HistoryMethod::RelaxedFft).unwrap())
        }),
        kind("exponentials", move || {
            base().structure(tower(SI, None)).ground(half_plane(HistoryMethod::Exponentials))
        }),
        kind("exponentials, bonded", move || {
            let base = scene(SI, 0.6).interface(Bonded);
            base.structure(block(SI)).ground(half_plane(HistoryMethod::Exponentials))
        }),
        kind("auto", move || base().structure(block(SI)).ground(half_plane(HistoryMethod::Auto))),
        kind("spring bed", move || base().structure(block(SI)).ground(spring_bed())),
        kind("nonlinear", move || {
            base().structure(Rider { block: block(SI) }).ground(spring_bed())
        }),
        kind("cells cut by a disc", move || {
            let cylinder = RigidBody::cylinder(2.0, 6.0, 2000.0).unwrap();
            let ground = ElasticGround::under(soil(SI), &cylinder, 4).unwrap();
            base().structure(cylinder).ground(ground)
        }),
        kind("memory of its own", move || {
            let sticky = Sticky { block: block(SI), anchor: 0.0 };
            base().structure(sticky).ground(spring_bed())
        }),
    ]
}

/// Everything but what belongs to the last step alone.
fn lasting(state: &State) -> State {
    let mut lasting = state.clone();
    lasting.transitions.clear();
    lasting.trials = 0;
    lasting.method = basemat::contact::SearchMethod::ActiveSet;
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
        let moved = whole[STEPS].absolute_displacement().iter().any(|u| *u != 0.0);
        assert!(
            moved && whole[STEPS].contact[0] != whole[0].contact[0],
            "{name}: nothing happened"
        );
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
        let moved = simulation.step().unwrap().absolute_displacement()[2];
        let next = last + 0.1 * (simulation.static_displacement()[2] + moved - last);
        let found = anchor(simulation.structure());
        assert!((found - next).abs() < 1e-12, "{found:e} {next:e}");
        last = found;
    }
    assert!(last.abs() > 1e-9);
    let whole: Box<dyn Any> = simulation.into_structure();
    assert_eq!(whole.downcast::<Sticky>().unwrap().anchor, last);
}

/// Back at the start, nothing is left of the steps made since: not their effort either.
#[test]
fn the_start_is_resumed_in_a_used_simulation() {
    let built = || scene(SI, 0.6).structure(block(SI)).interface(friction(0.35)).build().unwrap();
    let start = built();
    let saved = start.checkpoint().unwrap();
    let mut used = built();
    used.run(20, |_| {}).unwrap();
    assert!(used.state().trials > 0);
    used.resume(&saved).unwrap();
    assert!(used.state() == start.state());
}
