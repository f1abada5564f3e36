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

/// Number of forms.
pub(super) const FORMS: usize = 6;

/// Means over directions for all classes of a lattice.
#[derive(Debug)]
pub(super) struct AngularMeans {
    pitch: [f64; 2],
    diagonal: f64,
    extent: [usize; 2],
    classes: Vec<[usize; 2]>,
    /// Factors along x, weighted, of the terms with c′ and with s′: direction by direction.
    left: [Vec<f64>; 2],
    /// c′ and s′.
    right: [Vec<f64>; 2],
    /// Products of the factors along x and along y.
    sums: [Vec<f64>; 2],
    /// Form by form, all classes.
    values: Vec<f64>,
}

impl AngularMeans {
    pub(super) fn new(lattice: &Lattice) -> Self {
        let extent = lattice.extent();
        let classes = lattice.classes();
        let [columns, rows] = extent;
        let sums = [3, 2].map(|factors| vec![0.0; factors * columns * rows]);
        let values = vec![0.0; FORMS * classes.len()];
        let [left, right] = [(); 2].map(|()| [const { Vec::new() }; 2]);
        let pitch = lattice.pitch;
        let diagonal = lattice.diagonal();
        Self { pitch, diagonal, extent, classes, left, right, sums, values }
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
        let [columns, rows] = self.extent;
        let count = self.directions(k);
        for list in self.left.iter_mut().chain(&mut self.right) {
            list.clear();
        }
        let mut cosines = vec![0.0; columns];
        let mut sines = vec![0.0; columns];
        for direction in 0..count {
            let angle = std::f64::consts::FRAC_PI_2 * (direction as f64 + 0.5) / count as f64;
            let (sin, cos) = angle.sin_cos();
            let halves = [0.5 * k * self.pitch[0] * cos, 0.5 * k * self.pitch[1] * sin];
            let size: f64 =
                halves.into_iter().zip(self.pitch).map(|(half, side)| side * sinc(half)).product();
            let weight = size * size / count as f64;
            waves(
                2.0 * halves[0],
                |i, c, s| (cosines[i], sines[i]) = (weight * c, weight * s),
                columns,
            );
            let [even, odd] = &mut self.left;
            even.extend_from_slice(&cosines);
            even.extend(cosines.iter().map(|c| cos * cos * c));
            even.extend(sines.iter().map(|s| cos * s));
            odd.extend(sines.iter().map(|s| -cos * sin * s));
            odd.extend(cosines.iter().map(|c| sin * c));
            let [even, odd] = &mut self.right;
            waves(
                2.0 * halves[1],
                |_, c, s| {
                    even.push(c);
                    odd.push(s);
                },
                rows,
            );
        }
        for ((sum, left), right) in self.sums.iter_mut().zip(&self.left).zip(&self.right) {
            sum.fill(0.0);
            add_combined_rows(left, right, rows, 1.0, sum);
        }
        let [even, odd] = &self.sums;
        let total = self.classes.len();
        for (class, [i, j]) in self.classes.iter().enumerate() {
            let at = |sums: &[f64], factor: usize| sums[(factor * columns + i) * rows + j];
            let all = at(even, 0);
            let along = at(even, 1);
            let forms = [all, along, all - along, at(odd, 0), at(even, 2), at(odd, 1)];
            for (form, value) in forms.into_iter().enumerate() {
                self.values[form * total + class] = value;
            }
        }
        &self.values
    }
}

