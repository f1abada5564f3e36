//! GOAL: structures in boxes, and everything that wraps a structure, forward every method.
//! SCENE: a recording structure, boxed, grouped, with springs, damped and reduced.
//! REFERENCE: the methods of the trait's source.

use std::collections::BTreeSet;

use basemat::fem::{BeamQuadrature, BilinearSteel, FiberBeam, FiberSection, Mesh};
use basemat::structure::{
    Base, BaseNode, CraigBampton, DofCombination, InternalEnergy, ModalDamping, NonlinearForce,
    Structure, StructureDescription, StructureGroup, Triplets, WithElements, WithSprings,
};
use basemat::{Error, Result};

use super::log::{CallLog, methods, source};
use super::recording_part::MARKER_VALUE;

/// Structure of four degrees of freedom, two of them of the base, that records the calls of its methods.
struct RecordingStructure {
    log: CallLog,
    is_linear: bool,
}

fn part_error() -> Error {
    Error::part("structure", "refuses")
}

fn add_diagonal(matrix: &mut Triplets, value: f64) {
    (0..4).for_each(|i| matrix.add(i, i, value));
}

fn two_lines() -> Base {
    let lines = [[0.0, 1.0], [2.0, 3.0]];
    Base::Lines(lines.map(|ends| ends.map(|x| BaseNode::free(x, 0, 1)).to_vec()).to_vec())
}

impl Structure for RecordingStructure {
    fn dofs(&self) -> usize {
        self.log.add("dofs");
        4
    }

    fn base(&self) -> Base {
        self.log.add("base");
        two_lines()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.log.add("mass");
        add_diagonal(matrix, MARKER_VALUE);
        // A structure to be reduced must be coupled with the base.
        for (i, j) in [(0, 2), (2, 0), (0, 3), (3, 0)].into_iter().filter(|_| self.is_linear) {
            matrix.add(i, j, 1e-20);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.log.add("stiffness");
        add_diagonal(matrix, 2.0 * MARKER_VALUE);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.log.add("damping");
        add_diagonal(matrix, 3.0 * MARKER_VALUE);
        Ok(())
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.log.add("geometric_stiffness");
        add_diagonal(matrix, -MARKER_VALUE);
        Ok(())
    }

    fn mass_at_rest(&self) -> Result<Option<Vec<f64>>> {
        self.log.add("mass_at_rest");
        Ok(Some(vec![MARKER_VALUE; 4]))
    }

    fn has_active_damping(&self) -> bool {
        self.log.add("has_active_damping");
        true
    }

    fn has_active_stiffness(&self) -> bool {
        self.log.add("has_active_stiffness");
        true
    }

    fn description(&self) -> StructureDescription {
        self.log.add("description");
        StructureDescription {
            densities: Some([MARKER_VALUE, 2.0]),
            faces_off_ground: Some((3, [MARKER_VALUE, 2.0])),
        }
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        self.log.add("describe");
        Some(format!("places {dofs:?}"))
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        self.log.add("load");
        load[0] += time;
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.log.add("nonlinear");
        (!self.is_linear).then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.log.add("nonlinear_mut");
        (!self.is_linear).then_some(self)
    }
}

impl NonlinearForce for RecordingStructure {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        self.log.add("force");
        force[0] += displacement[0];
        Ok(())
    }

    fn tangent(&self, _: &[f64], matrix: &mut Triplets) -> Result<()> {
        self.log.add("tangent");
        add_diagonal(matrix, 4.0 * MARKER_VALUE);
        Ok(())
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        self.log.add("energy");
        Some(InternalEnergy { stored: displacement[0], dissipated: MARKER_VALUE })
    }

    fn remainder(&self, midstep: &[f64], end: &[f64]) -> Option<f64> {
        self.log.add("remainder");
        Some(midstep[0] + end[1])
    }

    fn describe_state(&self, _: &[f64], dofs: &[usize]) -> Option<String> {
        self.log.add("describe_state");
        Some(format!("state at {dofs:?}"))
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.log.add("has_symmetric_tangent");
        false
    }

    fn commit(&mut self, _: &[f64]) {
        self.log.add("commit");
    }

    fn save(&self) -> Result<Vec<f64>> {
        self.log.add("save");
        Ok(vec![MARKER_VALUE])
    }

    fn restore(&mut self, _: &[f64]) -> Result<()> {
        self.log.add("restore");
        Err(part_error())
    }
}

/// Entry of a matrix on its diagonal.
fn diagonal_entry(dof: usize, fill: impl FnOnce(&mut Triplets) -> Result<()>) -> f64 {
    let mut matrix = Triplets::new(4);
    fill(&mut matrix).unwrap();
    let entries = matrix.entries().iter();
    entries.filter(|(i, j, _)| (*i, *j) == (dof, dof)).map(|(_, _, value)| value).sum()
}

/// Calls the methods of a linear structure; the damping matrix must have the entry `damping` on its diagonal.
fn call_linear_methods(structure: &dyn Structure, dof: usize, damping: f64) {
    assert_eq!((structure.dofs(), structure.base()), (4, two_lines()));
    assert_eq!(diagonal_entry(dof, |matrix| structure.mass(matrix)), MARKER_VALUE);
    assert_eq!(diagonal_entry(dof, |matrix| structure.stiffness(matrix)), 2.0 * MARKER_VALUE);
    let damping_entry = diagonal_entry(dof, |matrix| structure.damping(matrix));
    assert!((damping_entry - damping).abs() < 1e-12);
    let geometric_entry = diagonal_entry(dof, |matrix| structure.geometric_stiffness(matrix));
    assert_eq!(geometric_entry, -MARKER_VALUE);
    assert!(structure.mass_at_rest().unwrap().is_some_and(|masses| masses.len() == 4));
    assert!(structure.has_active_damping());
    assert!(structure.has_active_stiffness());
    let description = structure.description();
    assert_eq!(description.densities, Some([MARKER_VALUE, 2.0]));
    assert_eq!(description.faces_off_ground, Some((3, [MARKER_VALUE, 2.0])));
    assert!(structure.describe(&[1]).is_some_and(|text| text.ends_with("places [1]")));
    let mut load = [0.0; 4];
    structure.load(0.25, &mut load).unwrap();
    assert_eq!(load, [0.25, 0.0, 0.0, 0.0]);
}

