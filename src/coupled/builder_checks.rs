//! Checks of a scene's parts that the builder makes.

use crate::bem::Ground;
use crate::error::{Result, finite};
use crate::matrix::check_order;
use crate::memory;
use crate::motion::FreeField;

/// Refuses more unknowns than fit into memory, by themselves or with a response to the traction of
/// each of `elements` contact elements.
pub(super) fn check_unknowns(unknowns: usize, elements: usize) -> Result<()> {
    check_order("unknowns of the structure", unknowns)?;
    // Two components of traction, and the responses twice while they are computed.
    let responses = 32.0 * unknowns as f64 * elements as f64;
    Ok(memory::check(
        "unknowns of the structure on its contact elements",
        unknowns as f64,
        responses,
    )?)
}

/// The free field at t = 0, from which it is measured.
pub(super) fn motion_at_start(
    ground: &dyn Ground,
    motion: &dyn FreeField,
    count: usize,
) -> Result<Vec<f64>> {
    let mut start = vec![0.0; 2 * count];
    ground.free_field(motion, 0.0, &mut start);
    match start.iter().find(|u| !u.is_finite()) {
        Some(bad) => finite("free field at t = 0", *bad).map(|_| start),
        None => Ok(start),
    }
}
