//! Path following: parametric pivoting for problems that other searches do not solve.
//!
//! The method solves a family of contact problems with the jumps j(λ) = j₀ + (1−λ) d. The solution at λ = 0 is
//! prescribed; λ = 1 is the problem of the step. For fixed modes the solution is linear in λ. The method follows it to
//! the first λ at which a law rejects an element's mode, and changes this mode to the mode that continues the solution.
//! Then it follows the next piece of the path, on which λ may decrease. For the complementarity problem of Coulomb
//! friction this is Lemke's method (Lemke 1965), and d is its covering vector. The method here uses only the conditions
//! and the next mode of a law.
//!
//! If all elements are open at first and d only widens gaps, the path cannot run to λ = −∞: there j = d + W r with
//! p·g = 0 and τ·Δjₜ ≤ 0 would give r·A W r + p·A dₙ ≤ 0, hence r = 0, which is the beginning. This holds for any
//! friction coefficient if r·A W r > 0 for r ≠ 0; A W need not be symmetric. With tensile strength the law is not
//! monotone and the path may end before λ = 1. It may also end where the modes at a change are nearly singular, at
//! infinite friction in long steps (c₁Δt/l > 13): λ then does not distinguish the points of the path. The next attempt
//! begins elsewhere, also with all elements closed under pressure.

use super::fixed_modes::ContactModeSolver;
use super::problem::{ContactInput, LawResult};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::interface::{ContactState, Mode, Tolerance};
use crate::linalg::dot;

/// Largest number of mode changes per element.
const MAX_CHANGES_PER_ELEMENT: usize = 60;
/// λ below which the path does not return.
const MIN_PATH_PARAMETER: f64 = -1e4;
/// Number of attempts that begin with nearly equal gaps, or nearly equal pressures.
const EVEN_ATTEMPTS: usize = 8;
/// Largest ratio of the initial gaps or pressures of later attempts.
///
/// Elements then change their modes in another order.
const MAX_SPREAD_FACTOR: f64 = 1e3;
/// Number of bisections that locate a change of mode to the last bit.
const MAX_BISECTIONS: usize = 120;
/// The golden ratio minus one: the fractional parts of its multiples are spread evenly.
const GOLDEN_FRACTION: f64 = 0.618_033_988_749_895;
/// Steps of λ that are tried for the first admissible state.
///
/// The laws' tolerances shift a change of mode, so the next mode may become admissible a little later.
const MIN_PATH_STEPS: [f64; 4] = [1e-13, 1e-11, 1e-9, 1e-7];

/// Path follower: the family of problems, and the states on the path.
pub(crate) struct Path {
    /// d.
    covering_jump: Vec<f64>,
    /// j(λ).
    jump: Vec<f64>,
    /// States at the current point.
    states: Vec<ContactState>,
    /// Rates of change of the states with λ.
    rates: Vec<ContactState>,
}

/// Length of a step of λ until a law rejects the mode of an element.
struct Reach {
    step: f64,
    element: usize,
}

impl Path {
    pub(crate) fn new(count: usize) -> Self {
        let size = ContactLayout::new(COMPONENTS_IN_PLANE, count).len();
        Self {
            covering_jump: vec![0.0; size],
            jump: vec![0.0; size],
            states: vec![ContactState::default(); count],
            rates: vec![ContactState::default(); count],
        }
    }

