//! GOAL: a motion goes through a site and comes back, whatever its frequencies.
//! SCENE: three damped layers on rock; noise, pulses, impulses, recorded, odd and even, one sample.
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

use basemat_problems::random::Random;

fn profile() -> SoilProfile {
    let damping = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0).unwrap();
    let rock = Soil::from_shear_wave_speed(1000.0, 0.25, 2300.0).unwrap();
    let mut profile = SoilProfile::on_half_plane(rock).with_bedrock_damping(damping(0.01));
    for (speed, height, ratio) in [(180.0, 6.0, 0.05), (260.0, 9.0, 0.04), (400.0, 15.0, 0.03)] {
        let soil = Soil::from_shear_wave_speed(speed, 0.35, 1900.0).unwrap();
        profile = profile.with_layer(soil, height).unwrap().with_damping(damping(ratio));
    }
    profile
}

/// Names, time steps and samples.
fn records() -> Vec<(&'static str, f64, Vec<f64>)> {
    let mut random = Random(23);
    let mut noise =
        |count: usize| -> Vec<f64> { (0..count).map(|_| random.within(-1.0, 1.0)).collect() };
    let envelope = |t: f64| (t / 4.0).min(1.0) * (-((t - 8.0).max(0.0)) / 3.0).exp();
    let one = |count: usize, place: usize| {
        let mut samples = vec![0.0; count];
        samples[place] = 1.0;
        samples
    };
    let of = |count: usize, f: &dyn Fn(usize) -> f64| (0..count).map(f).collect::<Vec<_>>();
    let enveloped = noise(2001);
    let enveloped = of(2001, &|i| 4.0 * enveloped[i] * envelope(0.01 * i as f64));
    vec![
        ("noise under an envelope", 0.01, enveloped),
        ("noise, even", 0.01, noise(2000)),
        ("noise, odd", 0.01, noise(777)),
        ("noise, fine", 0.002, noise(4096)),
        ("noise, coarse", 0.05, noise(300)),
        ("rectangle of 0.3 s", 0.01, of(400, &|i| f64::from(u8::from((50..80).contains(&i))))),
        ("step", 0.01, of(500, &|i| f64::from(u8::from(i >= 250)))),
        ("impulse at first", 0.01, one(300, 0)),
        ("impulse in the middle", 0.01, one(301, 150)),
        ("impulse at last", 0.01, one(300, 299)),
        ("highest frequency", 0.01, of(256, &|i| 1.0 - 2.0 * (i % 2) as f64)),
        ("near the highest frequency", 0.01, of(257, &|i| (0.97 * PI * i as f64).sin())),
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
            of(300, &|i| {
                let a = ((0.01 * i as f64 - 1.5) / 0.1).powi(2);
                (1.0 - 2.0 * a) * (-a).exp()
            }),
        ),
        ("sweep", 0.01, of(1500, &|i| (TAU * 50.0 * (i as f64).powi(2) / 3000.0 / 100.0).sin())),
        ("one sample", 0.01, vec![1.0]),
        ("two samples", 0.01, vec![1.0, -0.5]),
        ("three samples", 0.005, vec![0.3, -1.0, 0.2]),
    ]
}

