//! Structures that are defined by their matrices.

use crate::error::{Error, Result, at_least, same_length};
use crate::linalg::{Elimination, SparseMatrix};
use crate::structure::matrix_checks::{check_damping, check_mass, check_stiffness};
use crate::structure::{Base, DofCombination, RayleighDamping, SectionRows, Structure, Triplets};

/// Name of the damping matrix in errors.
const DAMPING_MATRIX_NAME: &str = "damping matrix";

/// A structure defined by its mass, damping and stiffness matrices, for example from another program.
///
/// The degrees of freedom are absolute displacements in m and rotations in rad, in any order. The structure is
/// **free**, without supports, since the ground supports it: a rigid translation must give no elastic force beyond
/// rounding (entries with ten digits may be too inaccurate, entries with twelve digits are not). Matrices are per metre
/// of thickness, except for a structure in space ([`Base::Faces`]). They may come from Matrix Market files
/// (`Triplets::read_matrix_market`, feature `io`), dense arrays ([`Triplets::from_dense`]) or compressed rows
/// ([`Triplets::from_csr`]). Large models run faster after a [`CraigBampton`](crate::structure::CraigBampton)
/// reduction.
///
/// The mass matrix must be positive semi-definite up to rounding (see [`Structure::mass`]), which is checked here. The
/// stiffness matrix must be symmetric, and positive semi-definite with a fixed base, Lagrange multipliers excepted (see
/// [`Structure::stiffness`]). This is checked when a simulation is built.
///
/// ```
/// use basemat::structure::{BaseNode, MatrixModel, Structure, Triplets};
///
/// // A rigid base [u_x, u_y, θ] with a mass on a spring, 5 m up.
/// let masses = [2.0e4, 3.0e4, 6.0e4, 1.0e4];
/// let mass = Triplets::from_entries(4, masses.into_iter().enumerate().map(|(k, m)| (k, k, m)));
/// let mut stiffness = Triplets::new(4);
/// stiffness.add_outer([(3, 1.0), (0, -1.0), (2, 5.0)], 4.0e6);
/// let base = BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]);
/// let model = MatrixModel::new(mass, stiffness, base)?;
/// assert_eq!(model.dofs(), 4);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixModel {
    mass: Triplets,
    damping: Triplets,
    stiffness: Triplets,
    base: Base,
    /// Whether the damping may feed energy in; it is then not checked.
    has_active_damping: bool,
    /// Whether the stiffness may be unsymmetric.
    has_active_stiffness: bool,
}

impl MatrixModel {
    /// Structure with mass (kg/m) and stiffness (N/m per metre), without damping.
    ///
    /// `base`: nodes from left to right, or any [`Base`]. With [`Base::Faces`] the structure is in space. Its matrices
    /// then belong to the whole body (kg, N/m):
    /// ```
    /// use basemat::structure::{Base, BaseNode, MatrixModel, Structure, Triplets};
    ///
    /// // A slab of one square element: u_x, u_y and u_z of its four nodes.
    /// let corners = [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0]];
    /// let node = |k: usize| BaseNode::free_in_plan(corners[k], [3 * k, 3 * k + 1, 3 * k + 2]);
    /// let mass = Triplets::from_entries(12, (0..12).map(|k| (k, k, 20.0e3)));
    /// let mut stiffness = Triplets::new(12);
    /// // Stiffness against displacements of the corners out of their plane; the slab has no other stiffness.
    /// stiffness.add_outer([(2, 1.0), (5, -1.0), (8, 1.0), (11, -1.0)], 5.0e6);
    /// let face = (0..4).map(node).collect();
    /// let slab = MatrixModel::new(mass, stiffness, Base::Faces(vec![face]))?;
    /// assert_eq!((slab.dofs(), slab.base().nodes().count()), (12, 4));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`] for matrices without rows or of different order and for a base of fewer than two nodes,
    /// [`Error::Index`] and [`Error::Input`] for entries, coordinates or weights out of range or not finite,
    /// [`Error::Unsymmetric`] for a mass matrix that is not symmetric, [`Error::Indefinite`] for a negative mass beyond
    /// rounding. The order of nodes, and whether faces are flat, convex and apart, are checked when a simulation is
    /// built.
    pub fn new(mass: Triplets, stiffness: Triplets, base: impl Into<Base>) -> Result<Self> {
        let order = mass.order();
        at_least("mass matrix", order, 1)?;
        check_mass(&SparseMatrix::new("mass matrix", &mass)?, &Elimination::default())?;
        checked_matrix("stiffness matrix", &stiffness, order)?;
        let base = base.into();
        let damping = Triplets::new(order);
        base.check(order)?;
        Ok(Self {
            mass,
            damping,
            stiffness,
            base,
            has_active_damping: false,
            has_active_stiffness: false,
        })
    }

