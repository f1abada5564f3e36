//! The rigid block on its flat base.

use crate::error::{Result, finite, not_negative, positive};
use crate::structure::{Base, BaseNode, DofCombination, Structure, Triplets};

/// Rigid body on a flat base in the plane.
///
/// Its degrees of freedom are `[u_x, u_y, θ]` of the base's middle. A point at height z above the base, x to the right
/// of its middle, moves by `u_x − z θ` and `u_y + x θ` (small rotations). The centre of gravity lies above the middle
/// of the base.
///
/// ```
/// use basemat::structure::{RigidBlock, Structure, Triplets};
///
/// let block = RigidBlock::new(4.0, 10.0, 2000.0)?;
/// assert_eq!(block.total_mass(), 80_000.0);
/// let mut mass = Triplets::new(3);
/// block.mass(&mut mass)?;
/// // the centre of gravity, 5 m up, moves by u_x − 5 θ
/// assert!(mass.entries().contains(&(0, 2, -400_000.0)));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RigidBlock {
    width: f64,
    mass: f64,
    /// Rotary inertia about the centre of gravity, kg m² per metre of thickness.
    rotary_inertia: f64,
    /// Height of the centre of gravity above the base, m.
    center_height: f64,
    /// Middle of the base on the surface, m.
    center: f64,
    /// Acceleration of gravity for P–Δ, m/s²; zero without it.
    gravity: f64,
    /// Overturning moment of carried weights per rotation, N m/m.
    carried_moment: f64,
}

impl RigidBlock {
    /// Index of the horizontal displacement of the base's middle.
    pub const HORIZONTAL_DOF: usize = 0;
    /// Index of the vertical displacement of the base's middle.
    pub const VERTICAL_DOF: usize = 1;
    /// Index of the rotation.
    pub const ROTATION_DOF: usize = 2;

    /// Homogeneous rectangle: width and height (m), density (kg/m³).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive.
    pub fn new(width: f64, height: f64, density: f64) -> Result<Self> {
        positive("width of the block", width)?;
        positive("height of the block", height)?;
        positive("density of the block", density)?;
        let mass =
            positive("mass of the block, by its size and density", width * height * density)?;
        let rotary_inertia = mass * (width * width + height * height) / 12.0;
        positive("rotary inertia of the block, by its size and density", rotary_inertia)?;
        Self::from_mass(width, mass, rotary_inertia, 0.5 * height)
    }

    /// Any rigid body in the plane, from its base width, mass and inertia.
    ///
    /// `width` of the base: m. `mass`: kg/m. `rotary_inertia` about the centre of gravity: kg m²/m.
    /// `center_height`: height of the centre of gravity above the base, m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless width, mass and inertia are positive and the
    /// height is not negative.
    pub fn from_mass(
        width: f64,
        mass: f64,
        rotary_inertia: f64,
        center_height: f64,
    ) -> Result<Self> {
        positive("width of the block", width)?;
        positive("mass of the block", mass)?;
        positive("rotary inertia of the block", rotary_inertia)?;
        not_negative("height of the centre of gravity", center_height)?;
        finite("rotary inertia about the base", rotary_inertia + mass * center_height.powi(2))?;
        Ok(Self {
            width,
            mass,
            rotary_inertia,
            center_height,
            center: 0.0,
            gravity: 0.0,
            carried_moment: 0.0,
        })
    }

    /// Moves the middle of the base from 0 to `center` (m) on the surface.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite.
    pub fn centered_at(self, center: f64) -> Result<Self> {
        Ok(Self { center: finite("middle of the base", center)?, ..self })
    }

    /// Adds the P–Δ effect of the block's weight: `−m g h_c θ²/2` in the potential energy.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `gravity` (m/s²) is finite and not negative.
    pub fn with_p_delta(self, gravity: f64) -> Result<Self> {
        Ok(Self { gravity: not_negative("acceleration of gravity", gravity)?, ..self })
    }

