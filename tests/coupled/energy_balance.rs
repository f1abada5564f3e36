//! GOAL: the energy balance closes in every kind of run, and only if every term is correct.
//! SCENE: kinds of law, scheme, damping, structure and ground; stiff structures that
//! travel far.
//! REFERENCE: the identity of the energies; with any term perturbed it must not close.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::{
    DissipativeMidpoint, EnergyBalance, Load, Newmark, SimulationBuilder, Theta,
};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::{Bonded, InterfaceLaw, ThinLayer, UnilateralCondition};
use basemat::motion::AtRest;
use basemat::results::Run;
use basemat::structure::{
    Bilinear, FemModel, RayleighDamping, RigidBlock, ShearBuilding, Storey, WithSprings,
};

use basemat_problems::scenes::{Rider, SI_UNITS, block, friction, scene, shake, soil, tower};
use basemat_problems::yielding_springs::spring_column;

fn run(builder: SimulationBuilder, steps: usize) -> Run {
    builder.build().unwrap().run(steps, |_| {}).unwrap()
}

/// A tower under two pulses with this law.
fn on_tower(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    scene(SI_UNITS, 0.6).structure(tower(SI_UNITS, None)).interface(law)
}

fn on_damped_tower(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let damping = RayleighDamping::from_ratios([2.0, 20.0], [0.05; 2]).unwrap();
    scene(SI_UNITS, 0.6).structure(tower(SI_UNITS, Some(damping))).interface(law)
}

fn on_block(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(law)
}

/// A block with a nonlinear elastic rider.
fn on_rider() -> SimulationBuilder {
    scene(SI_UNITS, 0.6)
        .structure(Rider { block: block(SI_UNITS) })
        .interface(friction(0.4))
}

/// A building with a yielding damper in its first storey.
fn on_yielding_building(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let storeys = [Storey::new(3.0, 15e3, 25e6); 3];
    let building = ShearBuilding::new(4.0, 3e4, 8e4, &storeys).unwrap();
    let drift = building.drift(0).unwrap();
    let damper = Bilinear::new(1e7, 2e4, 0.1).unwrap();
    let structure = WithSprings::new(building).spring(drift, damper).unwrap();
    scene(SI_UNITS, 0.6).structure(structure).interface(law)
}

/// A column of springs that yield, with the remainder of their work in a step.
fn on_yielding_column() -> SimulationBuilder {
    scene(SI_UNITS, 0.6).structure(spring_column(8)).interface(friction(0.4))
}

fn thin_layer() -> ThinLayer {
    ThinLayer::new(soil(SI_UNITS), 1.0, 0.3).unwrap()
}

/// Runs by the dissipative midpoint rule, by name.
fn dissipative_runs() -> Vec<(&'static str, Run)> {
    let scheme = DissipativeMidpoint::default();
    let push = Load::new(block(SI_UNITS).horizontal_at(6.0), |t: f64| 8e4 * (30.0 * t).sin());
    vec![
        ("dissipative", run(on_damped_tower(friction(0.4)).scheme(scheme), 300)),
        ("dissipative, thin layer", run(on_tower(thin_layer()).scheme(scheme), 300)),
        ("dissipative, nonlinear", run(on_rider().scheme(scheme), 400)),
        (
            "dissipative, yielding, thin layer",
            run(on_yielding_building(thin_layer()).scheme(scheme), 400),
        ),
        ("dissipative, loaded", run(on_block(friction(0.4)).load(push).scheme(scheme), 400)),
    ]
}

