//! One law for several elements of a list that has other laws too.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{
    Condition, ContactScene, ContactState, InterfaceLaw, Limits, Mode, PreviousContact, Tolerance,
};
use crate::error::Result;

/// A law that several entries of a list share.
#[derive(Clone)]
pub(crate) struct SharedLaw {
    law: Arc<Mutex<Box<dyn InterfaceLaw>>>,
    modes: Vec<Mode>,
}

impl SharedLaw {
    /// Shares a law.
    fn new(law: Box<dyn InterfaceLaw>) -> Self {
        let modes = law.modes().to_vec();
        Self { law: Arc::new(Mutex::new(law)), modes }
    }

    /// A law for each of `count` elements, from one law for all elements or one each.
    pub(crate) fn for_each(laws: Vec<Box<dyn InterfaceLaw>>, count: usize) -> Vec<Self> {
        let shared_laws: Vec<Self> = laws.into_iter().map(Self::new).collect();
        match shared_laws.as_slice() {
            [law] => vec![law.clone(); count],
            _ => shared_laws,
        }
    }

    /// Entries of a list of laws.
    pub(crate) fn boxed(laws: &[Self]) -> Vec<Box<dyn InterfaceLaw>> {
        laws.iter().map(|law| Box::new(law.clone()) as Box<dyn InterfaceLaw>).collect()
    }

    /// The law, locked.
    ///
    /// Evaluations do not change a law, so that it is still valid after a panic.
    fn law(&self) -> MutexGuard<'_, Box<dyn InterfaceLaw>> {
        self.law.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl InterfaceLaw for SharedLaw {
    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        self.law().limits(start)
    }

    fn modes(&self) -> &[Mode] {
        &self.modes
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.law().conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        self.law().next_mode(mode, start, trial, tolerance)
    }

    fn compliance(&self, mode: Mode, start: &PreviousContact) -> [f64; 2] {
        self.law().compliance(mode, start)
    }

    fn state_variables(&self) -> usize {
        self.law().state_variables()
    }

    fn initial_state_variables(&self, start: &PreviousContact, state_variables: &mut [f64]) {
        self.law().initial_state_variables(start, state_variables);
    }

    fn commit(
        &self,
        start: &PreviousContact,
        end: &ContactState,
        mode: Mode,
        state_variables: &mut [f64],
    ) {
        self.law().commit(start, end, mode, state_variables);
    }

    fn friction_coefficient(&self) -> Option<f64> {
        self.law().friction_coefficient()
    }

    fn bond_overload(&self, start: &PreviousContact, trial: &ContactState) -> Option<f64> {
        self.law().bond_overload(start, trial)
    }

    fn check_start(&self, start: &PreviousContact) -> Result<()> {
        self.law().check_start(start)
    }

    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        self.law().frictionless()
    }

    fn check(&self, scene: &ContactScene) -> Result<()> {
        self.law().check(scene)
    }
}
