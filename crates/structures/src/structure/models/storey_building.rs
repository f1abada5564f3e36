//! Storey building in space on a rigid mat.

use super::rigid_body::RigidBody;
use crate::error::{
    Error, Result, at_least, finite, in_bounds, not_negative, positive, require_part,
};
use crate::structure::hysteresis::{BiaxialSpring, Hysteresis, HystereticSprings};
use crate::structure::{Base, DofCombination, NonlinearForce, Structure, Triplets};

/// Storey of a [`StoreyBuilding`]: columns and walls, and their rigid floor.
///
/// Coordinates are relative to the middle of the mat's base.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PlanStorey {
    /// Height of the columns, m.
    pub height: f64,
    /// Mass of the floor on top, kg.
    pub mass: f64,
    /// Moments of inertia about x, y and z through the floor's centre of mass, kg m².
    pub inertia: [f64; 3],
    /// Centre of mass of the floor, `[x, y]` in m.
    #[cfg_attr(feature = "serde", serde(default))]
    pub mass_center: [f64; 2],
    /// Stiffness along x and y (N/m), and against twist (N m) about the centre of stiffness.
    pub stiffness: [f64; 3],
    /// Centre of stiffness, `[x, y]` in m; a shear force through it does not twist the storey.
    #[cfg_attr(feature = "serde", serde(default))]
    pub stiffness_center: [f64; 2],
    /// Dashpots parallel to the three stiffnesses, N s/m and N m s.
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: [f64; 3],
}

impl PlanStorey {
    /// Storey with a homogeneous rectangular floor above the middle of the mat.
    ///
    /// `height` in m, `mass` of the floor in kg, sides of the floor along x and y in m, `stiffness` as in the field
    /// [`stiffness`](PlanStorey::stiffness). The storey has no eccentricities and no dashpots.
    pub fn new(height: f64, mass: f64, [length, width]: [f64; 2], stiffness: [f64; 3]) -> Self {
        let y_inertia = mass * length * length / 12.0;
        let x_inertia = mass * width * width / 12.0;
        Self {
            height,
            mass,
            inertia: [x_inertia, y_inertia, y_inertia + x_inertia],
            mass_center: [0.0; 2],
            stiffness,
            stiffness_center: [0.0; 2],
            damping: [0.0; 3],
        }
    }
}

/// Rigid floors on flexible columns and walls, on a rigid mat in space.
///
/// Degrees of freedom: `[u_x, u_y, u_z, r_x, r_y, r_z]` of the mat as a [`RigidBody`], then of each floor, from below,
/// the **absolute** `[u_x, u_y, r_z]` of its point above the middle of the mat's base. Columns do not shorten: all
/// floors rise and tilt with the mat. The deformation of a storey is the relative motion of its floors less the part
/// due to the tilt. Along one axis and without eccentricities the building is a
/// [`ShearBuilding`](crate::structure::ShearBuilding).
///
/// [`ModalDamping`](crate::structure::ModalDamping) adds modal damping. Single walls and dampers at any point of a
/// storey are [`WithSprings`](crate::structure::WithSprings) on a [`drift_at`](StoreyBuilding::drift_at).
///
/// ```
/// use basemat::structure::{ModalDamping, PlanStorey, RigidBody, StoreyBuilding};
///
/// let mat = RigidBody::cuboid([18.0, 12.0, 1.0], 2500.0)?;
/// let storey = PlanStorey::new(3.2, 250.0e3, [18.0, 12.0], [4.0e8, 3.0e8, 2.0e10]);
/// // Walls of a staircase move the centre of stiffness to one end.
/// let storey = PlanStorey { stiffness_center: [-4.0, 0.0], ..storey };
/// let building = StoreyBuilding::new(mat, &[storey; 5])?;
/// assert_eq!(building.drift(0)?[1][..], [(7, 1.0), (8, -4.0), (1, -1.0), (5, 4.0), (3, 3.2)]);
/// let damped = ModalDamping::new(&[0.05])?.on_fixed_base(building)?;
/// // Along y and about z, coupled; along x; and so on.
/// assert_eq!(damped.frequencies().len(), 15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Clone)]
pub struct StoreyBuilding {
    mat: RigidBody,
    pub(super) storeys: Vec<PlanStorey>,
    /// Whether a law replaces the stiffness of each storey, in each direction.
    has_law: Vec<[bool; 3]>,
    springs: HystereticSprings,
    /// Acceleration of gravity for P–Δ, m/s²; zero without it.
    gravity: f64,
}

