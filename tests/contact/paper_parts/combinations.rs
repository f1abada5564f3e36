//! GOAL: every ground marches with every law, scheme and search, or is refused with a reason.
//! SCENE: a tower on springs and on the half-plane; seven laws, five schemes, two searches.
//! REFERENCE: the energy balance. Only the flow chart may give up, with an error that says so.

use basemat::bem::{ContactElement, Grading, SpringGround};
use basemat::contact::ContactSearch;
use basemat::coupled::StepError;
use basemat::coupled::{HhtAlpha, Midpoint, Newmark, SimulationBuilder, Theta};
use basemat::interface::{Bonded, FrictionLimit, InterfaceLaw, ThinLayer, UnilateralCondition};
use basemat::{Error, Simulation};
use basemat_problems::scenes::{GRAVITY, SI, friction, ground, shake, soil, tower};

fn layer() -> ThinLayer {
    ThinLayer::new(soil(SI), 1.0, 0.3).unwrap()
}

fn start(half_plane: bool) -> SimulationBuilder {
    let builder = Simulation::builder(2.5e-3).structure(tower(SI, None)).motion(shake(SI, 0.6));
    if half_plane {
        builder.ground(ground(SI, 6, Grading::Cosine))
    } else {
        let bed = SpringGround::new(-2.0..2.0, 6, 5e7, 4e7).unwrap();
        builder.ground(bed.with_dashpots(4e5, 3e5).unwrap())
    }
}

fn with_law(builder: SimulationBuilder, law: usize) -> SimulationBuilder {
    match law {
        0 => builder.interface(Bonded),
        1 => builder.interface(friction(0.3)),
        2 => builder.interface(
            friction(0.3)
                .with_unilateral_condition(UnilateralCondition::Velocity { closed_below: 1e-9 })
                .unwrap(),
        ),
        3 => builder.interface(layer()),
        4 => builder.interface(layer().with_friction_limit(FrictionLimit::Lagged)),
        5 => builder.interface(layer().with_slip_stiffness_ratio(1e-3).unwrap()),
        _ => {
            // Side by side: glued, layered, hard.
            let laws: Vec<Box<dyn InterfaceLaw>> = vec![
                Box::new(friction(0.3)),
                Box::new(layer()),
                Box::new(Bonded),
                Box::new(Bonded),
                Box::new(layer()),
                Box::new(friction(0.3)),
            ];
            builder.interfaces(laws)
        }
    }
}

const LAWS: usize = 7;

fn with_scheme(builder: SimulationBuilder, scheme: usize) -> SimulationBuilder {
    match scheme {
        0 => builder.scheme(Midpoint),
        1 => builder.scheme(Theta::new(0.55).unwrap()),
        2 => builder.scheme(Newmark::default()),
        3 => builder.scheme(Newmark::new(0.6, 0.31).unwrap()),
        _ => builder.scheme(HhtAlpha::new(-0.1).unwrap()),
    }
}

const SCHEMES: usize = 5;

/// Each keeps its energy balance closed; only the flow chart may give up, and says so.
#[test]
fn every_combination_marches() {
    let (mut marched, mut gave_up) = (0, 0);
    for half_plane in [true, false] {
        for law in 0..LAWS {
            for scheme in 0..SCHEMES {
                for search in [ContactSearch::Robust, ContactSearch::FlowChart { iterations: 50 }] {
                    let name = format!("{half_plane}, law {law}, scheme {scheme}, {search:?}");
                    let builder = with_scheme(with_law(start(half_plane), law), scheme);
                    let builder = builder.gravity(GRAVITY).contact_search(search);
                    let mut simulation = builder.build().unwrap();
                    match simulation.run(250, |_| {}) {
                        Ok(run) => {
                            assert!(run.energy_error < 1e-9, "{name}: {run}");
                            assert!(run.whole.base_shear.magnitude() > 1e3, "{name}: {run}");
                            marched += 1;
                        }
                        Err(Error::Step { source: StepError::Contact { .. }, .. })
                            if search != ContactSearch::Robust =>
                        {
                            gave_up += 1;
                        }
                        Err(error) => panic!("{name}: {error}"),
                    }
                }
            }
        }
    }
    println!("{marched} marched, {gave_up} flow charts gave up");
    assert!(marched > 2 * LAWS * SCHEMES && gave_up < LAWS * SCHEMES);
}

