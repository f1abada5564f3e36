//! GOAL: a structure that buckles or falls over on its ground is refused by name, and no other.
//! SCENE: random masts, portals and blocks with P–Δ on soft ground, upright and leaning, in the plane and in space.
//! REFERENCE: dense generalized eigenvalues of the stiffness on the ground's static compliance; equilibria of unilateral
//! contact, followed from no load by active sets.
//!
//! `STANDING_SCENES=3000 cargo test --test heavy standing_scenes -- --nocapture` draws more scenes, `STANDING_FIRST=40`
//! from that one on.

mod reference;
mod structures;

use basemat::bem::SpringGround;
use basemat::coupled::{GravityStage, StabilityError};
use basemat::interface::{Bonded, Coulomb, Mode, ThinLayer};
use basemat::structure::{Bilinear, RigidBlock, ShearBuilding, Storey};
use basemat::{Error, Simulation};

use reference::{Followed, Reference};
use structures::{Drawn, GRAVITY, draw};

const SCENES: usize = 150;

#[derive(Debug, Default)]
struct Counts {
    stand: usize,
    lifted: usize,
    buckle: usize,
    overturn: usize,
    topple: usize,
    held: usize,
    /// Faults.
    unstable: Vec<usize>,
    refused: Vec<usize>,
}

#[test]
fn refusals_of_random_structures_are_right() {
    let number = |name, usual| std::env::var(name).map_or(usual, |text| text.parse().unwrap());
    let (first, scenes) = (number("STANDING_FIRST", 0), number("STANDING_SCENES", SCENES));
    let mut counts = Counts::default();
    for number in first..first + scenes {
        let Some(Drawn { structure, up, ground, is_bonded }) = draw(number) else {
            counts.held += 1;
            continue;
        };
        let reference = Reference::new(structure.as_ref(), ground.as_ref(), &up);
        let all: Vec<usize> = (0..reference.means.len()).collect();
        let bonded = reference.load_factor(&all);
        let builder = Simulation::builder(0.01).gravity(GRAVITY).structure(structure);
        let builder = builder.ground(ground);
        let builder = if is_bonded {
            builder.interface(Bonded)
        } else {
            builder.interface(Coulomb::new(0.5).unwrap())
        };
        let built = builder.build();
        // A bonded base stands until it buckles.
        let follows = || {
            if is_bonded {
                return if bonded > 1.0 { Followed::Stands } else { Followed::Lost(bonded) };
            }
            reference.follow()
        };
        match built {
            Ok(simulation) => {
                let modes = &simulation.state().modes;
                let count = modes.len();
                let closed: Vec<usize> = all
                    .iter()
                    .copied()
                    .filter(|place| modes[place % count] != Mode::Open)
                    .collect();
                let factor = reference.load_factor(&closed);
                counts.lifted += usize::from(closed.len() < all.len());
                counts.stand += 1;
                if factor <= 1.0 {
                    println!("{number}: runs at a load factor of {factor}, bonded {bonded}");
                    counts.unstable.push(number);
                }
            }
            Err(Error::Stability(cause)) => {
                let is_right = match *cause {
                    StabilityError::Buckling { factor } => {
                        counts.buckle += 1;
                        bonded < 1.0 && (factor / bonded - 1.0).abs() < 1e-3
                    }
                    StabilityError::Overturning { .. } | StabilityError::Beyond { .. } => {
                        counts.overturn += 1;
                        matches!(follows(), Followed::Lost(_))
                    }
                    StabilityError::Toppling { factor, by_loads: false } => {
                        counts.topple += 1;
                        // The reference may lose the path earlier: its sets of closed elements in between need not be stable.
                        matches!(follows(), Followed::Lost(last) if factor > last - 0.04)
                    }
                    _ => false,
                };
                if !is_right {
                    println!("{number}: {cause}; bonded {bonded}, {:?}", follows());
                    counts.refused.push(number);
                }
            }
            Err(error) => {
                println!("{number}: {error}; bonded {bonded}, {:?}", follows());
                counts.refused.push(number);
            }
        }
    }
    println!("{scenes} scenes: {counts:?}");
    assert!(counts.unstable.is_empty() && counts.refused.is_empty(), "{counts:?}");
}

