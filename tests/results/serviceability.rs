//! GOAL: checks of serviceability have the right verdict, margin and first excess, in the run, its page and its table.
//! SCENE: a block that rocks and slides under El Centro.
//! REFERENCE: the states of the run.

use basemat::Error;
use basemat::coupled::State;
use basemat::results::Run;
use basemat::results::{Comparison, Criterion, ServiceCheck, Serviceability};

use super::{FRICTION_COEFFICIENT, STEP_COUNT};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

/// A run with limits, and its states.
struct CheckedRun {
    run: Run,
    states: Vec<State>,
}

fn checked_run(limits: Serviceability) -> CheckedRun {
    let builder = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(FRICTION_COEFFICIENT));
    let mut simulation = builder.serviceability(limits).build().unwrap();
    let mut states = vec![simulation.state().clone()];
    let run = simulation.run(STEP_COUNT, |state| states.push(state.clone())).unwrap();
    CheckedRun { run, states }
}

fn value(criterion: Criterion, state: &State) -> f64 {
    match criterion {
        Criterion::Slip => state.mean_slip.abs(),
        Criterion::Gap => {
            state.contact.iter().fold(0.0, |largest, contact| contact.gap.max(largest))
        }
        Criterion::UpliftedFraction => state.uplifted_fraction,
        Criterion::Settlement => state.foundations[0].settlement.max(0.0),
        _ => state.base_rotation.abs(),
    }
}

/// Text of the cell of a table's first row under this heading.
fn cell<'a>(csv: &'a str, name: &str) -> &'a str {
    let mut lines = csv.lines();
    let place = lines.next().unwrap().split(',').position(|heading| heading == name).unwrap();
    lines.next().unwrap().split(',').nth(place).unwrap()
}

#[test]
fn verdicts_are_those_of_the_states() {
    let CheckedRun { run: free, states } = checked_run(Serviceability::default());
    assert!(free.serviceability.is_empty() && free.is_serviceable().is_none());
    assert!(!free.to_string().contains("Serviceability"));
    let criteria = [
        Criterion::Slip,
        Criterion::Gap,
        Criterion::UpliftedFraction,
        Criterion::Rotation,
        Criterion::Settlement,
    ];
    let peaks =
        criteria.map(|criterion| states.iter().map(|s| value(criterion, s)).fold(0.0, f64::max));
    assert!(peaks.iter().all(|peak| *peak > 0.0));
    for factor in [0.5, 1.0, 2.0] {
        let limits = Serviceability {
            slip: Some(factor * peaks[0]),
            gap: Some(factor * peaks[1]),
            uplifted_fraction: Some((factor * peaks[2]).min(1.0)),
            rotation: Some(factor * peaks[3]),
            settlement: Some(factor * peaks[4]),
        };
        let CheckedRun { run, states: repeated_states } = checked_run(limits);
        assert_eq!(repeated_states.len(), states.len());
        assert_eq!(run.whole.base_shear, free.whole.base_shear);
        assert_eq!(run.serviceability.len(), 5);
        for ((check, criterion), peak) in run.serviceability.iter().zip(criteria).zip(peaks) {
            assert_eq!(check.criterion, criterion);
            assert_eq!(check.largest.value.abs(), peak);
            let first = states.iter().find(|s| value(criterion, s) > check.limit);
            assert_eq!(check.first_excess, first.map(|s| s.time), "{criterion:?}");
            assert_eq!(check.is_met(), peak <= check.limit);
            assert!((check.margin() - (1.0 - peak / check.limit)).abs() < 1e-15);
        }
        assert_eq!(run.is_serviceable(), Some(factor >= 1.0));
        let page = run.to_string();
        let verdict = if factor < 1.0 { "Serviceability: not met" } else { "Serviceability: met" };
        assert!(page.contains(verdict), "{page}");
        assert_eq!(page.contains("exceeded from"), factor < 1.0);
        let margin =
            run.serviceability.iter().map(ServiceCheck::margin).fold(f64::INFINITY, f64::min);
        let first = run.serviceability.iter().filter_map(|check| check.first_excess);
        let first = first.reduce(f64::min).map_or(String::new(), |time| time.to_string());
        let csv = Comparison::from_iter([("a", run.clone())]).csv();
        assert_eq!(cell(&csv, "serviceability_margin").parse(), Ok(margin));
        assert_eq!(cell(&csv, "serviceability_first_excess_s"), first);
    }
}

fn build(limits: Serviceability) -> Result<(), Error> {
    let builder = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(FRICTION_COEFFICIENT));
    builder.serviceability(limits).build().map(|_| ())
}

/// GOAL: invalid limits are errors that name the limit.
#[test]
fn invalid_limits_are_errors() {
    let no_limits = Serviceability::default();
    for invalid_value in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let result = [
            Serviceability { slip: Some(invalid_value), ..no_limits },
            Serviceability { gap: Some(invalid_value), ..no_limits },
            Serviceability { uplifted_fraction: Some(invalid_value), ..no_limits },
            Serviceability { rotation: Some(invalid_value), ..no_limits },
            Serviceability { settlement: Some(invalid_value), ..no_limits },
        ]
        .map(build);
        let names = [
            "allowable slip",
            "allowable gap",
            "allowable uplifted fraction",
            "allowable rotation",
            "allowable settlement",
        ];
        for (result, name) in result.into_iter().zip(names) {
            assert!(
                matches!(result, Err(Error::Input { quantity, value, .. })
                    if quantity == name && value.to_bits() == invalid_value.to_bits()),
                "{name} {invalid_value}"
            );
        }
    }
    let above_one = Serviceability { uplifted_fraction: Some(1.0 + 1e-12), ..no_limits };
    let one = Serviceability { uplifted_fraction: Some(1.0), ..no_limits };
    assert!(build(above_one).is_err() && build(one).is_ok());
}
