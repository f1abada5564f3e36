//! Soil that yields under a rigid rough strip: pressures beside those of another program, and the capacities.
//!
//! ```text
//! cargo study yielding
//! ```
//!
//! The source of the reference pressures is `tests/data/yielding/strip_capacity.md`.

use std::f64::consts::PI;
use std::time::Instant;

use basemat::fem::SharedMaterial;
use basemat_problems::yielding_strip::{
    CLAY_PRESSURES, FINE_CLAY_PRESSURE, REFERENCE_SETTLEMENTS, SAND_PRESSURES, StripSoil, clay,
    sand,
};

/// Rigid rough strip on clay and on sand that yield: pressures and capacities.
///
/// Prints a table.
#[derive(Debug, clap::Args)]
pub(crate) struct YieldingOptions {
    /// Without the fine mesh.
    #[arg(long)]
    short: bool,
}

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
    /// Capacity of the theory of plasticity, Pa.
    capacity: f64,
}

/// Runs the study.
pub(crate) fn run(options: &YieldingOptions) {
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
        capacity: 2.0 + PI,
    };
    let sand_case = StripCase {
        name: "sand",
        mesh: StripSoil::SAND_BOX,
        soil: sand().into(),
        strip_elements: 6,
        settlement_step: 0.005,
        steps: 60,
        reference: SAND_PRESSURES,
        capacity: StripSoil::SAND_BOX.surcharge * factor_q + factor_c,
    };
    let mut cases = vec![clay_case, sand_case];
    if !options.short {
        let mut reference = [f64::NAN; 6];
        reference[5] = FINE_CLAY_PRESSURE;
        cases.push(StripCase { soil: clay().into(), strip_elements: 16, reference, ..cases[0] });
    }
    println!(
        "| soil | elements | settlement | pressure | reference | difference | over capacity |\n\
         |---|---|---|---|---|---|---|"
    );
    for case in &cases {
        print_case(case);
    }
}

/// Prints the rows of a case.
fn print_case(case: &StripCase) {
    let start = Instant::now();
    let run = case.mesh.push_down(
        case.soil.clone(),
        case.strip_elements,
        case.settlement_step,
        case.steps,
    );
    let rows = REFERENCE_SETTLEMENTS.iter().zip(run.reference_pressures()).zip(case.reference);
    for ((settlement, pressure), reference) in rows {
        println!(
            "| {} | {} | {settlement} | {pressure:.4} | {reference} | {:.1e} | {:.4} |",
            case.name,
            case.strip_elements,
            pressure / reference - 1.0,
            pressure / case.capacity,
        );
    }
    let seconds = start.elapsed().as_secs_f64();
    println!("{} steps, {} iterations, {seconds:.1} s", case.steps, run.iterations);
}
