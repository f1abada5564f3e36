//! Eight-node brick of a solid in space.

use super::element::{Element, ElementFace, MassKind};
use super::element_matrix::{condense, recover_inner};
use super::material::Material;
use super::vector::{add_scaled, cross, dot};
use crate::error::{Result, require, same_length};
use crate::geometry::{Direction, SPACE_DIRECTIONS};
use crate::linalg::gauss;

/// Number of displacement patterns: eight shape functions and three inner bending modes.
const PATTERN_COUNT: usize = 11;
/// Number of displacements of the nodes.
const NODAL_ORDER: usize = 24;
/// Number of displacements of the nodes and of the inner modes.
const FULL_ORDER: usize = 3 * PATTERN_COUNT;

/// Brick between eight nodes, with inner bending modes.
///
/// Nodes 0 to 3 run counter-clockwise, seen from above, around the lower face; 4 to 7 stand over them. The
/// stiffness has 2 × 2 × 2 Gauss points and nine inner modes (Wilson's, corrected by Taylor, Beresford & Wilson,
/// 1976), as [`Quad4`](super::Quad4). Distorted bricks pass the patch test; rectangular bricks bend exactly and do not
/// lock as ν → 1/2. Bricks with inclined sides are far too stiff in bending: a row of 45° trapezoids deflects by 3 to
/// 5 % of the exact value.
///
/// On coarse meshes bending frequencies are too high with the consistent mass, and slightly too low with the lumped
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

    /// Brick between `nodes`: four around the lower face, counter-clockwise seen from above, and four over them.
    pub fn new(nodes: [usize; 8], material: Material) -> Self {
        Self { nodes, material }
    }

    /// Whether the Jacobian at the centre is negative: the upper face lies below the lower one.
    #[doc(hidden)]
    pub fn is_inside_out(coordinates: &[[f64; 3]]) -> bool {
        ShapeDerivatives::at([0.0; 3], coordinates).determinant < 0.0
    }

    /// Stresses at the eight nodes, Pa: `[σ_xx, σ_yy, σ_zz, τ_xy, τ_yz, τ_zx]`, tension positive.
    ///
    /// `displacement` holds the element's degrees of freedom, m. The stresses at the Gauss points, with the inner
    /// modes, are extrapolated to the nodes. Stresses of neighbouring bricks differ at a common node; take their mean.
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
        let full_stiffness = self.full_stiffness(coordinates);
        let mut full_displacement = [0.0; FULL_ORDER];
        full_displacement[..NODAL_ORDER].copy_from_slice(displacement);
        recover_inner(&full_stiffness, NODAL_ORDER, &mut full_displacement);
        let center_derivatives = ShapeDerivatives::at([0.0; 3], coordinates);
        let gauss_stresses = gauss_points().map(|point| {
            let pattern_derivatives = ShapeDerivatives::at(point, coordinates)
                .pattern_derivatives(point, &center_derivatives);
            self.stress(&pattern_derivatives, &full_displacement)
        });
        // The eight Gauss points are corners of a smaller brick.
        let extrapolation = 3.0_f64.sqrt();
        Ok(NODE_COORDINATES.map(|node| {
            let shape_values = shape_functions(node.map(|coordinate| extrapolation * coordinate));
            std::array::from_fn(|k| (0..8).map(|i| shape_values[i] * gauss_stresses[i][k]).sum())
        }))
    }

    /// Stress from the derivatives of the patterns and the displacements of the patterns.
    fn stress(
        &self,
        pattern_derivatives: &[[f64; 3]; PATTERN_COUNT],
        full_displacement: &[f64; FULL_ORDER],
    ) -> [f64; 6] {
        // Gradients (∂/∂x, ∂/∂y, ∂/∂z) of the displacements u, v, w.
        let mut u_gradient = [0.0; 3];
        let mut v_gradient = [0.0; 3];
        let mut w_gradient = [0.0; 3];
        for (i, &derivatives) in pattern_derivatives.iter().enumerate() {
            u_gradient = add_scaled(u_gradient, full_displacement[3 * i], derivatives);
            v_gradient = add_scaled(v_gradient, full_displacement[3 * i + 1], derivatives);
            w_gradient = add_scaled(w_gradient, full_displacement[3 * i + 2], derivatives);
        }
        let lame = self.material.lame();
        let shear = self.material.shear_modulus();
        let volumetric = lame * (u_gradient[0] + v_gradient[1] + w_gradient[2]);
        [
            volumetric + 2.0 * shear * u_gradient[0],
            volumetric + 2.0 * shear * v_gradient[1],
            volumetric + 2.0 * shear * w_gradient[2],
            shear * (u_gradient[1] + v_gradient[0]),
            shear * (v_gradient[2] + w_gradient[1]),
            shear * (w_gradient[0] + u_gradient[2]),
        ]
    }

    /// Condensed stiffness of the nodes in the first rows, then the equations of the inner modes.
    fn full_stiffness(&self, coordinates: &[[f64; 3]]) -> [[f64; FULL_ORDER]; FULL_ORDER] {
        let lame = self.material.lame();
        let shear = self.material.shear_modulus();
        let center_derivatives = ShapeDerivatives::at([0.0; 3], coordinates);
        let mut matrix = [[0.0; FULL_ORDER]; FULL_ORDER];
        for point in gauss_points() {
            let derivatives = ShapeDerivatives::at(point, coordinates);
            let pattern_derivatives = derivatives.pattern_derivatives(point, &center_derivatives);
            for (i, gradient_i) in pattern_derivatives.iter().enumerate() {
                for (j, gradient_j) in pattern_derivatives.iter().enumerate() {
                    let gradient_product = shear * dot(*gradient_i, *gradient_j);
                    for k in 0..3 {
                        for l in 0..3 {
                            let diagonal = if k == l { gradient_product } else { 0.0 };
                            let integrand = lame * gradient_i[k] * gradient_j[l]
                                + shear * gradient_i[l] * gradient_j[k]
                                + diagonal;
                            matrix[3 * i + k][3 * j + l] += derivatives.determinant * integrand;
                        }
                    }
                }
            }
        }
        condense(&mut matrix, NODAL_ORDER);
        matrix
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
        let full_stiffness = self.full_stiffness(coordinates);
        for (entries, row) in matrix.chunks_exact_mut(NODAL_ORDER).zip(&full_stiffness) {
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
        let mut nodal_mass = [[0.0; 8]; 8];
        // Exact: N_i N_j det J is of fourth degree in each coordinate.
        for (point, weight) in gauss::cube(3) {
            let shape_values = shape_functions(point);
            let point_mass = weight
                * self.material.density()
                * ShapeDerivatives::at(point, coordinates).determinant;
            for (i, row) in nodal_mass.iter_mut().enumerate() {
                for j in 0..8 {
                    let column = if kind == MassKind::Lumped { i } else { j };
                    row[column] += point_mass * shape_values[i] * shape_values[j];
                }
            }
        }
        for (index, entry) in matrix.iter_mut().take(NODAL_ORDER * NODAL_ORDER).enumerate() {
            let row = index / NODAL_ORDER;
            let column = index % NODAL_ORDER;
            if row % 3 == column % 3 {
                *entry += nodal_mass[row / 3][column / 3];
            }
        }
    }

    /// [`Error::Input`](crate::Error::Input) in an [`Error::Item`](crate::Error::Item) unless the Jacobian is positive
    /// at all Gauss points and at the centre; at a corner it may be negative.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length("coordinates of a brick", coordinates.len(), 8)?;
        for point in gauss_points().into_iter().chain([[0.0; 3]]) {
            let determinant = ShapeDerivatives::at(point, coordinates).determinant;
            let quantity = "Jacobian inside the brick";
            let needed = "above zero: lower face counter-clockwise from above, upper face over it";
            require(quantity, determinant, determinant.is_finite() && determinant > 0.0, needed)
                .map_err(|fault| fault.within(format!("brick on nodes {:?}", self.nodes)))?;
        }
        Ok(())
    }
}

