//! GOAL: factors of safety against sliding and overturning follow from statics.
//! SCENE: pushed blocks, two foundations, elements with and without friction.
//! REFERENCE: statics, μW/H and Wb/(Hh).

use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::coupled::GravityStage;
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, ThinLayer};
use basemat::motion::{AtRest, STANDARD_GRAVITY, el_centro_1940};
use basemat::results::Run;
use basemat::results::{Quantity, Recorder, TimeSeries};
use basemat::structure::{RigidBlock, StructureGroup};
use basemat::{Error, Simulation, Soil};

use super::simulation;
use basemat_problems::law_from;
use basemat_problems::scenes::{SI_UNITS, block, scene, soil};
use basemat_problems::wrapped::StructureWithForce;

/// A block of weight W and width 2b pushed with H at height h has the factors μW/H and Wb/(Hh).
#[test]
fn factors_of_a_pushed_block_follow_from_statics() {
    let block = RigidBlock::new(4.0, 3.0, 2000.0).unwrap();
    let weight = STANDARD_GRAVITY * block.total_mass();
    // The second block uplifts: its eccentricity h/4 = 1.25 exceeds b/3. The third block stands by tension only.
    for (push_ratio, height, bonded) in [(0.2, 1.5, false), (0.25, 5.0, false), (0.5, 6.0, true)] {
        let push = push_ratio * weight;
        let along = block.horizontal_at(height);
        let pushed_block =
            StructureWithForce { structure: block.clone(), along, force: move |_| push };
        let builder = Simulation::builder(1e-3)
            .structure(pushed_block)
            .ground(SpringGround::new(-2.0..2.0, 40, 4e7, 2e7).unwrap())
            .motion(AtRest)
            .gravity(STANDARD_GRAVITY)
            .gravity_stage(GravityStage::Frictional);
        let builder = if bonded {
            builder.interface(Bonded)
        } else {
            builder.interface(Coulomb::new(0.6).unwrap())
        };
        let simulation = builder.safety_friction([0.6]).build().unwrap();
        let time_series = Recorder::new().start(&simulation).unwrap();
        let sliding = time_series.series(Quantity::SlidingSafety)[0];
        let overturning = time_series.series(Quantity::OverturningSafety)[0];
        let uplifted = time_series.series(Quantity::UpliftedFraction)[0];
        assert!((sliding * push_ratio / 0.6 - 1.0).abs() < 1e-6);
        assert!((overturning * push_ratio * height / 2.0 - 1.0).abs() < 1e-6);
        assert_eq!(overturning < 1.0, bonded);
        assert_eq!(uplifted > 0.0, height == 5.0);
    }
}

/// GOAL: of two blocks, the factors are those of the block that is closer to overturning.
#[test]
fn factors_of_safety_are_those_of_the_worst_foundation() {
    let group = StructureGroup::new()
        .with(RigidBlock::new(2.0, 8.0, 2000.0).unwrap(), -2.0)
        .unwrap()
        .with(RigidBlock::new(2.0, 2.0, 2000.0).unwrap(), 2.0)
        .unwrap();
    let strips = [Strip::uniform(-3.0..-1.0, 6).unwrap(), Strip::uniform(1.0..3.0, 6).unwrap()];
    let soil = Soil::new(80.0e6, 0.3, 1900.0).unwrap();
    let mut simulation = Simulation::builder(0.005)
        .structure(group)
        .ground(ElasticGround::new(soil, &strips).unwrap())
        .interface(Coulomb::new(0.5).unwrap())
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY)
        .build()
        .unwrap();
    let mut smallest_overturning = f64::INFINITY;
    let mut smallest_sliding = f64::INFINITY;
    let run = simulation.run(500, |state| {
        for foundation in &state.foundations {
            // N b over the moment about the middle of the foundation's base, and friction N over the shear.
            let safety = foundation.normal_force / foundation.base_moment.abs();
            smallest_overturning = smallest_overturning.min(safety);
            let safety = 0.5 * foundation.normal_force / foundation.base_shear.abs();
            smallest_sliding = smallest_sliding.min(safety);
        }
    });
    let run = run.unwrap();
    let overturning = run.whole.overturning_safety.lowest.value;
    assert!((overturning / smallest_overturning - 1.0).abs() < 1e-9);
    let sliding = run.whole.sliding_safety.lowest.value;
    assert!((sliding / smallest_sliding - 1.0).abs() < 1e-9);
    assert!(smallest_overturning < 1.3);
}

