//! GOAL: capacity of a rigid rough strip on soil that yields.
//! SCENE: half of the soil by symmetry, eight-node quadrilaterals, static steps of settlement.
//! REFERENCE: pressures of another program, confirmed by a second (`tests/data/yielding/strip_capacity.md`); Prandtl's
//! and Reissner's capacities.

use std::f64::consts::PI;

use basemat_problems::yielding_strip::{
    CLAY_PRESSURES, SAND_PRESSURES, SETTLEMENTS, StripSoil, clay, sand,
};

/// Relative differences from the pressures of reference, at the steps where the settlement is that of reference.
fn differences(pressures: &[f64], settlement_step: f64, reference: &[f64; 6]) -> Vec<f64> {
    let mut differences = Vec::new();
    for (settlement, expected) in SETTLEMENTS.iter().zip(reference) {
        let step = (settlement / settlement_step).round() as usize;
        differences.push(pressures[step - 1] / expected - 1.0);
    }
    differences
}

#[test]
fn strip_on_clay_has_the_pressures_of_reference() {
    let (pressures, iterations) = StripSoil::CLAY.pressures(clay(), 8, 0.0025, 120);
    let differences = differences(&pressures, 0.0025, &CLAY_PRESSURES);
    println!("clay: {differences:.1e?}, {iterations} iterations");
    assert!(differences.iter().all(|difference| difference.abs() < 1e-4), "{differences:?}");
    // Prandtl: 2 + π; the mesh is 3 % stiffer.
    assert!((1.0..1.04).contains(&(pressures[119] / (2.0 + PI))));
    assert!(iterations < 6 * 120);
}

#[test]
fn strip_on_sand_has_the_pressures_of_reference() {
    let (pressures, iterations) = StripSoil::SAND.pressures(sand(), 6, 0.005, 100);
    let differences = differences(&pressures, 0.005, &SAND_PRESSURES);
    println!("sand: {differences:.1e?}, {iterations} iterations");
    assert!(differences.iter().all(|difference| difference.abs() < 1e-3), "{differences:?}");
    // Prandtl and Reissner: q N_q + c N_c.
    let factor_q = (PI * (PI / 6.0).tan()).exp() * (PI / 3.0).tan().powi(2);
    let factor_c = (factor_q - 1.0) / (PI / 6.0).tan();
    let capacity = 10.0 * factor_q + factor_c;
    assert!((1.0..1.08).contains(&(pressures[99] / capacity)), "{}", pressures[99]);
}
