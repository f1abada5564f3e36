//! GOAL: structures in a trench start from the soil's pressures at rest; yielding soil limits the thrust on walls.
//! SCENE: blocks in half-planes and layers, as heavy as the soil dug out, heavier and lighter; rigid, and bonded.
//! REFERENCE: the soil itself; frictionless equilibrium on the ground's compliance, solved by elimination; Rankine's
//! passive thrust.

use basemat::bem::Ground;
use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::coupled::{Face, GravityStage, Load};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Yielding};
use basemat::motion::STANDARD_GRAVITY;
use basemat::results::Recorder;
use basemat::soil::SoilProfile;
use basemat::structure::{DofCombination, RigidBlock, WithWalls};
use basemat::{Simulation, Soil};
use basemat_problems::dense::solve;

use super::trench_springs::{SOIL_DENSITY, TRENCH_DEPTH, TRENCH_WIDTH, soil};

/// K₀: horizontal over vertical pressure at rest.
const PRESSURE_RATIO_AT_REST: f64 = 0.5;

fn elements() -> TrenchElements {
    Trench::new(-0.5 * TRENCH_WIDTH..0.5 * TRENCH_WIDTH, TRENCH_DEPTH)
        .unwrap()
        .elements(4, 2)
        .unwrap()
}

fn ground(profile: impl Into<SoilProfile>) -> TrenchGround {
    TrenchGround::new(profile, elements())
        .unwrap()
        .with_pressure_at_rest(PRESSURE_RATIO_AT_REST)
        .unwrap()
}

/// Block of the trench's size and of this density in place of the soil.
fn buried_block(profile: impl Into<SoilProfile>, density: f64, bonded: bool) -> Simulation {
    let block = RigidBlock::new(TRENCH_WIDTH, TRENCH_DEPTH, density).unwrap();
    let builder = Simulation::builder(0.01)
        .structure(WithWalls::new(block, TRENCH_DEPTH).unwrap())
        .ground(ground(profile))
        .gravity_stage(GravityStage::WishedInPlace)
        .expected_steps(4);
    let friction = Coulomb::new(0.4).unwrap();
    let builder = if bonded { builder.interface(Bonded) } else { builder.interface(friction) };
    builder.build().unwrap()
}

/// Tractions of all elements, Pa.
struct Tractions {
    pressure: Vec<f64>,
    shear: Vec<f64>,
}

fn tractions(simulation: &Simulation) -> Tractions {
    let contact = &simulation.state().contact;
    Tractions {
        pressure: contact.iter().map(|element| element.pressure).collect(),
        shear: contact.iter().map(|element| element.shear).collect(),
    }
}

/// Soil put back into its trench has the pressures of the soil, and no shear.
#[test]
fn a_block_of_soil_changes_nothing() {
    let upper = Soil::from_shear_wave_speed(150.0, 0.35, 1600.0).unwrap();
    let layered = SoilProfile::on_half_plane(soil()).with_layer(upper, 2.0).unwrap();
    let homogeneous_mass = SOIL_DENSITY * TRENCH_DEPTH;
    let layered_mass = 2.0 * 1600.0 + (TRENCH_DEPTH - 2.0) * SOIL_DENSITY;
    let tolerance = 1e-9 * STANDARD_GRAVITY * homogeneous_mass;
    for (profile, mass) in [(soil().into(), homogeneous_mass), (layered, layered_mass)] {
        for bonded in [false, true] {
            let mut simulation = buried_block(profile.clone(), mass / TRENCH_DEPTH, bonded);
            let Tractions { pressure, shear } = tractions(&simulation);
            let description = ground(profile.clone()).description();
            for (computed, expected) in pressure.iter().zip(description.pressure_at_rest) {
                assert!((computed - STANDARD_GRAVITY * expected).abs() < tolerance);
            }
            assert!(shear.iter().all(|value| value.abs() < tolerance));
            let thrust = simulation.state().face(Face::Base).thrust;
            assert!((thrust / (STANDARD_GRAVITY * mass * TRENCH_WIDTH) - 1.0).abs() < 1e-9);
            for _ in 0..4 {
                let state = simulation.step().unwrap();
                for (contact, initial) in state.contact.iter().zip(&pressure) {
                    assert!((contact.pressure - initial).abs() < tolerance);
                }
            }
        }
    }
}

/// Depth of the boundary between two soils, m.
const LAYER_BOUNDARY_DEPTH: f64 = 2.3;
/// Depth of the trench in two soils, m.
const DEEP_TRENCH_DEPTH: f64 = 6.0;

