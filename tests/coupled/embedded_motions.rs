//! GOAL: structures in a trench return errors for free fields that do not belong to their ground.
//! SCENE: motions made for another soil, another depth or a ground without backfill, or known at the surface only.
//! REFERENCE: typed errors.

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::el_centro_1940;
use basemat::site::TrenchMotion;
use basemat::soil::{Elastic, SoilProfile};
use basemat::{Error, Simulation, Soil, unobserved};

use super::trench_springs::{TRENCH_DEPTH, TrenchSprings, soil, trench_elements, walled_block};

/// A motion made for another soil, another depth or a ground without backfill is an error.
#[test]
fn a_motion_made_for_another_ground_is_an_error() {
    let original = trench_in_layer(8.0, TRENCH_DEPTH);
    let motion = TrenchMotion::new(&original, el_centro_1940(), &mut unobserved).unwrap();
    assert!(error_of_motion(trench_in_layer(8.0, TRENCH_DEPTH), &motion).is_none());
    let backfill = Soil::from_shear_wave_speed(100.0, 0.3, 1800.0).unwrap();
    let backfilled =
        trench_in_layer(8.0, TRENCH_DEPTH).with_backfill(3.0, backfill, Elastic).unwrap();
    let in_half_plane = TrenchGround::new(soil(), trench_of_depth(TRENCH_DEPTH)).unwrap();
    for ground in [
        trench_in_layer(9.0, TRENCH_DEPTH),
        in_half_plane,
        trench_in_layer(8.0, TRENCH_DEPTH - 0.5),
        backfilled,
    ] {
        let error = error_of_motion(ground, &motion);
        assert!(matches!(error, Some(Error::Scene { quantity: "free field", .. })), "{error:?}");
    }
}

fn trench_of_depth(depth: f64) -> TrenchElements {
    Trench::new(-6.0..6.0, depth).unwrap().elements(2, 2).unwrap()
}

/// Ground around a trench of this depth whose upper layer has this thickness, m.
fn trench_in_layer(thickness: f64, depth: f64) -> TrenchGround {
    let profile = SoilProfile::on_half_plane(soil()).with_layer(soil(), thickness).unwrap();
    TrenchGround::new(profile, trench_of_depth(depth)).unwrap()
}

/// Error of a block on this ground under the motion; `None` if it is valid.
fn error_of_motion(ground: TrenchGround, motion: &TrenchMotion) -> Option<Error> {
    Simulation::builder(0.05)
        .structure(walled_block())
        .expected_steps(1)
        .ground(ground)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(motion.clone())
        .build()
        .err()
}

/// A motion known at the surface only is an error.
#[test]
fn a_motion_of_the_surface_alone_is_an_error() {
    let result = Simulation::builder(0.01)
        .structure(walled_block())
        .ground(TrenchSprings::new(&trench_elements(), 4e7, 4e5))
        .interface(Bonded)
        .motion(el_centro_1940())
        .build();
    assert!(matches!(result, Err(Error::Scene { quantity: "free field", .. })));
}
