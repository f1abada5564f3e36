//! GOAL: eight-node quadrilaterals.
//! SCENE: the patch of `MacNeal` & Harder, straight and curved; bent rows; bad shapes.
//! REFERENCE: uniform strain, rigid motions, pure bending, exact mass.

use basemat::Error;
use basemat::fem::{Direction, Element, MassKind, Material, Mesh, Quad8, Quad8Integration};
use basemat::structure::{FemModel, Structure};
use basemat_problems::dense::{
    dot, form, largest, mass, multiply, solve_with_prescribed, stiffness,
};
use basemat_problems::patch::{PATCH_NODES, PATCH_QUADS};

const INTEGRATION_RULES: [Quad8Integration; 2] =
    [Quad8Integration::Reduced, Quad8Integration::Full];

/// Mesh of eight-node quadrilaterals from corners: a node in the middle of every edge, moved by
/// `bulge` times the edge's length to its left.
fn refined(
    corners: &[[f64; 2]],
    quads: &[[usize; 4]],
    material: Material,
    integration: Quad8Integration,
    bulge: f64,
) -> Mesh {
    let mut mesh = Mesh::new();
    for &[x, y] in corners {
        mesh.add_node(x, y).unwrap();
    }
    let mut middles: Vec<([usize; 2], usize)> = Vec::new();
    for quad in quads {
        let mut nodes = [0; 8];
        for k in 0..4 {
            let mut ends = [quad[k], quad[(k + 1) % 4]];
            ends.sort_unstable();
            let existing = middles.iter().find(|(edge, _)| *edge == ends).map(|(_, node)| *node);
            let [[x0, y0], [x1, y1]] = ends.map(|node| corners[node]);
            nodes[k] = quad[k];
            nodes[k + 4] = existing.unwrap_or_else(|| {
                let x = 0.5 * (x0 + x1) - bulge * (y1 - y0);
                let node = mesh.add_node(x, 0.5 * (y0 + y1) + bulge * (x1 - x0)).unwrap();
                middles.push((ends, node));
                node
            });
        }
        mesh.add(Quad8::new(nodes, material).with_integration(integration)).unwrap();
    }
    mesh
}

/// Whether a point of the patch lies at its outline, corners and bulged middles of the outer edges included.
fn is_on_outline([x, y, _]: [f64; 3]) -> bool {
    [x, y, x - 0.24, y - 0.12].iter().any(|d| d.abs() < 0.01)
}

/// The patch of `MacNeal` & Harder, straight and with curved inner edges.
#[test]
fn constant_strain_is_reproduced_on_distorted_and_curved_quads() {
    for (integration, poisson, bulge) in [
        (INTEGRATION_RULES[0], 0.3, 0.0),
        (INTEGRATION_RULES[1], 0.3, 0.0),
        (INTEGRATION_RULES[0], 0.3, 0.03),
        (INTEGRATION_RULES[1], 0.4999, 0.03),
    ] {
        let material = Material::new(1.0e6, poisson, 1.0).unwrap();
        let mesh = refined(&PATCH_NODES, &PATCH_QUADS, material, integration, bulge);
        let nodes = mesh.nodes().to_vec();
        let model = FemModel::new(mesh, &[0, 1]).unwrap();
        let mut field = vec![0.0; model.dofs()];
        for (node, [x, y, _]) in nodes.iter().enumerate() {
            field[model.dof(node, Direction::X).unwrap()] = 1e-3 * (x + 0.5 * y);
            field[model.dof(node, Direction::Y).unwrap()] = 1e-3 * (y + 0.5 * x);
        }
        let prescribed: Vec<(usize, f64)> = nodes
            .iter()
            .enumerate()
            .filter(|(_, place)| is_on_outline(**place))
            .flat_map(|(node, _)| [2 * node, 2 * node + 1])
            .map(|dof| (dof, field[dof]))
            .collect();
        assert!(prescribed.len() < field.len(), "something is free");
        let computed =
            solve_with_prescribed(&stiffness(&model), &vec![0.0; field.len()], &prescribed);
        let error: Vec<f64> = computed.iter().zip(&field).map(|(a, b)| a - b).collect();
        let error = largest(&error);
        assert!(error < 1e-12, "{integration:?} {poisson} {bulge}: {error:e}");
    }
}

/// Inertia of a rigid motion.
fn inertia(model: &FemModel, direction: Direction) -> f64 {
    let motion = model.rigid_motion(direction, [0.0; 3]);
    form(&motion, &mass(model), &motion)
}

#[test]
fn rigid_motions_meet_no_force_and_their_inertia_is_exact() {
    for integration in INTEGRATION_RULES {
        let material = Material::new(1.0e6, 0.3, 5.0).unwrap();
        let mesh = refined(&PATCH_NODES, &PATCH_QUADS, material, integration, 0.04);
        let model = FemModel::new(mesh, &[0, 1]).unwrap();
        for direction in [Direction::X, Direction::Y, Direction::Rotation] {
            let shift = model.rigid_motion(direction, [0.0; 3]);
            let matrix = stiffness(&model);
            let max_stiffness = matrix.iter().map(|row| largest(row)).fold(0.0, f64::max);
            assert!(largest(&multiply(&matrix, &shift)) < 1e-14 * max_stiffness);
        }
    }
    // A rectangle 2 × 3 of density 5 about its corner: m and m (w² + h²)/3.
    let material = Material::new(1.0e6, 0.3, 5.0).unwrap();
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 3.0]];
    for (kind, turns) in [(MassKind::Consistent, true), (MassKind::Lumped, false)] {
        let mesh = refined(&corners, &[[0, 1, 2, 3]], material, INTEGRATION_RULES[0], 0.0);
        let model = FemModel::new(mesh, &[0, 1]).unwrap().with_mass(kind);
        assert!((inertia(&model, Direction::X) - 30.0).abs() < 1e-12);
        assert!((inertia(&model, Direction::Y) - 30.0).abs() < 1e-12);
        assert_eq!((inertia(&model, Direction::Rotation) - 130.0).abs() < 1e-11, turns);
        assert!((0..16).all(|i| mass(&model)[i][i] > 0.0));
    }
}