/// Runs by other schemes, by name.
fn other_runs() -> Vec<(&'static str, Run)> {
    let closing_rate = UnilateralCondition::Velocity { closed_below: 1e-9 };
    let rate = friction(0.4).with_unilateral_condition(closing_rate).unwrap();
    let theta = Theta::new(0.6).unwrap();
    let springs = SpringGround::new(-2.0..2.0, 8, 5e7, 4e7).unwrap();
    let springs = springs.with_dashpots(4e5, 3e5).unwrap();
    vec![
        ("bonded", run(on_tower(Bonded), 300)),
        ("uplift", run(on_block(friction(f64::INFINITY)), 400)),
        ("sliding", run(on_block(friction(0.2)), 400)),
        ("flexible, sliding", run(on_tower(friction(0.3)), 300)),
        ("θ", run(on_tower(friction(0.4)).scheme(theta), 300)),
        ("Rayleigh damping", run(on_damped_tower(friction(0.4)), 300)),
        ("θ and Rayleigh damping, bonded", run(on_damped_tower(Bonded).scheme(theta), 300)),
        ("thin layer", run(on_block(thin_layer()), 400)),
        ("thin layer, Newmark", run(on_tower(thin_layer()).scheme(Newmark::default()), 300)),
        ("rate", run(on_block(rate), 400)),
        ("nonlinear", run(on_rider(), 400)),
        ("yielding damper", run(on_yielding_building(friction(0.4)), 400)),
        ("yielding column", run(on_yielding_column(), 300)),
        ("yielding column, θ", run(on_yielding_column().scheme(theta), 300)),
        ("yielding column, Newmark", run(on_yielding_column().scheme(Newmark::default()), 300)),
        ("spring bed", run(on_block(friction(0.4)).ground(springs), 400)),
    ]
}

