//! GOAL: the energies of solids that yield balance in every run.
//! SCENE: random blocks of quadrilaterals with Iwan's or Drucker–Prager's material, that yield, lift off and slide.
//! REFERENCE: the unconfined strength; the energy balance with the mid-step remainder; signs of dissipation and remainder; a resumed run.

use std::f64::consts::FRAC_PI_4;

use basemat::bem::SpringGround;
use basemat::fem::{DruckerPrager, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY};
use basemat::structure::FemModel;
use basemat::{Error, Result, Simulation};
use basemat_problems::heavy;
use basemat_problems::yielding_blocks::{YieldingScene, block_energies, grid_lines, random_scene};

/// Largest residual of the energy balance.
const BALANCE_TOLERANCE: f64 = 1e-9;
/// Largest decrease of a sum that never decreases but for rounding, relative to the largest energy.
const DECREASE_TOLERANCE: f64 = 1e-12;

/// Counts over random scenes.
#[derive(Debug, Default)]
struct YieldingSceneCounts {
    build_errors: usize,
    failed: usize,
    yielded: usize,
}

/// Runs a scene and checks its energies in every step.
fn check_scene(scene: YieldingScene, counts: &mut YieldingSceneCounts) {
    let YieldingScene { simulation, is_associated, text } = scene;
    let mut simulation = match simulation {
        Ok(simulation) => simulation,
        Err(error) => {
            println!("{text}: error: {error}");
            counts.build_errors += 1;
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
    assert!(
        counts.build_errors < scene_count / 3 && counts.yielded > scene_count / 3,
        "{counts:?}"
    );
    assert_eq!(counts.failed, 0);
}

/// Block of sand on a frictionless base, of the height at which its weight is this part of its unconfined strength.
fn block_by_strength(ratio: f64) -> Result<Simulation> {
    const FRICTION_ANGLE: f64 = 0.35;
    const SAND_COHESION: f64 = 30.0e3;
    const SAND_DENSITY: f64 = 1900.0;
    // Unconfined strength by Mohr and Coulomb.
    let strength = 2.0 * SAND_COHESION * (FRAC_PI_4 + 0.5 * FRICTION_ANGLE).tan();
    let height = ratio * strength / (SAND_DENSITY * STANDARD_GRAVITY);
    let elastic = Material::new(60.0e6, 0.3, SAND_DENSITY)?;
    let sand = DruckerPrager::new(elastic, SAND_COHESION, FRICTION_ANGLE, FRICTION_ANGLE)?;
    let y_lines = grid_lines(0.0, height, 4);
    let mesh = Mesh::quad8_block(&[-1.5, 0.0, 1.5], &y_lines, |_, _| sand.clone())?;
    let model = FemModel::on_base(mesh)?;
    Simulation::builder(0.01)
        .ground(SpringGround::under(&model, 8, 1.0e8, 1.0e8)?)
        .structure(model)
        .interface(Coulomb::new(0.5)?)
        .motion(Record::from_fn(0.01, 0.1, |_| 0.0)?)
        .build()
}

/// An error for a weight beyond the strength has the force that is not in balance.
#[test]
fn blocks_stand_up_to_their_unconfined_strength() {
    let standing = block_by_strength(0.95);
    assert!(standing.is_ok(), "{:?}", standing.err().map(|error| error.to_string()));
    match block_by_strength(1.3) {
        Err(Error::Preload { residual, .. }) => assert!(residual > 0.01, "{residual:e}"),
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("a block stands that is too high"),
    }
    // In this scene full increments of Newton's method never converge; see `statics/shortened_increment.rs` of the
    // library.
    assert!(random_scene(15).simulation.is_ok());
}
