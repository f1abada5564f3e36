//! Eight-node quadrilateral of a solid in plane strain.

use super::element::{Element, ElementFace, MassKind};
use super::element_matrix::add_matrix;
use super::inelastic_force::InelasticForce;
use super::quad_force::{IntegrationPoint, IntegrationRule, QuadSolid};
use super::quad4::{determinant, integrate_stiffness, jacobian_matrix, plane_strains};
use super::solid::SharedMaterial;
use super::stress_at_rest::StressAtRest;
use crate::error::{Result, require, same_length};
use crate::geometry::{Direction, PLANE_TRANSLATIONS};
use crate::linalg::gauss;

/// Integration of the stiffness, or of the stresses, of a [`Quad8`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Quad8Integration {
    /// 2 × 2 Gauss points, the default.
    ///
    /// Rectangles bend exactly, and no element locks as ν → 1/2.
    ///
    /// A single element has no stiffness against one hourglass pattern. Two neighbouring elements resist it.
    #[default]
    Reduced,
    /// 3 × 3 Gauss points: no hourglass pattern; stiffer if distorted or nearly incompressible.
    Full,
}

/// Eight-node plane-strain serendipity quadrilateral, 1 m thick.
///
/// Nodes are the four corners counter-clockwise, then the nodes between the first and second corner, the
/// second and third, and so on. Edges may be curved. The ground assumes straight lines between neighbouring nodes of
/// the base, whose contact nodes are corners and mid-edge nodes.
///
/// The material is a [`Material`](super::Material), or any [`SolidMaterial`](super::SolidMaterial), such as soil that
/// yields. With an inelastic material the element has internal variables at its integration points.
///
/// ```
/// use basemat::fem::{Element, MassKind, Material, Quad8};
///
/// let material = Material::new(1.0e9, 0.3, 2000.0)?;
/// let quad = Quad8::new([0, 1, 2, 3, 4, 5, 6, 7], material);
/// let nodes = [
///     [0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0],
///     [1.0, 0.0], [2.0, 0.5], [1.0, 1.0], [0.0, 0.5],
/// ].map(|[x, y]| [x, y, 0.0]);
/// let mut mass = vec![0.0; 256];
/// quad.mass(&nodes, MassKind::Consistent, &mut mass);
/// // All entries of one direction sum up to the mass.
/// let total: f64 = (0..8).flat_map(|i| (0..8).map(move |j| (2 * i, 2 * j)))
///     .map(|(i, j)| mass[16 * i + j]).sum();
/// assert!((total - 4000.0).abs() < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Quad8 {
    nodes: [usize; 8],
    solid: QuadSolid<Quad8Integration, DOF_COUNT>,
}

/// Number of degrees of freedom.
const DOF_COUNT: usize = 16;

/// Natural coordinates (ξ, η) of the nodes.
const NODE_COORDINATES: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
];

impl Quad8 {
    /// Quadrilateral between `nodes`, with reduced integration.
    pub fn new(nodes: [usize; 8], material: impl Into<SharedMaterial>) -> Self {
        Self { nodes, solid: QuadSolid::new(material.into(), Quad8Integration::default()) }
    }

    /// Replaces the rule of integration.
    #[must_use]
    pub fn with_integration(self, integration: Quad8Integration) -> Self {
        Self { solid: self.solid.with_rule(integration), ..self }
    }

    /// Replaces the stresses `[xx, yy, zz, xy]` of the undeformed element, Pa; tension is positive.
    ///
    /// They are constant in the element, and their nodal forces act at zero displacement. Adding the element to a mesh
    /// returns an error for a stress that the material cannot have: for a linear elastic material, any stress but zero.
    #[must_use]
    pub fn with_initial_stress(self, stress: [f64; 4]) -> Self {
        Self { solid: self.solid.with_initial_stress(stress), ..self }
    }
}

/// Shape functions at (ξ, η) (Zienkiewicz & Taylor, The Finite Element Method, serendipity family).
fn shape_functions([xi, eta]: [f64; 2]) -> [f64; 8] {
    NODE_COORDINATES.map(|[a, b]| {
        let a_xi = a * xi;
        let b_eta = b * eta;
        if a == 0.0 {
            0.5 * (1.0 - xi * xi) * (1.0 + b_eta)
        } else if b == 0.0 {
            0.5 * (1.0 + a_xi) * (1.0 - eta * eta)
        } else {
            0.25 * (1.0 + a_xi) * (1.0 + b_eta) * (a_xi + b_eta - 1.0)
        }
    })
}

/// Derivatives (∂/∂ξ, ∂/∂η) of the shape functions.
fn natural_derivatives([xi, eta]: [f64; 2]) -> [[f64; 2]; 8] {
    NODE_COORDINATES.map(|[a, b]| {
        let a_xi = a * xi;
        let b_eta = b * eta;
        if a == 0.0 {
            [-xi * (1.0 + b_eta), 0.5 * b * (1.0 - xi * xi)]
        } else if b == 0.0 {
            [0.5 * a * (1.0 - eta * eta), -eta * (1.0 + a_xi)]
        } else {
            [
                0.25 * a * (1.0 + b_eta) * (2.0 * a_xi + b_eta),
                0.25 * b * (1.0 + a_xi) * (a_xi + 2.0 * b_eta),
            ]
        }
    })
}

