//! Linear system of contact in the plane, for prescribed contact modes (stick, slip, open).

use std::cell::Cell;

use super::delassus::Delassus;
use super::problem::{ContactInput, ContactResponse, LawResult};
use super::reduced_row::ReducedRow;
use super::row_updates::{MAX_CHANGED_ROWS, RowUpdates};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::interface::{Condition, InterfaceLaw, Mode, PreviousContacts, Tolerance};
use crate::linalg::{DenseFactor, dense_condition, largest};

/// Rounding error of a jump relative to the largest jump.
pub(super) const JUMP_ROUNDING_FACTOR: f64 = 1e-13;
/// Rounding error of a traction relative to the largest traction.
pub(super) const TRACTION_ROUNDING_FACTOR: f64 = 1e-12;

/// Largest order of a system for which factors column by column take less time.
const MAX_SMALL_ORDER: usize = 64;

/// Solver for prescribed modes in the plane; reuses factors while the conditions stay the same.
pub(super) struct ContactModeSolver {
    /// Tractions, jumps and states of the last solution.
    pub(super) response: ContactResponse,
    /// Conditions of the present modes, two per element.
    conditions: Vec<[Condition; 2]>,
    /// Conditions of the stored factors. The factors are independent of [`Condition::value`].
    factored_conditions: Vec<[Condition; 2]>,
    factor: DenseFactor,
    has_valid_factor: bool,
    /// Whether a trial of the present step has used the factors.
    is_factor_of_step: bool,
    /// Rows in which the present matrix differs from the factored one.
    updates: RowUpdates,
    /// The factored matrix.
    matrix: Vec<f64>,
    /// Scratch: a row of the present matrix.
    changed_row: Vec<f64>,
    rhs: Vec<f64>,
    rows: Vec<ReducedRow>,
    /// Unknown contact components of the reduced system; one condition alone fixes each other component.
    dofs: Vec<usize>,
}

