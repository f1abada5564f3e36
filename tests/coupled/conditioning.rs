//! GOAL: condition numbers are right and bound the error of a run; scenes beyond their limit are errors.
//! SCENE: blocks of hand-written mass, towers stiffened over eight decades, ever lighter blocks.
//! REFERENCE: the inverse, a closed form, and the rigid block.

use basemat::bem::{ContactElement, ElasticGround, Grading, Ground};
use basemat::coupled::{Conditioning, Coordinates, GravityStage, SimulationBuilder, State};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Bonded;
use basemat::structure::{Base, BaseNode, CraigBampton, FemModel, RigidBlock, Structure, Triplets};
use basemat::{Error, Result, Simulation, unobserved};

use basemat_problems::dense::condition_by_inverse;
use basemat_problems::scenes::{self, SI_UNITS, TIME_STEP, friction, ground, scene};

/// A block of this mass, inertia and height of its centre of gravity, on a base of 4 m.
fn block(mass: f64, inertia: f64, height: f64) -> RigidBlock {
    RigidBlock::from_mass(4.0, mass, inertia, height).unwrap()
}

/// 2M/Δt² scaled by its diagonal is [[1, −r], [−r, 1]] for sway and rocking; its condition number is (1 + r)/(1 − r).
#[test]
fn effective_stiffness_of_a_block_is_known_in_closed_form() {
    for (mass, inertia, height) in [(1e4, 1e5, 1.0), (1e5, 1e4, 30.0), (3.0, 1e-3, 2.0)] {
        let builder = scene(SI_UNITS, 0.0).coordinates(Coordinates::Physical).interface(Bonded);
        let builder = builder.structure(block(mass, inertia, height));
        let computed = builder.build().unwrap().conditioning().effective_stiffness;
        let r = (mass * height * height / (inertia + mass * height * height)).sqrt();
        let expected = (1.0 + r) / (1.0 - r);
        assert!((computed / expected - 1.0).abs() < 1e-9 * expected, "{computed} for {expected}");
    }
}

/// Mass, inertia and height of the centre of gravity of the block of the test below.
const BLOCK_MASS: f64 = 9e3;
const BLOCK_INERTIA: f64 = 4e4;
const CENTER_HEIGHT: f64 = 2.0;

/// Step compliance of the ground, with rows of all pressures, then of all shear tractions.
fn step_compliance(ground: &mut ElasticGround) -> Vec<f64> {
    ground.prepare(TIME_STEP, None, &mut unobserved).unwrap();
    let size = 2 * ground.elements().len();
    let mut matrix = vec![0.0; size * size];
    ground.step_compliance(&mut matrix).unwrap();
    matrix
}

/// Adds B K_eff⁻¹ Bᵀ A of the block, with the inverse of its 2M/Δt² by hand.
fn add_block_compliance(matrix: &mut [f64], elements: &[ContactElement]) {
    let count = elements.len();
    let size = 2 * count;
    let scale = TIME_STEP * TIME_STEP / 2.0;
    let rotation = 1.0 / BLOCK_INERTIA;
    let sway = 1.0 / BLOCK_MASS + CENTER_HEIGHT * CENTER_HEIGHT / BLOCK_INERTIA;
    for row in 0..size {
        for column in 0..size {
            let source = elements[column % count];
            let x = elements[row % count].center()[0];
            let y = source.center()[0];
            // Mean motions: down −(u_y + x θ), along u_x.
            let mean = match (row < count, column < count) {
                (true, true) => 1.0 / BLOCK_MASS + x * y * rotation,
                (true, false) => -x * CENTER_HEIGHT * rotation,
                (false, true) => -y * CENTER_HEIGHT * rotation,
                (false, false) => sway,
            };
            matrix[row * size + column] += scale * mean * source.length();
        }
    }
}

/// Computed condition numbers; without a coefficient of friction the block is bonded.
fn conditioning(grading: Grading, count: usize, coefficient: Option<f64>) -> Conditioning {
    let builder = scene(SI_UNITS, 0.0).ground(ground(SI_UNITS, count, grading)).structure(block(
        BLOCK_MASS,
        BLOCK_INERTIA,
        CENTER_HEIGHT,
    ));
    let builder = match coefficient {
        Some(coefficient) => builder.interface(friction(coefficient)),
        None => builder.interface(Bonded),
    };
    builder.build().unwrap().conditioning()
}

