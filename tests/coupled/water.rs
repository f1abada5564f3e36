//! GOAL: a water table lifts a base, presses on walls, and leaves contact with the effective pressures.
//! SCENE: blocks on half-planes and mats in plan below the water table, boxes in trenches; uplift and slip.
//! REFERENCE: statics of the rigid block; the same mass under less gravity; the uplift pressure as loads.

use basemat::bem::embedded::TrenchGround;
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::coupled::{
    Checkpoint, DissipativeMidpoint, Face, GravityStage, Load, Mistake, SimulationBuilder,
    StabilityError, State, Theta, Warning,
};
use basemat::fem::{Beam, Direction, Mesh};
use basemat::interface::{Bonded, Cohesive, Coulomb, Yielding};
use basemat::motion::{AtRest, Record, STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::results::Run;
use basemat::soil::WaterTable;
use basemat::structure::{DofCombination, FemModel, RigidBlock, RigidBody, WithWalls};
use basemat::{Error, Simulation, Soil};
use basemat_problems::random::Random;

use super::trench_springs::{
    BLOCK_HEIGHT, SOIL_DENSITY, TRENCH_DEPTH, TRENCH_WIDTH, soil, trench_elements, trench_motion,
};

pub(super) const WATER_DENSITY: f64 = 1000.0;
/// Height of the water above the base, m.
const WATER_HEAD: f64 = 4.0;
pub(super) const BASE_WIDTH: f64 = 10.0;
pub(super) const BLOCK_DENSITY: f64 = 1100.0;
pub(super) const BODY_HEIGHT: f64 = 12.0;
/// Buoyancy over weight.
const BUOYANT_FRACTION: f64 = WATER_DENSITY * WATER_HEAD / (BLOCK_DENSITY * BODY_HEIGHT);
const FRICTION_COEFFICIENT: f64 = 0.4;

fn water() -> WaterTable {
    WaterTable::at_depth(-WATER_HEAD).unwrap()
}

pub(super) fn block() -> RigidBlock {
    RigidBlock::new(BASE_WIDTH, BODY_HEIGHT, BLOCK_DENSITY).unwrap()
}

fn record(factor: f64) -> Record {
    el_centro_1940().scaled(factor).unwrap()
}

/// The block on a half-plane under a strong record: it uplifts and slides.
pub(super) fn shaken_block() -> SimulationBuilder {
    Simulation::builder(0.01)
        .ground(
            ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0).unwrap(), &block(), 12).unwrap(),
        )
        .structure(block())
        .interface(Coulomb::new(FRICTION_COEFFICIENT).unwrap())
        .motion(record(2.5))
}

/// A rigid body on a mat in plan, shaken in three directions.
fn shaken_body() -> SimulationBuilder {
    let body =
        RigidBody::cuboid([BASE_WIDTH, 0.8 * BASE_WIDTH, BODY_HEIGHT], BLOCK_DENSITY).unwrap();
    let motion = Triaxial { x: Some(record(2.0)), y: Some(record(1.2)), up: Some(record(0.5)) };
    Simulation::builder(0.01)
        .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0).unwrap(), &body, 5).unwrap())
        .structure(body)
        .interface(Coulomb::new(FRICTION_COEFFICIENT).unwrap())
        .motion(motion)
}

/// States before and after each step of a run, and its summary.
struct RecordedStates {
    states: Vec<State>,
    summary: Run,
}

impl RecordedStates {
    fn of(builder: SimulationBuilder, steps: usize) -> Self {
        let mut simulation = builder.build().unwrap();
        let mut states = vec![simulation.state().clone()];
        let summary = simulation.run(steps, |state| states.push(state.clone())).unwrap();
        Self { states, summary }
    }

