//! GOAL: a ground in plan marches: step compliance, history, statics, memory that ends, checkpoints, limits.
//! SCENE: cells of squares, oblong ones and an L on a half-space and on a damped layer over rock.
//! REFERENCE: direct sums; static compliance as the sum of all lags; rigid mats by another solution.

use std::sync::Arc;

use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::history::{DirectHistory, HistoryMethod, HistoryOptions};
use basemat::soil::SoilProfile;
use basemat::{Error, Soil, unobserved};
use basemat_problems::dense::solve;
use basemat_problems::passivity::least_work;
use basemat_problems::profiles::{gmb, p1, p3};
use basemat_problems::random::Random;

fn half_space() -> SoilProfile {
    Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap().into()
}

fn l_shape() -> Plan {
    let mask = "##..##..########".chars().map(|c| c == '#').collect::<Vec<_>>();
    Plan::masked([-1.0; 2], [0.5; 2], 4, &mask).unwrap()
}

/// History at each step under random tractions of `seed`.
fn marched(ground: &mut ElasticGround, steps: usize, seed: u64) -> Vec<Vec<f64>> {
    let size = 3 * ground.elements().len();
    let mut random = Random(seed);
    let step = |_| {
        let mut values = vec![0.0; size];
        ground.history(&mut values).unwrap();
        ground.commit(&(0..size).map(|_| random.within(-1.0, 1.0)).collect::<Vec<_>>());
        values
    };
    (0..steps).map(step).collect()
}

