//! Form factors of cells in the wavenumber domain: means over the direction of the wavenumber.
//!
//! For a wavenumber k in the direction θ, cells of sides a and b, and a receiver at (x, y) from the source, with
//! S = (a b sinc(½ka cos θ) sinc(½kb sin θ))², c, s = cos, sin(kx cos θ) and c′, s′ = cos, sin(ky sin θ),
//!
//! g₀ = ⟨S c c′⟩,   `g_cc` = ⟨cos²θ S c c′⟩,   `g_ss` = g₀ − `g_cc`,   `g_cs` = −⟨cos θ sin θ S s s′⟩,
//! `g_c` = ⟨cos θ S s c′⟩,   `g_s` = ⟨sin θ S c s′⟩
//!
//! They depend on the lattice alone. The integrands are entire and periodic, so the midpoint rule converges as
//! soon as it has as many points as they turn, and a few more for the transition of Bessel functions, kD^⅓ wide.
//!
//! Their integrals over k are integrals of static kernels over two cells, in closed form. They are second
//! differences in x and in y (steps of the pitch, weights 1, −2, 1) of functions whose fourth derivative ∂⁴/∂x²∂y²
//! is the kernel, with (x, y) from one cell to the other.

use crate::geometry::Lattice;
use crate::linalg::add_combined_rows;

/// Number of form factors of a pair of cells.
pub(super) const FORM_COUNT: usize = 6;

/// Means over directions for all classes of a lattice.
#[derive(Debug)]
pub(super) struct AngularMeans {
    pitch: [f64; 2],
    diagonal: f64,
    extent: [usize; 2],
    classes: Vec<[usize; 2]>,
    /// Factors along x, weighted, of the terms that are even and odd in y: direction by direction.
    x_factors: [Vec<f64>; 2],
    /// Factors along y of these terms, c′ and s′.
    y_factors: [Vec<f64>; 2],
    /// Products of the factors along x and along y.
    sums: [Vec<f64>; 2],
    /// Form by form, all classes.
    values: Vec<f64>,
}

impl AngularMeans {
    /// Buffers for the means of a lattice.
    pub(super) fn new(lattice: &Lattice) -> Self {
        let extent = lattice.extent();
        let classes = lattice.classes();
        Self {
            pitch: lattice.pitch,
            diagonal: lattice.diagonal(),
            extent,
            x_factors: [vec![], vec![]],
            y_factors: [vec![], vec![]],
            sums: [3, 2].map(|factors| vec![0.0; factors * extent[0] * extent[1]]),
            values: vec![0.0; FORM_COUNT * classes.len()],
            classes,
        }
    }

    /// Number of directions in a quarter that resolve the means at the wavenumber `k`.
    pub(super) fn directions(&self, k: f64) -> usize {
        let turn = k * self.diagonal;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let count = (0.25 * (turn + 8.0 * turn.cbrt() + 40.0)).ceil() as usize;
        count
    }