    /// Follows the path and stores the modes at its end in `modes`; the caller must check them.
    ///
    /// Returns the number of trials. Each `attempt` begins elsewhere, since a path may end early.
    pub(crate) fn follow(
        &mut self,
        solver: &mut ContactModeSolver,
        input: &ContactInput<'_>,
        attempt: usize,
        modes: &mut [Mode],
    ) -> LawResult<usize> {
        self.begin(input, attempt, modes);
        let mut lambda = 0.0;
        let mut direction = 1.0;
        let mut trials = 0;
        for _ in 0..MAX_CHANGES_PER_ELEMENT * modes.len() {
            trials += 2;
            if !self.update_states(solver, input, modes, lambda)? {
                break;
            }
            let tolerance = solver.tolerance(input);
            let Reach { step, element } = self.reach(input, modes, direction, tolerance);
            let max_step = if direction > 0.0 { 1.0 - lambda } else { lambda - MIN_PATH_PARAMETER };
            if step >= max_step {
                break;
            }
            lambda += direction * step;
            let rejected_mode = modes[element];
            let state = self.states[element].extrapolated(&self.rates[element], direction * step);
            // Several modes may be admissible: the nearest state continues the path.
            let compliance = input.delassus[element * (self.jump.len() + 1)];
            let mut min_distance = f64::INFINITY;
            let mut next_mode = rejected_mode;
            let mut next_direction = direction;
            for &mode in input.modes(element) {
                modes[element] = mode;
                if mode == rejected_mode || !self.update_states(solver, input, modes, lambda)? {
                    continue;
                }
                trials += 2;
                let distance = state.distance(&self.states[element], compliance);
                // Only one direction of λ is admissible; rounding allows a tiny step in the other one.
                let forward_step = self.reach(input, modes, direction, tolerance).step;
                let backward_step = self.reach(input, modes, -direction, tolerance).step;
                let is_forward = forward_step >= backward_step;
                let step = if is_forward { forward_step } else { backward_step };
                if distance < min_distance && step > MIN_PATH_STEPS[0] {
                    min_distance = distance;
                    next_mode = mode;
                    next_direction = if is_forward { direction } else { -direction };
                }
            }
            modes[element] = next_mode;
            direction = next_direction;
            if next_mode == rejected_mode {
                break;
            }
        }
        Ok(trials)
    }

    /// Sets the initial modes and d, differently for each attempt.
    ///
    /// All elements have a wide gap, or all a high pressure. These amounts differ, so that no two elements change their
    /// mode at the same λ.
    fn begin(&mut self, input: &ContactInput<'_>, attempt: usize, modes: &mut [Mode]) {
        let count = modes.len();
        // Fractional parts of multiples of the golden ratio differ; those of its multiples by squares have no order.
        let spread = |e: usize| {
            let number = (attempt * count + e + 1) as f64;
            if attempt < EVEN_ATTEMPTS {
                (GOLDEN_FRACTION * number).fract()
            } else {
                MAX_SPREAD_FACTOR.powf((GOLDEN_FRACTION * number * number).fract())
            }
        };
        if attempt.is_multiple_of(2) {
            self.begin_open(input, spread, modes);
        } else {
            self.begin_closed(input, spread, modes);
        }
    }

    /// Begins with all elements open or in active soil, and without tractions.
    ///
    /// d only widens the gaps.
    fn begin_open(
        &mut self,
        input: &ContactInput<'_>,
        spread: impl Fn(usize) -> f64,
        modes: &mut [Mode],
    ) {
        let count = modes.len();
        let size = self.jump.len();
        let mut max_gap = 0.0_f64;
        for (e, mode) in modes.iter_mut().enumerate() {
            let allowed = input.modes(e);
            let open_mode = allowed
                .iter()
                .find(|mode| matches!(mode, Mode::Open | Mode::Active | Mode::ActiveRight));
            *mode = *open_mode.unwrap_or(&allowed[0]);
            let row = &input.delassus[e * size..(e + 1) * size];
            let gap = input.free_jump[e] - dot(row, input.static_traction);
            max_gap = max_gap.max(gap.abs()).max(input.start.state(e).gap.abs());
        }
        self.covering_jump.fill(0.0);
        for (e, gap) in self.covering_jump[..count].iter_mut().enumerate() {
            // Wider than all gaps of the step.
            *gap = (3.0 + spread(e)) * if max_gap > 0.0 { max_gap } else { 1.0 };
        }
    }

