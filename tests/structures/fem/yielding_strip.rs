//! GOAL: capacity of a rigid rough strip on soil that yields.
//! SCENE: half of the soil by symmetry, eight-node quadrilaterals, static steps of settlement.
//! REFERENCE: pressures of another program, confirmed by a second (`tests/data/yielding/strip_capacity.md`); Prandtl's
//! and Reissner's capacities.

use std::f64::consts::PI;

use basemat_problems::heavy;
use basemat_problems::yielding_strip::{
    CLAY_PRESSURES, FINE_CLAY_PRESSURE, SAND_PRESSURES, StripRun, StripSoil, clay, sand,
};

/// Relative differences from the reference pressures.
fn differences(run: &StripRun, reference: &[f64; 6]) -> Vec<f64> {
    let pairs = run.reference_pressures().into_iter().zip(reference);
    pairs.map(|(pressure, expected)| pressure / expected - 1.0).collect()
}

#[test]
fn strip_on_clay_has_the_pressures_of_reference() {
    let run = StripSoil::CLAY_BOX.push_down(clay(), 8, 0.0025, 120);
    let differences = differences(&run, &CLAY_PRESSURES);
    println!("clay: {differences:?}, {} iterations", run.iterations);
    assert!(differences.iter().all(|difference| difference.abs() < 1e-4), "{differences:?}");
    // Prandtl: 2 + π; the mesh is 3 % stiffer.
    assert!((1.0..1.04).contains(&(run.pressures[119] / (2.0 + PI))));
    assert!(run.iterations < 8 * 120);
}

/// Every night: a mesh twice as fine comes closer to Prandtl's capacity.
#[test]
fn strip_on_clay_converges_to_the_capacity() {
    if !heavy() {
        return;
    }
    let run = StripSoil::CLAY_BOX.push_down(clay(), 16, 0.0025, 120);
    println!("fine clay: {}, {} iterations", run.pressures[119], run.iterations);
    assert!((run.pressures[119] / FINE_CLAY_PRESSURE - 1.0).abs() < 1e-4);
}

#[test]
fn strip_on_sand_has_the_pressures_of_reference() {
    let run = StripSoil::SAND_BOX.push_down(sand(), 6, 0.005, 100);
    let differences = differences(&run, &SAND_PRESSURES);
    println!("sand: {differences:?}, {} iterations", run.iterations);
    assert!(differences.iter().all(|difference| difference.abs() < 1e-3), "{differences:?}");
    // Prandtl and Reissner: q N_q + c N_c, with φ = 30°.
    let factor_q = (PI * (PI / 6.0).tan()).exp() * (PI / 3.0).tan().powi(2);
    let factor_c = (factor_q - 1.0) / (PI / 6.0).tan();
    let capacity = 10.0 * factor_q + factor_c;
    assert!((1.0..1.08).contains(&(run.pressures[99] / capacity)), "{}", run.pressures[99]);
}
