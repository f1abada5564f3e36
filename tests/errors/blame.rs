//! GOAL: an error blames the part that is at fault, by name, place and value, however degrees of freedom are
//! numbered.
//! SCENE: loads that a coarse base cannot carry, friction that changes, bonds that break, mechanisms,
//! motions without inertia, numbers that are NaN, grounds and laws of one's own that cannot be right.
//! REFERENCE: resultants by hand, the same scene in other numberings, the number that was given.

use basemat::bem::{ContactElement, ElasticGround, Ground, SpringGround, Strip};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::interface::{
    Bonded, Cohesive, Coulomb, InPlane, Mode, PreviousContact, VariableFriction,
};
use basemat::structure::{
    Base, BaseNode, InternalEnergy, NonlinearForce, RigidBlock, Structure, Triplets,
};
use basemat::{Error, Observer, Result, Simulation};

use super::{NOT_FINITE, error_with, soil};
use basemat_problems::block_on_springs::bed;
use basemat_problems::own_force;
use basemat_problems::random::Random;
use basemat_problems::wrapped::Wayward;

const WIDTH: f64 = 4.0;
const WEIGHT: f64 = 4.0 * 6.0 * 2000.0 * 9.81;

fn block() -> RigidBlock {
    RigidBlock::new(WIDTH, 6.0, 2000.0).unwrap()
}

fn standing(elements: usize, graded: bool) -> SimulationBuilder {
    let half = 0.5 * WIDTH;
    let strip = if graded { Strip::graded } else { Strip::uniform };
    let ground = ElasticGround::new(soil(), strip(-half..half, elements).unwrap()).unwrap();
    Simulation::builder(1e-3).structure(block()).ground(ground).gravity(9.81)
}

#[track_caller]
fn says(parts: &[&str], builder: SimulationBuilder) {
    let Err(error) = builder.build() else { panic!("accepted: {parts:?}") };
    let message = error.to_string();
    for part in parts {
        assert!(message.contains(part), "'{part}' is not in '{message}'");
    }
}

/// Constant tractions carry a resultant up to the middle of the outermost element and no further.
#[test]
fn a_resultant_beyond_the_last_middle_is_said_to_be_there() {
    // Halves of the width at which the last middle is.
    for (elements, graded, reach) in [(2, false, 0.5), (8, false, 0.875), (8, true, 0.961_939_8)] {
        let pushed = |share: f64| {
            let moment = share * 0.5 * WIDTH * WEIGHT;
            let push = Load::constant(block().horizontal_at(6.0), moment / 6.0);
            standing(elements, graded).interface(Coulomb::new(2.0).unwrap()).load(push)
        };
        pushed(0.99 * reach).build().unwrap();
        let last = format!("from x = -{:.4}", 0.5 * WIDTH * reach);
        let resultant = 1.005 * reach;
        let passes = format!("passes at x = {:.4}", 0.5 * WIDTH * resultant);
        says(&[&passes, &last, "middles of the outermost"], pushed(resultant));
        says(&["overturn"], pushed(1.02));
    }
    let push = Load::constant(block().horizontal_at(6.0), 0.01 * WEIGHT);
    let one = standing(1, false).interface(Coulomb::new(2.0).unwrap()).load(push);
    says(&["a base of one element resists no moment", "passes at x = 0.06"], one);
}

#[test]
fn what_pushes_a_base_off_is_named_whatever_the_law() {
    let push = |share: f64| Load::constant(block().horizontal_at(0.0), share * WEIGHT);
    let variable = || VariableFriction::new(|start| 0.3 + 0.0 * start.slip_rate);
    standing(8, true).interface(variable()).load(push(0.29)).build().unwrap();
    let pushed = standing(8, true).interface(variable()).load(push(0.6));
    says(&["pushes it off", "2.000 times the friction"], pushed);
    // A bond that carries a third of what pushes, beside the friction that stays.
    let bond = || Cohesive::new(1e6, 0.2 * WEIGHT / WIDTH, 0.2).unwrap();
    standing(8, true).interface(bond()).load(push(0.1)).build().unwrap();
    let pushed = standing(8, true).interface(bond()).load(push(0.6));
    says(&["bond of the interface breaks", "pushes it off", "3.000 times the friction"], pushed);
    // A bond that is pulled off.
    let up = Load::constant(block().vertical_at(0.0), 1.5 * WEIGHT);
    let pulled = standing(8, true).interface(Cohesive::new(1e3, 1e6, 0.2).unwrap()).load(up);
    says(&["bond of the interface breaks", "lift it"], pulled);
}