/// Thrust over gravity (kg/m) of two soils with these pressure ratios, and its height above the base (m).
fn thrust_and_height(upper_ratio: f64, lower_ratio: f64) -> (f64, f64) {
    let lower_thickness = DEEP_TRENCH_DEPTH - LAYER_BOUNDARY_DEPTH;
    // The triangle in the upper soil; the rectangle and the triangle in the lower one.
    let thrusts = [
        upper_ratio * (0.5 * 1600.0 * LAYER_BOUNDARY_DEPTH * LAYER_BOUNDARY_DEPTH),
        lower_ratio * (1600.0 * LAYER_BOUNDARY_DEPTH * lower_thickness),
        lower_ratio * (0.5 * 2000.0 * lower_thickness * lower_thickness),
    ];
    let heights = [
        lower_thickness + LAYER_BOUNDARY_DEPTH / 3.0,
        0.5 * lower_thickness,
        lower_thickness / 3.0,
    ];
    let thrust: f64 = thrusts.iter().sum();
    let moment = thrusts.iter().zip(heights).map(|(thrust, height)| thrust * height).sum::<f64>();
    (thrust, moment / thrust)
}

/// A block in a trench through two soils; `None` for the pressure ratios of elastic soils.
fn block_in_two_soils(pressure_ratio: Option<f64>, wall_elements: usize) -> Simulation {
    let upper = Soil::from_shear_wave_speed(150.0, 0.35, 1600.0).unwrap();
    let lower = Soil::from_shear_wave_speed(220.0, 0.3, 2000.0).unwrap();
    let profile = SoilProfile::on_half_plane(lower).with_layer(upper, LAYER_BOUNDARY_DEPTH);
    let trench = Trench::new(-5.0..5.0, DEEP_TRENCH_DEPTH).unwrap();
    let elements = trench.elements(2, wall_elements).unwrap();
    let ground = TrenchGround::new(profile.unwrap(), elements).unwrap();
    let ground = match pressure_ratio {
        Some(ratio) => ground.with_pressure_at_rest(ratio).unwrap(),
        None => ground,
    };
    let block = RigidBlock::new(10.0, 12.0, 900.0).unwrap();
    Simulation::builder(0.02)
        .structure(WithWalls::new(block, DEEP_TRENCH_DEPTH).unwrap())
        .ground(ground)
        .interface(Coulomb::new(0.4).unwrap())
        .expected_steps(1)
        .build()
        .unwrap()
}

/// Pressures at rest act at the height ∫K₀σ_v z dz/∫K₀σ_v dz for any number of elements.
#[test]
fn thrusts_at_rest_act_at_their_exact_height() {
    for (pressure_ratio, upper_ratio, lower_ratio, height_by_hand) in
        [(Some(0.5), 0.5, 0.5, 1.9334), (None, 0.35 / 0.65, 0.3 / 0.7, 2.0177)]
    {
        let (thrust, height) = thrust_and_height(upper_ratio, lower_ratio);
        assert!((height - height_by_hand).abs() < 1e-4, "{height}");
        for wall_elements in [2, 6] {
            let simulation = block_in_two_soils(pressure_ratio, wall_elements);
            let series = Recorder::new().contact(1).start(&simulation).unwrap();
            for wall in [Face::LeftWall, Face::RightWall] {
                let face = simulation.state().face(wall);
                assert!((face.thrust / (STANDARD_GRAVITY * thrust) - 1.0).abs() < 1e-12);
                let error = (face.place - height).abs();
                assert!(error < 1e-12 * DEEP_TRENCH_DEPTH, "{} {height}", face.place);
                assert_eq!(series.face(wall).next(), Some(face));
            }
        }
    }
}

fn largest_absolute(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
}

/// A block with its weight on the base and K₀ on the walls stays as it is without motion.
#[test]
fn a_block_in_its_trench_stays_at_rest() {
    let block = RigidBlock::new(TRENCH_WIDTH, 3.0 * TRENCH_DEPTH, 0.5 * SOIL_DENSITY).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(WithWalls::new(block, TRENCH_DEPTH).unwrap())
        .ground(ground(soil()))
        .interface(Coulomb::new(0.4).unwrap())
        .expected_steps(200)
        .build()
        .unwrap();
    let at_rest = tractions(&simulation);
    simulation.run(200, |_| {}).unwrap();
    let largest_pressure = at_rest.pressure.iter().copied().fold(0.0_f64, f64::max);
    let at_end = tractions(&simulation);
    for (end, start) in [(at_end.pressure, at_rest.pressure), (at_end.shear, at_rest.shear)] {
        for (end, start) in end.iter().zip(&start) {
            assert!((end - start).abs() < 1e-12 * largest_pressure, "{end} {start}");
        }
    }
    let settlement = largest_absolute(simulation.static_displacement());
    let displacement = largest_absolute(simulation.state().displacement());
    assert!(displacement < 1e-12 * settlement, "{displacement}");
}

