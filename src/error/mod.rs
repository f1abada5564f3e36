//! Errors: each names the quantity, its value and the requirement.
//!
//! The text of an error contains the text of its cause, and `source()` returns `None`. Printed alone the error is
//! complete, and printed with its chain of sources nothing occurs twice. A field called `source` is therefore
//! written `r#source`, which `thiserror` does not treat as a source.

mod case;
mod file;
mod ground;
pub(crate) mod memory;
mod part;
mod progress;
mod requirement;
mod step;

pub use case::{CaseError, CaseFileError, SweepError};
pub use file::RecordError;
#[cfg(feature = "io")]
pub use file::{MatrixFileError, MeshFileError};
pub use ground::{KernelFileError, LayeredError, PlanError, SiteError};
pub use memory::{MemoryError, memory_limit, set_memory_limit};
pub use part::{LawError, ReducedError};
pub(crate) use progress::Watch;
pub use progress::{Observer, Progress, unobserved};
pub(crate) use requirement::{
    all_finite, at_least, damping_ratio, finite, in_bounds, names, not_finite, not_negative,
    positive, require, require_part, same_length, short,
};
pub use step::{CheckpointError, CoarseBaseError, StabilityError, StepError};
pub(crate) use step::{along, place};

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
        /// The value that was given.
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
        /// The length that was given.
        found: usize,
        /// The length that was needed.
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
        /// The index that was given.
        index: usize,
        /// First value out of range.
        bound: usize,
    },
    /// A file that cannot be written.
    #[error("{file} cannot be written: {reason}")]
    Write {
        /// The file, or its folder.
        file: String,
        /// The system's own message.
        reason: std::io::ErrorKind,
    },
    /// A name that does not exist.
    #[error("there is no {quantity} called '{name}'{}", names(.known))]
    Name {
        /// Item that was sought.
        quantity: &'static str,
        /// The name that was given.
        name: String,
        /// The names that are known.
        known: Vec<String>,
    },
    /// A name that occurs more than once.
    #[error("more than one {quantity} is called '{name}'")]
    DuplicateName {
        /// Item that has the name.
        quantity: &'static str,
        /// The name.
        name: String,
    },
    /// A word that is not one of the choices.
    #[error("there is no {quantity} '{text}', only {}", known.join(", "))]
    Word {
        /// Choice to be made.
        quantity: &'static str,
        /// The given word, cut to 40 characters.
        text: String,
        /// The words that are known.
        known: &'static [&'static str],
    },
    /// A probe that does not fit the structure.
    #[error("probe '{name}': {source}")]
    Probe {
        /// Name of the probe.
        name: String,
        /// Reason.
        r#source: Box<Error>,
    },
    /// A point without a node.
    #[error(
        "no node at ({x}, {y}): the nearest, at ({}, {}), is {distance} m away",
        nearest[0], nearest[1]
    )]
    NoNode {
        /// Coordinate of the point to the right, m.
        x: f64,
        /// Coordinate of the point upwards, m.
        y: f64,
        /// Coordinates of the nearest node, m.
        nearest: [f64; 2],
        /// Distance to it, m.
        distance: f64,
    },
    /// A node that no element moves in the given direction.
    #[error(
        "node {node} has no degree of freedom in direction {direction}: no element needs one there"
    )]
    NoDof {
        /// The node.
        node: usize,
        /// The direction.
        direction: &'static str,
    },
    /// A part of the scene that is missing, or does not fit another part.
    #[error("{quantity}: {needed}")]
    Scene {
        /// Name of the part.
        quantity: &'static str,
        /// Requirement.
        needed: &'static str,
    },
    /// A user's own part that does not accept the scene, a file or a checkpoint: see [`Error::part`].
    #[error("{part}: {reason}")]
    Part {
        /// Name of the part.
        part: String,
        /// Reason that the part gives.
        reason: String,
    },
    /// A ground-motion record that cannot be read.
    #[error("{}: {reason}", place(.file, *.line))]
    Record {
        /// File or source of the record.
        file: String,
        /// Line number, from 1 (0: the file as a whole).
        line: usize,
        /// Fault of the line.
        reason: RecordError,
    },
    /// A file of a mesh that cannot be used.
    #[cfg(feature = "io")]
    #[error("{}: {reason}", place(.file, *.line))]
    MeshFile {
        /// File or source of the mesh.
        file: String,
        /// Line number, from 1 (0: the file as a whole).
        line: usize,
        /// Fault of the line.
        reason: MeshFileError,
    },
    /// A Matrix Market file that cannot be read or written.
    #[cfg(feature = "io")]
    #[error("{}: {reason}", place(.file, *.line))]
    MatrixFile {
        /// File or source of the matrix.
        file: String,
        /// Line number, from 1 (0: the file as a whole).
        line: usize,
        /// Fault of the line.
        reason: MatrixFileError,
    },
    /// A matrix that cannot be factored.
    #[error("{matrix} of order {order} is singular or not finite")]
    Singular {
        /// Name of the matrix.
        matrix: &'static str,
        /// Order of the matrix.
        order: usize,
    },
    /// A structure with stiffness to a fixed point: the ground alone must hold it up.
    #[error(
        "the structure must translate freely, without supports: moved {direction} by 1 m it meets \
         {force:.2e} N at degree of freedom {dof}, {ratio:.1e} of the stiffness around (entries of a \
         stiffness matrix in a file need eleven digits or more)"
    )]
    Restrained {
        /// Direction of the translation that is resisted.
        direction: &'static str,
        /// Force per metre of translation at the degree of freedom, N/m; if the structure is held so that it can hardly
        /// translate, the force at the contact nodes.
        force: f64,
        /// The degree of freedom with the largest force relative to the stiffness around.
        dof: usize,
        /// That force relative to the stiffness around.
        ratio: f64,
    },
    /// A part of a structure that no stiffness joins to its contact nodes: it would neither weigh on the ground
    /// nor move.
    #[error(
        "part of the structure is not joined to its base by any stiffness: {place} (dashpots alone \
         hold nothing up)"
    )]
    Detached {
        /// The degrees of freedom of all such parts, ascending.
        dofs: Vec<usize>,
        /// The structure's names of them: see [`Structure::describe`](crate::structure::Structure::describe).
        place: String,
    },
    /// An element in the place of another one, or given twice.
    #[error("the element on nodes {nodes:?} lies where element {first} is, and would count twice")]
    DuplicateElement {
        /// Index of the element that is there.
        first: usize,
        /// Nodes of the element that was to be added.
        nodes: Vec<usize>,
    },
    /// A structure that buckles, held at its contact nodes, under the axial forces of its static state.
    #[error(
        "the structure buckles under the axial forces of its static state: held at its contact \
         nodes it carries {factor:.3e} of them"
    )]
    Buckling {
        /// Fraction of the axial forces at which it buckles.
        factor: f64,
    },
    /// A matrix that would let a motion gain energy without end: negative mass or damping, or columns above their
    /// buckling load.
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
    /// A structure that cannot be stepped in reduced coordinates, or not with the given accuracy.
    #[error("reduced coordinates: {0}")]
    Reduced(#[from] ReducedError),
    /// A history by exponentials that does not reach the given accuracy.
    #[error("history by exponentials: relative error {reached:e}, but {tolerance:e} was asked for")]
    Accuracy {
        /// Given tolerance of the relative error.
        tolerance: f64,
        /// Relative error with the largest number of poles tried.
        reached: f64,
    },
    /// A kernel that does not allow a history by exponentials.
    #[error("history by exponentials needs {needed}")]
    NoExponentials {
        /// Property that the kernel lacks.
        needed: &'static str,
    },
    /// A history by exponentials that could generate energy, so that runs could grow.
    #[error(
        "history by exponentials is not passive: least eigenvalue {margin:e} of its instantaneous \
         part, at {frequency} radians per step (a smaller tolerance helps)"
    )]
    NotPassive {
        /// Least eigenvalue of the Hermitian part of (1−ζ)Ĝ(ζ), relative to the step compliance.
        margin: f64,
        /// Angle on the unit circle, radians per step.
        frequency: f64,
    },
    /// A call that its [`Observer`] stopped; everything is as before the call.
    #[error("stopped by its observer: {0}")]
    Stopped(Progress),
    /// A layered ground that cannot be computed.
    #[error("layered ground: {0}")]
    Layered(#[from] LayeredError),
    /// A mat in plan that cannot be computed.
    #[error("mat in plan: {0}")]
    Plan(#[from] PlanError),
    /// A soil profile that is invalid, or without strain-compatible properties.
    #[error("site: {0}")]
    Site(#[from] SiteError),
    /// Parameters, a table or files of a sweep that cannot be used.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// A run could not be saved or resumed.
    #[error("checkpoint: {0}")]
    Checkpoint(CheckpointError),
    /// A boundary equation whose perturbations grow from step to step.
    #[error(
        "the boundary equation is unstable with this time step: {growing_modes} modes grow, the \
         fastest by {growth_per_step:.1e} per step (take a longer step or another kernel, or allow it)"
    )]
    Unstable {
        /// Factor minus one by which the fastest mode grows in a step.
        growth_per_step: f64,
        /// Number of growing modes.
        growing_modes: usize,
    },
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

impl std::fmt::Debug for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
