//! GOAL: a finite element of a user works in a model.
//! SCENE: a tripod of struts on a block of quadrilaterals.
//! REFERENCE: a run with a closed energy balance.

use basemat::fem::{Direction, Element, Layer, MassKind, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::structure::FemModel;

use super::scene::{complete_run, shaken};
use basemat_problems::block_on_springs::bed;

/// A strut along its axis, exact under rigid motions.
struct Strut([usize; 2]);

impl Element for Strut {
    fn nodes(&self) -> &[usize] {
        &self.0
    }

    fn directions(&self) -> &[Direction] {
        &[Direction::X, Direction::Y]
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let dx = coordinates[1][0] - coordinates[0][0];
        let dy = coordinates[1][1] - coordinates[0][1];
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
fn an_element_of_a_user_carries_loads() {
    let concrete = Material::new(20.0e9, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::layered_block(-2.0..2.0, 4, &[Layer::new(1.0, 1, concrete)]).unwrap();
    let top = mesh.add_node(0.0, 4.0).unwrap();
    for x in [-2.0, 2.0] {
        let foot = mesh.node_at(x, 1.0).unwrap();
        mesh.add(Strut([foot, top])).unwrap();
    }
    let model = FemModel::on_base(mesh).unwrap();
    let tip = model.dof(top, Direction::X).unwrap();
    let scene = shaken().structure(model).ground(bed(4)).interface(Coulomb::new(0.6).unwrap());
    let simulation = complete_run(scene).simulation;
    assert!(simulation.state().absolute_displacement()[tip].is_finite());
}
