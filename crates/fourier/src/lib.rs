//! Plans of Fourier transforms in double precision.
//!
//! The transforms of `rustfft` are generic, some 20 % of the code of a crate that makes plans: they are compiled here
//! only.
#![forbid(unsafe_code)]

use std::fmt;
use std::sync::Arc;

pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::{Fft, num_complex};

/// Plans of transforms between real series and complex spectra; equal plans share their tables.
pub struct RealPlanner(realfft::RealFftPlanner<f64>);

impl RealPlanner {
    /// A planner without plans.
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
    /// A planner without plans.
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

    /// Of a cosine of three periods both transforms have the spectrum n/2 at 3, and the inverse returns n times it.
    #[test]
    fn plans_transform_a_cosine() {
        for length in [24, 31, 128] {
            let cosine = |j: usize| (std::f64::consts::TAU * 3.0 * j as f64 / length as f64).cos();
            let mut series: Vec<f64> = (0..length).map(cosine).collect();
            let mut numbers: Vec<Complex64> =
                series.iter().map(|x| Complex64::new(*x, 0.0)).collect();
            let mut planner = RealPlanner::new();
            let forward = planner.plan_fft_forward(length);
            let mut spectrum = forward.make_output_vec();
            forward.process(&mut series, &mut spectrum).unwrap();
            let mut complex = ComplexPlanner::default();
            complex.plan_fft_forward(length).process(&mut numbers);
            for (k, value) in spectrum.iter().enumerate() {
                let exact = if k == 3 { 0.5 * length as f64 } else { 0.0 };
                assert!(
                    (value - exact).norm() < 1e-12 && (numbers[k] - exact).norm() < 1e-12,
                    "{k}"
                );
            }
            planner.plan_fft_inverse(length).process(&mut spectrum, &mut series).unwrap();
            complex.plan_fft_inverse(length).process(&mut numbers);
            for (j, value) in series.iter().enumerate() {
                let exact = length as f64 * cosine(j);
                assert!((value - exact).abs() < 1e-11 && (numbers[j] - exact).norm() < 1e-11);
            }
        }
    }
}
