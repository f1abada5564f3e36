//! GOAL: dynamic stiffnesses of rigid strips are right up to the mesh, which is of second order.
//! SCENE: damped half-plane, layer on rock, layer on a rigid base; bonded and relaxed.
//! REFERENCE: tables of other programs, statics and the cut-off frequency of a layer.

use basemat::bem::GroundError;
use basemat::bem::layered::StripContact;
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::soil::{Elastic, Hysteretic, SoilProfile};
use basemat::{Complex, Error, Soil, unobserved};

use basemat_problems::profiles::{p1, p3};

/// Bonded hh, vv, rr, hr and relaxed hh, vv, rr.
fn all(profile: &SoilProfile, count: usize, omega: f64) -> [Complex; 7] {
    let strip = Strip::new(-1.0..1.0, count, Grading::Cosine).unwrap();
    let ground = ElasticGround::new(profile.clone(), strip).unwrap();
    let at = |contact| {
        let frequency = omega / std::f64::consts::TAU;
        ground.impedances(&[frequency], contact, &mut unobserved).unwrap()[0]
    };
    let (bonded, relaxed) = (at(StripContact::Bonded), at(StripContact::Relaxed));
    [
        bonded.horizontal,
        bonded.vertical,
        bonded.rocking,
        bonded.coupling,
        relaxed.horizontal,
        relaxed.vertical,
        relaxed.rocking,
    ]
}

fn rows(table: &str) -> Vec<Vec<f64>> {
    let numeric = |line: &&str| line.starts_with(|c: char| c.is_ascii_digit());
    let parse = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
    table.lines().filter(numeric).map(parse).collect()
}

/// Largest errors with 16, 32 and 64 elements, and after extrapolation from the last two; relative
/// to hh, vv, rr of the row (hr: of their mean).
fn errors(
    profile: &SoilProfile,
    rows: &[Vec<f64>],
    wanted: impl Fn(&[f64]) -> Vec<(usize, Complex)>,
) -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    for row in rows {
        let meshes = [16, 32, 64].map(|count| all(profile, count, row[0]));
        for (component, wanted) in wanted(row) {
            let size = if component == 3 { meshes[2][0].abs() } else { wanted.abs() };
            for (worst, mesh) in worst.iter_mut().zip(&meshes) {
                *worst = worst.max((mesh[component] - wanted).abs() / size);
            }
            let [_, b, c] = meshes.map(|mesh| mesh[component]);
            let extrapolated = c * (4.0 / 3.0) - b * (1.0 / 3.0);
            worst[3] = worst[3].max((extrapolated - wanted).abs() / size);
        }
    }
    worst
}

fn assert_second_order(name: &str, worst: [f64; 4], least: f64) {
    println!("{name}: 16, 32, 64 elements, extrapolated: {worst:?}");
    for pair in worst[..3].windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.25, "{name}: order {order}");
    }
    assert!(worst[0] < 1.2e-2, "{name}: {worst:?}");
    assert!(worst[3] < least, "{name}: {worst:?}");
}

/// Layered tables (y down as here, cosine meshes extrapolated, good to about 1e-3 by their own account).
#[test]
fn layered_strips_match_the_tables() {
    let damping = |ratio: f64| Hysteretic::new(ratio).unwrap();
    for (name, profile, table) in [
        (
            "layer on rock",
            p1(damping(0.05), damping(0.01)),
            include_str!("../data/layered/impedance_P1_layer_on_rock.csv"),
        ),
        (
            "layer on rigid base",
            p3(damping(0.05)),
            include_str!("../data/layered/impedance_P3_layer_on_rigid_base.csv"),
        ),
    ] {
        let rows: Vec<_> = rows(table).into_iter().step_by(3).collect();
        assert!(rows.len() > 4);
        let worst = errors(&profile, &rows, |row| {
            let columns = [(0, 1), (1, 3), (2, 5), (3, 7), (5, 9), (6, 11)];
            columns.map(|(c, i)| (c, Complex::new(row[i], row[i + 1]))).to_vec()
        });
        assert_second_order(name, worst, 4e-4);
    }
}

/// A damped half-plane (spectral solution, 1e-9): mesh error of second order and nothing else.
#[test]
fn half_plane_strips_match_the_tables() {
    let soil = Soil::new(1.0, 0.25, 1.0).unwrap();
    let profile = SoilProfile::on_half_plane(soil).with_damping(Hysteretic::new(0.05).unwrap());
    let table = include_str!("../data/layered/strip_bonded_nu025_xi05.csv");
    let rows: Vec<_> = rows(table).into_iter().filter(|row| (0.4..8.1).contains(&row[0])).collect();
    let rows: Vec<_> = rows.iter().step_by(rows.len().div_ceil(8)).cloned().collect();
    assert!(rows.len() >= 4);
    let worst = errors(&profile, &rows, |row| {
        (0..4).map(|c| (c, Complex::new(row[1 + 2 * c], row[2 + 2 * c]))).collect()
    });
    assert_second_order("half-plane", worst, 1e-4);
}

