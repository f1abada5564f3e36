//! Moment capacity of a strip without tension on clay that yields.

use basemat::Result;
use basemat_problems::heavy;
use basemat_problems::strip_rotation::{REFERENCE_MOMENTS, RotatedStrip};

/// Largest relative difference from a moment of the reference, whose contact is at nodes, from 0.02 rad on.
const MOMENT_TOLERANCE: f64 = 0.05;

/// REFERENCE: another program on the same mesh (`tests/data/yielding/moment_capacity.md`).
///
/// Every night also the finer mesh, whose moments at 0.06 rad are near (N B/2)(1 − N/N_u), the capacity of the effective
/// width.
#[test]
fn a_rotated_strip_has_the_moments_of_reference() -> Result<()> {
    for (strip, expected) in REFERENCE_MOMENTS {
        let is_fine = strip.half_elements > 4;
        if is_fine && !heavy() {
            continue;
        }
        let moments = strip.relative_moments()?;
        let RotatedStrip { half_elements, safety_factor } = strip;
        println!("{half_elements} elements, F = {safety_factor}: {moments:.3?}");
        let pairs = moments.iter().zip(expected).skip(1);
        let mut ratios = pairs.map(|(moment, reference)| moment / reference);
        assert!(ratios.all(|ratio| (ratio - 1.0).abs() < MOMENT_TOLERANCE), "{moments:?}");
        assert!(!is_fine || (0.92..1.03).contains(&moments[3]), "{moments:?}");
    }
    Ok(())
}
