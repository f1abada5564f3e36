//! GOAL: soil beside a wall yields at its passive pressure and follows the wall at its active one.
//! SCENE: random contact problems of walls; wedges of soil behind a vertical wall.
//! REFERENCE: all modes tried one by one; the wedge of the largest and of the smallest thrust; tables of coefficients.

use basemat::contact::ContactProblem;
use basemat::interface::{ContactState, EarthPressure, InterfaceLaw, Mode, PreviousContact};
use basemat::soil::SoilStrength;

use basemat_problems::dense::solve;
use basemat_problems::random::Random;

const COUNT: usize = 3;
const SIZE: usize = 2 * COUNT;

/// A contact problem of three elements in units of its own, and the parameters of their laws.
struct Problem {
    delassus: Vec<f64>,
    free_jump: Vec<f64>,
    pressed: Vec<f64>,
    movement: Vec<f64>,
    slip: Vec<f64>,
    bounds: Vec<[f64; 2]>,
    friction: f64,
}

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
        let free_jump = numbers(-3.0, 3.0, SIZE);
        let pressed = numbers(0.3, 1.0, COUNT);
        let movement = numbers(-0.5, 0.5, COUNT);
        let slip = numbers(-0.3, 0.3, COUNT);
        // Some elements stand without the wall, and so open.
        let bounds = (0..COUNT)
            .map(|_| {
                let active = if random.chance(0.2) { 0.0 } else { random.within(0.05, 0.3) };
                [active, random.within(1.0, 2.0)]
            })
            .collect();
        let friction = random.pick(&[0.0, 0.2, 0.5, f64::INFINITY]);
        Self { delassus, free_jump, pressed, movement, slip, bounds, friction }
    }

    fn law(&self, e: usize) -> EarthPressure {
        let [active, passive] = self.bounds[e];
        EarthPressure::new(active, passive, self.friction).unwrap()
    }

    /// Conditions of the modes as rows over (gap, slip, pressure, shear) and a right-hand side.
    fn rows(&self, e: usize, mode: Mode) -> Option<[([f64; 4], f64); 2]> {
        let [active, passive] = self.bounds[e];
        let gap = ([1.0, 0.0, 0.0, 0.0], -self.movement[e]);
        let presses = |pressure: f64| ([0.0, 0.0, 1.0, 0.0], pressure);
        let stick = ([0.0, 1.0, 0.0, 0.0], self.slip[e]);
        let slides = |sign: f64| ([0.0, 0.0, -self.friction, sign], 0.0);
        let is_sliding = mode.is_slip();
        if self.friction.is_infinite() && is_sliding {
            // Sliding has no pressure then.
            return (active == 0.0 && matches!(mode, Mode::SlipLeft | Mode::SlipRight))
                .then_some([gap, presses(0.0)]);
        }
        Some(match mode {
            Mode::Open => [presses(0.0), ([0.0, 0.0, 0.0, 1.0], 0.0)],
            Mode::Stick => [gap, stick],
            Mode::Yield => [presses(passive), stick],
            Mode::Active => [presses(active), stick],
            Mode::SlipRight => [gap, slides(1.0)],
            Mode::SlipLeft => [gap, slides(-1.0)],
            Mode::YieldRight => [presses(passive), slides(1.0)],
            Mode::YieldLeft => [presses(passive), slides(-1.0)],
            Mode::ActiveRight => [presses(active), slides(1.0)],
            Mode::ActiveLeft => [presses(active), slides(-1.0)],
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
            let (p, [active, passive]) = (state.pressure, self.bounds[e]);
            let g = state.gap + self.movement[e];
            // p from active to passive, g ≥ 0 below passive, g ≤ 0 above active.
            let bounds = (active - p).max(p - passive);
            let apart = g.max(0.0).min(p - active);
            let pressed = (-g).max(0.0).min(passive - p);
            // Infinite friction has its limit as p → 0, too: any shear.
            let endless = self.friction.is_infinite();
            let limit = if endless { f64::INFINITY } else { self.friction * p };
            let advance = state.slip - self.slip[e];
            let cone = state.shear.abs() - limit;
            let room = if endless { p.abs() } else { (-cone).max(0.0) };
            let sticks = advance.abs().min(room);
            let against = if self.friction > 0.0 {
                (-advance * state.shear.signum()).max(0.0).min(state.shear.abs())
            } else {
                0.0
            };
            let is_open = active == 0.0 && g > 1e-9;
            let touches = if is_open { 0.0 } else { sticks.max(against) };
            worst.max(bounds).max(apart).max(pressed).max(cone).max(touches)
        })
    }
}

