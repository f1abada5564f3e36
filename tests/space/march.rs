//! Bonded rigid bodies on independent cells.

use basemat::coupled::{Coordinates, Probe};
use basemat::interface::Bonded;
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{RigidBody, Structure, Triplets};
use basemat::{Result, Simulation};

use super::cells::{BED_PROPERTIES, CrossingPulses, SpringCells, equal_in_slices, plane_and_slice};
use super::equations::Cuboid;

const ECCENTRIC_CUBOID: Cuboid =
    Cuboid { sides: [8.0, 6.0, 9.0], density: 2000.0, center: [2.0, -1.0] };
const STRAIGHT_PULSES: CrossingPulses = CrossingPulses { quarter_turns: 0 };

fn body(cuboid: Cuboid) -> RigidBody {
    RigidBody::cuboid(cuboid.sides, cuboid.density)
        .unwrap()
        .centered_at(cuboid.center)
        .unwrap()
}

fn cells(cuboid: Cuboid) -> SpringCells {
    let sides = [cuboid.sides[0], cuboid.sides[1]];
    SpringCells::under(sides, cuboid.center, [4, 3], BED_PROPERTIES)
}

/// The eccentric cuboid under pulses.
fn scene(time_step: f64) -> Result<Simulation> {
    Simulation::builder(time_step)
        .structure(body(ECCENTRIC_CUBOID))
        .ground(cells(ECCENTRIC_CUBOID))
        .interface(Bonded)
        .motion(STRAIGHT_PULSES)
        .build()
}

fn max_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |max, (a, b)| f64::max(max, (a - b).abs()))
}

/// Displacement of the eccentric cuboid after `duration`.
fn displacement_after(duration: f64, steps: usize) -> Vec<f64> {
    let mut simulation = scene(duration / steps as f64).unwrap();
    let run = simulation.run(steps, |_| {}).unwrap();
    assert!(run.energy_error < 1e-10, "{}", run.energy_error);
    simulation.state().absolute_displacement().to_vec()
}

/// Errors are of second order in the step; extrapolation to a zero step leaves 2e-6.
#[test]
fn a_cuboid_follows_its_equations_of_motion() {
    let duration = 0.8;
    let cells = cells(ECCENTRIC_CUBOID);
    let expected =
        ECCENTRIC_CUBOID.march(&cells, BED_PROPERTIES, &STRAIGHT_PULSES, duration / 1600.0, 1600);
    let coarse_displacement = displacement_after(duration, 200);
    let fine_displacement = displacement_after(duration, 400);
    // Rotations move the edges by some metres times as much.
    let max_component = expected.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
    let min_component = expected.iter().fold(f64::INFINITY, |min, x| min.min(x.abs()));
    assert!(min_component > 1e-3 * max_component, "{expected:?}");
    let errors = [&coarse_displacement, &fine_displacement]
        .map(|u| max_difference(u, &expected) / max_component);
    let order = (errors[0] / errors[1]).log2();
    assert!(errors[1] < 1e-3 && (order - 2.0).abs() < 0.05, "{errors:?}, order {order}");
    let extrapolated_displacement: Vec<_> = coarse_displacement
        .iter()
        .zip(&fine_displacement)
        .map(|(c, f)| (4.0 * f - c) / 3.0)
        .collect();
    let error = max_difference(&extrapolated_displacement, &expected) / max_component;
    assert!(error < 2e-6, "{error:e}");
}

/// Newton's law in all six directions, from the accelerations of each step.
#[test]
fn resultants_on_the_soil_are_the_inertia_of_the_body() {
    let mut simulation = scene(2e-3).unwrap();
    let cells = cells(ECCENTRIC_CUBOID);
    let weight = STANDARD_GRAVITY * ECCENTRIC_CUBOID.mass();
    let settlement = simulation.static_displacement()[2];
    let area: f64 = (0..12).map(|e| cells.area(e)).sum();
    assert!((settlement * BED_PROPERTIES.stiffness[0] * area / weight + 1.0).abs() < 1e-9);
    for _ in 0..200 {
        let state = simulation.step().unwrap();
        let foundation = &state.foundations[0];
        let acceleration: [f64; 6] = state.acceleration().try_into().unwrap();
        let inertia_forces = ECCENTRIC_CUBOID.inertia_forces(acceleration);
        let resultants = [
            -foundation.base_shear,
            -foundation.shear_across,
            foundation.normal_force - weight,
            -foundation.moment_across,
            -foundation.base_moment,
            -foundation.torque,
        ];
        assert!(
            max_difference(&resultants, &inertia_forces) < 1e-9 * weight,
            "{resultants:?} {inertia_forces:?}"
        );
        assert_eq!(state.base_shear, foundation.base_shear);
        // Nothing slides.
        assert!(state.contact.iter().all(|contact| contact.slip_across.abs() < 1e-15));
    }
    let state = simulation.state();
    let foundation = &state.foundations[0];
    let contact = state.contact.iter().enumerate();
    let shear: f64 = contact.map(|(e, contact)| cells.area(e) * contact.shear_across).sum();
    assert!((shear - foundation.shear_across).abs() < 1e-9 * weight);
    assert!((foundation.base_rotation - state.displacement()[4]).abs() < 1e-15);
}

