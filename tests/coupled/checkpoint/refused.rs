//! GOAL: checkpoints of other scenes are refused, and parts that cannot be saved say so.
//! SCENE: one thing of the scene changed at a time; grounds and structures without `save`.
//! REFERENCE: typed errors, and a simulation that is unchanged.

use basemat::bem::{ContactElement, Ground, SpringGround};
use basemat::history::HistoryMethod;
use basemat::structure::{
    ModalDamping, NonlinearForce, RigidBlock, Structure, StructureGroup, Triplets, WithSprings,
};
use basemat::{CheckpointError, Error, Result};

use super::{half_plane, refusal, spring_bed};
use basemat_problems::scenes::{Rider, SI, block, friction, scene};
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

/// A ground that says nothing of checkpoints.
struct Silent(SpringGround);

impl Ground for Silent {
    fn elements(&self) -> &[ContactElement] {
        self.0.elements()
    }

    fn prepare(&mut self, time_step: f64) -> Result<()> {
        self.0.prepare(time_step)
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.step_compliance(matrix)
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
