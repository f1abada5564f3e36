//! GOAL: an error names the part at fault by name, place and value, for every numbering of the degrees of freedom.
//! SCENE: loads that a coarse base cannot carry, friction that changes, bonds that break, mechanisms, motions without
//! inertia, loads that are NaN, an unknown mode of a law.
//! REFERENCE: resultants by hand, the same scene in other numberings, the wrong number.

use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::interface::{
    Bonded, Cohesive, Coulomb, InPlane, Mode, PreviousContact, VariableFriction,
};
use basemat::structure::{Base, BaseNode, RigidBlock, Structure, Triplets};
use basemat::{Result, Simulation};

use super::{NOT_FINITE, error_with, soil};
use basemat_problems::random::Random;
use basemat_problems::wrapped::LawWithNextMode;

const BLOCK_WIDTH: f64 = 4.0;
/// Weight of the block, N/m.
const BLOCK_WEIGHT: f64 = 4.0 * 6.0 * 2000.0 * 9.81;

pub(super) fn block() -> RigidBlock {
    RigidBlock::new(BLOCK_WIDTH, 6.0, 2000.0).unwrap()
}

fn block_on_soil(elements: usize, graded: bool) -> SimulationBuilder {
    let half = 0.5 * BLOCK_WIDTH;
    let strip = if graded { Strip::graded } else { Strip::uniform };
    let ground = ElasticGround::new(soil(), strip(-half..half, elements).unwrap()).unwrap();
    Simulation::builder(1e-3).structure(block()).ground(ground).gravity(9.81)
}

/// Checks that the error of a scene contains all these words.
#[track_caller]
fn assert_build_error(words: &[&str], builder: SimulationBuilder) {
    let Err(error) = builder.build() else { panic!("accepted: {words:?}") };
    let message = error.to_string();
    for expected in words {
        assert!(message.contains(expected), "'{expected}' is not in '{message}'");
    }
}

/// A horizontal load on the block at this height (m), as a ratio of its weight.
fn push(height: f64, weight_ratio: f64) -> Load {
    Load::constant(block().horizontal_at(height), weight_ratio * BLOCK_WEIGHT)
}

/// Constant tractions can balance a resultant up to the middle of the outermost element.
#[test]
fn a_resultant_beyond_the_last_middle_is_named_with_its_place() {
    // The middle of the outermost element is at this ratio of half the width.
    for (elements, graded, outer_middle) in
        [(2, false, 0.5), (8, false, 0.875), (8, true, 0.961_939_8)]
    {
        let with_resultant_at = |ratio: f64| {
            let moment = ratio * 0.5 * BLOCK_WIDTH * BLOCK_WEIGHT;
            let push = Load::constant(block().horizontal_at(6.0), moment / 6.0);
            block_on_soil(elements, graded).interface(Coulomb::new(2.0).unwrap()).load(push)
        };
        with_resultant_at(0.99 * outer_middle).build().unwrap();
        let range = format!("x = -{:.4}", 0.5 * BLOCK_WIDTH * outer_middle);
        let ratio = 1.005 * outer_middle;
        let place = format!("passes at x = {:.4}", 0.5 * BLOCK_WIDTH * ratio);
        let words = [&place[..], &range, "middles of the outer elements"];
        assert_build_error(&words, with_resultant_at(ratio));
        assert_build_error(&["overturn"], with_resultant_at(1.02));
    }
    let law = Coulomb::new(2.0).unwrap();
    let one_element = block_on_soil(1, false).interface(law).load(push(6.0, 0.01));
    let words = ["a base of one element resists no moment", "passes at x = 0.06"];
    assert_build_error(&words, one_element);
}

