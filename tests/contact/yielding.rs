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

use basemat_problems::dense::solve;
use basemat_problems::random::Random;

/// A contact problem of three elements in units of its own, and its law's parameters.
struct Problem {
    delassus: Vec<f64>,
    free_jump: Vec<f64>,
    pressed: Vec<f64>,
    indentation: Vec<f64>,
    slip: Vec<f64>,
    bearing: f64,
    friction: f64,
}

const COUNT: usize = 3;
const SIZE: usize = 2 * COUNT;

impl Problem {
    fn random(random: &mut Random) -> Self {
        let mut numbers = |low: f64, high: f64, count: usize| -> Vec<f64> {
            (0..count).map(|_| random.within(low, high)).collect()
        };
        let root = numbers(-1.0, 1.0, SIZE * SIZE);
        let delassus = (0..SIZE * SIZE)
            .map(|k| {
                let (i, j) = (k / SIZE, k % SIZE);
                let product: f64 = (0..SIZE).map(|m| root[i * SIZE + m] * root[j * SIZE + m]).sum();
                product + if i == j { 0.2 } else { 0.0 }
            })
            .collect();
        let free_jump = numbers(-3.0, 2.0, SIZE);
        let pressed = numbers(0.0, 1.0, COUNT);
        let indentation = numbers(0.0, 0.5, COUNT);
        let slip = numbers(-0.3, 0.3, COUNT);
        let bearing = random.within(0.8, 2.0);
        let friction = random.pick(&[0.0, 0.2, 0.5, f64::INFINITY]);
        Self { delassus, free_jump, pressed, indentation, slip, bearing, friction }
    }

    /// Conditions of the modes as rows over (gap, slip, pressure, shear) and a right-hand side.
    fn rows(&self, e: usize, mode: Mode) -> Option<[([f64; 4], f64); 2]> {
        let gap = ([1.0, 0.0, 0.0, 0.0], -self.indentation[e]);
        let bears = ([0.0, 0.0, 1.0, 0.0], self.bearing);
        let stick = ([0.0, 1.0, 0.0, 0.0], self.slip[e]);
        let slides = |sign: f64| ([0.0, 0.0, -self.friction, sign], 0.0);
        let endless = self.friction.is_infinite();
        Some(match mode {
            Mode::Open => [([0.0, 0.0, 1.0, 0.0], 0.0), ([0.0, 0.0, 0.0, 1.0], 0.0)],
            Mode::Stick => [gap, stick],
            Mode::Yield => [bears, stick],
            // Infinite friction slides without pressure alone.
            Mode::SlipLeft | Mode::SlipRight if endless => [gap, ([0.0, 0.0, 1.0, 0.0], 0.0)],
            _ if endless => return None,
            Mode::SlipRight => [gap, slides(1.0)],
            Mode::SlipLeft => [gap, slides(-1.0)],
            Mode::YieldRight => [bears, slides(1.0)],
            Mode::YieldLeft => [bears, slides(-1.0)],
            other => panic!("{other:?}"),
        })
    }

    /// Total tractions and jumps of a choice of modes.
    fn solve(&self, modes: &[Mode]) -> Option<Vec<ContactState>> {
        let mut matrix = vec![vec![0.0; SIZE]; SIZE];
        let mut rhs = vec![0.0; SIZE];
        for (e, &mode) in modes.iter().enumerate() {
            for (k, ([g, s, p, t], value)) in self.rows(e, mode)?.into_iter().enumerate() {
                // gap = j_n + W τ, slip = −(j_t + W τ), p = p₀ + τ_n, shear = τ_t.
                let row = 2 * e + k;
                rhs[row] = value - g * self.free_jump[e] + s * self.free_jump[COUNT + e]
                    - p * self.pressed[e];
                for j in 0..SIZE {
                    matrix[row][j] +=
                        g * self.delassus[e * SIZE + j] - s * self.delassus[(COUNT + e) * SIZE + j];
                }
                matrix[row][e] += p;
                matrix[row][COUNT + e] += t;
            }
        }
        let traction = solve(&matrix, &rhs);
        traction.iter().all(|t| t.is_finite()).then(|| self.states(&traction))
    }

