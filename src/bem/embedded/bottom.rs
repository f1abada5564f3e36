//! Stretched finite elements in place of the half-plane below the near field.

use basemat_fourier::num_complex::Complex64;

/// Heights of stretched elements, for all Laplace variables near one of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bottom {
    pub(super) heights: Vec<Complex64>,
    pub(super) degree: usize,
}

/// Angle of the stretched elements relative to the argument of s.
const STRETCH_ANGLE_RATIO: f64 = 0.6;
/// Longest stretched element, in c/|s|.
const MAX_STRETCHED_LENGTH: f64 = 8.0;
/// Smallest degree of stretched elements; few elements of a high degree take less time than many of a low one.
const MIN_STRETCHED_DEGREE: usize = 8;

impl Bottom {
    /// Elements for Laplace variables near `s`, below an interval of `last` metres.
    ///
    /// `speed`: of shear waves in the half-plane, m/s. `depth`: of all elements, in c/|s|.
    pub(super) fn new(s: Complex64, last: f64, speed: f64, depth: f64, degree: usize) -> Self {
        let wave_length = speed / s.norm();
        let rotation = Complex64::from_polar(1.0, -STRETCH_ANGLE_RATIO * s.arg());
        let mut heights = vec![];
        let mut total_height = 0.0;
        let mut next = 2.0 * last;
        while total_height < depth * wave_length {
            let height = next.min(MAX_STRETCHED_LENGTH * wave_length);
            heights.push(rotation * height);
            total_height += height;
            next = 2.0 * height;
        }
        Self { heights, degree: degree.max(MIN_STRETCHED_DEGREE) }
    }

    /// No elements: the near field ends on rigid bedrock.
    pub(super) fn rigid(degree: usize) -> Self {
        Self { heights: vec![], degree }
    }
}
