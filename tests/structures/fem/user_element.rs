//! GOAL: an element written outside the crate: the constant-strain triangle.
//! SCENE: three triangles beside a quadrilateral.
//! REFERENCE: one uniform strain, and the mass of the whole.

use basemat::fem::{Direction, Element, MassKind, Material, Mesh, Quad4, QuadFormulation};
use basemat::structure::FemModel;
use basemat_problems::dense::{form, largest, mass, multiply, solve_with_prescribed, stiffness};

struct Triangle {
    nodes: [usize; 3],
    material: Material,
}

fn twice_area(p: &[[f64; 3]]) -> f64 {
    (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1])
}

impl Element for Triangle {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        &[Direction::X, Direction::Y]
    }

    fn stiffness(&self, p: &[[f64; 3]], matrix: &mut [f64]) {
        let double = twice_area(p);
        let d = self.material.elasticity();
        let strain: Vec<[f64; 3]> = (0..6)
            .map(|column| {
                let j = (column / 2 + 1) % 3;
                let k = (column / 2 + 2) % 3;
                let dx = (p[j][1] - p[k][1]) / double;
                let dy = (p[k][0] - p[j][0]) / double;
                if column % 2 == 0 { [dx, 0.0, dy] } else { [0.0, dy, dx] }
            })
            .collect();
        for i in 0..6 {
            for j in 0..6 {
                let mut sum = 0.0;
                for a in 0..3 {
                    for b in 0..3 {
                        sum += strain[i][a] * d[a][b] * strain[j][b];
                    }
                }
                matrix[6 * i + j] += 0.5 * double * sum;
            }
        }
    }

    fn mass(&self, p: &[[f64; 3]], _kind: MassKind, matrix: &mut [f64]) {
        for i in 0..6 {
            matrix[7 * i] += self.material.density() * twice_area(p) / 6.0;
        }
    }
}

/// Two triangles and a quadrilateral side by side: one strain, recovered at the node between.
#[test]
fn a_users_triangle_passes_the_patch_test_beside_quads() {
    let material = Material::new(2.0e7, 0.3, 1800.0).unwrap();
    let mut mesh = Mesh::new();
    let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.2, 0.6], [0.0, 1.0]];
    for [x, y] in points {
        mesh.add_node(x, y).unwrap();
    }
    for nodes in [[0, 1, 4], [0, 4, 5], [3, 5, 4]] {
        mesh.add(Triangle { nodes, material }).unwrap();
    }
    mesh.add(Quad4::new([1, 2, 3, 4], material, QuadFormulation::default())).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let expected: Vec<f64> =
        points.iter().flat_map(|[x, y]| [1e-3 * x - 2e-3 * y, 4e-3 * x + 3e-3 * y]).collect();
    let prescribed: Vec<(usize, f64)> = (0..12)
        .filter(|index| index / 2 != 4)
        .map(|index| (index, expected[index]))
        .collect();
    let computed = solve_with_prescribed(&stiffness(&model), &[0.0; 12], &prescribed);
    for (a, b) in computed.iter().zip(&expected) {
        assert!((a - b).abs() < 1e-15);
    }
    let shift = model.rigid_motion(Direction::X, [0.0; 3]);
    assert!((form(&shift, &mass(&model), &shift) - 2.0 * 1800.0).abs() < 1e-9);
    assert!(largest(&multiply(&stiffness(&model), &shift)) < 1e-7);
}
