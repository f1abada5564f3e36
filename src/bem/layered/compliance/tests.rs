//! The surface compliance against 60-digit values, closed forms and limits.

use super::*;
use crate::soil::{GeneralizedMaxwell, Relaxation, Soil};

/// A constant complex modulus, as in the tables.
#[derive(Debug)]
struct Loss(f64);

impl Relaxation for Loss {
    fn modulus(&self, _s: Complex) -> Complex {
        Complex::new(1.0, self.0)
    }
}

fn profile(layers: &str, rigid: bool) -> SoilProfile {
    let mut rows: Vec<Vec<f64>> = vec![];
    for layer in layers.split('|') {
        rows.push(layer.split(':').map(|x| x.parse().unwrap()).collect());
    }
    let mut profile = SoilProfile::on_rigid_bedrock();
    if !rigid {
        let last = rows.pop().unwrap();
        let loss = Loss(last[2] / last[1]);
        profile = SoilProfile::on_half_plane(soil(&last)).with_bedrock_damping(loss);
    }
    for row in &rows {
        let loss = Loss(row[2] / row[1]);
        profile = profile.with_layer(soil(row), row[4]).unwrap().with_damping(loss);
    }
    profile
}

/// Soil of a row: density, real and imaginary part of the modulus, Poisson's ratio.
fn soil(row: &[f64]) -> Soil {
    Soil::new(row[1], row[3], row[0]).unwrap()
}

/// Published digits: `kernel_C_ks.csv`, 80 random rows of 60-digit arithmetic.
#[test]
fn agrees_with_sixty_digits() {
    agrees(include_str!("../../../../tests/data/layered/kernel_C_ks.csv"), 80);
}

/// `contrasts_C_ks.csv`: slabs up to 1e8 times as stiff as the ground below, static and dynamic.
///
/// The reference uses matrix exponentials with 120 digits.
#[test]
fn stiff_layers_over_soft_ground_keep_their_digits() {
    agrees(include_str!("../../../../tests/data/layered/contrasts_C_ks.csv"), 144);
}

fn agrees(table: &str, count: usize) {
    let mut worst = 0.0_f64;
    let mut worst_xz = 0.0_f64;
    let mut rows = 0;
    for line in table.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit())) {
        let (numbers, layers) = line.rsplit_once(',').unwrap();
        let n: Vec<f64> = numbers.split(',').map(|x| x.parse().unwrap()).collect();
        let profile = profile(layers, n[3] == 1.0);
        let mut compliance = LayeredCompliance::default();
        compliance.set(&profile, Complex::new(n[1], n[2])).unwrap();
        let found = compliance.at(n[0]);
        let wanted = [4, 6, 8].map(|i| Complex::new(n[i], n[i + 1]));
        let size = wanted.iter().map(|c| c.abs()).fold(0.0, f64::max);
        for (found, wanted) in [found.xx, found.zz, found.xz].into_iter().zip(wanted) {
            worst = worst.max((found - wanted).abs() / size);
        }
        worst_xz = worst_xz.max((found.xz - wanted[2]).abs() / wanted[2].abs());
        rows += 1;
    }
    println!("{rows} rows: {worst:e} of max|C|, {worst_xz:e} of C_xz");
    assert_eq!(rows, count);
    assert!(worst < 1e-12, "{worst:e}");
}

