//! Six resultants of a model that lifts off and slides: a section at the base passes on the contact forces.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::State;
use basemat::fem::{Hex8, LumpedMass, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::structure::{FemModel, RayleighDamping, SectionRows};

/// Eight soft bricks with a mass on one corner, 4 m × 3 m × 5 m.
fn block() -> FemModel {
    let concrete = Material::new(2.0e8, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::in_space();
    let place =
        |row: usize, column: usize| [2.0 * column as f64 - 2.0, 1.5 * row as f64 - 1.5, 0.0];
    let foot = mesh.add_grid(3, 3, place).unwrap();
    for brick in foot.extrude(&mut mesh, &[2.0, 5.0]).unwrap() {
        mesh.add(Hex8::new(brick, concrete)).unwrap();
    }
    let corner = mesh.node_at_point([2.0, 1.5, 5.0]).unwrap();
    mesh.add(LumpedMass::in_space(corner, 3.0e4, [0.0; 3]).unwrap()).unwrap();
    let damping = RayleighDamping::new(0.0, 0.002).unwrap();
    FemModel::on_base(mesh).unwrap().with_rayleigh(damping)
}

/// Forces along x and y, pressure, moments about x and y, and torque of the only foundation.
fn contact(state: &State) -> [f64; 6] {
    let own = &state.foundations[0];
    let forces = [own.base_shear, own.shear_across, own.normal_force];
    let moments = [own.moment_across, own.base_moment, own.torque];
    [forces, moments].concat().try_into().unwrap()
}

#[test]
fn a_section_at_the_base_is_the_contact_force() {
    let model = block();
    let section = model.section_in_space(0.0, [0.0; 2]).unwrap();
    let [along, across] = &section.shear;
    let [about_x, about_y] = &section.moments;
    let rows: [&SectionRows; 6] =
        [along, across, &section.compression, about_x, about_y, &section.torque];
    let plan = Plan::rectangle(-2.0..2.0, -1.5..1.5, 4).unwrap();
    let ground = SpringGround::in_plan(plan, [4.0e7, 2.0e7, 2.0e7]).unwrap();
    let record = el_centro_1940().scaled(1.5).unwrap();
    let y = Some(record.padded(0.3, 0.0).unwrap());
    let motion = Triaxial { x: Some(record.clone()), y, up: Some(record.scaled(0.5).unwrap()) };
    let mut simulation = Simulation::builder(0.01)
        .structure(model)
        .ground(ground)
        .interface(Coulomb::new(0.3).unwrap())
        .motion(motion)
        .build()
        .unwrap();
    let rest = contact(simulation.state());
    let weight = (4.0 * 3.0 * 5.0 * 2400.0 + 3.0e4) * STANDARD_GRAVITY;
    assert!((rest[2] / weight - 1.0).abs() < 1e-9, "{} {weight}", rest[2]);
    let mut before =
        [simulation.state().displacement(), simulation.state().velocity()].map(<[f64]>::to_vec);
    let (mut slip, mut uplift, mut most) = (0.0_f64, 0.0_f64, [0.0_f64; 6]);
    for _ in 0..250 {
        let state = simulation.step().unwrap();
        let now = [state.displacement(), state.velocity()].map(<[f64]>::to_vec);
        // Tractions and accelerations act in the middle of the step.
        let [u, v] = [0, 1].map(|k| {
            let pairs = before[k].iter().zip(&now[k]);
            pairs.map(|(a, b)| 0.5 * (a + b)).collect::<Vec<f64>>()
        });
        for (k, (own, contact)) in rows.iter().zip(contact(state)).enumerate() {
            let (found, exact) = (own.value(&u, &v, state.acceleration()), contact - rest[k]);
            assert!((found - exact).abs() < 1e-8 * weight, "{k} {found} {exact}");
            most[k] = most[k].max(exact.abs());
        }
        (slip, uplift) = (slip.max(state.mean_slip.abs()), uplift.max(state.uplifted_fraction));
        before = now;
    }
    assert!(slip > 1e-3 && uplift > 0.1 && most.iter().all(|own| *own > 0.01 * weight));
}
