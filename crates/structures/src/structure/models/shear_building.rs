//! Shear building on a rigid base.

use crate::error::{Result, at_least, finite, in_bounds, not_negative, positive, require};
use crate::structure::hysteresis::HystereticSprings;
use crate::structure::{
    Base, BaseNode, DofCombination, NonlinearForce, SectionRows, Structure, Triplets,
};

/// Storey of a [`ShearBuilding`]: columns and their floor, per metre of thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Storey {
    /// Height of the columns, m.
    pub height: f64,
    /// Mass of the floor on top, kg.
    pub mass: f64,
    /// Rotary inertia of the floor about its centre, kg m².
    #[cfg_attr(feature = "serde", serde(default))]
    pub rotary_inertia: f64,
    /// Lateral stiffness of the columns, N/m.
    pub stiffness: f64,
    /// Dashpot between the floors, N s/m.
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f64,
}

impl Storey {
    /// Storey without rotary inertia and damping.
    pub fn new(height: f64, mass: f64, stiffness: f64) -> Self {
        Self { height, mass, rotary_inertia: 0.0, stiffness, damping: 0.0 }
    }
}

/// Shear building: rigid floors on flexible columns on a rigid base.
///
/// Degrees of freedom: `[u_x, u_y, θ]` of the base, then the **absolute** horizontal displacement of each floor, from
/// below. The columns do not shorten, so all floors rise and rotate with the base. A storey's drift is the relative
/// displacement of its floors less the part due to the rotation, `d_j = u_j − u_(j−1) + h_j θ`.
///
/// Storeys may follow a [`Hysteresis`](crate::structure::Hysteresis) law ([`with_law`](ShearBuilding::with_law)), and
/// the building may stand on isolators ([`isolated`](ShearBuilding::isolated)).
///
/// ```
/// use basemat::structure::{ShearBuilding, Storey, Structure};
///
/// let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
/// let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?.with_stiffness_damping(0.05)?;
/// assert_eq!(building.dofs(), 8);
/// // 2 √(k/m) sin(π/22) rad/s on a fixed base
/// assert!((building.fixed_base_frequency() - 2.02589).abs() < 1e-5);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Clone)]
pub struct ShearBuilding {
    width: f64,
    base_mass: f64,
    base_inertia: f64,
    pub(super) storeys: Vec<Storey>,
    /// Initial tangent of the law that replaces a storey's stiffness, N/m.
    ///
    /// `None` without a law.
    pub(super) law_tangents: Vec<Option<f64>>,
    /// The laws, as springs whose deformations are the drifts of their storeys.
    pub(super) springs: HystereticSprings,
    /// Whether storey 0 is a level of isolators, with the P–Δ effect of [`ShearBuilding::add_p_delta`].
    pub(super) is_isolated: bool,
    /// Middle of the base on the surface, m.
    center: f64,
    /// Factor β of stiffness-proportional damping, s.
    pub(super) stiffness_damping: f64,
    /// Acceleration of gravity for P–Δ, m/s²; zero without it.
    gravity: f64,
}

short_debug! { ShearBuilding; self; storeys: self.storeys, laws: self.springs.len() }

impl ShearBuilding {
    // Degrees of freedom of the base. Those of the floors follow from `FIRST_FLOOR_DOF` on.
    const BASE_HORIZONTAL_DOF: usize = 0;
    const BASE_VERTICAL_DOF: usize = 1;
    const BASE_ROTATION_DOF: usize = 2;
    const FIRST_FLOOR_DOF: usize = 3;

    /// Building on a rigid base, with storeys listed from below.
    ///
    /// The base has `width` (m), mass (kg/m) and rotary inertia about the middle of its underside (kg m²/m). The
    /// columns of the first storey stand at height 0.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) without storeys; [`Error::Input`](crate::Error::Input) unless width, base
    /// mass and each storey's height, mass and stiffness are positive and inertias and dashpots not negative, or when
    /// base and floors have no rotary inertia.
    pub fn new(width: f64, base_mass: f64, base_inertia: f64, storeys: &[Storey]) -> Result<Self> {
        positive("width of the base", width)?;
        positive("mass of the base", base_mass)?;
        not_negative("rotary inertia of the base", base_inertia)?;
        at_least("storeys", storeys.len(), 1)?;
        for storey in storeys {
            positive("height of a storey", storey.height)?;
            positive("mass of a floor", storey.mass)?;
            not_negative("rotary inertia of a floor", storey.rotary_inertia)?;
            positive("stiffness of a storey", storey.stiffness)?;
            not_negative("damping of a storey", storey.damping)?;
        }
        let building = Self {
            width,
            base_mass,
            base_inertia,
            storeys: storeys.to_vec(),
            law_tangents: vec![None; storeys.len()],
            springs: HystereticSprings::default(),
            is_isolated: false,
            center: 0.0,
            stiffness_damping: 0.0,
            gravity: 0.0,
        };
        finite("mass of the building", building.total_mass())?;
        let inertias = storeys.iter().map(|storey| storey.mass * storey.height.powi(2));
        finite("rotary inertia of the building, by masses and heights", inertias.sum())?;
        let stiffnesses = storeys.iter().map(|storey| storey.stiffness * storey.height.powi(2));
        finite("stiffness in rotation, by storeys and heights", stiffnesses.sum())?;
        positive("rotary inertia of base and floors", building.rotary_inertia())?;
        Ok(building)
    }

