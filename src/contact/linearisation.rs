//! Linearisation of laws whose pressure grows along a curve over the settlement.
//!
//! These are the laws of yielding soil.
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
//!
//! In the plane a line of nearly the same slope takes the place of the tangent: see [`super::trial_line`].

use super::problem::ContactInput;
use super::trial_line::CurvePoint;
use crate::error::{LawError, StepError};
use crate::interface::Limits;

/// Distance from the curve at which a pressure is accepted, relative to the pressure.
///
/// Laws put their state variables on the curve, so that this error does not grow from step to step.
const CURVE_TOLERANCE: f64 = 1e-8;
/// Largest distance from the curve at which the next tangent touches at the solution.
///
/// It is relative to the pressure. At larger distances the element is solved alone.
const SMALL_DISTANCE: f64 = 1e-2;
/// Largest number of linearisations of a step.
const MAX_LINEARISATIONS: usize = 80;
/// Number of linearisations after which steps are halved.
const MAX_WHOLE_STEPS: usize = 15;
/// Largest number of tangents in the solution of one element.
///
/// A curve that bends within 1e-12 of the settlement needs 40.
const MAX_LOCAL_TANGENTS: usize = 60;
/// Relative change of a settlement that ends the solution of one element.
///
/// More exact solutions gain nothing while the other elements still move.
const LOCAL_TOLERANCE: f64 = 3e-2;

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
    /// Error of the pressure in an accepted solution, Pa.
    pub(super) pressure_rounding: f64,
    /// Error of the settlement in an accepted solution, m.
    pub(super) settlement_rounding: f64,
}

/// Number of linearisations of a step, and the element farthest from its curve.
pub(super) struct Linearisation {
    count: usize,
    /// The element farthest from its curve, and its distance relative to the tolerance.
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

    /// Whether the next settlements are taken whole, not halfway.
    pub(super) fn is_whole(&self) -> bool {
        self.count <= MAX_WHOLE_STEPS
    }

    /// Compares a solution with the curve; returns the next point of its element.
    ///
    /// Returns `None` if the solution is near enough. `trial_settlement`: the present one, m.
    pub(super) fn compare(
        &mut self,
        input: &ContactInput<'_>,
        solution: &TangentSolution,
        trial_settlement: f64,
    ) -> Result<Option<CurvePoint>, LawError> {
        let &TangentSolution { element, pressure, yields, .. } = solution;
        let present = if yields { solution.settlement.max(0.0) } else { 0.0 };
        let limits = input.limits(element, present)?;
        let mut next = CurvePoint::new(present, &limits);
        let CurvePoint { pressure: on_curve, hardening, .. } = next;
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
        if distance > SMALL_DISTANCE * on_curve {
            next = point_on_curve(input, solution, limits)?;
        }
        if !self.is_whole() {
            next.settlement = 0.5 * (trial_settlement + next.settlement);
        }
        Ok(Some(next))
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

/// Point of the law's curve for an element that is solved alone.
///
/// There the line p + ρ v = constant through the solution meets the curve. The settlement is not below zero.
/// `limits`: a tangent of the curve.
pub(super) fn point_on_curve(
    input: &ContactInput<'_>,
    solution: &TangentSolution,
    mut limits: Limits,
) -> Result<CurvePoint, LawError> {
    let &TangentSolution { element, pressure, settlement, stiffness, .. } = solution;
    let trial = pressure + stiffness * settlement;
    let mut found = f64::INFINITY;
    for _ in 0..MAX_LOCAL_TANGENTS {
        let Limits { pressure_cap, hardening, .. } = limits;
        let next = ((trial - pressure_cap) / (hardening + stiffness)).max(0.0);
        let change = (next - found).abs();
        found = next;
        limits = input.limits(element, found)?;
        if change <= LOCAL_TOLERANCE * found {
            break;
        }
    }
    Ok(CurvePoint::new(found, &limits))
}
