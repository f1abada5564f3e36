//! A structure on its fixed base: the springs that hold it, and parts that nothing holds.

use super::{DofCombination, FaceNode, Structure, Triplets};
use crate::error::{Error, Result};
use crate::geometry::{PLANE, SPACE};
use crate::linalg::{
    Partition, SparseFactor, SparseMatrix, indefinite_row, largest, sparse_condition,
};

/// Condition of a part's stiffness above which the part counts as floating.
///
/// A floating part has a condition of 10¹⁶ up to rounding, a tower 800 times as high as wide has 10¹².
const FLOATS: f64 = 1e14;
/// A modal mass within 1e-6 of one counts as normalised.
const NORMALISED: f64 = 1e-6;

/// Largest number of degrees of freedom or nodes that a text lists.
pub(super) const NAMED: usize = 8;

/// Error for a part that no stiffness connects to a degree of freedom of `base`.
///
/// Without any degree of freedom in `base` nothing is checked.
pub(crate) fn check_attached(
    structure: &dyn Structure,
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    base: &[usize],
) -> Result<()> {
    let dofs = detached(stiffness, mass, base)?;
    if dofs.is_empty() {
        return Ok(());
    }
    let place = structure.describe(&dofs).unwrap_or_else(|| numbers(&dofs));
    Err(Error::Detached { dofs, place })
}

/// Degrees of freedom by their numbers.
pub(crate) fn numbers(dofs: &[usize]) -> String {
    let texts: Vec<String> = dofs.iter().take(NAMED).map(ToString::to_string).collect();
    let noun = if dofs.len() == 1 { "degree of freedom" } else { "degrees of freedom" };
    format!("{noun} {}", listed(&texts, dofs.len()))
}

/// Joins the texts, and adds the number of those left out of `count`.
pub(super) fn listed(texts: &[String], count: usize) -> String {
    let list = texts.join(", ");
    if count > texts.len() { format!("{list} and {} more", count - texts.len()) } else { list }
}

/// Degrees of freedom of all parts that stiffness does not connect to `base`, ascending.
///
/// A part without mass and stiffness does not count. Entries that are exactly zero couple nothing, in
/// symmetric matrices or others. A part that its own stiffness holds is attached if the mass couples it with
/// the rest: its degrees of freedom are coordinates relative to the base, for example of modes. A mode that
/// the base does not excite is recognised by its unit mass.
fn detached(stiffness: &SparseMatrix, mass: &SparseMatrix, base: &[usize]) -> Result<Vec<usize>> {
    let n = stiffness.order();
    let Some(&first) = base.first() else { return Ok(Vec::new()) };
    let mut by_stiffness = Partition::new(n);
    for &dof in base {
        by_stiffness.join(first, dof);
    }
    by_stiffness.couple(stiffness);
    let ground = by_stiffness.root(first);
    if (0..n).all(|dof| by_stiffness.root(dof) == ground) {
        return Ok(Vec::new());
    }
    let parts = by_stiffness.sets();
    let mut by_any = by_stiffness;
    by_any.couple(mass);
    let ground = by_any.root(first);

    let mut place = vec![(0, 0); n];
    for (part, dofs) in parts.iter().enumerate() {
        dofs.iter().enumerate().for_each(|(k, &dof)| place[dof] = (part, k));
    }
    let base_part = place[first].0;
    let mut own: Vec<_> = parts.iter().map(|part| Triplets::new(part.len())).collect();
    for (row, column, value) in stiffness.entries() {
        let (part, k) = place[row];
        if part != base_part && value != 0.0 {
            own[part].add(k, place[column].1, value);
        }
    }
    let (masses, massless) = (mass.diagonal(), massless(mass));
    let mut found = Vec::new();
    for (part, dofs) in parts.iter().enumerate().filter(|(part, _)| *part != base_part) {
        let has_mass = dofs.iter().any(|&dof| !massless[dof]);
        let is_mode = dofs.len() == 1 && (masses[dofs[0]] - 1.0).abs() <= NORMALISED;
        let takes_part = !has_mass || is_mode || by_any.root(dofs[0]) == ground;
        let is_empty = !has_mass && own[part].entries().is_empty();
        let is_attached = is_empty || takes_part && holds_itself(&own[part])?;
        if !is_attached {
            found.extend_from_slice(dofs);
        }
    }
    found.sort_unstable();
    Ok(found)
}

