//! In which coordinates a linear structure is stepped, and their basis.

use super::initial::Beginning;
use super::scene::base::Base;
use super::scene::krylov::Reduction;
use super::scene::modal_basis::ModalBasis;
use super::scene::model::Model;
use super::scene::operators::Factor;
use super::scene::step_response::Rows;
use super::scheme::SchemeCoefficients;
use crate::error::{Error, Result};
use crate::linalg::matrix::spread;
use crate::structure::probe::Probe;
use crate::structure::{Row, Structure};

/// Steps that modes have to pay for themselves in, if not told otherwise.
const STEPS: usize = 10_000;
/// Times at which the structure's own load is looked at.
const SAMPLES: u32 = 16;

/// In which coordinates a linear structure is stepped. Results are the same to rounding but for
/// [`Coordinates::Reduced`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Coordinates {
    /// Whichever is expected to take less time, with the modes' own computation counted against
    /// them; see [`SimulationBuilder::expected_steps`](crate::coupled::SimulationBuilder::expected_steps). Nonlinear structures, and those that
    /// modes do not decouple, keep their unknowns.
    #[default]
    Auto,
    /// The structure's unknowns: sparse matrices, one back-substitution per step.
    Unknowns,
    /// The modes of the structure without ground and damping. Needs a linear structure with
    /// symmetric matrices, a positive definite mass and damping that the modes decouple.
    Modes,
    /// Ritz modes, two to four hundred for thousands of unknowns: a rational block Krylov basis of the
    /// answers to contact tractions, loads, probes and an initial motion, projected (Galerkin), so that
    /// it stays passive and the ledger closes. The settlement under weight is that of all unknowns.
    ///
    /// The tolerance is for the error of responses, as the time scheme steps them, each relative to its
    /// largest: to a unit traction that begins to grow suddenly, displacements of the base, and displacements,
    /// velocities and accelerations that probes read; to a load that jumps, what every probe reads, section forces
    /// included. It is an estimate, from the change as vectors are added: on towers of 2 and 5 % under loads that jump,
    /// errors stayed below half of it. A load that acts for a step or two is the difference of two jumps: relative to
    /// its own, smaller response errors may reach twice the tolerance. Accelerations need more vectors, so
    /// they are looked at only where a probe reads them. What no probe reads is as good as the base's motion
    /// makes it; it is not checked.
    ///
    /// A bonded run is a sum of such responses. Contact amplifies their errors, which nothing
    /// bounds; on towers of 1 092 to 13 122 unknowns with 2 and 5 % of damping that slide and uplift, errors of
    /// base, roof and base shear stayed thirty times below the tolerance, and those of the roof's
    /// acceleration below it. Undamped structures are refused: no few vectors have what rings on above
    /// the frequency 2/Δt, and their accelerations would be lost first.
    ///
    /// Needs a linear structure with symmetric matrices, a positive definite mass and proportional
    /// damping; [`ReducedError`](crate::ReducedError) names what is wrong. A load of the structure's own
    /// is looked at 17 times over the expected steps: what acts only in between is projected. Loads of
    /// the builder have no such gap. Building holds about a dozen factors of the structure's matrices,
    /// and as many blocks of vectors.
    Reduced {
        /// Relative error of responses to sudden tractions, above 0 and below 1; below about 1e-9
        /// rounding may get in the way.
        tolerance: f64,
    },
}

/// All that the choice of a basis looks at.
pub(super) struct Chooser<'a> {
    pub(super) coordinates: Coordinates,
    /// Steps expected, 0 if unknown.
    pub(super) steps: usize,
    pub(super) time_step: f64,
    pub(super) coefficients: &'a SchemeCoefficients,
    pub(super) structure: &'a dyn Structure,
    pub(super) model: &'a Model,
    pub(super) base: &'a Base,
    pub(super) beginning: &'a Beginning,
    pub(super) probes: &'a [Probe],
}

