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

use super::forms::FORM_COUNT;
use crate::geometry::Lattice;
use crate::linalg::{Complex, add_combined_rows};

/// Number of waves of each corner: q = 1/sin², 1/cos², 1/(cos sin), 1/(cos sin²), 1/(cos² sin).
const CORNER_WAVE_COUNT: usize = 5;
/// Whether waves are odd in X and in Y.
const ODD_IN_X_AND_Y: [[bool; 2]; CORNER_WAVE_COUNT] =
    [[false, false], [false, false], [true, true], [true, false], [false, true]];
/// Directions of the poles, with cosine and sine.
const POLE_DIRECTIONS: [(f64, [f64; 2]); 4] =
    [(0.0, [1.0, 0.0]), (FRAC_PI_2, [0.0, 1.0]), (PI, [-1.0, 0.0]), (-FRAC_PI_2, [0.0, -1.0])];
/// Half the number of points of the path.
const PATH_HALF_POINTS: usize = 12;
/// h √(kR): the first neglected point and the error of the rule are both about 1e-16.
const PATH_STEP_FACTOR: f64 = 0.517;
/// Number of Chebyshev points of a band.
///
/// Amplitudes are singular at k = 0 alone, so their coefficients fall like 5.8ⁿ. Forms at k × side = 16 are below 1e-4
/// of the forms at k = 0.
const BAND_NODE_COUNT: usize = 16;
/// Smallest wavenumber × shorter side of a cell: the branch points of the path then add e^(−2π√(kR)/[`PATH_STEP_FACTOR`]).
const MIN_WAVENUMBER_SIDE: f64 = 16.0;

/// Forms of a lattice from a wavenumber on.
#[derive(Debug)]
pub(super) struct CornerWaves {
    lattice: Lattice,
    classes: Vec<[usize; 2]>,
    /// Distance of each corner from the source, column by column, m.
    distances: Vec<f64>,
    /// Wavenumber at which the first band begins, 1/m.
    first_wavenumber: f64,
    /// Chebyshev coefficients of the amplitudes on each band.
    ///
    /// Degree by degree, wave by wave, real and imaginary parts, all corners.
    bands: Vec<OnceLock<Vec<f64>>>,
}

/// Buffers of one thread.
#[derive(Debug, Default)]
pub(super) struct WaveBuffers {
    polynomials: Vec<f64>,
    amplitudes: Vec<f64>,
    /// H k⁴ of a wave at all corners.
    corners: Vec<f64>,
    /// Second differences in x of `corners`.
    differences: Vec<f64>,
    /// Forms: wavenumber by wavenumber, form by form, all classes.
    pub(super) values: Vec<f64>,
}

impl CornerWaves {
    /// Smallest wavenumber at which waves have full accuracy, 1/m.
    pub(super) fn min_wavenumber(lattice: &Lattice) -> f64 {
        MIN_WAVENUMBER_SIDE / lattice.shorter_side()
    }

    /// Waves from the wavenumber `first` up to `last`, 1/m.
    pub(super) fn new(lattice: &Lattice, first: f64, last: f64) -> Self {
        let mut bands = vec![];
        let mut band_end = first;
        while band_end < last {
            bands.push(OnceLock::new());
            band_end *= 2.0;
        }
        let extent = lattice.extent();
        let mut distances = vec![];
        for i in 0..=extent[0] {
            for j in 0..=extent[1] {
                distances.push((lattice.pitch[0] * i as f64).hypot(lattice.pitch[1] * j as f64));
            }
        }
        let classes = lattice.classes();
        Self { lattice: lattice.clone(), classes, distances, first_wavenumber: first, bands }
    }

