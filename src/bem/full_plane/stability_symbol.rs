//! The symbols Σ Gⁿζⁿ and Σ Hⁿζⁿ of any kernel: early lags are summed, late lags interpolated in 1/n.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::f64::consts::TAU;

use basemat_fourier::RealPlanner;
use basemat_fourier::num_complex::Complex64;

use crate::error::{Error, Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::linalg::{DenseFactor, largest};

use super::stability_tail::{TAIL_POWERS, interpolation_lag, tail_sums};
use super::{BoundaryCondition, BoundaryKernel};

/// Smallest number of early lags.
const MIN_EARLY_LAGS: usize = 64;

/// Largest number of early lags.
const MAX_EARLY_LAGS: usize = 4096;

/// Error of the interpolation at the lags checked, above which more early lags are summed.
const TAIL_TOLERANCE: f64 = 1e-9;
/// Largest error of the interpolation.
const MAX_TAIL_ERROR: f64 = 1e-6;

/// Symbols of G and H, and the operator that they form.
pub(super) struct BoundarySymbol<'a> {
    kernel: &'a dyn BoundaryKernel,
    prescribed: Vec<bool>,
    /// Scale of tractions for which the columns of G are as large as the columns of H.
    scale: f64,
    /// Entries of G and H together (each 2E × 2E) that have the same series: their indices and signs.
    classes: Vec<Vec<(usize, f64)>>,
    /// Early lags of each class, one lag after the other.
    early: Vec<f64>,
    /// Coefficients of (N/n)^p, p = 1 …, in the same layout.
    late: Vec<f64>,
    /// Number N of early lags.
    lags: usize,
}