#[test]
fn the_search_finds_a_solution_of_brute_force() {
    let mut random = Random(71);
    let (mut seen, mut several) = (std::collections::BTreeSet::new(), 0);
    for problem in (0..300).map(|_| Problem::random(&mut random)) {
        let laws: Vec<EarthPressure> = (0..COUNT).map(|e| problem.law(e)).collect();
        let mut solutions: Vec<Vec<ContactState>> = Vec::new();
        for one in laws[0].modes() {
            for two in laws[1].modes() {
                for three in laws[2].modes() {
                    let Some(states) = problem.solve(&[*one, *two, *three]) else { continue };
                    if problem.violation(&states) < 1e-9 {
                        solutions.push(states);
                    }
                }
            }
        }
        assert!(!solutions.is_empty(), "brute force has none");
        let starts: Vec<_> = (0..COUNT)
            .map(|e| {
                let state = ContactState {
                    gap: -problem.movement[e],
                    slip: problem.slip[e],
                    pressure: problem.pressed[e],
                    ..ContactState::default()
                };
                let mut start = PreviousContact::new(state, laws[e].modes()[0], 1.0);
                start.state_variables = &problem.movement[e..=e];
                start
            })
            .collect();
        let mut traction = problem.pressed.clone();
        traction.resize(SIZE, 0.0);
        let boxed = |law: &EarthPressure| -> Box<dyn InterfaceLaw> { Box::new(*law) };
        let list = laws.iter().map(boxed).collect();
        let mut contact = ContactProblem::new(problem.delassus.clone(), list)
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
    assert_eq!(seen.len(), 10, "{seen:?}");
    println!("several solutions in {several} of 300");
}

/// Thrust of the wedge with a surface at `angle` over that of a fluid of the soil's weight, and its component across the
/// wall.
fn wedge(angle: f64, friction: f64, wall_friction: f64) -> f64 {
    let weight = 1.0 / angle.tan();
    weight * (angle - friction).sin() / (angle - friction - wall_friction).cos()
}

#[test]
fn pressure_ratios_are_those_of_the_extreme_wedges() {
    for (friction, wall_friction) in [(20, 0), (30, 0), (30, 10), (30, 20), (35, 12), (42, 0)] {
        let [phi, delta] = [friction, wall_friction].map(|own| f64::from(own).to_radians());
        let strength = SoilStrength::new(phi).unwrap().with_wall_friction(delta).unwrap();
        let angles = |range: std::ops::Range<f64>| {
            (1..40_000).map(move |k| range.start + (range.end - range.start) * f64::from(k) / 4e4)
        };
        let right_angle = std::f64::consts::FRAC_PI_2;
        let active =
            angles(phi..right_angle).map(|angle| wedge(angle, phi, delta)).fold(0.0, f64::max);
        // Friction acts the other way.
        let passive = angles(0.0..right_angle - phi - delta)
            .map(|angle| wedge(angle, -phi, -delta))
            .fold(f64::INFINITY, f64::min);
        for (found, wanted) in strength.pressure_ratios().into_iter().zip([active, passive]) {
            let error = found / (wanted * delta.cos()) - 1.0;
            assert!(error.abs() < 1e-6, "{friction}° {wall_friction}°: {found} {wanted}");
        }
    }
}

/// Coefficients of Coulomb's thrust, along its direction, as printed in textbooks (Das, *Principles of Foundation
/// Engineering*), and those of Rankine.
#[test]
fn pressure_ratios_are_those_of_tables() {
    let table = [
        (30.0, 0.0, 0.333, 3.0),
        (30.0, 15.0, 0.301, 4.977),
        (30.0, 20.0, 0.297, 6.105),
        (35.0, 0.0, 0.271, 3.690),
        (40.0, 0.0, 0.217, 4.599),
    ];
    for (friction, wall_friction, active, passive) in table {
        let [phi, delta] = [friction, wall_friction].map(f64::to_radians);
        let strength = SoilStrength::new(phi).unwrap().with_wall_friction(delta).unwrap();
        let found = strength.pressure_ratios().map(|ratio| ratio / delta.cos());
        assert!((found[0] - active).abs() < 6e-4, "{friction} {wall_friction}: {found:?}");
        assert!((found[1] / passive - 1.0).abs() < 2e-4, "{friction} {wall_friction}: {found:?}");
    }
}
