//! GOAL: a motion that passes through a site is recovered, whatever its frequencies.
//! SCENE: three damped layers on rock; noise, pulses, impulses and records, odd and even numbers of samples, one sample.
//! REFERENCE: the motion itself; a zero-padded Fourier transform with `transfer`.

use std::f64::consts::{PI, TAU};

use basemat::motion::el_centro_1940;
use basemat::site::{
    ControlPoint, InclinedControl, InclinedWave, SiteMotion, SoilColumn, VerticalWave,
};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::{Complex, Soil, unobserved};
use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;

use basemat_problems::dense::largest;
use basemat_problems::random::Random;

fn damping(ratio: f64) -> GeneralizedMaxwell {
    GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0).unwrap()
}

fn profile() -> SoilProfile {
    let rock = Soil::from_shear_wave_speed(1000.0, 0.25, 2300.0).unwrap();
    let mut profile = SoilProfile::on_half_plane(rock).with_bedrock_damping(damping(0.01));
    for (speed, height, ratio) in [(180.0, 6.0, 0.05), (260.0, 9.0, 0.04), (400.0, 15.0, 0.03)] {
        let soil = Soil::from_shear_wave_speed(speed, 0.35, 1900.0).unwrap();
        profile = profile.with_layer(soil, height).unwrap().with_damping(damping(ratio));
    }
    profile
}

fn noise(random: &mut Random, count: usize) -> Vec<f64> {
    (0..count).map(|_| random.within(-1.0, 1.0)).collect()
}

/// Rise over 4 s, decay after 8 s.
fn envelope(t: f64) -> f64 {
    (t / 4.0).min(1.0) * (-((t - 8.0).max(0.0)) / 3.0).exp()
}

/// Zeros with a one at `index`.
fn impulse(count: usize, index: usize) -> Vec<f64> {
    let mut samples = vec![0.0; count];
    samples[index] = 1.0;
    samples
}

/// Values of a function at each index.
fn samples_of(count: usize, function: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..count).map(function).collect()
}

/// Names, time steps and samples.
fn records() -> Vec<(&'static str, f64, Vec<f64>)> {
    let mut random = Random(23);
    let mut enveloped = noise(&mut random, 2001);
    for (i, sample) in enveloped.iter_mut().enumerate() {
        *sample = 4.0 * *sample * envelope(0.01 * i as f64);
    }
    vec![
        ("noise under an envelope", 0.01, enveloped),
        ("noise, even", 0.01, noise(&mut random, 2000)),
        ("noise, odd", 0.01, noise(&mut random, 777)),
        ("noise, fine", 0.002, noise(&mut random, 4096)),
        ("noise, coarse", 0.05, noise(&mut random, 300)),
        (
            "rectangle of 0.3 s",
            0.01,
            samples_of(400, |i| f64::from(u8::from((50..80).contains(&i)))),
        ),
        ("step", 0.01, samples_of(500, |i| f64::from(u8::from(i >= 250)))),
        ("impulse at first", 0.01, impulse(300, 0)),
        ("impulse in the middle", 0.01, impulse(301, 150)),
        ("impulse at last", 0.01, impulse(300, 299)),
        ("highest frequency", 0.01, samples_of(256, |i| 1.0 - 2.0 * (i % 2) as f64)),
        ("near the highest frequency", 0.01, samples_of(257, |i| (0.97 * PI * i as f64).sin())),
        ("El Centro", 0.02, el_centro_1940().accelerations().to_vec()),
        (
            "El Centro, resampled",
            0.004,
            el_centro_1940().resampled(0.004).unwrap().accelerations().to_vec(),
        ),
        (
            "El Centro, coarse",
            0.08,
            el_centro_1940().accelerations().iter().step_by(4).copied().collect(),
        ),
        (
            "Ricker",
            0.01,
            samples_of(300, |i| {
                let a = ((0.01 * i as f64 - 1.5) / 0.1).powi(2);
                (1.0 - 2.0 * a) * (-a).exp()
            }),
        ),
        (
            "sweep",
            0.01,
            samples_of(1500, |i| (TAU * 50.0 * (i as f64).powi(2) / 3000.0 / 100.0).sin()),
        ),
        ("one sample", 0.01, vec![1.0]),
        ("two samples", 0.01, vec![1.0, -0.5]),
        ("three samples", 0.005, vec![0.3, -1.0, 0.2]),
    ]
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |m, (a, b)| (a - b).abs().max(m))
}

