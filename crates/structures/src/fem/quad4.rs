//! Four-node quadrilateral of a solid in plane strain.

use super::element::{Element, ElementFace, MassKind};
use super::element_matrix::{add_matrix, condense, leading_block};
use super::inelastic_force::InelasticForce;
use super::quad_force::QuadSolid;
use super::solid::SharedMaterial;
use super::stress_at_rest::StressAtRest;
use crate::error::{Result, require, require_part, same_length};
use crate::geometry::{Direction, PLANE_TRANSLATIONS};
use crate::linalg::gauss;

/// Formulation of the stiffness of a [`Quad4`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum QuadFormulation {
    /// 2 × 2 Gauss points.
    ///
    /// The element is far too stiff in bending (shear locking) and as ν → 1/2.
    Full,
    /// 2 × 2 Gauss points and two internal bending modes. The default.
    ///
    /// The bending modes are corrected so that distorted elements pass the patch test (QM6: Taylor, Beresford
    /// & Wilson, 1976). Rectangles bend exactly, and nothing locks as ν → 1/2.
    #[default]
    IncompatibleModes,
    /// One point at the centre: constant strain, as in Patel & Spyrakos.
    ///
    /// The element has no stiffness against the two hourglass patterns (nodes moving +, −, +, − in x or in
    /// y). A mesh of these elements is too flexible in bending, and is a mechanism unless its mass or its
    /// neighbours restrain it. On a rectangle, `IncompatibleModes` is this element plus the hourglass
    /// stiffness that makes bending exact.
    OnePoint,
    /// [`OnePoint`](Self::OnePoint) with a percentage of the hourglass stiffness of `Full`.
    ///
    /// Flanagan & Belytschko (1981) use about 5 %. A value of 0 gives `OnePoint`, and 100 gives `Full`. The stiffness
    /// against constant strains does not depend on the percentage.
    Hourglass {
        /// Hourglass stiffness, in per cent of the hourglass stiffness of `Full`.
        percent: u8,
    },
    /// 2 × 2 Gauss points, each with the mean dilatation of the element.
    ///
    /// This is the B-bar element (Hughes 1980, IJNME 15, 1413–1418). Nothing locks as ν → 1/2. A cantilever with two
    /// elements over its depth deflects 4 to 8 % too far, with four elements less than 1 %. This is the only
    /// formulation for inelastic materials.
    MeanDilatation,
}

impl QuadFormulation {
    /// Usual formulation of a material: the mean dilatation for an inelastic one, otherwise the default.
    pub fn for_material(material: &SharedMaterial) -> Self {
        if material.elastic().is_some() { Self::default() } else { Self::MeanDilatation }
    }
}

/// Plane-strain quadrilateral with nodes counter-clockwise, 1 m thick.
///
/// The material is a [`Material`](super::Material), or any [`SolidMaterial`](super::SolidMaterial) with the formulation
/// [`QuadFormulation::MeanDilatation`]; a mesh returns an error for another formulation. An inelastic element has
/// internal variables at its integration points. [`Quad8`](super::Quad8) bends far better.
///
/// ```
/// use basemat::fem::{Element, MassKind, Material, Quad4, QuadFormulation};
///
/// let material = Material::new(1.0e9, 0.3, 2000.0)?;
/// let quad = Quad4::new([0, 1, 2, 3], material, QuadFormulation::Full);
/// let corners = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mut mass = vec![0.0; 64];
/// quad.mass(&corners, MassKind::Lumped, &mut mass);
/// assert!((mass[0] - 1000.0).abs() < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Quad4 {
    nodes: [usize; 4],
    solid: QuadSolid<QuadFormulation, DOF_COUNT>,
}

/// Number of degrees of freedom of the nodes.
pub(super) const DOF_COUNT: usize = 8;
/// Number of degrees of freedom of the nodes, and of the two bending modes along x and y.
const FULL_DOF_COUNT: usize = 12;
/// Weight of the rule with one point: the area of the square −1 ≤ ξ, η ≤ 1.
const ONE_POINT_WEIGHT: f64 = 4.0;

