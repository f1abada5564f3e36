//! Soil that yields under a rigid rough strip: pressures beside those of another program, and the capacities.
//!
//! The source of the reference pressures is `tests/data/yielding/strip_capacity.md`.

use std::f64::consts::PI;
use std::time::Instant;

use basemat::fem::SharedMaterial;
use basemat_problems::yielding_strip::{
    CLAY_PRESSURES, FINE_CLAY_PRESSURE, REFERENCE_SETTLEMENTS, SAND_PRESSURES, StripSoil, clay,
    sand,
};

use super::check::{Check, Limit};

const CLAY_LIMIT: f64 = 1e-4;
const SAND_LIMIT: f64 = 1e-3;
/// Limit of a pressure above the capacity of the theory, relative to it.
const EXCESS_LIMIT: f64 = 0.08;
const STRIP_REFERENCE: &str = "an independent program, same mesh and steps";

/// A strip on a soil, and reference pressures.
struct StripCase {
    name: &'static str,
    mesh: StripSoil,
    soil: SharedMaterial,
    strip_elements: usize,
    settlement_step: f64,
    steps: usize,
    /// Pressures at the reference settlements, Pa; NaN where the reference has none.
    reference: [f64; 6],
    limit: f64,
    /// Capacity of the theory of plasticity, Pa.
    capacity: f64,
}

/// Checks of all strips; prints their pressures.
pub(super) fn checks(is_short: bool) -> Vec<Check> {
    let friction_angle = PI / 6.0;
    let factor_q =
        (PI * friction_angle.tan()).exp() * (PI / 4.0 + 0.5 * friction_angle).tan().powi(2);
    let factor_c = (factor_q - 1.0) / friction_angle.tan();
    let clay_case = StripCase {
        name: "clay",
        mesh: StripSoil::CLAY_BOX,
        soil: clay().into(),
        strip_elements: 8,
        settlement_step: 0.0025,
        steps: 120,
        reference: CLAY_PRESSURES,
        limit: CLAY_LIMIT,
        capacity: 2.0 + PI,
    };
    let sand_case = StripCase {
        name: "sand, φ = ψ = 30°",
        mesh: StripSoil::SAND_BOX,
        soil: sand().into(),
        strip_elements: 6,
        settlement_step: 0.005,
        steps: 60,
        reference: SAND_PRESSURES,
        limit: SAND_LIMIT,
        capacity: StripSoil::SAND_BOX.surcharge * factor_q + factor_c,
    };
    let mut cases = vec![clay_case, sand_case];
    if !is_short {
        let mut reference = [f64::NAN; 6];
        reference[5] = FINE_CLAY_PRESSURE;
        cases.push(StripCase { soil: clay().into(), strip_elements: 16, reference, ..cases[0] });
    }
    println!(
        "| soil | elements | settlement | pressure | reference | difference | over capacity |\n\
         |---|---|---|---|---|---|---|"
    );
    cases.iter().flat_map(case_checks).collect()
}

/// Checks of a case; prints its rows.
fn case_checks(case: &StripCase) -> Vec<Check> {
    let start = Instant::now();
    let run = case.mesh.push_down(
        case.soil.clone(),
        case.strip_elements,
        case.settlement_step,
        case.steps,
    );
    let pressures = run.reference_pressures();
    let mut largest_difference = 0.0_f64;
    let mut compared_count = 0;
    for ((settlement, pressure), reference) in
        REFERENCE_SETTLEMENTS.iter().zip(pressures).zip(case.reference)
    {
        let difference = pressure / reference - 1.0;
        if !reference.is_nan() {
            largest_difference = largest_difference.max(difference.abs());
            compared_count += 1;
        }
        println!(
            "| {} | {} | {settlement} | {pressure:.4} | {reference} | {difference:.1e} | {:.4} |",
            case.name,
            case.strip_elements,
            pressure / case.capacity,
        );
    }
    let seconds = start.elapsed().as_secs_f64();
    println!("{} steps, {} iterations, {seconds:.1} s", case.steps, run.iterations);
    let name = format!(
        "rigid rough strip on {}, {} elements under its half",
        case.name, case.strip_elements
    );
    let last_pressure = pressures[pressures.len() - 1];
    let difference = if last_pressure.is_nan() { f64::NAN } else { largest_difference };
    let remark = format!("{compared_count} pressures, {last_pressure:.4} at the last settlement");
    let mut checks = vec![
        Check::new(&name, STRIP_REFERENCE, difference, Limit::AtMost(case.limit))
            .with_remark(remark),
    ];
    if case.limit == SAND_LIMIT {
        let reference = "capacity of Prandtl and Reissner: excess";
        let excess_pressure = last_pressure / case.capacity - 1.0;
        checks.push(Check::new(name, reference, excess_pressure, Limit::AtMost(EXCESS_LIMIT)));
    }
    checks
}
