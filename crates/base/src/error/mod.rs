//! Errors: each names the quantity, its value and the requirement.
//!
//! The text of an error contains the text of its cause, and `source()` returns `None`. Printed alone the error is
//! complete, and printed with its chain of sources nothing occurs twice. A field called `source` is therefore
//! written `r#source`, which `thiserror` does not treat as a source.

mod checkpoint;
mod file;
mod ground;
pub mod memory;
mod progress;
mod requirement;
mod stability;
mod step;
mod sweep;

pub use checkpoint::CheckpointError;
pub use file::{FileError, FileFault};
pub use ground::{GroundError, PlanError, SoilError};
#[allow(deprecated, reason = "the path stays for one release")]
pub use memory::set_memory_limit;
pub use memory::{MemoryError, memory_limit};
pub use progress::{Observer, Progress, ProgressReporter, unobserved};
pub use requirement::{
    all_finite, at_least, damping_ratio, finite, in_bounds, in_brackets, names, not_finite,
    not_negative, positive, require, require_part, same_length, short,
};
pub use stability::{CoarseBaseError, StabilityError, StructureError};
pub use stability::{along, of_units};
pub use step::{LawError, StepError};
pub use sweep::{CaseError, SweepError};

/// Result of every fallible function of the crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Faults of this crate, with the quantity, its value and the requirement.
///
/// The printed text of an error is complete: it contains the text of its cause. The cause is in a field and not in
/// [`source`](std::error::Error::source), so chains of sources do not repeat it. `Debug` prints the same text, for
/// `unwrap` and for a `main` that returns [`Result`].
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number out of its range (NaN and infinities included).
    #[error("{quantity} is {}, but must be {needed}", short(*.value))]
    Input {
        /// Name of the quantity.
        quantity: &'static str,
        /// The value.
        value: f64,
        /// Requirement.
        needed: &'static str,
    },
    /// A number of a list that is NaN or infinite.
    #[error("{quantity} is not finite: entry {index} is {value}")]
    NotFinite {
        /// Name of the list.
        quantity: &'static str,
        /// Place in the list, from 0: a degree of freedom, or the number of a load.
        index: usize,
        /// The value.
        value: f64,
    },
    /// A slice or list of the wrong length.
    #[error("{quantity} has length {found}, but must have {needed}")]
    Size {
        /// Name of the quantity.
        quantity: &'static str,
        /// The length.
        found: usize,
        /// Required length.
        needed: usize,
    },
    /// A size that would not fit into memory.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// An index that points outside its list.
    #[error("{quantity}: index {index} must be below {bound}")]
    Index {
        /// Name of the quantity.
        quantity: &'static str,
        /// The index.
        index: usize,
        /// Smallest index that is out of range.
        bound: usize,
    },
    /// A file that cannot be read or written, or whose content cannot be right.
    #[error(transparent)]
    File(#[from] FileError),
    /// A name that does not exist.
    #[error("there is no {quantity} '{name}'{}", names(.known))]
    Name {
        /// Kind of the item.
        quantity: &'static str,
        /// The unknown name.
        name: String,
        /// The names that are known.
        known: Vec<String>,
    },
    /// A name that occurs more than once.
    #[error("more than one {quantity} is called '{name}'")]
    DuplicateName {
        /// Kind of the items.
        quantity: &'static str,
        /// The name.
        name: String,
    },
    /// A fault of one of several items: of a probe, a layer, an element, a parameter.
    #[error("{item}: {source}")]
    Item {
        /// The item, with its name or number.
        item: String,
        /// Its fault.
        r#source: Box<Error>,
    },
    /// A point without a node.
    #[error(
        "no node at {}: the nearest, at {}, is {distance} m away",
        in_brackets(point, &[*point, *nearest]), in_brackets(nearest, &[*point, *nearest])
    )]
    NoNode {
        /// Coordinates of the point, m.
        point: [f64; 3],
        /// Coordinates of the nearest node, m.
        nearest: [f64; 3],
        /// Distance to it, m.
        distance: f64,
    },
    /// A part of the scene that is missing, or does not fit another part.
    #[error("{quantity}: {needed}")]
    Scene {
        /// Name of the part.
        quantity: &'static str,
        /// Requirement.
        needed: &'static str,
    },
    /// A part that the user wrote and that does not accept the scene, a file or a checkpoint: see [`Error::part`].
    #[error("{part}: {reason}")]
    Part {
        /// Name of the part.
        part: String,
        /// Reason that the part gives.
        reason: String,
    },
    /// A matrix that cannot be factored.
    #[error("{matrix} of order {order} is singular or not finite")]
    Singular {
        /// Name of the matrix.
        matrix: &'static str,
        /// Order of the matrix.
        order: usize,
    },
    /// A matrix with which a motion would gain energy without end.
    ///
    /// It has negative mass or damping, or columns above their buckling load.
    #[error(
        "{matrix} is not positive semi-definite: it shows at row {row}, which has {diagonal:e} on the \
         diagonal"
    )]
    Indefinite {
        /// Name of the matrix.
        matrix: &'static str,
        /// Row, and degree of freedom, at which the factorisation shows it.
        row: usize,
        /// Entry on the diagonal there.
        diagonal: f64,
    },
    /// A matrix that must be symmetric.
    #[error("{matrix} must be symmetric: entry ({row}, {column}) is {:e}, entry ({column}, {row}) {:e}",
        entries[0], entries[1])]
    Unsymmetric {
        /// Name of the matrix.
        matrix: &'static str,
        /// Row of the first of two entries that differ.
        row: usize,
        /// Its column.
        column: usize,
        /// Both entries.
        entries: [f64; 2],
    },
    /// A matrix of the step too ill-conditioned for double precision.
    #[error(
        "{matrix}: condition about {condition:.1e}, but double precision carries {limit:.0e}; \
         cause: {quantity}, {ratio:.1e}"
    )]
    IllConditioned {
        /// Name of the matrix.
        matrix: &'static str,
        /// Estimated condition number; infinite if the matrix is singular.
        condition: f64,
        /// Largest accepted condition number.
        limit: f64,
        /// Cause.
        quantity: &'static str,
        /// Size of the cause.
        ratio: f64,
    },
    /// The static state under the structure's weight was not found.
    #[error(
        "no static equilibrium after {iterations} iterations: residual {residual:.2e} of the load \
         (loads are balanced and the structure is not a mechanism: check whether a part of it, or of its soil, is loaded \
         beyond its capacity)"
    )]
    Preload {
        /// Iterations made.
        iterations: usize,
        /// Last change, relative to the load.
        residual: f64,
    },
    /// Weight and loads at t = 0 that cannot be carried, and the reason.
    #[error("the structure cannot stand: {0}")]
    Stability(Box<StabilityError>),
    /// A flexible base with too few contact elements for its static state.
    #[error(transparent)]
    CoarseBase(#[from] CoarseBaseError),
    /// An interface law returned an invalid value before the first step.
    #[error(transparent)]
    Law(#[from] LawError),
    /// A structure that cannot stand on a ground, whatever its loads.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// An accuracy that is not reached.
    #[error("{quantity}: relative error {reached:e}, but {tolerance:e} was asked for ({remedy})")]
    Accuracy {
        /// Name of the approximation.
        quantity: &'static str,
        /// Smallest relative error that was reached.
        reached: f64,
        /// Relative error that is allowed.
        tolerance: f64,
        /// Circumstances and remedies.
        remedy: String,
    },
    /// Convolution weights or their exponentials that could generate energy, so that runs could grow.
    #[error(
        "{quantity} is not passive: least eigenvalue {margin:e}, but at least {allowed:e} is needed, at {angle} radians \
         per step on the circle |z| = {radius} (a smaller tolerance helps)"
    )]
    NotPassive {
        /// Name of the operator.
        quantity: &'static str,
        /// Least eigenvalue of its Hermitian part: of exponentials relative to the step compliance, of weights relative
        /// to its trace.
        margin: f64,
        /// Smallest accepted value.
        allowed: f64,
        /// Angle on the circle, radians per step.
        angle: f64,
        /// Radius of the circle.
        radius: f64,
    },
    /// A call that its [`Observer`] stopped; everything is as before the call.
    #[error("stopped by its observer: {0}")]
    Stopped(Progress),
    /// A soil through which waves do not travel as requested.
    #[error(transparent)]
    Soil(#[from] SoilError),
    /// A ground that cannot be computed or used.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// A mat in plan that cannot be computed.
    #[error("mat in plan: {0}")]
    Plan(PlanError),
    /// Parameters, a table or files of a sweep that cannot be used.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// A run could not be saved or resumed.
    #[error("checkpoint: {0}")]
    Checkpoint(CheckpointError),
    /// A time step that could not be solved; the simulation stays at the last accepted step.
    #[error("step {step} (t = {} s): {source}", short(*.time))]
    Step {
        /// Number of the step that failed, from 1.
        step: usize,
        /// Time at its end, s.
        time: f64,
        /// Failure of the step.
        r#source: StepError,
    },
}

// `#[from]` would make them sources, whose texts the error's own text contains.

impl From<CheckpointError> for Error {
    fn from(error: CheckpointError) -> Self {
        Self::Checkpoint(error)
    }
}

impl From<PlanError> for Error {
    fn from(error: PlanError) -> Self {
        Self::Plan(error)
    }
}

impl std::fmt::Debug for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
