//! A block on a heavy rigid slab, which is bonded to stiff ground, and the same block on the ground.
//!
//! The joint is hard, but the ground of the reference has a compliance. Two impacts of the block magnify its effect: on
//! 10¹⁹ Pa/m the reference has a rotation that differs by 7e-6 of its peak from that on hard ground, and the difference falls in
//! proportion to the compliance. Rounding has no part in it: a motion scaled by 1 + 10⁻¹² changes the rotation by 6e-10.

use basemat::bem::SpringGround;
use basemat::coupled::{Joint, Theta};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::el_centro_1940;
use basemat::structure::{RigidBlock, StructureGroup};
use basemat::{Result, Simulation};

use super::assert_same_responses;

/// Stiffness of the ground per area, Pa/m: with no effect on the response after all impacts.
const GROUND_STIFFNESS: f64 = 1e21;
const ELEMENT_COUNT: usize = 8;
const FRICTION_COEFFICIENT: f64 = 0.45;

/// Mean slip and rotation of the block at every step.
fn responses(is_on_slab: bool) -> Result<[Vec<f64>; 2]> {
    let block = RigidBlock::new(2.0, 4.0, 2400.0)?;
    let bottom = block.contact_nodes(&[[-1.0, 0.0], [1.0, 0.0]])?;
    let builder = Simulation::builder(0.001)
        .motion(el_centro_1940().scaled(2.0)?)
        .scheme(Theta::new(1.0)?);
    let law = Coulomb::new(FRICTION_COEFFICIENT)?;
    let mut simulation = if is_on_slab {
        let slab = RigidBlock::new(6.0, 2.0, 1e5)?;
        let top = slab.contact_nodes(&[[-1.0, 2.0], [1.0, 2.0]])?;
        let group = StructureGroup::new().with(slab, 0.0)?.with_above(block, [0.0, 2.0])?;
        let upper = group.contact_nodes(1, bottom)?;
        let joint = Joint::between(upper, group.contact_nodes(0, top)?, ELEMENT_COUNT)?;
        builder
            .ground(SpringGround::under(&group, 6, GROUND_STIFFNESS, GROUND_STIFFNESS)?)
            .structure(group)
            .interface(Bonded)
            .joint(joint.with_law(law))
            .build()?
    } else {
        builder
            .ground(SpringGround::under(&block, ELEMENT_COUNT, GROUND_STIFFNESS, GROUND_STIFFNESS)?)
            .structure(block)
            .interface(law)
            .build()?
    };
    let mut responses = [Vec::new(), Vec::new()];
    let run = simulation.run(6000, |state| {
        let (slip, rotation) = match &state.joints[..] {
            [joint] => (joint.mean_slip, state.displacement()[5]),
            _ => (state.mean_slip, state.displacement()[2]),
        };
        responses[0].push(slip);
        responses[1].push(rotation);
    })?;
    println!("energy error {:e}", run.energy_error);
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    Ok(responses)
}

/// REFERENCE: the block on the ground itself.
#[test]
fn a_block_on_a_slab_moves_as_on_the_ground() -> Result<()> {
    let on_ground = responses(false)?;
    let on_slab = responses(true)?;
    let peaks = assert_same_responses(&on_ground, &on_slab, 1e-6);
    assert!(peaks.iter().all(|peak| *peak > 1e-4), "{peaks:?}");
    Ok(())
}
