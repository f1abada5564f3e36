//! Static compliance of a layered ground.
//!
//! The compliances are the integrals of [`wavenumber`](super::wavenumber) at s = 0, with long-term moduli. On a half-plane
//! (subscript b) C(k, 0) → (1−`ν_b`)/(`μ_b` k) for k → 0, so that displacements vary logarithmically at large distances.
//! This far field is subtracted with a factor e^(−ka), with a the span of the elements. Its integral is added in space as
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

/// Relative tolerance of the integrals, which is small because static compliances are computed only once.
const STATIC_TOLERANCE: f64 = 1e-11;
/// Decay exponent ka at the end of the panels, where e^(−40) is 4e-18.
const STATIC_DECAY_EXPONENT: f64 = 40.0;
/// Datum L₀ relative to the span of the elements; well above one, so that the matrix is positive definite.
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
    let entry_count = ContactLayout::new(COMPONENTS_IN_PLANE, elements.len()).matrix_len();
    same_length("static compliance", matrix.len(), entry_count)?;
    let classes = PairClasses::new(elements.to_vec())?;
    let values = pair_compliances(profile, &classes)?;
    classes.scatter(matrix, |[receiver, _], pair| {
        let length = elements[receiver].length();
        values[pair.class].map(|value| value.re / length)
    });
    Ok(())
}

/// Compliances of the half-plane below at large distances, times k.
#[derive(Clone, Copy)]
struct FarField {
    /// Factor (1 − ν)/μ of xx and zz, 1/Pa.
    diagonal: f64,
    /// Factor (1 − 2ν)/2μ of xz, 1/Pa.
    coupling: f64,
}

/// Static compliances zz, xx and zx of all classes, integrals over receiver and source.
pub(super) fn pair_compliances(
    profile: &SoilProfile,
    classes: &PairClasses,
) -> Result<Vec<[Complex; STRIP_KINDS]>> {
    let mut compliance = LayeredCompliance::default();
    compliance.set(profile, Complex::default())?;
    let span = classes.span();
    let integrals = Wavenumbers::new(classes, STATIC_TOLERANCE);
    let mut values = vec![[Complex::default(); STRIP_KINDS]; classes.count()];
    let far_field = compliance.half_plane().map(|soil| {
        let diagonal = 0.5 / (1.0 - soil.a2) / soil.modulus.re;
        FarField { diagonal, coupling: soil.a2 * diagonal }
    });
    let mut surface = compliance.clone();
    let mut compliance_without_far_field = |k: f64| {
        let c = surface.at(k);
        let Some(FarField { diagonal, coupling }) = far_field else { return c };
        let decay = (-k * span).exp() / k;
        let diagonal_part = Complex::real(diagonal * decay);
        let coupling_part = Complex::real(coupling * decay);
        SurfaceCompliance {
            xx: c.xx - diagonal_part,
            zz: c.zz - diagonal_part,
            xz: c.xz + coupling_part,
        }
    };
    let min_k = top_layer_wavenumber(profile).max(STATIC_DECAY_EXPONENT / span);
    let mut buffers = IntegralBuffers::default();
    integrals.static_compliance(
        &compliance,
        min_k,
        &mut buffers,
        &mut values,
        &mut compliance_without_far_field,
    )?;
    if let Some(FarField { diagonal, coupling }) = far_field {
        for (class, class_values) in values.iter_mut().enumerate() {
            let [source, receiver] = classes.representative(class)?;
            let [logarithm_integral, angle_integral] = far_field_integrals(source, receiver, span);
            let factor = std::f64::consts::FRAC_1_PI;
            class_values[0].re += factor * diagonal * logarithm_integral;
            class_values[1].re += factor * diagonal * logarithm_integral;
            class_values[2].re += factor * coupling * angle_integral;
        }
    }
    Ok(values)
}

