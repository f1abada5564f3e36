//! Eight-node brick of a solid in space.

use super::condensation::{complete, condense};
use super::element::{Element, MassKind};
use super::element_face::ElementFace;
use super::material::Material;
use super::vector::{add, cross, dot};
use crate::error::{Result, require, same_length};
use crate::geometry::{Direction, SPACE_DIRECTIONS};
use crate::linalg::gauss;

/// Number of displacement patterns: eight shape functions and three inner modes.
const PATTERN_COUNT: usize = 11;
/// Number of displacements of the nodes.
const NODAL_ORDER: usize = 24;
/// Number of displacements of the nodes and the inner modes.
const FULL_ORDER: usize = 3 * PATTERN_COUNT;

/// Brick between eight nodes, with inner bending modes.
///
/// Nodes 0 to 3 run counter-clockwise, seen from above, around the lower face; 4 to 7 stand over them. The
/// stiffness has 2 × 2 × 2 Gauss points and nine inner modes (Wilson's, corrected by Taylor, Beresford & Wilson,
/// 1976), as [`Quad4`](super::Quad4): distorted bricks pass the patch test, and rectangular ones bend exactly and do not
/// lock as ν → 1/2. Bricks with slanting sides are far too stiff in bending: a row of 45° trapezoids deflects by 3
/// to 5 % of the exact value.
///
/// On coarse meshes frequencies of bending are too high with the consistent mass, and slightly too low with the lumped
/// mass.
///
/// ```
/// use basemat::fem::{Element, Hex8, MassKind, Material};
///
/// let brick = Hex8::new([0, 1, 2, 3, 4, 5, 6, 7], Material::new(30.0e9, 0.2, 2500.0)?);
/// let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
/// let corners: Vec<[f64; 3]> =
///     [0.0, 0.4].iter().flat_map(|z| square.map(|[x, y]| [x, y, *z])).collect();
/// let mut mass = vec![0.0; 24 * 24];
/// brick.mass(&corners, MassKind::Lumped, &mut mass);
/// assert!((mass[0] - 2500.0 * 0.8 / 8.0).abs() < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Hex8 {
    nodes: [usize; 8],
    material: Material,
}

