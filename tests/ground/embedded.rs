//! GOAL: impedances and kinematic motion of rigid bodies in a trench are right up to the mesh, which is of second
//! order.
//! SCENE: a block as deep as half its width in a half-plane, in a layer on rock and on rigid bedrock; strips.
//! REFERENCE: tables of two methods (finite elements, boundary elements) and of a spectral method for strips; strips on
//! the surface; statics.

use std::f64::consts::TAU;

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::bem::layered::{StripContact, StripImpedance};
use basemat::bem::{ElasticGround, GroundError, Strip};
use basemat::soil::{Elastic, Hysteretic, SoilProfile};
use basemat::{Complex, Error, Soil, unobserved};

use basemat_problems::profiles::{p1, p3};

fn soil() -> Soil {
    Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap()
}

fn hysteretic(ratio: f64) -> Hysteretic {
    Hysteretic::new(ratio).unwrap()
}

/// A trench of half width and depth 1.
fn ground(profile: impl Into<SoilProfile>, base: usize, wall: usize) -> TrenchGround {
    let elements = Trench::new(-1.0..1.0, 1.0).unwrap().elements(base, wall).unwrap();
    TrenchGround::new(profile, elements).unwrap()
}

fn impedance_at(ground: &TrenchGround, omega: f64) -> StripImpedance {
    ground.impedances(&[omega / TAU], &mut unobserved).unwrap()[0]
}

/// Horizontal, vertical, rocking and coupling impedance.
fn components(impedance: &StripImpedance) -> [Complex; 4] {
    [impedance.horizontal, impedance.vertical, impedance.rocking, impedance.coupling]
}

fn numbers(line: &str) -> Vec<f64> {
    line.split(',').filter_map(|number| number.parse().ok()).collect()
}

/// The row of a table that begins with these numbers.
fn row(table: &str, first: &[f64]) -> Vec<f64> {
    let rows = table.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    rows.map(numbers).find(|row| row.starts_with(first)).unwrap()
}

/// Complex numbers of a table, as real and imaginary parts.
fn complex_numbers(parts: &[f64]) -> Vec<Complex> {
    parts.chunks(2).map(|part| Complex::new(part[0], part[1])).collect()
}

/// Relative errors of hh, vv, rr, and of hr by the mean of hh and rr.
fn errors(computed: &StripImpedance, expected: &[Complex]) -> [f64; 4] {
    let computed = components(computed);
    std::array::from_fn(|k| {
        let size = if k == 3 {
            (expected[0].abs() * expected[2].abs()).sqrt()
        } else {
            expected[k].abs()
        };
        (computed[k] - expected[k]).abs() / size
    })
}

/// GOAL: impedances of a block in a half-plane agree with finite elements, at second order of the mesh.
#[test]
fn embedded_impedances_match_the_table_with_second_order() {
    let table = include_str!("../data/embedded/impedance_embedded_nu0333.csv");
    let coarse_ground = ground(soil(), 4, 3);
    let fine_ground = ground(soil(), 8, 6);
    for a0 in [0.5, 2.0] {
        let expected = complex_numbers(&row(table, &[1.0, a0])[2..10]);
        let coarse = errors(&impedance_at(&coarse_ground, a0), &expected);
        let fine = errors(&impedance_at(&fine_ground, a0), &expected);
        println!("{a0}: {coarse:?} {fine:?}");
        assert!(fine.iter().all(|error| *error < 5e-3), "{fine:?}");
        for (coarse, fine) in coarse.iter().zip(fine) {
            assert!(coarse / fine > 4.0, "{coarse} {fine}");
        }
    }
}

/// GOAL: translation and rotation of the massless block under vertical waves agree with the table.
#[test]
fn kinematic_motions_match_the_table() {
    let table = include_str!("../data/embedded/kinematic_embedded_nu0333.csv");
    let ground = ground(soil(), 8, 6);
    for a0 in [0.5, 2.0] {
        let row = row(table, &[1.0, a0]);
        let computed = ground.kinematic_motions(&[a0 / TAU], &mut unobserved).unwrap()[0];
        let expected = [Complex::new(row[2], row[3]), Complex::new(row[4], row[5])];
        let errors = [computed.horizontal - expected[0], computed.rotation - expected[1]];
        println!("{a0}: {errors:?}");
        assert!(errors.iter().all(|error| error.abs() < 1.5e-3 * expected[0].abs()), "{errors:?}");
    }
    // Walls move the base with the waves above it: its motion is less than cos(ωd/c_P) of the surface's, with a phase.
    let motion = ground.kinematic_motions(&[1.0 / TAU], &mut unobserved).unwrap()[0];
    assert!((motion.vertical.abs() - 0.5_f64.cos()).abs() < 0.1, "{motion:?}");
}

/// GOAL: impedances of a block in a layer on rock agree with the table.
#[test]
fn embedded_impedances_in_layers_match_the_table() {
    let table = include_str!("../data/embedded/impedance_embedded_layered.csv");
    let ground = ground(p1(hysteretic(0.05), hysteretic(0.01)), 8, 6);
    for a0 in [0.5, 2.0] {
        let lines = table.lines().filter(|line| line.starts_with("layer"));
        let row = lines.map(numbers).find(|row| row[0] == a0).unwrap();
        let errors = errors(&impedance_at(&ground, a0), &complex_numbers(&row[2..10]));
        println!("{a0}: {errors:?}");
        assert!(errors.iter().all(|error| *error < 1e-3), "{errors:?}");
    }
}

