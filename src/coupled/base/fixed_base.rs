//! The held base: a rigid base on an almost rigid ground.
//!
//! | symbol | meaning |
//! |---|---|
//! | N | displacements of a foundation's contact nodes |
//! | Q | orthonormal rigid motions of these nodes |
//! | γ | stiffness of the springs |

use crate::bem::{DiagonalCompliance, Ground};
use crate::coupled::base::{PlacedBase, dofs_of};
use crate::error::{Observer, Result, same_length};
use crate::geometry::{ContactElement, Patch};
use crate::linalg::{dot, largest};
use crate::structure::{
    BaseNode, HeldBase, MassAndStiffness, NonlinearForce, Structure, Triplets, mass_and_stiffness,
    stiffest,
};

/// Stiffness of the held ground over 4 m/Δt², the resistance of the structure's mass m in a step.
const HELD_GROUND_STIFFNESS_RATIO: f64 = 1e6;
/// Stiffness that keeps the shape of a base, over the structure's largest stiffness.
const SHAPE_STIFFNESS_RATIO: f64 = 1e5;
/// Part of a node's displacement that counts as rounding.
const RIGID_MOTION_TOLERANCE: f64 = 1e-9;

/// The structure with a base that keeps its shape, and the ground that holds it.
pub(crate) fn on_fixed_base(
    structure: Box<dyn Structure>,
    elements: &Patch,
    time_step: f64,
) -> Result<(Box<dyn Structure>, Box<dyn Ground>)> {
    let base = PlacedBase::of(structure.as_ref(), elements)?;
    let n = structure.dofs();
    let MassAndStiffness { mass, stiffness } = mass_and_stiffness(structure.as_ref())?;
    let springs = HeldBase::new(base.nodes(), &stiffness, stiffest(&stiffness));
    let mut along = springs.pulls().swap_remove(0);
    // The assembly names the motion that makes the matrix singular.
    if let Ok(mut factor) = springs.factor() {
        factor.solve(&mut along);
    }
    let total: f64 = elements.areas().iter().sum();
    let resistance = 4.0 * mass.form(&along, &along) / (time_step * time_step);
    // A massless structure: the reference is its stiffness.
    let is_usable = resistance > 0.0 && resistance.is_finite();
    let resistance = if is_usable { resistance } else { stiffest(&stiffness) };
    let ground = FixedGround {
        elements: elements.clone(),
        compliance: total / (HELD_GROUND_STIFFNESS_RATIO * resistance),
    };
    let mut shape = Triplets::new(n);
    for (nodes, _) in base.foundations() {
        keep_shape(nodes, SHAPE_STIFFNESS_RATIO * stiffest(&stiffness), &mut shape);
    }
    let structure: Box<dyn Structure> = if shape.entries().is_empty() {
        structure
    } else {
        Box::new(RigidBase { structure, shape })
    };
    Ok((structure, Box::new(ground)))
}

/// Whether the ground is a held one.
pub(crate) fn is_fixed_base(ground: &dyn Ground) -> bool {
    let ground: &dyn std::any::Any = ground;
    ground.is::<FixedGround>()
}

