//! GOAL: structures whose matrices, base or loads make no sense are errors.
//! SCENE: entries out of range or not finite, huge sizes, bad bases, loads without equilibrium.
//! REFERENCE: the fields of the error.

use basemat::bem::ElasticGround;
use basemat::coupled::{GravityStage, SimulationBuilder, StabilityError};
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::{
    Base, BaseNode, CraigBampton, ModalDamping, Structure, StructureGroup, Triplets,
};
use basemat::{Error, MemoryError, Simulation, Soil};

use super::builder::build_error;
use super::defective_structure::{DefectiveStructure, MatrixEntry};
use super::{NOT_FINITE, assert_errors};
use basemat_problems::block_on_springs::bed;

fn with_mass(mass: MatrixEntry) -> DefectiveStructure {
    DefectiveStructure { mass, ..DefectiveStructure::intact() }
}

fn with_stiffness(stiffness: MatrixEntry) -> DefectiveStructure {
    DefectiveStructure { stiffness, ..DefectiveStructure::intact() }
}

fn with_damping(damping: MatrixEntry) -> DefectiveStructure {
    DefectiveStructure { damping, ..DefectiveStructure::intact() }
}

fn with_tangent(tangent: MatrixEntry) -> DefectiveStructure {
    DefectiveStructure { tangent: Some(tangent), ..DefectiveStructure::intact() }
}

#[test]
fn structures_that_write_out_of_range_or_nan_are_errors() {
    type MatrixWithEntry = (&'static str, fn(MatrixEntry) -> DefectiveStructure);
    assert!(DefectiveStructure::intact().scene().build().is_ok());
    let matrices: [MatrixWithEntry; 4] = [
        ("mass matrix", with_mass),
        ("stiffness matrix", with_stiffness),
        ("damping matrix", with_damping),
        ("tangent of the nonlinear force", with_tangent),
    ];
    for (quantity, with_entry) in matrices {
        for entry in [(3, 0, 1.0), (0, 3, 1.0), (usize::MAX, 0, 1.0)] {
            let index = entry.0.max(entry.1);
            let error = build_error(quantity, with_entry(entry).scene());
            assert_eq!(error, Error::Index { quantity, index, bound: 3 });
            assert_eq!(error.to_string(), format!("{quantity}: index {index} must be below 3"));
        }
        assert_errors(quantity, &NOT_FINITE, |value| {
            with_entry((0, 0, value)).scene().build().map(drop)
        });
    }
    let intact_structure = DefectiveStructure::intact();
    let shrinking = DefectiveStructure { shrinks_stiffness: true, ..intact_structure.clone() };
    let error = build_error("stiffness matrix", shrinking.scene());
    assert!(matches!(error, Error::Size { found: 1, needed: 3, .. }));
    let failing_load = DefectiveStructure { load_fails_at: 0.0, ..intact_structure };
    let error = build_error("load of the structure", failing_load.scene());
    assert!(matches!(error, Error::NotFinite { index: 0, value, .. } if value.is_nan()));
}

#[test]
fn damping_that_adds_energy_is_an_error() {
    let error = build_error("positive semi-definite", with_damping((1, 1, -1.0)).scene());
    assert_eq!(error, Error::Indefinite { matrix: "damping matrix", row: 1, diagonal: -1.0 });
    let error = build_error("must be symmetric", with_damping((0, 1, 1.0)).scene());
    assert!(matches!(error, Error::Unsymmetric { matrix: "damping matrix", row: 0, .. }));
}

#[test]
fn stiffness_that_is_not_symmetric_is_an_error() {
    let scene = with_stiffness((2, 1, 1e3)).scene();
    let error = build_error("entry (2, 1) is 1e3, entry (1, 2) 0e0", scene);
    assert!(matches!(error, Error::Unsymmetric { matrix: "stiffness matrix", row: 2, .. }));
}

fn with_nodes(nodes: Vec<BaseNode>) -> SimulationBuilder {
    DefectiveStructure { nodes, ..DefectiveStructure::intact() }.scene()
}

#[test]
fn structures_with_an_invalid_base_are_errors() {
    let error = build_error("contact nodes", with_nodes(vec![BaseNode::free(0.0, 0, 1)]));
    assert!(matches!(error, Error::Size { found: 1, needed: 2, .. }));
    let unknown_dof = vec![BaseNode::free(-2.0, 0, 1), BaseNode::free(2.0, 0, 9)];
    let error = build_error("degree of freedom of a contact node", with_nodes(unknown_dof));
    assert!(matches!(error, Error::Index { index: 9, bound: 3, .. }));
    for values in [&NOT_FINITE[..], &[-2.0, -3.0]] {
        assert_errors("coordinate of a contact node", values, |x| {
            let nodes = vec![BaseNode::free(-2.0, 0, 1), BaseNode::free(x, 0, 1)];
            with_nodes(nodes).build().map(drop)
        });
    }
    assert_errors("weight of a contact node", &NOT_FINITE, |weight| {
        let mut nodes = BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]);
        nodes[0].vertical = (1, weight).into();
        with_nodes(nodes).build().map(drop)
    });
    let intact_structure = DefectiveStructure::intact();
    let without_dofs =
        DefectiveStructure { dofs: 0, nodes: nodes_without_dofs(), ..intact_structure };
    let scene = Simulation::builder(1e-3).structure(without_dofs).ground(bed(4));
    assert!(matches!(
        scene.interface(Bonded).build(),
        Err(Error::Size { found: 0, .. } | Error::Index { .. })
    ));
    // Nothing connects the base with the structure, and nothing resists its motion.
    let error_of_a_free_base = build_error("singular", with_nodes(nodes_without_dofs()));
    assert!(matches!(error_of_a_free_base, Error::Singular { order: 3, .. }));
}

