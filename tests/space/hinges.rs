//! GOAL: a hinge whose bending moments yield on a circle is the same in all directions, and its energy balance closes.
//! SCENE: a mast of circular section on a rigid raft, with a hinge at its foot, under a pulse and shaken.
//! REFERENCE: the pulse along x; the rigid–plastic closed form; balance of energy.

use std::any::Any;

use basemat::coupled::{Load, Probe};
use basemat::fem::{BeamSection, Direction, LumpedMass, Material, Mesh, SpaceBeam, SpaceHinge};
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::FemModel;
use basemat::{Result, Simulation};

use super::cells::{BED_PROPERTIES, CrossingPulses, SpringCells};

const RAFT_SIDE: f64 = 4.0;
const MAST_HEIGHT: f64 = 6.0;
const TOP_MASS: f64 = 30.0e3;
const PLASTIC_MOMENT: f64 = 400.0e3;
/// Duration of a pulse, s.
const PULSE_DURATION: f64 = 0.8;

/// A mast on a hinge of this strength and stiffness; returns its top, too.
fn mast(
    plastic_moment: f64,
    bending_stiffness: f64,
    hardening_ratio: f64,
    young_modulus: f64,
) -> Result<(FemModel, usize)> {
    let mut mesh = Mesh::in_space();
    let mut corners = Vec::new();
    for [x, y] in [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] {
        let corner = mesh.add_node_at([x * RAFT_SIDE, y * RAFT_SIDE, 0.0])?;
        mesh.add(LumpedMass::in_space(corner, 10e3, [1.0; 3])?)?;
        corners.push(corner);
    }
    let center = mesh.add_node_at([0.0; 3])?;
    let foot = mesh.add_node_at([0.0; 3])?;
    let top = mesh.add_node_at([0.0, 0.0, MAST_HEIGHT])?;
    let material = Material::new(young_modulus, 0.2, 10.0)?;
    let section = BeamSection::new(0.5, [0.02; 2], 0.04)?;
    mesh.add(SpaceBeam::new([foot, top], material, section, [1.0, 0.0, 0.0])?)?;
    mesh.add(LumpedMass::in_space(top, TOP_MASS, [10.0; 3])?)?;
    // The axes of the hinge need not be those of the motion.
    let axes = [[0.0, 0.0, 1.0], [0.8, 0.6, 0.0]];
    let stiffness = [1.0e10, bending_stiffness, bending_stiffness];
    let hinge = SpaceHinge::new([center, foot], axes, 1.0e11, stiffness, [plastic_moment; 2])?;
    mesh.add(hinge.with_hardening(hardening_ratio)?)?;
    let model = FemModel::on_faces(mesh, std::slice::from_ref(&corners))?;
    Ok((model.with_rigid_link(center, &corners)?, top))
}

/// Displacements of the top along and across a force at an angle from x, on a fixed base.
fn pushed_displacements(angle: f64, force: f64) -> Vec<[f64; 2]> {
    let (model, top) = mast(PLASTIC_MOMENT, 1e6 * PLASTIC_MOMENT, 0.0, 1.0e14).unwrap();
    let x = model.row(top, Direction::X).unwrap();
    let y = model.row(top, Direction::Y).unwrap();
    let along = angle.cos() * x.clone() + angle.sin() * y.clone();
    let across = angle.cos() * y + -angle.sin() * x;
    let load = move |time: f64| if time > 0.0 && time < PULSE_DURATION { force } else { 0.0 };
    let mut simulation = Simulation::builder(5e-4)
        .ground(SpringCells::under([RAFT_SIDE; 2], [0.0; 2], [3, 3], BED_PROPERTIES))
        .structure(model)
        .interface(Bonded)
        .motion(basemat::motion::AtRest)
        .load(Load::new(along.clone(), load))
        .probe(Probe::displacement("along", along))
        .probe(Probe::displacement("across", across))
        .on_fixed_base()
        .build()
        .unwrap();
    let mut displacements = Vec::new();
    let run = simulation
        .run(3600, |state| displacements.push([state.probes[0], state.probes[1]]))
        .unwrap();
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    displacements
}

/// Largest displacement along the force.
fn peak(displacements: &[[f64; 2]]) -> f64 {
    displacements.iter().fold(0.0, |max: f64, [along, _]| max.max(along.abs()))
}

#[test]
fn a_pulse_in_any_direction_turns_the_mast_alike() {
    let force = 2.0 * PLASTIC_MOMENT / MAST_HEIGHT;
    let reference = pushed_displacements(0.0, force);
    let excess_moment = force * MAST_HEIGHT - PLASTIC_MOMENT;
    let rotation = force * excess_moment * PULSE_DURATION.powi(2)
        / (2.0 * TOP_MASS * MAST_HEIGHT * PLASTIC_MOMENT);
    let peak_rotation = peak(&reference) / MAST_HEIGHT;
    println!("{peak_rotation} for {rotation}");
    assert!((peak_rotation / rotation - 1.0).abs() < 5e-3);
    for angle in [0.5, 1.3, 4.0] {
        let turned_displacements = pushed_displacements(angle, force);
        let scale = peak(&reference);
        let mut max_difference = 0.0_f64;
        for ([along, across], [expected, _]) in turned_displacements.iter().zip(&reference) {
            max_difference =
                max_difference.max((along - expected).abs() / scale).max(across.abs() / scale);
        }
        println!("{angle}: {max_difference:.1e}");
        assert!(max_difference < 1e-9, "{angle}: {max_difference:e}");
    }
}

#[test]
fn a_mast_that_yields_closes_the_energy() {
    let model = mast(0.1 * PLASTIC_MOMENT, 200.0 * PLASTIC_MOMENT, 0.01, 30.0e9).unwrap().0;
    let hinge = model.inelastic_elements().next().unwrap();
    let mut simulation = Simulation::builder(2e-3)
        .ground(SpringCells::under([RAFT_SIDE; 2], [0.0; 2], [4, 4], BED_PROPERTIES))
        .structure(model)
        .interface(Coulomb::new(0.1).unwrap())
        .motion(CrossingPulses { quarter_turns: 0 })
        .expected_steps(600)
        .build()
        .unwrap();
    let run = simulation.run(600, |_| {}).unwrap();
    let balance = &run.energy_balance;
    let structure: &dyn Any = simulation.structure();
    let state = structure.downcast_ref::<FemModel>().unwrap().hinge_state(hinge).unwrap();
    println!(
        "open by {:.1e}, hysteresis {:.3}, contact {:.3}, {state:?}",
        run.energy_error,
        balance.hysteresis / balance.input,
        balance.contact / balance.input
    );
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    assert!(balance.hysteresis > 0.0 && balance.midstep_remainder >= 0.0);
}
