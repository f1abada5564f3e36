//! Form factors of cells in the wavenumber domain: means over the direction of the wavenumber.
//!
//! For a wavenumber k in the direction θ, cells of sides a and b, and a receiver at (x, y) from the source, with
//! S = (a b sinc(½ka cos θ) sinc(½kb sin θ))², c, s = cos, sin(kx cos θ) and c′, s′ = cos, sin(ky sin θ),
//!
//! g₀ = ⟨S c c′⟩,   `g_cc` = ⟨cos²θ S c c′⟩,   `g_ss` = g₀ − `g_cc`,   `g_cs` = −⟨cos θ sin θ S s s′⟩,
//! `g_c` = ⟨cos θ S s c′⟩,   `g_s` = ⟨sin θ S c s′⟩
//!
//! They depend on the lattice alone. The integrands are entire and periodic, so that the midpoint rule converges as
//! soon as it has as many points as they turn, and a few more for the transition of Bessel functions, kD^⅓ wide.

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
    /// Their products.
    sums: [Vec<f64>; 2],
    /// Form by form, all classes.
    values: Vec<f64>,
}

impl AngularMeans {
    pub(super) fn new(lattice: &Lattice) -> Self {
        let (extent, classes) = (lattice.extent(), lattice.classes());
        let [columns, rows] = extent;
        let sums = [3, 2].map(|factors| vec![0.0; factors * columns * rows]);
        let values = vec![0.0; FORMS * classes.len()];
        let [left, right] = [(); 2].map(|()| [const { Vec::new() }; 2]);
        let (pitch, diagonal) = (lattice.pitch, lattice.diagonal());
        Self { pitch, diagonal, extent, classes, left, right, sums, values }
    }

    /// Directions in a quarter that resolve the means at the wavenumber `k`.
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
        let (mut cosines, mut sines) = (vec![0.0; columns], vec![0.0; columns]);
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
            let (all, along) = (at(even, 0), at(even, 1));
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
    let [mut c, mut s] = [1.0, 0.0];
    for n in 0..count {
        put(n, c, s);
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
    }
}

/// sin x/x.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
