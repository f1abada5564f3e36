//! GOAL: checkpoints of other scenes are errors, and parts that cannot be saved return an error.
//! SCENE: one thing of the scene changed at a time; grounds and structures without `save`.
//! REFERENCE: typed errors, and a simulation that is unchanged.

use basemat::bem::SpringGround;
use basemat::coupled::CheckpointError;
use basemat::coupled::{Change, GravityStage, Load, Probe, SimulationBuilder, Theta};
use basemat::history::HistoryMethod;
use basemat::interface::Cohesive;
use basemat::motion::el_centro_1940;
use basemat::structure::{
    ModalDamping, NonlinearForce, RigidBlock, Structure, StructureGroup, Triplets, WithSprings,
};
use basemat::{Error, Result};

use super::{half_plane, resume_error, spring_bed};
use basemat_problems::scenes::{Rider, SI_UNITS, block, friction, scene};
use basemat_problems::wrapped::MinimalGround;
use basemat_problems::{needed_from, own_force};

/// A block on springs without its law.
fn on_springs() -> SimulationBuilder {
    scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).ground(spring_bed())
}

fn sliding_block() -> SimulationBuilder {
    on_springs().interface(friction(0.3))
}

fn bed_of(count: usize, stiffness: f64) -> SpringGround {
    SpringGround::new(-2.0..2.0, count, stiffness, 4e7).unwrap()
}

#[test]
fn other_scenes_are_errors() {
    let mut simulation = sliding_block().build().unwrap();
    simulation.run(20, |_| {}).unwrap();
    let heavier_block = RigidBlock::new(4.0, 6.0, 1600.0).unwrap();
    for (quantity, other) in [
        (
            "number of degrees of freedom",
            sliding_block().structure(Rider { block: block(SI_UNITS) }),
        ),
        ("list of contact elements", sliding_block().ground(bed_of(6, 5e7))),
        ("list of probes", sliding_block().probe(Probe::displacement("top", vec![(0, 1.0)]))),
        ("structure", sliding_block().structure(heavier_block)),
        ("ground", sliding_block().ground(bed_of(8, 6e7))),
        ("static state", sliding_block().gravity(5.0)),
        ("time step or scheme", sliding_block().scheme(Theta::new(0.6).unwrap())),
    ] {
        let checkpoint = other.build().unwrap().checkpoint().unwrap();
        let error = resume_error(&mut simulation, &checkpoint);
        assert_eq!(error, CheckpointError::OtherScene { quantity });
    }
    let direct_history = sliding_block().ground(half_plane(HistoryMethod::Direct)).build().unwrap();
    let exponentials = sliding_block().ground(half_plane(HistoryMethod::Exponentials));
    let error =
        resume_error(&mut exponentials.build().unwrap(), &direct_history.checkpoint().unwrap());
    assert_eq!(error, CheckpointError::OtherScene { quantity: "kind of history" });
}

/// A block with a cohesive bond of this friction and a harmonic load.
fn cohesive_block(coefficient: f64, force: f64) -> SimulationBuilder {
    let law = Cohesive::new(2e3, 3e3, coefficient).unwrap();
    let load = Load::new(vec![(0, 1.0)], move |time: f64| force * (9.0 * time).sin());
    on_springs().interface(law).load(load)
}

fn reference_block() -> SimulationBuilder {
    cohesive_block(0.3, 1e3).label("as built")
}

