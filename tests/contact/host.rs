//! GOAL: another program can solve the contact problem of its time steps with the crate.
//! SCENE: a mass on a column on a rigid base, on springs with dashpots, sliding and uplifting under El Centro; central
//! differences by hand.
//! REFERENCE: the same structure in a `Simulation`, by the midpoint rule; errors by their type.

use basemat::bem::{Ground, SpringGround};
use basemat::contact::ContactProblem;
use basemat::interface::{ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{Base, BaseNode, Structure, Triplets};
use basemat::{Error, Simulation, unobserved};

use basemat_problems::laws_with_memory::{BreakingBond, SlipWeakening};

const TIME_STEP: f64 = 1e-3;
const RUN_STEPS: usize = 4000;
/// Masses and inertia of the degrees of freedom: base to the right, base up, rotation, mass to the right.
const DOF_MASSES: [f64; 4] = [10.0e3, 30.0e3, 40.0e3, 20.0e3];
const COLUMN_STIFFNESS: f64 = 4.0e6;
const COLUMN_HEIGHT: f64 = 6.0;
/// Width of a contact element, m.
const ELEMENT_LENGTH: f64 = 0.5;

/// A mass on a column on a rigid base.
struct MassOnColumn;

impl Structure for MassOnColumn {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        DOF_MASSES.into_iter().enumerate().for_each(|(i, mass)| matrix.add(i, i, mass));
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer([(3, 1.0), (0, -1.0), (2, COLUMN_HEIGHT)], COLUMN_STIFFNESS);
        Ok(())
    }
}

fn ground() -> SpringGround {
    let springs = SpringGround::new(-2.0..2.0, 8, 2e7, 1.5e7).unwrap();
    springs.with_dashpots(4e5, 3e5).unwrap()
}

fn law() -> Coulomb {
    Coulomb::new(0.15).unwrap()
}

/// Base shear, uplifted fraction and mean slip at the end of a step.
type StepResult = [f64; 3];

fn results_of_simulation() -> Vec<StepResult> {
    let builder = Simulation::builder(TIME_STEP).structure(MassOnColumn).ground(ground());
    let mut simulation = builder.interface(law()).motion(el_centro_1940()).build().unwrap();
    let mut results = Vec::new();
    simulation
        .run(RUN_STEPS, |state| {
            results.push([state.base_shear, state.uplifted_fraction, state.mean_slip]);
        })
        .unwrap();
    results
}

/// Displacements of the contact elements: down, then to the right.
fn base_displacement(centers: &[f64], u: &[f64; 4]) -> Vec<f64> {
    let downward_displacements = centers.iter().map(|x| -(u[1] + x * u[2]));
    downward_displacements.chain(centers.iter().map(|_| u[0])).collect()
}

/// Acceleration of the structure under tractions: pressures, then shear tractions.
fn acceleration(centers: &[f64], u: &[f64; 4], traction: &[f64]) -> [f64; 4] {
    let column_force = COLUMN_STIFFNESS * (u[3] - u[0] + COLUMN_HEIGHT * u[2]);
    let mut force = [column_force, 0.0, -COLUMN_HEIGHT * column_force, -column_force];
    for (e, x) in centers.iter().enumerate() {
        force[0] -= ELEMENT_LENGTH * traction[centers.len() + e];
        force[1] += ELEMENT_LENGTH * traction[e];
        force[2] += x * ELEMENT_LENGTH * traction[e];
    }
    std::array::from_fn(|i| force[i] / DOF_MASSES[i])
}

/// Jumps at the end of a step by unit tractions: of the ground, and of the structure by central differences.
fn delassus_operator(ground: &SpringGround, centers: &[f64]) -> Vec<f64> {
    let size = 2 * centers.len();
    let mut matrix = vec![0.0; size * size];
    ground.step_compliance(&mut matrix).unwrap();
    for column in 0..size {
        let mut unit = vec![0.0; size];
        unit[column] = 1.0;
        let displacement =
            acceleration(centers, &[0.0; 4], &unit).map(|a| TIME_STEP * TIME_STEP * a);
        for (row, value) in base_displacement(centers, &displacement).into_iter().enumerate() {
            matrix[row * size + column] -= value;
        }
    }
    matrix
}

