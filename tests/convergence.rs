//! GOAL: orders of accuracy in the time step and in the element size.
//! SCENE: rigid block on the half-plane under a Ricker pulse, bonded, rocking and sliding.
//! REFERENCE: finer runs, and the frequency-domain table. CI runs this binary in release.

use basemat::Soil;
use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::soil::Elastic;
use basemat::structure::{RigidBlock, RigidBody};

use basemat_problems::profiles::{gmb, p1, p3};
use basemat_problems::sampled_block::{
    PulsedBlock, SAMPLING_INTERVAL, SampledSeries, distance, sample, under_pulse,
};
use basemat_problems::series::{nearest_integer, print_errors};

const QUANTITY_NAMES: [&str; 3] = ["u_base", "theta", "V"];

fn block_series(scene: PulsedBlock, mesh: (Grading, usize), time_step: f64) -> SampledSeries {
    let (series, run) = scene.run(mesh, time_step).unwrap();
    assert!(run.energy_error < 1e-9, "energy balance open by {:.1e}", run.energy_error);
    println!(
        "{scene:?} {mesh:?}, step {time_step}: uplift {:.2}, slip {:.2}",
        run.whole.uplifted_fraction.largest().value,
        run.whole.largest_slip.largest().value
    );
    series
}

/// Distances of each run from the next.
fn successive_distances(runs: &[SampledSeries]) -> Vec<[f64; 3]> {
    runs.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect()
}

/// Mean order of the last `halvings` of printed errors, each at half the step or element of the one before.
fn orders(scene: &str, errors: &[[f64; 3]], halvings: u8) -> [f64; 3] {
    for error in errors {
        print_errors(scene, &QUANTITY_NAMES, error);
    }
    let last_index = errors.len() - 1;
    let first = last_index - usize::from(halvings);
    let orders = std::array::from_fn(|k| {
        (errors[first][k] / errors[last_index][k]).log2() / f64::from(halvings)
    });
    print_errors(&format!("{scene}: order"), &QUANTITY_NAMES, &orders);
    orders
}

#[track_caller]
fn assert_orders(scene: &str, orders: [f64; 3], expected: std::ops::Range<f64>) {
    for (name, order) in QUANTITY_NAMES.iter().zip(orders) {
        assert!(expected.contains(&order), "{scene}: order {order:.2} of {name}");
    }
}

/// GOAL: second order in the time step.
/// SCENE: bonded block, Ricker pulse, steps 0.2, 0.1, 0.05, 0.025.
/// REFERENCE: each run against the next finer one.
#[test]
fn a_bonded_block_converges_with_the_square_of_the_time_step() {
    let runs = [0.2, 0.1, 0.05, 0.025]
        .map(|step| block_series(PulsedBlock::BONDED_BLOCK, (Grading::Cosine, 8), step));
    let errors = successive_distances(&runs);
    assert_orders("time step", orders("time step", &errors, 1), 1.8..2.2);
}

/// GOAL: second order in the time step where the outline cuts cells, whose springs have no history.
/// SCENE: bonded cylinder on six cells across, Ricker pulse, steps 0.2, 0.1, 0.05, 0.025.
/// REFERENCE: each run against the next finer one.
#[test]
fn a_bonded_cylinder_converges_with_the_square_of_the_time_step() {
    let runs = [0.2, 0.1, 0.05, 0.025].map(cylinder_series);
    assert_orders("disc", orders("disc", &successive_distances(&runs), 1), 1.8..2.2);
}

