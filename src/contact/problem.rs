//! The contact problem of a step, condensed to the tractions of the elements.
//!
//! | symbol | meaning |
//! |---|---|
//! | W | Delassus operator: jump (soil − structure, normal components down) per unit traction |
//! | j₀ | jump at the end of the step if tractions stayed at their static values |
//! | τ | change of traction from the static state |
//!
//! jump = j₀ + W τ. Its normal components are gaps. The slip of the structure is minus its tangential
//! components.

use super::delassus::Delassus;
use crate::error::{Error, LawError};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::interface::{
    Condition, ContactState, InterfaceLaw, Mode, PreviousContact, PreviousContacts, Tolerance,
    law_of,
};
use crate::linalg::{DenseFactor, dense_condition, largest};

/// State of an element's bond in the search for the modes of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bond {
    /// No bond, or the search does not distinguish bonds: the law decides.
    Free,
    /// The bond holds the element in its mode of rest at any traction.
    Intact,
    /// The bond has broken in this step.
    Broken,
}

/// Data of a step for the contact problem.
#[derive(Clone, Copy)]
pub(crate) struct ContactInput<'a> {
    /// W, square, row-major.
    pub(crate) delassus: &'a Delassus,
    /// j₀, one number for each contact component.
    pub(crate) free_jump: &'a [f64],
    /// Static tractions, Pa, one for each contact component.
    pub(crate) static_traction: &'a [f64],
    /// Contact of each element at the end of the previous step.
    pub(crate) start: &'a PreviousContacts,
    /// One law for all elements, or one each.
    pub(crate) laws: &'a [Box<dyn InterfaceLaw>],
    /// Largest displacement in j₀, m; its rounding limits the gaps that can be distinguished.
    pub(crate) length_scale: f64,
    /// Bonds, one per element; empty if all are free.
    pub(crate) bonds: &'a [Bond],
    /// In plan, whether friction and cohesion are left out, as while the weight comes on.
    pub(crate) frictionless: bool,
}

impl ContactInput<'_> {
    /// The law of an element.
    pub(crate) fn law(&self, element: usize) -> &dyn InterfaceLaw {
        law_of(self.laws, element)
    }

    /// Bond of an element.
    pub(super) fn bond(&self, element: usize) -> Bond {
        self.bonds.get(element).copied().unwrap_or(Bond::Free)
    }

    /// Start of the step as an element's law receives it: without a bond that breaks in the step.
    #[inline]
    pub(super) fn start_of(&self, element: usize) -> PreviousContact<'_> {
        let mut start = self.start.element(element);
        start.has_opened |= self.bond(element) == Bond::Broken;
        start
    }

    /// Modes allowed for an element.
    pub(super) fn modes(&self, element: usize) -> &[Mode] {
        let modes = self.law(element).modes();
        if self.bond(element) == Bond::Intact { &modes[..1] } else { modes }
    }

    /// Conditions of the element's law in `mode`, all finite.
    #[inline]
    pub(super) fn conditions(
        &self,
        element: usize,
        mode: Mode,
    ) -> Result<[Condition; 2], LawError> {
        let law = self.law(element);
        let start = self.start_of(element);
        let pair = law.conditions(mode, &start);
        // A value is not finite, or the sum overflows.
        if !(pair[0].sum() + pair[1].sum()).is_finite()
            && let Some((quantity, value)) = pair.iter().find_map(Condition::not_finite)
        {
            return Err(match law.check_start(&start) {
                Ok(()) => LawError::not_finite(element, mode.word(), quantity, value),
                Err(reason) => LawError { element, mode: mode.word(), reason: Box::new(reason) },
            });
        }
        Ok(pair)
    }

    /// Next mode from the element's law, which must be a mode of this law.
    pub(super) fn next_mode(
        &self,
        element: usize,
        mode: Mode,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Result<Mode, LawError> {
        if self.bond(element) == Bond::Intact {
            return Ok(mode);
        }
        let law = self.law(element);
        let next = law.next_mode(mode, &self.start_of(element), trial, tolerance);
        if next == mode || law.modes().contains(&next) {
            return Ok(next);
        }
        let known = law.modes().iter().map(|mode| mode.word());
        let reason = Box::new(Error::no_name("next mode in the law's `modes`", next.word(), known));
        Err(LawError { element, mode: mode.word(), reason })
    }

    /// Traction by which a trial exceeds the strength of an element's bond; `None` without a bond.
    pub(super) fn overload(
        &self,
        element: usize,
        trial: &ContactState,
    ) -> Result<Option<f64>, LawError> {
        match self.law(element).bond_overload(&self.start_of(element), trial) {
            Some(value) if !value.is_finite() => {
                let mode = self.law(element).modes()[0];
                let quantity = "overload of the bond";
                Err(LawError::not_finite(element, mode.word(), quantity, value))
            }
            overload => Ok(overload),
        }
    }
}

