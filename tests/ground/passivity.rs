//! GOAL: the soil operator never generates energy.
//! SCENE: 48 strips of 20 elements over c₁Δt/l and ν, each second one graded, 1000 steps; tractions that extract the
//! largest energy in each step. HEAVY_TESTS: each of them uniform and graded, 3000 steps.
//! REFERENCE: zero work. The study `passivity` runs longer.

use basemat::history::HistoryMethod;

use basemat_problems::heavy;
use basemat_problems::passivity::PassivityScene;

/// β = c₁Δt/l of the scenes.
const TIME_STEP_RATIOS: [f64; 8] = [0.02, 0.1, 0.25, 0.5, 1.0, 2.0, 10.0, 50.0];
const POISSON_RATIOS: [f64; 6] = [-0.5, 0.0, 0.2, 1.0 / 3.0, 0.45, 0.4999];

fn scenes() -> Vec<PassivityScene> {
    let mut scenes = vec![];
    for (row, beta) in TIME_STEP_RATIOS.into_iter().enumerate() {
        for (column, poisson) in POISSON_RATIOS.into_iter().enumerate() {
            for is_graded in [false, true] {
                if heavy() || is_graded == ((row + column) % 2 == 1) {
                    scenes.push(PassivityScene {
                        poisson,
                        beta,
                        graded: is_graded,
                        elements: 20,
                        steps: if heavy() { 3000 } else { 1000 },
                        seed: 11,
                        history: HistoryMethod::Auto,
                        tolerance: 0.0,
                    });
                }
            }
        }
    }
    scenes
}

/// GOAL: random tractions never extract energy.
#[test]
fn random_tractions_never_extract_energy() {
    let mut smallest_work = f64::INFINITY;
    for scene in scenes() {
        let work = scene.min_work_ratio();
        assert!(work >= 0.0, "{scene:?}: {work:e}");
        smallest_work = smallest_work.min(work);
    }
    println!("smallest work over that of the first ten steps: {smallest_work:e}");
}

/// GOAL: the tractions of random displacement increments do not grow.
#[test]
fn random_displacements_have_bounded_tractions() {
    let mut max_value = 0.0_f64;
    for scene in scenes() {
        let growth = scene.growth_of_tractions();
        assert!(growth < 2.0, "{scene:?}: {growth}");
        max_value = max_value.max(growth);
    }
    println!("largest growth from the first tenth to the last: {max_value}");
}
