//! Structures without a mesh: the rigid block on its flat base, and given matrices.

use crate::error::{Result, at_least, finite, not_negative, positive, same_length};
use crate::linalg::SparseMatrix;
use crate::structure::detached::{check_damping, check_mass};
use crate::structure::{
    ContactNode, DofCombination, FaceNode, RayleighDamping, Structure, Triplets, base_nodes,
    check_base_nodes,
};

/// Rigid body with a flat base: degrees of freedom `[u_x, u_y, θ]` at the middle of the base.
///
/// A point at height z above the base and x beside its middle moves by `u_x − z θ` and `u_y + x θ`
/// (small rotations). The centre of gravity lies above the middle of the base.
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
    rotary_inertia: f64,
    center_height: f64,
    center: f64,
    gravity: f64,
}

impl RigidBlock {
    /// Index of the horizontal displacement of the base's middle.
    pub const HORIZONTAL: usize = 0;
    /// Index of the vertical displacement of the base's middle.
    pub const VERTICAL: usize = 1;
    /// Index of the rotation.
    pub const ROTATION: usize = 2;

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

    /// Any rigid body: width of the base (m), mass (kg/m), rotary inertia about the centre of
    /// gravity (kg m²/m) and height of the centre of gravity above the base (m).
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
        Ok(Self { width, mass, rotary_inertia, center_height, center: 0.0, gravity: 0.0 })
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
        [(Self::HORIZONTAL, 1.0), (Self::ROTATION, -height)].into()
    }

    /// Vertical displacement at coordinate `x` (m) of the surface, as a weighted sum of degrees of freedom.
    pub fn vertical_at(&self, x: f64) -> DofCombination {
        [(Self::VERTICAL, 1.0), (Self::ROTATION, x - self.center)].into()
    }
}

impl Structure for RigidBlock {
    fn dofs(&self) -> usize {
        3
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        let (left, right) = (self.center - 0.5 * self.width, self.center + 0.5 * self.width);
        ContactNode::rigid_base(left, right, [Self::HORIZONTAL, Self::VERTICAL, Self::ROTATION])
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        let coupling = -self.mass * self.center_height;
        matrix.add(Self::HORIZONTAL, Self::HORIZONTAL, self.mass);
        matrix.add(Self::VERTICAL, Self::VERTICAL, self.mass);
        matrix.add(Self::ROTATION, Self::ROTATION, self.base_inertia());
        matrix.add(Self::HORIZONTAL, Self::ROTATION, coupling);
        matrix.add(Self::ROTATION, Self::HORIZONTAL, coupling);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        if self.gravity > 0.0 {
            let overturning = self.mass * self.gravity * self.center_height;
            matrix.add(Self::ROTATION, Self::ROTATION, -overturning);
        }
        Ok(())
    }
}

// Structure given by its matrices.

const DAMPING: &str = "damping matrix";

/// A structure given by mass, damping and stiffness matrices, from another program for example.
///
/// The degrees of freedom are absolute displacements in m and rotations in rad, in any order; the structure is
/// **free**, without supports: the ground holds it up, so a rigid translation must give no elastic force beyond
/// rounding (entries of ten digits may leave too much, those of twelve do not). Matrices are per metre of thickness,
/// but for a structure [`in_plan`](MatrixModel::in_plan). They may come from Matrix Market files
/// (`Triplets::read_matrix_market`, feature `io`), dense arrays ([`Triplets::from_dense`]) or compressed rows
/// ([`Triplets::from_csr`]); large models march faster after a [`CraigBampton`](crate::structure::CraigBampton)
/// reduction.
///
/// The mass matrix must be positive semi-definite up to rounding (see [`Structure::mass`]), which is
/// checked here; a symmetric stiffness matrix must be so where the base is held, Lagrange
/// multipliers excepted (see [`Structure::stiffness`]), which is checked when a simulation is built.
///
/// ```
/// use basemat::structure::{ContactNode, MatrixModel, Structure, Triplets};
///
/// // A rigid base [u_x, u_y, θ] with a mass on a spring, 5 m up.
/// let masses = [2.0e4, 3.0e4, 6.0e4, 1.0e4];
/// let mass = Triplets::from_entries(4, masses.into_iter().enumerate().map(|(k, m)| (k, k, m)));
/// let mut stiffness = Triplets::new(4);
/// stiffness.add_outer([(3, 1.0), (0, -1.0), (2, 5.0)], 4.0e6);
/// let contact = ContactNode::rigid_base(-3.0, 3.0, [0, 1, 2]);
/// let model = MatrixModel::new(mass, stiffness, contact)?;
/// assert_eq!(model.dofs(), 4);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixModel {
    mass: Triplets,
    damping: Triplets,
    stiffness: Triplets,
    contact: Vec<ContactNode>,
    faces: Vec<Vec<FaceNode>>,
    /// Whether the damping may feed energy in, and is not checked.
    active: bool,
}

