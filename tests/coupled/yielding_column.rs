//! GOAL: Newton's method on columns of yielding springs: few iterations, static state, tangents, errors.
//! SCENE: 40 cells in series with twelve corners each, bonded to springs; a column under its own weight; friction between
//! masses; a force that jumps.
//! REFERENCE: the closed form of the column under its weight; runs with another tangent.

use std::any::Any;
use std::f64::consts::PI;

use basemat::bem::SpringGround;
use basemat::coupled::{SimulationBuilder, State, StepError};
use basemat::interface::Bonded;
use basemat::motion::{AtRest, FreeFieldFn};
use basemat::structure::{Base, NonlinearForce, RigidBlock, RigidBody, Structure, Triplets};
use basemat::{Error, Simulation};

use basemat_problems::scenes::{SCENE_GRAVITY, SI_UNITS, shake};
use basemat_problems::yielding_springs::{
    Masses, WithYieldingSprings, YieldingSpring, hyperbolic, spring_column,
};
use basemat_problems::{needed_from, own_force};

/// Acceleration amplitude of the shaken ground, m/s².
const GROUND_ACCELERATION: f64 = 3.0;

/// Shaking at 1.5 Hz that grows over six seconds.
fn shaking() -> FreeFieldFn {
    let omega = 3.0 * PI;
    FreeFieldFn::new(move |_, time| {
        let growth = (PI / 12.0 * time.min(6.0)).sin().powi(2);
        [-GROUND_ACCELERATION / (omega * omega) * growth * (omega * time).sin(), 0.0]
    })
}

/// A bonded structure on stiff springs.
fn bonded(structure: impl Structure + 'static, time_step: f64) -> SimulationBuilder {
    let ground = SpringGround::new(-2.0..2.0, 4, 2e9, 2e9).unwrap();
    Simulation::builder(time_step).ground(ground).interface(Bonded).structure(structure)
}

/// A bonded contact problem is solved once in each iteration, so that trials are iterations.
#[test]
fn piecewise_linear_columns_take_few_iterations() {
    for (time_step, max_mean) in [(0.01, 3.0), (0.02, 4.0), (0.05, 6.0)] {
        let builder = bonded(spring_column(40), time_step).motion(shaking());
        let mut simulation = builder.build().unwrap();
        let mut iterations = Vec::new();
        let run = simulation
            .run(simulation.steps_for(5.0), |state: &State| iterations.push(state.trials))
            .unwrap();
        let mean = iterations.iter().sum::<usize>() as f64 / iterations.len() as f64;
        let max = iterations.iter().max().unwrap();
        let hysteresis_ratio = run.energy_balance.hysteresis / run.energy_balance.input;
        println!(
            "Δt = {time_step}: {mean:.2} iterations, at most {max}; hysteresis {hysteresis_ratio:.2}"
        );
        println!("energy open by {:.1e}", run.energy_error);
        assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
        assert!(hysteresis_ratio > 0.3, "{hysteresis_ratio}");
        assert!(mean < max_mean && *max <= 40, "{time_step}: {mean} {max}");
    }
}

/// A column that has come to rest with an offset: rounding of the offset ends the iterations of its small forces.
#[test]
fn columns_at_rest_with_an_offset_take_few_iterations() {
    let omega = 3.0 * PI;
    let shaking = FreeFieldFn::new(move |_, time| {
        let growth = if time < 3.0 { (PI / 3.0 * time).sin().powi(2) } else { 0.0 };
        let acceleration = -GROUND_ACCELERATION * growth * (omega * time).sin();
        [acceleration / (omega * omega), 0.0]
    });
    // The dashpots have the impedance of the column.
    let ground = SpringGround::new(-2.0..2.0, 4, 1e6, 1e8).unwrap().with_dashpots(3e5, 3e5);
    let builder = Simulation::builder(0.01).ground(ground.unwrap()).interface(Bonded);
    let mut simulation =
        builder.structure(spring_column(40)).motion(shaking).gravity(0.0).build().unwrap();
    let mut last_trials = Vec::new();
    let mut top = 0.0;
    let observe = |state: &State| {
        if state.step > 1200 {
            last_trials.push(state.trials);
        }
        top = state.absolute_displacement()[42] - state.absolute_displacement()[0];
    };
    let run = simulation.run(1400, observe).unwrap();
    let mean = last_trials.iter().sum::<usize>() as f64 / last_trials.len() as f64;
    println!("{mean} iterations a step at rest, offset {top:e}");
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    assert!(top.abs() > 1e-4 && mean < 6.0, "{top} {mean}");
}

