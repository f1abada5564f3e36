//! GOAL: constant membrane strains, curvatures and twists are exact on distorted elements.
//! SCENE: `MacNeal` & Harder's patch as quadrilaterals, triangles and both, in a plane of any direction.
//! REFERENCE: the uniform state itself.

use super::{Assembly, material};
use basemat::fem::{Element, Shell};
use basemat_problems::dense::{largest, multiply};
use basemat_problems::patch::{POINTS, QUADS, STATES, field};

/// Elements of the patch by their corners: quadrilaterals both ways round, triangles, or both.
fn elements(kind: &str) -> Vec<Vec<usize>> {
    let halves = |[a, b, c, d]: [usize; 4]| vec![vec![a, b, c], vec![a, c, d]];
    let mut all = Vec::new();
    for (index, corners) in QUADS.into_iter().enumerate() {
        let [a, b, c, d] = corners;
        match (kind, index) {
            ("triangles", _) | ("mixed", 2) => all.extend(halves(corners)),
            (_, 0 | 4) => all.push(vec![d, c, b, a]),
            _ => all.push(corners.to_vec()),
        }
    }
    all
}

/// Axes of the patch in space.
fn axes() -> [[f64; 3]; 3] {
    let (a, b) = (0.7_f64, -1.1_f64);
    let first = [a.cos() * b.cos(), a.sin() * b.cos(), b.sin()];
    let second = [-a.sin(), a.cos(), 0.0];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    [first, second, cross(first, second)]
}

/// The patch in space, its uniform state, and the state that it finds with its outline held.
fn states(kind: &str, state: &str, thickness: f64, match_sides: bool) -> (Assembly, [Vec<f64>; 2]) {
    let axes = axes();
    let place = |part: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|k| (0..3).map(|axis| part[axis] * axes[axis][k]).sum())
    };
    let mut patch = Assembly::new();
    for [x, y] in POINTS {
        patch.node(place([x, y, 0.0]));
    }
    let shell =
        |corners: Vec<usize>| Shell::new(corners, material(1.0e6, 0.25, 1.0), thickness).unwrap();
    let shells: Vec<Shell> = elements(kind).into_iter().map(shell).collect();
    if match_sides {
        patch.matched(shells);
    } else {
        for shell in shells {
            patch.mesh.add(shell).unwrap();
        }
    }
    let at_node = |[x, y]: [f64; 2]| {
        let [u, v, w, a, b, c] = field(state, x, y);
        [place([u, v, w]), place([a, b, c])].concat()
    };
    let exact: Vec<f64> = POINTS.into_iter().flat_map(at_node).collect();
    patch.held = (0..24).map(|index| (index, exact[index])).collect();
    let found = patch.solve();
    (patch, [exact, found])
}

#[test]
fn uniform_states_are_exact() {
    for kind in ["quads", "triangles", "mixed"] {
        for state in STATES {
            for thickness in [0.001, 0.05] {
                let (patch, [exact, found]) = states(kind, state, thickness, true);
                let error: Vec<f64> = found.iter().zip(&exact).map(|(a, b)| a - b).collect();
                let error = largest(&error) / largest(&exact);
                assert!(error < 1e-9, "{kind}, {state}, t = {thickness}: {error:.1e}");
                // Inner nodes are free of forces: the state is in equilibrium, too. Forces of thin plates are
                // small beside the rounding of the membrane's.
                let forces = multiply(&patch.stiffness(), &exact);
                let rounding = 1e-13 * 1.0e6 * thickness * largest(&exact);
                let inside = largest(&forces[24..]);
                assert!(inside < 1e-9 * largest(&forces[..24]) + rounding, "{kind}, {state}");
                check_resultants(&patch, &exact, state, thickness);
            }
        }
    }
}

/// The sides of triangles bulge more by the rotations of their ends than the sides of quadrilaterals.
#[test]
fn triangles_beside_quadrilaterals_need_a_match_in_their_plane_only() {
    let error = |state: &str| {
        let (_, [exact, found]) = states("mixed", state, 0.05, false);
        let error: Vec<f64> = found.iter().zip(&exact).map(|(a, b)| a - b).collect();
        largest(&error) / largest(&exact)
    };
    assert!(error("membrane") > 0.05);
    assert!(error("bending") < 1e-9 && error("twist") < 1e-9);
}

/// Membrane forces and moments are uniform, in the axes of the patch, whatever the order of the nodes.
fn check_resultants(patch: &Assembly, exact: &[f64], state: &str, thickness: f64) {
    let (young, poisson) = (1.0e6, 0.25);
    let stress = |[x, y, shear]: [f64; 3]| {
        let direct = young / (1.0 - poisson * poisson);
        [direct * (x + poisson * y), direct * (y + poisson * x), 0.4 * young * shear]
    };
    let (strain, curvature) = match state {
        "membrane" => ([1.0, 1.0, 1.0], [0.0; 3]),
        "membrane and rotation" => ([1.0, 0.3, 0.6], [0.0; 3]),
        "bending" => ([0.0; 3], [1.0, 1.0, 1.0]),
        _ => ([0.0; 3], [0.0, 0.0, 2.0]),
    };
    let [first, _, normal] = axes();
    let membrane = stress(strain).map(|stress| stress * thickness);
    let moments = stress(curvature).map(|stress| stress * thickness.powi(3) / 12.0);
    for shell in &patch.shells {
        let points = patch.points(shell.nodes());
        for own in shell.resultants(&points, &Assembly::of(shell, exact)).unwrap() {
            let own = own.in_axes(first, normal).unwrap();
            for k in 0..3 {
                let scale = largest(&membrane).max(young * thickness * 1e-3);
                assert!((own.membrane[k] - membrane[k]).abs() < 1e-9 * scale, "{state} {own:?}");
                let scale = largest(&moments).max(young * thickness.powi(3) * 1e-3);
                assert!((own.moments[k] - moments[k]).abs() < 1e-9 * scale, "{state} {own:?}");
            }
            let scale = young * thickness * 0.1;
            assert!(largest(&own.shears) < 1e-9 * scale, "{state} {own:?}");
        }
    }
}