#[test]
fn a_friction_coefficient_below_zero_is_named() {
    for bad in [-0.1, f64::NAN] {
        let law =
            VariableFriction::new(move |start| if start.slip_rate == 0.0 { bad } else { 0.2 });
        let value = format!("friction coefficient is {bad}, but must be zero or more");
        let pushed = standing(8, true).interface(law);
        let error = pushed.build().map(|mut simulation| simulation.step().map(drop));
        let message = match error {
            Err(error) | Ok(Err(error)) => error.to_string(),
            Ok(Ok(())) => panic!("{bad} was accepted"),
        };
        assert!(message.contains(&value) && message.contains("element 0"), "{message}");
    }
}

#[test]
fn loads_that_are_not_finite_are_named_with_number_and_value() {
    let quiet = || Load::constant(block().horizontal_at(0.0), 0.0);
    for bad in NOT_FINITE {
        let at_start = Load::new(block().horizontal_at(3.0), move |_| bad);
        let named = format!("entry 1 is {bad}");
        let builder = || standing(4, false).interface(Bonded).load(quiet());
        says(&["external load at t = 0", &named], builder().load(at_start));
        let later =
            Load::new(block().horizontal_at(3.0), move |t| if t > 0.0032 { bad } else { 0.0 });
        let mut simulation = builder().load(later).build().unwrap();
        let error = error_with("external load", simulation.run(10, |_| {}));
        assert!(error.to_string().contains(&named), "{error}");
    }
}

/// Springs and masses on a rigid base: degrees of freedom 0 to 2 are its motion to the right, up and around.
#[derive(Clone)]
struct Frame {
    springs: Vec<(Vec<(usize, f64)>, f64)>,
    masses: Vec<f64>,
    /// The number of each degree of freedom.
    number: Vec<usize>,
}

impl Frame {
    fn new(springs: Vec<(Vec<(usize, f64)>, f64)>, masses: Vec<f64>) -> Self {
        Self { springs, number: (0..masses.len()).collect(), masses }
    }

    fn renumbered(&self, random: &mut Random) -> Self {
        let mut number = self.number.clone();
        for last in (1..number.len()).rev() {
            let other = random.pick(&(0..=last).collect::<Vec<_>>());
            number.swap(last, other);
        }
        Self { number, ..self.clone() }
    }

    fn scene(&self) -> SimulationBuilder {
        let ground = SpringGround::new(-2.0..2.0, 4, 1e8, 1e8).unwrap();
        Simulation::builder(1e-3).structure(self.clone()).ground(ground)
    }
}

impl Structure for Frame {
    fn dofs(&self) -> usize {
        self.masses.len()
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2].map(|unknown| self.number[unknown])).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        for (mass, number) in self.masses.iter().zip(&self.number) {
            matrix.add(*number, *number, *mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        for (row, stiffness) in &self.springs {
            let row: Vec<_> = row.iter().map(|&(i, weight)| (self.number[i], weight)).collect();
            matrix.add_outer(&row, *stiffness);
        }
        Ok(())
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        let own = |number: &usize| self.number.iter().position(|n| n == number);
        let mut own: Vec<usize> = dofs.iter().filter_map(own).collect();
        own.sort_unstable();
        Some(format!("{own:?}"))
    }
}

/// A bar in the direction (x, y) between two points, each with degrees of freedom to the right and up.
fn bar(
    from: [usize; 2],
    to: [usize; 2],
    [x, y]: [f64; 2],
    stiffness: f64,
) -> (Vec<(usize, f64)>, f64) {
    let length = x.hypot(y);
    let [x, y] = [x / length, y / length];
    (vec![(from[0], -x), (from[1], -y), (to[0], x), (to[1], y)], stiffness)
}

/// Two pendulums side by side, and one on another: nothing holds their masses across their bars.
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
        let frame = Frame::new(bars, masses);
        for _ in 0..1200 {
            let frame = frame.renumbered(&mut random);
            let place = format!("nothing resists a motion of {expected}");
            for law in [true, false] {
                let scene = frame.scene();
                let scene = if law {
                    scene.interface(Coulomb::new(0.5).unwrap())
                } else {
                    scene.interface(Bonded).gravity(0.0)
                };
                says(&["the structure is a mechanism", &place], scene);
            }
        }
    }
}

/// A storey on a rigid base without mass: nothing tells how the base moves up or turns.
#[test]
fn a_base_without_mass_is_named() {
    let storey = vec![(vec![(0, -1.0), (3, 1.0)], 1e7)];
    let frame = Frame::new(storey, vec![0.0, 0.0, 0.0, 2e4]);
    for gravity in [0.0, 9.81] {
        let parts =
            ["nothing resists a motion of [1, 2]", "neither stiffness nor damping nor mass"];
        says(&parts, frame.scene().interface(Bonded).gravity(gravity));
        says(&parts, frame.scene().interface(Coulomb::new(0.5).unwrap()).gravity(gravity));
    }
}

