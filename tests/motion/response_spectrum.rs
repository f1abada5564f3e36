//! GOAL: elastic response spectra are right, and warn of too few samples.
//! SCENE: El Centro; a constant acceleration; very stiff and very soft oscillators.
//! REFERENCE: matrix exponentials, a published table, closed forms and limits.

use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::unobserved;

use basemat_problems::table;

/// GOAL: spectra of El Centro agree with matrix exponentials, to the decimals printed.
#[test]
fn el_centro_agrees_with_matrix_exponentials() {
    let columns = ["period_s", "damping", "pseudo_acceleration_g", "acceleration_g"];
    let record = el_centro_1940();
    let mut largest_error = 0.0_f64;
    let rows = table("response_spectra_el_centro.csv").rows(columns);
    for [period, damping, pseudo, total] in rows {
        let point = record.response_spectrum(&[period], damping, &mut unobserved).unwrap()[0];
        for (computed, expected) in
            [(point.pseudo_acceleration, pseudo), (point.acceleration, total)]
        {
            // The table is printed to 9 decimals.
            let rounding = 1e-9 / expected;
            let error = (computed / STANDARD_GRAVITY / expected - 1.0).abs();
            largest_error = largest_error.max(error - rounding);
        }
    }
    assert!(largest_error < 2e-6, "{largest_error:e}");
}

/// GOAL: spectra of El Centro agree with a published table, up to peaks between its time steps.
///
/// The table takes the largest response at steps of 0.02 s, of 0.005 s for periods below 0.5 s (an integration by
/// matrix exponentials with these steps gives its six digits). It misses the peaks between them: by step²/8 of the
/// largest second derivative there, which is at most ω² S_d + PGA, and a little more for damping. Other rows of the
/// table are of other processings of the earthquake, whose samples are not shipped.
#[test]
fn el_centro_agrees_with_a_published_table() {
    let columns = ["Sa5_0.1", "Sa5_0.2", "Sa5_0.3", "Sa5_0.5", "Sa5_1.0"];
    let file = "elcentro1940_NS_peknold_0319g.csv";
    let expected = table("summary_records.csv").row("file", file, columns);
    let periods = columns.map(|name| name[4..].parse::<f64>().unwrap());
    let record = el_centro_1940();
    let spectrum = record.response_spectrum(&periods, 0.05, &mut unobserved).unwrap();
    let peak = record.peaks().acceleration;
    for (point, expected) in spectrum.iter().zip(expected) {
        let step = if point.period < 0.5 { 0.005 } else { 0.02 };
        let phase_step = std::f64::consts::TAU * step / point.period;
        let ground = peak / point.pseudo_acceleration;
        let missed =
            1.0 + phase_step * phase_step / 8.0 * (1.0 + ground) * (1.0 + 0.05 * phase_step);
        let ratio = point.pseudo_acceleration / STANDARD_GRAVITY / expected;
        // Rounding of the printed digits.
        let rounding = 5e-7 / expected;
        let limits = 1.0 - rounding..missed + rounding;
        assert!(limits.contains(&ratio), "{}: {ratio}", point.period);
    }
}

/// GOAL: a suddenly applied constant acceleration doubles deflection and total acceleration of an undamped oscillator.
#[test]
fn a_step_load_doubles_the_response() {
    let record = Record::new(0.013, vec![2.0; 400]).unwrap();
    for period in [0.031, 0.2, 1.7] {
        let point = record.response_spectrum(&[period], 0.0, &mut unobserved).unwrap()[0];
        assert!((point.pseudo_acceleration / 4.0 - 1.0).abs() < 1e-5);
        assert!((point.acceleration / 4.0 - 1.0).abs() < 1e-5);
        let omega = std::f64::consts::TAU / period;
        assert!((point.pseudo_velocity - omega * point.displacement).abs() < 1e-12);
    }
}

/// GOAL: stiff oscillators follow the ground; soft ones stay at rest while it moves.
#[test]
fn stiff_oscillators_follow_the_ground_and_soft_ones_stay() {
    let record = el_centro_1940();
    let spectrum = record.response_spectrum(&[1e-3, 1e3], 0.05, &mut unobserved).unwrap();
    assert!((spectrum[0].acceleration / record.peaks().acceleration - 1.0).abs() < 2e-3);
    assert!((spectrum[1].displacement / record.peaks().displacement - 1.0).abs() < 2e-2);
}

/// GOAL: periods and damping ratios out of range are errors.
#[test]
fn invalid_input_is_an_error() {
    let record = el_centro_1940();
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-12, 1e300, 1e-300] {
        let result = record.response_spectrum(&[1.0, period], 0.05, &mut unobserved);
        assert!(result.is_err(), "{period}");
    }
    for damping in [-0.01, 1.0, f64::NAN, f64::INFINITY] {
        assert!(record.response_spectrum(&[1.0], damping, &mut unobserved).is_err(), "{damping}");
    }
    assert!(record.response_spectrum(&[], 0.05, &mut unobserved).unwrap().is_empty());
}

/// Period of the sine, s.
const SINE_PERIOD: f64 = 0.5;

/// A long sine, from `count` samples in a period.
fn sampled_sine(count: f64) -> Record {
    let wave = |t: f64| (std::f64::consts::TAU * t / SINE_PERIOD).sin();
    Record::from_fn(SINE_PERIOD / count, 30.0, wave).unwrap()
}

/// GOAL: fewer than ten samples in a period give a warning.
/// REFERENCE: samples joined by lines keep (sin x/x)² of a sine, x = π/n for n samples in its period.
#[test]
fn spectra_of_few_samples_cause_a_warning() {
    let damping = 0.05;
    for count in [40.0, 20.0, 10.0, 5.0, 2.5] {
        let record = sampled_sine(count);
        let point = record.response_spectrum(&[SINE_PERIOD], damping, &mut unobserved).unwrap()[0];
        let computed = point.pseudo_acceleration;
        let x = std::f64::consts::PI / count;
        let expected = 0.5 / damping * (x.sin() / x).powi(2);
        // 2.5 samples in a period contain harmonics near the sine, too.
        assert!((computed / expected - 1.0).abs() < 0.04, "{count}: {computed} {expected}");
        let warning = record.coarse_spectrum(&[2.0, SINE_PERIOD, 1.0]);
        let expected_period = (count < 10.0).then_some(SINE_PERIOD);
        assert_eq!(warning.map(|warning| warning.period), expected_period, "{count}");
        assert!(warning.is_none_or(|warning| warning.to_string().contains("at 0.500 s")));
        assert_eq!(record.coarse_spectrum(&[]), None);
    }
}
