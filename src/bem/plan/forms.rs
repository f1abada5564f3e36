//! Form factors of cells in the wavenumber domain: means over the direction of the wavenumber.
//!
//! For a wavenumber k in the direction θ, cells of sides a and b, and a receiver at (x, y) from the source, with
//! S = (a b sinc(½ka cos θ) sinc(½kb sin θ))², c, s = cos, sin(kx cos θ) and c′, s′ = cos, sin(ky sin θ),
//!
//! g₀ = ⟨S c c′⟩,   `g_cc` = ⟨cos²θ S c c′⟩,   `g_ss` = g₀ − `g_cc`,   `g_cs` = −⟨cos θ sin θ S s s′⟩,
//! `g_c` = ⟨cos θ S s c′⟩,   `g_s` = ⟨sin θ S c s′⟩
//!
//! Form factors depend on the lattice alone. Their integrands are entire and periodic in θ. The midpoint rule therefore
//! converges once its number of points exceeds the largest phase kD, D the diagonal of the lattice, by a few times
//! (kD)^⅓, the width of the transition of Bessel functions.
//!
//! Their integrals over k are integrals of static kernels over two cells, in closed form. They are second
//! differences in x and in y (steps of the pitch, weights 1, −2, 1) of functions whose fourth derivative ∂⁴/∂x²∂y²
//! is the kernel, with (x, y) from one cell to the other.

use crate::geometry::Lattice;
use crate::linalg::add_combined_rows;

/// Number of form factors of a pair of cells.
pub(super) const FORM_COUNT: usize = 6;
/// Number of transition widths (kD)^⅓ beyond the largest phase with which means converge to rounding.
const TRANSITION_WIDTHS: f64 = 8.0;
/// Number of directions of a circle at the wavenumber zero, with which means converge to rounding.
const MIN_DIRECTION_COUNT: f64 = 40.0;
/// Largest x at which sin x/x equals its first two series terms to rounding.
const MAX_SINC_SERIES_ARGUMENT: f64 = 1e-4;

/// Form factors of all classes of a lattice, as sums over directions.
#[derive(Debug)]
pub(super) struct AngularMeans {
    /// Sides of a cell, m.
    pitch: [f64; 2],
    /// Diagonal of all cells, m.
    diagonal: f64,
    offset_counts: [usize; 2],
    classes: Vec<[usize; 2]>,
    /// Weighted factors along x of the terms even and odd in y, direction by direction.
    x_factors: [Vec<f64>; 2],
    /// Factors along y of these terms, c′ and s′.
    y_factors: [Vec<f64>; 2],
    /// Sums over directions of the factors' products.
    product_sums: [Vec<f64>; 2],
    /// Form by form, all classes.
    values: Vec<f64>,
}

impl AngularMeans {
    /// Buffers for the means of a lattice.
    pub(super) fn new(lattice: &Lattice) -> Self {
        let offset_counts = lattice.offset_counts();
        let classes = lattice.classes();
        Self {
            pitch: lattice.pitch,
            diagonal: lattice.diagonal(),
            offset_counts,
            x_factors: [vec![], vec![]],
            y_factors: [vec![], vec![]],
            product_sums: [3, 2]
                .map(|factor_count| vec![0.0; factor_count * offset_counts[0] * offset_counts[1]]),
            values: vec![0.0; FORM_COUNT * classes.len()],
            classes,
        }
    }

    /// Number of directions in a quarter circle that resolve the means at the wavenumber `k`.
    pub(super) fn direction_count(&self, k: f64) -> usize {
        let max_phase = k * self.diagonal;
        let margin = TRANSITION_WIDTHS * max_phase.cbrt() + MIN_DIRECTION_COUNT;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let count = (0.25 * (max_phase + margin)).ceil() as usize;
        count
    }

