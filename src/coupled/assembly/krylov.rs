//! Reduced coordinates: Ritz modes of a rational block Krylov space.
//!
//! | symbol | meaning |
//! |---|---|
//! | F | rows of degrees of freedom where forces act or probes read |
//! | σ | shifts, starting with the scheme's shift √(a/k): 2/Δt for the midpoint rule |
//! | Z | K_eff for the scheme's shift, K + σ² M for others |
//!
//! The space holds rigid motions and Z⁻¹Fᵀ, Z⁻¹M Z⁻¹Fᵀ and so on: each round adds one power of every shift (Ruhe
//! 1984; Grimme 1997). Each power of K_eff makes two more steps after a change of traction exact. Lower shifts
//! represent modes at lower frequencies, of which few are soon complete; one higher shift represents motion that a
//! step cannot follow.
//!
//! With many forces: `many_forces.rs`.

use std::cell::Cell;
use std::rc::Rc;

use crate::coupled::assembly::fixed_base_results::FixedBaseResponses;
use crate::coupled::assembly::step_response::{ResponseRows, StepResponses};
use crate::coupled::assembly::subspace::{REDUCED_COORDINATES_NAME, Ritz, Subspace};
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::parts::Parts;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::statics::compliance::Floating;
use crate::error::{Error, Result, finite, require, require_part};
use crate::linalg::matrix::spread;
use crate::linalg::{SparseFactor, SparseMatrix};
use crate::structure::proportional_factors;

/// Ratio of a shift to the previous one.
const SHIFT_RATIO: f64 = 4.0;
/// Number of forces from which vibration modes and static responses replace shifts.
const MANY_FORCES_THRESHOLD: usize = 100;
/// A direction is left out if its part outside the space is below this fraction, and below this multiple of the root
/// of the tolerance.
///
/// The responses depend on the square of that fraction.
pub(super) const MIN_NEW_FRACTION: f64 = 1e-2;
const NEW_FRACTION_PER_ROOT_TOLERANCE: f64 = 10.0;
/// Smallest new fraction of a direction, in the last rounds.
pub(super) const FINAL_MIN_NEW_FRACTION: f64 = 1e-7;
/// Smallest ratio of a round's change to the previous round's in the prediction.
pub(super) const MIN_CHANGE_RATIO: f64 = 0.1;
/// Largest number of rounds; half of them if the tolerance cannot be expected.
const MAX_KRYLOV_ROUNDS: usize = 16;
/// Smallest ratio of the lowest shift to the scheme's.
const MIN_SHIFT_RATIO: f64 = 1e-6;
/// Largest number of steps over which responses are compared.
const MAX_COMPARED_STEPS: usize = 10_000;

const DYNAMIC_STIFFNESS_NAME: &str = "dynamic stiffness matrix";

/// Number of times at which the structure's own load is sampled.
const LOAD_SAMPLE_COUNT: u32 = 16;

/// Factors an effective stiffness.
pub(crate) type Factored<'a> = dyn Fn() -> Result<Box<SparseFactor>> + 'a;

/// Input of a reduction.
///
/// Rows have an entry for every degree of freedom.
pub(crate) struct Reduction<'a> {
    pub(super) assembled: &'a Assembled,
    pub(super) coefficients: &'a SchemeCoefficients,
    /// Factors K_eff.
    pub(super) factored: &'a Factored<'a>,
    pub(super) fixed_base: FixedBaseResponses,
    /// Factored K + εM, until it is used.
    pub(super) floating: Cell<Option<Rc<Floating>>>,
    /// β and α of a damping in proportion to mass and to the stiffness without P–Δ.
    pub(super) without_p_delta: Option<[f64; 2]>,
    /// Steps of the run.
    steps: usize,
    /// Rows of the probes that are not zero.
    pub(super) rows: ResponseRows,
    /// Displacements that the modes must contain.
    pub(super) motions: Vec<f64>,
}