    /// Force or moment that the inertia of a part exerts on the other parts.
    ///
    /// `motion`: a rigid motion of the part by one unit, as (degree of freedom, displacement) terms. A translation
    /// gives the force in its direction, a rotation about a point the moment about this point. The weights of the
    /// accelerations are −motionᵀ M. The result is exact for a part without loads and without damping to the ground;
    /// with the midpoint rule it is the mean over the step. To include the weight, add the acceleration of gravity to
    /// the vertical accelerations. The returned unit is that of a force, also for a moment.
    ///
    /// ```
    /// use basemat::structure::{BaseNode, MatrixModel, Triplets};
    ///
    /// // A rigid base [u_x, u_y, θ] with masses on springs, 4 m and 8 m up.
    /// let masses = [2.0e4, 4.0e4, 6.0e4, 1.0e4, 1.5e4];
    /// let mass = Triplets::from_entries(5, masses.into_iter().enumerate().map(|(k, m)| (k, k, m)));
    /// let mut stiffness = Triplets::new(5);
    /// stiffness.add_outer([(3, 1.0), (0, -1.0), (2, 4.0)], 4.0e6);
    /// stiffness.add_outer([(4, 1.0), (3, -1.0), (2, 4.0)], 4.0e6);
    /// let model = MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]))?;
    /// let shear = model.section([(3, 1.0), (4, 1.0)])?;
    /// // A rotation by 1 rad about the foot moves the masses to the left.
    /// let moment = model.section([(3, -4.0), (4, -8.0)])?;
    /// let acceleration = [0.0, 0.0, 0.0, 1.0, 2.0];
    /// assert_eq!(shear.value(&[], &[], &acceleration), -1.0e4 - 3.0e4);
    /// assert_eq!(moment.value(&[], &[], &acceleration), 4.0e4 + 24.0e4);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`] for a degree of freedom that does not exist,
    /// [`Error::Input`] for a displacement that is not finite.
    pub fn section(&self, motion: impl Into<DofCombination>) -> Result<SectionRows> {
        let motion = motion.into();
        motion.check("degree of freedom of the part", self.dofs())?;
        let mut displacement = vec![0.0; self.dofs()];
        for &(dof, value) in &motion {
            displacement[dof] += value;
        }
        let mut force = vec![0.0; self.dofs()];
        let mass = SparseMatrix::new("mass matrix", &self.mass)?;
        mass.multiply_add(-1.0, &displacement, &mut force);
        let terms = force.into_iter().enumerate().filter(|(_, force)| *force != 0.0);
        let unit = if matches!(self.base, Base::Faces(_)) { "N" } else { "N/m" };
        Ok(SectionRows { unit, acceleration: terms.collect(), ..SectionRows::default() })
    }

    /// Replaces the damping by a damping matrix (N s/m per metre).
    ///
    /// # Errors
    /// [`Error::Size`] for another order, [`Error::Index`] and [`Error::Input`] for entries out of range or not finite,
    /// [`Error::Unsymmetric`] for a matrix that is not symmetric (with the name of the stiffness if it is not symmetric
    /// either), [`Error::Indefinite`] for negative damping beyond rounding.
    pub fn with_damping(self, damping: Triplets) -> Result<Self> {
        let damping_matrix = checked_matrix(DAMPING_MATRIX_NAME, &damping, self.mass.order())?;
        check_damping(&damping_matrix, &Elimination::default()).map_err(|error| match error {
            Error::Unsymmetric { .. } => self.unsymmetric_stiffness().unwrap_or(error),
            other => other,
        })?;
        Ok(Self { damping, has_active_damping: false, ..self })
    }

    /// Error for a stiffness that is not symmetric, which makes proportional damping unsymmetric too.
    fn unsymmetric_stiffness(&self) -> Option<Error> {
        let stiffness = SparseMatrix::new("stiffness matrix", &self.stiffness).ok()?;
        let mass = SparseMatrix::new("mass matrix", &self.mass).ok()?;
        check_stiffness(&stiffness, &mass).err().filter(|_| !self.has_active_stiffness)
    }

    /// Replaces the damping by a matrix without a check of symmetry and sign.
    ///
    /// The matrix is in N s/m per metre. Gyroscopes, or dampers that feed energy in, have such a matrix. This energy is
    /// negative `damping` in the energy balance.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Index`] and
    /// [`Error::Input`] as for [`with_damping`](MatrixModel::with_damping).
    pub fn with_active_damping(self, damping: Triplets) -> Result<Self> {
        checked_matrix(DAMPING_MATRIX_NAME, &damping, self.mass.order())?;
        Ok(Self { damping, has_active_damping: true, ..self })
    }

    /// Allows a stiffness matrix that is not symmetric ([`Structure::has_active_stiffness`]).
    ///
    /// Otherwise `build` returns an error for such a matrix.
    #[must_use]
    pub fn with_active_stiffness(self) -> Self {
        Self { has_active_stiffness: true, ..self }
    }

    /// Replaces the damping by Rayleigh damping.
    #[must_use]
    pub fn with_rayleigh(mut self, damping: RayleighDamping) -> Self {
        self.damping.clear();
        self.has_active_damping = false;
        for (matrix, factor) in
            [(&self.mass, damping.mass()), (&self.stiffness, damping.stiffness())]
        {
            if factor > 0.0 {
                add_scaled(matrix, factor, &mut self.damping);
            }
        }
        self
    }
}

/// Matrix of the triplets; an error for another order or invalid entries.
fn checked_matrix(name: &'static str, matrix: &Triplets, order: usize) -> Result<SparseMatrix> {
    same_length(name, matrix.order(), order)?;
    SparseMatrix::new(name, matrix)
}

/// Adds `factor` times a matrix to `sum`.
fn add_scaled(matrix: &Triplets, factor: f64, sum: &mut Triplets) {
    for &(row, column, value) in matrix.entries() {
        sum.add(row, column, factor * value);
    }
}

impl Structure for MatrixModel {
    fn dofs(&self) -> usize {
        self.mass.order()
    }

    fn base(&self) -> Base {
        self.base.clone()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        add_scaled(&self.mass, 1.0, matrix);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        add_scaled(&self.stiffness, 1.0, matrix);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        add_scaled(&self.damping, 1.0, matrix);
        Ok(())
    }

    fn has_active_damping(&self) -> bool {
        self.has_active_damping
    }

    fn has_active_stiffness(&self) -> bool {
        self.has_active_stiffness
    }
}
