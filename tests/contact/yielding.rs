//! GOAL: soil yields under its bearing pressure, and bonds break once.
//! SCENE: random contact problems; a block on springs under a moment, constant or cyclic; blocks that rock under El Centro.
//! REFERENCE: all modes tried one by one; closed form of springs that uplift and yield (Allotey & El Naggar 2003); the area
//! of the loop; Coulomb's law.

use std::collections::BTreeSet;

use basemat::bem::{ElasticGround, SpringGround};
use basemat::contact::ContactProblem;
use basemat::coupled::{Load, Probe, SimulationBuilder};
use basemat::interface::{
    Bonded, Cohesive, ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact, Yielding,
};
use basemat::motion::el_centro_1940;
use basemat::structure::{DofCombination, RigidBlock};
use basemat::{Simulation, Soil};

use basemat_problems::enumerated_contact::{ContactRanges, ELEMENT_COUNT, EnumeratedContact};
use basemat_problems::random::Random;

fn random_problem(random: &mut Random) -> EnumeratedContact {
    let ranges = ContactRanges {
        free_jump: [-3.0, 2.0],
        static_pressure: [0.0, 1.0],
        recession: [0.0, 0.5],
    };
    EnumeratedContact::random(random, ranges, |random| {
        vec![[0.0, random.within(0.8, 2.0)]; ELEMENT_COUNT]
    })
}

#[test]
fn the_search_finds_a_solution_of_brute_force() {
    const YIELDING_MODES: [Mode; 7] = [
        Mode::Stick,
        Mode::SlipLeft,
        Mode::SlipRight,
        Mode::Open,
        Mode::Yield,
        Mode::YieldLeft,
        Mode::YieldRight,
    ];
    let mut random = Random(7);
    let mut found_modes = BTreeSet::new();
    let mut problems_with_others = 0;
    for problem in (0..300).map(|_| random_problem(&mut random)) {
        let bearing_pressure = problem.bounds[0][1];
        let law = Yielding::new(bearing_pressure, problem.friction).unwrap();
        let laws = [law; ELEMENT_COUNT].map(|law| -> Box<dyn InterfaceLaw> { Box::new(law) });
        let (modes, has_others) =
            problem.assert_search_solves(laws, [&YIELDING_MODES; ELEMENT_COUNT]);
        found_modes.extend(modes);
        problems_with_others += usize::from(has_others);
    }
    assert_eq!(found_modes.len(), 7, "{found_modes:?}");
    println!("several solutions in {problems_with_others} of 300");
}

const BASE_HALF_WIDTH: f64 = 2.0;
/// Stiffness of the springs, Pa/m.
const BEDDING_MODULUS: f64 = 4.0e7;
const BEARING_PRESSURE: f64 = 2.5e5;

fn on_springs(elements: usize, law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let range = -BASE_HALF_WIDTH..BASE_HALF_WIDTH;
    let springs = SpringGround::new(range, elements, BEDDING_MODULUS, BEDDING_MODULUS).unwrap();
    Simulation::builder(0.01)
        .structure(RigidBlock::new(2.0 * BASE_HALF_WIDTH, 5.0, 2000.0).unwrap())
        .ground(springs)
        .interface(law)
}

/// Moment at which a base on springs that uplift and yield has turned by `rotation`.
///
/// The pressure is q over a from the edge, then falls to zero over c = q/(kθ), and N = q (a + c/2).
fn moment_at(rotation: f64, weight: f64) -> f64 {
    let c = BEARING_PRESSURE / (BEDDING_MODULUS * rotation);
    let a = weight / BEARING_PRESSURE - 0.5 * c;
    assert!(a > 0.0 && a + c < 2.0 * BASE_HALF_WIDTH, "another stage: {a} {c}");
    let half = BASE_HALF_WIDTH;
    BEARING_PRESSURE * (a * (half - 0.5 * a) + 0.5 * c * (half - a - c / 3.0))
}

