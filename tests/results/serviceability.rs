//! GOAL: limits of serviceability: verdict, margin, first excess, in the run, its page and its table.
//! SCENE: a block that rocks and slides under El Centro.
//! REFERENCE: the states of the run.

use basemat::Error;
use basemat::coupled::State;
use basemat::results::Run;
use basemat::results::{Comparison, Criterion, ServiceCheck, Serviceability};

use super::{FRICTION, STEPS};
use basemat_problems::scenes::{SI, block, friction, scene};

fn run(limits: Serviceability) -> (Run, Vec<State>) {
    let builder = scene(SI, 0.6).structure(block(SI)).interface(friction(FRICTION));
    let mut simulation = builder.serviceability(limits).build().unwrap();
    let mut states = vec![simulation.state().clone()];
    let run = simulation.run(STEPS, |state| states.push(state.clone())).unwrap();
    (run, states)
}

fn value(criterion: Criterion, state: &State) -> f64 {
    match criterion {
        Criterion::Slip => state.mean_slip.abs(),
        Criterion::Gap => state.contact.iter().fold(0.0, |most, own| own.gap.max(most)),
        Criterion::UpliftedFraction => state.uplifted_fraction,
        _ => state.base_rotation.abs(),
    }
}

#[test]
fn verdicts_are_those_of_the_states() {
    let (free, states) = run(Serviceability::default());
    assert!(free.serviceability.is_empty() && free.is_serviceable().is_none());
    assert!(!free.to_string().contains("Serviceability"));
    let peak = |criterion| states.iter().map(|s| value(criterion, s)).fold(0.0, f64::max);
    let wanted =
        [Criterion::Slip, Criterion::Gap, Criterion::UpliftedFraction, Criterion::Rotation];
    let peaks = wanted.map(peak);
    assert!(peaks.iter().all(|peak| *peak > 0.0));
    for share in [0.5, 1.0, 2.0] {
        let limit = |k: usize| share * peaks[k];
        let limits = Serviceability {
            slip: Some(limit(0)),
            gap: Some(limit(1)),
            uplifted_fraction: Some(limit(2).min(1.0)),
            rotation: Some(limit(3)),
        };
        let (run, again) = run(limits);
        assert_eq!(again.len(), states.len());
        assert_eq!(run.whole.base_shear, free.whole.base_shear);
        assert_eq!(run.serviceability.len(), 4);
        for ((check, criterion), peak) in run.serviceability.iter().zip(wanted).zip(peaks) {
            assert_eq!(check.criterion, criterion);
            assert_eq!(check.largest.value.abs(), peak);
            let first = states.iter().find(|s| value(criterion, s) > check.limit);
            assert_eq!(check.first_excess, first.map(|s| s.time), "{criterion:?}");
            assert_eq!(check.is_met(), peak <= check.limit);
            assert!((check.margin() - (1.0 - peak / check.limit)).abs() < 1e-15);
        }
        assert_eq!(run.is_serviceable(), Some(share >= 1.0));
        let page = run.to_string();
        let verdict = if share < 1.0 { "Serviceability: not met" } else { "Serviceability: met" };
        assert!(page.contains(verdict), "{page}");
        assert_eq!(page.contains("exceeded from"), share < 1.0);
        let least =
            run.serviceability.iter().map(ServiceCheck::margin).fold(f64::INFINITY, f64::min);
        let first = run.serviceability.iter().filter_map(|check| check.first_excess);
        let first = first.reduce(f64::min).map_or(String::new(), |time| time.to_string());
        let csv = Comparison::from_iter([("a", run.clone())]).csv();
        let [heading, line] = [0, 1].map(|k| csv.lines().nth(k).unwrap().split(','));
        let cell = |name: &str| {
            let place = heading.clone().position(|h| h == name).unwrap();
            line.clone().nth(place).unwrap().to_owned()
        };
        assert_eq!(cell("serviceability_margin").parse(), Ok(least));
        assert_eq!(cell("serviceability_first_excess_s"), first);
    }
}

/// GOAL: invalid limits are refused by name.
#[test]
fn bad_limits() {
    let none = Serviceability::default();
    let built = |limits| {
        let builder = scene(SI, 0.6).structure(block(SI)).interface(friction(FRICTION));
        builder.serviceability(limits).build().map(|_| ())
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let refused = [
            Serviceability { slip: Some(bad), ..none },
            Serviceability { gap: Some(bad), ..none },
            Serviceability { uplifted_fraction: Some(bad), ..none },
            Serviceability { rotation: Some(bad), ..none },
        ]
        .map(built);
        let names = [
            "allowable slip",
            "allowable gap",
            "allowable uplifted fraction",
            "allowable rotation",
        ];
        for (refused, name) in refused.into_iter().zip(names) {
            assert!(
                matches!(refused, Err(Error::Input { quantity, value, .. })
                    if quantity == name && value.to_bits() == bad.to_bits()),
                "{name} {bad}"
            );
        }
    }
    let uplifted = |limit| built(Serviceability { uplifted_fraction: Some(limit), ..none });
    assert!(uplifted(1.0 + 1e-12).is_err() && uplifted(1.0).is_ok());
}