fn nodes_without_dofs() -> Vec<BaseNode> {
    [-2.0, 2.0].map(|x| BaseNode { x, ..BaseNode::default() }).into()
}

/// A structure on friction of 0.3 under a horizontal load, N/m.
fn pushed(horizontal_load: f64) -> SimulationBuilder {
    let structure = DefectiveStructure { horizontal_load, ..DefectiveStructure::intact() };
    structure.scene().interface(Coulomb::new(0.3).unwrap())
}

#[test]
fn a_structure_that_slides_away_under_its_static_load_is_an_error() {
    // Friction of 0.3 carries the load after both gravity stages.
    for gravity_stage in [GravityStage::Frictionless, GravityStage::Frictional] {
        let simulation = pushed(1e4).gravity_stage(gravity_stage).build().unwrap();
        let shear = simulation.state().base_shear;
        assert!((shear - 1e4).abs() < 1e-4, "{shear}");
    }
    let weight = pushed(0.0).build().unwrap().state().normal_force;
    let error = build_error("pushes it off", pushed(0.31 * weight));
    let Error::Stability(cause) = error else { panic!("{error:?}") };
    match *cause {
        StabilityError::Sliding { ratio, .. } => {
            assert!((ratio - 0.31 / 0.3).abs() < 1e-6, "{ratio}");
        }
        other => panic!("{other:?}"),
    }
}

/// A structure with more degrees of freedom than any machine can store.
fn huge_structure() -> DefectiveStructure {
    DefectiveStructure { dofs: usize::MAX, ..DefectiveStructure::intact() }
}

#[test]
fn huge_structures_are_errors() {
    match huge_structure().scene().build().err() {
        Some(Error::Memory(MemoryError { quantity, .. })) => {
            assert_eq!(quantity, "degrees of freedom of the structure");
        }
        other => panic!("{other:?}"),
    }
}

/// A structure whose stiffness matrix is larger than its number of degrees of freedom.
struct StructureOfWrongOrder;

impl Structure for StructureOfWrongOrder {
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
fn matrices_of_another_order_are_errors_wherever_they_are_read() {
    let expected = Error::Size { quantity: "stiffness matrix", found: 7, needed: 3 };
    let scene = Simulation::builder(1e-3).structure(StructureOfWrongOrder).ground(bed(4));
    assert_eq!(scene.interface(Bonded).build().unwrap_err(), expected);
    let damping = ModalDamping::new(&[0.05]).unwrap();
    assert_eq!(damping.on(StructureOfWrongOrder).unwrap_err(), expected);
    assert_eq!(CraigBampton::new(0).reduce(StructureOfWrongOrder).unwrap_err(), expected);
}

#[test]
fn groups_of_huge_structures_are_errors() {
    let group = StructureGroup::new().with(huge_structure(), 0.0).unwrap();
    let group = group.with(huge_structure(), 9.0).unwrap();
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    assert!(ElasticGround::under(soil, &group, 4).is_ok());
    let scene = Simulation::builder(1e-3).structure(group).ground(bed(4)).interface(Bonded);
    assert!(matches!(scene.build(), Err(Error::Memory(_))));
}