/// A thick layer takes energy, stores some, and what it stores at rest is not counted.
#[test]
fn layer_stores_energy() {
    let mut simulation =
        with_law(start(true), 3).gravity(GRAVITY).scheme(Midpoint).build().unwrap();
    assert_eq!(simulation.state().energy_balance.interface, 0.0);
    let mut largest = 0.0_f64;
    let [normal, shear] = layer().stiffness();
    let energy = |contact: &[basemat::interface::ContactState], lengths: &[f64]| -> f64 {
        let stored = |c: &basemat::interface::ContactState| {
            if c.gap > 0.0 {
                500.0 / normal * c.pressure.powi(2) + 500.0 / shear * c.shear.powi(2)
            } else {
                0.5 / normal * c.pressure.powi(2) + 0.5 / shear * c.shear.powi(2)
            }
        };
        contact.iter().zip(lengths).map(|(c, length)| length * stored(c)).sum()
    };
    let lengths: Vec<_> =
        simulation.ground().elements().iter().map(ContactElement::length).collect();
    let at_rest = energy(&simulation.state().contact, &lengths);
    let run = simulation
        .run(250, |state| {
            let wanted = energy(&state.contact, &lengths) - at_rest;
            assert!((state.energy_balance.interface - wanted).abs() < 1e-9 * at_rest, "{wanted}");
            largest = largest.max(wanted.abs());
        })
        .unwrap();
    assert!(largest > 0.1 * at_rest && run.energy_balance.contact > 0.0, "{run}");
}

#[test]
fn combinations_without_sense_are_refused() {
    let still = layer().with_friction_limit(FrictionLimit::Static);
    let refused = start(true).interface(still).gravity(0.0).build();
    assert!(matches!(refused, Err(Error::Scene { quantity, .. }) if quantity.contains("static")));
    assert!(start(true).interface(still).gravity(GRAVITY).build().is_ok());
    let bad = [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-320];
    for value in bad {
        assert!(layer().with_thickness_ratio(value).is_err(), "{value}");
    }
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(ThinLayer::new(soil(SI), value, 0.3).is_err());
        assert!(ThinLayer::from_stiffness(value, 1.0, 0.3).is_err());
        assert!(ThinLayer::from_stiffness(1.0, value, 0.3).is_err());
    }
    for value in [-0.1, 1.1, f64::NAN] {
        assert!(layer().with_debonded_ratio(value).is_err());
        assert!(layer().with_slip_stiffness_ratio(value).is_err());
    }
    for friction in [-0.1, f64::NAN, f64::NEG_INFINITY] {
        assert!(ThinLayer::new(soil(SI), 1.0, friction).is_err());
    }
    assert!(ThinLayer::new(soil(SI), 1.0, f64::INFINITY).is_ok());
}

/// The shear stiffness that remains in slip has no effect where nothing slips.
#[test]
fn slip_stiffness_without_slip_changes_nothing() {
    let run = |share| {
        let layer = ThinLayer::new(soil(SI), 1.0, f64::INFINITY).unwrap();
        let layer = layer.with_slip_stiffness_ratio(share).unwrap();
        let mut simulation = start(true).interface(layer).gravity(GRAVITY).build().unwrap();
        let run = simulation.run(300, |_| {}).unwrap();
        assert!(run.whole.uplifted_fraction.largest().value > 0.1);
        simulation.state().clone()
    };
    assert_eq!(run(0.0), run(0.5));
}
