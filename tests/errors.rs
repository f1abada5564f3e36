//! Bad input: the soil, the ground, the interface, the motion and the builder refuse it with a
//! typed error that names quantity, value and need. Elements, structures, record files and closed
//! forms have the like in their own test files.

mod scene;

use std::fmt::Debug;

use basemat::bem::{
    ContactElement, Grading, Ground, HalfPlaneGround, InfluenceKernel, PatchKernel, SpringGround,
    StaticKernel, Strip,
};
use basemat::coupled::{
    Placement, Probe, SchemeCoefficients, SimulationBuilder, Theta, TimeScheme,
};
use basemat::interface::{
    Activation, Bonded, Condition, ContactState, Coulomb, InterfaceLaw, Mode, StepStart, Tolerance,
};
use basemat::motion::{Baseline, FreeField, FreeFieldFn, Record, RickerDisplacement};
use basemat::structure::{ContactNode, Row, Structure, Triplets};
use basemat::{Error, Simulation, Soil, StepError};

use scene::{bed, block};

const BAD: [f64; 5] = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const NEGATIVE: [f64; 3] = [-1.0, f64::NAN, f64::INFINITY];

/// Every value is refused by an input error that carries it and says so in its message.
#[track_caller]
fn refused<T>(name: &str, bad: &[f64], build: impl Fn(f64) -> basemat::Result<T>) {
    for &value in bad {
        let Err(error) = build(value) else { panic!("{name} of {value} was accepted") };
        let Error::Input { quantity, value: reported, needed } = &error else {
            panic!("{name} of {value}: {error:?}");
        };
        assert!(quantity.contains(name), "{quantity}, not {name}");
        assert!(*reported == value || !value.is_finite(), "{reported} for {value}");
        let message = error.to_string();
        for part in [*quantity, &reported.to_string(), *needed] {
            assert!(message.contains(part), "'{part}' is not in '{message}'");
        }
    }
}

/// The error, which also must say `part`.
#[track_caller]
fn error_with<T>(part: &str, outcome: basemat::Result<T>) -> Error {
    let Err(error) = outcome else { panic!("accepted: {part}") };
    assert!(error.to_string().contains(part), "'{part}' is not in '{error}'");
    error
}

fn soil() -> Soil {
    Soil::new(80.0e6, 0.33, 1900.0).unwrap()
}

#[test]
fn soils() {
    refused("shear modulus", &BAD, |x| Soil::new(x, 0.3, 1.0));
    refused("density", &BAD, |x| Soil::new(1.0, 0.3, x));
    let out_of_range = [-1.0, 0.5, 0.7, -3.0, f64::NAN, f64::INFINITY];
    refused("Poisson's ratio", &out_of_range, |x| Soil::new(1.0, x, 1.0));
    refused("shear wave speed", &BAD, |x| Soil::from_wave_speeds(x, 2.0, 1.0));
    refused("pressure wave speed", &BAD, |x| Soil::from_wave_speeds(1.0, x, 1.0));
    refused("density", &BAD, |x| Soil::from_wave_speeds(1.0, 2.0, x));
    error_with("Poisson's ratio", Soil::from_wave_speeds(1.0, 1.1, 1.0));
    error_with("shear wave speed", Soil::new(1e-300, 0.3, 1e300));
}

#[test]
fn strips_and_grounds() {
    refused("left end", &NOT_FINITE, |x| Strip::uniform(x..1.0, 2));
    refused("right end", &NOT_FINITE, |x| Strip::new(0.0..x, 2, Grading::Cosine));
    refused("length of the strip", &[0.0, -1.0], |x| Strip::uniform(0.0..x, 2));
    refused("number of contact elements", &[0.0], |_| Strip::uniform(0.0..1.0, 0));
    refused("strip node", &NOT_FINITE, |x| Strip::from_nodes(vec![0.0, x, 2.0]));
    refused("length of a contact element", &[0.0], |_| Strip::from_nodes(vec![1.0, 1.0]));
    let found = error_with("strip nodes", Strip::from_nodes(vec![1.0]));
    assert!(matches!(found, Error::Size { found: 1, needed: 2, .. }));

    refused("length of the strip", &[-1.0], |x| HalfPlaneGround::strip(soil(), 0.0..x, 2));
    refused("number of contact", &[0.0], |_| HalfPlaneGround::graded_strip(soil(), 0.0..1.0, 0));
    let none = error_with("contact elements", HalfPlaneGround::new(soil(), &[]));
    assert!(matches!(none, Error::Size { found: 0, needed: 1, .. }));
    let strip = |left: f64| Strip::uniform(left..left + 2.0, 2).unwrap();
    refused("left end of a contact element", &[1.0, -2.0], |x| {
        HalfPlaneGround::new(soil(), &[strip(0.0), strip(x)])
    });

    refused("normal stiffness", &BAD, |x| SpringGround::new(0.0..1.0, 2, x, 1.0));
    refused("tangential stiffness", &BAD, |x| SpringGround::new(0.0..1.0, 2, 1.0, x));
    refused("normal dashpot", &NEGATIVE, |x| bed(2).with_dashpots(x, 0.0));
    refused("tangential dashpot", &NEGATIVE, |x| bed(2).with_dashpots(0.0, x));
    refused("theta", &[0.49, 1.01, f64::NAN], |x| bed(2).with_theta(x));
    refused("time step", &BAD, |x| bed(2).prepare(x));
    refused("time step", &BAD, |x| HalfPlaneGround::strip(soil(), 0.0..1.0, 2)?.prepare(x));
}

