//! GOAL: dynamic stiffnesses of rigid strips are right up to the error of the mesh, which is of second order.
//! SCENE: damped half-plane, layer on rock, layer on a rigid base; bonded and relaxed.
//! REFERENCE: tables of other programs, statics and the cut-off frequency of a layer.

use basemat::bem::GroundError;
use basemat::bem::layered::{StripContact, StripImpedance};
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::soil::{Elastic, Hysteretic, SoilProfile};
use basemat::{Complex, Error, Result, Soil, unobserved};

use basemat_problems::profiles::{p1, p3};

fn hysteretic(ratio: f64) -> Hysteretic {
    Hysteretic::new(ratio).unwrap()
}

/// Bonded hh, vv, rr, hr and relaxed hh, vv, rr.
fn impedance_components(profile: &SoilProfile, count: usize, omega: f64) -> [Complex; 7] {
    let strip = Strip::new(-1.0..1.0, count, Grading::Cosine).unwrap();
    let ground = ElasticGround::new(profile.clone(), strip).unwrap();
    let frequencies = [omega / std::f64::consts::TAU];
    let bonded = ground.impedances(&frequencies, StripContact::Bonded, &mut unobserved).unwrap()[0];
    let relaxed_impedance =
        ground.impedances(&frequencies, StripContact::Relaxed, &mut unobserved).unwrap()[0];
    [
        bonded.horizontal,
        bonded.vertical,
        bonded.rocking,
        bonded.coupling,
        relaxed_impedance.horizontal,
        relaxed_impedance.vertical,
        relaxed_impedance.rocking,
    ]
}

/// Numbers of the lines that begin with a digit.
fn rows(table: &str) -> Vec<Vec<f64>> {
    table
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect()
}

/// Largest errors with 16, 32 and 64 elements, and after extrapolation from the last two.
///
/// Errors are relative to hh, vv, rr of the row (hr: to hh). `expected` returns components of a row.
fn largest_errors(
    profile: &SoilProfile,
    rows: &[Vec<f64>],
    expected: impl Fn(&[f64]) -> Vec<(usize, Complex)>,
) -> [f64; 4] {
    let mut max_errors = [0.0_f64; 4];
    for row in rows {
        let meshes = [16, 32, 64].map(|count| impedance_components(profile, count, row[0]));
        for (component, expected) in expected(row) {
            let scale = if component == 3 { meshes[2][0].abs() } else { expected.abs() };
            for (max_errors, mesh) in max_errors.iter_mut().zip(&meshes) {
                *max_errors = max_errors.max((mesh[component] - expected).abs() / scale);
            }
            let extrapolated_value =
                meshes[2][component] * (4.0 / 3.0) - meshes[1][component] * (1.0 / 3.0);
            max_errors[3] = max_errors[3].max((extrapolated_value - expected).abs() / scale);
        }
    }
    max_errors
}

fn assert_second_order(name: &str, errors: [f64; 4], extrapolated_limit: f64) {
    println!("{name}: 16, 32, 64 elements, extrapolated: {errors:?}");
    for pair in errors[..3].windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.25, "{name}: order {order}");
    }
    assert!(errors[0] < 1.2e-2, "{name}: {errors:?}");
    assert!(errors[3] < extrapolated_limit, "{name}: {errors:?}");
}

/// GOAL: strips on layers agree with the tables of another program.
/// REFERENCE: y down as here, cosine meshes extrapolated, stated to be good to about 1e-3.
#[test]
fn layered_strips_match_the_tables() {
    for (name, profile, table) in [
        (
            "layer on rock",
            p1(hysteretic(0.05), hysteretic(0.01)),
            include_str!("../data/layered/impedance_P1_layer_on_rock.csv"),
        ),
        (
            "layer on rigid base",
            p3(hysteretic(0.05)),
            include_str!("../data/layered/impedance_P3_layer_on_rigid_base.csv"),
        ),
    ] {
        let rows: Vec<_> = rows(table).into_iter().step_by(3).collect();
        assert!(rows.len() > 4);
        let errors = largest_errors(&profile, &rows, |row| {
            let columns = [(0, 1), (1, 3), (2, 5), (3, 7), (5, 9), (6, 11)];
            columns.map(|(c, i)| (c, Complex::new(row[i], row[i + 1]))).to_vec()
        });
        assert_second_order(name, errors, 4e-4);
    }
}

