//! Passivity of a boundary equation with prescribed displacements: whether the soil can create energy.
//!
//! Tractions t and displacements u of the elements satisfy u = C(ζ) t with C = (Σ Hⁿζⁿ)⁻¹ Σ Gⁿζⁿ. Over a whole history,
//! Σ t·L·Δu = (1/2π) ∫ tᴴ Herm[(1−ζ) L C(ζ)] t dθ on |ζ| = 1 (Parseval), L the lengths of the elements. This sum is never
//! negative if the Hermitian part has no negative eigenvalue.
//!
//! Coefficients without a closed symbol are summed by parts: (1−ζ)⁴ Σ Gⁿζⁿ = Σ Δ⁴Gⁿ ζⁿ, whose terms fall as n⁻⁵ once the
//! waves have passed.

use basemat::bem::full_plane::BoundaryKernel;

use crate::dense::inverse;

/// Number of angles between 0 and π.
const ANGLE_COUNT: usize = 192;
/// Number of angles around an extreme eigenvalue in each refinement.
const REFINED_ANGLE_COUNT: usize = 24;
/// Order of the differences of the coefficients.
const DIFFERENCE_ORDER: i32 = 4;
/// Number of summed lags: at the smallest angle the last terms are 1e-5 of the first.
const LAG_COUNT: usize = 4000;
/// Halvings of an interval that contains an eigenvalue.
const BISECTION_COUNT: usize = 40;

/// Smallest eigenvalue over the circle, relative to the largest magnitude of any eigenvalue, and its angle (rad).
///
/// Waves must pass the elements within some hundred lags.
pub fn boundary_passivity(kernel: &dyn BoundaryKernel) -> [f64; 2] {
    let series = KernelSeries::new(kernel);
    let mut extremes = EigenvalueExtremes::default();
    let mut width = std::f64::consts::PI / ANGLE_COUNT as f64;
    let min_angle = 0.5 * width;
    for k in 0..ANGLE_COUNT {
        extremes.add(&series, width * (k as f64 + 0.5));
    }
    for _ in 0..2 {
        let first_angles = [extremes.smallest_angle - width, extremes.largest_angle - width];
        width *= 2.0 / REFINED_ANGLE_COUNT as f64;
        for k in 0..=REFINED_ANGLE_COUNT {
            for first in first_angles {
                let angle = first + width * k as f64;
                if angle >= min_angle {
                    extremes.add(&series, angle);
                }
            }
        }
    }
    [extremes.smallest_eigenvalue / extremes.max_magnitude, extremes.smallest_angle]
}

/// Extreme eigenvalues over the angles so far.
struct EigenvalueExtremes {
    smallest_eigenvalue: f64,
    smallest_angle: f64,
    /// Largest magnitude of an eigenvalue.
    max_magnitude: f64,
    largest_angle: f64,
}

impl Default for EigenvalueExtremes {
    fn default() -> Self {
        Self {
            smallest_eigenvalue: f64::INFINITY,
            smallest_angle: 0.0,
            max_magnitude: 0.0,
            largest_angle: 0.0,
        }
    }
}

impl EigenvalueExtremes {
    fn add(&mut self, series: &KernelSeries<'_>, angle: f64) {
        let matrix = series.work_matrix(angle);
        let order = 2 * series.order;
        let rows = matrix.chunks_exact(order);
        let bound = rows.map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
        let count_below = |shift: f64| eigenvalues_below(&matrix, order, shift);
        if self.smallest_eigenvalue > bound || count_below(self.smallest_eigenvalue) > 0 {
            self.smallest_eigenvalue =
                bisect(-bound, self.smallest_eigenvalue.min(bound), |x| count_below(x) > 0);
            self.smallest_angle = angle;
        }
        if count_below(self.max_magnitude) < order {
            self.max_magnitude = bisect(self.max_magnitude, bound, |x| count_below(x) == order);
            self.largest_angle = angle;
        }
        if count_below(-self.max_magnitude) > 0 {
            self.max_magnitude = -bisect(-bound, -self.max_magnitude, |x| count_below(x) > 0);
            self.largest_angle = angle;
        }
    }
}

/// Values of G and H on the unit circle, complex numbers as pairs.
struct ComplexMatrices {
    g: Vec<f64>,
    h: Vec<f64>,
}

/// Power series of G and H.
struct KernelSeries<'a> {
    kernel: &'a dyn BoundaryKernel,
    /// Number of components.
    order: usize,
    /// Differences of the coefficients of all lags, G before H; none if the kernel has a closed symbol.
    differences: Vec<f64>,
}

