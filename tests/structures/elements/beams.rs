//! GOAL: stiffness, mass and geometric stiffness of single beams in space.
//! SCENE: beams of any direction with offsets and releases.
//! REFERENCE: the beam of the plane, rigid motions, closed forms.

use basemat::fem::{Beam, Direction, Element, MassKind, SpaceBeam};
use basemat_problems::dense::{eigenpairs, largest};
use basemat_problems::space_beams::{
    concrete, deep_beam, hinged_cantilever, section, section_with_shear, straight_cantilever,
    thick_cantilever, twisted_cantilever,
};
use basemat_problems::supported::{
    CLAMPED_DIRECTIONS, ElementMatrix, RX, RY, RZ, SupportedMesh, X, Y, Z, assert_near,
};

use super::{add, cross, inner};

const END_POINTS: [[f64; 3]; 2] = [[1.0, 2.0, 0.0], [2.5, 1.0, 3.0]];
const END_OFFSETS: [[f64; 3]; 2] = [[0.3, -0.2, 0.4], [0.1, 0.5, -0.3]];

/// Stiffness, geometric stiffness, consistent and lumped mass.
fn matrices(element: &dyn Element, points: &[[f64; 3]]) -> [Vec<f64>; 4] {
    [
        ElementMatrix::Stiffness,
        ElementMatrix::GeometricStiffness,
        ElementMatrix::Mass(MassKind::Consistent),
        ElementMatrix::Mass(MassKind::Lumped),
    ]
    .map(|part| part.of(element, points))
}

/// PROBLEM: beams of the plane x–z with the section's y axis across it. RESULT: the matrices of the
/// plane's beam, and no coupling between motions in the plane and out of it.
#[test]
fn a_beam_in_a_plane_is_the_beam_of_the_plane() {
    const SPACE_PLACES: [usize; 6] = [0, 2, 4, 6, 8, 10];
    const SPACE_SIGNS: [f64; 6] = [1.0, 1.0, -1.0, 1.0, 1.0, -1.0];
    for [[x0, z0], [x1, z1]] in
        [[[0.0, 0.0], [0.0, 4.0]], [[1.0, -2.0], [4.5, 1.0]], [[0.0, 0.0], [3.0, -0.7]]]
    {
        let plane_beam = Beam::new([0, 1], 30.0e9, 0.12, 1.6e-3, 2500.0)
            .and_then(|beam| beam.with_shear_stiffness(12.5e9 * 0.1))
            .unwrap()
            .with_rotary_inertia();
        let section = section().with_shear_areas([0.07, 0.1]).unwrap();
        let beam = SpaceBeam::new([0, 1], concrete(), section, [0.0, 1.0, 0.0])
            .unwrap()
            .with_rotary_inertia();
        let displacement = [1e-3, 2e-3, 1e-3, -2e-3, -1e-3, 3e-3];
        let mut in_space = [0.0; 12];
        for k in 0..6 {
            in_space[SPACE_PLACES[k]] = SPACE_SIGNS[k] * displacement[k];
        }
        let flat_points = [[x0, z0, 0.0], [x1, z1, 0.0]];
        let points = [[x0, 0.0, z0], [x1, 0.0, z1]];
        let plane_beam = plane_beam.in_static_state(&flat_points, &displacement, 50.0).unwrap();
        let beam = beam.in_static_state(&points, &in_space, 50.0).unwrap();
        assert_near(
            "compression",
            beam.compression().unwrap(),
            plane_beam.compression().unwrap(),
            1e-13,
        );
        let space_matrices = matrices(&beam, &points);
        for (plane_beam, space) in matrices(&plane_beam, &flat_points).iter().zip(&space_matrices) {
            let tolerance = 1e-14 * largest(plane_beam);
            for i in 0..6 {
                let row = &space[12 * SPACE_PLACES[i]..];
                for j in 0..6 {
                    let value = SPACE_SIGNS[i] * SPACE_SIGNS[j] * row[SPACE_PLACES[j]];
                    assert!((value - plane_beam[6 * i + j]).abs() <= tolerance, "({i}, {j})");
                    assert!(row[2 * j + 1].abs() <= tolerance, "({i}, {j}) out of the plane");
                }
            }
        }
    }
}

