//! Check that a structure translates freely, without stiffness to a fixed point.
//!
//! | symbol | meaning |
//! |---|---|
//! | r | displacements when the contact nodes are pulled by 1 m and all else follows |
//! | s | r in whole numbers, if r is close to these: 1 for a coordinate that moves along, else 0 |
//! | lag | distance by which the contact nodes stay behind, pulled by the largest stiffness |
//!
//! A support affects r in two ways: it holds the contact nodes back with a force, and it bends the structure. If
//! the force is small relative to the largest stiffness (a weak support, or one on top of a slender tower), K s is
//! the sharper test: row by row it compares the support with the stiffness around it. In a free structure it
//! contains only the rounding of the entries. Measured on walls of quadrilaterals, as fractions of the row, with
//! the largest |r − s|:
//!
//! | | row | r − s |
//! |---|---|---|
//! | elements added up in double precision | 4e-16 | 3e-5 |
//! | entries of 10 digits; of 8 digits | 2e-10; 2e-8 | 3e-6; 3e-4 |
//! | reduced walls, up to 800 times as high as wide | 1e-7 | 3e-5 |
//! | a spring of 1e-9 of the largest stiffness on a block | 4e-10 | 4e-9 |
//! | the same on a wall 200 times as high as wide | 7e-10 | 0.09 |
//!
//! The reduced walls meet a total force of 2e-10 of the largest stiffness, the springs one of 1e-9. A support
//! exceeds all of the limits below, and gives the structure a period of sway that a run could notice. The measure
//! r·K r over r·M r, which no scaling of coordinates changes, distinguishes it from rounding in the stiffness of a
//! rigid base alone, which contains no stiffness to compare with.

use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::Influence;
use crate::error::{Error, Result, StructureError, require, require_part};
use crate::linalg::matrix::spread;
use crate::linalg::{SparseMatrix, largest};
use crate::structure::{NEGLIGIBLE_SQUARED_FREQUENCY, Structure, Tangent};

/// Largest lag that is accepted, far above rounding; also the largest accepted error of contact nodes' weights.
const MAX_CONTACT_NODE_LAG: f64 = 1e-6;
/// Largest ignored work r·K r, relative to the largest stiffness.
const MAX_IGNORED_REACTION: f64 = 3e-10;
/// Largest force of a row of K s, relative to |K| |s|.
const ROW_FORCE_TOLERANCE: f64 = 3e-10;
/// Largest force of a row of K s relative to the diagonal, for rows in which all entries are rounding.
const DIAGONAL_FORCE_TOLERANCE: f64 = 1e-13;
/// Work r·K r that counts as rounding, relative to |r|·|K| |r|; elements added up leave 3e-17.
const WORK_ROUNDING: f64 = 1e-15;
/// Largest |r − s| that counts as no bending.
const BENDING_TOLERANCE: f64 = 1e-9;
/// Largest |r − s| at which r is replaced by s.
const MAX_ROUNDING_DISTANCE: f64 = 0.25;

/// Rounding of a nonlinear force at the static state, relative to ε, the largest stiffness and the displacement.
const NONLINEAR_ROUNDING_FACTOR: f64 = 16.0;

/// Largest error of a contact node's displacement under a rigid translation of 1 m.
const TRANSLATION_ERROR_TOLERANCE: f64 = 1e-14;
/// Translations (m) that no nonlinear force may resist.
const TRIAL_TRANSLATIONS: [f64; 6] = [1e-3, -1e-3, 1.0, -1.0, 1e3, -1e3];

/// Names of the translations.
const TRANSLATION_NAMES: [&str; 3] = ["to the right", "upwards", "along y"];

