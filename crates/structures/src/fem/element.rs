//! Finite elements: the trait, kinds of mass matrices, and faces.

use std::any::Any;

use super::inelastic_force::InelasticForce;
use super::stress_at_rest::StressAtRest;
use crate::error::Result;
use crate::geometry::Direction;

/// Distribution of an element's mass over its degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum MassKind {
    /// Mass distributed by the shape functions of the stiffness: a full matrix.
    #[default]
    Consistent,
    /// Mass at the nodes: a matrix of the same total mass, diagonal in the element's axes.
    ///
    /// Inclined beams in space couple the rotations of a node, and offsets couple rotations with displacements.
    Lumped,
}

words! { pub(crate) MassKind, "kind of mass", {
    Consistent = "consistent",
    Lumped = "lumped",
} }

/// A finite element: implement this for elements of your own.
///
/// Its matrices are dense, row-major and square, of order [`order`](Element::order). The degrees of freedom
/// run through the nodes in the element's order and, within a node, through
/// [`directions`](Element::directions). `coordinates` holds [x, y, z] (m) of each of the element's
/// nodes; in the plane y points up and z is zero.
/// Every matrix is **added to** the buffer; for the matrix alone the caller passes a zeroed buffer.
///
/// Every element is [`Any`], so that an element of a mesh can be downcast to its type.
///
/// ```
/// use basemat::fem::{Direction, Element, MassKind, Mesh};
///
/// /// A massless horizontal spring between two nodes at one height.
/// struct Tie(Vec<usize>);
///
/// impl Element for Tie {
///     fn nodes(&self) -> &[usize] { &self.0 }
///     fn directions(&self) -> &[Direction] { &[Direction::X] }
///     fn stiffness(&self, _coordinates: &[[f64; 3]], matrix: &mut [f64]) {
///         for (entry, k) in matrix.iter_mut().zip([1.0e6, -1.0e6, -1.0e6, 1.0e6]) {
///             *entry += k;
///         }
///     }
///     fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}
/// }
///
/// let mut mesh = Mesh::new();
/// let ends = vec![mesh.add_node(0.0, 0.0)?, mesh.add_node(1.0, 0.0)?];
/// mesh.add(Tie(ends))?;
/// assert_eq!(mesh.elements().next().map(|tie| tie.order()), Some(2));
/// # Ok::<(), basemat::Error>(())
/// ```
#[auto_impl::auto_impl(Box)]
pub trait Element: Any + Send + Sync {
    /// Nodes of the element, as indices into the mesh.
    fn nodes(&self) -> &[usize];

    /// Copy of this element between other nodes, as many as before and in the same order.
    ///
    /// [`Mesh::merge_nodes`](super::Mesh::merge_nodes) calls this method. Default: `None`; the nodes of a mesh with
    /// this element cannot be merged.
    fn with_nodes(&self, _nodes: &[usize]) -> Option<Box<dyn Element>> {
        None
    }

    /// Directions of the element's degrees of freedom, the same at each of its nodes.
    fn directions(&self) -> &[Direction];

