//! Six resultants of a model that lifts off and slides: a section at the base has the contact forces.

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
    let base_grid = mesh
        .add_grid(3, 3, |row, column| [2.0 * column as f64 - 2.0, 1.5 * row as f64 - 1.5, 0.0])
        .unwrap();
    for brick in base_grid.extrude(&mut mesh, &[2.0, 5.0]).unwrap() {
        mesh.add(Hex8::new(brick, concrete)).unwrap();
    }
    let corner = mesh.node_at_point([2.0, 1.5, 5.0]).unwrap();
    mesh.add(LumpedMass::in_space(corner, 3.0e4, [0.0; 3]).unwrap()).unwrap();
    let damping = RayleighDamping::new(0.0, 0.002).unwrap();
    FemModel::on_base(mesh).unwrap().with_rayleigh(damping)
}

/// The block on springs, shaken along x, y and upwards.
fn simulation(model: FemModel) -> Simulation {
    let plan = Plan::rectangle(-2.0..2.0, -1.5..1.5, 4).unwrap();
    let ground = SpringGround::in_plan(plan, [4.0e7, 2.0e7, 2.0e7]).unwrap();
    let record = el_centro_1940().scaled(1.5).unwrap();
    let y = Some(record.padded(0.3, 0.0).unwrap());
    let motion = Triaxial { x: Some(record.clone()), y, up: Some(record.scaled(0.5).unwrap()) };
    Simulation::builder(0.01)
        .structure(model)
        .ground(ground)
        .interface(Coulomb::new(0.3).unwrap())
        .motion(motion)
        .build()
        .unwrap()
}

/// Forces along x and y, pressure, moments about x and y, and torque of the only foundation.
fn contact_resultants(state: &State) -> [f64; 6] {
    let foundation = &state.foundations[0];
    [
        foundation.base_shear,
        foundation.shear_across,
        foundation.normal_force,
        foundation.moment_across,
        foundation.base_moment,
        foundation.torque,
    ]
}

/// Mean of two vectors of degrees of freedom.
fn midpoint(start: &[f64], end: &[f64]) -> Vec<f64> {
    start.iter().zip(end).map(|(start, end)| 0.5 * (start + end)).collect()
}

#[test]
fn a_section_at_the_base_has_the_contact_forces() {
    let model = block();
    let section = model.section_in_space(0.0, [0.0; 2]).unwrap();
    let section_rows: [&SectionRows; 6] = [
        &section.shear[0],
        &section.shear[1],
        &section.compression,
        &section.moments[0],
        &section.moments[1],
        &section.torque,
    ];
    let mut simulation = simulation(model);
    let at_rest = contact_resultants(simulation.state());
    let weight = (4.0 * 3.0 * 5.0 * 2400.0 + 3.0e4) * STANDARD_GRAVITY;
    assert!((at_rest[2] / weight - 1.0).abs() < 1e-9, "{} {weight}", at_rest[2]);
    let mut max_slip = 0.0_f64;
    let mut max_uplift = 0.0_f64;
    let mut max_resultants = [0.0_f64; 6];
    for _ in 0..250 {
        let start_displacement = simulation.state().displacement().to_vec();
        let start_velocity = simulation.state().velocity().to_vec();
        let state = simulation.step().unwrap();
        // Tractions and accelerations act in the middle of the step.
        let u = midpoint(&start_displacement, state.displacement());
        let v = midpoint(&start_velocity, state.velocity());
        for (k, contact) in contact_resultants(state).into_iter().enumerate() {
            let computed = section_rows[k].value(&u, &v, state.acceleration());
            let expected = contact - at_rest[k];
            assert!((computed - expected).abs() < 1e-8 * weight, "{k} {computed} {expected}");
            max_resultants[k] = max_resultants[k].max(expected.abs());
        }
        max_slip = max_slip.max(state.mean_slip.abs());
        max_uplift = max_uplift.max(state.uplifted_fraction);
    }
    assert!(max_slip > 1e-3 && max_uplift > 0.1);
    assert!(max_resultants.iter().all(|resultant| *resultant > 0.01 * weight));
}
