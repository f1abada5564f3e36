//! GOAL: walls bear no more than the passive and no less than the active thrust of the soil, and energy balances.
//! SCENE: smooth and rough blocks in trenches in one and two soils, with and without cohesion, pushed to the side and
//! back; strong shaking on springs and in the half-plane. HEAVY_TESTS: 400 scenes, else 30.
//! REFERENCE: Rankine's thrusts, integrated by hand; the energy balance.

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::coupled::{Face, Load, State, Warning};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Mode};
use basemat::motion::{STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::soil::{SoilProfile, SoilStrength};
use basemat::structure::{DofCombination, RigidBlock, WithWalls};
use basemat::{Error, Simulation, Soil, unobserved};

use basemat_problems::heavy;
use basemat_problems::random::Random;

use super::embedded::{Bed, DENSITY, DEPTH, WIDTH, block, soil};

const UNIT_WEIGHT: f64 = DENSITY * STANDARD_GRAVITY;

fn elements(wall: usize) -> TrenchElements {
    Trench::new(-0.5 * WIDTH..0.5 * WIDTH, DEPTH).unwrap().elements(4, wall).unwrap()
}

fn ground(profile: impl Into<SoilProfile>, wall: usize) -> TrenchGround {
    TrenchGround::new(profile, elements(wall)).unwrap().with_pressure_at_rest(0.5).unwrap()
}

fn strength(degrees: f64) -> SoilStrength {
    SoilStrength::new(degrees.to_radians()).unwrap()
}

/// Rankine's active and passive coefficient.
fn rankine(degrees: f64) -> [f64; 2] {
    [-1.0, 1.0].map(|sign| (45.0 + 0.5 * sign * degrees).to_radians().tan().powi(2))
}

/// Thrusts on the left and the right wall of a block pushed to the right until both walls are at their limits.
fn pushed(ground: TrenchGround, strengths: &[SoilStrength], push: f64) -> [f64; 2] {
    let laws = ground.interfaces(Coulomb::new(0.0).unwrap(), strengths, STANDARD_GRAVITY).unwrap();
    let block = WithWalls::new(RigidBlock::new(WIDTH, DEPTH, DENSITY).unwrap(), DEPTH).unwrap();
    // Through the middle of the walls' thrust, so that all of the wall moves.
    let right = DofCombination::of_base(&block, [0.0, 0.0, DEPTH / 3.0]).unwrap()[0].clone();
    let load = Load::table(right, &[0.0, 0.5, 10.0], &[0.0, push, push]).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(block)
        .ground(ground)
        .interfaces(laws)
        .load(load)
        .expected_steps(80)
        .build()
        .unwrap();
    let run = simulation.run(80, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    let is_wall = |own: &&Warning| matches!(own, Warning::WallPressure { .. });
    assert_eq!(run.warnings.iter().find(is_wall), None);
    [Face::LeftWall, Face::RightWall].map(|wall| simulation.state().face(wall).thrust)
}

#[track_caller]
fn assert_close(found: [f64; 2], wanted: [f64; 2]) {
    for (found, wanted) in found.into_iter().zip(wanted) {
        assert!((found - wanted).abs() < 1e-9 * wanted.abs().max(1.0), "{found} {wanted}");
    }
}

#[test]
fn walls_that_are_pushed_bear_active_and_passive_thrust() {
    let wanted = rankine(30.0).map(|ratio| 0.5 * ratio * UNIT_WEIGHT * DEPTH * DEPTH);
    for wall in [2, 3] {
        let found = pushed(ground(soil(), wall), &[strength(30.0)], 3.0 * wanted[1]);
        assert_close(found, wanted);
    }
}

/// Two soils: 2 m of 1600 kg/m³, the other below; the boundary is inside an element.
#[test]
fn thrusts_of_two_soils_are_exact() {
    let upper = Soil::from_shear_wave_speed(150.0, 0.35, 1600.0).unwrap();
    let profile = SoilProfile::on_half_plane(soil()).with_layer(upper, 2.0).unwrap();
    let [one, other] = [rankine(28.0), rankine(36.0)];
    let weight = 1600.0 * STANDARD_GRAVITY * 2.0;
    let wanted = [0, 1]
        .map(|k| one[k] * 0.5 * weight * 2.0 + other[k] * (weight * 3.0 + 0.5 * UNIT_WEIGHT * 9.0));
    let found = pushed(ground(profile, 3), &[strength(28.0), strength(36.0)], 3.0 * wanted[1]);
    assert_close(found, wanted);
}

/// Above z₀ = 2c/(γ √K_a) the soil stands without the wall, which opens.
#[test]
fn cohesive_soil_stands_to_its_depth_of_tension() {
    let cohesion = 8e3;
    let strength = strength(25.0).with_cohesion(cohesion).unwrap();
    let [active, passive] = rankine(25.0);
    let stands = 2.0 * cohesion / (UNIT_WEIGHT * active.sqrt());
    assert!(stands > 0.5 && stands < 3.0);
    let wanted = [
        0.5 * active * UNIT_WEIGHT * (DEPTH - stands).powi(2),
        0.5 * passive * UNIT_WEIGHT * DEPTH * DEPTH + 2.0 * cohesion * passive.sqrt() * DEPTH,
    ];
    assert_close(pushed(ground(soil(), 3), &[strength], 3.0 * wanted[1]), wanted);
}

/// Soil follows the wall that moves away, and resists at once when it returns.
#[test]
fn soil_behind_a_wall_ratchets() {
    let ground = ground(soil(), 2);
    let laws =
        ground.interfaces(Coulomb::new(0.0).unwrap(), &[strength(30.0)], STANDARD_GRAVITY).unwrap();
    let [active, passive] = rankine(30.0).map(|ratio| 0.5 * ratio * UNIT_WEIGHT * DEPTH * DEPTH);
    let block = WithWalls::new(RigidBlock::new(WIDTH, DEPTH, DENSITY).unwrap(), DEPTH).unwrap();
    let right = DofCombination::of_base(&block, [0.0, 0.0, DEPTH / 3.0]).unwrap()[0].clone();
    let push = 1.2 * (passive - active);
    let times = [0.0, 0.3, 0.6, 0.9];
    let load = Load::table(right, &times, &[0.0, push, -push, -push]).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(block)
        .ground(ground)
        .interfaces(laws)
        .load(load)
        .expected_steps(90)
        .build()
        .unwrap();
    let [mut least, mut back] = [f64::INFINITY, 0.0_f64];
    let mut lowest = 0.0_f64;
    let run = simulation
        .run(90, |state| {
            let left = state.face(Face::LeftWall);
            assert_eq!(left.open_fraction, 0.0);
            least = least.min(left.thrust);
            back = back.max(left.thrust);
            lowest = lowest.min(state.energy_balance.contact);
        })
        .unwrap();
    assert_close([least, back], [active, passive]);
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    // Soil that follows the left wall gives work; in all the walls dissipate more.
    let energy = simulation.state().energy_balance;
    assert!(lowest < 0.0 && energy.contact > -10.0 * lowest, "{lowest} {energy:?}");
}

/// Random strengths, shaking and laws of the base: the balance closes, and pressures keep their limits.
#[test]
fn energy_balance_closes_with_limits_of_wall_pressure() {
    let scenes = if heavy() { 400 } else { 30 };
    let (mut seen, mut worst) = (std::collections::BTreeSet::new(), 0.0_f64);
    for seed in 0..scenes {
        let random = &mut Random(2600 + seed);
        let wall = random.pick(&[2, 3, 4]);
        let angle = random.within(20.0, 42.0).to_radians();
        let cohesion = random.pick(&[0.0, 0.0, 5e3, 20e3]);
        let strength = SoilStrength::new(angle)
            .and_then(|own| own.with_cohesion(cohesion))
            .and_then(|own| own.with_wall_friction(random.pick(&[0.0, 0.5, 0.8]) * angle))
            .unwrap();
        let beside = ground(soil(), wall);
        let friction = Coulomb::new(random.pick(&[0.0, 0.3, 0.8])).unwrap();
        let strengths = [strength];
        let laws = if random.chance(0.8) {
            beside.interfaces(friction, &strengths, STANDARD_GRAVITY)
        } else {
            beside.interfaces(Bonded, &strengths, STANDARD_GRAVITY)
        };
        let limits: Vec<[f64; 2]> = elements(wall)
            .elements()
            .iter()
            .map(|own| {
                let above = -UNIT_WEIGHT * own.center()[2];
                strength.pressures(above).map(|limit| limit.max(0.0))
            })
            .collect();
        let record = el_centro_1940().scaled(random.log_within(0.5, 8.0)).unwrap();
        let vertical = random.chance(0.5).then(|| record.scaled(0.6).unwrap());
        let on_elements = ground(soil(), wall);
        let surface = VerticalIncidence { horizontal: Some(record), vertical };
        let waves = TrenchMotion::new(&on_elements, surface, &mut unobserved).unwrap();
        let bed = Bed::new(&elements(wall), random.log_within(1e7, 1e8), 4e5);
        let mut simulation = Simulation::builder(random.log_within(0.005, 0.02))
            .structure(block())
            .ground(bed)
            .interfaces(laws.unwrap())
            .motion(waves)
            .build()
            .unwrap();
        let check = |state: &State| {
            seen.extend(state.modes.iter().copied());
            for (e, (own, [active, passive])) in state.contact.iter().zip(&limits).enumerate() {
                let is_wall = e < wall || e >= wall + 4;
                let slack = 1e-9 * passive;
                let is_within = own.pressure > active - slack && own.pressure < passive + slack;
                // In an element across the depth of tension the mean of the active pressure is above zero.
                assert!(!is_wall || is_within || cohesion > 0.0, "{seed} {e}: {own:?}");
            }
        };
        let run = simulation.run(400, check).unwrap();
        worst = worst.max(run.energy_error);
    }
    println!("{worst:e}; {seen:?}");
    assert!(worst < 1e-9, "{worst:e}");
    let walls = [Mode::Active, Mode::ActiveLeft, Mode::ActiveRight, Mode::Yield, Mode::YieldLeft];
    assert!(walls.iter().all(|mode| seen.contains(mode)), "{seen:?}");
}

/// A wall far beyond passive pressure is named, by what strong soil bears; with limits it is not.
#[test]
fn walls_beyond_passive_pressure_warn() {
    let run = |factor: f64, laws: &dyn Fn(&TrenchGround) -> Vec<Box<dyn InterfaceLaw>>| {
        let ground = ground(soil(), 3);
        let mut simulation = Simulation::builder(0.01)
            .structure(block())
            .ground(Bed::new(&elements(3), 4e7, 4e5).with_masses(&ground))
            .interfaces(laws(&ground))
            .motion(motion_of(&ground, factor))
            .build()
            .unwrap();
        let run = simulation.run(400, |_| {}).unwrap();
        let wall = run.warnings.iter().find_map(|own| match own {
            Warning::WallPressure { pressure, above, z, .. } => Some([*pressure, *above, *z]),
            _ => None,
        });
        (run, wall)
    };
    let plain = |_: &TrenchGround| -> Vec<Box<dyn InterfaceLaw>> {
        elements(3).interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap())
    };
    let limited = |ground: &TrenchGround| {
        let base = Coulomb::new(0.5).unwrap();
        ground.interfaces(base, &[strength(32.0)], STANDARD_GRAVITY).unwrap()
    };
    let (strong, found) = run(2.0, &plain);
    let [pressure, above, z] = found.expect("a warning");
    let kept = strong.envelope.iter().find(|own| own.element.center()[2] == z).unwrap();
    assert!((above + UNIT_WEIGHT * z).abs() < 1e-9 * above && pressure > 5.83 * above);
    assert!(kept.pressure.highest.value > 0.0 && strong.to_string().contains("soil of 45°"));
    assert_eq!(run(2.0, &limited).1, None);
    assert_eq!(run(0.05, &plain).1, None);
}

/// Pressure at rest below the active pressure, and other lists of strengths, are refused.
#[test]
fn impossible_strengths_are_refused() {
    let base = || Coulomb::new(0.5).unwrap();
    let low = TrenchGround::new(soil(), elements(2)).unwrap().with_pressure_at_rest(0.2).unwrap();
    let Err(error) = low.interfaces(base(), &[strength(30.0)], STANDARD_GRAVITY) else { panic!() };
    assert!(matches!(error, Error::Item { .. }), "{error:?}");
    let text = error.to_string();
    assert!(text.contains("wall element 0") && text.contains("with_pressure_at_rest"), "{text}");
    let ground = ground(soil(), 2);
    for gravity in [0.0, -9.81, f64::NAN, f64::INFINITY] {
        assert!(ground.interfaces(base(), &[strength(30.0)], gravity).is_err());
    }
    for count in [0, 2] {
        let strengths = vec![strength(30.0); count];
        let found = ground.interfaces(base(), &strengths, STANDARD_GRAVITY).map(drop);
        assert!(matches!(found, Err(Error::Size { .. })), "{found:?}");
    }
}

fn motion_of(ground: &TrenchGround, factor: f64) -> TrenchMotion {
    let record = el_centro_1940().scaled(factor).unwrap();
    TrenchMotion::new(ground, record, &mut unobserved).unwrap()
}
