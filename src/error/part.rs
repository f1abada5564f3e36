//! Errors of a user's own parts.

use super::Error;

impl Error {
    /// Makes an [`Error::Part`], for a user's own part when no other error fits.
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::interface::{ContactScene, Coulomb, InterfaceLaw, Limits, PreviousContact};
    /// use basemat::structure::RigidBlock;
    /// use basemat::{Error, Result, Simulation};
    ///
    /// /// Friction of a bearing that was tested for steps of up to 5 ms.
    /// struct Bearing(Coulomb);
    ///
    /// impl InterfaceLaw for Bearing {
    ///     fn check(&self, scene: &ContactScene) -> Result<()> {
    ///         if scene.time_step <= 0.005 {
    ///             return Ok(());
    ///         }
    ///         Err(Error::part("bearing", format!("a step of {} s is too long", scene.time_step)))
    ///     }
    ///     fn limits(&self, start: &PreviousContact) -> Result<Limits> {
    ///         self.0.limits(start)
    ///     }
    /// }
    ///
    /// let refused = Simulation::builder(0.01)
    ///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    ///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///     .interface(Bearing(Coulomb::new(0.1)?))
    ///     .build()
    ///     .unwrap_err();
    /// assert_eq!(refused.to_string(), "bearing: a step of 0.01 s is too long");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn part(part: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Part { part: part.into(), reason: reason.into() }
    }
}
