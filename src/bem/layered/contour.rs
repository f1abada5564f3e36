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
pub(crate) const CHEBYSHEV_POINTS: usize = 24;
/// Number of halvings of θ = 0 … π that give the first panels.
const COARSEST_DEPTH: u32 = 2;
/// −ln |z| of a panel, divided by its width.
pub(super) const PANEL_OFFSET_RATIO: f64 = 1.0 / 20.0;
/// Limit of the last Chebyshev coefficients, relative to the tolerance.
///
/// It is below one because their errors grow with the lag, and errors of F do not.
const COEFFICIENT_LIMIT_FACTOR: f64 = 0.3;
/// Phase change over half a panel of the powers of z by which functions are divided, in the order of trial.
///
/// Responses come late and never early, so the powers are not negative.
const TRIAL_PHASES: [f64; 2] = [0.0, 4.0];

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
pub(crate) fn panel_factor(node: usize, [logarithm, angle]: [f64; 2]) -> Complex {
    let rest = on_circle(logarithm, angle).one_less_z;
    if node == 0 { Complex::real(1.0) } else { rest * rest }
}

/// Panels tested so far, with polynomials on the resolved ones.
#[derive(Debug)]
pub(crate) struct Panels {
    stored: Mutex<HashMap<CirclePanel, Option<Arc<PanelPolynomials>>>>,
    /// For each class: the classes of the pairs of its two elements with themselves.
    pub(super) self_pairs: Arc<[[usize; 2]]>,
}

/// Functions on a panel, divided by a power of z, by Chebyshev coefficients.
#[derive(Debug)]
pub(crate) struct PanelPolynomials {
    /// Coefficients degree by degree, one column for each function.
    pub(super) coefficients: Vec<Complex>,
    /// Phase change of the power over half the panel.
    pub(super) phase: f64,
}

impl PanelPolynomials {
    /// Polynomials through `values` at the points of a panel, one column for each function.
    ///
    /// `None` if no power resolves them. `self_pairs` and `tolerance` as in [`is_resolved`].
    pub(crate) fn through<const KINDS: usize>(
        values: &[Complex],
        self_pairs: &[[usize; 2]],
        tolerance: f64,
    ) -> Option<Self> {
        let count = values.len() / CHEBYSHEV_POINTS;
        for phase in TRIAL_PHASES {
            let mut divided = values.to_vec();
            for (x, row) in nodes().zip(divided.chunks_exact_mut(count)) {
                let inverse_power = Complex::polar(1.0, -phase * x);
                for value in row {
                    *value = *value * inverse_power;
                }
            }
            let coefficients = chebyshev_coefficients(&divided);
            if is_resolved::<KINDS>(&coefficients, self_pairs, tolerance, phase) {
                return Some(Self { coefficients, phase });
            }
        }
        None
    }
}

/// A panel of the half circle: the `index`-th of 2^`depth` equal panels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct CirclePanel {
    depth: u32,
    index: usize,
}

impl CirclePanel {
    /// Panels of half the width.
    fn halves(self) -> [Self; 2] {
        [0, 1].map(|half| Self { depth: self.depth + 1, index: 2 * self.index + half })
    }

    /// Angle, rad.
    pub(super) fn width(self) -> f64 {
        PI / (1_usize << self.depth) as f64
    }

    /// Points of a circle on this panel.
    pub(super) fn points_of(self, circle: Circle) -> Range<usize> {
        let points = (circle.points() - 1) >> self.depth;
        self.index * points..(self.index + 1) * points
    }

    /// ln |z| and angle of the Chebyshev points of this panel.
    pub(crate) fn chebyshev_points(self) -> impl Iterator<Item = [f64; 2]> {
        let width = self.width();
        nodes().map(move |x| {
            [-PANEL_OFFSET_RATIO * width, width * (self.index as f64 + 0.5 * (1.0 + x))]
        })
    }
}

/// Chebyshev points.
pub(super) fn nodes() -> impl Iterator<Item = f64> {
    (0..CHEBYSHEV_POINTS).map(|i| (PI * (i as f64 + 0.5) / CHEBYSHEV_POINTS as f64).cos())
}

/// Chebyshev coefficients of values at the points, one column for each function.
pub(super) fn chebyshev_coefficients(values: &[Complex]) -> Vec<Complex> {
    let count = values.len() / CHEBYSHEV_POINTS;
    let mut coefficients = vec![Complex::default(); values.len()];
    for (degree, row) in coefficients.chunks_exact_mut(count).enumerate() {
        for (i, values) in values.chunks_exact(count).enumerate() {
            let angle = PI * (degree as f64 * (i as f64 + 0.5)) / CHEBYSHEV_POINTS as f64;
            let unit = if degree == 0 { 1.0 } else { 2.0 } / CHEBYSHEV_POINTS as f64;
            let factor = unit * angle.cos();
            for (sum, value) in row.iter_mut().zip(values) {
                *sum += value.scale(factor);
            }
        }
    }
    coefficients
}