    /// Moves the middle of the base to `center` (m) on the surface.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite.
    pub fn centered_at(self, center: f64) -> Result<Self> {
        Ok(Self { center: finite("middle of the base", center)?, ..self })
    }

    /// Adds the P–Δ effect of the floors' weight.
    ///
    /// Columns do not shorten, so an inclination of the columns lowers the weight above by `(u_j − u_(j−1))²/(2 h_j)`.
    /// This reduces the stiffness of a storey under the weight W by W/h.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `gravity` (m/s²) is finite and not negative, and the height of
    /// every storey is above W/k, at which its columns buckle. k is the storey's stiffness, or the initial tangent of
    /// its law.
    pub fn with_p_delta(self, gravity: f64) -> Result<Self> {
        let building = Self { gravity: not_negative("acceleration of gravity", gravity)?, ..self };
        (0..building.storeys.len()).try_for_each(|storey| building.check_buckling(storey))?;
        Ok(building)
    }

    /// The storeys, from below.
    #[doc(hidden)]
    pub fn storeys(&self) -> &[Storey] {
        &self.storeys
    }

    /// Mass of base and floors, kg per metre of thickness.
    pub fn total_mass(&self) -> f64 {
        self.base_mass + self.storeys.iter().map(|storey| storey.mass).sum::<f64>()
    }

    /// Index of the horizontal displacement of the floor on top of `storey`.
    ///
    /// Storeys count from 0, the lowest.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey.
    pub fn floor(&self, storey: usize) -> Result<usize> {
        Ok(in_bounds("storey", storey, self.storeys.len())? + Self::FIRST_FLOOR_DOF)
    }

    /// Index of the horizontal displacement of the highest floor.
    pub fn roof(&self) -> usize {
        Self::FIRST_FLOOR_DOF + self.storeys.len() - 1
    }

    /// Drift of `storey` (0: the lowest): `u_j − u_(j−1) + h_j θ`.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey.
    pub fn drift(&self, storey: usize) -> Result<DofCombination> {
        self.floor(storey)?;
        Ok(self.drift_terms(storey).into())
    }

    /// Displacement of the floor on `storey` minus the base's rigid motion there.
    ///
    /// It is `u_j − u_x + H_j θ` with the height `H_j` of the floor, the sum of the drifts of all storeys up to this
    /// one. Storeys count from 0.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey.
    pub fn total_drift(&self, storey: usize) -> Result<DofCombination> {
        let floor = self.floor(storey)?;
        let height = self.storeys[..=storey].iter().map(|storey| storey.height).sum();
        Ok([(floor, 1.0), (Self::BASE_HORIZONTAL_DOF, -1.0), (Self::BASE_ROTATION_DOF, height)]
            .into())
    }

    /// Horizontal force of the floor on top of `storey` on the part below, N.
    ///
    /// It is the force of the columns or isolators, positive to the right; for storey 0 it is the base shear. With P–Δ
    /// it is the horizontal part of the columns' force, including −P/h times the floors' relative displacement. The
    /// force of a law is not a weighted sum of displacements. For a storey with a law, the force is therefore computed
    /// from the inertia of the floors above, which is exact for any law; with the midpoint rule it is then the mean
    /// over the step.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey.
    pub fn shear(&self, storey: usize) -> Result<SectionRows> {
        self.floor(storey)?;
        if self.law_tangents[storey].is_some() {
            let floors = self.storeys.iter().enumerate().skip(storey);
            let acceleration =
                floors.map(|(index, floor)| (Self::FIRST_FLOOR_DOF + index, -floor.mass)).collect();
            return Ok(SectionRows { acceleration, ..SectionRows::default() });
        }
        let Storey { height, stiffness, .. } = self.storeys[storey];
        let scaled_drift =
            |factor: f64| self.drift_terms(storey).map(|(dof, weight)| (dof, factor * weight));
        let mut displacement = scaled_drift(stiffness);
        if self.gravity > 0.0 {
            let weight_stiffness = self.weight_on(storey) / height;
            // The first two entries of a drift are the floors' relative displacement.
            for (drift_term, displacement_term) in
                displacement.iter_mut().zip(Self::relative_displacement_row(storey))
            {
                drift_term.1 -= weight_stiffness * displacement_term.1;
            }
        }
        let velocity = scaled_drift(self.damping_coefficient(storey)).into();
        Ok(SectionRows { displacement: displacement.into(), velocity, ..SectionRows::default() })
    }

    /// Relative displacement `u_j − u_(j−1)`, which includes the part due to the base's rotation.
    fn relative_displacement_row(storey: usize) -> [(usize, f64); 2] {
        let lower_dof = if storey == 0 {
            Self::BASE_HORIZONTAL_DOF
        } else {
            Self::FIRST_FLOOR_DOF + storey - 1
        };
        [(Self::FIRST_FLOOR_DOF + storey, 1.0), (lower_dof, -1.0)]
    }

