//! Shear buildings with yielding storeys or on isolators.

use super::shear_building::{ShearBuilding, Storey};
use crate::error::{Result, finite, not_negative, positive, require_part};
use crate::structure::Structure;
use crate::structure::hysteresis::Hysteresis;

/// Level of isolators between the basemat and the building's slab.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct IsolationLevel {
    /// Height of the bearings, from the basemat to the slab, m.
    pub height: f64,
    /// Mass of the slab above the bearings, kg per metre of thickness.
    pub slab_mass: f64,
    /// Rotary inertia of the slab about its centre, kg m² per metre of thickness.
    pub slab_inertia: f64,
    /// Viscous dampers parallel to the bearings, N s/m per metre of thickness.
    pub damping: f64,
}

impl ShearBuilding {
    /// Replaces the columns' stiffness of `storey` (0: the lowest) by `law`.
    ///
    /// The deformation of the law is the storey's drift. Stiffness-proportional damping still uses the stiffness in
    /// [`Storey`], also after the columns yield. To exclude it from a yielding storey, do not call
    /// [`with_stiffness_damping`](ShearBuilding::with_stiffness_damping), and set dashpots ([`Storey::damping`]) of
    /// ζ k/(π f₁) in the other storeys.
    ///
    /// ```
    /// use basemat::structure::{Bilinear, ShearBuilding, Storey, Structure};
    ///
    /// let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 3];
    /// let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?
    ///     .with_law(0, Bilinear::new(40.0e6, 150.0e3, 0.05)?)?;
    /// let nonlinear = building.nonlinear().expect("a storey yields");
    /// // 10 mm of drift in the lowest storey, far beyond its 3.75 mm at yield
    /// let mut force = [0.0; 6];
    /// nonlinear.force(&[0.0, 0.0, 0.0, 0.01, 0.01, 0.01], &mut force)?;
    /// assert!((force[3] - (150.0e3 + 2.0e6 * 6.25e-3)).abs() < 1e-6);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey, [`Error::Scene`](crate::Error::Scene) when
    /// it has a law already, [`Error::Input`](crate::Error::Input) when the storey buckles with P–Δ at the law's
    /// initial tangent.
    pub fn with_law(mut self, storey: usize, law: impl Hysteresis + 'static) -> Result<Self> {
        let drift = self.drift(storey)?;
        let is_first = self.law_tangents[storey].replace(law.response(0.0).tangent).is_none();
        require_part("law of a storey", is_first, "one law at most")?;
        self.check_buckling(storey)?;
        let dofs = self.dofs();
        self.springs.add_uniaxial(drift, Box::new(law), dofs)?;
        Ok(self)
    }

    /// Adds isolators that follow `law` under the building.
    ///
    /// The lowest columns then stand on a slab on the isolators. The isolators become storey 0, and the building's
    /// storeys count from 1. Call this before [`with_law`](ShearBuilding::with_law).
    ///
    /// A damping ratio of the building from before this call still applies to its storeys only. The isolators have the
    /// damping of their law and of [`IsolationLevel::damping`], but no stiffness-proportional damping.
    ///
    /// With [`with_p_delta`](ShearBuilding::with_p_delta) the weight W on the isolators exerts the force W θ along the
    /// slope of a rotated base, and, at the drift d, the moment W d on the base. The softening −W/h of columns does not
    /// apply: the law of a slider contains its weight already (W/R of a
    /// [`FrictionPendulum`](crate::structure::FrictionPendulum)), and the stiffness of rubber bearings must be that
    /// under their load.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the level's height and slab mass and the law's initial tangent
    /// are positive and its inertia and damping are not negative; [`Error::Scene`](crate::Error::Scene) when a
    /// storey has a law already.
    pub fn isolated(
        mut self,
        level: IsolationLevel,
        law: impl Hysteresis + 'static,
    ) -> Result<Self> {
        let storey = Storey {
            height: positive("height of the isolators", level.height)?,
            mass: positive("mass of the slab above the isolators", level.slab_mass)?,
            rotary_inertia: not_negative("rotary inertia of the slab", level.slab_inertia)?,
            stiffness: positive("initial stiffness of the isolators", law.response(0.0).tangent)?,
            damping: not_negative("damping of the isolators", level.damping)?,
        };
        let needed = "must be added before the laws of storeys";
        require_part("level of isolators", self.springs.is_empty(), needed)?;
        self.storeys.insert(0, storey);
        self.law_tangents.insert(0, None);
        self.is_isolated = true;
        finite("mass of the building", self.total_mass())?;
        self.with_law(0, law)
    }
}
