//! The mobility of a layered ground along its contours.
//!
//! (1−z) Ĝ(z) is smooth in the angle θ of z, except where waves return late. Panels in θ have 24 Chebyshev
//! points each. They are halved until the last two coefficients are small, which gives a binary tree for
//! every eigenvalue of Δ(z). The tree of the first eigenvalue, whose waves travel and return, has narrower
//! panels towards θ = 0, where long waves have a branch point. The waves of the other eigenvalues decay
//! within a step or two, except for high frequencies with three stages. After a division by (1−z)², a few
//! panels represent them.
//!
//! All singularities lie on |z| ≥ 1, and the singularities of undamped layers on the unit circle itself.
//! Panels lie inside it, at ln |z| = −w/20 for a width w, so that no singularity is missed between two
//! points. As polynomials of the complex variable ln z they are accurate on every circle from there to the unit
//! circle. One panel thus serves all blocks of lags. Where panels would need more points than the circle has
//! there, the circle's own points are evaluated. This always occurs at cut-off frequencies of undamped
//! layers.
//!
//! A response up to m lags late is a polynomial in z of degree m, with a phase change up to mw over a panel.
//! After division by the power of z in the middle, the phase change is half of this. A panel that is not
//! resolved may then be resolved.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::runge_kutta::on_circle;
use crate::error::Result;
use crate::history::PairClasses;
use crate::linalg::Complex;

/// Number of Chebyshev points of a panel.
pub(crate) const POINTS: usize = 24;
/// Number of halvings of θ = 0 … π for the first panels.
const COARSEST: u32 = 2;
/// −ln |z| of a panel, divided by its width.
const ASIDE: f64 = 1.0 / 20.0;
/// Limit of the last Chebyshev coefficients, relative to the tolerance. Their errors grow with the lag, errors of F do
/// not.
const LAST: f64 = 0.3;
/// Phase change over half a panel of the powers of z by which functions are divided, in the order of trial.
///
/// Responses come late and never early, so the powers are not negative.
const TURNS: [f64; 2] = [0.0, 4.0];
/// Number of points of a circle evaluated together.
const LANES: usize = 32;

/// Circle |z| = r for the transform of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Circle {
    /// Number of points of the whole circle.
    pub(crate) length: usize,
    /// ln r.
    pub(crate) logarithm: f64,
}

impl Circle {
    /// Circle of `length` points for a relative accuracy of F.
    pub(crate) fn new(length: usize, tolerance: f64) -> Self {
        // Aliases ε and noise tol·ε^(−1/2) at the last lag are then about equal.
        Self { length, logarithm: 2.0 / 3.0 * tolerance.ln() / length as f64 }
    }

    /// Number of points of the upper half, both ends included.
    pub(crate) fn points(self) -> usize {
        self.length / 2 + 1
    }

    /// Angle of a point, rad.
    pub(crate) fn angle(self, point: usize) -> f64 {
        std::f64::consts::TAU / self.length as f64 * point as f64
    }
}

/// Ratio of an eigenvalue's contribution to the mobility and the function that panels represent.
pub(crate) fn factor(node: usize, [logarithm, angle]: [f64; 2]) -> Complex {
    let [_, rest] = on_circle(logarithm, angle);
    if node == 0 { Complex::real(1.0) } else { rest * rest }
}

/// Panels tested so far, with polynomials on the resolved ones.
#[derive(Debug)]
pub(crate) struct Panels {
    stored: Mutex<HashMap<CirclePanel, Option<Arc<Polynomials>>>>,
    /// For each class: the classes of the pairs of its two elements with themselves.
    pub(super) own: Arc<[[usize; 2]]>,
}

/// Functions on a panel, divided by a power of z, by Chebyshev coefficients.
#[derive(Debug)]
pub(crate) struct Polynomials {
    /// Coefficients degree by degree, one column for each function.
    coefficients: Vec<Complex>,
    /// Phase change of the power over half the panel.
    turn: f64,
}

impl Polynomials {
    /// Polynomials through `values` at the points of a panel, one column for each function.
    ///
    /// `None` if no power resolves them. `own` and `tolerance` as in [`is_resolved`].
    pub(crate) fn through<const KINDS: usize>(
        values: &[Complex],
        own: &[[usize; 2]],
        tolerance: f64,
    ) -> Option<Self> {
        TURNS.into_iter().find_map(|turn| {
            let mut values = values.to_vec();
            let count = values.len() / POINTS;
            for (x, row) in nodes().zip(values.chunks_exact_mut(count)) {
                let back = Complex::polar(1.0, -turn * x);
                for value in row {
                    *value = *value * back;
                }
            }
            let coefficients = transformed(&values);
            let resolved = is_resolved::<KINDS>(&coefficients, own, tolerance, turn);
            resolved.then_some(Self { coefficients, turn })
        })
    }
}

