//! GOAL: the component of a wave that is late by a quarter of a period is the Hilbert transform of the other one.
//! SCENE: Rayleigh waves and SV waves beyond the critical angle, Gaussian and Ricker pulses, El Centro.
//! REFERENCE: Hilbert transforms in closed form; records with quiet time around them.

use basemat::Error;
use basemat::motion::{FreeField, PlaneWave, Record};

use super::inclined_waves::{el_centro_to_rest, gaussian_window, soil, sv};
use basemat_problems::table;

/// A wave whose vertical component is proportional to the Hilbert transform of the horizontal one.
fn rayleigh() -> PlaneWave {
    PlaneWave::rayleigh(soil(1.0 / 3.0))
}

/// Factor of the Hilbert transform in the vertical component.
fn hilbert_factor(wave: &PlaneWave) -> f64 {
    wave.amplification()[1][1]
}

/// Second derivative of the Gaussian exp(−x²/2).
fn gaussian_acceleration(x: f64) -> f64 {
    (x * x - 1.0) * (-0.5 * x * x).exp()
}

/// Second derivative of Ricker's pulse.
fn ricker_acceleration(x: f64) -> f64 {
    (x * x * (6.0 - x * x) - 3.0) * (-0.5 * x * x).exp()
}

/// GOAL: the late component of a pulse is right, also long before and after its record, which ends shortly after the pulse.
/// SCENE: a Gaussian, mainly of long period, whose transform decays as 1/t, and Ricker's pulse.
/// REFERENCE: Hilbert transforms in closed form.
#[test]
fn the_late_component_of_a_pulse_has_its_closed_form() {
    let table = table("hilbert_pulses.csv");
    let width = 0.7;
    let center = 6.0;
    let time_step = 0.0025;
    let wave = rayleigh();
    let factor = hilbert_factor(&wave);
    for (column, acceleration) in
        [(0, gaussian_acceleration as fn(f64) -> f64), (1, ricker_acceleration)]
    {
        let samples = (0..4800).map(|k| acceleration((f64::from(k) * time_step - center) / width));
        let record =
            Record::new(time_step, samples.map(|a| a / (width * width)).collect()).unwrap();
        let field = wave.field_from_horizontal(&record, 0.0).unwrap();
        // Displacements from the one at x = 0, where the transforms vanish.
        let start = field.displacement(0.0, center)[1] / factor;
        for row in table.rows(["x", "gaussian", "ricker"]) {
            let x = row[0];
            let expected = row[1 + column];
            let time = center + width * x;
            let computed = field.displacement(0.0, time)[1] / factor - start;
            assert!((computed - expected).abs() < 3e-6, "{x}: {computed} {expected}");
            if column == 0 {
                // The derivative of Dawson's integral D is 1 − 2xD.
                let slope = (2.0 / std::f64::consts::PI).sqrt() - x * expected;
                let computed = field.velocity(0.0, time)[1] / factor * width;
                assert!((computed - slope).abs() < 1e-5, "{x}: {computed} {slope}");
            }
        }
    }
}

/// Times of the compared displacements, s.
const COMPARED_TIMES: [f64; 7] = [0.5, 2.0, 10.0, 20.0, 30.0, 40.0, 90.0];

/// Vertical motion of a wave whose horizontal one is a padded record.
struct PaddedMotion {
    /// At the compared times, from the displacement at the record's start.
    displacements: [f64; 7],
    initial_velocity: f64,
    /// Final velocity of the padded record.
    drift: f64,
}

impl PaddedMotion {
    fn new(wave: &PlaneWave, before: f64, after: f64) -> Self {
        let padded = el_centro_to_rest().padded(before, after).unwrap();
        let field = wave.field_from_horizontal(&padded, 0.0).unwrap();
        let start = field.displacement(0.0, before)[1];
        Self {
            displacements: COMPARED_TIMES
                .map(|time| field.displacement(0.0, before + time)[1] - start),
            initial_velocity: field.velocity(0.0, 0.0)[1],
            drift: padded.at(padded.duration()).velocity.abs(),
        }
    }
}

