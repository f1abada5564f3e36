//! Errors: each names the quantity, its value and the requirement.
//!
//! The text of an error contains the text of its cause, and `source()` returns `None`. Printed alone the error is
//! complete, and printed with its chain of sources nothing occurs twice. A field called `source` is therefore
//! written `r#source`, which `thiserror` does not treat as a source.

mod file;
mod ground;
pub mod memory;
mod progress;
mod requirement;
mod stability;
mod step;
mod sweep;

pub use file::{CheckpointError, FileError, FileFault};
pub use ground::{GroundError, PlanError, SoilError};
#[allow(deprecated, reason = "the path stays for one release")]
pub use memory::set_memory_limit;
pub use memory::{MemoryError, memory_limit};
pub use progress::{Observer, Progress, ProgressReporter, unobserved};
pub use requirement::{
    all_finite, at_least, damping_ratio, finite, first_not_finite, in_bounds, not_negative,
    number_text, point_text, positive, require, require_part, same_length, valid_names_text,
};
pub use stability::{CoarseBaseError, StabilityError, StructureError};
pub use stability::{axis_text, units_hint};
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
    #[error("{quantity} is {}, but must be {needed}", number_text(*.value))]
    Input {
        /// Name of the quantity.
        quantity: &'static str,
        /// The value.
        value: f64,
        /// Requirement.
        needed: &'static str,
    },
    /// A list with an entry that is NaN or infinite.
    #[error("{quantity} is not finite: entry {index} is {value}")]
    NotFinite {
        /// Name of the list.
        quantity: &'static str,
        /// Index of the entry, from 0: a degree of freedom, or the number of a load.
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
    /// A size that needs more memory than is allowed.
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
    #[error("there is no {quantity} '{name}'{}", valid_names_text(.known))]
    Name {
        /// Kind of the item.
        quantity: &'static str,
        /// The unknown name.
        name: String,
        /// The names that exist.
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
    /// A fault of one item, such as a probe, a layer, an element or a parameter.
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
        point_text(point, &[*point, *nearest]), point_text(nearest, &[*point, *nearest])
    )]
    NoNode {
        /// Coordinates of the point, m.
        point: [f64; 3],
        /// Coordinates of the nearest node, m.
        nearest: [f64; 3],
        /// Distance to it, m.
        distance: f64,
    },
    /// A part of the scene is missing, or contradicts another part.
    #[error("{quantity}: {needed}")]
    Scene {
        /// Name of the part.
        quantity: &'static str,
        /// Requirement.
        needed: &'static str,
    },
    /// A part that the user wrote rejects the scene, a file or a checkpoint: see [`Error::part`].
    #[error("{part}: {reason}")]
    Part {
        /// Name of the part.
        part: String,
        /// Reason that the part states.
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
    /// A matrix that is not positive semi-definite: motions would grow without limit.
    ///
    /// The cause is a negative mass or damping, or a column above its buckling load.
    #[error(
        "{matrix} is not positive semi-definite: its factorisation fails at row {row}, whose diagonal entry is \
         {diagonal:e}"
    )]
    Indefinite {
        /// Name of the matrix.
        matrix: &'static str,
        /// Row (degree of freedom) at which the factorisation fails.
        row: usize,
        /// Diagonal entry of this row.
        diagonal: f64,
    },
    /// A matrix that must be symmetric.
    #[error("{matrix} must be symmetric: entry ({row}, {column}) is {:e}, entry ({column}, {row}) {:e}",
        entries[0], entries[1])]
    Unsymmetric {
        /// Name of the matrix.
        matrix: &'static str,
        /// Row of an entry that differs from its mirrored entry.
        row: usize,
        /// Column of this entry.
        column: usize,
        /// This entry, and the mirrored entry.
        entries: [f64; 2],
    },
    /// A matrix of a time step is too ill-conditioned for double precision.
    #[error(
        "{matrix}: condition about {condition:.1e}, but double precision allows {limit:.0e}; \
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
        /// Value of the cause.
        ratio: f64,
    },
    /// The search for the static state under weight and loads at t = 0 did not converge.
    #[error(
        "no static equilibrium after {iterations} iterations: residual {residual:.2e} of the load{} \
         (loads are balanced and the structure is not a mechanism: check whether a part of the structure, or of its \
         soil, is loaded beyond its capacity)",
        joint_text(*.joint_element)
    )]
    Preload {
        /// Number of iterations.
        iterations: usize,
        /// Largest unbalanced force of the last iteration, relative to the load.
        ///
        /// Unbalanced are forces of fictitious springs, resultants, or forces within a nonlinear structure.
        residual: f64,
        /// Joint, and its element, whose sides moved most against each other in the last iteration.
        ///
        /// Both count from 0. `None` without joints, and if the base moved more.
        joint_element: Option<[usize; 2]>,
    },
    /// Weight and loads at t = 0 have no stable equilibrium, and the reason.
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
    /// A required accuracy was not reached.
    #[error(
        "{quantity}: relative error {reached:e}, but at most {tolerance:e} is allowed ({remedy})"
    )]
    Accuracy {
        /// Name of the approximation.
        quantity: &'static str,
        /// Smallest relative error that was reached.
        reached: f64,
        /// Largest allowed relative error.
        tolerance: f64,
        /// Circumstances and remedies.
        remedy: String,
    },
    /// Convolution weights that could generate energy, so that runs could grow.
    #[error(
        "{quantity} is not passive: smallest eigenvalue {margin:e}, but at least {allowed:e} is needed, at {angle} radians \
         per step on the circle |z| = {radius} (a smaller tolerance helps)"
    )]
    NotPassive {
        /// Name of the operator.
        quantity: &'static str,
        /// Smallest eigenvalue of the operator's Hermitian part.
        ///
        /// It is relative to the step compliance for exponentials, and to the trace of the operator for convolution
        /// weights.
        margin: f64,
        /// Smallest accepted value.
        allowed: f64,
        /// Angle on the circle, radians per step.
        angle: f64,
        /// Radius of the circle.
        radius: f64,
    },
    /// An [`Observer`] stopped the call; the state is as before the call.
    #[error("stopped by its observer: {0}")]
    Stopped(Progress),
    /// A soil whose waves cannot be computed as requested.
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
    #[error("step {step} (t = {} s): {source}", number_text(*.time))]
    Step {
        /// Number of the step that failed, from 1.
        step: usize,
        /// Time at the end of this step, s.
        time: f64,
        /// Failure of the step.
        r#source: StepError,
    },
}

// `#[from]` would make these causes sources, and chains of sources would print their texts twice.

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

/// Words for the joint and element that moved most, if there is one.
fn joint_text(joint_element: Option<[usize; 2]>) -> String {
    joint_element.map_or_else(String::new, |[joint, element]| {
        format!(", element {element} of joint {joint} moves most")
    })
}

impl std::fmt::Debug for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
