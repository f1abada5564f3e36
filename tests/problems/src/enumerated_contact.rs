//! Contact problems of soil between an active and a passive pressure, solved by trying all modes of all elements.

use basemat::contact::ContactProblem;
use basemat::interface::{ContactState, InterfaceLaw, Mode, PreviousContact};

use super::dense::{dot, solve};
use super::random::Random;

pub const ELEMENT_COUNT: usize = 3;
const TRACTION_COUNT: usize = 2 * ELEMENT_COUNT;
/// Largest violation of the law by a solution.
const LAW_TOLERANCE: f64 = 1e-9;
/// Difference of equal tractions.
const SAME_TRACTION_TOLERANCE: f64 = 1e-8;

/// A linear condition on an element: a gap + b slip + c pressure + d shear = value.
#[derive(Clone, Copy)]
struct LinearCondition {
    /// Coefficients of gap, slip, pressure and shear traction.
    coefficients: [f64; 4],
    value: f64,
}

impl LinearCondition {
    fn new(coefficients: [f64; 4], value: f64) -> Self {
        Self { coefficients, value }
    }

    fn gap_is(gap: f64) -> Self {
        Self::new([1.0, 0.0, 0.0, 0.0], gap)
    }

    fn slip_is(slip: f64) -> Self {
        Self::new([0.0, 1.0, 0.0, 0.0], slip)
    }

    fn pressure_is(pressure: f64) -> Self {
        Self::new([0.0, 0.0, 1.0, 0.0], pressure)
    }
}

/// A dimensionless contact problem, and the parameters of the elements' laws.
pub struct EnumeratedContact {
    pub delassus: Vec<f64>,
    /// Jumps without tractions.
    pub free_jump: Vec<f64>,
    /// Pressures at rest.
    pub static_pressure: Vec<f64>,
    /// Distance by which the surface of the soil has recession away from the base.
    pub recession: Vec<f64>,
    /// Slips at the start of the step.
    pub slip: Vec<f64>,
    /// Active and passive pressure of the soil.
    pub bounds: Vec<[f64; 2]>,
    pub friction: f64,
}

/// Ranges of the random numbers of a contact problem.
#[derive(Debug, Clone, Copy)]
pub struct ContactRanges {
    pub free_jump: [f64; 2],
    pub static_pressure: [f64; 2],
    pub recession: [f64; 2],
}

impl EnumeratedContact {
    pub fn random(
        random: &mut Random,
        ranges: ContactRanges,
        bounds: impl FnOnce(&mut Random) -> Vec<[f64; 2]>,
    ) -> Self {
        let delassus = random_delassus(random);
        let free_jump = random_numbers(random, ranges.free_jump, TRACTION_COUNT);
        let static_pressure = random_numbers(random, ranges.static_pressure, ELEMENT_COUNT);
        let recession = random_numbers(random, ranges.recession, ELEMENT_COUNT);
        let slip = random_numbers(random, [-0.3, 0.3], ELEMENT_COUNT);
        let bounds = bounds(random);
        let friction = random.pick(&[0.0, 0.2, 0.5, f64::INFINITY]);
        Self { delassus, free_jump, static_pressure, recession, slip, bounds, friction }
    }

