//! GOAL: soil that yields under its bearing pressure, and glue that breaks once.
//! SCENE: random contact problems; a block on a bed of springs under a moment, slow or cyclic; blocks
//! that rock under El Centro.
//! REFERENCE: all modes tried one by one; closed form of a bed that uplifts and yields (Allotey & El
//! Naggar 2003); the area of the loop; Coulomb's law.

use basemat::bem::{ElasticGround, SpringGround};
use basemat::contact::ContactProblem;
use basemat::coupled::{Load, Probe, SimulationBuilder};
use basemat::interface::{
    Cohesive, ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact, Yielding,
};
use basemat::motion::el_centro_1940;
use basemat::structure::{DofCombination, RigidBlock};
use basemat::{Simulation, Soil};

use basemat_problems::enumerated_contact::{COUNT, EnumeratedContact, Ranges};
use basemat_problems::random::Random;

fn random_problem(random: &mut Random) -> EnumeratedContact {
    let ranges = Ranges { free_jump: [-3.0, 2.0], pressed: [0.0, 1.0], moved: [0.0, 0.5] };
    EnumeratedContact::random(random, ranges, |random| vec![[0.0, random.within(0.8, 2.0)]; COUNT])
}

#[test]
fn the_search_finds_a_solution_of_brute_force() {
    const MODES: [Mode; 7] = [
        Mode::Stick,
        Mode::SlipLeft,
        Mode::SlipRight,
        Mode::Open,
        Mode::Yield,
        Mode::YieldLeft,
        Mode::YieldRight,
    ];
    let mut random = Random(7);
    let (mut seen, mut several) = (std::collections::BTreeSet::new(), 0);
    for problem in (0..300).map(|_| random_problem(&mut random)) {
        let [_, bearing] = problem.bounds[0];
        let law = Yielding::new(bearing, problem.friction).unwrap();
        let laws = [law; COUNT].map(|law| -> Box<dyn InterfaceLaw> { Box::new(law) });
        let (modes, has_others) = problem.assert_found(laws, [&MODES; COUNT]);
        seen.extend(modes);
        several += usize::from(has_others);
    }
    assert_eq!(seen.len(), 7, "{seen:?}");
    println!("several solutions in {several} of 300");
}

/// Half width of the base (m), stiffness of the bed (Pa/m), and what it bears (Pa).
const HALF: f64 = 2.0;
const BED: f64 = 4.0e7;
const BEARING: f64 = 2.5e5;

fn on_bed(elements: usize, law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    Simulation::builder(0.01)
        .structure(RigidBlock::new(2.0 * HALF, 5.0, 2000.0).unwrap())
        .ground(SpringGround::new(-HALF..HALF, elements, BED, BED).unwrap())
        .interface(law)
}

/// Moment at which a bed that uplifts and yields has turned by `rotation`: the pressure is q over a
/// from the edge, then falls to zero over c = q/(kθ), and N = q (a + c/2).
fn moment(rotation: f64, weight: f64) -> f64 {
    let c = BEARING / (BED * rotation);
    let a = weight / BEARING - 0.5 * c;
    assert!(a > 0.0 && a + c < 2.0 * HALF, "another stage: {a} {c}");
    BEARING * (a * (HALF - 0.5 * a) + 0.5 * c * (HALF - a - c / 3.0))
}

#[test]
fn a_bed_that_uplifts_and_yields_turns_as_in_closed_form() {
    let law = Yielding::new(BEARING, 0.6).unwrap();
    let weight = on_bed(4, law).build().unwrap().state().normal_force;
    for (rotation, limits) in [(5.0e-3, [5e-3, 1e-3]), (1.0e-2, [4e-2, 5e-3])] {
        for (elements, limit) in [40, 160].into_iter().zip(limits) {
            let moment = Load::constant(DofCombination::from(2), moment(rotation, weight));
            let simulation = on_bed(elements, law).load(moment).build().unwrap();
            let found = simulation.static_displacement()[2];
            println!("{elements}: {}", found / rotation - 1.0);
            assert!((found / rotation - 1.0).abs() < limit, "{elements}: {found} {rotation}");
        }
    }
}

