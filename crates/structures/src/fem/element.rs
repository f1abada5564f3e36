//! Finite elements: the trait, and the kinds of mass matrices.

use std::any::Any;

use super::element_face::ElementFace;
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

/// A finite element: implement this for your elements.
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
/// /// A weightless spring that holds two points of the same height together.
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

    /// This element between other nodes, as many as before and in the same order.
    ///
    /// Called by [`Mesh::merge_nodes`](super::Mesh::merge_nodes). Default: `None`, the element cannot be renumbered,
    /// and a mesh with it cannot be merged.
    fn with_nodes(&self, _nodes: &[usize]) -> Option<Box<dyn Element>> {
        None
    }

    /// Directions of the element's degrees of freedom, the same at each of its nodes.
    fn directions(&self) -> &[Direction];

    /// Adds the stiffness matrix (N/m, in the plane per metre) to `matrix`.
    ///
    /// It is symmetric; a rigid motion of all nodes must give no force.
    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]);

    /// Adds the geometric stiffness (P–Δ) of the static axial force, N/m.
    ///
    /// In the plane it is per metre.
    ///
    /// Symmetric. A translation of all nodes must give no force; a rotation gives the moment of the offset
    /// force. The matrix is part of the structure's stiffness, but not of its stiffness-proportional damping.
    /// [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) adds what the other forces of the element give in
    /// a rotation, if the element moves in all directions. Default: none.
    fn geometric_stiffness(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    /// This element with the geometric stiffness of the static state under the structure's weight.
    ///
    /// `displacement` holds the element's degrees of freedom in that state; `gravity` (m/s²) acts downwards, along −y
    /// in the plane and along −z in space.
    /// Called by [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta). Default: `None`, the
    /// element does not change.
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
    /// A run warns of a density that no material has.
    fn density(&self) -> Option<f64> {
        None
    }

    /// Adds the viscous damping matrix to `matrix`, without Rayleigh damping. Default: none.
    fn damping(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    /// Faces of the element: the sides of a solid, or the shell itself.
    ///
    /// A solid in the plane has one face, its outline. Default: none, for bars, springs and masses.
    ///
    /// [`Mesh::add`](super::Mesh::add) returns an error for a second solid on the same corners. Bars and shells may
    /// share all their nodes.
    fn faces(&self) -> Vec<ElementFace> {
        Vec::new()
    }

    /// Whether the element fits meshes in the plane only.
    ///
    /// Default: yes, if it has the directions X and Y, but not Z. An element in space that moves horizontally only,
    /// such as a rubber bearing, returns `false`.
    fn is_plane(&self) -> bool {
        let directions = self.directions();
        directions.contains(&Direction::X)
            && directions.contains(&Direction::Y)
            && !directions.contains(&Direction::Z)
    }

    /// Checks the shape when the element is added to a mesh. Default: any shape is accepted.
    ///
    /// # Errors
    /// Any error that makes the element unusable at these coordinates.
    fn check(&self, _coordinates: &[[f64; 3]]) -> Result<()> {
        Ok(())
    }

    /// Number of the element's degrees of freedom: nodes × directions.
    fn order(&self) -> usize {
        self.nodes().len() * self.directions().len()
    }
}

/// Adds a square block to a row-major `matrix` of the same order.
pub(crate) fn add_square<const N: usize>(matrix: &mut [f64], block: &[[f64; N]; N]) {
    for (entry, value) in matrix.iter_mut().zip(block.iter().flatten()) {
        *entry += value;
    }
}

/// Adds Tᵀ k T of a `local` matrix k.
///
/// T = `to_local` transforms global to local displacements.
pub(crate) fn add_transformed<const N: usize>(
    local: &[[f64; N]; N],
    to_local: &[[f64; N]; N],
    matrix: &mut [f64],
) {
    let mut local_times_transformation = [[0.0; N]; N];
    let mut global = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            local_times_transformation[i][j] = (0..N).map(|k| local[i][k] * to_local[k][j]).sum();
        }
    }
    for i in 0..N {
        for j in 0..N {
            global[i][j] = (0..N).map(|k| to_local[k][i] * local_times_transformation[k][j]).sum();
        }
    }
    add_square(matrix, &global);
}
