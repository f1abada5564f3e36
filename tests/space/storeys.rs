//! Buildings in space: eccentric floors and matrices by closed forms.

use std::f64::consts::TAU;

use basemat::interface::Bonded;
use basemat::motion::FreeField;
use basemat::structure::{
    Bilinear, ModalDamping, PlanStorey, RigidBody, StoreyBuilding, Structure, StructureError,
    Triplets,
};
use basemat::{Error, Simulation};
use basemat_problems::dense::{DenseMatrix, dot, form, multiply};

use super::cells::{BED_PROPERTIES, SpringCells};

fn dense_matrix(triplets: &Triplets, order: usize) -> DenseMatrix {
    let mut matrix = vec![vec![0.0; order]; order];
    triplets.entries().iter().for_each(|&(i, j, value)| matrix[i][j] += value);
    matrix
}

fn stiffness_matrix(structure: &dyn Structure) -> DenseMatrix {
    let mut triplets = Triplets::new(structure.dofs());
    structure.stiffness(&mut triplets).unwrap();
    dense_matrix(&triplets, structure.dofs())
}

fn damping_matrix(structure: &dyn Structure) -> DenseMatrix {
    let mut triplets = Triplets::new(structure.dofs());
    structure.damping(&mut triplets).unwrap();
    dense_matrix(&triplets, structure.dofs())
}

fn mass_matrix(structure: &dyn Structure) -> DenseMatrix {
    let mut triplets = Triplets::new(structure.dofs());
    structure.mass(&mut triplets).unwrap();
    dense_matrix(&triplets, structure.dofs())
}

/// ω² of an eccentric storey: ½ (A + B) ± √(¼ (A − B)² + A B'), Chopra, Dynamics of Structures, § 9.6.
#[test]
fn an_eccentric_storey_couples_sway_and_twist() {
    const FLOOR_LENGTH: f64 = 16.0;
    const FLOOR_WIDTH: f64 = 10.0;
    let mass = 3.0e5;
    let eccentricity = 2.5;
    let stiffness = [5.0e8, 3.0e8, 1.5e10];
    let polar_inertia = mass * (FLOOR_LENGTH * FLOOR_LENGTH + FLOOR_WIDTH * FLOOR_WIDTH) / 12.0;
    for (across, mass_center, stiffness_center) in [
        (1, [0.0; 2], [eccentricity, 0.0]),
        (1, [1.0 - eccentricity, 3.0], [1.0, 3.0]),
        (0, [0.0; 2], [0.0, -eccentricity]),
    ] {
        let storey = PlanStorey::new(4.0, mass, [FLOOR_LENGTH, FLOOR_WIDTH], stiffness);
        let storey = PlanStorey { mass_center, stiffness_center, ..storey };
        let mat = RigidBody::cuboid([FLOOR_LENGTH, FLOOR_WIDTH, 1.0], 2500.0).unwrap();
        let building = StoreyBuilding::new(mat, &[storey]).unwrap();
        let damped_structure = ModalDamping::new(&[0.05]).unwrap().on_fixed_base(building).unwrap();
        let sway = stiffness[across] / mass;
        let twist = (stiffness[2] + stiffness[across] * eccentricity.powi(2)) / polar_inertia;
        let coupling = stiffness[across] * eccentricity;
        let coupling_square = coupling * coupling / (mass * polar_inertia);
        let root = (0.25 * (sway - twist).powi(2) + coupling_square).sqrt();
        let middle = 0.5 * (sway + twist);
        let mut expected = [middle - root, middle + root, stiffness[1 - across] / mass]
            .map(|square: f64| square.sqrt() / TAU);
        expected.sort_by(f64::total_cmp);
        assert_eq!(damped_structure.frequencies().len(), 3, "{:?}", damped_structure.frequencies());
        for (computed, expected) in damped_structure.frequencies().iter().zip(expected) {
            assert!((computed / expected - 1.0).abs() < 1e-5, "{computed} {expected}");
        }
    }
}

pub(super) const MAT_SIDES: [f64; 3] = [12.0, 9.0, 1.0];
const STOREY_HEIGHTS: [f64; 3] = [4.0, 3.0, 3.5];
/// Stiffness of the lowest storey: along x, along y, twist.
pub(super) const STOREY_STIFFNESS: [f64; 3] = [2.4e8, 1.6e8, 4.0e9];
pub(super) const STOREY_DAMPING: [f64; 3] = [3.0e5, 4.0e5, 5.0e6];
const FLOOR_MASS: f64 = 1.5e5;
pub(super) const P_DELTA_GRAVITY: f64 = 9.81;

