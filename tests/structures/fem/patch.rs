//! GOAL: a constant strain on the boundary gives that strain everywhere.
//! SCENE: the patch of distorted quadrilaterals of `MacNeal` & Harder (Finite Elements in Analysis
//! and Design 1, 1985, fig. 1).
//! REFERENCE: the uniform strain, its energy and its edge forces.

use basemat::fem::{Direction, Material, Mesh, Quad4, QuadFormulation};
use basemat::structure::{FemModel, Structure};
use basemat_problems::dense::{collect, dot, form, largest, multiply, solve_with_prescribed};
use basemat_problems::patch::{PATCH_NODES, PATCH_QUADS};

fn patch(formulation: QuadFormulation, poisson: f64) -> FemModel {
    let material = Material::new(1.0e6, poisson, 1.0).unwrap();
    let mut mesh = Mesh::new();
    for [x, y] in PATCH_NODES {
        mesh.add_node(x, y).unwrap();
    }
    for nodes in PATCH_QUADS {
        mesh.add(Quad4::new(nodes, material, formulation)).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// u = 1e-3 (x + y/2), v = 1e-3 (y + x/2) at every degree of freedom.
fn exact(model: &FemModel) -> Vec<f64> {
    let mut field = vec![0.0; model.dofs()];
    for (node, [x, y]) in PATCH_NODES.into_iter().enumerate() {
        field[model.dof(node, Direction::X).unwrap()] = 1e-3 * (x + 0.5 * y);
        field[model.dof(node, Direction::Y).unwrap()] = 1e-3 * (y + 0.5 * x);
    }
    field
}

#[test]
fn constant_strain_is_reproduced_on_distorted_quads() {
    for poisson in [0.0, 0.25, 0.4999, -0.5] {
        for formulation in [
            QuadFormulation::Full,
            QuadFormulation::IncompatibleModes,
            QuadFormulation::OnePoint,
            QuadFormulation::Hourglass { percent: 5 },
        ] {
            let model = patch(formulation, poisson);
            let stiffness = collect(&model, |k| model.stiffness(k));
            let expected = exact(&model);
            let prescribed: Vec<(usize, f64)> =
                (0..8).map(|index| (index, expected[index])).collect();
            let computed = solve_with_prescribed(&stiffness, &[0.0; 16], &prescribed);
            let error: Vec<f64> = computed.iter().zip(&expected).map(|(a, b)| a - b).collect();
            assert!(largest(&error) < 1e-11 * largest(&expected), "{formulation:?} {poisson}");
        }
    }
}

/// The energy of the patch is ½ ε D ε times its area: the level of the stress is right too.
#[test]
fn strain_energy_is_that_of_the_uniform_strain() {
    for formulation in [
        QuadFormulation::Full,
        QuadFormulation::IncompatibleModes,
        QuadFormulation::OnePoint,
        QuadFormulation::Hourglass { percent: 5 },
    ] {
        let model = patch(formulation, 0.25);
        let expected = exact(&model);
        // E = 1e6, ν = 1/4: λ = G = 4e5; ε = 1e-3 [1, 1, 1], so σ = [1600, 1600, 400].
        let energy = 0.5 * 1e-3 * (1600.0 + 1600.0 + 400.0) * 0.24 * 0.12;
        let computed = 0.5 * form(&expected, &collect(&model, |k| model.stiffness(k)), &expected);
        assert!((computed / energy - 1.0).abs() < 1e-12, "{formulation:?}: {computed} {energy}");
    }
}

/// Forces on the left edge of the patch: `−σ_xx` and `−τ_xy` times its length.
#[test]
fn edge_forces_are_those_of_the_uniform_stress() {
    let model = patch(QuadFormulation::IncompatibleModes, 0.25);
    let force = multiply(&collect(&model, |k| model.stiffness(k)), &exact(&model));
    let mut left = [vec![0.0; 16], vec![0.0; 16]];
    for node in [0, 3] {
        left[0][2 * node] = 1.0;
        left[1][2 * node + 1] = 1.0;
    }
    // Half of the bottom and top edges' traction goes to the left corners: in x τ·0.12 and −τ·0.12,
    // in y −σ·0.12 and σ·0.12, which cancel.
    assert!((dot(&left[0], &force) + 1600.0 * 0.12).abs() < 1e-9);
    assert!((dot(&left[1], &force) + 400.0 * 0.12).abs() < 1e-9);
}
