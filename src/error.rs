//! Errors: every one names the quantity, its value and what was needed.

use crate::interface::Mode;

/// Result of every fallible function of the crate.
pub type Result<T> = std::result::Result<T, Error>;

/// What can go wrong, with the quantity, its value and what was needed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number out of its range (NaN and infinities included).
    #[error("{quantity} is {value}, but must be {needed}")]
    Input {
        /// Name of the quantity.
        quantity: &'static str,
        /// The value that was given.
        value: f64,
        /// What was needed.
        needed: &'static str,
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
    /// An index that points outside its list.
    #[error("{quantity} is {index}, but must be below {bound}")]
    Index {
        /// Name of the quantity.
        quantity: &'static str,
        /// The index that was given.
        index: usize,
        /// First value out of range.
        bound: usize,
    },
    /// A part of the scene that was not given, or does not fit another part.
    #[error("{quantity}: {needed}")]
    Scene {
        /// Name of the part.
        quantity: &'static str,
        /// What was needed.
        needed: &'static str,
    },
    /// A ground-motion record that cannot be read.
    #[error("{file}, line {line}: {reason}")]
    Record {
        /// File or source of the record.
        file: String,
        /// Line number, from 1 (0: the file as a whole).
        line: usize,
        /// What is wrong there.
        reason: RecordError,
    },
    /// A matrix that cannot be factored.
    #[error("{matrix} of order {order} is singular or not finite")]
    Singular {
        /// Name of the matrix.
        matrix: &'static str,
        /// Its order.
        order: usize,
    },
    /// A matrix of the step that double precision cannot carry.
    #[error(
        "{matrix}: condition about {condition:.1e}, but double precision carries {limit:.0e}; what \
         makes it so: {quantity}, {ratio:.1e}"
    )]
    IllConditioned {
        /// Name of the matrix.
        matrix: &'static str,
        /// Its condition number, estimated; infinite if it is singular.
        condition: f64,
        /// Largest that is accepted.
        limit: f64,
        /// What makes it so.
        quantity: &'static str,
        /// How large that is.
        ratio: f64,
    },
    /// The static state under the structure's weight was not found.
    #[error(
        "no static equilibrium after {iterations} iterations: residual {residual:e} of the load \
         (does the structure topple or slide under its own weight? horizontal static loads need \
         `Placement::WithInterfaceLaw`)"
    )]
    Preload {
        /// Iterations made.
        iterations: usize,
        /// Last change, relative to the load.
        residual: f64,
    },
    /// A history by exponentials is not as accurate as was asked for.
    #[error("history by exponentials: relative error {reached:e}, but {tolerance:e} was asked for")]
    Accuracy {
        /// Relative error that was asked for.
        tolerance: f64,
        /// Relative error with as many poles as were tried.
        reached: f64,
    },
    /// A history by exponentials could give energy away, and runs with it could grow.
    #[error(
        "history by exponentials is not passive: least eigenvalue {margin:e} of its instantaneous \
         part, at {frequency} radians per step (a smaller tolerance helps)"
    )]
    NotPassive {
        /// Least eigenvalue of the Hermitian part of (1−ζ)Ĝ(ζ), over that of the instantaneous part.
        margin: f64,
        /// Where it is on the unit circle, radians per step.
        frequency: f64,
    },
    /// A run could not be saved or resumed.
    #[error("checkpoint: {0}")]
    Checkpoint(CheckpointError),
    /// A boundary equation whose perturbations grow from step to step.
    #[error(
        "the boundary equation is unstable with this time step: {growing_modes} modes grow, the \
         fastest by {growth_per_step:.1e} per step (take a longer step, or another kernel)"
    )]
    Unstable {
        /// Factor minus one by which the fastest mode grows in a step.
        growth_per_step: f64,
        /// Number of growing modes.
        growing_modes: usize,
    },
    /// A time step that could not be solved; the simulation stays at the last accepted step.
    #[error("step {step} (t = {time} s): {source}")]
    Step {
        /// Number of the step that failed, from 1.
        step: usize,
        /// Time at its end, s.
        time: f64,
        /// What failed.
        source: StepError,
    },
}

/// Why a run could not be saved or resumed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// A part of the scene cannot save its state.
    #[error("the {part} cannot save or restore its state")]
    Unsupported {
        /// The part.
        part: &'static str,
    },
    /// The checkpoint was made with another format than this version's.
    #[error("format {found}, but this version reads {needed}")]
    Format {
        /// Format of the checkpoint.
        found: u32,
        /// Format of this version.
        needed: u32,
    },
    /// The checkpoint belongs to another scene.
    #[error("made in another scene: the {quantity} differs")]
    OtherScene {
        /// What differs.
        quantity: &'static str,
    },
    /// Numbers are missing, too many or not finite.
    #[error("{quantity}: wrong number of values, or not finite")]
    Corrupt {
        /// What cannot be.
        quantity: &'static str,
    },
}

