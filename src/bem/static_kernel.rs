//! Static influence coefficients of boundary elements on an elastic half-plane.

use super::strip::Overlap;
use crate::error::{Result, positive, same_length};
use crate::fundamental::Surface;
use crate::geometry::ContactElement;
use crate::history::PairClasses;
use crate::linalg::gauss;
use crate::soil::Soil;

/// Reference length in spans of the elements, large enough for a positive definite static matrix.
const REFERENCE_LENGTH_SPANS: f64 = 10.0;

/// Element means of the static surface displacement (Flamant).
///
/// `u_zz` = `u_xx` = −(1−ν)/(πμ) ln(|x|/L₀) and `u_zx` = −`u_xz` = (1−2ν)/(4μ) sgn x (Johnson 1985, § 2.3), x from the
/// load to the receiver, z down.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StaticKernel {
    /// Factor of ln(|x|/L₀), 1/Pa.
    logarithm_factor: f64,
    /// Factor of sgn x, 1/Pa.
    sign_factor: f64,
    /// Distance L₀ at which displacements vanish, m.
    reference_length: f64,
}

impl StaticKernel {
    /// Kernel of `soil`, with displacements that vanish at the distance `reference_length` (L₀, m) from a load.
    ///
    /// The distance can be chosen freely because a half-plane has no static datum.
    ///
    /// # Errors
    /// [`crate::Error::Input`] unless the reference length is finite and above zero.
    pub(crate) fn new(soil: Soil, reference_length: f64) -> Result<Self> {
        positive("reference length", reference_length)?;
        let modulus = soil.shear_modulus();
        Ok(Self {
            logarithm_factor: -(1.0 - soil.poisson()) / (std::f64::consts::PI * modulus),
            sign_factor: (1.0 - 2.0 * soil.poisson()) / (4.0 * modulus),
            reference_length,
        })
    }

    /// Kernel for `elements` (at least one), with a reference length well above their span.
    ///
    /// The logarithm needs a length as datum. A long reference length keeps the static matrix positive definite. The
    /// settlement that it adds cancels in all results.
    pub(super) fn under(soil: Soil, elements: &[ContactElement]) -> Result<Self> {
        let span = elements[elements.len() - 1].right() - elements[0].left();
        Self::new(soil, REFERENCE_LENGTH_SPANS * span)
    }

    /// Mean displacement of the receiver due to a unit traction on the source, m/Pa.
    ///
    /// # Errors
    /// [`crate::Error::Input`] unless both elements have finite ends, the left one first.
    pub(crate) fn coefficients(
        &self,
        receiver: ContactElement,
        source: ContactElement,
    ) -> Result<Surface> {
        let overlap = Overlap::new(receiver, source)?;
        let Overlap { nodes, even_overlaps, odd_overlaps, receiver_length, .. } = &overlap;
        let mut even_sum = 0.0;
        let mut odd_sum = 0.0;
        for i in 1..nodes.len() {
            even_sum += self.logarithm_integral(
                [nodes[i - 1], nodes[i]],
                [even_overlaps[i - 1], even_overlaps[i]],
            );
            odd_sum += 0.5 * (nodes[i] - nodes[i - 1]) * (odd_overlaps[i - 1] + odd_overlaps[i]);
        }
        let diagonal = self.logarithm_factor * even_sum / receiver_length;
        Ok(Surface { zz: diagonal, xx: diagonal, zx: self.sign_factor * odd_sum / receiver_length })
    }