/// W = G¹ + B K_eff⁻¹ Bᵀ A of a block has the condition number that its inverse gives.
#[test]
fn ground_and_delassus_match_their_inverses() {
    for (grading, count) in [(Grading::Uniform, 3), (Grading::Cosine, 8)] {
        let mut soil = ground(SI_UNITS, count, grading);
        let mut matrix = step_compliance(&mut soil);
        let size = 2 * count;
        let ground_condition = condition_by_inverse(&matrix, size);
        add_block_compliance(&mut matrix, soil.elements());
        let normal: Vec<f64> =
            (0..count * count).map(|k| matrix[k / count * size + k % count]).collect();
        let full_condition = condition_by_inverse(&matrix, size);
        let normal_condition = condition_by_inverse(&normal, count);
        for (coefficient, delassus_condition) in
            [(None, full_condition), (Some(0.5), full_condition), (Some(0.0), normal_condition)]
        {
            let computed = conditioning(grading, count, coefficient);
            for (computed, exact) in
                [(computed.ground, ground_condition), (computed.delassus, delassus_condition)]
            {
                let ratio = exact / computed;
                assert!(
                    ratio > 1.0 - 1e-6 && ratio < 3.0,
                    "{coefficient:?}: {computed:e} for {exact:e}"
                );
            }
        }
    }
}

fn tower(young: f64) -> FemModel {
    let material = Material::new(young, 0.2, 1500.0).unwrap();
    let layers = [Layer::new(6.0, 6, material)];
    FemModel::on_base(Mesh::layered_block(-2.0..2.0, 6, &layers).unwrap()).unwrap()
}

fn bonded() -> SimulationBuilder {
    scene(SI_UNITS, 0.5)
        .coordinates(Coordinates::Physical)
        .interface(Bonded)
        .gravity(0.0)
}

/// A run of 200 steps.
struct CheckedRun {
    states: Vec<State>,
    energy_error: f64,
}

fn run(mut simulation: Simulation) -> CheckedRun {
    let states = scenes::states(&mut simulation, 200);
    let residuals = states.iter().map(|state| state.energy_balance.residual());
    let energy_error = residuals.fold(0.0, f64::max);
    CheckedRun { states, energy_error }
}

/// Largest difference of two series over the largest value of the second.
fn relative_difference(computed: &[f64], reference: &[f64]) -> f64 {
    let scale = reference.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let pairs = computed.iter().zip(reference);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale
}

fn rotations(states: &[State]) -> Vec<f64> {
    states.iter().map(|state| state.base_rotation).collect()
}

/// A tower tends to a rigid block with its stiffness, until rounding dominates.
///
/// The error stays below sixty roundings times the condition number; beyond the limit the scene is an error.
#[test]
fn condition_of_the_stiffness_bounds_the_error() {
    let rigid_block = RigidBlock::new(4.0, 6.0, 1500.0).unwrap();
    let reference = rotations(&run(bonded().structure(rigid_block).build().unwrap()).states);
    for power in 11..=19 {
        let young = 10.0_f64.powi(power);
        let simulation = bonded().structure(tower(young)).build().unwrap();
        let condition = simulation.conditioning().effective_stiffness;
        let rounding = condition * f64::EPSILON;
        let CheckedRun { states, energy_error } = run(simulation);
        let error = relative_difference(&rotations(&states), &reference);
        println!(
            "E = 1e{power}: condition {condition:.1e}, energy error {energy_error:.1e}, from rigid {error:.1e}"
        );
        assert!(error < 3e8 / young + 60.0 * rounding && energy_error < 60.0 * rounding);
    }
    let error = bonded().structure(tower(1e20)).build().err().unwrap();
    let Error::IllConditioned { matrix, condition, limit, quantity, ratio } = error else {
        panic!("{error}")
    };
    assert_eq!(matrix, "effective stiffness matrix");
    assert_eq!(quantity, "stiffness of the structure over its inertia in a time step");
    assert!(condition > limit && ratio > 1e-2 * condition, "{condition:e} {ratio:e}");
}

/// Density of a block 10^power times as light as the others, kg/m³.
fn light_density(power: i32) -> f64 {
    1500.0 * 10.0_f64.powi(-power)
}

fn light_block(power: i32) -> Result<Simulation> {
    bonded().structure(RigidBlock::new(4.0, 6.0, light_density(power)).unwrap()).build()
}

/// Base shear of a light block over its density, in every state.
fn specific_shear(simulation: Simulation, power: i32) -> Vec<f64> {
    let CheckedRun { states, energy_error } = run(simulation);
    assert!(energy_error < 1e-9, "{power}: {energy_error:e}");
    states.iter().map(|state| state.base_shear / light_density(power)).collect()
}

/// The shear of light blocks stays accurate until the ground's compliance is lost in the rounding of theirs.
#[test]
fn the_condition_of_the_delassus_operator_is_harmless_until_the_ground_is_lost() {
    let reference = specific_shear(light_block(9).unwrap(), 9);
    for power in [11, 13, 15] {
        let simulation = light_block(power).unwrap();
        let condition = simulation.conditioning().delassus;
        let error = relative_difference(&specific_shear(simulation, power), &reference);
        println!("1500e-{power} kg/m³: condition {condition:.1e}, error {error:.1e}");
        assert!(condition > 10.0_f64.powi(power) && error < 1e-4);
    }
    for power in [17, 20] {
        let error = light_block(power).err().unwrap();
        let Error::IllConditioned { matrix: "Delassus operator", quantity, ratio, .. } = error
        else {
            panic!("{error}")
        };
        assert!(quantity.starts_with("compliance of the structure"), "{quantity}");
        assert!(ratio > 1e15);
    }
}