impl Hex8 {
    /// Corners of the six faces, counter-clockwise seen from outside.
    #[doc(hidden)]
    pub const FACE_CORNERS: [[usize; 4]; 6] =
        [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

    /// Brick between `nodes`: four around the lower face, counter-clockwise from above, and four over them.
    pub fn new(nodes: [usize; 8], material: Material) -> Self {
        Self { nodes, material }
    }

    /// Whether the Jacobian at the centre is negative: the upper face lies below the lower one.
    #[doc(hidden)]
    pub fn is_inside_out(coordinates: &[[f64; 3]]) -> bool {
        Slopes::at([0.0; 3], coordinates).determinant < 0.0
    }

    /// Stresses at the eight nodes, Pa: `[σ_xx, σ_yy, σ_zz, τ_xy, τ_yz, τ_zx]`, tension positive.
    ///
    /// `displacement` holds the element's degrees of freedom, m. The stresses at the Gauss points, with the inner modes,
    /// are extrapolated to the nodes. Stresses of neighbours differ at a common node; take the mean.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless there are 8 points and 24 displacements, and errors of
    /// [`check`](Element::check).
    pub fn stresses(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
    ) -> Result<[[f64; 6]; 8]> {
        self.check(coordinates)?;
        same_length("displacements of a brick", displacement.len(), NODAL_ORDER)?;
        let full = self.full_stiffness(coordinates);
        let mut full_displacement = [0.0; FULL_ORDER];
        full_displacement[..NODAL_ORDER].copy_from_slice(displacement);
        complete(&full, NODAL_ORDER, &mut full_displacement);
        let centre = Slopes::at([0.0; 3], coordinates);
        let at_points = gauss_points().map(|point| {
            let slopes = Slopes::at(point, coordinates).patterns(point, &centre);
            self.stress(&slopes, &full_displacement)
        });
        // The eight Gauss points are corners of a smaller brick.
        let extrapolation = 3.0_f64.sqrt();
        Ok(NODE_COORDINATES.map(|corner| {
            let shape = shape(corner.map(|place| extrapolation * place));
            std::array::from_fn(|k| (0..8).map(|i| shape[i] * at_points[i][k]).sum())
        }))
    }

    /// Stress from the slopes of the patterns and their displacements.
    fn stress(
        &self,
        slopes: &[[f64; 3]; PATTERN_COUNT],
        full_displacement: &[f64; FULL_ORDER],
    ) -> [f64; 6] {
        // Slopes ∂/∂x, ∂/∂y, ∂/∂z of the displacements u, v, w.
        let mut u = [0.0; 3];
        let mut v = [0.0; 3];
        let mut w = [0.0; 3];
        for (i, &slope) in slopes.iter().enumerate() {
            u = add(u, full_displacement[3 * i], slope);
            v = add(v, full_displacement[3 * i + 1], slope);
            w = add(w, full_displacement[3 * i + 2], slope);
        }
        let lame = self.material.lame();
        let shear = self.material.shear_modulus();
        let volumetric = lame * (u[0] + v[1] + w[2]);
        [
            volumetric + 2.0 * shear * u[0],
            volumetric + 2.0 * shear * v[1],
            volumetric + 2.0 * shear * w[2],
            shear * (u[1] + v[0]),
            shear * (v[2] + w[1]),
            shear * (w[0] + u[2]),
        ]
    }

    /// Stiffness of the nodes, and the equations of the inner modes after it.
    fn full_stiffness(&self, coordinates: &[[f64; 3]]) -> [[f64; FULL_ORDER]; FULL_ORDER] {
        let lame = self.material.lame();
        let shear = self.material.shear_modulus();
        let centre = Slopes::at([0.0; 3], coordinates);
        let mut full = [[0.0; FULL_ORDER]; FULL_ORDER];
        for point in gauss_points() {
            let here = Slopes::at(point, coordinates);
            let slopes = here.patterns(point, &centre);
            for (i, a) in slopes.iter().enumerate() {
                for (j, b) in slopes.iter().enumerate() {
                    let gradient_product = shear * dot(*a, *b);
                    for k in 0..3 {
                        for l in 0..3 {
                            let diagonal = if k == l { gradient_product } else { 0.0 };
                            let value = lame * a[k] * b[l] + shear * a[l] * b[k] + diagonal;
                            full[3 * i + k][3 * j + l] += here.determinant * value;
                        }
                    }
                }
            }
        }
        condense(&mut full, NODAL_ORDER);
        full
    }
}

impl Element for Hex8 {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        Some(Box::new(Self { nodes: nodes.try_into().ok()?, ..self.clone() }))
    }

    fn directions(&self) -> &[Direction] {
        &SPACE_DIRECTIONS[..3]
    }

    fn faces(&self) -> Vec<ElementFace> {
        Self::FACE_CORNERS
            .map(|face| ElementFace::side(&face.map(|k| self.nodes[k])))
            .to_vec()
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let full = self.full_stiffness(coordinates);
        for (entries, row) in matrix.chunks_exact_mut(NODAL_ORDER).zip(&full) {
            for (entry, value) in entries.iter_mut().zip(row) {
                *entry += value;
            }
        }
    }

    fn density(&self) -> Option<f64> {
        Some(self.material.density())
    }

