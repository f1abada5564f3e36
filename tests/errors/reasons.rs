//! GOAL: a structure's error of a matrix, a load, a force or a tangent is reported, with nothing committed; a nonlinear
//! force with only one of its two accessors is an error.
//! SCENE: a structure on springs that returns an error for one part, from a time or a displacement on.
//! REFERENCE: the structure's error; the state before the step.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::coupled::StepError;
use basemat::interface::Bonded;
use basemat::motion::FreeFieldFn;
use basemat::structure::{
    Base, BaseNode, Bilinear, CraigBampton, ModalDamping, NonlinearForce, Structure,
    StructureGroup, Triplets, WithSprings,
};
use basemat::{Error, Result, Simulation};

use basemat_problems::block_on_springs::bed;

/// The part of a structure that returns an error.
#[derive(Debug, Clone, Copy, PartialEq)]
enum RefusedPart {
    None,
    Mass,
    Stiffness,
    Damping,
    Load,
    Force,
    Tangent,
}

/// Two masses joined by a nonlinear spring, of which one part returns an error.
struct StructureWithError {
    part: RefusedPart,
    /// Time from which the load returns an error (s), or drift from which force and tangent do (m).
    threshold: f64,
    /// Whether `nonlinear` returns the structure.
    has_force: bool,
    /// Whether `nonlinear_mut` returns the structure.
    has_mutable_force: bool,
    commits: Arc<AtomicUsize>,
}

fn part_error() -> Error {
    Error::part("my structure", "a spring of it has torn")
}

impl StructureWithError {
    fn new(part: RefusedPart, threshold: f64) -> Self {
        let commits = Arc::default();
        Self { part, threshold, has_force: true, has_mutable_force: true, commits }
    }

    /// A structure without errors.
    fn intact() -> Self {
        Self::new(RefusedPart::None, 0.0)
    }

    fn check(&self, part: RefusedPart, value: f64) -> Result<()> {
        if self.part == part && value >= self.threshold { Err(part_error()) } else { Ok(()) }
    }
}

impl Structure for StructureWithError {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        (0..4).for_each(|i| matrix.add(i, i, 1e4));
        self.check(RefusedPart::Mass, 0.0)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        matrix.add_spring(0, 3, 1e6);
        self.check(RefusedPart::Stiffness, 0.0)
    }

    fn damping(&self, _: &mut Triplets) -> Result<()> {
        self.check(RefusedPart::Damping, 0.0)
    }

    fn load(&self, time: f64, _: &mut [f64]) -> Result<()> {
        self.check(RefusedPart::Load, time)
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.has_force.then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.has_mutable_force.then_some(self)
    }
}

