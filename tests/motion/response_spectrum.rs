//! GOAL: elastic response spectra.
//! SCENE: El Centro; a constant acceleration; very stiff and very soft oscillators.
//! REFERENCE: matrix exponentials, a published table, closed forms and limits.

use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::unobserved;

use basemat_problems::table;

#[test]
fn el_centro_agrees_with_matrix_exponentials() {
    let columns = ["period_s", "damping", "pseudo_acceleration_g", "acceleration_g"];
    let record = el_centro_1940();
    let mut worst = 0.0_f64;
    let rows = table("response_spectra_el_centro.csv").rows(columns);
    for [period, damping, pseudo, total] in rows {
        let found = record.response_spectrum(&[period], damping, &mut unobserved).unwrap()[0];
        for (found, known) in [(found.pseudo_acceleration, pseudo), (found.acceleration, total)] {
            // The table is printed to 9 decimals.
            let slack = 1e-9 / known;
            worst = worst.max((found / STANDARD_GRAVITY / known - 1.0).abs() - slack);
        }
    }
    assert!(worst < 2e-6, "{worst:e}");
}

/// The row of this record in the table of summaries; its other rows are of other processings of the
/// same earthquake, whose samples are not shipped. The table takes the largest response at steps of
/// 0.02 s, of 0.005 s for periods below 0.5 s (an integration by matrix exponentials with these steps
/// gives its six digits), and misses the peaks between them: by step²/8 of the largest second
/// derivative there, which is at most ω² S_d + PGA, and a little more for damping.
#[test]
fn el_centro_agrees_with_a_published_table() {
    let columns = ["Sa5_0.1", "Sa5_0.2", "Sa5_0.3", "Sa5_0.5", "Sa5_1.0"];
    let file = "elcentro1940_NS_peknold_0319g.csv";
    let known = table("summary_records.csv").row("file", file, columns);
    let periods = columns.map(|name| name[4..].parse::<f64>().unwrap());
    let record = el_centro_1940();
    let spectrum = record.response_spectrum(&periods, 0.05, &mut unobserved).unwrap();
    let peak = record.peaks().acceleration;
    for (found, known) in spectrum.iter().zip(known) {
        let step = if found.period < 0.5 { 0.005 } else { 0.02 };
        let way = std::f64::consts::TAU * step / found.period;
        let ground = peak / found.pseudo_acceleration;
        let missed = 1.0 + way * way / 8.0 * (1.0 + ground) * (1.0 + 0.05 * way);
        let ratio = found.pseudo_acceleration / STANDARD_GRAVITY / known;
        // The digits printed.
        let slack = 5e-7 / known;
        assert!((1.0 - slack..missed + slack).contains(&ratio), "{}: {ratio}", found.period);
    }
}

/// A constant acceleration switched on moves an undamped oscillator to twice its static
/// deflection; its total acceleration too is doubled.
#[test]
fn step_load_doubles() {
    let record = Record::new(0.013, vec![2.0; 400]).unwrap();
    for period in [0.031, 0.2, 1.7] {
        let found = record.response_spectrum(&[period], 0.0, &mut unobserved).unwrap()[0];
        assert!((found.pseudo_acceleration / 4.0 - 1.0).abs() < 1e-5);
        assert!((found.acceleration / 4.0 - 1.0).abs() < 1e-5);
        let omega = std::f64::consts::TAU / period;
        assert!((found.pseudo_velocity - omega * found.displacement).abs() < 1e-12);
    }
}

#[test]
fn stiff_oscillators_follow_the_ground_and_soft_ones_stay() {
    let record = el_centro_1940();
    let spectrum = record.response_spectrum(&[1e-3, 1e3], 0.05, &mut unobserved).unwrap();
    assert!((spectrum[0].acceleration / record.peaks().acceleration - 1.0).abs() < 2e-3);
    assert!((spectrum[1].displacement / record.peaks().displacement - 1.0).abs() < 2e-2);
}

#[test]
fn bad_input_is_refused() {
    let record = el_centro_1940();
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-12, 1e300, 1e-300] {
        assert!(
            record.response_spectrum(&[1.0, period], 0.05, &mut unobserved).is_err(),
            "{period}"
        );
    }
    for damping in [-0.01, 1.0, f64::NAN, f64::INFINITY] {
        assert!(record.response_spectrum(&[1.0], damping, &mut unobserved).is_err(), "{damping}");
    }
    assert!(record.response_spectrum(&[], 0.05, &mut unobserved).unwrap().is_empty());
}

/// A long sine at its own period: samples that are joined by lines keep (sin x/x)² of it, x = π/n for n in a period.
/// The warning says so from fewer than ten on.
#[test]
fn spectra_of_few_samples_warn() {
    let (period, damping) = (0.5, 0.05);
    for count in [40.0, 20.0, 10.0, 5.0, 2.5] {
        let step = period / count;
        let wave = |t: f64| (std::f64::consts::TAU * t / period).sin();
        let record = Record::from_fn(step, 30.0, wave).unwrap();
        let found = record.response_spectrum(&[period], damping, &mut unobserved).unwrap()[0]
            .pseudo_acceleration;
        let x = std::f64::consts::PI / count;
        let wanted = 0.5 / damping * (x.sin() / x).powi(2);
        // Samples at 2.5 in a period hold harmonics near it, too.
        assert!((found / wanted - 1.0).abs() < 0.04, "{count}: {found} {wanted}");
        let warning = record.coarse_spectrum(&[2.0, period, 1.0]);
        assert_eq!(warning.map(|own| own.period), (count < 10.0).then_some(period), "{count}");
        assert!(warning.is_none_or(|own| own.to_string().contains("at 0.500 s")));
        assert_eq!(record.coarse_spectrum(&[]), None);
    }
}