/// A panel of the half circle: the `index`-th of 2^`depth` equal panels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct CirclePanel {
    depth: u32,
    index: usize,
}

impl CirclePanel {
    fn halves(self) -> [Self; 2] {
        [0, 1].map(|half| Self { depth: self.depth + 1, index: 2 * self.index + half })
    }

    fn width(self) -> f64 {
        PI / (1_usize << self.depth) as f64
    }

    /// Points of a circle on this panel.
    pub(super) fn points_of(self, circle: Circle) -> Range<usize> {
        let points = (circle.points() - 1) >> self.depth;
        self.index * points..(self.index + 1) * points
    }

    /// ln |z| and angle of the Chebyshev points of this panel.
    pub(crate) fn places(self) -> impl Iterator<Item = [f64; 2]> {
        let width = self.width();
        nodes().map(move |x| [-ASIDE * width, width * (self.index as f64 + 0.5 * (1.0 + x))])
    }
}

/// Chebyshev points.
fn nodes() -> impl Iterator<Item = f64> {
    (0..POINTS).map(|i| (PI * (i as f64 + 0.5) / POINTS as f64).cos())
}

/// Chebyshev coefficients of values at the points, one column for each function.
fn transformed(values: &[Complex]) -> Vec<Complex> {
    let count = values.len() / POINTS;
    let mut coefficients = vec![Complex::default(); values.len()];
    for (degree, row) in coefficients.chunks_exact_mut(count).enumerate() {
        for (i, values) in values.chunks_exact(count).enumerate() {
            let angle = PI * (degree as f64 * (i as f64 + 0.5)) / POINTS as f64;
            let unit = if degree == 0 { 1.0 } else { 2.0 } / POINTS as f64;
            let factor = unit * angle.cos();
            for (sum, value) in row.iter_mut().zip(values) {
                *sum += value.scale(factor);
            }
        }
    }
    coefficients
}

impl Panels {
    pub(crate) fn new(own: &Arc<[[usize; 2]]>) -> Self {
        Self { stored: Mutex::default(), own: Arc::clone(own) }
    }

    pub(super) fn stored(&self) -> MutexGuard<'_, HashMap<CirclePanel, Option<Arc<Polynomials>>>> {
        self.stored.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the panel at `place` is resolved; `None` if it has not been tested.
    pub(crate) fn known(&self, place: CirclePanel) -> Option<bool> {
        self.stored().get(&place).map(Option::is_some)
    }
}

/// For each class: the classes of the pairs of its two elements with themselves.
pub(in crate::bem) fn own_classes(classes: &PairClasses) -> Vec<[usize; 2]> {
    let mut own = vec![[0; 2]; classes.count()];
    let pairs = classes.pairs();
    let elements = classes.elements().len();
    for (place, pair) in pairs.iter().enumerate() {
        let ends = [place / elements, place % elements];
        own[pair.class] = ends.map(|element| pairs[element * (elements + 1)].class);
    }
    own
}

/// Whether the last two `coefficients` are small, up to the unit circle.
///
/// They are compared with the coefficients of the pairs of the elements with themselves; `own` has, for each
/// class, the classes of these pairs. `turn` belongs to the coefficients.
fn is_resolved<const KINDS: usize>(
    coefficients: &[Complex],
    own: &[[usize; 2]],
    tolerance: f64,
    turn: f64,
) -> bool {
    let shift = 2.0 * ASIDE;
    let growth = shift + (1.0 + shift * shift).sqrt();
    let most = LAST * tolerance / growth.powf((POINTS - 1) as f64) / (turn * shift).exp();
    let degrees: Vec<_> = coefficients
        .chunks_exact(own.len() * KINDS)
        .map(|row| row.as_chunks::<KINDS>().0)
        .collect();
    let largest = |class: usize, kind: usize| {
        degrees.iter().map(|row| row[class][kind].abs()).fold(0.0, f64::max)
    };
    // The diagonal of a symmetric matrix comes first.
    let least = |class: usize| {
        (0..KINDS.div_ceil(2)).map(|kind| largest(class, kind)).fold(f64::INFINITY, f64::min)
    };
    let sizes: Vec<_> = (0..own.len()).map(least).collect();
    let [.., one, two] = &degrees[..] else { return false };
    one.iter().zip(*two).zip(own).all(|((one, two), own)| {
        let allowed = most * own.map(|class| sizes[class]).iter().product::<f64>().sqrt();
        one.iter().zip(two).all(|(one, two)| one.abs() + two.abs() <= allowed)
    })
}

