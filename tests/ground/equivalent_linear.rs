//! GOAL: strain-compatible properties agree with another program, and the strains with theory. SCENE: clay, sand and
//! alternate layers on damped rock under El Centro; one layer in closed form. REFERENCE: pystrata's
//! `EquivalentLinearCalculator` (`equivalent_linear.csv`, from `equivalent_linear.py` beside it); sin and cos of
//! complex numbers.

use std::f64::consts::PI;
use std::fmt::Write as _;

use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::results::log_spaced;
use basemat::site::{
    ComplexModulus, ControlPoint, EquivalentLinear, EquivalentLinearOptions, SiteWarning,
    SoilColumn, VerticalWave,
};
use basemat::soil::{Hysteretic, SoilProfile, StrainCurves};
use basemat::{Complex, Error, Soil, unobserved};
use basemat_problems::faults::is_input_of;

const SITES: [&str; 3] = ["clay", "sand", "alternate"];
const PEAKS: [f64; 3] = [0.05, 0.2, 0.5];
const TABLE: &str = include_str!("../data/equivalent_linear.csv");

/// Thickness (m), shear wave speed (m/s), density (kg/m³), curves.
type Layer = (f64, f64, f64, StrainCurves);

/// Layers of a site, speed, density and damping ratio of its rock.
fn site(name: &str) -> (Vec<Layer>, [f64; 3]) {
    let clay = |k: u32| {
        let plasticity_index = if k < 4 { 30.0 } else { 50.0 };
        let curves = StrainCurves::VuceticDobry { plasticity_index };
        (3.0, 130.0 + 12.0 * f64::from(k), 1700.0, curves)
    };
    let sand = |k: u32| {
        let depth = 3.0 * f64::from(k) + 1.5;
        (3.0, 160.0 * (1.0 + depth / 3.0).powf(0.33), 1900.0, StrainCurves::Epri { depth })
    };
    let alternate = |k: u32| match k {
        12 => (4.0, 420.0, 2100.0, StrainCurves::Linear { damping: 0.02 }),
        0 | 4 | 8 => (1.5, 230.0, 1900.0, StrainCurves::SeedIdrissMean),
        2 | 6 | 10 => (1.5, 260.0, 1950.0, StrainCurves::SeedIdrissUpper),
        _ => {
            let curves = StrainCurves::Darendeli {
                plasticity_index: 20.0,
                overconsolidation: 2.0,
                mean_stress: 15.0e3 + 10.0e3 * f64::from(k),
                frequency: 1.0,
                cycles: 10.0,
            };
            (1.5, 170.0, 1800.0, curves)
        }
    };
    match name {
        "clay" => ((0..10).map(clay).collect(), [800.0, 2300.0, 0.01]),
        "sand" => ((0..15).map(sand).collect(), [760.0, 2200.0, 0.01]),
        _ => ((0..13).map(alternate).collect(), [600.0, 2200.0, 0.02]),
    }
}

fn column(layers: &[Layer], [speed, density, damping]: [f64; 3]) -> SoilColumn {
    let rock = Soil::from_shear_wave_speed(speed, 0.25, density).unwrap();
    let mut profile =
        SoilProfile::on_half_plane(rock).with_bedrock_damping(Hysteretic::new(damping).unwrap());
    for (thickness, speed, density, _) in layers {
        let soil = Soil::from_shear_wave_speed(*speed, 0.4, *density).unwrap();
        profile = profile.with_layer(soil, *thickness).unwrap();
    }
    SoilColumn::new(profile, VerticalWave::Shear).unwrap()
}

fn motion(peak: f64) -> Record {
    let record = el_centro_1940().resampled(0.01).unwrap().padded(1.0, 15.0).unwrap();
    record.scaled_to_peak(peak * STANDARD_GRAVITY).unwrap()
}

fn curves_of(layers: &[Layer]) -> Vec<StrainCurves> {
    layers.iter().map(|layer| layer.3.clone()).collect()
}

/// A name and numbers, as `equivalent_linear.py` reads them.
fn words(curves: &StrainCurves) -> String {
    match curves {
        StrainCurves::Linear { damping } => format!("linear,{damping}"),
        StrainCurves::SeedIdrissMean => "seed_idriss_mean".into(),
        StrainCurves::SeedIdrissUpper => "seed_idriss_upper".into(),
        StrainCurves::VuceticDobry { plasticity_index } => {
            format!("vucetic_dobry,{plasticity_index}")
        }
        StrainCurves::Epri { depth } => format!("epri,{depth}"),
        StrainCurves::Darendeli {
            plasticity_index,
            overconsolidation,
            mean_stress,
            frequency,
            cycles,
        } => {
            format!(
                "darendeli,{plasticity_index},{overconsolidation},{mean_stress},{frequency},{cycles}"
            )
        }
        other => unreachable!("{other:?}"),
    }
}

