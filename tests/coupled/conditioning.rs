//! GOAL: condition numbers are right, bound the error of a run, and refuse scenes beyond them.
//! SCENE: blocks of hand-written mass, towers stiffened over eight decades, ever lighter blocks.
//! REFERENCE: the inverse, a closed form, and the rigid block.

use basemat::bem::{ElasticGround, Grading, Ground};
use basemat::coupled::{Coordinates, GravityStage, SimulationBuilder, State};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Bonded;
use basemat::structure::{Base, BaseNode, CraigBampton, FemModel, RigidBlock, Structure, Triplets};
use basemat::{Error, Simulation, unobserved};

use basemat_problems::dense::condition_by_inverse;
use basemat_problems::scenes::{self, SI, TIME_STEP, friction, ground, scene};

/// A block whose matrices are written down by hand: m, I and h with its base of 4 m.
fn block(mass: f64, inertia: f64, height: f64) -> RigidBlock {
    RigidBlock::from_mass(4.0, mass, inertia, height).unwrap()
}

/// The condition of 2M/Δt² scaled by its diagonal: [[1, −r], [−r, 1]] for sway and rocking.
#[test]
fn effective_stiffness_of_a_block_is_known_in_closed_form() {
    for (mass, inertia, height) in [(1e4, 1e5, 1.0), (1e5, 1e4, 30.0), (3.0, 1e-3, 2.0)] {
        let builder = scene(SI, 0.0).coordinates(Coordinates::Physical).interface(Bonded);
        let builder = builder.structure(block(mass, inertia, height));
        let found = builder.build().unwrap().conditioning().effective_stiffness;
        let r = (mass * height * height / (inertia + mass * height * height)).sqrt();
        let wanted = (1.0 + r) / (1.0 - r);
        assert!((found / wanted - 1.0).abs() < 1e-9 * wanted, "{found} for {wanted}");
    }
}