impl ContactModeSolver {
    /// Solver for `element_count` elements.
    pub(super) fn new(element_count: usize) -> Self {
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, element_count);
        let size = layout.len();
        Self {
            response: ContactResponse::new(layout),
            conditions: vec![[Condition::default(); 2]; element_count],
            factored_conditions: vec![[Condition::default(); 2]; element_count],
            factor: DenseFactor::with_capacity(size),
            has_valid_factor: false,
            is_factor_of_step: false,
            updates: RowUpdates::with_capacity(size),
            matrix: Vec::with_capacity(size * size),
            changed_row: Vec::with_capacity(size),
            rhs: Vec::with_capacity(size),
            rows: Vec::with_capacity(size),
            dofs: Vec::with_capacity(size),
        }
    }

    /// Discards the factors; call this when W has changed.
    pub(super) fn invalidate(&mut self) {
        self.has_valid_factor = false;
    }

    /// Makes rounding errors independent of previous time steps.
    ///
    /// The first trial of a step has factors of its own matrix, as in a resumed run.
    pub(super) fn begin_step(&mut self) {
        self.is_factor_of_step = false;
        self.updates.begin_matrix();
    }

    /// Condition number of the system with all elements in their modes of rest.
    ///
    /// It is infinite if the system is singular. The mode of rest is the first in the list of a law.
    pub(super) fn condition_number_at_rest(
        &mut self,
        delassus: &Delassus,
        static_traction: &[f64],
        start: &PreviousContacts,
        laws: &[Box<dyn InterfaceLaw>],
    ) -> LawResult<f64> {
        let input = ContactInput {
            delassus,
            free_jump: static_traction,
            static_traction,
            start,
            laws,
            length_scale: 0.0,
            bonds: &[],
            trial_lines: &[],
            frictionless: false,
        };
        for (e, conditions) in self.conditions.iter_mut().enumerate() {
            let rest_mode = input.law(e).modes().first().copied().unwrap_or(Mode::Stick);
            *conditions = input.conditions(e, rest_mode)?;
        }
        let is_regular = self.assemble(&input, false);
        self.has_valid_factor = false;
        if !is_regular {
            return Ok(f64::INFINITY);
        }
        // The condition estimate scales by the diagonal itself, so the row scaling is undone.
        let order = self.dofs.len();
        for (values, row) in self.matrix.chunks_exact_mut(order.max(1)).zip(&self.rows) {
            for value in values {
                *value /= row.scale;
            }
        }
        Ok(dense_condition(&self.matrix, order))
    }

    /// Solves the linear system that `modes` define; `false` if it is singular.
    ///
    /// # Errors
    /// If a law returns a number that is not finite.
    pub(super) fn solve_for_modes(
        &mut self,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> LawResult<bool> {
        for (e, &mode) in modes.iter().enumerate() {
            self.conditions[e] = input.conditions(e, mode)?;
        }
        let is_factored = self.has_valid_factor
            && self.conditions.iter().zip(&self.factored_conditions).all(|(a, b)| {
                have_equal_coefficients(&a[0], &b[0]) && have_equal_coefficients(&a[1], &b[1])
            });
        if is_factored {
            self.reset_rows();
        } else {
            let has_curve = (0..modes.len()).any(|e| self.yields_with_hardening(e, modes[e]));
            let is_updated = has_curve && self.update_rows(input);
            if !is_updated && !self.assemble(input, has_curve) {
                self.has_valid_factor = false;
                return Ok(false);
            }
        }
        self.is_factor_of_step = true;
        self.solve(input);
        self.response.evaluate(input);
        Ok(self.response.traction.iter().all(|t| t.is_finite()))
    }

    /// Factors the reduced system: of the conditions that do not fix a component alone.
    ///
    /// `has_curve`: whether the pressure of an element is a curve over its settlement.
    ///
    /// Returns `false` if the system is singular.
    fn assemble(&mut self, input: &ContactInput<'_>, has_curve: bool) -> bool {
        self.list_rows_and_dofs();
        let order = self.dofs.len();
        if self.rows.len() != order || !self.fill_matrix(input) {
            return false;
        }
        self.factored_conditions.copy_from_slice(&self.conditions);
        self.updates.begin_matrix();
        // Laws without a curve keep their rounding errors.
        self.has_valid_factor = if has_curve && order <= MAX_SMALL_ORDER {
            self.factor.factor_small(&self.matrix, order)
        } else {
            self.factor.factor(&self.matrix, order)
        };
        self.has_valid_factor
    }

    /// Makes the rows those of the factored matrix.
    fn reset_rows(&mut self) {
        self.updates.clear();
        self.rows.iter_mut().for_each(|row| row.scale = row.factored_scale);
    }

    /// Changes a few rows of the factored matrix to those of the present conditions, if a pressure is a curve.
    ///
    /// Returns `false` if the system has other unknowns, if the factors may be those of an earlier step, or if a
    /// factorization serves better.
    fn update_rows(&mut self, input: &ContactInput<'_>) -> bool {
        if !(self.has_valid_factor && self.is_factor_of_step) {
            return false;
        }
        if self.count_changed_rows().is_none_or(|count| count > MAX_CHANGED_ROWS) {
            return false;
        }
        self.reset_rows();
        let size = self.response.layout.len();
        let Self { conditions, factored_conditions, rows, dofs, .. } = self;
        for (k, row) in rows.iter_mut().enumerate() {
            let condition = &conditions[row.element][row.condition];
            let factored_condition = &factored_conditions[row.element][row.condition];
            if have_equal_coefficients(condition, factored_condition) {
                continue;
            }
            self.changed_row.clear();
            let Some(scale) =
                row.append(condition, input.delassus, size, dofs, &mut self.changed_row)
            else {
                return false;
            };
            row.scale = scale;
            let factored_row = &self.matrix[k * dofs.len()..];
            for (value, factored) in self.changed_row.iter_mut().zip(factored_row) {
                *value -= factored;
            }
            if !self.updates.change_row(&mut self.factor, k, &self.changed_row) {
                return false;
            }
        }
        true
    }

    /// Number of rows whose coefficients differ from the factored ones; `None` if the unknowns differ.
    fn count_changed_rows(&self) -> Option<usize> {
        let mut count = 0;
        let present = self.conditions.iter().flatten();
        for (condition, factored) in present.zip(self.factored_conditions.iter().flatten()) {
            if have_equal_coefficients(condition, factored) {
                continue;
            }
            let fixed_component = condition.fixed_component();
            if fixed_component != factored.fixed_component() {
                return None;
            }
            count += usize::from(fixed_component.is_none());
        }
        Some(count)
    }

    /// Lists the rows of the reduced system, and its degrees of freedom.
    fn list_rows_and_dofs(&mut self) {
        self.rows.clear();
        self.dofs.clear();
        for (element, element_conditions) in self.conditions.iter().enumerate() {
            let fixed_components = element_conditions.map(|condition| condition.fixed_component());
            let mut columns = [None; COMPONENTS_IN_PLANE];
            for (component, column) in columns.iter_mut().enumerate() {
                if !fixed_components.contains(&Some(component)) {
                    *column = Some(self.dofs.len());
                    self.dofs.push(self.response.layout.index_of(component, element));
                }
            }
            let places = self.response.layout.indices_of(element);
            for (condition, fixed_component) in fixed_components.iter().enumerate() {
                if fixed_component.is_none() {
                    self.rows.push(ReducedRow::new(element, condition, places, columns));
                }
            }
        }
    }

    /// Computes the matrix of the reduced system with scaled rows.
    ///
    /// Returns `false` if a row is zero or not finite.
    fn fill_matrix(&mut self, input: &ContactInput<'_>) -> bool {
        let size = self.response.layout.len();
        let Self { conditions, rows, dofs, matrix, .. } = self;
        matrix.clear();
        for row in rows {
            let condition = &conditions[row.element][row.condition];
            let Some(scale) = row.append(condition, input.delassus, size, dofs, matrix) else {
                return false;
            };
            row.scale = scale;
            row.factored_scale = scale;
        }
        true
    }

    /// Computes tractions with the stored factors.
    fn solve(&mut self, input: &ContactInput<'_>) {
        let ContactResponse { layout, traction, jump, .. } = &mut self.response;
        traction.fill(0.0);
        for (e, element_conditions) in self.conditions.iter().enumerate() {
            for condition in element_conditions {
                if let Some(component) = condition.fixed_component() {
                    let i = layout.index_of(component, e);
                    let total_traction = condition.value / (condition.pressure + condition.shear);
                    traction[i] = total_traction - input.static_traction[i];
                }
            }
        }
        // Gaps and slips of the other components due to the fixed tractions.
        jump.copy_from_slice(input.free_jump);
        if self.dofs.len() < layout.len() {
            input.delassus.multiply_add(traction, jump);
        }
        self.rhs.clear();
        for row in &self.rows {
            let condition = self.conditions[row.element][row.condition];
            let [n, t] = layout.indices_of(row.element);
            let fixed_traction_term = condition.gap * jump[n] - condition.slip * jump[t]
                + condition.pressure * (input.static_traction[n] + traction[n])
                + condition.shear * (input.static_traction[t] + traction[t]);
            self.rhs.push(row.scale * (condition.value - fixed_traction_term));
        }
        self.factor.solve_small(&mut self.rhs);
        self.updates.correct(&mut self.rhs);
        for (&i, value) in self.dofs.iter().zip(&self.rhs) {
            traction[i] = *value;
        }
    }

    /// Corrects the last solution for the present lines of yielding elements, which have only shifted.
    ///
    /// `modes`: of the last solution.
    pub(super) fn correct(&mut self, input: &ContactInput<'_>, modes: &[Mode]) {
        self.rhs.clear();
        for row in &self.rows {
            let condition = &mut self.conditions[row.element][row.condition];
            let mut change = 0.0;
            if row.condition == 0
                && modes[row.element].is_yield()
                && let Some(line) = input.trial_lines.get(row.element).map(Cell::get)
                && line.slope > 0.0
            {
                change = line.value() - condition.value;
                condition.value = line.value();
            }
            self.rhs.push(row.scale * change);
        }
        self.factor.solve_small(&mut self.rhs);
        self.updates.correct(&mut self.rhs);
        for (&i, change) in self.dofs.iter().zip(&self.rhs) {
            self.response.traction[i] += change;
        }
        self.response.evaluate(input);
    }

    /// Whether an element yields in `mode`, and its pressure grows with the settlement.
    ///
    /// `mode`: of the last solution.
    pub(super) fn yields_with_hardening(&self, element: usize, mode: Mode) -> bool {
        mode.is_yield() && self.conditions[element][0].gap != 0.0
    }

    /// Tolerance of comparisons, from the rounding of the last solution.
    pub(super) fn tolerance(&self, input: &ContactInput<'_>) -> Tolerance {
        let response = &self.response;
        let mut max_pressure = 0.0_f64;
        let mut max_shear = largest(input.static_traction);
        for state in &response.states {
            max_pressure = max_pressure.max(state.pressure.abs());
            max_shear = max_shear.max(state.shear.abs());
        }
        let max_traction = max_pressure.max(max_shear);
        let max_jump = input.length_scale.max(largest(&response.jump));
        Tolerance {
            length: JUMP_ROUNDING_FACTOR * max_jump,
            traction: TRACTION_ROUNDING_FACTOR * max_traction,
        }
    }
}

/// Whether two conditions have equal coefficients; their values may differ.
fn have_equal_coefficients(a: &Condition, b: &Condition) -> bool {
    (a.gap, a.slip, a.pressure, a.shear) == (b.gap, b.slip, b.pressure, b.shear)
}
