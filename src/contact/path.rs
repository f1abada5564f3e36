//! Parametric pivoting, the last resort of the mode search.
//!
//! The contact problem is embedded in a family j(λ) = j₀ + (1−λ) d. At λ = 0 the solution is known; λ = 1 is
//! the problem to solve. For fixed modes the solution is linear in λ. It is followed to the first λ at which
//! a law rejects an element's mode; this mode is changed to the mode that continues the solution, and so on.
//! λ may decrease in between. For the complementarity problem of Coulomb friction this is Lemke's method
//! (Lemke 1965) with d its covering vector. The method here uses only the conditions and the next mode of a
//! law.
//!
//! If the path begins with all elements open and d only widens gaps, it cannot run to λ = −∞: there j = d + W
//! r with p·g = 0 and τ·Δjₜ ≤ 0 would give r·A W r + p·A dₙ ≤ 0, hence r = 0, which is the beginning. This
//! holds for any friction coefficient if r·A W r > 0 for r ≠ 0; A W need not be symmetric. With tensile
//! strength the law is not monotone and the path may break. It may also break where the modes at a change are
//! nearly singular, at infinite friction in long steps (c₁Δt/l > 13): λ then does not distinguish the points
//! of the path. After a break, the next attempt begins elsewhere, also with all elements pressed shut.

use super::fixed_modes::ContactModeSolver;
use super::problem::ContactInput;
use crate::error::LawError;
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::interface::{ContactState, Mode, Tolerance};
use crate::linalg::dot;

/// Largest number of mode changes per element.
const MAX_CHANGES_PER_ELEMENT: usize = 60;
/// λ below which the path counts as broken.
const MIN_PATH_PARAMETER: f64 = -1e4;
/// Number of attempts that begin with elements about equally far open, or about equally pressed. Their
/// elements change mode in about the same order. In later attempts the elements differ by up to the factor
/// `MAX_SPREAD_FACTOR`.
const EVEN_ATTEMPTS: usize = 8;
const MAX_SPREAD_FACTOR: f64 = 1e3;
/// The golden ratio minus one.
const GOLDEN_FRACTION: f64 = 0.618_033_988_749_895;
/// Smallest advances of λ that count. A change of mode is located only within the laws' tolerances, so the
/// next mode may become admissible a little later.
const MIN_PATH_STEPS: [f64; 4] = [1e-13, 1e-11, 1e-9, 1e-7];

/// Workspace for following a path.
pub(crate) struct Path {
    offset: Vec<f64>,
    jump: Vec<f64>,
    /// States at the current point, and their rates of change with λ.
    states: Vec<ContactState>,
    rates: Vec<ContactState>,
}

/// Step of λ until a law rejects the mode of an element.
struct Reach {
    distance: f64,
    element: usize,
}

impl Path {
    pub(crate) fn new(count: usize) -> Self {
        let size = ContactLayout::new(COMPONENTS_IN_PLANE, count).len();
        Self {
            offset: vec![0.0; size],
            jump: vec![0.0; size],
            states: vec![ContactState::default(); count],
            rates: vec![ContactState::default(); count],
        }
    }

    /// Follows the path and stores the modes at its end in `modes`; the caller must check them.
    ///
    /// Returns the number of trials. Each `attempt` begins elsewhere, since a path may break.
    pub(crate) fn follow(
        &mut self,
        solver: &mut ContactModeSolver,
        input: &ContactInput<'_>,
        attempt: usize,
        modes: &mut [Mode],
    ) -> Result<usize, LawError> {
        self.begin(input, attempt, modes);
        let mut lambda = 0.0;
        let mut direction = 1.0;
        let mut trials = 0;
        for _ in 0..MAX_CHANGES_PER_ELEMENT * modes.len() {
            trials += 2;
            if !self.line(solver, input, modes, lambda)? {
                break;
            }
            let tolerance = solver.tolerance(input);
            let Reach { distance, element: first } = self.reach(input, modes, direction, tolerance);
            let limit = if direction > 0.0 { 1.0 - lambda } else { lambda - MIN_PATH_PARAMETER };
            if distance >= limit {
                break;
            }
            lambda += direction * distance;
            let leaving = modes[first];
            let here = self.states[first].along(&self.rates[first], direction * distance);
            // Several modes may be admissible here: the path continues in the mode that continues the
            // solution.
            let compliance = input.delassus[first * (self.jump.len() + 1)];
            let mut best = (f64::INFINITY, leaving, direction);
            for &mode in input.modes(first) {
                modes[first] = mode;
                if mode == leaving || !self.line(solver, input, modes, lambda)? {
                    continue;
                }
                trials += 2;
                let break_off = here.distance(&self.states[first], compliance);
                // Only one direction of λ is admissible; in the other direction rounding allows only a tiny
                // step.
                let ahead = self.reach(input, modes, direction, tolerance).distance;
                let back = self.reach(input, modes, -direction, tolerance).distance;
                let sense = if ahead >= back { direction } else { -direction };
                let distance = if ahead >= back { ahead } else { back };
                if break_off < best.0 && distance > MIN_PATH_STEPS[0] {
                    best = (break_off, mode, sense);
                }
            }
            (_, modes[first], direction) = best;
            if modes[first] == leaving {
                break;
            }
        }
        Ok(trials)
    }

