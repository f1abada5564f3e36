//! GOAL: thrusts on walls stay between active and passive thrust of the soil, and energy balances.
//! SCENE: blocks with and without friction in trenches in one and two soils, with and without cohesion, pushed to the
//! side and back; strong shaking on springs and in the half-plane. HEAVY_TESTS: 400 scenes, else 30.
//! REFERENCE: Rankine's thrusts, integrated by hand; the energy balance.

use std::collections::BTreeSet;

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::coupled::{Face, Load, State, Warning};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Mode};
use basemat::motion::{STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::results::Run;
use basemat::site::TrenchMotion;
use basemat::soil::{SoilProfile, SoilStrength};
use basemat::structure::{DofCombination, RigidBlock, WithWalls};
use basemat::{Error, Simulation, Soil, unobserved};

use basemat_problems::heavy;
use basemat_problems::random::Random;

use super::trench_springs::{
    SOIL_DENSITY, TRENCH_DEPTH, TRENCH_WIDTH, TrenchSprings, soil, walled_block,
};

const UNIT_WEIGHT: f64 = SOIL_DENSITY * STANDARD_GRAVITY;

fn elements(wall_elements: usize) -> TrenchElements {
    let trench = Trench::new(-0.5 * TRENCH_WIDTH..0.5 * TRENCH_WIDTH, TRENCH_DEPTH).unwrap();
    trench.elements(4, wall_elements).unwrap()
}

fn ground(profile: impl Into<SoilProfile>, wall_elements: usize) -> TrenchGround {
    let ground = TrenchGround::new(profile, elements(wall_elements)).unwrap();
    ground.with_pressure_at_rest(0.5).unwrap()
}

fn strength(degrees: f64) -> SoilStrength {
    SoilStrength::new(degrees.to_radians()).unwrap()
}

/// Values for the active (left) and the passive (right) wall.
#[derive(Clone, Copy)]
struct ActivePassive {
    active: f64,
    passive: f64,
}

impl ActivePassive {
    /// Rankine's coefficients for this angle of friction.
    fn rankine(degrees: f64) -> Self {
        let [active, passive] =
            [-1.0, 1.0].map(|sign| (45.0 + 0.5 * sign * degrees).to_radians().tan().powi(2));
        Self { active, passive }
    }

    /// Thrusts of one soil of these coefficients on walls as deep as the trench.
    fn thrusts(self) -> Self {
        let thrust = |ratio: f64| 0.5 * ratio * UNIT_WEIGHT * TRENCH_DEPTH * TRENCH_DEPTH;
        Self { active: thrust(self.active), passive: thrust(self.passive) }
    }

    #[track_caller]
    fn assert_close_to(self, expected: Self) {
        for (computed, expected) in
            [(self.active, expected.active), (self.passive, expected.passive)]
        {
            let tolerance = 1e-9 * expected.abs().max(1.0);
            assert!((computed - expected).abs() < tolerance, "{computed} {expected}");
        }
    }
}

/// Block of the trench's size and the weight of the soil.
fn buried_block() -> WithWalls {
    let block = RigidBlock::new(TRENCH_WIDTH, TRENCH_DEPTH, SOIL_DENSITY).unwrap();
    WithWalls::new(block, TRENCH_DEPTH).unwrap()
}

/// Motion to the right at the height of the walls' thrust, under which the whole wall moves.
fn thrust_direction() -> DofCombination {
    DofCombination::of_base(&buried_block(), [0.0, 0.0, TRENCH_DEPTH / 3.0]).unwrap()[0].clone()
}

/// Thrusts on a block pushed to the right until both walls reach their limits.
fn thrusts_at_limits(ground: TrenchGround, strengths: &[SoilStrength], push: f64) -> ActivePassive {
    let laws = ground.interfaces(Coulomb::new(0.0).unwrap(), strengths, STANDARD_GRAVITY).unwrap();
    let load = Load::table(thrust_direction(), &[0.0, 0.5, 10.0], &[0.0, push, push]).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(buried_block())
        .ground(ground)
        .interfaces(laws)
        .load(load)
        .expected_steps(80)
        .build()
        .unwrap();
    let run = simulation.run(80, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    assert_eq!(wall_warning(&run), None);
    let state = simulation.state();
    ActivePassive {
        active: state.face(Face::LeftWall).thrust,
        passive: state.face(Face::RightWall).thrust,
    }
}

#[test]
fn walls_that_are_pushed_bear_active_and_passive_thrust() {
    let expected = ActivePassive::rankine(30.0).thrusts();
    for wall_elements in [2, 3] {
        let push = 3.0 * expected.passive;
        let thrusts = thrusts_at_limits(ground(soil(), wall_elements), &[strength(30.0)], push);
        thrusts.assert_close_to(expected);
    }
}

/// Thrusts of two soils whose boundary, 2 m deep, is inside an element.
#[test]
fn thrusts_of_two_soils_are_exact() {
    let upper = Soil::from_shear_wave_speed(150.0, 0.35, 1600.0).unwrap();
    let profile = SoilProfile::on_half_plane(soil()).with_layer(upper, 2.0).unwrap();
    let upper_ratios = ActivePassive::rankine(28.0);
    let lower_ratios = ActivePassive::rankine(36.0);
    let weight = 1600.0 * STANDARD_GRAVITY * 2.0;
    let thrust = |upper: f64, lower: f64| {
        upper * 0.5 * weight * 2.0 + lower * (weight * 3.0 + 0.5 * UNIT_WEIGHT * 9.0)
    };
    let expected = ActivePassive {
        active: thrust(upper_ratios.active, lower_ratios.active),
        passive: thrust(upper_ratios.passive, lower_ratios.passive),
    };
    let strengths = [strength(28.0), strength(36.0)];
    let thrusts = thrusts_at_limits(ground(profile, 3), &strengths, 3.0 * expected.passive);
    thrusts.assert_close_to(expected);
}

/// Above the depth z₀ = 2c/(γ √K_a) cohesive soil stands without the wall, and the contact opens.
#[test]
fn cohesive_soil_stands_to_its_depth_of_tension() {
    let cohesion = 8e3;
    let strength = strength(25.0).with_cohesion(cohesion).unwrap();
    let ActivePassive { active, passive } = ActivePassive::rankine(25.0);
    let tension_depth = 2.0 * cohesion / (UNIT_WEIGHT * active.sqrt());
    assert!(tension_depth > 0.5 && tension_depth < 3.0);
    let expected = ActivePassive {
        active: 0.5 * active * UNIT_WEIGHT * (TRENCH_DEPTH - tension_depth).powi(2),
        passive: 0.5 * passive * UNIT_WEIGHT * TRENCH_DEPTH * TRENCH_DEPTH
            + 2.0 * cohesion * passive.sqrt() * TRENCH_DEPTH,
    };
    let thrusts = thrusts_at_limits(ground(soil(), 3), &[strength], 3.0 * expected.passive);
    thrusts.assert_close_to(expected);
}

/// Soil follows the wall that moves away, and resists at once when it returns.
#[test]
fn soil_behind_a_wall_ratchets() {
    let ground = ground(soil(), 2);
    let laws = ground
        .interfaces(Coulomb::new(0.0).unwrap(), &[strength(30.0)], STANDARD_GRAVITY)
        .unwrap();
    let limits = ActivePassive::rankine(30.0).thrusts();
    let push = 1.2 * (limits.passive - limits.active);
    let times = [0.0, 0.3, 0.6, 0.9];
    let load = Load::table(thrust_direction(), &times, &[0.0, push, -push, -push]).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(buried_block())
        .ground(ground)
        .interfaces(laws)
        .load(load)
        .expected_steps(90)
        .build()
        .unwrap();
    let mut smallest_thrust = f64::INFINITY;
    let mut largest_thrust = 0.0_f64;
    let mut lowest_energy = 0.0_f64;
    let run = simulation
        .run(90, |state| {
            let left_wall = state.face(Face::LeftWall);
            assert_eq!(left_wall.open_fraction, 0.0);
            smallest_thrust = smallest_thrust.min(left_wall.thrust);
            largest_thrust = largest_thrust.max(left_wall.thrust);
            lowest_energy = lowest_energy.min(state.energy_balance.contact);
        })
        .unwrap();
    ActivePassive { active: smallest_thrust, passive: largest_thrust }.assert_close_to(limits);
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    // Soil that follows the left wall does work; in total the walls dissipate more.
    let energy = simulation.state().energy_balance;
    assert!(
        lowest_energy < 0.0 && energy.contact > -10.0 * lowest_energy,
        "{lowest_energy} {energy:?}"
    );
}

/// Soil beside a wall with random strength, limits of its pressure and laws of a random base.
struct RandomWall {
    seed: u64,
    wall_elements: usize,
    cohesion: f64,
    /// Active and passive pressure of each element, Pa.
    pressure_limits: Vec<[f64; 2]>,
    laws: Vec<Box<dyn InterfaceLaw>>,
}

impl RandomWall {
    fn new(seed: u64, random: &mut Random) -> Self {
        let wall_elements = random.pick(&[2, 3, 4]);
        let angle = random.within(20.0, 42.0).to_radians();
        let cohesion = random.pick(&[0.0, 0.0, 5e3, 20e3]);
        let strength = SoilStrength::new(angle).unwrap().with_cohesion(cohesion).unwrap();
        let wall_friction = random.pick(&[0.0, 0.5, 0.8]) * angle;
        let strength = strength.with_wall_friction(wall_friction).unwrap();
        let ground = ground(soil(), wall_elements);
        let friction = Coulomb::new(random.pick(&[0.0, 0.3, 0.8])).unwrap();
        let laws = if random.chance(0.8) {
            ground.interfaces(friction, &[strength], STANDARD_GRAVITY)
        } else {
            ground.interfaces(Bonded, &[strength], STANDARD_GRAVITY)
        };
        let mut pressure_limits = Vec::new();
        for element in elements(wall_elements).elements() {
            let stress_above = -UNIT_WEIGHT * element.center()[2];
            pressure_limits.push(strength.pressures(stress_above).map(|limit| limit.max(0.0)));
        }
        Self { seed, wall_elements, cohesion, pressure_limits, laws: laws.unwrap() }
    }

    /// Scene of the block beside this wall under random shaking.
    fn simulation(&mut self, random: &mut Random) -> Simulation {
        let record = el_centro_1940().scaled(random.log_within(0.5, 8.0)).unwrap();
        let vertical = random.chance(0.5).then(|| record.scaled(0.6).unwrap());
        let surface = VerticalIncidence { horizontal: Some(record), vertical };
        let ground = ground(soil(), self.wall_elements);
        let motion = TrenchMotion::new(&ground, surface, &mut unobserved).unwrap();
        let stiffness = random.log_within(1e7, 1e8);
        let springs = TrenchSprings::new(&elements(self.wall_elements), stiffness, 4e5);
        Simulation::builder(random.log_within(0.005, 0.02))
            .structure(walled_block())
            .ground(springs)
            .interfaces(std::mem::take(&mut self.laws))
            .motion(motion)
            .build()
            .unwrap()
    }

    fn assert_pressures_are_within_limits(&self, state: &State) {
        for (index, contact) in state.contact.iter().enumerate() {
            let [active, passive] = self.pressure_limits[index];
            let is_wall = index < self.wall_elements || index >= self.wall_elements + 4;
            let tolerance = 1e-9 * passive;
            let is_within =
                contact.pressure > active - tolerance && contact.pressure < passive + tolerance;
            // In an element across the depth of tension the mean of the active pressure is above zero.
            assert!(
                !is_wall || is_within || self.cohesion > 0.0,
                "{} {index}: {contact:?}",
                self.seed
            );
        }
    }
}

/// With random strengths, shaking and base the balance closes, and pressures keep their limits.
#[test]
fn energy_balance_closes_with_limits_of_wall_pressure() {
    let scenes = if heavy() { 400 } else { 30 };
    let mut modes = BTreeSet::new();
    let mut largest_error = 0.0_f64;
    for seed in 0..scenes {
        let random = &mut Random(2600 + seed);
        let mut wall = RandomWall::new(seed, random);
        let mut simulation = wall.simulation(random);
        let run = simulation.run(400, |state| {
            modes.extend(state.modes.iter().copied());
            wall.assert_pressures_are_within_limits(state);
        });
        largest_error = largest_error.max(run.unwrap().energy_error);
    }
    println!("{largest_error:e}; {modes:?}");
    assert!(largest_error < 1e-9, "{largest_error:e}");
    for mode in [Mode::Active, Mode::ActiveLeft, Mode::ActiveRight, Mode::Yield, Mode::YieldLeft] {
        assert!(modes.contains(&mode), "{modes:?}");
    }
}

/// Pressure, stress of the soil above (Pa) and depth (m) of a warning of walls beyond passive pressure.
fn wall_warning(run: &Run) -> Option<[f64; 3]> {
    run.warnings.iter().find_map(|warning| match warning {
        Warning::WallPressure { pressure, above, z, .. } => Some([*pressure, *above, *z]),
        _ => None,
    })
}

/// Run of the block under El Centro times a factor with these laws.
fn run_with_laws(factor: f64, laws: Vec<Box<dyn InterfaceLaw>>) -> Run {
    let ground = ground(soil(), 3);
    let record = el_centro_1940().scaled(factor).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(walled_block())
        .ground(TrenchSprings::new(&elements(3), 4e7, 4e5).with_mass_above(&ground))
        .interfaces(laws)
        .motion(TrenchMotion::new(&ground, record, &mut unobserved).unwrap())
        .build()
        .unwrap();
    simulation.run(400, |_| {}).unwrap()
}

/// Pressure beyond the passive one of strong soil causes a warning; with laws that limit it there is none.
#[test]
fn walls_beyond_passive_pressure_warn() {
    let base = Coulomb::new(0.5).unwrap();
    let wall = Coulomb::new(0.3).unwrap();
    let run_beyond_passive_pressure = run_with_laws(2.0, elements(3).interfaces(base, wall));
    let [pressure, stress_above, z] =
        wall_warning(&run_beyond_passive_pressure).expect("a warning");
    let element_of_the_warning = run_beyond_passive_pressure
        .envelope
        .iter()
        .find(|entry| entry.element.center()[2] == z)
        .unwrap();
    assert!((stress_above + UNIT_WEIGHT * z).abs() < 1e-9 * stress_above);
    assert!(pressure > 5.83 * stress_above);
    assert!(
        element_of_the_warning.pressure.highest.value > 0.0
            && run_beyond_passive_pressure.to_string().contains("soil of 45°")
    );
    let passive_laws =
        ground(soil(), 3).interfaces(base, &[strength(32.0)], STANDARD_GRAVITY).unwrap();
    assert_eq!(wall_warning(&run_with_laws(2.0, passive_laws)), None);
    assert_eq!(wall_warning(&run_with_laws(0.05, elements(3).interfaces(base, wall))), None);
}

/// Pressure at rest below the active pressure, and other lists of strengths, are errors.
#[test]
fn impossible_strengths_are_errors() {
    let base = Coulomb::new(0.5).unwrap();
    let ground_at_low_pressure =
        TrenchGround::new(soil(), elements(2)).unwrap().with_pressure_at_rest(0.2).unwrap();
    let laws = ground_at_low_pressure.interfaces(base, &[strength(30.0)], STANDARD_GRAVITY);
    let Err(error) = laws else { panic!() };
    assert!(matches!(error, Error::Item { .. }), "{error:?}");
    let text = error.to_string();
    assert!(text.contains("wall element 0") && text.contains("with_pressure_at_rest"), "{text}");
    let ground = ground(soil(), 2);
    for gravity in [0.0, -9.81, f64::NAN, f64::INFINITY] {
        assert!(ground.interfaces(base, &[strength(30.0)], gravity).is_err());
    }
    for count in [0, 2] {
        let strengths = vec![strength(30.0); count];
        let result = ground.interfaces(base, &strengths, STANDARD_GRAVITY).map(drop);
        assert!(matches!(result, Err(Error::Size { .. })), "{result:?}");
    }
}