/// Adds γ Nᵀ (1 − Q Qᵀ) N of one foundation, which resists all but rigid motions of its nodes.
fn keep_shape(nodes: &[BaseNode], spring: f64, matrix: &mut Triplets) {
    let Some(directions) = nodes.first().map(BaseNode::directions) else { return };
    let rigid = rigid_motions(nodes, directions);
    // Rows of N in the degrees of freedom of the base, and their remainders without rigid motions.
    let rows: Vec<_> =
        nodes.iter().flat_map(|node| node.rows().into_iter().take(directions)).collect();
    let dofs = dofs_of(nodes);
    let dense = |row: usize| {
        let mut values = vec![0.0; dofs.len()];
        for &(dof, weight) in rows[row] {
            if let Ok(place) = dofs.binary_search(&dof) {
                values[place] += weight;
            }
        }
        values
    };
    // Qᵀ N, a row for each rigid motion.
    let mut rigid_rows: Vec<Vec<f64>> = Vec::with_capacity(rigid.len());
    for motion in &rigid {
        let mut sum = vec![0.0; dofs.len()];
        for (row, factor) in motion.iter().enumerate() {
            sum.iter_mut().zip(dense(row)).for_each(|(sum, x)| *sum += factor * x);
        }
        rigid_rows.push(sum);
    }
    for row in 0..rows.len() {
        let mut values = dense(row);
        let largest = largest(&values);
        for (motion, sum) in rigid.iter().zip(&rigid_rows) {
            values.iter_mut().zip(sum).for_each(|(x, sum)| *x -= motion[row] * sum);
        }
        let terms = dofs.iter().copied().zip(values);
        let terms: Vec<_> =
            terms.filter(|(_, x)| x.abs() > RIGID_MOTION_TOLERANCE * largest).collect();
        if !terms.is_empty() {
            matrix.add_outer(&terms, spring);
        }
    }
}

/// Columns of Q: components of each node along x, up, along y.
fn rigid_motions(nodes: &[BaseNode], directions: usize) -> Vec<Vec<f64>> {
    let count = nodes.len() as f64;
    let x = nodes.iter().map(|node| node.x).sum::<f64>() / count;
    let y = nodes.iter().map(|node| node.y).sum::<f64>() / count;
    let z = nodes.iter().map(|node| node.z).sum::<f64>() / count;
    let motion = |of: &dyn Fn(&BaseNode) -> [f64; 3]| -> Vec<f64> {
        nodes.iter().flat_map(|node| of(node).into_iter().take(directions)).collect()
    };
    let mut motions = vec![
        motion(&|_| [1.0, 0.0, 0.0]),
        motion(&|_| [0.0, 1.0, 0.0]),
        motion(&|node| [z - node.z, node.x - x, 0.0]),
    ];
    if directions == 3 {
        motions.push(motion(&|_| [0.0, 0.0, 1.0]));
        motions.push(motion(&|node| [0.0, node.y - y, 0.0]));
        motions.push(motion(&|node| [y - node.y, 0.0, node.x - x]));
    }
    let mut rigid: Vec<Vec<f64>> = Vec::new();
    for mut motion in motions {
        let initial_norm = dot(&motion, &motion).sqrt();
        for other in rigid.iter().chain(&rigid) {
            let component = dot(other, &motion);
            motion.iter_mut().zip(other).for_each(|(x, y)| *x -= component * y);
        }
        let norm = dot(&motion, &motion).sqrt();
        if norm > RIGID_MOTION_TOLERANCE * initial_norm {
            for x in &mut motion {
                *x /= norm;
            }
            rigid.push(motion);
        }
    }
    rigid
}

/// A structure whose foundations move as rigid bodies.
struct RigidBase {
    structure: Box<dyn Structure>,
    shape: Triplets,
}

impl Structure for RigidBase {
    forward_structure! { self.structure }

    forward! {
        self.structure;
        fn damping(&self, matrix: &mut Triplets) -> Result<()>;
        fn nonlinear(&self) -> Option<&dyn NonlinearForce>;
        fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce>;
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.structure.stiffness(matrix)?;
        for &(row, column, value) in self.shape.entries() {
            matrix.add(row, column, value);
        }
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
    fn fill(&self, matrix: &mut [f64]) -> Result<()> {
        let size = self.elements.layout().len();
        same_length("matrix of the held ground", matrix.len(), size * size)?;
        matrix.fill(0.0);
        matrix.iter_mut().step_by(size + 1).for_each(|entry| *entry = self.compliance);
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
        self.fill(matrix)
    }

    /// A traction has no effect on later steps.
    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.fill(0.0);
        Ok(())
    }

    fn commit(&mut self, _traction: &[f64]) {}

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill(matrix)
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
