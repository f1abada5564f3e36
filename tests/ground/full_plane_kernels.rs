//! GOAL: displacements and tractions of the full plane are right to their last digits and consistent.
//! SCENE: line loads over elapsed times from before the first wave to statics.
//! REFERENCE: tables of another program, finite differences, Kelvin's solution, differential equations.

use std::f64::consts::PI;

use basemat::Soil;
use basemat::fundamental::{FullPlane, FundamentalSolution, LoadHistory};

use super::kernels::{assert_near, rows};
use basemat_problems::dense::largest;

/// GOAL: displacements and tractions of the full plane agree with another program.
#[test]
fn full_plane_agrees_with_another_program() {
    for row in rows(include_str!("../data/es_fullplane_testvectors.csv")) {
        let ground = Soil::from_wave_speeds(row[2], row[1], row[0]).unwrap();
        let plane = FullPlane::new(ground);
        let offset = [row[3], row[4]];
        let normal = [row[5], row[6]];
        let time = row[7];
        let load = if row[8] == 0.0 { LoadHistory::Step } else { LoadHistory::Ramp };
        let u = plane.displacement(offset, time, load).unwrap();
        let t = plane.traction(offset, normal, time, load).unwrap();
        let d = plane.displacement(offset, time, LoadHistory::Impulse).unwrap();
        for (column, computed) in [(9, u), (13, t), (17, d)] {
            let expected = &row[column..column + 4];
            let tolerance = 1e-10 * largest(expected) + 1e-14;
            for (i, expected) in expected.iter().enumerate() {
                let name = format!("{column} {i} {row:?}");
                assert_near(computed[i / 2][i % 2], *expected, tolerance, &name);
            }
        }
    }
}

/// Central differences of the displacement: ∂u_ij/∂x_k at `[k][i][j]`.
fn displacement_gradient(
    plane: &FullPlane,
    x: [f64; 2],
    time: f64,
    load: LoadHistory,
) -> [[[f64; 2]; 2]; 2] {
    let h = 1e-5;
    [[h, 0.0], [0.0, h]].map(|step| {
        let forward_displacement =
            plane.displacement([x[0] + step[0], x[1] + step[1]], time, load).unwrap();
        let backward_displacement =
            plane.displacement([x[0] - step[0], x[1] - step[1]], time, load).unwrap();
        [0, 1].map(|i| {
            [0, 1].map(|j| (forward_displacement[i][j] - backward_displacement[i][j]) / (2.0 * h))
        })
    })
}

/// GOAL: tractions of the full plane are those of its displacements, and tend to Kelvin's solution.
/// REFERENCE: Hooke's law by finite differences.
#[test]
fn full_plane_tractions_follow_from_displacements() {
    let ground = Soil::new(2.0, 0.3, 1.5).unwrap();
    let plane = FullPlane::new(ground);
    let x = [0.7, -0.4];
    let n = [0.6, 0.8];
    let mu = 2.0;
    let lambda = 2.0 * 2.0 * 0.3 / 0.4;
    for load in [LoadHistory::Impulse, LoadHistory::Step, LoadHistory::Ramp] {
        for time in [0.3, 0.5, 0.9, 30.0] {
            let gradient = displacement_gradient(&plane, x, time, load);
            let t = plane.traction(x, n, time, load).unwrap();
            let scale = t.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
            for j in 0..2 {
                for i in 0..2 {
                    let mut expected = lambda * (gradient[0][0][j] + gradient[1][1][j]) * n[i];
                    for k in 0..2 {
                        expected += mu * (gradient[k][i][j] + gradient[i][k][j]) * n[k];
                    }
                    let name = format!("{load:?} {time} {i} {j}");
                    assert_near(t[i][j], expected, 2e-8 * scale.max(0.1), &name);
                }
            }
        }
    }
    // Kelvin: χ → −1/(8πμ(1−ν)), so u_xz → e_x e_z/(8πμ(1−ν)), to rounding at very late times.
    let late_displacement = plane.displacement(x, 1e9, LoadHistory::Step).unwrap();
    let kelvin = -0.28 / 0.65 / (8.0 * PI * mu * 0.7);
    assert_near(late_displacement[0][1], kelvin, 1e-16, "Kelvin");
    let first = plane.traction(x, n, 1e7, LoadHistory::Step).unwrap();
    let second = plane.traction(x, n, 1e9, LoadHistory::Step).unwrap();
    assert_near(first[0][1], second[0][1], 1e-13, "late traction");
}

/// GOAL: Navier's equation and reciprocity, u_ij(x) = u_ji(−x).
/// REFERENCE: the divergence of the ramp's tractions is the density times its second time derivative, the impulse.
#[test]
fn full_plane_obeys_navier_and_reciprocity() {
    for (mu, nu, density) in [(2.0, 0.3, 1.5), (1.0, 0.0, 1.0), (3.0, 0.45, 0.7)] {
        let plane = FullPlane::new(Soil::new(mu, nu, density).unwrap());
        let h = 1e-4;
        for (x, time) in [([0.7, -0.4], 0.55), ([0.7, -0.4], 1.4), ([-0.2, 0.9], 2.5)] {
            let inertia = plane.displacement(x, time, LoadHistory::Impulse).unwrap();
            let scale = inertia.iter().flatten().fold(0.1_f64, |m, v| m.max(v.abs()));
            // Tractions on planes to the right, to the left, below and above.
            let tractions = [
                ([h, 0.0], [1.0, 0.0]),
                ([-h, 0.0], [1.0, 0.0]),
                ([0.0, h], [0.0, 1.0]),
                ([0.0, -h], [0.0, 1.0]),
            ]
            .map(|(offset, normal)| {
                let point = [x[0] + offset[0], x[1] + offset[1]];
                plane.traction(point, normal, time, LoadHistory::Ramp).unwrap()
            });
            for i in 0..2 {
                for j in 0..2 {
                    let sum = tractions[0][i][j] - tractions[1][i][j] + tractions[2][i][j]
                        - tractions[3][i][j];
                    let divergence = sum / (2.0 * h);
                    let name = format!("Navier {nu} {x:?} {time} {i} {j}");
                    assert_near(divergence, density * inertia[i][j], 1e-5 * density * scale, &name);
                }
            }
            for load in [LoadHistory::Impulse, LoadHistory::Step, LoadHistory::Ramp] {
                let forward = plane.displacement(x, time, load).unwrap();
                let backward = plane.displacement([-x[0], -x[1]], time, load).unwrap();
                for i in 0..2 {
                    for j in 0..2 {
                        assert_eq!(forward[i][j], backward[j][i], "reciprocity {load:?}");
                    }
                }
            }
        }
    }
}