/// Strains due to a displacement along x, and due to an equal displacement along y.
///
/// They are `[ε_xx, ε_yy, γ_xy]`.
///
/// The argument holds the derivatives (∂/∂x, ∂/∂y) of the displacement: those of a shape function.
pub(super) fn plane_strains([dx, dy]: [f64; 2]) -> [[f64; 3]; 2] {
    [[dx, 0.0, dy], [0.0, dy, dx]]
}

impl Quad4 {
    /// Quadrilateral between `nodes`, which run counter-clockwise.
    pub fn new(
        nodes: [usize; 4],
        material: impl Into<SharedMaterial>,
        formulation: QuadFormulation,
    ) -> Self {
        Self { nodes, solid: QuadSolid::new(material.into(), formulation) }
    }

    /// Replaces the stresses `[xx, yy, zz, xy]` of the undeformed element, Pa; tension is positive.
    ///
    /// As [`Quad8::with_initial_stress`](super::Quad8::with_initial_stress).
    #[must_use]
    pub fn with_initial_stress(self, stress: [f64; 4]) -> Self {
        Self { solid: self.solid.with_initial_stress(stress), ..self }
    }

    /// Stiffness from integration points of equal `weight`.
    fn integrated_stiffness<const N: usize>(
        elasticity: &[[f64; 3]; 3],
        points: [[f64; 2]; N],
        weight: f64,
        coordinates: &[[f64; 3]],
    ) -> [[f64; 8]; 8] {
        let weighted_points = points.into_iter().map(|point| (point, weight));
        integrate_stiffness(elasticity, weighted_points, |point| {
            let jacobian = Jacobian::at(point, coordinates);
            (node_strains(point, &jacobian), jacobian.determinant)
        })
    }

    /// Stiffness of the nodes after condensation of the two bending modes.
    fn stiffness_with_bending_modes(
        elasticity: &[[f64; 3]; 3],
        coordinates: &[[f64; 3]],
    ) -> [[f64; 8]; 8] {
        let center_jacobian = Jacobian::at([0.0; 2], coordinates);
        let weighted_points = gauss_points().into_iter().map(|point| (point, 1.0));
        let mut full_stiffness = integrate_stiffness(elasticity, weighted_points, |point| {
            let jacobian = Jacobian::at(point, coordinates);
            let mut strains = [[0.0; 3]; FULL_DOF_COUNT];
            strains[..DOF_COUNT].copy_from_slice(&node_strains(point, &jacobian));
            // Derivatives of the modes 1 − ξ² and 1 − η² from the Jacobian at the centre. They are scaled so that the
            // integral of their strains over the element vanishes: a constant stress does no work in these modes.
            let scale = -2.0 * center_jacobian.determinant / jacobian.determinant;
            let xi_mode_strains =
                plane_strains(center_jacobian.global_derivatives([scale * point[0], 0.0]));
            let eta_mode_strains =
                plane_strains(center_jacobian.global_derivatives([0.0, scale * point[1]]));
            strains[DOF_COUNT..DOF_COUNT + 2].copy_from_slice(&xi_mode_strains);
            strains[DOF_COUNT + 2..].copy_from_slice(&eta_mode_strains);
            (strains, jacobian.determinant)
        });
        condense(&mut full_stiffness, DOF_COUNT);
        leading_block(&full_stiffness)
    }
}

/// Stiffness ∫ Sᵀ D S of N displacement patterns, from integration points and their weights.
///
/// D = `elasticity`; `strains` returns the strains S of the patterns at a point, and the Jacobian determinant there.
pub(super) fn integrate_stiffness<const N: usize, const S: usize>(
    elasticity: &[[f64; S]; S],
    points: impl Iterator<Item = ([f64; 2], f64)>,
    strains: impl Fn([f64; 2]) -> ([[f64; S]; N], f64),
) -> [[f64; N]; N] {
    let mut matrix = [[0.0; N]; N];
    for (point, weight) in points {
        let (pattern_strains, determinant) = strains(point);
        add_point_stiffness(&mut matrix, &pattern_strains, elasticity, weight * determinant);
    }
    matrix
}

