//! Friction pendulum whose friction follows the vertical force on it.

use super::corrupt_state;
use super::coupled_slider::CoupledSlider;
use crate::error::Result;
use crate::structure::InternalEnergy;

/// Friction pendulum that supports the structure, with friction in proportion to the vertical force on it.
///
/// [`FrictionPendulum::with_vertical_stiffness`](crate::structure::FrictionPendulum::with_vertical_stiffness) makes it;
/// [`WithSprings::pendulum`](crate::structure::WithSprings::pendulum) attaches it. Its deformations d_x, d_y, d_z are
/// displacements (m) of the part above relative to the part below. The bearing slides in any horizontal direction,
/// climbs on its dish of radius R, has a vertical stiffness k, and can lift off:
///
/// ```text
/// N = k ⟨|d|²/(2R) − d_z⟩                vertical force; d = (d_x, d_y)
/// F = N d/R + friction · N₀ · n          n: direction of sliding; N₀: N at the end of the previous step
/// ```
///
/// N and N d/R are the derivatives of one energy, N²/(2k), so that the work of the climb is done on the vertical
/// motion. Friction follows N one step later. Overturning moments of N at the displaced bearing are neglected.
///
/// ```
/// use basemat::structure::FrictionPendulum;
///
/// let bearing = FrictionPendulum::new(1.0e6, 2.0, 0.05)?.with_vertical_stiffness(2.0e9)?;
/// // The weight compresses the bearing by 0.5 mm. At a displacement of 0.1 m it has climbed by 2.5 mm.
/// let [x, y, z] = bearing.force([0.1, 0.0, 2.5e-3 - 0.5e-3]);
/// assert!((x - 100.0e3).abs() < 1e-3 && y == 0.0 && (z + 1.0e6).abs() < 1e-3);
/// // A bearing that has lifted off has no force.
/// assert_eq!(bearing.force([0.0, 0.0, 1.0e-3]), [0.0; 3]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PendulumBearing {
    slider: CoupledSlider,
    /// Radius of the dish, m.
    radius: f64,
    /// Coefficient of friction.
    friction: f64,
    /// Vertical stiffness, N/m.
    vertical_stiffness: f64,
}

impl PendulumBearing {
    pub(super) fn new(
        slider: CoupledSlider,
        radius: f64,
        friction: f64,
        vertical_stiffness: f64,
    ) -> Self {
        Self { slider, radius, friction, vertical_stiffness }
    }

    /// Vertical force N on the bearing, N; zero while it is lifted off.
    pub fn vertical_force(&self, deformation: [f64; 3]) -> f64 {
        self.vertical_stiffness * self.shortening(deformation).max(0.0)
    }

    /// Vertical shortening of the bearing, m; negative after lift-off.
    ///
    /// It is the climb on the dish less the rise of the part above.
    fn shortening(&self, [x, y, z]: [f64; 3]) -> f64 {
        (x * x + y * y) / (2.0 * self.radius) - z
    }

    /// Forces along x, along y and up at a deformation (m), positive against positive deformations, N.
    pub fn force(&self, deformation: [f64; 3]) -> [f64; 3] {
        let horizontal_deformation = horizontal(deformation);
        let vertical_force = self.vertical_force(deformation);
        let friction_force = self.slider.response(horizontal_deformation).force;
        [
            friction_force[0] + vertical_force * horizontal_deformation[0] / self.radius,
            friction_force[1] + vertical_force * horizontal_deformation[1] / self.radius,
            -vertical_force,
        ]
    }

    /// Derivatives of the forces with respect to the deformation, N/m: a symmetric matrix, row by row.
    pub(super) fn tangent(&self, deformation: [f64; 3]) -> [[f64; 3]; 3] {
        let horizontal_deformation = horizontal(deformation);
        let slider_tangent = self.slider.response(horizontal_deformation).tangent;
        let is_in_contact = self.shortening(deformation) >= 0.0;
        let contact_stiffness = if is_in_contact { self.vertical_stiffness } else { 0.0 };
        let dish_stiffness = self.vertical_force(deformation) / self.radius;
        let shortening_gradient = [
            horizontal_deformation[0] / self.radius,
            horizontal_deformation[1] / self.radius,
            -1.0,
        ];
        let mut tangent = [[0.0; 3]; 3];
        for (i, row) in tangent.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let friction_tangent = if i < 2 && j < 2 { slider_tangent[i][j] } else { 0.0 };
                let dish_tangent = if i == j && i < 2 { dish_stiffness } else { 0.0 };
                *entry = friction_tangent
                    + dish_tangent
                    + contact_stiffness * shortening_gradient[i] * shortening_gradient[j];
            }
        }
        tangent
    }

    /// Stored and dissipated energy (J) at a deformation, after a straight path from the last committed one.
    pub fn energy(&self, deformation: [f64; 3]) -> InternalEnergy {
        let vertical_force = self.vertical_force(deformation);
        let mut energy = self.slider.energy(horizontal(deformation));
        energy.stored += 0.5 * vertical_force * vertical_force / self.vertical_stiffness;
        energy
    }

    /// Accepts a step that ended with a deformation, and updates the friction by the vertical force there.
    pub(super) fn commit(&mut self, deformation: [f64; 3]) {
        let horizontal_deformation = horizontal(deformation);
        self.slider.commit(horizontal_deformation);
        self.slider
            .set_limit(self.friction * self.vertical_force(deformation), horizontal_deformation);
    }

    pub(super) fn save(&self) -> Vec<f64> {
        [self.slider.save(), vec![self.slider.limit]].concat()
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        let (&limit, slider_variables) = values.split_last().ok_or_else(corrupt_state)?;
        if !(limit.is_finite() && limit >= 0.0) {
            return Err(corrupt_state());
        }
        self.slider.restore(slider_variables)?;
        self.slider.limit = limit;
        Ok(())
    }
}

/// Deformations along x and y.
fn horizontal([x, y, _]: [f64; 3]) -> [f64; 2] {
    [x, y]
}