/// GOAL: finite elements of degree 4 differ from wavenumber integrals by less than a tenth of the mesh's error.
/// REFERENCE: the same elements on the surface.
#[test]
fn a_trench_without_depth_is_a_strip_on_the_surface() {
    let layer_on_rock = p1(hysteretic(0.05), hysteretic(0.01));
    for profile in [layer_on_rock, p3(hysteretic(0.05)), soil().into()] {
        let elements = Trench::new(-1.0..1.0, 0.0).unwrap().elements(8, 0).unwrap();
        let trench = TrenchGround::new(profile.clone(), elements).unwrap();
        let strip = ElasticGround::new(profile, Strip::graded(-1.0..1.0, 8).unwrap()).unwrap();
        let bonded = StripContact::Bonded;
        let expected = strip.impedances(&[1.5 / TAU], bonded, &mut unobserved).unwrap()[0];
        let errors = errors(&impedance_at(&trench, 1.5), &components(&expected));
        println!("{errors:?}");
        assert!(errors.iter().all(|error| *error < 1e-3), "{errors:?}");
    }
}

/// GOAL: 32 elements, shorter towards both ends, agree with a spectral method.
#[test]
fn a_trench_without_depth_matches_the_table_of_a_strip() {
    let table = include_str!("../data/strip_bonded_nu0333_xi00.csv");
    let elements = Trench::new(-1.0..1.0, 0.0).unwrap().elements(32, 0).unwrap();
    let ground = TrenchGround::new(soil(), elements).unwrap();
    for a0 in [0.5, 2.0] {
        let expected = complex_numbers(&row(table, &[a0])[1..9]);
        let errors = errors(&impedance_at(&ground, a0), &expected);
        println!("{a0}: {errors:?}");
        assert!(errors.iter().all(|error| *error < 2e-3), "{errors:?}");
    }
}

/// GOAL: rigid bedrock gives a static stiffness, and the body moves with it at frequency zero.
#[test]
fn a_rigid_base_holds_the_body_at_rest() {
    let ground = ground(p3(Elastic), 4, 3);
    let static_impedance = impedance_at(&ground, 0.0);
    let slow_impedance = impedance_at(&ground, 0.1);
    for (static_impedance, slow_impedance) in [
        (static_impedance.horizontal, slow_impedance.horizontal),
        (static_impedance.rocking, slow_impedance.rocking),
    ] {
        assert_eq!(static_impedance.im, 0.0);
        assert!(
            (slow_impedance.re / static_impedance.re - 1.0).abs() < 0.01
                && slow_impedance.im.abs() < 1e-6 * static_impedance.re
        );
    }
    let motion = ground.kinematic_motions(&[0.0], &mut unobserved).unwrap()[0];
    assert!(
        (motion.horizontal.re - 1.0).abs() < 1e-9 && motion.rotation.abs() < 1e-9,
        "{motion:?}"
    );
    assert!((motion.vertical.re - 1.0).abs() < 1e-9);
}

/// GOAL: soft backfill reduces the rocking stiffness; backfill of the soil itself changes nothing.
/// SCENE: a quarter of the soil's modulus, half as wide as the half width of the trench.
#[test]
fn backfill_softens_the_walls() {
    let soft_soil = Soil::new(0.25, 1.0 / 3.0, 1.0).unwrap();
    let filled_ground =
        ground(soil(), 8, 6).with_backfill(0.5, soft_soil, hysteretic(0.05)).unwrap();
    let rocking = impedance_at(&filled_ground, 0.5).rocking;
    // With 40 elements rocking has 3.65 + 0.88i; without backfill it has 5.25 + 1.61i.
    assert!((rocking - Complex::new(3.65, 0.88)).abs() < 0.03, "{rocking:?}");
    let result = filled_ground.kinematic_motions(&[0.1], &mut unobserved);
    assert!(matches!(result, Err(Error::Scene { quantity: "backfill", .. })), "{result:?}");
    // Backfill of the soil itself changes the mesh and nothing else.
    let filled_with_soil = ground(soil(), 4, 3).with_backfill(0.5, soil(), Elastic).unwrap();
    let filled_ground = impedance_at(&filled_with_soil, 0.5).rocking;
    let unfilled = impedance_at(&ground(soil(), 4, 3), 0.5).rocking;
    assert!((filled_ground - unfilled).abs() < 1e-4 * unfilled.abs());
}

/// GOAL: trenches and frequencies out of range give typed errors.
#[test]
fn bad_trenches_and_frequencies_are_errors() {
    for (sides, depth) in
        [(1.0..1.0, 1.0), (0.0..f64::NAN, 1.0), (0.0..1.0, -1.0), (0.0..1.0, f64::INFINITY)]
    {
        assert!(matches!(Trench::new(sides, depth), Err(Error::Input { .. })));
    }
    let trench = Trench::new(-1.0..1.0, 1.0).unwrap();
    for (base, wall) in [(0, 3), (3, 3), (4, 0)] {
        assert!(matches!(trench.elements(base, wall), Err(Error::Scene { .. })));
    }
    assert!(matches!(trench.elements(usize::MAX - 1, usize::MAX), Err(Error::Memory(_))));
    let deep_elements = Trench::new(-1.0..1.0, 2.0).unwrap().elements(4, 3).unwrap();
    assert!(matches!(
        TrenchGround::new(p3(Elastic), deep_elements),
        Err(Error::Input { value: 2.0, .. })
    ));
    let half_plane = ground(soil(), 4, 3);
    for frequency in [0.0, -1.0, f64::NAN, 10.0] {
        let result = half_plane.impedances(&[frequency], &mut unobserved);
        assert!(matches!(result, Err(Error::Input { .. })), "{frequency}: {result:?}");
    }
    // The frequency is the cut-off of an undamped layer on rigid bedrock.
    let layer = ground(p3(Elastic), 4, 3);
    let result = layer.impedances(&[0.25 * 0.5], &mut unobserved);
    assert!(matches!(result, Err(Error::Ground(GroundError::GuidedWave { .. }))), "{result:?}");
}
