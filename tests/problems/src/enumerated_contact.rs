//! Contact problems of soil between an active and a passive pressure, solved by trying all modes of all elements.

use basemat::contact::ContactProblem;
use basemat::interface::{ContactState, InterfaceLaw, Mode, PreviousContact};

use super::dense::solve;
use super::random::Random;

/// Number of elements.
pub const COUNT: usize = 3;
/// Number of tractions.
const SIZE: usize = 2 * COUNT;
/// Largest violation of the law by a solution.
const ROUNDING: f64 = 1e-9;
/// Difference of equal tractions.
const SAME_TRACTION: f64 = 1e-8;

/// Coefficients of gap, slip, pressure and shear traction, and right-hand side, of both conditions of a mode.
type Rows = [([f64; 4], f64); 2];

/// A contact problem in units of its own, and the parameters of the elements' laws.
pub struct EnumeratedContact {
    pub delassus: Vec<f64>,
    /// Jumps without tractions.
    pub free_jump: Vec<f64>,
    /// Pressures at rest.
    pub pressed: Vec<f64>,
    /// How far the surface of the soil has moved away from the base.
    pub moved: Vec<f64>,
    /// Slips before.
    pub slip: Vec<f64>,
    /// Active and passive pressure of the soil.
    pub bounds: Vec<[f64; 2]>,
    pub friction: f64,
}

/// Ranges of random numbers.
#[derive(Debug, Clone, Copy)]
pub struct Ranges {
    pub free_jump: [f64; 2],
    pub pressed: [f64; 2],
    pub moved: [f64; 2],
}

impl EnumeratedContact {
    pub fn random(
        random: &mut Random,
        ranges: Ranges,
        bounds: impl FnOnce(&mut Random) -> Vec<[f64; 2]>,
    ) -> Self {
        let mut numbers = |[low, high]: [f64; 2], count: usize| -> Vec<f64> {
            (0..count).map(|_| random.within(low, high)).collect()
        };
        let root = numbers([-1.0, 1.0], SIZE * SIZE);
        let delassus = (0..SIZE * SIZE)
            .map(|k| {
                let (i, j) = (k / SIZE, k % SIZE);
                let product: f64 = (0..SIZE).map(|m| root[i * SIZE + m] * root[j * SIZE + m]).sum();
                product + if i == j { 0.2 } else { 0.0 }
            })
            .collect();
        let free_jump = numbers(ranges.free_jump, SIZE);
        let pressed = numbers(ranges.pressed, COUNT);
        let moved = numbers(ranges.moved, COUNT);
        let slip = numbers([-0.3, 0.3], COUNT);
        let bounds = bounds(random);
        let friction = random.pick(&[0.0, 0.2, 0.5, f64::INFINITY]);
        Self { delassus, free_jump, pressed, moved, slip, bounds, friction }
    }

    /// Conditions of a mode of an element; `None` if it has no such mode.
    fn rows(&self, e: usize, mode: Mode) -> Option<Rows> {
        let [active, passive] = self.bounds[e];
        let gap = ([1.0, 0.0, 0.0, 0.0], -self.moved[e]);
        let presses = |pressure: f64| ([0.0, 0.0, 1.0, 0.0], pressure);
        let stick = ([0.0, 1.0, 0.0, 0.0], self.slip[e]);
        let slides = |sign: f64| ([0.0, 0.0, -self.friction, sign], 0.0);
        if self.friction.is_infinite() && mode.is_slip() {
            // Infinite friction slides without pressure alone.
            let is_closed = matches!(mode, Mode::SlipLeft | Mode::SlipRight);
            return (active == 0.0 && is_closed).then_some([gap, presses(0.0)]);
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
            let g = state.gap + self.moved[e];
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
            let is_open = active == 0.0 && g > ROUNDING;
            let touches = if is_open { 0.0 } else { sticks.max(against) };
            worst.max(bounds).max(apart).max(pressed).max(cone).max(touches)
        })
    }

    /// All solutions with these modes of each element.
    fn solutions(&self, modes: [&[Mode]; COUNT]) -> Vec<Vec<ContactState>> {
        let mut solutions = Vec::new();
        for one in modes[0] {
            for two in modes[1] {
                for three in modes[2] {
                    let Some(states) = self.solve(&[*one, *two, *three]) else { continue };
                    if self.violation(&states) < ROUNDING {
                        solutions.push(states);
                    }
                }
            }
        }
        solutions
    }

    /// Contact of an element before, under a law.
    fn start<'a>(&'a self, e: usize, law: &dyn InterfaceLaw) -> PreviousContact<'a> {
        let state = ContactState {
            gap: -self.moved[e],
            slip: self.slip[e],
            pressure: self.pressed[e],
            ..ContactState::default()
        };
        let mut start = PreviousContact::new(state, law.modes()[0], 1.0);
        start.state_variables = &self.moved[e..=e];
        start
    }

    /// Modes that the contact search finds under these laws, and whether the problem has other solutions.
    ///
    /// Panics unless what the search finds is among all solutions with the `modes` of each element.
    pub fn assert_found(
        &self,
        laws: [Box<dyn InterfaceLaw>; COUNT],
        modes: [&[Mode]; COUNT],
    ) -> (Vec<Mode>, bool) {
        let solutions = self.solutions(modes);
        assert!(!solutions.is_empty(), "brute force has none");
        let starts: Vec<_> = (0..COUNT).map(|e| self.start(e, laws[e].as_ref())).collect();
        let mut traction = self.pressed.clone();
        traction.resize(SIZE, 0.0);
        let mut contact = ContactProblem::new(self.delassus.clone(), laws.into())
            .unwrap()
            .with_static_tractions(traction)
            .unwrap();
        let start = contact.start(&starts).unwrap();
        let found = contact.solve(&self.free_jump, &start).unwrap();
        let is_found = |states: &Vec<ContactState>| {
            states.iter().zip(found.states).all(|(a, b)| {
                (a.pressure - b.pressure).abs() < SAME_TRACTION
                    && (a.shear - b.shear).abs() < SAME_TRACTION
            })
        };
        assert!(solutions.iter().any(is_found), "{:?} {:?}", found.modes, found.states);
        (found.modes.to_vec(), !solutions.iter().all(is_found))
    }
}