/// Derivatives (∂/∂x, ∂/∂y) of the shape functions at a point, and the Jacobian determinant.
fn global_derivatives(point: [f64; 2], coordinates: &[[f64; 3]]) -> ([[f64; 2]; 8], f64) {
    let local_derivatives = natural_derivatives(point);
    let j = jacobian_matrix(&local_derivatives, coordinates);
    let determinant = determinant(&j);
    let derivatives = local_derivatives.map(|[xi, eta]| {
        [(j[1][1] * xi - j[1][0] * eta) / determinant, (j[0][0] * eta - j[0][1] * xi) / determinant]
    });
    (derivatives, determinant)
}

impl Quad8Integration {
    /// Number of Gauss points along each natural coordinate.
    fn points_per_axis(self) -> usize {
        match self {
            Self::Reduced => 2,
            Self::Full => 3,
        }
    }
}

impl IntegrationRule<DOF_COUNT> for Quad8Integration {
    fn point_count(self) -> usize {
        self.points_per_axis().pow(2)
    }

    fn visit_points(
        self,
        coordinates: &[[f64; 3]],
        mut visit: impl FnMut(&IntegrationPoint<DOF_COUNT>) -> Result<()>,
    ) -> Result<()> {
        for (index, (natural_point, weight)) in gauss::square(self.points_per_axis()).enumerate() {
            let (derivatives, determinant) = global_derivatives(natural_point, coordinates);
            let mut strains = [[0.0; 4]; DOF_COUNT];
            for ([dx, dy], columns) in derivatives.into_iter().zip(strains.chunks_exact_mut(2)) {
                columns[0] = [dx, 0.0, 0.0, dy];
                columns[1] = [0.0, dy, 0.0, dx];
            }
            let area = weight * determinant;
            let has_derivatives = true;
            visit(&IntegrationPoint { index, natural_point, area, strains, has_derivatives })?;
        }
        Ok(())
    }

    fn node_weights(self, natural_point: [f64; 2]) -> impl IntoIterator<Item = f64> {
        shape_functions(natural_point)
    }
}

impl Element for Quad8 {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        Some(Box::new(Self { nodes: nodes.try_into().ok()?, ..self.clone() }))
    }

    fn directions(&self) -> &[Direction] {
        PLANE_TRANSLATIONS
    }

    fn faces(&self) -> Vec<ElementFace> {
        vec![ElementFace::side(&self.nodes[..4])]
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(material) = self.solid.material.elastic() else {
            return self.solid.add_small_strain_stiffness(coordinates, matrix);
        };
        let points = gauss::square(self.solid.rule.points_per_axis());
        let element_matrix = integrate_stiffness(&material.elasticity(), points, |point| {
            let (derivatives, determinant) = global_derivatives(point, coordinates);
            let column_pairs = derivatives.map(plane_strains);
            (std::array::from_fn::<_, DOF_COUNT, _>(|i| column_pairs[i / 2][i % 2]), determinant)
        });
        add_matrix(matrix, &element_matrix);
    }

    fn inelastic(&self) -> Option<&dyn InelasticForce> {
        self.solid.inelastic()
    }

    fn with_stress_at_rest(&self, stress: &StressAtRest) -> Option<Box<dyn Element>> {
        let solid = self.solid.clone().with_stress_at_rest(stress);
        Some(Box::new(Self { solid, ..self.clone() }))
    }

    fn is_at_rest(&self) -> bool {
        self.solid.is_at_rest()
    }

    fn density(&self) -> Option<f64> {
        Some(self.solid.material.law().density())
    }

    /// Lumped: the diagonal of the consistent mass, scaled to the mass of the element.
    ///
    /// The method is due to Hinton, Rock & Zienkiewicz (1976). Row sums would be negative at the corners.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let density = self.solid.material.law().density();
        let mut nodal_mass = [[0.0; 8]; 8];
        let mut total_mass = 0.0;
        for (point, weight) in gauss::square(Quad8Integration::Full.points_per_axis()) {
            let shape_values = shape_functions(point);
            let point_mass = weight * density * global_derivatives(point, coordinates).1;
            total_mass += point_mass;
            for i in 0..8 {
                for j in 0..8 {
                    nodal_mass[i][j] += point_mass * shape_values[i] * shape_values[j];
                }
            }
        }
        if kind == MassKind::Lumped {
            let diagonal_sum: f64 = (0..8).map(|i| nodal_mass[i][i]).sum();
            let scale = if diagonal_sum > 0.0 { total_mass / diagonal_sum } else { 0.0 };
            for (i, row) in nodal_mass.iter_mut().enumerate() {
                let lumped_mass = scale * row[i];
                row.fill(0.0);
                row[i] = lumped_mass;
            }
        }
        let mut element_matrix = [[0.0; 16]; 16];
        for i in 0..8 {
            for j in 0..8 {
                element_matrix[2 * i][2 * j] = nodal_mass[i][j];
                element_matrix[2 * i + 1][2 * j + 1] = nodal_mass[i][j];
            }
        }
        add_matrix(matrix, &element_matrix);
    }

    /// [`Error::Input`](crate::Error::Input) unless the Jacobian is positive at the nodes and Gauss points.
    ///
    /// Also errors of the initial stress.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length("coordinates of an eight-node quadrilateral", coordinates.len(), 8)?;
        let points =
            gauss::square(Quad8Integration::Full.points_per_axis()).map(|(point, _)| point);
        for point in points.chain(NODE_COORDINATES) {
            let determinant = global_derivatives(point, coordinates).1;
            let quantity = "Jacobian of an eight-node quadrilateral";
            let needed = "above zero: nodes counter-clockwise, those of edges near the middle";
            require(quantity, determinant, determinant.is_finite() && determinant > 0.0, needed)?;
        }
        self.solid.check_initial_stress(coordinates)
    }
}
