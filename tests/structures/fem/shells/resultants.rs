//! GOAL: resultants have their signs and axes, and are in equilibrium with loads.
//! SCENE: strips bent by a force, a raft on springs.
//! REFERENCE: statics; the same formulation in Python.

use super::{ALL, Assembly, Pattern, RZ, X, Y, Z, dof, material};
use basemat::fem::{Element, Shell, ShellResultants};
use basemat_problems::dense::solve_held;
use basemat_problems::table::close;

const EAST: [f64; 3] = [1.0, 0.0, 0.0];
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Resultants at a node, means of its elements in common axes: membrane, moments, shears.
fn at_node(model: &Assembly, u: &[f64], node: usize) -> [f64; 8] {
    let mut sum = [0.0; 8];
    let mut count = 0.0;
    for shell in &model.shells {
        let Some(corner) = shell.nodes().iter().position(|&own| own == node) else { continue };
        let all = shell.resultants(&model.points(shell.nodes()), &Assembly::of(shell, u)).unwrap();
        let own = all[corner].in_axes(EAST, UP).unwrap();
        let values = [&own.membrane[..], &own.moments, &own.shears].concat();
        for (sum, value) in sum.iter_mut().zip(values) {
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
    let nodes = strip.grid(grid, Pattern::Clockwise, concrete, |x, y| [6.0 * x, y, 0.0]);
    for &node in &nodes[0] {
        strip.hold(node, &ALL);
    }
    for (node, share) in nodes[12].iter().zip([0.25, 0.5, 0.25]) {
        strip.load[dof(*node, Z)] = 1000.0 * share;
        strip.load[dof(*node, X)] = 5000.0 * share;
    }
    // The consistent moments of a uniform pull on two sides of 0.5 m.
    for (node, sign) in [(nodes[12][0], -1.0), (nodes[12][2], 1.0)] {
        strip.load[dof(node, RZ)] = sign * 5000.0 * 0.25 / 12.0;
    }
    let u = strip.solve();
    for (column, lever) in [(3, 4.5), (6, 3.0), (9, 1.5)] {
        let found = at_node(&strip, &u, nodes[column][1]);
        let wanted = [5000.0, 0.0, 0.0, 1000.0 * lever, 0.0, 0.0, 1000.0, 0.0];
        for (found, wanted) in found.into_iter().zip(wanted) {
            close("resultant", found, wanted, 1e-5, 0.0);
        }
    }
}

/// A raft 12 × 12 × 0.8 m on springs of 20 MN/m³, 4 MN on the middle 1.5 × 1.5 m, 8 × 8 cells.
#[test]
fn raft_on_springs() {
    let mut raft = Assembly::new();
    let nodes = raft.grid([8, 8], Pattern::Quads, (material(30.0e9, 0.2, 0.0), 0.8), |x, y| {
        [12.0 * x - 6.0, 12.0 * y - 6.0, 0.0]
    });
    for &node in nodes.iter().flatten() {
        raft.hold(node, &[X, Y, RZ]);
    }
    // The load covers a quarter of each of the four cells in the middle.
    for (i, column) in nodes.iter().enumerate().take(6).skip(3) {
        for (j, &node) in column.iter().enumerate().take(6).skip(3) {
            let share = |k: usize| if k == 4 { 0.75 } else { 0.125 };
            raft.load[dof(node, Z)] = -4.0e6 * share(i) * share(j);
        }
    }
    let mut stiffness = raft.stiffness();
    for i in 0..8 {
        for j in 0..8 {
            for a in 0..16 {
                let [fx, fy, tx, ty] = [a & 1, a >> 1 & 1, a >> 2 & 1, a >> 3];
                let share = |from: usize, to: usize| if from == to { 1.5 / 3.0 } else { 1.5 / 6.0 };
                let [from, to] = [nodes[i + fx][j + fy], nodes[i + tx][j + ty]];
                stiffness[dof(from, Z)][dof(to, Z)] += 20.0e6 * share(fx, tx) * share(fy, ty);
            }
        }
    }
    let u = solve_held(&stiffness, &raft.load, &raft.held);
    for ([i, j], wanted) in [([4, 4], 3.382_413), ([8, 4], 0.754_215_9), ([8, 8], -0.468_305_3)] {
        close("settlement, mm", -1e3 * u[dof(nodes[i][j], Z)], wanted, 0.0, 1e-6);
    }
    for ([i, j], component, wanted) in
        [([4, 4], 3, 477.9421), ([6, 4], 3, 55.672_89), ([8, 4], 4, 107.9159)]
    {
        let found = 1e-3 * at_node(&raft, &u, nodes[i][j])[component];
        close("moment, kNm/m", found, wanted, 0.0, 1e-6);
    }
}

/// A state with every resultant is the same from any list of nodes.
#[test]
fn resultants_do_not_depend_on_the_list_of_nodes() {
    for (name, shell, nodes) in super::tabled() {
        let count = nodes.len();
        let state: Vec<f64> =
            (0..6 * count).map(|k| 1e-4 * ((7 * k * k + 3) % 11) as f64).collect();
        let along = [0.3, 1.0, -0.2];
        let outward = [0.5, -0.4, 1.0];
        let turned = |order: &[usize]| -> Vec<ShellResultants> {
            let points: Vec<[f64; 3]> = order.iter().map(|&node| nodes[node]).collect();
            let u: Vec<f64> =
                order.iter().flat_map(|&node| state[6 * node..6 * node + 6].to_vec()).collect();
            let all = shell.resultants(&points, &u).unwrap();
            all.iter().map(|own| own.in_axes(along, outward).unwrap()).collect()
        };
        let straight: Vec<usize> = (0..count).collect();
        let wanted = turned(&straight);
        let size = |own: &ShellResultants| {
            own.membrane
                .iter()
                .chain(&own.moments)
                .chain(&own.shears)
                .fold(0.0_f64, |a, b| a.max(b.abs()))
        };
        let scale = wanted.iter().map(size).fold(0.0, f64::max);
        for start in 0..count {
            for clockwise in [false, true] {
                let turn = |k: usize| (start + if clockwise { count - k } else { k }) % count;
                let order: Vec<usize> = (0..count).map(turn).collect();
                for (own, &node) in turned(&order).iter().zip(&order) {
                    let wanted = &wanted[node];
                    let pairs = own.membrane.iter().zip(&wanted.membrane);
                    let pairs = pairs.chain(own.moments.iter().zip(&wanted.moments));
                    for (a, b) in pairs.chain(own.shears.iter().zip(&wanted.shears)) {
                        assert!(
                            (a - b).abs() < 1e-11 * scale,
                            "{name} {order:?}: {own:?} {wanted:?}"
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
    let own = shell.resultants(&corners, &state).unwrap()[2];
    let same = own.in_axes([5.0, 0.0, 1.0], [0.0, 3.0, 0.1]).unwrap();
    assert_eq!(same.axes, own.axes);
    assert_eq!(same.shears, own.shears);
    let north = own.in_axes([0.0, 1.0, 0.0], UP).unwrap();
    assert_eq!(north.membrane, [own.membrane[1], own.membrane[0], -own.membrane[2]]);
    assert_eq!(north.moments, [own.moments[1], own.moments[0], -own.moments[2]]);
    assert_eq!(north.shears, [own.shears[1], -own.shears[0]]);
    let below = own.in_axes(EAST, [0.0, 0.0, -1.0]).unwrap();
    assert_eq!(below.axes[2], [0.0, 0.0, -1.0]);
    assert_eq!(below.membrane, [own.membrane[0], own.membrane[1], -own.membrane[2]]);
    assert_eq!(below.moments, [-own.moments[0], -own.moments[1], own.moments[2]]);
    assert_eq!(below.shears, [-own.shears[0], own.shears[1]]);
}