/// Calls `put` with n, cos nx and sin nx for n below `count`.
fn waves(x: f64, mut put: impl FnMut(usize, f64, f64), count: usize) {
    let (sin, cos) = x.sin_cos();
    let mut c = 1.0;
    let mut s = 0.0;
    for n in 0..count {
        put(n, c, s);
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
    }
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
pub(super) fn integrals(pitch: [f64; 2], offset: [usize; 2]) -> [f64; FORMS] {
    let mut sums = [0.0; FORMS];
    let steps = [(-1.0, 1.0), (0.0, -2.0), (1.0, 1.0)];
    for (right, one) in steps {
        for (away, two) in steps {
            let x = pitch[0] * (offset[0] as f64 + right);
            let y = pitch[1] * (offset[1] as f64 + away);
            for (sum, value) in sums.iter_mut().zip(primitives(x, y)) {
                *sum += one * two * value;
            }
        }
    }
    let [i, j] = offset.map(|n| if n == 0 { 0.0 } else { 1.0 });
    // Odd integrals vanish exactly.
    let odd = [1.0, 1.0, 1.0, i * j, i, j];
    std::array::from_fn(|form| odd[form] * sums[form])
}

fn primitives(x: f64, y: f64) -> [f64; FORMS] {
    let r = x.hypot(y);
    let cube = r * r * r;
    // asinh and atan of quotients with a vanishing denominator have a factor of zero.
    let ratio = |a: f64, b: f64| if b == 0.0 { 0.0 } else { a / b };
    let along = ratio(x, y.abs()).asinh();
    let across = ratio(y, x.abs()).asinh();
    let one = 0.5 * x * x * y * across;
    let two = 0.5 * y * y * x * along;
    let inverse = one + two - cube / 6.0;
    let yy = cube / 6.0 + one - 0.5 * x * x * r;
    let xx = cube / 6.0 + two - 0.5 * y * y * r;
    let xy = x * y * r / 3.0 + (y * y * y * along + x * x * x * across) / 6.0;
    let logarithm = if r == 0.0 { 0.0 } else { r.ln() };
    let odd = |x: f64, y: f64| {
        (0.5 * x * y * y - x * x * x / 6.0) * logarithm
            + 0.5 * x * x * y * ratio(y, x).atan()
            + y * y * y * ratio(x, y).atan() / 6.0
    };
    [inverse, yy, xx, xy, odd(x, y), odd(y, x)]
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
            let [a, b] = lattice.pitch;
            let size = (a * b).powi(2);
            for k in [1e-7, 0.3, 4.0, 31.0, 250.0] {
                let mut sums = vec![0.0; FORMS * classes.len()];
                let count = 6000;
                for n in 0..count {
                    let angle = std::f64::consts::TAU * (f64::from(n) + 0.3) / f64::from(count);
                    let (sin, cos) = angle.sin_cos();
                    let weight = size * (sinc(0.5 * k * a * cos) * sinc(0.5 * k * b * sin)).powi(2);
                    for (class, [i, j]) in classes.iter().enumerate() {
                        let (s, c) = (k * a * cos * *i as f64).sin_cos();
                        let (t, d) = (k * b * sin * *j as f64).sin_cos();
                        let products =
                            [1.0, cos * cos, sin * sin, 0.0, 0.0, 0.0].map(|x| x * c * d);
                        let odd = [-cos * sin * s * t, cos * s * d, sin * c * t];
                        for form in 0..FORMS {
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
            let mut sums = [0.0; FORMS];
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
            let own = integrals(pitch, [0, 0])[0];
            for (found, wanted) in integrals(pitch, offset).into_iter().zip(sums) {
                let error = (found - wanted).abs() / own;
                assert!(error < 1e-11, "{offset:?} {found} {wanted} {error:e}");
            }
        }
    }

    /// The cells of a larger cell sum up to it; 1/r = x²/r³ + y²/r³; a unit square on itself has the textbooks'
    /// value.
    #[test]
    fn own_cells_are_sums_of_parts() {
        let pitch = [0.7, 0.4];
        let half = [0.35, 0.2];
        for offset in [[0_usize, 0], [1, 0], [0, 1], [1, 1]] {
            let mut sums = [0.0; FORMS];
            for (i, one) in [(-1, 1.0), (0, 2.0), (1, 1.0)] {
                for (j, two) in [(-1, 1.0), (0, 2.0), (1, 1.0)] {
                    let place = [i + 2 * offset[0].cast_signed(), j + 2 * offset[1].cast_signed()];
                    let signs = place.map(|n| if n < 0 { -1.0 } else { 1.0 });
                    let parts = integrals(half, place.map(isize::unsigned_abs));
                    let signs = [1.0, 1.0, 1.0, signs[0] * signs[1], signs[0], signs[1]];
                    for form in 0..FORMS {
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
