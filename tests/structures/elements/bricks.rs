//! GOAL: stiffness, mass and stresses of bricks.
//! SCENE: the patch, the cantilevers and the cylinder of `MacNeal` & Harder (Finite Elements in Analysis and Design 1,
//! 1985), NAFEMS' thick plate LE10, a thick plate on hard supports.
//! REFERENCE: uniform strain, closed forms, an independent program of the same formulation.

use basemat::fem::{Element, Hex8, MassKind, Material, Spring};
use basemat_problems::dense::eigenvalues;

use super::{add, cross, inner};
use crate::space_support::{HINGED, Load, Part, Supported, X, Y, Z, near};

/// Block of bricks whose nodes `at` places by their indices in the grid; returns the number of such a node.
fn block(
    scene: &mut Supported,
    [nx, ny, nz]: [usize; 3],
    material: Material,
    at: &dyn Fn([usize; 3]) -> [f64; 3],
) -> impl Fn(usize, usize, usize) -> usize + Copy + use<> {
    let place = move |i: usize, j: usize, k: usize| (i * (ny + 1) + j) * (nz + 1) + k;
    for i in 0..=nx {
        for j in 0..=ny {
            for k in 0..=nz {
                scene.node(at([i, j, k]));
            }
        }
    }
    for i in 0..nx {
        for j in 0..ny {
            for k in 0..nz {
                let lower = [place(i, j, k), place(i + 1, j, k), place(i + 1, j + 1, k)];
                let [a, b, c] = lower;
                let d = place(i, j + 1, k);
                scene.add(Hex8::new([a, b, c, d, a + 1, b + 1, c + 1, d + 1], material));
            }
        }
    }
    place
}

/// PROBLEM: uniform strain on seven distorted bricks, one with a negative Jacobian at a corner. RESULT: no force on
/// inner nodes, the uniform stress at all corners, six motions without force.
#[test]
fn a_patch_of_bricks_carries_a_uniform_strain() {
    const INNER: [[f64; 3]; 8] = [
        [0.249, 0.342, 0.192],
        [0.826, 0.288, 0.288],
        [0.850, 0.649, 0.263],
        [0.273, 0.750, 0.230],
        [0.320, 0.186, 0.643],
        [0.677, 0.305, 0.683],
        [0.788, 0.693, 0.644],
        [0.165, 0.745, 0.702],
    ];
    const BRICKS: [[usize; 8]; 7] = [
        [8, 9, 10, 11, 12, 13, 14, 15],
        [0, 1, 2, 3, 8, 9, 10, 11],
        [12, 13, 14, 15, 4, 5, 6, 7],
        [0, 1, 9, 8, 4, 5, 13, 12],
        [1, 2, 10, 9, 5, 6, 14, 13],
        [2, 3, 11, 10, 6, 7, 15, 14],
        [3, 0, 8, 11, 7, 4, 12, 15],
    ];
    let material = Material::new(1.0e6, 0.25, 1.0).unwrap();
    let mut scene = Supported::new();
    for z in [0.0, 1.0] {
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            scene.node([x, y, z]);
        }
    }
    for point in INNER {
        scene.node(point);
    }
    for nodes in BRICKS {
        scene.add(Hex8::new(nodes, material));
    }
    let exact = |[x, y, z]: [f64; 3]| {
        [2.0 * x + y + z, x + 2.0 * y + z, x + y + 2.0 * z].map(|value| 0.5e-3 * value)
    };
    let field: Vec<f64> = scene.mesh.nodes().iter().flat_map(|&point| exact(point)).collect();
    let forces = scene.matrix(Part::Stiffness, 1.0).multiply(&field);
    let scale = forces.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    for force in &forces[24..] {
        assert!(force.abs() < 1e-13 * scale, "{force} of {scale}");
    }
    let unit = |i: usize| (0..24).map(|j| f64::from(u8::from(i == j))).collect();
    let unit: Vec<Vec<f64>> = (0..24).map(unit).collect();
    for nodes in BRICKS {
        let (brick, points) = (Hex8::new(nodes, material), scene.points(&nodes));
        let displacement: Vec<f64> = points.iter().flat_map(|&point| exact(point)).collect();
        for stress in brick.stresses(&points, &displacement).unwrap() {
            for (found, value) in stress.iter().zip([2e3, 2e3, 2e3, 4e2, 4e2, 4e2]) {
                near("stress", *found, value, 1e-12);
            }
        }
        let stiffness = Part::Stiffness.of(&brick, &points);
        let rows: Vec<Vec<f64>> = stiffness.chunks(24).map(<[f64]>::to_vec).collect();
        let values = eigenvalues(&rows, &unit);
        assert!(values[..6].iter().all(|value| value.abs() < 1e-14 * values[23]), "{values:?}");
        assert!(values[6] > 1e-6 * values[23], "{values:?}");
    }
}

