//! The modes in which the structure moves the elements: factors of W without the soil.

/// Largest number of modes.
pub(super) const RANK: usize = 24;
/// Diagonal that the modes leave out, relative to the largest of W: rounding.
const ROUNDING: f64 = 1e-14;

/// Pivoted Cholesky factors L of W without `soil(row, column)` and its diagonal's `layer(row)`, mode by mode.
///
/// `None` if the rest of W has too many modes or is not positive.
pub(super) fn find_modes(
    w: &[f64],
    size: usize,
    soil: impl Fn(usize, usize) -> f64,
    layer: impl Fn(usize) -> f64,
) -> Option<Vec<Vec<f64>>> {
    let held = |row: usize, column: usize| {
        soil(row, column) + if row == column { layer(row) } else { 0.0 }
    };
    let own = |i: usize| w[i * (size + 1)];
    let mut rest: Vec<f64> = (0..size).map(|i| own(i) - held(i, i)).collect();
    let least = (0..size).map(|i| ROUNDING * own(i)).fold(0.0, f64::max);
    let mut modes: Vec<Vec<f64>> = vec![];
    loop {
        let pivot = (0..size).max_by(|a, b| rest[*a].total_cmp(&rest[*b]))?;
        if rest[pivot] <= least {
            // A rest that is not positive has no such factors.
            return rest.iter().all(|rest| *rest >= -10.0 * least).then_some(modes);
        }
        if modes.len() == RANK {
            return None;
        }
        let root = rest[pivot].sqrt();
        let mode = (0..size).map(|i| {
            let known: f64 = modes.iter().map(|mode| mode[i] * mode[pivot]).sum();
            (w[i * size + pivot] - held(i, pivot) - known) / root
        });
        let mode: Vec<f64> = mode.collect();
        rest.iter_mut().zip(&mode).for_each(|(rest, own)| *rest -= own * own);
        rest[pivot] = 0.0;
        modes.push(mode);
    }
}