    /// Means at the wavenumber `k`, form by form, all classes (m⁴).
    pub(super) fn at(&mut self, k: f64) -> &[f64] {
        let columns = self.extent[0];
        let rows = self.extent[1];
        let count = self.directions(k);
        for list in self.x_factors.iter_mut().chain(&mut self.y_factors) {
            list.clear();
        }
        for direction in 0..count {
            let angle = std::f64::consts::FRAC_PI_2 * (direction as f64 + 0.5) / count as f64;
            let sin = angle.sin();
            let cos = angle.cos();
            let half_phases = [0.5 * k * self.pitch[0] * cos, 0.5 * k * self.pitch[1] * sin];
            let size: f64 = half_phases
                .into_iter()
                .zip(self.pitch)
                .map(|(half_phase, side)| side * sinc(half_phase))
                .product();
            let weight = size * size / count as f64;
            let x_waves = cosines_and_sines(2.0 * half_phases[0], columns);
            let even = &mut self.x_factors[0];
            even.extend(x_waves.iter().map(|[c, _]| weight * c));
            even.extend(x_waves.iter().map(|[c, _]| cos * cos * (weight * c)));
            even.extend(x_waves.iter().map(|[_, s]| cos * (weight * s)));
            let odd = &mut self.x_factors[1];
            odd.extend(x_waves.iter().map(|[_, s]| -cos * sin * (weight * s)));
            odd.extend(x_waves.iter().map(|[c, _]| sin * (weight * c)));
            for [c, s] in cosines_and_sines(2.0 * half_phases[1], rows) {
                self.y_factors[0].push(c);
                self.y_factors[1].push(s);
            }
        }
        for ((sum, x), y) in self.sums.iter_mut().zip(&self.x_factors).zip(&self.y_factors) {
            sum.fill(0.0);
            add_combined_rows(x, y, rows, 1.0, sum);
        }
        let size = columns * rows;
        let class_count = self.classes.len();
        for (class, [i, j]) in self.classes.iter().enumerate() {
            let place = i * rows + j;
            let g_0 = self.sums[0][place];
            let g_cc = self.sums[0][size + place];
            let g_c = self.sums[0][2 * size + place];
            let g_cs = self.sums[1][place];
            let g_s = self.sums[1][size + place];
            for (form, value) in [g_0, g_cc, g_0 - g_cc, g_cs, g_c, g_s].into_iter().enumerate() {
                self.values[form * class_count + class] = value;
            }
        }
        &self.values
    }
}

/// cos nx and sin nx for n = 0, 1, … below `count`.
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

/// sin x/x.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

// Integrals of the forms over all wavenumbers.

