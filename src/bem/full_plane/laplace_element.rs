//! Laplace-domain integrals over a straight element, seen from a collocation point.
//!
//! The element is x(ξ) = ξ t + d m from the point, a ≤ ξ ≤ b. The integrands are analytic except at ξ = ±i d,
//! and decay or oscillate like e^{−s r/c}. Pieces are halved until a Gauss rule has all digits. Over the
//! point's own element only the logarithm remains, because tractions are odd and vanish on a straight line.
//! The power series of the logarithm is integrated exactly.

use super::bessel::{Complex64, SERIES_REACH, series};
use super::laplace::LaplacePlane;
use crate::linalg::gauss;

/// An element relative to a collocation point at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    /// Ends of the element, (x, z), m.
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
    /// Whether the point is the midpoint of this element.
    pub(super) own: bool,
}

/// Coefficients of one view: `g` xx, xz, zx, zz, then `h` in the same order, without the free term.
pub(super) type Block = [Complex64; 8];

/// A straight element in its own coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// ξ of both ends.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Unit vector along the line, and outward normal, (x, z).
    pub(super) along: [f64; 2],
    pub(super) normal: [f64; 2],
    /// Offset of the line from the point along the normal.
    pub(super) aside: f64,
}

impl View {
    pub(super) fn line(&self) -> Line {
        let ([x, z], [to_x, to_z]) = (self.from, self.to);
        let length = (to_x - x).hypot(to_z - z);
        let along = [(to_x - x) / length, (to_z - z) / length];
        let normal = [along[1], -along[0]];
        if self.own {
            return Line { low: -0.5 * length, high: 0.5 * length, along, normal, aside: 0.0 };
        }
        let low = x * along[0] + z * along[1];
        Line { low, high: low + length, along, normal, aside: x * normal[0] + z * normal[1] }
    }

    /// Largest distance between the point and the element.
    pub(super) fn reach(&self) -> f64 {
        self.from[0].hypot(self.from[1]).max(self.to[0].hypot(self.to[1]))
    }
}

impl Line {
    /// Offset of the point ξ.
    pub(super) fn offset(&self, xi: f64) -> [f64; 2] {
        [0, 1].map(|i| xi * self.along[i] + self.aside * self.normal[i])
    }
}

/// Integrals over the element of `view` of displacements and tractions at one s.
pub(super) fn integrate(plane: &LaplacePlane, view: &View) -> Block {
    let line = view.line();
    let mut block = Block::default();
    if view.own {
        add_own(plane, &line, &mut block);
    } else {
        add_pieces(line.low, line.high, line.aside, plane, |xi, weight| {
            let (u, t) = plane.kernels(line.offset(xi), line.normal);
            // The load acts at the collocation point: the block of h is the transpose of the traction.
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                block[2 * i + j] += u[i][j] * weight;
                block[4 + 2 * i + j] += t[j][i] * weight;
            }
        });
    }
    block
}

/// Integrates over both halves of the point's own element: the logarithm by its series, the rest by pieces.
fn add_own(plane: &LaplacePlane, line: &Line, block: &mut Block) {
    let end = line.high;
    let near = end.min(SERIES_REACH / plane.shear.norm());
    let [fast, slow] = plane.weights;
    let [shear, shear_rest] = series(plane.shear * near, true);
    let [pressure, pressure_rest] = series(plane.pressure * near, true);
    let mut psi = near * (slow * (shear + shear_rest) - fast * pressure_rest);
    let mut chi =
        near * (slow * (shear + 2.0 * shear_rest) - fast * (pressure + 2.0 * pressure_rest));
    add_pieces(near, end, 0.0, plane, |xi, weight| {
        let radial = plane.radial(xi);
        psi += radial.psi * weight;
        chi += radial.chi * weight;
    });
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let same = if i == j { psi } else { Complex64::default() };
        block[2 * i + j] += 2.0 * (same - chi * (line.along[i] * line.along[j]));
    }
}

/// Calls `add` with the points and weights of a rule for the kernels on [`low`, `high`].
fn add_pieces(
    low: f64,
    high: f64,
    aside: f64,
    plane: &LaplacePlane,
    mut add: impl FnMut(f64, f64),
) {
    let wave_number = plane.shear.norm();
    let mut waiting = vec![(low, high)];
    while let Some((low, high)) = waiting.pop() {
        let half = 0.5 * (high - low);
        let nearest = if low <= 0.0 && high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
        if half <= 0.0 || plane.pressure.re * nearest.hypot(aside) > NOTHING {
            continue;
        }
        let reach =
            gauss::reach([0.0, aside], low, high).min(exponential_reach(wave_number * half));
        match gauss::rule_for(reach) {
            Some(rule) => {
                for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                    add(low + half * (1.0 + node), half * weight);
                }
            }
            None if half > 1e-14 * nearest.max(low.abs()) => {
                waiting.push((low, low + half));
                waiting.push((low + half, high));
            }
            // The point lies on the element but is not its midpoint: this integral does not exist.
            None => {}
        }
    }
}

/// Exponents above which contributions are negligible.
const NOTHING: f64 = 50.0;

/// The reach for which [`gauss::rule_for`] selects a rule that also integrates e^{qx} on [−1, 1].
///
/// The error of n points is about π q^{2n}/(4ⁿ (2n)!) [Davis & Rabinowitz 1984, § 2.7].
fn exponential_reach(q: f64) -> f64 {
    let mut error = std::f64::consts::PI;
    for n in 1..=16_u32 {
        let even = f64::from(2 * n);
        error *= q * q / (4.0 * even * (even - 1.0));
        if error < 1e-15 {
            // Largest reach for which the selected rule has at least n points.
            return (16.118 / f64::from(n)).cosh();
        }
    }
    1.0
}