impl<'a> BoundarySymbol<'a> {
    /// Reads early lags and interpolates late ones.
    ///
    /// # Errors
    /// [`Error::Size`] for no elements or a wrong number of conditions, [`Error::Singular`] for a singular
    /// first lag, [`Error::Part`] if late lags are not smooth.
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
            lags: MIN_EARLY_LAGS,
        };
        symbol.prescribe(conditions)?;
        let mut first_lag = vec![0.0; 2 * size];
        symbol.read_lag(0, &mut first_lag)?;
        symbol.scale = largest(&first_lag[size..]) / largest(&first_lag[..size]);
        if !symbol.scale.is_finite() {
            return Err(Error::Singular { matrix: "coefficients of lag 0", order: symbol.order() });
        }
        let mut error = symbol.fit_tail()?;
        while error > TAIL_TOLERANCE && symbol.lags < MAX_EARLY_LAGS {
            symbol.lags *= 2;
            error = symbol.fit_tail()?;
        }
        if error.is_nan() || error > MAX_TAIL_ERROR {
            let reason = format!(
                "coefficients beyond lag {MAX_EARLY_LAGS} differ by {error:.0e} from smooth ones, which a search for growth needs"
            );
            return Err(Error::part("boundary kernel", reason));
        }
        symbol.classes = equal_entries(&first_lag, &symbol.late);
        if !symbol.read_early()? {
            symbol.classes = (0..2 * size).map(|index| vec![(index, 1.0)]).collect();
            symbol.read_early()?;
        }
        let mut late_of_classes = vec![];
        for entries in symbol.late.chunks_exact(2 * size) {
            for class in &symbol.classes {
                late_of_classes.push(entries[class[0].0]);
            }
        }
        symbol.late = late_of_classes;
        Ok(symbol)
    }

    /// Reads the early lags of all classes; false if the entries of a class have different series.
    fn read_early(&mut self) -> Result<bool> {
        let mut entries = vec![0.0; self.stride()];
        self.early.clear();
        for lag in 0..self.lags {
            self.read_lag(lag, &mut entries)?;
            for class in &self.classes {
                let value = entries[class[0].0];
                if class.iter().any(|(index, sign)| entries[*index] != sign * value) {
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

    /// Number of entries of G and H together.
    fn stride(&self) -> usize {
        2 * self.order() * self.order()
    }

    /// Overwrites `entries` with Gⁿ and Hⁿ.
    fn read_lag(&self, lag: usize, entries: &mut [f64]) -> Result<()> {
        let (g, h) = entries.split_at_mut(self.stride() / 2);
        self.kernel.coefficients(lag, g, h)
    }

    /// n·(Gⁿ, Hⁿ), with G scaled.
    fn scaled_lag(&self, lag: usize) -> Result<Vec<f64>> {
        let stride = self.stride();
        let mut values = vec![0.0; stride];
        self.read_lag(lag, &mut values)?;
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
        let stride = self.stride();
        let mut matrix = vec![0.0; TAIL_POWERS * TAIL_POWERS];
        let mut samples = vec![];
        for (k, row) in matrix.chunks_exact_mut(TAIL_POWERS).enumerate() {
            let lag = interpolation_lag(first, k as f64);
            let x = first / lag as f64;
            let mut power = 1.0;
            for entry in row {
                *entry = power;
                power *= x;
            }
            samples.push(self.scaled_lag(lag)?);
        }
        let mut factor = DenseFactor::with_capacity(TAIL_POWERS);
        if !factor.factor(&matrix, TAIL_POWERS) {
            return Err(Error::Singular {
                matrix: "interpolation of late lags",
                order: TAIL_POWERS,
            });
        }
        self.late = vec![0.0; TAIL_POWERS * stride];
        let mut column = [0.0; TAIL_POWERS];
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
            let lag = interpolation_lag(first, k);
            let x = first / lag as f64;
            for (entry, exact) in self.scaled_lag(lag)?.iter().enumerate() {
                let mut interpolated = 0.0;
                for p in (0..TAIL_POWERS).rev() {
                    interpolated = interpolated * x + self.late[p * stride + entry];
                }
                error = error.max((interpolated - exact).abs());
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
            for (index, sign) in class {
                sum[*index] = value * sign;
            }
        }
        Ok(())
    }

    /// The operator F from the symbols of G and H, with columns in the order of the degrees of freedom.
    pub(super) fn operator(&self, sum: &[Complex64], operator: &mut Vec<Complex64>) {
        let order = self.order();
        let size = order * order;
        operator.clear();
        for index in 0..size {
            operator.push(if self.prescribed[index % order] {
                -sum[index] * self.scale
            } else {
                sum[size + index]
            });
        }
    }

    /// Operators at ζ = `radius` e^{iθ}, θ = 2πk/`points` for k = 0 … `points`/2, by FFT.
    pub(super) fn operators_on(&self, radius: f64, points: usize) -> Vec<Vec<Complex64>> {
        let order = self.order();
        let count = self.classes.len();
        let forward = RealPlanner::new().plan_fft_forward(points);
        let mut series = forward.make_input_vec();
        let mut spectrum = forward.make_output_vec();
        let mut scratch = forward.make_scratch_vec();
        let frequencies = points / 2 + 1;
        let mut tails = vec![];
        for k in 0..frequencies {
            let zeta = Complex64::from_polar(radius, TAU * k as f64 / points as f64);
            tails.push(tail_sums(zeta, self.lags as f64));
        }
        let mut operators = vec![vec![Complex64::default(); order * order]; frequencies];
        for (index, class) in self.classes.iter().enumerate() {
            let entries = self.operator_entries(class);
            let early = self.early[index..].iter().step_by(count);
            if entries.is_empty() || early.clone().all(|value| *value == 0.0) {
                continue;
            }
            series.fill(0.0);
            let mut power = 1.0;
            for (n, value) in early.enumerate() {
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
                for (entry, factor) in &entries {
                    operator[*entry] = value * factor;
                }
            }
        }
        operators
    }

    /// Entries of the operator that contain a class, with their factors.
    ///
    /// The entry is in G for unknown tractions, in H for unknown displacements.
    fn operator_entries(&self, class: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let order = self.order();
        let size = order * order;
        let mut entries = vec![];
        for (index, sign) in class {
            let is_in_h = *index >= size;
            let entry = index % size;
            let prescribed = self.prescribed[entry % order];
            if prescribed != is_in_h {
                let factor = if prescribed { -self.scale } else { 1.0 };
                entries.push((entry, sign * factor));
            }
        }
        entries
    }
}

/// Groups entries with the same first value and the same late coefficients, up to sign.
///
/// On a flat surface of equal elements there are few groups.
fn equal_entries(first_lag: &[f64], late: &[f64]) -> Vec<Vec<(usize, f64)>> {
    let stride = first_lag.len();
    let mut known = HashMap::new();
    let mut classes: Vec<Vec<(usize, f64)>> = vec![];
    for (index, first_value) in first_lag.iter().enumerate() {
        let late_values = late[index..].iter().step_by(stride).copied();
        let values = std::iter::once(*first_value).chain(late_values);
        let sign = values.clone().find(|value| *value != 0.0).map_or(1.0, f64::signum);
        // Positive and negative zero are the same value.
        let key: Vec<u64> = values.map(|value| (sign * value + 0.0).to_bits()).collect();
        match known.entry(key) {
            Entry::Occupied(entry) => {
                let (class, sign_of_class): (usize, f64) = *entry.get();
                classes[class].push((index, sign * sign_of_class));
            }
            Entry::Vacant(entry) => {
                entry.insert((classes.len(), sign));
                classes.push(vec![(index, 1.0)]);
            }
        }
    }
    classes
}
