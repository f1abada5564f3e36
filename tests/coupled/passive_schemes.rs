//! GOAL: the midpoint rule and its dissipative form are passive together with the soil; Newmark's method
//! and HHT-α are not, which causes a warning.
//! SCENE: random forced steps; a shaken tower; a light block on soft soil; a shear building.
//! REFERENCE: the identity of `docs/theory.md`, section 8; accelerations of the states; a run in short steps.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::{
    DissipativeMidpoint, HhtAlpha, Midpoint, Newmark, SchemeCoefficients, State, TimeScheme,
    Warning,
};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{AtRest, el_centro_1940};
use basemat::results::Run;
use basemat::structure::{RigidBlock, ShearBuilding, Storey, Structure, Triplets};
use basemat::{Simulation, Soil};

use basemat_problems::dense::{DenseMatrix, dot, form, multiply};
use basemat_problems::random::Random;
use basemat_problems::scenes::{SI_UNITS, scene, tower};

pub(super) fn dissipative(gamma: f64) -> DissipativeMidpoint {
    DissipativeMidpoint::new(gamma).unwrap()
}

fn beta(gamma: f64) -> f64 {
    0.25 * (gamma + 0.5).powi(2)
}

/// Row of a scheme's coefficients times (Δu, v₀, a₀).
pub(super) fn combine(row: [f64; 3], du: f64, v: f64, a: f64) -> f64 {
    row[0] * du + row[1] * v + row[2] * a
}

/// [`combine`] for each degree of freedom.
fn combine_each(row: [f64; 3], du: &[f64], v: &[f64], a: &[f64]) -> Vec<f64> {
    (0..du.len()).map(|i| combine(row, du[i], v[i], a[i])).collect()
}

fn add_scaled(a: &[f64], b: &[f64], factor: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + factor * b).collect()
}

/// Solution by Gaussian elimination without pivoting, of a positive definite matrix.
fn solve(mut matrix: DenseMatrix, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for k in 0..n {
        for i in k + 1..n {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..n {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - sum) / matrix[k][k];
    }
    right
}

/// Identity plus G Gᵀ of random entries times a random size.
fn random_matrix(random: &mut Random, n: usize) -> DenseMatrix {
    let size = random.log_within(1e-2, 1e2);
    let factor: DenseMatrix =
        (0..n).map(|_| (0..n).map(|_| random.within(-1.0, 1.0)).collect()).collect();
    let mut matrix = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..n {
            let unit = if i == j { 1.0 } else { 0.0 };
            matrix[i][j] = size * dot(&factor[i], &factor[j]) + unit;
        }
    }
    matrix
}

fn random_vector(random: &mut Random, n: usize) -> Vec<f64> {
    (0..n).map(|_| random.within(-1.0, 1.0)).collect()
}

/// Matrices of a linear structure.
struct Matrices {
    mass: DenseMatrix,
    damping: DenseMatrix,
    stiffness: DenseMatrix,
}

/// Displacement, velocity and acceleration.
struct Motion {
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

impl Matrices {
    fn random(random: &mut Random, n: usize) -> Self {
        Self {
            mass: random_matrix(random, n),
            damping: random_matrix(random, n),
            stiffness: random_matrix(random, n),
        }
    }

    /// Displacement increment of M a* + C v* + K u* = force.
    fn increment(&self, scheme: &SchemeCoefficients, start: &Motion, force: &[f64]) -> Vec<f64> {
        let n = force.len();
        let zero = vec![0.0; n];
        let terms = [
            (&self.mass, scheme.acceleration, &zero),
            (&self.damping, scheme.velocity, &zero),
            (&self.stiffness, scheme.displacement, &start.displacement),
        ];
        let mut effective = vec![vec![0.0; n]; n];
        let mut right = force.to_vec();
        for (matrix, row, offset) in terms {
            for i in 0..n {
                effective[i] = add_scaled(&effective[i], &matrix[i], row[0]);
            }
            let force_of_the_start = combine_each(row, &zero, &start.velocity, &start.acceleration);
            let force_of_the_start = add_scaled(&force_of_the_start, offset, 1.0);
            right = add_scaled(&right, &multiply(matrix, &force_of_the_start), -1.0);
        }
        solve(effective, right)
    }

