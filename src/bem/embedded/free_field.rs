//! Vertical waves in the soil beside a trench: displacement and stress at the depths of its faces.

use basemat_fourier::num_complex::Complex64;

/// Piece of the profile: its height (m), modulus M of the wave (Pa) and ρ s².
#[derive(Debug, Clone, Copy)]
pub(super) struct ProfilePiece {
    pub(super) height: f64,
    pub(super) modulus: Complex64,
    pub(super) inertia: Complex64,
}

/// Displacement u and stress M ∂u/∂z, z down, of a vertical wave that moves the surface by one.
#[derive(Debug, Clone, Copy)]
pub(super) struct VerticalField {
    pub(super) displacement: Complex64,
    pub(super) stress: Complex64,
}

impl VerticalField {
    /// At the free surface.
    pub(super) const AT_SURFACE: Self =
        Self { displacement: Complex64::ONE, stress: Complex64::ZERO };

    /// The field at the bottom of a piece that has this field at its top, and its integrals over the piece.
    pub(super) fn below(self, piece: ProfilePiece) -> (Self, Self) {
        let Self { displacement, stress } = self;
        let ProfilePiece { height, modulus, inertia } = piece;
        let travel = (inertia / modulus).sqrt() * height;
        // sinh(κh)/κ, cosh(κh) and (cosh(κh) − 1)/κ².
        let ratio = sinh_ratio(travel) * height;
        let half = sinh_ratio(travel * 0.5) * height;
        let cosh = travel.cosh();
        let below = Self {
            displacement: displacement * cosh + stress / modulus * ratio,
            stress: stress * cosh + displacement * inertia * ratio,
        };
        let integrals = Self {
            displacement: displacement * ratio + stress / modulus * half * half * 0.5,
            stress: stress * ratio + displacement * inertia * half * half * 0.5,
        };
        (below, integrals)
    }
}

/// sinh(x)/x.
fn sinh_ratio(x: Complex64) -> Complex64 {
    if x.norm() < 1e-3 { Complex64::ONE + x * x / 6.0 } else { x.sinh() / x }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Homogeneous soil: u = cos(ωz/c), stress −μ (ω/c) sin(ωz/c), in pieces as at once.
    #[test]
    fn vertical_waves_of_homogeneous_soil_are_standing() {
        for omega in [1e-5_f64, 1e-3, 0.7, 3.0] {
            let inertia = Complex64::from(-1.5 * omega * omega);
            let modulus = Complex64::from(2.5);
            let k = omega * (1.5_f64 / 2.5).sqrt();
            let upper_piece = ProfilePiece { height: 0.4, modulus, inertia };
            let (middle, upper) = VerticalField::AT_SURFACE.below(upper_piece);
            let (bottom, lower) = middle.below(ProfilePiece { height: 0.9, modulus, inertia });
            let sine = (k * 1.3).sin();
            for (found, wanted) in [
                (bottom.displacement, (k * 1.3).cos()),
                (bottom.stress / (k * k), -2.5 * sine / k),
                (upper.displacement + lower.displacement, sine / k),
                ((upper.stress + lower.stress) / (k * k), -5.0 * ((k * 0.65).sin() / k).powi(2)),
            ] {
                assert!((found - wanted).norm() < 1e-12 * (1.0 + wanted.abs()), "{found} {wanted}");
            }
        }
    }
}