/// Base displacement, rotation and mean base shear of the cylinder.
fn cylinder_series(time_step: f64) -> SampledSeries {
    let cylinder = RigidBody::cylinder(1.0, 2.0, 1.0).unwrap();
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let ground = ElasticGround::under(soil, &cylinder, 6).unwrap();
    let mut simulation = under_pulse(cylinder, ground, time_step);
    let interval = nearest_integer(SAMPLING_INTERVAL / time_step);
    let mut samples = [const { Vec::new() }; 3];
    let mut mean_shear = 0.0;
    let run = simulation.run(nearest_integer(20.0 / time_step), |state| {
        mean_shear += state.base_shear / interval as f64;
        if state.step % interval == 0 {
            let displacement = state.absolute_displacement();
            let values = [displacement[0], displacement[4], std::mem::take(&mut mean_shear)];
            samples.iter_mut().zip(values).for_each(|(series, value)| series.push(value));
        }
    });
    assert!(run.unwrap().energy_error < 1e-9);
    samples
}

/// GOAL: the order of runs with contact is at least one. Errors are not smooth in the step: events fall on steps.
/// SCENE: blocks under their weight that rock, slide, or do both; steps 0.1 to 0.0125.
/// REFERENCE: a step four times finer than the finest.
#[test]
fn blocks_in_contact_converge_at_least_with_the_time_step() {
    let slow = PulsedBlock::SLENDER_BLOCK;
    for (name, scene) in [
        ("sliding", PulsedBlock { friction: Some(0.5), ..slow }),
        ("rocking", PulsedBlock { friction: Some(f64::INFINITY), ..slow }),
        ("rocking and sliding", PulsedBlock::SLIDING_BLOCK),
    ] {
        let mesh = (Grading::Cosine, 8);
        let reference = block_series(scene, mesh, 0.003_125);
        let errors = [0.1, 0.05, 0.025, 0.0125]
            .map(|step| distance(&block_series(scene, mesh, step), &reference));
        assert_orders(name, orders(name, &errors, 3), 1.0..3.0);
    }
}

/// GOAL: first order in the element size on uniform elements, second on graded ones.
/// SCENE: bonded block, Ricker pulse, 4 to 32 elements, step 0.025.
/// REFERENCE: each run against the next finer one, and the frequency-domain table.
#[test]
fn elements_converge_with_their_size_and_graded_ones_with_its_square() {
    let exact = PulsedBlock::table_series();
    for (grading, expected) in [(Grading::Uniform, 0.8..1.2), (Grading::Cosine, 1.7..2.3)] {
        let runs = [4, 8, 16, 32]
            .map(|count| block_series(PulsedBlock::BONDED_BLOCK, (grading, count), 0.025));
        let scene = format!("{grading:?}, next finer");
        assert_orders(&scene, orders(&scene, &successive_distances(&runs), 1), expected.clone());
        let scene = format!("{grading:?}, table");
        let errors = runs.map(|run| distance(&run, &exact));
        assert_orders(&scene, orders(&scene, &errors, 1), expected);
    }
}

/// GOAL: second order in the time step on layered ground, with two stages and with three.
/// SCENE: bonded block on a layer, elastic on rock and damped on a rigid base.
/// REFERENCE: each run against the next finer one.
#[test]
fn layered_ground_converges_with_the_square_of_the_time_step() {
    let rigid_base = p3(gmb(5));
    for (name, profile) in [("on rock", p1(Elastic, Elastic)), ("on a rigid base", rigid_base)] {
        for stages in [Stages::Two, Stages::Three] {
            let runs = [0.1, 0.05, 0.025, 0.0125].map(|step| {
                let ground =
                    ElasticGround::new(profile.clone(), Strip::graded(-1.0..1.0, 8).unwrap())
                        .unwrap();
                let block = RigidBlock::new(2.0, 2.0, 1.0).unwrap();
                let mut simulation = under_pulse(block, ground.with_stages(stages), step);
                let interval = nearest_integer(SAMPLING_INTERVAL / step);
                sample(&mut simulation, nearest_integer(20.0 / step), interval).unwrap().0
            });
            let scene = format!("{name}, {stages:?}");
            assert_orders(&scene, orders(&scene, &successive_distances(&runs), 1), 1.8..2.3);
        }
    }
}