/// PROBLEM: the faces of a distorted brick. RESULT: each has its outside on the left of its sides, and each node is in
/// three faces.
#[test]
fn faces_of_a_brick_look_outwards() {
    let corners = [[0.0, 0.0], [1.0, -0.2], [1.3, 0.9], [0.1, 1.1]];
    let points: Vec<[f64; 3]> =
        [0.0, 1.2].iter().flat_map(|z| corners.map(|[x, y]| [x + 0.2 * z, y, *z])).collect();
    let centre = points.iter().fold([0.0; 3], |sum, &point| add(sum, 0.125, point));
    let material = Material::new(1.0, 0.0, 0.0).unwrap();
    let faces = Hex8::new([0, 1, 2, 3, 4, 5, 6, 7], material).faces();
    let mut uses = [0; 8];
    for face in &faces {
        let at = face.corners().iter().map(|&node| points[node]).collect::<Vec<_>>();
        let normal = cross(add(at[2], -1.0, at[0]), add(at[3], -1.0, at[1]));
        assert!(inner(normal, add(at[0], -1.0, centre)) > 0.0, "{face:?}");
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
        let material = Material::new(1.0e7, 0.3, 0.0).unwrap();
        let mut scene = Supported::new();
        let height = 6.0 / count as f64;
        let place = block(&mut scene, [count, 1, 1], material, &|[i, j, k]| {
            // Parallelograms, or trapezoids with alternating signs.
            let slant = match i {
                0 => 0.0,
                i if i == count => 0.0,
                i if i % 2 == 1 => 0.1 * height * slants[0],
                _ => 0.1 * height * slants[1],
            };
            let [y, z] = [j as f64, k as f64];
            [height * i as f64 + slant * (1.0 - 2.0 * y), 0.2 * y, 0.1 * z]
        });
        let corners = [[0, 0], [0, 1], [1, 0], [1, 1]];
        for [j, k] in corners {
            scene.hold(place(0, j, k), &HINGED);
        }
        let force =
            |axis: usize| corners.map(|[j, k]| (place(count, j, k), HINGED[axis], 0.25)).to_vec();
        let torque: Vec<Load> = corners
            .into_iter()
            .flat_map(|[j, k]| {
                let [y, z] = [j, k].map(|side| 2.0 * side as f64 - 1.0);
                [(place(count, j, k), Z, 1.25 * y), (place(count, j, k), Y, -2.5 * z)]
            })
            .collect();
        for (loads, value) in [force(0), force(1), force(2), torque].iter().zip(table) {
            near("straight cantilever", scene.work(loads), value, 3e-6);
        }
    }
}

