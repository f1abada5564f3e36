//! GOAL: numbers of an interface law that are not finite are named by element and mode, with nothing committed.
//! SCENE: one wrong number of one element's law, from the start or once the element has slid; in a simulation and in the
//! contact problem of a host.
//! REFERENCE: the fields of the error, and the state before the step.

use basemat::bem::SpringGround;
use basemat::contact::ContactProblem;
use basemat::coupled::GravityStage;
use basemat::coupled::StepError;
use basemat::interface::LawError;
use basemat::interface::{
    Condition, ContactState, Coulomb, InPlane, InterfaceLaw, Mode, PlaneLaw, PreviousContact,
    Tolerance,
};
use basemat::{Error, Result, Simulation};

use super::NOT_FINITE;
use basemat_problems::scenes::{SI_UNITS, block, scene};

/// The number of a law that is wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
enum WrongNumber {
    /// Number of this index in both conditions of a mode.
    Condition(usize),
    Compliance,
    InitialStateVariable,
    StateVariable,
}

/// Coulomb's law with the distance slid as state variable, and one wrong number.
#[derive(Debug, Clone, Copy)]
struct DefectiveLaw {
    number: Option<WrongNumber>,
    value: f64,
    /// Distance slid from which the number is wrong, m.
    min_distance: f64,
}

fn coulomb() -> Coulomb {
    Coulomb::new(0.2).unwrap()
}

impl DefectiveLaw {
    fn is_wrong(&self, number: WrongNumber, distance: f64) -> bool {
        self.number == Some(number) && distance >= self.min_distance
    }
}

impl PlaneLaw for DefectiveLaw {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let mut pair = coulomb().conditions(mode, start);
        for index in 0..10 {
            if self.is_wrong(WrongNumber::Condition(index), start.state_variables[0]) {
                let Condition { gap, slip, pressure, shear, value } = &mut pair[index / 5];
                *[gap, slip, pressure, shear, value][index % 5] = self.value;
            }
        }
        pair
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        coulomb().next_mode(mode, start, trial, tolerance)
    }

    fn compliance(&self, _: Mode, start: &PreviousContact) -> [f64; 2] {
        let is_wrong = self.is_wrong(WrongNumber::Compliance, start.state_variables[0]);
        [0.0, if is_wrong { self.value } else { 0.0 }]
    }

    fn state_variables(&self) -> usize {
        2
    }

    fn initial_state_variables(&self, _: &PreviousContact, state_variables: &mut [f64]) {
        if self.is_wrong(WrongNumber::InitialStateVariable, f64::INFINITY) {
            state_variables[1] = self.value;
        }
    }

    fn commit(
        &self,
        start: &PreviousContact,
        end: &ContactState,
        _: Mode,
        state_variables: &mut [f64],
    ) {
        state_variables[0] += (end.slip - start.state.slip).abs();
        if self.is_wrong(WrongNumber::StateVariable, state_variables[0]) {
            state_variables[1] = self.value;
        }
    }
}

/// Index of the element whose law is defective.
const DEFECTIVE_ELEMENT: usize = 2;

/// A block on four springs, one of them with a defective law.
fn simulation(law: DefectiveLaw) -> Result<Simulation> {
    let ground = SpringGround::new(-2.0..2.0, 4, 5e7, 4e7)?.with_dashpots(4e5, 3e5)?;
    let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
    for e in 0..4 {
        let number = law.number.filter(|_| e == DEFECTIVE_ELEMENT);
        laws.push(Box::new(InPlane(DefectiveLaw { number, ..law })));
    }
    scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .ground(ground)
        .interfaces(laws)
        .build()
}

/// All numbers of conditions, and the compliance.
fn numbers_of_a_step() -> Vec<WrongNumber> {
    let mut numbers: Vec<WrongNumber> = (0..10).map(WrongNumber::Condition).collect();
    numbers.push(WrongNumber::Compliance);
    numbers
}

/// The quantity by which an error names this number.
fn quantity_of(number: WrongNumber) -> &'static str {
    match number {
        WrongNumber::Condition(index) => [
            "coefficient of the gap",
            "coefficient of the slip",
            "coefficient of the pressure",
            "coefficient of the shear traction",
            "right-hand side of a condition",
        ][index % 5],
        WrongNumber::Compliance => "shear compliance",
        WrongNumber::InitialStateVariable | WrongNumber::StateVariable => "state variable",
    }
}

fn assert_named(error: &LawError, number: WrongNumber, value: f64) {
    let LawError { element, mode, reason } = error;
    let Error::Input { quantity, value: reported, needed: "finite" } = &**reason else {
        panic!("{error:?}")
    };
    assert_eq!((*element, *quantity), (DEFECTIVE_ELEMENT, quantity_of(number)), "{error}");
    assert_eq!(reported.to_bits(), value.to_bits());
    let message = error.to_string();
    let mode = format!("mode {mode}");
    for words in ["element 2", &mode, quantity, &value.to_string()] {
        assert!(message.contains(words), "'{words}' is not in '{message}'");
    }
}

/// Error of the first step that fails, which must change nothing in two attempts.
fn failing_step_error(simulation: &mut Simulation) -> Error {
    loop {
        let state = simulation.state().clone();
        assert!(state.step < 600, "no step fails");
        for e in 0..4 {
            assert!(state.state_variables(e).iter().all(|variable| variable.is_finite()));
        }
        if let Err(error) = simulation.step() {
            assert_eq!(*simulation.state(), state);
            assert!(simulation.step().is_err());
            assert_eq!(*simulation.state(), state);
            return error;
        }
    }
}

