//! GOAL: a soil column that yields follows an independent program.
//! SCENE: 20 m of clay by Iwan's model, 40 eight-node elements with tied sides, on a rigid base.
//! REFERENCE: 40 two-node cells with lumped mass, Newmark's method, a tenth of the time step.

use basemat_problems::yielding_column::{clay, response};

const ROW_COUNT: usize = 40;
const TIME_STEP: f64 = 0.005;

#[test]
fn yielding_column_follows_the_independent_program() {
    let column = response(ROW_COUNT, TIME_STEP, &clay().into()).unwrap();
    let [top_difference, stress_difference] = column.table_differences(TIME_STEP).unwrap();
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
