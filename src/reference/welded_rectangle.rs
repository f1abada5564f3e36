//! Approximate impedances of a rigid rectangle welded to a half-space.

use crate::error::{Result, not_negative, positive, require};
use crate::{Complex, Soil};

/// Impedances of a rigid rectangle welded to a half-space, by formulas of Pais and Kausel, at a `frequency` (Hz).
///
/// `sides` are the shorter and the longer side (m). Returned are the impedances sideways along the shorter and along the
/// longer side, vertical (N/m), and in rocking about the longer axis (N m/rad); their imaginary parts belong to e^(iωt).
///
/// Pais and Kausel, "Approximate formulas for dynamic stiffnesses of rigid foundations", Soil Dynamics and Earthquake
/// Engineering 7 (1988), 213–227. The paper was not at hand: the formulas were read in the package geofound and in notes of
/// the program SASSI-EDU, which take them from NIST GCR 12-917-21. Left out is where the two differ: the frequency
/// dependence of the vertical spring, and rocking about the shorter axis. docs/validation.md compares them with computed
/// impedances.
///
/// ```
/// use basemat::{Soil, reference::pais_kausel_impedances};
/// // Static springs of a square 2b × 2b: 9.2 μb/(2 − ν), 4.7 μb/(1 − ν), 4 μb³/(1 − ν).
/// let [translation, _, vertical, rocking] = pais_kausel_impedances(Soil::new(1.0, 0.25, 1.0)?, [2.0, 2.0], 0.0)?;
/// assert!((translation.re - 9.2 / 1.75).abs() < 1e-14 && (vertical.re - 4.7 / 0.75).abs() < 1e-14);
/// assert!((rocking.re - 4.0 / 0.75).abs() < 1e-14 && rocking.im == 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless the sides are finite, above zero and in order, and the frequency finite and
/// not negative.
pub fn pais_kausel_impedances(soil: Soil, sides: [f64; 2], frequency: f64) -> Result<[Complex; 4]> {
    let half = 0.5 * positive("shorter side of the rectangle", sides[0])?;
    positive("longer side of the rectangle", sides[1])?;
    require(
        "longer side of the rectangle",
        sides[1],
        sides[1] >= sides[0],
        "at least the shorter",
    )?;
    not_negative("frequency", frequency)?;
    let poisson = soil.poisson();
    let aspect = sides[1] / sides[0];
    let dimensionless_frequency =
        std::f64::consts::TAU * frequency * half / soil.shear_wave_speed();
    let speed_ratio = (soil.pressure_wave_speed() / soil.shear_wave_speed()).min(2.5);
    let translation = 6.8 * aspect.powf(0.65);
    let square = dimensionless_frequency * dimensionless_frequency;
    let cube = 0.4 / aspect.powi(3);
    let reduction = (0.55 + 0.01 * (aspect - 1.0).sqrt()) * square / (2.4 - cube + square);
    let area = 4.0 * aspect * dimensionless_frequency;
    let unit = soil.shear_modulus() * half;
    Ok([
        Complex::new((translation + 0.8 * aspect + 1.6) / (2.0 - poisson), area) * unit,
        Complex::new((translation + 2.4) / (2.0 - poisson), area) * unit,
        Complex::new((3.1 * aspect.powf(0.75) + 1.6) / (1.0 - poisson), speed_ratio * area) * unit,
        Complex::new(
            (3.2 * aspect + 0.8) / (1.0 - poisson) * (1.0 - reduction),
            speed_ratio * area / 3.0 * square / (2.2 - cube + square),
        ) * (unit * half * half),
    ])
}
