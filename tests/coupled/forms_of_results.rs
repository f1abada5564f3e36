//! GOAL: results and states are read as they were written, also numbers that are not finite.
//! SCENE: a run with uplift, sliding, probes and warnings; its time series, checkpoint and state.
//! REFERENCE: the value that was written.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::{Checkpoint, EnergyBalance, Probe, Warning};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::results::{Peak, Quantity, Recorder, Run, Serviceability, TimeSeries};
use basemat::structure::RigidBlock;
use serde_json::{Value, json};

use super::forms::{assert_form, assert_round_trip, count_closed_objects};

/// Runs a block with uplift, sliding, probes, limits, warnings and infinite factors of safety.
fn run_block() -> (Simulation, Run) {
    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let mut simulation = Simulation::builder(0.08)
        .probe(Probe::displacement("top", block.horizontal_at(6.0)))
        .probe(Probe::acceleration("roof", block.horizontal_at(6.0)))
        .structure(block)
        .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7).unwrap())
        .interface(Coulomb::new(0.3).unwrap())
        .serviceability(Serviceability { slip: Some(1e-3), ..Serviceability::default() })
        .motion(el_centro_1940())
        .build()
        .unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    (simulation, run)
}

fn simulation_after_run() -> Simulation {
    run_block().0
}

#[test]
fn runs_are_read_as_written() {
    let (simulation, run) = run_block();
    let text = serde_json::to_string(&run).unwrap();
    let mut run_read: Run = serde_json::from_str(&text).unwrap();
    assert!(count_closed_objects::<Run>(&serde_json::from_str(&text).unwrap()) > 20);
    count_closed_objects::<Checkpoint>(
        &serde_json::to_value(simulation.checkpoint().unwrap()).unwrap(),
    );
    assert_eq!(serde_json::to_string(&run_read).unwrap(), text);
    assert_eq!(run_read.to_string(), run.to_string());
    assert_eq!((run_read.wall, run_read.energy_balance), (run.wall, run.energy_balance));
    assert!(
        !run.foundations[0].sliding.events.is_empty()
            && !run.warnings.is_empty()
            && run.whole.uplift.count > 0
    );
    for foundation in &run.foundations {
        assert_round_trip(foundation);
    }
    assert_round_trip(&(
        run.whole.base_shear,
        run.whole.uplift,
        run.whole.sliding.clone(),
        run.fallbacks,
    ));
    assert_round_trip(&(run.envelope.clone(), run.probes.clone(), run.serviceability.clone()));
    assert_round_trip(&run.warnings);
    assert_round_trip(&simulation.conditioning());

    // A run that was read records no further states, and ending it again changes nothing.
    run_read.record(simulation.state());
    assert_eq!(run_read.steps, run.steps);
    let ended_run = simulation.end_run(run_read);
    assert_eq!(serde_json::to_string(&ended_run).unwrap(), text);
}

#[test]
fn time_series_are_read_as_written() {
    let mut simulation = simulation_after_run();
    let mut series = Recorder::new().contact(2).motion(5).start(&simulation).unwrap();
    simulation.run(40, |state| series.record(state)).unwrap();
    let form = serde_json::to_value(&series).unwrap();
    assert!(count_closed_objects::<TimeSeries>(&form) > 20);
    let mut series_read: TimeSeries = serde_json::from_value(form.clone()).unwrap();
    assert_eq!(serde_json::to_value(&series_read).unwrap(), form);
    assert_eq!(series_read.times(), series.times());
    let safety = Quantity::OverturningSafety;
    assert_eq!(series_read.series(safety), series.series(safety));
    assert_eq!(series_read.contact_frames().count(), 21);
    assert!(series_read.contact_frames().eq(series.contact_frames()));
    assert!(series_read.motion_frames().eq(series.motion_frames()));
    // An acceleration has a record if every step up to the end is there.
    assert_eq!(series_read.acceleration_record("roof").map(|record| record.len()), Ok(41));
    let mut form_of_later_end = form.clone();
    form_of_later_end["end"] = json!(series.times()[40] + 1.0);
    let incomplete: TimeSeries = serde_json::from_value(form_of_later_end).unwrap();
    assert!(incomplete.acceleration_record("roof").is_err());
    // A series that was read records no further steps.
    simulation.step().unwrap();
    series_read.record(simulation.state()).unwrap();
    assert_eq!(series_read.times().len(), 41);
}

