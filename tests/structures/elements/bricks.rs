//! GOAL: stiffness, mass and stresses of bricks.
//! SCENE: the patch, the cantilevers and the cylinder of `MacNeal` & Harder (Finite Elements in Analysis and Design 1,
//! 1985), NAFEMS' thick plate LE10, a thick plate on hard supports.
//! REFERENCE: uniform strain, closed forms, an independent program of the same formulation.

use basemat::fem::{Element, Hex8, MassKind, Material};
use basemat_problems::dense::{eigenpairs, largest};
use basemat_problems::supported::{ElementMatrix, assert_near};
use basemat_problems::{bricks, patch};

use super::{add, cross, inner};

/// Displacement of the uniform strain.
fn patch_displacement([x, y, z]: [f64; 3]) -> [f64; 3] {
    [2.0 * x + y + z, x + 2.0 * y + z, x + y + 2.0 * z].map(|value| 0.5e-3 * value)
}

/// PROBLEM: uniform strain on seven distorted bricks, one with a negative Jacobian at a corner. RESULT: no force on
/// inner nodes, the uniform stress at all corners, six motions without force.
#[test]
fn a_patch_of_bricks_carries_a_uniform_strain() {
    let material = Material::new(1.0e6, 0.25, 1.0).unwrap();
    let scene = patch::bricks(material);
    let field: Vec<f64> =
        scene.mesh.nodes().iter().flat_map(|&point| patch_displacement(point)).collect();
    let forces = scene.matrix(ElementMatrix::Stiffness, 1.0).multiply(&field);
    let scale = largest(&forces);
    for force in &forces[24..] {
        assert!(force.abs() < 1e-13 * scale, "{force} of {scale}");
    }
    for nodes in patch::CUBE_BRICKS {
        let brick = Hex8::new(nodes, material);
        let points = scene.points(&nodes);
        let displacement: Vec<f64> =
            points.iter().flat_map(|&point| patch_displacement(point)).collect();
        for stress in brick.stresses(&points, &displacement).unwrap() {
            for (found, value) in stress.iter().zip([2e3, 2e3, 2e3, 4e2, 4e2, 4e2]) {
                assert_near("stress", *found, value, 1e-12);
            }
        }
        let stiffness = ElementMatrix::Stiffness.of(&brick, &points);
        let rows: Vec<Vec<f64>> = stiffness.chunks(24).map(<[f64]>::to_vec).collect();
        let values = eigenpairs(&rows).0;
        assert!(values[..6].iter().all(|value| value.abs() < 1e-14 * values[23]), "{values:?}");
        assert!(values[6] > 1e-6 * values[23], "{values:?}");
    }
}

/// PROBLEM: the faces of a distorted brick. RESULT: the normal by the order of its corners points outwards, and each
/// node is in three faces.
#[test]
fn normals_of_brick_faces_point_outwards() {
    let corners = [[0.0, 0.0], [1.0, -0.2], [1.3, 0.9], [0.1, 1.1]];
    let points: Vec<[f64; 3]> =
        [0.0, 1.2].iter().flat_map(|z| corners.map(|[x, y]| [x + 0.2 * z, y, *z])).collect();
    let center = points.iter().fold([0.0; 3], |sum, &point| add(sum, 0.125, point));
    let material = Material::new(1.0, 0.0, 0.0).unwrap();
    let faces = Hex8::new([0, 1, 2, 3, 4, 5, 6, 7], material).faces();
    let mut uses = [0; 8];
    for face in &faces {
        let at = face.corners().iter().map(|&node| points[node]).collect::<Vec<_>>();
        let normal = cross(add(at[2], -1.0, at[0]), add(at[3], -1.0, at[1]));
        assert!(inner(normal, add(at[0], -1.0, center)) > 0.0, "{face:?}");
        for &node in face.corners() {
            uses[node] += 1;
        }
    }
    assert_eq!((faces.len(), uses), (6, [3; 8]));
}

