//! Orders of accuracy in the time step and in the element size.

mod support;

use basemat::bem::{Grading, HalfPlaneGround, Strip};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw};
use basemat::motion::RickerDisplacement;
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};
use support::series::{Error, Series, print_errors, whole};
use support::table;

/// Sampling of the histories: all time steps are fractions of it.
const SAMPLE: f64 = 0.2;

/// Base displacement, rotation and base shear (mean over a sample) every `SAMPLE`, of the square
/// block of the tables under their Ricker pulse, scaled by `amplitude`.
fn block(
    (grading, elements): (Grading, usize),
    time_step: f64,
    duration: f64,
    law: impl InterfaceLaw + 'static,
    (height, gravity, amplitude): (f64, f64, f64),
) -> [Vec<f64>; 3] {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let strip = Strip::new(-1.0..1.0, elements, grading).unwrap();
    let mut simulation = Simulation::builder(time_step)
        .structure(RigidBlock::new(2.0, height, 2.0 / height).unwrap())
        .ground(HalfPlaneGround::new(soil, &[strip]).unwrap())
        .interface(law)
        .motion(RickerDisplacement::new(amplitude, 1.0, 5.0).unwrap())
        .gravity(gravity)
        .build()
        .unwrap();
    let every = whole(SAMPLE / time_step);
    let mut histories = [const { Vec::new() }; 3];
    let mut shear = 0.0;
    let run = simulation
        .run(whole(duration / time_step), |state| {
            shear += state.base_shear / every as f64;
            if state.step % every == 0 {
                histories[0].push(state.displacement[0]);
                histories[1].push(state.displacement[2]);
                histories[2].push(shear);
                shear = 0.0;
            }
        })
        .unwrap();
    assert!(run.ledger_residual < 1e-9, "ledger open by {:.1e}", run.ledger_residual);
    if gravity > 0.0 {
        println!("uplift {:.2}, slip {:.2e}", run.uplifted_fraction.value, run.slip.value);
    }
    histories
}

const NAMES: [&str; 3] = ["u_base", "theta", "V"];

/// Relative distances of each of `runs` from `reference`.
fn distances(runs: &[[Vec<f64>; 3]], reference: &[[Vec<f64>; 3]]) -> Vec<[f64; 3]> {
    let distance = |a: &[f64], b: &[f64]| {
        let mut error = Error::default();
        a.iter().zip(b).for_each(|(x, y)| error.add(*x, *y));
        error.relative()
    };
    let pairs = runs.iter().zip(reference);
    pairs.map(|(a, b)| std::array::from_fn(|k| distance(&a[k], &b[k]))).collect()
}

/// Base-2 logarithms of the ratios of successive errors.
fn orders(errors: &[[f64; 3]]) -> Vec<[f64; 3]> {
    errors.windows(2).map(|e| std::array::from_fn(|k| (e[0][k] / e[1][k]).log2())).collect()
}

fn report(scene: &str, errors: &[[f64; 3]]) -> [f64; 3] {
    for (k, error) in errors.iter().enumerate() {
        print_errors(&format!("{scene}, {k}"), &NAMES, error);
    }
    let orders = orders(errors);
    println!("  orders {orders:.2?}");
    orders[orders.len() - 1]
}

/// GOAL: second order in the time step.
/// SCENE: bonded block, Ricker pulse, Δt = 0.2, 0.1, 0.05, 0.025.
/// REFERENCE: each run against the next finer one.
#[test]
fn time_step_bonded() {
    let runs = [0.2, 0.1, 0.05, 0.025]
        .map(|dt| block((Grading::Cosine, 8), dt, 20.0, Bonded, (2.0, 0.0, 1.0)));
    let order = report("bonded, time step", &distances(&runs, &runs[1..]));
    for (name, order) in NAMES.iter().zip(order) {
        assert!((order - 2.0).abs() < 0.2, "order of {name}: {order:.2}");
    }
}

/// GOAL: the order that contact leaves.
/// SCENE: the same block under its weight, rocking and sliding (friction 0.4).
/// REFERENCE: a run with a step eight times finer than the finest.
#[test]
fn time_step_contact() {
    for (friction, amp) in [(0.6, 0.1), (f64::INFINITY, 0.1), (2.0,0.1), (2.0, 0.2), (f64::INFINITY,0.2), (f64::INFINITY,0.05)] { println!("== {friction} {amp}");
    let run = |dt| block((Grading::Cosine, 8), dt, 20.0, Coulomb::new(friction).unwrap(), (4.0, amp, 1.0));
    let runs = [0.1, 0.05, 0.025, 0.0125].map(run);
    let reference = [const { [const { Vec::new() }; 3] }; 4].map(|_: [Vec<f64>; 3]| Vec::<[Vec<f64>; 3]>::new());
    let _ = reference;
    let fine = run(0.0125 / 4.0);
    let errors: Vec<[f64; 3]> =
        runs.iter().map(|r| distances(std::slice::from_ref(r), std::slice::from_ref(&fine))[0]).collect();
    report("contact, time step", &errors);
    }
}

/// GOAL: first order in the element size on uniform elements, second on graded ones.
/// SCENE: bonded block, Ricker pulse.
/// REFERENCE: each run against the next finer one, and the frequency-domain table.
#[test]
fn element_size() {
    let table = table("td_block_SV_nu0333_h2_rho1.csv");
    let columns = ["u_base", "theta", "V"].map(|column| Series::new(&table, column));
    let exact: Vec<[f64; 3]> = (1..=100).map(|n| {
        let t = f64::from(n) * SAMPLE;
        let fine = (1..=8).map(|k| columns[2].mean(t - SAMPLE + f64::from(k) * SAMPLE / 8.0, SAMPLE / 8.0));
        [columns[0].at(t), -columns[1].at(t), fine.sum::<f64>() / 8.0]
    }).collect();
    let exact: [Vec<f64>; 3] = std::array::from_fn(|k| exact.iter().map(|e| e[k]).collect());
    for (grading, order, margin) in [(Grading::Uniform, 1.0, 0.2), (Grading::Cosine, 2.0, 0.3)] {
        let runs = [4, 8, 16, 32].map(|n| block((grading, n), 0.025, 20.0, Bonded, (2.0, 0.0, 1.0)));
        let own = report(&format!("{grading:?}, self"), &distances(&runs, &runs[1..]));
        let all = [exact.clone(), exact.clone(), exact.clone(), exact.clone()];
        let against = report(&format!("{grading:?}, table"), &distances(&runs, &all));
        let _ = (own, against, order, margin);
    }
}
