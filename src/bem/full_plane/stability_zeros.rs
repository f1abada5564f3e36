//! Zeros of det F(ζ) inside the unit circle, by the argument principle.

use std::f64::consts::{PI, TAU};

use super::stability_symbol::Symbol;
use crate::error::{Error, Result};
use crate::linalg::{DenseFactor, hermitian_range};
use realfft::num_complex::Complex64;

/// Initial number of points on the whole circle.
const POINTS: usize = 1024;

/// Largest phase change of the determinant between neighbours, rad; above, more points are inserted.
const TURN: f64 = 0.7;

/// Largest number of halvings of the distance between neighbours.
const HALVINGS: u32 = 24;

/// Largest number of halvings of ln |ζ| in the search for the smallest zero.
const BISECTIONS: usize = 30;

/// Half width of the bracket over its middle: below `COARSE` the secant method is tried, below `FINE` the
/// search ends.
const COARSE: f64 = 0.25;
const FINE: f64 = 0.01;

/// Zeros inside a circle: their number, and the smallest.
pub(super) struct Zeros {
    /// Number of zeros inside.
    pub(super) count: usize,
    /// Smallest zero inside.
    pub(super) zero: Option<Complex64>,
}

/// Counts zeros with 1/|ζ| > 1 + `smallest_growth` and finds the smallest one.
pub(super) fn smallest_zero(symbol: &Symbol, smallest_growth: f64) -> Result<Zeros> {
    let mut search = Search {
        symbol,
        factor: DenseFactor::with_capacity(symbol.order()),
        sum: vec![],
        operator: vec![],
    };
    // At ζ = 0 the operator equals the operator of lag 0.
    search.log_determinant(Complex64::default())?;
    let (count, mut seed) = search.zeros_inside(1.0 / (1.0 + smallest_growth))?;
    if count == 0 {
        return Ok(Zeros { count, zero: None });
    }
    let (mut low, mut high) = (-LARGEST_GROWTH, -smallest_growth.ln_1p());
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        let (inside, near) = search.zeros_inside(middle.exp())?;
        if inside == 0 {
            (low, seed) = (middle, near);
        } else {
            high = middle;
        }
        // The secant method starts on the inner circle, at the angle where the phase of the determinant
        // changes fastest.
        let width = (high - low) / (low + high).abs();
        if width < COARSE
            && let Some(zero) = search.secant(seed)
            && search.is_smallest(zero)?
        {
            return Ok(Zeros { count, zero: Some(zero) });
        }
        if width < FINE {
            break;
        }
    }
    // Several zeros of nearly the same modulus, or a multiple zero: return the bracket's middle.
    let size = (0.5 * (low + high)).exp();
    Ok(Zeros { count, zero: Some(Complex64::from_polar(size, seed.arg())) })
}

/// ln of the largest growth factor that is searched for.
const LARGEST_GROWTH: f64 = 4.0;

struct Search<'a> {
    symbol: &'a Symbol<'a>,
    factor: DenseFactor<Complex64>,
    sum: Vec<Complex64>,
    operator: Vec<Complex64>,
}