#[test]
fn numbers_that_become_wrong_are_named_and_nothing_is_committed() {
    let mut numbers = numbers_of_a_step();
    numbers.push(WrongNumber::StateVariable);
    for number in numbers {
        for value in NOT_FINITE {
            let law = DefectiveLaw { number: Some(number), value, min_distance: 1e-3 };
            let error = failing_step_error(&mut simulation(law).unwrap());
            let Error::Step { step, source: StepError::Law(error), .. } = error else {
                panic!("{number:?} of {value}: {error:?}");
            };
            assert!(step > 10);
            assert_named(&error, number, value);
        }
    }
}

/// A law with a number that is NaN from the start.
fn defective_from_start(number: WrongNumber) -> DefectiveLaw {
    DefectiveLaw { number: Some(number), value: f64::NAN, min_distance: 0.0 }
}

#[test]
fn numbers_that_are_wrong_from_the_start_are_named_by_build() {
    let mut numbers = numbers_of_a_step();
    numbers.push(WrongNumber::InitialStateVariable);
    for number in numbers {
        let Err(Error::Law(error)) = simulation(defective_from_start(number)) else {
            panic!("{number:?}")
        };
        assert_named(&error, number, f64::NAN);
    }
    // While the weight is applied.
    let law = InPlane(defective_from_start(WrongNumber::Condition(0)));
    let ground = SpringGround::new(-2.0..2.0, 1, 5e7, 4e7).unwrap();
    let builder = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).ground(ground).interface(law);
    let Err(Error::Law(error)) = builder.gravity_stage(GravityStage::Frictional).build() else {
        panic!("accepted");
    };
    assert_eq!((error.element, error.mode), (0, "stick"));
    assert!(matches!(*error.reason, Error::Input { needed: "finite", .. }), "{error}");
}

/// A bonded law with this number of state variables.
struct LawWithStateVariables(usize);

impl PlaneLaw for LawWithStateVariables {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, _: Mode, start: &PreviousContact) -> [Condition; 2] {
        [Condition::gap_is(0.0), Condition::slip_is(start.state.slip)]
    }

    fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        Mode::Stick
    }

    fn state_variables(&self) -> usize {
        self.0
    }
}

#[test]
fn more_state_variables_than_memory_holds_are_errors() {
    for count in [268_435_457, usize::MAX / 3, usize::MAX] {
        let builder = scene(SI_UNITS, 0.6)
            .structure(block(SI_UNITS))
            .interface(InPlane(LawWithStateVariables(count)));
        let built_scene = builder.build().map(drop);
        let law = Box::new(InPlane(LawWithStateVariables(count)));
        let problem = ContactProblem::new(vec![1.0, 0.0, 0.0, 1.0], vec![law]).map(drop);
        for result in [built_scene, problem] {
            let Err(Error::Memory(error)) = result else { panic!("{result:?}") };
            assert!(error.quantity.contains("state variables") && error.asked > 1e8, "{error}");
        }
    }
}

/// The contact problem of one element with this law.
fn one_element_problem(law: impl InterfaceLaw + 'static) -> ContactProblem {
    ContactProblem::new(vec![1e-7, 0.0, 0.0, 1e-7], vec![Box::new(law)]).unwrap()
}

/// An element that sticks under a pressure.
fn pressed_element() -> PreviousContact<'static> {
    let state = ContactState { pressure: 1e4, ..ContactState::default() };
    PreviousContact::new(state, Mode::Stick, 0.01)
}

#[test]
fn wrong_numbers_are_named_to_hosts_which_keep_their_start() {
    for number in [WrongNumber::Condition(9), WrongNumber::StateVariable] {
        let problem = one_element_problem(InPlane(defective_from_start(number)));
        let mut problem = problem.with_static_tractions(vec![1e4, 0.0]).unwrap();
        let mut start = problem.start(&[pressed_element()]).unwrap();
        let initial_start = start.clone();
        let result =
            problem.solve(&[0.0, -1e-3], &start).and_then(|solution| solution.commit(&mut start));
        let Err(Error::Step { step: 1, source: StepError::Law(error), .. }) = result else {
            panic!("{number:?}: {result:?}");
        };
        let Error::Input { quantity, needed: "finite", .. } = *error.reason else {
            panic!("{error:?}")
        };
        assert_eq!((error.element, quantity), (0, quantity_of(number)));
        assert_eq!(start, initial_start);
    }
}

#[test]
fn wrong_state_variables_of_a_host_are_errors() {
    let law = InPlane(defective_from_start(WrongNumber::InitialStateVariable));
    let problem = one_element_problem(law);
    assert!(matches!(problem.start(&[pressed_element()]), Err(Error::Law(_))));
    let mut element = pressed_element();
    element.state_variables = &[f64::NAN, 0.0];
    assert!(matches!(problem.start(&[element]), Err(Error::Input { .. })));
    element.state_variables = &[0.0];
    assert!(matches!(problem.start(&[element]), Err(Error::Size { .. })));
}

/// A problem that starts with state variables of another length is an error.
#[test]
fn starts_of_other_problems_are_errors() {
    let other_problem = one_element_problem(coulomb());
    let mut other_start = other_problem.start(&[pressed_element()]).unwrap();
    let valid_law = InPlane(DefectiveLaw { number: None, value: 0.0, min_distance: 0.0 });
    let mut problem = one_element_problem(valid_law);
    assert!(matches!(problem.solve(&[0.0; 2], &other_start), Err(Error::Scene { .. })));
    let start = problem.start(&[pressed_element()]).unwrap();
    let solution = problem.solve(&[0.0; 2], &start).unwrap();
    assert!(matches!(solution.commit(&mut other_start), Err(Error::Scene { .. })));
}
