//! The base of a structure: foundations in the plane, or faces in space.

use super::BaseNode;
use crate::error::{Result, at_least};

/// Base of a structure: lines of nodes in the plane, or faces in space.
///
/// One line is the usual case in the plane: `[left, right].into()`, or `.into()` after
/// [`BaseNode::rigid_base`].
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Base {
    /// Foundations in the plane, from left to right; each lists its nodes from left to right.
    ///
    /// The base is straight between neighbouring nodes. Between two foundations there is no base. A rigid
    /// foundation needs two nodes, its ends.
    Lines(Vec<Vec<BaseNode>>),
    /// Faces of a structure in space.
    ///
    /// Faces are triangles or other convex polygons, each given by its corners in either sense of rotation. They are
    /// flat, at one height, and do not overlap. The base is flat over a triangle and bilinear over a quadrilateral; a
    /// polygon of more corners is divided into triangles from its first corner. A rigid base needs one face, its
    /// outline. Faces that share a corner, or have a corner on the other's edge, belong to one foundation; other faces
    /// are foundations of their own.
    Faces(Vec<Vec<BaseNode>>),
}

impl Base {
    /// All nodes: line by line, or the corners face by face.
    ///
    /// ```
    /// use basemat::structure::{Base, BaseNode, RigidBlock, Structure};
    ///
    /// let base: Base = BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]).into();
    /// assert_eq!(base, RigidBlock::new(6.0, 4.0, 2400.0)?.base());
    /// assert_eq!(base.nodes().map(|node| node.x).collect::<Vec<_>>(), [-3.0, 3.0]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn nodes(&self) -> impl Iterator<Item = &BaseNode> + Clone {
        self.parts().iter().flatten()
    }

    /// The lines in the plane or the faces in space.
    #[doc(hidden)]
    pub fn parts(&self) -> &[Vec<BaseNode>] {
        let (Self::Lines(parts) | Self::Faces(parts)) = self;
        parts
    }

    /// All nodes, to move or renumber them.
    pub(crate) fn nodes_mut(&mut self) -> impl Iterator<Item = &mut BaseNode> {
        let (Self::Lines(parts) | Self::Faces(parts)) = self;
        parts.iter_mut().flatten()
    }

    /// All nodes, in the order of [`nodes`](Base::nodes).
    #[doc(hidden)]
    pub fn into_nodes(self) -> Vec<BaseNode> {
        let (Self::Lines(parts) | Self::Faces(parts)) = self;
        parts.into_iter().flatten().collect()
    }

    /// Returns an error for too few nodes, or an invalid node.
    ///
    /// Coordinates and weights must be finite, and degrees of freedom below `dof_count`.
    #[doc(hidden)]
    pub fn check(&self, dof_count: usize) -> Result<()> {
        at_least("list of contact nodes", self.nodes().count(), 2)?;
        self.nodes().try_for_each(|node| node.check(dof_count))
    }
}

/// One foundation in the plane, its nodes from left to right.
impl From<Vec<BaseNode>> for Base {
    fn from(nodes: Vec<BaseNode>) -> Self {
        Self::Lines(vec![nodes])
    }
}

/// One foundation in the plane, its nodes from left to right.
impl<const N: usize> From<[BaseNode; N]> for Base {
    fn from(nodes: [BaseNode; N]) -> Self {
        Vec::from(nodes).into()
    }
}
