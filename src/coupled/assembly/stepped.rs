//! The structure in its stepping coordinates: the choice between degrees of freedom, modes and Ritz modes.

use std::rc::Rc;

use super::vibration_modes::vibration_modes;
use crate::coupled::assembly::fixed_base_results::FixedBaseResponses;
use crate::coupled::assembly::krylov::{Factored, Reduction};
use crate::coupled::base::PlacedBase;
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::coordinates::Coordinates;
use crate::coupled::model::Model;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::mechanism::unresisted;
use crate::coupled::model::operators::{Factor, Operators};
use crate::coupled::parts::Parts;
use crate::coupled::statics::compliance::Floating;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result};
use crate::linalg::{SparseFactor, SparseMatrix};
use crate::structure::{Structure, Tangent};

/// Default number of steps within which computing the modes must save time.
const DEFAULT_EXPECTED_STEPS: usize = 4_000;

/// Largest number of degrees of freedom of which all modes may replace Ritz modes that are not accurate.
const MAX_FALLBACK_DOFS: usize = 1_000;
/// The same with many forces, where a tolerance below some 1e-4 is often beyond the Ritz modes: their computation takes
/// seven seconds.
const MAX_FALLBACK_DOFS_OF_MANY_FORCES: usize = 2_500;

/// Needs of [`Coordinates::Modes`].
const MODAL_COORDINATES_NEED: &str = "a linear structure with symmetric matrices, a positive definite mass and a \
                      damping that the modes decouple";

/// Times in nanoseconds for the choice of coordinates, as measured by `benches/studies/benches/step.rs`.
mod cost {
    /// Per entry of a sparse factor or matrix, and use.
    pub(crate) const SPARSE_ENTRY: f64 = 1.0;
    /// Per mode and step, in addition to a degree of freedom.
    pub(crate) const MODE_AND_STEP: f64 = 4.0;
    /// Per mode, contact component and step, in addition to degrees of freedom.
    pub(crate) const MODE_AND_CONTACT: f64 = 0.15;
    /// Per squared and per cubed number of modes, for computing them.
    pub(crate) const ALL_MODES: [f64; 2] = [60.0, 0.45];
}

/// Matrices, base and operators of a structure, in the stepping coordinates.
pub(crate) struct Stepped {
    pub(crate) model: Model,
    pub(crate) base: PlacedBase,
    pub(crate) operators: Operators,
}

impl Stepped {
    /// Chooses the coordinates, and factors the effective stiffness in them.
    ///
    /// The effective stiffness of the degrees of freedom is factored only if they are stepped or the choice needs
    /// it. `reduction`: input of [`Reduction`], for reduced coordinates.
    pub(crate) fn choose(
        parts: &Parts,
        assembled: &Assembled,
        reduction: Option<(FixedBaseResponses, Option<Rc<Floating>>)>,
        at_rest: &StaticState,
    ) -> Result<Self> {
        let Parts { builder, coefficients, .. } = parts;
        let structure = parts.structure.as_ref();
        let tangent = Tangent::at(structure, &at_rest.displacement)?.matrix;
        let steps = if builder.steps > 0 { builder.steps } else { DEFAULT_EXPECTED_STEPS };
        let physical = Model::new(assembled);
        let factored = || {
            let factor = Factor::of_dofs(&physical, coefficients, &tangent);
            factor.map_err(|error| cause(assembled, structure, &tangent, error))
        };
        let chosen = match builder.coordinates {
            Coordinates::Physical => Chosen::Physical(factored()?),
            Coordinates::Auto => {
                let factor = factored()?;
                let modes = cheaper_modes(assembled, factor.entry_count(), steps);
                modes.map_or(Chosen::Physical(factor), Chosen::Modes)
            }
            Coordinates::Modes => {
                let Some(modes) = vibration_modes(assembled) else {
                    // A singular matrix is reported first.
                    factored()?;
                    return Err(Error::Scene {
                        quantity: "modal coordinates",
                        needed: MODAL_COORDINATES_NEED,
                    });
                };
                Chosen::Modes(modes)
            }
            Coordinates::Reduced { tolerance } => {
                let (fixed_base, floating) = reduction.unwrap_or_default();
                let responses = (fixed_base, floating, &factored as &Factored<'_>);
                let reduction = Reduction::new(parts, assembled, responses, steps)?;
                let max_dofs = if reduction.has_many_forces() {
                    MAX_FALLBACK_DOFS_OF_MANY_FORCES
                } else {
                    MAX_FALLBACK_DOFS
                };
                let modes = reduction.modes(tolerance);
                Chosen::Modes(modes.or_else(|error| instead_of_few(assembled, max_dofs, error))?)
            }
        };
        let (model, factor) = match chosen {
            Chosen::Physical(factor) => (physical, Factor::Sparse(factor)),
            Chosen::Modes(modes) => {
                let model = physical.in_modes(assembled, modes);
                let factor = Factor::of_modes(&model, coefficients)?;
                (model, factor)
            }
        };
        let base = assembled.base.stepped(&model.transformation);
        let operators = Operators::new(&model, &base, &parts.soil, factor, tangent)?;
        Ok(Self { model, base, operators })
    }
}

/// Coordinates, and the matrices already computed for them.
enum Chosen {
    Physical(Box<SparseFactor>),
    Modes(ModalBasis),
}

/// All modes of a structure of up to `max_dofs` degrees of freedom for which fewer do not suffice; otherwise `error`.
fn instead_of_few(assembled: &Assembled, max_dofs: usize, error: Error) -> Result<ModalBasis> {
    let is_small = matches!(error, Error::Accuracy { .. }) && assembled.dofs() <= max_dofs;
    let all = if is_small { vibration_modes(assembled) } else { None };
    all.ok_or(error)
}

/// Cause of `error`: the reason why the effective stiffness cannot be factored.
fn cause(
    assembled: &Assembled,
    structure: &dyn Structure,
    tangent: &SparseMatrix,
    error: Error,
) -> Error {
    let Assembled { mass, damping, stiffness, .. } = assembled;
    let terms = [(1.0, &**stiffness), (1.0, tangent)];
    let sum = SparseMatrix::sum("stiffness matrix", assembled.dofs(), &terms).ok();
    let mechanism = sum.and_then(|sum| unresisted(structure, &sum, [&**damping, &**mass]));
    mechanism.map_or(error, |cause| Error::Stability(Box::new(cause)))
}

/// The modes, if stepping in them takes less time, including their computation.
///
/// `factor`: number of entries of the sparse factor.
fn cheaper_modes(assembled: &Assembled, factor: usize, steps: usize) -> Option<ModalBasis> {
    let n = assembled.dofs() as f64;
    let steps = steps as f64;
    let contact = assembled.base.layout().len();
    let entry_count: usize = assembled.matrices().into_iter().map(SparseMatrix::entry_count).sum();
    let sparse = cost::SPARSE_ENTRY * (2 * factor + 2 * entry_count) as f64;
    let modal = cost::MODE_AND_STEP * n + cost::MODE_AND_CONTACT * n * contact as f64;
    let computation = cost::ALL_MODES[0] * n.powi(2) + cost::ALL_MODES[1] * n.powi(3);
    let saves_time = modal * steps + computation < sparse * steps;
    if saves_time { vibration_modes(assembled) } else { None }
}
