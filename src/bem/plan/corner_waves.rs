//! Form factors of cells at large wavenumbers, as waves from the corners of cells.
//!
//! Because −4 sin² ½u = e^(iu) − 2 + e^(−iu), the [forms](super::forms) are second differences in x and in y (steps of
//! the pitch, weights 1, −2, 1) of
//!
//! H(X, Y) = k⁻⁴ ⟨q(θ) e^(ik(X cos θ + Y sin θ))⟩,   q = F/(cos²θ sin²θ)
//!
//! with F = 1, cos²θ, … of the form. The poles of q at the four axes cancel in the differences. Any path around the
//! poles is therefore allowed if it is the same for all corners. The code uses the mean of the paths above and below.
//!
//! With R = |(X, Y)| and φ its direction, the phase is stationary at θ = φ and at φ + π. The path of steepest descent
//! through φ is cos(θ − φ) = 1 + ip², −∞ < p < ∞. On this path the wave is e^(ikR) e^(−kRp²). The point φ + π has the
//! conjugate values. Poles lie between the original path and the two paths of steepest descent. Their residues, ±iπ Res,
//! are waves along an axis. The second differences of the residues are zero except in the first two rows and columns.
//!
//! On the path, the trapezoidal rule at (n + ½)h converges like e^(−π²/(kRh²)). Poles beside the path add, in closed
//! form, the residues of q e^(…)/(1 + e^(∓2πip/h)); a double pole on the path, A/p², adds Aπ²/h (Trefethen and
//! Weideman, "The exponentially convergent trapezoidal rule", SIAM Review 56, 2014). The sum is then exact to rounding.
//!
//! Amplitudes, without e^(ikR), are smooth in k. They are interpolated by polynomials on bands of k. Each band reaches
//! from its first wavenumber to twice this wavenumber, so that the time for a form is the same at any wavenumber.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use std::sync::OnceLock;

use super::forms::FORM_COUNT;
use crate::geometry::Lattice;
use crate::linalg::{Complex, add_combined_rows};

/// Number of waves of each corner, for the forms but g₀: q = 1/sin², 1/cos², 1/(cos sin), 1/(cos sin²), 1/(cos² sin).
const CORNER_WAVE_COUNT: usize = 5;
/// Whether waves are odd in X and in Y.
const ODD_IN_X_AND_Y: [[bool; 2]; CORNER_WAVE_COUNT] =
    [[false, false], [false, false], [true, true], [true, false], [false, true]];
/// Directions of the poles: angle, and its cosine and sine.
const POLE_DIRECTIONS: [(f64, [f64; 2]); 4] =
    [(0.0, [1.0, 0.0]), (FRAC_PI_2, [0.0, 1.0]), (PI, [-1.0, 0.0]), (-FRAC_PI_2, [0.0, -1.0])];
/// Half the number of points of the trapezoidal rule on the path, after which terms are below rounding.
const PATH_HALF_POINTS: usize = 12;
/// Step h √(kR) of the trapezoidal rule, with which the first neglected term and the error are both about 1e-16.
const PATH_STEP_FACTOR: f64 = 0.517;
/// Number of Chebyshev points of a band.
///
/// Amplitudes are singular at k = 0 alone, so that their coefficients decrease like 5.8⁻ⁿ. Forms at k × side = 16 are
/// below 1e-4 of the forms at k = 0.
const BAND_NODE_COUNT: usize = 16;
/// Smallest product of wavenumber and shorter side of a cell for which the rule is accurate.
///
/// Branch points of the path add an error of e^(−2π√(kR)/[`PATH_STEP_FACTOR`]).
const MIN_WAVENUMBER_TIMES_SIDE: f64 = 16.0;

/// Form factors of a lattice at large wavenumbers, as waves from corners of cells.
#[derive(Debug)]
pub(super) struct CornerWaves {
    lattice: Lattice,
    classes: Vec<[usize; 2]>,
    /// Distance of each corner from the source, column by column, m.
    distances: Vec<f64>,
    /// Wavenumber at the start of the first band, 1/m.
    first_wavenumber: f64,
    /// Chebyshev coefficients of each band's amplitudes: degree by degree, wave by wave, real and imaginary, all corners.
    bands: Vec<OnceLock<Vec<f64>>>,
}