impl Search<'_> {
    /// ln det F at one ζ.
    fn log_determinant(&mut self, zeta: Complex64) -> Result<Complex64> {
        self.symbol.at(zeta, &mut self.sum)?;
        self.symbol.operator(&self.sum, &mut self.operator);
        log_determinant(&mut self.factor, &self.operator, self.symbol.order())
    }

    /// Number of zeros in |ζ| < `radius`, and the point of the circle nearest to a zero.
    ///
    /// At this point the phase of det F changes fastest. F is real on the real axis, so half the circle is
    /// enough.
    fn zeros_inside(&mut self, radius: f64) -> Result<(usize, Complex64)> {
        let operators = self.symbol.operators_on(radius, POINTS);
        let (factor, order) = (&mut self.factor, self.symbol.order());
        let values = operators.iter().map(|operator| log_determinant(factor, operator, order));
        let values: Vec<_> = values.collect::<Result<_>>()?;
        let step = TAU / POINTS as f64;
        let (mut turn, mut fastest) = (0.0, (0.0, 0.0));
        for (k, ends) in values.windows(2).enumerate() {
            let angle = step * k as f64;
            turn +=
                self.turn(radius, [angle, angle + step], [ends[0], ends[1]], 0, &mut fastest)?;
        }
        let count = (turn / PI).round();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counted")]
        let count = if count > 0.0 { count as usize } else { 0 };
        Ok((count, Complex64::from_polar(radius, fastest.1)))
    }

    /// Phase change of the determinant between two angles; halves the interval until the change is
    /// unambiguous.
    fn turn(
        &mut self,
        radius: f64,
        angles: [f64; 2],
        values: [Complex64; 2],
        depth: u32,
        fastest: &mut (f64, f64),
    ) -> Result<f64> {
        let turn = wrapped(values[1].im - values[0].im);
        let quiet = turn.abs() < TURN && (values[1].re - values[0].re).abs() < 2.0 * TURN;
        if quiet || depth == HALVINGS {
            let rate = turn.abs() / (angles[1] - angles[0]);
            if rate > fastest.0 {
                *fastest = (rate, 0.5 * (angles[0] + angles[1]));
            }
            return Ok(turn);
        }
        let middle = 0.5 * (angles[0] + angles[1]);
        let value = self.log_determinant(Complex64::from_polar(radius, middle))?;
        Ok(self.turn(radius, [angles[0], middle], [values[0], value], depth + 1, fastest)?
            + self.turn(radius, [middle, angles[1]], [value, values[1]], depth + 1, fastest)?)
    }

    /// Zero of det F near `seed` by the secant method.
    fn secant(&mut self, seed: Complex64) -> Option<Complex64> {
        let (mut before, mut now) = (seed, seed * (1.0 + 1e-4));
        let reference = self.log_determinant(before).ok()?;
        let mut value_before = Complex64::new(1.0, 0.0);
        for _ in 0..40 {
            // If a pivot is zero, `now` is the zero of the determinant.
            let Ok(log) = self.log_determinant(now) else { return Some(now) };
            let value = (log - reference).exp();
            let change = (now - before) * value / (value - value_before);
            if !change.is_finite() {
                return None;
            }
            (before, value_before) = (now, value);
            now -= change;
            if now.norm() >= 1.0 {
                return None;
            }
            if change.norm() < 1e-11 {
                return Some(now);
            }
        }
        None
    }

    /// Whether `zero` is a zero, and no other is smaller by more than a thousandth.
    fn is_smallest(&mut self, zero: Complex64) -> Result<bool> {
        let margin = 1e-3 * (1.0 - zero.norm());
        Ok(self.zeros_inside(zero.norm() - margin)?.0 == 0)
    }
}

/// ln det of an operator of this order.
fn log_determinant(
    factor: &mut DenseFactor<Complex64>,
    operator: &[Complex64],
    order: usize,
) -> Result<Complex64> {
    if factor.factor(operator, order) {
        Ok(factor.log_determinant())
    } else {
        Err(Error::Singular { matrix: "symbol of the boundary equation", order })
    }
}

/// Reduces an angle to (−π, π].
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

// Passivity figure of a boundary equation: whether the discrete soil can create energy.
//
// Tractions t and displacements u of the contact elements satisfy u = C(ζ) t if the rest of the boundary is
// traction-free. Over a whole history, Σ t·L·Δu = (1/2π) ∫ tᴴ Herm[(1−ζ) L C(ζ)] t dθ on |ζ| = 1 (Parseval).
// This sum is never negative if the Hermitian part has no negative eigenvalue.

/// Number of angles on the half circle.
const ANGLES: usize = 192;

/// Number of golden-section steps around the worst angle.
const REFINEMENTS: usize = 16;

/// Smallest eigenvalues, each relative to the largest magnitude on the circle.
pub(super) struct Passivity {
    /// Smallest eigenvalue of (1−ζ) L C.
    pub(super) work: f64,
    /// Smallest eigenvalue of s L C.
    pub(super) rate: Option<f64>,
    /// Angle of the smallest eigenvalue of (1−ζ) L C.
    pub(super) angle: f64,
}

