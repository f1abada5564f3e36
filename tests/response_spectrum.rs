//! Response spectra against an independent integration, closed forms and limits.

use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};

#[test]
fn el_centro_agrees_with_matrix_exponentials() {
    let table = include_str!("data/response_spectra_el_centro.csv");
    let rows = table.lines().filter(|line| !line.starts_with(['#', 'p']));
    let record = el_centro_1940();
    let mut worst = 0.0_f64;
    for row in rows {
        let [period, damping, pseudo, total] = row
            .split(',')
            .map(|field| field.parse::<f64>().unwrap())
            .collect::<Vec<_>>()
            .try_into()
            .unwrap();
        let found = record.response_spectrum(&[period], damping).unwrap()[0];
        for (found, known) in [(found.pseudo_acceleration, pseudo), (found.acceleration, total)] {
            // The table is printed to 9 decimals.
            let slack = 1e-9 / known;
            worst = worst.max((found / STANDARD_GRAVITY / known - 1.0).abs() - slack);
        }
    }
    assert!(worst < 2e-6, "{worst:e}");
}

/// `summary_records.csv` of the reference tables takes peaks at the samples, at a quarter of them
/// for short periods: its ordinates are a little low.
#[test]
fn el_centro_agrees_with_a_published_table() {
    let record = el_centro_1940();
    for (period, in_g) in
        [(0.1, 0.645_646), (0.2, 0.819_514), (0.3, 0.760_019), (0.5, 0.915_992), (1.0, 0.454_068)]
    {
        let found = record.response_spectrum(&[period], 0.05).unwrap()[0];
        let ratio = found.pseudo_acceleration / STANDARD_GRAVITY / in_g;
        assert!((0.999_999..1.006).contains(&ratio), "{period}: {ratio}");
    }
}

/// A constant acceleration switched on moves an undamped oscillator to twice its static
/// deflection; its total acceleration too is doubled.
#[test]
fn step_load_doubles() {
    let record = Record::new(0.013, vec![2.0; 400]).unwrap();
    for period in [0.031, 0.2, 1.7] {
        let found = record.response_spectrum(&[period], 0.0).unwrap()[0];
        assert!((found.pseudo_acceleration / 4.0 - 1.0).abs() < 1e-5);
        assert!((found.acceleration / 4.0 - 1.0).abs() < 1e-5);
        let omega = std::f64::consts::TAU / period;
        assert!((found.pseudo_velocity - omega * found.displacement).abs() < 1e-12);
    }
}

#[test]
fn stiff_oscillators_ride_and_soft_ones_stay() {
    let record = el_centro_1940();
    let spectrum = record.response_spectrum(&[1e-3, 1e3], 0.05).unwrap();
    assert!((spectrum[0].acceleration / record.peak_acceleration() - 1.0).abs() < 2e-3);
    assert!((spectrum[1].displacement / record.peak_displacement() - 1.0).abs() < 2e-2);
}

#[test]
fn bad_input_is_refused() {
    let record = el_centro_1940();
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-12, 1e300, 1e-300] {
        assert!(record.response_spectrum(&[1.0, period], 0.05).is_err(), "{period}");
    }
    for damping in [-0.01, 1.0, f64::NAN, f64::INFINITY] {
        assert!(record.response_spectrum(&[1.0], damping).is_err(), "{damping}");
    }
    assert!(record.response_spectrum(&[], 0.05).unwrap().is_empty());
}