/// Curves of every kind.
fn all_curves() -> Vec<StrainCurves> {
    let drawn = [0.0, 15.0, 30.0, 50.0, 100.0, 200.0];
    let mut list = vec![StrainCurves::SeedIdrissMean, StrainCurves::SeedIdrissUpper];
    list.extend(drawn.map(|plasticity_index| StrainCurves::VuceticDobry { plasticity_index }));
    list.extend([3.0, 10.0, 20.0, 50.0, 100.0, 200.0].map(|depth| StrainCurves::Epri { depth }));
    let state = |plasticity_index, overconsolidation, mean_stress, frequency, cycles| {
        StrainCurves::Darendeli {
            plasticity_index,
            overconsolidation,
            mean_stress,
            frequency,
            cycles,
        }
    };
    list.extend([
        state(0.0, 1.0, 101_325.0, 1.0, 10.0),
        state(30.0, 2.0, 50e3, 1.0, 10.0),
        state(80.0, 8.0, 400e3, 5.0, 30.0),
    ]);
    list
}

/// Numbers of the table's lines that begin so.
fn rows(start: &str) -> Vec<Vec<f64>> {
    let rest = TABLE.lines().filter_map(|line| line.strip_prefix(start));
    rest.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect()
}

#[test]
fn curves_are_those_of_another_program() {
    for curves in all_curves() {
        let wanted = rows(&format!("curve,{},", words(&curves).replace(',', "/")));
        assert!(wanted.len() >= 6, "{curves:?}");
        for row in wanted {
            let found = curves.at(row[0]).unwrap();
            for (found, wanted) in found.iter().zip(&row[1..]) {
                assert!((found / wanted - 1.0).abs() < 2e-6, "{curves:?} {row:?} {found}");
            }
        }
    }
    // Between drawn plasticity indices: half way.
    let at = |plasticity_index| StrainCurves::VuceticDobry { plasticity_index }.at(2e-4).unwrap();
    let ([low, high], half) = ([at(50.0), at(100.0)], at(75.0));
    assert!((half[0] - 0.5 * (low[0] + high[0])).abs() < 1e-15);
    assert!((half[1] - 0.5 * (low[1] + high[1])).abs() < 1e-15);
}

/// Writes sites and results for `equivalent_linear.py`, which has pystrata compute them again.
#[test]
fn sites_respond_as_in_another_program() {
    let (periods, unscaled) = (log_spaced(0.05, 3.0, 19).unwrap(), motion(1.0));
    let list =
        |values: &[f64]| values.iter().fold(String::new(), |text, x| text + "," + &x.to_string());
    let mut file = format!("motion,{}{}\n", unscaled.time_step(), list(unscaled.accelerations()));
    writeln!(file, "periods{}", list(&periods)).unwrap();
    for curves in all_curves() {
        writeln!(file, "curve,{}", words(&curves)).unwrap();
    }
    let mut results = vec![];
    for name in SITES {
        let (layers, rock) = site(name);
        let column = column(&layers, rock);
        for peak in PEAKS {
            let options =
                EquivalentLinearOptions { tolerance: 1e-4, ..EquivalentLinearOptions::default() };
            let found = column
                .equivalent_linear(&motion(peak), &curves_of(&layers), &options, &mut unobserved)
                .unwrap();
            println!("{name} at {peak} g\n{found}");
            writeln!(file, "case,{name},{peak}").unwrap();
            for (thickness, speed, density, curves) in &layers {
                writeln!(file, "layer,{thickness},{speed},{density},{}", words(curves)).unwrap();
            }
            writeln!(file, "rock{}", list(&rock)).unwrap();
            let spectrum =
                found.surface.response_spectrum(&periods, 0.05, &mut unobserved).unwrap();
            let spectrum: Vec<f64> = spectrum.iter().map(|o| o.pseudo_acceleration).collect();
            let own = |k: usize| {
                let layer = &found.layers[k];
                [
                    layer.modulus_ratio,
                    layer.damping,
                    layer.largest_strain,
                    found.peak_accelerations[k],
                ]
            };
            let own: Vec<[f64; 4]> = (0..layers.len()).map(own).collect();
            for own in &own {
                writeln!(file, "own{}", list(own)).unwrap();
            }
            writeln!(file, "spectrum{}", list(&spectrum)).unwrap();
            results.push((format!("{name},{peak},"), own, spectrum));
        }
    }
    std::fs::write(concat!(env!("CARGO_TARGET_TMPDIR"), "/equivalent_linear.csv"), file).unwrap();
    let mut worst = [0.0_f64; 5];
    for (case, own, spectrum) in results {
        let wanted = rows(&format!("layer,{case}"));
        assert_eq!(wanted.len(), own.len(), "{case}");
        for (own, wanted) in own.iter().zip(&wanted) {
            for k in 0..4 {
                worst[k] = worst[k].max((own[k] / wanted[k] - 1.0).abs());
            }
        }
        let [wanted] = &rows(&format!("spectrum,{case}"))[..] else { panic!("{case}") };
        assert_eq!(wanted.len(), spectrum.len(), "{case}");
        for (own, wanted) in spectrum.iter().zip(wanted) {
            worst[4] = worst[4].max((own / wanted - 1.0).abs());
        }
    }
    println!("modulus, damping, strain, acceleration, spectrum: {worst:.5?}");
    assert!(worst.iter().all(|worst| *worst < 1e-3), "{worst:?}");
}

