//! GOAL: soil beside a wall yields at its passive pressure and follows the wall at its active one.
//! SCENE: random contact problems of walls; wedges of soil behind a vertical wall.
//! REFERENCE: all modes tried one by one; the wedge of the largest and of the smallest thrust; tables of coefficients.

use basemat::interface::{EarthPressure, InterfaceLaw};
use basemat::soil::SoilStrength;

use basemat_problems::enumerated_contact::{COUNT, EnumeratedContact, Ranges};
use basemat_problems::random::Random;

fn random_problem(random: &mut Random) -> EnumeratedContact {
    let ranges = Ranges { free_jump: [-3.0, 3.0], pressed: [0.3, 1.0], moved: [-0.5, 0.5] };
    // Some elements stand without the wall, and so open.
    EnumeratedContact::random(random, ranges, |random| {
        (0..COUNT)
            .map(|_| {
                let active = if random.chance(0.2) { 0.0 } else { random.within(0.05, 0.3) };
                [active, random.within(1.0, 2.0)]
            })
            .collect()
    })
}

#[test]
fn the_search_finds_a_solution_of_brute_force() {
    let mut random = Random(71);
    let (mut seen, mut several) = (std::collections::BTreeSet::new(), 0);
    for problem in (0..300).map(|_| random_problem(&mut random)) {
        let laws: [EarthPressure; COUNT] = std::array::from_fn(|e| {
            let [active, passive] = problem.bounds[e];
            EarthPressure::new(active, passive, problem.friction).unwrap()
        });
        let boxed = laws.map(|law| -> Box<dyn InterfaceLaw> { Box::new(law) });
        let all = laws.each_ref().map(InterfaceLaw::modes);
        let (modes, has_others) = problem.assert_found(boxed, all);
        seen.extend(modes);
        several += usize::from(has_others);
    }
    assert_eq!(seen.len(), 10, "{seen:?}");
    println!("several solutions in {several} of 300");
}

/// Thrust of the wedge with a surface at `angle` over that of a fluid of the soil's weight, and its component across the
/// wall.
fn wedge(angle: f64, friction: f64, wall_friction: f64) -> f64 {
    let weight = 1.0 / angle.tan();
    weight * (angle - friction).sin() / (angle - friction - wall_friction).cos()
}

#[test]
fn pressure_ratios_are_those_of_the_extreme_wedges() {
    for (friction, wall_friction) in [(20, 0), (30, 0), (30, 10), (30, 20), (35, 12), (42, 0)] {
        let [phi, delta] = [friction, wall_friction].map(|own| f64::from(own).to_radians());
        let strength = SoilStrength::new(phi).unwrap().with_wall_friction(delta).unwrap();
        let angles = |range: std::ops::Range<f64>| {
            (1..40_000).map(move |k| range.start + (range.end - range.start) * f64::from(k) / 4e4)
        };
        let right_angle = std::f64::consts::FRAC_PI_2;
        let active =
            angles(phi..right_angle).map(|angle| wedge(angle, phi, delta)).fold(0.0, f64::max);
        // Friction acts the other way.
        let passive = angles(0.0..right_angle - phi - delta)
            .map(|angle| wedge(angle, -phi, -delta))
            .fold(f64::INFINITY, f64::min);
        for (found, wanted) in strength.pressure_ratios().into_iter().zip([active, passive]) {
            let error = found / (wanted * delta.cos()) - 1.0;
            assert!(error.abs() < 1e-6, "{friction}° {wall_friction}°: {found} {wanted}");
        }
    }
}

/// Coefficients of Coulomb's thrust, along its direction, as printed in textbooks (Das, *Principles of Foundation
/// Engineering*), and those of Rankine.
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
        let [phi, delta] = [friction, wall_friction].map(f64::to_radians);
        let strength = SoilStrength::new(phi).unwrap().with_wall_friction(delta).unwrap();
        let found = strength.pressure_ratios().map(|ratio| ratio / delta.cos());
        assert!((found[0] - active).abs() < 6e-4, "{friction} {wall_friction}: {found:?}");
        assert!((found[1] / passive - 1.0).abs() < 2e-4, "{friction} {wall_friction}: {found:?}");
    }
}
