//! Deviators of plane strain and their norm, and isotropic elasticity.

use crate::error::{Result, all_finite, finite};

/// Deviator of a symmetric tensor: `[xx, yy, xy]`; zz is −(xx + yy).
pub(super) type Deviator = [f64; 3];

/// Sum of the normal components of `[xx, yy, zz, xy]`.
pub(super) fn trace(tensor: [f64; 4]) -> f64 {
    tensor[0] + tensor[1] + tensor[2]
}

/// Deviator of a strain whose shear component is the engineering strain γ = 2 ε_xy.
pub(super) fn strain_deviator(strain: [f64; 4]) -> Deviator {
    let mean = trace(strain) / 3.0;
    [strain[0] - mean, strain[1] - mean, 0.5 * strain[3]]
}

/// Deviator of a stress.
pub(super) fn stress_deviator(stress: [f64; 4]) -> Deviator {
    let mean = trace(stress) / 3.0;
    [stress[0] - mean, stress[1] - mean, stress[3]]
}

/// The stress with this deviator and this mean.
pub(super) fn stress_of(deviator: Deviator, mean: f64) -> [f64; 4] {
    [deviator[0] + mean, deviator[1] + mean, mean - deviator[0] - deviator[1], deviator[2]]
}

/// Contraction a : b of two deviators.
pub(super) fn contraction(a: Deviator, b: Deviator) -> f64 {
    a[0] * b[0] + a[1] * b[1] + (a[0] + a[1]) * (b[0] + b[1]) + 2.0 * a[2] * b[2]
}

/// Difference a − b of two deviators.
pub(super) fn difference(a: Deviator, b: Deviator) -> Deviator {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A deviator times a factor.
pub(super) fn scaled(deviator: Deviator, factor: f64) -> Deviator {
    deviator.map(|component| factor * component)
}

/// All four components of a deviator: `[xx, yy, zz, xy]`.
pub(super) fn components(deviator: Deviator) -> [f64; 4] {
    stress_of(deviator, 0.0)
}

/// Plastic shear strain √(2 e^p : e^p) of a deviator e^p; in simple shear it is |γ^p|.
pub(super) fn shear_strain(deviator: Deviator) -> f64 {
    (2.0 * contraction(deviator, deviator)).sqrt()
}

/// Matrix `deviator_factor` · I_dev + `volume_factor` · 1⊗1, for a strain with engineering shear.
///
/// I_dev maps such a strain to its deviator. With the factors 2 G and K the matrix is that of elasticity.
pub(super) fn isotropic_matrix(deviator_factor: f64, volume_factor: f64) -> [[f64; 4]; 4] {
    let lateral = volume_factor - deviator_factor / 3.0;
    let diagonal_entry = lateral + deviator_factor;
    [
        [diagonal_entry, lateral, lateral, 0.0],
        [lateral, diagonal_entry, lateral, 0.0],
        [lateral, lateral, diagonal_entry, 0.0],
        [0.0, 0.0, 0.0, 0.5 * deviator_factor],
    ]
}

/// Returns an error for a strain that is not finite, or whose elastic stress has no finite square.
///
/// `modulus`: largest modulus of the material, Pa. Yield functions need the square of the elastic stress 2 G (ε − ε^p).
/// Strain and plastic strain of opposite signs make it up to four times as large, hence the second factor of 4.
pub(super) fn check_strain(strain: [f64; 4], modulus: f64) -> Result<()> {
    all_finite("strain of the solid", &strain)?;
    let squared_strain: f64 = strain.iter().map(|component| component * component).sum();
    let squared_stress = 4.0 * modulus * modulus * squared_strain;
    finite("square of the elastic stress of the solid (Pa²)", 4.0 * squared_stress)?;
    Ok(())
}
