//! A run in numbers.

use super::{
    ElementEnvelope, EnergyShares, Extremes, FoundationSummary, Histories, Quantity, Sliding,
    Uplift,
};
use crate::bem::ContactElement;
use crate::coupled::{Ledger, Peak, ProbeExtremes, Warning, probe_index};
use crate::error::Result;

/// What a run came to; printed, a page for a report.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Summary {
    /// Steps recorded.
    pub steps: usize,
    /// Time at its beginning, s.
    pub start: f64,
    /// Time at its end, s.
    pub end: f64,
    /// Normal force at the start: the weight, N/m.
    pub static_normal_force: f64,
    /// Base shear, N/m.
    pub base_shear: Extremes,
    /// Base moment, static part included, N·m/m.
    pub base_moment: Extremes,
    /// Normal force, N/m.
    pub normal_force: Extremes,
    /// Rotation of the base, rad.
    pub base_rotation: Extremes,
    /// The probes, in the order they were given to the builder.
    pub probes: Vec<ProbeExtremes>,
    /// Uplift.
    pub uplift: Uplift,
    /// Sliding.
    pub sliding: Sliding,
    /// Each foundation by itself, from left to right.
    pub foundations: Vec<FoundationSummary>,
    /// Least factor of safety against sliding, of several foundations the least; `None` without a friction coefficient.
    pub least_sliding_safety: Option<Peak>,
    /// Least factor of safety against overturning, of several foundations the least.
    pub least_overturning_safety: Peak,
    /// Envelopes of the contact elements, from left to right.
    pub envelope: Vec<ElementEnvelope>,
    /// Where the energy went, as shares of the input at the end; `None` if that is not positive.
    pub energy: Option<EnergyShares>,
    /// The ledger at the end.
    pub ledger: Ledger,
    /// Largest ledger residual of all steps.
    pub ledger_residual: f64,
    /// Changes of contact mode.
    pub mode_changes: usize,
    /// Warnings, as for [`crate::coupled::Run`].
    pub warnings: Vec<Warning>,
}

impl Histories {
    /// The run so far in numbers.
    pub fn summary(&self) -> Summary {
        let tally = &self.tally;
        let shortest =
            self.elements.iter().map(ContactElement::length).fold(f64::INFINITY, f64::min);
        let mut warnings = Warning::all(
            tally.sliding.element_peak.value,
            shortest,
            self.extremes(Quantity::BaseRotation).largest().value,
            &tally.ledger,
        );
        tally.resolution.warn(&mut warnings);
        let sliding_safety = self.extremes(Quantity::SlidingSafety).lowest;
        Summary {
            steps: tally.steps,
            start: tally.start,
            end: tally.end,
            static_normal_force: tally.static_normal_force,
            base_shear: self.extremes(Quantity::BaseShear),
            base_moment: self.extremes(Quantity::BaseMoment),
            normal_force: self.extremes(Quantity::NormalForce),
            base_rotation: self.extremes(Quantity::BaseRotation),
            probes: self
                .probes
                .iter()
                .zip(&tally.probes)
                .map(|(probe, extremes)| ProbeExtremes {
                    name: probe.name.clone(),
                    unit: probe.unit.clone(),
                    extremes: *extremes,
                })
                .collect(),
            uplift: tally.uplift,
            sliding: tally.sliding.clone(),
            foundations: tally.foundations.iter().map(|own| own.summary.clone()).collect(),
            least_sliding_safety: (!self.recorder.friction.is_empty()).then_some(sliding_safety),
            least_overturning_safety: self.extremes(Quantity::OverturningSafety).lowest,
            envelope: tally.envelopes.clone(),
            energy: EnergyShares::of(&tally.ledger),
            ledger: tally.ledger,
            ledger_residual: tally.ledger_residual,
            mode_changes: tally.mode_changes,
            warnings,
        }
    }
}

impl Summary {
    /// Smallest and largest value of the probe called `name`.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if there is none.
    pub fn probe(&self, name: &str) -> Result<Extremes> {
        probe_index(&self.probes, name, |probe| &probe.name).map(|k| self.probes[k].extremes)
    }

    /// The element with the largest pressure, and that pressure, Pa.
    pub fn largest_pressure(&self) -> Option<(&ElementEnvelope, Peak)> {
        self.envelope
            .iter()
            .map(|envelope| (envelope, envelope.pressure.highest))
            .max_by(|a, b| a.1.value.total_cmp(&b.1.value))
    }

    /// Largest gap of any element, m.
    pub fn largest_gap(&self) -> Peak {
        let gaps = self.envelope.iter().map(|envelope| envelope.gap);
        gaps.max_by(|a, b| a.value.total_cmp(&b.value)).unwrap_or_default()
    }

    /// Largest base shear over the weight; `None` without weight.
    pub fn shear_coefficient(&self) -> Option<f64> {
        (self.static_normal_force > 0.0)
            .then(|| self.base_shear.largest().value.abs() / self.static_normal_force)
    }
}
