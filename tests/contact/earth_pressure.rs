//! GOAL: soil beside a wall yields at its passive pressure and follows the wall at its active one.
//! SCENE: random contact problems of walls; wedges of soil behind a vertical wall.
//! REFERENCE: all modes tried one by one; the wedge of the largest and of the smallest thrust; tables of coefficients.

use std::collections::BTreeSet;
use std::ops::Range;

use basemat::interface::{EarthPressure, InterfaceLaw};
use basemat::soil::SoilStrength;

use basemat_problems::enumerated_contact::{ContactRanges, ELEMENT_COUNT, EnumeratedContact};
use basemat_problems::random::Random;

fn random_problem(random: &mut Random) -> EnumeratedContact {
    let ranges = ContactRanges {
        free_jump: [-3.0, 3.0],
        static_pressure: [0.3, 1.0],
        recession: [-0.5, 0.5],
    };
    EnumeratedContact::random(random, ranges, |random| {
        let mut bounds = Vec::new();
        for _ in 0..ELEMENT_COUNT {
            // Without active pressure the soil needs no wall, and the elements may open.
            let active = if random.chance(0.2) { 0.0 } else { random.within(0.05, 0.3) };
            bounds.push([active, random.within(1.0, 2.0)]);
        }
        bounds
    })
}

#[test]
fn the_search_finds_a_solution_of_brute_force() {
    let mut random = Random(71);
    let mut found_modes = BTreeSet::new();
    let mut problems_with_others = 0;
    for problem in (0..300).map(|_| random_problem(&mut random)) {
        let laws: [EarthPressure; ELEMENT_COUNT] = std::array::from_fn(|e| {
            let [active, passive] = problem.bounds[e];
            EarthPressure::new(active, passive, problem.friction).unwrap()
        });
        let boxed = laws.map(|law| -> Box<dyn InterfaceLaw> { Box::new(law) });
        let law_modes = laws.each_ref().map(InterfaceLaw::modes);
        let (modes, has_others) = problem.assert_search_solves(boxed, law_modes);
        found_modes.extend(modes);
        problems_with_others += usize::from(has_others);
    }
    assert_eq!(found_modes.len(), 10, "{found_modes:?}");
    println!("several solutions in {problems_with_others} of 300");
}

/// Thrust of the wedge with a surface at `angle` over the thrust of a fluid of the soil's weight.
fn wedge_thrust(angle: f64, friction: f64, wall_friction: f64) -> f64 {
    let weight = 1.0 / angle.tan();
    weight * (angle - friction).sin() / (angle - friction - wall_friction).cos()
}

/// Thrusts of wedges with 39 999 angles of this range.
fn wedge_thrusts(
    angles: Range<f64>,
    friction: f64,
    wall_friction: f64,
) -> impl Iterator<Item = f64> {
    (1..40_000).map(move |k| {
        let angle = angles.start + (angles.end - angles.start) * f64::from(k) / 4e4;
        wedge_thrust(angle, friction, wall_friction)
    })
}

#[test]
fn pressure_ratios_are_those_of_the_extreme_wedges() {
    for (friction, wall_friction) in
        [(20.0, 0.0), (30.0, 0.0), (30.0, 10.0), (30.0, 20.0), (35.0, 12.0), (42.0, 0.0_f64)]
    {
        let phi = f64::to_radians(friction);
        let delta = wall_friction.to_radians();
        let strength = SoilStrength::new(phi).unwrap().with_wall_friction(delta).unwrap();
        let right_angle = std::f64::consts::FRAC_PI_2;
        let active = wedge_thrusts(phi..right_angle, phi, delta).fold(0.0, f64::max);
        // Friction acts in the other direction.
        let passive = wedge_thrusts(0.0..right_angle - phi - delta, -phi, -delta)
            .fold(f64::INFINITY, f64::min);
        for (computed, expected) in strength.pressure_ratios().into_iter().zip([active, passive]) {
            let error = computed / (expected * delta.cos()) - 1.0;
            assert!(error.abs() < 1e-6, "{friction}° {wall_friction}°: {computed} {expected}");
        }
    }
}

/// Coefficients of Coulomb's thrust along its direction, and Rankine's, as in textbooks.
///
/// Das, *Principles of Foundation Engineering*.
#[test]
fn pressure_ratios_are_those_of_tables() {
    let table = [
        (30.0, 0.0, 0.333, 3.0),
        (30.0, 15.0, 0.301, 4.977),
        (30.0, 20.0, 0.297, 6.105),
        (35.0, 0.0, 0.271, 3.690),
        (40.0, 0.0, 0.217, 4.599),
    ];
    for (friction, wall_friction, active, passive) in table {
        let delta = f64::to_radians(wall_friction);
        let strength = SoilStrength::new(f64::to_radians(friction)).unwrap();
        let strength = strength.with_wall_friction(delta).unwrap();
        let ratios = strength.pressure_ratios().map(|ratio| ratio / delta.cos());
        let label = format!("{friction} {wall_friction}: {ratios:?}");
        assert!((ratios[0] - active).abs() < 6e-4, "{label}");
        assert!((ratios[1] / passive - 1.0).abs() < 2e-4, "{label}");
    }
}
