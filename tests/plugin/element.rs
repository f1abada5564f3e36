//! GOAL: a finite element of one's own.
//! SCENE: a tripod of struts on a block of quadrilaterals.
//! REFERENCE: a run with a closed energy balance.

use basemat::fem::{Direction, Element, Layer, MassKind, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::structure::FemModel;

use super::scene::{run, shaken};
use basemat_problems::block_on_springs::bed;

/// A column that is only a spring between two heights.
struct Column([usize; 2]);

impl Element for Column {
    fn nodes(&self) -> &[usize] {
        &self.0
    }

    fn directions(&self) -> &[Direction] {
        &[Direction::X, Direction::Y]
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        // A strut along its axis, exact under rigid motions.
        let [dx, dy] = [0, 1].map(|k| coordinates[1][k] - coordinates[0][k]);
        let length = dx.hypot(dy);
        let axis = [-dx / length, -dy / length, dx / length, dy / length];
        for i in 0..4 {
            for j in 0..4 {
                matrix[4 * i + j] += 2.0e8 / length * axis[i] * axis[j];
            }
        }
    }

    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, matrix: &mut [f64]) {
        for i in 0..4 {
            matrix[5 * i] += 500.0;
        }
    }
}

#[test]
fn own_element() {
    let concrete = Material::new(20.0e9, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::layered_block(-2.0..2.0, 4, &[Layer::new(1.0, 1, concrete)]).unwrap();
    // A tripod of struts on the block.
    let top = mesh.add_node(0.0, 4.0).unwrap();
    for x in [-2.0, 2.0] {
        let foot = mesh.node_at(x, 1.0).unwrap();
        mesh.add(Column([foot, top])).unwrap();
    }
    let model = FemModel::on_base(mesh).unwrap();
    let tip = model.dof(top, Direction::X).unwrap();
    let scene = shaken().structure(model).ground(bed(4)).interface(Coulomb::new(0.6).unwrap());
    let (_, simulation) = run(scene);
    assert!(simulation.state().absolute_displacement()[tip].is_finite());
}