/// Number of masses of a column that stand on springs in series.
const WEIGHT_COUNT: usize = 10;
const WEIGHT_MASS: f64 = 1e4;
const SPRING_STIFFNESS: f64 = 1e8;

fn standing_column(strength: f64) -> WithYieldingSprings<Masses> {
    let block = RigidBlock::new(4.0, 1.0, 1900.0).unwrap();
    let masses = Masses { block, count: WEIGHT_COUNT, mass: WEIGHT_MASS };
    let springs = (0..WEIGHT_COUNT).map(|k| YieldingSpring {
        row: vec![(if k == 0 { 1 } else { 2 + k }, -1.0), (3 + k, 1.0)],
        components: hyperbolic(SPRING_STIFFNESS, strength),
    });
    let springs = springs.collect();
    WithYieldingSprings::new(masses, springs)
}

/// Compression of a spring under a force: the inverse of the line through the points of the hyperbola.
fn compression(force: f64, strength: f64) -> f64 {
    let reference = strength / SPRING_STIFFNESS;
    let limit = 1.0 / (1.0 / strength - 1.0 / (200.0 * strength));
    let mut previous_point = [0.0, 0.0];
    for j in 0..12 {
        let deformation = 0.02 * reference * 10_f64.powf(4.0 * f64::from(j) / 11.0);
        let elastic_force = SPRING_STIFFNESS * deformation;
        let point = [
            deformation,
            if j == 0 { elastic_force } else { elastic_force / (1.0 + elastic_force / limit) },
        ];
        if force <= point[1] {
            let fraction = (force - previous_point[1]) / (point[1] - previous_point[1]);
            return previous_point[0] + fraction * (point[0] - previous_point[0]);
        }
        previous_point = point;
    }
    panic!("{force} exceeds the strength");
}

/// The springs carry the weight beyond first yielding, and the dynamic stage starts from this state.
#[test]
fn yielding_columns_stand_under_their_weight() {
    let weight = WEIGHT_COUNT as f64 * WEIGHT_MASS * SCENE_GRAVITY;
    for ratio in [0.1, 0.5, 0.95, 0.999] {
        let strength = weight / ratio;
        let builder = bonded(standing_column(strength), 0.01).motion(AtRest).gravity(SCENE_GRAVITY);
        let mut simulation = builder.build().unwrap();
        let displacement = simulation.static_displacement().to_vec();
        let mut settlement = 0.0;
        for k in 0..WEIGHT_COUNT {
            let carried = (WEIGHT_COUNT - k) as f64 * WEIGHT_MASS * SCENE_GRAVITY;
            settlement += compression(carried, strength);
            let computed = displacement[1] - displacement[3 + k];
            let error = (computed / settlement - 1.0).abs();
            assert!(error < 1e-7, "{ratio}, {k}: {computed} {settlement} {error:e}");
        }
        let run = simulation.run(200, |_| {}).unwrap();
        let dynamic_energy = run.energy_balance.kinetic.abs() + run.energy_balance.hysteresis.abs();
        assert!(dynamic_energy < 1e-9 * weight * settlement, "{ratio}: {}", run.energy_balance);
        let structure: &dyn Any = simulation.structure();
        let column = structure.downcast_ref::<WithYieldingSprings<Masses>>().unwrap();
        assert!(column.largest_plastic_deformation() > 0.1 * compression(weight, strength));
        assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    }
}