/// Sums over many nodes are rounded more often.
#[test]
fn a_base_of_many_nodes_is_accepted() {
    struct Wide(usize);
    impl Structure for Wide {
        fn dofs(&self) -> usize {
            3
        }
        fn base(&self) -> Base {
            let place = |k: usize| 4.0 * k as f64 / (self.0 - 1) as f64 - 2.0;
            let nodes = (0..self.0).map(|k| BaseNode::rigid(place(k), 0.0, [0, 1, 2]));
            nodes.collect::<Vec<_>>().into()
        }
        fn mass(&self, matrix: &mut Triplets) -> Result<()> {
            (0..3).for_each(|i| matrix.add(i, i, 1e4));
            Ok(())
        }
        fn stiffness(&self, _: &mut Triplets) -> Result<()> {
            Ok(())
        }
    }
    let shear = |nodes: usize| {
        let push = Load::constant((0, 1.0), 1e3);
        let builder = Simulation::builder(1e-3).structure(Wide(nodes)).ground(bed(1));
        let mut simulation = builder.interface(Bonded).load(push).build().unwrap();
        simulation.run(10, |_| {}).unwrap();
        simulation.state().contact[0].pressure
    };
    let few = shear(2);
    for many in [20_001, 60_001] {
        assert!((shear(many) / few - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_mode_that_the_law_does_not_have_is_named() {
    let next = |mode: Mode, _: &PreviousContact, _: Mode| match mode {
        Mode::Stick => Mode::Yield,
        _ => mode,
    };
    let law = InPlane(Wayward { law: Coulomb::new(0.5).unwrap(), next });
    let mut simulation = standing(4, false).interface(law).gravity(0.0).build().unwrap();
    let error = error_with("interface law of element 0, mode stick", simulation.step().map(drop));
    let unknown = "there is no next mode in the law's `modes` 'yield', only stick";
    assert!(error.to_string().contains(unknown), "{error}");
}

/// A spring between base and ground level, with known energy or without.
struct Told(f64);

impl Structure for Told {
    fn dofs(&self) -> usize {
        4
    }
    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }
    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        (0..4).for_each(|i| matrix.add(i, i, 1e4));
        Ok(())
    }
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        matrix.add_outer([(0, -1.0), (3, 1.0)], 1e6);
        Ok(())
    }
    own_force!();
}

impl NonlinearForce for Told {
    fn force(&self, _: &[f64], _: &mut [f64]) -> Result<()> {
        Ok(())
    }
    fn tangent(&self, _: &[f64], _: &mut Triplets) -> Result<()> {
        Ok(())
    }
    fn energy(&self, _: &[f64]) -> Option<InternalEnergy> {
        Some(InternalEnergy { stored: self.0, dissipated: 0.0 })
    }
}

#[test]
fn an_energy_that_is_not_finite_at_the_start_is_no_energy_left_out() {
    let built = |energy: f64| {
        let builder = Simulation::builder(1e-3).structure(Told(energy)).ground(bed(4));
        builder.interface(Bonded).build()
    };
    built(0.0).unwrap();
    for bad in NOT_FINITE {
        let error = error_with("stores at t = 0", built(bad));
        assert!(matches!(error, Error::Input { value, .. } if value.to_bits() == bad.to_bits()));
    }
}

/// A ground without memory that answers with any matrix.
struct Answering(Vec<ContactElement>, Vec<f64>);

impl Ground for Answering {
    fn elements(&self) -> &[ContactElement] {
        &self.0
    }
    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        Ok(())
    }
    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        matrix.copy_from_slice(&self.1);
        Ok(())
    }
    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.fill(0.0);
        Ok(())
    }
    fn commit(&mut self, _: &[f64]) {}
    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        (0..16).for_each(|k| matrix[k] = if k % 5 == 0 { 1e-8 } else { 0.0 });
        Ok(())
    }
}

#[test]
fn a_ground_that_pushes_back_is_blamed_itself() {
    let built = |own: f64, between: f64, sense: f64| {
        let elements = vec![ContactElement::new(-2.0, 1.0), ContactElement::new(1.0, 2.0)];
        let mut matrix = vec![0.0; 16];
        (0..4).for_each(|i| matrix[5 * i] = own / elements[i % 2].length());
        // Reciprocal: lengths times the entries are symmetric.
        matrix[1] = between / elements[0].length();
        matrix[4] = sense * between / elements[1].length();
        let builder = Simulation::builder(1e-3).structure(block()).interface(Bonded);
        builder.ground(Answering(elements, matrix)).build()
    };
    // At its limit; and coupled far beyond it, but by what does no work.
    for (own, between, sense) in [(1e-8, 1e-8, 1.0), (1e-8, 3e-8, -1.0)] {
        built(own, between, sense).unwrap();
    }
    for (own, between) in [(-1e-8, 0.0), (1e-8, 1.01e-8), (0.0, 1e-8)] {
        let error = error_with("instantaneous operator of the ground", built(own, between, 1.0));
        assert!(matches!(error, Error::Indefinite { row: 0..=1, .. }), "{error:?}");
    }
}