fn uniform(damping: f64) -> SoilProfile {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock();
    let profile = (0..4).fold(profile, |profile, _| profile.with_layer(soil, 5.0).unwrap());
    profile.with_damping(Hysteretic::new(damping).unwrap())
}

/// One layer in four parts over a rigid base: u = cos kz/cos kH, so strain over the base's acceleration is
/// k sin kz/(ω² cos kH) with k = ω/c complex. A long harmonic, well after its beginning.
#[test]
fn strains_of_a_harmonic_are_those_of_theory() {
    strains_of_a_harmonic(ComplexModulus::RealPart, 0.08, Complex::new(1.0, 0.16).sqrt());
    // Of magnitude G and twice the angle asin ξ, G e^(2i asin ξ): c turns by the angle.
    let (sine, cosine) = (0.2_f64, (1.0 - 0.04_f64).sqrt());
    strains_of_a_harmonic(ComplexModulus::Magnitude, sine, Complex::new(cosine, sine));
}

/// `root` is √(G*/G).
fn strains_of_a_harmonic(complex_modulus: ComplexModulus, damping: f64, root: Complex) {
    let depth = 20.0;
    let column = SoilColumn::new(uniform(0.5), VerticalWave::Shear).unwrap();
    let curves = vec![StrainCurves::Linear { damping }; 4];
    let options = EquivalentLinearOptions {
        control: ControlPoint::Within,
        complex_modulus,
        ..EquivalentLinearOptions::default()
    };
    for frequency in [0.8, 2.5, 4.0, 7.5, 9.0] {
        let omega = 2.0 * PI * frequency;
        let ramp = |t: f64| (PI / 16.0 * t.min(40.0 - t).min(8.0)).sin().powi(2);
        let wave = |t: f64| ramp(t) * (omega * t).sin();
        let motion = Record::from_fn(0.001, 40.0, wave).unwrap();
        let found = column.equivalent_linear(&motion, &curves, &options, &mut unobserved).unwrap();
        assert_eq!((found.iterations, found.last_change), (1, 0.0));
        let wavenumber = Complex::real(omega / 200.0) / root;
        let cosine = |x: Complex| {
            let e = (Complex::new(0.0, 1.0) * x).exp();
            [(e + e.inverse()) * 0.5, (e - e.inverse()) * Complex::new(0.0, -0.5)]
        };
        let [bottom, _] = cosine(wavenumber * depth);
        for (k, layer) in found.layers.iter().enumerate() {
            let [_, sine] = cosine(wavenumber * (5.0 * k as f64 + 2.5));
            let wanted = (wavenumber * sine / bottom).abs() / (omega * omega);
            let ratio = layer.largest_strain / wanted;
            println!("{frequency} Hz, layer {k}: {ratio}");
            assert!((ratio - 1.0).abs() < 2e-3, "{frequency} {k} {ratio}");
            assert_eq!(layer.effective_strain, 0.65 * layer.largest_strain);
        }
        for (k, peak) in found.peak_accelerations.iter().enumerate() {
            let [here, _] = cosine(wavenumber * (5.0 * k as f64));
            let ratio = peak / (here / bottom).abs();
            assert!((ratio - 1.0).abs() < 2e-3, "{frequency} {k} {ratio}");
        }
    }
}