#[test]
fn an_unprepared_half_plane_says_so() {
    let mut ground = HalfPlaneGround::strip(soil(), 0.0..1.0, 1).unwrap();
    error_with("prepare", ground.instantaneous(&mut [0.0; 4]));
    error_with("prepare", ground.history(&mut [0.0; 2]));
    error_with("prepare", ground.reserve(10));
}

#[test]
fn an_unprepared_spring_bed_says_so() {
    let mut bed = SpringGround::new(0.0..1.0, 1, 1e6, 1e6).unwrap();
    error_with("prepare", bed.instantaneous(&mut [0.0; 4]));
    error_with("prepare", bed.history(&mut [0.0; 2]));
}

/// Counts as large as they come are refused or cut, not allocated.
#[test]
fn absurd_counts_do_not_panic() {
    for count in [0, 1_000_000_000_000, usize::MAX] {
        error_with("number of contact elements", HalfPlaneGround::strip(soil(), 0.0..1.0, count));
        error_with("number of contact elements", SpringGround::new(0.0..1.0, count, 1.0, 1.0));
    }
    let mut ground = HalfPlaneGround::strip(soil(), 0.0..1.0, 1).unwrap();
    ground.prepare(0.01).unwrap();
    ground.reserve(usize::MAX).unwrap();

    // Steps beside which the fronts' passage is no time at all must not split pieces without end.
    for step in [1e200, 1e300] {
        ground.prepare(step).unwrap();
        assert!(ground.instantaneous(&mut [0.0; 4]).is_ok());
    }

    let left = ContactElement { left: 0.0, right: 1.0 };
    let right = ContactElement { left: 1.0, right: 2.0 };
    let kernel = InfluenceKernel::new(soil(), 1e-30).unwrap();
    let pair = kernel.pair(right, left).unwrap();
    assert_eq!(pair.coupling_ends(), usize::MAX);
    pair.fill(usize::MAX, &mut [0.0; 2], &mut [0.0; 2], &mut [0.0; 2]).unwrap();
}

#[test]
fn kernels() {
    let element = |left: f64, right: f64| ContactElement { left, right };
    refused("time step", &BAD, |x| InfluenceKernel::new(soil(), x));
    let kernel = InfluenceKernel::new(soil(), 1e-3).unwrap();
    let unit = element(0.0, 1.0);
    for bad in [element(f64::NAN, 1.0), element(0.0, f64::INFINITY), element(1.0, 0.0)] {
        assert!(matches!(kernel.pair(bad, unit), Err(Error::Input { .. })));
        assert!(matches!(kernel.coefficients(unit, bad, 1), Err(Error::Input { .. })));
        let statics = StaticKernel::new(soil(), 1.0).unwrap();
        assert!(matches!(statics.coefficients(bad, unit), Err(Error::Input { .. })));
        assert!(PatchKernel::new(soil(), vec![bad], 1e-3).is_err());
    }
    refused("lag", &[0.0], |_| kernel.coefficients(unit, unit, 0));
    refused("reference length", &BAD, |x| StaticKernel::new(soil(), x));
    let pair = kernel.pair(unit, unit).unwrap();
    let uneven = pair.fill(1, &mut [0.0; 3], &mut [0.0; 2], &mut [0.0; 3]);
    assert!(matches!(error_with("xx", uneven), Error::Size { found: 2, needed: 3, .. }));
    error_with("first lag", pair.fill(0, &mut [0.0], &mut [0.0], &mut [0.0]));

    refused("time step", &BAD, |x| PatchKernel::new(soil(), vec![unit], x));
    error_with("contact elements", PatchKernel::new(soil(), vec![], 1e-3));
    let overlapping = vec![unit, element(0.5, 1.5)];
    error_with("left end", PatchKernel::new(soil(), overlapping, 1e-3));
}