/// PROBLEM: the twisted cantilever, 12 × 2 × 1 bricks. RESULT: the table's values, 0.992 and 0.986 of 96 beams'.
#[test]
fn a_twisted_cantilever_of_bricks_deflects_as_tabulated() {
    let material = Material::new(2.9e7, 0.22, 0.0).unwrap();
    let mut scene = Supported::new();
    let place = block(&mut scene, [12, 2, 1], material, &|[i, j, k]| {
        let x = i as f64;
        let (sine, cosine) = (std::f64::consts::FRAC_PI_2 * x / 12.0).sin_cos();
        let [y, z] = [1.1 * (0.5 * j as f64 - 0.5), 0.32 * (k as f64 - 0.5)];
        [x, y * cosine - z * sine, y * sine + z * cosine]
    });
    let section = [[0, 0], [0, 1], [1, 0], [1, 1], [2, 0], [2, 1]];
    for [j, k] in section {
        scene.hold(place(0, j, k), &HINGED);
    }
    for (direction, value) in [(Z, 5.38036e-3), (Y, 1.73007e-3)] {
        let weight = |j: usize| if j == 1 { 0.25 } else { 0.125 };
        let loads = section.map(|[j, k]| (place(12, j, k), direction, weight(j)));
        near("twisted cantilever", scene.work(&loads), value, 2e-6);
    }
}

/// PROBLEM: a thick cylinder under inner pressure, up to ν = 0.4999. RESULT: the table's values, 0.4 to 0.9 % from
/// Lamé: no locking.
#[test]
fn a_thick_cylinder_does_not_lock() {
    const RADII: [f64; 6] = [3.0, 3.5, 4.2, 5.2, 6.75, 9.0];
    let angle = 10.0_f64.to_radians();
    for (poisson, value) in
        [(0.3, 4.56138e-3), (0.49, 4.99587e-3), (0.499, 5.01463e-3), (0.4999, 5.0165e-3)]
    {
        let mut scene = Supported::new();
        let material = Material::new(1000.0, poisson, 0.0).unwrap();
        let place = block(&mut scene, [5, 1, 1], material, &|[i, j, k]| {
            let (sine, cosine) = (angle * j as f64).sin_cos();
            [RADII[i] * cosine, RADII[i] * sine, k as f64]
        });
        let (sine, cosine) = angle.sin_cos();
        for i in 0..6 {
            for k in 0..2 {
                scene.hold(place(i, 0, k), &[Y, Z]);
                // The other radial face moves in its plane: a stiff spring across it.
                let node = place(i, 1, k);
                let [x, y, z] = scene.mesh.nodes()[node];
                let support = scene.node([x + sine, y - cosine, z]);
                scene.add(Spring::axial_in_space([node, support], 1.0e10).unwrap());
                scene.hold(node, &[Z]);
                scene.hold(support, &HINGED);
            }
        }
        let force = 3.0 * angle / 4.0;
        let loads: Vec<Load> = (0..2)
            .flat_map(|k| {
                let [lower, upper] = [place(0, 0, k), place(0, 1, k)];
                [(lower, X, force), (upper, X, force * cosine), (upper, Y, force * sine)]
            })
            .collect();
        near("thick cylinder", scene.solve(&loads)(place(0, 0, 0), X), value, 2e-6);
        let (inner, outer) = (9.0_f64, 81.0);
        let exact = (1.0 + poisson) * inner / (1000.0 * (outer - inner)) / 3.0
            * ((1.0 - 2.0 * poisson) * inner + outer);
        near("Lamé", value, exact, 1e-2);
    }
}

