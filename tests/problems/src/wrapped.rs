//! Wrappers of a structure, of a ground and of a law.
//!
//! [`MinimalStructure`] and [`MinimalGround`] forward the required methods only. [`StructureWithForce`] adds a load.
//! [`LawWithNextMode`] replaces the rule for the next mode.

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

/// Accessors of the nonlinear force for a structure that implements it itself.
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
    /// Displacement of the loaded point in the direction of the force.
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

/// Required methods of an interface law, forwarded to a field.
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
    /// Function of the present mode, the previous contact and the law's next mode; returns the next mode.
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
