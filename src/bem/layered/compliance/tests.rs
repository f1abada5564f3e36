//! Tests of the surface compliance against 60-digit values, closed forms and limits.

use super::*;
use crate::soil::{GeneralizedMaxwell, Relaxation, Soil};

/// Constant complex modulus with a loss factor, as in the tables.
#[derive(Debug)]
struct LossFactor(f64);

impl Relaxation for LossFactor {
    fn modulus(&self, _s: Complex) -> Complex {
        Complex::new(1.0, self.0)
    }
}

/// Profile of a table's text, `density:re:im:poisson:thickness` for each layer.
fn profile(layers: &str, has_rigid_bedrock: bool) -> SoilProfile {
    let mut rows: Vec<Vec<f64>> = vec![];
    for layer in layers.split('|') {
        rows.push(layer.split(':').map(|x| x.parse().unwrap()).collect());
    }
    let mut profile = SoilProfile::on_rigid_bedrock();
    if !has_rigid_bedrock {
        let last_row = rows.pop().unwrap();
        let loss = LossFactor(last_row[2] / last_row[1]);
        profile = SoilProfile::on_half_plane(soil(&last_row)).with_bedrock_damping(loss);
    }
    for row in &rows {
        let loss = LossFactor(row[2] / row[1]);
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
    agrees_with_table(include_str!("../../../../tests/data/layered/kernel_C_ks.csv"), 80);
}

/// `contrasts_C_ks.csv`: slabs up to 1e8 times as stiff as the ground below, static and dynamic.
///
/// The reference uses matrix exponentials with 120 digits.
#[test]
fn stiff_layers_over_soft_ground_keep_their_digits() {
    agrees_with_table(include_str!("../../../../tests/data/layered/contrasts_C_ks.csv"), 144);
}

/// Compares the compliance at each row of a table with the table's values.
fn agrees_with_table(table: &str, expected_rows: usize) {
    let mut max_error = 0.0_f64;
    let mut max_xz_error = 0.0_f64;
    let mut row_count = 0;
    for line in table.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())) {
        let (numbers, layers) = line.rsplit_once(',').unwrap();
        let row: Vec<f64> = numbers.split(',').map(|x| x.parse().unwrap()).collect();
        let profile = profile(layers, row[3] == 1.0);
        let mut compliance = LayeredCompliance::default();
        compliance.set(&profile, Complex::new(row[1], row[2])).unwrap();
        let computed = compliance.at(row[0]);
        let expected = [4, 6, 8].map(|i| Complex::new(row[i], row[i + 1]));
        let max_compliance = expected.iter().map(|c| c.abs()).fold(0.0, f64::max);
        for (a, b) in [computed.xx, computed.zz, computed.xz].into_iter().zip(expected) {
            max_error = max_error.max((a - b).abs() / max_compliance);
        }
        max_xz_error = max_xz_error.max((computed.xz - expected[2]).abs() / expected[2].abs());
        row_count += 1;
    }
    println!("{row_count} rows: {max_error:e} of max|C|, {max_xz_error:e} of C_xz");
    assert_eq!(row_count, expected_rows);
    assert!(max_error < 1e-12, "{max_error:e}");
}

#[test]
fn identical_layers_are_one_half_plane() {
    let mut max_error = 0.0_f64;
    for nu in [-0.9, 0.0, 0.25, 0.4999] {
        let soil = Soil::new(2.0, nu, 1.5).unwrap();
        let half_plane = SoilProfile::on_half_plane(soil);
        let mut layered = half_plane.clone();
        for thickness in [0.3, 2.0, 0.01, 0.7] {
            layered = layered.with_layer(soil, thickness).unwrap();
        }
        for s in [
            Complex::real(1e-6),
            Complex::real(3.0),
            Complex::new(0.01, 2.0),
            Complex::new(1.0, -30.0),
        ] {
            for k in [1e-5, 1e-3, 0.1, 1.0, 7.0, 100.0] {
                let a = surface_compliance(&half_plane, s, k);
                let b = surface_compliance(&layered, s, k);
                let max_compliance = a.xx.abs().max(a.zz.abs());
                for (a, b) in [(a.xx, b.xx), (a.zz, b.zz), (a.xz, b.xz)] {
                    max_error = max_error.max((a - b).abs() / max_compliance);
                }
            }
        }
    }
    println!("{max_error:e}");
    assert!(max_error < 1e-11, "{max_error:e}");
}

fn surface_compliance(profile: &SoilProfile, s: Complex, k: f64) -> SurfaceCompliance {
    let mut compliance = LayeredCompliance::default();
    compliance.set(profile, s).unwrap();
    compliance.at(k)
}

/// The half-plane agrees with the closed form of Lamb's problem: C = [β, α] q₂/(μ R), R = (2k² + q₂)² − 4k²αβ.
#[test]
fn half_plane_agrees_with_lambs_solution() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let s = Complex::new(0.7, 2.0);
    let mut compliance = LayeredCompliance::default();
    compliance.set(&SoilProfile::on_half_plane(soil), s).unwrap();
    for k in [0.1, 1.0, 5.0] {
        let q2 = (s * s).scale(0.75);
        let k2 = Complex::real(k * k);
        let alpha = (k2 + q2.scale(soil.speed_ratio_squared())).sqrt();
        let beta = (k2 + q2).sqrt();
        let two_k_squared_plus_q2 = k2.scale(2.0) + q2;
        let denominator = (two_k_squared_plus_q2 * two_k_squared_plus_q2
            - (alpha * beta).scale(4.0 * k * k))
        .scale(2.0);
        let computed = compliance.at(k);
        assert!((computed.xx - q2 * beta / denominator).abs() < 1e-12 * computed.xx.abs());
        assert!((computed.zz - q2 * alpha / denominator).abs() < 1e-12 * computed.zz.abs());
        let coupling = (two_k_squared_plus_q2 - (alpha * beta).scale(2.0)).scale(k) / denominator;
        assert!((computed.xz - coupling).abs() < 1e-12 * computed.zz.abs());
    }
}

