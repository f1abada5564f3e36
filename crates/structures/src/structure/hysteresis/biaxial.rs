//! Hysteretic spring with two deformations, whose force components share one limit.

use super::BiaxialResponse;
use super::coupled_bouc_wen::CoupledBoucWen;
use super::coupled_slider::CoupledSlider;
use crate::error::Result;
use crate::structure::InternalEnergy;

/// A hysteretic spring with a deformation in two directions at a right angle.
///
/// [`Bilinear::coupled`](crate::structure::Bilinear::coupled),
/// [`FrictionPendulum::coupled`](crate::structure::FrictionPendulum::coupled),
/// [`LeadRubber::coupled`](crate::structure::LeadRubber::coupled) and
/// [`BoucWen::coupled`](crate::structure::BoucWen::coupled) make such springs. The limit of the force is a circle, so
/// that the law does not depend on the axes. Along a straight line through the origin it is the law of the uniaxial
/// spring. Two uniaxial springs along x and y have a square limit instead, and up to √2 times the force along its
/// diagonals.
///
/// Deformations are in m, forces in N. The spring stores the last **committed** deformation; trial deformations change
/// no state, as for [`Hysteresis`](crate::structure::Hysteresis).
///
/// ```
/// use basemat::structure::FrictionPendulum;
///
/// // 50 kN of friction, and 500 kN/m by the climb on the dish.
/// let bearing = FrictionPendulum::new(1.0e6, 2.0, 0.05)?.coupled();
/// let [x, y] = bearing.response([0.06, 0.08]).force;
/// assert!((x - 0.6 * 100.0e3).abs() < 1e-6 && (y - 0.8 * 100.0e3).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BiaxialSpring {
    law: BiaxialLaw,
}

/// Force law of a biaxial spring.
#[derive(Debug, Clone, PartialEq)]
enum BiaxialLaw {
    Slider(CoupledSlider),
    BoucWen(CoupledBoucWen),
}

impl From<CoupledSlider> for BiaxialSpring {
    fn from(law: CoupledSlider) -> Self {
        Self { law: BiaxialLaw::Slider(law) }
    }
}

impl From<CoupledBoucWen> for BiaxialSpring {
    fn from(law: CoupledBoucWen) -> Self {
        Self { law: BiaxialLaw::BoucWen(law) }
    }
}

/// Calls a method of the law in its variant.
macro_rules! call_law {
    ($law:expr, $variant:ident => $call:expr) => {
        match $law {
            BiaxialLaw::Slider($variant) => $call,
            BiaxialLaw::BoucWen($variant) => $call,
        }
    };
}

impl BiaxialSpring {
    /// Force and tangent at `deformation` (m), after a straight path from the last committed one.
    pub fn response(&self, deformation: [f64; 2]) -> BiaxialResponse {
        call_law!(&self.law, law => law.response(deformation))
    }

    /// Stored and dissipated energy (J) at `deformation`, after a straight path from the last committed one.
    ///
    /// Their sum is the work of the force along the path.
    pub fn energy(&self, deformation: [f64; 2]) -> InternalEnergy {
        call_law!(&self.law, law => law.energy(deformation))
    }

    /// Accepts a step that ended with `deformation`.
    pub fn commit(&mut self, deformation: [f64; 2]) {
        call_law!(&mut self.law, law => law.commit(deformation));
    }

    /// The internal variables that [`commit`](BiaxialSpring::commit) changes; their number is constant.
    pub fn save(&self) -> Vec<f64> {
        call_law!(&self.law, law => law.save())
    }

    /// Restores the variables that [`save`](BiaxialSpring::save) returned.
    ///
    /// # Errors
    /// `CheckpointError::Corrupt` for impossible values; the spring then does not change.
    pub fn restore(&mut self, values: &[f64]) -> Result<()> {
        call_law!(&mut self.law, law => law.restore(values))
    }
}