/// GOAL: on a damped half-plane the only error is the mesh's, of second order.
/// REFERENCE: a spectral solution, good to 1e-9.
#[test]
fn half_plane_strips_match_the_tables() {
    let soil = Soil::new(1.0, 0.25, 1.0).unwrap();
    let profile = SoilProfile::on_half_plane(soil).with_damping(hysteretic(0.05));
    let table = include_str!("../data/layered/strip_bonded_nu025_xi05.csv");
    let rows: Vec<_> = rows(table).into_iter().filter(|row| (0.4..8.1).contains(&row[0])).collect();
    let rows: Vec<_> = rows.iter().step_by(rows.len().div_ceil(8)).cloned().collect();
    assert!(rows.len() >= 4);
    let errors = largest_errors(&profile, &rows, |row| {
        (0..4).map(|c| (c, Complex::new(row[1 + 2 * c], row[2 + 2 * c]))).collect()
    });
    assert_second_order("half-plane", errors, 1e-4);
}

/// GOAL: static stiffnesses of strips on a layer on a rigid base agree with a table.
#[test]
fn static_strips_match_the_table() {
    let table = include_str!("../data/layered/ref_static_layer_on_rigid_base.csv");
    let mut extrapolated_error = 0.0_f64;
    let mut mesh_errors = [0.0_f64; 2];
    for row in rows(table) {
        let soil = Soil::new(1.0, row[0], 1.0).unwrap();
        let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, row[1]).unwrap();
        // As the table was made: 12 and 24 elements, extrapolated.
        let meshes = [12, 24].map(|count| impedance_components(&profile, count, 0.0));
        for (component, column) in [(0, 2), (1, 3), (2, 4), (3, 5), (5, 6), (6, 7)] {
            let expected = row[column];
            let extrapolated_value =
                (4.0 * meshes[1][component].re - meshes[0][component].re) / 3.0;
            let scale = if component == 3 { row[2] } else { expected };
            extrapolated_error =
                extrapolated_error.max((extrapolated_value - expected).abs() / scale);
            for (error, mesh) in mesh_errors.iter_mut().zip(meshes) {
                *error = error.max((mesh[component].re - expected).abs() / scale);
            }
        }
    }
    println!("static: {extrapolated_error:e}; 12 and 24 elements {mesh_errors:?}");
    assert!(extrapolated_error < 1e-7, "{extrapolated_error:e}");
}

/// GOAL: below the first frequency of the layer nothing radiates: Im K = 2ξ K static.
#[test]
fn rigid_base_has_a_cut_off_frequency() {
    let profile = p3(hysteretic(0.05));
    let static_impedance = impedance_components(&profile, 32, 0.0)[0];
    let slow_impedance = impedance_components(&profile, 32, 0.2)[0];
    let fast_impedance = impedance_components(&profile, 32, 2.0)[0];
    println!("{:.6} and {:.6}", slow_impedance.im, 0.1 * static_impedance.re);
    assert!((slow_impedance.im / (0.1 * static_impedance.re) - 1.0).abs() < 1e-3);
    assert!((slow_impedance.im - 0.24722).abs() < 3e-4);
    // Above the cut-off, a0 = π/4 for this layer, waves radiate.
    assert!(fast_impedance.im > 3.0 * slow_impedance.im, "{fast_impedance:?}");
}