impl MatrixModel {
    /// Structure with mass (kg/m) and stiffness (N/m per metre), which touches the ground with the
    /// nodes `contact`, from left to right. No damping.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for matrices without rows or of different order and for fewer than two
    /// contact nodes, [`Error::Index`](crate::Error::Index) and [`Error::Input`](crate::Error::Input) for entries,
    /// coordinates or weights out of range or not finite, [`Error::Scene`](crate::Error::Scene) for a mass matrix that
    /// is not symmetric, [`Error::Indefinite`](crate::Error::Indefinite) for one with a negative mass, more than
    /// rounding.
    pub fn new(mass: Triplets, stiffness: Triplets, contact: Vec<ContactNode>) -> Result<Self> {
        let damping = Triplets::new(mass.order());
        let faces = Vec::new();
        Self { mass, damping, stiffness, contact, faces, active: false }.checked()
    }

    /// Structure with mass (kg) and stiffness (N/m) that touches a ground in plan with `faces`, as
    /// [`Structure::contact_faces`] has them. No damping; its forces are those of the whole body.
    ///
    /// ```
    /// use basemat::structure::{FaceNode, MatrixModel, Structure, Triplets};
    ///
    /// // A slab of one square element: u_x, u_y and u_z of its four nodes.
    /// let corners = [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0]];
    /// let node = |k: usize| FaceNode::free(corners[k], [3 * k, 3 * k + 1, 3 * k + 2]);
    /// let mass = Triplets::from_entries(12, (0..12).map(|k| (k, k, 20.0e3)));
    /// let mut stiffness = Triplets::new(12);
    /// // What resists twisting of the corners out of their plane; this slab has nothing else.
    /// stiffness.add_outer([(2, 1.0), (5, -1.0), (8, 1.0), (11, -1.0)], 5.0e6);
    /// let slab = MatrixModel::in_plan(mass, stiffness, vec![(0..4).map(node).collect()])?;
    /// assert_eq!((slab.dofs(), slab.contact_faces()[0].len()), (12, 4));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`MatrixModel::new`], of the faces' corners. Whether faces are flat, convex and apart is checked when a
    /// simulation is built.
    pub fn in_plan(mass: Triplets, stiffness: Triplets, faces: Vec<Vec<FaceNode>>) -> Result<Self> {
        let damping = Triplets::new(mass.order());
        let contact = Vec::new();
        Self { mass, damping, stiffness, contact, faces, active: false }.checked()
    }

    /// The model, if its matrices and the points of its base are those of a structure.
    fn checked(self) -> Result<Self> {
        let order = self.mass.order();
        at_least("mass matrix", order, 1)?;
        check_mass(&SparseMatrix::new("mass matrix", &self.mass)?)?;
        check("stiffness matrix", &self.stiffness, order)?;
        check_base_nodes(&base_nodes(&self), order)?;
        Ok(self)
    }

    /// Replaces the damping by a damping matrix (N s/m per metre).
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for another order, [`Error::Index`](crate::Error::Index) and
    /// [`Error::Input`](crate::Error::Input) for entries out of range or not finite,
    /// [`Error::Scene`](crate::Error::Scene) for a matrix that is not symmetric,
    /// [`Error::Indefinite`](crate::Error::Indefinite) for one with negative damping, more than rounding.
    pub fn with_damping(self, damping: Triplets) -> Result<Self> {
        check_damping(&check(DAMPING, &damping, self.mass.order())?)?;
        Ok(Self { damping, active: false, ..self })
    }

    /// Replaces the damping by a matrix (N s/m per metre) that need be neither symmetric nor positive semi-definite:
    /// that of gyroscopes, or of dampers that feed energy in. What it feeds in shows as negative
    /// [`damping`](crate::coupled::EnergyBalance::damping) in the energy balance.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size), [`Error::Index`](crate::Error::Index) and
    /// [`Error::Input`](crate::Error::Input) as for [`with_damping`](MatrixModel::with_damping).
    pub fn with_active_damping(self, damping: Triplets) -> Result<Self> {
        check(DAMPING, &damping, self.mass.order())?;
        Ok(Self { damping, active: true, ..self })
    }

    /// Replaces the damping by Rayleigh damping.
    #[must_use]
    pub fn with_rayleigh(mut self, damping: RayleighDamping) -> Self {
        self.damping.clear();
        self.active = false;
        for (matrix, factor) in
            [(&self.mass, damping.mass()), (&self.stiffness, damping.stiffness())]
        {
            if factor > 0.0 {
                add(matrix, factor, &mut self.damping);
            }
        }
        self
    }
}

fn check(name: &'static str, matrix: &Triplets, order: usize) -> Result<SparseMatrix> {
    same_length(name, matrix.order(), order)?;
    SparseMatrix::new(name, matrix)
}

/// Adds `factor` times one matrix to another.
fn add(matrix: &Triplets, factor: f64, sum: &mut Triplets) {
    for &(row, column, value) in matrix.entries() {
        sum.add(row, column, factor * value);
    }
}

impl Structure for MatrixModel {
    fn dofs(&self) -> usize {
        self.mass.order()
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.contact.clone()
    }

    fn contact_faces(&self) -> Vec<Vec<FaceNode>> {
        self.faces.clone()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        add(&self.mass, 1.0, matrix);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        add(&self.stiffness, 1.0, matrix);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        add(&self.damping, 1.0, matrix);
        Ok(())
    }

    fn has_active_damping(&self) -> bool {
        self.active
    }
}