/// Error unless a structure translates freely; rounds its translations to whole numbers.
///
/// `translations`: to the right, upwards, in plan away. They are rounded where whole numbers are meant, and made
/// exact at the contact nodes. `stiffness`: without the springs at the contact nodes, which are `firmer` times as
/// stiff as its largest entry on the diagonal.
pub(crate) fn check(
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    firmer: f64,
    base: &PlacedBase,
    translations: &mut [Vec<f64>],
) -> Result<()> {
    let lag = base.translation_error(translations);
    for (translation, direction) in translations.iter_mut().zip(TRANSLATION_NAMES) {
        let resistance = Resistance::new(stiffness, translation);
        let square = stiffness.form(translation, translation).abs();
        let inertia = mass.form(translation, translation);
        let is_noticed = square > NEGLIGIBLE_SQUARED_FREQUENCY * inertia;
        if is_noticed && resistance.is_fixed_base(lag, firmer) {
            let Resistance { force, dof, ratio, .. } = resistance;
            return Err(StructureError::Restrained { direction, force, dof, ratio }.into());
        }
        if resistance.is_free || !is_noticed && resistance.bent <= MAX_CONTACT_NODE_LAG {
            for r in translation.iter_mut() {
                *r = r.round();
            }
        }
    }
    require_part(
        "structure",
        lag <= MAX_CONTACT_NODE_LAG,
        "its contact nodes must be able to translate together",
    )?;
    for (direction, translation) in translations.iter_mut().enumerate() {
        base.translate_nodes(direction, translation);
    }
    let error = base.translation_error(translations);
    let needed = "1e-14 or less: contact nodes must be able to translate together";
    require(
        "error of the base under a rigid translation of 1 m",
        error,
        error <= TRANSLATION_ERROR_TOLERANCE,
        needed,
    )?;
    Ok(())
}

/// Error for a part whose base does not translate as a whole: B R must be 1 where it moves.
pub(crate) fn check_parts(influence: &Influence, base: &PlacedBase, dofs: usize) -> Result<()> {
    let mut means = vec![0.0; base.layout().len()];
    // A mean is a sum over the nodes above an element, and each may be rounded.
    let exact = 10.0 * TRANSLATION_ERROR_TOLERANCE + base.nodes().len() as f64 * f64::EPSILON;
    for part in influence.parts() {
        for (direction, vector) in part.vectors.iter().enumerate() {
            base.means(&spread(vector, dofs), &mut means);
            for &e in part.elements().iter().filter(|_| !vector.is_empty()) {
                let moved = base.motion_of(e, &means)[direction];
                if (moved - 1.0).abs() > exact {
                    return Err(Error::Input {
                        quantity: "mean of the base under a rigid translation of 1 m",
                        value: moved,
                        needed: "1: all of a connected part's base must translate with it",
                    });
                }
            }
        }
    }
    Ok(())
}

/// Returns which parts a nonlinear force joins; an error if it resists a translation of the whole structure.
///
/// A force that resists a translation from the static state is tied to a fixed point. A part that the force joins with
/// others cannot translate alone.
pub(crate) fn joined_by_force(
    structure: &dyn Structure,
    stiffness: &SparseMatrix,
    influence: &Influence,
    [displacement, static_force]: [&[f64]; 2],
) -> Result<Vec<bool>> {
    let parts = influence.parts();
    let mut joined = vec![false; parts.len()];
    let Some(nonlinear) = structure.nonlinear() else { return Ok(joined) };
    let n = displacement.len();
    let tangent = Tangent::at(structure, displacement)?;
    let stiffest = largest(&tangent.matrix.diagonal()).max(largest(&stiffness.diagonal()));
    let deformed = largest(displacement);
    let resistance = |translation: &[f64]| -> Result<Option<(f64, usize, f64)>> {
        let [_, magnitudes] = products(&tangent.matrix, translation);
        let mut force = vec![0.0; n];
        for distance in TRIAL_TRANSLATIONS {
            let pairs = displacement.iter().zip(translation);
            let moved: Vec<f64> = pairs.map(|(u, r)| u + distance * r).collect();
            force.fill(0.0);
            nonlinear.force(&moved, &mut force)?;
            for (dof, (force, before)) in force.iter().zip(static_force).enumerate() {
                let force = force - before;
                let scale = distance.abs() * magnitudes[dof] + before.abs();
                let rounding = f64::EPSILON
                    * stiffest
                    * (distance.abs() + NONLINEAR_ROUNDING_FACTOR * deformed);
                if force.is_nan() || force.abs() > ROW_FORCE_TOLERANCE * scale + rounding {
                    let ratio = if scale > 0.0 { force.abs() / scale } else { f64::INFINITY };
                    return Ok(Some((force, dof, ratio)));
                }
            }
        }
        Ok(None)
    };
    for (translation, direction) in influence.of_all(n).iter().zip(TRANSLATION_NAMES) {
        if let Some((force, dof, ratio)) = resistance(translation)? {
            return Err(StructureError::Restrained { direction, force, dof, ratio }.into());
        }
    }
    if parts.len() > 1 {
        for (part, joined) in parts.iter().zip(&mut joined) {
            for vector in &part.vectors {
                *joined |= resistance(&spread(vector, n))?.is_some();
            }
        }
    }
    Ok(joined)
}