/// Static stiffness of a layer on a rigid base.
#[test]
fn static_strips_match_the_table() {
    let table = include_str!("../data/layered/ref_static_layer_on_rigid_base.csv");
    let mut worst = 0.0_f64;
    let mut before = [0.0_f64; 2];
    for row in rows(table) {
        let soil = Soil::new(1.0, row[0], 1.0).unwrap();
        let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, row[1]).unwrap();
        // As the table was made: 12 and 24 elements, extrapolated.
        let [a, b] = [12, 24].map(|count| all(&profile, count, 0.0));
        for (component, column) in [(0, 2), (1, 3), (2, 4), (3, 5), (5, 6), (6, 7)] {
            let found = (4.0 * b[component].re - a[component].re) / 3.0;
            let size = if component == 3 { row[2] } else { row[column] };
            worst = worst.max((found - row[column]).abs() / size);
            for (before, mesh) in before.iter_mut().zip([a, b]) {
                *before = before.max((mesh[component].re - row[column]).abs() / size);
            }
        }
    }
    println!("static: {worst:e}; 12 and 24 elements {before:?}");
    assert!(worst < 1e-7, "{worst:e}");
}

/// Below the first frequency of the layer nothing radiates: Im K = 2ξ K static.
#[test]
fn rigid_base_has_a_cut_off_frequency() {
    let profile = p3(Hysteretic::new(0.05).unwrap());
    let [still, slow] = [0.0, 0.2].map(|omega| all(&profile, 32, omega)[0]);
    println!("{:.6} and {:.6}", slow.im, 0.1 * still.re);
    assert!((slow.im / (0.1 * still.re) - 1.0).abs() < 1e-3);
    assert!((slow.im - 0.24722).abs() < 3e-4);
    // Above the cut-off it does: a0 = π/4 for this layer.
    let fast = all(&profile, 32, 2.0)[0];
    assert!(fast.im > 3.0 * slow.im, "{fast:?}");
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
        let worst = errors(&SoilProfile::on_half_plane(soil), &rows, |row| {
            let value = |c: usize| Complex::new(row[1 + 2 * c], row[2 + 2 * c]);
            let components: &[usize] = if bonded { &[0, 1, 2, 3] } else { &[4, 5, 6] };
            components.iter().map(|c| (*c, value(c % 4))).collect()
        });
        assert_second_order(if bonded { "bonded" } else { "relaxed" }, worst, 2e-4);
    }
    let loss = || Hysteretic::new(1e-3).unwrap();
    for (undamped, damped) in
        [(p1(Elastic, Elastic), p1(loss(), loss())), (p3(Elastic), p3(loss()))]
    {
        for omega in [0.3, 0.6, 1.1, 2.1] {
            let [found, wanted] = [&undamped, &damped].map(|profile| all(profile, 8, omega));
            for k in [0, 1, 2] {
                let error = (found[k] - wanted[k]).abs() / wanted[k].abs();
                assert!(error < 0.02, "{omega} {k}: {error:e}");
            }
        }
    }
    // A ground takes its own profile, a half-plane too.
    let ground = ElasticGround::new(soil, Strip::graded(-1.0..1.0, 8).unwrap()).unwrap();
    let own = ground.impedances(&[0.1, 0.2], StripContact::Bonded, &mut unobserved).unwrap();
    let omega = 0.2 * std::f64::consts::TAU;
    let same = all(&SoilProfile::on_half_plane(soil), 8, omega);
    assert_eq!((own[1].horizontal, own[1].frequency), (same[0], 0.2));
    assert_eq!(own[1].stiffnesses()[2], same[2].re);
    assert!((own[1].dashpots()[1] - same[1].im / omega).abs() < 1e-12);
}

#[test]
fn bad_frequencies_and_resonances_are_refused() {
    let soil = Soil::new(1.0, 0.25, 1.0).unwrap();
    let strip = Strip::uniform(-1.0..1.0, 4).unwrap();
    let at = |profile: &SoilProfile, frequency: f64| {
        ElasticGround::new(profile.clone(), &strip)?.impedances(
            &[frequency],
            StripContact::Bonded,
            &mut unobserved,
        )
    };
    // An undamped layer 2 m thick begins to guide waves at 1/8 Hz.
    let layer = SoilProfile::on_rigid_bedrock().with_layer(soil, 2.0).unwrap();
    let found = at(&layer, 0.125);
    assert!(matches!(found, Err(Error::Ground(GroundError::Unresolved { .. }))), "{found:?}");
    for frequency in [-1.0, f64::NAN, f64::INFINITY, 0.0] {
        let found = at(&SoilProfile::on_half_plane(soil), frequency);
        assert!(matches!(found, Err(Error::Input { .. })), "{found:?}");
    }
    assert!(at(&SoilProfile::on_rigid_bedrock(), 1.0).is_err());
}
