//! GOAL: a code with an integrator of its own gets the contact problem of a step from the crate.
//! SCENE: a mass on a column on a rigid base, on springs with dashpots, sliding and uplifting under
//! El Centro; central differences by hand.
//! REFERENCE: the same structure in a `Simulation`, by the midpoint rule; errors by their type.

use basemat::bem::{Ground, SpringGround};
use basemat::contact::ContactProblem;
use basemat::interface::{ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{Base, BaseNode, Structure, Triplets};
use basemat::{Error, Simulation, unobserved};

use basemat_problems::laws_with_memory::{Adhesion, SlipWeakening};

const STEP: f64 = 1e-3;
const STEPS: usize = 4000;
const MASS: [f64; 4] = [10.0e3, 30.0e3, 40.0e3, 20.0e3];
const COLUMN: f64 = 4.0e6;
const HEIGHT: f64 = 6.0;
const FRICTION: f64 = 0.15;

/// Degrees of freedom: base to the right, base up, rotation, mass to the right.
struct Tower;

impl Structure for Tower {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        MASS.into_iter().enumerate().for_each(|(i, mass)| matrix.add(i, i, mass));
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer([(3, 1.0), (0, -1.0), (2, HEIGHT)], COLUMN);
        Ok(())
    }
}

fn ground() -> SpringGround {
    let bed = SpringGround::new(-2.0..2.0, 8, 2e7, 1.5e7).unwrap();
    bed.with_dashpots(4e5, 3e5).unwrap()
}

fn law() -> Coulomb {
    Coulomb::new(FRICTION).unwrap()
}

/// Base shear, uplifted part and mean slip of every step.
fn by_simulation() -> Vec<[f64; 3]> {
    let builder = Simulation::builder(STEP).structure(Tower).ground(ground()).interface(law());
    let mut simulation = builder.motion(el_centro_1940()).build().unwrap();
    let mut seen = Vec::new();
    simulation.run(STEPS, |s| seen.push([s.base_shear, s.uplifted_fraction, s.mean_slip])).unwrap();
    seen
}

fn by_hand() -> Vec<[f64; 3]> {
    let mut ground = ground();
    let motion = el_centro_1940();
    let centers: Vec<f64> = ground.elements().iter().map(|own| own.center()[0]).collect();
    let (count, length) = (centers.len(), 0.5);
    let size = 2 * count;
    let base = |u: &[f64; 4]| -> Vec<f64> {
        let down = centers.iter().map(|x| -(u[1] + x * u[2]));
        down.chain(centers.iter().map(|_| u[0])).collect()
    };
    let acceleration = |u: &[f64; 4], traction: &[f64]| -> [f64; 4] {
        let column = COLUMN * (u[3] - u[0] + HEIGHT * u[2]);
        let mut force = [column, 0.0, -HEIGHT * column, -column];
        for (e, x) in centers.iter().enumerate() {
            force[0] -= length * traction[count + e];
            force[1] += length * traction[e];
            force[2] += x * length * traction[e];
        }
        std::array::from_fn(|i| force[i] / MASS[i])
    };
    ground.prepare(STEP, None, &mut unobserved).unwrap();
    let mut delassus = vec![0.0; size * size];
    ground.step_compliance(&mut delassus).unwrap();
    for column in 0..size {
        let mut unit = vec![0.0; size];
        unit[column] = 1.0;
        let answer = acceleration(&[0.0; 4], &unit).map(|a| STEP * STEP * a);
        for (row, moved) in base(&answer).into_iter().enumerate() {
            delassus[row * size + column] -= moved;
        }
    }
    let pressure = STANDARD_GRAVITY * MASS[1] / 4.0;
    let mut at_rest = vec![0.0; size];
    at_rest[..count].fill(pressure);
    let problem = ContactProblem::new(delassus, vec![Box::new(law())]).unwrap();
    let mut problem = problem.with_static_tractions(at_rest).unwrap();
    let pressed = ContactState { pressure, ..ContactState::default() };
    let mut start =
        problem.start(&vec![PreviousContact::new(pressed, Mode::Stick, STEP); count]).unwrap();
    let (mut before, mut now) = ([0.0; 4], [0.0; 4]);
    let [mut history, mut free_field] = [vec![0.0; size], vec![0.0; size]];
    let mut seen = Vec::new();
    for step in 1..=STEPS {
        ground.history(&mut history).unwrap();
        ground.free_field(&motion, step as f64 * STEP, &mut free_field);
        let free = acceleration(&now, &vec![0.0; size]);
        let mut next: [f64; 4] =
            std::array::from_fn(|i| 2.0 * now[i] - before[i] + STEP * STEP * free[i]);
        let moved = base(&next);
        let jump: Vec<f64> = (0..size).map(|i| free_field[i] + history[i] - moved[i]).collect();
        let solution = problem.solve(&jump, &start).unwrap();
        let pushed = acceleration(&[0.0; 4], solution.traction);
        next.iter_mut().zip(pushed).for_each(|(u, a)| *u += STEP * STEP * a);
        ground.commit(solution.traction);
        let mean = |of: fn(&ContactState) -> f64| {
            solution.states.iter().map(of).sum::<f64>() / count as f64
        };
        let open = solution.modes.iter().filter(|mode| !mode.is_closed()).count();
        seen.push([4.0 * mean(|s| s.shear), open as f64 / count as f64, mean(|s| s.slip)]);
        solution.commit(&mut start).unwrap();
        (before, now) = (now, next);
    }
    seen
}

