//! Integrals of the static kernels over two cells of a lattice, in closed form.
//!
//! Over receiver and source, (x, y) from one to the other, they are second differences in x and in y (steps of the
//! pitch, weights 1, −2, 1) of functions whose fourth derivative ∂⁴/∂x²∂y² is the kernel. Each is also the integral
//! over all wavenumbers of a [mean over their directions](super::angular_means).

use super::angular_means::FORMS;

/// Integrals over two cells of `pitch`, `offset` cells apart: of 1/r, y²/r³, x²/r³, −xy/r³ (m³) and of
/// x/r², y/r² (m³): those of the forms g₀, `g_cc`, `g_ss`, `g_cs`, `g_c`, `g_s` over k.
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
    // Odd ones vanish exactly.
    let odd = [1.0, 1.0, 1.0, i * j, i, j];
    std::array::from_fn(|form| odd[form] * sums[form])
}

fn primitives(x: f64, y: f64) -> [f64; FORMS] {
    let r = x.hypot(y);
    let cube = r * r * r;
    // asinh and atan of quotients with a vanishing denominator stand beside a factor that is zero.
    let ratio = |a: f64, b: f64| if b == 0.0 { 0.0 } else { a / b };
    let (along, across) = (ratio(x, y.abs()).asinh(), ratio(y, x.abs()).asinh());
    let (one, two) = (0.5 * x * x * y * across, 0.5 * y * y * x * along);
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

    /// The same by Gauss points over the distance, the two cells' overlap as weight: for cells apart.
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

    /// Cells of a larger one sum up to it; 1/r = x²/r³ + y²/r³; a unit square on itself by the text books' form.
    #[test]
    fn own_cells_are_sums_of_parts() {
        let (pitch, half) = ([0.7, 0.4], [0.35, 0.2]);
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
