//! Winkler's spring bed: a ground without history.

use super::plan::Plan;
use super::{Grading, Ground, NOT_PREPARED, Strip};
use crate::error::{
    CheckpointError, Observer, Result, not_negative, positive, require, same_length,
};
use crate::geometry::{ContactElement, Patch, SPACE};
use crate::structure::Structure;

/// Independent springs and dashpots under each element (Winkler bed).
///
/// Per unit of area, traction = stiffness · s + dashpot · ds/dt in each direction, stepped by a θ rule: θ = ½ (the
/// default) conserves the springs' energy, θ = 1 damps the ringing of a released bed without dashpots. Stiff tangential
/// springs without dashpots keep the sideways speed of a base that lands from a flight: it alternates from step to step.
///
/// ```
/// use basemat::bem::{Ground, SpringGround};
/// let mut bed = SpringGround::new(-2.0..2.0, 4, 20.0e6, 10.0e6)?.with_dashpots(4.0e5, 0.0)?;
/// bed.prepare(1.0e-3, None, &mut basemat::unobserved)?;
/// let mut matrix = vec![0.0; 64];
/// bed.step_compliance(&mut matrix)?;
/// assert!((matrix[0] - 1.0 / (0.5 * 20.0e6 + 4.0e5 / 1.0e-3)).abs() < 1e-18);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SpringGround {
    elements: Patch,
    /// Stiffness downwards, along x and in plan along y, Pa/m.
    stiffness: [f64; SPACE],
    /// Dashpot coefficient downwards, along x and in plan along y, Pa·s/m.
    dashpot: [f64; SPACE],
    theta: f64,
    time_step: f64,
    displacement: Vec<f64>,
}

impl SpringGround {
    /// Bed of `count` equal elements over `range` (m) with normal and tangential stiffness (Pa/m).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for an empty range, no elements, or a stiffness not finite and above zero.
    pub fn new(
        range: std::ops::Range<f64>,
        count: usize,
        normal_stiffness: f64,
        tangential_stiffness: f64,
    ) -> Result<Self> {
        Self::on_strips(&[Strip::uniform(range, count)?], normal_stiffness, tangential_stiffness)
    }

    /// Bed of `count` equal elements under each foundation of `structure`, as wide as the foundation.
    ///
    /// Under a structure with [faces](crate::structure::Base::Faces) it is a bed [in plan](SpringGround::in_plan). It has
    /// `count` cells along the shorter side of all faces together, and the tangential stiffness in both directions.
    ///
    /// # Errors
    /// As for [`Strip::under`] and [`SpringGround::new`], or [`Plan::on_faces`] and [`SpringGround::in_plan`].
    pub fn under(
        structure: &dyn Structure,
        count: usize,
        normal_stiffness: f64,
        tangential_stiffness: f64,
    ) -> Result<Self> {
        if let Some(plan) = Plan::of_base(structure, count, None)? {
            let stiffness = [normal_stiffness, tangential_stiffness, tangential_stiffness];
            return Self::in_plan(plan, stiffness);
        }
        let strips = Strip::under(structure, count, Grading::Uniform)?;
        Self::on_strips(&strips, normal_stiffness, tangential_stiffness)
    }

    /// Bed under several strips, from left to right.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for no strips, [`Error::Input`](crate::Error::Input) for strips that
    /// overlap or are out of order, and as for [`SpringGround::new`].
    pub fn on_strips(
        strips: &[Strip],
        normal_stiffness: f64,
        tangential_stiffness: f64,
    ) -> Result<Self> {
        let elements: Vec<_> = strips.iter().flat_map(Strip::elements).collect();
        Self::bed(elements, [normal_stiffness, tangential_stiffness, tangential_stiffness])
    }

    /// Bed in three dimensions under the contact elements of a [`Plan`].
    ///
    /// `stiffness` (Pa/m) is down, along x and along y. Springs do not interact, so cells end at the outline
    /// ([`Plan::without_overhang`]).
    ///
    /// ```
    /// use basemat::bem::plan::Plan;
    /// use basemat::bem::{Ground, SpringGround};
    /// let mat = Plan::rectangle(-4.0..4.0, -3.0..3.0, 6)?;
    /// let bed = SpringGround::in_plan(mat, [30.0e6, 20.0e6, 20.0e6])?;
    /// assert_eq!((bed.elements().len(), bed.elements()[0].directions().len()), (8 * 6, 3));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a stiffness not finite and above zero;
    /// [`Error::Memory`](crate::Error::Memory) for more elements than their matrices allow; as for
    /// [`Plan::without_overhang`].
    pub fn in_plan(plan: Plan, stiffness: [f64; SPACE]) -> Result<Self> {
        Self::bed(plan.without_overhang()?.elements(), stiffness)
    }

