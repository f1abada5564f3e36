//! Check that a structure translates freely: it must have no support besides the ground.
//!
//! | symbol | meaning |
//! |---|---|
//! | r | displacements when springs pull the contact nodes by 1 m and all other degrees of freedom follow |
//! | s | r rounded to whole numbers, if r is close to them: 1 for a coordinate that translates, otherwise 0 |
//! | lag | distance (m) of the contact nodes from 1 m under the pull of springs |
//!
//! A support affects r in two ways: its force causes a lag of the contact nodes, and it bends the structure. If the
//! force is small relative to the largest stiffness (a weak support, or one on top of a slender tower), K s is the
//! sharper test. Row by row it compares the support with the stiffness of neighbouring entries. In a free structure
//! K s contains only the rounding of the entries. The table has measurements on walls of quadrilaterals, relative to
//! the row, and the largest |r − s|:
//!
//! | | row | r − s |
//! |---|---|---|
//! | elements added up in double precision | 4e-16 | 3e-5 |
//! | entries of 10 digits; of 8 digits | 2e-10; 2e-8 | 3e-6; 3e-4 |
//! | reduced walls, up to 800 times as high as wide | 1e-7 | 3e-5 |
//! | a spring of 1e-9 of the largest stiffness on a block | 4e-10 | 4e-9 |
//! | the same on a wall 200 times as high as wide | 7e-10 | 0.09 |
//!
//! The total force on the reduced walls is 2e-10 of the largest stiffness, that on the springs 1e-9. A support exceeds
//! all of the limits below, and its squared frequency r·K r / r·M r is not negligible. This ratio does not depend on the
//! scaling of coordinates. It distinguishes a support from rounding in the stiffness of a rigid base, which has no other
//! stiffness for a comparison.

use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::Influence;
use crate::error::{Error, Result, StructureError, require, require_part};
use crate::linalg::matrix::dense_vector;
use crate::linalg::{SparseMatrix, largest};
use crate::structure::{NEGLIGIBLE_SQUARED_FREQUENCY, Structure, Tangent};

/// Largest accepted lag, m, far above rounding; also the largest accepted error of contact nodes' weights.
const MAX_CONTACT_NODE_LAG: f64 = 1e-6;
/// Largest ignored work r·K r, relative to the largest stiffness.
const MAX_IGNORED_REACTION: f64 = 3e-10;
/// Largest force of a row of K s, relative to |K| |s|.
const ROW_FORCE_TOLERANCE: f64 = 3e-10;
/// Largest force of a row of K s, relative to the diagonal.
///
/// For rows in which all entries are rounding.
const DIAGONAL_FORCE_TOLERANCE: f64 = 1e-13;
/// Work r·K r that counts as rounding, relative to |r|·|K| |r|; the sum of elements has 3e-17.
const WORK_ROUNDING_TOLERANCE: f64 = 1e-15;
/// Largest |r − s| that counts as no bending.
const BENDING_TOLERANCE: f64 = 1e-9;
/// Largest |r − s| at which r is replaced by s.
const MAX_ROUNDING_DISTANCE: f64 = 0.25;

/// Factor of the rounding of a nonlinear force at the static state.
///
/// The rounding is this factor times ε, the largest stiffness and the largest displacement.
const NONLINEAR_ROUNDING_FACTOR: f64 = 16.0;

/// Largest error of a contact node's displacement under a rigid translation of 1 m.
const TRANSLATION_ERROR_TOLERANCE: f64 = 1e-14;
/// Tolerance of an element's mean displacement, relative to that of a node.
///
/// The rounding of the terms of the mean is added.
const MEAN_TOLERANCE_FACTOR: f64 = 10.0;
/// Translations that no nonlinear force may resist, m.
///
/// From a small slip to the extent of a site.
const TRIAL_TRANSLATIONS: [f64; 6] = [1e-3, -1e-3, 1.0, -1.0, 1e3, -1e3];

/// Names of the directions of translation in errors.
const TRANSLATION_NAMES: [&str; 3] = ["to the right", "upwards", "along y"];