/// PROBLEM: NAFEMS' elliptic thick plate LE10, 6 × 4 × 2 bricks. RESULT: the table's stress and deflection at D; 2.3 %
/// from finer quadratic bricks.
#[test]
fn an_elliptic_plate_has_the_tabulated_stress() {
    let material = Material::new(210.0e9, 0.3, 0.0).unwrap();
    let mut scene = Supported::new();
    let place = block(&mut scene, [4, 6, 2], material, &|[i, j, k]| {
        let (sine, cosine) = (std::f64::consts::FRAC_PI_2 * j as f64 / 6.0).sin_cos();
        let part = 0.25 * i as f64;
        [(2.0 + 1.25 * part) * cosine, (1.0 + 1.75 * part) * sine, 0.3 * k as f64]
    });
    for k in 0..3 {
        for i in 0..5 {
            scene.hold(place(i, 0, k), &[Y]);
            scene.hold(place(i, 6, k), &[X]);
        }
        for j in 0..7 {
            scene.hold(place(4, j, k), if k == 1 { &HINGED } else { &[X, Y] });
        }
    }
    let mut loads: Vec<Load> = Vec::new();
    for i in 0..4 {
        for j in 0..6 {
            let nodes = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            loads.extend(pressure(&scene, nodes.map(|[i, j]| place(i, j, 2)), 1.0e6));
        }
    }
    let found = scene.solve(&loads);
    near("LE10, deflection", found(place(0, 0, 2), Z), -9.44847e-5, 1e-6);
    let nodes = [1, 2].map(|k| [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| place(i, j, k)));
    let nodes: [usize; 8] = nodes.concat().try_into().unwrap();
    let displacement: Vec<f64> =
        nodes.iter().flat_map(|&node| HINGED.map(|direction| found(node, direction))).collect();
    let stresses = Hex8::new(nodes, material).stresses(&scene.points(&nodes), &displacement);
    near("LE10, stress", stresses.unwrap()[4][1], -5.57573e6, 1e-6);
}

/// Forces of a pressure (Pa) downwards on a level quadrilateral, with 2 × 2 points.
fn pressure(scene: &Supported, nodes: [usize; 4], pressure: f64) -> Vec<Load> {
    const SIDES: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let points = scene.points(&nodes);
    let mut loads = Vec::new();
    for point in SIDES {
        let [xi, eta] = point.map(|side| side / 3.0_f64.sqrt());
        let mut tangent = [[0.0; 2]; 2];
        for ([a, b], at) in SIDES.iter().zip(&points) {
            for axis in 0..2 {
                tangent[0][axis] += 0.25 * a * (1.0 + b * eta) * at[axis];
                tangent[1][axis] += 0.25 * b * (1.0 + a * xi) * at[axis];
            }
        }
        let area = tangent[0][0] * tangent[1][1] - tangent[0][1] * tangent[1][0];
        for ([a, b], node) in SIDES.iter().zip(nodes) {
            let shape = 0.25 * (1.0 + a * xi) * (1.0 + b * eta);
            loads.push((node, Z, -pressure * area * shape));
        }
    }
    loads
}

/// PROBLEM: a plate 10 m × 10 m × 1 m on hard supports, 8 × 8 × 2 bricks. RESULT: the table's frequencies, without the
/// modes in its plane; Rayleigh and Lamb have 45.971, 109.857, 168.819 and 205.865 Hz.
#[test]
fn a_thick_plate_of_bricks_vibrates_as_tabulated() {
    let material = Material::new(200.0e9, 0.3, 8000.0).unwrap();
    let mut scene = Supported::new();
    let place = block(&mut scene, [8, 8, 2], material, &|index| {
        let [x, y, z] = index.map(|k| k as f64);
        [1.25 * x, 1.25 * y, 0.5 * z]
    });
    for side in [0, 8] {
        for other in 0..9 {
            for k in 0..3 {
                scene.hold(place(side, other, k), &[Y, Z]);
                scene.hold(place(other, side, k), &[X, Z]);
            }
        }
    }
    for (kind, table) in [
        (MassKind::Consistent, [46.9557, 117.673, 117.673, 182.231, 240.535, 240.535]),
        (MassKind::Lumped, [45.5914, 109.409, 109.409, 162.449, 208.477, 208.477]),
    ] {
        let found = scene.frequencies(kind, 9);
        for value in table {
            let distance = |frequency: &f64| (frequency - value).abs();
            let nearest = found.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
            near("thick plate, Hz", *nearest, value, 4e-6);
        }
    }
}
