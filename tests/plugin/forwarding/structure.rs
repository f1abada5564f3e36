//! GOAL: structures in boxes, and everything that wraps a structure, hand every question on.
//! SCENE: a double of the trait `Structure`, boxed, grouped, with springs, damped and reduced.
//! REFERENCE: the methods of the trait's source.

use std::collections::BTreeSet;

use basemat::structure::{
    Base, BaseNode, CraigBampton, InternalEnergy, ModalDamping, NonlinearForce, Structure,
    StructureDescription, StructureGroup, Triplets, WithSprings,
};
use basemat::{Error, Result};

use super::doubles::CORRECT;
use super::log::{Log, methods, source};

/// Four degrees of freedom, two of them of the base.
struct Double {
    log: Log,
    linear: bool,
}

fn refusal() -> Error {
    Error::part("structure", "refuses")
}

fn add_diagonal(matrix: &mut Triplets, value: f64) {
    (0..4).for_each(|i| matrix.add(i, i, value));
}

fn two_lines() -> Base {
    let line = |ends: [f64; 2]| ends.map(|x| BaseNode::free(x, 0, 1)).to_vec();
    Base::Lines(vec![line([0.0, 1.0]), line([2.0, 3.0])])
}

impl Structure for Double {
    fn dofs(&self) -> usize {
        self.log.asked("dofs");
        4
    }

    fn base(&self) -> Base {
        self.log.asked("base");
        two_lines()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.log.asked("mass");
        add_diagonal(matrix, CORRECT);
        // A structure to be reduced must be coupled with the base.
        for (i, j) in [(0, 2), (2, 0), (0, 3), (3, 0)].into_iter().filter(|_| self.linear) {
            matrix.add(i, j, 1e-20);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.log.asked("stiffness");
        add_diagonal(matrix, 2.0 * CORRECT);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.log.asked("damping");
        add_diagonal(matrix, 3.0 * CORRECT);
        Ok(())
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.log.asked("geometric_stiffness");
        add_diagonal(matrix, -CORRECT);
        Ok(())
    }

    fn has_active_damping(&self) -> bool {
        self.log.asked("has_active_damping");
        true
    }

    fn has_active_stiffness(&self) -> bool {
        self.log.asked("has_active_stiffness");
        true
    }

    fn description(&self) -> StructureDescription {
        self.log.asked("description");
        StructureDescription {
            densities: Some([CORRECT, 2.0]),
            faces_off_ground: Some((3, [CORRECT, 2.0])),
        }
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        self.log.asked("describe");
        Some(format!("places {dofs:?}"))
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        self.log.asked("load");
        load[0] += time;
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.log.asked("nonlinear");
        (!self.linear).then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.log.asked("nonlinear_mut");
        (!self.linear).then_some(self)
    }
}

impl NonlinearForce for Double {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        self.log.asked("force");
        force[0] += displacement[0];
        Ok(())
    }

    fn tangent(&self, _: &[f64], matrix: &mut Triplets) -> Result<()> {
        self.log.asked("tangent");
        add_diagonal(matrix, 4.0 * CORRECT);
        Ok(())
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        self.log.asked("energy");
        Some(InternalEnergy { stored: displacement[0], dissipated: CORRECT })
    }

    fn commit(&mut self, _: &[f64]) {
        self.log.asked("commit");
    }

    fn save(&self) -> Result<Vec<f64>> {
        self.log.asked("save");
        Ok(vec![CORRECT])
    }

    fn restore(&mut self, _: &[f64]) -> Result<()> {
        self.log.asked("restore");
        Err(refusal())
    }
}