impl Chooser<'_> {
    /// The modes, if the structure is to be stepped in them; `factor` is that of K_eff.
    pub(super) fn basis(&self, factor: &Factor) -> Result<Option<ModalBasis>> {
        let contact = 2 * self.base.lengths().len();
        match self.coordinates {
            Coordinates::Auto
                if self.model.modes_save_time(factor.stored(), contact, self.steps()) =>
            {
                Ok(self.modes())
            }
            Coordinates::Auto | Coordinates::Unknowns => Ok(None),
            Coordinates::Modes => self.modes().map(Some).ok_or(Error::Scene {
                quantity: "modal coordinates",
                needed: "a linear structure with symmetric matrices, a positive definite mass \
                         and a damping that the modes decouple",
            }),
            Coordinates::Reduced { tolerance } => self.reduced(tolerance, factor).map(Some),
        }
    }

    fn steps(&self) -> usize {
        if self.steps > 0 { self.steps } else { STEPS }
    }

    fn modes(&self) -> Option<ModalBasis> {
        let matrices = self.model.sparse().filter(|_| self.model.linear)?;
        let parts = self.model.influence.parts().iter();
        let translations: Vec<_> =
            parts.flat_map(|part| &part.vectors).map(Vec::as_slice).collect();
        ModalBasis::new(matrices, &translations)
    }

    fn reduced(&self, tolerance: f64, factor: &Factor) -> Result<ModalBasis> {
        let (n, size) = (self.model.unknowns, 2 * self.base.lengths().len());
        let mut rows = Rows { all: Vec::new(), counts: [0; 3], probes: Vec::new() };
        for load in &self.beginning.loads {
            keep(&mut rows.all, self.row(load.row()));
        }
        let duration = self.steps() as f64 * self.time_step;
        for k in 0..=SAMPLES {
            let mut load = vec![0.0; n];
            let loaded =
                self.structure.load(duration * f64::from(k) / f64::from(SAMPLES), &mut load);
            if k == 0 {
                loaded?;
            } else if loaded.is_err() {
                // The run may never come so far.
                continue;
            }
            if load.iter().all(|force| force.is_finite()) {
                keep(&mut rows.all, load);
            }
        }
        rows.counts[0] = rows.all.len() / n;
        let mut unit = vec![0.0; size];
        for i in 0..size {
            let mut force = vec![0.0; n];
            unit[i] = 1.0;
            self.base.add_forces(1.0, &unit, &mut force);
            unit[i] = 0.0;
            keep(&mut rows.all, force);
        }
        let mut motions = Vec::new();
        for motion in [&self.beginning.displacement, &self.beginning.velocity] {
            for motion in motion.chunks_exact(n) {
                let mut force = vec![0.0; n];
                self.model.mass.multiply_add(1.0, motion, &mut force);
                keep(&mut rows.all, force);
            }
            motions.extend_from_slice(motion);
        }
        rows.counts[1] = rows.all.len() / n;
        rows.probes = vec![[None; 3]; self.probes.len()];
        for kind in 0..3 {
            if kind == 2 {
                rows.counts[2] = rows.all.len() / n;
            }
            for (probe, places) in self.probes.iter().zip(&mut rows.probes) {
                let place = rows.all.len() / n;
                let kept = keep(&mut rows.all, self.row(probe.rows()[kind]));
                places[kind] = kept.then_some(place);
            }
        }
        let reduction = Reduction {
            model: self.model,
            base: self.base,
            coefficients: self.coefficients,
            factor,
            steps: self.steps(),
            rows,
            motions,
        };
        reduction.modes(tolerance)
    }

    /// A row of all unknowns.
    fn row(&self, row: &Row) -> Vec<f64> {
        spread(row.terms(), self.model.unknowns)
    }
}

/// Adds a row, unless it is zero.
fn keep(rows: &mut Vec<f64>, row: Vec<f64>) -> bool {
    let kept = row.iter().any(|value| *value != 0.0);
    if kept {
        rows.extend(row);
    }
    kept
}
