//! Shear building with yielding storeys, or on isolators.

use super::section::SectionRows;
use crate::error::{Result, not_negative, positive};
use crate::structure::hysteresis::{Hysteresis, Springs};
use crate::structure::{ContactNode, NonlinearForce, ShearBuilding, Storey, Structure, Triplets};

/// The level of isolators between the basemat and the slab on which a building stands.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct IsolationLevel {
    /// Height of the bearings, from the basemat to the slab, m.
    pub height: f64,
    /// Mass of the slab above the bearings, kg per metre of thickness.
    pub slab_mass: f64,
    /// Rotary inertia of that slab about its centre, kg m² per metre of thickness.
    pub slab_inertia: f64,
    /// Viscous dampers beside the bearings, N s/m per metre of thickness.
    pub damping: f64,
}

/// A [`ShearBuilding`] some of whose storeys follow a [`Hysteresis`] law.
///
/// The law sees the storey's drift and takes the place of its columns' stiffness. Everything else is
/// that of the shear building: unknowns, drifts, P–Δ, and damping. Stiffness-proportional damping
/// stays that of the stiffness in [`Storey`], however far the columns yield. Where it shall not act
/// in a yielding storey, leave [`ShearBuilding::with_stiffness_damping`] out and give the others
/// dashpots ([`Storey::damping`]) of ζ k/(π f₁).
///
/// ```
/// use basemat::structure::{Bilinear, NonlinearShearBuilding, ShearBuilding, Storey, Structure};
///
/// let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 3];
/// let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?;
/// let soft = Bilinear::new(40.0e6, 150.0e3, 0.05)?;
/// let building = NonlinearShearBuilding::new(building).with_law(0, soft)?;
/// let nonlinear = building.nonlinear().expect("a storey yields");
/// // 10 mm of drift in the lowest storey, far beyond its 3.75 mm at yield
/// let mut force = [0.0; 6];
/// nonlinear.force(&[0.0, 0.0, 0.0, 0.01, 0.01, 0.01], &mut force)?;
/// assert!((force[3] - (150.0e3 + 2.0e6 * 6.25e-3)).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct NonlinearShearBuilding {
    building: ShearBuilding,
    springs: Springs,
}

short_debug! {
    NonlinearShearBuilding; self; building: self.building, laws: self.springs.len()
}

impl NonlinearShearBuilding {
    /// The building as it is, all its storeys linear.
    pub fn new(building: ShearBuilding) -> Self {
        Self { building, springs: Springs::default() }
    }

    /// The building with its lowest columns on a slab that rests on isolators of this `law`; the
    /// isolators become storey 0, and the building's storeys count from 1.
    ///
    /// The building's damping ratio, if set, stays that of its storeys; the isolators have the damping
    /// of their law and of [`IsolationLevel::damping`], and none in proportion to their stiffness.
    ///
    /// With [`ShearBuilding::with_p_delta`] the weight W on the isolators pushes them down the
    /// slope of a base that turns, with W θ, and turns it with W d by its drift d. The softening
    /// −W/h of columns is not theirs: a slider's weight is in its law already (W/R of a
    /// [`FrictionPendulum`](crate::structure::FrictionPendulum)), and the stiffness of rubber bearings is to be
    /// given as it is under their load.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the level's height and slab mass and the law's
    /// first stiffness are positive, its inertia and damping not negative.
    pub fn isolated(
        building: ShearBuilding,
        level: IsolationLevel,
        law: impl Hysteresis + 'static,
    ) -> Result<Self> {
        let storey = Storey {
            height: positive("height of the isolators", level.height)?,
            mass: positive("mass of the slab above the isolators", level.slab_mass)?,
            rotary_inertia: not_negative("rotary inertia of the slab", level.slab_inertia)?,
            stiffness: positive("first stiffness of the isolators", law.response(0.0).tangent)?,
            damping: not_negative("damping of the isolators", level.damping)?,
        };
        Self::new(building.on_isolators(storey)?).with_law(0, law)
    }

    /// The same building with `storey` (0: the lowest) following `law`.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey,
    /// [`Error::Scene`](crate::Error::Scene) when it has a law already,
    /// [`Error::Input`](crate::Error::Input) when the law's first stiffness does not hold the storey
    /// up against its P–Δ.
    pub fn with_law(mut self, storey: usize, law: impl Hysteresis + 'static) -> Result<Self> {
        let drift = self.building.drift(storey)?;
        self.building.release(storey, law.response(0.0).tangent)?;
        self.springs.add(drift, Box::new(law), self.building.unknowns())?;
        Ok(self)
    }

    /// The shear building: unknowns, drifts, masses.
    pub fn building(&self) -> &ShearBuilding {
        &self.building
    }

    /// Horizontal force that what is above `storey`'s columns (or isolators) exerts through them
    /// on what is below, N, positive to the right, from the inertia of the floors above.
    ///
    /// Exact for whatever law, damping and P–Δ are in the storey; with the midpoint rule it is the
    /// mean over the step.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey.
    pub fn shear(&self, storey: usize) -> Result<SectionRows> {
        self.building.floor(storey)?;
        let floors = self.building.storeys().iter().enumerate().skip(storey);
        let acceleration = floors.map(|(index, floor)| (index + 3, -floor.mass)).collect();
        Ok(SectionRows { acceleration, ..SectionRows::default() })
    }
}

impl Structure for NonlinearShearBuilding {
    forward! {
        self.building;
        fn unknowns(&self) -> usize;
        fn contact_nodes(&self) -> Vec<ContactNode>;
        fn foundation_ends(&self) -> Vec<usize>;
        fn mass(&self, matrix: &mut Triplets) -> Result<()>;
        fn stiffness(&self, matrix: &mut Triplets) -> Result<()>;
        fn damping(&self, matrix: &mut Triplets) -> Result<()>;
        fn has_active_damping(&self) -> bool;
        fn describe(&self, unknowns: &[usize]) -> Option<String>;
        fn load(&self, time: f64, load: &mut [f64]) -> Result<()>;
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.springs.nonlinear()
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.springs.nonlinear_mut()
    }
}
