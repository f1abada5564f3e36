//! Blocks that lift off and slide in all directions on elastic ground.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use basemat::bem::layered::Stages;
use basemat::bem::{ContactElement, ElasticGround, SharedKernels};
use basemat::coupled::{EnergyBalance, State, Warning};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::interface::{ContactState, Coulomb, Mode};
use basemat::motion::FreeField;
use basemat::results::Run;
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};

/// Gravity in the units of these scenes, with a soil of modulus and density 1.
const SMALL_GRAVITY: f64 = 1e-3;

/// A block of 2 × 2 × 4 of this density.
fn slender_block(density: f64) -> RigidBody {
    RigidBody::cuboid([2.0, 2.0, 4.0], density).unwrap()
}

fn unit_soil() -> Soil {
    Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap()
}

/// Ricker's wavelet (1 − 2u) e^−u, u = (π f (t − t₀))².
fn ricker(frequency: f64, peak_time: f64, time: f64) -> f64 {
    let u = (PI * frequency * (time - peak_time)).powi(2);
    (1.0 - 2.0 * u) * (-u).exp()
}

/// Amplitude of a wavelet with this acceleration, in g.
fn ricker_amplitude(acceleration: f64, frequency: f64) -> f64 {
    acceleration * SMALL_GRAVITY / (6.0 * (PI * frequency).powi(2))
}

/// The table's motion. It begins with a jump, since the surface is at rest at t = 0.
struct TriaxialRicker;

impl FreeField for TriaxialRicker {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in space needs three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        if time == 0.0 {
            return [0.0; 3];
        }
        let x = ricker_amplitude(1.5, 0.06) * ricker(0.06, 14.0, time);
        let y = ricker_amplitude(1.05 / 0.8_f64.powi(2), 0.06) * ricker(0.048, 17.0, time);
        let down = ricker_amplitude(0.45 / 1.7_f64.powi(2), 0.06) * ricker(0.102, 13.0, time);
        // The table's y points towards the reader, its z down.
        [x, -y, -down]
    }
}

/// Ricker's wavelet along a direction (x, y).
struct DirectedRicker([f64; 2]);

impl FreeField for DirectedRicker {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in space needs three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        let motion = ricker_amplitude(1.8, 0.06) * ricker(0.06, 14.0, time);
        [self.0[0] * motion, self.0[1] * motion, 0.0]
    }
}

/// A slender block on a homogeneous half-space.
fn block_scene(cells: usize, motion: impl FreeField + 'static) -> Simulation {
    let body = slender_block(1.0);
    let ground = ElasticGround::under(unit_soil(), &body, cells).unwrap().with_stages(Stages::Two);
    Simulation::builder(0.1)
        .structure(body)
        .ground(ground)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(motion)
        .gravity(SMALL_GRAVITY)
        .expected_steps(300)
        .build()
        .unwrap()
}

fn open_elements(state: &State) -> usize {
    state.modes.iter().filter(|mode| **mode == Mode::Open).count()
}

/// Work of friction in the elements over a run.
struct FrictionWork {
    areas: Vec<f64>,
    previous_contact: Vec<ContactState>,
    total: f64,
    /// Smallest work of an element in a step.
    min_work: f64,
}

impl FrictionWork {
    fn new(simulation: &Simulation) -> Self {
        let elements = simulation.ground().elements().iter();
        Self {
            areas: elements.map(ContactElement::area).collect(),
            previous_contact: simulation.state().contact.clone(),
            total: 0.0,
            min_work: 0.0,
        }
    }

    fn add(&mut self, contact: &[ContactState]) {
        for ((end, start), area) in contact.iter().zip(&self.previous_contact).zip(&self.areas) {
            let along = end.shear * (end.slip - start.slip);
            let work = area * (along + end.shear_across * (end.slip_across - start.slip_across));
            self.total += work;
            self.min_work = self.min_work.min(work);
        }
        self.previous_contact.copy_from_slice(contact);
    }
}

