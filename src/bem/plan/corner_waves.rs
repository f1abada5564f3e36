//! Form factors of cells at large wavenumbers, as waves from the corners of cells.
//!
//! Because −4 sin² ½u = e^(iu) − 2 + e^(−iu), the [forms](super::forms) are second differences in x and in y (steps of
//! the pitch, weights 1, −2, 1) of
//!
//! H(X, Y) = k⁻⁴ ⟨q(θ) e^(ik(X cos θ + Y sin θ))⟩,   q = F/(cos²θ sin²θ)
//!
//! with F = 1, cos²θ, … of the form. The poles of q at the four axes cancel in the differences. Any path around
//! them is therefore allowed that is the same for all corners; the mean of the paths above and below is taken.
//!
//! With R = |(X, Y)| and φ its direction, waves are stationary at θ = φ and at φ + π. The path of steepest descent
//! through φ is cos(θ − φ) = 1 + ip², −∞ < p < ∞. There the wave is e^(ikR) e^(−kRp²). The other point has the
//! conjugate values. Between the first path and these two lie poles; their residues are waves along an axis,
//! ±iπ Res, and their second differences are zero except in the first row and column, or in the second.
//!
//! On the path, the trapezoidal rule at (n + ½)h converges like e^(−π²/(kRh²)). Poles beside the path add, in closed
//! form, the residues of q e^(…)/(1 + e^(∓2πip/h)); a double pole on the path, A/p², adds Aπ²/h (Trefethen and
//! Weideman, "The exponentially convergent trapezoidal rule", SIAM Review 56, 2014). The sum has thus no error but
//! rounding, however near the poles are.
//!
//! Amplitudes, without e^(ikR), are smooth in k. They are polynomials on bands of k, each up to twice the wavenumber
//! at which it begins, so that a form costs the same at any wavenumber.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use std::sync::OnceLock;

use super::forms::FORMS;
use crate::geometry::Lattice;
use crate::linalg::{Complex, add_combined_rows};

/// Waves of each corner: q = 1/sin², 1/cos², 1/(cos sin), 1/(cos sin²), 1/(cos² sin).
const WAVES: usize = 5;
/// Whether waves are odd in X and in Y.
const ODD: [[bool; 2]; WAVES] =
    [[false, false], [false, false], [true, true], [true, false], [false, true]];
/// Directions of the poles, with cosine and sine.
const AXES: [(f64, [f64; 2]); 4] =
    [(0.0, [1.0, 0.0]), (FRAC_PI_2, [0.0, 1.0]), (PI, [-1.0, 0.0]), (-FRAC_PI_2, [0.0, -1.0])];
/// Half the number of points of the path.
const PATH: usize = 12;
/// h √(kR): the first neglected point and the error of the rule are both about 1e-16.
const STEP: f64 = 0.517;
/// Number of Chebyshev points of a band.
///
/// Amplitudes are singular at k = 0 alone, so their coefficients fall like 5.8ⁿ. Forms at k × side = 16 are below 1e-4
/// of the forms at k = 0.
const NODES: usize = 16;
/// Smallest wavenumber × shorter side of a cell: the branch points of the path then add e^(−2π√(kR)/[`STEP`]).
const LEAST: f64 = 16.0;

/// Forms of a lattice from a wavenumber on.
#[derive(Debug)]
pub(super) struct CornerWaves {
    lattice: Lattice,
    classes: Vec<[usize; 2]>,
    /// Distance of each corner from the source, column by column, m.
    distances: Vec<f64>,
    /// Wavenumber at which the first band begins, 1/m.
    first: f64,
    /// Chebyshev coefficients of the amplitudes on each band.
    ///
    /// Degree by degree, wave by wave, real and imaginary parts, all corners.
    bands: Vec<OnceLock<Vec<f64>>>,
}

/// Scratch of one thread.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    polynomials: Vec<f64>,
    amplitudes: Vec<f64>,
    /// H k⁴ of a wave at all corners, and its differences in x.
    corners: Vec<f64>,
    columns: Vec<f64>,
    /// Forms: wavenumber by wavenumber, form by form, all classes.
    pub(super) values: Vec<f64>,
}