    /// Adds the stiffness matrix (N/m, in the plane per metre) to `matrix`.
    ///
    /// It is symmetric; a rigid motion of all nodes must give no force.
    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]);

    /// Force of an element with internal variables, in place of K u.
    ///
    /// Default: `None`, for a linear element.
    ///
    /// [`stiffness`](Element::stiffness) is then the stiffness of small displacements. The static forces of P–Δ use it,
    /// and Rayleigh damping if [`has_stiffness_damping`](Element::has_stiffness_damping), but the force of the element in a
    /// run is the [`InelasticForce`] alone.
    fn inelastic(&self) -> Option<&dyn InelasticForce> {
        None
    }

    /// Whether the stiffness counts in stiffness-proportional damping. Default: yes.
    ///
    /// A stiff element whose force has a limit returns `false`: its viscous force would have none.
    fn has_stiffness_damping(&self) -> bool {
        true
    }

    /// Copy of this element as soil that begins at rest, with these stresses and without weight.
    ///
    /// [`Mesh::with_stress_at_rest`](super::Mesh::with_stress_at_rest) calls this method; [`check`](Element::check) of the
    /// copy returns an error for a stress that the material cannot have. The copy exerts no force at zero displacement, and
    /// its [`is_at_rest`](Element::is_at_rest) returns `true`. Default: `None`, for an element that is no soil.
    fn with_stress_at_rest(&self, _stress: &StressAtRest) -> Option<Box<dyn Element>> {
        None
    }

    /// Whether the element is soil that begins at rest. Default: no.
    ///
    /// Its weight and its stresses at rest are in equilibrium, so that it has inertia, but no weight.
    fn is_at_rest(&self) -> bool {
        false
    }

    /// Adds the geometric stiffness (P–Δ) of the static axial force, N/m.
    ///
    /// In the plane it is per metre. The matrix is symmetric. A translation of all nodes must give no force; a rotation
    /// gives the moment of the axial force at its lever arm. The matrix is part of the structure's stiffness, but not
    /// of its stiffness-proportional damping. [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) adds
    /// the geometric stiffness of the element's other forces, if the element has all displacements. Default: none.
    fn geometric_stiffness(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    /// Copy of this element with the axial force that it has under the structure's weight.
    ///
    /// `displacement` holds the element's degrees of freedom in that static state; `gravity` (m/s²) acts along −y in
    /// the plane and along −z in space. [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) calls
    /// this method. Default: `None`, the element does not change.
    fn in_static_state(
        &self,
        _coordinates: &[[f64; 3]],
        _displacement: &[f64],
        _gravity: f64,
    ) -> Option<Box<dyn Element>> {
        None
    }

    /// Mean compressive axial force of the geometric stiffness, N (negative for tension).
    ///
    /// Default: `None`, for elements that are not bars.
    fn compression(&self) -> Option<f64> {
        None
    }

    /// Adds the mass matrix (kg, in the plane per metre) to `matrix`.
    ///
    /// It is symmetric and positive semi-definite.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]);

    /// Density of the material, kg/m³. Default: `None`, for springs and masses.
    ///
    /// A run warns of an implausible density.
    fn density(&self) -> Option<f64> {
        None
    }

    /// Adds the viscous damping matrix to `matrix`, without Rayleigh damping. Default: none.
    fn damping(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    /// Faces of the element: the sides of a solid, or the shell itself.
    ///
    /// A solid in the plane has one face, its outline. Default: no faces, for bars, springs and masses.
    ///
    /// [`Mesh::add`](super::Mesh::add) returns an error for a second solid on the same corners. Bars and shells may
    /// share all their nodes.
    fn faces(&self) -> Vec<ElementFace> {
        Vec::new()
    }

    /// Whether the element may be in meshes in the plane only.
    ///
    /// Default: `true` for an element with the directions X and Y, but not Z. An element in space with horizontal
    /// displacements only, such as a rubber bearing, returns `false`.
    fn is_plane(&self) -> bool {
        let directions = self.directions();
        directions.contains(&Direction::X)
            && directions.contains(&Direction::Y)
            && !directions.contains(&Direction::Z)
    }

    /// Checks the shape when the element is added to a mesh. Default: any shape is accepted.
    ///
    /// # Errors
    /// Any error, for coordinates at which the element is unusable.
    fn check(&self, _coordinates: &[[f64; 3]]) -> Result<()> {
        Ok(())
    }

    /// Number of the element's degrees of freedom: nodes × directions.
    fn order(&self) -> usize {
        self.nodes().len() * self.directions().len()
    }
}

/// A face of an element: a side of a solid, or a shell.
///
/// Faces define the base of a mesh in space, the areas of pressures, pictures and ParaView's cells.
///
/// ```
/// use basemat::fem::{Element, ElementFace, Material, Quad4, QuadFormulation};
///
/// let material = Material::new(1.0e9, 0.3, 2000.0)?;
/// let quad = Quad4::new([4, 5, 9, 8], material, QuadFormulation::default());
/// assert_eq!(quad.faces(), [ElementFace::side(&[4, 5, 9, 8])]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ElementFace {
    corners: Vec<usize>,
    thickness: f64,
}

impl ElementFace {
    /// Side of a solid between `corners`, counter-clockwise seen from outside.
    ///
    /// In the plane the side is the outline of the solid.
    pub fn side(corners: &[usize]) -> Self {
        Self { corners: corners.to_vec(), thickness: 0.0 }
    }

    /// Shell between `corners`, listed around it; `thickness` in m.
    pub fn shell(corners: &[usize], thickness: f64) -> Self {
        Self { corners: corners.to_vec(), thickness }
    }

    /// Corner nodes, listed around the face.
    pub fn corners(&self) -> &[usize] {
        &self.corners
    }

    /// Thickness of a shell, m; zero for a side of a solid.
    ///
    /// The surfaces of a shell lie half of its thickness above and below the nodes.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Whether the face bounds a solid.
    pub(crate) fn is_side(&self) -> bool {
        self.thickness == 0.0
    }
}