impl Circle {
    /// Panels that cover the upper half of a circle, and the points not covered, in ascending order.
    ///
    /// `resolved` returns for panels of one width which of them are resolved.
    pub(crate) fn covered(
        self,
        node: usize,
        mut resolved: impl FnMut(&[CirclePanel]) -> Result<Vec<bool>>,
    ) -> Result<(Vec<CirclePanel>, Vec<usize>)> {
        let mut covering = vec![];
        let mut panels: Vec<_> =
            (0..1 << COARSEST).map(|index| CirclePanel { depth: COARSEST, index }).collect();
        let serves = |panel: &CirclePanel| {
            let beside = -self.logarithm <= 2.0 * ASIDE * panel.width();
            beside && panel.points_of(self).len() > POINTS
        };
        while panels.first().is_some_and(serves) {
            // The panel at the branch point of long waves is never resolved.
            let never = node == 0 && panels[0].index == 0;
            let (first, rest) = panels.split_at(usize::from(never));
            let mut halves = first.to_vec();
            for (panel, resolved) in rest.iter().zip(resolved(rest)?) {
                if resolved { &mut covering } else { &mut halves }.push(*panel);
            }
            panels = halves.into_iter().flat_map(CirclePanel::halves).collect();
        }
        let mut alone: Vec<_> =
            panels.into_iter().flat_map(|panel| panel.points_of(self)).collect();
        alone.push(self.points() - 1);
        Ok((covering, alone))
    }
}

/// Approximate number of values between two calls of `heard`: a hundredth of a second.
const HEARD: usize = 1 << 18;

/// Chebyshev polynomials of all degrees at several places.
#[inline]
fn chebyshev(x: [f64; LANES]) -> [[f64; LANES]; POINTS] {
    let mut polynomials = [[1.0; LANES]; POINTS];
    polynomials[1] = x;
    for degree in 2..POINTS {
        let before = polynomials[degree - 2];
        let last = polynomials[degree - 1];
        polynomials[degree] = std::array::from_fn(|lane| 2.0 * x[lane] * last[lane] - before[lane]);
    }
    polynomials
}

/// Adds the contribution of an eigenvalue on a panel to the values at the points of a circle.
///
/// `spectra` has one row for each function. An error of `heard` ends the evaluation.
pub(super) fn evaluate(
    node: usize,
    panel: &Polynomials,
    place: CirclePanel,
    circle: Circle,
    spectra: &mut [Complex],
    mut heard: impl FnMut() -> Result<()>,
) -> Result<()> {
    let Polynomials { coefficients: panel, turn } = panel;
    let count = panel.len() / POINTS;
    let points = place.points_of(circle);
    // Converts the polynomials from the panel's line to the circle's, x − iy.
    let shift = -(circle.logarithm + ASIDE * place.width()) / (0.5 * place.width());
    let mut moved = vec![Complex::default(); panel.len()];
    for (x, values) in nodes().zip(moved.chunks_exact_mut(count)) {
        let x = Complex::new(x, shift);
        let mut last = x;
        let mut value = Complex::real(1.0);
        for row in panel.chunks_exact(count) {
            for (sum, coefficient) in values.iter_mut().zip(row) {
                *sum += value * *coefficient;
            }
            (last, value) = (value, x.scale(2.0) * value - last);
        }
    }
    let panel = transformed(&moved);
    let between = (HEARD / (LANES * count)).max(1);
    for first in points.clone().step_by(LANES) {
        if ((first - points.start) / LANES).is_multiple_of(between) {
            heard()?;
        }
        let x: [f64; LANES] = std::array::from_fn(|lane| {
            2.0 * (first + lane - points.start) as f64 / points.len() as f64 - 1.0
        });
        let polynomials = chebyshev(x);
        let factors: [Complex; LANES] = std::array::from_fn(|lane| {
            let turned = Complex::polar((-turn * shift).exp(), turn * x[lane]);
            turned * factor(node, [circle.logarithm, circle.angle(first + lane)])
        });
        let end = points.end.min(first + LANES);
        for (function, row) in spectra.chunks_exact_mut(circle.points()).enumerate() {
            let [mut re, mut im] = [[0.0; LANES]; 2];
            for (polynomial, row) in polynomials.iter().zip(panel.chunks_exact(count)) {
                let coefficient = row[function];
                for lane in 0..LANES {
                    re[lane] += coefficient.re * polynomial[lane];
                    im[lane] += coefficient.im * polynomial[lane];
                }
            }
            for (lane, value) in row[first..end].iter_mut().enumerate() {
                *value += factors[lane] * Complex::new(re[lane], im[lane]);
            }
        }
    }
    Ok(())
}
