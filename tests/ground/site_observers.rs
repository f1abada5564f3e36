//! GOAL: motions through a site report their progress and can be stopped; their results do not change.
//! SCENE: vertical and inclined waves, motions in three directions and the equivalent-linear iteration through 12 layers.
//! REFERENCE: the same calls without an observer.

use std::ops::ControlFlow::Continue;

use basemat::motion::{FreeField, Record, TravellingWave, Triaxial, el_centro_1940};
use basemat::site::{
    ControlPoint, EquivalentLinear, EquivalentLinearOptions, InclinedControl, InclinedWave,
    LayerResponse, SoilColumn, VerticalWave,
};
use basemat::soil::{SoilProfile, StrainCurves};
use basemat::{Observer, Soil, unobserved};

use super::observers::{check_observed, count_reports};
use basemat_problems::profiles::gmb;

/// Twelve damped layers, stiffer with depth, on rock.
fn profile() -> SoilProfile {
    let rock = Soil::from_shear_wave_speed(800.0, 0.3, 1900.0).unwrap();
    let mut profile = SoilProfile::on_half_plane(rock).with_bedrock_damping(gmb(1));
    for k in 0..12 {
        let speed = 180.0 + 10.0 * f64::from(k);
        let layer = Soil::from_shear_wave_speed(speed, 0.3, 1900.0).unwrap();
        profile = profile.with_layer(layer, 3.0).unwrap().with_damping(gmb(5));
    }
    profile
}

fn column() -> SoilColumn {
    SoilColumn::new(profile(), VerticalWave::Shear).unwrap()
}

/// GOAL: motions through a column, up and down, report often enough to be interrupted.
#[test]
fn site_response_reports_and_stops() {
    let record = el_centro_1940();
    let control = ControlPoint::Outcrop;
    let step = record.time_step();
    let samples = record.accelerations();
    let column = column();
    let expected = column.to_surface(control, step, samples, &mut unobserved).unwrap();
    let to_surface =
        |observer: &mut Observer<'_>| column.to_surface(control, step, samples, observer);
    check_observed(to_surface, Some(&expected));
    assert!(count_reports(|observer| drop(to_surface(observer))) > 50);
    let expected = column.from_surface(control, step, samples, &mut unobserved).unwrap();
    check_observed(
        |observer| column.from_surface(control, step, samples, observer),
        Some(&expected),
    );
}

/// GOAL: transfer functions of many frequencies are those of each, report and stop.
#[test]
fn transfer_functions_report_and_stop() {
    let control = ControlPoint::Outcrop;
    let column = column();
    let frequencies: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
    let transfers = column.transfers(control, &frequencies, &mut |_| Continue(())).unwrap();
    for (frequency, computed) in frequencies.iter().zip(&transfers) {
        let expected = column.transfer(control, *frequency).unwrap();
        assert!((*computed + expected * -1.0).abs() < 1e-13 * expected.abs(), "{frequency}");
    }
    check_observed(|observer| column.transfers(control, &frequencies, observer), Some(&transfers));
}

/// GOAL: motions and records of inclined waves report and stop; their field travels with the records.
#[test]
fn inclined_waves_report_and_stop() {
    let record = el_centro_1940();
    let step = record.time_step();
    let samples = record.accelerations();
    let wave = InclinedWave::sv(profile(), 0.2).unwrap();
    let control = InclinedControl::OutcropHorizontal;
    let expected = wave.to_surface(control, step, samples, &mut unobserved).unwrap();
    check_observed(|observer| wave.to_surface(control, step, samples, observer), Some(&expected));
    let records = wave.surface_records(control, &record, &mut |_| Continue(())).unwrap();
    check_observed(|observer| wave.surface_records(control, &record, observer), Some(&records));
    let field = wave.field(control, &record, -3.0).unwrap();
    let travelling = TravellingWave::new(records, wave.apparent_velocity(), -3.0).unwrap();
    assert_eq!(field.displacement(2.0, 4.0), travelling.displacement(2.0, 4.0));
}

/// GOAL: a motion of several directions through the site reports and stops.
#[test]
fn motions_in_three_directions_report_and_stop() {
    let record = el_centro_1940();
    let motion = Triaxial { x: Some(record.clone()), y: None, up: Some(record) };
    let control = ControlPoint::Outcrop;
    let profile = profile();
    let expected =
        SoilColumn::surface_in_plan(&profile, control, &motion, &mut unobserved).unwrap();
    check_observed(
        |observer| SoilColumn::surface_in_plan(&profile, control, &motion, observer),
        Some(&expected),
    );
}

/// GOAL: the equivalent-linear analysis reports every iteration, in its frequencies and in its layers.
#[test]
fn equivalent_linear_iterations_report_and_stop() {
    let record = el_centro_1940();
    let column = column();
    let curves = vec![StrainCurves::VuceticDobry { plasticity_index: 30.0 }; 12];
    let options = EquivalentLinearOptions::default();
    let analyse = |observer: &mut Observer<'_>| {
        column.equivalent_linear(&record, &curves, &options, observer).map(compared_parts)
    };
    let expected = analyse(&mut unobserved).unwrap();
    check_observed(analyse, Some(&expected));
    assert!(count_reports(|observer| drop(analyse(observer))) > 300);
}

/// The parts of a result that can be compared.
fn compared_parts(result: EquivalentLinear) -> (Record, Vec<Vec<f64>>, Vec<LayerResponse>) {
    (result.surface, result.accelerations, result.layers)
}