/// `uplift_biaxial.csv`, written by another program: down, x, y, rotations, open part, work on the soil, friction work.
#[test]
fn a_block_that_lifts_and_slides_follows_the_table() {
    let table = include_str!("../data/plan/uplift_biaxial.csv");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|number| number.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 300);
    for (cells, tolerances) in
        [(16, [1e-5; 9]), (8, [2e-2, 1e-2, 1e-2, 1e-2, 1e-2, 2e-2, 3e-2, 1e-2, 1e-2])]
    {
        let mut simulation = block_scene(cells, TriaxialRicker);
        let mut friction = FrictionWork::new(&simulation);
        let mat_area = friction.areas.iter().sum::<f64>();
        assert!((mat_area - 4.0).abs() < 1e-12, "{mat_area}");
        let mut error_squares = [0.0; 9];
        let mut expected_squares = [0.0; 9];
        let mut remaining_rows = rows.iter();
        let mut iterations = 0;
        let mut max_residual = 0.0_f64;
        let run = simulation.run(300, |state| {
            let u = state.absolute_displacement();
            let energy = &state.energy_balance;
            friction.add(&state.contact);
            let open_fraction = open_elements(state) as f64 / friction.areas.len() as f64;
            assert!((open_fraction - state.uplifted_fraction).abs() < 0.05);
            let computed = [
                -u[2],
                u[0],
                -u[1],
                u[3],
                -u[4],
                -u[5],
                open_fraction,
                energy.soil,
                friction.total,
            ];
            let expected = &remaining_rows.next().unwrap()[1..];
            for k in 0..9 {
                error_squares[k] += (computed[k] - expected[k]).powi(2);
                expected_squares[k] += expected[k].powi(2);
            }
            iterations += state.trials;
            max_residual = max_residual.max(energy.residual());
        });
        let run = run.unwrap();
        let errors: [f64; 9] =
            std::array::from_fn(|k| f64::sqrt(error_squares[k] / expected_squares[k]));
        println!("{cells}: {errors:?}, {iterations} iterations, {:?}", run.fallbacks);
        assert!(max_residual < 1e-9, "{max_residual:e}");
        let FrictionWork { total, min_work, .. } = friction;
        assert!(min_work > -1e-10 * total, "{min_work:e} of {total:e}");
        for (error, tolerance) in errors.iter().zip(tolerances) {
            assert!(*error < tolerance, "{cells}: {errors:?}");
        }
    }
}

/// Displacements of the block in each step, shaken along a direction.
fn march_along(direction: [f64; 2]) -> Vec<[f64; 6]> {
    let mut simulation = block_scene(8, DirectedRicker(direction));
    let mut displacements: Vec<[f64; 6]> = Vec::new();
    let run = simulation.run(300, |state| {
        displacements.push(state.absolute_displacement().try_into().unwrap());
    });
    assert!(run.unwrap().energy_error < 1e-9);
    displacements
}

/// Largest magnitude of a degree of freedom.
fn peak(displacements: &[[f64; 6]], dof: usize) -> f64 {
    displacements.iter().fold(0.0_f64, |max, u| max.max(u[dof].abs()))
}

/// A square scene shaken along one diagonal, and along the other.
#[test]
fn motions_along_both_diagonals_are_symmetric() {
    let first_diagonal = march_along([FRAC_1_SQRT_2; 2]);
    let second_diagonal = march_along([-FRAC_1_SQRT_2, FRAC_1_SQRT_2]);
    let along_x = march_along([1.0, 0.0]);
    let size = peak(&along_x, 0);
    assert!(peak(&along_x, 4) > 0.1 * size, "it rocks");
    for (u, v) in first_diagonal.iter().zip(&second_diagonal) {
        let turned_displacement = [-u[1], u[0], u[2], -u[4], u[3], u[5]];
        for (a, b) in turned_displacement.iter().zip(v) {
            assert!((a - b).abs() < 1e-10 * size, "{turned_displacement:?} {v:?}");
        }
        // The diagonal is an axis of symmetry.
        assert!((u[0] - u[1]).abs() < 1e-10 * size && (u[3] + u[4]).abs() < 1e-10 * size);
    }
    for (dof, name) in [(1, "y"), (3, "roll"), (5, "twist")] {
        let across = peak(&along_x, dof);
        assert!(across < 1e-12 * size, "{name}: {across:e} of {size:e}");
    }
}

/// Sines along x, y and upwards that never end.
struct EndlessSines;

/// A sine with this acceleration, in g; it begins at zero.
fn sine(acceleration: f64, frequency: f64, phase: f64, time: f64) -> f64 {
    let angle = 2.0 * PI * frequency * time;
    acceleration * SMALL_GRAVITY / (2.0 * PI * frequency).powi(2)
        * ((angle + phase).sin() - phase.sin())
}

impl FreeField for EndlessSines {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in space needs three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        [sine(1.2, 0.06, 0.3, time), sine(-0.9, 0.047, 1.1, time), sine(0.4, 0.09, 0.7, time)]
    }
}