/// Submatrix of the degrees of freedom for which `place` returns a row, in the order of these rows.
pub(super) fn restricted(
    name: &'static str,
    matrix: &SparseMatrix,
    order: usize,
    place: impl Fn(usize) -> Option<usize>,
) -> Result<SparseMatrix> {
    let mut part = Triplets::new(order);
    for (row, column, value) in matrix.entries() {
        if let (Some(row), Some(column)) = (place(row), place(column)) {
            part.add(row, column, value);
        }
    }
    SparseMatrix::new(name, &part)
}

/// Whether a stiffness resists every motion.
fn holds_itself(stiffness: &Triplets) -> Result<bool> {
    const NAME: &str = "stiffness matrix of a part";
    let matrix = SparseMatrix::new(NAME, stiffness)?;
    if matrix.is_empty() {
        return Ok(false);
    }
    Ok(SparseFactor::new(NAME, stiffness)
        .is_ok_and(|mut factor| sparse_condition(&matrix, &mut factor) < FLOATS))
}

// Structures on springs under their contact nodes.
//
// | symbol | meaning |
// |---|---|
// | N | displacements of the contact nodes |
// | γ | stiffness of the springs |

/// A structure on springs at its contact nodes: K + γ NᵀN, and forces that move its base.
pub(crate) struct HeldBase<'a> {
    nodes: &'a [FaceNode],
    pub(crate) spring: f64,
    pub(crate) matrix: Triplets,
}

impl<'a> HeldBase<'a> {
    pub(crate) const NAME: &'static str = "stiffness matrix with its base held";

    pub(crate) fn new(nodes: &'a [FaceNode], stiffness: &SparseMatrix, spring: f64) -> Self {
        let mut matrix = SparseMatrix::weighted_sum(stiffness.order(), &[(1.0, stiffness)]);
        for row in nodes.iter().flat_map(FaceNode::rows).filter(|row| !row.is_empty()) {
            matrix.add_outer(row, spring);
        }
        Self { nodes, spring, matrix }
    }

    /// The factored matrix.
    pub(crate) fn factor(&self) -> Result<SparseFactor> {
        SparseFactor::new(Self::NAME, &self.matrix)
    }

    /// Forces γ Nᵀ1 for base displacements of 1 m to the right, upwards and, in plan, away.
    pub(crate) fn pulls(&self) -> Vec<Vec<f64>> {
        let rows = |direction| self.nodes.iter().map(move |node| (node.rows()[direction], 1.0));
        (0..self.directions()).map(|direction| self.forces(rows(direction))).collect()
    }

    /// Forces γ Nᵀn for rotations of `nodes` by 1 rad about `middle`.
    ///
    /// In the plane: the rotation of x and up. In plan: the rotations of x and up, of y and up, and of x and
    /// y.
    pub(crate) fn turns<'b>(
        &self,
        nodes: impl Iterator<Item = &'b FaceNode> + Clone,
        [x, y]: [f64; 2],
    ) -> Vec<Vec<f64>> {
        let mut turns = vec![self.forces(nodes.clone().map(|node| (&node.vertical, node.x - x)))];
        if self.directions() == SPACE {
            turns.push(self.forces(nodes.clone().map(|node| (&node.vertical, node.y - y))));
            let [along, across] = [
                self.forces(nodes.clone().map(|node| (&node.horizontal, y - node.y))),
                self.forces(nodes.map(|node| (&node.across, node.x - x))),
            ];
            turns.push(along.iter().zip(&across).map(|(one, other)| one + other).collect());
        }
        turns
    }

    /// Number of directions in which the nodes move.
    fn directions(&self) -> usize {
        self.nodes.first().map_or(PLANE, FaceNode::directions)
    }

    /// Forces of springs with these elongations.
    fn forces<'b>(&self, pulled: impl Iterator<Item = (&'b DofCombination, f64)>) -> Vec<f64> {
        let mut force = vec![0.0; self.matrix.order()];
        for (row, amount) in pulled {
            for &(i, weight) in row {
                force[i] += self.spring * weight * amount;
            }
        }
        force
    }
}