    /// Largest difference of tractions over the largest pressure, and of gaps and slips over the largest.
    fn difference(&self, other: &Self) -> f64 {
        let mut scales = [0.0_f64; 2];
        let mut differences = [0.0_f64; 2];
        for (state, other) in self.states.iter().zip(&other.states) {
            for (a, b) in state.contact.iter().zip(&other.contact) {
                for (k, [a, b]) in [
                    (0, [a.pressure, b.pressure]),
                    (0, [a.shear, b.shear]),
                    (0, [a.shear_across, b.shear_across]),
                    (1, [a.gap, b.gap]),
                    (1, [a.slip, b.slip]),
                    (1, [a.slip_across, b.slip_across]),
                ] {
                    scales[k] = scales[k].max(a.abs());
                    differences[k] = differences[k].max((a - b).abs());
                }
            }
        }
        (differences[0] / scales[0]).max(differences[1] / scales[1])
    }
}

/// Full mass under the effective weight: the gravity that gives this weight in place of the water.
#[test]
fn a_block_in_water_is_one_of_less_weight_and_full_mass() {
    let less_gravity = STANDARD_GRAVITY * (1.0 - BUOYANT_FRACTION);
    for (name, scene, steps) in
        [("plane", shaken_block as fn() -> SimulationBuilder, 1500), ("plan", shaken_body, 500)]
    {
        // A static state is itself accurate to 1e-10.
        for (stage, limit) in [
            (GravityStage::Unloaded, 1e-12),
            (GravityStage::Frictionless, 1e-10),
            (GravityStage::Frictional, 1e-10),
        ] {
            let in_water =
                RecordedStates::of(scene().gravity_stage(stage).water_table(water()), steps);
            let lighter =
                RecordedStates::of(scene().gravity_stage(stage).gravity(less_gravity), steps);
            let change = in_water.difference(&lighter);
            assert!(change < limit, "{name} {stage:?}: {change:e}");
            let run = &in_water.summary;
            // The run must uplift and slide, else it shows nothing.
            assert!(run.whole.uplifted_fraction.highest.value > 0.3, "{name}");
            assert!(run.whole.sliding.path > 1e-3, "{name} {}", run.whole.sliding.path);
            assert!(run.energy_error < 1e-9, "{name} {:e}", run.energy_error);
            let sliding = run.whole.sliding_safety.lowest.value;
            let expected = lighter.summary.whole.sliding_safety.lowest.value;
            assert!((sliding / expected - 1.0).abs() < 1e-9, "{name}");
            let input = run.energy_balance.input;
            assert!((input / lighter.summary.energy_balance.input - 1.0).abs() < 1e-9, "{name}");
            let dry = RecordedStates::of(scene().gravity_stage(stage), 300);
            assert!(in_water.difference(&dry) > 0.1, "{name}");
        }
    }
}

/// Random blocks, laws, grounds and water: as above, and the balance of energy.
#[test]
fn random_blocks_in_water_close_their_balance() {
    let mut random = Random(68);
    let mut uplifted_count = 0;
    for scene in 0..24 {
        let width = random.within(4.0, 20.0);
        let height = width * random.within(0.4, 1.8);
        let density = random.within(300.0, 2000.0);
        let head = random.within(0.1, 0.85) * height * density / WATER_DENSITY;
        let friction = random.within(0.2, 0.8);
        let count = 4 + scene % 7;
        let block = RigidBlock::new(width, height, density).unwrap();
        let scheme_choice = scene % 3;
        let builder = || {
            let builder = Simulation::builder(0.01)
                .structure(block.clone())
                .motion(record(random_factor(scene)))
                .ground(ElasticGround::under(soil(), &block, count).unwrap());
            let builder = match scheme_choice {
                0 => builder.scheme(DissipativeMidpoint::default()),
                1 => builder.scheme(Theta::new(0.6).unwrap()),
                _ => builder,
            };
            let bearing = 4.0 * density * STANDARD_GRAVITY * height;
            match scene % 4 {
                0 => builder.interface(Yielding::new(bearing, friction).unwrap()),
                1 => builder.interface(Cohesive::new(2.0e4, 2.0e4, friction).unwrap()),
                _ => builder.interface(Coulomb::new(friction).unwrap()),
            }
        };
        let table = WaterTable::at_depth(-head).unwrap();
        let in_water = RecordedStates::of(builder().water_table(table), 500);
        let gravity = STANDARD_GRAVITY * (1.0 - WATER_DENSITY * head / (density * height));
        let lighter = RecordedStates::of(builder().gravity(gravity), 500);
        let change = in_water.difference(&lighter);
        assert!(change < 1e-9, "{scene}: {change:e}");
        let run = &in_water.summary;
        assert!(run.energy_error < 1e-9, "{scene}: {:e}", run.energy_error);
        uplifted_count += usize::from(run.whole.uplifted_fraction.highest.value > 0.2);
    }
    assert!(uplifted_count > 8, "{uplifted_count}");
}

