//! GOAL: a structure written by hand is the built-in one.
//! SCENE: five storeys of springs and masses.
//! REFERENCE: `ShearBuilding`.

use basemat::structure::{Base, BaseNode, ShearBuilding, Storey, Structure, Triplets};
use basemat_problems::dense::{mass, stiffness};

/// Five storeys on a rigid base: `[u_x, u_y, θ]` and the floors.
struct FiveStoreys {
    mass: f64,
    stiffness: f64,
    height: f64,
}

impl Structure for FiveStoreys {
    fn dofs(&self) -> usize {
        8
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-5.0, 5.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add(0, 0, self.mass);
        matrix.add(1, 1, 6.0 * self.mass);
        matrix.add(2, 2, 10.0 * self.mass);
        for floor in 3..8 {
            matrix.add(floor, floor, self.mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        for (below, floor) in [(0, 3), (3, 4), (4, 5), (5, 6), (6, 7)] {
            matrix.add_outer([(floor, 1.0), (below, -1.0), (2, self.height)], self.stiffness);
        }
        Ok(())
    }
}

#[test]
fn five_storeys_by_hand_are_a_shear_building() {
    let by_hand = FiveStoreys { mass: 2.0e4, stiffness: 4.0e7, height: 3.0 };
    let storeys = [Storey::new(3.0, 2.0e4, 4.0e7); 5];
    let building = ShearBuilding::new(10.0, 2.0e4, 2.0e5, &storeys).unwrap();
    assert_eq!(mass(&by_hand), mass(&building));
    assert_eq!(stiffness(&by_hand), stiffness(&building));
    assert_eq!(by_hand.base(), building.base());
}