/// A mass that rubs on a block, pressed by a spring whose force changes: its tangent is not symmetric.
struct RubbingMass {
    masses: Masses,
    /// Plastic part of the slip, m.
    slip: f64,
    uses_symmetric_part: bool,
}

const RUBBING_STIFFNESS: f64 = 5e7;
const PRESSING_STIFFNESS: f64 = 2e8;
const FRICTION_COEFFICIENT: f64 = 0.5;

impl RubbingMass {
    fn new(uses_symmetric_part: bool) -> Self {
        let block = RigidBlock::new(4.0, 1.0, 1900.0).unwrap();
        Self { masses: Masses { block, count: 2, mass: 2e4 }, slip: 0.0, uses_symmetric_part }
    }

    /// Pressing force, rubbing force, and whether the mass slips.
    fn forces(&self, u: &[f64]) -> ([f64; 2], bool) {
        let pressing_force = (1e5 - PRESSING_STIFFNESS * (u[4] - u[1])).max(1e4);
        let trial = RUBBING_STIFFNESS * (u[3] - u[0] - self.slip);
        let limit = FRICTION_COEFFICIENT * pressing_force;
        ([pressing_force, trial.clamp(-limit, limit)], trial.abs() > limit)
    }
}

impl Structure for RubbingMass {
    fn dofs(&self) -> usize {
        self.masses.dofs()
    }

    fn base(&self) -> Base {
        self.masses.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.masses.mass(matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_spring(1, 4, PRESSING_STIFFNESS);
        matrix.add_spring(0, 3, 0.02 * RUBBING_STIFFNESS);
        Ok(())
    }

    own_force!();
}

impl NonlinearForce for RubbingMass {
    fn force(&self, u: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        let ([_, rubbing], _) = self.forces(u);
        force[3] += rubbing;
        force[0] -= rubbing;
        Ok(())
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        let ([pressing_force, rubbing_force], slips) = self.forces(u);
        matrix.add_spring(0, 3, if slips { 0.0 } else { RUBBING_STIFFNESS });
        let changes = slips && pressing_force > 1e4;
        let slope = if changes {
            -FRICTION_COEFFICIENT * rubbing_force.signum() * PRESSING_STIFFNESS
        } else {
            0.0
        };
        for (row, row_sign) in [(3, 1.0), (0, -1.0)] {
            for (column, sign) in [(4, 1.0), (1, -1.0)] {
                let entry = row_sign * sign * slope;
                let [upper, lower] = if self.uses_symmetric_part { [0.5, 0.5] } else { [1.0, 0.0] };
                matrix.add(row, column, upper * entry);
                matrix.add(column, row, lower * entry);
            }
        }
        Ok(())
    }

    fn commit(&mut self, u: &[f64]) {
        let ([_, rubbing], _) = self.forces(u);
        self.slip = u[3] - u[0] - rubbing / RUBBING_STIFFNESS;
    }
}

/// A tangent that is not symmetric is factored by LU, and gives the same motion in fewer iterations than its symmetric part.
#[test]
fn unsymmetric_tangents_are_used_as_they_are() {
    let run = |uses_symmetric_part: bool| {
        let structure = RubbingMass::new(uses_symmetric_part);
        let builder = bonded(structure, 2.5e-3).motion(shake(SI_UNITS, 1.0));
        let mut simulation = builder.build().unwrap();
        let mut iterations = 0;
        let mut motion = Vec::new();
        let observe = |state: &State| {
            iterations += state.trials;
            motion.push(state.absolute_displacement()[3]);
        };
        let run = simulation.run(600, observe).unwrap();
        assert!(run.energy_error < 1e-10, "{:e}", run.energy_error);
        (motion, iterations)
    };
    let [(motion, iterations), (other_motion, other_iterations)] = [run(false), run(true)];
    println!("{iterations} iterations, {other_iterations} with the symmetric part");
    assert!(iterations < 3 * 600 && 5 * iterations < 4 * other_iterations);
    let max_magnitude = motion.iter().fold(0.0_f64, |max, u| max.max(u.abs()));
    for (a, b) in motion.iter().zip(&other_motion) {
        assert!((a - b).abs() < 1e-9 * max_magnitude, "{a} {b}");
    }
}

/// A body in plan with a tangent that is not symmetric.
struct UnsymmetricBody(RigidBody);

impl Structure for UnsymmetricBody {
    needed_from!(0);