/// Adds the stiffness Sᵀ D S of N displacement patterns times an `area` to `matrix`.
///
/// S = `strains`, D = `elasticity`.
pub(super) fn add_point_stiffness<const N: usize, const S: usize>(
    matrix: &mut [[f64; N]; N],
    strains: &[[f64; S]; N],
    elasticity: &[[f64; S]; S],
    area: f64,
) {
    let stresses = strains.map(|column| elasticity.map(|row| inner_product(&row, &column)));
    for i in 0..N {
        for j in 0..N {
            matrix[i][j] += area * inner_product(&strains[i], &stresses[j]);
        }
    }
}

fn inner_product<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Strains due to a unit displacement of each node along x, then along y.
fn node_strains(point: [f64; 2], jacobian: &Jacobian) -> [[f64; 3]; 8] {
    let column_pairs = jacobian.shape_derivatives(point).map(plane_strains);
    std::array::from_fn(|i| column_pairs[i / 2][i % 2])
}

impl Element for Quad4 {
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
        vec![ElementFace::side(&self.nodes)]
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(material) = self.solid.material.elastic() else {
            return self.solid.add_small_strain_stiffness(coordinates, matrix);
        };
        let elasticity = &material.elasticity();
        let element_matrix = match self.solid.rule {
            QuadFormulation::Full => {
                Self::integrated_stiffness(elasticity, gauss_points(), 1.0, coordinates)
            }
            QuadFormulation::OnePoint => {
                Self::integrated_stiffness(elasticity, [[0.0; 2]], ONE_POINT_WEIGHT, coordinates)
            }
            QuadFormulation::IncompatibleModes => {
                Self::stiffness_with_bending_modes(elasticity, coordinates)
            }
            QuadFormulation::Hourglass { percent } => {
                let fraction = f64::from(percent) / 100.0;
                let full_integration =
                    Self::integrated_stiffness(elasticity, gauss_points(), 1.0, coordinates);
                let mut stiffness = Self::integrated_stiffness(
                    elasticity,
                    [[0.0; 2]],
                    ONE_POINT_WEIGHT,
                    coordinates,
                );
                for (entry, full_entry) in
                    stiffness.iter_mut().flatten().zip(full_integration.as_flattened())
                {
                    *entry += fraction * (full_entry - *entry);
                }
                stiffness
            }
            QuadFormulation::MeanDilatation => {
                return self.solid.add_small_strain_stiffness(coordinates, matrix);
            }
        };
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

    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let density = self.solid.material.law().density();
        let mut element_matrix = [[0.0; 8]; 8];
        // Exact: N_i N_j det J is of third degree in ξ and in η.
        for point in gauss_points() {
            let point_mass = density * Jacobian::at(point, coordinates).determinant;
            let shape_values = shape_functions(point);
            for i in 0..4 {
                for j in 0..4 {
                    let product = point_mass * shape_values[i] * shape_values[j];
                    let column = if kind == MassKind::Lumped { i } else { j };
                    for axis in 0..2 {
                        element_matrix[2 * i + axis][2 * column + axis] += product;
                    }
                }
            }
        }
        add_matrix(matrix, &element_matrix);
    }

    /// [`Error::Input`](crate::Error::Input) unless the quadrilateral is convex and its nodes run counter-clockwise.
    ///
    /// [`Error::Scene`](crate::Error::Scene) for an inelastic material with a formulation other than
    /// [`QuadFormulation::MeanDilatation`]. Also errors of the initial stress.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length("coordinates of a quadrilateral", coordinates.len(), 4)?;
        for corner in NODE_COORDINATES {
            let determinant = Jacobian::at(corner, coordinates).determinant;
            let quantity = "Jacobian at a corner of a quadrilateral";
            let needed = "above zero: convex, nodes counter-clockwise";
            require(quantity, determinant, determinant.is_finite() && determinant > 0.0, needed)?;
        }
        require_part(
            "four-node quadrilateral of an inelastic material",
            self.solid.material.elastic().is_some()
                || self.solid.rule == QuadFormulation::MeanDilatation,
            "its formulation must be QuadFormulation::MeanDilatation",
        )?;
        self.solid.check_initial_stress(coordinates)
    }
}

