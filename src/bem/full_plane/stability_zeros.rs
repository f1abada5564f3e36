//! Zeros of det F(ζ) inside the unit circle, by the argument principle; F is the operator of [`BoundarySymbol`].

use std::f64::consts::{PI, TAU};

use super::stability_symbol::BoundarySymbol;
use crate::error::{Error, Result};
use crate::linalg::DenseFactor;
use basemat_fourier::num_complex::Complex64;

/// Initial number of points on the whole circle, which resolves the phase if no zero is near the circle.
const CIRCLE_POINT_COUNT: usize = 1024;

/// Largest phase change of the determinant between neighbouring points, rad.
///
/// For a larger change, or for twice this change of the logarithm of its modulus, more points are inserted.
const MAX_PHASE_CHANGE: f64 = 0.7;

/// Largest number of halvings of the arc between neighbouring points.
const MAX_ARC_HALVINGS: u32 = 24;

/// Largest number of halvings of ln |ζ| in the search for the smallest zero.
const MAX_BISECTIONS: usize = 30;

/// Half width of the bracket of ln |ζ|, relative to its middle, below which the secant method is tried.
const SECANT_BRACKET_HALF_WIDTH: f64 = 0.25;

/// Half width of the bracket of ln |ζ|, relative to its middle, below which the search ends.
const FINAL_BRACKET_HALF_WIDTH: f64 = 0.01;

/// Relative distance of the first two points of the secant method.
const SECANT_START_STEP: f64 = 1e-4;

/// Largest number of steps of the secant method.
const MAX_SECANT_STEPS: usize = 40;

/// Change of ζ below which the secant method ends.
const SECANT_TOLERANCE: f64 = 1e-11;

/// Distance of the search for smaller zeros from the zero found, relative to the distance of that zero from |ζ| = 1.
const SMALLEST_ZERO_MARGIN: f64 = 1e-3;

/// Logarithm of the largest growth factor per step in the search: a run that grows faster ends within a few steps.
const MAX_LOG_GROWTH: f64 = 4.0;

/// Zeros of det F that make the time stepping grow.
pub(super) struct Zeros {
    /// Number of zeros in the searched circle.
    pub(super) zero_count: usize,
    /// Zero of the smallest modulus, whose growth is the fastest.
    pub(super) smallest_zero: Option<Complex64>,
}

/// Counts zeros with 1/|ζ| > 1 + `min_growth`, and computes the one with the smallest modulus.
pub(super) fn smallest_zero(symbol: &BoundarySymbol, min_growth: f64) -> Result<Zeros> {
    let mut search = ZeroSearch {
        symbol,
        factor: DenseFactor::with_capacity(symbol.order()),
        symbols: vec![],
        operator: vec![],
    };
    // Returns an error if the operator of lag 0, which is the operator at ζ = 0, is singular.
    search.log_determinant(Complex64::default())?;
    let circle = search.zeros_inside(1.0 / (1.0 + min_growth))?;
    let zero_count = circle.zero_count;
    if zero_count == 0 {
        return Ok(Zeros { zero_count, smallest_zero: None });
    }
    let mut seed = circle.fastest_phase_point;
    let mut low_log = -MAX_LOG_GROWTH;
    let mut high_log = -min_growth.ln_1p();
    for _ in 0..MAX_BISECTIONS {
        let middle_log = 0.5 * (low_log + high_log);
        let circle = search.zeros_inside(middle_log.exp())?;
        if circle.zero_count == 0 {
            low_log = middle_log;
            seed = circle.fastest_phase_point;
        } else {
            high_log = middle_log;
        }
        // The secant method starts on the inner circle, at the angle where the phase of the determinant
        // changes fastest.
        let relative_half_width = (high_log - low_log) / (low_log + high_log).abs();
        if relative_half_width < SECANT_BRACKET_HALF_WIDTH
            && let Some(zero) = search.secant(seed)
            && search.is_smallest(zero)?
        {
            return Ok(Zeros { zero_count, smallest_zero: Some(zero) });
        }
        if relative_half_width < FINAL_BRACKET_HALF_WIDTH {
            break;
        }
    }
    // Several zeros of nearly the same modulus, or a multiple zero: return the bracket's middle.
    let modulus = (0.5 * (low_log + high_log)).exp();
    let smallest_zero = Some(Complex64::from_polar(modulus, seed.arg()));
    Ok(Zeros { zero_count, smallest_zero })
}

/// Result of the argument principle for a circle.
struct CircleZeros {
    /// Number of zeros inside.
    zero_count: usize,
    /// Point of the circle where the phase of det F changes fastest, which is usually close to a zero.
    fastest_phase_point: Complex64,
}

/// Angle at which the phase of the determinant changes fastest.
#[derive(Default)]
struct FastestPhase {
    /// Phase change per radian.
    rate: f64,
    angle: f64,
}

