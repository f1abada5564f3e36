//! Wrappers of a structure, of a ground and of a law.
//!
//! Of a structure and of a ground, one that forwards the required methods only; of a structure, one with a force; of a law,
//! one with another rule for modes.

use basemat::bem::Ground;
use basemat::interface::{
    Condition, ContactState, Coulomb, InterfaceLaw, Mode, PlaneLaw, PreviousContact, Tolerance,
};
use basemat::structure::{DofCombination, Structure, Triplets};

/// Required methods of a structure, forwarded to a field.
#[macro_export]
macro_rules! needed_from {
    ($field:tt) => {
        fn dofs(&self) -> usize {
            self.$field.dofs()
        }

        fn base(&self) -> basemat::structure::Base {
            self.$field.base()
        }

        fn mass(&self, matrix: &mut basemat::structure::Triplets) -> basemat::Result<()> {
            self.$field.mass(matrix)
        }

        fn stiffness(&self, matrix: &mut basemat::structure::Triplets) -> basemat::Result<()> {
            self.$field.stiffness(matrix)
        }
    };
}

/// Methods of a structure that is its nonlinear force.
#[macro_export]
macro_rules! own_force {
    () => {
        fn nonlinear(&self) -> Option<&dyn basemat::structure::NonlinearForce> {
            Some(self)
        }

        fn nonlinear_mut(&mut self) -> Option<&mut dyn basemat::structure::NonlinearForce> {
            Some(self)
        }
    };
}

/// A structure with the required methods only.
pub struct MinimalStructure<S>(pub S);

impl<S: Structure> Structure for MinimalStructure<S> {
    needed_from!(0);
}

/// A structure under a force.
pub struct StructureWithForce<S, F> {
    pub structure: S,
    /// Displacement in the direction of the force of the point it acts on.
    pub along: DofCombination,
    /// The force at a time, N/m.
    pub force: F,
}

impl<S: Structure, F: Fn(f64) -> f64 + Send + 'static> Structure for StructureWithForce<S, F> {
    needed_from!(structure);

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.structure.damping(matrix)
    }

    fn load(&self, time: f64, load: &mut [f64]) -> basemat::Result<()> {
        for &(dof, weight) in &self.along {
            load[dof] += weight * (self.force)(time);
        }
        Ok(())
    }
}

/// Required methods of a ground, forwarded to a field.
#[macro_export]
macro_rules! ground_from {
    ($field:tt) => {
        fn elements(&self) -> &[basemat::bem::ContactElement] {
            self.$field.elements()
        }

        fn prepare(
            &mut self,
            time_step: f64,
            steps: Option<usize>,
            observer: &mut basemat::Observer<'_>,
        ) -> basemat::Result<()> {
            self.$field.prepare(time_step, steps, observer)
        }

        fn step_compliance(&self, matrix: &mut [f64]) -> basemat::Result<()> {
            self.$field.step_compliance(matrix)
        }

        fn history(&mut self, displacement: &mut [f64]) -> basemat::Result<()> {
            self.$field.history(displacement)
        }

        fn commit(&mut self, traction: &[f64]) {
            self.$field.commit(traction);
        }

        fn static_compliance(&self, matrix: &mut [f64]) -> basemat::Result<()> {
            self.$field.static_compliance(matrix)
        }
    };
}

/// A ground with the required methods only.
pub struct MinimalGround<G>(pub G);

impl<G: Ground> Ground for MinimalGround<G> {
    ground_from!(0);
}

/// Methods that every interface law needs, as a field has them.
#[macro_export]
macro_rules! law_from {
    ($field:tt) => {
        fn limits(
            &self,
            start: &basemat::interface::PreviousContact,
        ) -> basemat::Result<basemat::interface::Limits> {
            self.$field.limits(start)
        }

        fn modes(&self) -> &[basemat::interface::Mode] {
            self.$field.modes()
        }

        fn conditions(
            &self,
            mode: basemat::interface::Mode,
            start: &basemat::interface::PreviousContact,
        ) -> [basemat::interface::Condition; 2] {
            self.$field.conditions(mode, start)
        }

        fn next_mode(
            &self,
            mode: basemat::interface::Mode,
            start: &basemat::interface::PreviousContact,
            trial: &basemat::interface::ContactState,
            tolerance: basemat::interface::Tolerance,
        ) -> basemat::interface::Mode {
            self.$field.next_mode(mode, start, trial, tolerance)
        }
    };
}

/// Coulomb's law with another rule for the next mode.
pub struct LawWithNextMode<F> {
    pub law: Coulomb,
    /// The next mode, by the present one, the previous contact and the mode that the law returns.
    pub next: F,
}

impl<F: Fn(Mode, &PreviousContact, Mode) -> Mode + Send + Sync> PlaneLaw for LawWithNextMode<F> {
    fn modes(&self) -> &[Mode] {
        self.law.modes()
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.law.conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        (self.next)(mode, start, self.law.next_mode(mode, start, trial, tolerance))
    }
}