#[test]
fn central_differences_by_hand_follow_the_simulation() {
    let (own, whole) = (by_hand(), by_simulation());
    let largest = |run: &[[f64; 3]], k: usize| run.iter().fold(0.0_f64, |m, v| m.max(v[k].abs()));
    assert!(largest(&whole, 1) > 0.2 && largest(&whole, 2) > 1e-3, "it uplifts and slides");
    for (k, limit) in [(0, 0.02), (2, 0.05)] {
        let (mut square, mut scale) = (0.0, 0.0);
        for (a, b) in own.iter().zip(&whole) {
            square += (a[k] - b[k]).powi(2);
            scale += b[k].powi(2);
        }
        let apart = (square / scale).sqrt();
        println!("quantity {k}: {apart:.1e} apart, peak {:.3e}", largest(&whole, k));
        assert!(apart < limit, "quantity {k}: {apart:.1e}");
    }
}

#[test]
fn bad_problems_are_errors() {
    let laws = || -> Vec<Box<dyn InterfaceLaw>> { vec![Box::new(law())] };
    for bad in [0, 1, 3, 5, 9, 15] {
        let found = ContactProblem::new(vec![1.0; bad], laws());
        assert!(matches!(found, Err(Error::Size { .. })), "{bad}");
    }
    let unit = || vec![1.0, 0.0, 0.0, 1.0];
    assert!(matches!(ContactProblem::new(unit(), Vec::new()), Err(Error::Size { .. })));
    for bad in [f64::NAN, f64::INFINITY] {
        let found = ContactProblem::new(vec![1.0, bad, 0.0, 1.0], laws());
        assert!(matches!(found, Err(Error::Input { .. })));
    }
    let problem = || ContactProblem::new(unit(), laws()).unwrap();
    assert!(matches!(problem().with_static_tractions(vec![1.0]), Err(Error::Size { .. })));
    let element = PreviousContact::new(ContactState::default(), Mode::Stick, STEP);
    let mut own = problem();
    let start = own.start(&[element]).unwrap();
    assert!(matches!(own.solve(&[0.0], &start), Err(Error::Size { .. })));
    for few_or_many in [vec![], vec![element; 2]] {
        assert!(matches!(own.start(&few_or_many), Err(Error::Size { .. })));
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut element = element;
        element.time_step = bad;
        assert!(matches!(own.start(&[element]), Err(Error::Input { .. })));
    }
    let mut remembers = element;
    remembers.state_variables = &[1.0];
    assert!(
        matches!(own.start(&[remembers]), Err(Error::Size { .. })),
        "Coulomb remembers nothing"
    );
    let wide = vec![1.0; 16];
    let other = ContactProblem::new(wide, laws()).unwrap();
    let other = other.start(&[element; 2]).unwrap();
    assert!(matches!(own.solve(&[0.0; 2], &other), Err(Error::Size { .. })));
    assert!(matches!(own.solve(&[f64::NAN, 0.0], &start), Err(Error::Input { .. })));
    assert!(matches!(own.set_delassus(&[1.0]), Err(Error::Size { .. })));
    // Another operator counts from the next step on.
    let pushed = own.solve(&[-1.0, 0.0], &start).unwrap().traction[0];
    own.set_delassus(&[2.0, 0.0, 0.0, 2.0]).unwrap();
    let softer = own.solve(&[-1.0, 0.0], &start).unwrap().traction[0];
    assert!((pushed - 1.0).abs() < 1e-12 && (softer - 0.5).abs() < 1e-12);
}