#[test]
fn laws_and_schemes() {
    refused("friction", &[-0.1, f64::NAN, f64::NEG_INFINITY], Coulomb::new);
    let law = Coulomb::uplift_only();
    refused("tensile strength", &NEGATIVE, |x| law.with_tensile_strength(x));
    refused("gap below", &NEGATIVE, |closed_below| {
        law.with_activation(Activation::Rate { closed_below })
    });
    refused("theta", &[0.0, 0.49, 1.01, f64::NAN], Theta::new);
}

#[test]
fn motions() {
    refused("time step of the record", &BAD, |x| Record::new(x, vec![0.0; 3]));
    refused("acceleration", &NOT_FINITE, |x| Record::new(0.1, vec![0.0, x, 0.0]));
    for few in [vec![], vec![1.0]] {
        assert!(matches!(error_with("samples", Record::new(0.1, few)), Error::Record { .. }));
    }
    let record = Record::new(0.1, vec![0.0, 1.0, 0.0, -1.0]).unwrap();
    refused("new time step", &BAD, |x| record.resampled(x));
    refused("scale factor", &NOT_FINITE, |x| record.scaled(x));
    refused("wanted peak", &BAD, |x| record.scaled_to_peak(x));
    assert!(record.with_baseline(Baseline::VelocityPolynomial { degree: 0 }).is_err());
    assert!(record.with_baseline(Baseline::RestToRest { degree: 9 }).is_err());
    refused("amplitude", &NOT_FINITE, |x| RickerDisplacement::new(x, 0.1, 1.0));
    refused("width", &BAD, |x| RickerDisplacement::new(1.0, x, 1.0));
    refused("center", &[0.0, f64::NAN, f64::INFINITY], |x| RickerDisplacement::new(1.0, 0.1, x));
}

/// A scene that is complete, for one thing to be spoilt.
fn good() -> SimulationBuilder {
    Simulation::builder(1e-3).structure(block()).ground(bed(4)).interface(Bonded)
}

#[track_caller]
fn unbuilt(part: &str, builder: SimulationBuilder) -> Error {
    error_with(part, builder.build())
}

#[test]
fn builders_refuse_missing_parts_and_bad_numbers() {
    assert!(good().build().is_ok());
    let step = |x| {
        Simulation::builder(x).structure(block()).ground(bed(4)).interface(Bonded).build().map(drop)
    };
    refused("time step", &BAD, step);
    refused("gravity", &NEGATIVE, |x| good().gravity(x).build().map(drop));
    refused("moment center", &NOT_FINITE, |x| good().moment_center(x).build().map(drop));

    let empty = Simulation::builder(1e-3);
    assert!(matches!(unbuilt("structure", empty), Error::Scene { .. }));
    let groundless = Simulation::builder(1e-3).structure(block());
    assert!(matches!(unbuilt("ground", groundless), Error::Scene { .. }));
    let lawless = Simulation::builder(1e-3).structure(block()).ground(bed(4));
    assert!(matches!(unbuilt("interface", lawless), Error::Scene { .. }));
}