#[test]
fn extremes_are_finite() {
    let soft_soil = Soil::new(1.0, 0.4999, 1.0).unwrap();
    let stiff_soil = Soil::new(1e6, -0.99, 3.0).unwrap();
    for profile in [
        SoilProfile::on_half_plane(stiff_soil)
            .with_layer(soft_soil, 1e-3)
            .unwrap()
            .with_layer(stiff_soil, 1e5)
            .unwrap(),
        SoilProfile::on_rigid_bedrock().with_layer(soft_soil, 2.0).unwrap(),
    ] {
        for re in [0.0, 1e-9, 1e-3, 1.0, 1e4] {
            for im in [0.0, 1e-6, 1.0, 1e5] {
                let s = Complex::new(re, im);
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

/// For k → 0 on rigid bedrock the compliances are tanh(sh/c)/(ρcs) of columns in shear and in compression.
#[test]
fn long_waves_have_the_compliance_of_a_column() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 2.0).unwrap();
    for s in [0.1, 1.0, 5.0] {
        let mut compliance = LayeredCompliance::default();
        compliance.set(&profile, Complex::real(s)).unwrap();
        let surface = compliance.at(1e-7);
        for (computed, speed) in
            [(surface.xx, soil.shear_wave_speed()), (surface.zz, soil.pressure_wave_speed())]
        {
            let expected = (s * 2.0 / speed).tanh() / (1.5 * speed * s);
            assert!(
                (computed.re - expected).abs() < 1e-13 * expected,
                "{s} {computed:?} {expected}"
            );
        }
    }
}

/// Transverse compliance at the wavenumber `k`.
fn transverse(profile: &SoilProfile, s: Complex, k: f64) -> Complex {
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
    let thin_profile = SoilProfile::on_rigid_bedrock().with_layer(thin_layer, 1e-4).unwrap();
    [with_two_layers(on_rock), with_two_layers(SoilProfile::on_rigid_bedrock()), thin_profile]
}

fn with_two_layers(profile: SoilProfile) -> SoilProfile {
    let upper = Soil::new(1.0, 0.33, 1.0).unwrap();
    let lower = Soil::new(0.3, 0.4, 1.1).unwrap();
    let profile = profile.with_layer(upper, 0.7).unwrap();
    profile.with_layer(lower, 1.1).unwrap().with_damping(damped())
}

/// Identical layers, thick or thin, equal one half-space.
#[test]
fn equal_layers_have_the_transverse_compliance_of_a_half_space() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let half_space = SoilProfile::on_half_plane(soil);
    let mut layered = half_space.clone();
    for thickness in [0.1, 1e-4, 1.0, 40.0] {
        layered = layered.with_layer(soil, thickness).unwrap();
    }
    for s in [Complex::new(0.3, 1.0), Complex::new(1e-4, 3.0), Complex::real(20.0)] {
        for k in [1e-5, 0.1, 0.9, 4.0, 300.0] {
            let beta = (Complex::real(k * k) + (s * s).scale(0.75)).sqrt();
            let expected = beta.scale(2.0).inverse();
            for profile in [&half_space, &layered] {
                let error = (transverse(profile, s, k) - expected).abs() / expected.abs();
                assert!(error < 1e-12, "{s:?} {k} {error:e}");
            }
        }
    }
}

/// As k → 0, shear along and normal to the wavenumber causes the same vertical wave: both recursions agree.
#[test]
fn both_shear_compliances_agree_for_long_waves() {
    for profile in damped_profiles() {
        for s in [Complex::new(0.05, 0.4), Complex::new(1.0, 7.0), Complex::real(3.0)] {
            let mut ground = LayeredCompliance::default();
            ground.set(&profile, s).unwrap();
            let k = 1e-8;
            let expected = ground.at(k).xx;
            let computed = ground.transverse();
            let error = (computed - expected).abs() / expected.abs();
            assert!(error < 1e-13, "{s:?} {error:e}");
        }
    }
}

/// A layer on rigid bedrock agrees with the power series of its differential equation u″ = β²u.
#[test]
fn layer_on_rigid_base_solves_its_equation() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    for (k, h) in [(0.3, 0.5), (2.0, 1.3), (0.7, 1e-3)] {
        let s = Complex::new(0.2, 1.4);
        let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, h).unwrap();
        let beta_squared = Complex::real(k * k) + (s * s).scale(0.75);
        // sinh(βh)/β and cosh(βh).
        let mut term = Complex::real(1.0);
        let mut u = Complex::default();
        let mut slope = Complex::default();
        for n in 0..30 {
            let n = f64::from(n);
            slope += term;
            u += term.scale(h / (2.0 * n + 1.0));
            term = (term * beta_squared).scale(h * h / ((2.0 * n + 1.0) * (2.0 * n + 2.0)));
        }
        let expected = u / slope.scale(2.0);
        let error = (transverse(&profile, s, k) - expected).abs() / expected.abs();
        assert!(error < 1e-13, "{k} {h} {error:e}");
    }
}