impl<'a> KernelSeries<'a> {
    fn new(kernel: &'a dyn BoundaryKernel) -> Self {
        let order = 2 * kernel.segments().len();
        let entry_count = order * order;
        let mut g = vec![0.0; 2 * entry_count];
        let mut h = vec![0.0; 2 * entry_count];
        let mut differences = vec![];
        if kernel.symbol([-1.0, 0.0], &mut g, &mut h).unwrap().is_none() {
            differences = vec![0.0; 2 * entry_count * LAG_COUNT];
            for (lag, coefficients) in differences.chunks_exact_mut(2 * entry_count).enumerate() {
                let (g, h) = coefficients.split_at_mut(entry_count);
                kernel.coefficients(lag, g, h).unwrap();
            }
            for _ in 0..DIFFERENCE_ORDER {
                for i in (2 * entry_count..differences.len()).rev() {
                    differences[i] -= differences[i - 2 * entry_count];
                }
            }
        }
        Self { kernel, order, differences }
    }

    /// G and H at ζ = e^{iθ}.
    fn at(&self, angle: f64) -> ComplexMatrices {
        let entry_count = self.order * self.order;
        let mut g = vec![0.0; 2 * entry_count];
        let mut h = vec![0.0; 2 * entry_count];
        let zeta = [angle.cos(), angle.sin()];
        if self.kernel.symbol(zeta, &mut g, &mut h).unwrap().is_none() {
            let distance = 2.0 * (0.5 * angle).sin();
            for (lag, coefficients) in self.differences.chunks_exact(2 * entry_count).enumerate() {
                // ζⁿ/(1−ζ)⁴, 1 − ζ = 2 sin(θ/2) e^{i(θ−π)/2}.
                let phase = angle * lag as f64
                    - 0.5 * f64::from(DIFFERENCE_ORDER) * (angle - std::f64::consts::PI);
                let modulus = distance.powi(-DIFFERENCE_ORDER);
                let factor = [modulus * phase.cos(), modulus * phase.sin()];
                add_multiple(&mut g, &coefficients[..entry_count], factor);
                add_multiple(&mut h, &coefficients[entry_count..], factor);
            }
        }
        ComplexMatrices { g, h }
    }

    /// Hermitian part of (1−ζ) L C as a symmetric real matrix, in which each eigenvalue appears twice.
    fn work_matrix(&self, angle: f64) -> Vec<f64> {
        let n = self.order;
        let order = 2 * n;
        let matrices = self.at(angle);
        let h_inverse = inverse(&real_form(&matrices.h, n), order);
        let compliance = product(&h_inverse, &real_form(&matrices.g, n), order);
        let segments = self.kernel.segments();
        let re = 1.0 - angle.cos();
        let im = -angle.sin();
        let mut product_matrix = vec![0.0; order * order];
        for i in 0..n {
            let length = segments[i % segments.len()].length();
            for j in 0..order {
                let a = compliance[i * order + j];
                let b = compliance[(n + i) * order + j];
                product_matrix[i * order + j] = length * (re * a - im * b);
                product_matrix[(n + i) * order + j] = length * (re * b + im * a);
            }
        }
        (0..order * order)
            .map(|k| 0.5 * (product_matrix[k] + product_matrix[k % order * order + k / order]))
            .collect()
    }
}

/// Adds real numbers times a complex factor to complex ones.
fn add_multiple(sum: &mut [f64], values: &[f64], [re, im]: [f64; 2]) {
    for (sum, value) in sum.chunks_exact_mut(2).zip(values) {
        sum[0] += re * value;
        sum[1] += im * value;
    }
}

/// A complex matrix of order n as a real one: [[Re, −Im], [Im, Re]].
fn real_form(complex: &[f64], n: usize) -> Vec<f64> {
    let order = 2 * n;
    let mut matrix = vec![0.0; order * order];
    for (position, pair) in complex.chunks_exact(2).enumerate() {
        let i = position / n;
        let j = position % n;
        matrix[i * order + j] = pair[0];
        matrix[(n + i) * order + n + j] = pair[0];
        matrix[i * order + n + j] = -pair[1];
        matrix[(n + i) * order + j] = pair[1];
    }
    matrix
}

fn product(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let mut product = vec![0.0; n * n];
    for (product_row, a_row) in product.chunks_exact_mut(n).zip(a.chunks_exact(n)) {
        for (factor, b_row) in a_row.iter().zip(b.chunks_exact(n)) {
            product_row.iter_mut().zip(b_row).for_each(|(sum, x)| *sum += factor * x);
        }
    }
    product
}

/// Number of eigenvalues of a symmetric matrix below `shift`: its negative pivots (Sylvester).
fn eigenvalues_below(matrix: &[f64], n: usize, shift: f64) -> usize {
    let mut a = matrix.to_vec();
    (0..n).for_each(|i| a[i * n + i] -= shift);
    for k in 0..n {
        let (eliminated, remaining) = a.split_at_mut((k + 1) * n);
        let pivot_row = &eliminated[k * n..];
        for row in remaining.chunks_exact_mut(n) {
            let factor = row[k] / pivot_row[k];
            row[k..].iter_mut().zip(&pivot_row[k..]).for_each(|(x, pivot)| *x -= factor * pivot);
        }
    }
    (0..n).filter(|i| a[i * n + i] < 0.0).count()
}

/// Number between `low` and `high` from which on a condition holds.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..BISECTION_COUNT {
        let middle = 0.5 * (low + high);
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}