/// Asks all there is to ask; `damping` as it should come out on the diagonal at the degree of freedom `place`.
fn ask(mut part: impl Structure, place: usize, damping: f64) {
    assert_eq!((part.dofs(), part.base()), (4, two_lines()));
    let diagonal = |fill: &dyn Fn(&mut Triplets) -> Result<()>| {
        let mut matrix = Triplets::new(4);
        fill(&mut matrix).unwrap();
        let entries = matrix.entries().iter();
        entries
            .filter(|(i, j, _)| (*i, *j) == (place, place))
            .map(|(_, _, value)| value)
            .sum::<f64>()
    };
    assert_eq!(diagonal(&|m| part.mass(m)), CORRECT);
    assert_eq!(diagonal(&|m| part.stiffness(m)), 2.0 * CORRECT);
    assert!((diagonal(&|m| part.damping(m)) - damping).abs() < 1e-12);
    assert_eq!(diagonal(&|m| part.geometric_stiffness(m)), -CORRECT);
    assert!(part.has_active_damping());
    assert!(part.has_active_stiffness());
    let description = part.description();
    assert_eq!(description.densities, Some([CORRECT, 2.0]));
    assert_eq!(description.faces_off_ground, Some((3, [CORRECT, 2.0])));
    assert!(part.describe(&[1]).is_some_and(|text| text.ends_with("places [1]")));
    let mut load = [0.0; 4];
    part.load(0.25, &mut load).unwrap();
    assert_eq!(load, [0.25, 0.0, 0.0, 0.0]);
    let Some(force) = part.nonlinear() else {
        assert!(part.nonlinear_mut().is_none());
        return;
    };
    force.force(&[0.5; 4], &mut load).unwrap();
    assert_eq!(load, [0.75, 0.0, 0.0, 0.0]);
    assert_eq!(diagonal(&|m| force.tangent(&[0.0; 4], m)), 4.0 * CORRECT);
    let energy = InternalEnergy { stored: 0.5, dissipated: CORRECT };
    assert_eq!(force.energy(&[0.5; 4]), Some(energy));
    let saved = force.save().unwrap();
    assert!(saved.contains(&CORRECT));
    let force = part.nonlinear_mut().unwrap();
    force.commit(&[0.0; 4]);
    assert_eq!(force.restore(&saved), Err(refusal()));
}

fn all() -> BTreeSet<String> {
    let mut all = linear();
    all.extend(methods(
        source!("../crates/structures/src/structure/nonlinear.rs"),
        "NonlinearForce",
    ));
    all
}

fn linear() -> BTreeSet<String> {
    methods(source!("../crates/structures/src/structure/mod.rs"), "Structure")
}

fn double(log: &Log) -> Double {
    Double { log: log.clone(), linear: false }
}

#[test]
fn boxed_structures() {
    let log = Log::default();
    let part: Box<dyn Structure> = Box::new(double(&log));
    ask(part, 0, 3.0 * CORRECT);
    assert_eq!(log.take(), all());
    // A box in a box.
    let part: Box<dyn Structure> = Box::new(double(&log));
    ask(Box::new(part), 0, 3.0 * CORRECT);
    assert_eq!(log.take(), all());
}

#[test]
fn structures_with_something_around_them() {
    let log = Log::default();
    ask(WithSprings::new(double(&log)), 0, 3.0 * CORRECT);
    assert_eq!(log.take(), all());

    let damped = ModalDamping::new(&[0.5]).unwrap().on(double(&log)).unwrap();
    log.take();
    // 2 ζ ω m more, with ω² = 6, stiffness and first tangent over mass; at a degree of freedom outside the base, since
    // a motion of the base alone counts as rigid.
    ask(damped, 2, CORRECT * (3.0 + 6.0_f64.sqrt()));
    assert_eq!(log.take(), all());

    ask(StructureGroup::new().with(double(&log), 0.0).unwrap(), 0, 3.0 * CORRECT);
    assert_eq!(log.take(), all());
}

/// Properties that a reduction keeps of a linear structure, the only kind that it accepts.
#[test]
fn reduced_structures() {
    let log = Log::default();
    let full = Double { log: log.clone(), linear: true };
    let reduced = CraigBampton::new(2).reduce(full).unwrap();
    ask(reduced, 0, 3.0 * CORRECT);
    assert_eq!(log.take(), linear());
}