#[test]
fn loads_that_push_a_base_off_are_named_for_every_law() {
    let variable = || VariableFriction::new(|start| 0.3 + 0.0 * start.slip_rate);
    block_on_soil(8, true).interface(variable()).load(push(0.0, 0.29)).build().unwrap();
    let pushed_block = block_on_soil(8, true).interface(variable()).load(push(0.0, 0.6));
    assert_build_error(&["pushes it off", "2.000 times the friction"], pushed_block);
    // A bond that carries a third of the load, beside the friction that remains.
    let bond = Cohesive::new(1e6, 0.2 * BLOCK_WEIGHT / BLOCK_WIDTH, 0.2).unwrap();
    block_on_soil(8, true).interface(bond).load(push(0.0, 0.1)).build().unwrap();
    let pushed_block = block_on_soil(8, true).interface(bond).load(push(0.0, 0.6));
    let words = ["bond of the interface breaks", "pushes it off", "3.000 times the friction"];
    assert_build_error(&words, pushed_block);
    // A bond that is pulled off.
    let lift = Load::constant(block().vertical_at(0.0), 1.5 * BLOCK_WEIGHT);
    let weak_bond = Cohesive::new(1e3, 1e6, 0.2).unwrap();
    let lifted_block = block_on_soil(8, true).interface(weak_bond).load(lift);
    assert_build_error(&["bond of the interface breaks", "lift it"], lifted_block);
}

#[test]
fn a_friction_coefficient_below_zero_is_named() {
    for value in [-0.1, f64::NAN] {
        let law =
            VariableFriction::new(move |start| if start.slip_rate == 0.0 { value } else { 0.2 });
        let result_of_build = block_on_soil(8, true).interface(law).build();
        let result = result_of_build.and_then(|mut simulation| simulation.step().map(drop));
        let Err(error) = result else { panic!("{value} was accepted") };
        let message = error.to_string();
        let words = format!("friction coefficient is {value}, but must be zero or more");
        assert!(message.contains(&words) && message.contains("element 0"), "{message}");
    }
}

/// A bonded block under a load of zero and another one.
fn block_under_two_loads(second: Load) -> SimulationBuilder {
    block_on_soil(4, false).interface(Bonded).load(push(0.0, 0.0)).load(second)
}

#[test]
fn loads_that_are_not_finite_are_named_with_number_and_value() {
    for value in NOT_FINITE {
        let entry = format!("entry 1 is {value}");
        let at_start = Load::new(block().horizontal_at(3.0), move |_| value);
        let words = ["external load at t = 0", &entry];
        assert_build_error(&words, block_under_two_loads(at_start));
        let later_load =
            Load::new(block().horizontal_at(3.0), move |t| if t > 0.0032 { value } else { 0.0 });
        let mut simulation = block_under_two_loads(later_load).build().unwrap();
        let error = error_with("external load", simulation.run(10, |_| {}));
        assert!(error.to_string().contains(&entry), "{error}");
    }
}

/// A spring: its elongation as a sum over degrees of freedom, and its stiffness.
#[derive(Clone)]
struct FrameSpring {
    elongation: Vec<(usize, f64)>,
    stiffness: f64,
}

/// Springs and masses on a rigid base.
///
/// Before renumbering, degrees of freedom 0 to 2 are the base's motion to the right, up and its rotation.
#[derive(Clone)]
struct NumberedFrame {
    springs: Vec<FrameSpring>,
    masses: Vec<f64>,
    /// The number of each degree of freedom.
    dof_numbers: Vec<usize>,
}

impl NumberedFrame {
    fn new(springs: Vec<FrameSpring>, masses: Vec<f64>) -> Self {
        Self { springs, dof_numbers: (0..masses.len()).collect(), masses }
    }

    /// The same frame in a random numbering.
    fn renumbered(&self, random: &mut Random) -> Self {
        let mut dof_numbers = self.dof_numbers.clone();
        for last_dof in (1..dof_numbers.len()).rev() {
            let other_dof = random.pick(&(0..=last_dof).collect::<Vec<_>>());
            dof_numbers.swap(last_dof, other_dof);
        }
        Self { dof_numbers, ..self.clone() }
    }

    fn scene(&self) -> SimulationBuilder {
        let ground = SpringGround::new(-2.0..2.0, 4, 1e8, 1e8).unwrap();
        Simulation::builder(1e-3).structure(self.clone()).ground(ground)
    }
}

