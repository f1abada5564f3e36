//! Zeros of det F(ζ) inside the unit circle, by the argument principle.

use std::f64::consts::{PI, TAU};

use super::stability_symbol::Symbol;
use crate::error::{Error, Result};
use crate::linalg::DenseFactor;
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
    let mut low = -LARGEST_GROWTH;
    let mut high = -smallest_growth.ln_1p();
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
        let factor = &mut self.factor;
        let order = self.symbol.order();
        let values = operators.iter().map(|operator| log_determinant(factor, operator, order));
        let values: Vec<_> = values.collect::<Result<_>>()?;
        let step = TAU / POINTS as f64;
        let mut turn = 0.0;
        let mut fastest = (0.0, 0.0);
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
        let mut before = seed;
        let mut now = seed * (1.0 + 1e-4);
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