fn peak(samples: &[f64]) -> f64 {
    samples.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

fn padded(samples: &[f64], before: usize, after: usize) -> Vec<f64> {
    let mut motion = vec![0.0; before];
    motion.extend(samples);
    motion.resize(before + samples.len() + after, 0.0);
    motion
}

/// Length of the zero-padded transform.
fn length(motion: &[f64]) -> usize {
    (motion.len() + 32_768).next_power_of_two()
}

/// By a zero-padded transform, times a factor for each of its frequencies.
fn reference(motion: &[f64], factors: impl Iterator<Item = Complex>) -> Vec<f64> {
    let length = length(motion);
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
    let mut values = padded(motion, 0, length - motion.len());
    let mut spectrum = forward.make_output_vec();
    forward.process(&mut values, &mut spectrum).unwrap();
    for (value, factor) in spectrum.iter_mut().zip(factors) {
        *value *= Complex64::new(factor.re, factor.im);
    }
    let last = spectrum.len() - 1;
    (spectrum[0].im, spectrum[last].im) = (0.0, 0.0);
    inverse.process(&mut spectrum, &mut values).unwrap();
    values[..motion.len()].iter().map(|x| x / length as f64).collect()
}

/// 1 up to 93 % of the highest frequency, 0 above 97 %.
fn low(ratio: f64) -> f64 {
    0.5 + 0.5 * (PI * ((ratio - 0.93) / 0.04).clamp(0.0, 1.0)).cos()
}

/// With quiet time on both sides nothing is lost, and it comes back; without, what is lost is said.
#[test]
fn there_and_back() {
    let column = SoilColumn::new(profile(), VerticalWave::Shear).unwrap();
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    for (name, step, samples) in records() {
        for control in [ControlPoint::Outcrop, ControlPoint::Within] {
            let way = |motion: &[f64]| {
                let surface = column.to_surface(control, step, motion, &mut unobserved).unwrap();
                let back =
                    column.from_surface(control, step, &surface.samples, &mut unobserved).unwrap();
                let error = apart(motion, &back.samples) / peak(motion);
                (error, surface, back)
            };
            let (error, surface, back) = way(&with_quiet(step, &samples));
            let whole = surface.is_whole() && back.is_whole();
            assert!(whole && error < 1e-9, "{name}, {control:?}: {error:e}; {surface}; {back}");
            worst = worst.max(error);
            let (error, surface, back) = way(&samples);
            let lost = surface.before.max(surface.after).max(back.before).max(back.after);
            let said = error * peak(&samples) / lost;
            assert!(!surface.is_whole() && said < 3.0, "{name}, {control:?}: {error:e}; {surface}");
            most = most.max(said);
        }
    }
    println!("error {worst:e}; cut off: error up to {most:.2} of what is said");
}

/// The arriving motion follows the transfer function, except at the highest frequencies, where the reported size is
/// right to a factor of four.
#[test]
fn the_surface_moves_by_the_transfer_function() {
    let column = SoilColumn::new(profile(), VerticalWave::Shear).unwrap();
    let sv = InclinedWave::sv(profile(), 0.35).unwrap();
    let p = InclinedWave::p(profile(), -0.8).unwrap();
    let (control, incident) = (InclinedControl::OutcropHorizontal, InclinedControl::Incident);
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    for (name, step, samples) in records() {
        let motion = with_quiet(step, &samples);
        let length = length(&motion);
        let frequencies = || (0..=length / 2).map(|l| l as f64 / (length as f64 * step));
        let lows = || (0..=length / 2).map(|l| low(2.0 * l as f64 / length as f64));
        let mut check = |found: &SiteMotion, transfer: &[Complex]| {
            let wanted = transfer.iter().zip(lows()).map(|(factor, low)| *factor * low);
            let passed = reference(&found.samples, lows().map(Complex::real));
            let error = apart(&reference(&motion, wanted), &passed) / found.peak();
            assert!(error < 1e-9, "{name}: {error:e}; {found}");
            worst = worst.max(error);
            let all = apart(&found.samples, &reference(&motion, transfer.iter().copied()));
            let said = (all - 1e-9 * found.peak()) / found.near_nyquist;
            assert!(said < 4.0, "{name}: {all:e}; {found}");
            most = most.max(said);
            println!("{name:27}: {error:8.1e}, {:8.1e}; {found}", all / found.peak());
        };
        let found =
            column.to_surface(ControlPoint::Outcrop, step, &motion, &mut unobserved).unwrap();
        let transfer = |f| column.transfer(ControlPoint::Outcrop, f).unwrap();
        check(&found, &frequencies().map(transfer).collect::<Vec<_>>());
        for (wave, control) in [(&sv, control), (&p, incident)] {
            let found = wave.to_surface(control, step, &motion, &mut unobserved).unwrap();
            let (x, up): (Vec<_>, Vec<_>) =
                frequencies().map(|f| wave.transfer(control, f).unwrap().into()).unzip();
            check(&found[0], &x);
            check(&found[1], &up);
        }
    }
    println!("low: {worst:e}; all: up to {most:.2} of what is said");
}

/// Records of any length have room around them in which all that is near the highest frequency ends.
fn with_quiet(step: f64, samples: &[f64]) -> Vec<f64> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
    let long = (45.0 / step) as usize;
    padded(samples, 2400, long.max(4800))
}