    /// Adds the P–Δ effect of a carried weight.
    ///
    /// The effect is `−weight · height · θ²/2` in the potential energy.
    ///
    /// `weight`: N/m, of what stands on the block at `height` (m) above its base, such as its part of a cap. The
    /// weight itself acts by a load or a joint.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are finite and not negative.
    pub fn with_carried_weight(self, weight: f64, height: f64) -> Result<Self> {
        not_negative("carried weight", weight)?;
        not_negative("height of a carried weight", height)?;
        let carried_moment =
            finite("moment of carried weights", self.carried_moment + weight * height)?;
        Ok(Self { carried_moment, ..self })
    }

    /// Points of the block as contact nodes, for a joint with another structure.
    ///
    /// Each point has its coordinate on the surface and its height above the base, m.
    ///
    /// ```
    /// use basemat::structure::RigidBlock;
    ///
    /// let block = RigidBlock::new(4.0, 10.0, 2000.0)?.centered_at(1.0)?;
    /// let top = block.contact_nodes(&[[-1.0, 10.0], [3.0, 10.0]])?;
    /// assert_eq!(top[0].horizontal[..], [(0, 1.0), (2, -10.0)]);
    /// assert_eq!(top[0].vertical[..], [(1, 1.0), (2, -2.0)]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for coordinates that are not finite.
    pub fn contact_nodes(&self, points: &[[f64; 2]]) -> Result<Vec<BaseNode>> {
        let mut nodes = Vec::with_capacity(points.len());
        for &[x, z] in points {
            nodes.push(BaseNode {
                x: finite("coordinate of a contact node", x)?,
                z: finite("coordinate of a contact node", z)?,
                horizontal: self.horizontal_at(z),
                vertical: self.vertical_at(x),
                ..BaseNode::default()
            });
        }
        Ok(nodes)
    }

    /// Mass m, kg per metre of thickness.
    pub fn total_mass(&self) -> f64 {
        self.mass
    }

    /// Rotary inertia about the middle of the base, kg m² per metre of thickness.
    pub fn base_inertia(&self) -> f64 {
        self.rotary_inertia + self.mass * self.center_height.powi(2)
    }

    /// Horizontal displacement at `height` (m) above the base, as a weighted sum of degrees of freedom.
    pub fn horizontal_at(&self, height: f64) -> DofCombination {
        [(Self::HORIZONTAL_DOF, 1.0), (Self::ROTATION_DOF, -height)].into()
    }

    /// Vertical displacement at coordinate `x` (m) of the surface, as a weighted sum of degrees of freedom.
    pub fn vertical_at(&self, x: f64) -> DofCombination {
        [(Self::VERTICAL_DOF, 1.0), (Self::ROTATION_DOF, x - self.center)].into()
    }
}

impl Structure for RigidBlock {
    fn dofs(&self) -> usize {
        3
    }

    fn base(&self) -> Base {
        let left_end = self.center - 0.5 * self.width;
        let right_end = self.center + 0.5 * self.width;
        BaseNode::rigid_base(
            left_end,
            right_end,
            [Self::HORIZONTAL_DOF, Self::VERTICAL_DOF, Self::ROTATION_DOF],
        )
        .into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        let coupling = -self.mass * self.center_height;
        matrix.add(Self::HORIZONTAL_DOF, Self::HORIZONTAL_DOF, self.mass);
        matrix.add(Self::VERTICAL_DOF, Self::VERTICAL_DOF, self.mass);
        matrix.add(Self::ROTATION_DOF, Self::ROTATION_DOF, self.base_inertia());
        matrix.add(Self::HORIZONTAL_DOF, Self::ROTATION_DOF, coupling);
        matrix.add(Self::ROTATION_DOF, Self::HORIZONTAL_DOF, coupling);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.geometric_stiffness(matrix)
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        if self.gravity > 0.0 || self.carried_moment > 0.0 {
            let overturning = self.mass * self.gravity * self.center_height + self.carried_moment;
            matrix.add(Self::ROTATION_DOF, Self::ROTATION_DOF, -overturning);
        }
        Ok(())
    }
}

former_constants! {
    RigidBlock {
        HORIZONTAL: usize = HORIZONTAL_DOF, "use `HORIZONTAL_DOF`";
        VERTICAL: usize = VERTICAL_DOF, "use `VERTICAL_DOF`";
        ROTATION: usize = ROTATION_DOF, "use `ROTATION_DOF`";
    }
}
