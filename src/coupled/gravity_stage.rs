//! Friction while the weight and the loads at t = 0 are applied.

/// Friction while the structure is placed on the ground.
///
/// One rule holds for all forces at t = 0:
///
/// 1. The **weight** is applied first, as the stage defines: gravity on all masses, and each
///    [`Load::weight`](super::Load::weight).
/// 2. All **other loads** at t = 0 are applied after it, slowly, and the interface law acts. Their static state is the
///    end of a slow ramp of the same loads in time. Where elements slide or yield, the loads grow in ten increments.
///
/// [Soil at rest](crate::fem::Mesh::with_stress_at_rest) in a trench has no weight and no pressures at rest: every stage
/// applies the other weights with the trench bonded.
///
/// A base that never opens ([`Bonded`](crate::interface::Bonded)) is bonded under weight and loads. On elastic ground a
/// weight that acts as an ordinary load causes friction, unlike a placement without friction. With ν = 0.33 and a
/// friction of 0.5 a strip settles by up to 1.5 % less, and its shear traction reaches half its pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum GravityStage {
    /// The base is placed without friction and cohesion, and sticks from then on.
    ///
    /// Bearing pressures, tensile strengths and bonds of the laws act during the placement. An element that opens under
    /// the weight alone is open at the start.
    #[default]
    Frictionless,
    /// The interface law acts while the weight is applied, as under the loads.
    ///
    /// The weight is applied in one step.
    Frictional,
    /// The structure replaces soil at rest, for comparisons.
    ///
    /// It is for a structure with walls in the ground. The walls have no friction at the start, and the soil was never
    /// cut open. Pressures of the soil at rest act on base and walls, and the difference of the weights strains the
    /// soil. A structure as heavy as the soil that it replaces causes no strain. Below a lighter structure part of the
    /// base opens. The pressures on the walls of a heavier structure exceed the pressures of the soil at rest. Elements
    /// under laws that never open are bonded from the start. On the surface this stage is
    /// [`Frictionless`](Self::Frictionless).
    WishedInPlace,
    /// There is no static state: weight and loads act from t = 0 on.
    ///
    /// The base starts without pressure. Use this stage for a structure that is dropped, or tilted and released.
    ///
    /// ```
    /// use basemat::Simulation;
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::GravityStage;
    /// use basemat::interface::Coulomb;
    /// use basemat::structure::RigidBlock;
    ///
    /// // Tilted by 20 mrad about its left edge.
    /// let tilt = 0.02;
    /// let mut simulation = Simulation::builder(0.001)
    ///     .structure(RigidBlock::new(1.0, 4.0, 2400.0)?.with_p_delta(9.81)?)
    ///     .ground(SpringGround::new(-0.5..0.5, 8, 5e9, 2e9)?.with_dashpots(1e6, 1e6)?)
    ///     .interface(Coulomb::new(0.8)?)
    ///     .gravity_stage(GravityStage::Unloaded)
    ///     .initial_displacement([0.0, 0.5 * tilt, tilt])
    ///     .build()?;
    /// assert_eq!(simulation.state().uplifted_fraction, 1.0);
    /// let run = simulation.run(1000, |_| {})?;
    /// // The block rocks to its other edge, by a smaller angle.
    /// let other_side = -run.whole.base_rotation.lowest.value;
    /// assert!(other_side > 0.2 * tilt && other_side < tilt, "{other_side}");
    /// # Ok::<(), basemat::Error>(())
    /// ```
    Unloaded,
}

words! { pub(crate) GravityStage, "gravity stage", {
    Frictionless = "frictionless",
    Frictional = "frictional",
    WishedInPlace = "wished_in_place",
    Unloaded = "unloaded",
} }