    /// Conditions of a mode of an element; `None` if it has no such mode.
    fn conditions(&self, e: usize, mode: Mode) -> Option<[LinearCondition; 2]> {
        let active = LinearCondition::pressure_is(self.bounds[e][0]);
        let passive = LinearCondition::pressure_is(self.bounds[e][1]);
        let closed_gap = LinearCondition::gap_is(-self.recession[e]);
        let stick = LinearCondition::slip_is(self.slip[e]);
        let slip_right = LinearCondition::new([0.0, 0.0, -self.friction, 1.0], 0.0);
        let slip_left = LinearCondition::new([0.0, 0.0, -self.friction, -1.0], 0.0);
        let without_pressure = LinearCondition::pressure_is(0.0);
        if self.friction.is_infinite() && mode.is_slip() {
            // With infinite friction an element slides only without pressure.
            let is_closed = matches!(mode, Mode::SlipLeft | Mode::SlipRight);
            let can_open = self.bounds[e][0] == 0.0;
            return (can_open && is_closed).then_some([closed_gap, without_pressure]);
        }
        Some(match mode {
            Mode::Open => [without_pressure, LinearCondition::new([0.0, 0.0, 0.0, 1.0], 0.0)],
            Mode::Stick => [closed_gap, stick],
            Mode::Yield => [passive, stick],
            Mode::Active => [active, stick],
            Mode::SlipRight => [closed_gap, slip_right],
            Mode::SlipLeft => [closed_gap, slip_left],
            Mode::YieldRight => [passive, slip_right],
            Mode::YieldLeft => [passive, slip_left],
            Mode::ActiveRight => [active, slip_right],
            Mode::ActiveLeft => [active, slip_left],
            other => panic!("{other:?}"),
        })
    }

    /// Total tractions and jumps of a choice of modes.
    fn solve(&self, modes: &[Mode]) -> Option<Vec<ContactState>> {
        let mut matrix = vec![vec![0.0; TRACTION_COUNT]; TRACTION_COUNT];
        let mut rhs = vec![0.0; TRACTION_COUNT];
        for (e, &mode) in modes.iter().enumerate() {
            for (k, condition) in self.conditions(e, mode)?.into_iter().enumerate() {
                // gap = j_n + W τ, slip = −(j_t + W τ), p = p₀ + τ_n, shear = τ_t.
                let LinearCondition { coefficients: [g, s, p, t], value } = condition;
                let row = 2 * e + k;
                rhs[row] = value - g * self.free_jump[e] + s * self.free_jump[ELEMENT_COUNT + e]
                    - p * self.static_pressure[e];
                for j in 0..TRACTION_COUNT {
                    matrix[row][j] += g * self.delassus[e * TRACTION_COUNT + j]
                        - s * self.delassus[(ELEMENT_COUNT + e) * TRACTION_COUNT + j];
                }
                matrix[row][e] += p;
                matrix[row][ELEMENT_COUNT + e] += t;
            }
        }
        let traction = solve(&matrix, &rhs);
        traction.iter().all(|t| t.is_finite()).then(|| self.states(&traction))
    }

    fn states(&self, traction: &[f64]) -> Vec<ContactState> {
        let jump: Vec<f64> = self
            .delassus
            .chunks_exact(TRACTION_COUNT)
            .zip(&self.free_jump)
            .map(|(row, free_jump)| free_jump + dot(row, traction))
            .collect();
        (0..ELEMENT_COUNT)
            .map(|e| ContactState {
                gap: jump[e],
                slip: -jump[ELEMENT_COUNT + e],
                pressure: self.static_pressure[e] + traction[e],
                shear: traction[ELEMENT_COUNT + e],
                ..ContactState::default()
            })
            .collect()
    }

    /// Residual of the law over all elements, written as complementarity conditions.
    fn violation(&self, states: &[ContactState]) -> f64 {
        let violations =
            states.iter().enumerate().map(|(e, state)| self.element_violation(e, state));
        violations.fold(0.0_f64, f64::max)
    }

    fn element_violation(&self, e: usize, state: &ContactState) -> f64 {
        let [active, passive] = self.bounds[e];
        let p = state.pressure;
        let g = state.gap + self.recession[e];
        // p from active to passive, g ≥ 0 below passive, g ≤ 0 above active.
        let pressure_violation = (active - p).max(p - passive);
        let gap_violation = g.max(0.0).min(p - active);
        let penetration_violation = (-g).max(0.0).min(passive - p);
        // Infinite friction allows any shear traction, also in the limit p → 0.
        let is_infinite = self.friction.is_infinite();
        let shear_limit = if is_infinite { f64::INFINITY } else { self.friction * p };
        let slip_increment = state.slip - self.slip[e];
        let cone_violation = state.shear.abs() - shear_limit;
        let distance_from_limit = if is_infinite { p.abs() } else { (-cone_violation).max(0.0) };
        let stick_violation = slip_increment.abs().min(distance_from_limit);
        let direction_violation = if self.friction > 0.0 {
            (-slip_increment * state.shear.signum()).max(0.0).min(state.shear.abs())
        } else {
            0.0
        };
        let is_open = active == 0.0 && g > LAW_TOLERANCE;
        let slip_violation = if is_open { 0.0 } else { stick_violation.max(direction_violation) };
        pressure_violation
            .max(gap_violation)
            .max(penetration_violation)
            .max(cone_violation)
            .max(slip_violation)
    }

