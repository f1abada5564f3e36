//! Settlement of an elastic plate under a force.

use crate::error::{Result, finite, positive};

/// Settlement (m) of an infinite plate on springs under a `force` (N), at the force.
///
/// P/(8 √(k D)) for the bending `rigidity` D (N m) and the `bed` k of springs (N/m³), which pull too; Hertz 1884. The plate
/// does not shear. The formula is the integral of P κ/(2π (D κ⁴ + k)) over the wavenumber κ.
///
/// ```
/// use basemat::reference::hertz_plate_settlement;
/// assert_eq!(hertz_plate_settlement(8.0, 4.0, 1.0)?, 0.5);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless the force is finite, and rigidity and bed finite and above zero.
pub fn hertz_plate_settlement(force: f64, rigidity: f64, bed: f64) -> Result<f64> {
    finite("force on the plate", force)?;
    let product = positive("rigidity of the plate", rigidity)?.sqrt()
        * positive("bed of springs", bed)?.sqrt();
    Ok(force / (8.0 * product))
}
