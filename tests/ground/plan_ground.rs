//! GOAL: a ground in plan has the right step compliance, history, statics, end of memory, checkpoints and limits.
//! SCENE: cells of squares, oblong ones and an L on a half-space and on a damped layer over rock.
//! REFERENCE: direct sums; static compliance as the sum of all lags; rigid mats by another solution.

use std::sync::Arc;

use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::history::{DirectHistory, HistoryMethod, HistoryOptions};
use basemat::soil::SoilProfile;
use basemat::{Error, Soil, unobserved};
use basemat_problems::dense::{dot, solve};
use basemat_problems::passivity::min_work_ratio;
use basemat_problems::profiles::{gmb, p1, p3};
use basemat_problems::random::Random;

fn half_space() -> SoilProfile {
    Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap().into()
}

fn l_shape() -> Plan {
    let mask = "##..##..########".chars().map(|c| c == '#').collect::<Vec<_>>();
    Plan::masked([-1.0; 2], [0.5; 2], 4, &mask).unwrap()
}

/// An L of twelve cells on a damped layer over rock.
fn l_shape_on_layer() -> ElasticGround {
    ElasticGround::in_plan(p1(gmb(5), gmb(1)), l_shape()).unwrap()
}

/// Responses of a march under random tractions, step by step.
fn march(ground: &mut ElasticGround, steps: usize, seed: u64) -> Vec<Vec<f64>> {
    let size = 3 * ground.elements().len();
    let mut random = Random(seed);
    let mut histories = vec![];
    for _ in 0..steps {
        let mut history = vec![0.0; size];
        ground.history(&mut history).unwrap();
        ground.commit(&random_tractions(&mut random, size));
        histories.push(history);
    }
    histories
}

fn random_tractions(random: &mut Random, size: usize) -> Vec<f64> {
    (0..size).map(|_| random.within(-1.0, 1.0)).collect()
}

