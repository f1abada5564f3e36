//! Symbols Σ Gⁿζⁿ and Σ Hⁿζⁿ of any kernel: early lags are summed, late lags interpolated in 1/n.

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

/// Number of early lags of the first attempt; it is doubled until the interpolation is accurate.
const MIN_EARLY_LAGS: usize = 64;

/// Largest number of early lags, which limits the memory of their values.
const MAX_EARLY_LAGS: usize = 4096;

/// Error of the interpolation above which more early lags are summed.
const TAIL_TOLERANCE: f64 = 1e-9;
/// Largest error of the interpolation with which a search for growth is reliable.
const MAX_TAIL_ERROR: f64 = 1e-6;

/// Points between the interpolation points at which the error is checked.
const CHECKED_POINTS: [f64; 3] = [0.5, 3.5, 6.5];

/// Symbols of G and H, and the operator of the degrees of freedom.
pub(super) struct BoundarySymbol<'a> {
    kernel: &'a dyn BoundaryKernel,
    /// Whether the displacement of a component is prescribed.
    has_prescribed_displacement: Vec<bool>,
    /// Scale of tractions for which the columns of G and H have equal size.
    traction_scale: f64,
    /// Entries of G and H together (each 2E × 2E) that have the same series: their indices and signs.
    classes: Vec<Vec<(usize, f64)>>,
    /// Early lags of each class, one lag after the other.
    early_values: Vec<f64>,
    /// Coefficients of (N/n)^p, p = 1 …, in the same layout.
    late_coefficients: Vec<f64>,
    /// Number N of early lags.
    lag_count: usize,
}

impl<'a> BoundarySymbol<'a> {
    /// Evaluates the early lags of the kernel, and interpolates the late ones.
    ///
    /// # Errors
    /// [`Error::Size`] for no elements or a wrong number of conditions, [`Error::Singular`] for a singular
    /// first lag, [`Error::Part`] if late lags are not smooth.
    pub(super) fn new(
        kernel: &'a dyn BoundaryKernel,
        conditions: &[BoundaryCondition],
    ) -> Result<Self> {
        let segment_count = kernel.segments().len();
        if segment_count == 0 {
            return Err(Error::Size { quantity: "segments", found: 0, needed: 1 });
        }
        let matrix_length = ContactLayout::new(COMPONENTS_IN_PLANE, segment_count).matrix_len();
        let mut symbol = Self {
            kernel,
            has_prescribed_displacement: vec![],
            traction_scale: 1.0,
            classes: vec![],
            early_values: vec![],
            late_coefficients: vec![],
            lag_count: MIN_EARLY_LAGS,
        };
        symbol.prescribe(conditions)?;
        let mut first_lag = vec![0.0; 2 * matrix_length];
        symbol.read_lag(0, &mut first_lag)?;
        let max_g = largest(&first_lag[..matrix_length]);
        symbol.traction_scale = largest(&first_lag[matrix_length..]) / max_g;
        if !symbol.traction_scale.is_finite() {
            return Err(Error::Singular { matrix: "coefficients of lag 0", order: symbol.order() });
        }
        let mut error = symbol.fit_tail()?;
        while error > TAIL_TOLERANCE && symbol.lag_count < MAX_EARLY_LAGS {
            symbol.lag_count *= 2;
            error = symbol.fit_tail()?;
        }
        if error.is_nan() || error > MAX_TAIL_ERROR {
            let reason = format!(
                "coefficients beyond lag {MAX_EARLY_LAGS} differ by {error:.0e} from smooth ones, which a search for growth needs"
            );
            return Err(Error::part("boundary kernel", reason));
        }
        symbol.classes = equal_entries(&first_lag, &symbol.late_coefficients);
        if !symbol.read_early()? {
            symbol.classes = (0..2 * matrix_length).map(|index| vec![(index, 1.0)]).collect();
            symbol.read_early()?;
        }
        let mut class_coefficients = vec![];
        for entries in symbol.late_coefficients.chunks_exact(2 * matrix_length) {
            for class in &symbol.classes {
                class_coefficients.push(entries[class[0].0]);
            }
        }
        symbol.late_coefficients = class_coefficients;
        Ok(symbol)
    }

    /// Reads the early lags; returns false if the entries of a class have different series.
    fn read_early(&mut self) -> Result<bool> {
        let mut entries = vec![0.0; self.stride()];
        self.early_values.clear();
        for lag in 0..self.lag_count {
            self.read_lag(lag, &mut entries)?;
            for class in &self.classes {
                let value = entries[class[0].0];
                if class.iter().any(|(index, sign)| entries[*index] != sign * value) {
                    return Ok(false);
                }
                self.early_values.push(value);
            }
        }
        Ok(true)
    }