short_debug! { StoreyBuilding; self; storeys: self.storeys, laws: self.springs.len() }

impl StoreyBuilding {
    /// Direction along x of [`StoreyBuilding::with_law`].
    pub const DIRECTION_ALONG: usize = 0;
    /// Direction along y.
    pub const DIRECTION_ACROSS: usize = 1;
    /// Twist about the vertical.
    pub const DIRECTION_TWIST: usize = 2;

    /// Building on a mat, with storeys listed from below.
    ///
    /// The mat determines the position, and has its own P–Δ effect. The columns of the first storey begin at height 0.
    ///
    /// # Errors
    /// [`Error::Size`] without storeys; [`Error::Input`] unless each storey's height, mass, inertia about the vertical
    /// and stiffnesses are positive, other inertias and dashpots not negative, and all numbers finite.
    pub fn new(mat: RigidBody, storeys: &[PlanStorey]) -> Result<Self> {
        at_least("storeys", storeys.len(), 1)?;
        for storey in storeys {
            positive("height of a storey", storey.height)?;
            positive("mass of a floor", storey.mass)?;
            not_negative("moment of inertia of a floor about x", storey.inertia[0])?;
            not_negative("moment of inertia of a floor about y", storey.inertia[1])?;
            positive("moment of inertia of a floor about the vertical", storey.inertia[2])?;
            for k in 0..3 {
                positive("stiffness of a storey", storey.stiffness[k])?;
                not_negative("damping of a storey", storey.damping[k])?;
            }
            for coordinate in storey.mass_center.iter().chain(&storey.stiffness_center) {
                finite("centre of a storey", *coordinate)?;
            }
        }
        let building = Self {
            mat,
            storeys: storeys.to_vec(),
            has_law: vec![[false; 3]; storeys.len()],
            springs: HystereticSprings::default(),
            gravity: 0.0,
        };
        finite("mass of the building", building.total_mass())?;
        Ok(building)
    }

    /// Replaces the stiffness of `storey` (0: the lowest) by `law` in one `direction`.
    ///
    /// Directions: [`DIRECTION_ALONG`](StoreyBuilding::DIRECTION_ALONG),
    /// [`DIRECTION_ACROSS`](StoreyBuilding::DIRECTION_ACROSS) or [`DIRECTION_TWIST`](StoreyBuilding::DIRECTION_TWIST).
    /// The deformation of the law is the storey's [`drift`](StoreyBuilding::drift) in that direction. Laws along x and
    /// y act independently: along the diagonal, two sliders have √2 times the friction of one. For bearings that slide
    /// or yield in any direction use [`with_biaxial_law`](StoreyBuilding::with_biaxial_law).
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such storey or direction, [`Error::Scene`] when it has a law already.
    pub fn with_law(
        mut self,
        storey: usize,
        direction: usize,
        law: impl Hysteresis + 'static,
    ) -> Result<Self> {
        let fault = Error::Index { quantity: "direction of a storey", index: direction, bound: 3 };
        let row = self.drift(storey)?.into_iter().nth(direction).ok_or(fault)?;
        self.replace_stiffness(storey, direction)?;
        let dofs = self.dofs();
        self.springs.add_uniaxial(row, Box::new(law), dofs)?;
        Ok(self)
    }

    /// Replaces the stiffness of `storey` (0: the lowest) along x and y by one `law`.
    ///
    /// Its deformations are the first two [`drift`](StoreyBuilding::drift)s of the storey.
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such storey, [`Error::Scene`] when it has a law along x or y already.
    pub fn with_biaxial_law(mut self, storey: usize, law: BiaxialSpring) -> Result<Self> {
        let drift = self.drift(storey)?;
        self.replace_stiffness(storey, Self::DIRECTION_ALONG)?;
        self.replace_stiffness(storey, Self::DIRECTION_ACROSS)?;
        let dofs = self.dofs();
        let horizontal = [Self::DIRECTION_ALONG, Self::DIRECTION_ACROSS]
            .map(|direction| drift[direction].clone());
        self.springs.add_biaxial(horizontal, law, dofs)?;
        Ok(self)
    }

