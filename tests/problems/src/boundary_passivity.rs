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

/// Angles on the half circle, and around the angles of extremes.
const ANGLES: usize = 192;
const AROUND: usize = 24;
/// Order of the differences, and number of lags: the last terms are 1e-5 of the first at the smallest angle.
const PARTS: i32 = 4;
const LAGS: usize = 4000;
/// Halvings of an interval that holds an eigenvalue.
const HALVINGS: usize = 40;

/// Smallest eigenvalue over the circle, relative to the largest magnitude of any eigenvalue, and its angle (rad).
///
/// Waves must pass the elements within some hundred lags.
pub fn boundary_passivity(kernel: &dyn BoundaryKernel) -> [f64; 2] {
    let series = Series::new(kernel);
    let (mut least, mut largest) = (f64::INFINITY, 0.0);
    // Angles of both.
    let mut places = [0.0; 2];
    let mut see = |angle: f64| {
        let matrix = series.work(angle);
        let order = 2 * series.order;
        let rows = matrix.chunks_exact(order);
        let bound = rows.map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
        let below = |shift: f64| eigenvalues_below(&matrix, order, shift);
        if least > bound || below(least) > 0 {
            (least, places[0]) = (edge(-bound, least.min(bound), |x| below(x) > 0), angle);
        }
        if below(largest) < order {
            (largest, places[1]) = (edge(largest, bound, |x| below(x) == order), angle);
        }
        if below(-largest) > 0 {
            (largest, places[1]) = (-edge(-bound, -largest, |x| below(x) > 0), angle);
        }
        places
    };
    let mut width = std::f64::consts::PI / ANGLES as f64;
    let smallest = 0.5 * width;
    let mut found = (0..ANGLES).fold([0.0; 2], |_, k| see(width * (k as f64 + 0.5)));
    for _ in 0..2 {
        let around = found.map(|place| place - width);
        width *= 2.0 / AROUND as f64;
        let angles = (0..=AROUND).flat_map(|k| around.map(|first| first + width * k as f64));
        found = angles.filter(|angle| *angle >= smallest).fold(found, |_, angle| see(angle));
    }
    [least / largest, found[0]]
}

/// Power series of G and H.
struct Series<'a> {
    kernel: &'a dyn BoundaryKernel,
    /// Number of components.
    order: usize,
    /// Differences of the coefficients of all lags, G before H; none if the kernel has a closed symbol.
    differences: Vec<f64>,
}

impl<'a> Series<'a> {
    fn new(kernel: &'a dyn BoundaryKernel) -> Self {
        let order = 2 * kernel.segments().len();
        let size = order * order;
        let (mut g, mut h) = (vec![0.0; 2 * size], vec![0.0; 2 * size]);
        let mut differences = vec![];
        if kernel.symbol([-1.0, 0.0], &mut g, &mut h).unwrap().is_none() {
            differences = vec![0.0; 2 * size * LAGS];
            for (lag, both) in differences.chunks_exact_mut(2 * size).enumerate() {
                let (g, h) = both.split_at_mut(size);
                kernel.coefficients(lag, g, h).unwrap();
            }
            for _ in 0..PARTS {
                for i in (2 * size..differences.len()).rev() {
                    differences[i] -= differences[i - 2 * size];
                }
            }
        }
        Self { kernel, order, differences }
    }

    /// G and H at ζ = e^{iθ}: real and imaginary part alternate.
    fn at(&self, angle: f64) -> [Vec<f64>; 2] {
        let size = self.order * self.order;
        let (mut g, mut h) = (vec![0.0; 2 * size], vec![0.0; 2 * size]);
        let [re, im] = [angle.cos(), angle.sin()];
        if self.kernel.symbol([re, im], &mut g, &mut h).unwrap().is_none() {
            let distance = 2.0 * (0.5 * angle).sin();
            for (lag, both) in self.differences.chunks_exact(2 * size).enumerate() {
                // ζⁿ/(1−ζ)⁴, 1 − ζ = 2 sin(θ/2) e^{i(θ−π)/2}.
                let turned =
                    angle * lag as f64 - 0.5 * f64::from(PARTS) * (angle - std::f64::consts::PI);
                let factor = distance.powi(-PARTS);
                let [re, im] = [factor * turned.cos(), factor * turned.sin()];
                let (of_g, of_h) = both.split_at(size);
                for (sum, own) in [(&mut g, of_g), (&mut h, of_h)] {
                    for (sum, own) in sum.chunks_exact_mut(2).zip(own) {
                        sum[0] += re * own;
                        sum[1] += im * own;
                    }
                }
            }
        }
        [g, h]
    }

    /// Hermitian part of (1−ζ) L C as a symmetric real matrix, in which each eigenvalue is twice.
    fn work(&self, angle: f64) -> Vec<f64> {
        let (n, order) = (self.order, 2 * self.order);
        // A complex matrix as a real one: [[Re, −Im], [Im, Re]].
        let real = |own: &[f64]| {
            let mut matrix = vec![0.0; order * order];
            for (place, pair) in own.chunks_exact(2).enumerate() {
                let (i, j) = (place / n, place % n);
                (matrix[i * order + j], matrix[(n + i) * order + n + j]) = (pair[0], pair[0]);
                (matrix[i * order + n + j], matrix[(n + i) * order + j]) = (-pair[1], pair[1]);
            }
            matrix
        };
        let [g, h] = self.at(angle).map(|own| real(&own));
        let solved = product(&inverse(&h, order), &g, order);
        let segments = self.kernel.segments();
        let [re, im] = [1.0 - angle.cos(), -angle.sin()];
        let mut own = vec![0.0; order * order];
        for i in 0..n {
            let length = segments[i % segments.len()].length();
            for j in 0..order {
                let [a, b] = [solved[i * order + j], solved[(n + i) * order + j]];
                own[i * order + j] = length * (re * a - im * b);
                own[(n + i) * order + j] = length * (re * b + im * a);
            }
        }
        let entry = |k: usize| 0.5 * (own[k] + own[k % order * order + k / order]);
        (0..order * order).map(entry).collect()
    }
}

fn product(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let mut found = vec![0.0; n * n];
    for (row, own) in found.chunks_exact_mut(n).zip(a.chunks_exact(n)) {
        for (factor, line) in own.iter().zip(b.chunks_exact(n)) {
            row.iter_mut().zip(line).for_each(|(sum, x)| *sum += factor * x);
        }
    }
    found
}

/// Number of eigenvalues of a symmetric matrix below `shift`: its negative pivots (Sylvester).
fn eigenvalues_below(matrix: &[f64], n: usize, shift: f64) -> usize {
    let mut a = matrix.to_vec();
    (0..n).for_each(|i| a[i * n + i] -= shift);
    for k in 0..n {
        let (done, rest) = a.split_at_mut((k + 1) * n);
        let row = &done[k * n..];
        for line in rest.chunks_exact_mut(n) {
            let factor = line[k] / row[k];
            line[k..].iter_mut().zip(&row[k..]).for_each(|(x, own)| *x -= factor * own);
        }
    }
    (0..n).filter(|i| a[i * n + i] < 0.0).count()
}

/// Place between `low` and `high` from which on a condition holds.
fn edge(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}
