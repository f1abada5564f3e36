//! GOAL: checkpoints of other scenes are refused, and parts that cannot be saved say so.
//! SCENE: one thing of the scene changed at a time; grounds and structures without `save`.
//! REFERENCE: typed errors, and a simulation that is unchanged.

use basemat::bem::SpringGround;
use basemat::coupled::CheckpointError;
use basemat::coupled::{Change, GravityStage, Load, SimulationBuilder};
use basemat::history::HistoryMethod;
use basemat::interface::Cohesive;
use basemat::motion::el_centro_1940;
use basemat::structure::{
    ModalDamping, NonlinearForce, RigidBlock, Structure, StructureGroup, Triplets, WithSprings,
};
use basemat::{Error, Result};

use super::{half_plane, refusal, spring_bed};
use basemat_problems::scenes::{Rider, SI, block, friction, scene};
use basemat_problems::wrapped::BareGround;
use basemat_problems::{needed_from, own_force};

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
        (
            "number of degrees of freedom",
            base().structure(Rider { block: block(SI) }).ground(spring_bed()),
        ),
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
    let direct = with(HistoryMethod::Direct).checkpoint().unwrap();
    let quantity = "kind of history";
    let found = refusal(&mut with(HistoryMethod::Exponentials), &direct);
    assert_eq!(found, CheckpointError::OtherScene { quantity });
}

/// The label names what is not compared; gravity stage and initial motion are compared.
#[test]
fn what_decides_a_run_is_compared() {
    let law = || Cohesive::new(2e3, 3e3, 0.3).unwrap();
    let base = || scene(SI, 0.6).structure(block(SI)).ground(spring_bed()).interface(law());
    let load =
        |factor: f64| Load::new(vec![(0, 1.0)], move |time: f64| factor * (9.0 * time).sin());
    let plain = || base().load(load(1e3)).label("as built");
    let softer = || Cohesive::new(2e3, 3e3, 0.31).unwrap();
    let cases: [(&str, Change, SimulationBuilder); 5] = [
        ("label", Change::InterfaceLaw, plain().interface(softer()).label("0.31")),
        ("label", Change::GroundMotion, plain().motion(el_centro_1940()).label("El Centro")),
        ("label", Change::Load, base().load(load(1.1e3)).label("1.1 kN")),
        ("gravity stage", Change::GravityStage, plain().gravity_stage(GravityStage::Frictional)),
        ("initial motion", Change::InitialMotion, plain().initial_velocity([0.1, 0.0, 0.0])),
    ];
    let mut simulation = plain().build().unwrap();
    simulation.run(150, |_| {}).unwrap();
    let saved = simulation.checkpoint().unwrap();
    for (quantity, change, other) in cases {
        let mut other = other.build().unwrap();
        assert_eq!(refusal(&mut other, &saved), CheckpointError::OtherScene { quantity });
        let may_relabel = |own: &Change| {
            quantity == "label" && !matches!(own, Change::GravityStage | Change::InitialMotion)
        };
        let others: Vec<_> =
            Change::ALL.into_iter().filter(|own| *own != change && !may_relabel(own)).collect();
        assert!(other.resume_changed(&saved, &others).is_err(), "{quantity}");
        if change != Change::GravityStage {
            other.resume_changed(&saved, &[change]).unwrap();
            other.run(20, |_| {}).unwrap();
        }
    }
    // Another number of loads shows without a label.
    let mut unloaded = base().label("as built").build().unwrap();
    let quantity = "load";
    assert_eq!(refusal(&mut unloaded, &saved), CheckpointError::OtherScene { quantity });
}

#[test]
fn grounds_that_cannot_be_saved_say_so() {
    let base = || scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
    let mut silent = base().ground(BareGround(spring_bed())).build().unwrap();
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
    needed_from!(0);

    own_force!();
}

impl NonlinearForce for Unsaved {
    fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
        self.0.force(u, force)
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> Result<()> {
        self.0.tangent(u, matrix)
    }
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