/// The terms of an energy balance, its left-hand side first.
fn terms(energy_balance: &mut EnergyBalance) -> [(&'static str, &mut f64); 11] {
    [
        ("kinetic", &mut energy_balance.kinetic),
        ("strain", &mut energy_balance.strain),
        ("hysteresis", &mut energy_balance.hysteresis),
        ("damping", &mut energy_balance.damping),
        ("algorithmic", &mut energy_balance.algorithmic),
        ("midstep_remainder", &mut energy_balance.midstep_remainder),
        ("soil", &mut energy_balance.soil),
        ("contact", &mut energy_balance.contact),
        ("interface", &mut energy_balance.interface),
        ("static_contact", &mut energy_balance.static_contact),
        ("input", &mut energy_balance.input),
    ]
}

#[test]
fn energy_balance_closes_and_every_term_counts() {
    let mut tested_terms = [false; 11];
    for (name, run) in dissipative_runs().into_iter().chain(other_runs()) {
        let residual = run.energy_balance.residual();
        println!("{name}: largest {:.1e}, end {residual:.1e}", run.energy_error);
        assert!(run.energy_error < 1e-10, "{name}: {:e}", run.energy_error);
        for k in 0..11 {
            let mut energy_balance = run.energy_balance;
            let (term, value) = terms(&mut energy_balance).into_iter().nth(k).unwrap();
            let size = value.abs();
            *value *= 1.0 + 1e-3;
            // Residuals are relative to the largest energy of the run.
            let relative_size = size / energy_balance.largest;
            // Relevant terms change the residual if they are wrong by one in a thousand.
            if relative_size > 1e-4 {
                tested_terms[k] = true;
                let residual = energy_balance.residual();
                assert!(
                    residual > 0.5e-3 * relative_size,
                    "{name}: {term} may be off, {residual:e}"
                );
            }
        }
    }
    assert_eq!(tested_terms, [true; 11], "a term was never tested");
}

/// The balance of a yielding column closes with the right remainder only, which falls with the step.
///
/// REFERENCE: without the force's formula, the remainder counts as algorithmic, from the difference of the work.
#[test]
fn remainder_of_yielding_springs_is_that_of_their_work() {
    let scene = |time_step: f64| {
        let ground = SpringGround::new(-2.0..2.0, 8, 5e7, 4e7).unwrap();
        Simulation::builder(time_step)
            .ground(ground)
            .motion(shake(SI_UNITS, 0.6))
            .interface(Bonded)
    };
    let ratio = |time_step: f64, steps: usize| {
        let run = run(scene(time_step).structure(spring_column(8)), steps);
        let energies = run.energy_balance;
        assert!(run.energy_error < 1e-11, "{time_step}: {:e}", run.energy_error);
        assert!(energies.algorithmic == 0.0 && energies.midstep_remainder > 0.0, "{energies}");
        let column = spring_column(8).without_remainder();
        let other_run = self::run(scene(time_step).structure(column), steps);
        let difference = other_run.energy_balance.algorithmic - energies.midstep_remainder;
        assert_eq!(other_run.energy_balance.midstep_remainder, 0.0);
        assert!(difference.abs() < 1e-9 * energies.largest, "{difference:e}");
        let mut column = spring_column(8);
        column.remainder_factor = 1.01;
        let wrong_run = self::run(scene(time_step).structure(column), steps);
        let error = wrong_run.energy_balance.residual() * energies.largest;
        assert!((error / (0.01 * energies.midstep_remainder) - 1.0).abs() < 1e-3, "{error:e}");
        energies.midstep_remainder / energies.hysteresis
    };
    let ratios = [ratio(4e-3, 300), ratio(2e-3, 600), ratio(1e-3, 1200)];
    println!("remainder over hysteresis: {ratios:?}");
    assert!(ratios[0] < 0.1 && ratios[1] < 0.4 * ratios[0] && ratios[2] < 0.4 * ratios[1]);
}

/// The energy error of stiff structures that move far is rounding of the displacement.
///
/// K u and ½ u·K u belong to a deformation of micrometres on a displacement of decimetres. The residual grows with the
/// stiffness, and is largest while the motion is weak.
#[test]
fn large_displacements_of_the_ground_open_the_energy_balance_by_rounding_only() {
    for (modulus, strength) in [(2e8, 1.0), (2e10, 1.0), (2e10, 10.0), (2e12, 10.0)] {
        let material = Material::new(modulus, 0.2, 1500.0).unwrap();
        let mesh = Mesh::layered_block(-2.0..2.0, 6, &[Layer::new(6.0, 6, material)]).unwrap();
        let model = FemModel::on_base(mesh).unwrap();
        let bonded = scene(SI_UNITS, strength).motion(shake(SI_UNITS, strength)).interface(Bonded);
        let run = run(bonded.structure(model), 300);
        let max_energy_error = run.energy_error;
        let end = run.energy_balance.residual();
        println!(
            "E = {modulus:e}, strength {strength}: {max_energy_error:.1e}, at the end {end:.1e}"
        );
        assert!(
            max_energy_error < 1e-21 * modulus,
            "E = {modulus:e}, strength {strength}: {max_energy_error:e}"
        );
        assert!(end < 3e-22 * modulus, "E = {modulus:e}, strength {strength}: {end:e}");
    }
}

/// At rest energies are zero to rounding, also on a thin layer under the weight.
#[test]
fn rest_closes_the_energy_balance() {
    let builder = scene(SI_UNITS, 0.0)
        .motion(AtRest)
        .structure(block(SI_UNITS))
        .interface(thin_layer());
    let run = run(builder, 400);
    assert!(run.energy_balance.kinetic < 1e-25, "{}", run.energy_balance);
    assert!(run.energy_error < 1e-14 && run.warnings.is_empty(), "{}", run.energy_error);
}

/// Residuals are relative to the largest energy so far, and therefore do not grow while energies decay.
#[test]
fn residuals_are_relative_to_the_largest_energy_so_far() {
    let mut simulation = on_tower(friction(0.3)).build().unwrap();
    let mut max_magnitude = 0.0_f64;
    for _ in 0..600 {
        let mut energy_balance = simulation.step().unwrap().energy_balance;
        for (_, value) in terms(&mut energy_balance) {
            max_magnitude = max_magnitude.max(value.abs());
        }
        assert!(energy_balance.largest >= max_magnitude && energy_balance.residual() < 1e-12);
        energy_balance.input += 1e-3 * energy_balance.largest;
        assert!((energy_balance.residual() / 1e-3 - 1.0).abs() < 2e-3);
    }
    assert!(max_magnitude > 0.0);
}

/// On a frictionless base, below which the ground moves, the scale is the energy of its motion.
#[test]
fn residuals_are_relative_to_the_motion_of_the_ground() {
    let frictionless_scene = scene(SI_UNITS, 0.0).motion(basemat::motion::el_centro_1940());
    let mut simulation = frictionless_scene
        .structure(block(SI_UNITS))
        .interface(friction(0.0))
        .build()
        .unwrap();
    let mass = block(SI_UNITS).total_mass();
    let mut previous_free_field = [0.0; 2];
    let mut max_value = 0.0_f64;
    for _ in 0..400 {
        let state = simulation.step().unwrap();
        let velocity = [0, 1].map(|k| (state.free_field[k] - previous_free_field[k]) / 2.5e-3);
        previous_free_field = state.free_field;
        let kinetic = 0.5 * mass * (velocity[0] * velocity[0] + velocity[1] * velocity[1]);
        max_value = max_value.max(kinetic);
        let energy_balance = state.energy_balance;
        assert!((energy_balance.largest / max_value - 1.0).abs() < 1e-9, "{energy_balance}");
    }
}

/// A run without energy balance has the same states, and energies that are NaN.
#[test]
fn an_energy_balance_that_is_left_out_changes_nothing_else() {
    let mut complete_simulation = on_tower(friction(0.3)).build().unwrap();
    let mut simulation_without_balance =
        on_tower(friction(0.3)).without_energy_balance().build().unwrap();
    let complete_run = complete_simulation.run(200, |_| {}).unwrap();
    let reduced_run = simulation_without_balance.run(200, |_| {}).unwrap();
    assert!(complete_run.energy_error < 1e-9);
    assert!(reduced_run.energy_error.is_nan() && reduced_run.energy_balance.soil.is_nan());
    assert!(reduced_run.to_string().contains("energy balance omitted"));
    assert_eq!(reduced_run.warnings, complete_run.warnings);
    assert_eq!(complete_simulation.state().contact, simulation_without_balance.state().contact);
    assert_eq!(complete_simulation.state().probes, simulation_without_balance.state().probes);
    assert_eq!(
        complete_simulation.state().displacement(),
        simulation_without_balance.state().displacement()
    );
    // A checkpoint contains whether there is an energy balance.
    let checkpoint = simulation_without_balance.checkpoint().unwrap();
    assert!(complete_simulation.resume(&checkpoint).is_err());
    let mut resumed_simulation = on_tower(friction(0.3)).without_energy_balance().build().unwrap();
    resumed_simulation.resume(&checkpoint).unwrap();
    assert!(resumed_simulation.step().unwrap().energy_balance.residual().is_nan());
}

/// Absolute and relative input energy agree once the ground has come to rest, and not before.
///
/// They differ by the kinetic energies that belong to them (Uang and Bertero 1990, eq. 12).
#[test]
fn relative_input_meets_the_absolute_one_when_the_ground_rests() {
    let shaking = run(on_tower(Bonded).gravity(0.0), 130).energy_balance;
    let at_rest = run(on_tower(Bonded).gravity(0.0), 600).energy_balance;
    assert!((shaking.relative_input / shaking.input - 1.0).abs() > 0.2);
    assert!((at_rest.relative_input / at_rest.input - 1.0).abs() < 2e-3);
}

/// Stiffness of the springs below the bouncing block, Pa/m.
const SPRING_STIFFNESS: f64 = 5.0e7;
const BOUNCING_TIME_STEP: f64 = 5.0e-4;

/// A block 4 m wide and high that bounces on springs without dashpots, by the midpoint rule.
fn bouncing_block(theta: f64) -> SimulationBuilder {
    let block = RigidBlock::new(4.0, 4.0, 2000.0).unwrap();
    let ground = SpringGround::under(&block, 4, SPRING_STIFFNESS, SPRING_STIFFNESS).unwrap();
    Simulation::builder(BOUNCING_TIME_STEP)
        .ground(ground.with_theta(theta).unwrap())
        .structure(block)
        .interface(Bonded)
        .gravity(0.0)
        .initial_velocity([0.0, 0.01, 0.0])
}

/// GOAL: Newmark's method conserves energy on springs that act at the end of a step (θ = 1) only.
/// SCENE: a block that bounces on springs without dashpots.
/// REFERENCE: the energy e^(ω²Δt t/2) of an oscillator with a dashpot of ratio −ωΔt/4, to which springs that act at
/// mid-step are equivalent in Newmark's method; the midpoint rule.
#[test]
fn newmark_on_springs_needs_theta_one() {
    let unstable = run(bouncing_block(0.5).scheme(Newmark::default()), 2000);
    let squared_frequency = SPRING_STIFFNESS / (2000.0 * 4.0);
    let expected = (squared_frequency * BOUNCING_TIME_STEP * unstable.end / 2.0).exp();
    let balance = unstable.energy_balance;
    let energy = (balance.input - balance.algorithmic) / balance.input;
    assert!((energy.ln() / expected.ln() - 1.0).abs() < 0.02, "{energy} {expected}");
    let midpoint = run(bouncing_block(0.5), 2000).energy_balance.kinetic;
    let newmark = run(bouncing_block(1.0).scheme(Newmark::default()), 2000).energy_balance.kinetic;
    assert!((midpoint / newmark - 1.0).abs() < 1e-9, "{midpoint} {newmark}");
}