/// Buffers of one thread.
#[derive(Debug, Default)]
pub(super) struct WaveBuffers {
    /// Chebyshev polynomials at the wavenumbers, degree by degree.
    polynomials: Vec<f64>,
    /// Amplitudes at the wavenumbers: wavenumber by wavenumber, as the coefficients of one degree.
    amplitudes: Vec<f64>,
    /// Values H k⁴ of a wave at all corners.
    corner_values: Vec<f64>,
    /// Second differences in x of `corner_values`.
    x_differences: Vec<f64>,
    /// Forms: wavenumber by wavenumber, form by form, all classes.
    pub(super) values: Vec<f64>,
}

impl CornerWaves {
    /// Smallest wavenumber at which the waves are accurate to rounding, 1/m.
    pub(super) fn min_wavenumber(lattice: &Lattice) -> f64 {
        MIN_WAVENUMBER_TIMES_SIDE / lattice.shorter_side()
    }

    /// Waves from `first_wavenumber` up to `last_wavenumber`, 1/m.
    pub(super) fn new(lattice: &Lattice, first_wavenumber: f64, last_wavenumber: f64) -> Self {
        let mut bands = vec![];
        let mut band_end = first_wavenumber;
        while band_end < last_wavenumber {
            bands.push(OnceLock::new());
            band_end *= 2.0;
        }
        let offset_counts = lattice.offset_counts();
        let mut distances = vec![];
        for i in 0..=offset_counts[0] {
            for j in 0..=offset_counts[1] {
                distances.push((lattice.pitch[0] * i as f64).hypot(lattice.pitch[1] * j as f64));
            }
        }
        let classes = lattice.classes();
        Self { lattice: lattice.clone(), classes, distances, first_wavenumber, bands }
    }

    /// Overwrites `buffers.values` with the forms at `wavenumbers` (1/m), which lie on one band.
    pub(super) fn fill_forms(&self, wavenumbers: &[f64], buffers: &mut WaveBuffers) {
        let WaveBuffers { polynomials, amplitudes, values, .. } = buffers;
        values.clear();
        let Some(middle) = wavenumbers.get(wavenumbers.len() / 2) else { return };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let band_index = (middle / self.first_wavenumber).log2().clamp(0.0, 63.0) as usize;
        let band_start = self.first_wavenumber * (1_u64 << band_index) as f64;
        let Some(band) = self.bands.get(band_index) else { return };
        let point_count = wavenumbers.len();
        polynomials.clear();
        polynomials.resize(BAND_NODE_COUNT * point_count, 1.0);
        for (i, k) in wavenumbers.iter().enumerate() {
            // Chebyshev polynomials T₁ = x and Tₙ = 2x Tₙ₋₁ − Tₙ₋₂.
            let x = 2.0 * (k - band_start) / band_start - 1.0;
            polynomials[point_count + i] = x;
            for degree in 2..BAND_NODE_COUNT {
                let previous = polynomials[(degree - 1) * point_count + i];
                let before_previous = polynomials[(degree - 2) * point_count + i];
                polynomials[degree * point_count + i] = 2.0 * x * previous - before_previous;
            }
        }
        let column_count = 2 * CORNER_WAVE_COUNT * self.distances.len();
        amplitudes.clear();
        amplitudes.resize(column_count * point_count, 0.0);
        let coefficients = band.get_or_init(|| self.amplitude_coefficients(band_start));
        add_combined_rows(polynomials, coefficients, column_count, 1.0, amplitudes);
        let all_amplitudes = std::mem::take(amplitudes);
        for (k, point_amplitudes) in
            wavenumbers.iter().zip(all_amplitudes.chunks_exact(column_count))
        {
            self.append_forms(*k, point_amplitudes, buffers);
        }
        buffers.amplitudes = all_amplitudes;
    }