impl CornerWaves {
    /// Smallest wavenumber at which waves have full accuracy, 1/m.
    pub(super) fn least(lattice: &Lattice) -> f64 {
        LEAST / lattice.finest()
    }

    /// Waves from the wavenumber `first` up to `last`, 1/m.
    pub(super) fn new(lattice: &Lattice, [first, last]: [f64; 2]) -> Self {
        let mut bands = vec![];
        let mut end = first;
        while end < last {
            bands.push(OnceLock::new());
            end *= 2.0;
        }
        let [columns, rows] = lattice.extent();
        let [a, b] = lattice.pitch;
        let all = (0..=columns).flat_map(|i| (0..=rows).map(move |j| [i, j]));
        let distances = all.map(|[i, j]| (a * i as f64).hypot(b * j as f64)).collect();
        Self { lattice: lattice.clone(), classes: lattice.classes(), distances, first, bands }
    }

    /// Overwrites `scratch.values` with the forms at `wavenumbers` (1/m), which lie on one band.
    pub(super) fn at(&self, wavenumbers: &[f64], scratch: &mut Scratch) {
        let corners = self.distances.len();
        let Scratch { polynomials, amplitudes, values, .. } = scratch;
        values.clear();
        let Some(middle) = wavenumbers.get(wavenumbers.len() / 2) else { return };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let number = (middle / self.first).log2().clamp(0.0, 63.0) as usize;
        let begin = self.first * (1_u64 << number) as f64;
        let Some(band) = self.bands.get(number) else { return };
        polynomials.clear();
        polynomials.resize(NODES * wavenumbers.len(), 1.0);
        for (i, k) in wavenumbers.iter().enumerate() {
            let x = 2.0 * (k - begin) / begin - 1.0;
            for degree in 1..NODES {
                let before = |back: usize| polynomials[(degree - back) * wavenumbers.len() + i];
                let value = if degree == 1 { x } else { 2.0 * x * before(1) - before(2) };
                polynomials[degree * wavenumbers.len() + i] = value;
            }
        }
        let columns = 2 * WAVES * corners;
        amplitudes.clear();
        amplitudes.resize(columns * wavenumbers.len(), 0.0);
        let band = band.get_or_init(|| self.band(begin));
        add_combined_rows(polynomials, band, columns, 1.0, amplitudes);
        let amplitudes = std::mem::take(amplitudes);
        for (k, amplitudes) in wavenumbers.iter().zip(amplitudes.chunks_exact(columns)) {
            self.add(*k, amplitudes, scratch);
        }
        scratch.amplitudes = amplitudes;
    }

    /// Appends the forms at the wavenumber `k` to `scratch.values`.
    fn add(&self, k: f64, amplitudes: &[f64], scratch: &mut Scratch) {
        let Scratch { corners, columns, values, .. } = scratch;
        let ([across, down], count) = (self.lattice.extent(), self.classes.len());
        let start = values.len();
        values.resize(start + FORMS * count, 0.0);
        let values = &mut values[start..];
        let waves: Vec<_> = self.distances.iter().map(|r| (k * r).sin_cos()).collect();
        let parts = amplitudes.chunks_exact(2 * self.distances.len());
        for ((wave, parts), [odd_x, odd_y]) in parts.enumerate().zip(ODD) {
            let (re, im) = parts.split_at(self.distances.len());
            corners.clear();
            let all = re.iter().zip(im).zip(&waves);
            // The two points of stationary phase together: twice the real part, or for odd F the imaginary part.
            corners.extend(all.map(|((re, im), (sin, cos))| {
                if odd_x == odd_y { re * cos - im * sin } else { re * sin + im * cos }
            }));
            let height = down + 1;
            let unit = k.powi(-4) / PI;
            columns.clear();
            for i in 0..across {
                let before = if i > 0 { i - 1 } else { 1 };
                let sign = if i == 0 && odd_x { -1.0 } else { 1.0 };
                let column = |i: usize| &corners[i * height..(i + 1) * height];
                let all = column(before).iter().zip(column(i)).zip(column(i + 1));
                columns.extend(all.map(|((one, two), three)| sign * one - 2.0 * two + three));
            }
            for (class, [i, j]) in self.classes.iter().enumerate() {
                let column = &columns[i * height..(i + 1) * height];
                let (before, sign) =
                    if *j > 0 { (j - 1, 1.0) } else { (1, if odd_y { -1.0 } else { 1.0 }) };
                let value = sign * column[before] - 2.0 * column[*j] + column[j + 1];
                values[(wave + 1) * count + class] = unit * value;
            }
        }
        for (class, offset) in self.classes.iter().enumerate() {
            let along = along_axes(k, self.lattice.pitch, *offset);
            for (form, value) in (1..).zip(along) {
                values[form * count + class] += value;
            }
            values[class] = values[count + class] + values[2 * count + class];
        }
    }