/// A law of a user whose friction coefficient is NaN.
struct NanFriction(Coulomb);

impl InterfaceLaw for NanFriction {
    law_from!(0);

    fn friction_coefficient(&self) -> Option<f64> {
        Some(f64::NAN)
    }
}

type Laws = Vec<Box<dyn InterfaceLaw>>;

/// A run of 20 steps with these friction coefficients for the factor of safety.
fn march(laws: Laws, safety_friction: Vec<f64>) -> Result<(Run, TimeSeries), Error> {
    let builder = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interfaces(laws);
    let mut simulation = builder.safety_friction(safety_friction).build()?;
    let mut time_series = Recorder::new().start(&simulation)?;
    let run = simulation.run(20, |state| time_series.record(state))?;
    Ok((run, time_series))
}

/// Factors of safety against sliding without the static state, which has no shear.
fn sliding_factors(laws: Laws, safety_friction: Vec<f64>) -> Vec<f64> {
    let time_series = march(laws, safety_friction).unwrap().1;
    time_series.series(Quantity::SlidingSafety)[1..].to_vec()
}

fn coulomb_laws(coefficients: &[f64]) -> Laws {
    let mut laws: Laws = Vec::new();
    for &friction in coefficients {
        laws.push(Box::new(Coulomb::new(friction).unwrap()));
    }
    laws
}

/// Laws of friction, but for one bonded element.
fn partly_bonded_laws(coefficients: &[f64]) -> Laws {
    let mut laws = coulomb_laws(coefficients);
    laws[2] = Box::new(Bonded);
    laws
}

/// GOAL: the factor of safety has the friction coefficient of each element's law, unless the builder has other coefficients;
/// a base with an element without a coefficient has no factor.
#[test]
fn friction_coefficients_are_those_of_the_laws() {
    let count = simulation().ground().elements().len();
    let graded_coefficients: Vec<f64> = (0..count).map(|e| 0.3 + 0.01 * e as f64).collect();
    let factors = sliding_factors(coulomb_laws(&graded_coefficients), Vec::new());
    assert!(factors.iter().all(|factor| factor.is_finite()));
    assert_eq!(
        factors,
        sliding_factors(coulomb_laws(&graded_coefficients), graded_coefficients.clone())
    );
    let smaller_factors = sliding_factors(coulomb_laws(&vec![0.3; count]), Vec::new());
    assert!(factors.iter().zip(smaller_factors).all(|(a, b)| *a > b));
    // One law for all; a layer; infinite friction.
    let layer = ThinLayer::new(soil(SI_UNITS), 0.5, 0.3).unwrap();
    for laws in [coulomb_laws(&[0.3]), vec![Box::new(layer) as Box<dyn InterfaceLaw>]] {
        let factors = sliding_factors(laws, Vec::new());
        assert!(factors.iter().all(|factor| *factor >= 1.0 - 1e-9 && factor.is_finite()));
    }
    let unlimited = sliding_factors(vec![Box::new(Coulomb::uplift_only())], Vec::new());
    assert!(unlimited.iter().all(|factor| *factor == f64::INFINITY));
    // With one bonded element there is no factor, unless the builder has coefficients.
    let factors_without_coefficient =
        sliding_factors(partly_bonded_laws(&graded_coefficients), Vec::new());
    assert!(factors_without_coefficient.iter().all(|factor| factor.is_nan()));
    let run = march(partly_bonded_laws(&graded_coefficients), Vec::new()).unwrap().0;
    assert!(run.whole.sliding_safety.lowest.value.is_nan());
    let with_coefficients =
        sliding_factors(partly_bonded_laws(&graded_coefficients), graded_coefficients.clone());
    assert!(with_coefficients.iter().all(|factor| factor.is_finite()));
    let nan_friction = NanFriction(Coulomb::new(0.3).unwrap());
    let result = march(vec![Box::new(nan_friction) as Box<dyn InterfaceLaw>], Vec::new());
    assert!(matches!(result.err().unwrap(), Error::Input { .. }));
    for coefficient in [-0.1, f64::NAN, f64::NEG_INFINITY] {
        let result = march(partly_bonded_laws(&graded_coefficients), vec![coefficient]);
        assert!(matches!(result.err().unwrap(), Error::Input { .. }));
    }
    assert!(march(partly_bonded_laws(&graded_coefficients), vec![f64::INFINITY]).is_ok());
    let result = march(partly_bonded_laws(&graded_coefficients), vec![0.4; 3]);
    assert!(matches!(result.err().unwrap(), Error::Size { found: 3, .. }));
}