    /// Appends the forms at the wavenumber `k` to `buffers.values`.
    fn append_forms(&self, k: f64, amplitudes: &[f64], buffers: &mut WaveBuffers) {
        let WaveBuffers { corner_values, x_differences, values, .. } = buffers;
        let class_count = self.classes.len();
        let start = values.len();
        values.resize(start + FORM_COUNT * class_count, 0.0);
        let forms = &mut values[start..];
        let phases: Vec<_> = self.distances.iter().map(|r| (k * r).sin_cos()).collect();
        let corner_count = self.distances.len();
        let column_height = self.lattice.offset_counts()[1] + 1;
        let factor = k.powi(-4) / PI;
        let wave_amplitudes = amplitudes.chunks_exact(2 * corner_count);
        for ((wave, amplitudes), [is_odd_in_x, is_odd_in_y]) in
            wave_amplitudes.enumerate().zip(ODD_IN_X_AND_Y)
        {
            let re = &amplitudes[..corner_count];
            let im = &amplitudes[corner_count..];
            corner_values.clear();
            // Sum over both points of stationary phase: twice the real part, or for odd F the imaginary part.
            for ((re, im), (sin, cos)) in re.iter().zip(im).zip(&phases) {
                let is_real = is_odd_in_x == is_odd_in_y;
                corner_values.push(if is_real { re * cos - im * sin } else { re * sin + im * cos });
            }
            self.find_x_differences(corner_values, is_odd_in_x, x_differences);
            for (class, [i, j]) in self.classes.iter().enumerate() {
                let column = &x_differences[i * column_height..(i + 1) * column_height];
                let previous_row = if *j > 0 { j - 1 } else { 1 };
                let sign = if *j == 0 && is_odd_in_y { -1.0 } else { 1.0 };
                let difference = sign * column[previous_row] - 2.0 * column[*j] + column[j + 1];
                forms[(wave + 1) * class_count + class] = factor * difference;
            }
        }
        for (class, offset) in self.classes.iter().enumerate() {
            let residues = residue_differences(k, self.lattice.pitch, *offset);
            for (form, residue) in (1..).zip(residues) {
                forms[form * class_count + class] += residue;
            }
            forms[class] = forms[class_count + class] + forms[2 * class_count + class];
        }
    }

    /// Overwrites `x_differences` with the second differences in x of a function at all corners, column by column.
    ///
    /// The function is even or odd in x, so that the column before the first column equals the second column or its
    /// negative.
    fn find_x_differences(
        &self,
        corner_values: &[f64],
        is_odd_in_x: bool,
        x_differences: &mut Vec<f64>,
    ) {
        let column_height = self.lattice.offset_counts()[1] + 1;
        x_differences.clear();
        for i in 0..self.lattice.offset_counts()[0] {
            let previous_column = if i > 0 { i - 1 } else { 1 };
            let sign = if i == 0 && is_odd_in_x { -1.0 } else { 1.0 };
            for j in 0..column_height {
                x_differences.push(
                    sign * corner_values[previous_column * column_height + j]
                        - 2.0 * corner_values[i * column_height + j]
                        + corner_values[(i + 1) * column_height + j],
                );
            }
        }
    }

    /// Chebyshev coefficients of all amplitudes on the band from `band_start` on.
    fn amplitude_coefficients(&self, band_start: f64) -> Vec<f64> {
        let column_height = self.lattice.offset_counts()[1] + 1;
        let pitch = self.lattice.pitch;
        let corner_count = self.distances.len();
        let mut coefficients = vec![0.0; BAND_NODE_COUNT * 2 * CORNER_WAVE_COUNT * corner_count];
        for node in 0..BAND_NODE_COUNT {
            let angle = PI * (node as f64 + 0.5) / BAND_NODE_COUNT as f64;
            let k = band_start * (1.0 + 0.5 * (1.0 + angle.cos()));
            for corner in 1..corner_count {
                let i = corner / column_height;
                let j = corner % column_height;
                let amplitudes = amplitudes(k, [pitch[0] * i as f64, pitch[1] * j as f64]);
                for (wave, (amplitude, [is_odd_in_x, is_odd_in_y])) in
                    amplitudes.into_iter().zip(ODD_IN_X_AND_Y).enumerate()
                {
                    if (is_odd_in_x && i == 0) || (is_odd_in_y && j == 0) {
                        continue;
                    }
                    for degree in 0..BAND_NODE_COUNT {
                        let norm = if degree == 0 { 1.0 } else { 2.0 } / BAND_NODE_COUNT as f64;
                        let factor = norm * (degree as f64 * angle).cos();
                        let index = (degree * CORNER_WAVE_COUNT + wave) * 2 * corner_count + corner;
                        coefficients[index] += factor * amplitude.re;
                        coefficients[index + corner_count] += factor * amplitude.im;
                    }
                }
            }
        }
        coefficients
    }
}