/// Factor of the record of a random scene.
fn random_factor(scene: usize) -> f64 {
    [0.8, 1.6, 2.4][scene % 3]
}

/// Effective force, and factors of safety of the block under a horizontal force at its top.
#[test]
fn static_factors_of_safety_are_those_of_the_effective_weight() {
    let weight = BLOCK_DENSITY * STANDARD_GRAVITY * BASE_WIDTH * BODY_HEIGHT;
    let buoyancy = WATER_DENSITY * STANDARD_GRAVITY * BASE_WIDTH * WATER_HEAD;
    let force = 0.1 * weight;
    let height = 3.0;
    let builder = shaken_block()
        .motion(AtRest)
        .water_table(water())
        .load(Load::constant(block().horizontal_at(height), force));
    let run = RecordedStates::of(builder, 1).summary;
    let effective_weight = weight - buoyancy;
    assert!((run.whole.static_normal_force / effective_weight - 1.0).abs() < 1e-9);
    assert!((run.buoyancy / buoyancy - 1.0).abs() < 1e-12, "{}", run.buoyancy);
    let sliding = run.whole.sliding_safety.lowest.value;
    assert!(
        (sliding / (FRICTION_COEFFICIENT * effective_weight / force) - 1.0).abs() < 1e-9,
        "{sliding}"
    );
    let overturning = run.whole.overturning_safety.lowest.value;
    let expected = effective_weight * 0.5 * BASE_WIDTH / (force * height);
    assert!((overturning / expected - 1.0).abs() < 1e-9, "{overturning} {expected}");
    assert!((run.shear_coefficient().unwrap() - 0.1).abs() < 1e-9);
    let page = run.to_string();
    let flotation = format!("factor of safety against flotation {:.3}", weight / buoyancy);
    assert!(page.contains(&flotation), "{page}");
    let line = format!("Effective weight on the base: {:.1} kN/m", 1e-3 * effective_weight);
    assert!(page.contains(&line), "{page}");
}

/// A slab that bends: the pressure of the water as a load on each part of the base.
#[test]
fn water_under_a_slab_that_bends_is_a_load_of_its_pressure() {
    let mut mesh = Mesh::new();
    let nodes: Vec<usize> =
        (0..=8).map(|k| mesh.add_node(1.5 * f64::from(k) - 6.0, 0.0).unwrap()).collect();
    for ends in nodes.windows(2) {
        mesh.add(Beam::new([ends[0], ends[1]], 30.0e9, 1.2, 0.144, 6000.0).unwrap()).unwrap();
    }
    let model = FemModel::on_base(mesh).unwrap();
    let mut uplift = DofCombination::default();
    for (k, node) in nodes.iter().enumerate() {
        let length = if k == 0 || k == 8 { 0.75 } else { 1.5 };
        uplift += length * model.row(*node, Direction::Y).unwrap();
    }
    let scene = || {
        Simulation::builder(0.01)
            .ground(ElasticGround::under(soil(), &model, 16).unwrap())
            .structure(model.clone())
            .interface(Coulomb::new(FRICTION_COEFFICIENT).unwrap())
            .motion(record(1.0))
    };
    let pressure = WATER_DENSITY * STANDARD_GRAVITY * WATER_HEAD;
    let in_water = RecordedStates::of(scene().water_table(water()), 600);
    let loaded = RecordedStates::of(scene().load(Load::weight(uplift, pressure)), 600);
    let change = in_water.difference(&loaded);
    assert!(change < 1e-9 && in_water.summary.energy_error < 1e-9, "{change:e}");
}