/// A slice one metre deep that moves along x alone is the block of the plane.
#[test]
fn a_slice_is_the_block_of_the_plane() {
    let scenes = plane_and_slice(|| Box::new(Bonded), &el_centro_1940(), 4e-3);
    let mut plane = scenes.plane.build().unwrap();
    let mut slice = scenes.slice.build().unwrap();
    let mut max_values = [0.0_f64; 4];
    let mut max_errors = [0.0_f64; 4];
    for _ in 0..500 {
        let pairs = equal_in_slices(plane.step().unwrap(), slice.step().unwrap(), 1e-14);
        for (k, [plane, slice]) in pairs.into_iter().enumerate() {
            max_values[k] = max_values[k].max(plane.abs());
            max_errors[k] = max_errors[k].max((plane - slice).abs());
        }
    }
    for (error, value) in max_errors.iter().zip(max_values) {
        assert!(*error < 1e-11 * value, "{max_errors:?} {max_values:?}");
    }
}

/// Displacement of a square body whose pulses are turned about the vertical axis.
fn turned_displacement(quarter_turns: usize) -> Vec<f64> {
    let square = Cuboid { sides: [6.0, 6.0, 9.0], density: 2000.0, center: [0.0; 2] };
    let bed = BED_PROPERTIES.isotropic();
    let mut simulation = Simulation::builder(2e-3)
        .structure(body(square))
        .ground(SpringCells::under([6.0; 2], [0.0; 2], [4, 4], bed))
        .interface(Bonded)
        .motion(CrossingPulses { quarter_turns })
        .build()
        .unwrap();
    simulation.run(200, |_| {}).unwrap();
    simulation.state().absolute_displacement().to_vec()
}

/// The displacements of a scene that is turned by 90 degrees about the vertical axis are turned, too.
#[test]
fn a_turned_scene_turns_its_displacements() {
    let u = turned_displacement(0);
    let v = turned_displacement(1);
    let expected = [-u[1], u[0], u[2], -u[4], u[3], u[5]];
    assert!(max_difference(&expected, &v) < 1e-14, "{expected:?} {v:?}");
    assert!(v.iter().all(|x| x.abs() > 1e-7), "{v:?}");
}

/// Motions of a corner at the top after 300 steps.
fn corner_motions(coordinates: Coordinates) -> Vec<f64> {
    let body = body(ECCENTRIC_CUBOID);
    let corner = body.displacement_at([4.0, 3.0, 9.0]);
    let mut simulation = Simulation::builder(2e-3)
        .structure(body)
        .ground(cells(ECCENTRIC_CUBOID))
        .interface(Bonded)
        .motion(STRAIGHT_PULSES)
        .coordinates(coordinates)
        .probe(Probe::absolute_displacement("along", corner[0].clone()))
        .probe(Probe::absolute_displacement("across", corner[1].clone()))
        .probe(Probe::acceleration("up", corner[2].clone()))
        .build()
        .unwrap();
    simulation.run(300, |_| {}).unwrap();
    simulation.state().probes.clone()
}

#[test]
fn modes_and_degrees_of_freedom_have_the_same_motion() {
    let physical = corner_motions(Coordinates::Physical);
    let modal = corner_motions(Coordinates::Modes);
    for (x, y) in physical.iter().zip(modal) {
        assert!(x.abs() > 1e-6 && (x - y).abs() < 1e-9 * x.abs(), "{x} {y}");
    }
}

#[test]
fn a_run_in_space_resumes_to_the_last_bit() {
    let mut uninterrupted_simulation = scene(2e-3).unwrap();
    uninterrupted_simulation.run(120, |_| {}).unwrap();
    let checkpoint = uninterrupted_simulation.checkpoint().unwrap();
    uninterrupted_simulation.run(80, |_| {}).unwrap();
    let mut resumed_simulation = scene(2e-3).unwrap();
    resumed_simulation.resume(&checkpoint).unwrap();
    assert!(resumed_simulation.state().free_field_across != 0.0);
    resumed_simulation.run(80, |_| {}).unwrap();
    assert_eq!(resumed_simulation.state(), uninterrupted_simulation.state());
}

