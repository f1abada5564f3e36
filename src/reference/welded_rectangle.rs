//! Approximate impedances of a rigid rectangle welded to a half-space.

use crate::error::{Result, not_negative, positive, require};
use crate::{Complex, Soil};

/// Largest ratio of wave speeds in the dashpots: the formulas limit it for nearly incompressible soil.
const MAX_SPEED_RATIO: f64 = 2.5;

/// Impedances of a rigid rectangle welded to a half-space, by Pais and Kausel.
///
/// `sides`: the shorter and the longer side, m; `frequency` in Hz. Returns the horizontal impedances along the shorter and
/// along the longer side (N/m), the vertical impedance (N/m), and the rocking impedance about the longer axis (N m/rad),
/// for the time factor e^(iωt).
///
/// Pais and Kausel, "Approximate formulas for dynamic stiffnesses of rigid foundations", Soil Dynamics and Earthquake
/// Engineering 7 (1988), 213–227. The formulas are taken from the package geofound and from notes of the program
/// SASSI-EDU, which quote NIST GCR 12-917-21, not from the paper itself. The two sources differ in the frequency
/// dependence of the vertical spring and in rocking about the shorter axis; both are omitted here. docs/validation.md
/// compares the formulas with computed impedances.
///
/// ```
/// use basemat::{Soil, reference::pais_kausel_impedances};
/// // Static stiffnesses of a square 2b × 2b: 9.2 μb/(2 − ν), 4.7 μb/(1 − ν), 4 μb³/(1 − ν).
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
    let half_width = 0.5 * positive("shorter side of the rectangle", sides[0])?;
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
        std::f64::consts::TAU * frequency * half_width / soil.shear_wave_speed();
    let speed_ratio = (soil.pressure_wave_speed() / soil.shear_wave_speed()).min(MAX_SPEED_RATIO);
    // Terms of the formulas: of both horizontal stiffnesses, of the rocking stiffness, and of all dashpots.
    let horizontal_term = 6.8 * aspect.powf(0.65);
    let square_frequency = dimensionless_frequency * dimensionless_frequency;
    let aspect_term = 0.4 / aspect.powi(3);
    let rocking_reduction = (0.55 + 0.01 * (aspect - 1.0).sqrt()) * square_frequency
        / (2.4 - aspect_term + square_frequency);
    let dashpot_term = 4.0 * aspect * dimensionless_frequency;
    let unit = soil.shear_modulus() * half_width;
    Ok([
        Complex::new((horizontal_term + 0.8 * aspect + 1.6) / (2.0 - poisson), dashpot_term) * unit,
        Complex::new((horizontal_term + 2.4) / (2.0 - poisson), dashpot_term) * unit,
        Complex::new((3.1 * aspect.powf(0.75) + 1.6) / (1.0 - poisson), speed_ratio * dashpot_term)
            * unit,
        Complex::new(
            (3.2 * aspect + 0.8) / (1.0 - poisson) * (1.0 - rocking_reduction),
            speed_ratio * dashpot_term / 3.0 * square_frequency
                / (2.2 - aspect_term + square_frequency),
        ) * (unit * half_width * half_width),
    ])
}
