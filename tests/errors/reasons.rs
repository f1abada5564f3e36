//! GOAL: the reason of a structure's own for refusing a matrix, a load, a force or a tangent arrives,
//! with nothing committed; a nonlinear force that is shown by half is refused.
//! SCENE: a block on springs that refuses one thing from a time or a displacement on.
//! REFERENCE: the reason itself; the state before the step.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::coupled::StepError;
use basemat::interface::Bonded;
use basemat::motion::FreeFieldFn;
use basemat::structure::{
    Base, BaseNode, CraigBampton, ModalDamping, NonlinearForce, Structure, StructureGroup,
    Triplets, WithSprings,
};
use basemat::{Error, Result, Simulation};

use basemat_problems::block_on_springs::bed;

/// The one thing that is refused.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Nothing,
    Mass,
    Stiffness,
    Damping,
    Load,
    Force,
    Tangent,
}

struct Refusing {
    part: Part,
    /// Load from this time on (s), force and tangent from this sway on (m).
    from: f64,
    shown: [bool; 2],
    commits: Arc<AtomicUsize>,
}

fn reason() -> Error {
    Error::part("my structure", "a spring of it has torn")
}

impl Refusing {
    fn new(part: Part, from: f64) -> Self {
        Self { part, from, shown: [true; 2], commits: Arc::default() }
    }

    fn answer(&self, part: Part, reached: f64) -> Result<()> {
        if self.part == part && reached >= self.from { Err(reason()) } else { Ok(()) }
    }
}

impl Structure for Refusing {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        (0..4).for_each(|i| matrix.add(i, i, 1e4));
        self.answer(Part::Mass, 0.0)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        matrix.add_spring(0, 3, 1e6);
        self.answer(Part::Stiffness, 0.0)
    }

    fn damping(&self, _: &mut Triplets) -> Result<()> {
        self.answer(Part::Damping, 0.0)
    }

    fn load(&self, time: f64, _: &mut [f64]) -> Result<()> {
        self.answer(Part::Load, time)
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.shown[0].then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.shown[1].then_some(self)
    }
}

impl NonlinearForce for Refusing {
    fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
        let stretch = u[3] - u[0];
        force[3] += 1e8 * stretch.powi(3);
        force[0] -= 1e8 * stretch.powi(3);
        self.answer(Part::Force, stretch.abs())
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> Result<()> {
        matrix.add_spring(0, 3, 3e8 * (u[3] - u[0]).powi(2));
        self.answer(Part::Tangent, (u[3] - u[0]).abs())
    }

    fn commit(&mut self, _: &[f64]) {
        self.commits.fetch_add(1, Ordering::Relaxed);
    }
}

fn build(structure: impl Structure + 'static) -> Result<Simulation> {
    Simulation::builder(1e-3)
        .structure(structure)
        .ground(bed(4))
        .interface(Bonded)
        .motion(FreeFieldFn::new(|_, t| [5.0 * t * t, 0.0]))
        .build()
}

#[test]
fn matrices_and_the_static_load_are_refused_with_the_structures_reason() {
    for part in [Part::Mass, Part::Stiffness, Part::Damping, Part::Load, Part::Force, Part::Tangent]
    {
        let refusing = || Refusing::new(part, 0.0);
        assert_eq!(build(refusing()).unwrap_err(), reason(), "{part:?}");
        let group = StructureGroup::new().with(refusing(), 0.0).unwrap();
        assert_eq!(build(group).unwrap_err(), reason(), "{part:?}");
        assert_eq!(build(WithSprings::new(refusing())).unwrap_err(), reason(), "{part:?}");
    }
    let damped = ModalDamping::new(&[0.05]).unwrap();
    assert_eq!(damped.on(Refusing::new(Part::Stiffness, 0.0)).unwrap_err(), reason());
    let linear = Refusing { shown: [false; 2], ..Refusing::new(Part::Mass, 0.0) };
    assert_eq!(CraigBampton::new(0).reduce(linear).unwrap_err(), reason());
}

#[test]
fn a_step_that_the_structure_refuses_commits_nothing() {
    for (part, from, name) in [
        (Part::Load, 0.0205, "load of the structure"),
        (Part::Force, 1e-4, "nonlinear force of the structure"),
        (Part::Tangent, 1e-4, "tangent of the structure"),
    ] {
        let structure = Refusing::new(part, from);
        let commits = Arc::clone(&structure.commits);
        let mut simulation = build(structure).unwrap();
        // The static state.
        assert_eq!(commits.swap(0, Ordering::Relaxed), 1, "{part:?}");
        let mut accepted = 0;
        let error = loop {
            let before = simulation.state().clone();
            if let Err(error) = simulation.step() {
                assert_eq!(*simulation.state(), before, "{part:?}");
                break error;
            }
            accepted += 1;
            assert!(accepted < 1000, "{part:?} is never refused");
        };
        assert_eq!(commits.load(Ordering::Relaxed), accepted, "{part:?}");
        let Error::Step { step, source, .. } = &error else { panic!("{error:?}") };
        assert_eq!(*step, accepted + 1);
        let expected = StepError::Part { quantity: name, source: Box::new(reason()) };
        assert_eq!(*source, expected);
        assert!(error.to_string().contains(&format!("{name}: my structure: a spring")), "{error}");
        // Again: the same error, and still nothing committed.
        assert_eq!(simulation.step().unwrap_err(), error);
        assert_eq!(commits.load(Ordering::Relaxed), accepted, "{part:?}");
    }
}

#[test]
fn a_nonlinear_force_that_is_shown_by_half_is_refused() {
    for shown in [[true, false], [false, true]] {
        let half = || Refusing { shown, ..Refusing::new(Part::Nothing, 0.0) };
        let whole = || Refusing::new(Part::Nothing, 0.0);
        let group = |first, second| {
            let group = StructureGroup::new().with(first, -2.0).unwrap();
            group.with(second, 4.0).unwrap()
        };
        let sprung = |structure: Refusing| {
            let law = basemat::structure::Bilinear::new(1e6, 1e4, 0.1).unwrap();
            WithSprings::new(structure).spring(vec![(0, -1.0), (3, 1.0)], law).unwrap()
        };
        let damped = ModalDamping::new(&[0.05]).unwrap().on(half()).unwrap();
        let all: Vec<Box<dyn Structure>> = vec![
            Box::new(half()),
            Box::new(WithSprings::new(half())),
            Box::new(sprung(half())),
            Box::new(damped),
            Box::new(group(half(), whole())),
            Box::new(group(whole(), half())),
        ];
        for (k, structure) in all.into_iter().enumerate() {
            let Err(Error::Scene { quantity, .. }) = build(structure) else {
                panic!("{shown:?}, structure {k} was not refused");
            };
            assert_eq!(quantity, "nonlinear force of the structure");
        }
        assert!(CraigBampton::new(0).reduce(half()).is_err());
    }
    build(Refusing::new(Part::Nothing, 0.0)).unwrap();
}
