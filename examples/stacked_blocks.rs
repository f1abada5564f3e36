//! Two stacked blocks: a heavy machine on its concrete foundation, which both may slide.
//!
//! The block of concrete stands on firm ground, the machine on the block. A joint between them has the same laws and
//! results as the base. The table compares frictions of the joint: below a joint that slides early, the base slides less.
//!
//! ```text
//! cargo run --release --example stacked_blocks
//! ```

use basemat::Result;
use basemat::coupled::{Joint, JointState, Theta};
use basemat::prelude::*;

/// Runs 20 s of El Centro; returns the run and the joint's last state.
fn shake(friction: f64) -> Result<(Run, JointState)> {
    let block = RigidBlock::new(6.0, 1.5, 2400.0)?;
    let machine = RigidBlock::new(4.0, 1.0, 3000.0)?;
    // Both sides of the joint, listed from left to right: the upper side stands on the lower one.
    let lower = block.contact_nodes(&[[-2.0, 1.5], [2.0, 1.5]])?;
    let upper = machine.contact_nodes(&[[-2.0, 0.0], [2.0, 0.0]])?;
    // The machine does not stand on the ground: it stands 1.5 m above the surface.
    let group = StructureGroup::new().with(block, 0.0)?.with_above(machine, [0.0, 1.5])?;
    let joint = Joint::between(group.contact_nodes(1, upper)?, group.contact_nodes(0, lower)?, 8)?;

    let soil = Soil::from_shear_wave_speed(300.0, 0.3, 2000.0)?;
    let mut simulation = Simulation::builder(0.002)
        .ground(ElasticGround::under(soil, &group, 8)?)
        .structure(group)
        .interface(Coulomb::new(0.35)?)
        .joint(joint.with_law(Coulomb::new(friction)?))
        .motion(el_centro_1940().scaled(2.0)?)
        // Hard bodies that strike each other lose the energy of the impact.
        .scheme(Theta::new(1.0)?)
        .build()?;
    let steps = simulation.steps_for(20.0);
    let run = simulation.run(steps, |_| {})?;
    let joint = simulation.state().joints[0].clone();
    Ok((run, joint))
}

fn main() -> Result<()> {
    println!("Machine on a block, El Centro 1940 twice, friction of the ground 0.35\n");
    println!(
        "| friction of the joint | slip of the joint, mm | slip of the base, mm | base shear, kN/m | lost in the joint, kJ/m |"
    );
    println!("|---|---|---|---|---|");
    let mut base_slips = Vec::new();
    for friction in [0.15, 0.25, 0.6] {
        let (run, joint) = shake(friction)?;
        let base_slip = run.whole.largest_slip.magnitude();
        println!(
            "| {friction} | {:.1} | {:.1} | {:.1} | {:.2} |",
            1e3 * joint.mean_slip.abs(),
            1e3 * base_slip,
            1e-3 * run.whole.base_shear.magnitude(),
            1e-3 * joint.contact_energy,
        );
        base_slips.push(base_slip);
    }
    println!(
        "\nThe base reaches its friction limit in each run. Below a joint that slides early it slides less."
    );
    assert!(base_slips[0] < base_slips[2]);
    Ok(())
}