/// Mean of a quantity over the contact elements.
fn mean(states: &[ContactState], quantity: fn(&ContactState) -> f64) -> f64 {
    states.iter().map(quantity).sum::<f64>() / states.len() as f64
}

/// Results of central differences by hand.
fn results_by_hand() -> Vec<StepResult> {
    let mut ground = ground();
    let motion = el_centro_1940();
    let centers: Vec<f64> = ground.elements().iter().map(|element| element.center()[0]).collect();
    let count = centers.len();
    let size = 2 * count;
    ground.prepare(TIME_STEP, None, &mut unobserved).unwrap();
    let pressure = STANDARD_GRAVITY * DOF_MASSES[1] / 4.0;
    let mut static_tractions = vec![0.0; size];
    static_tractions[..count].fill(pressure);
    let laws: Vec<Box<dyn InterfaceLaw>> = vec![Box::new(law())];
    let problem = ContactProblem::new(delassus_operator(&ground, &centers), laws).unwrap();
    let mut problem = problem.with_static_tractions(static_tractions).unwrap();
    let pressed_element = ContactState { pressure, ..ContactState::default() };
    let element = PreviousContact::new(pressed_element, Mode::Stick, TIME_STEP);
    let mut start = problem.start(&vec![element; count]).unwrap();
    let mut previous_displacement = [0.0; 4];
    let mut current = [0.0; 4];
    let mut history = vec![0.0; size];
    let mut free_field = vec![0.0; size];
    let mut results = Vec::new();
    for step in 1..=RUN_STEPS {
        ground.history(&mut history).unwrap();
        ground.free_field(&motion, step as f64 * TIME_STEP, &mut free_field);
        let free = acceleration(&centers, &current, &vec![0.0; size]);
        let mut next_displacement: [f64; 4] = std::array::from_fn(|i| {
            2.0 * current[i] - previous_displacement[i] + TIME_STEP * TIME_STEP * free[i]
        });
        let base = base_displacement(&centers, &next_displacement);
        let jump: Vec<f64> = (0..size).map(|i| free_field[i] + history[i] - base[i]).collect();
        let solution = problem.solve(&jump, &start).unwrap();
        let by_contact = acceleration(&centers, &[0.0; 4], solution.traction);
        next_displacement
            .iter_mut()
            .zip(by_contact)
            .for_each(|(u, a)| *u += TIME_STEP * TIME_STEP * a);
        ground.commit(solution.traction);
        let open_count = solution.modes.iter().filter(|mode| !mode.is_closed()).count();
        let shear = 4.0 * mean(solution.states, |state| state.shear);
        let slip = mean(solution.states, |state| state.slip);
        results.push([shear, open_count as f64 / count as f64, slip]);
        solution.commit(&mut start).unwrap();
        previous_displacement = current;
        current = next_displacement;
    }
    results
}

fn largest(results: &[StepResult], quantity: usize) -> f64 {
    results.iter().fold(0.0_f64, |largest, result| largest.max(result[quantity].abs()))
}

#[test]
fn central_differences_by_hand_follow_the_simulation() {
    let computed = results_by_hand();
    let expected = results_of_simulation();
    assert!(largest(&expected, 1) > 0.2, "it uplifts");
    assert!(largest(&expected, 2) > 1e-3, "it slides");
    for (quantity, tolerance) in [(0, 0.02), (2, 0.05)] {
        let mut squared_difference = 0.0;
        let mut squared_scale = 0.0;
        for (a, b) in computed.iter().zip(&expected) {
            squared_difference += (a[quantity] - b[quantity]).powi(2);
            squared_scale += b[quantity].powi(2);
        }
        let difference = (squared_difference / squared_scale).sqrt();
        let peak = largest(&expected, quantity);
        println!("quantity {quantity}: difference {difference:.1e}, peak {peak:.3e}");
        assert!(difference < tolerance, "quantity {quantity}: {difference:.1e}");
    }
}

