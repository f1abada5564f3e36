//! GOAL: constant membrane strains, curvatures and twists are exact on distorted elements.
//! SCENE: `MacNeal` & Harder's patch as quadrilaterals, triangles and both, in a plane of any direction.
//! REFERENCE: the uniform state itself.

use super::{Assembly, material};
use basemat::fem::{Element, Shell};
use basemat_problems::dense::{largest, multiply};
use basemat_problems::patch::{PATCH_NODES, PATCH_QUADS, SHELL_STATES, field};

/// Elements of the patch by their corners: quadrilaterals both ways round, triangles, or both.
fn elements(kind: &str) -> Vec<Vec<usize>> {
    let mut elements = Vec::new();
    for (index, corners) in PATCH_QUADS.into_iter().enumerate() {
        let [a, b, c, d] = corners;
        match (kind, index) {
            ("triangles", _) | ("mixed", 2) => elements.extend([vec![a, b, c], vec![a, c, d]]),
            (_, 0 | 4) => elements.push(vec![d, c, b, a]),
            _ => elements.push(corners.to_vec()),
        }
    }
    elements
}

/// Axes of the patch in space.
fn axes() -> [[f64; 3]; 3] {
    let a = 0.7_f64;
    let b = -1.1_f64;
    let first = [a.cos() * b.cos(), a.sin() * b.cos(), b.sin()];
    let second = [-a.sin(), a.cos(), 0.0];
    let third = [
        first[1] * second[2] - first[2] * second[1],
        first[2] * second[0] - first[0] * second[2],
        first[0] * second[1] - first[1] * second[0],
    ];
    [first, second, third]
}

/// Components in space of a vector in the axes of the patch.
fn in_space(vector: [f64; 3]) -> [f64; 3] {
    let axes = axes();
    std::array::from_fn(|k| (0..3).map(|axis| vector[axis] * axes[axis][k]).sum())
}

/// The patch in space in a uniform state.
struct SolvedPatch {
    assembly: Assembly,
    /// The uniform state.
    exact: Vec<f64>,
    /// Displacements that the patch computes from those of its outline.
    computed: Vec<f64>,
}

impl SolvedPatch {
    fn new(kind: &str, state: &str, thickness: f64, match_sides: bool) -> Self {
        let mut assembly = Assembly::new();
        for [x, y] in PATCH_NODES {
            assembly.node(in_space([x, y, 0.0]));
        }
        let mut shells = Vec::new();
        for corners in elements(kind) {
            shells.push(Shell::new(corners, material(1.0e6, 0.25, 1.0), thickness).unwrap());
        }
        if match_sides {
            assembly.matched(shells);
        } else {
            for shell in shells {
                assembly.mesh.add(shell).unwrap();
            }
        }
        let mut expected = Vec::new();
        for [x, y] in PATCH_NODES {
            let [u, v, w, a, b, c] = field(state, x, y);
            expected.extend(in_space([u, v, w]));
            expected.extend(in_space([a, b, c]));
        }
        assembly.prescribed = (0..24).map(|index| (index, expected[index])).collect();
        let computed = assembly.solve();
        Self { assembly, exact: expected, computed }
    }

    /// Largest error over the largest displacement.
    fn error(&self) -> f64 {
        let error: Vec<f64> = self.computed.iter().zip(&self.exact).map(|(a, b)| a - b).collect();
        largest(&error) / largest(&self.exact)
    }
}

#[test]
fn uniform_states_are_exact() {
    for kind in ["quads", "triangles", "mixed"] {
        for state in SHELL_STATES {
            for thickness in [0.001, 0.05] {
                let patch = SolvedPatch::new(kind, state, thickness, true);
                let expected = &patch.exact;
                let error = patch.error();
                assert!(error < 1e-9, "{kind}, {state}, t = {thickness}: {error:.1e}");
                // Inner nodes are free of forces: the state is in equilibrium, too. Forces of thin plates are
                // small beside the rounding of the membrane's.
                let forces = multiply(&patch.assembly.stiffness(), expected);
                let rounding = 1e-13 * 1.0e6 * thickness * largest(expected);
                let inside = largest(&forces[24..]);
                assert!(inside < 1e-9 * largest(&forces[..24]) + rounding, "{kind}, {state}");
                check_resultants(&patch.assembly, expected, state, thickness);
            }
        }
    }
}

/// The sides of triangles bulge more by the rotations of their ends than the sides of quadrilaterals.
#[test]
fn triangles_beside_quadrilaterals_need_a_match_in_their_plane_only() {
    let membrane = SolvedPatch::new("mixed", "membrane", 0.05, false);
    assert!(membrane.error() > 0.05);
    for state in ["bending", "twist"] {
        assert!(SolvedPatch::new("mixed", state, 0.05, false).error() < 1e-9);
    }
}

/// Plane stress of Young's modulus 1 MPa and Poisson's ratio 1/4.
fn plane_stress([x, y, shear]: [f64; 3]) -> [f64; 3] {
    let young = 1.0e6;
    let poisson = 0.25;
    let direct_modulus = young / (1.0 - poisson * poisson);
    [
        direct_modulus * (x + poisson * y),
        direct_modulus * (y + poisson * x),
        0.4 * young * shear,
    ]
}

/// Membrane forces and moments are uniform, in the axes of the patch, whatever the order of the nodes.
fn check_resultants(patch: &Assembly, exact: &[f64], state: &str, thickness: f64) {
    let young = 1.0e6;
    let (strain, curvature) = match state {
        "membrane" => ([1.0, 1.0, 1.0], [0.0; 3]),
        "membrane and rotation" => ([1.0, 0.3, 0.6], [0.0; 3]),
        "bending" => ([0.0; 3], [1.0, 1.0, 1.0]),
        _ => ([0.0; 3], [0.0, 0.0, 2.0]),
    };
    let [first, _, normal] = axes();
    let membrane = plane_stress(strain).map(|stress| stress * thickness);
    let moments = plane_stress(curvature).map(|stress| stress * thickness.powi(3) / 12.0);
    for shell in &patch.shells {
        let points = patch.points(shell.nodes());
        let displacements = Assembly::node_displacements(shell, exact);
        for corner in shell.resultants(&points, &displacements).unwrap() {
            let computed = corner.in_axes(first, normal).unwrap();
            for k in 0..3 {
                let scale = largest(&membrane).max(young * thickness * 1e-3);
                let error = (computed.membrane[k] - membrane[k]).abs();
                assert!(error < 1e-9 * scale, "{state} {computed:?}");
                let scale = largest(&moments).max(young * thickness.powi(3) * 1e-3);
                let error = (computed.moments[k] - moments[k]).abs();
                assert!(error < 1e-9 * scale, "{state} {computed:?}");
            }
            let scale = young * thickness * 0.1;
            assert!(largest(&computed.shears) < 1e-9 * scale, "{state} {computed:?}");
        }
    }
}
