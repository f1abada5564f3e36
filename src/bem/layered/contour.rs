//! Mobility of a layered ground along the circles of its convolution quadrature.
//!
//! (1−z) Ĝ(z) is smooth in the angle θ of z, except for waves that return late. Panels in θ have 24 Chebyshev points
//! each. They are halved until the last two coefficients are small, which yields a binary tree for every eigenvalue of
//! Δ(z). The first eigenvalue represents waves that travel and return. Its tree has narrower panels towards θ = 0, the
//! branch point of long waves. The waves of the other eigenvalues decay within a step or two, except for high frequencies
//! with three stages. After a division by (1−z)², a few panels represent them.
//!
//! All singularities lie on |z| ≥ 1, and the singularities of undamped layers on the unit circle itself. Panels lie inside
//! the unit circle, at ln |z| = −w/20 for a width w, so that no singularity is missed between two points. Their
//! polynomials in the complex variable ln z are accurate on every circle between the panel and the unit circle. All blocks
//! of lags can therefore use the same panel. On parts of a circle with fewer points than panels need, the mobility is
//! evaluated at the circle's points. This always occurs at cut-off frequencies of undamped layers.
//!
//! A response up to m lags late is a polynomial in z of degree m, whose phase change over a panel is up to mw. Division by
//! z^(m/2) halves the phase change. It may resolve a panel that is not resolved without division.

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
/// Number of halvings of θ = 0 … π that yield the widest panels.
const COARSEST_DEPTH: u32 = 2;
/// −ln |z| of a panel, divided by its width.
pub(super) const PANEL_OFFSET_RATIO: f64 = 1.0 / 20.0;
/// Limit of the last Chebyshev coefficients, relative to the tolerance.
///
/// It is below one because errors of coefficients grow with the lag, in contrast to errors of F.
const COEFFICIENT_LIMIT_FACTOR: f64 = 0.3;
/// Phase changes over half a panel of the trial powers of z by which functions are divided.
///
/// Responses are late and never early, so that the powers are not negative.
const TRIAL_PHASES: [f64; 2] = [0.0, 4.0];

/// Circle |z| = r for the transform of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Circle {
    /// Number of points of the whole circle.
    pub(crate) point_count: usize,
    /// ln r.
    pub(crate) log_radius: f64,
}

impl Circle {
    /// Circle of `point_count` points for a relative accuracy of F.
    pub(crate) fn new(point_count: usize, tolerance: f64) -> Self {
        // Aliases ε and amplified errors tol·ε^(−1/2) at the last lag are then about equal.
        let log_radius = 2.0 / 3.0 * tolerance.ln() / point_count as f64;
        Self { point_count, log_radius }
    }

    /// Number of points of the upper half, with both ends.
    pub(crate) fn half_circle_points(self) -> usize {
        self.point_count / 2 + 1
    }

    /// Angle of a point, rad.
    pub(crate) fn angle(self, point: usize) -> f64 {
        std::f64::consts::TAU / self.point_count as f64 * point as f64
    }
}

/// Factor by which the contribution of an eigenvalue is divided before it is interpolated on a panel.
///
/// `log_z`: ln |z| and angle.
pub(crate) fn panel_factor(node: usize, log_z: [f64; 2]) -> Complex {
    let one_less_z = on_circle(log_z[0], log_z[1]).one_less_z;
    if node == 0 { Complex::real(1.0) } else { one_less_z * one_less_z }
}

/// Tested panels of an eigenvalue, with polynomials on the resolved panels.
#[derive(Debug)]
pub(crate) struct Panels {
    stored: Mutex<HashMap<CirclePanel, Option<Arc<PanelPolynomials>>>>,
    /// For each class: the classes of the pairs of its two elements with themselves.
    pub(super) self_pairs: Arc<[[usize; 2]]>,
}

/// Functions on a panel, divided by a power of z, as Chebyshev series.
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
    /// `None` if the panel is not resolved with any power. `self_pairs` and `tolerance` as in [`is_resolved`].
    pub(crate) fn through<const KINDS: usize>(
        values: &[Complex],
        self_pairs: &[[usize; 2]],
        tolerance: f64,
    ) -> Option<Self> {
        let function_count = values.len() / CHEBYSHEV_POINTS;
        for phase in TRIAL_PHASES {
            let mut quotients = values.to_vec();
            for (x, row) in nodes().zip(quotients.chunks_exact_mut(function_count)) {
                let inverse_power = Complex::polar(1.0, -phase * x);
                for value in row {
                    *value = *value * inverse_power;
                }
            }
            let coefficients = chebyshev_coefficients(&quotients);
            if is_resolved::<KINDS>(&coefficients, self_pairs, tolerance, phase) {
                return Some(Self { coefficients, phase });
            }
        }
        None
    }
}

/// Panel of the half circle: the `index`-th of 2^`depth` equal panels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct CirclePanel {
    depth: u32,
    index: usize,
}

impl CirclePanel {
    /// Two panels of half the width.
    fn halves(self) -> [Self; 2] {
        [0, 1].map(|half| Self { depth: self.depth + 1, index: 2 * self.index + half })
    }

