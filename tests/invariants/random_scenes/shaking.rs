//! Ground motions scaled to the duration of a run.

use basemat::motion::{FreeField, Record, el_centro_1940};
use proptest::prelude::*;

#[derive(Debug, Clone)]
pub(crate) enum ShakingKind {
    /// Seconds of El Centro, squeezed or stretched to the run.
    Record { begin: f64 },
    /// Jumps of the displacement: phase of the run, right, up, relative to the amplitude.
    Jumps(Vec<[f64; 3]>),
    /// Ricker pulses: phase of the run, right, up.
    Pulses(Vec<[f64; 3]>),
    /// Up and down.
    Vertical { periods: f64 },
}

/// The free field of a scene, the same at all places.
#[derive(Debug, Clone)]
pub(crate) struct Shaking {
    pub(crate) kind: ShakingKind,
    /// Amplitude of the displacement, m.
    pub(crate) amplitude: f64,
    /// −1 exchanges left and right.
    pub(crate) sign: f64,
    /// Time of rest before the motion, s.
    pub(crate) delay: f64,
    pub(crate) duration: f64,
}

impl ShakingKind {
    /// Displacement `[right, up]` at a phase of the run.
    fn at(&self, phase: f64) -> [f64; 2] {
        if phase <= 0.0 {
            return [0.0; 2];
        }
        match self {
            ShakingKind::Record { begin } => {
                let along = el_centro(begin + 2.0 * phase) - el_centro(*begin);
                // Within two seconds the displacement changes by about a centimetre: the shape is of order one.
                [100.0 * along, 30.0 * along]
            }
            ShakingKind::Jumps(jumps) => sum_of_events(jumps, phase, jump),
            ShakingKind::Pulses(pulses) => sum_of_events(pulses, phase, ricker),
            ShakingKind::Vertical { periods } => {
                let angle = std::f64::consts::TAU * periods * phase.min(1.0);
                [0.0, 1.0 - angle.cos()]
            }
        }
    }
}

thread_local! {
    static EL_CENTRO: Record = el_centro_1940();
}

/// Displacement of El Centro.
fn el_centro(time: f64) -> f64 {
    EL_CENTRO.with(|record| record.at(time).displacement)
}

/// Displacement after a jump.
fn jump(phase: f64) -> f64 {
    if phase >= 0.0 { 0.3 } else { 0.0 }
}

fn ricker(phase: f64) -> f64 {
    let s = 12.0 * phase;
    (1.0 - 2.0 * s * s) * (-s * s).exp()
}

/// Sum of events: phase of the middle, right, up.
fn sum_of_events(events: &[[f64; 3]], phase: f64, shape: fn(f64) -> f64) -> [f64; 2] {
    events.iter().fold([0.0; 2], |[x, y], [middle, right, up]| {
        let value = shape(phase - middle);
        [x + right * value, y + up * value]
    })
}

impl FreeField for Shaking {
    fn displacement(&self, _: f64, time: f64) -> [f64; 2] {
        let displacement = self.kind.at((time - self.delay) / self.duration);
        [self.sign * self.amplitude * displacement[0], self.amplitude * displacement[1]]
    }
}

/// One to three events: phase of the run, right, up.
fn events() -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec(prop::array::uniform3(-1.0..1.0), 1..4).prop_map(|list| {
        list.into_iter()
            .map(|[phase, right, up]: [f64; 3]| [0.5 + 0.45 * phase, right, up])
            .collect::<Vec<_>>()
    })
}

pub(crate) fn kinds() -> impl Strategy<Value = ShakingKind> {
    prop_oneof![
        (1.0..20.0).prop_map(|begin| ShakingKind::Record { begin }),
        events().prop_map(ShakingKind::Jumps),
        events().prop_map(ShakingKind::Pulses),
        (1.0..6.0).prop_map(|periods| ShakingKind::Vertical { periods }),
    ]
}