/// Natural coordinates (ξ, η, ζ) of the nodes.
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

/// Gauss points of the 2 × 2 × 2 rule in the order of the nodes.
///
/// All weights are 1.
fn gauss_points() -> [[f64; 3]; 8] {
    let gauss_coordinate = gauss::rule(2).nodes[1];
    NODE_COORDINATES.map(|node| node.map(|coordinate| gauss_coordinate * coordinate))
}

/// Trilinear shape functions at (ξ, η, ζ).
fn shape_functions([xi, eta, zeta]: [f64; 3]) -> [f64; 8] {
    NODE_COORDINATES.map(|[a, b, c]| 0.125 * (1.0 + a * xi) * (1.0 + b * eta) * (1.0 + c * zeta))
}

/// Derivatives of the shape functions at a point, and the Jacobian determinant there.
struct ShapeDerivatives {
    /// Derivatives (∂/∂x, ∂/∂y, ∂/∂z) of the eight shape functions, 1/m.
    shape: [[f64; 3]; 8],
    /// Gradients (∂/∂x, ∂/∂y, ∂/∂z) of ξ, η and ζ, times the determinant.
    cofactors: [[f64; 3]; 3],
    /// Determinant of ∂(x, y, z)/∂(ξ, η, ζ).
    determinant: f64,
}

impl ShapeDerivatives {
    /// Derivatives at natural coordinates, for an element with these nodes.
    fn at([xi, eta, zeta]: [f64; 3], coordinates: &[[f64; 3]]) -> Self {
        let natural_derivatives = NODE_COORDINATES.map(|[a, b, c]| {
            let xi_factor = 1.0 + a * xi;
            let eta_factor = 1.0 + b * eta;
            let zeta_factor = 1.0 + c * zeta;
            [
                0.125 * a * eta_factor * zeta_factor,
                0.125 * b * xi_factor * zeta_factor,
                0.125 * c * xi_factor * eta_factor,
            ]
        });
        let tangents: [[f64; 3]; 3] = std::array::from_fn(|k| {
            let nodes = coordinates.iter().zip(&natural_derivatives);
            nodes.fold([0.0; 3], |sum, (&node, derivatives)| add_scaled(sum, derivatives[k], node))
        });
        let cofactors = [
            cross(tangents[1], tangents[2]),
            cross(tangents[2], tangents[0]),
            cross(tangents[0], tangents[1]),
        ];
        let determinant = dot(tangents[0], cofactors[0]);
        let shape = natural_derivatives.map(|derivatives| {
            (0..3).fold([0.0; 3], |sum, k| {
                add_scaled(sum, derivatives[k] / determinant, cofactors[k])
            })
        });
        Self { shape, cofactors, determinant }
    }

    /// Derivatives of the shape functions and of the inner modes at the `point` of this value.
    ///
    /// The modes are 1 − ξ², 1 − η² and 1 − ζ². Their derivatives use the Jacobian at the `center` and are scaled so
    /// that their integral over the element vanishes: a constant stress does no work on them.
    fn pattern_derivatives(&self, point: [f64; 3], center: &Self) -> [[f64; 3]; PATTERN_COUNT] {
        let scale = -2.0 / self.determinant;
        std::array::from_fn(|i| match i.checked_sub(8) {
            None => self.shape[i],
            Some(k) => center.cofactors[k].map(|cofactor| scale * point[k] * cofactor),
        })
    }
}