/// Evaluates det F and counts its zeros, with buffers.
struct ZeroSearch<'a> {
    symbol: &'a BoundarySymbol<'a>,
    factor: DenseFactor<Complex64>,
    /// Buffer for the symbols of G and H.
    symbols: Vec<Complex64>,
    /// Buffer for F.
    operator: Vec<Complex64>,
}

impl ZeroSearch<'_> {
    /// Logarithm of det F at one ζ.
    fn log_determinant(&mut self, zeta: Complex64) -> Result<Complex64> {
        self.symbol.at(zeta, &mut self.symbols)?;
        self.symbol.operator(&self.symbols, &mut self.operator);
        log_determinant(&mut self.factor, &self.operator, self.symbol.order())
    }

    /// Counts the zeros in |ζ| < `radius`.
    ///
    /// F is real on the real axis, so that half the circle is sufficient.
    fn zeros_inside(&mut self, radius: f64) -> Result<CircleZeros> {
        let operators = self.symbol.operators_on(radius, CIRCLE_POINT_COUNT);
        let factor = &mut self.factor;
        let order = self.symbol.order();
        let results = operators.iter().map(|operator| log_determinant(factor, operator, order));
        let log_determinants: Vec<_> = results.collect::<Result<_>>()?;
        let step = TAU / CIRCLE_POINT_COUNT as f64;
        let mut phase = 0.0;
        let mut fastest = FastestPhase::default();
        for (k, pair) in log_determinants.windows(2).enumerate() {
            let angle = step * k as f64;
            let angles = [angle, angle + step];
            phase += self.phase_change(radius, angles, [pair[0], pair[1]], 0, &mut fastest)?;
        }
        let half_turns = (phase / PI).round();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counted")]
        let zero_count = if half_turns > 0.0 { half_turns as usize } else { 0 };
        let fastest_phase_point = Complex64::from_polar(radius, fastest.angle);
        Ok(CircleZeros { zero_count, fastest_phase_point })
    }

    /// Phase change of the determinant between two angles, at which `log_determinants` are known.
    ///
    /// Halves the interval until the change is unambiguous.
    fn phase_change(
        &mut self,
        radius: f64,
        angles: [f64; 2],
        log_determinants: [Complex64; 2],
        depth: u32,
        fastest: &mut FastestPhase,
    ) -> Result<f64> {
        let phase_change = wrapped_angle(log_determinants[1].im - log_determinants[0].im);
        let log_modulus_change = log_determinants[1].re - log_determinants[0].re;
        let is_unambiguous = phase_change.abs() < MAX_PHASE_CHANGE
            && log_modulus_change.abs() < 2.0 * MAX_PHASE_CHANGE;
        let middle = 0.5 * (angles[0] + angles[1]);
        if is_unambiguous || depth == MAX_ARC_HALVINGS {
            let rate = phase_change.abs() / (angles[1] - angles[0]);
            if rate > fastest.rate {
                *fastest = FastestPhase { rate, angle: middle };
            }
            return Ok(phase_change);
        }
        let middle_value = self.log_determinant(Complex64::from_polar(radius, middle))?;
        let lower_angles = [angles[0], middle];
        let lower_values = [log_determinants[0], middle_value];
        let upper_angles = [middle, angles[1]];
        let upper_values = [middle_value, log_determinants[1]];
        Ok(self.phase_change(radius, lower_angles, lower_values, depth + 1, fastest)?
            + self.phase_change(radius, upper_angles, upper_values, depth + 1, fastest)?)
    }

    /// Zero of det F near `seed` by the secant method.
    fn secant(&mut self, seed: Complex64) -> Option<Complex64> {
        let mut previous = seed;
        let mut zeta = seed * (1.0 + SECANT_START_STEP);
        // Values are determinants relative to the one at `seed`, which do not overflow.
        let seed_log_determinant = self.log_determinant(seed).ok()?;
        let mut previous_value = Complex64::new(1.0, 0.0);
        for _ in 0..MAX_SECANT_STEPS {
            // If a pivot is zero, `zeta` is the zero of the determinant.
            let Ok(log_determinant) = self.log_determinant(zeta) else { return Some(zeta) };
            let value = (log_determinant - seed_log_determinant).exp();
            let change = (zeta - previous) * value / (value - previous_value);
            if !change.is_finite() {
                return None;
            }
            previous = zeta;
            previous_value = value;
            zeta -= change;
            if zeta.norm() >= 1.0 {
                return None;
            }
            if change.norm() < SECANT_TOLERANCE {
                return Some(zeta);
            }
        }
        None
    }

    /// Whether no zero is smaller than `zero` by more than a thousandth of its distance from the unit circle.
    fn is_smallest(&mut self, zero: Complex64) -> Result<bool> {
        let margin = SMALLEST_ZERO_MARGIN * (1.0 - zero.norm());
        Ok(self.zeros_inside(zero.norm() - margin)?.zero_count == 0)
    }
}

/// Logarithm of the determinant of an operator.
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

/// Reduces an angle to [−π, π] by full turns.
fn wrapped_angle(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