/// One element that answers its own tractions alone, by 1e-7 m/Pa both ways, under no pressure.
fn glued(law: Adhesion) -> ContactProblem {
    ContactProblem::new(vec![1e-7, 0.0, 0.0, 1e-7], vec![Box::new(law)]).unwrap()
}

/// GOAL: a host commits the memory of laws, step by step; numbers by hand.
#[test]
fn glue_of_a_host_breaks_once() {
    let law = Adhesion { friction: 0.5, strength: 1e4, breaks_by_sliding: true };
    let mut problem = glued(law);
    let element = PreviousContact::new(ContactState::default(), Mode::Stick, STEP);
    let mut start = problem.start(&[element]).unwrap();
    assert_eq!(start.iter().next().unwrap().state_variables, [1e4, 0.0]);
    assert_eq!(start.iter().count(), 1);
    // Jump without traction, then pressure and shear that follow from it, and the strength left.
    for (jump, [pressure, shear], left) in [
        // Lifted by 0.5 mm: 5 kPa of tension hold.
        ([5e-4, 0.0], [-5e3, 0.0], 1e4),
        // 0.2 mm and 0.3 mm to the right: 3 kPa are less than friction (10 − 2) kPa.
        ([2e-4, -3e-4], [-2e3, 3e3], 1e4),
        // 0.9 mm to the right: 9 kPa are more than 5 kPa, which drag for this step.
        ([0.0, -9e-4], [0.0, 5e3], 0.0),
        // Nothing holds any more, to the side (0.4 mm have slid) or up.
        ([0.0, -9e-4], [0.0, 0.0], 0.0),
        ([5e-4, -9e-4], [0.0, 0.0], 0.0),
        // Pressed again by 1 mm, and pushed by 0.8 mm: friction alone.
        ([-1e-3, -1.7e-3], [1e4, 5e3], 0.0),
    ] {
        let solution = problem.solve(&jump, &start).unwrap();
        let found = [solution.states[0].pressure, solution.states[0].shear];
        for (found, wanted) in found.into_iter().zip([pressure, shear]) {
            assert!((found - wanted).abs() < 1e-6, "{jump:?}: {found}, {wanted} wanted");
        }
        solution.commit(&mut start).unwrap();
        assert_eq!(start.iter().next().unwrap().state_variables[0], left, "{jump:?}");
    }
}

/// GOAL: a step that is not committed leaves nothing behind, and a start can be kept and come back to.
#[test]
fn hosts_own_the_memory() {
    let law = || SlipWeakening { first: 0.5, residual: 0.2, distance: 1e-3 };
    let operator = vec![1e-7, 0.0, 0.0, 1e-7];
    let problem = ContactProblem::new(operator, vec![Box::new(law())]).unwrap();
    let mut problem = problem.with_static_tractions(vec![1e4, 0.0]).unwrap();
    let pressed = ContactState { pressure: 1e4, ..ContactState::default() };
    let mut start = problem.start(&[PreviousContact::new(pressed, Mode::Stick, STEP)]).unwrap();
    let mut slid = 0.0_f64;
    for step in 1..=20 {
        let jump = [0.0, -1e-3 * f64::from(step)];
        let before = start.clone();
        // A trial that is given up: elsewhere, and far.
        problem.solve(&[0.0, 0.5], &start).unwrap();
        assert_eq!(start, before);
        let solution = problem.solve(&jump, &start).unwrap();
        // Friction by the distance slid so far; what it does not hold back slides.
        let shear = 1e4 * (0.2 + 0.3 * (-slid / 1e-3).exp());
        assert!((solution.states[0].shear - shear).abs() < 1e-6);
        slid = -jump[1] - 1e-7 * shear;
        solution.commit(&mut start).unwrap();
        assert!((start.iter().next().unwrap().state_variables[0] - slid).abs() < 1e-12);
        // Taken apart and put together again, it is the same.
        let elements: Vec<PreviousContact> = start.iter().collect();
        let again = problem.start(&elements).unwrap();
        assert_eq!(again, start);
        start = again;
    }
    assert!(slid > 0.01);
}
