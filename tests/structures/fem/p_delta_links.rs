//! GOAL: rigid links take part in P–Δ with the finite rotation of their arms.
//! SCENE: a rigid slab of linked nodes on inclined bars.
//! REFERENCE: second derivatives of the potential of bars and rigid body by finite differences.

use basemat::fem::{Element, LumpedMass, Mesh, Truss};
use basemat::structure::FemModel;
use basemat_problems::dense::stiffness;
use basemat_problems::directions::IN_SPACE;

const GRAVITY: f64 = 9.81;

/// Potential of a rigid slab with masses on inclined bars, beyond first order, at displacements and a rotation vector of
/// its leader.
fn slab_potential(
    bars: &[([f64; 3], [f64; 3], f64, f64)],
    masses: &[([f64; 3], f64)],
) -> impl Fn(&[f64; 6]) -> f64 {
    let (bars, masses) = (bars.to_vec(), masses.to_vec());
    move |u: &[f64; 6]| {
        let moved = |arm: [f64; 3]| -> [f64; 3] {
            // Rodrigues' formula.
            let vector = [u[3], u[4], u[5]];
            let angle = (vector.iter().map(|x| x * x).sum::<f64>()).sqrt();
            let [a, b] = if angle > 0.0 {
                [angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle)]
            } else {
                [1.0, 0.5]
            };
            let cross = |p: [f64; 3], q: [f64; 3]| {
                [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
            };
            let once = cross(vector, arm);
            let twice = cross(vector, once);
            std::array::from_fn(|k| u[k] + arm[k] + a * once[k] + b * twice[k])
        };
        let distance =
            |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
        let mut potential = 0.0;
        for &(foot, arm, stiffness, compression) in &bars {
            let stretch = distance(moved(arm), foot) - distance(arm, foot);
            potential += 0.5 * stiffness * stretch * stretch - compression * stretch;
        }
        for &(arm, mass) in &masses {
            potential += mass * GRAVITY * moved(arm)[2];
        }
        potential
    }
}

/// PROBLEM: a rigid slab of linked nodes on inclined bars. RESULT: the second derivatives of its potential, by finite
/// differences of finite rotations. Before, the links had no part in P–Δ.
#[test]
fn linked_nodes_move_by_finite_rotations() {
    let mut mesh = Mesh::in_space();
    let feet = [[-3.0, -2.0, 0.0], [3.0, -2.0, 0.0], [3.0, 2.5, 0.0], [-3.0, 2.0, 0.0]]
        .map(|place| mesh.add_node_at(place).unwrap());
    for foot in feet {
        mesh.add(LumpedMass::in_space(foot, 10.0, [0.0; 3]).unwrap()).unwrap();
    }
    let origin = [0.2, 0.1, 4.0];
    let leader = mesh.add_node_at(origin).unwrap();
    mesh.add(LumpedMass::in_space(leader, 7e3, [1e3; 3]).unwrap()).unwrap();
    let arms = [[-2.0, -1.5, -0.6], [2.2, -1.0, 0.4], [1.8, 1.7, -0.3], [-2.0, 1.6, 0.5]];
    let mut masses = vec![([0.0; 3], 7e3)];
    let mut bars = Vec::new();
    let followers: Vec<usize> = arms
        .iter()
        .enumerate()
        .map(|(k, arm)| {
            let place = std::array::from_fn(|axis| origin[axis] + arm[axis]);
            let node = mesh.add_node_at(place).unwrap();
            let mass = 2e3 + 1e3 * k as f64;
            mesh.add(LumpedMass::in_space(node, mass, [0.0; 3]).unwrap()).unwrap();
            masses.push((*arm, mass));
            node
        })
        .collect();
    // Two bars from each follower, to feet of both sides.
    let mut ends = Vec::new();
    for k in 0..4 {
        for foot in [k, (k + 1) % 4] {
            ends.push((foot, k));
            let bar = Truss::in_space([feet[foot], followers[k]], 1e11, 1e-3, 0.0).unwrap();
            mesh.add(bar).unwrap();
        }
    }
    let model = FemModel::on_faces(mesh, &[feet.to_vec()]).unwrap();
    let model = model.with_rigid_link(leader, &followers).unwrap().with_p_delta(GRAVITY).unwrap();
    let mut forces = model.mesh().elements().filter_map(Element::compression);
    for (foot, k) in ends {
        let foot = model.mesh().nodes()[feet[foot]];
        let foot: [f64; 3] = std::array::from_fn(|axis| foot[axis] - origin[axis]);
        let length = (0..3).map(|axis| (arms[k][axis] - foot[axis]).powi(2)).sum::<f64>().sqrt();
        bars.push((foot, arms[k], 1e8 / length, forces.next().unwrap()));
    }
    let potential = slab_potential(&bars, &masses);
    let dofs = IN_SPACE.map(|own| model.dof(leader, own).unwrap());
    let found = stiffness(&model);
    // Equilibrium.
    for i in 0..6 {
        let step = |sign: f64| {
            let mut u = [0.0; 6];
            u[i] = sign * 1e-4;
            potential(&u)
        };
        let slope = (step(1.0) - step(-1.0)) / 2e-4;
        assert!(slope.abs() < 1e-4 * 3e5, "{i}: {slope}");
    }
    let weight: f64 = masses.iter().map(|(_, mass)| mass * GRAVITY).sum();
    for i in 0..6 {
        for j in 0..6 {
            let exact = crate::structures::curvature(&potential, [i, j], 1e-4);
            let error = (found[dofs[i]][dofs[j]] - exact).abs();
            assert!(error < 1e-3 * weight, "{i} {j}: {} {exact}", found[dofs[i]][dofs[j]]);
        }
    }
}
