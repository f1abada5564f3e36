//! GOAL: a number that an interface law returns and that is not finite is named by element and mode,
//! and nothing of its step is committed.
//! SCENE: one number of one element's law spoilt, from the start or once the element has slid; in a
//! simulation and in the contact problem of a host.
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
use basemat::{Error, Simulation};

use super::NOT_FINITE;
use basemat_problems::scenes::{SI, block, scene};

#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    Condition(usize),
    Compliance,
    InitialMemory,
    Memory,
}

/// Coulomb's law that also remembers the distance slid, with one number spoilt beyond `slid`.
#[derive(Debug, Clone, Copy)]
struct Spoilt {
    place: Option<Place>,
    value: f64,
    slid: f64,
}

fn coulomb() -> Coulomb {
    Coulomb::new(0.2).unwrap()
}

impl Spoilt {
    fn breaks(&self, place: Place, slid: f64) -> bool {
        self.place == Some(place) && slid >= self.slid
    }
}

impl PlaneLaw for Spoilt {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let mut pair = coulomb().conditions(mode, start);
        for number in 0..10 {
            if self.breaks(Place::Condition(number), start.state_variables[0]) {
                let Condition { gap, slip, pressure, shear, value } = &mut pair[number / 5];
                *[gap, slip, pressure, shear, value][number % 5] = self.value;
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
        let broken = self.breaks(Place::Compliance, start.state_variables[0]);
        [0.0, if broken { self.value } else { 0.0 }]
    }

    fn state_variables(&self) -> usize {
        2
    }

    fn initial_state_variables(&self, _: &PreviousContact, state_variables: &mut [f64]) {
        if self.breaks(Place::InitialMemory, f64::INFINITY) {
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
        if self.breaks(Place::Memory, state_variables[0]) {
            state_variables[1] = self.value;
        }
    }
}

/// The element whose law is spoilt.
const ELEMENT: usize = 2;

fn simulation(spoilt: Spoilt) -> basemat::Result<Simulation> {
    let law = |e: usize| -> Box<dyn InterfaceLaw> {
        let place = spoilt.place.filter(|_| e == ELEMENT);
        Box::new(InPlane(Spoilt { place, ..spoilt }))
    };
    let ground = SpringGround::new(-2.0..2.0, 4, 5e7, 4e7)?.with_dashpots(4e5, 3e5)?;
    let laws = (0..4).map(law).collect();
    scene(SI, 0.6).structure(block(SI)).ground(ground).interfaces(laws).build()
}

fn places() -> Vec<Place> {
    let mut places: Vec<Place> = (0..10).map(Place::Condition).collect();
    places.extend([Place::Compliance, Place::Memory]);
    places
}

fn expected(place: Place) -> &'static str {
    match place {
        Place::Condition(number) => [
            "coefficient of the gap",
            "coefficient of the slip",
            "coefficient of the pressure",
            "coefficient of the shear traction",
            "right-hand side of a condition",
        ][number % 5],
        Place::Compliance => "shear compliance",
        Place::InitialMemory | Place::Memory => "state variable",
    }
}

fn assert_named(error: &LawError, place: Place, value: f64) {
    let LawError { element, mode, reason } = error;
    let Error::Input { quantity, value: found, needed: "finite" } = &**reason else {
        panic!("{error:?}")
    };
    assert_eq!((*element, *quantity), (ELEMENT, expected(place)), "{error}");
    assert_eq!(found.to_bits(), value.to_bits());
    let message = error.to_string();
    let mode = format!("mode {mode}");
    for part in ["element 2", &mode, quantity, &value.to_string()] {
        assert!(message.contains(part), "'{part}' is not in '{message}'");
    }
}

#[test]
fn numbers_that_break_in_a_step_are_named_and_nothing_is_committed() {
    for place in places() {
        for value in NOT_FINITE {
            let mut simulation =
                simulation(Spoilt { place: Some(place), value, slid: 1e-3 }).unwrap();
            let error = loop {
                let before = simulation.state().clone();
                assert!(before.step < 600, "{place:?} of {value} was accepted");
                let state_variables: Vec<f64> =
                    (0..4).flat_map(|e| simulation.state().state_variables(e).to_vec()).collect();
                assert!(state_variables.iter().all(|number| number.is_finite()));
                if let Err(error) = simulation.step() {
                    assert_eq!(*simulation.state(), before);
                    // Tried again, it fails from the same state.
                    assert!(simulation.step().is_err());
                    assert_eq!(*simulation.state(), before);
                    break error;
                }
            };
            let Error::Step { step, source: StepError::Law(error), .. } = error else {
                panic!("{place:?} of {value}: {error:?}");
            };
            assert!(step > 10);
            assert_named(&error, place, value);
        }
    }
}

#[test]
fn numbers_that_are_broken_from_the_start_are_named_by_build() {
    let mut places = places();
    places.retain(|place| *place != Place::Memory);
    places.push(Place::InitialMemory);
    for place in places {
        let spoilt = Spoilt { place: Some(place), value: f64::NAN, slid: 0.0 };
        let Err(Error::Law(error)) = simulation(spoilt) else { panic!("{place:?}") };
        assert_named(&error, place, f64::NAN);
    }
    // While the weight comes on.
    let spoilt = Spoilt { place: Some(Place::Condition(0)), value: f64::NAN, slid: 0.0 };
    let ground = SpringGround::new(-2.0..2.0, 1, 5e7, 4e7).unwrap();
    let built = scene(SI, 0.6).structure(block(SI)).ground(ground).interface(InPlane(spoilt));
    let Err(Error::Law(error)) = built.gravity_stage(GravityStage::Frictional).build() else {
        panic!("accepted");
    };
    assert_eq!((error.element, error.mode), (0, "stick"));
    assert!(matches!(*error.reason, Error::Input { needed: "finite", .. }), "{error}");
}

/// Remembers as many numbers as it is told to.
struct Memorious(usize);

impl PlaneLaw for Memorious {
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
fn more_numbers_than_memory_holds_are_refused() {
    for many in [268_435_457, usize::MAX / 3, usize::MAX] {
        let builder = scene(SI, 0.6).structure(block(SI)).interface(InPlane(Memorious(many)));
        let built = builder.build().map(drop);
        let host =
            ContactProblem::new(vec![1.0, 0.0, 0.0, 1.0], vec![Box::new(InPlane(Memorious(many)))]);
        for found in [built, host.map(drop)] {
            let Err(Error::Memory(error)) = found else { panic!("{found:?}") };
            assert!(error.quantity.contains("remember") && error.asked > 1e8, "{error}");
        }
    }
}

#[test]
fn hosts_are_told_too_and_keep_their_start() {
    let unit = || vec![1e-7, 0.0, 0.0, 1e-7];
    let pressed = ContactState { pressure: 1e4, ..ContactState::default() };
    let element = PreviousContact::new(pressed, Mode::Stick, 0.01);
    for place in [Place::Condition(9), Place::Memory] {
        let spoilt = Spoilt { place: Some(place), value: f64::NAN, slid: 0.0 };
        let problem = ContactProblem::new(unit(), vec![Box::new(InPlane(spoilt))]).unwrap();
        let mut problem = problem.with_static_tractions(vec![1e4, 0.0]).unwrap();
        let mut start = problem.start(&[element]).unwrap();
        let before = start.clone();
        let done = problem.solve(&[0.0, -1e-3], &start).and_then(|found| found.commit(&mut start));
        let Err(Error::Step { step: 1, source: StepError::Law(error), .. }) = done else {
            panic!("{place:?}: {done:?}");
        };
        let Error::Input { quantity, needed: "finite", .. } = *error.reason else {
            panic!("{error:?}")
        };
        assert_eq!((error.element, quantity), (0, expected(place)));
        assert_eq!(start, before);
    }
    let spoilt = Spoilt { place: Some(Place::InitialMemory), value: f64::NAN, slid: 0.0 };
    let problem = ContactProblem::new(unit(), vec![Box::new(InPlane(spoilt))]).unwrap();
    assert!(matches!(problem.start(&[element]), Err(Error::Law(_))));
    let mut remembers = element;
    remembers.state_variables = &[f64::NAN, 0.0];
    assert!(matches!(problem.start(&[remembers]), Err(Error::Input { .. })));
    remembers.state_variables = &[0.0];
    assert!(matches!(problem.start(&[remembers]), Err(Error::Size { .. })));
    // The start of a problem whose laws remember something else.
    let other = ContactProblem::new(unit(), vec![Box::new(coulomb())]).unwrap();
    let mut other = other.start(&[element]).unwrap();
    let sound = Spoilt { place: None, value: 0.0, slid: 0.0 };
    let mut problem = ContactProblem::new(unit(), vec![Box::new(InPlane(sound))]).unwrap();
    assert!(matches!(problem.solve(&[0.0; 2], &other), Err(Error::Scene { .. })));
    let own = problem.start(&[element]).unwrap();
    let solution = problem.solve(&[0.0; 2], &own).unwrap();
    assert!(matches!(solution.commit(&mut other), Err(Error::Scene { .. })));
}