const UNIT_MATRIX: [f64; 4] = [1.0, 0.0, 0.0, 1.0];

fn problem_with_matrix(matrix: Vec<f64>) -> basemat::Result<ContactProblem> {
    ContactProblem::new(matrix, vec![Box::new(law())])
}

fn unit_problem() -> ContactProblem {
    problem_with_matrix(UNIT_MATRIX.to_vec()).unwrap()
}

/// An element at rest without tractions.
fn element_at_rest() -> PreviousContact<'static> {
    PreviousContact::new(ContactState::default(), Mode::Stick, TIME_STEP)
}

#[test]
fn invalid_problems_are_errors() {
    for size in [0, 1, 3, 5, 9, 15] {
        let result = problem_with_matrix(vec![1.0; size]);
        assert!(matches!(result, Err(Error::Size { .. })), "{size}");
    }
    let without_laws = ContactProblem::new(UNIT_MATRIX.to_vec(), Vec::new());
    assert!(matches!(without_laws, Err(Error::Size { .. })));
    for value in [f64::NAN, f64::INFINITY] {
        let result = problem_with_matrix(vec![1.0, value, 0.0, 1.0]);
        assert!(matches!(result, Err(Error::Input { .. })));
    }
    let result = unit_problem().with_static_tractions(vec![1.0]);
    assert!(matches!(result, Err(Error::Size { .. })));
}

#[test]
fn invalid_starts_and_steps_are_errors() {
    let mut problem = unit_problem();
    let start = problem.start(&[element_at_rest()]).unwrap();
    assert!(matches!(problem.solve(&[0.0], &start), Err(Error::Size { .. })));
    for elements in [vec![], vec![element_at_rest(); 2]] {
        assert!(matches!(problem.start(&elements), Err(Error::Size { .. })));
    }
    for time_step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut element = element_at_rest();
        element.time_step = time_step;
        assert!(matches!(problem.start(&[element]), Err(Error::Input { .. })));
    }
    let mut with_state_variable = element_at_rest();
    with_state_variable.state_variables = &[1.0];
    // Coulomb's law has no state variables.
    assert!(matches!(problem.start(&[with_state_variable]), Err(Error::Size { .. })));
    let two_elements = problem_with_matrix(vec![1.0; 16]).unwrap();
    let other_start = two_elements.start(&[element_at_rest(); 2]).unwrap();
    assert!(matches!(problem.solve(&[0.0; 2], &other_start), Err(Error::Size { .. })));
    assert!(matches!(problem.solve(&[f64::NAN, 0.0], &start), Err(Error::Input { .. })));
    assert!(matches!(problem.set_delassus(&[1.0]), Err(Error::Size { .. })));
}

#[test]
fn another_operator_acts_from_the_next_step_on() {
    let mut problem = unit_problem();
    let start = problem.start(&[element_at_rest()]).unwrap();
    let pressure_on_stiff_ground = problem.solve(&[-1.0, 0.0], &start).unwrap().traction[0];
    problem.set_delassus(&[2.0, 0.0, 0.0, 2.0]).unwrap();
    let pressure_on_soft_ground = problem.solve(&[-1.0, 0.0], &start).unwrap().traction[0];
    assert!(
        (pressure_on_stiff_ground - 1.0).abs() < 1e-12
            && (pressure_on_soft_ground - 0.5).abs() < 1e-12
    );
}

/// One element with a compliance of 1e-7 m/Pa in both directions.
fn compliant_problem(law: impl InterfaceLaw + 'static) -> ContactProblem {
    ContactProblem::new(vec![1e-7, 0.0, 0.0, 1e-7], vec![Box::new(law)]).unwrap()
}