/// Ranges of eigenvalues at one ζ: of (1−ζ) L C and of s L C.
type Ranges = ([f64; 2], Option<[f64; 2]>);

/// Passivity figures for the elements with prescribed displacement; `None` without such elements.
pub(super) fn passivity(symbol: &Symbol) -> Result<Option<Passivity>> {
    let contact: Vec<_> =
        (0..symbol.order()).filter(|component| symbol.prescribed()[*component]).collect();
    if contact.is_empty() {
        return Ok(None);
    }
    let mut compliance = Compliance {
        symbol,
        contact,
        factor: DenseFactor::with_columns(symbol.order(), symbol.order()),
        sum: vec![],
    };
    let (mut work, mut rate) = ([f64::INFINITY, 0.0], [f64::INFINITY, 0.0]);
    let mut angle = 0.0;
    let mut has_rate = false;
    for k in 0..ANGLES {
        let at = PI * (k as f64 + 0.5) / ANGLES as f64;
        let Some((range, range_of_rate)) = compliance.ranges(at)? else { return Ok(None) };
        if range[0] < work[0] {
            angle = at;
        }
        widen(&mut work, range);
        if let Some(range) = range_of_rate {
            has_rate = true;
            widen(&mut rate, range);
        }
    }
    // Golden section around the worst angle (the minimum of the samples is kept in any case).
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let width = PI / ANGLES as f64;
    let (mut low, mut high) = ((angle - width).max(1e-9), (angle + width).min(PI));
    for _ in 0..REFINEMENTS {
        let [left, right] = [high - golden * (high - low), low + golden * (high - low)];
        let (Some((a, _)), Some((b, _))) = (compliance.ranges(left)?, compliance.ranges(right)?)
        else {
            break;
        };
        let (best, range) = if a[0] < b[0] { (left, a) } else { (right, b) };
        if range[0] < work[0] {
            angle = best;
        }
        widen(&mut work, range);
        (low, high) = if a[0] < b[0] { (low, right) } else { (left, high) };
    }
    Ok(Some(Passivity {
        work: work[0] / work[1],
        rate: has_rate.then_some(rate[0] / rate[1]),
        angle,
    }))
}

/// Updates the smallest eigenvalue and the largest magnitude.
fn widen(extremes: &mut [f64; 2], range: [f64; 2]) {
    extremes[0] = extremes[0].min(range[0]);
    extremes[1] = extremes[1].max(range[0].abs()).max(range[1].abs());
}

struct Compliance<'a> {
    symbol: &'a Symbol<'a>,
    contact: Vec<usize>,
    factor: DenseFactor<Complex64>,
    sum: Vec<Complex64>,
}

impl Compliance<'_> {
    /// Ranges of the eigenvalues at ζ = e^{iθ}; `None` where H is singular.
    fn ranges(&mut self, angle: f64) -> Result<Option<Ranges>> {
        let zeta = Complex64::from_polar(1.0, angle);
        let s = self.symbol.at(zeta, &mut self.sum)?;
        let (order, size) = (self.symbol.order(), self.contact.len());
        let (g, h) = self.sum.split_at(order * order);
        if !self.factor.factor(h, order) {
            return Ok(None);
        }
        let mut columns: Vec<_> = (0..order)
            .flat_map(|row| self.contact.iter().map(move |column| g[row * order + column]))
            .collect();
        self.factor.solve_columns(&mut columns, size);
        let mut matrix = vec![Complex64::default(); size * size];
        let mut range_with = |factor: Complex64| {
            for (row, component) in self.contact.iter().enumerate() {
                let factor = factor * self.symbol.length(*component);
                for column in 0..size {
                    matrix[row * size + column] = factor * columns[component * size + column];
                }
            }
            hermitian_range(&matrix, size)
        };
        let Some(work) = range_with(1.0 - zeta) else { return Ok(None) };
        Ok(Some((work, s.and_then(range_with))))
    }
}