fn padded(samples: &[f64], before: usize, after: usize) -> Vec<f64> {
    let mut motion = vec![0.0; before];
    motion.extend(samples);
    motion.resize(before + samples.len() + after, 0.0);
    motion
}

/// Length of the zero-padded transform.
fn transform_length(motion: &[f64]) -> usize {
    (motion.len() + 32_768).next_power_of_two()
}

/// The motion by a zero-padded transform, times a factor for each of its frequencies.
fn filtered(motion: &[f64], factors: impl Iterator<Item = Complex>) -> Vec<f64> {
    let length = transform_length(motion);
    let mut planner = RealFftPlanner::<f64>::new();
    let forward = planner.plan_fft_forward(length);
    let inverse = planner.plan_fft_inverse(length);
    let mut values = padded(motion, 0, length - motion.len());
    let mut spectrum = forward.make_output_vec();
    forward.process(&mut values, &mut spectrum).unwrap();
    for (value, factor) in spectrum.iter_mut().zip(factors) {
        *value *= Complex64::new(factor.re, factor.im);
    }
    let last_index = spectrum.len() - 1;
    spectrum[0].im = 0.0;
    spectrum[last_index].im = 0.0;
    inverse.process(&mut spectrum, &mut values).unwrap();
    values[..motion.len()].iter().map(|x| x / length as f64).collect()
}

/// Factor of a low-pass filter: 1 up to 93 % of the highest frequency, 0 above 97 %.
fn low_pass(ratio: f64) -> f64 {
    0.5 + 0.5 * (PI * ((ratio - 0.93) / 0.04).clamp(0.0, 1.0)).cos()
}

/// A motion at the surface, the motion recovered from it, and its error.
struct RoundTrip {
    surface: SiteMotion,
    recovered_motion: SiteMotion,
    /// Largest difference from the motion, over its peak.
    error: f64,
}

impl RoundTrip {
    fn new(column: &SoilColumn, control: ControlPoint, step: f64, motion: &[f64]) -> Self {
        let surface = column.to_surface(control, step, motion, &mut unobserved).unwrap();
        let recovered_motion =
            column.from_surface(control, step, &surface.samples, &mut unobserved).unwrap();
        let error = largest_difference(motion, &recovered_motion.samples) / largest(motion);
        Self { surface, recovered_motion, error }
    }
}

/// GOAL: with quiet time on both sides a motion is recovered; without quiet time the size of the lost motion is
/// reported.
#[test]
fn motions_are_recovered_through_a_site() {
    let column = SoilColumn::new(profile(), VerticalWave::Shear).unwrap();
    let mut largest_error = 0.0_f64;
    let mut largest_ratio = 0.0_f64;
    for (name, step, samples) in records() {
        for control in [ControlPoint::Outcrop, ControlPoint::Within] {
            let RoundTrip { surface, recovered_motion, error } =
                RoundTrip::new(&column, control, step, &with_quiet(step, &samples));
            assert!(
                surface.is_whole() && recovered_motion.is_whole() && error < 1e-9,
                "{name}, {control:?}: {error:e}; {surface}; {recovered_motion}"
            );
            largest_error = largest_error.max(error);
            let RoundTrip { surface, recovered_motion, error } =
                RoundTrip::new(&column, control, step, &samples);
            let reported = surface
                .before
                .max(surface.after)
                .max(recovered_motion.before)
                .max(recovered_motion.after);
            let ratio = error * largest(&samples) / reported;
            assert!(
                !surface.is_whole() && ratio < 3.0,
                "{name}, {control:?}: {error:e}; {surface}"
            );
            largest_ratio = largest_ratio.max(ratio);
        }
    }
    println!("error {largest_error:e}; cut off: error up to {largest_ratio:.2} of the reported");
}