/// Solves the contact problem for fixed modes; stores the factors while the modes stay the same.
pub(crate) struct ContactSolver {
    layout: ContactLayout,
    /// Conditions of the last trial, two per element.
    conditions: Vec<[Condition; 2]>,
    /// The conditions whose factors are stored; the values of these conditions do not matter.
    factored: Vec<[Condition; 2]>,
    factor: DenseFactor,
    has_valid_factor: bool,
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    /// For each row of the reduced system: element, number of its condition (0 or 1), and the row's scale.
    rows: Vec<(usize, usize, f64)>,
    /// Contact components of the reduced system; every other component is fixed by one condition alone.
    dofs: Vec<usize>,
    /// Change of traction of the last trial, Pa, for each contact component.
    pub(crate) traction: Vec<f64>,
    /// Opening and total traction of the last trial, per element.
    pub(crate) states: Vec<ContactState>,
    jump: Vec<f64>,
    /// Smallest friction coefficient that replaced the law's larger one on a sliding element; `None` if none was
    /// replaced.
    pub(crate) substituted_friction: Option<f64>,
    /// Error of a law that returned a number that is not finite, since the last `take`.
    pub(super) fault: Option<LawError>,
    /// Number of factorings so far.
    pub(crate) factorings: usize,
    /// Number of times that W has changed.
    pub(super) generation: usize,
}

impl ContactSolver {
    pub(crate) fn new(layout: ContactLayout) -> Self {
        let size = layout.len();
        let count = layout.elements();
        // In plan the search has its own system.
        let system = if layout.components() == COMPONENTS_IN_PLANE { size } else { 0 };
        Self {
            layout,
            conditions: vec![[Condition::default(); 2]; count],
            factored: vec![[Condition::default(); 2]; count],
            factor: DenseFactor::with_capacity(system),
            has_valid_factor: false,
            matrix: Vec::with_capacity(system * system),
            rhs: Vec::with_capacity(size),
            rows: Vec::with_capacity(size),
            dofs: Vec::with_capacity(size),
            traction: vec![0.0; size],
            states: vec![ContactState::default(); count],
            jump: vec![0.0; size],
            substituted_friction: None,
            fault: None,
            factorings: 0,
            generation: 0,
        }
    }

    /// Whether the problem has a ground in plan.
    pub(super) fn is_plan(&self) -> bool {
        self.layout.components() != COMPONENTS_IN_PLANE
    }

    /// Discards the factors; call this when W has changed.
    pub(crate) fn invalidate(&mut self) {
        self.has_valid_factor = false;
        self.generation += 1;
    }

    /// Condition number of the system with every element in its law's mode of rest; infinite if singular.
    pub(crate) fn condition_at_rest(
        &mut self,
        delassus: &Delassus,
        static_traction: &[f64],
        start: &PreviousContacts,
        laws: &[Box<dyn InterfaceLaw>],
    ) -> Result<f64, LawError> {
        if self.is_plan() {
            return Ok(delassus.condition(self.layout.len()));
        }
        let input = ContactInput {
            delassus,
            free_jump: static_traction,
            static_traction,
            start,
            laws,
            length_scale: 0.0,
            bonds: &[],
            frictionless: false,
        };
        for (e, conditions) in self.conditions.iter_mut().enumerate() {
            let at_rest = input.law(e).modes().first().copied().unwrap_or(Mode::Stick);
            *conditions = input.conditions(e, at_rest)?;
        }
        let regular = self.assemble(&input);
        self.has_valid_factor = false;
        self.factorings = 0;
        if !regular {
            return Ok(f64::INFINITY);
        }
        // The condition number scales by the diagonal. The scaling of rows by their largest entries is
        // therefore undone.
        let order = self.dofs.len();
        for (row, &(_, _, scale)) in self.matrix.chunks_exact_mut(order.max(1)).zip(&self.rows) {
            for value in row {
                *value /= scale;
            }
        }
        Ok(dense_condition(&self.matrix, order))
    }

    /// Solves the linear system that `modes` define; false if it is singular, or if a law returned an error.
    pub(crate) fn trial(&mut self, input: &ContactInput<'_>, modes: &[Mode]) -> bool {
        for (e, &mode) in modes.iter().enumerate() {
            match input.conditions(e, mode) {
                Ok(pair) => self.conditions[e] = pair,
                Err(fault) => {
                    self.fault = Some(fault);
                    return false;
                }
            }
        }
        let unchanged = self.has_valid_factor
            && self
                .conditions
                .iter()
                .zip(&self.factored)
                .all(|(a, b)| has_same_row(&a[0], &b[0]) && has_same_row(&a[1], &b[1]));
        if !unchanged && !self.assemble(input) {
            self.has_valid_factor = false;
            return false;
        }
        self.solve(input);
        self.evaluate(input);
        self.traction.iter().all(|t| t.is_finite())
    }