    fn bed(elements: Vec<ContactElement>, stiffness: [f64; SPACE]) -> Result<Self> {
        let elements = Patch::new(elements)?;
        positive("normal stiffness of the spring bed", stiffness[0])?;
        positive("tangential stiffness of the spring bed", stiffness[1])?;
        positive("tangential stiffness of the spring bed along y", stiffness[2])?;
        Ok(Self {
            displacement: vec![0.0; elements.layout().len()],
            elements,
            stiffness,
            dashpot: [0.0; SPACE],
            theta: 0.5,
            time_step: 0.0,
        })
    }

    /// Adds dashpots (Pa·s/m) parallel to the springs.
    ///
    /// In plan the tangential dashpots act in both directions.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are finite and not below zero.
    pub fn with_dashpots(mut self, normal: f64, tangential: f64) -> Result<Self> {
        let normal = not_negative("normal dashpot of the spring bed", normal)?;
        let tangential = not_negative("tangential dashpot of the spring bed", tangential)?;
        self.dashpot = [normal, tangential, tangential];
        Ok(self)
    }

    /// Sets θ of the time integration, from ½ to 1.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) outside this range.
    pub fn with_theta(mut self, theta: f64) -> Result<Self> {
        self.theta = require("theta", theta, (0.5..=1.0).contains(&theta), "from 0.5 to 1")?;
        Ok(self)
    }

    /// Returns an error before `prepare`: without a time step the impedance is not defined.
    fn check_prepared(&self) -> Result<()> {
        if self.time_step > 0.0 { Ok(()) } else { Err(NOT_PREPARED) }
    }

    /// θ k + c/Δt of a component.
    fn impedance(&self, component: usize) -> f64 {
        self.theta * self.stiffness[component] + self.dashpot[component] / self.time_step
    }

    fn fill_diagonal(&self, matrix: &mut [f64], value: impl Fn(usize) -> f64) -> Result<()> {
        let size = self.displacement.len();
        same_length("matrix of the spring bed", matrix.len(), size * size)?;
        matrix.fill(0.0);
        for i in 0..size {
            matrix[i * size + i] = value(self.component(i));
        }
        Ok(())
    }

    fn component(&self, index: usize) -> usize {
        index / self.elements.len()
    }
}

impl Ground for SpringGround {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(
        &mut self,
        time_step: f64,
        _steps: Option<usize>,
        _observer: &mut Observer<'_>,
    ) -> Result<()> {
        self.time_step = positive("time step", time_step)?;
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.check_prepared()?;
        self.fill_diagonal(matrix, |component| 1.0 / self.impedance(component))
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.check_prepared()?;
        same_length("displacement of the history", displacement.len(), self.displacement.len())?;
        for (i, (out, last)) in displacement.iter_mut().zip(&self.displacement).enumerate() {
            let k = self.component(i);
            let impedance = self.impedance(k);
            *out = (impedance - self.stiffness[k]) / impedance * last;
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        for i in 0..self.displacement.len() {
            let traction = traction.get(i).copied().unwrap_or(0.0);
            let k = self.component(i);
            let impedance = self.impedance(k);
            let kept = (impedance - self.stiffness[k]) / impedance * self.displacement[i];
            self.displacement[i] = kept + traction / impedance;
        }
    }

    /// Returns the displacement at the end of the last step.
    fn save(&self) -> Result<Vec<f64>> {
        Ok(self.displacement.clone())
    }

    fn restore(&mut self, _steps: usize, values: &[f64]) -> Result<()> {
        if values.len() != self.displacement.len() {
            return Err(CheckpointError::Corrupt { quantity: "spring bed" }.into());
        }
        self.displacement.copy_from_slice(values);
        Ok(())
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill_diagonal(matrix, |component| 1.0 / self.stiffness[component])
    }

    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        let parts = self.elements[0].parts().count();
        let size = parts * self.displacement.len();
        let mut matrix = vec![0.0; size * size];
        for i in 0..size {
            matrix[i * (size + 1)] = 1.0 / self.stiffness[self.component(i / parts)];
        }
        Ok(Some(matrix))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_traction_tends_to_the_static_displacement() {
        let mut bed =
            SpringGround::new(0.0..1.0, 1, 100.0, 50.0).unwrap().with_dashpots(10.0, 5.0).unwrap();
        bed.prepare(0.01, None, &mut crate::unobserved).unwrap();
        let mut s = [0.0; 2];
        for _ in 0..10 {
            bed.commit(&[200.0, -50.0]);
        }
        // s = p/k (1 − exp(−k t/c)) at t = 0.1 s, within the rule's second order.
        let exact = 1.0 - (-1.0_f64).exp();
        assert!((bed.displacement[0] / 2.0 - exact).abs() < 5e-4);
        assert!((bed.displacement[1] / -1.0 - exact).abs() < 5e-4);
        for _ in 0..2000 {
            bed.commit(&[200.0, -50.0]);
        }
        bed.history(&mut s).unwrap();
        let mut matrix = [0.0; 4];
        bed.step_compliance(&mut matrix).unwrap();
        assert!((s[0] + matrix[0] * 200.0 - 2.0).abs() < 1e-12);
        assert!((s[1] + matrix[3] * -50.0 + 1.0).abs() < 1e-12);
    }
}