#[test]
fn identical_layers_are_one_half_plane() {
    let mut worst = 0.0_f64;
    for nu in [-0.9, 0.0, 0.25, 0.4999] {
        let soil = Soil::new(2.0, nu, 1.5).unwrap();
        let one = SoilProfile::on_half_plane(soil);
        let mut many = one.clone();
        for h in [0.3, 2.0, 0.01, 0.7] {
            many = many.with_layer(soil, h).unwrap();
        }
        for s in [
            Complex::real(1e-6),
            Complex::real(3.0),
            Complex::new(0.01, 2.0),
            Complex::new(1.0, -30.0),
        ] {
            for k in [1e-5, 1e-3, 0.1, 1.0, 7.0, 100.0] {
                let a = surface_compliance(&one, s, k);
                let b = surface_compliance(&many, s, k);
                let size = a.xx.abs().max(a.zz.abs());
                for (a, b) in [(a.xx, b.xx), (a.zz, b.zz), (a.xz, b.xz)] {
                    worst = worst.max((a - b).abs() / size);
                }
            }
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-11, "{worst:e}");
}

fn surface_compliance(profile: &SoilProfile, s: Complex, k: f64) -> SurfaceCompliance {
    let mut compliance = LayeredCompliance::default();
    compliance.set(profile, s).unwrap();
    compliance.at(k)
}

/// Closed form of Lamb's problem: C = [β, α] q₂/(μ R), R = (2k² + q₂)² − 4k²αβ.
#[test]
fn half_plane_is_lambs() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let s = Complex::new(0.7, 2.0);
    let mut compliance = LayeredCompliance::default();
    compliance.set(&SoilProfile::on_half_plane(soil), s).unwrap();
    for k in [0.1, 1.0, 5.0] {
        let q2 = (s * s).scale(0.75);
        let k2 = Complex::real(k * k);
        let alpha = (k2 + q2.scale(soil.speed_ratio_squared())).sqrt();
        let beta = (k2 + q2).sqrt();
        let sum = k2.scale(2.0) + q2;
        let r = (sum * sum - (alpha * beta).scale(4.0 * k * k)).scale(2.0);
        let found = compliance.at(k);
        assert!((found.xx - q2 * beta / r).abs() < 1e-12 * found.xx.abs());
        assert!((found.zz - q2 * alpha / r).abs() < 1e-12 * found.zz.abs());
        let coupling = (sum - (alpha * beta).scale(2.0)).scale(k) / r;
        assert!((found.xz - coupling).abs() < 1e-12 * found.zz.abs());
    }
}

#[test]
fn extremes_are_finite() {
    let soft = Soil::new(1.0, 0.4999, 1.0).unwrap();
    let stiff = Soil::new(1e6, -0.99, 3.0).unwrap();
    for profile in [
        SoilProfile::on_half_plane(stiff)
            .with_layer(soft, 1e-3)
            .unwrap()
            .with_layer(stiff, 1e5)
            .unwrap(),
        SoilProfile::on_rigid_bedrock().with_layer(soft, 2.0).unwrap(),
    ] {
        for s in [0.0, 1e-9, 1e-3, 1.0, 1e4] {
            for im in [0.0, 1e-6, 1.0, 1e5] {
                let s = Complex::new(s, im);
                let mut compliance = LayeredCompliance::default();
                if s.re == 0.0 && im > 0.0 {
                    continue;
                }
                compliance.set(&profile, s).unwrap();
                for k in [1e-6, 1e-3, 1.0, 1e3, 1e7] {
                    let c = compliance.at(k);
                    for x in [c.xx, c.zz, c.xz] {
                        assert!(x.is_finite(), "{s:?} {k} {c:?}");
                    }
                }
            }
        }
    }
}

/// k → 0 on rigid bedrock: shear and pressure columns, tanh(sh/c)/(ρcs).
#[test]
fn long_waves_see_a_column() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 2.0).unwrap();
    for s in [0.1, 1.0, 5.0] {
        let mut compliance = LayeredCompliance::default();
        compliance.set(&profile, Complex::real(s)).unwrap();
        let found = compliance.at(1e-7);
        for (found, speed) in
            [(found.xx, soil.shear_wave_speed()), (found.zz, soil.pressure_wave_speed())]
        {
            let wanted = (s * 2.0 / speed).tanh() / (1.5 * speed * s);
            assert!((found.re - wanted).abs() < 1e-13 * wanted, "{s} {found:?} {wanted}");
        }
    }
}