impl<'a> Reduction<'a> {
    /// Collects forces and probes of a structure.
    ///
    /// `factored`: factors its effective stiffness. `floating`: its stiffness without supports, if it is known.
    pub(crate) fn new(
        parts: &'a Parts,
        assembled: &'a Assembled,
        (fixed_base, floating, factored): (
            FixedBaseResponses,
            Option<Rc<Floating>>,
            &'a Factored<'a>,
        ),
        steps: usize,
    ) -> Result<Self> {
        let mut rows = ResponseRows::default();
        collect_loads(&mut rows, parts, assembled.dofs(), steps)?;
        collect_tractions(&mut rows, assembled);
        let motions = collect_motions(&mut rows, parts, assembled);
        collect_probes(&mut rows, parts, assembled.dofs());
        let floating = Cell::new(floating);
        let damping = &assembled.damping;
        let is_proportional = damping.is_empty()
            || proportional_factors(damping, [&assembled.stiffness, &assembled.mass]).is_some();
        let without_p_delta = if is_proportional {
            None
        } else {
            assembled.damping_without_p_delta(parts.structure.as_ref())
        };
        Ok(Self {
            assembled,
            coefficients: &parts.coefficients,
            factored,
            fixed_base,
            floating,
            without_p_delta,
            steps,
            rows,
            motions,
        })
    }

    /// The Ritz modes whose responses to forces are within `tolerance`.
    pub(crate) fn modes(&self, tolerance: f64) -> Result<ModalBasis> {
        const TOLERANCE_NAME: &str = "tolerance of reduced coordinates";
        finite(TOLERANCE_NAME, tolerance)?;
        require(
            TOLERANCE_NAME,
            tolerance,
            tolerance > 0.0 && tolerance < 1.0,
            "above 0 and below 1",
        )?;
        let matrices = self.matrices()?;
        if self.has_many_forces() {
            return self.modes_of_many(tolerance, matrices);
        }
        self.modes_of_few(tolerance, matrices)
    }

    /// Whether vibration modes and static responses replace shifts.
    pub(super) fn has_many_forces(&self) -> bool {
        self.rows.force_count >= MANY_FORCES_THRESHOLD
    }