impl Structure for NumberedFrame {
    fn dofs(&self) -> usize {
        self.masses.len()
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2].map(|dof| self.dof_numbers[dof])).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        for (mass, number) in self.masses.iter().zip(&self.dof_numbers) {
            matrix.add(*number, *number, *mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        for FrameSpring { elongation, stiffness } in &self.springs {
            let row: Vec<_> =
                elongation.iter().map(|&(dof, weight)| (self.dof_numbers[dof], weight)).collect();
            matrix.add_outer(&row, *stiffness);
        }
        Ok(())
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        let mut original_dofs: Vec<usize> = dofs
            .iter()
            .filter_map(|dof| self.dof_numbers.iter().position(|number| number == dof))
            .collect();
        original_dofs.sort_unstable();
        Some(format!("{original_dofs:?}"))
    }
}

/// A bar in this direction between two points, each with degrees of freedom to the right and up.
fn bar(from: [usize; 2], to: [usize; 2], direction: [f64; 2], stiffness: f64) -> FrameSpring {
    let length = direction[0].hypot(direction[1]);
    let [x, y] = direction.map(|component| component / length);
    let elongation = vec![(from[0], -x), (from[1], -y), (to[0], x), (to[1], y)];
    FrameSpring { elongation, stiffness }
}

/// Pendulums, side by side and one on another, are mechanisms: their masses are free to move across the bars.
#[test]
fn mechanisms_are_the_same_in_any_numbering() {
    let mut random = Random(11);
    let base = [0, 1];
    for (bars, expected) in [
        (vec![bar(base, [3, 4], [0.4, 3.1], 1.3e9)], "[3, 4]"),
        (
            vec![bar(base, [3, 4], [0.4, 3.1], 1.3e9), bar([3, 4], [5, 6], [0.3, 2.2], 0.7e7)],
            "[3, 4, 5, 6]",
        ),
        (
            vec![bar(base, [3, 4], [0.7, 3.1], 1.3e9), bar(base, [5, 6], [-0.9, 2.2], 0.7e7)],
            "[3, 4, 5, 6]",
        ),
    ] {
        let dofs = 3 + 2 * bars.len();
        let masses = (0..dofs).map(|i| 1.7e4 * (1.0 + 0.3 * i as f64)).collect();
        let frame = NumberedFrame::new(bars, masses);
        let place = format!("nothing resists a motion of {expected}");
        let words = ["the structure is a mechanism", &place];
        for _ in 0..1200 {
            let frame = frame.renumbered(&mut random);
            let with_friction = frame.scene().interface(Coulomb::new(0.5).unwrap());
            assert_build_error(&words, with_friction);
            assert_build_error(&words, frame.scene().interface(Bonded).gravity(0.0));
        }
    }
}

/// A storey on a rigid base without mass, whose vertical motion and rotation are undetermined.
#[test]
fn a_base_without_mass_is_named() {
    let storey = FrameSpring { elongation: vec![(0, -1.0), (3, 1.0)], stiffness: 1e7 };
    let frame = NumberedFrame::new(vec![storey], vec![0.0, 0.0, 0.0, 2e4]);
    let words = ["nothing resists a motion of [1, 2]", "neither stiffness nor damping nor mass"];
    for gravity in [0.0, 9.81] {
        let scene = frame.scene().gravity(gravity);
        assert_build_error(&words, scene.interface(Bonded));
        let scene = frame.scene().gravity(gravity);
        assert_build_error(&words, scene.interface(Coulomb::new(0.5).unwrap()));
    }
}

#[test]
fn a_mode_that_the_law_does_not_have_is_named() {
    let law = InPlane(LawWithNextMode {
        law: Coulomb::new(0.5).unwrap(),
        next: |mode: Mode, _: &PreviousContact, _: Mode| match mode {
            Mode::Stick => Mode::Yield,
            _ => mode,
        },
    });
    let mut simulation = block_on_soil(4, false).interface(law).gravity(0.0).build().unwrap();
    let error = error_with("interface law of element 0, mode stick", simulation.step().map(drop));
    let words = "there is no next mode in the law's `modes` 'yield', only stick";
    assert!(error.to_string().contains(words), "{error}");
}
