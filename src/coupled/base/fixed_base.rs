//! The fixed base: rigid foundations on an almost rigid ground.
//!
//! | symbol | meaning |
//! |---|---|
//! | N | displacements of a foundation's contact nodes |
//! | Q | orthonormal rigid motions of these nodes |
//! | γ | stiffness of the springs between the nodes of a foundation |

use crate::bem::{DiagonalCompliance, Ground};
use crate::coupled::base::joint_line::JointLine;
use crate::coupled::base::{PlacedBase, dofs_of};
use crate::error::{Observer, Result, same_length};
use crate::geometry::{ContactElement, Patch};
use crate::linalg::{dot, largest};
use crate::structure::{
    Base, BaseNode, MassAndStiffness, NonlinearForce, SpringSupportedBase, Structure, Triplets,
    mass_and_stiffness, max_diagonal_stiffness,
};

/// Stiffness of the almost rigid ground, relative to 4 m/Δt².
///
/// This is the resistance of the structure's mass m in a step.
const FIXED_GROUND_STIFFNESS_RATIO: f64 = 1e6;
/// Stiffness that makes foundations rigid, relative to the structure's largest stiffness.
const RIGID_FOUNDATION_STIFFNESS_RATIO: f64 = 1e5;
/// Fraction of a displacement, or of the norm of a motion, that counts as rounding.
const RIGID_MOTION_TOLERANCE: f64 = 1e-9;

/// The structure with rigid foundations, and an almost rigid ground under it.
pub(crate) fn on_fixed_base(
    structure: Box<dyn Structure>,
    elements: &Patch,
    joints: &[JointLine],
    time_step: f64,
) -> Result<(Box<dyn Structure>, Box<dyn Ground>)> {
    let base = PlacedBase::of(structure.as_ref(), elements, joints)?;
    let dofs = structure.dofs();
    let MassAndStiffness { mass, stiffness } = mass_and_stiffness(structure.as_ref())?;
    let springs =
        SpringSupportedBase::new(base.nodes(), &stiffness, max_diagonal_stiffness(&stiffness));
    // Forces of the springs for a unit translation to the right, and then the translation itself.
    let mut translation = springs.translation_forces().swap_remove(0);
    // Without a factor the assembly later returns an error that names the mechanism.
    if let Ok(mut factor) = springs.factor() {
        factor.solve(&mut translation);
    }
    let total_area: f64 = elements.areas().iter().sum();
    let resistance = 4.0 * mass.form(&translation, &translation) / (time_step * time_step);
    // The reference of a massless structure is its stiffness.
    let has_inertia = resistance > 0.0 && resistance.is_finite();
    let resistance = if has_inertia { resistance } else { max_diagonal_stiffness(&stiffness) };
    let ground = FixedGround {
        elements: elements.clone(),
        compliance: total_area / (FIXED_GROUND_STIFFNESS_RATIO * resistance),
    };
    let mut foundation_stiffness = Triplets::new(dofs);
    for (nodes, _) in base.foundations() {
        add_rigid_foundation(
            nodes,
            RIGID_FOUNDATION_STIFFNESS_RATIO * max_diagonal_stiffness(&stiffness),
            &mut foundation_stiffness,
        );
    }
    let structure: Box<dyn Structure> = if foundation_stiffness.entries().is_empty() {
        structure
    } else {
        Box::new(StructureOnRigidFoundations { structure, foundation_stiffness })
    };
    Ok((structure, Box::new(ground)))
}

/// The structure that the builder received, without the stiffness that makes its foundations rigid.
pub(crate) fn without_rigid_foundations(structure: &dyn Structure) -> &dyn Structure {
    let wrapper: &dyn std::any::Any = structure;
    wrapper
        .downcast_ref::<StructureOnRigidFoundations>()
        .map_or(structure, |wrapper| wrapper.structure.as_ref())
}

/// The structure that the builder received, by value.
pub(crate) fn into_structure(mut structure: Box<dyn Structure>) -> Box<dyn Structure> {
    let wrapper: &mut dyn std::any::Any = structure.as_mut();
    match wrapper.downcast_mut::<StructureOnRigidFoundations>() {
        Some(wrapper) => std::mem::replace(&mut wrapper.structure, Box::new(NoStructure)),
        None => structure,
    }
}

/// Whether the ground belongs to a fixed base.
pub(crate) fn is_fixed_base(ground: &dyn Ground) -> bool {
    let ground: &dyn std::any::Any = ground;
    ground.is::<FixedGround>()
}

/// Adds the stiffness γ Nᵀ (1 − Q Qᵀ) N, which makes a foundation rigid.
///
/// It resists all motions of the nodes except rigid ones.
fn add_rigid_foundation(nodes: &[BaseNode], spring: f64, matrix: &mut Triplets) {
    let Some(direction_count) = nodes.first().map(BaseNode::direction_count) else {
        return;
    };
    let rigid_motions = rigid_motions(nodes, direction_count);
    let rows: Vec<_> =
        nodes.iter().flat_map(|node| node.rows().into_iter().take(direction_count)).collect();
    let dofs = dofs_of(nodes);
    let dense_row = |row: usize| {
        let mut values = vec![0.0; dofs.len()];
        for &(dof, weight) in rows[row] {
            if let Ok(index) = dofs.binary_search(&dof) {
                values[index] += weight;
            }
        }
        values
    };
    // Qᵀ N, a row for each rigid motion.
    let mut rigid_rows: Vec<Vec<f64>> = Vec::with_capacity(rigid_motions.len());
    for motion in &rigid_motions {
        let mut sum = vec![0.0; dofs.len()];
        for (row, factor) in motion.iter().enumerate() {
            sum.iter_mut().zip(dense_row(row)).for_each(|(sum, x)| *sum += factor * x);
        }
        rigid_rows.push(sum);
    }
    for row in 0..rows.len() {
        let mut values = dense_row(row);
        let max_weight = largest(&values);
        for (motion, rigid_row) in rigid_motions.iter().zip(&rigid_rows) {
            values.iter_mut().zip(rigid_row).for_each(|(x, r)| *x -= motion[row] * r);
        }
        let mut terms = Vec::with_capacity(dofs.len());
        for (&dof, value) in dofs.iter().zip(values) {
            if value.abs() > RIGID_MOTION_TOLERANCE * max_weight {
                terms.push((dof, value));
            }
        }
        if !terms.is_empty() {
            matrix.add_outer(&terms, spring);
        }
    }
}