impl Panels {
    /// No panels yet; `self_pairs`: as the field.
    pub(crate) fn new(self_pairs: &Arc<[[usize; 2]]>) -> Self {
        Self { stored: Mutex::default(), self_pairs: Arc::clone(self_pairs) }
    }

    pub(super) fn stored(
        &self,
    ) -> MutexGuard<'_, HashMap<CirclePanel, Option<Arc<PanelPolynomials>>>> {
        self.stored.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether `panel` is resolved; `None` if it has not been tested.
    pub(crate) fn is_resolved(&self, panel: CirclePanel) -> Option<bool> {
        self.stored().get(&panel).map(Option::is_some)
    }
}

/// For each class: the classes of the pairs of its two elements with themselves.
pub(in crate::bem) fn self_pair_classes(classes: &PairClasses) -> Vec<[usize; 2]> {
    let mut self_pairs = vec![[0; 2]; classes.count()];
    let pairs = classes.pairs();
    let elements = classes.elements().len();
    for (number, pair) in pairs.iter().enumerate() {
        let members = [number / elements, number % elements];
        self_pairs[pair.class] = members.map(|element| pairs[element * (elements + 1)].class);
    }
    self_pairs
}

/// Whether the last two `coefficients` are small, up to the unit circle.
///
/// They are compared with the coefficients of the pairs of the elements with themselves; `self_pairs` has, for each
/// class, the classes of these pairs. `phase` belongs to the coefficients.
fn is_resolved<const KINDS: usize>(
    coefficients: &[Complex],
    self_pairs: &[[usize; 2]],
    tolerance: f64,
    phase: f64,
) -> bool {
    let shift = 2.0 * PANEL_OFFSET_RATIO;
    let growth = shift + (1.0 + shift * shift).sqrt();
    let limit = COEFFICIENT_LIMIT_FACTOR * tolerance
        / growth.powf((CHEBYSHEV_POINTS - 1) as f64)
        / (phase * shift).exp();
    let degrees: Vec<_> = coefficients
        .chunks_exact(self_pairs.len() * KINDS)
        .map(|row| row.as_chunks::<KINDS>().0)
        .collect();
    let mut sizes = Vec::with_capacity(self_pairs.len());
    for class in 0..self_pairs.len() {
        // The diagonal of a symmetric matrix comes first.
        let mut size = f64::INFINITY;
        for kind in 0..KINDS.div_ceil(2) {
            size = size.min(degrees.iter().map(|row| row[class][kind].abs()).fold(0.0, f64::max));
        }
        sizes.push(size);
    }
    let [.., next_to_last, last] = &degrees[..] else { return false };
    next_to_last.iter().zip(*last).zip(self_pairs).all(|((one, two), classes)| {
        let max_size = limit * classes.map(|class| sizes[class]).iter().product::<f64>().sqrt();
        one.iter().zip(two).all(|(one, two)| one.abs() + two.abs() <= max_size)
    })
}

/// Panels and single points that cover the upper half of a circle.
pub(crate) struct CircleCover {
    pub(crate) panels: Vec<CirclePanel>,
    /// Points on none of the panels, in ascending order.
    pub(crate) points: Vec<usize>,
}

impl Circle {
    /// Covers the upper half of a circle by resolved panels and single points.
    ///
    /// `are_resolved` returns for each of some panels of one width whether it is resolved.
    pub(crate) fn cover(
        self,
        node: usize,
        mut are_resolved: impl FnMut(&[CirclePanel]) -> Result<Vec<bool>>,
    ) -> Result<CircleCover> {
        let mut resolved_panels = vec![];
        let mut panels: Vec<_> = (0..1 << COARSEST_DEPTH)
            .map(|index| CirclePanel { depth: COARSEST_DEPTH, index })
            .collect();
        while panels.first().is_some_and(|panel| self.can_use(*panel)) {
            // The panel at the branch point of long waves is never resolved.
            let unresolved_count = usize::from(node == 0 && panels[0].index == 0);
            let mut unresolved = panels[..unresolved_count].to_vec();
            let candidates = &panels[unresolved_count..];
            for (panel, is_resolved) in candidates.iter().zip(are_resolved(candidates)?) {
                if is_resolved { &mut resolved_panels } else { &mut unresolved }.push(*panel);
            }
            panels = unresolved.into_iter().flat_map(CirclePanel::halves).collect();
        }
        let mut points: Vec<_> =
            panels.into_iter().flat_map(|panel| panel.points_of(self)).collect();
        points.push(self.points() - 1);
        Ok(CircleCover { panels: resolved_panels, points })
    }

    /// Whether a panel lies near enough to the circle, and replaces more points than it has.
    fn can_use(self, panel: CirclePanel) -> bool {
        let is_near = -self.logarithm <= 2.0 * PANEL_OFFSET_RATIO * panel.width();
        is_near && panel.points_of(self).len() > CHEBYSHEV_POINTS
    }
}
