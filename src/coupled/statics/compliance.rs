//! Compliance of a structure without supports, for its static state.

use std::rc::Rc;
use std::sync::Arc;

use crate::contact::Delassus;
use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::UPWARD_DIRECTION;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::model::operators::condense;
use crate::error::{Error, Result};
use crate::linalg::{CompressedMatrix, SparseFactor, SparseMatrix, sparse_condition};

pub(super) const STATIC_STIFFNESS_NAME: &str = "static stiffness matrix";
/// Initial stiffness of the fictitious springs, as a fraction of the foundation's.
pub(super) const PROXIMAL_SPRING_FRACTION: f64 = 1e-4;

/// Factored K + D + εM.
pub(crate) struct Floating {
    /// ε.
    pub(crate) springs: f64,
    matrix: Arc<SparseMatrix>,
    pub(crate) factor: SparseFactor,
}

/// Factored K + D + εM, its response to unit tractions, and the static Delassus operator.
pub(crate) struct Compliance {
    pub(crate) floating: Rc<Floating>,
    pub(crate) columns: Vec<f64>,
    pub(crate) delassus: Delassus,
}

impl Floating {
    /// Factors the matrix for springs of stiffness `springs` per mass.
    pub(crate) fn new(assembled: &Assembled, tangent: &SparseMatrix, springs: f64) -> Result<Self> {
        let Assembled { stiffness, mass, .. } = assembled;
        let terms = [(1.0, &**stiffness), (1.0, tangent), (springs, mass)];
        let matrix = SparseMatrix::sum(STATIC_STIFFNESS_NAME, assembled.dofs(), &terms)?;
        let factor =
            SparseFactor::with_elimination(STATIC_STIFFNESS_NAME, &matrix, &assembled.elimination)?;
        Ok(Self { springs, matrix: matrix.into(), factor })
    }

    /// The whole of a condensed structure, on the springs at its base only.
    pub(crate) fn of_whole(&self, whole: &Assembled, condensed: Condensed) -> Option<Self> {
        let factor = condensed.on_springs(&self.matrix)?;
        Some(Self { springs: self.springs, matrix: Arc::clone(&whole.stiffness), factor })
    }

    /// The matrix, if it is positive definite.
    pub(crate) fn positive_definite(&self) -> Option<&SparseMatrix> {
        self.factor.is_positive_definite().then_some(&self.matrix)
    }

    /// Condition of the matrix, scaled by its diagonal.
    pub(crate) fn condition(&self) -> f64 {
        sparse_condition(&self.matrix, &self.factor)
    }
}

impl Compliance {
    /// Compliance on a base, over a soil of this static compliance.
    ///
    /// Returns an error for more elements than the entries of W allow.
    pub(crate) fn new(
        floating: Rc<Floating>,
        base: &PlacedBase,
        soil: &CompressedMatrix,
    ) -> Result<Self> {
        let order = floating.matrix.order();
        let (columns, delassus) =
            condense(|rhs| floating.factor.solve_many(rhs), base, soil, order)?;
        Ok(Self { floating, columns, delassus })
    }
}

/// Initial stiffness of the fictitious springs per mass, ε.
pub(crate) fn springs(assembled: &Assembled, soil: &CompressedMatrix) -> Result<f64> {
    let foundation = vertical_stiffness(soil, &assembled.base);
    let stiffness = PROXIMAL_SPRING_FRACTION * foundation / total_mass(assembled);
    if stiffness.is_finite() {
        return Ok(stiffness);
    }
    Err(Error::Singular { matrix: STATIC_STIFFNESS_NAME, order: assembled.dofs() })
}

/// Mass that moves in a vertical translation.
fn total_mass(assembled: &Assembled) -> f64 {
    let up = assembled.influence.of(UPWARD_DIRECTION, assembled.dofs());
    assembled.mass.form(&up, &up)
}

/// Vertical force per settlement of the soil under a uniform pressure.
fn vertical_stiffness(soil: &CompressedMatrix, base: &PlacedBase) -> f64 {
    let areas = base.areas();
    let size = base.layout().len();
    let count = areas.len();
    let area = areas.iter().sum::<f64>();
    // Integral of the settlement under a unit pressure.
    let settled_volume: f64 = match soil.as_diagonal() {
        Some(diagonal) => areas.iter().zip(diagonal).map(|(area, entry)| area * entry).sum(),
        None => (0..count)
            .map(|p| areas[p] * (0..count).map(|q| soil[p * size + q]).sum::<f64>())
            .sum(),
    };
    area * area / settled_volume
}
