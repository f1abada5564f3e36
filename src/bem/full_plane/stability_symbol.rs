//! The symbols Σ Gⁿζⁿ and Σ Hⁿζⁿ of any kernel: early lags are summed, late lags interpolated in 1/n.
//!
//! n·(Gⁿ, Hⁿ) of an elastic plane is analytic in x = N/n for nΔt beyond the waves' travel time. Its
//! polynomial through Chebyshev points of 0 < x < 1 is summed in closed form,
//!
//! ```text
//! Σ_{n≥N} ζⁿ (N/n)^p = 1/Γ(p) ∫₀^∞ y^{p−1} e^{−y} ζ^N / (1 − ζ e^{−y/N}) dy ,
//! ```
//!
//! with the integral by the trapezoidal rule in ln y, which converges exponentially: for |ζ| ≤ 1 the pole y =
//! N ln ζ stays at least a quarter turn away.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::f64::consts::{PI, TAU};

use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;

use crate::error::{Error, Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::linalg::{DenseFactor, largest};

use super::{BoundaryCondition, BoundaryKernel};

/// Number of powers p = 1 … POWERS of N/n.
const POWERS: usize = 10;

/// Smallest and largest number of early lags.
const FIRST: usize = 64;
const LAST: usize = 4096;

/// Error of the interpolation at the lags checked, above which more early lags are summed.
const TAIL_TOLERANCE: f64 = 1e-9;
/// Largest error of the interpolation.
const ROUGH: f64 = 1e-6;

/// Symbols of G and H, and the operator that they form.
pub(super) struct Symbol<'a> {
    kernel: &'a dyn BoundaryKernel,
    prescribed: Vec<bool>,
    /// Scale of tractions for which the columns of G are as large as the columns of H.
    scale: f64,
    /// Entries of G and H together (each 2E × 2E) that have the same series: their places and signs.
    classes: Vec<Vec<(usize, f64)>>,
    /// Early lags of each class, one lag after the other.
    early: Vec<f64>,
    /// Coefficients of (N/n)^p, p = 1 …, in the same layout.
    late: Vec<f64>,
    lags: usize,
}

impl<'a> Symbol<'a> {
    pub(super) fn new(
        kernel: &'a dyn BoundaryKernel,
        conditions: &[BoundaryCondition],
    ) -> Result<Self> {
        let count = kernel.segments().len();
        if count == 0 {
            return Err(Error::Size { quantity: "segments", found: 0, needed: 1 });
        }
        let size = ContactLayout::new(COMPONENTS_IN_PLANE, count).square();
        let mut symbol = Self {
            kernel,
            prescribed: vec![],
            scale: 1.0,
            classes: vec![],
            early: vec![],
            late: vec![],
            lags: FIRST,
        };
        symbol.prescribe(conditions)?;
        let mut first = vec![0.0; 2 * size];
        symbol.read(0, &mut first)?;
        let (g, h) = first.split_at(size);
        symbol.scale = largest(h) / largest(g);
        if !symbol.scale.is_finite() {
            return Err(Error::Singular { matrix: "coefficients of lag 0", order: symbol.order() });
        }
        let mut error = symbol.fit_tail()?;
        while error > TAIL_TOLERANCE && symbol.lags < LAST {
            symbol.lags *= 2;
            error = symbol.fit_tail()?;
        }
        if error.is_nan() || error > ROUGH {
            let reason = format!(
                "coefficients beyond lag {LAST} differ by {error:.0e} from smooth ones, which a search for growth needs"
            );
            return Err(Error::part("boundary kernel", reason));
        }
        symbol.classes = classes(&first, &symbol.late);
        if !symbol.read_early()? {
            symbol.classes = (0..2 * size).map(|place| vec![(place, 1.0)]).collect();
            symbol.read_early()?;
        }
        let late = symbol.late.chunks_exact(2 * size);
        symbol.late =
            late.flat_map(|all| symbol.classes.iter().map(|class| all[class[0].0])).collect();
        Ok(symbol)
    }