    /// Width as an angle, rad.
    pub(super) fn width(self) -> f64 {
        PI / (1_usize << self.depth) as f64
    }

    /// Points of a circle on this panel.
    pub(super) fn points_of(self, circle: Circle) -> Range<usize> {
        let point_count = (circle.half_circle_points() - 1) >> self.depth;
        self.index * point_count..(self.index + 1) * point_count
    }

    /// ln |z| and angle of the Chebyshev points of this panel.
    pub(crate) fn chebyshev_points(self) -> impl Iterator<Item = [f64; 2]> {
        let width = self.width();
        nodes().map(move |x| {
            [-PANEL_OFFSET_RATIO * width, width * (self.index as f64 + 0.5 * (1.0 + x))]
        })
    }
}

/// Chebyshev points in −1 … 1, in descending order.
pub(super) fn nodes() -> impl Iterator<Item = f64> {
    (0..CHEBYSHEV_POINTS).map(|i| (PI * (i as f64 + 0.5) / CHEBYSHEV_POINTS as f64).cos())
}

/// Chebyshev coefficients from values at the Chebyshev points, one column for each function.
pub(super) fn chebyshev_coefficients(values: &[Complex]) -> Vec<Complex> {
    let function_count = values.len() / CHEBYSHEV_POINTS;
    let mut coefficients = vec![Complex::default(); values.len()];
    for (degree, row) in coefficients.chunks_exact_mut(function_count).enumerate() {
        for (i, point_values) in values.chunks_exact(function_count).enumerate() {
            let angle = PI * (degree as f64 * (i as f64 + 0.5)) / CHEBYSHEV_POINTS as f64;
            let normalisation = if degree == 0 { 1.0 } else { 2.0 } / CHEBYSHEV_POINTS as f64;
            let factor = normalisation * angle.cos();
            for (sum, value) in row.iter_mut().zip(point_values) {
                *sum += value.scale(factor);
            }
        }
    }
    coefficients
}

impl Panels {
    /// Empty store of panels; `self_pairs` has, for each class, the classes of its two elements with themselves.
    pub(crate) fn new(self_pairs: &Arc<[[usize; 2]]>) -> Self {
        Self { stored: Mutex::default(), self_pairs: Arc::clone(self_pairs) }
    }

    /// Locks the store of tested panels.
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
    let element_count = classes.elements().len();
    for (index, pair) in pairs.iter().enumerate() {
        let elements = [index / element_count, index % element_count];
        self_pairs[pair.class] = elements.map(|element| pairs[element * (element_count + 1)].class);
    }
    self_pairs
}

/// Whether the last two `coefficients` are small, also on the unit circle.
///
/// They are compared with the coefficients of the pairs of the elements with themselves; `self_pairs` has, for each
/// class, the classes of these pairs. `phase` is the phase change of the power of z over half the panel.
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
    let rows_by_degree: Vec<_> = coefficients
        .chunks_exact(self_pairs.len() * KINDS)
        .map(|row| row.as_chunks::<KINDS>().0)
        .collect();
    let mut class_magnitudes = Vec::with_capacity(self_pairs.len());
    for class in 0..self_pairs.len() {
        // The first components are the diagonal of the pair's symmetric matrix.
        let mut min_magnitude = f64::INFINITY;
        for component in 0..KINDS.div_ceil(2) {
            let magnitudes = rows_by_degree.iter().map(|row| row[class][component].abs());
            min_magnitude = min_magnitude.min(magnitudes.fold(0.0, f64::max));
        }
        class_magnitudes.push(min_magnitude);
    }
    let [.., next_to_last_row, last_row] = &rows_by_degree[..] else {
        return false;
    };
    next_to_last_row.iter().zip(*last_row).zip(self_pairs).all(|((one, two), classes)| {
        let magnitudes = classes.map(|class| class_magnitudes[class]);
        let max_sum = limit * magnitudes.iter().product::<f64>().sqrt();
        one.iter().zip(two).all(|(one, two)| one.abs() + two.abs() <= max_sum)
    })
}

/// Panels and single points that cover the upper half of a circle.
pub(crate) struct CircleCover {
    pub(crate) panels: Vec<CirclePanel>,
    /// Points outside all panels, in ascending order.
    pub(crate) points: Vec<usize>,
}

impl Circle {
    /// Covers the upper half of a circle by resolved panels and single points.
    ///
    /// `node` is the index of the eigenvalue. `are_resolved` receives panels of one width, and returns for each whether it
    /// is resolved.
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
        points.push(self.half_circle_points() - 1);
        Ok(CircleCover { panels: resolved_panels, points })
    }

    /// Whether a panel is close enough to the circle, and replaces more points than it has.
    fn can_use(self, panel: CirclePanel) -> bool {
        let is_close = -self.log_radius <= 2.0 * PANEL_OFFSET_RATIO * panel.width();
        is_close && panel.points_of(self).len() > CHEBYSHEV_POINTS
    }
}