/// GOAL: a bond in the contact problem of a host breaks once.
/// SCENE: one element without static pressure.
/// REFERENCE: numbers by hand.
#[test]
fn a_bond_in_the_problem_of_a_host_breaks_once() {
    let law = BreakingBond { friction: 0.5, strength: 1e4, breaks_by_sliding: true };
    let mut problem = compliant_problem(law);
    let mut start = problem.start(&[element_at_rest()]).unwrap();
    assert_eq!(start.iter().next().unwrap().state_variables, [1e4, 0.0]);
    assert_eq!(start.iter().count(), 1);
    // Jump without traction, the pressure and shear that follow from it, and the strength afterwards.
    for (jump, [pressure, shear], strength) in [
        // The element is lifted by 0.5 mm; the bond carries 5 kPa of tension.
        ([5e-4, 0.0], [-5e3, 0.0], 1e4),
        // 0.2 mm and 0.3 mm to the right: 3 kPa are less than friction (10 − 2) kPa.
        ([2e-4, -3e-4], [-2e3, 3e3], 1e4),
        // 0.9 mm to the right: 9 kPa are more than 5 kPa, which act in this step.
        ([0.0, -9e-4], [0.0, 5e3], 0.0),
        // The bond is broken: no traction to the side (0.4 mm of slip) or upwards.
        ([0.0, -9e-4], [0.0, 0.0], 0.0),
        ([5e-4, -9e-4], [0.0, 0.0], 0.0),
        // The element is pressed by 1 mm and pushed by 0.8 mm; only friction acts.
        ([-1e-3, -1.7e-3], [1e4, 5e3], 0.0),
    ] {
        let solution = problem.solve(&jump, &start).unwrap();
        let state = solution.states[0];
        assert!((state.pressure - pressure).abs() < 1e-6, "{jump:?}: {state:?}");
        assert!((state.shear - shear).abs() < 1e-6, "{jump:?}: {state:?}");
        solution.commit(&mut start).unwrap();
        assert_eq!(start.iter().next().unwrap().state_variables[0], strength, "{jump:?}");
    }
}

/// GOAL: a step that is not committed changes nothing, and a start can be stored and used again.
#[test]
fn hosts_commit_state_variables() {
    let law = SlipWeakening { first: 0.5, residual: 0.2, distance: 1e-3 };
    let problem = compliant_problem(law);
    let mut problem = problem.with_static_tractions(vec![1e4, 0.0]).unwrap();
    let pressed_element = ContactState { pressure: 1e4, ..ContactState::default() };
    let element = PreviousContact::new(pressed_element, Mode::Stick, TIME_STEP);
    let mut start = problem.start(&[element]).unwrap();
    let mut distance = 0.0_f64;
    for step in 1..=20 {
        let jump = [0.0, -1e-3 * f64::from(step)];
        let initial_start = start.clone();
        // A trial with another jump that is not committed.
        problem.solve(&[0.0, 0.5], &start).unwrap();
        assert_eq!(start, initial_start);
        let solution = problem.solve(&jump, &start).unwrap();
        // Friction depends on the distance slid so far; the remaining jump is slip.
        let shear = 1e4 * (0.2 + 0.3 * (-distance / 1e-3).exp());
        assert!((solution.states[0].shear - shear).abs() < 1e-6);
        distance = -jump[1] - 1e-7 * shear;
        solution.commit(&mut start).unwrap();
        let variable = start.iter().next().unwrap().state_variables[0];
        assert!((variable - distance).abs() < 1e-12);
        // A start that is made of the elements of another start equals it.
        let elements: Vec<PreviousContact> = start.iter().collect();
        let copied_start = problem.start(&elements).unwrap();
        assert_eq!(copied_start, start);
        start = copied_start;
    }
    assert!(distance > 0.01);
}