    /// Means at the wavenumber `k`, form by form, all classes (m⁴).
    pub(super) fn at(&mut self, k: f64) -> &[f64] {
        self.sum_directions(k);
        let row_count = self.offset_counts[1];
        let cell_count = self.offset_counts[0] * row_count;
        let class_count = self.classes.len();
        for (class, [i, j]) in self.classes.iter().enumerate() {
            let cell = i * row_count + j;
            let g_0 = self.product_sums[0][cell];
            let g_cc = self.product_sums[0][cell_count + cell];
            let g_c = self.product_sums[0][2 * cell_count + cell];
            let g_cs = self.product_sums[1][cell];
            let g_s = self.product_sums[1][cell_count + cell];
            for (form, value) in [g_0, g_cc, g_0 - g_cc, g_cs, g_c, g_s].into_iter().enumerate() {
                self.values[form * class_count + class] = value;
            }
        }
        &self.values
    }

    /// Overwrites the product sums with sums over directions at the wavenumber `k`.
    fn sum_directions(&mut self, k: f64) {
        let column_count = self.offset_counts[0];
        let row_count = self.offset_counts[1];
        let direction_count = self.direction_count(k);
        for factors in self.x_factors.iter_mut().chain(&mut self.y_factors) {
            factors.clear();
        }
        for direction in 0..direction_count {
            let angle =
                std::f64::consts::FRAC_PI_2 * (direction as f64 + 0.5) / direction_count as f64;
            let sin = angle.sin();
            let cos = angle.cos();
            let half_phases = [0.5 * k * self.pitch[0] * cos, 0.5 * k * self.pitch[1] * sin];
            let cell_integral: f64 = half_phases
                .into_iter()
                .zip(self.pitch)
                .map(|(half_phase, side)| side * sinc(half_phase))
                .product();
            let weight = cell_integral * cell_integral / direction_count as f64;
            let x_waves = cosines_and_sines(2.0 * half_phases[0], column_count);
            let even_factors = &mut self.x_factors[0];
            even_factors.extend(x_waves.iter().map(|[c, _]| weight * c));
            even_factors.extend(x_waves.iter().map(|[c, _]| cos * cos * (weight * c)));
            even_factors.extend(x_waves.iter().map(|[_, s]| cos * (weight * s)));
            let odd_factors = &mut self.x_factors[1];
            odd_factors.extend(x_waves.iter().map(|[_, s]| -cos * sin * (weight * s)));
            odd_factors.extend(x_waves.iter().map(|[c, _]| sin * (weight * c)));
            for [c, s] in cosines_and_sines(2.0 * half_phases[1], row_count) {
                self.y_factors[0].push(c);
                self.y_factors[1].push(s);
            }
        }
        for parity in 0..2 {
            let product_sums = &mut self.product_sums[parity];
            product_sums.fill(0.0);
            add_combined_rows(
                &self.x_factors[parity],
                &self.y_factors[parity],
                row_count,
                1.0,
                product_sums,
            );
        }
    }
}

/// Values cos nx and sin nx for n = 0, 1, … below `count`.
fn cosines_and_sines(x: f64, count: usize) -> Vec<[f64; 2]> {
    let sin = x.sin();
    let cos = x.cos();
    let mut values = Vec::with_capacity(count);
    let mut c = 1.0;
    let mut s = 0.0;
    for _ in 0..count {
        values.push([c, s]);
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
    }
    values
}