/// GOAL: a record has the same transform however long the quiet time around it; the initial velocity decreases.
#[test]
fn quiet_time_changes_nothing_but_the_start() {
    let beyond_critical = sv(1.0 / 3.0, 35.0_f64.to_radians());
    for wave in [rayleigh(), beyond_critical] {
        let unpadded = PaddedMotion::new(&wave, 0.0, 0.0);
        for (before, after) in
            [(2.0, 0.0), (60.0, 0.0), (1000.0, 0.0), (2.0, 8.0), (60.0, 60.0), (1000.0, 1000.0)]
        {
            let padded = PaddedMotion::new(&wave, before, after);
            for (k, time) in COMPARED_TIMES.into_iter().enumerate() {
                // A zero after a last sample that is not zero leaves a small velocity, which lasts
                // for as long as the record is padded.
                let tolerance = 1e-9 + 3.0 * padded.drift * time;
                let a = unpadded.displacements[k];
                let b = padded.displacements[k];
                assert!((a - b).abs() < tolerance, "{time} s: {a} {b} with {before} and {after} s");
            }
            assert!(padded.initial_velocity.abs() < unpadded.initial_velocity.abs());
        }
        // Far away the velocity is the record's first moment over the square of the distance.
        let ratio = PaddedMotion::new(&wave, 500.0, 0.0).initial_velocity
            / PaddedMotion::new(&wave, 1000.0, 0.0).initial_velocity;
        assert!((ratio - 4.0).abs() < 0.3, "{ratio}");
    }
}

/// GOAL: a prescribed vertical component is led by the horizontal one, as it lags otherwise.
#[test]
fn either_component_can_be_prescribed() {
    let record = el_centro_to_rest().padded(5.0, 0.0).unwrap();
    let wave = rayleigh();
    let factor = hilbert_factor(&wave);
    let from_horizontal = wave.field_from_horizontal(&record, 0.0).unwrap();
    let from_vertical = wave.field_from_vertical(&record, 0.0).unwrap();
    for time in [-3.0, 4.0, 9.1, 17.0, 60.0] {
        let lagging = from_horizontal.displacement(0.0, time);
        let leading = from_vertical.displacement(0.0, time);
        assert_eq!(lagging[0], leading[1]);
        let difference = lagging[1] + factor * factor * leading[0];
        assert!(difference.abs() < 1e-12, "{lagging:?} {leading:?}");
    }
}

/// GOAL: a record that does not end at rest has no transform and is an error.
#[test]
fn records_that_do_not_end_at_rest_are_errors() {
    let drifting = Record::new(0.1, vec![0.0, 1.0, 0.0, -0.9, 0.0]).unwrap();
    let wave = rayleigh();
    for outcome in
        [wave.field_from_horizontal(&drifting, 0.0), wave.field_from_vertical(&drifting, 0.0)]
    {
        let Err(Error::Input { quantity, value, .. }) = outcome else {
            panic!("accepted")
        };
        assert_eq!(quantity, "velocity at the end of the record");
        assert!((value - 0.01).abs() < 1e-12);
    }
    assert!(wave.field_from_horizontal(&Record::new(0.1, vec![0.0; 5]).unwrap(), 0.0).is_ok());
    // A wave below the critical angle, whose components are in phase, needs no transform.
    assert!(sv(0.25, 0.3).field_from_horizontal(&drifting, 0.0).is_ok());
}

/// GOAL: the transform of a windowed cosine is the windowed sine; the transform of the transform is minus the record.
#[test]
fn hilbert_transforms_are_a_quarter_of_a_period_late() {
    let omega = 12.0_f64;
    let times: Vec<f64> = (0..2001).map(|k| f64::from(k) * 0.01).collect();
    let samples = times.iter().map(|&t| gaussian_window(t, 2.0) * (omega * t).cos());
    let record = Record::new(0.01, samples.collect()).unwrap();
    let late = record.hilbert_transform().unwrap();
    for (&t, computed) in times.iter().zip(late.accelerations()) {
        let expected = gaussian_window(t, 2.0) * (omega * t).sin();
        assert!((computed - expected).abs() < 1e-12, "{t}");
    }
    let twice = late.hilbert_transform().unwrap();
    for (a, b) in record.accelerations().iter().zip(twice.accelerations()) {
        assert!((a + b).abs() < 1e-12);
    }
    let padded = record.padded(0.995, 2.0).unwrap();
    assert_eq!(padded.len(), 2001 + 100 + 200);
    assert_eq!(padded.accelerations()[100..2101], *record.accelerations());
    for padding in [-1.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(record.padded(padding, 0.0).is_err() && record.padded(0.0, padding).is_err());
    }
}
