//! Checks of a scene's parts that the builder makes.

use crate::bem::Ground;
use crate::error::{Error, Result, finite};
use crate::motion::FreeField;

/// More unknowns than this are a mistake, or would not fit in memory.
const MOST_UNKNOWNS: usize = 10_000_000;

/// Refuses more unknowns than anything can hold.
pub(super) fn check_unknowns(unknowns: usize) -> Result<()> {
    if unknowns <= MOST_UNKNOWNS {
        return Ok(());
    }
    Err(Error::Input {
        quantity: "number of unknowns of the structure",
        value: unknowns as f64,
        needed: "ten million or fewer",
    })
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
