//! Contact on soil that yields under its bearing pressure.

use super::{ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact};
use crate::error::{Result, positive};

/// Coulomb friction and uplift on soil whose contact pressure is bounded.
///
/// Where the pressure reaches the bearing pressure q, the base settles permanently.
/// [`ShallowFooting`](crate::soil::ShallowFooting) computes q of a footing from the strength of its soil. The state
/// variable of each element is its indentation w ≥ 0: after uplift, the base meets the surface at w below its initial
/// position. The normal conditions of the element, combined with stick and slip:
///
/// | | |
/// |---|---|
/// | open | p = 0, g ≥ −w |
/// | closed | g = −w, 0 ≤ p ≤ q |
/// | yielding | p = q, g ≤ −w; w becomes −g |
///
/// In the energy balance, `contact` includes q times the indentation. The law models the near field of a foundation: a
/// rocking base settles, and the surface under it becomes rounded, as in beds of yielding springs (Allotey & El Naggar
/// 2003). The ground below remains elastic. Sliding does not reduce q.
/// Only friction bounds the shear traction; the law has no bound by the undrained strength of the soil.
///
/// ```
/// use basemat::Simulation;
/// use basemat::bem::SpringGround;
/// use basemat::interface::Yielding;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
///
/// // 118 kPa due to weight, on soil with a bearing pressure of 300 kPa.
/// let mut simulation = Simulation::builder(0.002)
///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///     .ground(SpringGround::new(-2.0..2.0, 16, 8e7, 4e7)?.with_dashpots(7e5, 4e5)?)
///     .interface(Yielding::new(300.0e3, 0.6)?)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(2500, |state| {
///     assert!(state.contact.iter().all(|c| c.pressure <= 300.0e3 * (1.0 + 1e-9)));
/// })?;
/// let indentation = simulation.state().state_variables(0)[0];
/// assert!(indentation > 1e-3, "the edge has sunk in: {indentation}");
/// assert!(run.energy_error < 1e-9 && simulation.state().energy_balance.contact > 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "YieldingForm"))]
pub struct Yielding {
    bearing_pressure: f64,
    #[cfg_attr(
        feature = "serde",
        serde(rename = "friction", serialize_with = "Coulomb::write_friction")
    )]
    contact: Coulomb,
}

validated! {
    Yielding as YieldingForm {
        bearing_pressure: f64,
        #[serde(with = "crate::text::forms::number")]
        friction: f64,
    }
    => Yielding::new(bearing_pressure, friction)
}

impl Yielding {
    /// Law with a bearing pressure (Pa) and a friction coefficient of zero or more.
    ///
    /// [`ShallowFooting::drained_pressure`](crate::soil::ShallowFooting::drained_pressure) and
    /// [`ShallowFooting::undrained_pressure`](crate::soil::ShallowFooting::undrained_pressure) return bearing pressures. If
    /// the coefficient is infinite, nothing ever slides.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a pressure that is not finite and above zero, and for a
    /// coefficient that is NaN or negative.
    pub fn new(bearing_pressure: f64, friction: f64) -> Result<Self> {
        let bearing_pressure = positive("bearing pressure", bearing_pressure)?;
        Ok(Self { bearing_pressure, contact: Coulomb::new(friction)? })
    }

    /// The friction coefficient.
    pub(crate) fn friction(&self) -> f64 {
        self.contact.friction()
    }
}

/// Indentation of an element, its state variable, m.
fn indentation(start: &PreviousContact) -> f64 {
    start.state_variables.first().copied().unwrap_or(0.0)
}

impl InterfaceLaw for Yielding {
    fn modes(&self) -> &[Mode] {
        Mode::with_yield(self.friction())
    }

    fn state_variables(&self) -> usize {
        1
    }

    fn commit(
        &self,
        _start: &PreviousContact,
        end: &ContactState,
        mode: Mode,
        state_variables: &mut [f64],
    ) {
        if mode.is_yield() {
            state_variables[0] = state_variables[0].max(-end.gap);
        }
    }

    fn friction_coefficient(&self) -> Option<f64> {
        Some(self.friction())
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        Ok(Limits {
            pressure_cap: self.bearing_pressure,
            gap_offset: -indentation(start),
            ..self.contact.limits(start)?
        })
    }

    /// The same law without friction, with the same bearing pressure.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Self { contact: Coulomb::frictionless(), ..*self })
    }
}