    /// Overwrites `buffers.values` with the forms at `wavenumbers` (1/m), which lie on one band.
    pub(super) fn fill_forms(&self, wavenumbers: &[f64], buffers: &mut WaveBuffers) {
        let WaveBuffers { polynomials, amplitudes, values, .. } = buffers;
        values.clear();
        let Some(middle) = wavenumbers.get(wavenumbers.len() / 2) else { return };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let number = (middle / self.first_wavenumber).log2().clamp(0.0, 63.0) as usize;
        let band_start = self.first_wavenumber * (1_u64 << number) as f64;
        let Some(band) = self.bands.get(number) else { return };
        let count = wavenumbers.len();
        polynomials.clear();
        polynomials.resize(BAND_NODE_COUNT * count, 1.0);
        for (i, k) in wavenumbers.iter().enumerate() {
            // Chebyshev polynomials T₁ = x and Tₙ = 2x Tₙ₋₁ − Tₙ₋₂.
            let x = 2.0 * (k - band_start) / band_start - 1.0;
            polynomials[count + i] = x;
            for degree in 2..BAND_NODE_COUNT {
                let previous = polynomials[(degree - 1) * count + i];
                let before_previous = polynomials[(degree - 2) * count + i];
                polynomials[degree * count + i] = 2.0 * x * previous - before_previous;
            }
        }
        let columns = 2 * CORNER_WAVE_COUNT * self.distances.len();
        amplitudes.clear();
        amplitudes.resize(columns * count, 0.0);
        let coefficients = band.get_or_init(|| self.amplitude_coefficients(band_start));
        add_combined_rows(polynomials, coefficients, columns, 1.0, amplitudes);
        let amplitudes = std::mem::take(amplitudes);
        for (k, amplitudes) in wavenumbers.iter().zip(amplitudes.chunks_exact(columns)) {
            self.append_forms(*k, amplitudes, buffers);
        }
        buffers.amplitudes = amplitudes;
    }

    /// Appends the forms at the wavenumber `k` to `buffers.values`.
    fn append_forms(&self, k: f64, amplitudes: &[f64], buffers: &mut WaveBuffers) {
        let WaveBuffers { corners, differences, values, .. } = buffers;
        let class_count = self.classes.len();
        let start = values.len();
        values.resize(start + FORM_COUNT * class_count, 0.0);
        let values = &mut values[start..];
        let phases: Vec<_> = self.distances.iter().map(|r| (k * r).sin_cos()).collect();
        let corner_count = self.distances.len();
        let column_height = self.lattice.extent()[1] + 1;
        let unit = k.powi(-4) / PI;
        let amplitudes = amplitudes.chunks_exact(2 * corner_count);
        for ((wave, amplitudes), [odd_x, odd_y]) in amplitudes.enumerate().zip(ODD_IN_X_AND_Y) {
            let re = &amplitudes[..corner_count];
            let im = &amplitudes[corner_count..];
            corners.clear();
            // The two points of stationary phase together: twice the real part, or for odd F the imaginary part.
            for ((re, im), (sin, cos)) in re.iter().zip(im).zip(&phases) {
                let sum = if odd_x == odd_y { re * cos - im * sin } else { re * sin + im * cos };
                corners.push(sum);
            }
            differences.clear();
            for i in 0..self.lattice.extent()[0] {
                let before = if i > 0 { i - 1 } else { 1 };
                let sign = if i == 0 && odd_x { -1.0 } else { 1.0 };
                for j in 0..column_height {
                    differences.push(
                        sign * corners[before * column_height + j]
                            - 2.0 * corners[i * column_height + j]
                            + corners[(i + 1) * column_height + j],
                    );
                }
            }
            for (class, [i, j]) in self.classes.iter().enumerate() {
                let column = &differences[i * column_height..(i + 1) * column_height];
                let before = if *j > 0 { j - 1 } else { 1 };
                let sign = if *j == 0 && odd_y { -1.0 } else { 1.0 };
                let value = sign * column[before] - 2.0 * column[*j] + column[j + 1];
                values[(wave + 1) * class_count + class] = unit * value;
            }
        }
        for (class, offset) in self.classes.iter().enumerate() {
            let residues = residue_differences(k, self.lattice.pitch, *offset);
            for (form, value) in (1..).zip(residues) {
                values[form * class_count + class] += value;
            }
            values[class] = values[class_count + class] + values[2 * class_count + class];
        }
    }

