//! Structure given by its matrices.

use crate::error::{Error, Result, same_length};
use crate::linalg::SparseMatrix;
use crate::structure::matrix_checks::{check_damping, check_mass};
use crate::structure::{ContactNode, RayleighDamping, Structure, Triplets, check_contact_nodes};

const DAMPING: &str = "damping matrix";

/// A structure given by mass, damping and stiffness matrices, from another program for example.
///
/// The degrees of freedom are absolute displacements in m and rotations in rad, in any order; the structure
/// is **free**, without supports: the ground holds it up, so a rigid translation must give no elastic
/// force beyond rounding (entries of ten digits may leave too much, those of twelve do not).
/// Matrices are per metre of thickness. They may come from Matrix Market files
/// (`Triplets::read_matrix_market`, feature `io`), dense arrays ([`Triplets::from_dense`]) or compressed
/// rows ([`Triplets::from_csr`]); large models march faster after a
/// [`CraigBampton`](crate::structure::CraigBampton) reduction.
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
    /// Whether the damping is taken as it is.
    active: bool,
}

impl MatrixModel {
    /// Structure with mass (kg/m) and stiffness (N/m per metre), which touches the ground with the
    /// nodes `contact`, from left to right. No damping.
    ///
    /// # Errors
    /// [`Error::Size`] for matrices without rows or of different order and for fewer than two
    /// contact nodes, [`Error::Index`] and [`Error::Input`] for entries, coordinates or weights out
    /// of range or not finite, [`Error::Scene`] for a mass matrix that is not symmetric,
    /// [`Error::Indefinite`] for one with a negative mass, more than rounding.
    pub fn new(mass: Triplets, stiffness: Triplets, contact: Vec<ContactNode>) -> Result<Self> {
        let order = mass.order();
        if order == 0 {
            return Err(Error::Size { quantity: "mass matrix", found: 0, needed: 1 });
        }
        let inertia = SparseMatrix::new("mass matrix", &mass)?;
        check_mass(&inertia)?;
        check("stiffness matrix", &stiffness, order)?;
        check_contact_nodes(&contact, order)?;
        Ok(Self { mass, damping: Triplets::new(order), stiffness, contact, active: false })
    }

    /// The same structure with a damping matrix (N s/m per metre), in place of what it had.
    ///
    /// # Errors
    /// [`Error::Size`] for another order, [`Error::Index`] and [`Error::Input`] for entries out of
    /// range or not finite, [`Error::Scene`] for a matrix that is not symmetric,
    /// [`Error::Indefinite`] for one with negative damping, more than rounding.
    pub fn with_damping(self, damping: Triplets) -> Result<Self> {
        check_damping(&check(DAMPING, &damping, self.mass.order())?)?;
        Ok(Self { damping, active: false, ..self })
    }

    /// The same with a matrix that need be neither symmetric nor positive semi-definite: that of
    /// gyroscopes, or of dampers that feed energy in. What it feeds in shows as negative
    /// [`damping`](crate::coupled::EnergyBalance::damping) in the energy balance.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Index`] and [`Error::Input`] as for
    /// [`with_damping`](MatrixModel::with_damping).
    pub fn with_active_damping(self, damping: Triplets) -> Result<Self> {
        check(DAMPING, &damping, self.mass.order())?;
        Ok(Self { damping, active: true, ..self })
    }

    /// The same structure with Rayleigh damping, in place of what it had.
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
