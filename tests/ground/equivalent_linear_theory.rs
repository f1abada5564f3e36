//! GOAL: strains and motions of the equivalent-linear iteration agree with theory.
//! SCENE: one soil in four layers on rigid bedrock; clay on rock.
//! REFERENCE: sine and cosine of complex numbers; the linear column by a plain Fourier sum.

use std::f64::consts::{PI, TAU};

use basemat::motion::Record;
use basemat::site::{
    ComplexModulus, ControlPoint, EquivalentLinearOptions, SoilColumn, VerticalWave,
};
use basemat::soil::{Hysteretic, SoilProfile, StrainCurves};
use basemat::{Complex, Soil, unobserved};

use super::equivalent_linear::{LayeredSite, motion};

/// Four layers of one soil on rigid bedrock.
pub(super) fn uniform_profile(damping: f64) -> SoilProfile {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock();
    let profile = (0..4).fold(profile, |profile, _| profile.with_layer(soil, 5.0).unwrap());
    profile.with_damping(Hysteretic::new(damping).unwrap())
}

/// GOAL: the largest strains and accelerations of a long harmonic motion follow from theory.
/// REFERENCE: one layer over a rigid base has u = cos kz/cos kH; the strain over the base's acceleration is
/// k sin kz/(ω² cos kH) with k = ω/c complex.
#[test]
fn strains_of_a_harmonic_are_those_of_theory() {
    check_strains_of_harmonics(ComplexModulus::RealPart, 0.08, Complex::new(1.0, 0.16).sqrt());
    // The modulus is G e^(2i asin ξ), of magnitude G: the phase of c is asin ξ.
    let sine = 0.2_f64;
    let cosine = (1.0 - 0.04_f64).sqrt();
    check_strains_of_harmonics(ComplexModulus::Magnitude, sine, Complex::new(cosine, sine));
}

/// Harmonic of 40 s that rises and falls over 8 s.
fn ramped_harmonic(omega: f64) -> Record {
    let acceleration = |t: f64| {
        let ramp = (PI / 16.0 * t.min(40.0 - t).min(8.0)).sin().powi(2);
        ramp * (omega * t).sin()
    };
    Record::from_fn(0.001, 40.0, acceleration).unwrap()
}

/// Cosine and sine of a complex number.
fn cosine_and_sine(x: Complex) -> [Complex; 2] {
    let e = (Complex::new(0.0, 1.0) * x).exp();
    [(e + e.inverse()) * 0.5, (e - e.inverse()) * Complex::new(0.0, -0.5)]
}

/// Compares strains and accelerations of harmonics; `root` is √(G*/G).
fn check_strains_of_harmonics(complex_modulus: ComplexModulus, damping: f64, root: Complex) {
    let depth = 20.0;
    let column = SoilColumn::new(uniform_profile(0.5), VerticalWave::Shear).unwrap();
    let curves = vec![StrainCurves::Linear { damping }; 4];
    let options = EquivalentLinearOptions {
        control: ControlPoint::Within,
        complex_modulus,
        ..EquivalentLinearOptions::default()
    };
    for frequency in [0.8, 2.5, 4.0, 7.5, 9.0] {
        let omega = 2.0 * PI * frequency;
        let motion = ramped_harmonic(omega);
        let computed =
            column.equivalent_linear(&motion, &curves, &options, &mut unobserved).unwrap();
        assert_eq!((computed.iterations, computed.last_change), (1, 0.0));
        let wavenumber = Complex::real(omega / 200.0) / root;
        let cosine_at_base = cosine_and_sine(wavenumber * depth)[0];
        for (k, layer) in computed.layers.iter().enumerate() {
            let sine = cosine_and_sine(wavenumber * (5.0 * k as f64 + 2.5))[1];
            let expected = (wavenumber * sine / cosine_at_base).abs() / (omega * omega);
            let ratio = layer.largest_strain / expected;
            println!("{frequency} Hz, layer {k}: {ratio}");
            assert!((ratio - 1.0).abs() < 2e-3, "{frequency} {k} {ratio}");
            assert_eq!(layer.effective_strain, 0.65 * layer.largest_strain);
        }
        for (k, peak) in computed.peak_accelerations.iter().enumerate() {
            let cosine = cosine_and_sine(wavenumber * (5.0 * k as f64))[0];
            let ratio = peak / (cosine / cosine_at_base).abs();
            assert!((ratio - 1.0).abs() < 2e-3, "{frequency} {k} {ratio}");
        }
    }
}

/// Number of samples of the plain Fourier sum, a power of two far above the 512 of the record.
const FOURIER_LENGTH: usize = 16_384;

/// e^(2πi k/n) for n samples of the Fourier sum.
fn root_of_unity(k: usize) -> Complex {
    let angle = TAU * (k % FOURIER_LENGTH) as f64 / FOURIER_LENGTH as f64;
    Complex::new(angle.cos(), angle.sin())
}