    /// Chebyshev coefficients of all amplitudes on the band that begins at `band_start`.
    fn amplitude_coefficients(&self, band_start: f64) -> Vec<f64> {
        let column_height = self.lattice.extent()[1] + 1;
        let pitch = self.lattice.pitch;
        let corners = self.distances.len();
        let mut coefficients = vec![];
        coefficients.resize(BAND_NODE_COUNT * 2 * CORNER_WAVE_COUNT * corners, 0.0);
        for node in 0..BAND_NODE_COUNT {
            let angle = PI * (node as f64 + 0.5) / BAND_NODE_COUNT as f64;
            let k = band_start * (1.0 + 0.5 * (1.0 + angle.cos()));
            for corner in 1..corners {
                let i = corner / column_height;
                let j = corner % column_height;
                let amplitudes = amplitudes(k, [pitch[0] * i as f64, pitch[1] * j as f64]);
                for (wave, (value, [odd_x, odd_y])) in
                    amplitudes.into_iter().zip(ODD_IN_X_AND_Y).enumerate()
                {
                    if (odd_x && i == 0) || (odd_y && j == 0) {
                        continue;
                    }
                    for degree in 0..BAND_NODE_COUNT {
                        let unit = if degree == 0 { 1.0 } else { 2.0 } / BAND_NODE_COUNT as f64;
                        let factor = unit * (degree as f64 * angle).cos();
                        let place = (degree * CORNER_WAVE_COUNT + wave) * 2 * corners + corner;
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
fn residue_differences(k: f64, pitch: [f64; 2], offset: [usize; 2]) -> [f64; CORNER_WAVE_COUNT] {
    let mut values = [0.0; CORNER_WAVE_COUNT];
    for axis in 0..2 {
        let across = 1 - axis;
        if offset[across] > 1 {
            continue;
        }
        // Places of the forms g_cc, g_c and g_s along x, of g_ss, g_s and g_c along y.
        let [even, odd, next_row] = [[0, 3, 4], [1, 4, 3]][axis];
        let unit = 4.0 * (0.5 * k * pitch[axis]).sin().powi(2) * k.powi(-4);
        let phase = k * pitch[axis] * offset[axis] as f64;
        let sin = phase.sin();
        let cos = phase.cos();
        if offset[across] == 0 {
            values[even] += 2.0 * k * pitch[across] * unit * cos;
            values[odd] += 2.0 * k * pitch[across] * unit * sin;
        } else {
            values[2] -= unit * sin;
            values[next_row] += unit * cos;
        }
    }
    values
}

/// k⁴ 2π e^(−ikR) of the waves by the stationary point θ = φ, for a corner at (X, Y) ≠ (0, 0), X, Y ≥ 0.
fn amplitudes(k: f64, [x, y]: [f64; 2]) -> [Complex; CORNER_WAVE_COUNT] {
    let distance = x.hypot(y);
    let cos = x / distance;
    let sin = y / distance;
    let direction = y.atan2(x);
    let h = PATH_STEP_FACTOR / (k * distance).sqrt();
    let one = Complex::real(1.0);
    // p = turn × √2 sin ½(θ − φ).
    let turn = Complex::polar(1.0, 0.5 * FRAC_PI_2);
    let mut sums = [Complex::default(); CORNER_WAVE_COUNT];
    for n in 0..2 * PATH_HALF_POINTS {
        let place = n as f64 + 0.5 - PATH_HALF_POINTS as f64;
        let p = place * h;
        // Half angle's sine and cosine, and the angle's, of θ − φ on the path.
        let half_sine = turn.conj().scale(p / SQRT_2);
        let half_cosine = Complex::new(1.0, 0.5 * p * p).sqrt();
        let turn_cosine = Complex::new(1.0, p * p);
        let turn_sine = (half_sine * half_cosine).scale(2.0);
        let c = turn_cosine.scale(cos) - turn_sine.scale(sin);
        let s = turn_cosine.scale(sin) + turn_sine.scale(cos);
        // dp e^(−kRp²) dθ/dp.
        let decay = (-(place * PATH_STEP_FACTOR).powi(2)).exp();
        let weight = turn.conj().scale(h * SQRT_2 * decay) / half_cosine;
        let over_c = one / c;
        let over_s = one / s;
        let over_cs = over_c * over_s;
        let values =
            [over_s * over_s, over_c * over_c, over_cs, over_cs * over_s, over_cs * over_c];
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += weight * value;
        }
    }
    for (angle, [c, s]) in POLE_DIRECTIONS {
        let pole_angle = angle - direction;
        let wave = Complex::polar(1.0, k * (x * c + y * s - distance));
        let slope = Complex::new(0.0, k * (y * c - x * s));
        let poles = poles([c, s], slope);
        // dp/dθ at the pole.
        let path_slope = turn.scale((0.5 * pole_angle).cos() / SQRT_2);
        if pole_angle == 0.0 {
            for (sum, [double, _]) in sums.iter_mut().zip(poles) {
                *sum = *sum - (double * path_slope * wave).scale(PI * PI / h);
            }
            continue;
        }
        // 2πi p/h with the sign of Im p.
        let exponent =
            (turn * Complex::new(0.0, TAU)).scale(SQRT_2 * (0.5 * pole_angle).sin().abs() / h);
        let exponential = exponent.exp();
        let inverse = (one + exponential).inverse();
        // 1/(1 + e^(−…)) and its derivative by the exponent.
        let correction = exponential * inverse;
        let correction_slope = exponential * inverse * inverse;
        let sign = if pole_angle > 0.0 { 1.0 } else { -1.0 };
        let rate = (Complex::new(0.0, TAU) * path_slope).scale(sign / h);
        for (sum, [double, single]) in sums.iter_mut().zip(poles) {
            let residue = (single * correction + double * correction_slope * rate) * wave;
            *sum += residue * Complex::new(0.0, sign * TAU);
        }
    }
    sums
}

/// Coefficients of (θ − θ₀)⁻² and (θ − θ₀)⁻¹ of all waves at the pole in the direction (c, s) of an axis.
///
/// `slope`: logarithmic derivative of the wave e^(…) there.
fn poles([c, s]: [f64; 2], slope: Complex) -> [[Complex; 2]; CORNER_WAVE_COUNT] {
    // Sizes of the double and of the simple pole of each wave.
    let sizes = if s == 0.0 {
        [[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [c, 0.0], [0.0, c]]
    } else {
        [[0.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, -s], [s, 0.0]]
    };
    sizes.map(|[double, single]| {
        if double == 0.0 {
            [Complex::default(), Complex::real(single)]
        } else {
            [Complex::real(double), slope.scale(double)]
        }
    })
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
            let smallest = CornerWaves::min_wavenumber(&lattice);
            let waves = CornerWaves::new(&lattice, smallest, 40.0 * smallest);
            let mut means = AngularMeans::new(&lattice);
            let mut buffers = WaveBuffers::default();
            for size in [1.0, 1.37, 1.999, 2.0, 3.7, 31.0] {
                let wavenumbers = [size * smallest, size * smallest * (1.0 + 1e-4)];
                waves.fill_forms(&wavenumbers, &mut buffers);
                // Forms of a row or column fall like k⁻³.
                let unit = (pitch[0] * pitch[1]).powi(2) * (size * MIN_WAVENUMBER_SIDE).powi(-3);
                let rows = buffers.values.chunks_exact(FORM_COUNT * waves.classes.len());
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