/// At small strain properties equal the curves' beginning, and the surface moves as in the linear column: each
/// frequency of the record by its transfer function, summed without a fast transform.
#[test]
fn small_motions_pass_a_linear_column() {
    let curves = vec![StrainCurves::Epri { depth: 4.0 }; 4];
    let damping = curves[0].at(0.0).unwrap()[1];
    let column = SoilColumn::new(uniform(0.5), VerticalWave::Shear).unwrap();
    let linear = uniform(0.5);
    let linear = linear.layers().iter().fold(SoilProfile::on_rigid_bedrock(), |profile, layer| {
        let law = Hysteretic::new(damping).unwrap();
        profile.with_layer(layer.soil, layer.thickness).unwrap().with_damping(law)
    });
    let linear = SoilColumn::new(linear, VerticalWave::Shear).unwrap();
    // A pulse of 1.6 Hz, 1e-6 m/s² high: above the first frequency nothing is left at 25 Hz.
    let pulse = |t: f64| {
        let a = (5.0 * (t - 1.2)).powi(2);
        1e-6 * (1.0 - 2.0 * a) * (-a).exp()
    };
    let (step, count) = (0.02, 512);
    let motion =
        Record::new(step, (0..count).map(|i| pulse(step * f64::from(i))).collect()).unwrap();
    let options = EquivalentLinearOptions {
        control: ControlPoint::Within,
        ..EquivalentLinearOptions::default()
    };
    let found = column.equivalent_linear(&motion, &curves, &options, &mut unobserved).unwrap();
    assert_eq!((found.iterations, found.last_change, found.layers[0].modulus_ratio), (1, 0.0, 1.0));
    let length = 16_384;
    let frequency = |l: usize| l as f64 / (step * length as f64);
    let turn = |l: usize, i: usize| {
        let angle = std::f64::consts::TAU * ((l * i) % length) as f64 / length as f64;
        Complex::new(angle.cos(), angle.sin())
    };
    let product = |l: usize| {
        let samples = motion.accelerations().iter().enumerate();
        let sum = samples.fold(Complex::default(), |sum, (i, a)| sum + turn(length - l, i) * *a);
        sum * linear.transfer(ControlPoint::Within, frequency(l)).unwrap()
    };
    // Up to 12 Hz; the pulse has 1e-14 of its spectrum above.
    let products: Vec<Complex> = (1..4000).map(product).collect();
    let mut worst = 0.0_f64;
    for (i, found) in found.surface.accelerations().iter().enumerate().step_by(7) {
        let terms = products.iter().enumerate();
        let wanted: f64 = terms.map(|(l, product)| (*product * turn(l + 1, i)).re).sum();
        worst = worst.max((found - 2.0 * wanted / length as f64).abs());
    }
    println!("{worst:e} of {:e}", found.peak_accelerations[0]);
    assert!(worst < 1e-6 * found.peak_accelerations[0], "{worst:e}");
}

/// The profile carries its result: moduli at its first frequency, damping over the band, Poisson's ratio, causal laws.
#[test]
fn profiles_are_ready_for_a_ground() {
    let (layers, rock) = site("clay");
    let options = EquivalentLinearOptions::of_magnitude(6.9);
    assert!((options.strain_ratio - 0.59).abs() < 1e-15);
    let found = column(&layers, rock).equivalent_linear(
        &motion(0.2),
        &curves_of(&layers),
        &options,
        &mut unobserved,
    );
    let found = found.unwrap();
    let reference = found.profile.first_frequency().unwrap();
    assert!((0.5..1.2).contains(&reference), "{reference}");
    for (own, layer) in found.layers.iter().zip(found.profile.layers()) {
        assert_eq!((layer.soil.shear_modulus(), layer.soil.poisson()), (own.shear_modulus, 0.4));
        for frequency in [0.1, reference, 5.0, 30.0] {
            let s = Complex::new(0.0, std::f64::consts::TAU * frequency);
            let modulus = layer.damping.modulus(s);
            let ratio = 0.5 * modulus.im / modulus.re / own.damping;
            assert!((ratio - 1.0).abs() < 0.06, "{frequency} {ratio}");
            assert!(frequency != reference || (modulus.re - 1.0).abs() < 1e-9);
        }
        let [reduction, damping] = layers[0].3.at(own.effective_strain).unwrap();
        let first = own.depth > 0.0 || (reduction / own.modulus_ratio - 1.0).abs() < 1e-3;
        assert!(first && damping > 0.0);
    }
    // Through the profile's own laws the surface moves much the same.
    let causal = SoilColumn::new(found.profile.clone(), VerticalWave::Shear).unwrap();
    let motion = motion(0.2);
    let (step, samples) = (motion.time_step(), motion.accelerations());
    let surface = causal.to_surface(ControlPoint::Outcrop, step, samples, &mut unobserved).unwrap();
    let ratio = surface.peak() / found.peak_accelerations[0];
    println!("peak by the causal profile over that of the iteration: {ratio}");
    assert!((0.8..1.25).contains(&ratio), "{ratio}");
}

