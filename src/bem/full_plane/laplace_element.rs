//! Laplace-domain integrals over a straight element, seen from a collocation point.
//!
//! The element is x(ξ) = ξ t + d m from the point, a ≤ ξ ≤ b. The integrands are analytic except at ξ = ±i d,
//! and decay or oscillate like e^{−s r/c}. Pieces are halved until a Gauss rule has all digits. On the element around
//! the point only the logarithm remains, because tractions are odd and vanish on a straight line. The power series of
//! the logarithm is integrated exactly.

use super::bessel::{Complex64, MAX_SERIES_ARGUMENT, bessel_series};
use super::laplace::LaplacePlane;
use crate::linalg::gauss;

/// An element relative to a collocation point at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ElementView {
    /// First end of the element, (x, z), m.
    pub(super) start: [f64; 2],
    /// Second end of the element, (x, z), m.
    pub(super) end: [f64; 2],
    /// Whether the point is the midpoint of this element.
    pub(super) is_self: bool,
}

/// Coefficients of one view: `g` xx, xz, zx, zz, then `h` in the same order, without the free term.
pub(super) type ViewBlock = [Complex64; 8];

/// A straight element in coordinates along its tangent and normal.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoundaryLine {
    /// ξ of the first end.
    pub(super) low: f64,
    /// ξ of the second end.
    pub(super) high: f64,
    /// Unit vector along the line, (x, z).
    pub(super) tangent: [f64; 2],
    /// Outward normal, (x, z).
    pub(super) normal: [f64; 2],
    /// Offset of the line from the point along the normal.
    pub(super) height: f64,
}

impl ElementView {
    /// The element in coordinates along its tangent and normal.
    pub(super) fn line(&self) -> BoundaryLine {
        let start = self.start;
        let step = [self.end[0] - start[0], self.end[1] - start[1]];
        let length = step[0].hypot(step[1]);
        let tangent = [step[0] / length, step[1] / length];
        let normal = [tangent[1], -tangent[0]];
        if self.is_self {
            let high = 0.5 * length;
            return BoundaryLine { low: -0.5 * length, high, tangent, normal, height: 0.0 };
        }
        let low = start[0] * tangent[0] + start[1] * tangent[1];
        let height = start[0] * normal[0] + start[1] * normal[1];
        BoundaryLine { low, high: low + length, tangent, normal, height }
    }

    /// Largest distance between the point and the element, m.
    pub(super) fn max_distance(&self) -> f64 {
        self.start[0].hypot(self.start[1]).max(self.end[0].hypot(self.end[1]))
    }
}

impl BoundaryLine {
    /// Offset of the point ξ.
    pub(super) fn offset(&self, xi: f64) -> [f64; 2] {
        [0, 1].map(|i| xi * self.tangent[i] + self.height * self.normal[i])
    }
}

/// Integrals of displacements and tractions over the element of `view`, at one s.
pub(super) fn integrate(plane: &LaplacePlane, view: &ElementView) -> ViewBlock {
    let line = view.line();
    let mut block = ViewBlock::default();
    if view.is_self {
        add_self_integrals(plane, &line, &mut block);
    } else {
        add_pieces(line.low, line.high, line.height, plane, |xi, weight| {
            let kernels = plane.kernels(line.offset(xi), line.normal);
            // The load acts at the collocation point: the block of h is the transpose of the traction.
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                block[2 * i + j] += kernels.displacement[i][j] * weight;
                block[4 + 2 * i + j] += kernels.traction[j][i] * weight;
            }
        });
    }
    block
}

/// Adds the integrals over the element around the point: twice the integrals over one half.
///
/// The series of the logarithm is integrated exactly, the remaining interval by pieces.
fn add_self_integrals(plane: &LaplacePlane, line: &BoundaryLine, block: &mut ViewBlock) {
    let end = line.high;
    let series_end = end.min(MAX_SERIES_ARGUMENT / plane.shear.norm());
    let pressure_weight = plane.weights[0];
    let shear_weight = plane.weights[1];
    let shear = bessel_series(plane.shear * series_end, true);
    let pressure = bessel_series(plane.pressure * series_end, true);
    let mut psi =
        series_end * (shear_weight * (shear.k0 + shear.kappa) - pressure_weight * pressure.kappa);
    let mut chi = series_end
        * (shear_weight * (shear.k0 + 2.0 * shear.kappa)
            - pressure_weight * (pressure.k0 + 2.0 * pressure.kappa));
    add_pieces(series_end, end, 0.0, plane, |xi, weight| {
        let radial = plane.radial(xi);
        psi += radial.psi * weight;
        chi += radial.chi * weight;
    });
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let psi_delta = if i == j { psi } else { Complex64::default() };
        block[2 * i + j] += 2.0 * (psi_delta - chi * (line.tangent[i] * line.tangent[j]));
    }
}

/// Calls `add` with the points and weights of Gauss rules for the kernels on [`low`, `high`].
fn add_pieces(
    low: f64,
    high: f64,
    height: f64,
    plane: &LaplacePlane,
    mut add: impl FnMut(f64, f64),
) {
    let wave_number = plane.shear.norm();
    let mut pieces = vec![(low, high)];
    while let Some((low, high)) = pieces.pop() {
        let half_length = 0.5 * (high - low);
        let min_distance = if low <= 0.0 && high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
        let decay = plane.pressure.re * min_distance.hypot(height);
        if half_length <= 0.0 || decay > NEGLIGIBLE_EXPONENT {
            continue;
        }
        let ellipse_size = gauss::ellipse_size([0.0, height], low, high)
            .min(exponential_ellipse_size(wave_number * half_length));
        match gauss::rule_for(ellipse_size) {
            Some(rule) => {
                for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                    add(low + half_length * (1.0 + node), half_length * weight);
                }
            }
            None if half_length > MIN_PIECE_RATIO * min_distance.max(low.abs()) => {
                pieces.push((low, low + half_length));
                pieces.push((low + half_length, high));
            }
            // The point lies on the element but is not its midpoint: this integral does not exist.
            None => {}
        }
    }
}

/// Smallest decay exponent of negligible contributions: e^{−50} is far below rounding.
const NEGLIGIBLE_EXPONENT: f64 = 50.0;
/// Half length of a piece, relative to its distance, below which the piece is not halved.
const MIN_PIECE_RATIO: f64 = 1e-14;
/// Largest number of points of a rule for the exponential; if more points are needed, the piece is halved.
const MAX_EXPONENTIAL_POINTS: u32 = 16;
/// Error of a rule that counts as rounding.
const RULE_TOLERANCE: f64 = 1e-15;
/// [`gauss::rule_for`] selects at least n points for ellipse sizes up to the cosh of this number over n.
const RULE_EXPONENT: f64 = 16.118;

/// Ellipse size for which [`gauss::rule_for`] selects a rule that also integrates e^{qx} on [−1, 1].
///
/// The error of n points is about π q^{2n}/(4ⁿ (2n)!) [Davis & Rabinowitz 1984, § 2.7].
fn exponential_ellipse_size(q: f64) -> f64 {
    let mut error = std::f64::consts::PI;
    for n in 1..=MAX_EXPONENTIAL_POINTS {
        let even_number = f64::from(2 * n);
        error *= q * q / (4.0 * even_number * (even_number - 1.0));
        if error < RULE_TOLERANCE {
            return (RULE_EXPONENT / f64::from(n)).cosh();
        }
    }
    1.0
}