/// A wall pushed into soil that yields under K_p times its weight bears at most K_p γ d²/2.
#[test]
fn a_pushed_wall_bears_the_passive_thrust() {
    let friction_angle = 30.0_f64.to_radians();
    let passive = (0.25 * std::f64::consts::PI + 0.5 * friction_angle).tan().powi(2);
    let unit_weight = SOIL_DENSITY * STANDARD_GRAVITY;
    let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
    for element in elements().elements() {
        if element.directions()[0][2] < -0.5 {
            laws.push(Box::new(Coulomb::new(0.0).unwrap()));
        } else {
            // The mean stress of the soil above over the element.
            let strength = -passive * unit_weight * element.center()[2];
            laws.push(Box::new(Yielding::new(strength, 0.0).unwrap()));
        }
    }
    let block = RigidBlock::new(TRENCH_WIDTH, TRENCH_DEPTH, SOIL_DENSITY).unwrap();
    let block = WithWalls::new(block, TRENCH_DEPTH).unwrap();
    let expected = 0.5 * passive * unit_weight * TRENCH_DEPTH * TRENCH_DEPTH;
    // Through the middle of the walls' thrust, so that all of the wall is pushed in.
    let right = DofCombination::of_base(&block, [0.0, 0.0, TRENCH_DEPTH / 3.0]).unwrap()[0].clone();
    let forces = [0.0, 3.0 * expected, 3.0 * expected];
    let push = Load::table(right, &[0.0, 0.5, 10.0], &forces).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(block)
        .ground(ground(soil()))
        .interfaces(laws)
        .load(push)
        .expected_steps(100)
        .build()
        .unwrap();
    let mut largest_thrust = 0.0_f64;
    let run = simulation
        .run(100, |state| largest_thrust = largest_thrust.max(state.face(Face::RightWall).thrust))
        .unwrap();
    assert!((largest_thrust / expected - 1.0).abs() < 1e-9, "{largest_thrust} {expected}");
    let state = simulation.state();
    assert!((state.face(Face::RightWall).thrust / expected - 1.0).abs() < 1e-9);
    assert_eq!(state.face(Face::LeftWall).open_fraction, 1.0);
    assert!(run.energy_error < 1e-9 && state.energy_balance.contact > 0.0);
}

/// Pressures under a heavy block without friction satisfy S_nn (p − p₀) = B u and Σ p = W.
#[test]
fn a_heavy_block_presses_its_walls() {
    let density = 2.5 * SOIL_DENSITY;
    let Tractions { pressure, shear } = tractions(&buried_block(soil(), density, false));
    let ground = ground(soil());
    let elements = ground.elements();
    let count = pressure.len();
    let mut compliance = vec![0.0; 4 * count * count];
    ground.static_compliance(&mut compliance).unwrap();
    let mass_at_rest = ground.description().pressure_at_rest;
    let at_rest: Vec<f64> = mass_at_rest.iter().map(|mass| STANDARD_GRAVITY * mass).collect();
    let mut matrix = vec![vec![0.0; count + 1]; count + 1];
    let mut load = vec![0.0; count + 1];
    for i in 0..count {
        for j in 0..count {
            matrix[i][j] = compliance[i * 2 * count + j];
            load[i] += compliance[i * 2 * count + j] * at_rest[j];
        }
        // A unit settlement moves elements of the base into the soil; by symmetry there is no other motion.
        let is_base = elements[i].heights()[0] == elements[i].heights()[1];
        let settlement = if is_base { 1.0 } else { 0.0 };
        matrix[i][count] = -settlement;
        matrix[count][i] = settlement * elements[i].length();
    }
    load[count] = STANDARD_GRAVITY * density * TRENCH_WIDTH * TRENCH_DEPTH;
    let expected = solve(&matrix, &load);
    let stress_above = STANDARD_GRAVITY * SOIL_DENSITY * TRENCH_DEPTH;
    for e in 0..count {
        assert!(expected[e] > 0.0, "{e}");
        assert!((pressure[e] - expected[e]).abs() < 1e-6 * stress_above, "{e}");
        assert!(shear[e].abs() < 1e-9 * stress_above);
    }
    // Walls keep the soil beside the base from moving in.
    assert!(pressure[0] > 1.5 * at_rest[0], "{pressure:?} {at_rest:?}");
}

/// A light block opens its base; a bonded block hangs on its walls.
#[test]
fn a_light_block_opens_unless_it_is_bonded() {
    let density = 0.2 * SOIL_DENSITY;
    let weight = STANDARD_GRAVITY * density * TRENCH_WIDTH * TRENCH_DEPTH;
    let unbonded_block = buried_block(soil(), density, false);
    let base = unbonded_block.state().face(Face::Base);
    assert!(base.open_fraction > 0.0 && (base.thrust / weight - 1.0).abs() < 1e-9, "{base:?}");
    let bonded = buried_block(soil(), density, true);
    let state = bonded.state();
    let base = state.face(Face::Base);
    // The force acts upwards on the soil.
    let wall_force = state.face(Face::RightWall).shear - state.face(Face::LeftWall).shear;
    assert!(base.open_fraction == 0.0, "{base:?}");
    assert!(wall_force.abs() > 0.1 * weight, "{wall_force} {weight}");
    assert!((base.thrust - wall_force - weight).abs() < 1e-9 * weight);
}
