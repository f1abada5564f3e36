//! Where a run begins: weight, loads at t = 0 and initial motion, as they were given.

use crate::coupled::load::Load;
use crate::error::{Result, all_finite, same_length};
use crate::motion::STANDARD_GRAVITY;

/// Friction while the structure is placed on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Placement {
    /// The base is placed without friction and without adhesion, and sticks from then on. What
    /// does not touch under weight alone starts open. Where no element's law ever opens, the base
    /// is bonded from the start.
    #[default]
    Frictionless,
    /// The interface law acts while the weight comes on, in one step.
    WithInterfaceLaw,
    /// There is no static state: the base begins unpressed, and weight and loads act from t = 0 on.
    /// For a structure that is dropped, or tilted and let go.
    ///
    /// ```
    /// use basemat::Simulation;
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::Placement;
    /// use basemat::interface::Coulomb;
    /// use basemat::structure::RigidBlock;
    ///
    /// // Tilted by 20 mrad about its left edge.
    /// let tilt = 0.02;
    /// let mut simulation = Simulation::builder(0.001)
    ///     .structure(RigidBlock::new(1.0, 4.0, 2400.0)?.with_p_delta(9.81)?)
    ///     .ground(SpringGround::new(-0.5..0.5, 8, 5e9, 2e9)?.with_dashpots(1e6, 1e6)?)
    ///     .interface(Coulomb::new(0.8)?)
    ///     .placement(Placement::Unloaded)
    ///     .initial_displacement([0.0, 0.5 * tilt, tilt])
    ///     .build()?;
    /// assert_eq!(simulation.state().uplifted_fraction, 1.0);
    /// let run = simulation.run(1000, |_| {})?;
    /// // It rocks over to the other edge, and less far.
    /// let other_side = -run.whole.base_rotation.lowest.value;
    /// assert!(other_side > 0.2 * tilt && other_side < tilt, "{other_side}");
    /// # Ok::<(), basemat::Error>(())
    /// ```
    Unloaded,
}

words! { Placement, "placement", {
    Frictionless = "frictionless",
    WithInterfaceLaw = "with_interface_law",
    Unloaded = "unloaded",
} }

/// Weight, loads and initial motion.
pub(crate) struct Beginning {
    pub(crate) gravity: f64,
    pub(crate) placement: Placement,
    pub(crate) loads: Vec<Load>,
    /// Displacement and velocity of the unknowns at t = 0; empty for none.
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
}

impl Default for Beginning {
    fn default() -> Self {
        Self {
            gravity: STANDARD_GRAVITY,
            placement: Placement::default(),
            loads: Vec::new(),
            displacement: Vec::new(),
            velocity: Vec::new(),
        }
    }
}

impl Beginning {
    /// Refuses loads and motions of other unknowns than the structure's, and numbers that are not
    /// finite.
    pub(crate) fn check(&self, unknowns: usize) -> Result<()> {
        let mut loads = self.loads.iter().enumerate();
        loads.try_for_each(|(index, load)| load.check(index, unknowns))?;
        for (values, quantity) in
            [(&self.displacement, "initial displacement"), (&self.velocity, "initial velocity")]
        {
            if !values.is_empty() {
                same_length(quantity, values.len(), unknowns)?;
                all_finite(quantity, values)?;
            }
        }
        Ok(())
    }

    /// Whether weight and loads are there before the run begins.
    pub(crate) fn is_static(&self) -> bool {
        self.gravity > 0.0 && self.placement != Placement::Unloaded
    }

    /// Gravity as the laws may count on it at the start: zero where nothing presses.
    pub(crate) fn static_gravity(&self) -> f64 {
        if self.is_static() { self.gravity } else { 0.0 }
    }

    /// Whether weight acts as a load from t = 0 on.
    pub(crate) fn falls(&self) -> bool {
        self.gravity > 0.0 && self.placement == Placement::Unloaded
    }
}
