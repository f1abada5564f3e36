//! The rigid body on a flat base in space.

use std::f64::consts::TAU;

use crate::error::{Result, at_least, finite, not_negative, positive, require};
use crate::geometry::circle;
use crate::structure::{Base, BaseNode, DofCombination, Structure, Triplets};

/// Relative difference up to which mirrored entries of an inertia tensor count as equal.
const SYMMETRY_TOLERANCE: f64 = 1e-9;

/// Rigid body on a flat base in space, with six degrees of freedom.
///
/// `[u_x, u_y, u_z, r_x, r_y, r_z]` belong to the middle of the base. x points to the right, y away from the
/// reader, z up; rotations follow the right-hand rule. A point at (x, y, z) from the middle of the base moves by u
/// + r × (x, y, z) (small rotations), so that r_y lowers points to the right of the middle.
///
/// ```
/// use basemat::structure::{RigidBody, Structure};
///
/// // Along x, y and z, m, and the density, kg/m³.
/// let block = RigidBody::cuboid([20.0, 14.0, 12.0], 2400.0)?;
/// assert_eq!((block.dofs(), block.total_mass()), (6, 8_064_000.0));
/// let [right, away, up] = block.displacement_at([3.0, 2.0, 12.0]);
/// assert_eq!(right[..], [(0, 1.0), (4, 12.0), (5, -2.0)]);
/// assert_eq!(away[..], [(1, 1.0), (5, 3.0), (3, -12.0)]);
/// assert_eq!(up[..], [(2, 1.0), (3, 2.0), (4, -3.0)]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RigidBody {
    /// Corners of the base from its middle, m.
    outline: Vec<[f64; 2]>,
    mass: f64,
    /// Tensor of inertia about the centre of gravity, kg m².
    inertia: [[f64; 3]; 3],
    /// Centre of gravity from the middle of the base, m.
    gravity_center: [f64; 3],
    /// Middle of the base on the surface, m.
    center: [f64; 2],
    /// Acceleration of gravity for P–Δ, m/s²; zero without it.
    gravity: f64,
}

impl RigidBody {
    /// Homogeneous cuboid: sides along x, y and z (m) and density (kg/m³).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive.
    pub fn cuboid([length, width, height]: [f64; 3], density: f64) -> Result<Self> {
        positive("length of the cuboid", length)?;
        positive("width of the cuboid", width)?;
        positive("height of the cuboid", height)?;
        positive("density of the cuboid", density)?;
        let half_length = 0.5 * length;
        let half_width = 0.5 * width;
        let mass = length * width * height * density;
        let moment_of_inertia = |a: f64, b: f64| mass * (a * a + b * b) / 12.0;
        let inertia = diagonal_tensor([
            moment_of_inertia(width, height),
            moment_of_inertia(length, height),
            moment_of_inertia(length, width),
        ]);
        let outline = vec![
            [-half_length, -half_width],
            [half_length, -half_width],
            [half_length, half_width],
            [-half_length, half_width],
        ];
        Self::from_mass(outline, mass, inertia, [0.0, 0.0, 0.5 * height])
    }

    /// Homogeneous cylinder that stands on its base.
    ///
    /// `radius` and `height` in m, `density` in kg/m³. The base is a polygon of the same area.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive.
    pub fn cylinder(radius: f64, height: f64, density: f64) -> Result<Self> {
        positive("radius of the cylinder", radius)?;
        positive("height of the cylinder", height)?;
        positive("density of the cylinder", density)?;
        let squared_radius = radius * radius;
        let mass = 0.5 * TAU * squared_radius * height * density;
        let tilting_inertia = mass * (squared_radius / 4.0 + height * height / 12.0);
        let inertia =
            diagonal_tensor([tilting_inertia, tilting_inertia, 0.5 * mass * squared_radius]);
        let outline = circle(radius).collect();
        Self::from_mass(outline, mass, inertia, [0.0, 0.0, 0.5 * height])
    }

    /// Any rigid body, from its convex base, mass, inertia and centre of gravity.
    ///
    /// `outline`: corners of the base relative to the point of the degrees of freedom, m. `mass`: kg. `inertia`: tensor
    /// about the centre of gravity, kg m², with moments of inertia on the diagonal and minus the products of inertia
    /// off the diagonal. `gravity_center`: relative to the same point, m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for numbers that are not finite, a mass that is not positive, a tensor
    /// that is not symmetric and positive definite, and a centre of gravity below the base;
    /// [`Error::Size`](crate::Error::Size) for fewer than three corners. Whether the corners form a convex face
    /// is checked when a simulation is built.
    pub fn from_mass(
        outline: Vec<[f64; 2]>,
        mass: f64,
        inertia: [[f64; 3]; 3],
        gravity_center: [f64; 3],
    ) -> Result<Self> {
        at_least("list of corners of a rigid body's base", outline.len(), 3)?;
        let mut corners = outline.iter().flatten();
        corners.try_for_each(|x| finite("corner of the base", *x).map(drop))?;
        positive("mass of the body", mass)?;
        gravity_center.iter().try_for_each(|x| finite("centre of gravity", *x).map(drop))?;
        not_negative("height of the centre of gravity", gravity_center[2])?;
        check_tensor(&inertia)?;
        let body = Self { outline, mass, inertia, gravity_center, center: [0.0; 2], gravity: 0.0 };
        body.base_inertia().iter().flatten().try_for_each(|value| {
            finite("moment of inertia about the middle of the base", *value).map(drop)
        })?;
        Ok(body)
    }

