//! Integration points of a four-node quadrilateral with the mean dilatation of the element (B-bar).
//!
//! The dilatation ε_xx + ε_yy at each point is replaced by its mean over the element (Hughes 1980, IJNME 15,
//! 1413–1418). Each direct strain, also ε_zz, gets a third of the difference. The mean of ε_zz over the element stays
//! zero.

use super::quad_force::{IntegrationPoint, IntegrationRule};
use super::quad4::{
    DOF_COUNT, Jacobian, NODE_COORDINATES, QuadFormulation, gauss_points, shape_functions,
};
use crate::error::Result;

/// Integration points of the formulation `MeanDilatation`, the only formulation for inelastic materials.
impl IntegrationRule<DOF_COUNT> for QuadFormulation {
    fn point_count(self) -> usize {
        NODE_COORDINATES.len()
    }

    fn visit_points(
        self,
        coordinates: &[[f64; 3]],
        mut visit: impl FnMut(&IntegrationPoint<DOF_COUNT>) -> Result<()>,
    ) -> Result<()> {
        let points = gauss_points();
        let jacobians = points.map(|point| Jacobian::at(point, coordinates));
        let mut element_area = 0.0;
        let mut mean_derivatives = [[0.0; 2]; 4];
        for (point, jacobian) in points.iter().zip(&jacobians) {
            element_area += jacobian.determinant;
            let derivatives = jacobian.shape_derivatives(*point);
            for (mean, derivative) in
                mean_derivatives.as_flattened_mut().iter_mut().zip(derivatives.as_flattened())
            {
                *mean += jacobian.determinant * derivative;
            }
        }
        for (index, (point, jacobian)) in points.into_iter().zip(&jacobians).enumerate() {
            let mut strains = [[0.0; 4]; DOF_COUNT];
            let derivatives = jacobian.shape_derivatives(point);
            for (node, [dx, dy]) in derivatives.into_iter().enumerate() {
                // Every direct strain has a third of the difference between mean and local dilatation.
                let x_third = (mean_derivatives[node][0] / element_area - dx) / 3.0;
                let y_third = (mean_derivatives[node][1] / element_area - dy) / 3.0;
                strains[2 * node] = [dx + x_third, x_third, x_third, dy];
                strains[2 * node + 1] = [y_third, dy + y_third, y_third, dx];
            }
            let area = jacobian.determinant;
            let has_derivatives = false;
            visit(&IntegrationPoint {
                index,
                natural_point: point,
                area,
                strains,
                has_derivatives,
            })?;
        }
        Ok(())
    }

    fn node_weights(self, natural_point: [f64; 2]) -> impl IntoIterator<Item = f64> {
        shape_functions(natural_point)
    }
}
