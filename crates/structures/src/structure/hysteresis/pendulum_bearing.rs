//! Friction pendulum under the vertical force that acts on it.

use super::corrupt;
use super::coupled_slider::CoupledSlider;
use crate::error::Result;
use crate::structure::InternalEnergy;

/// Friction pendulum that carries the structure: its weight is the vertical force on it.
///
/// Made by [`FrictionPendulum::with_vertical_stiffness`](crate::structure::FrictionPendulum::with_vertical_stiffness);
/// [`WithSprings::pendulum`](crate::structure::WithSprings::pendulum) attaches it. Its deformations d_x, d_y, d_z are
/// displacements (m) of the part above relative to the part below. The bearing slides in any direction, climbs on its
/// dish of radius R, has a vertical stiffness k, and lifts off:
///
/// ```text
/// N = k ⟨|d|²/(2R) − d_z⟩                vertical force; d = (d_x, d_y)
/// F = N d/R + friction · N₀ · n          n along the sliding; N₀: N at the end of the step before
/// ```
///
/// N and N d/R are the slopes of one energy, N²/(2k), so that the vertical motion receives the work of the climb. Friction
/// follows N one step later. Overturning moments of N at the displaced bearing are left out.
///
/// ```
/// use basemat::structure::FrictionPendulum;
///
/// let bearing = FrictionPendulum::new(1.0e6, 2.0, 0.05)?.with_vertical_stiffness(2.0e9)?;
/// // Under its weight it sinks by 0.5 mm. 0.1 m aside it has climbed by 2.5 mm.
/// let [x, y, z] = bearing.force([0.1, 0.0, 2.5e-3 - 0.5e-3]);
/// assert!((x - 100.0e3).abs() < 1e-3 && y == 0.0 && (z + 1.0e6).abs() < 1e-3);
/// // Above the dish it carries nothing.
/// assert_eq!(bearing.force([0.0, 0.0, 1.0e-3]), [0.0; 3]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PendulumBearing {
    slider: CoupledSlider,
    radius: f64,
    friction: f64,
    /// Vertical stiffness, N/m.
    stiffness: f64,
}

impl PendulumBearing {
    pub(super) fn new(slider: CoupledSlider, radius: f64, friction: f64, stiffness: f64) -> Self {
        Self { slider, radius, friction, stiffness }
    }

    /// Vertical force N on the bearing, N; zero while it is lifted off.
    pub fn vertical_force(&self, deformation: [f64; 3]) -> f64 {
        self.stiffness * self.shortening(deformation).max(0.0)
    }

    /// Climb on the dish less the rise of the part above, m; negative while the bearing is lifted off.
    fn shortening(&self, [x, y, z]: [f64; 3]) -> f64 {
        (x * x + y * y) / (2.0 * self.radius) - z
    }

    /// Forces along x, along y and up at a deformation (m), positive against positive deformations, N.
    pub fn force(&self, deformation: [f64; 3]) -> [f64; 3] {
        let level = horizontal(deformation);
        let weight = self.vertical_force(deformation);
        let friction = self.slider.response(level).force;
        [
            friction[0] + weight * level[0] / self.radius,
            friction[1] + weight * level[1] / self.radius,
            -weight,
        ]
    }

    /// Slopes of the forces over the deformation, N/m: a symmetric matrix, by rows.
    pub(super) fn tangent(&self, deformation: [f64; 3]) -> [[f64; 3]; 3] {
        let level = horizontal(deformation);
        let slider_tangent = self.slider.response(level).tangent;
        let is_closed = self.shortening(deformation) >= 0.0;
        let stiffness = if is_closed { self.stiffness } else { 0.0 };
        let climb = self.vertical_force(deformation) / self.radius;
        // Slopes of the shortening.
        let shortening = [level[0] / self.radius, level[1] / self.radius, -1.0];
        let mut tangent = [[0.0; 3]; 3];
        for (i, row) in tangent.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let sliding = if i < 2 && j < 2 { slider_tangent[i][j] } else { 0.0 };
                let turning = if i == j && i < 2 { climb } else { 0.0 };
                *entry = sliding + turning + stiffness * shortening[i] * shortening[j];
            }
        }
        tangent
    }

    /// Stored and dissipated energy (J) at a deformation, on a straight path to it.
    pub fn energy(&self, deformation: [f64; 3]) -> InternalEnergy {
        let weight = self.vertical_force(deformation);
        let mut energy = self.slider.energy(horizontal(deformation));
        energy.stored += 0.5 * weight * weight / self.stiffness;
        energy
    }

    /// Accepts a step that ended with a deformation: friction then follows the vertical force at its end.
    pub(super) fn commit(&mut self, deformation: [f64; 3]) {
        let level = horizontal(deformation);
        self.slider.commit(level);
        self.slider.set_limit(self.friction * self.vertical_force(deformation), level);
    }

    pub(super) fn save(&self) -> Vec<f64> {
        [self.slider.save(), vec![self.slider.limit]].concat()
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        let (&limit, slider_variables) = values.split_last().ok_or_else(corrupt)?;
        if !(limit.is_finite() && limit >= 0.0) {
            return Err(corrupt());
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