    /// The rigid motions; `rounding`: of the vectors' orthogonality after one pass.
    pub(super) fn rigid<'m>(&self, matrices: [&'m SparseMatrix; 3], rounding: f64) -> Subspace<'m> {
        let translations = self.assembled.influence.translations(self.assembled.dofs());
        let mut space = Subspace::new(matrices, translations, rounding);
        if let Some(proportional) = self.without_p_delta {
            space = space.with_proportional_damping(proportional);
        }
        space.extend(self.fixed_base.rotations.clone(), FINAL_MIN_NEW_FRACTION);
        space
    }

    /// Ritz modes for few forces: powers of several shifts.
    fn modes_of_few(&self, tolerance: f64, matrices: [&SparseMatrix; 3]) -> Result<ModalBasis> {
        let mut space = self.rigid(matrices, 0.0);
        space.extend(self.motions.clone(), FINAL_MIN_NEW_FRACTION);
        let rows = &self.rows.all;
        let count = (rows.len() / self.assembled.dofs()).max(1);
        self.floating.take();
        let effective = self.effective()?;
        let factors = self.shifts().map(|shift| self.shifted(shift)).collect::<Result<Vec<_>>>()?;
        let factors: Vec<_> = std::iter::once(&*effective).chain(&factors).collect();
        let mut blocks = vec![rows.clone(); factors.len()];
        // Rows in terms of the vectors.
        let mut products = Vec::new();
        let mut min_fraction =
            MIN_NEW_FRACTION.min(NEW_FRACTION_PER_ROOT_TOLERANCE * tolerance.sqrt());
        let mut last: Option<StepResponses> = None;
        let mut change = f64::INFINITY;
        let mut reached = f64::INFINITY;
        for round in 1..=MAX_KRYLOV_ROUNDS {
            if !grow(&mut space, &factors, &mut blocks, min_fraction) {
                if min_fraction <= FINAL_MIN_NEW_FRACTION {
                    let modes = space.ritz()?;
                    return self.basis(space, &modes, &factors, tolerance);
                }
                // Repeats with a lower limit for the directions that were left out.
                min_fraction = FINAL_MIN_NEW_FRACTION.max(MIN_NEW_FRACTION * min_fraction);
                blocks.fill(rows.clone());
                continue;
            }
            let modes = space.ritz()?;
            products.extend(space.products(products.len() / count, rows));
            let modal_rows = Subspace::modal_rows(&modes, &products);
            let responses = self.responses(&modes, modal_rows, 0);
            let mut rate = 1.0;
            if let Some(last) = &last {
                let new_change = responses.difference(last, tolerance);
                if change.is_finite() {
                    rate = (new_change / change).clamp(MIN_CHANGE_RATIO, 1.0);
                }
                change = new_change;
                // Estimated change by the next round, at the rate of this round.
                reached = new_change * rate;
            }
            if reached <= tolerance || space.count() == self.assembled.dofs() {
                return self.basis(space, &modes, &factors, tolerance);
            }
            let remaining_rounds = i32::try_from(MAX_KRYLOV_ROUNDS - round).unwrap_or(0);
            if 2 * round >= MAX_KRYLOV_ROUNDS && reached * rate.powi(remaining_rounds) > tolerance {
                break;
            }
            last = Some(responses);
        }
        let vectors = space.count();
        let remedy = format!("with {vectors} vectors; damping in proportion to stiffness helps");
        Err(inaccurate(reached, tolerance, remedy))
    }

    /// Factored K_eff, with the proportional damping if the damping differs from it by P–Δ alone.
    pub(super) fn effective(&self) -> Result<Box<SparseFactor>> {
        let Some([beta, alpha]) = self.without_p_delta else {
            return (self.factored)();
        };
        let mass: &SparseMatrix = &self.assembled.mass;
        let c = self.coefficients;
        let mass_factor = c.acceleration[0] + c.velocity[0] * alpha;
        let stiffness_factor = c.displacement[0] + c.velocity[0] * beta;
        let terms = [(mass_factor, mass), (stiffness_factor, &self.assembled.stiffness)];
        let matrix = SparseMatrix::sum(DYNAMIC_STIFFNESS_NAME, mass.order(), &terms)?;
        SparseFactor::with_elimination(DYNAMIC_STIFFNESS_NAME, &matrix, &self.assembled.elimination)
            .map(Box::new)
    }

    /// Responses over the steps of the run to forces that grow over `growth_steps` steps.
    pub(super) fn responses(
        &self,
        modes: &Ritz,
        modal_rows: Vec<f64>,
        growth_steps: usize,
    ) -> StepResponses {
        let steps = self.steps.clamp(1, MAX_COMPARED_STEPS);
        StepResponses::new(modes, modal_rows, &self.rows, self.coefficients, steps, growth_steps)
    }

    /// Mass, damping and stiffness; an error if they cannot be reduced.
    fn matrices(&self) -> Result<[&SparseMatrix; 3]> {
        require_part(
            REDUCED_COORDINATES_NAME,
            self.assembled.linear,
            "they need a linear structure",
        )?;
        let matrices = self.assembled.matrices();
        let names = ["mass matrix", "damping matrix", "stiffness matrix"];
        for (matrix, name) in matrices.iter().zip(names) {
            if matrix.asymmetry() > 1e-13 {
                let needed = "it must be symmetric";
                let error = Error::Scene { quantity: name, needed };
                return Err(error.within(REDUCED_COORDINATES_NAME));
            }
        }
        if !self.assembled.is_massive {
            let needed = "it must be positive definite";
            let error = Error::Scene { quantity: names[0], needed };
            return Err(error.within(REDUCED_COORDINATES_NAME));
        }
        Ok(matrices)
    }

    /// The shifts below the scheme's, and one above it, 1/s.
    fn shifts(&self) -> impl Iterator<Item = f64> + use<> {
        let Assembled { mass, stiffness, .. } = self.assembled;
        let pairs = stiffness.diagonal().into_iter().zip(mass.diagonal());
        let max_shift = pairs.fold(0.0, |largest: f64, (k, m)| largest.max(k / m)).sqrt();
        let c = self.coefficients;
        let scheme_shift =
            (c.acceleration[0] / c.displacement[0]).sqrt().min(SHIFT_RATIO * max_shift);
        let lowest = self.fixed_base.lowest.max(MIN_SHIFT_RATIO * scheme_shift);
        let first_below = scheme_shift / SHIFT_RATIO;
        let below = std::iter::successors(Some(first_below), |shift| Some(shift / SHIFT_RATIO))
            .take_while(move |shift| *shift > lowest);
        let above = std::iter::once(SHIFT_RATIO * scheme_shift);
        above.chain(below).filter(move |shift| *shift < max_shift)
    }

    /// Factored K + σ²M at a shift σ.
    fn shifted(&self, shift: f64) -> Result<SparseFactor> {
        let Assembled { mass, stiffness, .. } = self.assembled;
        let terms = [(shift * shift, &**mass), (1.0, &**stiffness)];
        let matrix = SparseMatrix::sum(DYNAMIC_STIFFNESS_NAME, mass.order(), &terms)?;
        SparseFactor::with_elimination(DYNAMIC_STIFFNESS_NAME, &matrix, &self.assembled.elimination)
    }
}