    /// Twice the kinetic, the strain and the algorithmic energy, the last with its factor κ.
    fn doubled_energies(&self, motion: &Motion, kappa: f64) -> [f64; 3] {
        [
            form(&motion.velocity, &self.mass, &motion.velocity),
            form(&motion.displacement, &self.stiffness, &motion.displacement),
            kappa * form(&motion.acceleration, &self.mass, &motion.acceleration),
        ]
    }
}

/// State at the end of a step with this increment.
fn advance(scheme: &SchemeCoefficients, start: &Motion, increment: &[f64]) -> Motion {
    let Motion { displacement, velocity, acceleration } = start;
    Motion {
        displacement: add_scaled(displacement, increment, 1.0),
        velocity: combine_each(scheme.new_velocity, increment, velocity, acceleration),
        acceleration: combine_each(scheme.new_acceleration, increment, velocity, acceleration),
    }
}

#[test]
fn energy_of_a_forced_step_is_as_the_theory_says() {
    const DOF_COUNT: usize = 3;
    let mut random = Random(7);
    for _ in 0..20_000 {
        let gamma = random.within(0.5, 1.0);
        let time_step = random.log_within(1e-2, 1e2);
        let scheme = dissipative(gamma).coefficients(time_step);
        let matrices = Matrices::random(&mut random, DOF_COUNT);
        let start = Motion {
            displacement: random_vector(&mut random, DOF_COUNT),
            velocity: random_vector(&mut random, DOF_COUNT),
            acceleration: random_vector(&mut random, DOF_COUNT),
        };
        let force = random_vector(&mut random, DOF_COUNT);
        let increment = matrices.increment(&scheme, &start, &force);
        let end = advance(&scheme, &start, &increment);
        let kappa =
            if gamma == 0.5 { 0.0 } else { time_step * time_step * (beta(gamma) - 0.5 * gamma) };
        let before = matrices.doubled_energies(&start, kappa);
        let after = matrices.doubled_energies(&end, kappa);
        let acceleration_change = add_scaled(&end.acceleration, &start.acceleration, -1.0);
        let loss = kappa
            * (gamma - 0.5)
            * form(&acceleration_change, &matrices.mass, &acceleration_change);
        let work =
            dot(&force, &increment) - form(&increment, &matrices.damping, &increment) / time_step;
        let change: f64 = (0..3).map(|k| 0.5 * (after[k] - before[k])).sum();
        let scale = before.iter().chain(&after).fold(work.abs(), |m, x| m.max(*x));
        let residual = (change - work + loss).abs() / scale;
        assert!(
            residual < 3e-12 && loss >= 0.0,
            "γ = {gamma}, Δt = {time_step}: {residual:e}, loss {loss:e}"
        );
    }
}

/// All states of a tower under two pulses.
fn shaken(scheme: impl TimeScheme + 'static, steps: usize) -> Vec<State> {
    let builder = scene(SI_UNITS, 0.5)
        .structure(tower(SI_UNITS, None))
        .interface(Bonded)
        .scheme(scheme);
    let mut simulation = builder.build().unwrap();
    basemat_problems::scenes::states(&mut simulation, steps)
}

#[test]
fn without_dissipation_the_scheme_is_the_midpoint_rule_to_the_bit() {
    assert!(shaken(Midpoint, 100) == shaken(dissipative(0.5), 100));
}

/// aᵀ M a of a mass matrix.
fn mass_form(mass: &Triplets, a: &[f64]) -> f64 {
    mass.entries().iter().map(|&(i, j, m)| a[i] * m * a[j]).sum()
}

/// The algorithmic energy is what the accelerations of the states store and dissipate.
#[test]
fn algorithmic_energy_follows_from_the_accelerations() {
    let mut mass = Triplets::new(tower(SI_UNITS, None).dofs());
    tower(SI_UNITS, None).mass(&mut mass).unwrap();
    for gamma in [0.6, 0.8, 1.0] {
        let states = shaken(dissipative(gamma), 300);
        let kappa = 2.5e-3_f64.powi(2) * (beta(gamma) - 0.5 * gamma);
        let mut dissipated_energy = 0.0;
        for pair in states.windows(2) {
            let acceleration = pair[1].acceleration();
            let change = add_scaled(acceleration, pair[0].acceleration(), -1.0);
            dissipated_energy += kappa * (gamma - 0.5) * mass_form(&mass, &change);
            let expected = dissipated_energy + 0.5 * kappa * mass_form(&mass, acceleration);
            let energy_balance = &pair[1].energy_balance;
            let error = (energy_balance.algorithmic - expected).abs() / energy_balance.largest;
            assert!(error < 1e-11, "γ = {gamma}: {} {expected}", energy_balance.algorithmic);
        }
        let end = &states.last().unwrap().energy_balance;
        assert!(dissipated_energy > 1e-8 * end.largest && end.residual() < 1e-11, "{end}");
    }
}

/// Run of a light block on soft soil that is thrown up and lands on its two elements.
fn run_thrown_block(scheme: impl TimeScheme + 'static, steps: usize) -> Run {
    let block = RigidBlock::new(6.0, 6.0, 50.9).unwrap();
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .ground(
            ElasticGround::new(soil, Strip::under(&block, 2, Grading::Uniform).unwrap()).unwrap(),
        )
        .structure(block)
        .interface(Coulomb::uplift_only())
        .motion(AtRest)
        .initial_velocity([0.0, 0.35, 0.0])
        .scheme(scheme)
        .build()
        .unwrap();
    simulation.run(steps, |_| {}).unwrap()
}

/// Energy that the scheme has added, from the run's warning.
fn added_energy(run: &Run) -> Option<f64> {
    run.warnings.iter().find_map(|warning| match warning {
        Warning::AlgorithmicEnergy { made } => Some(*made),
        _ => None,
    })
}

#[test]
fn newmark_adds_energy_on_the_half_plane_and_warns() {
    let run = run_thrown_block(Newmark::default(), 220);
    let total = run.energy_balance.kinetic + run.energy_balance.static_contact;
    assert!(total > 100.0 * run.energy_balance.input, "{}", run.energy_balance);
    assert!(added_energy(&run).unwrap() > 0.5 && run.energy_error < 1e-9, "{:?}", run.warnings);
    for scheme in [DissipativeMidpoint::new(0.5).unwrap(), DissipativeMidpoint::default()] {
        let run = run_thrown_block(scheme, 220);
        let total = run.energy_balance.kinetic + run.energy_balance.static_contact;
        assert!(total < run.energy_balance.input, "{}", run.energy_balance);
        assert!(run.energy_balance.algorithmic >= -1e-3 * run.energy_balance.largest);
        assert!(added_energy(&run).is_none());
        assert!(run.energy_error < 1e-12);
    }
}

/// Run of an ordinary building under El Centro.
fn run_building(scheme: impl TimeScheme + 'static, time_step: f64) -> Run {
    let storeys = [Storey::new(3.0, 30e3, 60e6); 3];
    let building = ShearBuilding::new(8.0, 60e3, 4e5, &storeys).unwrap();
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0).unwrap();
    let strips = Strip::under(&building, 12, Grading::Uniform).unwrap();
    let mut simulation = Simulation::builder(time_step)
        .ground(ElasticGround::new(soil, strips).unwrap())
        .structure(building.with_stiffness_damping(0.05).unwrap())
        .motion(el_centro_1940())
        .interface(Bonded)
        .scheme(scheme)
        .build()
        .unwrap();
    let steps = simulation.steps_for(10.0);
    simulation.run(steps, |_| {}).unwrap()
}

