//! Static compliance of a layered ground.
//!
//! The integrals of [`wavenumber`](super::wavenumber) at s = 0, with long-term moduli. On a half-plane
//! (subscript b) C(k, 0) → (1−`ν_b`)/(`μ_b` k) for k → 0, which makes the displacement logarithmic far away.
//! This part is subtracted with a factor e^(−ka), with a the length of the patch, and added in space as
//!
//! `F_zz`, `F_xx` += (1−`ν_b`)/(π`μ_b`) ∫∫ −½ ln(((x−ξ)² + a²)/L₀²),
//! `F_zx` += (1−2`ν_b`)/(2π`μ_b`) ∫∫ atan((x−ξ)/a)
//!
//! with an arbitrary datum L₀ (Gradshteyn & Ryzhik 3.941, 3.943). On rigid bedrock displacements are absolute.

use super::compliance::{Compliance, SurfaceCompliance};
use super::wavenumber::{Scratch, Wavenumbers, deep};
use crate::error::{Result, same_length};
use crate::geometry::{ContactElement, ContactLayout, PLANE};
use crate::history::{PairClasses, STRIP_KINDS};
use crate::linalg::Complex;
use crate::linalg::gauss;
use crate::soil::SoilProfile;

/// Tolerance of the integrals.
const TOLERANCE: f64 = 1e-11;
/// Decay exponent ka at the end of the panels.
const FORGOTTEN: f64 = 40.0;
/// Datum L₀ relative to the length of the patch; well above one, so that the matrix is positive definite.
const DATUM: f64 = 10.0;

/// Overwrites `matrix` with the mean static displacements of `elements` due to unit tractions.
///
/// `matrix` is 2Q × 2Q, row-major, m/Pa, with 2Q numbers as in [`crate::bem`]. Displacements are absolute on
/// rigid bedrock, and determined up to a rigid settlement on a half-plane.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) for a slice of the wrong length,
/// [`SoilError::Modulus`](crate::soil::SoilError::Modulus) for a damping law without long-term
/// stiffness; as for [`PairClasses::new`].
pub(in crate::bem) fn static_compliance(
    profile: &SoilProfile,
    elements: &[ContactElement],
    matrix: &mut [f64],
) -> Result<()> {
    let size = ContactLayout::new(PLANE, elements.len()).square();
    same_length("static compliance", matrix.len(), size)?;
    let classes = PairClasses::new(elements.to_vec())?;
    let values = pairs(profile, &classes)?;
    classes.scatter(matrix, |[receiver, _], pair| {
        let length = elements[receiver].length();
        values[pair.class].map(|value| value.re / length)
    });
    Ok(())
}

/// Static compliances zz, xx, zx of all classes, integrals over receiver and source.
pub(super) fn pairs(
    profile: &SoilProfile,
    classes: &PairClasses,
) -> Result<Vec<[Complex; STRIP_KINDS]>> {
    let mut compliance = Compliance::default();
    compliance.set(profile, Complex::default())?;
    let span = classes.span();
    let integrals = Wavenumbers::new(classes, TOLERANCE);
    let mut values = vec![[Complex::default(); STRIP_KINDS]; classes.count()];
    let far = compliance.half_plane().map(|(modulus, _, a2)| {
        // 1 − ν and (1 − 2ν)/2 over μ.
        let even = 0.5 / (1.0 - a2) / modulus.re;
        [even, a2 * even]
    });
    let end = FORGOTTEN / span;
    let mut waves = compliance.clone();
    let mut symbol = |k: f64| {
        let c = waves.at(k);
        let Some([even, odd]) = far else { return c };
        let decay = (-k * span).exp() / k;
        let (even, odd) = (Complex::real(even * decay), Complex::real(odd * decay));
        SurfaceCompliance { xx: c.xx - even, zz: c.zz - even, xz: c.xz + odd }
    };
    let least = deep(profile).max(end);
    integrals.at_rest(&compliance, least, &mut Scratch::default(), &mut values, &mut symbol)?;
    if let Some([even, odd]) = far {
        for (class, value) in values.iter_mut().enumerate() {
            let [source, receiver] = classes.representative(class)?;
            let [logarithm, angle] = smooth(source, receiver, span);
            let unit = std::f64::consts::FRAC_1_PI;
            value[0].re += unit * even * logarithm;
            value[1].re += unit * even * logarithm;
            value[2].re += unit * odd * angle;
        }
    }
    Ok(values)
}