#[test]
fn strained_assumptions_are_told() {
    let (layers, rock) = site("clay");
    let column = column(&layers, rock);
    let found = |curves: &[StrainCurves], most_iterations| {
        let options =
            EquivalentLinearOptions { most_iterations, ..EquivalentLinearOptions::default() };
        column.equivalent_linear(&motion(0.5), curves, &options, &mut unobserved).unwrap()
    };
    let has = |found: &EquivalentLinear, kind: fn(&SiteWarning) -> bool| {
        assert!(found.warnings.iter().any(kind), "{found}");
    };
    let narrow = vec![StrainCurves::Table(vec![[1e-6, 1.0, 0.01], [1e-4, 0.8, 0.05]]); 10];
    has(&found(&narrow, 50), |w| matches!(w, SiteWarning::Extrapolated { largest: 1e-4, .. }));
    let short = found(&curves_of(&layers), 2);
    has(&short, |w| matches!(w, SiteWarning::NotConverged { iterations: 2, .. }));
    let strained = found(&curves_of(&layers), 50);
    has(&strained, |w| matches!(w, SiteWarning::LargeStrain { layer: 3, .. }));
    assert!(strained.layers[2].largest_strain > 5e-3);
    assert!(strained.last_change <= 1e-3 && strained.iterations <= 8, "{strained}");
    // With next to no damping on a rigid base it rings long.
    let ringing = SoilColumn::new(uniform(0.0), VerticalWave::Shear).unwrap();
    let linear = vec![StrainCurves::Linear { damping: 0.003 }; 4];
    let record = el_centro_1940().scaled(0.1).unwrap();
    let found = ringing
        .equivalent_linear(&record, &linear, &EquivalentLinearOptions::default(), &mut unobserved)
        .unwrap();
    assert!(matches!(found.warnings[..], [SiteWarning::CutOff { .. }]), "{found}");
    let quiet = Record::new(0.01, vec![0.0; 50]).unwrap();
    let found = ringing
        .equivalent_linear(&quiet, &linear, &EquivalentLinearOptions::default(), &mut unobserved)
        .unwrap();
    assert_eq!((found.layers[0].largest_strain, &found.warnings[..]), (0.0, &[][..]));
}