/// PROBLEM: rotations of both nodes about any point. RESULT: the work of the axial force on the second-order
/// motion of its ends, with taper and rigid arms, and whatever is released.
#[test]
fn an_axial_force_works_on_a_rigid_rotation() {
    for released_directions in [&[][..], &[RY, RZ], &[RX, RZ, Y], &[X], &CLAMPED_DIRECTIONS] {
        let beam = SpaceBeam::new([0, 1], concrete(), section_with_shear(), [1.0, 1.0, 0.2])
            .and_then(|beam| beam.with_offsets(END_OFFSETS))
            .and_then(|beam| beam.with_releases(1, released_directions))
            .unwrap();
        let ends = [0, 1].map(|k| add(END_POINTS[k], 1.0, END_OFFSETS[k]));
        let span = add(ends[1], -1.0, ends[0]);
        let length = inner(span, span).sqrt();
        let along = span.map(|component| component / length);
        let mut displacement = [0.0; 12];
        displacement[6..9].copy_from_slice(&along.map(|component| -2e-3 * component));
        let beam = beam.in_static_state(&END_POINTS, &displacement, 300.0).unwrap();
        let force = beam.compression().unwrap();
        let elastic = 30.0e9 * 0.12 / length * 2e-3;
        let expected = if released_directions.contains(&X) { 0.0 } else { elastic };
        assert!((force - expected).abs() < 1e-12 * elastic, "{force}");
        let taper = 2500.0 * 0.12 * 300.0 * span[2];
        let matrix = ElementMatrix::GeometricStiffness.of(&beam, &END_POINTS);
        for (turn, center) in
            [([0.3, -0.5, 0.8], [1.0, 2.0, -3.0]), ([1.0, 0.2, 0.1], [0.0, 5.0, 0.0])]
        {
            let motion: Vec<f64> = END_POINTS
                .iter()
                .flat_map(|&point| [cross(turn, add(point, -1.0, center)), turn].concat())
                .collect();
            let rows = matrix.chunks(12).zip(&motion);
            let work = rows.map(|(row, value)| {
                0.5 * value * row.iter().zip(&motion).map(|(a, b)| a * b).sum::<f64>()
            });
            let arms = add(
                END_OFFSETS[1].map(|component| (force - 0.5 * taper) * component),
                -(force + 0.5 * taper),
                END_OFFSETS[0],
            );
            let across = add(turn, -inner(turn, along), along);
            let expected_second_order = -0.5 * inner(along, cross(turn, cross(turn, arms)))
                - 0.5 * force * length * inner(across, across);
            let scale = elastic.max(taper);
            assert!(
                (work.sum::<f64>() - expected_second_order).abs() < 1e-13 * scale,
                "{expected_second_order}"
            );
        }
    }
}

/// PROBLEM: offset beams with releases. RESULT: six rigid motions and one more motion for each release cause
/// no force, and the mass of a translation is the whole mass.
#[test]
fn rigid_motions_cause_no_force() {
    for released_directions in [&[][..], &[RY], &[RY, RZ], &[X], &[RX, RZ, Y], &CLAMPED_DIRECTIONS]
    {
        let beam = SpaceBeam::new([0, 1], concrete(), section_with_shear(), [1.0, 1.0, 0.2])
            .and_then(|beam| beam.with_offsets(END_OFFSETS))
            .and_then(|beam| beam.with_releases(1, released_directions))
            .unwrap()
            .with_rotary_inertia();
        let span = add(
            add(END_POINTS[1], 1.0, END_OFFSETS[1]),
            -1.0,
            add(END_POINTS[0], 1.0, END_OFFSETS[0]),
        );
        let length = inner(span, span).sqrt();
        let [stiffness, _, mass, _] = matrices(&beam, &END_POINTS);
        let scale = 30.0e9 * 0.12 / length;
        for kind in 0..6 {
            let mut unit = [0.0; 6];
            unit[kind] = 1.0;
            let shift = [unit[0], unit[1], unit[2]];
            let turn = [unit[3], unit[4], unit[5]];
            let motion: Vec<f64> = END_POINTS
                .iter()
                .flat_map(|&point| [add(cross(turn, point), 1.0, shift), turn].concat())
                .collect();
            for row in stiffness.chunks(12) {
                let force: f64 = row.iter().zip(&motion).map(|(a, b)| a * b).sum();
                assert!(force.abs() < 1e-13 * scale, "{released_directions:?} {kind}: {force}");
            }
            if kind < 3 {
                let momentum: f64 =
                    (0..4).map(|k| mass[12 * (6 * (k / 2) + kind) + 6 * (k % 2) + kind]).sum();
                assert_near("mass", momentum, 2500.0 * 0.12 * length, 1e-12);
            }
        }
        let rows: Vec<Vec<f64>> = stiffness.chunks(12).map(<[f64]>::to_vec).collect();
        let values = eigenpairs(&rows).0;
        let zeros = values.iter().filter(|value| value.abs() < 1e-9 * scale).count();
        assert_eq!(zeros, 6 + released_directions.len(), "{released_directions:?}: {values:?}");
        assert!(values[0] > -1e-13 * scale, "{values:?}");
    }
}