/// ∫∫ −½ ln((x² + a²)/L₀²) and ∫∫ atan(x/a), x from source to receiver, over both elements.
///
/// Both integrands are smooth on the scale of a, the span of all elements.
fn far_field_integrals(source: ContactElement, receiver: ContactElement, a: f64) -> [f64; 2] {
    let rule = gauss::largest_rule();
    let half_receiver = 0.5 * receiver.length();
    let half_source = 0.5 * source.length();
    let offset = if source == receiver { 0.0 } else { receiver.center()[0] - source.center()[0] };
    let mut sums = [0.0; 2];
    for (u, u_weight) in rule.nodes.iter().zip(&rule.weights) {
        for (v, v_weight) in rule.nodes.iter().zip(&rule.weights) {
            let x = (offset + half_receiver * u - half_source * v) / a;
            let weight = half_receiver * half_source * u_weight * v_weight;
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

    /// A half-plane, without and with layers of equal soil, agrees with Flamant's solution to rounding.
    #[test]
    fn homogeneous_ground_agrees_with_flamants_solution() {
        let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
        for (strip, tolerance) in [
            (Strip::uniform(-1.0..1.0, 5).unwrap(), 1e-11),
            (Strip::new(-1.0..1.0, 24, Grading::Cosine).unwrap(), 1e-10),
        ] {
            let elements = strip.elements();
            let kernel = StaticKernel::new(soil, 20.0).unwrap();
            let half_plane = SoilProfile::on_half_plane(soil);
            let layered =
                half_plane.clone().with_layer(soil, 0.1).unwrap().with_layer(soil, 30.0).unwrap();
            for profile in [half_plane, layered] {
                let computed = matrix(&profile, &strip);
                let element_count = elements.len();
                let mut max_error = 0.0_f64;
                for (i, receiver) in elements.iter().enumerate() {
                    for (j, source) in elements.iter().enumerate() {
                        let flamant = kernel.coefficients(*receiver, *source).unwrap();
                        for (row, column, expected) in [
                            (i, j, flamant.zz),
                            (element_count + i, element_count + j, flamant.xx),
                            (i, element_count + j, flamant.zx),
                            (element_count + i, j, -flamant.zx),
                        ] {
                            let error =
                                (computed[row * 2 * element_count + column] - expected).abs();
                            // A mean displacement has the order of (1−ν)/(πμ) l.
                            max_error = max_error.max(error / (0.1 * source.length()));
                        }
                    }
                }
                println!("{element_count} elements: {max_error:e}");
                assert!(max_error < tolerance, "{max_error:e}");
            }
        }
    }

    /// Compliances of slow motions tend to static compliances: up to a constant on a half-plane, exactly on rigid bedrock.
    ///
    /// The constants of zz and xx differ.
    #[test]
    fn statics_are_the_limit_of_slow_motions() {
        let layer = Soil::new(1.0, 0.4, 1.0).unwrap();
        let on_rock = SoilProfile::on_half_plane(Soil::new(7.0, 0.2, 1.2).unwrap());
        for (bedrock, tolerance) in [(on_rock, 1e-6), (SoilProfile::on_rigid_bedrock(), 1e-8)] {
            let is_rigid = tolerance < 1e-7;
            let profile = bedrock.with_layer(layer, 0.8).unwrap().with_layer(layer, 0.5).unwrap();
            let strip = Strip::new(-1.0..1.0, 5, Grading::Cosine).unwrap();
            let classes = PairClasses::new(strip.elements()).unwrap();
            let static_values = pair_compliances(&profile, &classes).unwrap();
            let mut slow_values = static_values.clone();
            let integrals = Wavenumbers::new(&classes, 1e-12);
            let s = Complex::real(2e-5);
            integrals
                .compliance(&profile, s, &mut StripWorkspace::default(), &mut slow_values)
                .unwrap();
            let mut max_error = 0.0_f64;
            for component in 0..3 {
                let mut differences = vec![];
                for class in 0..classes.count() {
                    let lengths =
                        classes.representative(class).unwrap().map(|element| element.length());
                    let difference =
                        slow_values[class][component].re - static_values[class][component].re;
                    differences.push(difference / (lengths[0] * lengths[1]));
                }
                let settlement = differences[0];
                let has_settlement = !is_rigid && component < 2;
                assert!(!has_settlement || settlement.abs() > 1e-2);
                for difference in differences {
                    let datum = if has_settlement { settlement } else { 0.0 };
                    max_error = max_error.max((difference - datum).abs());
                }
            }
            println!("rigid bedrock {is_rigid}: {max_error:e}");
            assert!(max_error < tolerance, "{is_rigid} {max_error:e}");
        }
    }

    #[test]
    fn laws_without_long_term_stiffness_are_errors() {
        let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
        let law = Kjartansson::new(0.05, 1.0).unwrap();
        let profile = SoilProfile::on_half_plane(soil).with_damping(law);
        let elements = Strip::uniform(0.0..1.0, 2).unwrap().elements();
        let outcome = static_compliance(&profile, &elements, &mut [0.0; 16]);
        assert!(matches!(outcome, Err(Error::Soil(SoilError::Modulus { layer: 1, .. }))));
        assert!(static_compliance(&profile, &elements, &mut [0.0; 15]).is_err());
    }
}
