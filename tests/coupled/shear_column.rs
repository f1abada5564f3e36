//! GOAL: a soil column that yields follows an independent program.
//! SCENE: 20 m of clay by Iwan's model, 40 eight-node elements with tied sides, on a rigid base.
//! REFERENCE: 40 two-node cells with lumped mass, Newmark's method, a tenth of the time step.

use basemat::motion::Record;
use basemat_problems::table;
use basemat_problems::yielding_column::{clay, response};

const ROW_COUNT: usize = 40;
const TIME_STEP: f64 = 0.005;
/// Corner frequency, Hz, of the filter on both sides: kinks of the law excite frequencies that the meshes do not resolve.
const CORNER_FREQUENCY: f64 = 10.0;

/// A series that has passed the filter.
fn filtered(time_step: f64, values: Vec<f64>) -> Vec<f64> {
    let sample_count = values.len();
    let record = Record::new(time_step, values).unwrap();
    let low = record.low_pass(CORNER_FREQUENCY, 4).unwrap();
    let pad_length = (low.len() - sample_count) / 2;
    low.accelerations()[pad_length..pad_length + sample_count].to_vec()
}

/// Largest difference of two series relative to the largest value of the second.
fn relative_difference(values: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(values.len(), reference.len());
    let pairs = values.iter().zip(reference);
    let max_difference = pairs.fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
    max_difference / reference.iter().fold(0.0_f64, |max, value| max.max(value.abs()))
}

#[test]
fn yielding_column_follows_the_independent_program() {
    let column = response(ROW_COUNT, TIME_STEP, &clay().into()).unwrap();
    let reference = table("yielding/column_iwan.csv");
    let top = filtered(0.01, reference.column("top_relative_displacement"));
    let stress = filtered(0.01, reference.column("base_shear_stress"));
    // The reference has every second of the steps.
    let sampled = |values: &[f64]| values.iter().skip(1).step_by(2).copied().collect::<Vec<_>>();
    let top_difference =
        relative_difference(&sampled(&filtered(TIME_STEP, column.top_displacement)), &top);
    let stress_difference =
        relative_difference(&sampled(&filtered(TIME_STEP, column.base_stress)), &stress);
    println!("top {top_difference:.4}, stress {stress_difference:.4}");
    assert!(top_difference < 0.01, "{top_difference}");
    assert!(stress_difference < 0.03, "{stress_difference}");
    assert!(column.energy_error < 1e-9, "{}", column.energy_error);
    assert!(column.hysteresis > 0.0 && column.midstep_remainder > 0.0);
}

/// The remainder of the mid-step force falls with the square of the time step.
#[test]
fn remainder_is_of_second_order() {
    let ratios = [0.02, 0.01, 0.005].map(|time_step| {
        let column = response(10, time_step, &clay().into()).unwrap();
        column.midstep_remainder / column.hysteresis
    });
    println!("R/D {ratios:?}");
    for pair in ratios.windows(2) {
        assert!(pair[1] > 0.0 && pair[0] / pair[1] > 3.0, "{ratios:?}");
    }
}