/// Dropped on springs: weight and water act from t = 0 on.
#[test]
fn water_acts_from_the_start_on_an_unloaded_base() {
    let scene = || {
        Simulation::builder(0.002)
            .ground(SpringGround::under(&block(), 8, 2.0e8, 1.0e8).unwrap())
            .structure(block())
            .interface(Coulomb::new(FRICTION_COEFFICIENT).unwrap())
            .gravity_stage(GravityStage::Unloaded)
            .initial_displacement([0.0, 0.02, 0.0])
    };
    let in_water = RecordedStates::of(scene().water_table(water()), 400);
    let less_gravity = STANDARD_GRAVITY * (1.0 - BUOYANT_FRACTION);
    let lighter = RecordedStates::of(scene().gravity(less_gravity), 400);
    let change = in_water.difference(&lighter);
    assert!(change < 1e-12 && in_water.summary.energy_error < 1e-9, "{change:e}");
}

/// A box in a trench, as heavy as the soil dug out: effective pressures are those of the soil under buoyancy.
#[test]
fn a_box_of_soil_under_water_changes_nothing() {
    let table = WaterTable::at_depth(1.7).unwrap();
    let ground = TrenchGround::new(soil(), trench_elements())
        .unwrap()
        .with_pressure_at_rest(0.5)
        .unwrap()
        .with_water_table(table)
        .unwrap();
    let pressures = ground.description().pressure_at_rest;
    let block = RigidBlock::new(TRENCH_WIDTH, TRENCH_DEPTH, SOIL_DENSITY).unwrap();
    let simulation = Simulation::builder(0.01)
        .structure(WithWalls::new(block, TRENCH_DEPTH).unwrap())
        .ground(ground)
        .gravity_stage(GravityStage::WishedInPlace)
        .interface(Coulomb::new(FRICTION_COEFFICIENT).unwrap())
        .build()
        .unwrap();
    let soil_mass = SOIL_DENSITY * TRENCH_DEPTH;
    let effective_mass = soil_mass - WATER_DENSITY * (TRENCH_DEPTH - 1.7);
    for (contact, pressure) in simulation.state().contact.iter().zip(&pressures) {
        let error = contact.pressure - STANDARD_GRAVITY * pressure;
        assert!(error.abs() < 1e-9 * STANDARD_GRAVITY * soil_mass, "{error}");
        assert!(contact.shear.abs() < 1e-9 * STANDARD_GRAVITY * soil_mass);
    }
    let thrust = simulation.state().face(Face::Base).thrust;
    assert!((thrust / (STANDARD_GRAVITY * effective_mass * TRENCH_WIDTH) - 1.0).abs() < 1e-9);
}

/// A light box in a trench, with or without a water table at a depth of 1.7 m.
fn shaken_box(in_water: bool) -> Simulation {
    let block = RigidBlock::new(TRENCH_WIDTH, BLOCK_HEIGHT, 400.0).unwrap();
    let mut ground = TrenchGround::new(soil(), trench_elements()).unwrap();
    if in_water {
        ground = ground.with_water_table(WaterTable::at_depth(1.7).unwrap()).unwrap();
    }
    Simulation::builder(0.02)
        .structure(WithWalls::new(block, TRENCH_DEPTH).unwrap())
        .ground(ground)
        .interface(Coulomb::new(0.3).unwrap())
        .motion(trench_motion(record(1.5)))
        .build()
        .unwrap()
}

/// Weight = effective force + buoyancy in a trench; the balance stays closed; a resumed run has the same bits.
#[test]
fn a_shaken_box_in_water_balances_and_resumes() {
    let mut simulation = shaken_box(true);
    let weight = 400.0 * STANDARD_GRAVITY * TRENCH_WIDTH * BLOCK_HEIGHT;
    let buoyancy = WATER_DENSITY * STANDARD_GRAVITY * TRENCH_WIDTH * (TRENCH_DEPTH - 1.7);
    let normal_force = simulation.state().normal_force;
    assert!(((normal_force + buoyancy) / weight - 1.0).abs() < 1e-9);
    simulation.run(60, |_| {}).unwrap();
    let text = serde_json::to_string(&simulation.checkpoint().unwrap()).unwrap();
    let checkpoint: Checkpoint = serde_json::from_str(&text).unwrap();
    let first = simulation.run(60, |_| {}).unwrap();
    assert!(first.energy_error < 1e-9, "{:e}", first.energy_error);
    assert!(first.whole.uplifted_fraction.highest.value > 0.0);
    let mut resumed = shaken_box(true);
    resumed.resume(&checkpoint).unwrap();
    resumed.run(60, |_| {}).unwrap();
    assert_eq!(resumed.state(), simulation.state());
    assert!(shaken_box(false).resume(&checkpoint).is_err());
}