    /// All solutions with these modes of each element.
    fn solutions(&self, modes: [&[Mode]; ELEMENT_COUNT]) -> Vec<Vec<ContactState>> {
        let mut solutions = Vec::new();
        for first in modes[0] {
            for second in modes[1] {
                for third in modes[2] {
                    let Some(states) = self.solve(&[*first, *second, *third]) else { continue };
                    if self.violation(&states) < LAW_TOLERANCE {
                        solutions.push(states);
                    }
                }
            }
        }
        solutions
    }

    /// Contact of an element at the start of the step.
    fn start<'a>(&'a self, e: usize, law: &dyn InterfaceLaw) -> PreviousContact<'a> {
        let state = ContactState {
            gap: -self.recession[e],
            slip: self.slip[e],
            pressure: self.static_pressure[e],
            ..ContactState::default()
        };
        let mut start = PreviousContact::new(state, law.modes()[0], 1.0);
        start.state_variables = &self.recession[e..=e];
        start
    }

    /// Modes that the contact search finds, and whether the problem has other solutions.
    ///
    /// Panics unless the solution of the search is among all solutions with the `modes` of each element.
    pub fn assert_search_solves(
        &self,
        laws: [Box<dyn InterfaceLaw>; ELEMENT_COUNT],
        modes: [&[Mode]; ELEMENT_COUNT],
    ) -> (Vec<Mode>, bool) {
        let solutions = self.solutions(modes);
        assert!(!solutions.is_empty(), "no choice of modes is a solution");
        let starts: Vec<_> = (0..ELEMENT_COUNT).map(|e| self.start(e, laws[e].as_ref())).collect();
        let mut traction = self.static_pressure.clone();
        traction.resize(TRACTION_COUNT, 0.0);
        let mut contact = ContactProblem::new(self.delassus.clone(), laws.into())
            .unwrap()
            .with_static_tractions(traction)
            .unwrap();
        let start = contact.start(&starts).unwrap();
        let solution = contact.solve(&self.free_jump, &start).unwrap();
        let same_solutions = solutions
            .iter()
            .filter(|states| have_same_tractions(states, solution.states))
            .count();
        assert!(same_solutions > 0, "{:?} {:?}", solution.modes, solution.states);
        (solution.modes.to_vec(), same_solutions < solutions.len())
    }
}

fn have_same_tractions(first: &[ContactState], second: &[ContactState]) -> bool {
    first.iter().zip(second).all(|(a, b)| {
        (a.pressure - b.pressure).abs() < SAME_TRACTION_TOLERANCE
            && (a.shear - b.shear).abs() < SAME_TRACTION_TOLERANCE
    })
}

fn random_numbers(random: &mut Random, [low, high]: [f64; 2], count: usize) -> Vec<f64> {
    (0..count).map(|_| random.within(low, high)).collect()
}

/// A random symmetric positive definite matrix.
fn random_delassus(random: &mut Random) -> Vec<f64> {
    let size = TRACTION_COUNT;
    let root = random_numbers(random, [-1.0, 1.0], size * size);
    let mut matrix = Vec::with_capacity(size * size);
    for i in 0..size {
        for j in 0..size {
            let product: f64 = (0..size).map(|m| root[i * size + m] * root[j * size + m]).sum();
            matrix.push(product + if i == j { 0.2 } else { 0.0 });
        }
    }
    matrix
}
