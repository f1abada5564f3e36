//! Two cubes on elastic ground that move each other through the soil.

use basemat::bem::ElasticGround;
use basemat::interface::Bonded;
use basemat::motion::{Record, Triaxial, el_centro_1940};
use basemat::structure::{RigidBody, StructureGroup};
use basemat::{Simulation, Soil};

const CUBE_SIDE: f64 = 4.0;
const CELLS_PER_SIDE: usize = 4;
/// Side of a cell, m. The cells extend beyond both edges by 0.21 of a cell together.
const CELL_PITCH: f64 = CUBE_SIDE / (4.0 - 0.21);
const TIME_STEP: f64 = 0.01;
const SHEAR_WAVE_SPEED: f64 = 120.0;

fn cube_at(x: f64) -> RigidBody {
    RigidBody::cuboid([CUBE_SIDE; 3], 2000.0).unwrap().centered_at([x, 0.0]).unwrap()
}

/// Displacements in each step of two cubes at this distance between their middles along x, or of one cube.
fn march(distance_in_cells: Option<usize>, direction: usize) -> Vec<Vec<f64>> {
    let half_distance = 0.5 * CELL_PITCH * distance_in_cells.unwrap_or(0) as f64;
    let mut group = StructureGroup::new().with(cube_at(-half_distance), 0.0).unwrap();
    if distance_in_cells.is_some() {
        group = group.with(cube_at(half_distance), 0.0).unwrap();
    }
    let soil = Soil::from_shear_wave_speed(SHEAR_WAVE_SPEED, 0.3, 1800.0).unwrap();
    let ground = ElasticGround::under(soil, &group, CELLS_PER_SIDE).unwrap();
    let mut simulation = Simulation::builder(TIME_STEP)
        .structure(group)
        .ground(ground)
        .interface(Bonded)
        .motion(motion_along(direction))
        .build()
        .unwrap();
    let count = if distance_in_cells.is_some() { 2 } else { 1 };
    assert_eq!(simulation.state().foundations.len(), count);
    let mut displacements = Vec::new();
    let run = simulation.run(150, |state| displacements.push(state.displacement().to_vec()));
    assert!(run.unwrap().energy_error < 1e-9);
    displacements
}

/// Two seconds of El Centro along x (0) or along y (1).
fn motion_along(direction: usize) -> Triaxial {
    let accelerations = el_centro_1940().accelerations()[100..300].to_vec();
    let record = Some(Record::new(TIME_STEP, accelerations).unwrap());
    match direction {
        0 => Triaxial { x: record, ..Triaxial::default() },
        _ => Triaxial { y: record, ..Triaxial::default() },
    }
}

/// Largest effect of one cube on the other, relative to the motion of a cube alone.
///
/// Mirrored at the plane between them, the cubes move alike; before the fastest waves arrive, they move as if alone.
fn max_coupling(direction: usize, distance_in_cells: usize, motion_alone: &[Vec<f64>]) -> f64 {
    let pair = march(Some(distance_in_cells), direction);
    let max_displacement = motion_alone.iter().fold(0.0_f64, |max, u| max.max(u[direction].abs()));
    // The mirror image x → −x changes the signs of u_x, r_y and r_z, and of a motion along x.
    let motion_sign = if direction == 0 { -1.0 } else { 1.0 };
    let mirror_signs = [-1.0, 1.0, 1.0, 1.0, -1.0, -1.0].map(|sign| motion_sign * sign);
    let gap = CELL_PITCH * distance_in_cells as f64 - CUBE_SIDE;
    let arrival = gap / (SHEAR_WAVE_SPEED * 3.5_f64.sqrt());
    let mut max_coupling = 0.0_f64;
    for (step, (u, motion_alone)) in pair.iter().zip(motion_alone).enumerate() {
        for k in 0..6 {
            let asymmetry = (u[k] - mirror_signs[k] * u[6 + k]).abs();
            assert!(asymmetry < 1e-9 * max_displacement, "{direction} {k}: {asymmetry:e}");
            let lever = if k < 3 { 1.0 } else { 2.0 };
            let coupling = lever * (u[k] - motion_alone[k]).abs() / max_displacement;
            max_coupling = max_coupling.max(coupling);
            let is_before_arrival = TIME_STEP * (step as f64 + 2.0) < arrival;
            assert!(!is_before_arrival || coupling < 1e-4, "{direction} {k} {step}: {coupling:e}");
        }
    }
    max_coupling
}

/// The effect of one cube on the other decreases with their distance.
#[test]
fn two_cubes_couple_through_the_soil() {
    for direction in 0..2 {
        let motion_alone = march(None, direction);
        let couplings = [6, 12, 30].map(|cells| max_coupling(direction, cells, &motion_alone));
        println!("{direction}: {couplings:?}");
        // The amplitude of surface waves decreases with the root of the distance.
        assert!(couplings[1] < couplings[0] && couplings[2] < couplings[1], "{couplings:?}");
        assert!(couplings[2] < 1.4 * couplings[0] / 5.0_f64.sqrt(), "{couplings:?}");
    }
}
