//! GOAL: every kind of scene resumes to the last bit; a structure is returned in its last state.
//! SCENE: every history, a spring bed, nonlinear structures; saved after 0 to 200 steps and resumed
//! in new and in used simulations.
//! REFERENCE: the states of the uninterrupted run.

use std::any::Any;

use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::contact::SearchMethod;
use basemat::coupled::CheckpointError;
use basemat::coupled::{SimulationBuilder, State};
use basemat::fem::{Iwan, Mesh};
use basemat::history::HistoryMethod;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::Record;
use basemat::structure::{FemModel, NonlinearForce, RigidBlock, RigidBody, Structure, Triplets};
use basemat::{Result, Simulation};

use super::{RUN_STEPS, half_plane, spring_bed, through_text};
use basemat_problems::scenes::{Rider, SI_UNITS, block, friction, scene, soil, states, tower};
use basemat_problems::yielding_blocks::grid_lines;
use basemat_problems::{needed_from, own_force};

/// Rigid block with a weak spring against rotation whose anchor follows the block.
struct BlockWithMovingAnchor {
    block: RigidBlock,
    anchor: f64,
}

impl BlockWithMovingAnchor {
    fn new() -> Self {
        Self { block: block(SI_UNITS), anchor: 0.0 }
    }
}

impl Structure for BlockWithMovingAnchor {
    needed_from!(block);

    own_force!();
}