/// Function sin x/x.
fn sinc(x: f64) -> f64 {
    if x.abs() < MAX_SINC_SERIES_ARGUMENT { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

/// Integrals of the six form factors over all wavenumbers, m³.
///
/// They equal the integrals of the static kernels 1/r, y²/r³, x²/r³, −xy/r³, x/r² and y/r² over two cells of `pitch`,
/// `offset` cells apart. The forms are g₀, `g_cc`, `g_ss`, `g_cs`, `g_c`, `g_s`.
pub(super) fn integrals(pitch: [f64; 2], offset: [usize; 2]) -> [f64; FORM_COUNT] {
    let mut sums = [0.0; FORM_COUNT];
    // Steps of the second differences, each with its weight.
    let weighted_steps = [(-1.0, 1.0), (0.0, -2.0), (1.0, 1.0)];
    for (x_step, x_weight) in weighted_steps {
        for (y_step, y_weight) in weighted_steps {
            let x = pitch[0] * (offset[0] as f64 + x_step);
            let y = pitch[1] * (offset[1] as f64 + y_step);
            for (sum, value) in sums.iter_mut().zip(kernel_primitives(x, y)) {
                *sum += x_weight * y_weight * value;
            }
        }
    }
    // Integrals odd in x or y are exactly zero at an offset of zero.
    let x_factor = if offset[0] == 0 { 0.0 } else { 1.0 };
    let y_factor = if offset[1] == 0 { 0.0 } else { 1.0 };
    let parity_factors = [1.0, 1.0, 1.0, x_factor * y_factor, x_factor, y_factor];
    std::array::from_fn(|form| parity_factors[form] * sums[form])
}

/// Functions whose derivatives ∂⁴/∂x²∂y² are the six static kernels of [`integrals`].
fn kernel_primitives(x: f64, y: f64) -> [f64; FORM_COUNT] {
    let r = x.hypot(y);
    let cube = r * r * r;
    let x_asinh = quotient(x, y.abs()).asinh();
    let y_asinh = quotient(y, x.abs()).asinh();
    let x_term = 0.5 * x * x * y * y_asinh;
    let y_term = 0.5 * y * y * x * x_asinh;
    let inverse = x_term + y_term - cube / 6.0;
    let yy = cube / 6.0 + x_term - 0.5 * x * x * r;
    let xx = cube / 6.0 + y_term - 0.5 * y * y * r;
    let xy = x * y * r / 3.0 + (y * y * y * x_asinh + x * x * x * y_asinh) / 6.0;
    let logarithm = if r == 0.0 { 0.0 } else { r.ln() };
    [inverse, yy, xx, xy, shear_primitive(x, y, logarithm), shear_primitive(y, x, logarithm)]
}

/// Fourth primitive of x/r²; `logarithm`: ln r.
fn shear_primitive(x: f64, y: f64, logarithm: f64) -> f64 {
    (0.5 * x * y * y - x * x * x / 6.0) * logarithm
        + 0.5 * x * x * y * quotient(y, x).atan()
        + y * y * y * quotient(x, y).atan() / 6.0
}

/// Quotient a/b, or 0 for b = 0: its asinh or atan is then multiplied by zero.
fn quotient(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a / b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::gauss;

    /// Means equal their definitions, with sums over the whole circle.
    #[test]
    fn means_agree_with_sums_over_many_directions() {
        for lattice in [
            Lattice { pitch: [0.5, 0.5], counts: [4, 6] },
            Lattice { pitch: [0.3, 0.7], counts: [5, 3] },
        ] {
            let classes = lattice.classes();
            let mut means = AngularMeans::new(&lattice);
            let a = lattice.pitch[0];
            let b = lattice.pitch[1];
            let area_squared: f64 = (a * b).powi(2);
            for k in [1e-7, 0.3, 4.0, 31.0, 250.0] {
                let mut sums = vec![0.0; FORM_COUNT * classes.len()];
                let point_count = 6000;
                for n in 0..point_count {
                    let angle =
                        std::f64::consts::TAU * (f64::from(n) + 0.3) / f64::from(point_count);
                    let sin = angle.sin();
                    let cos = angle.cos();
                    let weight =
                        area_squared * (sinc(0.5 * k * a * cos) * sinc(0.5 * k * b * sin)).powi(2);
                    for (class, [i, j]) in classes.iter().enumerate() {
                        let x_phase = k * a * cos * *i as f64;
                        let y_phase = k * b * sin * *j as f64;
                        let even_product = x_phase.cos() * y_phase.cos();
                        let even_products =
                            [even_product, cos * cos * even_product, sin * sin * even_product];
                        let odd_products = [
                            -cos * sin * x_phase.sin() * y_phase.sin(),
                            cos * x_phase.sin() * y_phase.cos(),
                            sin * x_phase.cos() * y_phase.sin(),
                        ];
                        for form in 0..FORM_COUNT {
                            let value =
                                if form < 3 { even_products[form] } else { odd_products[form - 3] };
                            sums[form * classes.len() + class] +=
                                weight * value / f64::from(point_count);
                        }
                    }
                }
                for (computed, expected) in means.at(k).iter().zip(sums) {
                    assert!(
                        (computed - expected).abs() < 2e-13 * area_squared,
                        "{k} {computed} {expected}"
                    );
                }
            }
        }
    }

    /// For cells apart, closed forms agree with Gauss integrals over the distance, weighted by the cells' overlap.
    #[test]
    fn closed_forms_are_the_integrals() {
        let rule = gauss::largest_rule();
        let pitch = [0.7_f64, 0.4];
        for offset in [[2, 0], [0, 3], [2, 2], [5, 3], [9, 2]] {
            let mut sums = [0.0; FORM_COUNT];
            for (u, x_weight) in rule.points_on_unit_interval() {
                for (v, y_weight) in rule.points_on_unit_interval() {
                    // The overlap is a hat function, whose two sides are integrated separately.
                    for [x_sign, y_sign] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
                        let x = pitch[0] * (offset[0] as f64 + x_sign * u);
                        let y = pitch[1] * (offset[1] as f64 + y_sign * v);
                        let r = x.hypot(y);
                        let area_squared = (pitch[0] * pitch[1]).powi(2);
                        let weight = x_weight * y_weight * (1.0 - u) * (1.0 - v) * area_squared;
                        let cube = r.powi(3);
                        let kernels = [
                            1.0 / r,
                            y * y / cube,
                            x * x / cube,
                            -x * y / cube,
                            x / r / r,
                            y / r / r,
                        ];
                        for (sum, kernel) in sums.iter_mut().zip(kernels) {
                            *sum += weight * kernel;
                        }
                    }
                }
            }
            let max_integral = integrals(pitch, [0, 0])[0];
            for (computed, expected) in integrals(pitch, offset).into_iter().zip(sums) {
                let error = (computed - expected).abs() / max_integral;
                assert!(error < 1e-11, "{offset:?} {computed} {expected} {error:e}");
            }
        }
    }

    /// Integrals over quarter cells sum up to that of the cell; 1/r = x²/r³ + y²/r³; a unit square has the known value.
    #[test]
    fn integrals_of_a_cell_are_sums_of_parts() {
        let pitch = [0.7, 0.4];
        let half_pitch = [0.35, 0.2];
        for offset in [[0_usize, 0], [1, 0], [0, 1], [1, 1]] {
            let mut sums = [0.0; FORM_COUNT];
            for (i, x_count) in [(-1, 1.0), (0, 2.0), (1, 1.0)] {
                for (j, y_count) in [(-1, 1.0), (0, 2.0), (1, 1.0)] {
                    let half_offset =
                        [i + 2 * offset[0].cast_signed(), j + 2 * offset[1].cast_signed()];
                    let axis_signs = half_offset.map(|n| if n < 0 { -1.0 } else { 1.0 });
                    let part = integrals(half_pitch, half_offset.map(isize::unsigned_abs));
                    let form_signs = [
                        1.0,
                        1.0,
                        1.0,
                        axis_signs[0] * axis_signs[1],
                        axis_signs[0],
                        axis_signs[1],
                    ];
                    for form in 0..FORM_COUNT {
                        sums[form] += x_count * y_count * form_signs[form] * part[form];
                    }
                }
            }
            let whole_integrals = integrals(pitch, offset);
            for (computed, expected) in whole_integrals.iter().zip(sums) {
                assert!((computed - expected).abs() < 1e-14, "{offset:?} {computed} {expected}");
            }
            assert!((whole_integrals[0] - whole_integrals[1] - whole_integrals[2]).abs() < 1e-15);
        }
        let unit_square = integrals([1.0, 1.0], [0, 0]);
        let expected = 4.0 * (1.0_f64.asinh() - (2.0_f64.sqrt() - 1.0) / 3.0);
        assert!((unit_square[0] - expected).abs() < 1e-14, "{}", unit_square[0]);
        assert_eq!(unit_square[3..], [0.0; 3]);
    }
}
