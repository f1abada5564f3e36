//! Orders of accuracy in the time step and in the element size.

use basemat::bem::Grading;
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome};
use crate::AnyError;
use crate::figure::{
    CURVE_BLUE, CURVE_GRAY, CURVE_GREEN, CURVE_ORANGE, CURVE_RED, Figure, FigurePanel,
};
use basemat_problems::sampled_block::{PulsedBlock, SampledSeries, distance};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "convergence",
    title: "Orders of convergence",
    reference: "frequency-domain table (elements); a much finer step (time)",
    settings: "4 to 32 elements at Δt = 0.025 b/c_S; Δt = 0.2 to 0.0125 b/c_S on 8 cosine-graded",
    run,
};

fn block_series(
    scene: PulsedBlock,
    mesh: (Grading, usize),
    time_step: f64,
) -> Result<SampledSeries, AnyError> {
    let (series, run) = scene.run(mesh, time_step)?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(series)
}

/// Smallest and largest order of the three quantities over the last `halvings`.
fn orders(errors: &[[f64; 3]], halvings: u8) -> [f64; 2] {
    let last_index = errors.len() - 1;
    let first = last_index - usize::from(halvings);
    let orders: [f64; 3] = std::array::from_fn(|k| {
        (errors[first][k] / errors[last_index][k]).log2() / f64::from(halvings)
    });
    let smallest = orders.iter().fold(f64::INFINITY, |smallest, order| smallest.min(*order));
    let max_magnitude = orders.iter().fold(0.0, |max, order| order.max(max));
    [smallest, max_magnitude]
}

fn add(checks: &mut Vec<ValidationCheck>, name: &str, [low, high]: [f64; 2], limits: [f64; 2]) {
    let range = limits[0]..=limits[1];
    checks.push(ValidationCheck::within(format!("{name}: smallest order"), low, range.clone()));
    checks.push(ValidationCheck::within(format!("{name}: largest order"), high, range));
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let mut checks = Vec::new();
    let counts = if short { &[4, 8, 16][..] } else { &[4, 8, 16, 32][..] };
    let expected = PulsedBlock::table_series();
    let mut left = FigurePanel::new("number of elements", "error of the rotation, relative L2")
        .categories(&["4", "8", "16", "32"])
        .logarithmic();
    for (grading, name, color, range) in [
        (Grading::Uniform, "uniform elements", CURVE_RED, [0.8, 1.2]),
        (Grading::Cosine, "cosine-graded elements", CURVE_BLUE, [1.7, 2.3]),
    ] {
        let mut errors = Vec::new();
        for &count in counts {
            let computed = block_series(PulsedBlock::BONDED_BLOCK, (grading, count), 0.025)?;
            errors.push(distance(&computed, &expected));
        }
        add(&mut checks, name, orders(&errors, 1), range);
        left = left.circles(name, color, points(0, &errors));
        let power = if grading == Grading::Uniform { 1 } else { 2 };
        let last_index = errors.len() - 1;
        let end = (last_index as f64, errors[last_index][1]);
        let start = (0.0, end.1 * 2.0_f64.powf(f64::from(power) * end.0));
        left = left.dashed(&format!("order {power}"), color, vec![start, end]);
    }

    let mesh = (Grading::Cosine, 8);
    let mut right = FigurePanel::new("time step Δt c_S/b", "error of the rotation, relative L2")
        .legend(SeriesLabelPosition::LowerLeft)
        .categories(&["0.2", "0.1", "0.05", "0.025", "0.0125"])
        .room(0.1, 0.08)
        .logarithmic();
    let finest = block_series(PulsedBlock::BONDED_BLOCK, mesh, 0.003_125)?;
    let steps = [0.2, 0.1, 0.05, 0.025];
    let mut errors = Vec::new();
    for step in steps {
        errors.push(distance(&block_series(PulsedBlock::BONDED_BLOCK, mesh, step)?, &finest));
    }
    add(&mut checks, "time step, bonded", orders(&errors, 2), [1.8, 2.2]);
    right = right.circles("bonded", CURVE_BLUE, points(0, &errors));
    for (power, color, start) in [(2, CURVE_BLUE, errors[0][1]), (1, CURVE_GRAY, 0.09)] {
        let end = start * 0.5_f64.powi(4 * power);
        right = right.dashed(&format!("order {power}"), color, vec![(0.0, start), (4.0, end)]);
    }
    let list = [
        (
            "sliding",
            CURVE_ORANGE,
            PulsedBlock { friction: Some(0.5), ..PulsedBlock::SLENDER_BLOCK },
        ),
        (
            "rocking",
            CURVE_GREEN,
            PulsedBlock { friction: Some(f64::INFINITY), ..PulsedBlock::SLENDER_BLOCK },
        ),
        ("rocking and sliding", CURVE_RED, PulsedBlock::SLIDING_BLOCK),
    ];
    let list = if short { &list[..1] } else { &list[..] };
    let steps = [0.1, 0.05, 0.025, 0.0125];
    for (name, color, scene) in list {
        let finest = block_series(*scene, mesh, 0.003_125)?;
        let mut errors = Vec::new();
        for step in steps {
            errors.push(distance(&block_series(*scene, mesh, step)?, &finest));
        }
        add(&mut checks, &format!("time step, {name}"), orders(&errors, 3), [1.0, 3.0]);
        right = right.circles(name, *color, points(1, &errors));
    }
    let title =
        "Rigid block under an SV pulse: error against elements (left) and time step (right)";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, vec![left, right]) })
}

/// Errors of the rotation, the first at the halving of number `first`.
fn points(first: u8, errors: &[[f64; 3]]) -> Vec<(f64, f64)> {
    errors
        .iter()
        .enumerate()
        .map(|(k, error)| ((k + usize::from(first)) as f64, error[1]))
        .collect()
}