    /// Lumped: row sums of the consistent mass.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let mut block = [[0.0; 8]; 8];
        // Exact: N_i N_j det J is of fourth degree in each coordinate.
        for (point, weight) in gauss::cube(3) {
            let shape = shape(point);
            let mass =
                weight * self.material.density() * Slopes::at(point, coordinates).determinant;
            for (i, row) in block.iter_mut().enumerate() {
                for j in 0..8 {
                    let column = if kind == MassKind::Lumped { i } else { j };
                    row[column] += mass * shape[i] * shape[j];
                }
            }
        }
        for (index, entry) in matrix.iter_mut().take(NODAL_ORDER * NODAL_ORDER).enumerate() {
            let row = index / NODAL_ORDER;
            let column = index % NODAL_ORDER;
            if row % 3 == column % 3 {
                *entry += block[row / 3][column / 3];
            }
        }
    }

    /// [`Error::Input`](crate::Error::Input) in an [`Error::Item`](crate::Error::Item) unless the Jacobian is positive
    /// at all Gauss points and at the centre; at a corner it may be negative.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length("coordinates of a brick", coordinates.len(), 8)?;
        for point in gauss_points().into_iter().chain([[0.0; 3]]) {
            let value = Slopes::at(point, coordinates).determinant;
            let quantity = "Jacobian inside the brick";
            let needed = "above zero: lower face counter-clockwise from above, upper face over it";
            require(quantity, value, value.is_finite() && value > 0.0, needed)
                .map_err(|fault| fault.within(format!("brick on nodes {:?}", self.nodes)))?;
        }
        Ok(())
    }
}

/// Natural coordinates (ξ, η, ζ) of the eight nodes.
const NODE_COORDINATES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Gauss points of the 2 × 2 × 2 rule in the order of the nodes; all weights are 1.
fn gauss_points() -> [[f64; 3]; 8] {
    let place = gauss::rule(2).nodes[1];
    NODE_COORDINATES.map(|corner| corner.map(|side| place * side))
}

/// Trilinear shape functions at (ξ, η, ζ).
fn shape([xi, eta, zeta]: [f64; 3]) -> [f64; 8] {
    NODE_COORDINATES.map(|[a, b, c]| 0.125 * (1.0 + a * xi) * (1.0 + b * eta) * (1.0 + c * zeta))
}

/// Slopes of the shape functions at a point, and the Jacobian there.
struct Slopes {
    /// Of the eight shape functions along x, y and z, 1/m.
    shape: [[f64; 3]; 8],
    /// Slopes of ξ, η and ζ along x, y and z, times the determinant.
    natural: [[f64; 3]; 3],
    /// Determinant of ∂(x, y, z)/∂(ξ, η, ζ).
    determinant: f64,
}

impl Slopes {
    fn at([xi, eta, zeta]: [f64; 3], coordinates: &[[f64; 3]]) -> Self {
        let by_natural = NODE_COORDINATES.map(|[a, b, c]| {
            let along_xi = 1.0 + a * xi;
            let along_eta = 1.0 + b * eta;
            let along_zeta = 1.0 + c * zeta;
            [
                0.125 * a * along_eta * along_zeta,
                0.125 * b * along_xi * along_zeta,
                0.125 * c * along_xi * along_eta,
            ]
        });
        let tangent: [[f64; 3]; 3] = std::array::from_fn(|k| {
            let nodes = coordinates.iter().zip(&by_natural);
            nodes.fold([0.0; 3], |sum, (&node, slope)| add(sum, slope[k], node))
        });
        let natural = [
            cross(tangent[1], tangent[2]),
            cross(tangent[2], tangent[0]),
            cross(tangent[0], tangent[1]),
        ];
        let determinant = dot(tangent[0], natural[0]);
        let shape = by_natural.map(|slope| {
            (0..3).fold([0.0; 3], |sum, k| add(sum, slope[k] / determinant, natural[k]))
        });
        Self { shape, natural, determinant }
    }

    /// Slopes of the shape functions and of the inner modes at the `point` of these slopes.
    ///
    /// The modes are 1 − ξ², 1 − η² and 1 − ζ².
    ///
    /// Slopes of the modes are those by the Jacobian at the `centre`, scaled so that their integral over the element
    /// vanishes: a constant stress does no work on them.
    fn patterns(&self, point: [f64; 3], centre: &Self) -> [[f64; 3]; PATTERN_COUNT] {
        let scale = -2.0 / self.determinant;
        std::array::from_fn(|i| match i.checked_sub(8) {
            None => self.shape[i],
            Some(k) => centre.natural[k].map(|slope| scale * point[k] * slope),
        })
    }
}
