//! Outcomes of random runs that yield: counts, and the largest residual of the energy balance.

use basemat::{Result, Simulation};
use basemat_problems::yielding_blocks::{BlockEnergies, block_energies};

/// Counts of random scenes, and the largest residual of their energy balances.
#[derive(Debug, Default)]
pub(super) struct RunCounts {
    pub(super) refused: usize,
    pub(super) failed: usize,
    pub(super) yielded: usize,
    /// Runs whose second half is not the same after resuming.
    pub(super) changed: usize,
    pub(super) residual: f64,
}

impl RunCounts {
    /// Runs a scene; `None` if its build or its run returns an error.
    ///
    /// `text`: description of the scene, for messages.
    pub(super) fn energies(
        &mut self,
        simulation: Result<Simulation>,
        text: &str,
    ) -> Option<BlockEnergies> {
        let mut simulation = match simulation {
            Ok(simulation) => simulation,
            Err(error) => {
                println!("refused: {text}: {error}");
                self.refused += 1;
                return None;
            }
        };
        match block_energies(&mut simulation) {
            Ok(energies) => {
                self.residual = larger(self.residual, energies.residual);
                self.yielded += usize::from(energies.yields);
                self.changed += usize::from(!energies.resumes);
                Some(energies)
            }
            Err(error) => {
                println!("failed: {text}: {error}");
                self.failed += 1;
                None
            }
        }
    }
}

/// The larger of two numbers, or NaN if the second one is NaN.
pub(super) fn larger(one: f64, other: f64) -> f64 {
    if other.is_nan() || other > one { other } else { one }
}