/// GOAL: undamped ground, whose poles lie on the path, is the limit of damped ground.
/// SCENE: half-plane; layer on rock and on a rigid base, away from its resonances.
/// REFERENCE: table of the undamped strip, another code's; hysteretic damping of a thousandth.
#[test]
fn undamped_ground_is_extrapolated() {
    let soil = Soil::new(1.0, 0.25, 1.0).unwrap();
    for (table, bonded) in [
        (include_str!("../data/strip_bonded_nu025_xi00.csv"), true),
        (include_str!("../data/strip_relaxed_nu025_xi00.csv"), false),
    ] {
        let rows = rows(table).into_iter();
        let rows: Vec<_> = rows.filter(|row| (0.04..8.1).contains(&row[0])).step_by(12).collect();
        assert!(rows.len() > 6);
        let errors = largest_errors(&SoilProfile::on_half_plane(soil), &rows, |row| {
            let components = if bonded { 0..4 } else { 4..7 };
            components
                .map(|c| {
                    let column = 1 + 2 * (c % 4);
                    (c, Complex::new(row[column], row[column + 1]))
                })
                .collect()
        });
        assert_second_order(if bonded { "bonded" } else { "relaxed" }, errors, 2e-4);
    }
    let slightly_damped_layer = p1(hysteretic(1e-3), hysteretic(1e-3));
    for (undamped, damped) in
        [(p1(Elastic, Elastic), slightly_damped_layer), (p3(Elastic), p3(hysteretic(1e-3)))]
    {
        for omega in [0.3, 0.6, 1.1, 2.1] {
            let computed = impedance_components(&undamped, 8, omega);
            let expected = impedance_components(&damped, 8, omega);
            for k in [0, 1, 2] {
                let error = (computed[k] - expected[k]).abs() / expected[k].abs();
                assert!(error < 0.02, "{omega} {k}: {error:e}");
            }
        }
    }
}

/// GOAL: a ground on a soil is a ground on its half-plane profile; stiffness and dashpot are parts of the impedance.
#[test]
fn impedances_of_a_soil_are_those_of_its_profile() {
    let soil = Soil::new(1.0, 0.25, 1.0).unwrap();
    let ground = ElasticGround::new(soil, Strip::graded(-1.0..1.0, 8).unwrap()).unwrap();
    let contact = StripContact::Bonded;
    let impedance = ground.impedances(&[0.1, 0.2], contact, &mut unobserved).unwrap()[1];
    let omega = 0.2 * std::f64::consts::TAU;
    let expected = impedance_components(&SoilProfile::on_half_plane(soil), 8, omega);
    assert_eq!((impedance.horizontal, impedance.frequency), (expected[0], 0.2));
    assert_eq!(impedance.stiffnesses()[2], expected[2].re);
    assert!((impedance.dashpots()[1] - expected[1].im / omega).abs() < 1e-12);
}

/// Impedances of four elements at one frequency (Hz).
fn impedances_at(profile: SoilProfile, frequency: f64) -> Result<Vec<StripImpedance>> {
    let ground = ElasticGround::new(profile, Strip::uniform(-1.0..1.0, 4).unwrap())?;
    ground.impedances(&[frequency], StripContact::Bonded, &mut unobserved)
}

/// GOAL: frequencies out of range, resonances and profiles without soil are errors.
#[test]
fn invalid_frequencies_and_resonances_are_errors() {
    let soil = Soil::new(1.0, 0.25, 1.0).unwrap();
    // An undamped layer 2 m thick guides waves from 1/8 Hz.
    let layer = SoilProfile::on_rigid_bedrock().with_layer(soil, 2.0).unwrap();
    let result = impedances_at(layer, 0.125);
    assert!(matches!(result, Err(Error::Ground(GroundError::Unresolved { .. }))), "{result:?}");
    for frequency in [-1.0, f64::NAN, f64::INFINITY, 0.0] {
        let result = impedances_at(SoilProfile::on_half_plane(soil), frequency);
        assert!(matches!(result, Err(Error::Input { .. })), "{result:?}");
    }
    assert!(impedances_at(SoilProfile::on_rigid_bedrock(), 1.0).is_err());
}