/// Stiffness and mass of a storey relative to the lowest one.
pub(super) fn storey_scale(storey: usize) -> f64 {
    1.0 - 0.2 * storey as f64
}

/// A vector after some quarter turns about the vertical axis.
pub(super) fn turned(vector: [f64; 2], quarter_turns: usize) -> [f64; 2] {
    (0..quarter_turns).fold(vector, |[x, y], _| [-y, x])
}

/// A pair of values for x and y, after some quarter turns.
pub(super) fn swapped<T: Copy>(pair: [T; 2], quarter_turns: usize) -> [T; 2] {
    if quarter_turns % 2 == 1 { [pair[1], pair[0]] } else { pair }
}

/// Values for x, y and twist, after some quarter turns.
fn swapped_translations(numbers: [f64; 3], quarter_turns: usize) -> [f64; 3] {
    if quarter_turns % 2 == 1 { [numbers[1], numbers[0], numbers[2]] } else { numbers }
}

/// A storey, eccentric along x and y, after some quarter turns about the vertical axis.
fn storey(number: usize, quarter_turns: usize) -> PlanStorey {
    let scale = storey_scale(number);
    let stiffness = STOREY_STIFFNESS.map(|stiffness| stiffness * scale);
    PlanStorey {
        mass_center: turned([0.6, -0.4 * number as f64], quarter_turns),
        stiffness_center: turned([-0.8 * number as f64, 0.5], quarter_turns),
        damping: swapped_translations(STOREY_DAMPING, quarter_turns),
        ..PlanStorey::new(
            STOREY_HEIGHTS[number],
            FLOOR_MASS * scale,
            swapped([MAT_SIDES[0], MAT_SIDES[1]], quarter_turns),
            swapped_translations(stiffness, quarter_turns),
        )
    }
}

/// Three storeys with P–Δ, after some quarter turns about the vertical axis.
pub(super) fn building(quarter_turns: usize) -> StoreyBuilding {
    let storeys: Vec<_> = (0..3).map(|number| storey(number, quarter_turns)).collect();
    let sides = swapped([MAT_SIDES[0], MAT_SIDES[1]], quarter_turns);
    let mat = RigidBody::cuboid([sides[0], sides[1], MAT_SIDES[2]], 2400.0).unwrap();
    StoreyBuilding::new(mat, &storeys).unwrap().with_p_delta(P_DELTA_GRAVITY).unwrap()
}

/// Rigid motions of the whole building, one for each motion of the mat.
fn rigid_motions(dofs: usize) -> Vec<Vec<f64>> {
    (0..6)
        .map(|k| {
            let mut u = vec![0.0; dofs];
            u[k] = 1.0;
            let mut height = 0.0;
            for storey in 0..3 {
                height += STOREY_HEIGHTS[storey];
                u[6 + 3 * storey] = u[0] + height * u[4];
                u[7 + 3 * storey] = u[1] - height * u[3];
                u[8 + 3 * storey] = u[5];
            }
            u
        })
        .collect()
}

/// In any motion the total drift is the sum of the storeys' drifts.
#[test]
fn the_total_drift_is_the_sum_of_the_drifts() {
    let building = building(0);
    let u: Vec<f64> = (0..building.dofs()).map(|k| (1.3 * k as f64).cos()).collect();
    let total = building.total_drift(2, [1.5, -2.5]).unwrap();
    for (k, row) in total.iter().enumerate() {
        let drifts = (0..3).map(|storey| building.drift_at(storey, [1.5, -2.5]).unwrap());
        let sum: f64 = drifts.map(|drift| drift[k].value(&u)).sum();
        assert!((row.value(&u) - sum).abs() < 1e-13);
    }
}

