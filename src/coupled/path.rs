//! The last resort of the mode search: parametric pivoting.
//!
//! The contact problem is embedded in a family j(λ) = j₀ + (1−λ) d. At λ = 0 all elements are
//! pressed shut and stick; at λ = 1 it is the problem to solve. For fixed modes the solution is
//! linear in λ, so it is followed to the first λ at which a law objects, that element's mode is
//! changed to the one that continues the solution there, and so on. λ may turn back in between.
//! For the complementarity problem of Coulomb friction this is Lemke's method (Lemke 1965) with
//! its covering vector; here it needs of a law no more than its conditions and its next mode.

use super::contact::{ContactInput, ContactSolver};
use crate::interface::{ContactState, Mode, Tolerance};

/// Changes of mode per element, at most.
const CHANGES: usize = 60;
/// λ below which the path counts as lost.
const LOST: f64 = -1e4;
/// Shortest advance of λ that counts.
const STEP: f64 = 1e-13;

/// Memory of the path.
pub(crate) struct Path {
    offset: Vec<f64>,
    jump: Vec<f64>,
    /// States at the point reached, and their rates of change with λ.
    states: Vec<ContactState>,
    rates: Vec<ContactState>,
}

impl Path {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            offset: vec![0.0; 2 * count],
            jump: vec![0.0; 2 * count],
            states: vec![ContactState::default(); count],
            rates: vec![ContactState::default(); count],
        }
    }

    /// Follows the path and leaves in `modes` those at its end, which the caller must check.
    pub(crate) fn follow(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
        trials: &mut usize,
    ) {
        self.begin(input, modes);
        let (mut lambda, mut direction) = (0.0, 1.0);
        for _ in 0..CHANGES * modes.len() {
            *trials += 2;
            if !self.line(solver, input, modes, lambda) {
                return;
            }
            let tolerance = solver.tolerance(input);
            let (reach, first) = self.reach(input, modes, direction, tolerance);
            let limit = if direction > 0.0 { 1.0 - lambda } else { lambda - LOST };
            if reach >= limit {
                return;
            }
            lambda += direction * reach;
            let leaving = modes[first];
            let here = self.states[first].along(&self.rates[first], direction * reach);
            // Several modes may be admissible here: the path goes on in the one that continues it.
            let compliance = input.delassus[first * (2 * modes.len() + 1)];
            let mut best = (f64::INFINITY, leaving, direction);
            for &mode in input.law(first).modes() {
                modes[first] = mode;
                if mode == leaving || !self.line(solver, input, modes, lambda) {
                    continue;
                }
                *trials += 2;
                let break_off = here.distance(&self.states[first], compliance);
                // Only one sense of λ is admissible; rounding leaves the other one next to nothing.
                let [ahead, back] = [direction, -direction]
                    .map(|sense| (self.reach(input, modes, sense, tolerance).0, sense));
                let (reach, sense) = if ahead.0 >= back.0 { ahead } else { back };
                if break_off < best.0 && reach > STEP {
                    best = (break_off, mode, sense);
                }
            }
            (_, modes[first], direction) = best;
            if modes[first] == leaving {
                return;
            }
        }
    }

    /// Sets the modes and d of the beginning: pressures well above all that the step knows,
    /// unequal so that no two elements change at once.
    fn begin(&mut self, input: &ContactInput<'_>, modes: &mut [Mode]) {
        let count = modes.len();
        let size = 2 * count;
        let mut pressure = 0.0_f64;
        for e in 0..count {
            let blocked = input.free_jump[e].abs() / input.delassus[e * size + e];
            let sheared =
                input.free_jump[count + e].abs() / input.delassus[(count + e) * size + count + e];
            let before = input.start[e].state;
            pressure = pressure.max(blocked).max(sheared).max(before.pressure.abs());
        }
        if pressure == 0.0 {
            pressure = 1.0;
        }
        for i in 0..size {
            let element = i % count;
            let state = input.start[element].state;
            let closed = if i >= count {
                -state.slip
            } else if input.start[element].mode.is_closed() {
                state.gap
            } else {
                0.0
            };
            let row = &input.delassus[i * size..(i + 1) * size];
            let mut answer = 0.0;
            for (q, fixed) in input.static_traction.iter().enumerate() {
                // Multiples of the golden ratio, modulo one, never meet.
                let spread = (0.618_033_988_749_895 * (q + 1) as f64).fract();
                let total = if q < count { (10.0 + 5.0 * spread) * pressure } else { 0.0 };
                answer += row[q] * (total - fixed);
            }
            self.offset[i] = closed - answer - input.free_jump[i];
        }
        for (e, mode) in modes.iter_mut().enumerate() {
            *mode = input.law(e).modes()[0];
        }
    }

    /// States at `lambda` and their rates, for fixed modes; false if the modes are singular.
    fn line(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
        lambda: f64,
    ) -> bool {
        for at in [lambda + 1.0, lambda] {
            for (i, jump) in self.jump.iter_mut().enumerate() {
                *jump = input.free_jump[i] + (1.0 - at) * self.offset[i];
            }
            let there = ContactInput { free_jump: &self.jump, ..*input };
            if !solver.trial(&there, modes) {
                return false;
            }
            if at == lambda {
                self.states.copy_from_slice(&solver.states);
            } else {
                self.rates.copy_from_slice(&solver.states);
            }
        }
        for (rate, state) in self.rates.iter_mut().zip(&self.states) {
            rate.gap -= state.gap;
            rate.slip -= state.slip;
            rate.pressure -= state.pressure;
            rate.shear -= state.shear;
        }
        true
    }

    /// How far λ can go in `direction` until a law objects, and whose.
    ///
    /// What a law admits in one mode is convex (an intersection of half-spaces), so that bisection
    /// finds the end.
    fn reach(
        &self,
        input: &ContactInput<'_>,
        modes: &[Mode],
        direction: f64,
        tolerance: Tolerance,
    ) -> (f64, usize) {
        let far = 1.0 - LOST;
        let mut nearest = (far, 0);
        for (e, &mode) in modes.iter().enumerate() {
            let admits = |distance: f64| {
                let there = self.states[e].along(&self.rates[e], direction * distance);
                input.law(e).next_mode(mode, &input.start[e], &there, tolerance) == mode
            };
            if !admits(STEP) {
                return (0.0, e);
            }
            if admits(nearest.0) {
                continue;
            }
            let (mut low, mut high) = (0.0, nearest.0);
            for _ in 0..120 {
                let middle = 0.5 * (low + high);
                if admits(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            nearest = (low, e);
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
        }
    }

    /// How far two states are apart, as a traction.
    fn distance(&self, other: &Self, compliance: f64) -> f64 {
        (self.pressure - other.pressure).abs()
            + (self.shear - other.shear).abs()
            + ((self.gap - other.gap).abs() + (self.slip - other.slip).abs()) / compliance
    }
}
