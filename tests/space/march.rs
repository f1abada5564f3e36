//! Bonded rigid bodies on independent cells.

use basemat::coupled::{Coordinates, Probe};
use basemat::interface::Bonded;
use basemat::motion::el_centro_1940;
use basemat::structure::{RigidBody, Structure, Triplets};
use basemat::{Result, Simulation};

use super::cells::{BED, Bed, Cells, Waves, equal_in_slices, slices};
use super::equations::Cuboid;

const CUBOID: Cuboid = Cuboid { sides: [8.0, 6.0, 9.0], density: 2000.0, center: [2.0, -1.0] };

fn body(cuboid: Cuboid) -> RigidBody {
    RigidBody::cuboid(cuboid.sides, cuboid.density).unwrap().centered_at(cuboid.center).unwrap()
}

fn cells(cuboid: Cuboid) -> Cells {
    Cells::under([cuboid.sides[0], cuboid.sides[1]], cuboid.center, [4, 3], BED)
}

fn scene(cuboid: Cuboid, waves: Waves, bed: Bed, step: f64) -> Result<Simulation> {
    let ground = Cells::under([cuboid.sides[0], cuboid.sides[1]], cuboid.center, [4, 3], bed);
    Simulation::builder(step)
        .structure(body(cuboid))
        .ground(ground)
        .interface(Bonded)
        .motion(waves)
        .build()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

/// Errors of second order, and what is left without them.
#[test]
fn a_cuboid_follows_its_equations_of_motion() {
    let (waves, duration) = (Waves { quarters: 0 }, 0.8);
    let exact = CUBOID.march(&cells(CUBOID), BED, &waves, duration / 1600.0, 1600);
    let march = |steps: usize| {
        let mut simulation = scene(CUBOID, waves, BED, duration / steps as f64).unwrap();
        let run = simulation.run(steps, |_| {}).unwrap();
        assert!(run.energy_error < 1e-10, "{}", run.energy_error);
        simulation.state().absolute_displacement().to_vec()
    };
    let [coarse, fine] = [march(200), march(400)];
    // Rotations move the edges by some metres times as much.
    let size = exact.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let least = exact.iter().fold(f64::INFINITY, |least, x| least.min(x.abs()));
    assert!(least > 1e-3 * size, "{exact:?}");
    let errors = [&coarse, &fine].map(|u| apart(u, &exact) / size);
    let order = (errors[0] / errors[1]).log2();
    assert!(errors[1] < 1e-3 && (order - 2.0).abs() < 0.05, "{errors:?}, order {order}");
    let extrapolated: Vec<_> = coarse.iter().zip(&fine).map(|(c, f)| (4.0 * f - c) / 3.0).collect();
    let error = apart(&extrapolated, &exact) / size;
    assert!(error < 2e-6, "{error:e}");
}

/// Newton's law in all six directions, from the accelerations of each step.
#[test]
fn resultants_on_the_soil_are_the_inertia_of_the_body() {
    let mut simulation = scene(CUBOID, Waves { quarters: 0 }, BED, 2e-3).unwrap();
    let weight = 9.80665 * CUBOID.mass();
    let settlement = simulation.static_displacement()[2];
    let area: f64 = (0..12).map(|e| cells(CUBOID).cell(e).0).sum();
    assert!((settlement * BED.stiffness[0] * area / weight + 1.0).abs() < 1e-9);
    for _ in 0..200 {
        let state = simulation.step().unwrap();
        let own = &state.foundations[0];
        let acceleration: [f64; 6] = state.acceleration().try_into().unwrap();
        let force = CUBOID.inertia_forces(acceleration);
        let found = [
            -own.base_shear,
            -own.shear_across,
            own.normal_force - weight,
            -own.moment_across,
            -own.base_moment,
            -own.torque,
        ];
        assert!(apart(&found, &force) < 1e-9 * weight, "{found:?} {force:?}");
        assert_eq!(state.base_shear, own.base_shear);
        // Nothing slides.
        assert!(state.contact.iter().all(|own| own.slip_across.abs() < 1e-15));
    }
    let own = &simulation.state().foundations[0];
    let (contact, rotation) = (&simulation.state().contact, own.base_rotation);
    let sum: f64 =
        contact.iter().enumerate().map(|(e, own)| cells(CUBOID).cell(e).0 * own.shear_across).sum();
    assert!((sum - own.shear_across).abs() < 1e-9 * weight);
    assert!((rotation - simulation.state().displacement()[4]).abs() < 1e-15);
}

/// A slice one metre deep that moves along x alone is the block of the plane.
#[test]
fn a_slice_is_the_block_of_the_plane() {
    let scenes = slices(|| Box::new(Bonded), &el_centro_1940(), 4e-3);
    let [mut plane, mut space] = scenes.map(|scene| scene.build().unwrap());
    let mut largest = [0.0_f64; 4];
    let mut errors = [0.0_f64; 4];
    for _ in 0..500 {
        let pairs = equal_in_slices(plane.step().unwrap(), space.step().unwrap(), 1e-14);
        for (k, [plane, space]) in pairs.into_iter().enumerate() {
            largest[k] = largest[k].max(plane.abs());
            errors[k] = errors[k].max((plane - space).abs());
        }
    }
    for (error, largest) in errors.iter().zip(largest) {
        assert!(*error < 1e-11 * largest, "{errors:?} {largest:?}");
    }
}

/// A scene that is turned by 90 degrees about the vertical axis has displacements that are.
#[test]
fn a_turned_scene_turns_its_displacements() {
    let square = Cuboid { sides: [6.0, 6.0, 9.0], density: 2000.0, center: [0.0; 2] };
    let [k, c] = [BED.stiffness, BED.dashpot].map(|values| [values[0], values[1], values[1]]);
    let bed = Bed { stiffness: k, dashpot: c };
    let march = |quarters| {
        let ground = Cells::under([6.0; 2], [0.0; 2], [4, 4], bed);
        let mut simulation = Simulation::builder(2e-3)
            .structure(body(square))
            .ground(ground)
            .interface(Bonded)
            .motion(Waves { quarters })
            .build()
            .unwrap();
        simulation.run(200, |_| {}).unwrap();
        simulation.state().absolute_displacement().to_vec()
    };
    let [u, v] = [march(0), march(1)];
    let turned = [-u[1], u[0], u[2], -u[4], u[3], u[5]];
    assert!(apart(&turned, &v) < 1e-14 && v.iter().all(|x| x.abs() > 1e-7), "{turned:?} {v:?}");
}

#[test]
fn modes_and_degrees_of_freedom_march_alike() {
    let march = |coordinates| {
        let body = body(CUBOID);
        let [along, away, up] = body.displacement_at([4.0, 3.0, 9.0]);
        let mut simulation = Simulation::builder(2e-3)
            .structure(body)
            .ground(cells(CUBOID))
            .interface(Bonded)
            .motion(Waves { quarters: 0 })
            .coordinates(coordinates)
            .probe(Probe::absolute_displacement("along", along))
            .probe(Probe::absolute_displacement("away", away))
            .probe(Probe::acceleration("up", up))
            .build()
            .unwrap();
        simulation.run(300, |_| {}).unwrap();
        simulation.state().probes.clone()
    };
    let [physical, modes] = [march(Coordinates::Physical), march(Coordinates::Modes)];
    for (one, other) in physical.iter().zip(modes) {
        assert!(one.abs() > 1e-6 && (one - other).abs() < 1e-9 * one.abs(), "{one} {other}");
    }
}

#[test]
fn a_run_in_plan_resumes_to_the_last_bit() {
    let make = || scene(CUBOID, Waves { quarters: 0 }, BED, 2e-3).unwrap();
    let mut whole = make();
    whole.run(120, |_| {}).unwrap();
    let saved = whole.checkpoint().unwrap();
    whole.run(80, |_| {}).unwrap();
    let mut resumed = make();
    resumed.resume(&saved).unwrap();
    assert!(resumed.state().free_field_across != 0.0);
    resumed.run(80, |_| {}).unwrap();
    assert_eq!(resumed.state(), whole.state());
}

/// Mass matrix about the middle of the base, by Steiner, and the area of the polygon.
#[test]
fn a_cylinder_has_the_mass_and_the_base_of_its_closed_form() {
    let (radius, height, density) = (3.0_f64, 8.0, 2500.0);
    let body = RigidBody::cylinder(radius, height, density).unwrap();
    let mass = std::f64::consts::PI * radius * radius * height * density;
    let mut matrix = Triplets::new(6);
    body.mass(&mut matrix).unwrap();
    let tilting = mass * (radius * radius / 4.0 + height * height / 3.0);
    let lever = mass * height / 2.0;
    let mut exact = [[0.0; 6]; 6];
    for (i, value) in
        [mass, mass, mass, tilting, tilting, mass * radius * radius / 2.0].into_iter().enumerate()
    {
        exact[i][i] = value;
    }
    for (i, j, value) in [(0, 4, lever), (1, 3, -lever)] {
        (exact[i][j], exact[j][i]) = (value, value);
    }
    let mut found = [[0.0; 6]; 6];
    matrix.entries().iter().for_each(|&(i, j, value)| found[i][j] += value);
    assert!(apart(found.as_flattened(), exact.as_flattened()) < 1e-12 * tilting);
    let base = body.base();
    let face: Vec<_> = base.nodes().collect();
    let next = face.iter().cycle().skip(1);
    let area: f64 = face.iter().zip(next).map(|(a, b)| 0.5 * (a.x * b.y - b.x * a.y)).sum();
    assert!((area / (std::f64::consts::PI * radius * radius) - 1.0).abs() < 1e-14);
}

/// An eccentric mass on a bed: settlement and tilts of the closed form.
#[test]
fn an_eccentric_weight_tilts_the_body_about_both_axes() {
    let [l, b] = [8.0, 6.0];
    let outline = vec![[-4.0, -3.0], [4.0, -3.0], [4.0, 3.0], [-4.0, 3.0]];
    let inertia = [[9e6, -1e5, 2e5], [-1e5, 8e6, 3e5], [2e5, 3e5, 7e6]];
    let (mass, [x, y, z]) = (4e5, [0.7, -0.4, 3.0]);
    let body = RigidBody::from_mass(outline, mass, inertia, [x, y, z]).unwrap();
    let lines = |side: f64, count: u32| -> Vec<f64> {
        (0..=count).map(|k| side * (f64::from(k) / f64::from(count) - 0.5)).collect()
    };
    let simulation = Simulation::builder(0.01)
        .structure(body)
        .ground(Cells::between(&lines(l, 8), &lines(b, 6), BED))
        .interface(Bonded)
        .build()
        .unwrap();
    let weight = 9.80665 * mass;
    // Σ A y² of squares with a side of one metre: the integral less the own moment of each.
    let tilting =
        |side: f64, other: f64| BED.stiffness[0] * other * side * (side * side - 1.0) / 12.0;
    let u = simulation.static_displacement();
    let exact = [
        -weight / (BED.stiffness[0] * l * b),
        -weight * y / tilting(b, l),
        weight * x / tilting(l, b),
    ];
    assert!(apart(&u[2..5], &exact) < 1e-9 * exact[0].abs(), "{u:?} {exact:?}");
    let own = &simulation.state().foundations[0];
    assert!((own.moment_across + weight * y).abs() < 1e-8 * weight);
    assert!((own.base_moment - weight * x).abs() < 1e-8 * weight);
}

/// A page in plan is of the whole body, not of a metre of it.
#[test]
fn pages_are_of_the_whole_body() {
    let mut simulation = scene(CUBOID, Waves { quarters: 0 }, BED, 2e-3).unwrap();
    let run = simulation.run(20, |_| {}).unwrap();
    let page = run.to_string();
    let weight = 9.80665e-3 * CUBOID.mass();
    assert!(page.contains(&format!("Weight on the base: {weight:.1} kN\n")), "{page}");
    assert!(run.in_plan && !page.contains("kN/m") && !page.contains("kJ/m"), "{page}");
}
