//! GOAL: structures whose matrices, base or loads make no sense are refused.
//! SCENE: entries out of range or not finite, endless sizes, bad bases, loads without equilibrium.
//! REFERENCE: the fields of the error.

use basemat::bem::ElasticGround;
use basemat::coupled::GravityStage;
use basemat::coupled::StabilityError;
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::{
    Base, BaseNode, CraigBampton, ModalDamping, Structure, StructureGroup, Triplets,
};
use basemat::{Error, MemoryError, Simulation, Soil};

use super::builder::unbuilt;
use super::spoilt::Spoilt;
use super::{NOT_FINITE, refused};
use basemat_problems::block_on_springs::bed;

#[test]
fn structures_that_write_out_of_range_or_nan_are_refused() {
    assert!(Spoilt::sound().scene().build().is_ok());
    let sound = Spoilt::sound;
    for entry in [(3, 0, 1.0), (0, 3, 1.0), (usize::MAX, 0, 1.0)] {
        let index = entry.0.max(entry.1);
        for (name, spoilt) in [
            ("mass matrix", Spoilt { mass: entry, ..sound() }),
            ("stiffness matrix", Spoilt { stiffness: entry, ..sound() }),
            ("damping matrix", Spoilt { damping: entry, ..sound() }),
            ("tangent of the nonlinear force", Spoilt { tangent: Some(entry), ..sound() }),
        ] {
            let error = unbuilt(name, spoilt.scene());
            assert_eq!(error, Error::Index { quantity: name, index, bound: 3 });
            assert_eq!(error.to_string(), format!("{name}: index {index} must be below 3"));
        }
    }
    refused("mass matrix", &NOT_FINITE, |x| {
        Spoilt { mass: (0, 0, x), ..sound() }.scene().build().map(drop)
    });
    refused("stiffness matrix", &NOT_FINITE, |x| {
        Spoilt { stiffness: (0, 0, x), ..sound() }.scene().build().map(drop)
    });
    refused("damping matrix", &NOT_FINITE, |x| {
        Spoilt { damping: (0, 0, x), ..sound() }.scene().build().map(drop)
    });
    refused("tangent", &NOT_FINITE, |x| {
        Spoilt { tangent: Some((0, 0, x)), ..sound() }.scene().build().map(drop)
    });
    let error = unbuilt("stiffness matrix", Spoilt { shrinks: true, ..sound() }.scene());
    assert!(matches!(error, Error::Size { found: 1, needed: 3, .. }));
    let error = unbuilt("load of the structure", Spoilt { load_from: 0.0, ..sound() }.scene());
    assert!(matches!(error, Error::NotFinite { index: 0, value, .. } if value.is_nan()));
}

#[test]
fn damping_that_feeds_energy_in_is_refused() {
    let with = |damping| Spoilt { damping, ..Spoilt::sound() }.scene();
    let error = unbuilt("positive semi-definite", with((1, 1, -1.0)));
    assert_eq!(error, Error::Indefinite { matrix: "damping matrix", row: 1, diagonal: -1.0 });
    let error = unbuilt("must be symmetric", with((0, 1, 1.0)));
    assert!(matches!(error, Error::Unsymmetric { matrix: "damping matrix", row: 0, .. }));
}

#[test]
fn stiffness_that_is_not_symmetric_is_refused() {
    let with = |stiffness| Spoilt { stiffness, ..Spoilt::sound() }.scene();
    let error = unbuilt("entry (2, 1) is 1e3, entry (1, 2) 0e0", with((2, 1, 1e3)));
    assert!(matches!(error, Error::Unsymmetric { matrix: "stiffness matrix", row: 2, .. }));
}

