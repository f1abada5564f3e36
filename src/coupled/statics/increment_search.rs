//! Search along the increment between two iterates of Newton's method.
//!
//! | symbol | meaning |
//! |---|---|
//! | u₀, u₁ | the last two iterates, each the solution of a linear step; δ = u₁ − u₀ |
//! | L | force that the linear part of the equation leaves for the nonlinear force, with the contact tractions |
//! | r | out-of-balance force f − L |
//!
//! The tangents of a piecewise linear law can lead Newton's method from one piece to the next and back for ever. L is linear
//! in the displacement and the tractions. Between the iterates it is therefore (1 − s) L₀ + s L₁, and
//!
//! ```text
//! r(s) = f(u₀ + sδ) − (1 − s) L₀ − s L₁
//! ```
//!
//! Pressures and shears on this line satisfy the limits of the interface laws, which are convex. For a force that is the
//! derivative of a convex potential (Iwan's model), r(s)·δ increases with s. If it is negative at s = 0 and positive at
//! s = 1, the full step has passed the minimum of the potential on the line, and the search ends there.

use crate::linalg::dot;

/// Work of the out-of-balance force at which the search ends.
///
/// It is relative to the work at the start of the increment.
const WORK_TOLERANCE: f64 = 1e-3;
/// Largest number of evaluations of the force in a search.
const MAX_EVALUATIONS: usize = 30;

/// The last but one iterate, and the force of the linear part at both iterates.
pub(crate) struct IncrementSearch {
    /// Iterate u₀.
    start: Vec<f64>,
    /// Force L₀ of the linear part.
    start_linear_force: Vec<f64>,
    /// Out-of-balance force r(0).
    start_imbalance: Vec<f64>,
    /// Increment δ.
    increment: Vec<f64>,
    /// Force L₁ of the linear part.
    end_linear_force: Vec<f64>,
}

impl IncrementSearch {
    /// Buffers for this number of degrees of freedom.
    pub(crate) fn new(dofs: usize) -> Self {
        let zeros = vec![0.0; dofs];
        Self {
            start: zeros.clone(),
            start_linear_force: zeros.clone(),
            start_imbalance: zeros.clone(),
            increment: zeros.clone(),
            end_linear_force: zeros,
        }
    }

    /// Stores the start of an increment: an iterate with its forces.
    pub(crate) fn start_at(
        &mut self,
        iterate: &[f64],
        linear_force: &[f64],
        nonlinear_force: &[f64],
    ) {
        self.start.copy_from_slice(iterate);
        self.start_linear_force.copy_from_slice(linear_force);
        let forces = nonlinear_force.iter().zip(linear_force);
        for (imbalance, (f, l)) in self.start_imbalance.iter_mut().zip(forces) {
            *imbalance = f - l;
        }
    }

    /// Moves `iterate` and `linear_force` back to where the out-of-balance force does no work on the increment.
    ///
    /// The arguments have the values at the end of the increment. `evaluate` writes the nonlinear force at its first
    /// argument to its second argument. Its last call is for the result. Nothing changes unless the increment has
    /// passed such a point. Returns the position s of the result on the increment.
    pub(crate) fn search<E>(
        &mut self,
        iterate: &mut [f64],
        linear_force: &mut [f64],
        nonlinear_force: &mut [f64],
        mut evaluate: impl FnMut(&[f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<f64, E> {
        for (increment, (end, start)) in
            self.increment.iter_mut().zip(iterate.iter().zip(&self.start))
        {
            *increment = end - start;
        }
        let start_work = dot(&self.start_imbalance, &self.increment);
        let end_work = work(nonlinear_force, linear_force, &self.increment);
        if !(start_work < 0.0 && end_work > 0.0) {
            return Ok(1.0);
        }
        self.end_linear_force.copy_from_slice(linear_force);
        let mut bracket =
            Bracket { low: (0.0, start_work), high: (1.0, end_work), last_is_low: None };
        let mut s = 1.0;
        for _ in 0..MAX_EVALUATIONS {
            s = bracket.estimate();
            for i in 0..iterate.len() {
                iterate[i] = self.start[i] + s * self.increment[i];
                let start_force = self.start_linear_force[i];
                linear_force[i] = start_force + s * (self.end_linear_force[i] - start_force);
            }
            evaluate(iterate, nonlinear_force)?;
            let work = work(nonlinear_force, linear_force, &self.increment);
            if work.abs() <= -WORK_TOLERANCE * start_work {
                break;
            }
            bracket.narrow(s, work);
        }
        Ok(s)
    }
}

/// Work of the out-of-balance force on an increment.
fn work(nonlinear_force: &[f64], linear_force: &[f64], increment: &[f64]) -> f64 {
    let forces = nonlinear_force.iter().zip(linear_force);
    forces.zip(increment).map(|((f, l), d)| (f - l) * d).sum()
}

/// Interval of an increment with a root of the work, for the Illinois method.
struct Bracket {
    /// Position and work at the lower end.
    low: (f64, f64),
    /// Position and work at the upper end.
    high: (f64, f64),
    /// Whether the last estimate replaced the lower end; `None` before the first.
    last_is_low: Option<bool>,
}

impl Bracket {
    /// Estimate of the root, by the secant of the works at the ends.
    fn estimate(&self) -> f64 {
        let interval = self.high.0 - self.low.0;
        self.low.0 - self.low.1 * interval / (self.high.1 - self.low.1)
    }

    /// Replaces an end by the estimate; the work of an end that stays twice counts half.
    fn narrow(&mut self, estimate: f64, work: f64) {
        let is_low = work < 0.0;
        if is_low {
            self.low = (estimate, work);
        } else {
            self.high = (estimate, work);
        }
        if self.last_is_low == Some(is_low) {
            let other_end = if is_low { &mut self.high } else { &mut self.low };
            other_end.1 *= 0.5;
        }
        self.last_is_low = Some(is_low);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spring with a kink: the search ends beyond the kink, where the forces balance.
    #[test]
    fn search_ends_where_the_force_balances() {
        let law = |u: f64| if u < 0.25 { u } else { 0.25 + 40.0 * (u - 0.25) };
        let mut search = IncrementSearch::new(1);
        // L = 0.85 − 2u: balance at u = 0.25 + 0.1/42.
        let linear_part = |u: f64| 0.85 - 2.0 * u;
        search.start_at(&[0.0], &[linear_part(0.0)], &[law(0.0)]);
        let mut iterate = [1.0];
        let mut linear_force = [linear_part(1.0)];
        let mut nonlinear_force = [law(1.0)];
        let mut count = 0;
        search
            .search::<()>(&mut iterate, &mut linear_force, &mut nonlinear_force, |u, f| {
                count += 1;
                f[0] = law(u[0]);
                Ok(())
            })
            .unwrap();
        let balance = 0.25 + 0.1 / 42.0;
        assert!((iterate[0] - balance).abs() < 1e-3, "{} {balance}", iterate[0]);
        assert!((linear_force[0] - linear_part(iterate[0])).abs() < 1e-12);
        assert!(nonlinear_force[0] == law(iterate[0]) && count < MAX_EVALUATIONS, "{count}");
        // An increment that ends before the balance does not change.
        search.start_at(&[0.0], &[linear_part(0.0)], &[law(0.0)]);
        let mut short_iterate = [0.1];
        let mut forces = ([linear_part(0.1)], [law(0.1)]);
        let position = search
            .search::<()>(&mut short_iterate, &mut forces.0, &mut forces.1, |_, _| unreachable!())
            .unwrap();
        assert!(position == 1.0 && short_iterate == [0.1]);
    }
}
