//! GOAL: every ground runs with every law, scheme and search, or the error has a reason.
//! SCENE: a tower on springs and on the half-plane; seven laws, five schemes, two searches.
//! REFERENCE: the energy balance. Only the flow chart may fail, with a typed error.

use basemat::bem::{ContactElement, Grading, SpringGround};
use basemat::contact::ContactSearch;
use basemat::coupled::{HhtAlpha, Midpoint, Newmark, SimulationBuilder, State, StepError, Theta};
use basemat::interface::{
    Bonded, ContactState, FrictionLimit, InterfaceLaw, ThinLayer, UnilateralCondition,
};
use basemat::{Error, Simulation};
use basemat_problems::scenes::{SCENE_GRAVITY, SI_UNITS, friction, ground, shake, soil, tower};

fn thin_layer() -> ThinLayer {
    ThinLayer::new(soil(SI_UNITS), 1.0, 0.3).unwrap()
}

fn shaken_tower(on_half_plane: bool) -> SimulationBuilder {
    let builder = Simulation::builder(2.5e-3)
        .structure(tower(SI_UNITS, None))
        .motion(shake(SI_UNITS, 0.6));
    if on_half_plane {
        builder.ground(ground(SI_UNITS, 6, Grading::Cosine))
    } else {
        let springs = SpringGround::new(-2.0..2.0, 6, 5e7, 4e7).unwrap();
        builder.ground(springs.with_dashpots(4e5, 3e5).unwrap())
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
        3 => builder.interface(thin_layer()),
        4 => builder.interface(thin_layer().with_friction_limit(FrictionLimit::Lagged)),
        5 => builder.interface(thin_layer().with_slip_stiffness_ratio(1e-3).unwrap()),
        _ => {
            // Hard contact, layers and bonds side by side.
            let laws: Vec<Box<dyn InterfaceLaw>> = vec![
                Box::new(friction(0.3)),
                Box::new(thin_layer()),
                Box::new(Bonded),
                Box::new(Bonded),
                Box::new(thin_layer()),
                Box::new(friction(0.3)),
            ];
            builder.interfaces(laws)
        }
    }
}

const LAW_COUNT: usize = 7;

fn with_scheme(builder: SimulationBuilder, scheme: usize) -> SimulationBuilder {
    match scheme {
        0 => builder.scheme(Midpoint),
        1 => builder.scheme(Theta::new(0.55).unwrap()),
        2 => builder.scheme(Newmark::default()),
        3 => builder.scheme(Newmark::new(0.6, 0.31).unwrap()),
        _ => builder.scheme(HhtAlpha::new(-0.1).unwrap()),
    }
}

const SCHEME_COUNT: usize = 5;

/// The energy balance closes in every combination; only the flow chart may fail.
#[test]
fn energy_balances_of_all_combinations_close() {
    let mut completed_runs = 0;
    let mut failed_charts = 0;
    for on_half_plane in [true, false] {
        for law in 0..LAW_COUNT {
            for scheme in 0..SCHEME_COUNT {
                for search in [ContactSearch::Robust, ContactSearch::FlowChart { iterations: 50 }] {
                    let name = format!("{on_half_plane}, law {law}, scheme {scheme}, {search:?}");
                    let builder = with_scheme(with_law(shaken_tower(on_half_plane), law), scheme);
                    let builder = builder.gravity(SCENE_GRAVITY).contact_search(search);
                    let mut simulation = builder.build().unwrap();
                    match simulation.run(250, |_| {}) {
                        Ok(run) => {
                            assert!(run.energy_error < 1e-9, "{name}: {run}");
                            assert!(run.whole.base_shear.magnitude() > 1e3, "{name}: {run}");
                            completed_runs += 1;
                        }
                        Err(Error::Step { source: StepError::Contact { .. }, .. })
                            if search != ContactSearch::Robust =>
                        {
                            failed_charts += 1;
                        }
                        Err(error) => panic!("{name}: {error}"),
                    }
                }
            }
        }
    }
    println!("{completed_runs} runs completed, {failed_charts} flow charts failed");
    let combinations = LAW_COUNT * SCHEME_COUNT;
    assert!(completed_runs > 2 * combinations && failed_charts < combinations);
}

