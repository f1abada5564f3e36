//! GOAL: orders of accuracy in the time step and in the element size.
//! SCENE: rigid block on the half-plane under a Ricker pulse, bonded, rocking and sliding.
//! REFERENCE: finer runs, and the frequency-domain table. CI runs this binary in release.

use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::RickerDisplacement;
use basemat::soil::Elastic;
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};

use basemat_problems::profiles::{gmb, p1, p3};
use basemat_problems::sampled_block::{History, distance, sample, under_pulse};
use basemat_problems::series::{Series, print_errors, whole};
use basemat_problems::table;

/// Sampling of the histories: all time steps are fractions of it.
const SAMPLE: f64 = 0.2;

/// A block of width and mass 2 and 4 under a Ricker pulse of peak 1 that ends before `duration`.
#[derive(Debug, Clone, Copy)]
struct Scene {
    height: f64,
    gravity: f64,
    sigma: f64,
    friction: Option<f64>,
    duration: f64,
}

const NAMES: [&str; 3] = ["u_base", "theta", "V"];

/// The bonded block of the reference table.
const BONDED: Scene =
    Scene { height: 2.0, gravity: 0.0, sigma: 1.0, friction: None, duration: 20.0 };

fn history(scene: Scene, (grading, elements): (Grading, usize), time_step: f64) -> History {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let strip = Strip::new(-1.0..1.0, elements, grading).unwrap();
    let builder = Simulation::builder(time_step)
        .structure(RigidBlock::new(2.0, scene.height, 2.0 / scene.height).unwrap())
        .ground(ElasticGround::new(soil, strip).unwrap())
        .motion(RickerDisplacement::new(1.0, scene.sigma, 5.0 * scene.sigma).unwrap())
        .gravity(scene.gravity);
    let builder = match scene.friction {
        Some(friction) => builder.interface(Coulomb::new(friction).unwrap()),
        None => builder.interface(Bonded),
    };
    let mut simulation = builder.build().unwrap();
    let every = whole(SAMPLE / time_step);
    let (history, run) = sample(&mut simulation, whole(scene.duration / time_step), every).unwrap();
    assert!(run.energy_error < 1e-9, "energy balance open by {:.1e}", run.energy_error);
    println!(
        "{scene:?} {grading:?} {elements}, step {time_step}: uplift {:.2}, slip {:.2}",
        run.whole.uplifted_fraction.largest().value,
        run.whole.largest_slip.largest().value
    );
    history
}

/// Distances of each run from the next.
fn successive(runs: &[History]) -> Vec<[f64; 3]> {
    runs.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect()
}

/// Prints errors, each at half the step or element of the one before, and gives the mean order of
/// the last `halvings`.
fn orders(scene: &str, errors: &[[f64; 3]], halvings: u8) -> [f64; 3] {
    for error in errors {
        print_errors(scene, &NAMES, error);
    }
    let last = errors.len() - 1;
    let first = last - usize::from(halvings);
    let orders =
        std::array::from_fn(|k| (errors[first][k] / errors[last][k]).log2() / f64::from(halvings));
    print_errors(&format!("{scene}: order"), &NAMES, &orders);
    orders
}

#[track_caller]
fn check(scene: &str, orders: [f64; 3], wanted: std::ops::Range<f64>) {
    for (name, order) in NAMES.iter().zip(orders) {
        assert!(wanted.contains(&order), "{scene}: order {order:.2} of {name}");
    }
}

/// GOAL: second order in the time step.
/// SCENE: bonded block, Ricker pulse, steps 0.2, 0.1, 0.05, 0.025.
/// REFERENCE: each run against the next finer one.
#[test]
fn time_step_bonded() {
    let runs = [0.2, 0.1, 0.05, 0.025].map(|step| history(BONDED, (Grading::Cosine, 8), step));
    check("time step", orders("time step", &successive(&runs), 1), 1.8..2.2);
}

/// GOAL: the order that contact leaves, at least one. It is not smooth: events fall on steps.
/// SCENE: blocks under their weight that rock, slide, or do both; steps 0.1 to 0.0125.
/// REFERENCE: a step four times finer than the finest.
#[test]
fn time_step_contact() {
    let quick =
        Scene { height: 4.0, gravity: 0.1, sigma: 1.0, friction: Some(2.0), duration: 20.0 };
    let slow = Scene { height: 6.0, gravity: 0.15, sigma: 2.0, friction: None, duration: 25.0 };
    for (name, scene) in [
        ("sliding", Scene { friction: Some(0.5), ..slow }),
        ("rocking", Scene { friction: Some(f64::INFINITY), ..slow }),
        ("rocking and sliding", quick),
    ] {
        let run = |step| history(scene, (Grading::Cosine, 8), step);
        let reference = run(0.003_125);
        let errors = [0.1, 0.05, 0.025, 0.0125].map(|step| distance(&run(step), &reference));
        check(name, orders(name, &errors, 3), 1.0..3.0);
    }
}

/// GOAL: first order in the element size on uniform elements, second on graded ones.
/// SCENE: bonded block, Ricker pulse, 4 to 32 elements, step 0.025.
/// REFERENCE: each run against the next finer one, and the frequency-domain table.
#[test]
fn element_size() {
    let table = table("td_block_SV_nu0333_h2_rho1.csv");
    let column = |name| Series::new(&table, name);
    let (base, rotation, shear) = (column("u_base"), column("theta"), column("V"));
    let times = (1..=whole(BONDED.duration / SAMPLE)).map(|n| n as f64 * SAMPLE);
    // Mean of the shear over a sample, from means over its eighths.
    let mean = |time: f64| -> f64 {
        (0..8).map(|k| shear.mean(time - f64::from(k) * SAMPLE / 8.0, SAMPLE / 8.0)).sum::<f64>()
            / 8.0
    };
    let exact: History = [
        times.clone().map(|time| base.at(time)).collect(),
        times.clone().map(|time| -rotation.at(time)).collect(),
        times.map(mean).collect(),
    ];
    for (grading, wanted) in [(Grading::Uniform, 0.8..1.2), (Grading::Cosine, 1.7..2.3)] {
        let runs = [4, 8, 16, 32].map(|count| history(BONDED, (grading, count), 0.025));
        let scene = format!("{grading:?}, next finer");
        check(&scene, orders(&scene, &successive(&runs), 1), wanted.clone());
        let scene = format!("{grading:?}, table");
        let errors = runs.map(|run| distance(&run, &exact));
        check(&scene, orders(&scene, &errors, 1), wanted);
    }
}

/// GOAL: second order in the time step on layered ground, with two stages and with three.
/// SCENE: bonded block on a layer, elastic on rock and damped on a rigid base.
/// REFERENCE: each run against the next finer one.
#[test]
fn time_step_on_layers() {
    let rigid_base = p3(gmb(5));
    for (name, profile) in [("on rock", p1(Elastic, Elastic)), ("on a rigid base", rigid_base)] {
        for stages in [Stages::Two, Stages::Three] {
            let runs = [0.1, 0.05, 0.025, 0.0125].map(|step| {
                let ground =
                    ElasticGround::new(profile.clone(), Strip::graded(-1.0..1.0, 8).unwrap())
                        .unwrap();
                let block = RigidBlock::new(2.0, 2.0, 1.0).unwrap();
                let mut simulation = under_pulse(block, ground.with_stages(stages), step);
                sample(&mut simulation, whole(20.0 / step), whole(SAMPLE / step)).unwrap().0
            });
            let scene = format!("{name}, {stages:?}");
            check(&scene, orders(&scene, &successive(&runs), 1), 1.8..2.3);
        }
    }
}