    /// Overwrites `matrix` (2Q × 2Q, row-major) with the means of all pairs of elements.
    pub(super) fn compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        let classes = PairClasses::new(elements.to_vec())?;
        same_length("static compliance", matrix.len(), classes.layout().matrix_len())?;
        let mut means = Vec::with_capacity(elements.len() * elements.len());
        for receiver in elements {
            for source in elements {
                means.push(self.coefficients(*receiver, *source)?);
            }
        }
        classes.scatter(matrix, |[receiver, source], pair| {
            let Surface { zz, xx, zx } = means[receiver * elements.len() + source];
            [zz, xx, zx * pair.sign]
        });
        Ok(())
    }

    /// ∫ w ln(x/L₀) dx from `x0` to `x1`, for w linear from `w0` to `w1`.
    fn logarithm_integral(&self, [x0, x1]: [f64; 2], [w0, w1]: [f64; 2]) -> f64 {
        let length = x1 - x0;
        let slope = (w1 - w0) / length;
        if x0 >= 0.5 * length {
            // Away from the singularity the rule is exact to rounding, while differences of the primitives lose digits.
            let rule = gauss::largest_rule();
            let mut sum = 0.0;
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let distance = 0.5 * length * (1.0 + node);
                let logarithm = ((x0 + distance) / self.reference_length).ln();
                sum += weight * (w0 + slope * distance) * logarithm;
            }
            return 0.5 * length * sum;
        }
        let start_primitives = self.primitives(x0);
        let end_primitives = self.primitives(x1);
        (w0 - slope * x0) * (end_primitives[0] - start_primitives[0])
            + slope * (end_primitives[1] - start_primitives[1])
    }

    /// Primitives of ln(x/L₀) and of x ln(x/L₀).
    fn primitives(&self, x: f64) -> [f64; 2] {
        if x == 0.0 {
            return [0.0, 0.0];
        }
        let logarithm = (x / self.reference_length).ln();
        [x * (logarithm - 1.0), 0.5 * x * x * (logarithm - 0.5)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn element(left: f64, right: f64) -> ContactElement {
        ContactElement::new(left, right)
    }

    #[test]
    fn invalid_input_is_an_error() {
        let soil = Soil::new(8e7, 0.3, 2000.0).unwrap();
        for reference_length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(StaticKernel::new(soil, reference_length).is_err());
        }
        let kernel = StaticKernel::new(soil, 1.0).unwrap();
        for invalid_element in
            [element(f64::NAN, 1.0), element(0.0, f64::INFINITY), element(1.0, 0.0)]
        {
            assert!(kernel.coefficients(invalid_element, element(0.0, 1.0)).is_err());
        }
    }

    #[test]
    fn means_match_quadrature() {
        let soil = Soil::new(2.0, 0.3, 1.0).unwrap();
        let kernel = StaticKernel::new(soil, 3.0).unwrap();
        // Midpoint rule over the receiver of the exact line integral over the source.
        for (receiver, source) in [
            (element(0.0, 1.0), element(1.5, 3.0)),
            (element(-4.0, -1.0), element(-0.9, 0.3)),
            (element(0.0, 1.0), element(400.0, 401.0)),
        ] {
            let point_count = 4000;
            let mut sum = 0.0;
            for i in 0..point_count {
                let fraction = (f64::from(i) + 0.5) / f64::from(point_count);
                let x = receiver.left() + receiver.length() * fraction;
                sum += line_integral(x - source.left()) - line_integral(x - source.right());
            }
            let expected = -0.7 / (std::f64::consts::PI * 2.0) * sum / f64::from(point_count);
            let computed = kernel.coefficients(receiver, source).unwrap();
            let error = (computed.zz - expected).abs();
            assert!(error < 1e-6 * expected.abs(), "{receiver:?} {source:?}");
            assert_eq!(computed.zz, computed.xx);
            let expected_coupling = -0.4 / 8.0 * source.length();
            let error = (computed.zx - expected_coupling).abs();
            assert!(error < 1e-15, "{} {expected_coupling}", computed.zx);
        }
    }

    /// ∫₀^x ln(|ξ|/3) dξ.
    fn line_integral(x: f64) -> f64 {
        if x == 0.0 { 0.0 } else { x * ((x.abs() / 3.0).ln() - 1.0) }
    }

    #[test]
    fn self_term_is_the_closed_form() {
        // (1/l) ∫∫ ln|x−ξ| = l (ln l − 3/2).
        let soil = Soil::new(1.0, 0.25, 1.0).unwrap();
        let kernel = StaticKernel::new(soil, 1.0).unwrap();
        let computed = kernel.coefficients(element(2.0, 4.0), element(2.0, 4.0)).unwrap();
        let expected = -0.75 / std::f64::consts::PI * 2.0 * (2.0_f64.ln() - 1.5);
        assert!((computed.zz - expected).abs() < 1e-15);
        assert_eq!(computed.zx, 0.0);
    }
}