fn largest_difference(one: &[Vec<f64>], two: &[Vec<f64>]) -> f64 {
    let largest = two.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let pairs = one.iter().flatten().zip(two.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
}

/// Largest difference of the changes from step to step, m.
fn largest_change(one: &[Vec<f64>], two: &[Vec<f64>]) -> f64 {
    let changes = |all: &[Vec<f64>]| -> Vec<f64> {
        let pairs = all.windows(2).flat_map(|pair| pair[1].iter().zip(&pair[0]));
        pairs.map(|(now, before)| now - before).collect()
    };
    let pairs = changes(one).into_iter().zip(changes(two));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Transforms along the surface and in time are the direct sum; on a square, oblong cells and an L, both stages.
#[test]
fn histories_are_the_direct_sum() {
    let plans = [
        Plan::rectangle(-1.0..1.0, -1.0..1.0, 4).unwrap(),
        Plan::rectangle(-1.5..1.5, -1.0..1.0, 3).unwrap().without_overhang().unwrap(),
        l_shape(),
    ];
    for (plan, stages) in plans.into_iter().zip([Stages::Two, Stages::Three, Stages::Two]) {
        let ground = || {
            ElasticGround::in_plan(p1(gmb(5), gmb(1)), plan.clone()).unwrap().with_stages(stages)
        };
        let mut direct =
            ground().with_own_history(|kernel: Arc<_>| Box::new(DirectHistory::new(kernel)));
        let mut fast = ground();
        for ground in [&mut direct, &mut fast] {
            assert_eq!(ground.elements()[0].directions().len(), 3);
            ground.prepare(0.2, None, &mut unobserved).unwrap();
        }
        let [wanted, found] = [&mut direct, &mut fast].map(|ground| marched(ground, 100, 1));
        let error = largest_difference(&found, &wanted);
        println!("{} cells: {error:e}", plan.count());
        assert!(error < 1e-13, "{error:e}");
    }
}

/// Rigid mats by the static compliance, which is what tractions held for ever give; Betti's symmetry.
#[test]
fn step_compliance_and_history_add_up_to_statics() {
    for profile in [half_space(), p1(gmb(5), gmb(1))] {
        let plan = l_shape();
        let mut ground = ElasticGround::in_plan(profile.clone(), plan.clone()).unwrap();
        ground.prepare(0.4, None, &mut unobserved).unwrap();
        let size = 3 * plan.count();
        let [mut step, mut still] = [vec![0.0; size * size], vec![0.0; size * size]];
        ground.step_compliance(&mut step).unwrap();
        ground.static_compliance(&mut still).unwrap();
        let mut random = Random(2);
        let traction: Vec<f64> = (0..size).map(|_| random.within(-1.0, 1.0)).collect();
        let times = |matrix: &[f64]| -> Vec<f64> {
            let row = |row: &[f64]| row.iter().zip(&traction).map(|(a, b)| a * b).sum();
            matrix.chunks_exact(size).map(row).collect()
        };
        for _ in 0..400 {
            ground.commit(&traction);
        }
        let mut found = vec![0.0; size];
        ground.history(&mut found).unwrap();
        found.iter_mut().zip(times(&step)).for_each(|(found, own)| *found += own);
        let error = largest_difference(&[found], &[times(&still)]);
        println!("{error:e}");
        assert!(error < 2e-4, "{error:e}");
        for matrix in [&step, &still] {
            let pairs = (0..size * size).map(|n| [n, n % size * size + n / size]);
            assert!(pairs.into_iter().all(|[a, b]| (matrix[a] - matrix[b]).abs() < 1e-14));
        }
        // A rigid settlement.
        let found =
            impedances_in_plan(&profile, &plan, &[0.0], StripContact::Bonded, &mut unobserved)
                .unwrap()[0];
        let area = plan.pitch()[0] * plan.pitch()[1];
        let mut sum = 0.0;
        let settled: Vec<_> = (0..size).map(|n| f64::from(n < plan.count())).collect();
        let solved = solve(&still.chunks_exact(size).map(<[_]>::to_vec).collect(), &settled);
        solved[..plan.count()].iter().for_each(|traction| sum += area * traction);
        assert!((sum / found.matrix[2][2].re - 1.0).abs() < 1e-8, "{sum} {found:?}");
    }
}

/// Four grounds under a square, an L and a disc, in steps from short to long: tractions that take out all they can get.
/// `PLAN_STEPS=300` makes so many.
#[test]
fn tractions_never_take_energy_from_a_ground_in_plan() {
    let steps = std::env::var("PLAN_STEPS").map_or(60, |number| number.parse().unwrap());
    let thin = SoilProfile::on_rigid_bedrock().with_layer(Soil::new(1.0, 0.45, 1.0).unwrap(), 0.4);
    let mut least = f64::INFINITY;
    for profile in [half_space(), p1(gmb(5), gmb(1)), p3(gmb(5)), thin.unwrap()] {
        let square = Plan::rectangle(-1.0..1.0, -1.0..1.0, 4).unwrap();
        for plan in [square, l_shape(), Plan::disc([0.0; 2], 1.0, 4).unwrap()] {
            for step in [0.05, 0.3, 1.5] {
                let mut ground = ElasticGround::in_plan(profile.clone(), plan.clone()).unwrap();
                ground.prepare(step, Some(steps), &mut unobserved).unwrap();
                let work = least_work(&mut ground, steps, 11);
                assert!(work >= 0.0, "{work:e} at {step}");
                least = least.min(work);
            }
        }
    }
    println!("least work over what the first ten steps gave: {least:e}");
}

/// With a coarse tolerance memory ends; what is left out is less than the bound says, and more than nothing.
#[test]
fn what_memory_forgets_is_bounded() {
    let options = HistoryOptions { tolerance: Some(3e-3), ..HistoryOptions::default() };
    let ground = || ElasticGround::in_plan(half_space(), l_shape()).unwrap();
    let mut whole = ground().with_history(HistoryMethod::RelaxedFft).unwrap();
    let mut ended = ground().with_history(options).unwrap();
    let mut late = ground().with_history(options).unwrap();
    let steps = 700;
    for (ground, steps) in [(&mut whole, steps), (&mut ended, steps), (&mut late, 1)] {
        ground.prepare(0.2, Some(steps), &mut unobserved).unwrap();
    }
    let [wanted, found, grown] = [&mut whole, &mut ended, &mut late].map(|g| marched(g, steps, 3));
    let bound = ended.increment_error_bound();
    let worst = largest_change(&wanted, &found);
    println!("{worst:e} of {bound:e}");
    assert!(1e-3 * bound < worst && worst < bound, "{worst:e} {bound:e}");
    assert_eq!(whole.increment_error_bound(), 0.0);
    // However far was looked.
    assert_eq!(grown, found);
    let saved = ended.save().unwrap();
    // No more than the memory.
    assert!(saved.len() < 520 * 400, "{}", saved.len());
    let mut other = ground().with_history(options).unwrap();
    other.prepare(0.2, Some(steps), &mut unobserved).unwrap();
    other.restore(steps, &saved).unwrap();
    let [one, two] = [&mut ended, &mut other].map(|ground| marched(ground, 300, 4));
    assert_eq!(one, two);
    assert!(other.restore(steps, &saved[1..]).is_err());
}

/// Beyond the memory allowed, and for what strips alone have, there are errors that say so.
#[test]
fn limits_are_told_beforehand() {
    let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, 8).unwrap();
    let small = HistoryOptions { memory: 1 << 20, ..HistoryOptions::default() };
    let mut ground = ElasticGround::in_plan(half_space(), plan.clone()).unwrap();
    ground = ground.with_history(small).unwrap();
    let outcome = ground.prepare(0.1, Some(50_000), &mut unobserved);
    assert!(matches!(outcome, Err(Error::Memory(_))), "{outcome:?}");
    // Matrices of three components between 3600 elements.
    let many = || Plan::rectangle(-1.0..1.0, -1.0..1.0, 60).unwrap();
    let outcome = ElasticGround::in_plan(half_space(), many()).map(drop);
    assert!(matches!(outcome, Err(Error::Memory(_))), "{outcome:?}");
    // Springs have none between them.
    assert_eq!(SpringGround::in_plan(many(), [1.0; 3]).unwrap().elements().len(), 3600);
    let ground = ElasticGround::in_plan(half_space(), plan).unwrap();
    let outcome = ground.impedances(&[1.0], StripContact::Bonded, &mut unobserved);
    assert!(matches!(outcome, Err(Error::Scene { .. })), "{outcome:?}");
}

/// Elements of several cells are what tractions equal over these cells, and means over them, make of the cells' ground.
#[test]
fn unions_are_sums_of_cells() {
    let plan = Plan::rectangle(-1.0..1.0, -1.5..1.5, 5).unwrap();
    let [columns, rows] = [[1, 3, 1].as_slice(), &[1, 2, 2, 1, 1]];
    let joined = plan.clone().with_unions(columns, rows).unwrap();
    let [mut cells, mut unions] =
        [plan.clone(), joined].map(|plan| ElasticGround::in_plan(half_space(), plan).unwrap());
    let places = |sizes: &[usize]| -> Vec<usize> {
        sizes.iter().enumerate().flat_map(|(place, size)| vec![place; *size]).collect()
    };
    let [x, y] = [columns, rows].map(places);
    let owner = |cell: usize| y[cell / 5] * 3 + x[cell % 5];
    let (count, size) = (plan.count(), unions.elements().len());
    assert_eq!((count, size), (35, 15));
    let sizes: Vec<usize> =
        (0..size).map(|own| (0..count).filter(|cell| owner(*cell) == own).count()).collect();
    let area = plan.pitch()[0] * plan.pitch()[1];
    for (element, number) in unions.elements().iter().zip(0..) {
        let [along, across] = element.sides();
        let found = along * across;
        assert!((found / area - sizes[number] as f64).abs() < 1e-12);
    }
    let mut random = Random(6);
    for ground in [&mut cells, &mut unions] {
        ground.prepare(0.2, None, &mut unobserved).unwrap();
    }
    let (mut found, mut wanted) = (vec![0.0; 3 * size], vec![0.0; 3 * count]);
    let means = |wanted: &[f64]| {
        let mut means = vec![0.0; 3 * size];
        for (place, value) in wanted.iter().enumerate() {
            let own = owner(place % count);
            means[place / count * size + own] += value / sizes[own] as f64;
        }
        means
    };
    let mut traction = vec![0.0; 3 * size];
    let of_cell = |traction: &[f64]| -> Vec<f64> {
        (0..3 * count).map(|n| traction[n / count * size + owner(n % count)]).collect()
    };
    for _ in 0..40 {
        traction.fill_with(|| random.within(-1.0, 1.0));
        unions.history(&mut found).unwrap();
        cells.history(&mut wanted).unwrap();
        let error = largest_difference(&[found.clone()], &[means(&wanted)]);
        assert!(wanted[0] == 0.0 || error < 1e-13, "{error:e}");
        unions.commit(&traction);
        cells.commit(&of_cell(&traction));
    }
    let times = |matrix: &[f64], traction: &[f64]| -> Vec<f64> {
        let row = |row: &[f64]| row.iter().zip(traction).map(|(a, b)| a * b).sum();
        matrix.chunks_exact(traction.len()).map(row).collect()
    };
    for still in [false, true] {
        let [own, all] = [(&unions, 3 * size), (&cells, 3 * count)].map(|(ground, size)| {
            let mut matrix = vec![0.0; size * size];
            if still {
                ground.static_compliance(&mut matrix).unwrap();
            } else {
                ground.step_compliance(&mut matrix).unwrap();
            }
            matrix
        });
        let wanted = means(&times(&all, &of_cell(&traction)));
        assert!(largest_difference(&[times(&own, &traction)], &[wanted]) < 1e-13);
    }
    for (columns, rows) in
        [(&[1, 4][..], rows), (&[2, 2, 1], rows), (&[1, 3], rows), (columns, &[1, 2, 2, 2])]
    {
        assert!(plan.clone().with_unions(columns, rows).is_err(), "{columns:?} {rows:?}");
    }
    // Sums beyond what a number holds, and unions of nothing.
    for columns in [&[usize::MAX, 5][..], &[usize::MAX, usize::MAX, 1], &[0, 1, 3, 1]] {
        assert!(plan.clone().with_unions(columns, rows).is_err(), "{columns:?}");
        assert!(plan.clone().with_unions(&[1, 3, 1], columns).is_err(), "{columns:?}");
    }
    // A corner that is not there.
    assert!(l_shape().with_unions(&[1, 2, 1], &[1, 1, 1, 1]).is_err());
    assert!(l_shape().with_unions(&[1, 1, 1, 1], &[1, 1, 1, 1]).is_ok());
}

/// Without a tolerance memory ends where coefficients are lost in their errors, in a long run on layers.
#[test]
fn memory_ends_by_itself() {
    let steps = 5000;
    let ground = |tolerance| {
        let ground = ElasticGround::in_plan(p1(gmb(5), gmb(1)), l_shape()).unwrap();
        let mut ground = ground.with_tolerance(tolerance).unwrap();
        ground.prepare(0.4, Some(steps), &mut unobserved).unwrap();
        ground
    };
    let mut ended = ground(1e-10);
    let found = marched(&mut ended, steps, 7);
    let bound = ended.increment_error_bound();
    let choice = ended.description().history.unwrap();
    assert!((5e-7..2e-6).contains(&choice.error_bound), "{choice}");
    let kept = ended.save().unwrap().len() / (3 * 12);
    assert!(bound > 0.0 && kept < steps - 2000, "{bound:e} {kept}");
    // Coefficients a hundred times as good, all of them; random tractions cancel, their bound does not.
    let mut whole = ground(1e-13).with_history(HistoryMethod::RelaxedFft).unwrap();
    whole.prepare(0.4, None, &mut unobserved).unwrap();
    let wanted = marched(&mut whole, steps, 7);
    let error = largest_change(&found, &wanted);
    println!("{error:e} of {bound:e}, {choice}");
    assert!(0.0 < error && error < bound, "{error:e} {bound:e}");
}

/// A history may be saved before it has looked as far as its last lag, and restored after, and the reverse.
#[test]
fn memory_that_ends_is_restored_however_far_is_looked() {
    let ground = |steps: Option<usize>| {
        let mut ground = ElasticGround::in_plan(p1(gmb(5), gmb(1)), l_shape()).unwrap();
        ground.prepare(0.4, steps, &mut unobserved).unwrap();
        ground
    };
    let mut far = ground(Some(5000));
    for (made, from, to) in [
        (1, None, Some(5000)),
        (300, None, Some(5000)),
        (300, Some(5000), None),
        (2600, Some(2600), Some(5000)),
        (2600, None, None),
    ] {
        let mut one = ground(from);
        marched(&mut one, made, 7);
        let mut other = ground(to);
        other.restore(made, &one.save().unwrap()).unwrap();
        let next = [&mut one, &mut other].map(|ground| marched(ground, 80, 8));
        let difference = largest_difference(&next[1], &next[0]);
        assert!(difference < 1e-9, "{made}, {from:?}, {to:?}: {difference:e}");
        assert!(next[0].iter().flatten().any(|value| *value != 0.0));
    }
    // The other way back, to where nothing has happened.
    let start = ground(None).save().unwrap();
    marched(&mut far, 100, 7);
    far.restore(0, &start).unwrap();
    assert_eq!(marched(&mut far, 100, 7), marched(&mut ground(Some(5000)), 100, 7));
}
