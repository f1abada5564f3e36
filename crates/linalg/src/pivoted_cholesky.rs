//! Factors of a positive semi-definite matrix of low rank: Cholesky's with pivots (Higham 2002, § 10.3).

/// Smallest value of the rest of a diagonal that counts as rounding, over the tolerance.
const ROUNDING_FACTOR: f64 = -10.0;

/// Columns of L with V = L Lᵀ, from the diagonal of V.
///
/// `column` overwrites a vector with the column of V at a place. The rest of the diagonal is at most `tolerance`. `None` if
/// L has more than `max_rank` columns, or V is not positive semi-definite.
pub fn pivoted_cholesky(
    diagonal: Vec<f64>,
    tolerance: f64,
    max_rank: usize,
    mut column: impl FnMut(usize, &mut [f64]),
) -> Option<Vec<Vec<f64>>> {
    let mut rest = diagonal;
    let mut factors: Vec<Vec<f64>> = vec![];
    loop {
        let pivot = (0..rest.len()).max_by(|a, b| rest[*a].total_cmp(&rest[*b]))?;
        if rest[pivot] <= tolerance {
            // A rest that is not positive has no such factors.
            return rest.iter().all(|rest| *rest >= ROUNDING_FACTOR * tolerance).then_some(factors);
        }
        if factors.len() == max_rank {
            return None;
        }
        let root = rest[pivot].sqrt();
        let mut factor = vec![0.0; rest.len()];
        column(pivot, &mut factor);
        for (i, value) in factor.iter_mut().enumerate() {
            let known: f64 = factors.iter().map(|other| other[i] * other[pivot]).sum();
            *value = (*value - known) / root;
        }
        rest.iter_mut().zip(&factor).for_each(|(rest, value)| *rest -= value * value);
        rest[pivot] = 0.0;
        factors.push(factor);
    }
}
