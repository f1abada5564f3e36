//! Winkler bed: independent springs and dashpots, without waves.

use super::plan::Plan;
use super::{DiagonalCompliance, Grading, Ground, NOT_PREPARED, Strip};
use crate::error::{
    CheckpointError, Observer, Result, not_negative, positive, require, same_length,
};
use crate::geometry::{COMPONENTS_IN_SPACE, ContactElement, ContactLayout, Patch};
use crate::structure::Structure;

/// Independent springs and dashpots under each element (Winkler bed).
///
/// Per unit of area, traction = stiffness · s + dashpot · ds/dt in each direction, integrated in time by a θ rule. θ = ½
/// (the default, the [mid-step form](Ground#elastic-parts-in-the-mid-step-form)) conserves the springs' energy, and θ = 1
/// damps the oscillations of a released bed without dashpots. If a base with a sideways speed lands on stiff tangential
/// springs without dashpots, the sign of this speed then alternates from step to step. A user's ground can contain a
/// bed as one of its parts: [`SpringGround::of_elements`].
///
/// In plan under a base of up to ten rigid bodies, memory and time per step grow in proportion to the number of elements,
/// from 64 elements on: a bed of 64 × 64 cells is usual. Under a flexible base, and in the plane, they grow as on elastic
/// soil.
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
    /// Stiffness of each component of a contact vector, Pa/m.
    stiffness: Vec<f64>,
    /// Dashpot coefficient of each component of a contact vector, Pa·s/m.
    dashpot: Vec<f64>,
    /// Weight θ of the end of a step in the time integration, from ½ to 1.
    theta: f64,
    /// Time step, s; zero before `prepare`.
    time_step: f64,
    /// Displacement at the end of the last step, m.
    displacement: Vec<f64>,
}

impl SpringGround {
    /// Bed of `count` equal elements over `range` (m) with normal and tangential stiffness (Pa/m).
    ///
    /// # Errors
    /// As for [`Strip::new`]; [`Error::Input`](crate::Error::Input) for a stiffness not finite and above zero.
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
        Self::uniform_bed(elements, [normal_stiffness, tangential_stiffness, tangential_stiffness])
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
    /// [`Error::Memory`](crate::Error::Memory) for more cells than the memory allows; as for
    /// [`Plan::without_overhang`].
    pub fn in_plan(plan: Plan, stiffness: [f64; COMPONENTS_IN_SPACE]) -> Result<Self> {
        Self::uniform_bed(plan.without_overhang()?.elements(), stiffness)
    }

    /// Bed of any elements, with a spring and a dashpot for each component of a [contact vector](crate::bem).
    ///
    /// `stiffness` (Pa/m) and `dashpot` (Pa·s/m) have 2Q components for Q elements, in plan 3Q. A user's ground with
    /// such a bed as a part calls the bed's methods in its methods of the same name, and adds its other parts.
    ///
    /// ```
    /// use basemat::bem::{Ground, SpringGround, Strip};
    /// let elements = Strip::uniform(-2.0..2.0, 2)?.elements();
    /// // Down, then to the right: the left element is softer.
    /// let mut bed = SpringGround::of_elements(elements, &[1e7, 2e7, 5e6, 5e6], &[0.0; 4])?;
    /// bed.prepare(0.01, None, &mut basemat::unobserved)?;
    /// let (mut step, mut past) = ([0.0; 16], [0.0; 4]);
    /// bed.step_compliance(&mut step)?;
    /// assert_eq!([step[0], step[5]], [2.0 / 1e7, 2.0 / 2e7]);
    /// bed.commit(&[1e4, 0.0, 0.0, 0.0]);
    /// bed.history(&mut past)?;
    /// assert_eq!(past[0], -2e-3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for lists of another length, [`Error::Input`](crate::Error::Input) for a
    /// stiffness not finite and above zero or a dashpot not finite or below zero, and for elements that overlap.
    pub fn of_elements(
        elements: Vec<ContactElement>,
        stiffness: &[f64],
        dashpot: &[f64],
    ) -> Result<Self> {
        let elements = Patch::of_any_count(elements)?;
        let component_count = elements.layout().len();
        same_length("stiffnesses of the spring bed", stiffness.len(), component_count)?;
        same_length("dashpots of the spring bed", dashpot.len(), component_count)?;
        for i in 0..component_count {
            positive("stiffness of the spring bed", stiffness[i])?;
            not_negative("dashpot of the spring bed", dashpot[i])?;
        }
        Ok(Self {
            elements,
            stiffness: stiffness.to_vec(),
            dashpot: dashpot.to_vec(),
            theta: 0.5,
            time_step: 0.0,
            displacement: vec![0.0; component_count],
        })
    }

