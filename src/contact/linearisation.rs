//! Settlements at which laws are linearised whose pressure is a curve over the settlement of yielding soil.
//!
//! | symbol | meaning |
//! |---|---|
//! | v | settlement of an element in the step, m |
//! | p(v) | pressure of its law's curve, which rises at a falling slope, Pa |
//! | ρ | reciprocal of the element's compliance with all other tractions fixed, Pa/m |
//!
//! A step is solved with the tangent of each curve at a trial settlement. A tangent lies above its curve, so the solution
//! has too much pressure and too little settlement. The next trial settlement solves each element alone: its line
//! p + ρ v = constant through the solution meets the curve there. Newton's direction is one of descent for the energy of a
//! step, which is convex without friction; shorter steps therefore converge where whole ones do not.

use super::problem::ContactInput;
use crate::error::{LawError, StepError};
use crate::interface::Limits;

/// Distance from the curve at which a pressure is accepted, relative to the pressure.
const CURVE_TOLERANCE: f64 = 1e-9;
/// Largest number of linearisations of a step.
const MAX_LINEARISATIONS: usize = 80;
/// Number of linearisations after which steps are halved.
const WHOLE_STEPS: usize = 15;
/// Largest number of tangents in the solution of one element: a curve that bends within 1e-12 of the settlement takes 40.
const MAX_LOCAL_TANGENTS: usize = 60;
/// Relative change of a settlement that ends the solution of one element: the other elements still move.
const LOCAL_TOLERANCE: f64 = 1e-3;

/// Solution of an element with the tangent of its law.
#[derive(Debug, Clone, Copy)]
pub(super) struct TangentSolution {
    pub(super) element: usize,
    pub(super) pressure: f64,
    /// v; below zero if the element is open.
    pub(super) settlement: f64,
    pub(super) yields: bool,
    /// ρ.
    pub(super) stiffness: f64,
    /// Error of the pressure, Pa, and of the settlement, m, with which solutions are accepted.
    pub(super) pressure_rounding: f64,
    pub(super) settlement_rounding: f64,
}

/// Distance from the curves of the worst element, and how often the step has been linearised.
pub(super) struct Linearisation {
    count: usize,
    worst: Option<(usize, f64)>,
}

impl Linearisation {
    pub(super) fn new() -> Self {
        Self { count: 0, worst: None }
    }

    /// Begins to compare the solution of the present tangents with the curves.
    pub(super) fn begin(&mut self) {
        self.count += 1;
        self.worst = None;
    }

    /// Compares a solution with the curve; returns the next trial settlement of its element, m, unless it is near enough.
    ///
    /// `trial_settlement`: the present one.
    pub(super) fn compare(
        &mut self,
        input: &ContactInput<'_>,
        solution: &TangentSolution,
        trial_settlement: f64,
    ) -> Result<Option<f64>, LawError> {
        let &TangentSolution { element, pressure, yields, .. } = solution;
        let present = if yields { solution.settlement.max(0.0) } else { 0.0 };
        let limits = input.limits(element, present)?;
        let Limits { pressure_cap, hardening, .. } = limits;
        let on_curve = pressure_cap + hardening * present;
        let difference = pressure - on_curve;
        let distance = if yields { difference.abs() } else { difference.max(0.0) };
        let tolerance = CURVE_TOLERANCE * on_curve.max(pressure)
            + solution.pressure_rounding
            + hardening * solution.settlement_rounding;
        if distance <= tolerance {
            return Ok(None);
        }
        let excess = distance / tolerance.max(f64::MIN_POSITIVE);
        if self.worst.is_none_or(|(_, worst)| excess > worst) {
            self.worst = Some((element, excess));
        }
        let next = settlement_on_curve(input, solution, limits, present)?;
        let is_whole = self.count <= WHOLE_STEPS;
        Ok(Some(if is_whole { next } else { 0.5 * (trial_settlement + next) }))
    }

    /// Whether all pressures are on their curves.
    ///
    /// # Errors
    /// If too many linearisations have not brought them there.
    pub(super) fn is_done(&self) -> Result<bool, StepError> {
        match self.worst {
            None => Ok(true),
            Some((element, excess)) if self.count >= MAX_LINEARISATIONS => {
                let residual = CURVE_TOLERANCE * excess;
                let elements = vec![element];
                Err(StepError::Cone { iterations: self.count, residual, elements })
            }
            Some(_) => Ok(false),
        }
    }
}

/// The settlement at which the line p + ρ v = constant through a solution meets the law's curve; zero below it.
///
/// `limits`: the tangent at a settlement `begin`.
pub(super) fn settlement_on_curve(
    input: &ContactInput<'_>,
    solution: &TangentSolution,
    mut limits: Limits,
    begin: f64,
) -> Result<f64, LawError> {
    let &TangentSolution { element, pressure, settlement, stiffness, .. } = solution;
    let trial = pressure + stiffness * settlement;
    let mut found = begin;
    for _ in 0..MAX_LOCAL_TANGENTS {
        let Limits { pressure_cap, hardening, .. } = limits;
        let next = ((trial - pressure_cap) / (hardening + stiffness)).max(0.0);
        let change = (next - found).abs();
        found = next;
        if change <= LOCAL_TOLERANCE * found {
            break;
        }
        limits = input.limits(element, found)?;
    }
    Ok(found)
}
