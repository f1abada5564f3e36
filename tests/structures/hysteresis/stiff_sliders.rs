//! GOAL: Newton's method on laws that stick and slide in turn.
//! SCENE: random nonlinear buildings with long steps; friction pendulums that slide after 0.1 mm.
//! REFERENCE: every run ends, and its energy balance closes.
//!
//! `NONLINEAR_SCENES=300 cargo test --test fast stiff_sliders` runs more scenes.

use basemat::Simulation;
use basemat::Soil;
use basemat::bem::{ElasticGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{
    Bilinear, BoucWen, FrictionPendulum, Hysteresis, IsolationLevel, LeadRubber, ShearBuilding,
    Storey,
};

use basemat_problems::random::Random;

const FLOOR_MASS: f64 = 20.0e3;
const ISOLATION_LEVEL: IsolationLevel =
    IsolationLevel { height: 0.3, slab_mass: 30.0e3, slab_inertia: 2.5e5, damping: 0.0 };

fn building(storeys: usize, stiffness: f64, damping: f64) -> ShearBuilding {
    let storeys = vec![Storey::new(3.0, FLOOR_MASS, stiffness); storeys];
    let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys).unwrap();
    building.with_stiffness_damping(damping).unwrap()
}

/// Soil and interface of a building.
#[derive(Debug, Clone, Copy)]
struct SoilAndInterface {
    modulus: f64,
    friction: f64,
    elements: usize,
}

/// Energy error of a run under El Centro for `duration`, s.
fn shake(
    structure: ShearBuilding,
    foundation: SoilAndInterface,
    strength: f64,
    time_step: f64,
    duration: f64,
) -> basemat::Result<f64> {
    let soil = Soil::new(foundation.modulus, 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(time_step)
        .structure(structure)
        .ground(ElasticGround::new(soil, Strip::uniform(-5.0..5.0, foundation.elements)?)?)
        .interface(Coulomb::new(foundation.friction)?)
        .motion(el_centro_1940().scaled(strength)?)
        .build()?;
    let steps = simulation.steps_for(duration);
    let run = simulation.run(steps, |_| {})?;
    Ok(run.energy_error)
}

/// A law under `weight` that yields at a displacement from 0.1 to 20 mm, at 3 to 20 % of the
/// weight.
fn random_law(weight: f64, random: &mut Random) -> Box<dyn Hysteresis> {
    let yield_displacement = random.log_within(1e-4, 2e-2);
    let force = random.within(0.03, 0.2) * weight;
    let stiffness = force / yield_displacement;
    let hardening = random.pick(&[0.0, 0.02, 0.1]);
    match random.pick(&[0, 1, 2, 3]) {
        0 => Box::new(Bilinear::new(stiffness, force, hardening).unwrap()),
        1 => {
            let shape = (random.within(1.0, 6.0), random.within(0.5, 1.0));
            let law = BoucWen::new(stiffness, force, hardening).unwrap();
            Box::new(law.with_shape(shape.0, shape.1).unwrap())
        }
        2 => {
            let law = FrictionPendulum::new(weight, random.within(1.0, 4.0), force / weight);
            Box::new(law.unwrap().with_yield_displacement(yield_displacement).unwrap())
        }
        _ => {
            let ratio = random.within(5.0, 20.0);
            let law = LeadRubber::from_strength(stiffness / ratio, force).unwrap();
            Box::new(law.with_stiffness_ratio(ratio).unwrap())
        }
    }
}

/// Weight of the floors above a storey.
fn weight_above(storey: usize, storeys: usize) -> f64 {
    STANDARD_GRAVITY * FLOOR_MASS * (storeys - storey) as f64
}

#[test]
fn random_buildings_are_solved() {
    let scenes = std::env::var("NONLINEAR_SCENES").ok().and_then(|text| text.parse().ok());
    let scenes: usize = scenes.unwrap_or(30);
    let mut random = Random(12);
    let mut failed_scenes = Vec::new();
    for scene in 0..scenes {
        let storeys = random.pick(&[1, 2, 3, 4, 5]);
        let superstructure = building(storeys, random.log_within(5e6, 1e8), random.pick(&[0.0, 0.02]));
        let is_isolated = random.chance(0.5);
        let mut structure = if is_isolated {
            let weight = weight_above(0, storeys) + STANDARD_GRAVITY * ISOLATION_LEVEL.slab_mass;
            let law = random_law(weight, &mut random);
            superstructure.isolated(ISOLATION_LEVEL, law).unwrap()
        } else {
            superstructure
        };
        for storey in 0..storeys {
            if !is_isolated || random.chance(0.3) {
                let level = storey + usize::from(is_isolated);
                let law = random_law(weight_above(storey, storeys), &mut random);
                structure = structure.with_law(level, law).unwrap();
            }
        }
        let foundation = SoilAndInterface {
            modulus: random.log_within(20e6, 500e6),
            friction: random.within(0.2, 1.0),
            elements: random.pick(&[4, 8, 12]),
        };
        let strength = random.within(0.5, 2.0);
        let time_step = random.log_within(0.002, 0.05);
        match shake(structure, foundation, strength, time_step, 400.0 * time_step) {
            Ok(residual) => assert!(residual < 1e-8, "{scene}: {residual:e}"),
            Err(error) => {
                println!("SCENE {scene} dt {time_step:.4} {foundation:?}: {error}");
                failed_scenes.push(scene);
            }
        }
    }
    assert!(failed_scenes.is_empty(), "{} of {scenes} failed: {failed_scenes:?}", failed_scenes.len());
}

#[test]
fn pendulums_that_slide_after_a_tenth_of_a_millimetre_are_solved() {
    let runs_all_scenes = std::env::var_os("NONLINEAR_SCENES").is_some();
    let mut scenes = 0;
    let mut error_texts = Vec::new();
    for storeys in [1, 2, 3, 5] {
        for modulus in [20e6, 80e6, 300e6] {
            for friction in [0.03, 0.06, 0.1] {
                for radius in [1.0, 2.0, 4.0] {
                    let is_published_case = modulus == 80e6 && friction == 0.06 && radius == 2.0;
                    if !(runs_all_scenes || is_published_case) {
                        continue;
                    }
                    let weight = STANDARD_GRAVITY
                        * (ISOLATION_LEVEL.slab_mass + storeys as f64 * FLOOR_MASS);
                    let law = FrictionPendulum::new(weight, radius, friction).unwrap();
                    let law = law.with_yield_displacement(1e-4).unwrap();
                    let superstructure = building(storeys, 7.0e6 * storeys as f64, 0.02);
                    let structure = superstructure.isolated(ISOLATION_LEVEL, law).unwrap();
                    let foundation = SoilAndInterface { modulus, friction: 0.4, elements: 8 };
                    scenes += 1;
                    match shake(structure, foundation, 1.0, 0.02, 15.0) {
                        Ok(residual) => assert!(residual < 1e-8, "{residual:e}"),
                        Err(error) => {
                            println!("SCENE {storeys} {modulus:e} {friction} {radius}: {error}");
                            error_texts.push(error.to_string());
                        }
                    }
                }
            }
        }
    }
    assert!(error_texts.is_empty(), "{} of {scenes} failed: {error_texts:?}", error_texts.len());
}