/// Errors of a motion of the surface against its transfer function.
struct TransferErrors {
    /// Below the highest frequencies, over the peak.
    low_frequencies: f64,
    /// At all frequencies, over the size reported near the highest.
    ratio_to_reported: f64,
}

/// Checks a motion of the surface against the transfer function at the frequencies of the transform.
fn check_transfer(
    name: &str,
    motion: &[f64],
    surface: &SiteMotion,
    transfer: &[Complex],
) -> TransferErrors {
    let length = transform_length(motion);
    let low_pass: Vec<f64> =
        (0..=length / 2).map(|l| low_pass(2.0 * l as f64 / length as f64)).collect();
    let factors = transfer.iter().zip(&low_pass).map(|(factor, low)| *factor * *low);
    let expected = filtered(motion, factors);
    let computed = filtered(&surface.samples, low_pass.iter().map(|low| Complex::real(*low)));
    let low_frequencies = largest_difference(&expected, &computed) / surface.peak();
    assert!(low_frequencies < 1e-9, "{name}: {low_frequencies:e}; {surface}");
    let expected = filtered(motion, transfer.iter().copied());
    let error = largest_difference(&surface.samples, &expected);
    let ratio_to_reported = (error - 1e-9 * surface.peak()) / surface.near_nyquist;
    assert!(ratio_to_reported < 4.0, "{name}: {error:e}; {surface}");
    println!("{name:27}: {low_frequencies:8.1e}, {:8.1e}; {surface}", error / surface.peak());
    TransferErrors { low_frequencies, ratio_to_reported }
}

/// GOAL: the motion of the surface follows the transfer function; at the highest frequencies the reported size is right
/// to a factor of four.
#[test]
fn the_surface_follows_the_transfer_function() {
    let column = SoilColumn::new(profile(), VerticalWave::Shear).unwrap();
    let sv = InclinedWave::sv(profile(), 0.35).unwrap();
    let p = InclinedWave::p(profile(), -0.8).unwrap();
    let mut errors = vec![];
    for (name, step, samples) in records() {
        let motion = with_quiet(step, &samples);
        let length = transform_length(&motion);
        let frequencies: Vec<f64> =
            (0..=length / 2).map(|l| l as f64 / (length as f64 * step)).collect();
        let control = ControlPoint::Outcrop;
        let surface = column.to_surface(control, step, &motion, &mut unobserved).unwrap();
        let transfer: Vec<Complex> =
            frequencies.iter().map(|f| column.transfer(control, *f).unwrap()).collect();
        errors.push(check_transfer(name, &motion, &surface, &transfer));
        for (wave, control) in
            [(&sv, InclinedControl::OutcropHorizontal), (&p, InclinedControl::Incident)]
        {
            let surface = wave.to_surface(control, step, &motion, &mut unobserved).unwrap();
            let transfers: Vec<[Complex; 2]> =
                frequencies.iter().map(|f| wave.transfer(control, *f).unwrap()).collect();
            for component in 0..2 {
                let transfer: Vec<Complex> =
                    transfers.iter().map(|transfer| transfer[component]).collect();
                errors.push(check_transfer(name, &motion, &surface[component], &transfer));
            }
        }
    }
    let low = errors.iter().fold(0.0_f64, |m, errors| m.max(errors.low_frequencies));
    let ratio = errors.iter().fold(0.0_f64, |m, errors| m.max(errors.ratio_to_reported));
    println!("low frequencies: {low:e}; all: up to {ratio:.2} of the reported size");
}

/// The record between quiet times in which motions near the highest frequency decay.
fn with_quiet(step: f64, samples: &[f64]) -> Vec<f64> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
    let quiet_samples = (45.0 / step) as usize;
    padded(samples, 2400, quiet_samples.max(4800))
}