    /// Bed of equal springs, with their stiffness down, along x and along y.
    fn uniform_bed(
        elements: Vec<ContactElement>,
        stiffness: [f64; COMPONENTS_IN_SPACE],
    ) -> Result<Self> {
        positive("normal stiffness of the spring bed", stiffness[0])?;
        positive("tangential stiffness of the spring bed", stiffness[1])?;
        positive("tangential stiffness of the spring bed along y", stiffness[2])?;
        let layout = ContactLayout::for_elements(&elements);
        let stiffnesses = component_values(layout, stiffness);
        Self::of_elements(elements, &stiffnesses, &vec![0.0; stiffnesses.len()])
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
        self.dashpot = component_values(self.elements.layout(), [normal, tangential, tangential]);
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

    /// Error before `prepare`, because the impedance depends on the time step.
    fn check_prepared(&self) -> Result<()> {
        if self.time_step > 0.0 { Ok(()) } else { Err(NOT_PREPARED) }
    }

    /// Impedance θ k + c/Δt of a component of a contact vector, Pa/m.
    fn impedance(&self, index: usize) -> f64 {
        self.theta * self.stiffness[index] + self.dashpot[index] / self.time_step
    }

    /// Displacement at the end of the next step without traction, m.
    fn history_component(&self, index: usize) -> f64 {
        let impedance = self.impedance(index);
        (impedance - self.stiffness[index]) / impedance * self.displacement[index]
    }

    /// Overwrites `matrix` with a diagonal matrix; `diagonal_entry` returns the entry of each component.
    fn fill_diagonal(
        &self,
        matrix: &mut [f64],
        diagonal_entry: impl Fn(usize) -> f64,
    ) -> Result<()> {
        let row_count = self.displacement.len();
        same_length("matrix of the spring bed", matrix.len(), row_count * row_count)?;
        matrix.fill(0.0);
        for i in 0..row_count {
            matrix[i * row_count + i] = diagonal_entry(i);
        }
        Ok(())
    }
}

/// Value of each component of a contact vector, from the values down, along x and along y.
fn component_values(layout: ContactLayout, values: [f64; COMPONENTS_IN_SPACE]) -> Vec<f64> {
    (0..layout.len())
        .map(|index| values[layout.component_and_element(index)[0]])
        .collect()
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
        self.fill_diagonal(matrix, |i| 1.0 / self.impedance(i))
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.check_prepared()?;
        same_length("displacement of the history", displacement.len(), self.displacement.len())?;
        for (i, component) in displacement.iter_mut().enumerate() {
            *component = self.history_component(i);
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        for i in 0..self.displacement.len() {
            let component_traction = traction.get(i).copied().unwrap_or(0.0);
            self.displacement[i] =
                self.history_component(i) + component_traction / self.impedance(i);
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
        self.fill_diagonal(matrix, |i| 1.0 / self.stiffness[i])
    }

    fn diagonal_compliance(&self) -> Result<Option<DiagonalCompliance>> {
        self.check_prepared()?;
        let in_step = (0..self.stiffness.len()).map(|i| 1.0 / self.impedance(i)).collect();
        let at_rest = self.stiffness.iter().map(|stiffness| 1.0 / stiffness).collect();
        Ok(Some(DiagonalCompliance { in_step, at_rest }))
    }

    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        let part_count = self.elements[0].parts().count();
        let row_count = part_count * self.displacement.len();
        let mut matrix = vec![0.0; row_count * row_count];
        for i in 0..row_count {
            matrix[i * (row_count + 1)] = 1.0 / self.stiffness[i / part_count];
        }
        Ok(Some(matrix))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_traction_leads_to_the_static_displacement() {
        let mut bed = SpringGround::new(0.0..1.0, 1, 100.0, 50.0)
            .unwrap()
            .with_dashpots(10.0, 5.0)
            .unwrap();
        bed.prepare(0.01, None, &mut crate::unobserved).unwrap();
        for _ in 0..10 {
            bed.commit(&[200.0, -50.0]);
        }
        // s = p/k (1 − exp(−k t/c)) at t = 0.1 s, with the second-order error of the θ rule.
        let expected_ratio = 1.0 - (-1.0_f64).exp();
        assert!((bed.displacement[0] / 2.0 - expected_ratio).abs() < 5e-4);
        assert!((bed.displacement[1] / -1.0 - expected_ratio).abs() < 5e-4);
        for _ in 0..2000 {
            bed.commit(&[200.0, -50.0]);
        }
        let mut history = [0.0; 2];
        bed.history(&mut history).unwrap();
        let mut compliance = [0.0; 4];
        bed.step_compliance(&mut compliance).unwrap();
        assert!((history[0] + compliance[0] * 200.0 - 2.0).abs() < 1e-12);
        assert!((history[1] + compliance[3] * -50.0 + 1.0).abs() < 1e-12);
    }
}