#[test]
fn time_series_of_unequal_lists_are_errors() {
    let mut simulation = simulation_after_run();
    let mut series = Recorder::new().contact(2).motion(5).start(&simulation).unwrap();
    simulation.run(40, |state| series.record(state)).unwrap();
    let form = serde_json::to_value(&series).unwrap();
    for (list, reason) in [
        ("times", "list of energy balances has length 41, but must have 40"),
        ("scalars", "list of scalars has length 12, but must have 13"),
        ("probe_values", "list of probes has length 1, but must have 2"),
        ("energy_balances", "list of energy balances has length 40, but must have 41"),
        ("elements", "whole frames"),
    ] {
        let mut short_form = form.clone();
        short_form[list].as_array_mut().unwrap().pop().unwrap();
        let error = serde_json::from_value::<TimeSeries>(short_form).unwrap_err().to_string();
        assert!(error.contains(reason), "{list}: {error}");
    }
    let mut short_form = form;
    short_form["probe_values"][0].as_array_mut().unwrap().pop().unwrap();
    assert!(serde_json::from_value::<TimeSeries>(short_form).is_err());
}

#[test]
fn states_are_written() {
    let simulation = simulation_after_run();
    let state = simulation.state();
    let form = serde_json::to_value(state).unwrap();
    assert_eq!(form["time"], json!(state.time));
    assert_eq!(form["probes"], json!(state.probes));
    assert_eq!(form["contact"][3]["pressure"], json!(state.contact[3].pressure));
    assert_eq!(form["modes"][0], json!(state.modes[0].to_string()));
    assert_eq!(form["foundations"][0]["elements"], json!({"start": 0, "end": 8}));
    for private_field in ["origin", "probe_names", "motion", "start"] {
        assert!(form.get(private_field).is_none(), "{private_field}");
    }
    assert_round_trip(&state.foundations);
    assert_round_trip(&state.contact);
}

#[test]
fn numbers_that_are_not_finite_are_read_as_written() {
    for (value, form) in [
        (f64::INFINITY, json!("inf")),
        (f64::NEG_INFINITY, json!("-inf")),
        (-0.0, json!(-0.0)),
        (1.0 / 3.0, json!(1.0 / 3.0)),
    ] {
        assert_form(&Peak { value, time: 0.0 }, json!({"value": form, "time": 0.0}));
    }
    let peak: Peak = serde_json::from_value(json!({"value": null, "time": 3})).unwrap();
    assert!(peak.value.is_nan() && peak.time == 3.0);
    assert_eq!(serde_json::to_value(peak).unwrap(), json!({"value": null, "time": 3.0}));
    let warnings: Vec<Warning> =
        serde_json::from_value(json!([{"energy_balance": {"residual": "inf"}}])).unwrap();
    assert_eq!(warnings, [Warning::EnergyBalance { residual: f64::INFINITY }]);

    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let simulation = Simulation::builder(0.01)
        .structure(block)
        .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .without_energy_balance()
        .build()
        .unwrap();
    let energy_balance = simulation.state().energy_balance;
    assert!(energy_balance.input.is_nan());
    assert_eq!(assert_round_trip(&energy_balance)["input"], Value::Null);
    let mut form = assert_round_trip(&EnergyBalance::default());
    form["soil"] = json!("inf");
    assert_eq!(serde_json::from_value::<EnergyBalance>(form).unwrap().soil, f64::INFINITY);
}