/// ∫∫ −½ ln((x² + a²)/L₀²) and ∫∫ atan(x/a) over source and receiver, with x from one to the other.
///
/// Both integrands are smooth on the scale of a, the length of the patch.
fn smooth(source: ContactElement, receiver: ContactElement, a: f64) -> [f64; 2] {
    let rule = gauss::largest();
    let (p, q) = (0.5 * receiver.length(), 0.5 * source.length());
    let offset = if source == receiver { 0.0 } else { receiver.center()[0] - source.center()[0] };
    let mut sums = [0.0; 2];
    for (u, wu) in rule.nodes.iter().zip(&rule.weights) {
        for (v, wv) in rule.nodes.iter().zip(&rule.weights) {
            let x = (offset + p * u - q * v) / a;
            let weight = p * q * wu * wv;
            sums[0] += weight * (DATUM.ln() - 0.5 * (x * x).ln_1p());
            sums[1] += weight * x.atan();
        }
    }
    if source == receiver { [sums[0], 0.0] } else { sums }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::bem::layered::wavenumber::{Compliances, Workspace};
    use crate::bem::{Grading, StaticKernel, Strip};
    use crate::soil::SoilError;
    use crate::soil::{Kjartansson, Soil};

    fn matrix(profile: &SoilProfile, strip: &Strip) -> Vec<f64> {
        let elements = strip.elements();
        let mut matrix = vec![f64::NAN; 4 * elements.len() * elements.len()];
        static_compliance(profile, &elements, &mut matrix).unwrap();
        matrix
    }

    /// A half-plane, in one piece and cut into layers, equals Flamant's solution to rounding.
    #[test]
    fn homogeneous_ground_is_flamants() {
        let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
        for (strip, tolerance) in [
            (Strip::uniform(-1.0..1.0, 5).unwrap(), 1e-11),
            (Strip::new(-1.0..1.0, 24, Grading::Cosine).unwrap(), 1e-10),
        ] {
            let elements = strip.elements();
            let kernel = StaticKernel::new(soil, 20.0).unwrap();
            let one = SoilProfile::on_half_plane(soil);
            let many = one.clone().with_layer(soil, 0.1).unwrap().with_layer(soil, 30.0).unwrap();
            for profile in [one, many] {
                let found = matrix(&profile, &strip);
                let (count, mut worst) = (elements.len(), 0.0_f64);
                for (p, receiver) in elements.iter().enumerate() {
                    for (q, source) in elements.iter().enumerate() {
                        let wanted = kernel.coefficients(*receiver, *source).unwrap();
                        let at = |row: usize, column: usize| found[row * 2 * count + column];
                        for (found, wanted) in [
                            (at(p, q), wanted.zz),
                            (at(count + p, count + q), wanted.xx),
                            (at(p, count + q), wanted.zx),
                            (at(count + p, q), -wanted.zx),
                        ] {
                            // A mean displacement has the order of (1−ν)/(πμ) l.
                            worst = worst.max((found - wanted).abs() / (0.1 * source.length()));
                        }
                    }
                }
                println!("{count} elements: {worst:e}");
                assert!(worst < tolerance, "{worst:e}");
            }
        }
    }

    /// Slow motions tend to statics: on a half-plane up to a settlement (one for zz, one for xx), on a rigid
    /// base in every digit.
    #[test]
    fn statics_are_the_limit_of_slow_motions() {
        let layer = Soil::new(1.0, 0.4, 1.0).unwrap();
        let on_rock = SoilProfile::on_half_plane(Soil::new(7.0, 0.2, 1.2).unwrap());
        for (base, tolerance) in [(on_rock, 1e-6), (SoilProfile::on_rigid_bedrock(), 1e-8)] {
            let rigid = tolerance < 1e-7;
            let profile = base.with_layer(layer, 0.8).unwrap().with_layer(layer, 0.5).unwrap();
            let strip = Strip::new(-1.0..1.0, 5, Grading::Cosine).unwrap();
            let classes = PairClasses::new(strip.elements()).unwrap();
            let still = pairs(&profile, &classes).unwrap();
            let mut slow = still.clone();
            let integrals = Wavenumbers::new(&classes, 1e-12);
            let s = Complex::real(2e-5);
            integrals.compliance(&profile, s, &mut Workspace::default(), &mut slow).unwrap();
            let mean = |values: &[[Complex; STRIP_KINDS]], class: usize, component: usize| {
                let [p, q] = classes.representative(class).unwrap();
                values[class][component].re / (p.length() * q.length())
            };
            let mut worst = 0.0_f64;
            for component in 0..3 {
                let shift = mean(&slow, 0, component) - mean(&still, 0, component);
                let datum = if rigid || component == 2 { 0.0 } else { shift };
                assert!(rigid || component == 2 || shift.abs() > 1e-2);
                for class in 0..classes.count() {
                    let error = mean(&slow, class, component) - mean(&still, class, component);
                    worst = worst.max((error - datum).abs());
                }
            }
            println!("rigid base {rigid}: {worst:e}");
            assert!(worst < tolerance, "{rigid} {worst:e}");
        }
    }

    #[test]
    fn laws_without_long_term_stiffness_are_refused() {
        let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
        let law = Kjartansson::new(0.05, 1.0).unwrap();
        let profile = SoilProfile::on_half_plane(soil).with_damping(law);
        let elements = Strip::uniform(0.0..1.0, 2).unwrap().elements();
        let found = static_compliance(&profile, &elements, &mut [0.0; 16]);
        assert!(matches!(found, Err(Error::Soil(SoilError::Modulus { layer: 1, .. }))));
        assert!(static_compliance(&profile, &elements, &mut [0.0; 15]).is_err());
    }
}