    /// Reads the early lags of all classes; false if the entries of a class have different series.
    fn read_early(&mut self) -> Result<bool> {
        let mut all = vec![0.0; self.stride()];
        self.early.clear();
        for lag in 0..self.lags {
            self.read(lag, &mut all)?;
            for class in &self.classes {
                let value = all[class[0].0];
                if class.iter().any(|(place, sign)| all[*place] != sign * value) {
                    return Ok(false);
                }
                self.early.push(value);
            }
        }
        Ok(true)
    }

    /// Replaces the boundary conditions; the coefficients stay.
    pub(super) fn prescribe(&mut self, conditions: &[BoundaryCondition]) -> Result<()> {
        let count = self.kernel.segments().len();
        same_length("boundary conditions", conditions.len(), count)?;
        let prescribed = conditions.iter().map(|c| *c == BoundaryCondition::PrescribedDisplacement);
        self.prescribed = prescribed.clone().chain(prescribed).collect();
        Ok(())
    }

    /// Order 2E of the matrices.
    pub(super) fn order(&self) -> usize {
        self.prescribed.len()
    }

    fn stride(&self) -> usize {
        2 * self.order() * self.order()
    }

    /// Overwrites `all` with Gⁿ and Hⁿ.
    fn read(&self, lag: usize, all: &mut [f64]) -> Result<()> {
        let (g, h) = all.split_at_mut(self.stride() / 2);
        self.kernel.coefficients(lag, g, h)
    }

    /// n·(Gⁿ, Hⁿ), with G scaled.
    fn scaled(&self, lag: usize) -> Result<Vec<f64>> {
        let stride = self.stride();
        let mut values = vec![0.0; stride];
        self.read(lag, &mut values)?;
        for value in &mut values[..stride / 2] {
            *value *= self.scale;
        }
        for value in &mut values {
            *value *= lag as f64;
        }
        Ok(values)
    }