    /// Replaces the boundary conditions; the coefficients do not change.
    pub(super) fn prescribe(&mut self, conditions: &[BoundaryCondition]) -> Result<()> {
        let segment_count = self.kernel.segments().len();
        same_length("boundary conditions", conditions.len(), segment_count)?;
        let flags = conditions
            .iter()
            .map(|condition| *condition == BoundaryCondition::PrescribedDisplacement);
        self.has_prescribed_displacement = flags.clone().chain(flags).collect();
        Ok(())
    }

    /// Order 2E of the matrices.
    pub(super) fn order(&self) -> usize {
        self.has_prescribed_displacement.len()
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

    /// Values n·(Gⁿ, Hⁿ) of a lag n, with G scaled.
    fn scaled_lag(&self, lag: usize) -> Result<Vec<f64>> {
        let stride = self.stride();
        let mut values = vec![0.0; stride];
        self.read_lag(lag, &mut values)?;
        for value in &mut values[..stride / 2] {
            *value *= self.traction_scale;
        }
        for value in &mut values {
            *value *= lag as f64;
        }
        Ok(values)
    }

    /// Interpolates n·(Gⁿ, Hⁿ) by a polynomial in N/n; returns its relative error between its points.
    fn fit_tail(&mut self) -> Result<f64> {
        let first_late_lag = self.lag_count as f64;
        let stride = self.stride();
        let mut matrix = vec![0.0; TAIL_POWERS * TAIL_POWERS];
        let mut samples = vec![];
        for (k, row) in matrix.chunks_exact_mut(TAIL_POWERS).enumerate() {
            let lag = interpolation_lag(first_late_lag, k as f64);
            let x = first_late_lag / lag as f64;
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
        self.late_coefficients = vec![0.0; TAIL_POWERS * stride];
        let mut column = [0.0; TAIL_POWERS];
        for entry in 0..stride {
            for (value, sample) in column.iter_mut().zip(&samples) {
                *value = sample[entry];
            }
            factor.solve(&mut column);
            for (p, value) in column.iter().enumerate() {
                self.late_coefficients[p * stride + entry] = *value;
            }
        }
        let largest_sample = samples.iter().map(|sample| largest(sample)).fold(0.0, f64::max);
        let mut error = 0.0_f64;
        for k in CHECKED_POINTS {
            let lag = interpolation_lag(first_late_lag, k);
            let x = first_late_lag / lag as f64;
            for (entry, exact) in self.scaled_lag(lag)?.iter().enumerate() {
                let mut interpolated_value = 0.0;
                for p in (0..TAIL_POWERS).rev() {
                    interpolated_value =
                        interpolated_value * x + self.late_coefficients[p * stride + entry];
                }
                error = error.max((interpolated_value - exact).abs());
            }
        }
        // Converts back to (Gⁿ, Hⁿ) = Σ c_p (N/n)^p /N, with G unscaled.
        for (index, value) in self.late_coefficients.iter_mut().enumerate() {
            let is_in_g = index % stride < stride / 2;
            *value /= if is_in_g { first_late_lag * self.traction_scale } else { first_late_lag };
        }
        // A kernel without late lags needs no interpolation.
        Ok(if largest_sample > 0.0 { error / largest_sample } else { 0.0 })
    }

    /// Adds the contribution of late lags to `sums`, one for each class.
    fn add_late(&self, zeta: Complex64, sums: &mut [Complex64]) {
        let tails = tail_sums(zeta, self.lag_count as f64);
        let powers = self.late_coefficients.chunks_exact(self.classes.len());
        for (tail, coefficients) in tails.iter().zip(powers) {
            for (sum, coefficient) in sums.iter_mut().zip(coefficients) {
                *sum += tail * coefficient;
            }
        }
    }

    /// Overwrites `symbols` with the symbols of G and H (2E × 2E each) at one ζ.
    pub(super) fn at(&self, zeta: Complex64, symbols: &mut Vec<Complex64>) -> Result<()> {
        let stride = self.stride();
        let mut kernel_symbols = vec![0.0; 2 * stride];
        let (g, h) = kernel_symbols.split_at_mut(stride);
        if self.kernel.symbol([zeta.re, zeta.im], g, h)?.is_some() {
            symbols.clear();
            symbols.extend(kernel_symbols.chunks_exact(2).map(|x| Complex64::new(x[0], x[1])));
            return Ok(());
        }
        let mut class_sums = vec![Complex64::default(); self.classes.len()];
        let mut power = Complex64::new(1.0, 0.0);
        for lag in self.early_values.chunks_exact(self.classes.len()) {
            for (sum, value) in class_sums.iter_mut().zip(lag) {
                *sum += power * value;
            }
            power *= zeta;
        }
        self.add_late(zeta, &mut class_sums);
        symbols.resize(stride, Complex64::default());
        for (class, value) in self.classes.iter().zip(class_sums) {
            for (index, sign) in class {
                symbols[*index] = value * sign;
            }
        }
        Ok(())
    }

    /// Overwrites `operator` with F, from the symbols of G and H.
    ///
    /// Its columns are in the order of the degrees of freedom.
    pub(super) fn operator(&self, symbols: &[Complex64], operator: &mut Vec<Complex64>) {
        let order = self.order();
        let matrix_length = order * order;
        operator.clear();
        for index in 0..matrix_length {
            operator.push(if self.has_prescribed_displacement[index % order] {
                -symbols[index] * self.traction_scale
            } else {
                symbols[matrix_length + index]
            });
        }
    }

    /// Operators at ζ = `radius` e^{iθ}, θ = 2πk/`point_count` for k = 0 … `point_count`/2, by FFT.
    pub(super) fn operators_on(&self, radius: f64, point_count: usize) -> Vec<Vec<Complex64>> {
        let order = self.order();
        let class_count = self.classes.len();
        let forward = RealPlanner::new().plan_fft_forward(point_count);
        let mut series = forward.make_input_vec();
        let mut spectrum = forward.make_output_vec();
        let mut scratch = forward.make_scratch_vec();
        let frequency_count = point_count / 2 + 1;
        let mut tails = vec![];
        for k in 0..frequency_count {
            let zeta = Complex64::from_polar(radius, TAU * k as f64 / point_count as f64);
            tails.push(tail_sums(zeta, self.lag_count as f64));
        }
        let mut operators = vec![vec![Complex64::default(); order * order]; frequency_count];
        for (index, class) in self.classes.iter().enumerate() {
            let entries = self.operator_entries(class);
            let early_values = self.early_values[index..].iter().step_by(class_count);
            if entries.is_empty() || early_values.clone().all(|value| *value == 0.0) {
                continue;
            }
            series.fill(0.0);
            let mut power = 1.0;
            for (n, value) in early_values.enumerate() {
                // The phase of ζⁿ repeats after `point_count` lags.
                series[n % point_count] += power * value;
                power *= radius;
            }
            // All lengths come from the plan.
            if forward.process_with_scratch(&mut series, &mut spectrum, &mut scratch).is_err() {
                continue;
            }
            for (k, operator) in operators.iter_mut().enumerate() {
                let late_sum: Complex64 = tails[k]
                    .iter()
                    .enumerate()
                    .map(|(p, tail)| tail * self.late_coefficients[p * class_count + index])
                    .sum();
                // The exponent of the transform has the opposite sign.
                let value = spectrum[k].conj() + late_sum;
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
        let matrix_length = order * order;
        let mut entries = vec![];
        for (index, sign) in class {
            let is_in_h = *index >= matrix_length;
            let entry = index % matrix_length;
            let is_prescribed = self.has_prescribed_displacement[entry % order];
            if is_prescribed != is_in_h {
                let factor = if is_prescribed { -self.traction_scale } else { 1.0 };
                entries.push((entry, sign * factor));
            }
        }
        entries
    }
}

/// Groups entries with the same first value and the same late coefficients, up to sign.
///
/// On a flat surface of equal elements there are few groups.
fn equal_entries(first_lag: &[f64], late_coefficients: &[f64]) -> Vec<Vec<(usize, f64)>> {
    let stride = first_lag.len();
    let mut class_of_key = HashMap::new();
    let mut classes: Vec<Vec<(usize, f64)>> = vec![];
    for (index, first_value) in first_lag.iter().enumerate() {
        let late_values = late_coefficients[index..].iter().step_by(stride).copied();
        let values = std::iter::once(*first_value).chain(late_values);
        let sign = values.clone().find(|value| *value != 0.0).map_or(1.0, f64::signum);
        // Positive and negative zero are the same value.
        let key: Vec<u64> = values.map(|value| (sign * value + 0.0).to_bits()).collect();
        match class_of_key.entry(key) {
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
