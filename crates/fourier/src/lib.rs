//! Plans of Fourier transforms in double precision.
//!
//! The transforms of `rustfft` are generic, so every crate that makes plans of `rustfft` compiles them again: about 20
//! % of the code of such a crate. In this crate they are compiled once, for all others.
#![forbid(unsafe_code)]

use std::fmt;
use std::sync::Arc;

pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::{Fft, num_complex};

/// Plans of transforms between real series and complex spectra; equal plans share their tables.
pub struct RealPlanner(realfft::RealFftPlanner<f64>);

impl RealPlanner {
    /// Planner without plans.
    pub fn new() -> Self {
        Self(realfft::RealFftPlanner::new())
    }

    /// The transform of `length` real numbers to a spectrum.
    pub fn plan_fft_forward(&mut self, length: usize) -> Arc<dyn RealToComplex<f64>> {
        self.0.plan_fft_forward(length)
    }

    /// The transform of a spectrum to `length` real numbers, without the factor 1/`length`.
    pub fn plan_fft_inverse(&mut self, length: usize) -> Arc<dyn ComplexToReal<f64>> {
        self.0.plan_fft_inverse(length)
    }
}

impl Default for RealPlanner {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Debug for RealPlanner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RealPlanner").finish_non_exhaustive()
    }
}

/// Plans of transforms of complex series; equal plans share their tables.
pub struct ComplexPlanner(rustfft::FftPlanner<f64>);

impl ComplexPlanner {
    /// Planner without plans.
    pub fn new() -> Self {
        Self(rustfft::FftPlanner::new())
    }

    /// The forward transform of `length` numbers, Σ xⱼ exp(−2πi jk/`length`).
    pub fn plan_fft_forward(&mut self, length: usize) -> Arc<dyn Fft<f64>> {
        self.0.plan_fft_forward(length)
    }

    /// The inverse transform of `length` numbers, without the factor 1/`length`.
    pub fn plan_fft_inverse(&mut self, length: usize) -> Arc<dyn Fft<f64>> {
        self.0.plan_fft_inverse(length)
    }
}

impl Default for ComplexPlanner {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Debug for ComplexPlanner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ComplexPlanner").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::num_complex::Complex64;
    use super::{ComplexPlanner, RealPlanner};

    /// A cosine of three periods has the spectrum n/2 at 3; the inverse returns n times the cosine.
    #[test]
    fn plans_transform_a_cosine() {
        for length in [24, 31, 128] {
            let cosine = |j: usize| (std::f64::consts::TAU * 3.0 * j as f64 / length as f64).cos();
            let mut real_series: Vec<f64> = (0..length).map(cosine).collect();
            let mut complex_series: Vec<Complex64> =
                real_series.iter().map(|x| Complex64::new(*x, 0.0)).collect();
            let mut real_planner = RealPlanner::new();
            let forward = real_planner.plan_fft_forward(length);
            let mut spectrum = forward.make_output_vec();
            forward.process(&mut real_series, &mut spectrum).unwrap();
            let mut complex_planner = ComplexPlanner::default();
            complex_planner.plan_fft_forward(length).process(&mut complex_series);
            for (k, value) in spectrum.iter().enumerate() {
                let exact_value = if k == 3 { 0.5 * length as f64 } else { 0.0 };
                assert!(
                    (value - exact_value).norm() < 1e-12
                        && (complex_series[k] - exact_value).norm() < 1e-12,
                    "{k}"
                );
            }
            real_planner
                .plan_fft_inverse(length)
                .process(&mut spectrum, &mut real_series)
                .unwrap();
            complex_planner.plan_fft_inverse(length).process(&mut complex_series);
            for (j, value) in real_series.iter().enumerate() {
                let exact_value = length as f64 * cosine(j);
                assert!(
                    (value - exact_value).abs() < 1e-11
                        && (complex_series[j] - exact_value).norm() < 1e-11
                );
            }
        }
    }
}
