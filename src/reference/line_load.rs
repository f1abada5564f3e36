//! Static line loads on the surface of a half-plane and within a full plane.
//!
//! In two dimensions the displacement due to a line load varies with the logarithm of the distance, also at infinity.
//! Therefore only displacements relative to another point are defined.

use std::f64::consts::PI;

use crate::Soil;
use crate::error::{Result, finite, positive};

/// Settlement of the surface under a vertical line load, relative to a far point, m.
///
/// (1−ν)P/(πμ) ln(far/near), downwards, at the distance `near_distance` (m) from the line load P (N/m, downwards),
/// relative to the distance `far_distance` (m).
///
/// Flamant 1892; Johnson, *Contact Mechanics*, 1985, eq. 2.19b.
///
/// ```
/// use basemat::{Soil, reference::flamant_relative_settlement};
/// let soil = Soil::new(1.0, 0.5 - 1e-12, 1.0)?;
/// let settlement = flamant_relative_settlement(soil, 2.0, 1.0, 1.0_f64.exp())?;
/// assert!((settlement - 1.0 / std::f64::consts::PI).abs() < 1e-11);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless the load is finite and the distances are finite
/// and above zero.
pub fn flamant_relative_settlement(
    soil: Soil,
    load: f64,
    near_distance: f64,
    far_distance: f64,
) -> Result<f64> {
    finite("line load", load)?;
    positive("near distance from the load", near_distance)?;
    positive("far distance from the load", far_distance)?;
    Ok((1.0 - soil.poisson()) * load / (PI * soil.shear_modulus())
        * (far_distance / near_distance).ln())
}

/// Horizontal displacement of the surface due to a vertical line load, m, to the right.
///
/// −(1−2ν)P/(4μ) sgn x at `x` (m) from the load P (N/m, downwards). The surface moves towards the load.
///
/// Flamant 1892; Johnson, *Contact Mechanics*, 1985, eq. 2.19a.
///
/// ```
/// use basemat::{Soil, reference::flamant_horizontal_displacement};
/// let soil = Soil::new(1.0, 0.25, 1.0)?;
/// assert_eq!(flamant_horizontal_displacement(soil, 8.0, 3.0)?, -1.0);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless load and position are finite.
pub fn flamant_horizontal_displacement(soil: Soil, load: f64, x: f64) -> Result<f64> {
    finite("line load", load)?;
    finite("position on the surface", x)?;
    let sign = if x == 0.0 { 0.0 } else { x.signum() };
    Ok(-(1.0 - 2.0 * soil.poisson()) * load / (4.0 * soil.shear_modulus()) * sign)
}

/// Radial stress under a vertical line load on the surface, Pa, tension positive.
///
/// −2P cos θ/(πr) at `distance` r (m) and `angle` θ (rad from the downward vertical), for the load P (N/m,
/// downwards). The circumferential stress and the shear stress are zero.
///
/// Flamant 1892; Johnson, *Contact Mechanics*, 1985, eq. 2.15.
///
/// ```
/// let stress = basemat::reference::flamant_radial_stress(3.0, 2.0, 0.0)?;
/// assert!((stress + 3.0 / std::f64::consts::PI).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless load and angle are finite and the distance is
/// finite and above zero.
pub fn flamant_radial_stress(load: f64, distance: f64, angle: f64) -> Result<f64> {
    finite("line load", load)?;
    positive("distance from the load", distance)?;
    finite("angle from the vertical", angle)?;
    Ok(-2.0 * load * angle.cos() / (PI * distance))
}

/// Displacement `[u_x, u_y]` in a full plane under a line force, m.
///
/// At `point` (m from the load) under the `force` `[F_x, F_y]` (N/m), relative to the isotropic part of the
/// displacement at distance `datum` (m).
///
/// Kelvin's solution in plane strain, `u_i` = ((3−4ν) ln(datum/r) `F_i` + `r_i` (r·F)/r²)/(8πμ(1−ν)):
/// Brebbia & Dominguez, *Boundary Elements: An Introductory Course*, 1992, ch. 3.
///
/// ```
/// use basemat::{Soil, reference::kelvin_relative_displacement};
/// let soil = Soil::new(1.0, 0.25, 1.0)?;
/// let u = kelvin_relative_displacement(soil, [6.0, 0.0], [1.0, 1.0], 2.0_f64.sqrt())?;
/// assert!((u[0] - 0.5 / std::f64::consts::PI).abs() < 1e-15 && u[0] == u[1]);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) unless all numbers are finite, and the distances of the point and of the
/// datum are above zero.
pub fn kelvin_relative_displacement(
    soil: Soil,
    force: [f64; 2],
    point: [f64; 2],
    datum: f64,
) -> Result<[f64; 2]> {
    for component in force {
        finite("line force", component)?;
    }
    let distance = positive("distance from the load", point[0].hypot(point[1]))?;
    positive("distance of the datum", datum)?;
    let direction = point.map(|component| component / distance);
    let radial_force = direction[0] * force[0] + direction[1] * force[1];
    let scale = 1.0 / (8.0 * PI * soil.shear_modulus() * (1.0 - soil.poisson()));
    let isotropic = (3.0 - 4.0 * soil.poisson()) * (datum / distance).ln();
    Ok([0, 1].map(|i| scale * (isotropic * force[i] + radial_force * direction[i])))
}