/// Tip deflection of a cantilever 1 × 10 under a unit shear, relative to Timoshenko's beam.
fn tip_ratio(elements: usize, nu: f64, integration: Quad8Integration) -> f64 {
    let young = 1.0e7;
    let length = 10.0;
    let material = Material::new(young, nu, 1.0).unwrap();
    let corners: Vec<[f64; 2]> = (0..=elements)
        .flat_map(|k| {
            let y = length * k as f64 / elements as f64;
            [[-0.5, y], [0.5, y]]
        })
        .collect();
    let quads: Vec<[usize; 4]> =
        (0..elements).map(|k| [2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2]).collect();
    let mesh = refined(&corners, &quads, material, integration, 0.0);
    let model = FemModel::on_base(mesh).unwrap();
    assert_eq!(model.base().nodes().count(), 3);
    let fixed: Vec<(usize, f64)> = model
        .base()
        .nodes()
        .flat_map(|node| [(node.horizontal[0].0, 0.0), (node.vertical[0].0, 0.0)])
        .collect();
    let top = model.mesh().nodes_at_height(length, 1e-9).unwrap();
    let mut load = vec![0.0; model.dofs()];
    for (&node, part) in top.iter().zip([1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]) {
        load[model.dof(node, Direction::X).unwrap()] = part;
    }
    let computed = solve_with_prescribed(&stiffness(&model), &load, &fixed);
    let bending = length.powi(3) / (3.0 * young / (1.0 - nu * nu) / 12.0);
    let shear = length / (5.0 / 6.0 * 0.5 * young / (1.0 + nu));
    dot(&load, &computed) / (bending + shear)
}

#[test]
fn one_row_bends_as_it_should() {
    for elements in [10, 20] {
        for (integration, nu, tolerance) in [
            (Quad8Integration::Reduced, 0.3, 0.02),
            (Quad8Integration::Full, 0.3, 0.03),
            (Quad8Integration::Reduced, 0.4999, 0.1),
        ] {
            // The clamped foot stiffens the cantilever, the more the nearer ν is to ½; locking would halve the
            // deflection.
            let ratio = tip_ratio(elements, nu, integration);
            println!("{elements} {integration:?} {nu}: {ratio}");
            assert!((ratio - 1.0).abs() < tolerance, "{elements} {integration:?} {nu}: {ratio}");
        }
    }
}

/// u_x = −κ (y² + ν′ x²)/2, u_y = κ x y with ν′ = ν/(1−ν): the stress of pure bending, whose energy
/// in a rectangle 1 × 3 is κ² E/(1−ν²)/12 · 3/2.
#[test]
fn pure_bending_is_exact() {
    let young = 1.0e7;
    let nu = 0.3;
    for integration in INTEGRATION_RULES {
        let material = Material::new(young, nu, 1.0).unwrap();
        let corners = [[-0.5, 0.0], [0.5, 0.0], [0.5, 3.0], [-0.5, 3.0]];
        let mesh = refined(&corners, &[[0, 1, 2, 3]], material, integration, 0.0);
        let nodes = mesh.nodes().to_vec();
        let model = FemModel::new(mesh, &[0, 1]).unwrap();
        let mut field = Vec::new();
        for [x, y, _] in nodes {
            field.extend([-0.5 * (y * y + nu / (1.0 - nu) * x * x), x * y]);
        }
        let twice_energy = form(&field, &stiffness(&model), &field);
        let expected = young / (1.0 - nu * nu) / 12.0 * 3.0;
        assert!(
            (twice_energy / expected - 1.0).abs() < 1e-12,
            "{integration:?}: {twice_energy} {expected}"
        );
    }
}

#[test]
fn bad_shapes_are_errors() {
    let quad = Quad8::new([0, 1, 2, 3, 4, 5, 6, 7], Material::new(1.0, 0.3, 1.0).unwrap());
    let valid_nodes = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [0.0, 1.0],
        [1.0, 0.0],
        [2.0, 0.5],
        [1.0, 1.0],
        [0.0, 0.5],
    ]
    .map(|[x, y]| [x, y, 0.0]);
    assert!(quad.check(&valid_nodes).is_ok());
    assert!(matches!(quad.check(&valid_nodes[..7]), Err(Error::Size { .. })));
    let mut clockwise = valid_nodes;
    clockwise.swap(1, 3);
    clockwise.swap(4, 7);
    clockwise.swap(5, 6);
    assert!(matches!(quad.check(&clockwise), Err(Error::Input { .. })));
    // The node of an edge beyond its quarter: the map folds at the corner.
    let mut folded_nodes = valid_nodes;
    folded_nodes[4][0] = 0.4;
    assert!(matches!(quad.check(&folded_nodes), Err(Error::Input { .. })));
    let mut nodes_with_a_missing_one = valid_nodes;
    nodes_with_a_missing_one[2][0] = f64::NAN;
    assert!(matches!(quad.check(&nodes_with_a_missing_one), Err(Error::Input { .. })));
}
