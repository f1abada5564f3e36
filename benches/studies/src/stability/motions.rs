//! Ground motions that are difficult for a time integrator.
//!
//! Each is a function of the step's number, so that it is equally difficult for every time step. It shakes
//! for a number of steps, stops suddenly, and remains at its last displacement.

use std::sync::Arc;

use basemat::motion::{FreeFieldFn, Record, STANDARD_GRAVITY, el_centro_1940};

use std::f64::consts::{PI, TAU};

/// Motion or force that shakes a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ShakingMotion {
    /// No motion; the static state must remain.
    Still,
    /// Twelve sines in either direction, from 2.5 rad per step to 400 steps a period, 1 g each at most.
    Sines,
    /// Pulses of acceleration of 50 g that last a fifth of a step, up and down alternately.
    Pulses,
    /// Displacement at the end of single steps only.
    Spikes,
    /// A jump by g Δt² to the side and 0.4 g Δt² up within one step.
    Step,
    /// Velocity pulse of Mavroeidis & Papageorgiou (2003), scaled to 5 g, with half of it upwards.
    NearFault,
    /// Up and down with 3 g, so that the whole base leaves the ground.
    LiftOff,
    /// Alternating direction with every step, 5 g.
    Nyquist,
    /// Independent random displacements at every step, up to 5 g.
    Noise,
    /// El Centro 1940, in real time.
    ElCentro,
}

pub(crate) const SHAKING_MOTIONS: [(&str, ShakingMotion); 10] = [
    ("still", ShakingMotion::Still),
    ("sines 1 g", ShakingMotion::Sines),
    ("pulses in a step", ShakingMotion::Pulses),
    ("spikes", ShakingMotion::Spikes),
    ("step", ShakingMotion::Step),
    ("near fault 5 g", ShakingMotion::NearFault),
    ("lift-off 3 g", ShakingMotion::LiftOff),
    ("Nyquist 5 g", ShakingMotion::Nyquist),
    ("noise 5 g", ShakingMotion::Noise),
    ("El Centro begins", ShakingMotion::ElCentro),
];

impl ShakingMotion {
    /// The free field that shakes for `steps` steps of `time_step` seconds and then stops.
    pub(crate) fn field(self, steps: usize, time_step: f64) -> basemat::Result<FreeFieldFn> {
        let record: Option<Arc<Record>> = match self {
            Self::ElCentro => Some(Arc::new(el_centro_1940())),
            Self::NearFault => Some(Arc::new(near_fault(steps, time_step)?)),
            _ => None,
        };
        // Half-plane and springs use displacements at the ends of steps, and no velocities.
        Ok(FreeFieldFn::new(move |_, time| {
            let n = (time / time_step).round().min(steps as f64);
            match (&record, self) {
                (Some(record), Self::NearFault) => {
                    let u = record.at(n * time_step).displacement;
                    [u, 0.5 * u]
                }
                (Some(record), _) => [record.at(n * time_step).displacement, 0.0],
                (None, motion) => {
                    // Displacement of one g over one step squared.
                    let g = STANDARD_GRAVITY * time_step * time_step;
                    motion.shape(n).map(|u| g * u)
                }
            }
        }))
    }

    /// Displacement at the end of step `n`, in g Δt².
    fn shape(self, n: f64) -> [f64; 2] {
        match self {
            Self::Still | Self::ElCentro | Self::NearFault => [0.0; 2],
            Self::Sines => {
                let mut sum = [0.0; 2];
                for k in 0..12 {
                    let omega = 2.5 * (TAU / 400.0 / 2.5_f64).powf(f64::from(k) / 11.0);
                    // The sine starts from rest, because it grows over a period.
                    let fade_factor = 1.0 - (-(omega * n / TAU).powi(2)).exp();
                    sum[0] +=
                        fade_factor * (omega * n + 0.7 * f64::from(k)).sin() / (omega * omega);
                    sum[1] +=
                        fade_factor * (omega * n + 1.9 * f64::from(k)).sin() / (omega * omega);
                }
                sum.map(|u| 0.3 * u)
            }
            Self::Pulses => {
                // Every 20 steps a jump of velocity of 50 g × Δt/5, with alternating sign, in the middle of a step.
                let pulses = (n / 20.0).floor();
                let since_pulse = n % 20.0;
                let odd_pulses = pulses % 2.0;
                let completed_time = (pulses / 2.0).floor() * 20.0 + odd_pulses * 19.5;
                let current = if odd_pulses == 0.0 {
                    (since_pulse - 0.5).max(0.0)
                } else {
                    since_pulse.min(0.5)
                };
                let u = 10.0 * (completed_time + current);
                [u, 0.3 * u]
            }
            Self::Spikes => {
                let u = if n % 25.0 == 7.0 { 5.0 } else { 0.0 };
                [u, 0.5 * u]
            }
            Self::Step => [f64::from(n >= 5.0), 0.4 * f64::from(n >= 5.0)],
            Self::LiftOff => {
                let omega = TAU / 60.0;
                let u = 3.0 * (1.0 - (omega * n).cos()) / (omega * omega);
                [0.2 * u, u]
            }
            Self::Nyquist => {
                let u = if n % 2.0 == 0.0 { 0.0 } else { 5.0 / 4.0 };
                [u, 0.5 * u]
            }
            Self::Noise => [2.5 * random(n, 1), 1.25 * random(n, 2)],
        }
    }
}

/// Random number from −½ to ½ that depends on the step's number alone (splitmix64).
fn random(n: f64, stream: u64) -> f64 {
    if n == 0.0 {
        return 0.0;
    }
    let mut z = n.to_bits().wrapping_add(stream.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
}

/// v = ½ (1 + cos(2π(t−t₀)/(γT))) cos(2π(t−t₀)/T), |t−t₀| ≤ γT/2, with γ = 2: two periods in
/// `steps` steps, scaled to 5 g.
fn near_fault(steps: usize, time_step: f64) -> basemat::Result<Record> {
    let gamma = 2.0;
    let count = steps.max(8);
    let period = count as f64 / gamma;
    let velocity = |n: f64| {
        let angle = TAU * (n / period - 0.5 * gamma);
        0.5 * (1.0 + (angle / gamma).cos()) * (angle + 0.25 * PI).cos()
    };
    let acceleration = (0..=count)
        .map(|n| {
            let n = n as f64;
            (velocity((n + 0.5).min(count as f64)) - velocity((n - 0.5).max(0.0))) / time_step
        })
        .collect();
    Record::new(time_step, acceleration)?.scaled_to_peak(5.0 * STANDARD_GRAVITY)
}