#[test]
fn rigid_motions_cause_no_drift_and_no_force() {
    let building = building(0).with_p_delta(0.0).unwrap();
    let total_drift = building.total_drift(2, [1.5, -2.5]).unwrap();
    let stiffness = stiffness_matrix(&building);
    let damping = damping_matrix(&building);
    for motion in &rigid_motions(building.dofs()) {
        for row in &total_drift {
            assert!(row.value(motion).abs() < 1e-13);
        }
        for matrix in [&stiffness, &damping] {
            let force = multiply(matrix, motion);
            assert!(force.iter().all(|f| f.abs() < 1e-12 * 1e11), "{force:?}");
        }
    }
}

/// A mass at a place.
struct PointMass {
    mass: f64,
    place: [f64; 3],
}

/// Six points on the axes of a body that have its mass, its centre and its moments of inertia.
fn equivalent_points(mass: f64, center: [f64; 3], [jx, jy, jz]: [f64; 3]) -> Vec<PointMass> {
    let mut points = Vec::new();
    for (k, j) in [jy + jz - jx, jx + jz - jy, jx + jy - jz].into_iter().enumerate() {
        // Two of m/6 at ± r: 2 (m/6) r² = j/2.
        let r = (1.5 * j / mass).sqrt();
        for offset in [-r, r] {
            let mut place = center;
            place[k] += offset;
            points.push(PointMass { mass: mass / 6.0, place });
        }
    }
    points
}

/// Points equivalent to the building's mat and floors.
fn building_points() -> Vec<PointMass> {
    let [l, b, h] = MAT_SIDES;
    let mat_mass = MAT_SIDES.iter().product::<f64>() * 2400.0;
    let mat_inertia =
        [b * b + h * h, l * l + h * h, l * l + b * b].map(|square| mat_mass * square / 12.0);
    let mut points = equivalent_points(mat_mass, [0.0, 0.0, 0.5 * h], mat_inertia);
    let mut height = 0.0;
    for storey in 0..3 {
        height += STOREY_HEIGHTS[storey];
        let mass = FLOOR_MASS * storey_scale(storey);
        let inertia = [b * b, l * l, l * l + b * b].map(|square| mass * square / 12.0);
        points.extend(equivalent_points(mass, [0.6, -0.4 * storey as f64, height], inertia));
    }
    points
}

/// Velocity at a place by a unit rigid motion.
fn unit_velocity(motion: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
    match motion {
        3 => [0.0, -z, y],
        4 => [z, 0.0, -x],
        5 => [-y, x, 0.0],
        axis => std::array::from_fn(|k| f64::from(u8::from(k == axis))),
    }
}

/// The inertia in rigid motions is that of point masses equivalent to the mat and the floors.
#[test]
fn rigid_motions_move_all_masses() {
    let building = building(0);
    let mass = mass_matrix(&building);
    let motions = rigid_motions(building.dofs());
    let points = building_points();
    for (i, a) in motions.iter().enumerate() {
        for (j, b) in motions.iter().enumerate() {
            let computed = form(b, &mass, a);
            let expected: f64 = points
                .iter()
                .map(|point| {
                    let a = unit_velocity(i, point.place);
                    let b = unit_velocity(j, point.place);
                    point.mass * dot(&a, &b)
                })
                .sum();
            assert!((computed - expected).abs() < 1e-12 * 1e9, "{i} {j}: {computed} {expected}");
        }
    }
}