impl From<CheckpointError> for Error {
    fn from(error: CheckpointError) -> Self {
        Self::Checkpoint(error)
    }
}

/// Why a step failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// No set of contact modes satisfied the interface laws.
    #[error(
        "contact modes not found in {iterations} trials, residual {residual:e}, modes {modes:?}"
    )]
    Contact {
        /// Trials made, fallbacks included.
        iterations: usize,
        /// How far the tractions of these modes are from those of the modes that the laws ask for
        /// instead, relative to the largest; 1 if either set of modes is singular.
        residual: f64,
        /// Modes of the last trial, left to right.
        modes: Vec<Mode>,
    },
    /// Newton's iteration for a nonlinear structure did not converge.
    #[error(
        "Newton's iteration not converged in {iterations} iterations, residual {residual:e}, \
         modes {modes:?}"
    )]
    Newton {
        /// Iterations made.
        iterations: usize,
        /// Last out-of-balance force relative to the largest force.
        residual: f64,
        /// Contact modes of the last iteration, left to right.
        modes: Vec<Mode>,
    },
    /// The ground could not give its history.
    #[error("history of the ground: {0}")]
    Ground(Box<Error>),
    /// A number became NaN or infinite.
    #[error("{quantity} is not finite")]
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// A matrix of the step is singular.
    #[error("{matrix} is singular")]
    Singular {
        /// Name of the matrix.
        matrix: &'static str,
    },
}

/// What is wrong with a line of a record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::ErrorKind),
    /// There are too few samples.
    #[error("{found} samples, at least {needed} needed")]
    TooShort {
        /// Samples found.
        found: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A line has too few columns.
    #[error("{found} columns, but column {needed} was asked for")]
    Column {
        /// Columns found.
        found: usize,
        /// Column asked for, from 1.
        needed: usize,
    },
    /// A field is not a finite number.
    #[error("'{text}' is not a finite number")]
    NotANumber {
        /// The field, cut to 40 characters.
        text: String,
    },
    /// The time column does not advance by equal steps.
    #[error("time advances by {found} s, but by {expected} s before")]
    UnequalStep {
        /// This step, s.
        found: f64,
        /// The first step, s.
        expected: f64,
    },
    /// The steps of the time column are nearly equal, but drift away from equal ones.
    #[error("time is {found} s, but would be {expected} s with equal steps")]
    DriftingStep {
        /// This time, s.
        found: f64,
        /// The time with equal steps, s.
        expected: f64,
    },
    /// The time column does not increase.
    #[error("time advances by {found} s, but must advance")]
    TimeNotIncreasing {
        /// This step, s.
        found: f64,
    },
    /// The number of samples is not the one that was asked for.
    #[error("{found} samples, but {needed} asked for")]
    SampleCount {
        /// Samples found.
        found: usize,
        /// Samples asked for.
        needed: usize,
    },
    /// The header lacks something.
    #[error("the header has no {quantity}, or none that makes sense")]
    Missing {
        /// What is missing.
        quantity: &'static str,
    },
    /// The file holds something else than an acceleration, or in a unit that is not known.
    #[error("'{text}' is no acceleration in a known unit")]
    NotAcceleration {
        /// What the file says of its numbers, cut to 60 characters.
        text: String,
    },
    /// There is no channel of this number.
    #[error("{found} channels, but channel {needed} was asked for (they count from 1)")]
    Channel {
        /// Channels found.
        found: usize,
        /// Channel asked for.
        needed: usize,
    },
    /// A line is too long to be one of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}

/// `value` if it is finite and above zero.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Error::Input { quantity, value, needed: "finite and above zero" })
    }
}

/// `value` if it is finite and not below zero.
pub(crate) fn not_negative(quantity: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(Error::Input { quantity, value, needed: "finite and not below zero" })
    }
}

/// `value` if it is finite.
pub(crate) fn finite(quantity: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::Input { quantity, value, needed: "finite" })
    }
}

/// Error unless `found == needed`.
pub(crate) fn same_length(quantity: &'static str, found: usize, needed: usize) -> Result<()> {
    if found == needed { Ok(()) } else { Err(Error::Size { quantity, found, needed }) }
}