impl NonlinearForce for StructureWithError {
    fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
        let drift = u[3] - u[0];
        force[3] += 1e8 * drift.powi(3);
        force[0] -= 1e8 * drift.powi(3);
        self.check(RefusedPart::Force, drift.abs())
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> Result<()> {
        matrix.add_spring(0, 3, 3e8 * (u[3] - u[0]).powi(2));
        self.check(RefusedPart::Tangent, (u[3] - u[0]).abs())
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
fn matrices_and_the_static_load_are_errors_with_the_structures_error() {
    for part in [
        RefusedPart::Mass,
        RefusedPart::Stiffness,
        RefusedPart::Damping,
        RefusedPart::Load,
        RefusedPart::Force,
        RefusedPart::Tangent,
    ] {
        let [single_structure, group_member, structure_with_springs] =
            [(); 3].map(|()| StructureWithError::new(part, 0.0));
        assert_eq!(build(single_structure).unwrap_err(), part_error(), "{part:?}");
        let group = StructureGroup::new().with(group_member, 0.0).unwrap();
        assert_eq!(build(group).unwrap_err(), part_error(), "{part:?}");
        let with_springs = WithSprings::new(structure_with_springs);
        assert_eq!(build(with_springs).unwrap_err(), part_error(), "{part:?}");
    }
    let damping = ModalDamping::new(&[0.05]).unwrap();
    let structure = StructureWithError::new(RefusedPart::Stiffness, 0.0);
    assert_eq!(damping.on(structure).unwrap_err(), part_error());
    let linear_structure = StructureWithError {
        has_force: false,
        has_mutable_force: false,
        ..StructureWithError::new(RefusedPart::Mass, 0.0)
    };
    assert_eq!(CraigBampton::new(0).reduce(linear_structure).unwrap_err(), part_error());
}

#[test]
fn a_step_with_an_error_of_the_structure_commits_nothing() {
    for (part, threshold, quantity) in [
        (RefusedPart::Load, 0.0205, "load of the structure"),
        (RefusedPart::Force, 1e-4, "nonlinear force of the structure"),
        (RefusedPart::Tangent, 1e-4, "tangent of the structure"),
    ] {
        let structure = StructureWithError::new(part, threshold);
        let commits = Arc::clone(&structure.commits);
        let mut simulation = build(structure).unwrap();
        // The static state is committed once.
        assert_eq!(commits.swap(0, Ordering::Relaxed), 1, "{part:?}");
        let mut accepted_steps = 0;
        let error = loop {
            let state = simulation.state().clone();
            if let Err(error) = simulation.step() {
                assert_eq!(*simulation.state(), state, "{part:?}");
                break error;
            }
            accepted_steps += 1;
            assert!(accepted_steps < 1000, "{part:?} is never an error");
        };
        assert_eq!(commits.load(Ordering::Relaxed), accepted_steps, "{part:?}");
        let Error::Step { step, source, .. } = &error else { panic!("{error:?}") };
        assert_eq!(*step, accepted_steps + 1);
        let expected = StepError::Part { quantity, source: Box::new(part_error()) };
        assert_eq!(*source, expected);
        let text = format!("{quantity}: my structure: a spring");
        assert!(error.to_string().contains(&text), "{error}");
        // Another attempt has the same error, and commits nothing.
        assert_eq!(simulation.step().unwrap_err(), error);
        assert_eq!(commits.load(Ordering::Relaxed), accepted_steps, "{part:?}");
    }
}

/// A structure with only one of the two accessors of its nonlinear force.
fn with_one_accessor(is_mutable: bool) -> StructureWithError {
    StructureWithError {
        has_force: !is_mutable,
        has_mutable_force: is_mutable,
        ..StructureWithError::intact()
    }
}

fn group_of(first: StructureWithError, second: StructureWithError) -> StructureGroup {
    StructureGroup::new().with(first, -2.0).unwrap().with(second, 4.0).unwrap()
}

#[test]
fn a_nonlinear_force_with_one_accessor_is_an_error() {
    for is_mutable in [false, true] {
        let structure = || with_one_accessor(is_mutable);
        let spring = Bilinear::new(1e6, 1e4, 0.1).unwrap();
        let with_spring = WithSprings::new(structure()).spring(vec![(0, -1.0), (3, 1.0)], spring);
        let structures: [Box<dyn Structure>; 6] = [
            Box::new(structure()),
            Box::new(WithSprings::new(structure())),
            Box::new(with_spring.unwrap()),
            Box::new(ModalDamping::new(&[0.05]).unwrap().on(structure()).unwrap()),
            Box::new(group_of(structure(), StructureWithError::intact())),
            Box::new(group_of(StructureWithError::intact(), structure())),
        ];
        for (index, structure) in structures.into_iter().enumerate() {
            let Err(Error::Scene { quantity, .. }) = build(structure) else {
                panic!("mutable {is_mutable}, structure {index} was no error");
            };
            assert_eq!(quantity, "nonlinear force of the structure");
        }
        assert!(CraigBampton::new(0).reduce(structure()).is_err());
    }
    build(StructureWithError::intact()).unwrap();
}
