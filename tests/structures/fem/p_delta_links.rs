//! GOAL: rigid links take part in P–Δ with the finite rotation of their arms.
//! SCENE: a rigid slab of linked nodes on inclined bars.
//! REFERENCE: second derivatives of the potential of bars and rigid body by finite differences.

use basemat::fem::{Element, LumpedMass, Mesh, Truss};
use basemat::structure::FemModel;
use basemat_problems::dense::stiffness;
use basemat_problems::directions::NODE_DIRECTIONS;

const GRAVITY_ACCELERATION: f64 = 9.81;

/// A bar from a foot to a node at the end of an arm of the slab.
struct SlabBar {
    foot: [f64; 3],
    arm: [f64; 3],
    stiffness: f64,
    compression: f64,
}

/// A rigid slab with masses at the ends of its arms, on inclined bars.
struct LinkedSlab {
    bars: Vec<SlabBar>,
    masses: Vec<([f64; 3], f64)>,
}

fn cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt()
}

/// End of an arm after the displacement and the rotation vector of its leader, by Rodrigues' formula.
fn moved(arm: [f64; 3], u: &[f64; 6]) -> [f64; 3] {
    let vector = [u[3], u[4], u[5]];
    let angle = (vector.iter().map(|x| x * x).sum::<f64>()).sqrt();
    let [a, b] = if angle > 0.0 {
        [angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle)]
    } else {
        [1.0, 0.5]
    };
    let first_product = cross(vector, arm);
    let second_product = cross(vector, first_product);
    std::array::from_fn(|k| u[k] + arm[k] + a * first_product[k] + b * second_product[k])
}

impl LinkedSlab {
    /// Potential beyond first order at displacements and a rotation vector of the leader.
    fn potential(&self, u: &[f64; 6]) -> f64 {
        let mut potential = 0.0;
        for bar in &self.bars {
            let stretch = distance(moved(bar.arm, u), bar.foot) - distance(bar.arm, bar.foot);
            potential += 0.5 * bar.stiffness * stretch * stretch - bar.compression * stretch;
        }
        for &(arm, mass) in &self.masses {
            potential += mass * GRAVITY_ACCELERATION * moved(arm, u)[2];
        }
        potential
    }
}

/// The model of a slab, and the node that its arms follow.
struct LinkedModel {
    slab: LinkedSlab,
    model: FemModel,
    leader: usize,
}

fn linked_model() -> LinkedModel {
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
    let model = model
        .with_rigid_link(leader, &followers)
        .unwrap()
        .with_p_delta(GRAVITY_ACCELERATION)
        .unwrap();
    let forces: Vec<f64> = model.mesh().elements().filter_map(Element::compression).collect();
    let mut forces = forces.into_iter();
    for (foot, k) in ends {
        let foot = model.mesh().nodes()[feet[foot]];
        let foot: [f64; 3] = std::array::from_fn(|axis| foot[axis] - origin[axis]);
        let length = (0..3).map(|axis| (arms[k][axis] - foot[axis]).powi(2)).sum::<f64>().sqrt();
        let stiffness = 1e8 / length;
        let compression = forces.next().unwrap();
        bars.push(SlabBar { foot, arm: arms[k], stiffness, compression });
    }
    let slab = LinkedSlab { bars, masses };
    LinkedModel { slab, model, leader }
}

/// PROBLEM: a rigid slab of linked nodes on inclined bars. RESULT: the second derivatives of its potential, by finite
/// differences of finite rotations.
#[test]
fn linked_nodes_move_by_finite_rotations() {
    let LinkedModel { slab, model, leader } = linked_model();
    let dofs = NODE_DIRECTIONS.map(|direction| model.dof(leader, direction).unwrap());
    let computed = stiffness(&model);
    // The forces are in equilibrium.
    for i in 0..6 {
        let [above, below] = [1.0, -1.0].map(|sign| {
            let mut u = [0.0; 6];
            u[i] = sign * 1e-4;
            slab.potential(&u)
        });
        let slope = (above - below) / 2e-4;
        assert!(slope.abs() < 1e-4 * 3e5, "{i}: {slope}");
    }
    let weight: f64 = slab.masses.iter().map(|(_, mass)| mass * GRAVITY_ACCELERATION).sum();
    for i in 0..6 {
        for j in 0..6 {
            let expected = crate::structures::curvature(|u| slab.potential(u), [i, j], 1e-4);
            let error = (computed[dofs[i]][dofs[j]] - expected).abs();
            assert!(error < 1e-3 * weight, "{i} {j}: {} {expected}", computed[dofs[i]][dofs[j]]);
        }
    }
}