/// Returns an error unless a structure translates freely; rounds its translations to whole numbers.
///
/// `translations` are those to the right, upwards, and in plan along y. Entries close to whole numbers are rounded, and
/// the displacements of the contact nodes become exact. `stiffness` does not contain the springs at the contact nodes.
/// These are `spring_ratio` times as stiff as its largest diagonal entry.
pub(crate) fn check(
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    spring_ratio: f64,
    base: &PlacedBase,
    translations: &mut [Vec<f64>],
) -> Result<()> {
    let lag = base.translation_error(translations);
    for (translation, direction) in translations.iter_mut().zip(TRANSLATION_NAMES) {
        let resistance = Resistance::new(stiffness, translation);
        let stiffness_form = stiffness.form(translation, translation).abs();
        let mass_form = mass.form(translation, translation);
        let has_frequency = stiffness_form > NEGLIGIBLE_SQUARED_FREQUENCY * mass_form;
        if has_frequency && resistance.is_support(lag, spring_ratio) {
            let RowForce { force, dof, ratio } = resistance.row_force;
            return Err(StructureError::Restrained { direction, force, dof, ratio }.into());
        }
        if resistance.is_free || !has_frequency && resistance.bending <= MAX_CONTACT_NODE_LAG {
            for entry in translation.iter_mut() {
                *entry = entry.round();
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

/// Returns an error for a part whose base does not translate as a whole.
///
/// B R must be 1 in the directions in which the part moves.
pub(crate) fn check_parts(influence: &Influence, base: &PlacedBase, dofs: usize) -> Result<()> {
    let mut means = vec![0.0; base.layout().len()];
    // A mean is a sum over the nodes of an element, and each term may be rounded.
    let tolerance = MEAN_TOLERANCE_FACTOR * TRANSLATION_ERROR_TOLERANCE
        + base.nodes().len() as f64 * f64::EPSILON;
    for part in influence.parts() {
        for (direction, vector) in part.vectors.iter().enumerate() {
            base.means(&dense_vector(vector, dofs), &mut means);
            for &e in part.elements().iter().filter(|_| !vector.is_empty()) {
                let mean = base.element_displacement(e, &means)[direction];
                if (mean - 1.0).abs() > tolerance {
                    return Err(Error::Input {
                        quantity: "mean of the base under a rigid translation of 1 m",
                        value: mean,
                        needed: "1: all of a connected part's base must translate with it",
                    });
                }
            }
        }
    }
    Ok(())
}

/// Whether a nonlinear force connects each part with other parts.
///
/// A part that the force connects with others cannot translate alone. A force that resists a translation of the whole
/// structure from the static state is connected to a fixed point: this is an error.
pub(crate) fn parts_connected_by_force(
    structure: &dyn Structure,
    stiffness: &SparseMatrix,
    influence: &Influence,
    static_displacement: &[f64],
    static_force: &[f64],
) -> Result<Vec<bool>> {
    let parts = influence.parts();
    let mut is_connected = vec![false; parts.len()];
    let Some(nonlinear_force) = structure.nonlinear() else {
        return Ok(is_connected);
    };
    let dofs = static_displacement.len();
    let tangent = Tangent::at(structure, static_displacement)?;
    let max_stiffness = largest(&tangent.matrix.diagonal()).max(largest(&stiffness.diagonal()));
    let max_displacement = largest(static_displacement);
    // The first force beyond rounding against a translation.
    let find_resistance = |translation: &[f64]| -> Result<Option<RowForce>> {
        let magnitudes = RowProducts::new(&tangent.matrix, translation).magnitudes;
        let mut forces = vec![0.0; dofs];
        for distance in TRIAL_TRANSLATIONS {
            let pairs = static_displacement.iter().zip(translation);
            let displacement: Vec<f64> = pairs.map(|(u, r)| u + distance * r).collect();
            forces.fill(0.0);
            nonlinear_force.force(&displacement, &mut forces)?;
            for (dof, (force, static_force)) in forces.iter().zip(static_force).enumerate() {
                let force = force - static_force;
                let scale = distance.abs() * magnitudes[dof] + static_force.abs();
                let rounding = f64::EPSILON
                    * max_stiffness
                    * (distance.abs() + NONLINEAR_ROUNDING_FACTOR * max_displacement);
                if force.is_nan() || force.abs() > ROW_FORCE_TOLERANCE * scale + rounding {
                    let ratio = if scale > 0.0 { force.abs() / scale } else { f64::INFINITY };
                    return Ok(Some(RowForce { force, dof, ratio }));
                }
            }
        }
        Ok(None)
    };
    for (translation, direction) in influence.whole_vectors(dofs).iter().zip(TRANSLATION_NAMES) {
        if let Some(RowForce { force, dof, ratio }) = find_resistance(translation)? {
            return Err(StructureError::Restrained { direction, force, dof, ratio }.into());
        }
    }
    if parts.len() > 1 {
        for (part, is_connected) in parts.iter().zip(&mut is_connected) {
            for vector in &part.vectors {
                *is_connected |= find_resistance(&dense_vector(vector, dofs))?.is_some();
            }
        }
    }
    Ok(is_connected)
}

/// Force of a stiffness or a nonlinear force against a translation, in one row.
struct RowForce {
    /// Force, N.
    force: f64,
    /// Degree of freedom of the row.
    dof: usize,
    /// Magnitude of the force, relative to the terms of its row.
    ratio: f64,
}

/// Resistance of the stiffness to a translation.
struct Resistance {
    /// r·K r, relative to |r|·|K| |r|.
    work: f64,
    /// r·K r, relative to the largest stiffness.
    reaction: f64,
    /// Largest |r − s|.
    bending: f64,
    /// Whether the force in every row of K s is only rounding.
    is_free: bool,
    /// Force that is largest relative to the terms of its row.
    row_force: RowForce,
}

impl Resistance {
    /// Resistance of a stiffness to a translation r.
    fn new(stiffness: &SparseMatrix, translation: &[f64]) -> Self {
        let rounded_translation: Vec<f64> = translation.iter().map(|r| r.round()).collect();
        let differences: Vec<f64> =
            translation.iter().zip(&rounded_translation).map(|(r, s)| r - s).collect();
        let bending = largest(&differences);
        let mut products = RowProducts::new(stiffness, translation);
        let work: f64 = translation.iter().zip(&products.forces).map(|(r, f)| r * f).sum();
        let scale: f64 =
            translation.iter().zip(&products.magnitudes).map(|(r, f)| (r * f).abs()).sum();
        let is_nearly_whole = bending <= MAX_ROUNDING_DISTANCE;
        if is_nearly_whole {
            products = RowProducts::new(stiffness, &rounded_translation);
        }
        let RowProducts { forces, magnitudes } = products;
        let diagonal = stiffness.diagonal();
        let is_free = (0..translation.len()).all(|i| {
            forces[i].abs()
                <= ROW_FORCE_TOLERANCE * magnitudes[i]
                    + DIAGONAL_FORCE_TOLERANCE * diagonal[i].abs()
        });
        let ratio = |i: usize| ratio_or_zero(forces[i].abs(), magnitudes[i]);
        let dof = (0..translation.len()).fold(0, |a, b| if ratio(b) > ratio(a) { b } else { a });
        let force = forces.get(dof).copied().unwrap_or(0.0);
        Self {
            work: ratio_or_zero(work.abs(), scale),
            reaction: ratio_or_zero(work.abs(), stiffest(stiffness, &diagonal)),
            bending,
            is_free: is_nearly_whole && is_free,
            row_force: RowForce { force, dof, ratio: ratio(dof) },
        }
    }

    /// Whether the resistance comes from a support.
    ///
    /// `lag` is the lag of the contact nodes under the pull of springs `spring_ratio` times as stiff as the largest
    /// stiffness.
    fn is_support(&self, lag: f64, spring_ratio: f64) -> bool {
        let is_rounding = self.reaction <= MAX_IGNORED_REACTION
            || spring_ratio * self.bending <= BENDING_TOLERANCE
            || self.is_free;
        self.work > WORK_ROUNDING_TOLERANCE
            && (spring_ratio * lag > MAX_CONTACT_NODE_LAG || !is_rounding)
    }
}

/// A value over its scale; zero without a scale.
fn ratio_or_zero(value: f64, scale: f64) -> f64 {
    if scale > 0.0 { value / scale } else { 0.0 }
}

/// Largest stiffness between two degrees of freedom, which a support does not change.
///
/// Without such entries it is the largest stiffness on the diagonal.
fn stiffest(stiffness: &SparseMatrix, diagonal: &[f64]) -> f64 {
    let off_diagonal = stiffness.entries().filter(|(row, column, _)| row != column);
    let max_entry = off_diagonal.fold(0.0_f64, |max, (_, _, value)| max.max(value.abs()));
    if max_entry > 0.0 { max_entry } else { largest(diagonal) }
}

/// Products of a matrix A with a vector x.
struct RowProducts {
    /// A x.
    forces: Vec<f64>,
    /// |A| |x|.
    magnitudes: Vec<f64>,
}

impl RowProducts {
    fn new(matrix: &SparseMatrix, x: &[f64]) -> Self {
        let mut forces = vec![0.0; x.len()];
        let mut magnitudes = vec![0.0; x.len()];
        for (row, column, value) in matrix.entries() {
            let term = value * x[column];
            forces[row] += term;
            magnitudes[row] += term.abs();
        }
        Self { forces, magnitudes }
    }
}