    /// Sets the modes and d at the beginning, differently for each attempt.
    ///
    /// All elements are far open, or pressed shut, by unequal amounts, so that no two change at the same
    /// time.
    fn begin(&mut self, input: &ContactInput<'_>, attempt: usize, modes: &mut [Mode]) {
        let count = modes.len();
        // Multiples of the golden ratio, modulo one, never coincide; multiples by squares are spread without
        // order.
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
            self.begin_shut(input, spread, modes);
        }
    }

    /// Begins with all elements open and without tractions, or in active soil; d only widens the gaps.
    fn begin_open(
        &mut self,
        input: &ContactInput<'_>,
        spread: impl Fn(usize) -> f64,
        modes: &mut [Mode],
    ) {
        let count = modes.len();
        let size = self.jump.len();
        let mut largest = 0.0_f64;
        for (e, mode) in modes.iter_mut().enumerate() {
            let allowed = input.modes(e);
            let apart = allowed
                .iter()
                .find(|mode| matches!(mode, Mode::Open | Mode::Active | Mode::ActiveRight));
            *mode = *apart.unwrap_or(&allowed[0]);
            let row = &input.delassus[e * size..(e + 1) * size];
            let gap = input.free_jump[e] - dot(row, input.static_traction);
            largest = largest.max(gap.abs()).max(input.start.state(e).gap.abs());
        }
        self.offset.fill(0.0);
        for (e, offset) in self.offset[..count].iter_mut().enumerate() {
            *offset = (3.0 + spread(e)) * if largest > 0.0 { largest } else { 1.0 };
        }
    }

    /// Begins with all elements in the mode of rest, with pressures well above all pressures of the step.
    fn begin_shut(
        &mut self,
        input: &ContactInput<'_>,
        spread: impl Fn(usize) -> f64,
        modes: &mut [Mode],
    ) {
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, modes.len());
        let size = layout.len();
        let mut pressure = 0.0_f64;
        for e in 0..modes.len() {
            for i in layout.places::<COMPONENTS_IN_PLANE>(e) {
                pressure = pressure.max(input.free_jump[i].abs() / input.delassus[i * (size + 1)]);
            }
            pressure = pressure.max(input.start.state(e).pressure.abs());
        }
        if pressure == 0.0 {
            pressure = 1.0;
        }
        let mut change: Vec<f64> = input.static_traction.iter().map(|fixed| -fixed).collect();
        for (e, mode) in modes.iter_mut().enumerate() {
            let law = input.law(e);
            let start = &input.start_of(e);
            *mode = law.modes()[0];
            let pressed = (10.0 + 5.0 * spread(e)) * pressure;
            let mut target = ContactState {
                slip: start.state.slip,
                pressure: pressed,
                ..ContactState::default()
            };
            for condition in law.conditions(*mode, start) {
                if let Some(gap) = condition.gap_at(pressed) {
                    target.gap = gap;
                }
                if condition.gap == 0.0 && condition.slip != 0.0 && condition.shear != 0.0 {
                    let fixed_part = condition.slip * target.slip + condition.pressure * pressed;
                    target.shear = (condition.value - fixed_part) / condition.shear;
                }
            }
            // A law may prevent an element from closing in this step, at any pressure.
            let exact = Tolerance { length: 0.0, traction: 0.0 };
            let next = input.next_mode(e, *mode, &target, exact).unwrap_or(*mode);
            if next != *mode {
                *mode = next;
                target = ContactState { gap: start.state.gap, pressure: 0.0, shear: 0.0, ..target };
            }
            let [n, t] = layout.places(e);
            change[n] += target.pressure;
            change[t] += target.shear;
            self.offset[n] = target.gap;
            self.offset[t] = -target.slip;
        }
        for (i, offset) in self.offset.iter_mut().enumerate() {
            let row = &input.delassus[i * size..(i + 1) * size];
            *offset -= dot(row, &change) + input.free_jump[i];
        }
    }

    /// Computes states at `lambda` and their rates, for fixed modes; false if the modes are singular.
    fn line(
        &mut self,
        solver: &mut ContactModeSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
        lambda: f64,
    ) -> Result<bool, LawError> {
        for at in [lambda + 1.0, lambda] {
            for (i, jump) in self.jump.iter_mut().enumerate() {
                *jump = input.free_jump[i] + (1.0 - at) * self.offset[i];
            }
            let there = ContactInput { free_jump: &self.jump, ..*input };
            if !solver.solve_for_modes(&there, modes)? {
                return Ok(false);
            }
            if at == lambda {
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

    /// Largest step of λ in `direction` until a law rejects a mode, and the element of that law.
    ///
    /// The set of states that a law admits in one mode is convex (an intersection of half-spaces), so
    /// bisection finds its boundary.
    fn reach(
        &self,
        input: &ContactInput<'_>,
        modes: &[Mode],
        direction: f64,
        tolerance: Tolerance,
    ) -> Reach {
        let far = 1.0 - MIN_PATH_PARAMETER;
        let mut nearest = Reach { distance: far, element: 0 };
        for (e, &mode) in modes.iter().enumerate() {
            let admits = |distance: f64| {
                let there = self.states[e].along(&self.rates[e], direction * distance);
                input.next_mode(e, mode, &there, tolerance) == Ok(mode)
            };
            let Some(begin) = MIN_PATH_STEPS.into_iter().find(|&step| admits(step)) else {
                return Reach { distance: 0.0, element: e };
            };
            if admits(nearest.distance) {
                continue;
            }
            let mut low = begin;
            let mut high = nearest.distance;
            for _ in 0..120 {
                let middle = 0.5 * (low + high);
                if admits(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            nearest = Reach { distance: low, element: e };
        }
        nearest
    }
}

impl ContactState {
    /// This state after `distance` at `rate`.
    fn along(&self, rate: &Self, distance: f64) -> Self {
        Self {
            gap: self.gap + distance * rate.gap,
            slip: self.slip + distance * rate.slip,
            pressure: self.pressure + distance * rate.pressure,
            shear: self.shear + distance * rate.shear,
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