    /// Begins with all elements in the mode of rest, under high pressures.
    ///
    /// These are well above all pressures of the step.
    fn begin_closed(
        &mut self,
        input: &ContactInput<'_>,
        spread: impl Fn(usize) -> f64,
        modes: &mut [Mode],
    ) {
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, modes.len());
        let size = layout.len();
        let mut max_pressure = 0.0_f64;
        for e in 0..modes.len() {
            for i in layout.indices_of::<COMPONENTS_IN_PLANE>(e) {
                let pressure = input.free_jump[i].abs() / input.delassus[i * (size + 1)];
                max_pressure = max_pressure.max(pressure);
            }
            max_pressure = max_pressure.max(input.start.state(e).pressure.abs());
        }
        if max_pressure == 0.0 {
            max_pressure = 1.0;
        }
        let mut change: Vec<f64> = input.static_traction.iter().map(|traction| -traction).collect();
        for (e, mode) in modes.iter_mut().enumerate() {
            let law = input.law(e);
            let start = &input.start_of(e);
            *mode = law.modes()[0];
            let pressure = (10.0 + 5.0 * spread(e)) * max_pressure;
            let mut target =
                ContactState { slip: start.state.slip, pressure, ..ContactState::default() };
            for condition in law.conditions(*mode, start) {
                if let Some(gap) = condition.gap_at(pressure) {
                    target.gap = gap;
                }
                if condition.gap == 0.0 && condition.slip != 0.0 && condition.shear != 0.0 {
                    let other_terms = condition.slip * target.slip + condition.pressure * pressure;
                    target.shear = (condition.value - other_terms) / condition.shear;
                }
            }
            // A law may prevent an element from closing in this step, at any pressure.
            let zero_tolerance = Tolerance { length: 0.0, traction: 0.0 };
            let next_mode = input.next_mode(e, *mode, &target, zero_tolerance).unwrap_or(*mode);
            if next_mode != *mode {
                *mode = next_mode;
                target = ContactState { gap: start.state.gap, pressure: 0.0, shear: 0.0, ..target };
            }
            let [n, t] = layout.indices_of(e);
            change[n] += target.pressure;
            change[t] += target.shear;
            self.covering_jump[n] = target.gap;
            self.covering_jump[t] = -target.slip;
        }
        for (i, jump) in self.covering_jump.iter_mut().enumerate() {
            let row = &input.delassus[i * size..(i + 1) * size];
            *jump -= dot(row, &change) + input.free_jump[i];
        }
    }

    /// Computes states at `lambda` and their rates, for fixed modes.
    ///
    /// `false` if the modes are singular.
    fn update_states(
        &mut self,
        solver: &mut ContactModeSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
        lambda: f64,
    ) -> LawResult<bool> {
        for parameter in [lambda + 1.0, lambda] {
            for (i, jump) in self.jump.iter_mut().enumerate() {
                *jump = input.free_jump[i] + (1.0 - parameter) * self.covering_jump[i];
            }
            let path_input = ContactInput { free_jump: &self.jump, ..*input };
            if !solver.solve_for_modes(&path_input, modes)? {
                return Ok(false);
            }
            if parameter == lambda {
                self.states.copy_from_slice(&solver.response.states);
            } else {
                self.rates.copy_from_slice(&solver.response.states);
            }
        }
        for (rate, state) in self.rates.iter_mut().zip(&self.states) {
            rate.gap -= state.gap;
            rate.slip -= state.slip;
            rate.pressure -= state.pressure;
            rate.shear -= state.shear;
        }
        Ok(true)
    }

    /// Largest step of λ until a law rejects a mode, and its element.
    ///
    /// `direction`: sign of the change of λ. The states that a law admits in one mode form a convex set (an
    /// intersection of half-spaces), so bisection finds its boundary.
    fn reach(
        &self,
        input: &ContactInput<'_>,
        modes: &[Mode],
        direction: f64,
        tolerance: Tolerance,
    ) -> Reach {
        let mut reach = Reach { step: 1.0 - MIN_PATH_PARAMETER, element: 0 };
        for (e, &mode) in modes.iter().enumerate() {
            let admits = |step: f64| {
                let state = self.states[e].extrapolated(&self.rates[e], direction * step);
                input.next_mode(e, mode, &state, tolerance) == Ok(mode)
            };
            let Some(min_step) = MIN_PATH_STEPS.into_iter().find(|&step| admits(step)) else {
                return Reach { step: 0.0, element: e };
            };
            if admits(reach.step) {
                continue;
            }
            let mut admitted_step = min_step;
            let mut rejected_step = reach.step;
            for _ in 0..MAX_BISECTIONS {
                let middle = 0.5 * (admitted_step + rejected_step);
                if admits(middle) {
                    admitted_step = middle;
                } else {
                    rejected_step = middle;
                }
            }
            reach = Reach { step: admitted_step, element: e };
        }
        reach
    }
}

impl ContactState {
    /// This state after a `step` of λ at this `rate`.
    fn extrapolated(&self, rate: &Self, step: f64) -> Self {
        Self {
            gap: self.gap + step * rate.gap,
            slip: self.slip + step * rate.slip,
            pressure: self.pressure + step * rate.pressure,
            shear: self.shear + step * rate.shear,
            ..*self
        }
    }

    /// Distance between two states, expressed as a traction.
    fn distance(&self, other: &Self, compliance: f64) -> f64 {
        (self.pressure - other.pressure).abs()
            + (self.shear - other.shear).abs()
            + ((self.gap - other.gap).abs() + (self.slip - other.slip).abs()) / compliance
    }
}
