//! GOAL: the energies of solids that yield balance in every run.
//! SCENE: random blocks of quadrilaterals with Iwan's or Drucker–Prager's material, that yield, lift off and slide.
//! REFERENCE: the energy balance with the mid-step remainder; signs of dissipation and remainder; a resumed run.

use basemat_problems::heavy;
use basemat_problems::yielding_blocks::{YieldingScene, block_energies, random_scene};

/// Largest residual of the energy balance.
const BALANCE_TOLERANCE: f64 = 1e-9;
/// Largest decrease of a sum that never decreases but for rounding, relative to the largest energy.
const DECREASE_TOLERANCE: f64 = 1e-12;

/// Counts over random scenes.
#[derive(Debug, Default)]
struct YieldingSceneCounts {
    refused: usize,
    failed: usize,
    yielded: usize,
}

/// Runs a scene and checks its energies in every step.
fn check_scene(scene: YieldingScene, counts: &mut YieldingSceneCounts) {
    let YieldingScene { simulation, is_associated, text } = scene;
    let mut simulation = match simulation {
        Ok(simulation) => simulation,
        Err(error) => {
            println!("{text}: refused: {error}");
            counts.refused += 1;
            return;
        }
    };
    let energies = match block_energies(&mut simulation) {
        Ok(energies) => energies,
        Err(error) => {
            println!("{text}: failed: {error}");
            counts.failed += 1;
            return;
        }
    };
    assert!(energies.residual < BALANCE_TOLERANCE, "{text}: {energies:?}");
    assert!(energies.min_dissipation >= -DECREASE_TOLERANCE, "{text}: {energies:?}");
    assert!(
        !is_associated || energies.min_remainder >= -DECREASE_TOLERANCE,
        "{text}: {energies:?}"
    );
    assert!(energies.resumes, "{text}: {energies:?}");
    counts.yielded += usize::from(energies.yields);
}

#[test]
fn energies_of_yielding_solids_balance() {
    let scene_count = if heavy() { 500 } else { 40 };
    let mut counts = YieldingSceneCounts::default();
    for seed in 0..scene_count {
        check_scene(random_scene(seed), &mut counts);
    }
    println!("{counts:?} of {scene_count}");
    let scene_count = usize::try_from(scene_count).unwrap();
    assert!(counts.refused < scene_count / 3 && counts.yielded > scene_count / 3, "{counts:?}");
    assert_eq!(counts.failed, 0);
}