    fn states(&self, traction: &[f64]) -> Vec<ContactState> {
        let jump = |i: usize| -> f64 {
            let row = &self.delassus[i * SIZE..(i + 1) * SIZE];
            self.free_jump[i] + row.iter().zip(traction).map(|(w, t)| w * t).sum::<f64>()
        };
        (0..COUNT)
            .map(|e| ContactState {
                gap: jump(e),
                slip: -jump(COUNT + e),
                pressure: self.pressed[e] + traction[e],
                shear: traction[COUNT + e],
                ..ContactState::default()
            })
            .collect()
    }

    /// By how much the states miss the law, written down as complementarity conditions.
    fn violation(&self, states: &[ContactState]) -> f64 {
        states.iter().enumerate().fold(0.0_f64, |worst, (e, state)| {
            let (p, q) = (state.pressure, self.bearing);
            let g = state.gap + self.indentation[e];
            // p in [0, q], g ≥ 0 below q, g ≤ 0 above 0.
            let normal = (-p).max(p - q).max(g.max(0.0).min(p)).max((-g).max(0.0).min(q - p));
            // Infinite friction has its limit as p → 0, too: any shear.
            let endless = self.friction.is_infinite();
            let limit = if endless { f64::INFINITY } else { self.friction * p };
            let advance = state.slip - self.slip[e];
            let cone = state.shear.abs() - limit;
            let room = if limit.is_infinite() { p.abs() } else { (-cone).max(0.0) };
            let sticks = advance.abs().min(room);
            let against = if self.friction > 0.0 {
                (-advance * state.shear.signum()).max(0.0).min(state.shear.abs())
            } else {
                0.0
            };
            let touches = if g > 1e-9 { 0.0 } else { sticks.max(against) };
            worst.max(normal).max(cone).max(touches)
        })
    }
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
    for problem in (0..300).map(|_| Problem::random(&mut random)) {
        let mut solutions: Vec<Vec<ContactState>> = Vec::new();
        for code in 0..7 * 7 * 7 {
            let modes: Vec<Mode> = (0..COUNT).map(|e| MODES[code / [1, 7, 49][e] % 7]).collect();
            let Some(states) = problem.solve(&modes) else { continue };
            if problem.violation(&states) < 1e-9 {
                solutions.push(states);
            }
        }
        assert!(!solutions.is_empty(), "brute force has none");
        let law = Yielding::new(problem.bearing, problem.friction).unwrap();
        let starts: Vec<_> = (0..COUNT)
            .map(|e| {
                let state = ContactState {
                    gap: -problem.indentation[e],
                    slip: problem.slip[e],
                    pressure: problem.pressed[e],
                    ..ContactState::default()
                };
                let mut start = PreviousContact::new(state, law.modes()[0], 1.0);
                start.state_variables = &problem.indentation[e..=e];
                start
            })
            .collect();
        let mut traction = problem.pressed.clone();
        traction.resize(SIZE, 0.0);
        let mut contact = ContactProblem::new(problem.delassus.clone(), vec![Box::new(law)])
            .unwrap()
            .with_static_tractions(traction)
            .unwrap();
        let start = contact.start(&starts).unwrap();
        let found = contact.solve(&problem.free_jump, &start).unwrap();
        seen.extend(found.modes.iter().copied());
        let near = |states: &Vec<ContactState>| {
            states.iter().zip(found.states).all(|(a, b)| {
                (a.pressure - b.pressure).abs() < 1e-8 && (a.shear - b.shear).abs() < 1e-8
            })
        };
        assert!(solutions.iter().any(near), "{:?} {:?}", found.modes, found.states);
        several += usize::from(!solutions.iter().all(near));
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