#[test]
#[allow(clippy::too_many_lines, reason = "a table of bad sites")]
fn bad_sites_are_told_by_layer_quantity_value_and_need() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 5.0).unwrap();
    let profile = profile.with_layer(soil, 5.0).unwrap();
    let column = SoilColumn::new(profile.clone(), VerticalWave::Shear).unwrap();
    let quiet = Record::new(0.01, vec![0.0, 1.0, 0.0]).unwrap();
    let darendeli = |plasticity_index, overconsolidation, mean_stress, frequency, cycles| {
        StrainCurves::Darendeli {
            plasticity_index,
            overconsolidation,
            mean_stress,
            frequency,
            cycles,
        }
    };
    let good = StrainCurves::SeedIdrissMean;
    let nan = f64::NAN;
    for bad in [
        StrainCurves::Linear { damping: 1.0 },
        StrainCurves::VuceticDobry { plasticity_index: 200.1 },
        StrainCurves::VuceticDobry { plasticity_index: nan },
        StrainCurves::Epri { depth: 305.0 },
        StrainCurves::Epri { depth: -1.0 },
        darendeli(-1.0, 1.0, 1e5, 1.0, 10.0),
        darendeli(0.0, 0.0, 1e5, 1.0, 10.0),
        darendeli(0.0, 1.0, nan, 1.0, 10.0),
        darendeli(0.0, 1.0, 1e5, 0.03, 10.0),
        darendeli(0.0, 1.0, 1e5, 1.0, 0.5),
        darendeli(0.0, 1.0, 1e-5, 1.0, 10.0),
        StrainCurves::Table(vec![]),
        StrainCurves::Table(vec![[0.0, 1.0, 0.01]]),
        StrainCurves::Table(vec![[1e-4, 1.0, 0.01], [1e-4, 0.9, 0.02]]),
        StrainCurves::Table(vec![[1e-4, 1.1, 0.01]]),
        StrainCurves::Table(vec![[1e-4, 0.8, 0.01], [1e-3, 0.9, 0.02]]),
        StrainCurves::Table(vec![[1e-4, 0.0, 0.01]]),
        StrainCurves::Table(vec![[1e-4, 1.0, -0.01]]),
        StrainCurves::Table(vec![[f64::INFINITY, 1.0, 0.01]]),
    ] {
        assert!(bad.at(1e-4).is_err(), "{bad:?}");
        let curves = [good.clone(), bad.clone()];
        let found = column.equivalent_linear(
            &quiet,
            &curves,
            &EquivalentLinearOptions::default(),
            &mut unobserved,
        );
        let Err(Error::Item { item, .. }) = found else { panic!("{bad:?}: {found:?}") };
        assert_eq!(item, "layer 2", "{bad:?}");
    }
    assert!(good.at(-1e-9).is_err() && good.at(nan).is_err());
    let curves = [good.clone(), good.clone()];
    for (options, name) in [
        (EquivalentLinearOptions::of_magnitude(1.0), "strain ratio"),
        (EquivalentLinearOptions::of_magnitude(nan), "strain ratio"),
        (
            EquivalentLinearOptions { tolerance: 0.0, ..EquivalentLinearOptions::default() },
            "tolerance",
        ),
        (
            EquivalentLinearOptions { most_iterations: 0, ..EquivalentLinearOptions::default() },
            "iterations",
        ),
        (
            EquivalentLinearOptions { band: [1.0, 1.0], ..EquivalentLinearOptions::default() },
            "band",
        ),
        (
            EquivalentLinearOptions { band: [nan, 1.0], ..EquivalentLinearOptions::default() },
            "band",
        ),
    ] {
        let found =
            column.equivalent_linear(&quiet, &curves, &options, &mut unobserved).unwrap_err();
        assert!(found.to_string().contains(name), "{found}");
    }
    let found = column
        .equivalent_linear(
            &quiet,
            &curves[..1],
            &EquivalentLinearOptions::default(),
            &mut unobserved,
        )
        .unwrap_err();
    let quantity = "list of strain curves, one for each layer,";
    assert_eq!(found, Error::Size { quantity, found: 1, needed: 2 });
    let pressure = SoilColumn::new(profile, VerticalWave::Pressure).unwrap();
    let found = pressure
        .equivalent_linear(&quiet, &curves, &EquivalentLinearOptions::default(), &mut unobserved)
        .unwrap_err();
    assert!(matches!(found, Error::Scene { quantity: "soil column", .. }), "{found}");
    // Nothing damps what a rigid base sends back.
    let rings = [good.clone(), StrainCurves::Linear { damping: 0.0 }];
    let found = column
        .equivalent_linear(&quiet, &rings, &EquivalentLinearOptions::default(), &mut unobserved)
        .unwrap_err();
    assert!(is_input_of(&found, "layer 2", "damping ratio at small strain", 0.0), "{found}");
    // A modulus by its magnitude has no real part left at so much damping.
    let options = EquivalentLinearOptions {
        complex_modulus: ComplexModulus::Magnitude,
        ..Default::default()
    };
    let compatible = "strain-compatible damping ratio";
    let half = StrainCurves::Linear { damping: 0.6 };
    let found = column
        .equivalent_linear(&quiet, &[good.clone(), half], &options, &mut unobserved)
        .unwrap_err();
    assert!(is_input_of(&found, "layer 2", compatible, 0.6), "{found}");
    // So much damping that no body has it, and a motion beyond all numbers.
    let damped = StrainCurves::Linear { damping: 0.99 };
    let found = column
        .equivalent_linear(
            &quiet,
            &[damped, good],
            &EquivalentLinearOptions::default(),
            &mut unobserved,
        )
        .unwrap_err();
    assert!(is_input_of(&found, "layer 1", compatible, 0.99), "{found}");
    let shaken = |size: f64| {
        let motion = Record::new(1.0, vec![size, -size, size]).unwrap();
        column.equivalent_linear(
            &motion,
            &curves,
            &EquivalentLinearOptions::default(),
            &mut unobserved,
        )
    };
    assert!(shaken(1e100).is_ok_and(|found| !found.warnings.is_empty()));
    assert!(matches!(shaken(1e300), Err(Error::Input { value: 1e300, .. })));
}