/// Energy per length that the thin layer stores at an element, J/m².
fn stored_density(contact: &ContactState) -> f64 {
    let [normal, shear] = thin_layer().stiffness();
    if contact.gap > 0.0 {
        500.0 / normal * contact.pressure.powi(2) + 500.0 / shear * contact.shear.powi(2)
    } else {
        0.5 / normal * contact.pressure.powi(2) + 0.5 / shear * contact.shear.powi(2)
    }
}

/// Energy that the thin layer stores at all elements, J/m.
fn stored_energy(contact: &[ContactState], elements: &[ContactElement]) -> f64 {
    let pairs = contact.iter().zip(elements);
    pairs.map(|(contact, element)| element.length() * stored_density(contact)).sum()
}

/// The energy balance contains what a thick layer stores beyond its energy at rest.
#[test]
fn layers_store_energy() {
    let builder = with_law(shaken_tower(true), 3).gravity(SCENE_GRAVITY).scheme(Midpoint);
    let mut simulation = builder.build().unwrap();
    assert_eq!(simulation.state().energy_balance.interface, 0.0);
    let mut max_magnitude = 0.0_f64;
    let elements = simulation.ground().elements().to_vec();
    let static_energy = stored_energy(&simulation.state().contact, &elements);
    let run = simulation
        .run(250, |state| {
            let expected = stored_energy(&state.contact, &elements) - static_energy;
            let error = (state.energy_balance.interface - expected).abs();
            assert!(error < 1e-9 * static_energy, "{expected}");
            max_magnitude = max_magnitude.max(expected.abs());
        })
        .unwrap();
    assert!(max_magnitude > 0.1 * static_energy && run.energy_balance.contact > 0.0, "{run}");
}

#[test]
fn combinations_without_sense_are_errors() {
    let static_limit = thin_layer().with_friction_limit(FrictionLimit::Static);
    let weightless_tower = shaken_tower(true).interface(static_limit).gravity(0.0).build();
    assert!(
        matches!(weightless_tower, Err(Error::Scene { quantity, .. }) if quantity.contains("static"))
    );
    assert!(shaken_tower(true).interface(static_limit).gravity(SCENE_GRAVITY).build().is_ok());
    for value in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-320] {
        assert!(thin_layer().with_thickness_ratio(value).is_err(), "{value}");
    }
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(ThinLayer::new(soil(SI_UNITS), value, 0.3).is_err());
        assert!(ThinLayer::from_stiffness(value, 1.0, 0.3).is_err());
        assert!(ThinLayer::from_stiffness(1.0, value, 0.3).is_err());
    }
    for value in [-0.1, 1.1, f64::NAN] {
        assert!(thin_layer().with_debonded_ratio(value).is_err());
        assert!(thin_layer().with_slip_stiffness_ratio(value).is_err());
    }
    for friction in [-0.1, f64::NAN, f64::NEG_INFINITY] {
        assert!(ThinLayer::new(soil(SI_UNITS), 1.0, friction).is_err());
    }
    assert!(ThinLayer::new(soil(SI_UNITS), 1.0, f64::INFINITY).is_ok());
}

/// Last state of a tower on layers that never slip, with this ratio of stiffness in slip.
fn state_with_slip_stiffness(ratio: f64) -> State {
    let layer = ThinLayer::new(soil(SI_UNITS), 1.0, f64::INFINITY).unwrap();
    let layer = layer.with_slip_stiffness_ratio(ratio).unwrap();
    let mut simulation =
        shaken_tower(true).interface(layer).gravity(SCENE_GRAVITY).build().unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    assert!(run.whole.uplifted_fraction.largest().value > 0.1);
    simulation.state().clone()
}

/// The shear stiffness in slip has no effect on elements that do not slip.
#[test]
fn slip_stiffness_without_slip_changes_nothing() {
    assert_eq!(state_with_slip_stiffness(0.0), state_with_slip_stiffness(0.5));
}