/// Scenes that differ from the reference, the quantity that shows it, and the change that allows it.
fn changed_scenes() -> [(&'static str, Change, SimulationBuilder); 5] {
    let shaken_block = reference_block().motion(el_centro_1940()).label("El Centro");
    let frictional = reference_block().gravity_stage(GravityStage::Frictional);
    let thrown_block = reference_block().initial_velocity([0.1, 0.0, 0.0]);
    [
        ("label", Change::InterfaceLaw, cohesive_block(0.31, 1e3).label("0.31")),
        ("label", Change::GroundMotion, shaken_block),
        ("label", Change::Load, cohesive_block(0.3, 1.1e3).label("1.1 kN")),
        ("gravity stage", Change::GravityStage, frictional),
        ("initial motion", Change::InitialMotion, thrown_block),
    ]
}

/// Whether a change allows another value of this quantity.
fn allows(change: Change, quantity: &str) -> bool {
    match change {
        Change::GravityStage => quantity == "gravity stage",
        Change::InitialMotion => quantity == "initial motion",
        _ => quantity == "label",
    }
}

/// The label names what is not compared; gravity stage and initial motion are compared.
#[test]
fn what_decides_a_run_is_compared() {
    let mut simulation = reference_block().build().unwrap();
    simulation.run(150, |_| {}).unwrap();
    let checkpoint = simulation.checkpoint().unwrap();
    for (quantity, change, other_simulation) in changed_scenes() {
        let mut other_simulation = other_simulation.build().unwrap();
        assert_eq!(
            resume_error(&mut other_simulation, &checkpoint),
            CheckpointError::OtherScene { quantity }
        );
        let other_changes: Vec<_> = Change::ALL
            .into_iter()
            .filter(|other_change| *other_change != change && !allows(*other_change, quantity))
            .collect();
        assert!(
            other_simulation.resume_changed(&checkpoint, &other_changes).is_err(),
            "{quantity}"
        );
        if change != Change::GravityStage {
            other_simulation.resume_changed(&checkpoint, &[change]).unwrap();
            other_simulation.run(20, |_| {}).unwrap();
        }
    }
    // Another number of loads is detected although the labels are equal.
    let law = Cohesive::new(2e3, 3e3, 0.3).unwrap();
    let mut unloaded_block = on_springs().interface(law).label("as built").build().unwrap();
    let quantity = "load";
    assert_eq!(
        resume_error(&mut unloaded_block, &checkpoint),
        CheckpointError::OtherScene { quantity }
    );
}

#[test]
fn grounds_that_cannot_be_saved_say_so() {
    let unsaved_ground = sliding_block().ground(MinimalGround(spring_bed()));
    let mut simulation = unsaved_ground.build().unwrap();
    simulation.run(5, |_| {}).unwrap();
    let expected = Error::Checkpoint(CheckpointError::Unsupported { part: "ground" });
    assert_eq!(simulation.checkpoint().unwrap_err(), expected);
    let checkpoint = sliding_block().build().unwrap().checkpoint().unwrap();
    assert_eq!(simulation.resume(&checkpoint).unwrap_err(), expected);
    simulation.run(5, |_| {}).unwrap();
}

/// A nonlinear structure without `save`, whose default must return an error.
struct UnsavedRider(Rider);

impl UnsavedRider {
    fn new() -> Self {
        Self(Rider { block: block(SI_UNITS) })
    }
}

impl Structure for UnsavedRider {
    needed_from!(0);

    own_force!();
}

impl NonlinearForce for UnsavedRider {
    fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
        self.0.force(u, force)
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> Result<()> {
        self.0.tangent(u, matrix)
    }
}

#[test]
fn nonlinear_structures_that_cannot_be_saved_say_so() {
    let expected = Error::Checkpoint(CheckpointError::Unsupported { part: "structure" });
    let rider = sliding_block().structure(Rider { block: block(SI_UNITS) }).build().unwrap();
    let checkpoint = rider.checkpoint().unwrap();
    let structures: [Box<dyn Structure>; 4] = [
        Box::new(UnsavedRider::new()),
        Box::new(WithSprings::new(UnsavedRider::new())),
        Box::new(ModalDamping::new(&[0.05]).unwrap().on(UnsavedRider::new()).unwrap()),
        Box::new(StructureGroup::new().with(UnsavedRider::new(), 0.0).unwrap()),
    ];
    for (index, structure) in structures.into_iter().enumerate() {
        let mut simulation = sliding_block().structure(structure).build().unwrap();
        simulation.run(5, |_| {}).unwrap();
        assert_eq!(simulation.checkpoint().unwrap_err(), expected, "{index}");
        if index == 0 {
            assert_eq!(simulation.resume(&checkpoint).unwrap_err(), expected);
        }
        simulation.run(5, |_| {}).unwrap();
    }
}
