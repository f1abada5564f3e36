//! Complex 2 × 2 matrices.

use crate::linalg::Complex;

/// Complex 2 × 2 matrix, row by row, for waves of a layer.
#[derive(Clone, Copy, Default)]
pub(super) struct Square(pub(super) [Complex; 4]);

impl Square {
    /// diag(1, 1).
    pub(super) const IDENTITY_MATRIX: Self = {
        let zero = Complex::new(0.0, 0.0);
        let one = Complex::new(1.0, 0.0);
        Self([one, zero, zero, one])
    };

    /// diag(1, −1) A, the displacements of waves in the opposite vertical direction.
    pub(super) fn mirrored(self) -> Self {
        let Self([a, b, c, d]) = self;
        Self([a, b, -c, -d])
    }

    /// −A.
    pub(super) fn negative(self) -> Self {
        Self(self.0.map(|x| -x))
    }

    /// `factor` A.
    pub(super) fn scaled(self, factor: Complex) -> Self {
        Self(self.0.map(|x| x * factor))
    }

    /// A + B.
    pub(super) fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    /// A − B.
    pub(super) fn minus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }

    /// A B.
    pub(super) fn times(self, other: Self) -> Self {
        let Self([a, b, c, d]) = self;
        let Self([e, f, g, h]) = other;
        Self([a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h])
    }

    /// A⁻¹ B, the solution of A X = B.
    pub(super) fn solve(self, other: Self) -> Self {
        let Self([a, b, c, d]) = self;
        let inverse_determinant = (a * d - b * c).inverse();
        let Self([e, f, g, h]) = other;
        Self(
            [d * e - b * g, d * f - b * h, a * g - c * e, a * h - c * f]
                .map(|x| x * inverse_determinant),
        )
    }

    /// A B⁻¹.
    pub(super) fn times_inverse(self, other: Self) -> Self {
        let Self([e, f, g, h]) = other;
        let inverse_determinant = (e * h - f * g).inverse();
        let Self([a, b, c, d]) = self;
        Self(
            [a * h - b * g, b * e - a * f, c * h - d * g, d * e - c * f]
                .map(|x| x * inverse_determinant),
        )
    }
}
