//! Distributions of random scenes.

use basemat::coupled::{Coordinates, GravityStage};
use basemat::history::HistoryMethod;
use proptest::prelude::*;

use super::recipe::{
    BuildingRecipe, GroundRecipe, LawRecipe, SceneRecipe, SchemeRecipe, TowerForm, TowerRecipe,
};
use super::shaking::kinds;

/// 10^x with x uniform.
fn log_uniform(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from.log10()..to.log10()).prop_map(|power| 10.0_f64.powf(power))
}

fn building() -> impl Strategy<Value = BuildingRecipe> {
    prop_oneof![
        (0.5..10.0, log_uniform(300.0, 3000.0))
            .prop_map(|(height, density)| BuildingRecipe::Block { height, density }),
        tower().prop_map(BuildingRecipe::Tower),
        (1_usize..4, log_uniform(1e6, 1e9), any::<bool>()).prop_map(
            |(count, stiffness, is_damped)| BuildingRecipe::Storeys {
                count,
                stiffness,
                damped: is_damped
            }
        ),
    ]
}

fn tower() -> impl Strategy<Value = TowerRecipe> {
    let size = (0.5..10.0, 1_usize..4, 1_usize..5);
    let poisson = prop_oneof![3 => Just(0.2), 1 => 0.0..0.4995];
    let form = prop_oneof![3 => Just(TowerForm::Quad4), 1 => Just(TowerForm::Quad8), 1 => Just(TowerForm::Reduced)];
    (size, log_uniform(1e8, 3e10), poisson, any::<bool>(), form).prop_map(
        |((height, rows, columns), young, poisson, damped, form)| TowerRecipe {
            height,
            rows,
            columns,
            young,
            poisson,
            damped,
            form,
        },
    )
}

fn ground() -> impl Strategy<Value = GroundRecipe> {
    let history = prop::sample::select(vec![
        HistoryMethod::Auto,
        HistoryMethod::Direct,
        HistoryMethod::RelaxedFft,
        HistoryMethod::Exponentials,
    ]);
    prop_oneof![
        3 => (any::<bool>(), prop_oneof![7 => 0.0..0.49, 1 => 0.49..0.4995], history)
            .prop_map(|(is_graded, poisson, history)| GroundRecipe::HalfPlane { graded: is_graded, poisson, history }),
        1 => any::<bool>().prop_map(|dashpots| GroundRecipe::Springs { dashpots }),
    ]
}

fn law(max_friction: f64) -> impl Strategy<Value = LawRecipe> {
    let moderate_friction = max_friction.min(1.0);
    prop_oneof![
        1 => Just(LawRecipe::Coulomb(0.0)),
        4 => (0.05..moderate_friction).prop_map(LawRecipe::Coulomb),
        2 => (0.5 * moderate_friction..max_friction).prop_map(LawRecipe::Coulomb),
        // With infinite friction the distribution of the shear is not unique.
        if max_friction < 1.0 { 0 } else { 2 } => Just(LawRecipe::UpliftOnly),
        1 => Just(LawRecipe::Bonded),
        2 => (0.0..max_friction, prop::sample::select(vec![0.0, 1e-3]))
            .prop_map(|(friction, debonded_ratio)| LawRecipe::ThinLayer(friction, debonded_ratio)),
    ]
}

fn scheme() -> impl Strategy<Value = SchemeRecipe> {
    prop_oneof![
        3 => Just(SchemeRecipe::Midpoint),
        1 => (0.5..1.0).prop_map(SchemeRecipe::Theta),
        1 => (0.5..1.0).prop_map(SchemeRecipe::Dissipative),
        1 => (0.5..0.8).prop_map(SchemeRecipe::Newmark),
        1 => (-1.0 / 3.0..0.0).prop_map(SchemeRecipe::Hht),
    ]
}

/// Scenes with friction of `max_friction` or less (and unbounded where nothing slides).
pub(crate) fn recipes(max_friction: f64) -> impl Strategy<Value = SceneRecipe> {
    let coordinates =
        prop::sample::select(vec![Coordinates::Auto, Coordinates::Physical, Coordinates::Modes]);
    let gravity_stage =
        prop::sample::select(vec![GravityStage::Frictionless, GravityStage::Frictional]);
    let parts = (building(), ground(), 1_usize..8, law(max_friction), scheme());
    let options = (
        coordinates,
        gravity_stage,
        kinds(),
        log_uniform(0.2, 10.0),
        log_uniform(0.2, 5.0),
        log_uniform(1e6, 1e9),
    );
    (parts, options).prop_map(|((building, ground, elements, law, scheme), options)| {
        let (coordinates, gravity_stage, kind, strength, courant, modulus) = options;
        SceneRecipe {
            building,
            ground,
            // A base of one element does not resist rotation.
            elements: elements.max(2),
            law,
            scheme,
            coordinates,
            gravity_stage,
            kind,
            strength,
            courant,
            modulus,
            weightless: false,
        }
    })
}