/// Resistance of the stiffness to a translation.
struct Resistance {
    /// r·K r divided by |r|·|K| |r|; in `reaction`, divided by the largest stiffness.
    work: f64,
    reaction: f64,
    /// Largest |r − s|.
    bent: f64,
    /// Whether the force in every row of K s is only rounding.
    is_free: bool,
    /// Force that is largest relative to the stiffness in its row, the number of this row, and the ratio.
    force: f64,
    dof: usize,
    ratio: f64,
}

impl Resistance {
    fn new(stiffness: &SparseMatrix, translation: &[f64]) -> Self {
        let whole: Vec<f64> = translation.iter().map(|r| r.round()).collect();
        let differences: Vec<f64> = translation.iter().zip(&whole).map(|(r, s)| r - s).collect();
        let bent = largest(&differences);
        let [force, around] = products(stiffness, translation);
        let work: f64 = translation.iter().zip(&force).map(|(r, f)| r * f).sum();
        let scale: f64 = translation.iter().zip(&around).map(|(r, f)| (r * f).abs()).sum();
        let is_whole = bent <= MAX_ROUNDING_DISTANCE;
        let [force, around] = if is_whole { products(stiffness, &whole) } else { [force, around] };
        let diagonal = stiffness.diagonal();
        let is_free = (0..translation.len()).all(|i| {
            force[i].abs()
                <= ROW_FORCE_TOLERANCE * around[i] + DIAGONAL_FORCE_TOLERANCE * diagonal[i].abs()
        });
        let ratio = |i: usize| ratio_or_zero(force[i].abs(), around[i]);
        let dof = (0..translation.len()).fold(0, |a, b| if ratio(b) > ratio(a) { b } else { a });
        Self {
            work: ratio_or_zero(work.abs(), scale),
            reaction: ratio_or_zero(work.abs(), stiffest(stiffness, &diagonal)),
            bent,
            is_free: is_whole && is_free,
            force: force.get(dof).copied().unwrap_or(0.0),
            dof,
            ratio: ratio(dof),
        }
    }

    /// Whether a support holds the structure.
    ///
    /// The contact nodes stay behind by `lag` when pulled by springs `firmer` times as stiff as the largest stiffness.
    fn is_fixed_base(&self, lag: f64, firmer: f64) -> bool {
        let is_rounding = self.reaction <= MAX_IGNORED_REACTION
            || firmer * self.bent <= BENDING_TOLERANCE
            || self.is_free;
        self.work > WORK_ROUNDING && (firmer * lag > MAX_CONTACT_NODE_LAG || !is_rounding)
    }
}

/// A value over its scale; zero without a scale.
fn ratio_or_zero(value: f64, scale: f64) -> f64 {
    if scale > 0.0 { value / scale } else { 0.0 }
}

/// Largest stiffness between two degrees of freedom; a support adds nothing to it.
///
/// Without such entries, the largest stiffness on the diagonal.
fn stiffest(stiffness: &SparseMatrix, diagonal: &[f64]) -> f64 {
    let between = stiffness.entries().filter(|(row, column, _)| row != column);
    let stiffest = between.fold(0.0_f64, |largest, entry| largest.max(entry.2.abs()));
    if stiffest > 0.0 { stiffest } else { largest(diagonal) }
}

/// The products A x and |A| |x|.
fn products(matrix: &SparseMatrix, x: &[f64]) -> [Vec<f64>; 2] {
    let mut sums = vec![0.0; x.len()];
    let mut sizes = vec![0.0; x.len()];
    for (row, column, value) in matrix.entries() {
        let term = value * x[column];
        sums[row] += term;
        sizes[row] += term.abs();
    }
    [sums, sizes]
}