/// Integrals over two cells of `pitch`, `offset` cells apart, of six static kernels.
///
/// 1/r, y²/r³, x²/r³, −xy/r³ and x/r², y/r² (m³ each); they equal the integrals of the forms g₀, `g_cc`, `g_ss`,
/// `g_cs`, `g_c`, `g_s` over k.
pub(super) fn integrals(pitch: [f64; 2], offset: [usize; 2]) -> [f64; FORM_COUNT] {
    let mut sums = [0.0; FORM_COUNT];
    // Weights of the second differences.
    let steps = [(-1.0, 1.0), (0.0, -2.0), (1.0, 1.0)];
    for (right, x_weight) in steps {
        for (away, y_weight) in steps {
            let x = pitch[0] * (offset[0] as f64 + right);
            let y = pitch[1] * (offset[1] as f64 + away);
            for (sum, value) in sums.iter_mut().zip(kernel_primitives(x, y)) {
                *sum += x_weight * y_weight * value;
            }
        }
    }
    // Odd integrals vanish exactly at an offset of zero.
    let odd_x = if offset[0] == 0 { 0.0 } else { 1.0 };
    let odd_y = if offset[1] == 0 { 0.0 } else { 1.0 };
    let factors = [1.0, 1.0, 1.0, odd_x * odd_y, odd_x, odd_y];
    std::array::from_fn(|form| factors[form] * sums[form])
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

/// Primitive of x/r², with ln r.
fn shear_primitive(x: f64, y: f64, logarithm: f64) -> f64 {
    (0.5 * x * y * y - x * x * x / 6.0) * logarithm
        + 0.5 * x * x * y * quotient(y, x).atan()
        + y * y * y * quotient(x, y).atan() / 6.0
}

/// a/b, or 0 for b = 0, where the quotient's asinh or atan has a factor of zero.
fn quotient(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a / b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::gauss;

    /// The definitions, over the whole circle.
    #[test]
    fn means_are_those_of_many_directions() {
        for lattice in [
            Lattice { pitch: [0.5, 0.5], counts: [4, 6] },
            Lattice { pitch: [0.3, 0.7], counts: [5, 3] },
        ] {
            let classes = lattice.classes();
            let mut means = AngularMeans::new(&lattice);
            let a = lattice.pitch[0];
            let b = lattice.pitch[1];
            let size = (a * b).powi(2);
            for k in [1e-7, 0.3, 4.0, 31.0, 250.0] {
                let mut sums = vec![0.0; FORM_COUNT * classes.len()];
                let count = 6000;
                for n in 0..count {
                    let angle = std::f64::consts::TAU * (f64::from(n) + 0.3) / f64::from(count);
                    let sin = angle.sin();
                    let cos = angle.cos();
                    let weight = size * (sinc(0.5 * k * a * cos) * sinc(0.5 * k * b * sin)).powi(2);
                    for (class, [i, j]) in classes.iter().enumerate() {
                        let x_phase = k * a * cos * *i as f64;
                        let y_phase = k * b * sin * *j as f64;
                        let even = x_phase.cos() * y_phase.cos();
                        let products = [even, cos * cos * even, sin * sin * even];
                        let odd = [
                            -cos * sin * x_phase.sin() * y_phase.sin(),
                            cos * x_phase.sin() * y_phase.cos(),
                            sin * x_phase.cos() * y_phase.sin(),
                        ];
                        for form in 0..FORM_COUNT {
                            let value = if form < 3 { products[form] } else { odd[form - 3] };
                            sums[form * classes.len() + class] += weight * value / f64::from(count);
                        }
                    }
                }
                for (found, wanted) in means.at(k).iter().zip(sums) {
                    assert!((found - wanted).abs() < 2e-13 * size, "{k} {found} {wanted}");
                }
            }
        }
    }

    /// Closed forms agree with integrals by Gauss points over the distance, weighted by the two cells' overlap:
    /// for cells apart.
    #[test]
    fn closed_forms_are_the_integrals() {
        let rule = gauss::largest();
        let pitch = [0.7, 0.4];
        for offset in [[2, 0], [0, 3], [2, 2], [5, 3], [9, 2]] {
            let mut sums = [0.0; FORM_COUNT];
            for (u, w) in rule.points_on_unit_interval() {
                for (v, z) in rule.points_on_unit_interval() {
                    // The hat function on both sides.
                    for [right, away] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
                        let x = pitch[0] * (offset[0] as f64 + right * u);
                        let y = pitch[1] * (offset[1] as f64 + away * v);
                        let r = x.hypot(y);
                        let area = (pitch[0] * pitch[1]).powi(2);
                        let weight = w * z * (1.0 - u) * (1.0 - v) * area;
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
            let largest = integrals(pitch, [0, 0])[0];
            for (found, wanted) in integrals(pitch, offset).into_iter().zip(sums) {
                let error = (found - wanted).abs() / largest;
                assert!(error < 1e-11, "{offset:?} {found} {wanted} {error:e}");
            }
        }
    }

    /// The cells of a larger cell sum up to it; 1/r = x²/r³ + y²/r³; a unit square on itself has the textbooks'
    /// value.
    #[test]
    fn integrals_of_a_cell_are_sums_of_parts() {
        let pitch = [0.7, 0.4];
        let half = [0.35, 0.2];
        for offset in [[0_usize, 0], [1, 0], [0, 1], [1, 1]] {
            let mut sums = [0.0; FORM_COUNT];
            for (i, one) in [(-1, 1.0), (0, 2.0), (1, 1.0)] {
                for (j, two) in [(-1, 1.0), (0, 2.0), (1, 1.0)] {
                    let place = [i + 2 * offset[0].cast_signed(), j + 2 * offset[1].cast_signed()];
                    let signs = place.map(|n| if n < 0 { -1.0 } else { 1.0 });
                    let parts = integrals(half, place.map(isize::unsigned_abs));
                    let signs = [1.0, 1.0, 1.0, signs[0] * signs[1], signs[0], signs[1]];
                    for form in 0..FORM_COUNT {
                        sums[form] += one * two * signs[form] * parts[form];
                    }
                }
            }
            let whole = integrals(pitch, offset);
            for (found, wanted) in whole.iter().zip(sums) {
                assert!((found - wanted).abs() < 1e-14, "{offset:?} {found} {wanted}");
            }
            assert!((whole[0] - whole[1] - whole[2]).abs() < 1e-15);
        }
        let unit = integrals([1.0, 1.0], [0, 0]);
        let wanted = 4.0 * (1.0_f64.asinh() - (2.0_f64.sqrt() - 1.0) / 3.0);
        assert!((unit[0] - wanted).abs() < 1e-14, "{}", unit[0]);
        assert_eq!(unit[3..], [0.0; 3]);
    }
}