#[test]
fn builders_refuse_parts_that_do_not_fit() {
    let laws = |count: usize| -> Vec<Box<dyn InterfaceLaw>> {
        (0..count).map(|_| Box::new(Bonded) as Box<dyn InterfaceLaw>).collect()
    };
    assert!(good().interfaces(laws(4)).build().is_ok());
    for found in [2, 3, 5] {
        let error = unbuilt("interface laws", good().interfaces(laws(found)));
        assert_eq!(error, Error::Size { quantity: "list of interface laws", found, needed: 4 });
    }
    assert!(matches!(unbuilt("interface law", good().interfaces(vec![])), Error::Scene { .. }));

    let probe = Probe::velocity("far", 3);
    let error = unbuilt("probe", good().probe(probe));
    let source = Box::new(Error::Index { quantity: "unknown", index: 3, bound: 3 });
    assert_eq!(error, Error::Probe { name: "far".to_owned(), source });
    for bad in NOT_FINITE {
        let probe = Probe::displacement("bad", (0, bad));
        let error = unbuilt("probe 'bad': weight of an unknown", good().probe(probe));
        assert!(
            matches!(error, Error::Probe { source, .. } if matches!(*source, Error::Input { .. }))
        );
    }

    // Two probes of one name: which would `Run::probe` tell of?
    let probes = [Probe::displacement("u", 0), Probe::velocity("v", 0), Probe::velocity("u", 1)];
    let error = unbuilt("called 'u'", good().probes(probes.clone()));
    assert_eq!(error, Error::DuplicateName { quantity: "probe", name: "u".to_owned() });
    assert!(good().probes(probes[..2].to_vec()).build().is_ok());

    // Twice as wide as the block.
    let wide = SpringGround::new(-4.0..4.0, 4, 1e7, 1e7).unwrap();
    assert!(matches!(unbuilt("overlap of the base", good().ground(wide)), Error::Input { .. }));
    refused("free field at t = 0", &NOT_FINITE, |x| good().motion(Standing(x)).build().map(drop));
}

/// A free field that never moves, wherever it stands.
struct Standing(f64);

impl FreeField for Standing {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        [self.0, 0.0]
    }
}

struct NoModes;

impl InterfaceLaw for NoModes {
    fn modes(&self) -> &[Mode] {
        &[]
    }

    fn conditions(&self, _: Mode, start: &StepStart) -> [Condition; 2] {
        Bonded.conditions(Mode::Stick, start)
    }

    fn next_mode(&self, mode: Mode, _: &StepStart, _: &ContactState, _: Tolerance) -> Mode {
        mode
    }
}

struct NotANumber;

impl TimeScheme for NotANumber {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        SchemeCoefficients {
            acceleration: [f64::NAN, 0.0, 0.0],
            ..Theta::new(0.5).unwrap().coefficients(time_step)
        }
    }
}

#[test]
fn builders_refuse_broken_plugins() {
    assert!(matches!(unbuilt("modes", good().interface(NoModes)), Error::Scene { .. }));
    let error = unbuilt("effective stiffness", good().scheme(NotANumber));
    assert!(matches!(error, Error::Singular { .. } | Error::Input { .. }), "{error:?}");
}

/// A structure of which one part is spoilt.
#[derive(Clone)]
struct Spoilt {
    unknowns: usize,
    nodes: Vec<ContactNode>,
    mass: (usize, usize, f64),
    stiffness: (usize, usize, f64),
    damping: (usize, usize, f64),
    tangent: Option<(usize, usize, f64)>,
    shrinks: bool,
    load_from: f64,
    push: f64,
}

impl Spoilt {
    fn sound() -> Self {
        Self {
            unknowns: 3,
            nodes: ContactNode::rigid_base(-2.0, 2.0, [0, 1, 2]),
            mass: (0, 0, 0.0),
            stiffness: (0, 0, 0.0),
            damping: (0, 0, 0.0),
            tangent: None,
            shrinks: false,
            load_from: f64::INFINITY,
            push: 0.0,
        }
    }

    fn scene(self) -> SimulationBuilder {
        Simulation::builder(1e-3).structure(self).ground(bed(4)).interface(Bonded).gravity(9.81)
    }
}

impl Structure for Spoilt {
    fn unknowns(&self) -> usize {
        self.unknowns
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.nodes.clone()
    }

    fn mass(&self, matrix: &mut Triplets) {
        for i in 0..self.unknowns.min(3) {
            matrix.add(i, i, 1e4);
        }
        let (row, column, value) = self.mass;
        matrix.add(row, column, value);
    }

    fn stiffness(&self, matrix: &mut Triplets) {
        let (row, column, value) = self.stiffness;
        matrix.add(row, column, value);
        if self.shrinks {
            *matrix = Triplets::new(1);
        }
    }

    fn damping(&self, matrix: &mut Triplets) {
        let (row, column, value) = self.damping;
        matrix.add(row, column, value);
    }

    fn load(&self, time: f64, load: &mut [f64]) {
        load[0] += self.push;
        if time >= self.load_from {
            load[0] = f64::NAN;
        }
    }

    fn is_linear(&self) -> bool {
        self.tangent.is_none()
    }

    fn nonlinear_tangent(&self, _: &[f64], matrix: &mut Triplets) {
        if let Some((row, column, value)) = self.tangent {
            matrix.add(row, column, value);
        }
    }
}

