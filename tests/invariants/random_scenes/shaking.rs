//! Ground motions that fill a run, whatever its length.

use basemat::motion::{FreeField, Record, el_centro_1940};
use proptest::prelude::*;

#[derive(Debug, Clone)]
pub(crate) enum Kind {
    /// Seconds of El Centro, squeezed or stretched to the run.
    Record { begin: f64 },
    /// Displacements that jump: phase of the run, right, up; in the amplitude.
    Jumps(Vec<[f64; 3]>),
    /// Ricker pulses: phase of the run, right, up.
    Pulses(Vec<[f64; 3]>),
    /// Up and down.
    Vertical { periods: f64 },
}

/// The free field of a scene, the same at all places.
#[derive(Debug, Clone)]
pub(crate) struct Shaking {
    pub(crate) kind: Kind,
    /// m.
    pub(crate) amplitude: f64,
    /// −1 exchanges left and right.
    pub(crate) sign: f64,
    /// s.
    pub(crate) delay: f64,
    pub(crate) duration: f64,
}

impl Kind {
    /// Displacement `[right, up]` at a phase of the run.
    fn at(&self, phase: f64) -> [f64; 2] {
        if phase <= 0.0 {
            return [0.0; 2];
        }
        let sum = |list: &[[f64; 3]], shape: &dyn Fn(f64) -> f64| {
            list.iter().fold([0.0; 2], |[x, y], [middle, right, up]| {
                let value = shape(phase - middle);
                [x + right * value, y + up * value]
            })
        };
        match self {
            Kind::Record { begin } => {
                let at = |t: f64| STRONG.with(|record| record.at(t).displacement);
                let along = at(begin + 2.0 * phase) - at(*begin);
                // Peaks of a centimetre or so.
                [100.0 * along, 30.0 * along]
            }
            Kind::Jumps(jumps) => sum(jumps, &|after| if after >= 0.0 { 0.3 } else { 0.0 }),
            Kind::Pulses(pulses) => {
                let ricker = |s: f64| (1.0 - 2.0 * s * s) * (-s * s).exp();
                sum(pulses, &|after| ricker(12.0 * after))
            }
            Kind::Vertical { periods } => {
                let angle = std::f64::consts::TAU * periods * phase.min(1.0);
                [0.0, 1.0 - angle.cos()]
            }
        }
    }
}

thread_local! {
    static STRONG: Record = el_centro_1940();
}

impl FreeField for Shaking {
    fn displacement(&self, _: f64, time: f64) -> [f64; 2] {
        let [right, up] = self.kind.at((time - self.delay) / self.duration);
        [self.sign * self.amplitude * right, self.amplitude * up]
    }
}

pub(crate) fn kinds() -> impl Strategy<Value = Kind> {
    let event = || {
        prop::collection::vec(prop::array::uniform3(-1.0..1.0), 1..4).prop_map(|list| {
            list.into_iter()
                .map(|[phase, right, up]: [f64; 3]| [0.5 + 0.45 * phase, right, up])
                .collect::<Vec<_>>()
        })
    };
    prop_oneof![
        (1.0..20.0).prop_map(|begin| Kind::Record { begin }),
        event().prop_map(Kind::Jumps),
        event().prop_map(Kind::Pulses),
        (1.0..6.0).prop_map(|periods| Kind::Vertical { periods }),
    ]
}