/// The largest stiffness on the diagonal, or one.
pub(crate) fn stiffest(stiffness: &SparseMatrix) -> f64 {
    let stiffest = largest(&stiffness.diagonal());
    if stiffest > 0.0 { stiffest } else { 1.0 }
}

// Whether the mass and damping matrices of a structure are symmetric and positive semi-definite.

/// Relative difference of mirrored entries up to which a matrix counts as symmetric.
pub(super) const SYMMETRIC: f64 = 1e-9;
/// Negative masses and dampings up to this fraction of the diagonal are rounding.
///
/// A singular matrix read from a file with seven digits has negative values of this size.
const SEMI_DEFINITE: f64 = 1e-6;
/// Masses and dampings up to this fraction of the largest entry are rounding.
///
/// After reductions and sums a zero has values of this size. One bound serves kg and kg m², whose sizes differ by far
/// less.
pub(super) const MASSLESS: f64 = 1e-12;

/// Whether each degree of freedom is massless, up to rounding.
pub(crate) fn massless(mass: &SparseMatrix) -> Vec<bool> {
    let masses = mass.diagonal();
    let most = MASSLESS * largest(&masses);
    masses.iter().map(|mass| mass.abs() <= most).collect()
}

/// Square of a circular frequency (1/s²) too low to affect a run: a period of a day.
pub(crate) const UNNOTICED: f64 = 5.29e-9;

/// Error unless the stiffness matrix is symmetric.
///
/// A difference is relative to the diagonal of its row and column and to the inertia of `mass` there, so that
/// scaling of coordinates does not change the result.
pub(crate) fn check_stiffness(stiffness: &SparseMatrix, mass: &SparseMatrix) -> Result<()> {
    let [diagonal, masses] = [stiffness.diagonal(), mass.diagonal()];
    let rounding = MASSLESS * stiffness.entries().fold(0.0, |m: f64, (_, _, k)| m.max(k.abs()));
    let both = |of: &[f64], i: usize, j: usize| (of[i] * of[j]).abs().sqrt();
    check_symmetric("stiffness matrix", stiffness, |i, j| {
        SYMMETRIC * both(&diagonal, i, j) + UNNOTICED * both(&masses, i, j) + rounding
    })
}

/// Error for mirrored entries that differ by more than 1e-9 of the largest entry.
pub(super) fn check_mirrored(name: &'static str, matrix: &SparseMatrix) -> Result<()> {
    let largest = matrix.entries().fold(0.0, |m: f64, (_, _, value)| m.max(value.abs()));
    check_symmetric(name, matrix, |_, _| SYMMETRIC * largest)
}

fn check_symmetric(
    name: &'static str,
    matrix: &SparseMatrix,
    allowed: impl Fn(usize, usize) -> f64,
) -> Result<()> {
    let refused =
        |(row, column, entries)| Error::Unsymmetric { matrix: name, row, column, entries };
    matrix.unsymmetric_pair(allowed).map_or(Ok(()), |pair| Err(refused(pair)))
}

/// Error unless the mass matrix is symmetric and positive semi-definite.
pub(crate) fn check_mass(mass: &SparseMatrix) -> Result<()> {
    check_semi_definite("mass matrix", mass)
}

/// Error unless the damping matrix is symmetric and positive semi-definite.
pub(crate) fn check_damping(damping: &SparseMatrix) -> Result<()> {
    check_semi_definite("damping matrix", damping)
}

fn check_semi_definite(name: &'static str, matrix: &SparseMatrix) -> Result<()> {
    check_mirrored(name, matrix)?;
    let largest = matrix.entries().fold(0.0, |m: f64, (_, _, value)| m.max(value.abs()));
    match indefinite_row(matrix, SEMI_DEFINITE, MASSLESS * largest) {
        Some(row) => Err(Error::Indefinite { matrix: name, row, diagonal: matrix.diagonal()[row] }),
        None => Ok(()),
    }
}