    /// Interpolates n·(Gⁿ, Hⁿ) by a polynomial in N/n; returns its relative error between its points.
    fn fit_tail(&mut self) -> Result<f64> {
        let first = self.lags as f64;
        let point = |k: f64| 0.5 + 0.5 * (PI * (k + 0.5) / POWERS as f64).cos();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "n ≥ N")]
        let lag_at = |k: f64| (first / point(k)).ceil() as usize;
        let stride = self.stride();
        let mut matrix = vec![0.0; POWERS * POWERS];
        let mut samples = vec![];
        for (k, row) in matrix.chunks_exact_mut(POWERS).enumerate() {
            let lag = lag_at(k as f64);
            let x = first / lag as f64;
            let mut power = 1.0;
            for entry in row {
                *entry = power;
                power *= x;
            }
            samples.push(self.scaled(lag)?);
        }
        let mut factor = DenseFactor::with_capacity(POWERS);
        if !factor.factor(&matrix, POWERS) {
            return Err(Error::Singular { matrix: "interpolation of late lags", order: POWERS });
        }
        self.late = vec![0.0; POWERS * stride];
        let mut column = [0.0; POWERS];
        for entry in 0..stride {
            for (value, sample) in column.iter_mut().zip(&samples) {
                *value = sample[entry];
            }
            factor.solve(&mut column);
            for (p, value) in column.iter().enumerate() {
                self.late[p * stride + entry] = *value;
            }
        }
        let largest = samples.iter().map(|sample| largest(sample)).fold(0.0, f64::max);
        let mut error = 0.0_f64;
        for k in [0.5, 3.5, 6.5] {
            let lag = lag_at(k);
            let x = first / lag as f64;
            for (entry, wanted) in self.scaled(lag)?.iter().enumerate() {
                let found =
                    (0..POWERS).rev().fold(0.0, |sum, p| sum * x + self.late[p * stride + entry]);
                error = error.max((found - wanted).abs());
            }
        }
        // Converts back to (Gⁿ, Hⁿ) = Σ c_p (N/n)^p /N, with G unscaled.
        for (index, value) in self.late.iter_mut().enumerate() {
            *value /= if index % stride < stride / 2 { first * self.scale } else { first };
        }
        // A kernel without late lags needs no interpolation.
        Ok(if largest > 0.0 { error / largest } else { 0.0 })
    }

    /// Adds the contribution of late lags to `sum`, which has one number per class.
    fn add_late(&self, zeta: Complex64, sum: &mut [Complex64]) {
        let tails = tail_sums(zeta, self.lags as f64);
        for (tail, late) in tails.iter().zip(self.late.chunks_exact(self.classes.len())) {
            for (sum, late) in sum.iter_mut().zip(late) {
                *sum += tail * late;
            }
        }
    }

    /// Overwrites `sum` with the symbols of G and H (2E × 2E each) at one ζ.
    pub(super) fn at(&self, zeta: Complex64, sum: &mut Vec<Complex64>) -> Result<()> {
        let stride = self.stride();
        let mut exact = vec![0.0; 2 * stride];
        let (g, h) = exact.split_at_mut(stride);
        if self.kernel.symbol([zeta.re, zeta.im], g, h)?.is_some() {
            sum.clear();
            sum.extend(exact.chunks_exact(2).map(|x| Complex64::new(x[0], x[1])));
            return Ok(());
        }
        let mut series = vec![Complex64::default(); self.classes.len()];
        let mut power = Complex64::new(1.0, 0.0);
        for lag in self.early.chunks_exact(self.classes.len()) {
            for (sum, value) in series.iter_mut().zip(lag) {
                *sum += power * value;
            }
            power *= zeta;
        }
        self.add_late(zeta, &mut series);
        sum.resize(stride, Complex64::default());
        for (class, value) in self.classes.iter().zip(series) {
            for (place, sign) in class {
                sum[*place] = value * sign;
            }
        }
        Ok(())
    }

    /// The operator F from the symbols of G and H, with columns in the order of the degrees of freedom.
    pub(super) fn operator(&self, sum: &[Complex64], operator: &mut Vec<Complex64>) {
        let order = self.order();
        let (g, h) = sum.split_at(order * order);
        operator.clear();
        operator.extend(g.iter().zip(h).enumerate().map(|(place, (g, h))| {
            if self.prescribed[place % order] { -g * self.scale } else { *h }
        }));
    }

    /// Operators at ζ = `radius` e^{iθ}, θ = 2πk/`points` for k = 0 … `points`/2, by FFT.
    pub(super) fn operators_on(&self, radius: f64, points: usize) -> Vec<Vec<Complex64>> {
        let order = self.order();
        let count = self.classes.len();
        let forward = RealFftPlanner::new().plan_fft_forward(points);
        let mut series = forward.make_input_vec();
        let mut spectrum = forward.make_output_vec();
        let mut scratch = forward.make_scratch_vec();
        let frequencies = points / 2 + 1;
        let zetas: Vec<_> = (0..frequencies)
            .map(|k| Complex64::from_polar(radius, TAU * k as f64 / points as f64))
            .collect();
        let tails: Vec<_> = zetas.iter().map(|zeta| tail_sums(*zeta, self.lags as f64)).collect();
        let mut operators = vec![vec![Complex64::default(); order * order]; frequencies];
        for (index, class) in self.classes.iter().enumerate() {
            // Place of the class in the operator: in G for unknown tractions, in H for unknown displacements.
            let entries = class.iter().filter_map(|(place, sign)| {
                let of_h = *place >= order * order;
                let place = place % (order * order);
                let prescribed = self.prescribed[place % order];
                let factor = if prescribed { -self.scale } else { 1.0 };
                (prescribed != of_h).then_some((place, sign * factor))
            });
            let entries: Vec<_> = entries.collect();
            let early = || self.early[index..].iter().step_by(count);
            if entries.is_empty() || early().all(|value| *value == 0.0) {
                continue;
            }
            series.fill(0.0);
            let mut power = 1.0;
            for (n, value) in early().enumerate() {
                // Lags beyond one turn are added to earlier lags.
                series[n % points] += power * value;
                power *= radius;
            }
            // All lengths come from the plan.
            if forward.process_with_scratch(&mut series, &mut spectrum, &mut scratch).is_err() {
                continue;
            }
            for (k, operator) in operators.iter_mut().enumerate() {
                let late: Complex64 = tails[k]
                    .iter()
                    .enumerate()
                    .map(|(p, tail)| tail * self.late[p * count + index])
                    .sum();
                // The exponent of the transform has the opposite sign.
                let value = spectrum[k].conj() + late;
                for (place, factor) in &entries {
                    operator[*place] = value * factor;
                }
            }
        }
        operators
    }
}