/// A bonded structure after `steps` steps.
pub(super) fn march(
    structure: impl Structure + 'static,
    ground: SpringCells,
    motion: impl FreeField + 'static,
    steps: usize,
) -> Simulation {
    let mut simulation = Simulation::builder(4e-3)
        .structure(structure)
        .ground(ground)
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    let run = simulation.run(steps, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    simulation
}

/// Motion along x, along y and twist of the mat (level 0) or a floor.
fn level_motion(u: &[f64], level: usize) -> [f64; 3] {
    match level {
        0 => [u[0], u[1], u[5]],
        _ => [u[3 * level + 3], u[3 * level + 4], u[3 * level + 5]],
    }
}

/// The weight of point masses that have a floor's mass and polar inertia, lowered by the sway below them.
#[test]
fn weights_sink_with_the_sway_of_all_storeys_below() {
    let stiffness_with_p_delta = stiffness_matrix(&building(0));
    let stiffness_without_p_delta = stiffness_matrix(&building(0).with_p_delta(0.0).unwrap());
    let u: Vec<f64> = (0..stiffness_with_p_delta.len()).map(|k| (1.7 * k as f64).sin()).collect();
    let stiffness_with_p_delta = form(&u, &stiffness_with_p_delta, &u);
    let stiffness_without_p_delta = form(&u, &stiffness_without_p_delta, &u);
    let radius = ((MAT_SIDES[0].powi(2) + MAT_SIDES[1].powi(2)) / 12.0).sqrt();
    let mut expected = 0.0;
    for floor in 0..3 {
        let mass = FLOOR_MASS * storey_scale(floor);
        for [dx, dy] in [[radius, 0.0], [-radius, 0.0], [0.0, radius], [0.0, -radius]] {
            let x = 0.6 + dx;
            let y = -0.4 * floor as f64 + dy;
            for storey in 0..=floor {
                let motion_below = level_motion(&u, storey);
                let motion_above = level_motion(&u, storey + 1);
                let drift: [f64; 3] = std::array::from_fn(|k| motion_above[k] - motion_below[k]);
                let square = (drift[0] - y * drift[2]).powi(2) + (drift[1] + x * drift[2]).powi(2);
                expected -= P_DELTA_GRAVITY * 0.25 * mass * square / STOREY_HEIGHTS[storey];
            }
        }
    }
    assert!(
        (stiffness_with_p_delta - stiffness_without_p_delta - expected).abs()
            < 1e-9 * stiffness_without_p_delta,
        "{stiffness_with_p_delta} {stiffness_without_p_delta} {expected}"
    );
    assert!(expected.abs() > 1e-4 * stiffness_without_p_delta);
}

/// The building's cells.
pub(super) fn cells() -> SpringCells {
    SpringCells::under([MAT_SIDES[0], MAT_SIDES[1]], [0.0; 2], [4, 3], BED_PROPERTIES)
}

#[test]
fn invalid_buildings_are_errors() {
    let mat = RigidBody::cuboid(MAT_SIDES, 2400.0).unwrap();
    let storey = PlanStorey::new(3.0, 1e5, [9.0; 2], [2e8, 3e8, 4e9]);
    let without_storeys = StoreyBuilding::new(mat.clone(), &[]);
    assert!(matches!(without_storeys, Err(Error::Size { found: 0, .. })));
    for invalid in [
        PlanStorey { height: 0.0, ..storey },
        PlanStorey { stiffness: [2e8, f64::NAN, 4e9], ..storey },
        PlanStorey { stiffness: [2e8, 3e8, 0.0], ..storey },
        PlanStorey { inertia: [0.0; 3], ..storey },
        PlanStorey { damping: [0.0, -1.0, 0.0], ..storey },
        PlanStorey { mass_center: [f64::INFINITY, 0.0], ..storey },
    ] {
        let result = StoreyBuilding::new(mat.clone(), &[invalid]);
        assert!(matches!(result, Err(Error::Input { .. })));
    }
    let building = StoreyBuilding::new(mat.clone(), &[storey]).unwrap();
    let law = Bilinear::new(1e8, 1e5, 0.1).unwrap();
    assert!(matches!(building.drift(1), Err(Error::Index { index: 1, bound: 1, .. })));
    let fourth_direction = building.clone().with_law(0, 3, law.clone());
    assert!(matches!(fourth_direction, Err(Error::Index { index: 3, .. })));
    let building = building.with_law(0, 1, law.clone()).unwrap();
    assert!(matches!(building.clone().with_law(0, 1, law), Err(Error::Scene { .. })));
    assert_eq!(building.describe(&[4, 8]).unwrap(), "r_y of the rigid body, r_z of floor 0");
    // 100 t on columns of 2e5 N/m: they buckle under W/h.
    let weak_storey = PlanStorey { stiffness: [2e5, 3e8, 4e9], ..storey };
    let weak_building = StoreyBuilding::new(mat, &[weak_storey]).unwrap();
    let weak_building = weak_building.with_p_delta(P_DELTA_GRAVITY).unwrap();
    let builder = Simulation::builder(0.01).structure(weak_building).ground(cells());
    let built = builder.interface(Bonded).build();
    let Err(Error::Structure(StructureError::Buckling { factor })) = built else {
        panic!("{:?}", built.err())
    };
    let expected = 2e5 * 3.0 / (1e5 * P_DELTA_GRAVITY);
    assert!((factor / expected - 1.0).abs() < 1e-5, "{factor} {expected}");
}