/// Newmark's coupling increases the shear of an ordinary building, with a warning.
///
/// The midpoint rule and its dissipative form agree.
#[test]
fn schemes_of_a_building() {
    let reference = run_building(Midpoint, 1e-3).whole.base_shear.magnitude();
    for time_step in [0.01, 0.02] {
        let midpoint = run_building(Midpoint, time_step);
        let dissipative = run_building(dissipative(0.8), time_step);
        let newmark = run_building(Newmark::default(), time_step);
        let hht = run_building(HhtAlpha::new(-0.1).unwrap(), time_step);
        let [midpoint_error, dissipative_error, newmark_error, hht_error] =
            [&midpoint, &dissipative, &newmark, &hht]
                .map(|run| run.whole.base_shear.magnitude() / reference - 1.0);
        println!(
            "{time_step}: midpoint {midpoint_error:.4}, dissipative {dissipative_error:.4}, Newmark \
             {newmark_error:.4} {:?}, HHT {hht_error:.4} {:?}",
            added_energy(&newmark),
            added_energy(&hht),
        );
        assert!(added_energy(&midpoint).is_none() && added_energy(&dissipative).is_none());
        assert!(dissipative_error.abs() < 0.06 && midpoint_error.abs() < 0.06);
        assert!(newmark_error > 0.04 && added_energy(&newmark).unwrap() > 0.02);
    }
}
