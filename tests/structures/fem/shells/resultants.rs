//! GOAL: resultants have their signs and axes, and are in equilibrium with loads.
//! SCENE: strips bent by a force, a raft on springs.
//! REFERENCE: statics; the same formulation in Python.

use super::{
    ALL_DIRECTIONS, Assembly, CellPattern, RZ, TabledShell, X, Y, Z, dof, material, tabled_shells,
    turned_list,
};
use basemat::fem::{Element, Shell, ShellResultants};
use basemat_problems::dense::{largest, solve_with_prescribed};
use basemat_problems::table::assert_close;

const X_AXIS: [f64; 3] = [1.0, 0.0, 0.0];
const Z_AXIS: [f64; 3] = [0.0, 0.0, 1.0];

/// Membrane forces, moments and shears.
fn values(resultants: &ShellResultants) -> Vec<f64> {
    [&resultants.membrane[..], &resultants.moments, &resultants.shears].concat()
}

/// Resultants at a node, means of its elements in common axes: membrane, moments, shears.
fn at_node(model: &Assembly, u: &[f64], node: usize) -> [f64; 8] {
    let mut sum = [0.0; 8];
    let mut count = 0.0;
    for shell in &model.shells {
        let Some(corner) = shell.nodes().iter().position(|&other| other == node) else {
            continue;
        };
        let displacements = Assembly::node_displacements(shell, u);
        let resultants = shell.resultants(&model.points(shell.nodes()), &displacements).unwrap();
        for (sum, value) in
            sum.iter_mut().zip(values(&resultants[corner].in_axes(X_AXIS, Z_AXIS).unwrap()))
        {
            *sum += value;
        }
        count += 1.0;
    }
    sum.map(|sum| sum / count)
}

/// A strip 6 × 1 m, clamped at x = 0; at its tip 1 kN upwards and 5 kN along. The shear force is upwards on the
/// section that looks to the tip, and the lower face is in tension.
#[test]
fn cantilever_is_in_equilibrium() {
    let mut strip = Assembly::new();
    let grid = [12, 2];
    let concrete = (material(30.0e9, 0.0, 0.0), 0.2);
    let nodes = strip.grid(grid, CellPattern::Clockwise, concrete, |x, y| [6.0 * x, y, 0.0]);
    for &node in &nodes[0] {
        strip.fix(node, &ALL_DIRECTIONS);
    }
    for (node, part) in nodes[12].iter().zip([0.25, 0.5, 0.25]) {
        strip.load[dof(*node, Z)] = 1000.0 * part;
        strip.load[dof(*node, X)] = 5000.0 * part;
    }
    // The consistent moments of a uniform pull on two sides of 0.5 m.
    for (node, sign) in [(nodes[12][0], -1.0), (nodes[12][2], 1.0)] {
        strip.load[dof(node, RZ)] = sign * 5000.0 * 0.25 / 12.0;
    }
    let u = strip.solve();
    for (column, lever) in [(3, 4.5), (6, 3.0), (9, 1.5)] {
        let computed = at_node(&strip, &u, nodes[column][1]);
        let expected = [5000.0, 0.0, 0.0, 1000.0 * lever, 0.0, 0.0, 1000.0, 0.0];
        for (computed, expected) in computed.into_iter().zip(expected) {
            assert_close("resultant", computed, expected, 1e-5, 0.0);
        }
    }
}

/// Integral of the product of two linear shape functions over a side of 1.5 m.
fn shape_integral(from: usize, to: usize) -> f64 {
    if from == to { 1.5 / 3.0 } else { 1.5 / 6.0 }
}