/// Slow cycles of a moment: what the soil has taken is the area of the loops.
#[test]
fn indentation_takes_the_area_of_the_loop() {
    let amplitude = 4.5e5;
    let turn = Load::new(DofCombination::from(2), move |t| {
        amplitude * (1.0 + 0.3 * t / 16.0) / 1.3 * (std::f64::consts::TAU * t / 8.0).sin()
    });
    let moment = move |t: f64| {
        amplitude * (1.0 + 0.3 * t / 16.0) / 1.3 * (std::f64::consts::TAU * t / 8.0).sin()
    };
    let mut simulation = on_bed(40, Yielding::new(BEARING, 0.6).unwrap())
        .load(turn)
        .probe(Probe::displacement("rotation", DofCombination::from(2)))
        .build()
        .unwrap();
    let (mut area, mut before) = (0.0, 0.0);
    let run = simulation
        .run(1600, |state| {
            let now = state.probes[0];
            area += moment(state.time - 0.005) * (now - before);
            before = now;
        })
        .unwrap();
    let energy_balance = simulation.state().energy_balance;
    let stored = energy_balance.soil + energy_balance.static_contact + energy_balance.kinetic;
    println!("area {area}, contact {}, stored {stored}", energy_balance.contact);
    assert!(run.energy_error < 1e-9);
    assert!((energy_balance.contact + stored - area).abs() < 1e-6 * area, "{energy_balance}");
    // Most of it is q times the indentation.
    let sunk: f64 = (0..40)
        .map(|e| simulation.state().state_variables(e)[0] * BEARING * 2.0 * HALF / 40.0)
        .sum();
    assert!(
        energy_balance.contact > 0.5 * area && (energy_balance.contact / sunk - 1.0).abs() < 0.2,
        "{sunk}"
    );
}

/// A rocking block settles, and the ground under it is rounded: sunk most at its edges.
#[test]
fn rocking_rounds_the_ground() {
    let soil = Soil::new(40.0e6, 0.3, 1900.0).unwrap();
    let block = RigidBlock::new(4.0, 8.0, 2000.0).unwrap();
    let mut simulation = Simulation::builder(0.005)
        .ground(ElasticGround::under(soil, &block, 12).unwrap())
        .structure(block)
        .interface(Yielding::new(6.0e5, 0.6).unwrap())
        .motion(el_centro_1940().scaled(1.3).unwrap())
        .build()
        .unwrap();
    let settled: Vec<f64> = (0..12).map(|e| simulation.state().state_variables(e)[0]).collect();
    assert!(settled.iter().all(|w| *w < 1e-3), "{settled:?}");
    let run = simulation.run(9000, |_| {}).unwrap();
    let sunk: Vec<f64> = (0..12).map(|e| simulation.state().state_variables(e)[0]).collect();
    println!("{sunk:?} {run}");
    assert!(run.energy_error < 1e-9);
    assert!(sunk[0] > 5e-3 && sunk[11] > 5e-3 && sunk[0] > 2.0 * sunk[6], "{sunk:?}");
    let mean = sunk.iter().sum::<f64>() / 12.0;
    let settlement = -simulation.state().displacement()[1];
    assert!(settlement > 0.3 * mean && settlement < mean, "{settlement} {mean}");
}

#[test]
fn soil_that_never_yields_and_glue_without_strength_are_coulomb_s() {
    let run = |law: Box<dyn InterfaceLaw>| {
        let soil = Soil::new(40.0e6, 0.3, 1900.0).unwrap();
        let block = RigidBlock::new(4.0, 8.0, 2000.0).unwrap();
        let mut simulation = Simulation::builder(0.005)
            .ground(ElasticGround::under(soil, &block, 8).unwrap())
            .structure(block)
            .interface(law)
            .motion(el_centro_1940())
            .build()
            .unwrap();
        simulation.run(1000, |_| {}).unwrap();
        simulation.state().contact.clone()
    };
    let wanted = run(Box::new(Coulomb::new(0.3).unwrap()));
    assert_eq!(run(Box::new(Yielding::new(1e12, 0.3).unwrap())), wanted);
    assert_eq!(run(Box::new(Cohesive::new(0.0, 0.0, 0.3).unwrap())), wanted);
    // Strong glue never breaks.
    let strong = run(Box::new(Cohesive::new(1e12, 1e12, 0.3).unwrap()));
    let bonded = run(Box::new(basemat::interface::Bonded));
    for (a, b) in strong.iter().zip(&bonded) {
        assert!(a.gap.abs().max(a.slip.abs()).max(b.gap.abs()) < 1e-12, "{a:?} {b:?}");
    }
}