    /// Chebyshev coefficients of all amplitudes on the band that begins at `begin`.
    fn band(&self, begin: f64) -> Vec<f64> {
        let [_, down] = self.lattice.extent();
        let [a, b] = self.lattice.pitch;
        let corners = self.distances.len();
        let mut coefficients = vec![];
        coefficients.resize(NODES * 2 * WAVES * corners, 0.0);
        for node in 0..NODES {
            let angle = PI * (node as f64 + 0.5) / NODES as f64;
            let k = begin * (1.0 + 0.5 * (1.0 + angle.cos()));
            for corner in 1..corners {
                let i = corner / (down + 1);
                let j = corner % (down + 1);
                let amplitudes = amplitudes(k, [a * i as f64, b * j as f64]);
                for (wave, (value, [odd_x, odd_y])) in amplitudes.into_iter().zip(ODD).enumerate() {
                    if (odd_x && i == 0) || (odd_y && j == 0) {
                        continue;
                    }
                    for degree in 0..NODES {
                        let unit = if degree == 0 { 1.0 } else { 2.0 } / NODES as f64;
                        let factor = unit * (degree as f64 * angle).cos();
                        let place = (degree * WAVES + wave) * 2 * corners + corner;
                        coefficients[place] += factor * value.re;
                        coefficients[place + corners] += factor * value.im;
                    }
                }
            }
        }
        coefficients
    }
}

/// Second differences of the residues between the paths, for all forms but g₀.
///
/// −|Y| cos kX k⁻³ and −|X| cos kY k⁻³ of `g_cc` and `g_ss`, −(sign Y sin kX + sign X sin kY) k⁻⁴ of `g_cs`,
/// −|Y| sin kX k⁻³ + sign X cos kY k⁻⁴ of `g_c`, and `g_s` alike.
fn along_axes(k: f64, [a, b]: [f64; 2], [i, j]: [usize; 2]) -> [f64; WAVES] {
    let mut values = [0.0; WAVES];
    let axes = [(a, i, b, j, [0, 3, 4]), (b, j, a, i, [1, 4, 3])];
    for (pitch, along, other, across, [even, odd, next]) in axes {
        if across > 1 {
            continue;
        }
        let unit = 4.0 * (0.5 * k * pitch).sin().powi(2) * k.powi(-4);
        let (sin, cos) = (k * pitch * along as f64).sin_cos();
        if across == 0 {
            values[even] += 2.0 * k * other * unit * cos;
            values[odd] += 2.0 * k * other * unit * sin;
        } else {
            values[2] -= unit * sin;
            values[next] += unit * cos;
        }
    }
    values
}