    /// Marks the stiffness of a storey as replaced by a law.
    fn replace_stiffness(&mut self, storey: usize, direction: usize) -> Result<()> {
        let is_first = !std::mem::replace(&mut self.has_law[storey][direction], true);
        require_part("law of a storey", is_first, "one law at most")
    }

    /// Adds the P–Δ effect of the floors' weight.
    ///
    /// Columns do not shorten, so an inclination lowers the weight of each floor above by δ²/(2 h), where δ is the
    /// relative displacement of a storey's ends at the floor's mass centre. Columns that buckle cause an error when a
    /// simulation is built.
    ///
    /// # Errors
    /// [`Error::Input`] unless `gravity` (m/s²) is finite and not negative.
    pub fn with_p_delta(self, gravity: f64) -> Result<Self> {
        Ok(Self { gravity: not_negative("acceleration of gravity", gravity)?, ..self })
    }

    /// Heights of the storeys, m.
    #[doc(hidden)]
    pub fn heights(&self) -> impl Iterator<Item = f64> {
        self.storeys.iter().map(|storey| storey.height)
    }

    /// Middle of the mat's base, m.
    #[doc(hidden)]
    pub fn center(&self) -> [f64; 2] {
        self.mat.center()
    }

    /// Mass of mat and floors, kg.
    pub fn total_mass(&self) -> f64 {
        self.mat.total_mass() + self.storeys.iter().map(|storey| storey.mass).sum::<f64>()
    }

    /// Displacements along x and y, and twist, of the floor on top of `storey`.
    ///
    /// Weighted sums of degrees of freedom. `place`: m from the middle of the mat's base.
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such storey.
    pub fn floor(&self, storey: usize, place: [f64; 2]) -> Result<[DofCombination; 3]> {
        Ok(level_motion(in_bounds("storey", storey, self.storeys.len())? + 1, place))
    }

    /// Drifts along x and y, and twist, of `storey` (0: the lowest) at its centre of stiffness.
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such storey.
    pub fn drift(&self, storey: usize) -> Result<[DofCombination; 3]> {
        let center = self.storeys.get(storey).map_or([0.0; 2], |storey| storey.stiffness_center);
        self.drift_at(storey, center)
    }

    /// Deformation of `storey` at `place`: drifts along x and y, and twist.
    ///
    /// `place`: m from the middle of the mat's base.
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such storey.
    pub fn drift_at(&self, storey: usize, place: [f64; 2]) -> Result<[DofCombination; 3]> {
        self.floor(storey, place)?;
        Ok(self.deformation([storey, storey + 1], place))
    }

    /// Displacements of the floor on `storey` minus the mat's rigid motion.
    ///
    /// Along x, along y, and twist, at `place` (m from the middle of the mat's base): the sum of the drifts below.
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such storey.
    pub fn total_drift(&self, storey: usize, place: [f64; 2]) -> Result<[DofCombination; 3]> {
        self.floor(storey, place)?;
        Ok(self.deformation([0, storey + 1], place))
    }

    /// Relative displacement of two `levels`, less the part due to the mat's rotation.
    fn deformation(&self, levels: [usize; 2], place: [f64; 2]) -> [DofCombination; 3] {
        let storeys = &self.storeys[levels[0]..levels[1]];
        let height: f64 = storeys.iter().map(|storey| storey.height).sum();
        let mut deformation = relative_displacement(levels, place);
        deformation[Self::DIRECTION_ALONG] -= DofCombination::from((MAT_ROTATION_Y, height));
        deformation[Self::DIRECTION_ACROSS] += DofCombination::from((MAT_ROTATION_X, height));
        deformation
    }

    /// Displacements of the mass centre of the floor on `storey`, and its rotations.
    pub(super) fn floor_motion(&self, storey: usize) -> [DofCombination; 6] {
        let place = self.storeys[storey].mass_center;
        let [x_row, y_row, twist] = level_motion(storey + 1, place);
        let [.., vertical] = self.mat.displacement_at([place[0], place[1], 0.0]);
        [x_row, y_row, vertical, MAT_ROTATION_X.into(), MAT_ROTATION_Y.into(), twist]
    }

    /// Adds lᵀ l of each storey's deformations l, times their factors, to `matrix`.
    fn add_drifts(&self, matrix: &mut Triplets, factor: impl Fn(usize) -> [f64; 3]) -> Result<()> {
        for storey in 0..self.storeys.len() {
            for (row, row_factor) in self.drift(storey)?.iter().zip(factor(storey)) {
                matrix.add_outer(row, row_factor);
            }
        }
        Ok(())
    }

