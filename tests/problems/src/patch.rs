//! Patches of `MacNeal` & Harder (Finite Elements in Analysis and Design 1, 1985), and their uniform states.

use basemat::fem::{Hex8, Material};

use crate::supported::SupportedMesh;

/// Nodes of the distorted quadrilaterals, corners of the patch first.
pub const PATCH_NODES: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [0.24, 0.0],
    [0.24, 0.12],
    [0.0, 0.12],
    [0.04, 0.02],
    [0.18, 0.03],
    [0.16, 0.08],
    [0.08, 0.08],
];
/// Corners of the distorted quadrilaterals.
pub const PATCH_QUADS: [[usize; 4]; 5] =
    [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]];
/// Names of the states in which shells have uniform strains or curvatures.
pub const SHELL_STATES: [&str; 4] = ["membrane", "membrane and rotation", "bending", "twist"];
/// Seven bricks in a unit cube.
pub const CUBE_BRICKS: [[usize; 8]; 7] = [
    [8, 9, 10, 11, 12, 13, 14, 15],
    [0, 1, 2, 3, 8, 9, 10, 11],
    [12, 13, 14, 15, 4, 5, 6, 7],
    [0, 1, 9, 8, 4, 5, 13, 12],
    [1, 2, 10, 9, 5, 6, 14, 13],
    [2, 3, 11, 10, 6, 7, 15, 14],
    [3, 0, 8, 11, 7, 4, 12, 15],
];
/// Nodes inside the cube, numbers 8 to 15.
const INNER_NODES: [[f64; 3]; 8] = [
    [0.249, 0.342, 0.192],
    [0.826, 0.288, 0.288],
    [0.850, 0.649, 0.263],
    [0.273, 0.750, 0.230],
    [0.320, 0.186, 0.643],
    [0.677, 0.305, 0.683],
    [0.788, 0.693, 0.644],
    [0.165, 0.745, 0.702],
];

/// Displacements u, v, w and rotations about x, y, z of shells in a state.
pub fn field(state: &str, x: f64, y: f64) -> [f64; 6] {
    match state {
        "membrane" => [x + 0.5 * y, y + 0.5 * x, 0.0, 0.0, 0.0, 0.0],
        "membrane and rotation" => [x - 0.2 * y, 0.3 * y + 0.8 * x, 0.0, 0.0, 0.0, 0.5],
        "bending" => {
            // w = ½(x² + xy + y²); θ1 = w,y and θ2 = −w,x.
            [0.0, 0.0, 0.5 * (x * x + x * y + y * y), 0.5 * x + y, -x - 0.5 * y, 0.0]
        }
        "twist" => [0.0, 0.0, x * y, x, -y, 0.0],
        _ => unreachable!(),
    }
}

/// The bricks; their first eight nodes are the corners of the cube.
pub fn bricks(material: Material) -> SupportedMesh {
    let mut scene = SupportedMesh::new();
    for z in [0.0, 1.0] {
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            scene.node([x, y, z]);
        }
    }
    for point in INNER_NODES {
        scene.node(point);
    }
    for nodes in CUBE_BRICKS {
        scene.add(Hex8::new(nodes, material));
    }
    scene
}
