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

use super::compliance::{LayeredCompliance, SurfaceCompliance};
use super::wavenumber::{IntegralBuffers, Wavenumbers, top_layer_wavenumber};
use crate::error::{Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, ContactLayout};
use crate::history::{PairClasses, STRIP_KINDS};
use crate::linalg::Complex;
use crate::linalg::gauss;
use crate::soil::SoilProfile;

/// Relative tolerance of the integrals.
const STATIC_TOLERANCE: f64 = 1e-11;
/// Decay exponent ka at the end of the panels.
const STATIC_DECAY_EXPONENT: f64 = 40.0;
/// Datum L₀ relative to the length of the patch; well above one, so that the matrix is positive definite.
const DATUM_LENGTH_RATIO: f64 = 10.0;

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
    let size = ContactLayout::new(COMPONENTS_IN_PLANE, elements.len()).square();
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
    let mut compliance = LayeredCompliance::default();
    compliance.set(profile, Complex::default())?;
    let span = classes.span();
    let integrals = Wavenumbers::new(classes, STATIC_TOLERANCE);
    let mut values = vec![[Complex::default(); STRIP_KINDS]; classes.count()];
    // (1 − ν)/μ and (1 − 2ν)/2μ of the half-plane below.
    let far_field = compliance.half_plane().map(|soil| {
        let even = 0.5 / (1.0 - soil.a2) / soil.modulus.re;
        [even, soil.a2 * even]
    });
    let mut surface = compliance.clone();
    let mut compliance_without_far_field = |k: f64| {
        let c = surface.at(k);
        let Some([even, odd]) = far_field else { return c };
        let decay = (-k * span).exp() / k;
        let even = Complex::real(even * decay);
        let odd = Complex::real(odd * decay);
        SurfaceCompliance { xx: c.xx - even, zz: c.zz - even, xz: c.xz + odd }
    };
    let min_k = top_layer_wavenumber(profile).max(STATIC_DECAY_EXPONENT / span);
    let mut work = IntegralBuffers::default();
    integrals.static_compliance(
        &compliance,
        min_k,
        &mut work,
        &mut values,
        &mut compliance_without_far_field,
    )?;
    if let Some([even, odd]) = far_field {
        for (class, value) in values.iter_mut().enumerate() {
            let [source, receiver] = classes.representative(class)?;
            let far_integrals = far_field_integrals(source, receiver, span);
            let unit = std::f64::consts::FRAC_1_PI;
            value[0].re += unit * even * far_integrals[0];
            value[1].re += unit * even * far_integrals[0];
            value[2].re += unit * odd * far_integrals[1];
        }
    }
    Ok(values)
}

/// ∫∫ −½ ln((x² + a²)/L₀²) and ∫∫ atan(x/a) over source and receiver, with x from one to the other.
///
/// Both integrands are smooth on the scale of a, the length of the patch.
fn far_field_integrals(source: ContactElement, receiver: ContactElement, a: f64) -> [f64; 2] {
    let rule = gauss::largest();
    let p = 0.5 * receiver.length();
    let q = 0.5 * source.length();
    let offset = if source == receiver { 0.0 } else { receiver.center()[0] - source.center()[0] };
    let mut sums = [0.0; 2];
    for (u, wu) in rule.nodes.iter().zip(&rule.weights) {
        for (v, wv) in rule.nodes.iter().zip(&rule.weights) {
            let x = (offset + p * u - q * v) / a;
            let weight = p * q * wu * wv;
            sums[0] += weight * (DATUM_LENGTH_RATIO.ln() - 0.5 * (x * x).ln_1p());
            sums[1] += weight * x.atan();
        }
    }
    if source == receiver { [sums[0], 0.0] } else { sums }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::bem::layered::wavenumber::{Compliances, StripWorkspace};
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
                let count = elements.len();
                let mut worst = 0.0_f64;
                for (p, receiver) in elements.iter().enumerate() {
                    for (q, source) in elements.iter().enumerate() {
                        let wanted = kernel.coefficients(*receiver, *source).unwrap();
                        for (row, column, wanted) in [
                            (p, q, wanted.zz),
                            (count + p, count + q, wanted.xx),
                            (p, count + q, wanted.zx),
                            (count + p, q, -wanted.zx),
                        ] {
                            let error = (found[row * 2 * count + column] - wanted).abs();
                            // A mean displacement has the order of (1−ν)/(πμ) l.
                            worst = worst.max(error / (0.1 * source.length()));
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
            let at_rest = pairs(&profile, &classes).unwrap();
            let mut slow = at_rest.clone();
            let integrals = Wavenumbers::new(&classes, 1e-12);
            let s = Complex::real(2e-5);
            integrals.compliance(&profile, s, &mut StripWorkspace::default(), &mut slow).unwrap();
            let mut worst = 0.0_f64;
            for component in 0..3 {
                let mut differences = vec![];
                for class in 0..classes.count() {
                    let lengths = classes.representative(class).unwrap().map(|e| e.length());
                    let difference = slow[class][component].re - at_rest[class][component].re;
                    differences.push(difference / (lengths[0] * lengths[1]));
                }
                let settlement = differences[0];
                let has_settlement = !rigid && component < 2;
                assert!(!has_settlement || settlement.abs() > 1e-2);
                for difference in differences {
                    let datum = if has_settlement { settlement } else { 0.0 };
                    worst = worst.max((difference - datum).abs());
                }
            }
            println!("rigid base {rigid}: {worst:e}");
            assert!(worst < tolerance, "{rigid} {worst:e}");
        }
    }

    #[test]
    fn laws_without_long_term_stiffness_are_errors() {
        let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
        let law = Kjartansson::new(0.05, 1.0).unwrap();
        let profile = SoilProfile::on_half_plane(soil).with_damping(law);
        let elements = Strip::uniform(0.0..1.0, 2).unwrap().elements();
        let found = static_compliance(&profile, &elements, &mut [0.0; 16]);
        assert!(matches!(found, Err(Error::Soil(SoilError::Modulus { layer: 1, .. }))));
        assert!(static_compliance(&profile, &elements, &mut [0.0; 15]).is_err());
    }
}