#[test]
fn structures_that_write_out_of_range_or_nan_are_refused() {
    assert!(Spoilt::sound().scene().build().is_ok());
    let sound = Spoilt::sound;
    for entry in [(3, 0, 1.0), (0, 3, 1.0), (usize::MAX, 0, 1.0)] {
        let index = entry.0.max(entry.1);
        for (name, spoilt) in [
            ("mass matrix", Spoilt { mass: entry, ..sound() }),
            ("stiffness matrix", Spoilt { stiffness: entry, ..sound() }),
            ("damping matrix", Spoilt { damping: entry, ..sound() }),
            ("tangent of the nonlinear force", Spoilt { tangent: Some(entry), ..sound() }),
        ] {
            let error = unbuilt(name, spoilt.scene());
            assert_eq!(error, Error::Index { quantity: name, index, bound: 3 });
        }
    }
    refused("mass matrix", &NOT_FINITE, |x| {
        Spoilt { mass: (0, 0, x), ..sound() }.scene().build().map(drop)
    });
    refused("stiffness matrix", &NOT_FINITE, |x| {
        Spoilt { stiffness: (0, 0, x), ..sound() }.scene().build().map(drop)
    });
    refused("damping matrix", &NOT_FINITE, |x| {
        Spoilt { damping: (0, 0, x), ..sound() }.scene().build().map(drop)
    });
    refused("tangent", &NOT_FINITE, |x| {
        Spoilt { tangent: Some((0, 0, x)), ..sound() }.scene().build().map(drop)
    });
    let error = unbuilt("stiffness matrix", Spoilt { shrinks: true, ..sound() }.scene());
    assert!(matches!(error, Error::Size { found: 1, needed: 3, .. }));
    refused("load at t = 0", &[f64::NAN], |_| {
        Spoilt { load_from: 0.0, ..sound() }.scene().build().map(drop)
    });
}

#[test]
fn structures_with_a_bad_base_are_refused() {
    let with = |nodes: Vec<ContactNode>| Spoilt { nodes, ..Spoilt::sound() }.scene();
    let error = unbuilt("contact nodes", with(vec![ContactNode::free(0.0, 0, 1)]));
    assert!(matches!(error, Error::Size { found: 1, needed: 2, .. }));
    let far = vec![ContactNode::free(-2.0, 0, 1), ContactNode::free(2.0, 0, 9)];
    let error = unbuilt("unknown of a contact node", with(far));
    assert!(matches!(error, Error::Index { index: 9, bound: 3, .. }));
    refused("coordinate of a contact node", &NOT_FINITE, |x| {
        with(vec![ContactNode::free(-2.0, 0, 1), ContactNode::free(x, 0, 1)]).build().map(drop)
    });
    refused("coordinate of a contact node", &[-2.0, -3.0], |x| {
        with(vec![ContactNode::free(-2.0, 0, 1), ContactNode::free(x, 0, 1)]).build().map(drop)
    });
    refused("weight of a contact node", &NOT_FINITE, |x| {
        let mut nodes = ContactNode::rigid_base(-2.0, 2.0, [0, 1, 2]);
        nodes[0].vertical = (1, x).into();
        with(nodes).build().map(drop)
    });
    let none = Spoilt { unknowns: 0, nodes: empty_base(), ..Spoilt::sound() };
    assert!(matches!(
        Simulation::builder(1e-3).structure(none).ground(bed(4)).interface(Bonded).build(),
        Err(Error::Size { found: 0, .. } | Error::Index { .. })
    ));
    // The base moves with one unknown only: nothing turns it, nothing moves it sideways.
    let floating = unbuilt("singular", with(empty_base()));
    assert!(matches!(floating, Error::Singular { order: 3, .. }));
}

fn empty_base() -> Vec<ContactNode> {
    [-2.0, 2.0]
        .map(|x| ContactNode { x, horizontal: Row::default(), vertical: Row::default() })
        .into()
}

#[test]
fn a_structure_that_slides_away_under_its_static_load_is_refused() {
    let pushed = || Spoilt { push: 1e4, ..Spoilt::sound() };
    let law = Coulomb::new(0.3).unwrap();
    // Set down without friction, nothing holds it; with friction of 0.3 its weight does.
    let error = unbuilt("no static equilibrium", pushed().scene().interface(law));
    assert!(matches!(error, Error::Preload { iterations: 1.., .. }), "{error:?}");
    let placed = pushed().scene().interface(law).placement(Placement::WithInterfaceLaw);
    let shear = placed.build().unwrap().state().base_shear;
    assert!((shear - 1e4).abs() < 1e-4, "{shear}");
}