#[test]
fn springs_that_uplift_and_yield_turn_as_in_closed_form() {
    let law = Yielding::new(BEARING_PRESSURE, 0.6).unwrap();
    let weight = on_springs(4, law).build().unwrap().state().normal_force;
    for (rotation, tolerances) in [(5.0e-3, [5e-3, 1e-3]), (1.0e-2, [4e-2, 5e-3])] {
        for (elements, tolerance) in [40, 160].into_iter().zip(tolerances) {
            let moment = Load::constant(DofCombination::from(2), moment_at(rotation, weight));
            let simulation = on_springs(elements, law).load(moment).build().unwrap();
            let computed = simulation.static_displacement()[2];
            let error = computed / rotation - 1.0;
            println!("{elements}: {error}");
            assert!(error.abs() < tolerance, "{elements}: {computed} {rotation}");
        }
    }
}

/// Slow cycles of a moment, whose amplitude grows.
fn cyclic_moment(time: f64) -> f64 {
    let amplitude = 4.5e5;
    amplitude * (1.0 + 0.3 * time / 16.0) / 1.3 * (std::f64::consts::TAU * time / 8.0).sin()
}

/// Depths by which the soil below each element has yielded, m.
fn yielded_depths(simulation: &Simulation) -> Vec<f64> {
    let count = simulation.ground().elements().len();
    (0..count).map(|e| simulation.state().state_variables(e)[0]).collect()
}

/// Under slow cycles of a moment the soil dissipates the area of the loops.
#[test]
fn indentation_dissipates_the_area_of_the_loop() {
    let mut simulation = on_springs(40, Yielding::new(BEARING_PRESSURE, 0.6).unwrap())
        .load(Load::new(DofCombination::from(2), cyclic_moment))
        .probe(Probe::displacement("rotation", DofCombination::from(2)))
        .build()
        .unwrap();
    let mut area = 0.0;
    let mut previous_rotation = 0.0;
    let run = simulation
        .run(1600, |state| {
            let rotation = state.probes[0];
            area += cyclic_moment(state.time - 0.005) * (rotation - previous_rotation);
            previous_rotation = rotation;
        })
        .unwrap();
    let energy_balance = simulation.state().energy_balance;
    let stored = energy_balance.soil + energy_balance.static_contact + energy_balance.kinetic;
    println!("area {area}, contact {}, stored {stored}", energy_balance.contact);
    assert!(run.energy_error < 1e-9);
    assert!((energy_balance.contact + stored - area).abs() < 1e-6 * area, "{energy_balance}");
    // The pressure q times the indentation is most of the dissipation.
    let indentation_work: f64 = yielded_depths(&simulation)
        .iter()
        .map(|depth| depth * BEARING_PRESSURE * 2.0 * BASE_HALF_WIDTH / 40.0)
        .sum();
    assert!(energy_balance.contact > 0.5 * area, "{energy_balance}");
    let ratio = energy_balance.contact / indentation_work;
    assert!((ratio - 1.0).abs() < 0.2, "{indentation_work}");
}

/// Builds a slender block on the half-plane under El Centro times a factor.
fn slender_block(elements: usize, factor: f64, law: impl InterfaceLaw + 'static) -> Simulation {
    let soil = Soil::new(40.0e6, 0.3, 1900.0).unwrap();
    let block = RigidBlock::new(4.0, 8.0, 2000.0).unwrap();
    Simulation::builder(0.005)
        .ground(ElasticGround::under(soil, &block, elements).unwrap())
        .structure(block)
        .interface(law)
        .motion(el_centro_1940().scaled(factor).unwrap())
        .build()
        .unwrap()
}

/// A rocking block settles and rounds the ground, whose largest indentation is at the edges.
#[test]
fn rocking_indents_the_ground_most_at_the_edges() {
    let mut simulation = slender_block(12, 1.3, Yielding::new(6.0e5, 0.6).unwrap());
    let static_depths = yielded_depths(&simulation);
    assert!(static_depths.iter().all(|depth| *depth < 1e-3), "{static_depths:?}");
    let run = simulation.run(9000, |_| {}).unwrap();
    let depths = yielded_depths(&simulation);
    println!("{depths:?} {run}");
    assert!(run.energy_error < 1e-9);
    assert!(depths[0] > 5e-3 && depths[11] > 5e-3, "{depths:?}");
    assert!(depths[0] > 2.0 * depths[6], "{depths:?}");
    let mean = depths.iter().sum::<f64>() / 12.0;
    let settlement = -simulation.state().displacement()[1];
    assert!(settlement > 0.3 * mean && settlement < mean, "{settlement} {mean}");
}