/// Largest difference of two runs, relative to the largest value of the second.
fn largest_difference(one: &[Vec<f64>], two: &[Vec<f64>]) -> f64 {
    let max_magnitude = two.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    let pairs = one.iter().flatten().zip(two.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / max_magnitude
}

/// Changes from step to step.
fn increments(histories: &[Vec<f64>]) -> Vec<f64> {
    let pairs = histories.windows(2).flat_map(|pair| pair[1].iter().zip(&pair[0]));
    pairs.map(|(end, start)| end - start).collect()
}

/// Largest difference of the changes from step to step, m.
fn largest_increment_difference(one: &[Vec<f64>], two: &[Vec<f64>]) -> f64 {
    let pairs = increments(one).into_iter().zip(increments(two));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Product of a square matrix, row by row, and a vector.
fn multiply(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(vector.len()).map(|row| dot(row, vector)).collect()
}

/// GOAL: transforms along the surface and in time are the direct sum.
/// SCENE: a square, oblong cells and an L, two and three stages.
#[test]
fn histories_are_the_direct_sum() {
    let plans = [
        Plan::rectangle(-1.0..1.0, -1.0..1.0, 4).unwrap(),
        Plan::rectangle(-1.5..1.5, -1.0..1.0, 3).unwrap().without_overhang().unwrap(),
        l_shape(),
    ];
    for (plan, stages) in plans.into_iter().zip([Stages::Two, Stages::Three, Stages::Two]) {
        let profile = p1(gmb(5), gmb(1));
        let mut ground_with_direct_history = ElasticGround::in_plan(profile.clone(), plan.clone())
            .unwrap()
            .with_stages(stages)
            .with_own_history(|kernel: Arc<_>| Box::new(DirectHistory::new(kernel)));
        let mut ground_with_transforms =
            ElasticGround::in_plan(profile, plan.clone()).unwrap().with_stages(stages);
        for ground in [&mut ground_with_direct_history, &mut ground_with_transforms] {
            assert_eq!(ground.elements()[0].directions().len(), 3);
            ground.prepare(0.2, None, &mut unobserved).unwrap();
        }
        let expected = march(&mut ground_with_direct_history, 100, 1);
        let computed = march(&mut ground_with_transforms, 100, 1);
        let error = largest_difference(&computed, &expected);
        println!("{} cells: {error:e}", plan.count());
        assert!(error < 1e-13, "{error:e}");
    }
}

/// GOAL: constant tractions tend to the static compliance, which is symmetric and gives the stiffness of a rigid mat.
/// REFERENCE: Betti's theorem; impedances at frequency zero.
#[test]
fn step_compliance_and_history_add_up_to_statics() {
    for profile in [half_space(), p1(gmb(5), gmb(1))] {
        let plan = l_shape();
        let mut ground = ElasticGround::in_plan(profile.clone(), plan.clone()).unwrap();
        ground.prepare(0.4, None, &mut unobserved).unwrap();
        let size = 3 * plan.count();
        let mut step_compliance = vec![0.0; size * size];
        let mut static_compliance = vec![0.0; size * size];
        ground.step_compliance(&mut step_compliance).unwrap();
        ground.static_compliance(&mut static_compliance).unwrap();
        let traction = random_tractions(&mut Random(2), size);
        for _ in 0..400 {
            ground.commit(&traction);
        }
        let mut displacement = vec![0.0; size];
        ground.history(&mut displacement).unwrap();
        for (sum, step_displacement) in
            displacement.iter_mut().zip(multiply(&step_compliance, &traction))
        {
            *sum += step_displacement;
        }
        let expected = multiply(&static_compliance, &traction);
        let error = largest_difference(&[displacement], &[expected]);
        println!("{error:e}");
        assert!(error < 2e-4, "{error:e}");
        for matrix in [&step_compliance, &static_compliance] {
            for n in 0..size * size {
                let transposed = n % size * size + n / size;
                assert!((matrix[n] - matrix[transposed]).abs() < 1e-14);
            }
        }
        // A rigid settlement.
        let contact = StripContact::Bonded;
        let expected =
            impedances_in_plan(&profile, &plan, &[0.0], contact, &mut unobserved).unwrap()[0];
        let area = plan.pitch()[0] * plan.pitch()[1];
        let settlement: Vec<_> = (0..size).map(|n| f64::from(n < plan.count())).collect();
        let matrix = static_compliance.chunks_exact(size).map(<[_]>::to_vec).collect();
        let mut force = 0.0;
        for traction in &solve(&matrix, &settlement)[..plan.count()] {
            force += area * traction;
        }
        assert!((force / expected.matrix[2][2].re - 1.0).abs() < 1e-8, "{force} {expected:?}");
    }
}

/// GOAL: tractions that extract the largest energy in each step never extract energy in sum.
/// SCENE: four grounds under a square, an L and a disc, short to long time steps; `PLAN_STEPS` sets the number of steps.
#[test]
fn tractions_never_extract_energy_from_a_ground_in_plan() {
    let steps = std::env::var("PLAN_STEPS").map_or(60, |number| number.parse().unwrap());
    let thin_layer =
        SoilProfile::on_rigid_bedrock().with_layer(Soil::new(1.0, 0.45, 1.0).unwrap(), 0.4);
    let mut smallest_work = f64::INFINITY;
    for profile in [half_space(), p1(gmb(5), gmb(1)), p3(gmb(5)), thin_layer.unwrap()] {
        let square = Plan::rectangle(-1.0..1.0, -1.0..1.0, 4).unwrap();
        for plan in [square, l_shape(), Plan::disc([0.0; 2], 1.0, 4).unwrap()] {
            for time_step in [0.05, 0.3, 1.5] {
                let mut ground = ElasticGround::in_plan(profile.clone(), plan.clone()).unwrap();
                ground.prepare(time_step, Some(steps), &mut unobserved).unwrap();
                let work = min_work_ratio(&mut ground, steps, 11);
                assert!(work >= 0.0, "{work:e} at {time_step}");
                smallest_work = smallest_work.min(work);
            }
        }
    }
    println!("smallest work over that of the first ten steps: {smallest_work:e}");
}

/// An L of twelve cells on a half-space.
fn l_shape_with_history(options: HistoryOptions) -> ElasticGround {
    let ground = ElasticGround::in_plan(half_space(), l_shape()).unwrap();
    ground.with_history(options).unwrap()
}

/// GOAL: with a coarse tolerance the memory ends; the error by the end of the memory is below its bound and above zero.
#[test]
fn the_error_of_a_memory_that_ends_is_bounded() {
    let options = HistoryOptions { tolerance: Some(3e-3), ..HistoryOptions::default() };
    let mut ground_with_full_memory = l_shape_with_history(HistoryMethod::RelaxedFft.into());
    let mut ground_with_cut_memory = l_shape_with_history(options);
    let mut unexpected_steps = l_shape_with_history(options);
    let steps = 700;
    ground_with_full_memory.prepare(0.2, Some(steps), &mut unobserved).unwrap();
    ground_with_cut_memory.prepare(0.2, Some(steps), &mut unobserved).unwrap();
    unexpected_steps.prepare(0.2, Some(1), &mut unobserved).unwrap();
    let expected = march(&mut ground_with_full_memory, steps, 3);
    let computed = march(&mut ground_with_cut_memory, steps, 3);
    let bound = ground_with_cut_memory.increment_error_bound();
    let error = largest_increment_difference(&expected, &computed);
    println!("{error:e} of {bound:e}");
    assert!(1e-3 * bound < error && error < bound, "{error:e} {bound:e}");
    assert_eq!(ground_with_full_memory.increment_error_bound(), 0.0);
    // The expected number of steps does not matter.
    assert_eq!(march(&mut unexpected_steps, steps, 3), computed);
    let saved_variables = ground_with_cut_memory.save().unwrap();
    // No more than the memory is saved.
    assert!(saved_variables.len() < 520 * 400, "{}", saved_variables.len());
    let mut restored_ground = l_shape_with_history(options);
    restored_ground.prepare(0.2, Some(steps), &mut unobserved).unwrap();
    restored_ground.restore(steps, &saved_variables).unwrap();
    assert_eq!(march(&mut ground_with_cut_memory, 300, 4), march(&mut restored_ground, 300, 4));
    assert!(restored_ground.restore(steps, &saved_variables[1..]).is_err());
}

/// GOAL: too much memory, and analyses of strips alone, are errors beforehand.
#[test]
fn limits_are_checked_beforehand() {
    let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, 8).unwrap();
    let little_memory = HistoryOptions { memory: 1 << 20, ..HistoryOptions::default() };
    let mut ground = ElasticGround::in_plan(half_space(), plan.clone()).unwrap();
    ground = ground.with_history(little_memory).unwrap();
    let outcome = ground.prepare(0.1, Some(50_000), &mut unobserved);
    assert!(matches!(outcome, Err(Error::Memory(_))), "{outcome:?}");
    // Matrices of three components between 3600 elements.
    let many_cells = Plan::rectangle(-1.0..1.0, -1.0..1.0, 60).unwrap();
    let outcome = ElasticGround::in_plan(half_space(), many_cells.clone()).map(drop);
    assert!(matches!(outcome, Err(Error::Memory(_))), "{outcome:?}");
    // Springs need no matrices between elements.
    assert_eq!(SpringGround::in_plan(many_cells, [1.0; 3]).unwrap().elements().len(), 3600);
    let ground = ElasticGround::in_plan(half_space(), plan).unwrap();
    let outcome = ground.impedances(&[1.0], StripContact::Bonded, &mut unobserved);
    assert!(matches!(outcome, Err(Error::Scene { .. })), "{outcome:?}");
}

/// GOAL: without a tolerance the memory ends where weights are smaller than their errors, in a long run on layers.
#[test]
fn memory_ends_without_a_tolerance() {
    let steps = 5000;
    let mut ground_with_cut_memory = l_shape_on_layer().with_tolerance(1e-10).unwrap();
    ground_with_cut_memory.prepare(0.4, Some(steps), &mut unobserved).unwrap();
    let computed = march(&mut ground_with_cut_memory, steps, 7);
    let bound = ground_with_cut_memory.increment_error_bound();
    let choice = ground_with_cut_memory.description().history.unwrap();
    assert!((5e-7..2e-6).contains(&choice.error_bound), "{choice}");
    let saved_steps = ground_with_cut_memory.save().unwrap().len() / (3 * 12);
    assert!(bound > 0.0 && saved_steps < steps - 2000, "{bound:e} {saved_steps}");
    // All weights are used, with errors a hundredth as large. Errors of random tractions cancel; their bound does not.
    let ground_with_full_memory = l_shape_on_layer().with_tolerance(1e-13).unwrap();
    let mut ground_with_full_memory =
        ground_with_full_memory.with_history(HistoryMethod::RelaxedFft).unwrap();
    ground_with_full_memory.prepare(0.4, None, &mut unobserved).unwrap();
    let expected = march(&mut ground_with_full_memory, steps, 7);
    let error = largest_increment_difference(&computed, &expected);
    println!("{error:e} of {bound:e}, {choice}");
    assert!(0.0 < error && error < bound, "{error:e} {bound:e}");
}

/// The L on a layer, prepared for an expected number of steps.
fn prepared_l_shape(expected_steps: Option<usize>) -> ElasticGround {
    let mut ground = l_shape_on_layer();
    ground.prepare(0.4, expected_steps, &mut unobserved).unwrap();
    ground
}

/// GOAL: a history saved before the end of its memory is known can be restored after, and the reverse.
#[test]
fn memory_that_ends_is_restored_for_any_expected_steps() {
    for (steps, expected_by_saved, expected_by_restored) in [
        (1, None, Some(5000)),
        (300, None, Some(5000)),
        (300, Some(5000), None),
        (2600, Some(2600), Some(5000)),
        (2600, None, None),
    ] {
        let mut saved_ground = prepared_l_shape(expected_by_saved);
        march(&mut saved_ground, steps, 7);
        let mut restored_ground = prepared_l_shape(expected_by_restored);
        restored_ground.restore(steps, &saved_ground.save().unwrap()).unwrap();
        let expected = march(&mut saved_ground, 80, 8);
        let computed = march(&mut restored_ground, 80, 8);
        let difference = largest_difference(&computed, &expected);
        assert!(
            difference < 1e-9,
            "{steps}, {expected_by_saved:?}, {expected_by_restored:?}: {difference:e}"
        );
        assert!(expected.iter().flatten().any(|value| *value != 0.0));
    }
    // Back to the initial state.
    let start = prepared_l_shape(None).save().unwrap();
    let mut restored_ground = prepared_l_shape(Some(5000));
    march(&mut restored_ground, 100, 7);
    restored_ground.restore(0, &start).unwrap();
    let expected = march(&mut prepared_l_shape(Some(5000)), 100, 7);
    assert_eq!(march(&mut restored_ground, 100, 7), expected);
}
