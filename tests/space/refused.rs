//! Scenes in plan that are none, each with an error that says what is wrong.

use basemat::bem::{Ground, SpringGround};
use basemat::interface::{Bonded, InterfaceLaw};
use basemat::structure::{ContactNode, RigidBlock, RigidBody, Structure, StructureGroup, Triplets};
use basemat::{Error, PlanError, Result, Simulation};

use super::cells::{BED, Cells};

fn build(
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
    law: impl InterfaceLaw + 'static,
) -> Error {
    let built =
        Simulation::builder(0.01).structure(structure).ground(ground).interface(law).build();
    built.expect_err("an error")
}

fn cube() -> RigidBody {
    RigidBody::cuboid([4.0; 3], 2000.0).unwrap()
}

fn cells() -> Cells {
    Cells::under([4.0; 2], [0.0; 2], [4, 4], BED)
}

fn bed() -> SpringGround {
    SpringGround::new(-2.0..2.0, 4, 1e7, 1e7).unwrap()
}

#[test]
fn bases_of_another_dimension() {
    let error = build(RigidBlock::new(4.0, 4.0, 2000.0).unwrap(), cells(), Bonded);
    assert!(matches!(error, Error::Scene { quantity: "structure", .. }), "{error}");
    assert!(error.to_string().contains("faces"), "{error}");
    let error = build(cube(), bed(), Bonded);
    assert!(matches!(error, Error::Scene { quantity: "structure", .. }), "{error}");
    assert!(error.to_string().contains("contact nodes"), "{error}");
    let group = StructureGroup::new().with(cube(), 0.0).unwrap();
    let error = group.with(RigidBlock::new(4.0, 4.0, 2000.0).unwrap(), 9.0).err().unwrap();
    assert!(matches!(error, Error::Scene { quantity: "structure of a group", .. }), "{error}");
}

/// A body with nodes of the plane, too.
struct Both(RigidBody);

impl Structure for Both {
    fn dofs(&self) -> usize {
        6
    }
    fn contact_nodes(&self) -> Vec<ContactNode> {
        ContactNode::rigid_base(-2.0, 2.0, [0, 2, 4])
    }
    fn contact_faces(&self) -> Vec<Vec<basemat::structure::FaceNode>> {
        self.0.contact_faces()
    }
    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.mass(matrix)
    }
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.stiffness(matrix)
    }
}

#[test]
fn a_base_of_both_kinds() {
    for error in [build(Both(cube()), cells(), Bonded), build(Both(cube()), bed(), Bonded)] {
        assert!(error.to_string().contains("not both"), "{error}");
    }
}

#[test]
fn cells_that_no_face_covers() {
    let error = build(cube(), Cells::under([7.0, 4.0], [0.0; 2], [7, 4], BED), Bonded);
    let quantity = "distance of a contact element from the faces of the base, m";
    let Error::Input { quantity: found, value, .. } = error else { panic!("{error}") };
    // Gauss points of the outer cells, from the edge at 2 m.
    let pitch = 7.0 / 6.8;
    let expected = pitch * (3.0 + 0.5 / 3.0_f64.sqrt()) - 2.0;
    assert_eq!(found, quantity);
    assert!((value - expected).abs() < 1e-12, "{value} {expected}");
    // Up to half a cell the base goes on.
    let ground = Cells::under([4.8, 4.0], [0.0; 2], [4, 4], BED);
    assert!(
        Simulation::builder(0.01)
            .structure(cube())
            .ground(ground)
            .interface(Bonded)
            .build()
            .is_ok()
    );
}

#[test]
fn elements_that_are_no_cells() {
    let wrong = |change: fn(&mut Cells)| {
        let mut cells = cells();
        change(&mut cells);
        build(cube(), cells, Bonded)
    };
    let quantity = |error: Error| match error {
        Error::Input { quantity, .. } => quantity,
        error => panic!("{error}"),
    };
    assert_eq!(quantity(wrong(|own| own.directions = 4)), "number of directions of the ground");
    assert_eq!(quantity(wrong(|own| own.depths[3] = [1.0, 1.0])), "depth of a contact element");
    assert_eq!(quantity(wrong(|own| own.depths[3][1] = f64::NAN)), "back end of a contact element");
    assert_eq!(
        quantity(wrong(|own| own.elements[5].right += 0.1)),
        "left end of a contact element"
    );
    assert_eq!(quantity(wrong(|own| own.depths[5][0] -= 0.1)), "left end of a contact element");
    // In the plane these rows lie on one another.
    assert_eq!(quantity(wrong(|own| own.directions = 2)), "left end of a contact element");
}

#[test]
fn bodies_that_are_none() {
    let body = |outline: &[[f64; 2]], inertia| {
        RigidBody::from_mass(outline.to_vec(), 1e4, inertia, [0.0, 0.0, 1.0])
    };
    let square = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let round = [[1e4, 0.0, 0.0], [0.0, 1e4, 0.0], [0.0, 0.0, 1e4]];
    assert!(body(&square, round).is_ok());
    let mut tensor = round;
    tensor[0][1] = 1.0;
    assert!(body(&square, tensor).err().unwrap().to_string().contains("symmetric"));
    tensor[0][1] = 1e4;
    tensor[1][0] = 1e4;
    assert!(body(&square, tensor).err().unwrap().to_string().contains("positive definite"));
    assert!(matches!(body(&square[..2], round), Err(Error::Size { found: 2, needed: 3, .. })));
    assert!(RigidBody::cuboid([4.0, 0.0, 4.0], 2000.0).is_err());
    assert!(RigidBody::cylinder(4.0, 4.0, f64::NAN).is_err());
    assert!(RigidBody::from_mass(square.to_vec(), 1e4, round, [0.0, 0.0, -1.0]).is_err());
    let crossed = [square[0], square[2], square[1], square[3]];
    let error = build(body(&crossed, round).unwrap(), cells(), Bonded);
    assert!(matches!(error, Error::Plan(PlanError::Face { face: 0, .. })), "{error}");
}