    /// Terms of the drift of a storey that exists.
    fn drift_terms(&self, storey: usize) -> [(usize, f64); 3] {
        let relative_displacement = Self::relative_displacement_row(storey);
        [
            relative_displacement[0],
            relative_displacement[1],
            (Self::BASE_ROTATION_DOF, self.storeys[storey].height),
        ]
    }

    /// Weight that the columns of `storey` carry, N.
    fn weight_on(&self, storey: usize) -> f64 {
        self.gravity * self.storeys[storey..].iter().map(|storey| storey.mass).sum::<f64>()
    }

    /// Returns an error if the columns of a storey buckle under the weight above.
    ///
    /// On a fixed base the stiffness is a chain of storeys, positive definite if every k − W/h is positive.
    pub(super) fn check_buckling(&self, storey: usize) -> Result<()> {
        let Storey { height, stiffness, .. } = self.storeys[storey];
        let initial_stiffness = self.law_tangents[storey].unwrap_or(stiffness);
        let is_stable = self.gravity == 0.0
            || self.is_isolated && storey == 0
            || initial_stiffness * height > self.weight_on(storey);
        let needed = "above W/k, the weight on the storey over its stiffness: its columns buckle";
        require("height of a storey with P–Δ", height, is_stable, needed).map(drop)
    }

    /// Adds the geometric stiffness of the weight.
    ///
    /// Columns lower the weight by half the square of the floors' relative displacement, divided by their height.
    /// Isolators do not: a slider moves along the plane of the rotated base, which lifts the weight W by d θ − h θ²/2
    /// for a drift d at the height h. The term in d² is part of the law: W/R, or the stiffness of rubber under its
    /// load.
    fn add_p_delta(&self, matrix: &mut Triplets) {
        for (index, storey) in self.storeys.iter().enumerate().filter(|_| self.gravity > 0.0) {
            let weight = self.weight_on(index);
            if self.is_isolated && index == 0 {
                for (dof, sign) in Self::relative_displacement_row(0) {
                    matrix.add(dof, Self::BASE_ROTATION_DOF, sign * weight);
                    matrix.add(Self::BASE_ROTATION_DOF, dof, sign * weight);
                }
                // d = u_1 − u_0 + h θ, so that d θ contains a further h θ².
                matrix.add(
                    Self::BASE_ROTATION_DOF,
                    Self::BASE_ROTATION_DOF,
                    weight * storey.height,
                );
            } else {
                matrix.add_outer(Self::relative_displacement_row(index), -weight / storey.height);
            }
        }
    }

    /// Rotary inertia of base and floors, kg m² per metre.
    fn rotary_inertia(&self) -> f64 {
        self.base_inertia + self.storeys.iter().map(|storey| storey.rotary_inertia).sum::<f64>()
    }

    /// Damping coefficient of a storey, N s/m: its dashpot and the stiffness-proportional damping of its columns.
    ///
    /// The latter uses the stiffness in [`Storey`], even if a law replaces this stiffness. Isolators have none.
    fn damping_coefficient(&self, storey: usize) -> f64 {
        let Storey { stiffness, damping, .. } = self.storeys[storey];
        let is_isolator = self.is_isolated && storey == 0;
        damping + if is_isolator { 0.0 } else { self.stiffness_damping * stiffness }
    }

    /// Adds `factor(storey)` times lᵀ l of each storey's drift l to `matrix`.
    fn add_drifts(&self, matrix: &mut Triplets, factor: impl Fn(usize) -> f64) {
        for storey in 0..self.storeys.len() {
            matrix.add_outer(self.drift_terms(storey), factor(storey));
        }
    }
}

impl Structure for ShearBuilding {
    fn dofs(&self) -> usize {
        Self::FIRST_FLOOR_DOF + self.storeys.len()
    }

    fn base(&self) -> Base {
        let left = self.center - 0.5 * self.width;
        let right = self.center + 0.5 * self.width;
        let dofs = [Self::BASE_HORIZONTAL_DOF, Self::BASE_VERTICAL_DOF, Self::BASE_ROTATION_DOF];
        BaseNode::rigid_base(left, right, dofs).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        matrix.add(Self::BASE_HORIZONTAL_DOF, Self::BASE_HORIZONTAL_DOF, self.base_mass);
        matrix.add(Self::BASE_VERTICAL_DOF, Self::BASE_VERTICAL_DOF, self.total_mass());
        matrix.add(Self::BASE_ROTATION_DOF, Self::BASE_ROTATION_DOF, self.rotary_inertia());
        for (index, storey) in self.storeys.iter().enumerate() {
            let dof = Self::FIRST_FLOOR_DOF + index;
            matrix.add(dof, dof, storey.mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_drifts(matrix, |storey| {
            if self.law_tangents[storey].is_some() {
                0.0
            } else {
                self.storeys[storey].stiffness
            }
        });
        self.geometric_stiffness(matrix)
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_p_delta(matrix);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_drifts(matrix, |storey| self.damping_coefficient(storey));
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.springs.nonlinear()
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.springs.nonlinear_mut()
    }
}