#[test]
fn structures_with_a_bad_base_are_refused() {
    let with = |nodes: Vec<BaseNode>| Spoilt { nodes, ..Spoilt::sound() }.scene();
    let error = unbuilt("contact nodes", with(vec![BaseNode::free(0.0, 0, 1)]));
    assert!(matches!(error, Error::Size { found: 1, needed: 2, .. }));
    let far = vec![BaseNode::free(-2.0, 0, 1), BaseNode::free(2.0, 0, 9)];
    let error = unbuilt("degree of freedom of a contact node", with(far));
    assert!(matches!(error, Error::Index { index: 9, bound: 3, .. }));
    refused("coordinate of a contact node", &NOT_FINITE, |x| {
        with(vec![BaseNode::free(-2.0, 0, 1), BaseNode::free(x, 0, 1)]).build().map(drop)
    });
    refused("coordinate of a contact node", &[-2.0, -3.0], |x| {
        with(vec![BaseNode::free(-2.0, 0, 1), BaseNode::free(x, 0, 1)]).build().map(drop)
    });
    refused("weight of a contact node", &NOT_FINITE, |x| {
        let mut nodes = BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]);
        nodes[0].vertical = (1, x).into();
        with(nodes).build().map(drop)
    });
    let none = Spoilt { dofs: 0, nodes: empty_base(), ..Spoilt::sound() };
    assert!(matches!(
        Simulation::builder(1e-3).structure(none).ground(bed(4)).interface(Bonded).build(),
        Err(Error::Size { found: 0, .. } | Error::Index { .. })
    ));
    // The base moves with one degree of freedom only: nothing turns it, nothing moves it sideways.
    let floating = unbuilt("singular", with(empty_base()));
    assert!(matches!(floating, Error::Singular { order: 3, .. }));
}

fn empty_base() -> Vec<BaseNode> {
    [-2.0, 2.0].map(|x| BaseNode { x, ..BaseNode::default() }).into()
}

#[test]
fn a_structure_that_slides_away_under_its_static_load_is_refused() {
    let pushed = |push| Spoilt { push, ..Spoilt::sound() }.scene();
    let law = Coulomb::new(0.3).unwrap();
    // It is set down without friction; friction of 0.3 then holds it.
    for gravity_stage in [GravityStage::Frictionless, GravityStage::Frictional] {
        let placed = pushed(1e4).interface(law).gravity_stage(gravity_stage);
        let shear = placed.build().unwrap().state().base_shear;
        assert!((shear - 1e4).abs() < 1e-4, "{shear}");
    }
    let weight = pushed(0.0).interface(law).build().unwrap().state().normal_force;
    let error = unbuilt("pushes it off", pushed(0.31 * weight).interface(law));
    let Error::Stability(cause) = error else { panic!("{error:?}") };
    match *cause {
        StabilityError::Sliding { ratio, .. } => {
            assert!((ratio - 0.31 / 0.3).abs() < 1e-6, "{ratio}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn structures_without_end_are_refused() {
    // More degrees of freedom than any machine holds.
    let endless = Spoilt { dofs: usize::MAX, ..Spoilt::sound() };
    match endless.scene().build().err() {
        Some(Error::Memory(MemoryError { quantity, .. })) => {
            assert_eq!(quantity, "degrees of freedom of the structure");
        }
        other => panic!("{other:?}"),
    }
}

/// A structure whose stiffness is of another order than it says.
struct Grown;

impl Structure for Grown {
    fn dofs(&self) -> usize {
        3
    }
    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }
    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        (0..3).for_each(|i| matrix.add(i, i, 1e4));
        Ok(())
    }
    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        *matrix = Triplets::new(7);
        Ok(())
    }
}

#[test]
fn matrices_of_another_order_are_refused_by_whatever_reads_them() {
    let refusal = Error::Size { quantity: "stiffness matrix", found: 7, needed: 3 };
    let scene = Simulation::builder(1e-3).structure(Grown).ground(bed(4)).interface(Bonded);
    assert_eq!(scene.build().unwrap_err(), refusal);
    assert_eq!(ModalDamping::new(&[0.05]).unwrap().on(Grown).unwrap_err(), refusal);
    assert_eq!(CraigBampton::new(0).reduce(Grown).unwrap_err(), refusal);
}

#[test]
fn groups_of_endless_structures_are_refused() {
    let endless = || Spoilt { dofs: usize::MAX, ..Spoilt::sound() };
    let group = StructureGroup::new().with(endless(), 0.0).unwrap().with(endless(), 9.0).unwrap();
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    assert!(ElasticGround::under(soil, &group, 4).is_ok());
    let scene = Simulation::builder(1e-3).structure(group).ground(bed(4)).interface(Bonded);
    assert!(matches!(scene.build(), Err(Error::Memory(_))));
}
