//! GOAL: the static state of structures up to a hundred million times softer than the soil.
//! SCENE: block of ten columns on the half-plane under its weight, without lateral contraction.
//! REFERENCE: the weight, and the pressure ρ g h where the ground is rigid to the structure.

use basemat::bem::{ElasticGround, Strip};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::structure::FemModel;
use basemat::{Simulation, Soil};

const GRAVITY_ACCELERATION: f64 = 9.81;
const MASS_DENSITY: f64 = 1500.0;
const BLOCK_HEIGHT: f64 = 6.0;

/// A block of ten columns on ten elements, without lateral contraction.
///
/// Under its weight on frictionless flat ground it is stressed in one direction only.
fn block_on_soil(stiffness_ratio: f64) -> Simulation {
    let soil = Soil::new(80.0e6, 1.0 / 3.0, 1900.0).unwrap();
    let young = 2.0 * (1.0 + soil.poisson()) * soil.shear_modulus() * stiffness_ratio;
    let layers = [Layer::new(BLOCK_HEIGHT, 4, Material::new(young, 0.0, MASS_DENSITY).unwrap())];
    let mesh = Mesh::layered_block(-5.0..5.0, 10, &layers).unwrap();
    Simulation::builder(1e-3)
        .structure(FemModel::on_base(mesh).unwrap())
        .ground(ElasticGround::new(soil, Strip::uniform(-5.0..5.0, 10).unwrap()).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .gravity(GRAVITY_ACCELERATION)
        .build()
        .unwrap()
}

#[test]
fn soft_structures_stand() {
    let weight = GRAVITY_ACCELERATION * MASS_DENSITY * BLOCK_HEIGHT * 10.0;
    for decade in -8..=4 {
        let state = block_on_soil(10.0_f64.powi(decade)).state().clone();
        let error = (state.normal_force / weight - 1.0).abs();
        let moment = state.base_moment.abs() / (10.0 * weight);
        assert!(error < 1e-9, "1e{decade}: weight off by {error:e}");
        assert!(state.base_shear.abs() < 1e-9 * weight, "1e{decade}: {}", state.base_shear);
        assert!(moment < 1e-9, "1e{decade}: moment {moment:e}");
    }
}

#[test]
fn soft_structures_press_evenly() {
    // On ground that is rigid compared with the block every column carries its own weight: p = ρ g h.
    let pressure = GRAVITY_ACCELERATION * MASS_DENSITY * BLOCK_HEIGHT;
    for decade in [-8, -7, -6] {
        for contact in &block_on_soil(10.0_f64.powi(decade)).state().contact {
            let error = (contact.pressure / pressure - 1.0).abs();
            let tolerance = 10.0 * 10.0_f64.powi(decade).max(1e-7);
            assert!(error < tolerance, "1e{decade}: {error:e}");
        }
    }
}
