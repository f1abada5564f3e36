//! The contact problem in the plane with the mode of every element fixed: a linear system.

use super::delassus::Delassus;
use super::problem::ContactInput;
use super::response::ContactResponse;
use crate::error::LawError;
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::interface::{Condition, InterfaceLaw, Mode, PreviousContacts, Tolerance};
use crate::linalg::{DenseFactor, dense_condition, largest};

/// Solver for fixed modes in the plane; it stores the factors while the modes stay the same.
pub(super) struct FixedModeSolver {
    /// Tractions, jumps and states of the last trial.
    pub(super) response: ContactResponse,
    /// Conditions of the last trial, two per element.
    conditions: Vec<[Condition; 2]>,
    /// The conditions whose factors are stored; the values of these conditions do not matter.
    factored: Vec<[Condition; 2]>,
    factor: DenseFactor,
    has_valid_factor: bool,
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    rows: Vec<ReducedRow>,
    /// Contact components of the reduced system; every other component is fixed by one condition alone.
    dofs: Vec<usize>,
}

/// Row of the reduced system.
struct ReducedRow {
    element: usize,
    /// Number of the element's condition, 0 or 1.
    condition: usize,
    /// Factor that makes the largest entry of the row 1.
    scale: f64,
}

impl FixedModeSolver {
    /// Solver for `count` elements.
    pub(super) fn new(count: usize) -> Self {
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, count);
        let size = layout.len();
        Self {
            response: ContactResponse::new(layout),
            conditions: vec![[Condition::default(); 2]; count],
            factored: vec![[Condition::default(); 2]; count],
            factor: DenseFactor::with_capacity(size),
            has_valid_factor: false,
            matrix: Vec::with_capacity(size * size),
            rhs: Vec::with_capacity(size),
            rows: Vec::with_capacity(size),
            dofs: Vec::with_capacity(size),
        }
    }

    /// Discards the factors; call this when W has changed.
    pub(super) fn invalidate(&mut self) {
        self.has_valid_factor = false;
    }

    /// Condition number of the system with every element in its law's mode of rest; infinite if singular.
    pub(super) fn condition_at_rest(
        &mut self,
        delassus: &Delassus,
        static_traction: &[f64],
        start: &PreviousContacts,
        laws: &[Box<dyn InterfaceLaw>],
    ) -> Result<f64, LawError> {
        let input = ContactInput {
            delassus,
            free_jump: static_traction,
            static_traction,
            start,
            laws,
            length_scale: 0.0,
            bonds: &[],
            trial_settlements: &[],
            frictionless: false,
        };
        for (e, conditions) in self.conditions.iter_mut().enumerate() {
            let at_rest = input.law(e).modes().first().copied().unwrap_or(Mode::Stick);
            *conditions = input.conditions(e, at_rest)?;
        }
        let is_regular = self.assemble(&input);
        self.has_valid_factor = false;
        if !is_regular {
            return Ok(f64::INFINITY);
        }
        // The condition number scales by the diagonal. The scaling of rows by their largest entries is
        // therefore undone.
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
    pub(super) fn trial(
        &mut self,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> Result<bool, LawError> {
        for (e, &mode) in modes.iter().enumerate() {
            self.conditions[e] = input.conditions(e, mode)?;
        }
        let is_factored = self.has_valid_factor
            && self
                .conditions
                .iter()
                .zip(&self.factored)
                .all(|(a, b)| has_same_row(&a[0], &b[0]) && has_same_row(&a[1], &b[1]));
        if !is_factored && !self.assemble(input) {
            self.has_valid_factor = false;
            return Ok(false);
        }
        self.solve(input);
        self.response.evaluate(input);
        Ok(self.response.traction.iter().all(|t| t.is_finite()))
    }

    /// Separates conditions that fix one component from the others, and factors the system of the others.
    ///
    /// Returns `false` if the system is singular.
    fn assemble(&mut self, input: &ContactInput<'_>) -> bool {
        self.list_rows_and_dofs();
        let order = self.dofs.len();
        if self.rows.len() != order || !self.fill_matrix(input) {
            return false;
        }
        self.factored.copy_from_slice(&self.conditions);
        self.has_valid_factor = self.factor.factor(&self.matrix, order);
        self.has_valid_factor
    }

    /// Lists the rows of the reduced system, and its degrees of freedom.
    fn list_rows_and_dofs(&mut self) {
        self.rows.clear();
        self.dofs.clear();
        for (element, pair) in self.conditions.iter().enumerate() {
            let fixed = pair.map(|condition| condition.fixed_component());
            for component in 0..COMPONENTS_IN_PLANE {
                if !fixed.contains(&Some(component)) {
                    self.dofs.push(self.response.layout.place(component, element));
                }
            }
            for (condition, fixed) in fixed.iter().enumerate() {
                if fixed.is_none() {
                    self.rows.push(ReducedRow { element, condition, scale: 1.0 });
                }
            }
        }
    }

    /// Computes the matrix of the reduced system with scaled rows; `false` if a row is zero or not finite.
    fn fill_matrix(&mut self, input: &ContactInput<'_>) -> bool {
        let layout = self.response.layout;
        let size = layout.len();
        self.matrix.clear();
        for row in &mut self.rows {
            let condition = self.conditions[row.element][row.condition];
            let [normal, tangential] = layout.places(row.element);
            let begin = self.matrix.len();
            for &j in &self.dofs {
                let mut value = condition.gap * input.delassus[normal * size + j]
                    - condition.slip * input.delassus[tangential * size + j];
                if j == normal {
                    value += condition.pressure;
                } else if j == tangential {
                    value += condition.shear;
                }
                self.matrix.push(value);
            }
            let values = &mut self.matrix[begin..];
            let largest = largest(values);
            if !(largest > 0.0 && largest.is_finite()) {
                return false;
            }
            row.scale = 1.0 / largest;
            for value in values {
                *value *= row.scale;
            }
        }
        true
    }

    /// Computes tractions with the stored factors.
    fn solve(&mut self, input: &ContactInput<'_>) {
        let ContactResponse { layout, traction, jump, .. } = &mut self.response;
        traction.fill(0.0);
        for (e, pair) in self.conditions.iter().enumerate() {
            for condition in pair {
                if let Some(component) = condition.fixed_component() {
                    let i = layout.place(component, e);
                    let total = condition.value / (condition.pressure + condition.shear);
                    traction[i] = total - input.static_traction[i];
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
            let [n, t] = layout.places(row.element);
            let fixed_part = condition.gap * jump[n] - condition.slip * jump[t]
                + condition.pressure * (input.static_traction[n] + traction[n])
                + condition.shear * (input.static_traction[t] + traction[t]);
            self.rhs.push(row.scale * (condition.value - fixed_part));
        }
        self.factor.solve_small(&mut self.rhs);
        for (&i, value) in self.dofs.iter().zip(&self.rhs) {
            traction[i] = *value;
        }
    }

    /// Whether an element yields in a `mode` of the last trial on soil whose pressure grows with the settlement.
    pub(super) fn hardens(&self, element: usize, mode: Mode) -> bool {
        mode.is_yield() && self.conditions[element][0].gap != 0.0
    }

    /// Tolerance of comparisons, from the rounding of the last trial.
    pub(super) fn tolerance(&self, input: &ContactInput<'_>) -> Tolerance {
        let traction = self
            .response
            .states
            .iter()
            .map(|state| state.pressure.abs().max(state.shear.abs()))
            .chain(input.static_traction.iter().map(|traction| traction.abs()))
            .fold(0.0, f64::max);
        let jump = self
            .response
            .jump
            .iter()
            .fold(input.length_scale, |largest, jump| largest.max(jump.abs()));
        Tolerance { length: 1e-13 * jump, traction: 1e-12 * traction }
    }
}

/// Whether two conditions differ at most in their values.
fn has_same_row(a: &Condition, b: &Condition) -> bool {
    (a.gap, a.slip, a.pressure, a.shear) == (b.gap, b.slip, b.pressure, b.shear)
}