    own_force!();
}

impl NonlinearForce for UnsymmetricBody {
    fn force(&self, _: &[f64], _: &mut [f64]) -> basemat::Result<()> {
        Ok(())
    }

    fn tangent(&self, _: &[f64], _: &mut Triplets) -> basemat::Result<()> {
        Ok(())
    }

    fn has_symmetric_tangent(&self) -> bool {
        false
    }
}

#[test]
fn unsymmetric_tangents_are_errors_in_plan() {
    let body = UnsymmetricBody(RigidBody::cuboid([4.0, 4.0, 6.0], 1500.0).unwrap());
    let ground = SpringGround::under(&body, 4, 5e7, 4e7).unwrap();
    let builder = Simulation::builder(0.01).ground(ground).interface(Bonded).structure(body);
    let error = builder.motion(AtRest).build().unwrap_err();
    assert!(matches!(error, Error::Scene { quantity: "tangent of the structure", .. }), "{error}");
}

/// A block on whose rotation a force acts that jumps, so that a step may have no solution.
struct JumpingForce {
    block: RigidBlock,
    commits: usize,
}

impl Structure for JumpingForce {
    needed_from!(block);

    own_force!();
}

impl NonlinearForce for JumpingForce {
    fn force(&self, u: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        force[2] += if u[2] > 1e-6 { 1e7 } else { 0.0 };
        Ok(())
    }

    fn tangent(&self, _: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add(2, 2, 0.0);
        Ok(())
    }

    fn describe_state(&self, u: &[f64], dofs: &[usize]) -> Option<String> {
        (dofs == [2]).then(|| format!("jump at a rotation of {:.0e}", u[2]))
    }

    fn commit(&mut self, _: &[f64]) {
        self.commits += 1;
    }
}

/// The error of a step without a solution has the state of the structure, and nothing of the step is kept.
#[test]
fn failed_steps_name_the_state_and_keep_nothing() {
    let structure = JumpingForce { block: RigidBlock::new(4.0, 6.0, 1500.0).unwrap(), commits: 0 };
    let mut simulation = bonded(structure, 5e-3).motion(shake(SI_UNITS, 0.6)).build().unwrap();
    let error = simulation.run(400, |_| {}).unwrap_err();
    let commits = |simulation: &Simulation| {
        let structure: &dyn Any = simulation.structure();
        structure.downcast_ref::<JumpingForce>().unwrap().commits
    };
    let last_state = simulation.state().clone();
    let last_commits = commits(&simulation);
    let Error::Step { step, source, .. } = &error else { panic!("{error}") };
    assert_eq!(*step, last_state.step + 1);
    let StepError::Newton { state: Some(state), residual, modes, .. } = source else {
        panic!("{error}")
    };
    assert!(state.starts_with("jump at a rotation of ") && *residual > 1e-9 && modes.len() == 4);
    println!("{error}");
    assert!(error.to_string().contains(&format!(", {state}, modes stick")), "{error}");
    assert_eq!(simulation.step().unwrap_err().to_string(), error.to_string());
    assert_eq!(commits(&simulation), last_commits);
    assert_eq!(last_state.absolute_displacement(), simulation.state().absolute_displacement());
}