    /// Adds the geometric stiffness of the floors' weight.
    fn add_p_delta(&self, matrix: &mut Triplets) {
        for (index, storey) in self.storeys.iter().enumerate().filter(|_| self.gravity > 0.0) {
            for floor in &self.storeys[index..] {
                let softening = -self.gravity / storey.height;
                let inertias = [floor.mass, floor.mass, floor.inertia[2]];
                let rows = relative_displacement([index, index + 1], floor.mass_center);
                for (row, inertia) in rows.into_iter().zip(inertias) {
                    matrix.add_outer(row, softening * inertia);
                }
            }
        }
    }
}

/// Degree of freedom of the mat: rotation about x.
const MAT_ROTATION_X: usize = 3;
/// Degree of freedom of the mat: rotation about y.
const MAT_ROTATION_Y: usize = 4;

/// Displacements along x and y, and twist, of a level (0: the mat's base) at a point, m.
fn level_motion(level: usize, [x, y]: [f64; 2]) -> [DofCombination; 3] {
    // The six degrees of freedom of the mat come first, then three of each floor.
    let first_dof = 3 * level + 3;
    let [x_dof, y_dof, twist] =
        if level == 0 { [0, 1, 5] } else { [first_dof, first_dof + 1, first_dof + 2] };
    [translation_row(x_dof, twist, -y), translation_row(y_dof, twist, x), twist.into()]
}

/// Displacement due to the translation `dof` and the rotation `twist` at a lever arm, m.
fn translation_row(dof: usize, twist: usize, lever_arm: f64) -> DofCombination {
    let twist_term = Some((twist, lever_arm)).filter(|_| lever_arm != 0.0);
    std::iter::once((dof, 1.0)).chain(twist_term).collect()
}

/// Displacement of an upper level relative to a lower one, with the mat's tilt.
fn relative_displacement(
    [lower_level, upper_level]: [usize; 2],
    place: [f64; 2],
) -> [DofCombination; 3] {
    let mut lower_rows = level_motion(lower_level, place).into_iter();
    level_motion(upper_level, place)
        .map(|upper_row| upper_row - lower_rows.next().unwrap_or_default())
}

impl Structure for StoreyBuilding {
    fn dofs(&self) -> usize {
        6 + 3 * self.storeys.len()
    }

    fn base(&self) -> Base {
        self.mat.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.mat.mass(matrix)?;
        for (index, floor) in self.storeys.iter().enumerate() {
            let inertias = [floor.mass; 3].into_iter().chain(floor.inertia);
            for (row, inertia) in self.floor_motion(index).iter().zip(inertias) {
                matrix.add_outer(row, inertia);
            }
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.mat.stiffness(matrix)?;
        self.add_drifts(matrix, |storey| {
            let stiffness = self.storeys[storey].stiffness;
            [0, 1, 2].map(|k| if self.has_law[storey][k] { 0.0 } else { stiffness[k] })
        })?;
        self.add_p_delta(matrix);
        Ok(())
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.mat.geometric_stiffness(matrix)?;
        self.add_p_delta(matrix);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_drifts(matrix, |storey| self.storeys[storey].damping)
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.springs.nonlinear()
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.springs.nonlinear_mut()
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        const FLOOR_DOF_NAMES: [&str; 3] = ["u_x", "u_y", "r_z"];
        let mut names = Vec::with_capacity(dofs.len());
        for &dof in dofs {
            if dof >= self.dofs() {
                return None;
            }
            names.push(match dof.checked_sub(6) {
                None => self.mat.describe(&[dof])?,
                Some(floor_dof) => {
                    format!("{} of floor {}", FLOOR_DOF_NAMES[floor_dof % 3], floor_dof / 3)
                }
            });
        }
        Some(names.join(", "))
    }
}

former_constants! {
    StoreyBuilding {
        ALONG: usize = DIRECTION_ALONG, "use `DIRECTION_ALONG`";
        ACROSS: usize = DIRECTION_ACROSS, "use `DIRECTION_ACROSS`";
        TWIST: usize = DIRECTION_TWIST, "use `DIRECTION_TWIST`";
    }
}