/// Groups places with the same first value and the same late coefficients, up to sign.
///
/// On a flat surface of equal elements there are few groups.
fn classes(first: &[f64], late: &[f64]) -> Vec<Vec<(usize, f64)>> {
    let stride = first.len();
    let mut known = HashMap::new();
    let mut classes: Vec<Vec<(usize, f64)>> = vec![];
    for (place, head) in first.iter().enumerate() {
        let values = || std::iter::once(*head).chain(late[place..].iter().step_by(stride).copied());
        let sign = values().find(|value| *value != 0.0).map_or(1.0, f64::signum);
        // Positive and negative zero are the same value.
        let key: Vec<u64> = values().map(|value| (sign * value + 0.0).to_bits()).collect();
        match known.entry(key) {
            Entry::Occupied(entry) => {
                let (class, sign_of_class): (usize, f64) = *entry.get();
                classes[class].push((place, sign * sign_of_class));
            }
            Entry::Vacant(entry) => {
                entry.insert((classes.len(), sign));
                classes.push(vec![(place, 1.0)]);
            }
        }
    }
    classes
}

/// Σ_{n≥first} ζⁿ (first/n)^p for p = 1 … [`POWERS`].
fn tail_sums(zeta: Complex64, first: f64) -> [Complex64; POWERS] {
    const STEP: f64 = 0.125;
    let mut sums = [Complex64::default(); POWERS];
    let front = (zeta.ln() * first).exp() * STEP;
    for k in -280..=32 {
        let y = (STEP * f64::from(k)).exp();
        // dy = y d(ln y)
        let mut term = front * (-y).exp() * y / (1.0 - zeta * (-y / first).exp());
        for (p, sum) in sums.iter_mut().enumerate() {
            *sum += term;
            term *= y / (p + 1) as f64;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: the closed sum against direct summation where |ζ| < 1, and on the circle against Abel's
    /// summation by parts, exact to (1−ζ)^{−1} N^{−2} terms there.
    #[test]
    fn tails_are_sums() {
        for (radius, angle) in [(0.99, 0.0), (0.99, 1.0), (0.98, 3.1), (0.995, 0.01)] {
            let zeta = Complex64::from_polar(radius, angle);
            let tails = tail_sums(zeta, 64.0);
            for (p, tail) in tails.iter().enumerate() {
                let power = i32::try_from(p + 1).unwrap();
                let sum: Complex64 =
                    (64..9000).map(|n| zeta.powi(n) * (64.0 / f64::from(n)).powi(power)).sum();
                assert!((tail - sum).norm() < 1e-12, "{zeta} {p}: {tail} {sum}");
            }
        }
        // On the circle: Σ_{n≥1} ζⁿ/n = −ln(1−ζ).
        let zeta = Complex64::from_polar(1.0, 0.3);
        let early: Complex64 = (1..64).map(|n| zeta.powi(n) / f64::from(n)).sum();
        let sum = early + tail_sums(zeta, 64.0)[0] / 64.0;
        assert!((sum + (1.0 - zeta).ln()).norm() < 1e-13);
    }
}
