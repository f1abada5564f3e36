//! Motions through transfer functions, by Fourier transform.
//!
//! All runs at Re s = η > 0: a window e^(−ηt) that makes what wraps around the transform negligible
//! and undamped profiles regular.

use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;

use crate::complex::Complex;
use crate::error::{Error, Result, finite, positive};

/// ηT: what wraps around is e^(−24), rounding in the first half e^12 times that of the transform.
const WINDOW: f64 = 24.0;
/// Most samples of a motion.
const MOST_SAMPLES: usize = 1 << 27;

/// `motion`, samples `time_step` seconds apart, times each of N functions of s.
pub(super) fn filtered<const N: usize>(
    time_step: f64,
    motion: &[f64],
    mut filters: impl FnMut(Complex) -> Result<[Complex; N]>,
) -> Result<[Vec<f64>; N]> {
    positive("time step of a motion", time_step)?;
    if motion.is_empty() || motion.len() > MOST_SAMPLES {
        return Err(Error::Size {
            quantity: "motion of a column",
            found: motion.len(),
            needed: motion.len().clamp(1, MOST_SAMPLES),
        });
    }
    let length = (2 * motion.len()).next_power_of_two();
    let duration = length as f64 * time_step;
    let decay = positive("decay of the window", WINDOW / duration)?;
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
    let mut values = forward.make_input_vec();
    let window = |i: usize| (-WINDOW * i as f64 / length as f64).exp();
    for (i, (value, sample)) in values.iter_mut().zip(motion).enumerate() {
        *value = finite("sample of a motion", *sample)? * window(i);
    }
    let mut spectrum = forward.make_output_vec();
    let failed = |_| Error::Singular { matrix: "spectrum of a motion", order: length };
    forward.process(&mut values, &mut spectrum).map_err(failed)?;
    let last = spectrum.len() - 1;
    let mut spectra: [_; N] = std::array::from_fn(|_| spectrum.clone());
    for (l, value) in spectrum.iter().enumerate() {
        let s = Complex::new(decay, std::f64::consts::TAU * l as f64 / duration);
        for (spectrum, filter) in spectra.iter_mut().zip(filters(s)?) {
            let product = Complex::new(value.re, value.im) * filter;
            let imaginary = if l == 0 || l == last { 0.0 } else { product.im };
            spectrum[l] = Complex64::new(product.re, imaginary);
        }
    }
    let mut motions = std::array::from_fn(|_| vec![]);
    for (mut spectrum, found) in spectra.into_iter().zip(&mut motions) {
        inverse.process(&mut spectrum, &mut values).map_err(failed)?;
        let samples = values[..motion.len()].iter().enumerate();
        let back = |(i, value): (usize, &f64)| {
            finite("motion through the column", value / (window(i) * length as f64))
        };
        *found = samples.map(back).collect::<Result<_>>()?;
    }
    Ok(motions)
}
