//! The modes in which the structure moves the elements: factors of W without the soil.

use crate::contact::on_bed::MODE_TOLERANCE;
use crate::linalg::pivoted_cholesky;

/// Largest number of modes.
pub(super) const MAX_MODE_COUNT: usize = 24;

/// Pivoted Cholesky factors L of W without `soil(row, column)` and its diagonal's `layer(row)`, mode by mode.
///
/// `None` if the rest of W has too many modes or is not positive.
pub(super) fn find_modes(
    w: &[f64],
    size: usize,
    soil: impl Fn(usize, usize) -> f64,
    layer: impl Fn(usize) -> f64,
) -> Option<Vec<Vec<f64>>> {
    let other_part = |row: usize, column: usize| {
        soil(row, column) + if row == column { layer(row) } else { 0.0 }
    };
    let diagonal: Vec<f64> = (0..size).map(|i| w[i * (size + 1)]).collect();
    let rest = diagonal.iter().enumerate().map(|(i, entry)| entry - other_part(i, i)).collect();
    let tolerance = diagonal.iter().map(|entry| MODE_TOLERANCE * entry).fold(0.0, f64::max);
    pivoted_cholesky(rest, tolerance, MAX_MODE_COUNT, |pivot, column| {
        for (i, value) in column.iter_mut().enumerate() {
            *value = w[i * size + pivot] - other_part(i, pivot);
        }
    })
}
