//! GOAL: layers of a block take materials that yield.
//! SCENE: blocks of layers of clay and of concrete at random displacements.
//! REFERENCE: the same quadrilaterals added one by one: forces to the last bit.

use basemat::Error;
use basemat::fem::{Iwan, Layer, Material, Mesh, Quad4, QuadFormulation, SharedMaterial};
use basemat::structure::{FemModel, Structure};
use basemat_problems::random::Random;

fn clay() -> SharedMaterial {
    Iwan::hyperbolic(20.0e6, 40.0e3, 0.4, 0.45, 1800.0).unwrap().into()
}

fn concrete() -> SharedMaterial {
    Material::new(30.0e9, 0.2, 2400.0).unwrap().into()
}

const GRID_LINES: [f64; 4] = [-1.0, 0.0, 0.5, 2.0];

/// Two rows of clay of 1 m each below one row of concrete of 0.5 m, one by one.
fn block_by_hand() -> Mesh {
    let heights = [0.0, 1.0, 2.0, 2.5];
    let mut mesh = Mesh::new();
    let grid = mesh.add_grid(4, 4, |row, column| [GRID_LINES[column], heights[row], 0.0]).unwrap();
    for row in 0..3 {
        for column in 0..3 {
            let lower = grid.row(row);
            let upper = grid.row(row + 1);
            let nodes = [lower[column], lower[column + 1], upper[column + 1], upper[column]];
            let quad = if row < 2 {
                Quad4::new(nodes, clay(), QuadFormulation::MeanDilatation)
            } else {
                Quad4::new(nodes, concrete(), QuadFormulation::IncompatibleModes)
            };
            mesh.add(quad).unwrap();
        }
    }
    mesh
}

/// Nonlinear force at a displacement.
fn nonlinear_force(model: &FemModel, displacement: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; model.dofs()];
    model.nonlinear().unwrap().force(displacement, &mut force).unwrap();
    force
}

#[test]
fn layers_that_yield_are_their_quadrilaterals() {
    let layers = [Layer::new(2.0, 2, clay()), Layer::new(0.5, 1, concrete())];
    assert_eq!(layers[0].formulation, QuadFormulation::MeanDilatation);
    assert_eq!(layers[1].formulation, QuadFormulation::IncompatibleModes);
    let block = FemModel::on_base(Mesh::graded_block(&GRID_LINES, &layers).unwrap()).unwrap();
    let by_hand = FemModel::on_base(block_by_hand()).unwrap();
    assert_eq!(block.mesh().nodes(), by_hand.mesh().nodes());
    let mut random = Random(11);
    let displacement: Vec<f64> = (0..block.dofs()).map(|_| random.within(-0.01, 0.01)).collect();
    let force = nonlinear_force(&block, &displacement);
    assert!(force.iter().any(|value| value.abs() > 1e4));
    assert_eq!(force, nonlinear_force(&by_hand, &displacement));
}

/// GOAL: a single type of material needs no conversion, and another formulation is an error that names it.
#[test]
fn layers_of_one_law_need_no_conversion() {
    let clay = Iwan::hyperbolic(20.0e6, 40.0e3, 0.4, 0.45, 1800.0).unwrap();
    let layer = Layer::new(2.0, 2, clay);
    let mesh = Mesh::layered_block(0.0..1.0, 1, std::slice::from_ref(&layer)).unwrap();
    assert!(mesh.elements().all(|element| element.inelastic().is_some()));
    let elastic_layer = Layer { formulation: QuadFormulation::Full, ..layer };
    let error = Mesh::layered_block(0.0..1.0, 1, &[elastic_layer]).unwrap_err();
    assert!(matches!(error, Error::Scene { .. }), "{error}");
    assert!(error.to_string().contains("QuadFormulation::MeanDilatation"), "{error}");
}