fn across(profile: &SoilProfile, s: Complex, k: f64) -> Complex {
    let mut ground = LayeredCompliance::default();
    ground.set(profile, s).unwrap();
    ground.at(k);
    ground.transverse()
}

fn damped() -> GeneralizedMaxwell {
    GeneralizedMaxwell::constant_q(0.05, [0.1, 10.0], 1.0).unwrap()
}

fn damped_profiles() -> [SoilProfile; 3] {
    let rock = Soil::new(9.0, 0.3, 1.2).unwrap();
    let on_rock = SoilProfile::on_half_plane(rock).with_bedrock_damping(damped());
    let thin_layer = Soil::new(1.0, 0.3, 1.0).unwrap();
    let thin = SoilProfile::on_rigid_bedrock().with_layer(thin_layer, 1e-4).unwrap();
    [with_two_layers(on_rock), with_two_layers(SoilProfile::on_rigid_bedrock()), thin]
}

fn with_two_layers(profile: SoilProfile) -> SoilProfile {
    let upper = Soil::new(1.0, 0.33, 1.0).unwrap();
    let lower = Soil::new(0.3, 0.4, 1.1).unwrap();
    let profile = profile.with_layer(upper, 0.7).unwrap();
    profile.with_layer(lower, 1.1).unwrap().with_damping(damped())
}

/// Identical layers, thick or thin, equal one half-space.
#[test]
fn cut_half_space_is_whole_across() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let one = SoilProfile::on_half_plane(soil);
    let mut many = one.clone();
    for thickness in [0.1, 1e-4, 1.0, 40.0] {
        many = many.with_layer(soil, thickness).unwrap();
    }
    for s in [Complex::new(0.3, 1.0), Complex::new(1e-4, 3.0), Complex::real(20.0)] {
        for k in [1e-5, 0.1, 0.9, 4.0, 300.0] {
            let beta = (Complex::real(k * k) + (s * s).scale(0.75)).sqrt();
            let wanted = beta.scale(2.0).inverse();
            for profile in [&one, &many] {
                let error = (across(profile, s, k) - wanted).abs() / wanted.abs();
                assert!(error < 1e-12, "{s:?} {k} {error:e}");
            }
        }
    }
}

/// As k → 0, shear along and across the wavenumber has the same vertical wave; compares both recursions.
#[test]
fn long_waves_are_those_along_the_wavenumber() {
    for profile in damped_profiles() {
        for s in [Complex::new(0.05, 0.4), Complex::new(1.0, 7.0), Complex::real(3.0)] {
            let mut ground = LayeredCompliance::default();
            ground.set(&profile, s).unwrap();
            let k = 1e-8;
            let wanted = ground.at(k).xx;
            let found = ground.transverse();
            let error = (found - wanted).abs() / wanted.abs();
            assert!(error < 1e-13, "{s:?} {error:e}");
        }
    }
}

/// μβ u = τ cosh/sinh of a layer on rigid bedrock, by the differential equation: u″ = β²u through its power series.
#[test]
fn layer_on_rigid_base_solves_its_equation() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    for (k, h) in [(0.3, 0.5), (2.0, 1.3), (0.7, 1e-3)] {
        let s = Complex::new(0.2, 1.4);
        let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, h).unwrap();
        let square = Complex::real(k * k) + (s * s).scale(0.75);
        // sinh(βh)/β and cosh(βh).
        let mut term = Complex::real(1.0);
        let mut u = Complex::default();
        let mut slope = Complex::default();
        for n in 0..30 {
            let n = f64::from(n);
            slope += term;
            u += term.scale(h / (2.0 * n + 1.0));
            term = (term * square).scale(h * h / ((2.0 * n + 1.0) * (2.0 * n + 2.0)));
        }
        let wanted = u / slope.scale(2.0);
        let error = (across(&profile, s, k) - wanted).abs() / wanted.abs();
        assert!(error < 1e-13, "{k} {h} {error:e}");
    }
}