/// A pull on one element: it holds up to its strength, and does not heal.
#[test]
fn glue_breaks_once() {
    let law = Cohesive::new(3.0, 2.0, 0.5).unwrap();
    let mut problem = ContactProblem::new(vec![1.0, 0.0, 0.0, 1.0], vec![Box::new(law)]).unwrap();
    let mut start =
        problem.start(&[PreviousContact::new(ContactState::default(), Mode::Stick, 0.1)]).unwrap();
    // (jump down, jump to the right without tractions), mode, pressure, shear.
    for (jump, mode, pressure, shear) in [
        ([2.9, 0.0], Mode::Stick, -2.9, 0.0),
        ([-1.0, -2.4], Mode::Stick, 1.0, 2.4),
        ([3.1, 0.0], Mode::Open, 0.0, 0.0),
        ([0.5, 0.0], Mode::Open, 0.0, 0.0),
        ([-1.0, -0.4], Mode::Stick, 1.0, 0.4),
        ([-1.0, -0.6], Mode::SlipRight, 1.0, 0.5),
    ] {
        let found = problem.solve(&jump, &start).unwrap();
        assert_eq!(found.modes, [mode], "{jump:?}");
        let state = found.states[0];
        assert!((state.pressure - pressure).abs() < 1e-12 && (state.shear - shear).abs() < 1e-12);
        found.commit(&mut start).unwrap();
    }
    for (tension, cohesion, friction) in
        [(-1.0, 0.0, 0.1), (0.0, f64::NAN, 0.1), (0.0, f64::INFINITY, 0.1), (0.0, 0.0, -0.1)]
    {
        assert!(Cohesive::new(tension, cohesion, friction).is_err());
    }
    for (bearing, friction) in [(0.0, 0.1), (f64::INFINITY, 0.1), (1.0, f64::NAN)] {
        assert!(Yielding::new(bearing, friction).is_err());
    }
}

/// Glue beside yielding soil: each element keeps what its own law remembers of the weight.
#[test]
fn laws_side_by_side_remember_each_their_own() {
    let run = |fourth: Box<dyn InterfaceLaw>| {
        let yielding = || -> Box<dyn InterfaceLaw> { Box::new(Yielding::new(1.5e5, 0.6).unwrap()) };
        let mut laws: Vec<Box<dyn InterfaceLaw>> = (0..8).map(|_| yielding()).collect();
        laws[3] = fourth;
        let soil = Soil::new(20.0e6, 0.3, 1900.0).unwrap();
        let block = RigidBlock::new(4.0, 5.0, 2000.0).unwrap();
        let push = Load::constant(block.horizontal_at(5.0), 2.0e4);
        let simulation = Simulation::builder(0.005)
            .ground(ElasticGround::under(soil, &block, 8).unwrap())
            .structure(block)
            .interfaces(laws)
            .load(push)
            .build()
            .unwrap();
        let state = simulation.state();
        for (e, contact) in state.contact.iter().enumerate().filter(|(e, _)| *e != 3) {
            let sunk = state.state_variables(e)[0];
            let closed = state.modes[e].is_closed();
            assert!(!closed || (contact.gap + sunk).abs() < 1e-9, "{e}: {contact:?} {sunk}");
        }
        assert!(state.state_variables(0)[0] > 1e-6, "the edge has yielded");
        simulation.static_displacement()[2]
    };
    // An element in the middle neither yields nor opens: its law does not matter.
    let [glued, yields] = [
        run(Box::new(Cohesive::new(0.0, 0.0, 0.6).unwrap())),
        run(Box::new(Yielding::new(1.5e5, 0.6).unwrap())),
    ];
    assert!((glued / yields - 1.0).abs() < 1e-6, "{glued} {yields}");
}