/// Second differences of the poles' residues between the paths, for all forms but g₀.
///
/// The residues are −|Y| cos kX k⁻³ and −|X| cos kY k⁻³ of `g_cc` and `g_ss`, −(sign Y sin kX + sign X sin kY) k⁻⁴ of `g_cs`,
/// −|Y| sin kX k⁻³ + sign X cos kY k⁻⁴ of `g_c`, and with X and Y exchanged of `g_s`.
fn residue_differences(k: f64, pitch: [f64; 2], offset: [usize; 2]) -> [f64; CORNER_WAVE_COUNT] {
    let mut differences = [0.0; CORNER_WAVE_COUNT];
    for axis in 0..2 {
        let other_axis = 1 - axis;
        if offset[other_axis] > 1 {
            continue;
        }
        // Indices of the forms g_cc, g_c and g_s along x, and of g_ss, g_s and g_c along y.
        let [cosine_form, sine_form, neighbour_form] = [[0, 3, 4], [1, 4, 3]][axis];
        let factor = 4.0 * (0.5 * k * pitch[axis]).sin().powi(2) * k.powi(-4);
        let phase = k * pitch[axis] * offset[axis] as f64;
        let sin = phase.sin();
        let cos = phase.cos();
        if offset[other_axis] == 0 {
            differences[cosine_form] += 2.0 * k * pitch[other_axis] * factor * cos;
            differences[sine_form] += 2.0 * k * pitch[other_axis] * factor * sin;
        } else {
            differences[2] -= factor * sin;
            differences[neighbour_form] += factor * cos;
        }
    }
    differences
}