/// The mass matrix about the middle of the base follows from Steiner's theorem; the polygon has the area of the circle.
#[test]
fn a_cylinder_has_the_mass_and_the_base_of_its_closed_form() {
    let radius = 3.0_f64;
    let height = 8.0;
    let density = 2500.0;
    let body = RigidBody::cylinder(radius, height, density).unwrap();
    let mass = std::f64::consts::PI * radius * radius * height * density;
    let mut matrix = Triplets::new(6);
    body.mass(&mut matrix).unwrap();
    let tilting_inertia = mass * (radius * radius / 4.0 + height * height / 3.0);
    let lever = mass * height / 2.0;
    let diagonal =
        [mass, mass, mass, tilting_inertia, tilting_inertia, mass * radius * radius / 2.0];
    let mut expected = [[0.0; 6]; 6];
    for (i, value) in diagonal.into_iter().enumerate() {
        expected[i][i] = value;
    }
    for (i, j, value) in [(0, 4, lever), (1, 3, -lever)] {
        expected[i][j] = value;
        expected[j][i] = value;
    }
    let mut computed = [[0.0; 6]; 6];
    matrix.entries().iter().for_each(|&(i, j, value)| computed[i][j] += value);
    let error = max_difference(computed.as_flattened(), expected.as_flattened());
    assert!(error < 1e-12 * tilting_inertia);
    let base = body.base();
    let corners: Vec<_> = base.nodes().collect();
    let next_corners = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next_corners);
    let area: f64 = pairs.map(|(a, b)| 0.5 * (a.x * b.y - b.x * a.y)).sum();
    assert!((area / (std::f64::consts::PI * radius * radius) - 1.0).abs() < 1e-14);
}

/// Boundaries of cells of one metre.
fn metre_lines(side: f64, count: u32) -> Vec<f64> {
    (0..=count).map(|k| side * (f64::from(k) / f64::from(count) - 0.5)).collect()
}

/// k Σ A y² of squares with a side of one metre: the integral minus the moments of the squares about their middles.
fn rocking_stiffness(side: f64, other_side: f64) -> f64 {
    BED_PROPERTIES.stiffness[0] * other_side * side * (side * side - 1.0) / 12.0
}

/// An eccentric mass on a bed: settlement and tilts of the closed form.
#[test]
fn an_eccentric_weight_tilts_the_body_about_both_axes() {
    const BASE_LENGTH: f64 = 8.0;
    const BASE_WIDTH: f64 = 6.0;
    let outline = vec![[-4.0, -3.0], [4.0, -3.0], [4.0, 3.0], [-4.0, 3.0]];
    let inertia = [[9e6, -1e5, 2e5], [-1e5, 8e6, 3e5], [2e5, 3e5, 7e6]];
    let mass = 4e5;
    let center = [0.7, -0.4, 3.0];
    let body = RigidBody::from_mass(outline, mass, inertia, center).unwrap();
    let cells = SpringCells::between(
        &metre_lines(BASE_LENGTH, 8),
        &metre_lines(BASE_WIDTH, 6),
        BED_PROPERTIES,
    );
    let simulation = Simulation::builder(0.01)
        .structure(body)
        .ground(cells)
        .interface(Bonded)
        .build()
        .unwrap();
    let weight = STANDARD_GRAVITY * mass;
    let u = simulation.static_displacement();
    let expected = [
        -weight / (BED_PROPERTIES.stiffness[0] * BASE_LENGTH * BASE_WIDTH),
        -weight * center[1] / rocking_stiffness(BASE_WIDTH, BASE_LENGTH),
        weight * center[0] / rocking_stiffness(BASE_LENGTH, BASE_WIDTH),
    ];
    let error = max_difference(&u[2..5], &expected);
    assert!(error < 1e-9 * expected[0].abs(), "{u:?} {expected:?}");
    let foundation = &simulation.state().foundations[0];
    assert!((foundation.moment_across + weight * center[1]).abs() < 1e-8 * weight);
    assert!((foundation.base_moment - weight * center[0]).abs() < 1e-8 * weight);
}

/// A page of a body in space has the results of the whole body, not of one metre of it.
#[test]
fn pages_have_values_of_the_whole_body() {
    let mut simulation = scene(2e-3).unwrap();
    let run = simulation.run(20, |_| {}).unwrap();
    let page = run.to_string();
    let weight = 9.80665e-3 * ECCENTRIC_CUBOID.mass();
    assert!(page.contains(&format!("Weight on the base: {weight:.1} kN\n")), "{page}");
    assert!(run.in_plan && !page.contains("kN/m") && !page.contains("kJ/m"), "{page}");
}
