//! GOAL: the soil operator never gives energy away.
//! SCENE: 48 strips of 20 elements over c₁Δt/l and ν, each second one graded, 1000 steps; tractions that take out all
//! they can. HEAVY_TESTS: each of them uniform and graded, 3000 steps.
//! REFERENCE: zero work. The example `passivity` runs longer.

use basemat::history::HistoryMethod;

use basemat_problems::heavy;
use basemat_problems::passivity::Scene;

const BETAS: [f64; 8] = [0.02, 0.1, 0.25, 0.5, 1.0, 2.0, 10.0, 50.0];
const POISSON: [f64; 6] = [-0.5, 0.0, 0.2, 1.0 / 3.0, 0.45, 0.4999];

fn scenes() -> impl Iterator<Item = Scene> {
    let cases = BETAS.into_iter().enumerate().flat_map(|(row, beta)| {
        POISSON.into_iter().enumerate().flat_map(move |(column, poisson)| {
            let gradings = [false, true].into_iter();
            let chosen = gradings.filter(move |own| heavy() || *own == ((row + column) % 2 == 1));
            chosen.map(move |graded| (beta, poisson, graded))
        })
    });
    cases.map(|(beta, poisson, graded)| Scene {
        poisson,
        beta,
        graded,
        elements: 20,
        steps: if heavy() { 3000 } else { 1000 },
        seed: 11,
        history: HistoryMethod::Auto,
        tolerance: 0.0,
    })
}

#[test]
fn random_tractions_never_extract_energy() {
    let mut least = f64::INFINITY;
    for scene in scenes() {
        let work = scene.least_work();
        assert!(work >= 0.0, "{scene:?}: {work:e}");
        least = least.min(work);
    }
    println!("least work over what the first ten steps gave: {least:e}");
}

#[test]
fn random_displacements_give_bounded_tractions() {
    let mut largest = 0.0_f64;
    for scene in scenes() {
        let growth = scene.growth_of_tractions();
        assert!(growth < 2.0, "{scene:?}: {growth}");
        largest = largest.max(growth);
    }
    println!("largest growth from the first tenth to the last: {largest}");
}