/// The step that fails, with the state before and after the attempt.
fn failing_step(mut simulation: Simulation) -> (Error, usize, Simulation) {
    for accepted in 0..1000 {
        let before = simulation.state().clone();
        if let Err(error) = simulation.step() {
            assert_eq!(*simulation.state(), before, "a failed step changes nothing");
            assert_eq!(before.step, accepted);
            return (error, accepted, simulation);
        }
    }
    panic!("no step failed");
}

fn assert_not_finite(error: &Error, accepted: usize, part: &str) {
    let Error::Step { step, time, source: StepError::NotFinite { quantity } } = error else {
        panic!("{error:?}");
    };
    assert_eq!(*step, accepted + 1);
    assert!((time - *step as f64 * 1e-3).abs() < 1e-12);
    let message = error.to_string();
    assert!(quantity.contains(part), "{quantity}");
    assert!(message.contains(&format!("step {step} (t = ")) && message.contains("not finite"));
}

#[test]
fn a_free_field_that_breaks_leaves_the_last_accepted_step() {
    let broken = FreeFieldFn::new(|_, t| [if t > 0.0105 { f64::NAN } else { t * t }, 0.0]);
    let law = Coulomb::new(0.3).unwrap();
    let simulation = good().interface(law).motion(broken).gravity(9.81).build().unwrap();
    let (error, accepted, mut simulation) = failing_step(simulation);
    assert_eq!(accepted, 10);
    assert_not_finite(&error, accepted, "free field");
    // Again, and through `run`: the same error, the same state.
    let seen = simulation.state().clone();
    assert_eq!(simulation.run(5, |_| {}).unwrap_err(), error);
    assert_eq!(*simulation.state(), seen);
    assert!(seen.displacement().iter().all(|u| u.is_finite()));
}

#[test]
fn a_load_that_breaks_leaves_the_last_accepted_step() {
    for tangent in [None, Some((0, 0, 0.0))] {
        let structure = Spoilt { load_from: 0.0101, tangent, ..Spoilt::sound() };
        let (error, accepted, _) = failing_step(structure.scene().build().unwrap());
        assert_not_finite(&error, accepted, "displacement");
        assert_eq!(accepted, 10);
    }
}

/// A law that is never content.
struct Fickle;

impl InterfaceLaw for Fickle {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &StepStart) -> [Condition; 2] {
        Coulomb::uplift_only().conditions(mode, start)
    }

    fn next_mode(&self, mode: Mode, _: &StepStart, _: &ContactState, _: Tolerance) -> Mode {
        if mode == Mode::Stick { Mode::Open } else { Mode::Stick }
    }
}

#[test]
fn modes_that_are_not_found_are_an_error_with_residual_and_modes() {
    let (error, accepted, _) = failing_step(good().interface(Fickle).build().unwrap());
    assert_eq!(accepted, 0);
    let Error::Step { step: 1, source: StepError::Contact { iterations, residual, modes }, .. } =
        &error
    else {
        panic!("{error:?}");
    };
    assert!(*iterations > 0 && !residual.is_nan());
    assert_eq!(modes.len(), 4);
    let message = error.to_string();
    assert!(
        message.contains("residual") && message.contains("modes [") && message.contains("0.001")
    );
}

#[test]
fn errors_are_ordinary_errors() {
    fn is_error<T: std::error::Error + Send + Sync + Clone + Debug + 'static>() {}
    is_error::<Error>();
    is_error::<StepError>();
    let (error, ..) = failing_step(good().interface(Fickle).build().unwrap());
    assert!(std::error::Error::source(&error).is_some());
}

/// A structure that claims more unknowns than any machine holds.
struct Endless;

impl Structure for Endless {
    fn unknowns(&self) -> usize {
        usize::MAX
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        ContactNode::rigid_base(-2.0, 2.0, [0, 1, 2])
    }

    fn mass(&self, matrix: &mut Triplets) {
        matrix.add(0, 0, 1.0);
    }

    fn stiffness(&self, _matrix: &mut Triplets) {}
}

#[test]
fn structures_without_end_are_refused() {
    let scene =
        Simulation::builder(1e-3).structure(Endless).ground(scene::bed(4)).interface(Bonded);
    match scene.build().err() {
        Some(Error::Input { quantity, .. }) => {
            assert_eq!(quantity, "number of unknowns of the structure");
        }
        other => panic!("{other:?}"),
    }
}