/// PROBLEM: a cantilever hinged against a guide. RESULT: 3 EI/L³, reduced by shear.
#[test]
fn a_hinge_carries_no_moment() {
    for (section, ratio) in
        [(section(), 0.0), (section_with_shear(), 12.0 * 30.0e9 * 0.9e-3 / 1.25e9 / 16.0)]
    {
        let expected = 64.0 / (3.0 * 30.0e9 * 0.9e-3) * (1.0 + 0.25 * ratio);
        assert_near("hinged cantilever", hinged_cantilever(section), expected, 1e-12);
    }
}

/// PROBLEM: the deep beam FV5 of the National Agency for Finite Element Methods and Standards (NAFEMS).
/// RESULT: frequencies of bending, torsion and stretching of the table; they are 1e-3 from closed forms
/// with 40 beams.
#[test]
fn a_deep_beam_vibrates_as_tabulated() {
    let tables = [
        (
            5,
            [
                42.67461, 42.67461, 71.48922, 125.5147, 150.4251, 150.4251, 221.554, 300.0999,
                300.0999,
            ],
        ),
        (
            10,
            [
                42.62453, 42.62453, 71.2693, 125.1285, 148.4263, 148.4263, 215.5696, 286.7565,
                286.7565,
            ],
        ),
    ];
    for (count, table) in tables {
        let scene = deep_beam(count);
        for (found, value) in scene.frequencies(MassKind::Consistent, 9).iter().zip(table) {
            assert_near("FV5, Hz", *found, value, 2e-6);
        }
    }
}

/// PROBLEM: a cantilever 3 m × 4 m × 20 m with rotary inertia and shear. RESULT: frequencies of the table,
/// 0.3 % from Timoshenko's closed form in two modes of each direction with the consistent mass.
#[test]
fn a_thick_cantilever_has_the_frequencies_of_timoshenko() {
    let closed_form = [4.128_065, 5.436_274, 23.67972, 29.49179];
    for (kind, table) in [
        (MassKind::Consistent, [4.128_245, 5.436_675, 23.7123, 29.55256, 59.8951, 71.38831]),
        (MassKind::Lumped, [4.096_018, 5.395_115, 23.05549, 28.77253, 56.83891, 67.75244]),
    ] {
        let scene = thick_cantilever(8, &[Z, RZ]);
        let computed = scene.frequencies(kind, 6);
        for (computed, value) in computed.iter().zip(table) {
            assert_near("cantilever, Hz", *computed, value, 1e-6);
        }
        if kind == MassKind::Consistent {
            for (computed, value) in computed.iter().zip(closed_form) {
                assert_near("Timoshenko, Hz", *computed, value, 3e-3);
            }
        }
    }
}

fn tip_deflection(scene: &SupportedMesh, count: usize, direction: Direction) -> f64 {
    scene.work(&[(count, direction, 1.0)])
}

/// PROBLEM: the straight and the twisted cantilever of `MacNeal` & Harder (1985). RESULT: displacements of the
/// tables.
#[test]
fn cantilevers_deflect_as_tabulated() {
    for count in [1, 6] {
        let beam = straight_cantilever(4.58e-5, count);
        let torsion = 6.0 / (1.0e7 / 2.6 * 4.58e-5);
        for (direction, value) in [(X, 3e-5), (Y, 0.108_093_6), (Z, 0.432_093_6), (RX, torsion)] {
            assert_near(
                "straight cantilever",
                tip_deflection(&beam, count, direction),
                value,
                1e-7,
            );
        }
    }
    // The torsion constant has little effect: the load causes bending.
    let torsion = 1.1 * 0.32_f64.powi(3) / 3.0 * (1.0 - 0.63 * 0.32 / 1.1);
    for (count, [along, across]) in
        [(12, [5.424_036e-3, 1.754_909e-3]), (96, [5.429_239e-3, 1.749_705e-3])]
    {
        let beam = twisted_cantilever(0.32, torsion, count);
        assert_near(
            "twisted cantilever, along its width",
            tip_deflection(&beam, count, Z),
            along,
            1e-6,
        );
        assert_near("twisted cantilever, across", tip_deflection(&beam, count, Y), across, 1e-6);
    }
}
