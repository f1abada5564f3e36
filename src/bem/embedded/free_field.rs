//! Vertical waves in the soil beside a trench.
//!
//! Their displacements and stresses at the depths of the faces are the free field of the trench.

use basemat_fourier::num_complex::Complex64;

/// Piece of the profile.
#[derive(Debug, Clone, Copy)]
pub(super) struct ProfilePiece {
    /// Height, m.
    pub(super) height: f64,
    /// Modulus M of the wave, Pa.
    pub(super) modulus: Complex64,
    /// ρ s², kg/(m³ s²).
    pub(super) inertia: Complex64,
}

/// Displacement and stress of a vertical wave that displaces the surface by one.
#[derive(Debug, Clone, Copy)]
pub(super) struct VerticalField {
    /// u.
    pub(super) displacement: Complex64,
    /// M ∂u/∂z, with z down.
    pub(super) stress: Complex64,
}

/// Field of a vertical wave over a piece of the profile.
pub(super) struct FieldOverPiece {
    /// Field at the lower end.
    pub(super) bottom: VerticalField,
    /// Integrals over the height.
    pub(super) integrals: VerticalField,
}

/// Largest |x| for which two terms of the series of sinh(x)/x suffice.
///
/// Their error is below 1e-14.
const MAX_SERIES_ARGUMENT: f64 = 1e-3;

impl VerticalField {
    /// Field at the free surface.
    pub(super) const AT_SURFACE: Self =
        Self { displacement: Complex64::ONE, stress: Complex64::ZERO };

    /// Field over a piece that has this field at its top.
    pub(super) fn over_piece(self, piece: ProfilePiece) -> FieldOverPiece {
        let Self { displacement, stress } = self;
        let ProfilePiece { height, modulus, inertia } = piece;
        let phase = (inertia / modulus).sqrt() * height;
        // sinh(κh)/κ, cosh(κh) and (cosh(κh) − 1)/κ².
        let sinh_term = sinh_ratio(phase) * height;
        let half_sinh_term = sinh_ratio(phase * 0.5) * height;
        let cosh = phase.cosh();
        let bottom = Self {
            displacement: displacement * cosh + stress / modulus * sinh_term,
            stress: stress * cosh + displacement * inertia * sinh_term,
        };
        let integrals = Self {
            displacement: displacement * sinh_term
                + stress / modulus * half_sinh_term * half_sinh_term * 0.5,
            stress: stress * sinh_term
                + displacement * inertia * half_sinh_term * half_sinh_term * 0.5,
        };
        FieldOverPiece { bottom, integrals }
    }
}

/// sinh(x)/x.
fn sinh_ratio(x: Complex64) -> Complex64 {
    if x.norm() < MAX_SERIES_ARGUMENT {
        Complex64::ONE + x * x / 6.0
    } else {
        x.sinh() / x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pieces of homogeneous soil: u = cos(ωz/c), stress −μ (ω/c) sin(ωz/c).
    #[test]
    fn vertical_waves_of_homogeneous_soil_are_standing() {
        for omega in [1e-5_f64, 1e-3, 0.7, 3.0] {
            let inertia = Complex64::from(-1.5 * omega * omega);
            let modulus = Complex64::from(2.5);
            let k = omega * (1.5_f64 / 2.5).sqrt();
            let upper_piece = ProfilePiece { height: 0.4, modulus, inertia };
            let upper = VerticalField::AT_SURFACE.over_piece(upper_piece);
            let lower_piece = ProfilePiece { height: 0.9, modulus, inertia };
            let lower = upper.bottom.over_piece(lower_piece);
            let displacement_integral = upper.integrals.displacement + lower.integrals.displacement;
            let stress_integral = upper.integrals.stress + lower.integrals.stress;
            let sine = (k * 1.3).sin();
            for (computed, expected) in [
                (lower.bottom.displacement, (k * 1.3).cos()),
                (lower.bottom.stress / (k * k), -2.5 * sine / k),
                (displacement_integral, sine / k),
                (stress_integral / (k * k), -5.0 * ((k * 0.65).sin() / k).powi(2)),
            ] {
                let tolerance = 1e-12 * (1.0 + expected.abs());
                assert!((computed - expected).norm() < tolerance, "{computed} {expected}");
            }
        }
    }
}