/// A raft 12 × 12 × 0.8 m on springs of 20 MN/m³, 4 MN on the middle 1.5 × 1.5 m, 8 × 8 cells.
#[test]
fn raft_on_springs() {
    let mut raft = Assembly::new();
    let nodes = raft.grid([8, 8], CellPattern::Quads, (material(30.0e9, 0.2, 0.0), 0.8), |x, y| {
        [12.0 * x - 6.0, 12.0 * y - 6.0, 0.0]
    });
    for &node in nodes.iter().flatten() {
        raft.fix(node, &[X, Y, RZ]);
    }
    // The load covers a quarter of each of the four cells in the middle.
    let mut line_parts = [0.0; 9];
    line_parts[3..6].copy_from_slice(&[0.125, 0.75, 0.125]);
    for (i, column) in nodes.iter().enumerate().take(6).skip(3) {
        for (j, &node) in column.iter().enumerate().take(6).skip(3) {
            raft.load[dof(node, Z)] = -4.0e6 * line_parts[i] * line_parts[j];
        }
    }
    let mut stiffness = raft.stiffness();
    for i in 0..8 {
        for j in 0..8 {
            for a in 0..16 {
                let [fx, fy, tx, ty] = [a & 1, a >> 1 & 1, a >> 2 & 1, a >> 3];
                let from = dof(nodes[i + fx][j + fy], Z);
                let to = dof(nodes[i + tx][j + ty], Z);
                stiffness[from][to] += 20.0e6 * shape_integral(fx, tx) * shape_integral(fy, ty);
            }
        }
    }
    let u = solve_with_prescribed(&stiffness, &raft.load, &raft.prescribed);
    for ([i, j], expected) in [([4, 4], 3.382_413), ([8, 4], 0.754_215_9), ([8, 8], -0.468_305_3)] {
        assert_close("settlement, mm", -1e3 * u[dof(nodes[i][j], Z)], expected, 0.0, 1e-6);
    }
    for ([i, j], component, expected) in
        [([4, 4], 3, 477.9421), ([6, 4], 3, 55.672_89), ([8, 4], 4, 107.9159)]
    {
        let computed = 1e-3 * at_node(&raft, &u, nodes[i][j])[component];
        assert_close("moment, kNm/m", computed, expected, 0.0, 1e-6);
    }
}

/// Resultants of a shell whose nodes are listed in this order, in common axes.
fn listed_resultants(tabled: &TabledShell, state: &[f64], order: &[usize]) -> Vec<ShellResultants> {
    let points: Vec<[f64; 3]> = order.iter().map(|&node| tabled.nodes[node]).collect();
    let u: Vec<f64> =
        order.iter().flat_map(|&node| state[6 * node..6 * node + 6].to_vec()).collect();
    let resultants = tabled.shell.resultants(&points, &u).unwrap();
    let along = [0.3, 1.0, -0.2];
    let outward = [0.5, -0.4, 1.0];
    resultants
        .iter()
        .map(|resultants| resultants.in_axes(along, outward).unwrap())
        .collect()
}

/// A state with every resultant is the same from any list of nodes.
#[test]
fn resultants_do_not_depend_on_the_list_of_nodes() {
    for tabled in tabled_shells() {
        let name = tabled.name;
        let count = tabled.nodes.len();
        let state: Vec<f64> =
            (0..6 * count).map(|k| 1e-4 * ((7 * k * k + 3) % 11) as f64).collect();
        let ascending_order: Vec<usize> = (0..count).collect();
        let expected = listed_resultants(&tabled, &state, &ascending_order);
        let scale = expected.iter().map(|node| largest(&values(node))).fold(0.0, f64::max);
        for start in 0..count {
            for clockwise in [false, true] {
                let order = turned_list(count, start, clockwise);
                for (found, &node) in listed_resultants(&tabled, &state, &order).iter().zip(&order)
                {
                    let expected = &expected[node];
                    for (a, b) in values(found).iter().zip(values(expected)) {
                        assert!(
                            (a - b).abs() < 1e-11 * scale,
                            "{name} {order:?}: {found:?} {expected:?}"
                        );
                    }
                }
            }
        }
    }
}

/// In axes turned by 90° about the normal 11 and 22 change places; the other side turns moments and shears.
#[test]
fn axes_turn_resultants() {
    let shell = Shell::new([0, 1, 2, 3], material(1.0e6, 0.2, 0.0), 0.1).unwrap();
    let corners = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let state: Vec<f64> = (0..24).map(|k| f64::from(k * k % 7)).collect();
    let original = shell.resultants(&corners, &state).unwrap()[2];
    let original_resultants = original.in_axes([5.0, 0.0, 1.0], [0.0, 3.0, 0.1]).unwrap();
    assert_eq!(original_resultants.axes, original.axes);
    assert_eq!(original_resultants.shears, original.shears);
    let north = original.in_axes([0.0, 1.0, 0.0], Z_AXIS).unwrap();
    let membrane = original.membrane;
    let moments = original.moments;
    let shears = original.shears;
    assert_eq!(north.membrane, [membrane[1], membrane[0], -membrane[2]]);
    assert_eq!(north.moments, [moments[1], moments[0], -moments[2]]);
    assert_eq!(north.shears, [shears[1], -shears[0]]);
    let below = original.in_axes(X_AXIS, [0.0, 0.0, -1.0]).unwrap();
    assert_eq!(below.axes[2], [0.0, 0.0, -1.0]);
    assert_eq!(below.membrane, [membrane[0], membrane[1], -membrane[2]]);
    assert_eq!(below.moments, [-moments[0], -moments[1], moments[2]]);
    assert_eq!(below.shears, [-shears[0], shears[1]]);
}