/// W = G¹ + B K_eff⁻¹ Bᵀ A of a block, from the ground's G¹ and a three by three inverse by hand.
#[test]
fn ground_and_delassus_match_their_inverses() {
    let (mass, inertia, height) = (9e3, 4e4, 2.0);
    for (grading, count) in [(Grading::Uniform, 3), (Grading::Cosine, 8)] {
        let mut soil: ElasticGround = ground(SI, count, grading);
        soil.prepare(TIME_STEP, None, &mut unobserved).unwrap();
        let size = 2 * count;
        let mut matrix = vec![0.0; size * size];
        soil.step_compliance(&mut matrix).unwrap();
        let exact_ground = condition_by_inverse(&matrix, size);
        // 2M/Δt² inverted: sway and rocking meet by −mh.
        let scale = TIME_STEP * TIME_STEP / 2.0;
        let (sway, turn) = (1.0 / mass + height * height / inertia, 1.0 / inertia);
        let elements = soil.elements().to_vec();
        for (i, j) in (0..size * size).map(|k| (k / size, k % size)) {
            let (x, source) = (elements[i % count].center()[0], elements[j % count]);
            let (y, length) = (source.center()[0], source.length());
            // Mean motions: down −(u_y + x θ), along u_x.
            let mean = match (i < count, j < count) {
                (true, true) => 1.0 / mass + x * y * turn,
                (true, false) => -x * height * turn,
                (false, true) => -y * height * turn,
                (false, false) => sway,
            };
            matrix[i * size + j] += scale * mean * length;
        }
        let normal: Vec<f64> =
            (0..count * count).map(|k| matrix[k / count * size + k % count]).collect();
        let build = |law| {
            let builder = scene(SI, 0.0).ground(ground(SI, count, grading));
            let builder = builder.structure(block(mass, inertia, height));
            match law {
                Some(coefficient) => builder.interface(friction(coefficient)).build().unwrap(),
                None => builder.interface(Bonded).build().unwrap(),
            }
        };
        let whole = condition_by_inverse(&matrix, size);
        let smooth = condition_by_inverse(&normal, count);
        for (law, wanted) in [(None, whole), (Some(0.5), whole), (Some(0.0), smooth)] {
            let found = build(law).conditioning();
            for (found, wanted) in [(found.ground, exact_ground), (found.delassus, wanted)] {
                let ratio = wanted / found;
                assert!(ratio > 1.0 - 1e-6 && ratio < 3.0, "{law:?}: {found:e} for {wanted:e}");
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
    scene(SI, 0.5).coordinates(Coordinates::Physical).interface(Bonded).gravity(0.0)
}

/// States of 200 steps, and the largest energy error.
fn run(mut simulation: Simulation) -> (Vec<State>, f64) {
    let states = scenes::states(&mut simulation, 200);
    let worst = states.iter().map(|state| state.energy_balance.residual()).fold(0.0, f64::max);
    (states, worst)
}

/// Largest difference of a quantity, relative to its largest value.
fn apart(one: &[State], other: &[State], of: impl Fn(&State) -> f64) -> f64 {
    let scale = other.iter().map(|state| of(state).abs()).fold(0.0, f64::max);
    one.iter().zip(other).map(|(a, b)| (of(a) - of(b)).abs()).fold(0.0, f64::max) / scale
}

/// As a tower stiffens it becomes a rigid block, until rounding takes over: by no more than a few
/// dozen roundings times the condition, and beyond the limit the scene is refused.
#[test]
fn condition_of_the_stiffness_bounds_the_error() {
    let rigid = RigidBlock::new(4.0, 6.0, 1500.0).unwrap();
    let (rigid, _) = run(bonded().structure(rigid).build().unwrap());
    for power in 11..=19 {
        let young = 10.0_f64.powi(power);
        let simulation = bonded().structure(tower(young)).build().unwrap();
        let condition = simulation.conditioning().effective_stiffness;
        let rounding = condition * f64::EPSILON;
        let (states, energy_balance) = run(simulation);
        let error = apart(&states, &rigid, |state| state.base_rotation);
        println!(
            "E = 1e{power}: condition {condition:.1e}, energy balance {energy_balance:.1e}, from rigid {error:.1e}"
        );
        assert!(error < 3e8 / young + 60.0 * rounding && energy_balance < 60.0 * rounding);
    }
    let error = bonded().structure(tower(1e20)).build().err().unwrap();
    let Error::IllConditioned { matrix, condition, limit, quantity, ratio } = error else {
        panic!("{error}")
    };
    assert_eq!(matrix, "effective stiffness matrix");
    assert_eq!(quantity, "stiffness of the structure over its inertia in a time step");
    assert!(condition > limit && ratio > 1e-2 * condition, "{condition:e} {ratio:e}");
}

/// The lighter a block, the less the ground is seen beside its compliance: what it needs of the
/// tractions stays right until the ground is lost.
#[test]
fn condition_of_the_delassus_operator_is_carried_until_the_ground_is_lost() {
    let light = |power: i32| {
        let density = 1500.0 * 10.0_f64.powi(-power);
        let block = RigidBlock::new(4.0, 6.0, density).unwrap();
        (bonded().structure(block).build(), density)
    };
    let shear = |power: i32| {
        let (simulation, density) = light(power);
        let simulation = simulation.unwrap();
        let condition = simulation.conditioning().delassus;
        let (states, energy_balance) = run(simulation);
        assert!(energy_balance < 1e-9, "{power}: {energy_balance:e}");
        (states.iter().map(|state| state.base_shear / density).collect::<Vec<_>>(), condition)
    };
    let (reference, _) = shear(9);
    let scale = reference.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    for power in [11, 13, 15] {
        let (found, condition) = shear(power);
        let worst = found.iter().zip(&reference).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        println!("1500e-{power} kg/m³: condition {condition:.1e}, off by {:.1e}", worst / scale);
        assert!(condition > 10.0_f64.powi(power) && worst < 1e-4 * scale);
    }
    for power in [17, 20] {
        let error = light(power).0.err().unwrap();
        let Error::IllConditioned { matrix: "Delassus operator", quantity, ratio, .. } = error
        else {
            panic!("{error}")
        };
        assert!(quantity.starts_with("compliance of the structure"), "{quantity}");
        assert!(ratio > 1e15);
    }
}

/// Two wheels on a block, held to each other far more stiffly than to anything else.
struct Wheels;

impl Structure for Wheels {
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
    let error = bonded().structure(Wheels).build().err().unwrap();
    let Error::IllConditioned { quantity, ratio, .. } = error else { panic!("{error}") };
    assert_eq!(quantity, "largest over least stiffness within the structure");
    assert!(ratio > 1e12, "{ratio:e}");
}

/// A very stiff tower stands as exactly as its stiffness can be solved with; beyond that the error
/// names the stiffness, not the weight.
#[test]
fn stiff_structures_stand_or_say_why_not() {
    let weighed = |young: f64| {
        let builder = scene(SI, 0.5).structure(tower(young)).interface(friction(0.4));
        builder.gravity_stage(GravityStage::Frictionless).build()
    };
    let weight = 4.0 * 6.0 * 1500.0 * scenes::GRAVITY;
    for young in [1e13, 1e14, 1e15] {
        let simulation = weighed(young).unwrap();
        let force = simulation.state().normal_force;
        assert!((force / weight - 1.0).abs() < 1e-7, "{young:e}: {force}");
    }
    for young in [3e17, 1e18, 3e18, 1e19, 1e20, 1e22] {
        let error = weighed(young).err().unwrap();
        let Error::IllConditioned { matrix: "static stiffness matrix", quantity, .. } = error
        else {
            panic!("{young:e}: {error}")
        };
        assert_eq!(quantity, "stiffness of the structure over that of the ground");
    }
}

/// A stiff tower that the ground throws off, without weight: its energy balance is open by a few dozen roundings
/// times the condition, since K_eff Δu is rounded in proportion to the flight, near the limit of
/// incompressibility as elsewhere. A reduced one keeps the rounding of the whole one's stiffness
/// under rigid motions, whatever its own condition. In modes, where a flight meets no stiffness, both close.
#[test]
fn flights_of_stiff_structures_open_the_energy_balance_by_rounding_only() {
    for (young, poisson) in [(3e9, 0.2), (3e10, 0.499), (1e12, 0.499), (1e13, 0.4995)] {
        let fly = |reduced: bool, coordinates| {
            let material = Material::new(young, poisson, 1500.0).unwrap();
            let layers = [Layer::new(6.0, 4, material)];
            let mesh = Mesh::layered_block(-2.0..2.0, 4, &layers).unwrap();
            let model = FemModel::on_base(mesh).unwrap();
            let builder = scene(SI, 2.0).gravity(0.0).interface(friction(0.5));
            let builder = if reduced {
                builder.structure(CraigBampton::new(4).reduce(model).unwrap())
            } else {
                builder.structure(model)
            };
            let simulation = builder.coordinates(coordinates).build().unwrap();
            let condition = simulation.conditioning().effective_stiffness;
            let (states, energy_balance) = run(simulation);
            let off = states.iter().filter(|state| state.uplifted_fraction == 1.0).count();
            assert!(off > 50, "{off} steps in flight");
            (condition * f64::EPSILON, energy_balance)
        };
        let (rounding, whole) = fly(false, Coordinates::Physical);
        let (_, reduced) = fly(true, Coordinates::Physical);
        let [(_, whole_modes), (_, reduced_modes)] =
            [false, true].map(|reduced| fly(reduced, Coordinates::Modes));
        println!(
            "E = {young:e}, ν = {poisson}: rounding {rounding:.1e}, whole {whole:.1e}, reduced \
             {reduced:.1e}; in modes {whole_modes:.1e}, {reduced_modes:.1e}"
        );
        assert!(whole < 60.0 * rounding && reduced < 60.0 * rounding);
        assert!(whole_modes < 1e-12 && reduced_modes < 1e-10);
    }
}