/// Error of a scene that floats.
fn floating(builder: SimulationBuilder) -> [f64; 2] {
    match builder.build().map(|_| ()).unwrap_err() {
        Error::Stability(cause) => match *cause {
            StabilityError::Uplift { upward, buoyancy, .. } => [buoyancy - upward, buoyancy],
            other => panic!("{other}"),
        },
        other => panic!("{other}"),
    }
}

#[test]
fn floating_structures_are_refused_with_weight_and_buoyancy() {
    let deep = WaterTable::at_depth(-14.0).unwrap();
    let weight = BLOCK_DENSITY * STANDARD_GRAVITY * BASE_WIDTH * BODY_HEIGHT;
    let buoyancy = WATER_DENSITY * STANDARD_GRAVITY * BASE_WIDTH * 14.0;
    let found = floating(shaken_block().water_table(deep));
    assert!((found[0] / weight - 1.0).abs() < 1e-12 && (found[1] / buoyancy - 1.0).abs() < 1e-12);
    let found = floating(shaken_body().water_table(deep));
    assert!((found[0] / (0.8 * BASE_WIDTH * weight) - 1.0).abs() < 1e-9);
    assert!((found[1] / (0.8 * BASE_WIDTH * buoyancy) - 1.0).abs() < 1e-9, "{found:?}");
    let dropped = shaken_block().water_table(deep).gravity_stage(GravityStage::Unloaded);
    assert_eq!(floating(dropped), floating(shaken_block().water_table(deep)));
    // An anchored base holds.
    shaken_block().interface(Bonded).water_table(deep).build().unwrap();
    let message = shaken_block().water_table(deep).build().unwrap_err().to_string();
    assert!(message.contains("floats") && message.contains("1.3729e6"), "{message}");
}

#[test]
fn water_tables_without_sense_are_refused_or_warned_of() {
    for depth in [f64::NAN, f64::INFINITY] {
        assert!(WaterTable::at_depth(depth).is_err());
    }
    for density in [0.0, -1.0, f64::NAN] {
        assert!(water().with_density(density).is_err());
    }
    let ground = || TrenchGround::new(soil(), trench_elements()).unwrap();
    assert!(ground().with_water_table(water()).is_err());
    let heavy = WaterTable::at_depth(1.0).unwrap().with_density(2000.0).unwrap();
    assert!(ground().with_water_table(heavy).is_err());
    let walled =
        WithWalls::new(RigidBlock::new(TRENCH_WIDTH, BLOCK_HEIGHT, 900.0).unwrap(), TRENCH_DEPTH);
    let error = Simulation::builder(0.02)
        .structure(walled.unwrap())
        .ground(ground())
        .interface(Coulomb::new(0.3).unwrap())
        .water_table(WaterTable::at_depth(1.0).unwrap())
        .build()
        .unwrap_err();
    assert!(error.to_string().contains("with_water_table"), "{error}");
    let dry = WaterTable::at_depth(0.0).unwrap();
    let idle = RecordedStates::of(shaken_block().water_table(dry), 50);
    assert_eq!(idle.states.last(), RecordedStates::of(shaken_block(), 50).states.last());
    let below = Warning::Mistake(Mistake::WaterBelowBase { depth: 0.0 });
    assert!(idle.summary.warnings.contains(&below) && idle.summary.buoyancy == 0.0);
    let open = RecordedStates::of(shaken_block().water_table(water()), 700).summary;
    assert!(open.warnings.iter().any(|warning| matches!(warning, Warning::WaterInGap { .. })));
    assert!(!open.warnings.contains(&below));
}
