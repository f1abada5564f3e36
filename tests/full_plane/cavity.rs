//! GOAL: curved boundaries converge.
//! SCENE: circular cavity under a suddenly applied pressure.
//! REFERENCE: closed form in the Laplace domain.

use basemat::bem::full_plane::{BoundaryMarch, Given, TimeKernel};

use super::{circle, mean, soil};
use basemat_problems::series::{assert_within, nearest_integer};
use basemat_problems::table;

/// Largest error of the radial displacement over 0 < t ≤ 8, and the
/// largest difference of an element from the mean, both relative to the static value ½.
fn cavity_errors(poisson: f64, count: usize, time_step: f64) -> [f64; 2] {
    let segments = circle(count, true);
    let kernel = TimeKernel::new(soil(poisson), &segments, time_step).unwrap();
    let mut march =
        BoundaryMarch::new(Box::new(kernel), &vec![Given::Traction; 2 * count]).unwrap();
    // Pressure on the wall is a traction against the outward normal.
    let values: Vec<f64> =
        (0..2).flat_map(|k| segments.iter().map(move |s| -s.normal()[k])).collect();
    let table = table("cavity_step_pressure.csv");
    let column = table.column(if poisson == 0.0 { "u_nu0" } else { "u_nu025" });
    let mut largest_error = 0.0_f64;
    let mut largest_difference = 0.0_f64;
    let mut compared_times = 0;
    for n in 1..=nearest_integer(8.0 / time_step) {
        march.step(&values).unwrap();
        let u = march.displacement();
        let radial: Vec<f64> = segments
            .iter()
            .enumerate()
            .map(|(k, s)| -(u[k] * s.normal()[0] + u[count + k] * s.normal()[1]))
            .collect();
        let mean = mean(&radial);
        largest_difference =
            radial.iter().fold(largest_difference, |m, r| m.max((r - mean).abs() / 0.5));
        let table_row = n as f64 * time_step / 0.2;
        if (table_row - table_row.round()).abs() < 1e-9 {
            let error = (mean - column[nearest_integer(table_row) - 1]).abs() / 0.5;
            largest_error = largest_error.max(error);
            compared_times += 1;
        }
    }
    assert!(compared_times >= 20);
    [largest_error, largest_difference]
}

/// GOAL: on curved boundaries the error falls with element and step.
/// SCENE: cavity under a suddenly applied pressure, β from 1.3 to 2.6, where the march is bounded.
/// REFERENCE: closed form in the Laplace domain (K₀, K₁).
#[test]
fn a_cavity_under_a_sudden_pressure_moves_as_the_closed_form() {
    let runs =
        [(24, 0.2), (48, 0.1), (96, 0.1)].map(|(count, step)| cavity_errors(0.25, count, step));
    let mean_errors = runs.map(|run| run[0]);
    let differences = runs.map(|run| run[1]);
    assert_within("cavity", &["24", "48", "96"], &mean_errors, &[9.5e-2, 3.3e-2, 2.6e-2]);
    assert_within("cavity, unevenness", &["24", "48", "96"], &differences, &[1e-9; 3]);
}
