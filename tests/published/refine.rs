//! GOAL: errors estimated by `refine` are within a factor of two of the true errors.
//! SCENE: bonded blocks, a building and a cantilever under a pulse, three meshes and steps.
//! REFERENCE: `td_*`, frequency domain.

use basemat::Soil;
use basemat::analyses::{Refinement, refine};
use basemat::bem::{ElasticGround, Strip};
use basemat::structure::{RigidBlock, Structure};

use basemat_problems::sampled_block::under_pulse;
use basemat_problems::series::{RelativeError, TabledSeries, nearest_integer};
use basemat_problems::table;
use basemat_problems::tabled_structures::{Cantilever, three_storeys};

/// Ratios of the estimated to the true error of the base shear's time series, for each setting.
fn estimates<S: Structure + 'static>(
    file: &str,
    poisson: f64,
    structure: impl Fn() -> S,
) -> (Refinement, Vec<f64>) {
    const COARSE_TIME_STEP: f64 = 0.2;
    let soil = Soil::new(1.0, poisson, 1.0).unwrap();
    let reference = TabledSeries::new(&table(&format!("td_{file}.csv")), "V");
    let steps = nearest_integer((reference.duration() / COARSE_TIME_STEP).floor());
    let computed = refine(4, COARSE_TIME_STEP, |elements, time_step| {
        let ground = ElasticGround::new(soil, Strip::graded(-1.0..1.0, elements)?)?;
        let mut simulation = under_pulse(structure(), ground, time_step);
        // Means over the coarsest step, of forces that are constant over each of these.
        let steps_per_mean = nearest_integer(COARSE_TIME_STEP / time_step);
        let mut means = vec![0.0; steps];
        simulation.run(steps * steps_per_mean, |state| {
            means[(state.step - 1) / steps_per_mean] += state.base_shear / steps_per_mean as f64;
        })?;
        Ok(means)
    })
    .unwrap();
    let expected: Vec<f64> = (0..steps)
        .map(|k| {
            // Simpson's rule over many parts: steps may be longer than those of the table.
            let part = COARSE_TIME_STEP / 8.0;
            (1..=8)
                .map(|j| {
                    let end = COARSE_TIME_STEP * k as f64 + part * f64::from(j);
                    reference.mean(end, part)
                })
                .sum::<f64>()
                / 8.0
        })
        .collect();
    let mut ratios = Vec::new();
    for setting in &computed.settings {
        let mut error = RelativeError::default();
        setting
            .results
            .iter()
            .zip(&expected)
            .for_each(|(computed, x)| error.add(*computed, *x));
        ratios.push(setting.error / error.relative());
    }
    println!("{file}\n{computed}\nestimated over true: {ratios:.2?}");
    (computed, ratios)
}

#[track_caller]
fn within_a_factor_of_two((found, ratios): (Refinement, Vec<f64>)) {
    assert!(found.is_regular(), "{found}");
    for ratio in ratios {
        assert!((0.5..2.0).contains(&ratio), "{ratio:.2}");
    }
}

#[test]
fn errors_of_blocks_are_estimated() {
    for (file, poisson, height, density) in [
        ("block_SV_nu025_h1_rho1", 0.25, 1.0, 1.0),
        ("block_SV_nu0333_h2_rho1", 1.0 / 3.0, 2.0, 1.0),
        ("block_SV_nu0333_h4_rho0.5", 1.0 / 3.0, 4.0, 0.5),
    ] {
        let block_ratios =
            estimates(file, poisson, || RigidBlock::new(2.0, height, density).unwrap());
        within_a_factor_of_two(block_ratios);
    }
}

#[test]
fn errors_of_flexible_structures_are_estimated() {
    let third = 1.0 / 3.0;
    within_a_factor_of_two(estimates("shearbuilding3_SV_nu0333_sig1", third, || {
        three_storeys().unwrap()
    }));
    within_a_factor_of_two(estimates("EBcantilever_SV_nu0333", third, || Cantilever::new(12)));
}