/// Calls all methods; the damping matrix must have the entry `damping` on its diagonal.
fn call_methods(mut structure: impl Structure, dof: usize, damping: f64) {
    call_linear_methods(&structure, dof, damping);
    let Some(force) = structure.nonlinear() else {
        assert!(structure.nonlinear_mut().is_none());
        return;
    };
    let mut nonlinear_force = [0.0; 4];
    force.force(&[0.5; 4], &mut nonlinear_force).unwrap();
    assert_eq!(nonlinear_force, [0.5, 0.0, 0.0, 0.0]);
    let tangent_entry = diagonal_entry(dof, |matrix| force.tangent(&[0.0; 4], matrix));
    assert_eq!(tangent_entry, 4.0 * MARKER_VALUE);
    let energy = InternalEnergy { stored: 0.5, dissipated: MARKER_VALUE };
    assert_eq!(force.energy(&[0.5; 4]), Some(energy));
    assert_eq!(force.remainder(&[0.5; 4], &[0.25; 4]), Some(0.75));
    let state = force.describe_state(&[0.5; 4], &[1]).unwrap();
    assert!(state.ends_with("state at [1]"), "{state}");
    assert!(!force.has_symmetric_tangent());
    let variables = force.save().unwrap();
    assert!(variables.contains(&MARKER_VALUE));
    let force = structure.nonlinear_mut().unwrap();
    force.commit(&[0.0; 4]);
    assert_eq!(force.restore(&variables), Err(part_error()));
}

/// Methods of linear structures.
fn linear_methods() -> BTreeSet<String> {
    methods(source!("../crates/structures/src/structure/mod.rs"), "Structure")
}

/// Methods of structures, linear and nonlinear.
fn all_methods() -> BTreeSet<String> {
    let mut names = linear_methods();
    names.extend(methods(
        source!("../crates/structures/src/structure/nonlinear.rs"),
        "NonlinearForce",
    ));
    names
}

fn nonlinear_structure(log: &CallLog) -> RecordingStructure {
    RecordingStructure { log: log.clone(), is_linear: false }
}

#[test]
fn boxed_structures_forward_all_methods() {
    let log = CallLog::default();
    let boxed: Box<dyn Structure> = Box::new(nonlinear_structure(&log));
    call_methods(boxed, 0, 3.0 * MARKER_VALUE);
    assert_eq!(log.take(), all_methods());
    // A box in a box.
    let boxed: Box<dyn Structure> = Box::new(nonlinear_structure(&log));
    call_methods(Box::new(boxed), 0, 3.0 * MARKER_VALUE);
    assert_eq!(log.take(), all_methods());
}

#[test]
fn wrapped_structures_forward_all_methods() {
    let log = CallLog::default();
    call_methods(WithSprings::new(nonlinear_structure(&log)), 0, 3.0 * MARKER_VALUE);
    assert_eq!(log.take(), all_methods());

    let damped_structure =
        ModalDamping::new(&[0.5]).unwrap().on(nonlinear_structure(&log)).unwrap();
    log.take();
    // 2 ζ ω m more, with ω² = 6, stiffness and first tangent over mass; at a degree of freedom outside the base, since
    // a motion of the base alone counts as rigid.
    call_methods(damped_structure, 2, MARKER_VALUE * (3.0 + 6.0_f64.sqrt()));
    assert_eq!(log.take(), all_methods());

    let group = StructureGroup::new().with(nonlinear_structure(&log), 0.0).unwrap();
    call_methods(group, 0, 3.0 * MARKER_VALUE);
    assert_eq!(log.take(), all_methods());
}

/// A reduction accepts linear structures only, and keeps their properties.
#[test]
fn reduced_structures_forward_all_methods() {
    let log = CallLog::default();
    let full_structure = RecordingStructure { log: log.clone(), is_linear: true };
    let reduced_structure = CraigBampton::new(2).reduce(full_structure).unwrap();
    call_methods(reduced_structure, 0, 3.0 * MARKER_VALUE);
    assert_eq!(log.take(), linear_methods());
}

/// Elements on a linear structure add a nonlinear force, and keep its other properties.
#[test]
fn structures_with_elements_forward_all_methods() {
    let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.01).unwrap();
    let section = FiberSection::new().with_rectangle([[-0.1, -0.1], [0.1, 0.1]], [4, 1], steel);
    let mut mesh = Mesh::new();
    let ends = [0.0, 3.0].map(|y| mesh.add_node(0.0, y).unwrap());
    let beam = FiberBeam::new(ends, &section.unwrap(), BeamQuadrature::Lobatto(3), 0.0).unwrap();
    mesh.add(beam).unwrap();
    let log = CallLog::default();
    let linear_structure = RecordingStructure { log: log.clone(), is_linear: true };
    let no_motion = |_, _| Ok(DofCombination::default());
    let with_elements = WithElements::new(linear_structure, mesh, no_motion).unwrap();
    call_linear_methods(&with_elements, 0, 3.0 * MARKER_VALUE);
    // The elements alone are nonlinear, and change.
    let mut methods = linear_methods();
    methods.remove("nonlinear_mut");
    assert_eq!(log.take(), methods);
    assert!(with_elements.nonlinear().is_some());
}