/// Adds the loads of a scene, and samples of the structure's own load.
fn collect_loads(rows: &mut ResponseRows, parts: &Parts, dofs: usize, steps: usize) -> Result<()> {
    for load in &parts.builder.loads {
        push_nonzero(&mut rows.all, spread(load.row(), dofs));
    }
    let duration = steps as f64 * parts.builder.time_step;
    for sample in 0..=LOAD_SAMPLE_COUNT {
        let time = duration * f64::from(sample) / f64::from(LOAD_SAMPLE_COUNT);
        let mut load = vec![0.0; dofs];
        let loaded = parts.structure.load(time, &mut load);
        if sample == 0 {
            loaded?;
        } else if loaded.is_err() {
            // The run may end before that time.
            continue;
        }
        if load.iter().all(|force| force.is_finite()) {
            push_nonzero(&mut rows.all, load);
        }
    }
    rows.load_count = rows.all.len() / dofs;
    Ok(())
}

/// Adds the forces by a unit traction on each component of each element.
fn collect_tractions(rows: &mut ResponseRows, assembled: &Assembled) {
    let size = assembled.base.layout().len();
    let mut unit = vec![0.0; size];
    for place in 0..size {
        let mut force = vec![0.0; assembled.dofs()];
        unit[place] = 1.0;
        assembled.base.add_forces(1.0, &unit, &mut force);
        unit[place] = 0.0;
        push_nonzero(&mut rows.all, force);
    }
}

/// Adds the momenta of the initial displacement and velocity, and returns both.
fn collect_motions(rows: &mut ResponseRows, parts: &Parts, assembled: &Assembled) -> Vec<f64> {
    let dofs = assembled.dofs();
    let mut motions = Vec::new();
    for motion in [&parts.builder.displacement, &parts.builder.velocity] {
        for motion in motion.chunks_exact(dofs) {
            let mut force = vec![0.0; dofs];
            assembled.mass.multiply_add(1.0, motion, &mut force);
            push_nonzero(&mut rows.all, force);
        }
        motions.extend_from_slice(motion);
    }
    rows.force_count = rows.all.len() / dofs;
    motions
}

/// Adds the rows of the probes: of displacements, velocities and accelerations.
fn collect_probes(rows: &mut ResponseRows, parts: &Parts, dofs: usize) {
    let probes = &parts.builder.probes;
    rows.probes = vec![[None; 3]; probes.len()];
    for kind in 0..3 {
        if kind == 2 {
            rows.first_acceleration = rows.all.len() / dofs;
        }
        for (probe, places) in probes.iter().zip(&mut rows.probes) {
            let place = rows.all.len() / dofs;
            let is_nonzero = push_nonzero(&mut rows.all, spread(probe.rows()[kind], dofs));
            places[kind] = is_nonzero.then_some(place);
        }
    }
}

/// Adds the next power of each shift to the space; returns whether there is a new direction.
fn grow(
    space: &mut Subspace<'_>,
    factors: &[&SparseFactor],
    blocks: &mut [Vec<f64>],
    min_fraction: f64,
) -> bool {
    let start = space.count();
    for (factor, block) in factors.iter().zip(blocks) {
        let before = space.count();
        factor.solve_many(block);
        space.extend(std::mem::take(block), min_fraction);
        block.extend_from_slice(space.momenta(before));
    }
    space.count() > start
}

/// Adds a row unless it is zero; returns whether it was added.
fn push_nonzero(rows: &mut Vec<f64>, row: Vec<f64>) -> bool {
    let is_nonzero = row.iter().any(|value| *value != 0.0);
    if is_nonzero {
        rows.extend(row);
    }
    is_nonzero
}

/// Error for reduced coordinates that do not reach a tolerance.
pub(super) fn inaccurate(reached: f64, tolerance: f64, remedy: String) -> Error {
    let quantity = "response of reduced coordinates to tractions";
    Error::Accuracy { quantity, reached, tolerance, remedy }
}