/// Columns of Q, the orthonormal rigid motions of nodes.
///
/// The components of each node are those along x, upwards and, in plan, along y.
fn rigid_motions(nodes: &[BaseNode], direction_count: usize) -> Vec<Vec<f64>> {
    let node_count = nodes.len() as f64;
    let center_x = nodes.iter().map(|node| node.x).sum::<f64>() / node_count;
    let center_y = nodes.iter().map(|node| node.y).sum::<f64>() / node_count;
    let center_z = nodes.iter().map(|node| node.z).sum::<f64>() / node_count;
    let motion = |node_motion: &dyn Fn(&BaseNode) -> [f64; 3]| -> Vec<f64> {
        nodes
            .iter()
            .flat_map(|node| node_motion(node).into_iter().take(direction_count))
            .collect()
    };
    let mut motions = vec![
        motion(&|_| [1.0, 0.0, 0.0]),
        motion(&|_| [0.0, 1.0, 0.0]),
        motion(&|node| [center_z - node.z, node.x - center_x, 0.0]),
    ];
    if direction_count == 3 {
        motions.push(motion(&|_| [0.0, 0.0, 1.0]));
        motions.push(motion(&|node| [0.0, node.y - center_y, 0.0]));
        motions.push(motion(&|node| [center_y - node.y, 0.0, node.x - center_x]));
    }
    let mut orthonormal: Vec<Vec<f64>> = Vec::new();
    for mut motion in motions {
        let initial_norm = dot(&motion, &motion).sqrt();
        // Two passes remove rounding.
        for direction in orthonormal.iter().chain(&orthonormal) {
            let component = dot(direction, &motion);
            motion.iter_mut().zip(direction).for_each(|(entry, unit)| *entry -= component * unit);
        }
        let norm = dot(&motion, &motion).sqrt();
        if norm > RIGID_MOTION_TOLERANCE * initial_norm {
            for entry in &mut motion {
                *entry /= norm;
            }
            orthonormal.push(motion);
        }
    }
    orthonormal
}

/// A structure whose foundations move as rigid bodies.
struct StructureOnRigidFoundations {
    structure: Box<dyn Structure>,
    /// Stiffness that makes the foundations rigid.
    foundation_stiffness: Triplets,
}

impl Structure for StructureOnRigidFoundations {
    forward_structure! { self.structure }

    forward! {
        self.structure;
        fn damping(&self, matrix: &mut Triplets) -> Result<()>;
        fn nonlinear(&self) -> Option<&dyn NonlinearForce>;
        fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce>;
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.structure.stiffness(matrix)?;
        for &(row, column, value) in self.foundation_stiffness.entries() {
            matrix.add(row, column, value);
        }
        Ok(())
    }
}

/// Placeholder in a wrapper after its structure has been moved out.
struct NoStructure;

impl Structure for NoStructure {
    fn dofs(&self) -> usize {
        0
    }

    fn base(&self) -> Base {
        Base::Lines(Vec::new())
    }

    fn mass(&self, _matrix: &mut Triplets) -> Result<()> {
        Ok(())
    }

    fn stiffness(&self, _matrix: &mut Triplets) -> Result<()> {
        Ok(())
    }
}

/// Springs under each element, so stiff that the base moves with the free field.
struct FixedGround {
    elements: Patch,
    /// Displacement by a traction, m/Pa.
    compliance: f64,
}

impl FixedGround {
    /// Writes the compliance to the diagonal of a full matrix.
    fn write_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let order = self.elements.layout().len();
        same_length("matrix of the fixed ground", matrix.len(), order * order)?;
        matrix.fill(0.0);
        matrix.iter_mut().step_by(order + 1).for_each(|entry| *entry = self.compliance);
        Ok(())
    }
}

impl Ground for FixedGround {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(
        &mut self,
        _time_step: f64,
        _steps: Option<usize>,
        _observer: &mut Observer<'_>,
    ) -> Result<()> {
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.write_compliance(matrix)
    }

    /// A traction has no effect on later steps.
    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.fill(0.0);
        Ok(())
    }

    fn commit(&mut self, _traction: &[f64]) {}

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.write_compliance(matrix)
    }

    fn diagonal_compliance(&self) -> Result<Option<DiagonalCompliance>> {
        let diagonal = vec![self.compliance; self.elements.layout().len()];
        Ok(Some(DiagonalCompliance { in_step: diagonal.clone(), at_rest: diagonal }))
    }

    fn save(&self) -> Result<Vec<f64>> {
        Ok(Vec::new())
    }

    fn restore(&mut self, _steps: usize, _values: &[f64]) -> Result<()> {
        Ok(())
    }
}
