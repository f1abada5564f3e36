//! Surface compliance for waves polarised horizontally, across their wavenumber.
//!
//! The impedance Z = σ/u on a horizontal plane is carried upwards from the base: μβ in a half-space, and through a
//! layer of thickness h with z₀ = μβ and the reflection R = e^(−2βh) (z₀ − Z)/(z₀ + Z) at its bottom
//! Z ← z₀ (1 − R)/(1 + R). With E = 1 − e^(−2βh) that is z₀ (z₀E + Z(2 − E))/(z₀(2 − E) + ZE), which keeps its
//! digits in layers thin beside the waves; a rigid base is Z = ∞.

use crate::bem::layered::Compliance;
use crate::linalg::Complex;

/// |2βh| below which 1 − e^(−2βh) is summed as a series.
const THIN: f64 = 0.3;

/// `C_tt`(k, s) = 1/Z: displacement by shear across the wavenumber at which `ground` was evaluated last, m/Pa.
pub(super) fn transverse(ground: &Compliance) -> Complex {
    // Below the last layer that is felt, rigid is as good as anything.
    let mut below = None;
    for (modulus, beta, thickness) in ground.shear_waves().rev() {
        let own = modulus * beta;
        if thickness.is_infinite() {
            below = Some(own);
            continue;
        }
        let missing = one_less_exponential(beta.scale(2.0 * thickness));
        let rest = Complex::real(2.0) - missing;
        let (above, under) = match below {
            Some(z) => (own * missing + z * rest, own * rest + z * missing),
            None => (rest, missing),
        };
        below = Some(own * above / under);
    }
    below.map_or_else(Complex::default, Complex::inverse)
}

/// 1 − e^(−x) for Re x ≥ 0.
fn one_less_exponential(x: Complex) -> Complex {
    if x.square() > THIN * THIN {
        return Complex::real(1.0) - (-x).exp();
    }
    let terms = (2..=13).rev().map(f64::from);
    let one = Complex::real(1.0);
    x * terms.fold(one, |sum, n| one - (x * sum).scale(1.0 / n))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soil::{GeneralizedMaxwell, Soil, SoilProfile};

    fn found(profile: &SoilProfile, s: Complex, k: f64) -> Complex {
        let mut ground = Compliance::default();
        ground.set(profile, s).unwrap();
        ground.at(k);
        transverse(&ground)
    }

    fn damped() -> GeneralizedMaxwell {
        GeneralizedMaxwell::constant_q(0.05, [0.1, 10.0], 1.0).unwrap()
    }

    fn profiles() -> [SoilProfile; 3] {
        let soil = |mu, nu, rho| Soil::new(mu, nu, rho).unwrap();
        let on_rock = SoilProfile::on_half_plane(soil(9.0, 0.3, 1.2)).with_base_damping(damped());
        let layers = |profile: SoilProfile| {
            let profile = profile.with_layer(soil(1.0, 0.33, 1.0), 0.7).unwrap();
            profile.with_layer(soil(0.3, 0.4, 1.1), 1.1).unwrap().with_damping(damped())
        };
        let thin = SoilProfile::on_rigid_base().with_layer(soil(1.0, 0.3, 1.0), 1e-4).unwrap();
        [layers(on_rock), layers(SoilProfile::on_rigid_base()), thin]
    }

    /// Identical layers are one half-space, thick or thin.
    #[test]
    fn cut_half_space_is_whole() {
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
                    let error = (found(profile, s, k) - wanted).abs() / wanted.abs();
                    assert!(error < 1e-12, "{s:?} {k} {error:e}");
                }
            }
        }
    }

    /// At k → 0 shear along and across the wavenumber send the same vertical wave: the other recursion's.
    #[test]
    fn long_waves_are_those_along_the_wavenumber() {
        for profile in profiles() {
            for s in [Complex::new(0.05, 0.4), Complex::new(1.0, 7.0), Complex::real(3.0)] {
                let mut ground = Compliance::default();
                ground.set(&profile, s).unwrap();
                let k = 1e-8;
                let (wanted, found) = (ground.at(k).xx, transverse(&ground));
                let error = (found - wanted).abs() / wanted.abs();
                assert!(error < 1e-13, "{s:?} {error:e}");
            }
        }
    }

    /// μβ u = τ cosh/sinh of a layer on a rigid base, by the differential equation: u″ = β²u through its power series.
    #[test]
    fn layer_on_rigid_base_solves_its_equation() {
        let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
        for (k, h) in [(0.3, 0.5), (2.0, 1.3), (0.7, 1e-3)] {
            let s = Complex::new(0.2, 1.4);
            let profile = SoilProfile::on_rigid_base().with_layer(soil, h).unwrap();
            let square = Complex::real(k * k) + (s * s).scale(0.75);
            // sinh(βh)/β and cosh(βh).
            let (mut term, mut u, mut slope) =
                (Complex::real(1.0), Complex::default(), Complex::default());
            for n in 0..30 {
                let n = f64::from(n);
                slope += term;
                u += term.scale(h / (2.0 * n + 1.0));
                term = (term * square).scale(h * h / ((2.0 * n + 1.0) * (2.0 * n + 2.0)));
            }
            let wanted = u / slope.scale(2.0);
            let error = (found(&profile, s, k) - wanted).abs() / wanted.abs();
            assert!(error < 1e-13, "{k} {h} {error:e}");
        }
    }
}