impl NonlinearForce for BlockWithMovingAnchor {
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

/// A scene's name and the function that builds it.
type NamedScene = (&'static str, fn() -> SimulationBuilder);

/// A scene of two pulses and friction, without structure and ground.
fn with_friction() -> SimulationBuilder {
    scene(SI_UNITS, 0.6).interface(friction(0.3))
}

fn named_scenes() -> Vec<NamedScene> {
    vec![
        ("direct", || {
            with_friction().structure(block(SI_UNITS)).ground(half_plane(HistoryMethod::Direct))
        }),
        ("transforms", || {
            let ground = half_plane(HistoryMethod::RelaxedFft);
            with_friction().structure(tower(SI_UNITS, None)).ground(ground)
        }),
        ("transforms along the surface", || {
            let strip = Strip::uniform(-2.0..2.0, 9).unwrap();
            let ground = ElasticGround::new(soil(SI_UNITS), strip).unwrap();
            let ground = ground.with_history(HistoryMethod::RelaxedFft).unwrap();
            with_friction().structure(block(SI_UNITS)).ground(ground)
        }),
        ("exponentials", || {
            let ground = half_plane(HistoryMethod::Exponentials);
            with_friction().structure(tower(SI_UNITS, None)).ground(ground)
        }),
        ("exponentials, bonded", || {
            let ground = half_plane(HistoryMethod::Exponentials);
            with_friction().interface(Bonded).structure(block(SI_UNITS)).ground(ground)
        }),
        ("auto", || {
            with_friction().structure(block(SI_UNITS)).ground(half_plane(HistoryMethod::Auto))
        }),
        ("spring bed", || with_friction().structure(block(SI_UNITS)).ground(spring_bed())),
        ("nonlinear", || {
            with_friction().structure(Rider { block: block(SI_UNITS) }).ground(spring_bed())
        }),
        ("cells cut by a disc", || {
            let cylinder = RigidBody::cylinder(2.0, 6.0, 2000.0).unwrap();
            let ground = ElasticGround::under(soil(SI_UNITS), &cylinder, 4).unwrap();
            with_friction().structure(cylinder).ground(ground)
        }),
        ("structure with memory", || {
            with_friction().structure(BlockWithMovingAnchor::new()).ground(spring_bed())
        }),
    ]
}

/// The state without the data on the computation of the last step.
fn without_step_details(state: &State) -> State {
    let mut state = state.clone();
    state.transitions.clear();
    state.trials = 0;
    state.method = SearchMethod::ActiveSet;
    state
}

#[test]
fn resumed_runs_are_the_same_to_the_last_bit() {
    for (name, builder) in named_scenes() {
        let expected = states(&mut builder().build().unwrap(), RUN_STEPS);
        let mut first = builder().build().unwrap();
        let mut checkpoints = Vec::new();
        for step in 0..=RUN_STEPS {
            if [0, 1, 31, 64, 77, 128, 200].contains(&step) {
                checkpoints.push((step, first.checkpoint().unwrap()));
            }
            first.step().unwrap();
        }
        assert_eq!(first.state().step, RUN_STEPS + 1);
        let mut used_simulation = builder().build().unwrap();
        used_simulation.run(90, |_| {}).unwrap();
        for (step, checkpoint) in checkpoints {
            assert_eq!(checkpoint.steps(), step);
            let checkpoint = through_text(&checkpoint);
            // In a new simulation, and in one that was used for other steps.
            for resumed_simulation in [&mut builder().build().unwrap(), &mut used_simulation] {
                let label = format!("{name}, saved after {step}");
                resumed_simulation
                    .resume(&checkpoint)
                    .unwrap_or_else(|error| panic!("{label}: {error}"));
                let resumed_state = without_step_details(resumed_simulation.state());
                assert_eq!(resumed_state, without_step_details(&expected[step]), "{label}");
                // Before the first step, Auto has not chosen its history yet.
                if step > 0 {
                    assert_eq!(resumed_simulation.checkpoint().unwrap(), checkpoint, "{label}");
                }
                for state in &expected[step + 1..] {
                    assert_eq!(resumed_simulation.step().unwrap(), state, "{label}");
                }
            }
        }
        let end = &expected[RUN_STEPS];
        assert!(end.absolute_displacement().iter().any(|u| *u != 0.0), "{name}: no motion");
        assert!(end.contact[0] != expected[0].contact[0], "{name}: no change of contact");
    }
}

/// Block of clay with more than 400 degrees of freedom, under strong motion.
fn block_of_clay(steps: usize) -> Result<Simulation> {
    let clay = Iwan::hyperbolic(40.0e6, 60.0e3, 0.3, 0.45, 1900.0)?;
    let x_lines = grid_lines(-4.0, 8.0, 10);
    let y_lines = grid_lines(0.0, 4.0, 6);
    let model = FemModel::on_base(Mesh::quad8_block(&x_lines, &y_lines, |_, _| clay.clone())?)?;
    let time_step = 0.005;
    let duration = time_step * steps as f64;
    let motion = Record::from_fn(time_step, duration, |time| 8.0 * (25.0 * time).sin())?;
    Simulation::builder(time_step)
        .ground(SpringGround::under(&model, 40, 4.0e8, 4.0e8)?)
        .structure(model)
        .interface(Coulomb::new(0.5)?)
        .motion(motion)
        .build()
}

/// Large structures begin a step with the last tangent of the step before, which is part of the checkpoint.
#[test]
fn large_yielding_structures_resume_to_the_last_bit() -> Result<()> {
    const RESUMED_RUN_STEPS: usize = 60;
    let mut first = block_of_clay(RESUMED_RUN_STEPS)?;
    assert!(first.structure().dofs() > 400);
    first.run(RESUMED_RUN_STEPS / 2, |_| {})?;
    let checkpoint = through_text(&first.checkpoint()?);
    let mut resumed_simulation = block_of_clay(RESUMED_RUN_STEPS)?;
    resumed_simulation.resume(&checkpoint)?;
    assert_eq!(resumed_simulation.checkpoint()?, checkpoint);
    for _ in RESUMED_RUN_STEPS / 2..RESUMED_RUN_STEPS {
        assert_eq!(first.step()?, resumed_simulation.step()?);
    }
    assert!(first.state().energy_balance.hysteresis > 0.0);
    Ok(())
}

fn anchor(structure: &dyn Any) -> f64 {
    structure.downcast_ref::<BlockWithMovingAnchor>().unwrap().anchor
}

/// GOAL: the internal variables of a structure can be read during a run and after it.
#[test]
fn a_structure_is_returned_in_its_last_state() {
    let builder = with_friction().ground(spring_bed()).structure(BlockWithMovingAnchor::new());
    let mut simulation = builder.build().unwrap();
    let mut previous_anchor = anchor(simulation.structure());
    for _ in 0..50 {
        let increment = simulation.step().unwrap().absolute_displacement()[2];
        let rotation = simulation.static_displacement()[2] + increment;
        let expected = previous_anchor + 0.1 * (rotation - previous_anchor);
        let computed = anchor(simulation.structure());
        assert!((computed - expected).abs() < 1e-12, "{computed:e} {expected:e}");
        previous_anchor = computed;
    }
    assert!(previous_anchor.abs() > 1e-9);
    let structure: Box<dyn Any> = simulation.into_structure();
    assert_eq!(structure.downcast::<BlockWithMovingAnchor>().unwrap().anchor, previous_anchor);
}

fn sliding_block() -> Simulation {
    scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(0.35))
        .build()
        .unwrap()
}

/// A simulation resumed at its start equals a new one, also in the numbers of iterations.
#[test]
fn the_start_is_resumed_in_a_used_simulation() {
    let start = sliding_block();
    let checkpoint = start.checkpoint().unwrap();
    let mut used_simulation = sliding_block();
    used_simulation.run(20, |_| {}).unwrap();
    assert!(used_simulation.state().trials > 0);
    used_simulation.resume(&checkpoint).unwrap();
    assert!(used_simulation.state() == start.state());
}