/// A run of 120 steps in which waves cross `crossed` cells in a step.
fn run_of_hard_steps(crossed_cells: f64, mass: f64, friction: f64, kernels: &SharedKernels) -> Run {
    let body = slender_block(mass / 16.0);
    let ground = ElasticGround::under(unit_soil(), &body, 8).unwrap();
    let mut simulation = Simulation::builder(crossed_cells * 2.0 / (8.0 - 0.21))
        .structure(body)
        .ground(ground.with_stages(Stages::Two).with_shared_kernels(kernels))
        .interface(Coulomb::new(friction).unwrap())
        .motion(EndlessSines)
        .gravity(SMALL_GRAVITY)
        .expected_steps(120)
        .build()
        .unwrap();
    let run = simulation.run(120, |_| {}).unwrap();
    println!(
        "{crossed_cells} {mass} {friction}: {:.1} iterations, {:?}, energy {:.1e}, open {:.2}, slip {:.1e}",
        run.trials as f64 / 120.0,
        run.fallbacks,
        run.energy_error,
        run.whole.uplifted_fraction.magnitude(),
        run.whole.largest_slip.magnitude(),
    );
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    let substitutes_friction = |warning: &Warning| matches!(warning, Warning::LessFriction { .. });
    assert!(!run.warnings.iter().any(substitutes_friction), "{:?}", run.warnings);
    run
}

/// Three time steps, three masses, four coefficients of friction: W from well to badly conditioned.
#[test]
fn hard_steps_are_solved() {
    let kernels = SharedKernels::default();
    let mut finite_trials = 0;
    let mut finite_steps = 0;
    let mut infinite_trials = 0;
    for crossed_cells in [0.4, 1.9, 7.8] {
        for mass in [16.0, 1.0, 0.2] {
            for friction in [0.3, 1.0, 3.0] {
                let run = run_of_hard_steps(crossed_cells, mass, friction, &kernels);
                finite_trials += run.trials;
                finite_steps += run.steps;
            }
            let run = run_of_hard_steps(crossed_cells, mass, f64::INFINITY, &kernels);
            infinite_trials += run.trials;
        }
    }
    println!("{finite_trials} in {finite_steps}, {infinite_trials}");
    assert!(finite_trials < 40 * finite_steps, "{finite_trials} {finite_steps}");
    assert!(infinite_trials < 100 * finite_steps, "{infinite_trials} {finite_steps}");
}

/// Many cells, for which W is stored in blocks: saved where elements lift and slide, and resumed in another simulation.
#[test]
fn many_cells_resume_to_the_last_bit() {
    let mut uninterrupted_simulation = block_scene(12, EndlessSines);
    uninterrupted_simulation.run(15, |_| {}).unwrap();
    let checkpoint = uninterrupted_simulation.checkpoint().unwrap();
    let mut states = Vec::new();
    let run = uninterrupted_simulation.run(15, |state| states.push(state.clone())).unwrap();
    let mut resumed_simulation = block_scene(12, EndlessSines);
    resumed_simulation.resume(&checkpoint).unwrap();
    let mut open_count = 0;
    let mut slip_count = 0;
    for expected in &states {
        assert!(resumed_simulation.step().unwrap() == expected);
        open_count += open_elements(expected);
        slip_count += expected.modes.iter().filter(|mode| mode.is_slip()).count();
    }
    assert!(run.energy_error < 1e-12, "{}", run.energy_error);
    assert!(open_count > 100 && slip_count > 100, "{open_count} {slip_count}");
}

/// Energies of a block after 700 steps, with this history.
fn energies_with(history: HistoryOptions) -> EnergyBalance {
    let body = slender_block(1.0);
    let ground = ElasticGround::under(unit_soil(), &body, 4).unwrap();
    let mut simulation = Simulation::builder(0.2)
        .structure(body)
        .ground(ground.with_history(history).unwrap())
        .interface(Coulomb::new(0.5).unwrap())
        .motion(EndlessSines)
        .gravity(SMALL_GRAVITY)
        .expected_steps(700)
        .build()
        .unwrap();
    let run = simulation.run(700, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9 && run.whole.uplifted_fraction.magnitude() > 0.1);
    run.energy_balance
}

/// A truncated history changes the soil's work by less than the bound in the energy balance.
#[test]
fn the_energy_balance_bounds_what_a_truncated_history_omits() {
    let exact_energies = energies_with(HistoryMethod::RelaxedFft.into());
    let options = HistoryOptions { tolerance: Some(1e-4), ..HistoryOptions::default() };
    let truncated_energies = energies_with(options);
    let difference = (exact_energies.soil - truncated_energies.soil).abs();
    let bound = truncated_energies.soil_error_bound;
    println!("{difference:e} of {bound:e}, {}", exact_energies.soil);
    assert_eq!(exact_energies.soil_error_bound, 0.0);
    assert!(0.0 < difference && difference < bound, "{difference:e} {bound:e}");
    assert!(bound < 0.5 * exact_energies.soil, "{bound:e}");
}