/// PROBLEM: an upright block on a bed of springs, or on a layer over it. RESULT: Σ k A x²/(W h) is its load factor,
/// whatever the stage and the law. Before, it ran.
#[test]
fn upright_blocks_have_the_load_factor_of_their_rocking_stiffness() {
    const WIDTH: f64 = 6.0;
    const CELLS: usize = 8;
    let layer = 4.0e5;
    let block = || RigidBlock::new(WIDTH, 9.0, 2000.0).unwrap().with_p_delta(GRAVITY).unwrap();
    let weight = GRAVITY * WIDTH * 9.0 * 2000.0;
    let cell = WIDTH / CELLS as f64;
    let squares: f64 =
        (0..CELLS).map(|k| cell * (cell * (k as f64 + 0.5) - 0.5 * WIDTH).powi(2)).sum();
    for (factor, has_layer) in
        [(0.24, false), (0.7, false), (0.999, false), (1.001, false), (0.9, true), (1.1, true)]
    {
        let together = factor * weight * 4.5 / squares;
        let bed = if has_layer { 1.0 / (1.0 / together - 1.0 / layer) } else { together };
        assert!(bed > 0.0);
        for stage in [GravityStage::Frictionless, GravityStage::Frictional, GravityStage::Unloaded]
        {
            let ground = SpringGround::new(-0.5 * WIDTH..0.5 * WIDTH, CELLS, bed, bed).unwrap();
            let builder = Simulation::builder(0.005).gravity(GRAVITY).gravity_stage(stage);
            let builder = builder.ground(ground).structure(block());
            let builder = if has_layer {
                builder.interface(ThinLayer::from_stiffness(layer, layer, 0.5).unwrap())
            } else {
                builder.interface(Coulomb::new(0.5).unwrap())
            };
            match builder.build() {
                Ok(_) => assert!(factor > 1.0, "{factor} {stage:?}"),
                Err(Error::Stability(cause)) => {
                    let StabilityError::Buckling { factor: found } = *cause else {
                        panic!("{factor} {stage:?}: {cause}")
                    };
                    assert!((found / factor - 1.0).abs() < 1e-5, "{found} for {factor}");
                }
                Err(error) => panic!("{factor} {stage:?}: {error}"),
            }
        }
    }
}

/// A storey with a hysteretic law of the same stiffness buckles at the same load factor.
#[test]
fn nonlinear_structures_buckle_as_linear_ones_do() {
    let storeys = [Storey::new(6.0, 50.0e3, 8.0e6); 3];
    let building = || {
        let building = ShearBuilding::new(4.0, 20.0e3, 4.0e4, &storeys).unwrap();
        building.with_p_delta(GRAVITY).unwrap()
    };
    let nonlinear = building().with_law(0, Bilinear::new(8.0e6, 1.0e6, 0.1).unwrap()).unwrap();
    let factor = |structure: ShearBuilding| {
        let ground = SpringGround::under(&structure, 8, 1.0e6, 1.0e6).unwrap();
        let builder = Simulation::builder(0.005).gravity(GRAVITY).ground(ground);
        match builder.structure(structure).interface(Coulomb::new(0.5).unwrap()).build() {
            Err(Error::Stability(cause)) => match *cause {
                StabilityError::Buckling { factor } => factor,
                other => panic!("{other}"),
            },
            other => panic!("{:?}", other.err()),
        }
    };
    let [linear, other] = [building(), nonlinear].map(factor);
    assert!(linear < 1.0 && (other / linear - 1.0).abs() < 1e-5, "{linear} {other}");
}
