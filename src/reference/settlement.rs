//! Settlements of a plate on springs, and of the surface of a half-space, under loads.

use crate::Soil;
use crate::error::{Result, finite, positive};

/// Settlement (m) of an infinite plate on springs under a `force` (N), at the force.
///
/// P/(8 √(k D)) for the bending `rigidity` D (N m) and the stiffness k (`bed`, N/m³) of springs with tension; Hertz 1884.
/// The plate has no shear deformation. The formula is the integral of P κ/(2π (D κ⁴ + k)) over the wavenumber κ.
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
    let root_product = positive("rigidity of the plate", rigidity)?.sqrt()
        * positive("bed of springs", bed)?.sqrt();
    Ok(force / (8.0 * root_product))
}

/// Settlement (m) of the surface of a half-space under a uniform `pressure` on a rectangle.
///
/// The rectangle has the `sides` (m) along x and y, and its middle at the origin; the `pressure` is in Pa. The `point`
/// (m) of the settlement may be under the load or beside it. The formula is the integral of Boussinesq's solution
/// p (1 − ν)/(2πμ r) over the rectangle; Johnson, *Contact Mechanics*, 1985, section 3.3. The settlement in the middle of
/// a perfectly flexible square plate of width B is 4 ln(1 + √2)/π · p B (1 − ν)/(2μ):
///
/// ```
/// use basemat::{Soil, reference::loaded_rectangle_settlement};
/// let soil = Soil::new(1.0, 0.5 - 1e-12, 1.0)?;
/// let middle = loaded_rectangle_settlement(soil, 4.0, [1.0, 1.0], [0.0, 0.0])?;
/// let corner = loaded_rectangle_settlement(soil, 4.0, [1.0, 1.0], [0.5, 0.5])?;
/// assert!((middle - 1.122_199).abs() < 1e-6);
/// assert!((middle - 2.0 * corner).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless pressure and point are finite, and the sides finite and above zero.
pub fn loaded_rectangle_settlement(
    soil: Soil,
    pressure: f64,
    sides: [f64; 2],
    point: [f64; 2],
) -> Result<f64> {
    finite("pressure on the rectangle", pressure)?;
    for k in 0..2 {
        positive("side of the rectangle", sides[k])?;
        finite("coordinate of the point", point[k])?;
    }
    // The four rectangles between the point and the corners; signed sides make their sum valid outside the load too.
    let signed_sides = [0, 1].map(|k| [0.5 * sides[k] - point[k], 0.5 * sides[k] + point[k]]);
    let integral: f64 = signed_sides[0]
        .into_iter()
        .flat_map(|a| signed_sides[1].map(|b| half_integral(a, b) + half_integral(b, a)))
        .sum();
    let unit = (1.0 - soil.poisson()) / (2.0 * std::f64::consts::PI * soil.shear_modulus());
    Ok(pressure * unit * integral)
}

/// a arsinh(b/|a|), one of two terms of the integral of 1/r over a rectangle a × b from its corner.
///
/// The term is odd in both sides.
fn half_integral(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() }
}