/// Amplitudes of the waves from the stationary point θ = φ, times k⁴ 2π e^(−ikR).
///
/// The corner is at (X, Y) ≠ (0, 0) with X, Y ≥ 0.
fn amplitudes(k: f64, [x, y]: [f64; 2]) -> [Complex; CORNER_WAVE_COUNT] {
    let distance = x.hypot(y);
    let cos = x / distance;
    let sin = y / distance;
    let h = PATH_STEP_FACTOR / (k * distance).sqrt();
    let one = Complex::real(1.0);
    // p = turn × √2 sin ½(θ − φ).
    let turn = Complex::polar(1.0, 0.5 * FRAC_PI_2);
    let mut sums = [Complex::default(); CORNER_WAVE_COUNT];
    for n in 0..2 * PATH_HALF_POINTS {
        let steps_from_center = n as f64 + 0.5 - PATH_HALF_POINTS as f64;
        let p = steps_from_center * h;
        // Sine and cosine of ½(θ − φ) and of θ − φ on the path.
        let half_sine = turn.conj().scale(p / SQRT_2);
        let half_cosine = Complex::new(1.0, 0.5 * p * p).sqrt();
        let path_cosine = Complex::new(1.0, p * p);
        let path_sine = (half_sine * half_cosine).scale(2.0);
        let c = path_cosine.scale(cos) - path_sine.scale(sin);
        let s = path_cosine.scale(sin) + path_sine.scale(cos);
        // dp e^(−kRp²) dθ/dp.
        let decay = (-(steps_from_center * PATH_STEP_FACTOR).powi(2)).exp();
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
    add_pole_terms(k, [x, y], h, &mut sums);
    sums
}

/// Adds the terms of the poles beside the path and on the path to the sums of the trapezoidal rule with the step `h`.
fn add_pole_terms(k: f64, [x, y]: [f64; 2], h: f64, sums: &mut [Complex; CORNER_WAVE_COUNT]) {
    let distance = x.hypot(y);
    let direction = y.atan2(x);
    let one = Complex::real(1.0);
    // p = turn × √2 sin ½(θ − φ).
    let turn = Complex::polar(1.0, 0.5 * FRAC_PI_2);
    for (angle, [c, s]) in POLE_DIRECTIONS {
        let pole_angle = angle - direction;
        let wave = Complex::polar(1.0, k * (x * c + y * s - distance));
        let log_derivative = Complex::new(0.0, k * (y * c - x * s));
        let poles = poles([c, s], log_derivative);
        // dp/dθ at the pole.
        let path_slope = turn.scale((0.5 * pole_angle).cos() / SQRT_2);
        if pole_angle == 0.0 {
            for (sum, [double_pole, _]) in sums.iter_mut().zip(poles) {
                *sum = *sum - (double_pole * path_slope * wave).scale(PI * PI / h);
            }
            continue;
        }
        // 2πi p/h with the sign of Im p.
        let exponent =
            (turn * Complex::new(0.0, TAU)).scale(SQRT_2 * (0.5 * pole_angle).sin().abs() / h);
        let exponential = exponent.exp();
        let inverse = (one + exponential).inverse();
        // 1/(1 + e^(−…)) and its derivative with respect to the exponent.
        let correction = exponential * inverse;
        let correction_slope = exponential * inverse * inverse;
        let sign = if pole_angle > 0.0 { 1.0 } else { -1.0 };
        let rate = (Complex::new(0.0, TAU) * path_slope).scale(sign / h);
        for (sum, [double_pole, simple_pole]) in sums.iter_mut().zip(poles) {
            let residue = (simple_pole * correction + double_pole * correction_slope * rate) * wave;
            *sum += residue * Complex::new(0.0, sign * TAU);
        }
    }
}

/// Coefficients of (θ − θ₀)⁻² and (θ − θ₀)⁻¹ of all waves at the pole in the direction (c, s) of an axis.
///
/// `log_derivative`: logarithmic derivative of the wave e^(…) at the pole.
fn poles([c, s]: [f64; 2], log_derivative: Complex) -> [[Complex; 2]; CORNER_WAVE_COUNT] {
    // Coefficients of the double and of the simple pole of q for each wave.
    let coefficients = if s == 0.0 {
        [[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [c, 0.0], [0.0, c]]
    } else {
        [[0.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, -s], [s, 0.0]]
    };
    coefficients.map(|[double_pole, simple_pole]| {
        if double_pole == 0.0 {
            [Complex::default(), Complex::real(simple_pole)]
        } else {
            [Complex::real(double_pole), log_derivative.scale(double_pole)]
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::forms::AngularMeans;
    use super::*;

    /// Waves agree with sums over directions at both ends of bands and between; corners near an axis have near poles.
    #[test]
    fn waves_agree_with_sums_over_directions() {
        let mut max_error = 0.0_f64;
        for (pitch, counts) in [
            ([1.0, 1.0], [1, 1]),
            ([1.0, 0.7], [5, 4]),
            ([0.3, 0.9], [1, 3]),
            ([0.5, 0.5], [3, 24]),
        ] {
            let lattice = Lattice { pitch, counts };
            let min_wavenumber = CornerWaves::min_wavenumber(&lattice);
            let waves = CornerWaves::new(&lattice, min_wavenumber, 40.0 * min_wavenumber);
            let mut means = AngularMeans::new(&lattice);
            let mut buffers = WaveBuffers::default();
            for wavenumber_ratio in [1.0, 1.37, 1.999, 2.0, 3.7, 31.0] {
                let wavenumbers =
                    [1.0, 1.0 + 1e-4].map(|factor| wavenumber_ratio * min_wavenumber * factor);
                waves.fill_forms(&wavenumbers, &mut buffers);
                // Forms of a row or column decrease like k⁻³.
                let scale = (pitch[0] * pitch[1]).powi(2)
                    * (wavenumber_ratio * MIN_WAVENUMBER_TIMES_SIDE).powi(-3);
                let rows = buffers.values.chunks_exact(FORM_COUNT * waves.classes.len());
                for (k, row) in wavenumbers.into_iter().zip(rows) {
                    for (computed, expected) in row.iter().zip(means.at(k)) {
                        max_error = max_error.max((computed - expected).abs() / scale);
                    }
                }
            }
        }
        println!("{max_error:e}");
        assert!(max_error < 1e-11, "{max_error:e}");
    }
}
