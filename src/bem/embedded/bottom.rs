//! Stretched elements that stand for the half-plane below the near field.

use realfft::num_complex::Complex64;

/// Heights of stretched elements, for all Laplace variables near one of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bottom {
    pub(super) heights: Vec<Complex64>,
    pub(super) degree: usize,
}

/// Angle of the stretched elements relative to the argument of s.
const TURN: f64 = 0.6;
/// Longest stretched element, in c/|s|.
const LONGEST: f64 = 8.0;
/// Least degree of stretched elements: a higher one than of the near field, of longer elements, takes less time.
const LEAST: usize = 8;

impl Bottom {
    /// Elements for Laplace variables near `s`, below an interval of `last` metres.
    ///
    /// `speed`: of shear waves in the half-plane, m/s. `depth`: of all elements, in c/|s|.
    pub(super) fn new(s: Complex64, last: f64, speed: f64, depth: f64, degree: usize) -> Self {
        let wave = speed / s.norm();
        let turn = Complex64::from_polar(1.0, -TURN * s.arg());
        let mut heights = vec![];
        let mut sum = 0.0;
        let mut next = 2.0 * last;
        while sum < depth * wave {
            let height = next.min(LONGEST * wave);
            heights.push(turn * height);
            sum += height;
            next = 2.0 * height;
        }
        Self { heights, degree: degree.max(LEAST) }
    }

    /// No elements: the near field ends on rigid bedrock.
    pub(super) fn rigid(degree: usize) -> Self {
        Self { heights: vec![], degree }
    }
}