/// Contact after five seconds of El Centro with this law.
fn contact_after_shaking(law: impl InterfaceLaw + 'static) -> Vec<ContactState> {
    let mut simulation = slender_block(8, 1.0, law);
    simulation.run(1000, |_| {}).unwrap();
    simulation.state().contact.clone()
}

#[test]
fn limits_of_yielding_and_cohesion_are_coulomb_and_bonded() {
    let coulomb = contact_after_shaking(Coulomb::new(0.3).unwrap());
    assert_eq!(contact_after_shaking(Yielding::new(1e12, 0.3).unwrap()), coulomb);
    assert_eq!(contact_after_shaking(Cohesive::new(0.0, 0.0, 0.3).unwrap()), coulomb);
    let strong_bond = contact_after_shaking(Cohesive::new(1e12, 1e12, 0.3).unwrap());
    let bonded = contact_after_shaking(Bonded);
    for (a, b) in strong_bond.iter().zip(&bonded) {
        assert!(a.gap.abs().max(a.slip.abs()).max(b.gap.abs()) < 1e-12, "{a:?} {b:?}");
    }
}

/// A bond carries tractions up to its strength, and does not heal.
#[test]
fn bonds_break_once() {
    let law = Cohesive::new(3.0, 2.0, 0.5).unwrap();
    let mut problem = ContactProblem::new(vec![1.0, 0.0, 0.0, 1.0], vec![Box::new(law)]).unwrap();
    let element = PreviousContact::new(ContactState::default(), Mode::Stick, 0.1);
    let mut start = problem.start(&[element]).unwrap();
    // Jumps without tractions, down and to the right; mode, pressure and shear.
    for (jump, mode, pressure, shear) in [
        ([2.9, 0.0], Mode::Stick, -2.9, 0.0),
        ([-1.0, -2.4], Mode::Stick, 1.0, 2.4),
        ([3.1, 0.0], Mode::Open, 0.0, 0.0),
        ([0.5, 0.0], Mode::Open, 0.0, 0.0),
        ([-1.0, -0.4], Mode::Stick, 1.0, 0.4),
        ([-1.0, -0.6], Mode::SlipRight, 1.0, 0.5),
    ] {
        let solution = problem.solve(&jump, &start).unwrap();
        assert_eq!(solution.modes, [mode], "{jump:?}");
        let state = solution.states[0];
        assert!((state.pressure - pressure).abs() < 1e-12 && (state.shear - shear).abs() < 1e-12);
        solution.commit(&mut start).unwrap();
    }
}

#[test]
fn impossible_strengths_are_errors() {
    for (tension, cohesion, friction) in
        [(-1.0, 0.0, 0.1), (0.0, f64::NAN, 0.1), (0.0, f64::INFINITY, 0.1), (0.0, 0.0, -0.1)]
    {
        assert!(Cohesive::new(tension, cohesion, friction).is_err());
    }
    for (bearing, friction) in [(0.0, 0.1), (f64::INFINITY, 0.1), (1.0, f64::NAN)] {
        assert!(Yielding::new(bearing, friction).is_err());
    }
}

/// Static rotation of a pushed block on yielding soil with another law for the fourth element.
fn rotation_with_law(fourth: impl InterfaceLaw + 'static) -> f64 {
    let yielding_soil = Yielding::new(1.5e5, 0.6).unwrap();
    let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
    for _ in 0..8 {
        laws.push(Box::new(yielding_soil));
    }
    laws[3] = Box::new(fourth);
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
        let depth = state.state_variables(e)[0];
        let is_closed = state.modes[e].is_closed();
        assert!(!is_closed || (contact.gap + depth).abs() < 1e-9, "{e}: {contact:?} {depth}");
    }
    assert!(state.state_variables(0)[0] > 1e-6, "the edge has yielded");
    simulation.static_displacement()[2]
}

/// A bond beside yielding soil: each element has the state variables of its law.
#[test]
fn laws_side_by_side_have_separate_state_variables() {
    // An element in the middle neither yields nor opens: its law has no effect.
    let with_bond = rotation_with_law(Cohesive::new(0.0, 0.0, 0.6).unwrap());
    let with_yielding = rotation_with_law(Yielding::new(1.5e5, 0.6).unwrap());
    assert!((with_bond / with_yielding - 1.0).abs() < 1e-6, "{with_bond} {with_yielding}");
}