/// PROBLEM: the straight cantilever of one row of bricks under unit forces and a unit torque at its tip. RESULT: the
/// table's values; 0.978 and 0.973 of the deflections of beam theory for rectangles, locking for trapezoids.
#[test]
fn a_straight_cantilever_of_bricks_deflects_as_tabulated() {
    for (count, slants, table) in [
        (6, [0.0; 2], [2.96288e-5, 0.105_744, 0.420_369, 0.028_608_4]),
        (12, [0.0; 2], [2.98144e-5, 0.107_069, 0.426_719, 0.028_917_1]),
        (6, [1.0; 2], [2.98273e-5, 0.067_416, 0.22828, 0.026_247_3]),
        (6, [1.0, -1.0], [2.98298e-5, 0.005_117_81, 0.013_037, 0.017_941_2]),
    ] {
        for (found, value) in bricks::straight_cantilever(count, slants).into_iter().zip(table) {
            assert_near("straight cantilever", found, value, 3e-6);
        }
    }
}

/// PROBLEM: the twisted cantilever, 12 × 2 × 1 bricks. RESULT: the table's values, 0.992 and 0.986 of those of 96 beams.
#[test]
fn a_twisted_cantilever_of_bricks_deflects_as_tabulated() {
    let computed = bricks::twisted_cantilever([12, 2, 1]);
    assert_near("twisted cantilever, along its width", computed[0], 5.38036e-3, 2e-6);
    assert_near("twisted cantilever, across", computed[1], 1.73007e-3, 2e-6);
}

/// PROBLEM: a thick cylinder under inner pressure, up to ν = 0.4999. RESULT: the table's values, 0.4 to 0.9 % from
/// Lamé: no locking.
#[test]
fn a_thick_cylinder_does_not_lock() {
    for (poisson, value) in
        [(0.3, 4.56138e-3), (0.49, 4.99587e-3), (0.499, 5.01463e-3), (0.4999, 5.0165e-3)]
    {
        assert_near("thick cylinder", bricks::thick_cylinder(poisson), value, 2e-6);
        let inner_square = 9.0_f64;
        let outer_square = 81.0;
        let expected =
            (1.0 + poisson) * inner_square / (1000.0 * (outer_square - inner_square)) / 3.0
                * ((1.0 - 2.0 * poisson) * inner_square + outer_square);
        assert_near("Lamé", value, expected, 1e-2);
    }
}

/// PROBLEM: NAFEMS' elliptic thick plate LE10, 6 × 4 × 2 bricks. RESULT: the table's stress and deflection at D; 2.3 %
/// from finer quadratic bricks.
#[test]
fn an_elliptic_plate_has_the_tabulated_stress() {
    let stress_and_deflection = bricks::elliptic_plate(6);
    assert_near("LE10, deflection", stress_and_deflection[1], -9.44847e-5, 1e-6);
    assert_near("LE10, stress", stress_and_deflection[0], -5.57573e6, 1e-6);
}

/// PROBLEM: a plate 10 m × 10 m × 1 m on hard supports, 8 × 8 × 2 bricks. RESULT: the table's frequencies, without the
/// modes in its plane; Rayleigh and Lamb have 45.971, 109.857, 168.819 and 205.865 Hz.
#[test]
fn a_thick_plate_of_bricks_vibrates_as_tabulated() {
    let scene = bricks::hard_plate([8, 8, 2]).scene;
    for (kind, table) in [
        (MassKind::Consistent, [46.9557, 117.673, 117.673, 182.231, 240.535, 240.535]),
        (MassKind::Lumped, [45.5914, 109.409, 109.409, 162.449, 208.477, 208.477]),
    ] {
        let computed = scene.frequencies(kind, 9);
        for value in table {
            let nearest = computed
                .iter()
                .min_by(|a, b| (*a - value).abs().total_cmp(&(*b - value).abs()))
                .unwrap();
            assert_near("thick plate, Hz", *nearest, value, 4e-6);
        }
    }
}
