//! Classes of the pairs of elements around a trench.

use crate::error::Result;
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, check_count};
use crate::history::{Pair, PairClasses};

/// Number of kinds of coefficients: normal, tangential, normal by tangential, and tangential by normal.
pub(super) const TRENCH_KINDS: usize = 4;

/// Sorts the pairs of elements around a trench into classes.
///
/// The elements follow the outline, and the second half mirrors the first one. Counted from the axis along either half,
/// class i(i + 1)/2 + j, j ≤ i, has the receiver i of the right half and the source j of the same half. As many classes
/// follow, whose source is j of the left half.
///
/// # Errors
/// As for [`check_count`].
pub(super) fn trench_classes(elements: Vec<ContactElement>) -> Result<PairClasses> {
    check_count(elements.len(), COMPONENTS_IN_PLANE)?;
    let count = elements.len();
    let half = count / 2;
    let same_half_classes = half * (half + 1) / 2;
    let from_axis =
        |element: usize| if element < half { half - 1 - element } else { element - half };
    let mut pairs = vec![];
    let mut exchanged = vec![];
    for (p, receiver) in elements.iter().enumerate() {
        for q in 0..count {
            let i = from_axis(p);
            let j = from_axis(q);
            let is_across = (p < half) != (q < half);
            let first_class = if is_across { same_half_classes } else { 0 };
            let class = i.max(j) * (i.max(j) + 1) / 2 + i.min(j) + first_class;
            let is_exchanged = i < j;
            // A receiver of the left half is the mirror image of one of the right half.
            let is_mirrored = if is_exchanged { q < half } else { p < half };
            let sign = if is_mirrored { -1.0 } else { 1.0 };
            pairs.push(Pair { class, scale: 1.0 / receiver.length(), sign });
            exchanged.push(is_exchanged);
        }
    }
    let mut representatives = Vec::with_capacity(2 * same_half_classes);
    for source_is_right in [true, false] {
        for i in 0..half {
            for j in 0..=i {
                let source = if source_is_right { half + j } else { half - 1 - j };
                representatives.push([elements[source], elements[half + i]]);
            }
        }
    }
    Ok(PairClasses::of_pairs(elements, pairs, representatives, TRENCH_KINDS, exchanged))
}
