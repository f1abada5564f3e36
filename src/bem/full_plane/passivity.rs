//! Passivity figure of a boundary equation: whether the soil can create energy.
//!
//! Tractions t and displacements u of the contact elements satisfy u = C(ζ) t if the rest of the boundary is
//! traction-free. Over a whole history, Σ t·L·Δu = (1/2π) ∫ tᴴ Herm[(1−ζ) L C(ζ)] t dθ on |ζ| = 1 (Parseval).
//! This sum is never negative if the Hermitian part has no negative eigenvalue.

use std::f64::consts::PI;

use super::stability_symbol::Symbol;
use crate::error::Result;
use crate::linalg::{DenseFactor, hermitian_range};
use realfft::num_complex::Complex64;

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
