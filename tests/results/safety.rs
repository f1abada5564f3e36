//! GOAL: factors of safety against sliding and overturning.
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
use basemat_problems::scenes::{SI, block, scene, soil};
use basemat_problems::wrapped::Pulled;

/// Pushed with H at height h, a block of weight W and width 2b stands with μW/H and Wb/(Hh).
#[test]
fn statics_of_a_pushed_block() {
    let block = RigidBlock::new(4.0, 3.0, 2000.0).unwrap();
    let weight = STANDARD_GRAVITY * block.total_mass();
    // The second one uplifts: eccentricity h/4 = 1.25 > b/3. The third must be held by tension.
    for (share, height, bonded) in [(0.2, 1.5, false), (0.25, 5.0, false), (0.5, 6.0, true)] {
        let push = share * weight;
        let along = block.horizontal_at(height);
        let pushed = Pulled { structure: block.clone(), along, force: move |_| push };
        let builder = Simulation::builder(1e-3)
            .structure(pushed)
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
        let value = |quantity| time_series.series(quantity)[0];
        assert!((value(Quantity::SlidingSafety) * share / 0.6 - 1.0).abs() < 1e-6);
        assert!((value(Quantity::OverturningSafety) * share * height / 2.0 - 1.0).abs() < 1e-6);
        assert_eq!(value(Quantity::OverturningSafety) < 1.0, bonded);
        assert_eq!(value(Quantity::UpliftedFraction) > 0.0, height == 5.0);
    }
}

/// GOAL: of two blocks the page tells of the one that is closer to falling over.
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
    let mut least = [f64::INFINITY; 2];
    let run = simulation.run(500, |state| {
        for foundation in &state.foundations {
            // N b over the moment about the middle of its own base, and friction N over the shear.
            let safety = foundation.normal_force / foundation.base_moment.abs();
            least[0] = least[0].min(safety);
            least[1] = least[1].min(0.5 * foundation.normal_force / foundation.base_shear.abs());
        }
    });
    let run = run.unwrap();
    let close = |found: f64, known: f64| (found / known - 1.0).abs() < 1e-9;
    assert!(close(run.whole.overturning_safety.lowest.value, least[0]));
    assert!(close(run.whole.sliding_safety.lowest.value, least[1]));
    assert!(least[0] < 1.3);
}

/// A law of one's own whose coefficient is nonsense.
struct Nonsense(Coulomb);

impl InterfaceLaw for Nonsense {
    law_from!(0);

    fn friction_coefficient(&self) -> Option<f64> {
        Some(f64::NAN)
    }
}

type Laws = Vec<Box<dyn InterfaceLaw>>;

/// GOAL: the factor of safety is made of the laws' own coefficients, element by element, unless the
/// builder is told others; a base with an element that has none has no factor.
#[test]
fn friction_is_that_of_the_laws() {
    let coulomb = |friction| Coulomb::new(friction).unwrap();
    let layer = |friction| ThinLayer::new(soil(SI), 0.5, friction).unwrap();
    let march = |laws: Laws, told: Vec<f64>| {
        let builder = scene(SI, 0.6).structure(block(SI)).interfaces(laws);
        let mut simulation = builder.safety_friction(told).build()?;
        let mut time_series = Recorder::new().start(&simulation)?;
        let run = simulation.run(20, |state| time_series.record(state))?;
        Ok::<_, Error>((run, time_series))
    };
    let count = simulation().ground().elements().len();
    let each = |friction: &dyn Fn(usize) -> f64| -> Laws {
        (0..count).map(|e| Box::new(coulomb(friction(e))) as Box<dyn InterfaceLaw>).collect()
    };
    let graded = |e: usize| 0.3 + 0.01 * e as f64;
    // Without the static state, which has no shear.
    let factor = |marched: Result<(Run, TimeSeries), Error>| {
        marched.unwrap().1.series(Quantity::SlidingSafety)[1..].to_vec()
    };
    let told = |laws: Laws| factor(march(laws, (0..count).map(graded).collect()));
    let read = |laws: Laws| factor(march(laws, Vec::new()));
    let own = read(each(&graded));
    assert!(own.iter().all(|factor| factor.is_finite()));
    assert_eq!(own, told(each(&graded)));
    assert!(own.iter().zip(read(each(&|_| 0.3))).all(|(a, b)| *a > b));
    // One law for all; a layer; infinite friction.
    for law in [Box::new(coulomb(0.3)) as Box<dyn InterfaceLaw>, Box::new(layer(0.3))] {
        let factor = read(vec![law]);
        assert!(factor.iter().all(|factor| *factor >= 1.0 - 1e-9 && factor.is_finite()));
    }
    let unlimited = read(vec![Box::new(Coulomb::uplift_only())]);
    assert!(unlimited.iter().all(|factor| *factor == f64::INFINITY));
    // One bonded element: none, unless told.
    let mixed = || {
        let mut laws = each(&graded);
        laws[2] = Box::new(Bonded);
        laws
    };
    assert!(read(mixed()).iter().all(|factor| factor.is_nan()));
    assert!(march(mixed(), Vec::new()).unwrap().0.whole.sliding_safety.lowest.value.is_nan());
    assert!(told(mixed()).iter().all(|factor| factor.is_finite()));
    let refused = |laws: Laws, told: Vec<f64>| march(laws, told).err().unwrap();
    let nonsense = vec![Box::new(Nonsense(coulomb(0.3))) as Box<dyn InterfaceLaw>];
    assert!(matches!(refused(nonsense, Vec::new()), Error::Input { .. }));
    for coefficient in [-0.1, f64::NAN, f64::NEG_INFINITY] {
        assert!(matches!(refused(mixed(), vec![coefficient]), Error::Input { .. }));
    }
    assert!(march(mixed(), vec![f64::INFINITY]).is_ok());
    assert!(matches!(refused(mixed(), vec![0.4; 3]), Error::Size { found: 3, .. }));
}