/// k⁴ 2π e^(−ikR) of the waves by the stationary point θ = φ, for a corner at (X, Y) ≠ (0, 0), X, Y ≥ 0.
fn amplitudes(k: f64, [x, y]: [f64; 2]) -> [Complex; WAVES] {
    let distance = x.hypot(y);
    let cos = x / distance;
    let sin = y / distance;
    let direction = y.atan2(x);
    let h = STEP / (k * distance).sqrt();
    let one = Complex::real(1.0);
    // p = turn × √2 sin ½(θ − φ).
    let turn = Complex::polar(1.0, 0.5 * FRAC_PI_2);
    let mut sums = [Complex::default(); WAVES];
    for n in 0..2 * PATH {
        let place = n as f64 + 0.5 - PATH as f64;
        let p = place * h;
        let half = turn.conj().scale(p / SQRT_2);
        let root = Complex::new(1.0, 0.5 * p * p).sqrt();
        let near = Complex::new(1.0, p * p);
        let far = (half * root).scale(2.0);
        let c = near.scale(cos) - far.scale(sin);
        let s = near.scale(sin) + far.scale(cos);
        // dp e^(−kRp²) dθ/dp.
        let weight = turn.conj().scale(h * SQRT_2 * (-(place * STEP).powi(2)).exp()) / root;
        let over_c = one / c;
        let over_s = one / s;
        let both = over_c * over_s;
        let all = [over_s * over_s, over_c * over_c, both, both * over_s, both * over_c];
        for (sum, value) in sums.iter_mut().zip(all) {
            *sum += weight * value;
        }
    }
    for (angle, [c, s]) in AXES {
        let gap = angle - direction;
        let wave = Complex::polar(1.0, k * (x * c + y * s - distance));
        let slope = Complex::new(0.0, k * (y * c - x * s));
        let poles = poles([c, s], slope);
        let speed = turn.scale((0.5 * gap).cos() / SQRT_2);
        if gap == 0.0 {
            for (sum, [double, _]) in sums.iter_mut().zip(poles) {
                *sum = *sum - (double * speed * wave).scale(PI * PI / h);
            }
            continue;
        }
        // 2πi p/h with the sign of Im p.
        let exponent = (turn * Complex::new(0.0, TAU)).scale(SQRT_2 * (0.5 * gap).sin().abs() / h);
        let fall = exponent.exp();
        let under = (one + fall).inverse();
        let kernel = fall * under;
        let change = fall * under * under;
        let side = if gap > 0.0 { 1.0 } else { -1.0 };
        let rate = (Complex::new(0.0, TAU) * speed).scale(side / h);
        for (sum, [double, single]) in sums.iter_mut().zip(poles) {
            let residue = (single * kernel + double * change * rate) * wave;
            *sum += residue * Complex::new(0.0, side * TAU);
        }
    }
    sums
}

/// Coefficients of (θ − θ₀)⁻² and (θ − θ₀)⁻¹ of all waves at the pole in the direction (c, s) of an axis.
///
/// `slope`: logarithmic derivative of the wave e^(…) there.
fn poles([c, s]: [f64; 2], slope: Complex) -> [[Complex; 2]; WAVES] {
    let none = [Complex::default(); 2];
    let double = |size: f64| [Complex::real(size), slope.scale(size)];
    let single = |size: f64| [Complex::default(), Complex::real(size)];
    if s == 0.0 {
        [double(1.0), none, single(1.0), double(c), single(c)]
    } else {
        [none, double(1.0), single(-1.0), single(-s), double(s)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::forms::AngularMeans;
    use super::*;

    /// Against sums over directions, at both ends of bands and within: corners near an axis have poles near the path.
    #[test]
    fn waves_are_sums_over_directions() {
        let mut worst = 0.0_f64;
        for (pitch, counts) in [
            ([1.0, 1.0], [1, 1]),
            ([1.0, 0.7], [5, 4]),
            ([0.3, 0.9], [1, 3]),
            ([0.5, 0.5], [3, 24]),
        ] {
            let lattice = Lattice { pitch, counts };
            let least = CornerWaves::least(&lattice);
            let waves = CornerWaves::new(&lattice, [least, 40.0 * least]);
            let mut means = AngularMeans::new(&lattice);
            let mut scratch = Scratch::default();
            for size in [1.0, 1.37, 1.999, 2.0, 3.7, 31.0] {
                let wavenumbers = [size * least, size * least * (1.0 + 1e-4)];
                waves.at(&wavenumbers, &mut scratch);
                // Forms of a row or column fall like k⁻³.
                let unit = (pitch[0] * pitch[1]).powi(2) * (size * LEAST).powi(-3);
                let rows = scratch.values.chunks_exact(FORMS * waves.classes.len());
                for (k, found) in wavenumbers.into_iter().zip(rows) {
                    for (found, wanted) in found.iter().zip(means.at(k)) {
                        worst = worst.max((found - wanted).abs() / unit);
                    }
                }
            }
        }
        println!("{worst:e}");
        assert!(worst < 1e-11, "{worst:e}");
    }
}
