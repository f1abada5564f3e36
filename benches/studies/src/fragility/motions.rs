//! The ensemble: El Centro with several durations, and near-fault pulses.

use std::f64::consts::{PI, TAU};

use basemat::Result;
use basemat::motion::{Record, el_centro_1940};

/// A near-fault pulse: Mavroeidis and Papageorgiou, "A mathematical representation of near-fault ground
/// motions", Bulletin of the Seismological Society of America 93 (2003), 1099–1131.
///
/// Velocity A/2 [1 + cos(2πf(t − t₀)/γ)] cos(2πf(t − t₀) + ν) for |t − t₀| ≤ γ/(2f), zero outside.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pulse {
    /// Prevailing period 1/f, s.
    pub(crate) period: f64,
    /// γ > 1: oscillations within the envelope.
    pub(crate) oscillations: f64,
    /// ν, degrees.
    pub(crate) phase: f64,
}

impl Pulse {
    /// Length, s; t₀ is in its middle.
    pub(crate) fn duration(&self) -> f64 {
        self.oscillations * self.period
    }

    /// Velocity at `time` for A = 1 m/s.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests differentiate it"))]
    pub(crate) fn velocity(&self, time: f64) -> f64 {
        let angle = self.angle(time);
        let slow_angle = angle / self.oscillations;
        let fast_angle = angle + self.phase.to_radians();
        0.5 * (1.0 + slow_angle.cos()) * fast_angle.cos()
    }

    /// Acceleration at `time` for A = 1 m/s, m/s².
    pub(crate) fn acceleration(&self, time: f64) -> f64 {
        let angle = self.angle(time);
        let slow_angle = angle / self.oscillations;
        let fast_angle = angle + self.phase.to_radians();
        let envelope_term = slow_angle.sin() * fast_angle.cos() / self.oscillations;
        -PI / self.period * (envelope_term + (1.0 + slow_angle.cos()) * fast_angle.sin())
    }

    /// 2πf(t − t₀), constant outside the pulse, where the velocity is zero.
    fn angle(&self, time: f64) -> f64 {
        let angle = TAU * (time - 0.5 * self.duration()) / self.period;
        let end = PI * self.oscillations;
        angle.clamp(-end, end)
    }

    fn record(&self, step: f64) -> Result<Record> {
        let samples = (self.duration() / step).ceil();
        Record::from_fn(step, samples * step, |time| self.acceleration(time))
    }
}

/// A motion with the name of its cases.
pub(crate) type EnsembleMotion = (String, Record);

/// The motions, sampled every `step` (s); fewer if `short`.
pub(crate) fn list(step: f64, short: bool) -> Result<Vec<EnsembleMotion>> {
    let record = el_centro_1940();
    let factors: &[f64] = if short { &[1.0] } else { &[0.7, 1.0, 1.4] };
    let mut motions = Vec::new();
    for &factor in factors {
        let stretched_record =
            Record::new(factor * record.time_step(), record.accelerations().to_vec())?;
        let name = if factor == 1.0 { String::new() } else { format!(", {factor} × as long") };
        motions.push((format!("El Centro 1940{name}"), stretched_record));
    }
    let periods: &[f64] = if short { &[0.6, 1.6] } else { &[0.4, 0.6, 1.0, 1.6, 2.5] };
    let shapes: &[(f64, f64)] = if short {
        &[(1.5, 0.0), (2.0, 90.0)]
    } else {
        &[(1.3, 0.0), (2.0, 90.0), (3.0, 45.0)]
    };
    for &period in periods {
        for &(oscillations, phase) in shapes {
            let pulse = Pulse { period, oscillations, phase };
            let name = format!("pulse {period} s, γ {oscillations}, ν {phase}°");
            motions.push((name, pulse.record(step)?));
        }
    }
    Ok(motions)
}
