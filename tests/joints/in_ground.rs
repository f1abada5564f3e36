//! Joints of a structure in the ground, and of structures on a fixed base.

use basemat::bem::SpringGround;
use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::coupled::{Joint, Theta};
use basemat::interface::Coulomb;
use basemat::motion::{AtRest, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{RigidBlock, StructureGroup, WithWalls};
use basemat::{Result, Simulation, Soil};

/// A block in a trench under another block: base, walls and joint are in one search.
#[test]
fn a_block_stands_on_a_basement() -> Result<()> {
    let basement = RigidBlock::new(8.0, 5.0, 2000.0)?;
    let block = RigidBlock::new(6.0, 6.0, 1500.0)?;
    let mut top = basement.contact_nodes(&[[-3.0, 5.0], [3.0, 5.0]])?;
    for node in &mut top {
        node.z -= 3.0;
    }
    let bottom = block.contact_nodes(&[[-3.0, 0.0], [3.0, 0.0]])?;
    let group = StructureGroup::new()
        .with(WithWalls::new(basement, 3.0)?, 0.0)?
        .with_above(block, [0.0, 2.0])?;
    let joint = Joint::between(group.contact_nodes(1, bottom)?, group.contact_nodes(0, top)?, 6)?;
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    let elements = Trench::new(-4.0..4.0, 3.0)?.elements(2, 4)?;
    let mut simulation = Simulation::builder(0.02)
        .structure(group)
        .ground(TrenchGround::new(soil, elements)?.with_pressure_at_rest(0.5)?)
        .interface(Coulomb::new(0.5)?)
        .joint(joint.with_law(Coulomb::new(0.4)?))
        .motion(AtRest)
        .initial_velocity(vec![0.0, 0.0, 0.0, 0.4, 0.0, 0.02])
        .expected_steps(50)
        .build()?;
    let weights = [8.0 * 5.0 * 2000.0, 6.0 * 6.0 * 1500.0].map(|mass| mass * STANDARD_GRAVITY);
    let state = simulation.state();
    assert!((state.joints[0].normal_force / weights[1] - 1.0).abs() < 1e-7);
    assert!((state.normal_force / (weights[0] + weights[1]) - 1.0).abs() < 1e-7);
    let run = simulation.run(50, |_| {})?;
    println!("{:?} {:e}", simulation.state().joints[0], run.energy_error);
    assert!(simulation.state().joints[0].contact_energy > 0.0);
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    Ok(())
}

/// On a fixed base the joint keeps its law.
#[test]
fn blocks_slide_on_a_fixed_base() -> Result<()> {
    let lower = RigidBlock::new(6.0, 1.0, 2400.0)?;
    let upper = RigidBlock::new(4.0, 1.0, 2400.0)?;
    let top = lower.contact_nodes(&[[-2.0, 1.0], [2.0, 1.0]])?;
    let bottom = upper.contact_nodes(&[[-2.0, 0.0], [2.0, 0.0]])?;
    let group = StructureGroup::new().with(lower, 0.0)?.with_above(upper, [0.0, 1.0])?;
    let joint = Joint::between(group.contact_nodes(1, bottom)?, group.contact_nodes(0, top)?, 4)?;
    let mut simulation = Simulation::builder(0.002)
        .ground(SpringGround::under(&group, 6, 4e8, 4e8)?)
        .structure(group)
        .interface(Coulomb::new(0.1)?)
        .joint(joint.with_law(Coulomb::new(0.2)?))
        .motion(el_centro_1940())
        .scheme(Theta::new(1.0)?)
        .on_fixed_base()
        .build()?;
    let mut largest_shear: f64 = 0.0;
    let run = simulation.run(3000, |state| {
        largest_shear = largest_shear.max(state.joints[0].shear_force.abs());
    })?;
    let friction = 0.2 * 4.0 * 2400.0 * STANDARD_GRAVITY;
    println!("{largest_shear} of {friction}, {:e}", run.energy_error);
    assert!((largest_shear / friction - 1.0).abs() < 1e-6);
    let base_slip = simulation.state().mean_slip;
    println!("slip of the base {base_slip:e} m");
    assert!(base_slip.abs() < 1e-9 && run.energy_error < 1e-9);
    Ok(())
}