    /// Moves the middle of the base from the origin to `center` (m) on the surface.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite.
    pub fn centered_at(self, center: [f64; 2]) -> Result<Self> {
        center.iter().try_for_each(|x| finite("middle of the base", *x).map(drop))?;
        Ok(Self { center, ..self })
    }

    /// Adds the P–Δ effect of the body's weight.
    ///
    /// The effect is the potential energy −m g h (r_x² + r_y²)/2 with the height h of the centre of gravity.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `gravity` (m/s²) is finite and not negative.
    pub fn with_p_delta(self, gravity: f64) -> Result<Self> {
        Ok(Self { gravity: not_negative("acceleration of gravity", gravity)?, ..self })
    }

    /// Point of the degrees of freedom on the surface, m.
    pub(crate) fn center(&self) -> [f64; 2] {
        self.center
    }

    /// Mass, kg.
    pub fn total_mass(&self) -> f64 {
        self.mass
    }

    /// Displacements of a point of the body along x, y and z.
    ///
    /// The coordinates of the point are relative to the middle of the base, m.
    pub fn displacement_at(&self, [x, y, z]: [f64; 3]) -> [DofCombination; 3] {
        let rows =
            [[(0, 1.0), (4, z), (5, -y)], [(1, 1.0), (5, x), (3, -z)], [(2, 1.0), (3, y), (4, -x)]];
        rows.map(DofCombination::from)
    }

    /// Tensor of inertia about the middle of the base, by the parallel axis theorem, kg m².
    fn base_inertia(&self) -> [[f64; 3]; 3] {
        let c = self.gravity_center;
        let squared_distance: f64 = c.iter().map(|x| x * x).sum();
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let diagonal = if i == j { squared_distance } else { 0.0 };
                self.inertia[i][j] + self.mass * (diagonal - c[i] * c[j])
            })
        })
    }
}

/// Diagonal tensor.
fn diagonal_tensor([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

/// Returns an error unless a tensor of inertia is symmetric and positive definite.
fn check_tensor(t: &[[f64; 3]; 3]) -> Result<()> {
    const TENSOR_NAME: &str = "tensor of inertia of the body";
    let mut max_entry = 0.0_f64;
    for entry in t.iter().flatten() {
        max_entry = max_entry.max(finite(TENSOR_NAME, *entry)?.abs());
    }
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        let asymmetry = t[i][j] - t[j][i];
        require(
            TENSOR_NAME,
            asymmetry,
            asymmetry.abs() <= SYMMETRY_TOLERANCE * max_entry,
            "symmetric",
        )?;
    }
    let second_minor = t[0][0] * t[1][1] - t[0][1] * t[1][0];
    let determinant = t[0][2] * (t[1][0] * t[2][1] - t[1][1] * t[2][0])
        - t[1][2] * (t[0][0] * t[2][1] - t[0][1] * t[2][0])
        + t[2][2] * second_minor;
    for minor in [t[0][0], second_minor, determinant] {
        require(TENSOR_NAME, minor, minor > 0.0, "positive definite")?;
    }
    Ok(())
}

impl Structure for RigidBody {
    fn dofs(&self) -> usize {
        6
    }

    fn base(&self) -> Base {
        let outline = BaseNode::rigid_face(&self.outline, self.center, [0, 1, 2, 3, 4, 5]);
        Base::Faces(vec![outline])
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        let inertia = self.base_inertia();
        // The centre of gravity moves by u + r × c, which gives the mass of the translations and their coupling with
        // the rotations.
        let center_rows = self.displacement_at(self.gravity_center);
        for i in 0..3 {
            matrix.add(i, i, self.mass);
            for &(j, weight) in center_rows[i].iter().skip(1).filter(|(_, weight)| *weight != 0.0) {
                matrix.add(i, j, self.mass * weight);
                matrix.add(j, i, self.mass * weight);
            }
            for j in 0..3 {
                // The mean is symmetric to the last bit.
                let value = 0.5 * (inertia[i][j] + inertia[j][i]);
                if value != 0.0 {
                    matrix.add(3 + i, 3 + j, value);
                }
            }
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.geometric_stiffness(matrix)
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        if self.gravity > 0.0 {
            let overturning = self.mass * self.gravity * self.gravity_center[2];
            matrix.add(3, 3, -overturning);
            matrix.add(4, 4, -overturning);
        }
        Ok(())
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        const DOF_NAMES: [&str; 6] = ["u_x", "u_y", "u_z", "r_x", "r_y", "r_z"];
        let names: Option<Vec<_>> = dofs.iter().map(|dof| DOF_NAMES.get(*dof).copied()).collect();
        Some(format!("{} of the rigid body", names?.join(", ")))
    }
}