/// A block with two wheels, joined to each other far more stiffly than to the block.
struct BlockOnWheels;

impl Structure for BlockOnWheels {
    fn dofs(&self) -> usize {
        5
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        for (dof, mass) in [1e4, 1e4, 5e4, 10.0, 10.0].into_iter().enumerate() {
            matrix.add(dof, dof, mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_spring(3, 4, 1e22);
        matrix.add_spring(2, 3, 1e5);
        Ok(())
    }
}

#[test]
fn stiffness_within_a_structure_is_named() {
    let error = bonded().structure(BlockOnWheels).build().err().unwrap();
    let Error::IllConditioned { quantity, ratio, .. } = error else {
        panic!("{error}")
    };
    assert_eq!(quantity, "largest over smallest stiffness within the structure");
    assert!(ratio > 1e12, "{ratio:e}");
}

fn standing_tower(young: f64) -> Result<Simulation> {
    let builder = scene(SI_UNITS, 0.5).structure(tower(young)).interface(friction(0.4));
    builder.gravity_stage(GravityStage::Frictionless).build()
}

/// Very stiff towers have the right weight, or an error that names the stiffness.
#[test]
fn stiff_structures_stand_or_say_why_not() {
    let weight = 4.0 * 6.0 * 1500.0 * scenes::SCENE_GRAVITY;
    for young in [1e13, 1e14, 1e15] {
        let simulation = standing_tower(young).unwrap();
        let force = simulation.state().normal_force;
        assert!((force / weight - 1.0).abs() < 1e-7, "{young:e}: {force}");
    }
    for young in [3e17, 1e18, 3e18, 1e19, 1e20, 1e22] {
        let error = standing_tower(young).err().unwrap();
        let Error::IllConditioned { matrix: "static stiffness matrix", quantity, .. } = error
        else {
            panic!("{young:e}: {error}")
        };
        assert_eq!(quantity, "stiffness of the structure over that of the ground");
    }
}

/// A tower without weight that the ground throws off, in full or reduced.
fn thrown_tower(material: Material, reduced: bool, coordinates: Coordinates) -> Simulation {
    let layers = [Layer::new(6.0, 4, material)];
    let mesh = Mesh::layered_block(-2.0..2.0, 4, &layers).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let builder = scene(SI_UNITS, 2.0).gravity(0.0).interface(friction(0.5));
    let builder = if reduced {
        builder.structure(CraigBampton::new(4).reduce(model).unwrap())
    } else {
        builder.structure(model)
    };
    builder.coordinates(coordinates).build().unwrap()
}

/// Energy error of a run with more than fifty steps in flight.
fn flight_error(simulation: Simulation) -> f64 {
    let CheckedRun { states, energy_error } = run(simulation);
    let steps = states.iter().filter(|state| state.uplifted_fraction == 1.0).count();
    assert!(steps > 50, "{steps} steps in flight");
    energy_error
}

/// In flight the energy error stays below sixty roundings times the condition number.
///
/// K_eff Δu is rounded in proportion to the flight, also near the limit of incompressibility. A reduced tower has the
/// rounding of the full tower's stiffness under rigid motions, whatever its condition number. In modes a flight
/// meets no stiffness, and both balances close.
#[test]
fn flights_of_stiff_structures_open_the_energy_balance_by_rounding_only() {
    for (young, poisson) in [(3e9, 0.2), (3e10, 0.499), (1e12, 0.499), (1e13, 0.4995)] {
        let material = Material::new(young, poisson, 1500.0).unwrap();
        let full_tower = thrown_tower(material, false, Coordinates::Physical);
        let rounding = full_tower.conditioning().effective_stiffness * f64::EPSILON;
        let full_error = flight_error(full_tower);
        let reduced_error = flight_error(thrown_tower(material, true, Coordinates::Physical));
        let full_in_modes = flight_error(thrown_tower(material, false, Coordinates::Modes));
        let reduced_in_modes = flight_error(thrown_tower(material, true, Coordinates::Modes));
        println!(
            "E = {young:e}, ν = {poisson}: rounding {rounding:.1e}, full {full_error:.1e}, reduced \
             {reduced_error:.1e}; in modes {full_in_modes:.1e}, {reduced_in_modes:.1e}"
        );
        assert!(full_error < 60.0 * rounding && reduced_error < 60.0 * rounding);
        assert!(full_in_modes < 1e-12 && reduced_in_modes < 1e-10);
    }
}
