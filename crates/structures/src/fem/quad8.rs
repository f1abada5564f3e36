//! Eight-node quadrilateral of a solid in plane strain.

use super::element::{Element, MassKind, add_square};
use super::element_face::ElementFace;
use super::material::Material;
use super::quad4::{determinant, integrate_stiffness, strains, tangents};
use crate::error::{Result, require, same_length};
use crate::geometry::{Direction, PLANE_TRANSLATIONS};
use crate::linalg::gauss;

/// Integration of the stiffness of a [`Quad8`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Quad8Integration {
    /// 2 × 2 Gauss points, the default: rectangles bend exactly, and nothing locks as ν → 1/2. A single
    /// element has no stiffness against one pattern, but two neighbours cannot deform in it together.
    #[default]
    Reduced,
    /// 3 × 3 Gauss points: no such pattern; stiffer when distorted or nearly incompressible.
    Full,
}

/// Eight-node plane-strain serendipity quadrilateral, 1 m thick.
///
/// Nodes are the four corners counter-clockwise, then the nodes between the first and second corner, the
/// second and third, and so on. Edges may be curved. At the base, the ground assumes straight lines between
/// neighbouring nodes. There the mid-edge nodes are contact nodes, as the corners are.
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
    material: Material,
    integration: Quad8Integration,
}

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
    pub fn new(nodes: [usize; 8], material: Material) -> Self {
        Self { nodes, material, integration: Quad8Integration::default() }
    }

    /// Replaces the rule of integration.
    #[must_use]
    pub fn with_integration(self, integration: Quad8Integration) -> Self {
        Self { integration, ..self }
    }
}

/// Shape functions at (ξ, η) (Zienkiewicz & Taylor, The Finite Element Method, serendipity family).
fn shape([xi, eta]: [f64; 2]) -> [f64; 8] {
    NODE_COORDINATES.map(|[a, b]| {
        let x = a * xi;
        let y = b * eta;
        if a == 0.0 {
            0.5 * (1.0 - xi * xi) * (1.0 + y)
        } else if b == 0.0 {
            0.5 * (1.0 + x) * (1.0 - eta * eta)
        } else {
            0.25 * (1.0 + x) * (1.0 + y) * (x + y - 1.0)
        }
    })
}

/// Slopes (∂/∂ξ, ∂/∂η) of the shape functions.
fn natural_slopes([xi, eta]: [f64; 2]) -> [[f64; 2]; 8] {
    NODE_COORDINATES.map(|[a, b]| {
        let x = a * xi;
        let y = b * eta;
        if a == 0.0 {
            [-xi * (1.0 + y), 0.5 * b * (1.0 - xi * xi)]
        } else if b == 0.0 {
            [0.5 * a * (1.0 - eta * eta), -eta * (1.0 + x)]
        } else {
            [0.25 * a * (1.0 + y) * (2.0 * x + y), 0.25 * b * (1.0 + x) * (x + 2.0 * y)]
        }
    })
}

/// Slopes (∂/∂x, ∂/∂y) at a point, and the determinant of ∂(x, y)/∂(ξ, η).
fn slopes(point: [f64; 2], coordinates: &[[f64; 3]]) -> ([[f64; 2]; 8], f64) {
    let natural = natural_slopes(point);
    let j = tangents(&natural, coordinates);
    let determinant = determinant(&j);
    let global = natural.map(|[xi, eta]| {
        [(j[1][1] * xi - j[1][0] * eta) / determinant, (j[0][0] * eta - j[0][1] * xi) / determinant]
    });
    (global, determinant)
}

impl Quad8Integration {
    /// Number of Gauss points along a side of the square.
    fn order(self) -> usize {
        match self {
            Self::Reduced => 2,
            Self::Full => 3,
        }
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
        let points = gauss::square(self.integration.order());
        let block = integrate_stiffness(&self.material.elasticity(), points, |point| {
            let (slopes, determinant) = slopes(point, coordinates);
            let strains = slopes.map(strains);
            (std::array::from_fn::<_, 16, _>(|i| strains[i / 2][i % 2]), determinant)
        });
        add_square(matrix, &block);
    }

    fn density(&self) -> Option<f64> {
        Some(self.material.density())
    }

    /// Lumped: the diagonal of the consistent mass, scaled to the mass of the element (Hinton, Rock &
    /// Zienkiewicz 1976). Row sums would be negative at the corners.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let mut nodal_mass = [[0.0; 8]; 8];
        let mut total = 0.0;
        for (point, weight) in gauss::square(Quad8Integration::Full.order()) {
            let shape = shape(point);
            let weight = weight * self.material.density() * slopes(point, coordinates).1;
            total += weight;
            for i in 0..8 {
                for j in 0..8 {
                    nodal_mass[i][j] += weight * shape[i] * shape[j];
                }
            }
        }
        if kind == MassKind::Lumped {
            let diagonal: f64 = (0..8).map(|i| nodal_mass[i][i]).sum();
            let scale = if diagonal > 0.0 { total / diagonal } else { 0.0 };
            for (i, row) in nodal_mass.iter_mut().enumerate() {
                let lumped = scale * row[i];
                row.fill(0.0);
                row[i] = lumped;
            }
        }
        let mut block = [[0.0; 16]; 16];
        for i in 0..8 {
            for j in 0..8 {
                block[2 * i][2 * j] = nodal_mass[i][j];
                block[2 * i + 1][2 * j + 1] = nodal_mass[i][j];
            }
        }
        add_square(matrix, &block);
    }

    /// [`Error::Input`](crate::Error::Input) unless the element's map is regular at its nodes and Gauss points.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length("coordinates of an eight-node quadrilateral", coordinates.len(), 8)?;
        let points = gauss::square(Quad8Integration::Full.order()).map(|(point, _)| point);
        for point in points.chain(NODE_COORDINATES) {
            let value = slopes(point, coordinates).1;
            let quantity = "Jacobian of an eight-node quadrilateral";
            let needed = "above zero: nodes counter-clockwise, those of edges near the middle";
            require(quantity, value, value.is_finite() && value > 0.0, needed)?;
        }
        Ok(())
    }
}
