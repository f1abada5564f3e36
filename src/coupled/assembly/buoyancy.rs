//! Buoyancy: forces of the water on a structure, and the check that its weight exceeds them.

use super::at_rest::StaticLoads;
use crate::coupled::base::influence::UPWARD_DIRECTION;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::parts::Parts;
use crate::coupled::run::mistake::Mistake;
use crate::coupled::run::warning::Warning;
use crate::error::{Error, Result, StabilityError};
use crate::geometry::span;
use crate::interface::{Mode, law_of};
use crate::structure::BaseNode;

/// Sets the force of the water and the buoyancy in the `parts`.
///
/// Returns an error for a part that floats, unless elements under it never open. With joints the whole model counts as
/// one part.
pub(super) fn set_water_force(parts: &mut Parts, assembled: &Assembled) -> Result<()> {
    let gravity = parts.builder.gravity;
    let Some(water) = parts.water_table.filter(|_| gravity > 0.0) else {
        return Ok(());
    };
    let dofs = assembled.dofs();
    let mut force = assembled.base.water_masses(&water, dofs)?;
    if force.is_empty() {
        return Ok(());
    }
    for value in &mut force {
        *value *= gravity;
    }
    let weight = StaticLoads::new(parts, assembled)?.weight;
    let base = &assembled.base;
    let laws = &parts.builder.laws;
    let is_plan = base.layout().is_plan();
    let has_joints = !base.joints().is_empty();
    let mut total_buoyancy = 0.0;
    let mut total_weight = 0.0;
    let mut base_can_open = true;
    for part in assembled.influence.parts() {
        let part_buoyancy = part.resultants(&force)[UPWARD_DIRECTION];
        let part_weight = -part.resultants(&weight)[UPWARD_DIRECTION];
        let mut downward = part.elements().iter().filter(|e| base.elements()[**e].faces_down());
        let part_can_open = downward.all(|e| law_of(laws, *e).modes().contains(&Mode::Open));
        if part_can_open && !has_joints {
            check_floating(&part.nodes(base), is_plan, [part_weight, part_buoyancy])?;
        }
        total_buoyancy += part_buoyancy;
        total_weight += part_weight;
        base_can_open &= part_can_open;
    }
    if base_can_open && has_joints {
        let nodes: Vec<_> = base.foundations().flat_map(|(nodes, _)| nodes).collect();
        check_floating(&nodes, is_plan, [total_weight, total_buoyancy])?;
    }
    parts.water_force = force;
    parts.buoyancy = total_buoyancy;
    parts.weight_in_water = total_weight;
    Ok(())
}

/// Warning of a water table below the base.
pub(super) fn warning(parts: &Parts) -> Option<Warning> {
    let has_no_force = parts.builder.gravity > 0.0 && parts.water_force.is_empty();
    let water = parts.water_table.filter(|_| has_no_force)?;
    Some(Warning::Mistake(Mistake::WaterBelowBase { depth: water.depth() }))
}

/// Returns an error unless the weight exceeds the buoyancy.
fn check_floating(nodes: &[&BaseNode], is_plan: bool, [weight, buoyancy]: [f64; 2]) -> Result<()> {
    if weight > buoyancy {
        return Ok(());
    }
    let ends = span(nodes.iter().map(|node| node.place()[0]));
    let y_ends = span(nodes.iter().map(|node| node.place()[1]));
    let across = is_plan.then_some(y_ends);
    let cause = StabilityError::Uplift { ends, across, upward: buoyancy - weight, buoyancy };
    Err(Error::Stability(Box::new(cause)))
}