/// Natural coordinates (ξ, η) of the four nodes, counter-clockwise.
pub(super) const NODE_COORDINATES: [[f64; 2]; 4] =
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Gauss points of the 2 × 2 rule in the order of the corners.
///
/// All weights are 1.
pub(super) fn gauss_points() -> [[f64; 2]; 4] {
    let gauss_coordinate = gauss::rule(2).nodes[1];
    NODE_COORDINATES.map(|[xi, eta]| [gauss_coordinate * xi, gauss_coordinate * eta])
}

/// Bilinear shape functions at (ξ, η).
pub(super) fn shape_functions([xi, eta]: [f64; 2]) -> [f64; 4] {
    NODE_COORDINATES.map(|[a, b]| 0.25 * (1.0 + a * xi) * (1.0 + b * eta))
}

/// Jacobian ∂(x, y)/∂(ξ, η) at a point: its inverse transpose and determinant.
pub(super) struct Jacobian {
    /// Rows: ∂ξ/∂x, ∂η/∂x; ∂ξ/∂y, ∂η/∂y.
    inverse_transpose: [[f64; 2]; 2],
    pub(super) determinant: f64,
}

impl Jacobian {
    /// Jacobian of an element with these nodes at a point (ξ, η).
    pub(super) fn at<const D: usize>(point: [f64; 2], coordinates: &[[f64; D]]) -> Self {
        let j = jacobian_matrix(&natural_derivatives(point), coordinates);
        let determinant = determinant(&j);
        let inverse_transpose = [
            [j[1][1] / determinant, -j[1][0] / determinant],
            [-j[0][1] / determinant, j[0][0] / determinant],
        ];
        Self { inverse_transpose, determinant }
    }

    /// Derivatives (∂/∂x, ∂/∂y) from derivatives (∂/∂ξ, ∂/∂η).
    pub(super) fn global_derivatives(&self, natural_gradient: [f64; 2]) -> [f64; 2] {
        self.inverse_transpose
            .map(|row| row[0] * natural_gradient[0] + row[1] * natural_gradient[1])
    }

    /// Derivatives (∂/∂x, ∂/∂y) of the four shape functions at `point`, the point of this Jacobian.
    pub(super) fn shape_derivatives(&self, point: [f64; 2]) -> [[f64; 2]; 4] {
        natural_derivatives(point).map(|derivatives| self.global_derivatives(derivatives))
    }
}

/// Jacobian matrix ∂(x, y)/∂(ξ, η) from the derivatives (∂/∂ξ, ∂/∂η) of the shape functions.
pub(super) fn jacobian_matrix<const D: usize>(
    natural_derivatives: &[[f64; 2]],
    coordinates: &[[f64; D]],
) -> [[f64; 2]; 2] {
    let mut j = [[0.0; 2]; 2];
    for (derivatives, node) in natural_derivatives.iter().zip(coordinates) {
        for axis in 0..2 {
            j[axis][0] += derivatives[0] * node[axis];
            j[axis][1] += derivatives[1] * node[axis];
        }
    }
    j
}

/// Determinant of a matrix of order 2.
pub(super) fn determinant(j: &[[f64; 2]; 2]) -> f64 {
    j[0][0] * j[1][1] - j[0][1] * j[1][0]
}

/// Derivatives (∂/∂ξ, ∂/∂η) of the shape functions.
pub(super) fn natural_derivatives([xi, eta]: [f64; 2]) -> [[f64; 2]; 4] {
    NODE_COORDINATES.map(|[a, b]| [0.25 * a * (1.0 + b * eta), 0.25 * b * (1.0 + a * xi)])
}