/// A pulse of 1.6 Hz, 1e-6 m/s² high: nothing of its spectrum reaches 25 Hz.
fn small_pulse(t: f64) -> f64 {
    let a = (5.0 * (t - 1.2)).powi(2);
    1e-6 * (1.0 - 2.0 * a) * (-a).exp()
}

/// GOAL: at small strain the properties are the initial ones of the curves, and the surface moves as in the linear column.
/// REFERENCE: each frequency of the record by its transfer function, summed without a fast transform.
#[test]
fn small_motions_respond_as_in_the_linear_column() {
    let curves = vec![StrainCurves::Epri { depth: 4.0 }; 4];
    let damping = curves[0].at(0.0).unwrap()[1];
    let column = SoilColumn::new(uniform_profile(0.5), VerticalWave::Shear).unwrap();
    let mut linear_profile = SoilProfile::on_rigid_bedrock();
    for layer in uniform_profile(0.5).layers() {
        let law = Hysteretic::new(damping).unwrap();
        linear_profile =
            linear_profile.with_layer(layer.soil, layer.thickness).unwrap().with_damping(law);
    }
    let linear_column = SoilColumn::new(linear_profile, VerticalWave::Shear).unwrap();
    let time_step = 0.02;
    let samples = (0..512).map(|i| small_pulse(time_step * f64::from(i))).collect();
    let motion = Record::new(time_step, samples).unwrap();
    let options = EquivalentLinearOptions {
        control: ControlPoint::Within,
        ..EquivalentLinearOptions::default()
    };
    let computed = column.equivalent_linear(&motion, &curves, &options, &mut unobserved).unwrap();
    assert_eq!((computed.iterations, computed.last_change), (1, 0.0));
    assert_eq!(computed.layers[0].modulus_ratio, 1.0);
    // Transform of the surface's motion up to 12 Hz; the pulse has 1e-14 of its spectrum above.
    let transform: Vec<Complex> = (1..4000)
        .map(|l| {
            let samples = motion.accelerations().iter().enumerate();
            let sum = samples.fold(Complex::default(), |sum, (i, a)| {
                sum + root_of_unity((FOURIER_LENGTH - l) * i) * *a
            });
            let frequency = l as f64 / (time_step * FOURIER_LENGTH as f64);
            sum * linear_column.transfer(ControlPoint::Within, frequency).unwrap()
        })
        .collect();
    let mut largest_error = 0.0_f64;
    for (i, computed) in computed.surface.accelerations().iter().enumerate().step_by(7) {
        let terms = transform.iter().enumerate();
        let sum: f64 = terms.map(|(l, value)| (*value * root_of_unity((l + 1) * i)).re).sum();
        let expected = 2.0 * sum / FOURIER_LENGTH as f64;
        largest_error = largest_error.max((computed - expected).abs());
    }
    println!("{largest_error:e} of {:e}", computed.peak_accelerations[0]);
    assert!(largest_error < 1e-6 * computed.peak_accelerations[0], "{largest_error:e}");
}

/// GOAL: the profile of the result has its moduli at the first frequency, its damping over the band, Poisson's ratio,
/// and causal laws.
#[test]
fn profiles_are_ready_for_a_ground() {
    let site = LayeredSite::named("clay");
    let options = EquivalentLinearOptions::of_magnitude(6.9);
    assert!((options.strain_ratio - 0.59).abs() < 1e-15);
    let motion = motion(0.2);
    let computed = site
        .column()
        .equivalent_linear(&motion, &site.curves(), &options, &mut unobserved)
        .unwrap();
    let reference = computed.profile.first_frequency().unwrap();
    assert!((0.5..1.2).contains(&reference), "{reference}");
    for (compatible, layer) in computed.layers.iter().zip(computed.profile.layers()) {
        let properties = (layer.soil.shear_modulus(), layer.soil.poisson());
        assert_eq!(properties, (compatible.shear_modulus, 0.4));
        for frequency in [0.1, reference, 5.0, 30.0] {
            let s = Complex::new(0.0, TAU * frequency);
            let modulus = layer.damping.modulus(s);
            let ratio = 0.5 * modulus.im / modulus.re / compatible.damping;
            assert!((ratio - 1.0).abs() < 0.06, "{frequency} {ratio}");
            assert!(frequency != reference || (modulus.re - 1.0).abs() < 1e-9);
        }
        let [reduction, damping] = site.layers[0].curves.at(compatible.effective_strain).unwrap();
        let is_first = compatible.depth <= 0.0;
        assert!(!is_first || (reduction / compatible.modulus_ratio - 1.0).abs() < 1e-3);
        assert!(damping > 0.0);
    }
    // With the causal laws of the profile, the surface motion is nearly the same.
    let causal_column = SoilColumn::new(computed.profile.clone(), VerticalWave::Shear).unwrap();
    let surface = causal_column
        .to_surface(
            ControlPoint::Outcrop,
            motion.time_step(),
            motion.accelerations(),
            &mut unobserved,
        )
        .unwrap();
    let ratio = surface.peak() / computed.peak_accelerations[0];
    println!("peak by the causal profile over that of the iteration: {ratio}");
    assert!((0.8..1.25).contains(&ratio), "{ratio}");
}