    /// Separates conditions that fix one component from the others, and factors the system of the others.
    fn assemble(&mut self, input: &ContactInput<'_>) -> bool {
        let layout = self.layout;
        let size = self.layout.len();
        self.rows.clear();
        self.dofs.clear();
        for (e, pair) in self.conditions.iter().enumerate() {
            let fixed = pair.map(|condition| condition.fixed_component());
            for component in 0..COMPONENTS_IN_PLANE {
                if !fixed.contains(&Some(component)) {
                    self.dofs.push(layout.place(component, e));
                }
            }
            for (which, fixed) in fixed.iter().enumerate() {
                if fixed.is_none() {
                    self.rows.push((e, which, 1.0));
                }
            }
        }
        let order = self.dofs.len();
        if self.rows.len() != order {
            return false;
        }
        self.matrix.clear();
        for (e, which, scale) in &mut self.rows {
            let condition = self.conditions[*e][*which];
            let [normal, tangential] = layout.places(*e);
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
            let row = &mut self.matrix[begin..];
            let largest = largest(row);
            if !(largest > 0.0 && largest.is_finite()) {
                return false;
            }
            *scale = 1.0 / largest;
            for value in row {
                *value *= *scale;
            }
        }
        self.factorings += 1;
        self.factored.copy_from_slice(&self.conditions);
        self.has_valid_factor = self.factor.factor(&self.matrix, order);
        self.has_valid_factor
    }

    /// Computes tractions with the stored factors.
    fn solve(&mut self, input: &ContactInput<'_>) {
        let layout = self.layout;
        self.traction.fill(0.0);
        for (e, pair) in self.conditions.iter().enumerate() {
            for condition in pair {
                if let Some(component) = condition.fixed_component() {
                    let i = layout.place(component, e);
                    let total = condition.value / (condition.pressure + condition.shear);
                    self.traction[i] = total - input.static_traction[i];
                }
            }
        }
        // Gaps and slips of the other components due to the fixed tractions.
        self.jump.copy_from_slice(input.free_jump);
        if self.dofs.len() < layout.len() {
            input.delassus.multiply_add(&self.traction, &mut self.jump);
        }
        self.rhs.clear();
        for &(e, which, scale) in &self.rows {
            let condition = self.conditions[e][which];
            let [n, t] = layout.places(e);
            let known = condition.gap * self.jump[n] - condition.slip * self.jump[t]
                + condition.pressure * (input.static_traction[n] + self.traction[n])
                + condition.shear * (input.static_traction[t] + self.traction[t]);
            self.rhs.push(scale * (condition.value - known));
        }
        self.factor.solve_small(&mut self.rhs);
        for (&i, value) in self.dofs.iter().zip(&self.rhs) {
            self.traction[i] = *value;
        }
    }

    /// Computes jumps and states from the tractions of the last trial.
    pub(crate) fn evaluate(&mut self, input: &ContactInput<'_>) {
        self.evaluate_by(input, |traction, jump| input.delassus.multiply_add(traction, jump));
    }

    /// Computes jumps and states, with `multiply_add` for jump ← jump + W τ.
    pub(super) fn evaluate_by(
        &mut self,
        input: &ContactInput<'_>,
        multiply_add: impl FnOnce(&[f64], &mut [f64]),
    ) {
        self.jump.copy_from_slice(input.free_jump);
        multiply_add(&self.traction, &mut self.jump);
        let layout = self.layout;
        let plan = self.is_plan();
        let Self { jump, traction, states, .. } = self;
        for (e, state) in states.iter_mut().enumerate() {
            let place = |component| layout.place(component, e);
            let total = |i: usize| input.static_traction[i] + traction[i];
            *state = ContactState::from_components(|k| jump[place(k)], |k| total(place(k)), plan);
        }
    }

    /// Tolerance of comparisons, from the rounding of the last trial.
    pub(crate) fn tolerance(&self, input: &ContactInput<'_>) -> Tolerance {
        let traction = self
            .states
            .iter()
            .map(|s| s.pressure.abs().max(s.shear.abs()))
            .chain(input.static_traction.iter().map(|t| t.abs()))
            .fold(0.0, f64::max);
        let jump = self.jump.iter().fold(input.length_scale, |m, j| m.max(j.abs()));
        Tolerance { length: 1e-13 * jump, traction: 1e-12 * traction }
    }
}

/// Whether two conditions differ at most in their values.
fn has_same_row(a: &Condition, b: &Condition) -> bool {
    (a.gap, a.slip, a.pressure, a.shear) == (b.gap, b.slip, b.pressure, b.shear)
}
