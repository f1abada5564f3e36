//! A structure whose rigid base has walls up to the surface.

use crate::error::{Error, Result, positive};
use crate::structure::{Base, BaseNode, NonlinearForce, Structure, StructureDescription, Triplets};

/// Embedded structure: its rigid base is at a depth and has walls up to the surface.
///
/// The structure is the same as on the surface, with heights above its base. The ground is a `TrenchGround` of this
/// width and depth. For a flexible base, the structure itself lists the nodes of base and walls: down the left wall,
/// along the base, up the right wall. Needs the feature `embedded`.
///
/// ```
/// use basemat::structure::{RigidBlock, Structure, WithWalls};
///
/// let block = WithWalls::new(RigidBlock::new(12.0, 20.0, 900.0)?, 5.0)?;
/// let base = block.base();
/// let places: Vec<_> = base.nodes().map(|node| [node.x, node.z]).collect();
/// assert_eq!(places, [[-6.0, 0.0], [-6.0, -5.0], [6.0, -5.0], [6.0, 0.0]]);
/// // The upper end of a wall moves by u_x − 5 θ.
/// let displacement = base.nodes().next().unwrap().horizontal.value(&[0.0, 0.0, 1.0]);
/// assert!((displacement + 5.0).abs() < 1e-14);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct WithWalls {
    structure: Box<dyn Structure>,
    nodes: Vec<BaseNode>,
}

short_debug! { WithWalls; self; dofs: self.structure.dofs(), nodes: self.nodes.len() }

impl WithWalls {
    /// Embeds `structure` with its base at a `depth` (m).
    ///
    /// # Errors
    /// [`Error::Input`] for a depth that is not positive; [`Error::Scene`] for a base in space, with several
    /// foundations, with walls, or that is flexible.
    pub fn new(structure: impl Structure + 'static, depth: f64) -> Result<Self> {
        positive("depth of the base", depth)?;
        let unsuitable_base = Error::Scene {
            quantity: "structure",
            needed: "one rigid base in the plane, on the surface",
        };
        let Base::Lines(mut lines) = structure.base() else {
            return Err(unsuitable_base);
        };
        let Some(mut nodes) = lines.pop().filter(|line| lines.is_empty() && line.len() > 1) else {
            return Err(unsuitable_base);
        };
        if !BaseNode::are_flat(&nodes) || nodes.iter().any(|node| node.z != 0.0) {
            return Err(unsuitable_base);
        }
        let left_end = nodes[0].clone();
        let right_end = nodes[nodes.len() - 1].clone();
        let rotation = (1.0 / (right_end.x - left_end.x))
            * (right_end.vertical.clone() - left_end.vertical.clone());
        for node in &mut nodes {
            node.z = -depth;
        }
        let left_top = left_end.horizontal - depth * rotation.clone();
        let right_top = right_end.horizontal - depth * rotation;
        nodes.insert(0, BaseNode { horizontal: left_top, ..left_end });
        nodes.push(BaseNode { horizontal: right_top, ..right_end });
        Ok(Self { structure: Box::new(structure), nodes })
    }

    /// The structure without its walls, with its present internal variables.
    ///
    /// A downcast of it to its type gives access to its results, such as
    /// [`FemModel::solid_points`](crate::structure::FemModel::solid_points).
    pub fn structure(&self) -> &dyn Structure {
        self.structure.as_ref()
    }
}

impl Structure for WithWalls {
    forward! {
        self.structure;
        fn dofs(&self) -> usize;
        fn mass(&self, matrix: &mut Triplets) -> Result<()>;
        fn mass_at_rest(&self) -> Result<Option<Vec<f64>>>;
        fn stiffness(&self, matrix: &mut Triplets) -> Result<()>;
        fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()>;
        fn damping(&self, matrix: &mut Triplets) -> Result<()>;
        fn has_active_damping(&self) -> bool;
        fn has_active_stiffness(&self) -> bool;
        fn description(&self) -> StructureDescription;
        fn describe(&self, dofs: &[usize]) -> Option<String>;
        fn load(&self, time: f64, load: &mut [f64]) -> Result<()>;
        fn nonlinear(&self) -> Option<&dyn NonlinearForce>;
        fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce>;
    }

    fn base(&self) -> Base {
        self.nodes.clone().into()
    }
}
