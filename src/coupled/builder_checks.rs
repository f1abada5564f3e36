//! Checks of a scene's parts that the builder makes.

use crate::bem::Ground;
use crate::error::memory;
use crate::error::{Error, Result, all_finite, finite};
use crate::linalg::indefinite_pivot;
use crate::linalg::matrix::check_order;
use crate::motion::FreeField;

/// Negative eigenvalue of the ground's operator that is rounding, in the matrix scaled to a diagonal of
/// one.
const ROUNDING: f64 = 1e-9;

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

/// The ground's instantaneous operator, for a step over `lengths`: rows weighted by these, its symmetric
/// part must not be negative, or the ground would push back work that it never got.
pub(super) fn instantaneous_operator(ground: &dyn Ground, lengths: &[f64]) -> Result<Vec<f64>> {
    const NAME: &str = "instantaneous operator of the ground";
    let (count, size) = (lengths.len(), 2 * lengths.len());
    let mut operator = vec![0.0; size * size];
    ground.instantaneous(&mut operator)?;
    all_finite(NAME, &operator)?;
    let scale: Vec<f64> = (0..size)
        .map(|i| (lengths[i % count] * operator[i * (size + 1)].abs()).sqrt())
        .map(|root| if root > 0.0 { root.recip() } else { 1.0 })
        .collect();
    let weighted = |i: usize, j: usize| {
        0.5 * scale[i]
            * scale[j]
            * (lengths[i % count] * operator[i * size + j]
                + lengths[j % count] * operator[j * size + i])
    };
    let mut symmetric: Vec<f64> = (0..size * size).map(|k| weighted(k / size, k % size)).collect();
    for row in 0..size {
        symmetric[row * (size + 1)] += ROUNDING;
    }
    match indefinite_pivot(&symmetric, size) {
        None => Ok(operator),
        Some(row) => {
            let diagonal = operator[row * (size + 1)];
            Err(Error::Indefinite { matrix: NAME, row, diagonal })
        }
    }
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
