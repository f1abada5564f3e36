//! Errors of a run: steps that fail, checkpoints that cannot be resumed.

use super::{Error, LawError, not_finite, short};

/// Why a step failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// No set of contact modes satisfied the interface laws.
    #[error(
        "contact modes not found in {iterations} trials{}, residual {residual:.2e}, modes {} \
         (`coupled::largest_convergent_step` finds a time step that gets through)",
        all(*sets), modes.join(" ")
    )]
    Contact {
        /// Number of trials, fallbacks included.
        iterations: usize,
        /// Difference between the tractions of these modes and the tractions of the modes that the laws require
        /// next, relative to the largest; 1 if either set of modes is singular.
        residual: f64,
        /// Words ([`Mode`](crate::interface::Mode)'s `Display`) of the modes of the last trial, left to right.
        modes: Vec<&'static str>,
        /// Number of all sets of modes, if all were tried: the step has no solution. `None` if there are more than
        /// 65 536 sets.
        sets: Option<usize>,
    },
    /// In plan: no contact forces were found that satisfy the interface laws.
    #[error(
        "contact forces not found in {iterations} iterations, residual {residual:.2e}, elements {} \
         (`coupled::largest_convergent_step` finds a time step that gets through)",
        elements.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
    )]
    Cone {
        /// Number of sweeps and Newton iterations, including the proximal method's.
        iterations: usize,
        /// Largest difference of an element's force from the force that its law allows at its displacement,
        /// relative to the largest force.
        residual: f64,
        /// Elements with too large a difference.
        elements: Vec<usize>,
    },
    /// Newton's iteration for a nonlinear structure did not converge.
    #[error(
        "Newton's iteration not converged in {iterations} iterations, residual {residual:.2e}, \
         modes {} (`coupled::largest_convergent_step` finds a time step that gets through)",
        modes.join(" ")
    )]
    Newton {
        /// Iterations made.
        iterations: usize,
        /// Last out-of-balance force relative to the largest force.
        residual: f64,
        /// Words ([`Mode`](crate::interface::Mode)'s `Display`) of the contact modes of the last iteration, left to
        /// right.
        modes: Vec<&'static str>,
    },
    /// The ground returned an error for its history.
    #[error("history of the ground: {0}")]
    Ground(Box<Error>),
    /// The structure returned an error for its load, nonlinear force or tangent.
    #[error("{quantity}: {source}")]
    Structure {
        /// Name of the quantity.
        quantity: &'static str,
        /// The structure's reason.
        r#source: Box<Error>,
    },
    /// An interface law returned an invalid value.
    #[error(transparent)]
    Law(#[from] LawError),
    /// A number became NaN or infinite.
    #[error("{quantity} is not finite: entry {index} is {value}")]
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// Index from 0: of a structure's quantity the degree of freedom (or mode, in modal coordinates); of a
        /// base's quantity the component (normal ones first, then tangential ones); of loads the number of the
        /// load.
        index: usize,
        /// The value.
        value: f64,
    },
    /// The structure has lost its stability: its motion grows without limit.
    ///
    /// By weight on yielding columns (P–Δ), negative damping or a growing ground. The energy balance still closes.
    #[error("the structure runs away: it moves by {increment:e} in one step")]
    Runaway {
        /// Largest change of a degree of freedom in the step, m or rad (in modes, times the root of a mass).
        increment: f64,
    },
    /// A matrix of the step is singular.
    #[error("{matrix} is singular")]
    Singular {
        /// Name of the matrix.
        matrix: &'static str,
    },
}

/// Number of sets of modes, where all were tried.
fn all(sets: Option<usize>) -> String {
    sets.map_or_else(String::new, |sets| {
        format!(
            ": the step has no solution, as none of all {sets} sets of modes satisfies the laws"
        )
    })
}

impl StepError {
    /// Error if one of `values` is not finite.
    pub(crate) fn check_finite(
        quantity: &'static str,
        values: &[f64],
    ) -> std::result::Result<(), Self> {
        match not_finite(values) {
            None => Ok(()),
            Some((index, value)) => Err(Self::NotFinite { quantity, index, value }),
        }
    }

    /// Wraps an error of the structure as [`StepError::Structure`].
    pub(crate) fn structure(quantity: &'static str) -> impl FnOnce(Error) -> Self {
        move |source| Self::Structure { quantity, source: Box::new(source) }
    }
}

// Checkpoints.

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
    /// The checkpoint has a format that this version does not read.
    #[error("format {found}, but this version reads {needed}")]
    Format {
        /// Format of the checkpoint.
        found: u32,
        /// Format of this version.
        needed: u32,
    },
    /// The contents differ from those saved: the file was damaged, or changed by hand.
    #[error("damaged: the contents do not agree with their check sum")]
    Damaged,
    /// The checkpoint belongs to another scene.
    #[error("made in another scene: the {quantity} differs")]
    OtherScene {
        /// Quantity that differs.
        quantity: &'static str,
    },
    /// Numbers are missing, too many or not finite.
    #[error("{quantity}: wrong number of values, or not finite")]
    Corrupt {
        /// Quantity that is impossible.
        quantity: &'static str,
    },
}

impl From<CheckpointError> for Error {
    fn from(error: CheckpointError) -> Self {
        Self::Checkpoint(error)
    }
}

// Why a structure cannot stand on the ground.

/// The reason why weight and loads at t = 0 have no equilibrium.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StabilityError {
    /// The loads lift the structure off.
    #[error("weight and loads at t = 0 lift it by {upward:.4e} {}{}", force(*across), on(*ends, *across))]
    Uplift {
        /// Left and right end of the base of the part that is lifted, m.
        ends: [f64; 2],
        /// In plan: front and back end of that base along y, m; forces then act on the whole body.
        across: Option<[f64; 2]>,
        /// Resultant upwards, N/m; zero without any pressure.
        upward: f64,
    },
    /// The horizontal load exceeds friction.
    #[error(
        "the load at t = 0 pushes it off: {horizontal:.4e} {0} along the base, {ratio:.3} times the \
         friction {resistance:.4e} {0} under a normal force of {normal:.4e} {0}{1}",
        force(*across),
        on(*ends, *across)
    )]
    Sliding {
        /// Left and right end of the base of the part that slides, m.
        ends: [f64; 2],
        /// In plan: front and back end of that base along y, m; forces then act on the whole body.
        across: Option<[f64; 2]>,
        /// Horizontal resultant, positive to the right, N/m; in plan the resultant of both directions.
        horizontal: f64,
        /// Normal force, N/m.
        normal: f64,
        /// Largest friction coefficient times the normal force, N/m.
        resistance: f64,
        /// Horizontal resultant over friction; infinite without friction.
        ratio: f64,
    },
    /// In plan: the torque of the loads exceeds friction.
    #[error(
        "the load at t = 0 twists it: a torque of {torque:.4e} N·m, {ratio:.3} times the {resistance:.4e} N·m of friction \
         under a normal force of {normal:.4e} N that is spread evenly{}",
        on(*ends, Some(*across))
    )]
    Twisting {
        /// Left and right end of the base of the part that is twisted, m.
        ends: [f64; 2],
        /// Front and back end of that base along y, m.
        across: [f64; 2],
        /// Torque of the loads about the middle of the base, counter-clockwise from above, N·m.
        torque: f64,
        /// Normal force, N.
        normal: f64,
        /// Torque of friction under even pressure, N·m.
        resistance: f64,
        /// Torque over the torque of friction; infinite without friction.
        ratio: f64,
    },
    /// The resultant of weight and loads passes beside the base.
    #[error(
        "weight and loads at t = 0 overturn it{1}: moment {moment:.4e} N·m{0} about the middle of the base \
         under a normal force of {normal:.4e} N{0}, whose resultant passes {eccentricity:.4} m from it{2}, \
         {ratio:.3} times half the width{3}",
        if across.is_some() { "" } else { "/m" },
        edge(*axis, *eccentricity),
        along(*axis),
        on(*ends, *across)
    )]
    Overturning {
        /// Left and right end of the base of the part that overturns, m.
        ends: [f64; 2],
        /// In plan: front and back end of that base along y, m; forces then act on the whole body.
        across: Option<[f64; 2]>,
        /// In plan: `x` if it overturns to the left or the right, `y` if to the front or the back.
        axis: Option<char>,
        /// Moment of weight and loads about the middle of the base, counter-clockwise, N·m/m; in plan by the
        /// right-hand rule about the other axis: about y if it overturns to the left or the right.
        moment: f64,
        /// Normal force, N/m.
        normal: f64,
        /// Distance of the resultant from the middle of the base, positive to the right, in plan along the axis, m.
        eccentricity: f64,
        /// Eccentricity over half the width; in plan, for a base that is not rectangular, over the distance to its
        /// edge.
        ratio: f64,
    },
    /// The weight exceeds the bearing pressure of the interface.
    #[error(
        "weight and loads at t = 0 press it into the soil: a normal force of {normal:.4e} {0}, {ratio:.3} \
         times the {capacity:.4e} {0} that the bearing pressure gives on the {width:.4} {1} whose middle \
         is under the resultant{2}",
        force(*across),
        if across.is_some() { "m²" } else { "m" },
        on(*ends, *across)
    )]
    BearingFailure {
        /// Left and right end of the base of the part that sinks in, m.
        ends: [f64; 2],
        /// In plan: front and back end of that base along y, m; forces then act on the whole body.
        across: Option<[f64; 2]>,
        /// Normal force, N/m.
        normal: f64,
        /// Width minus twice the eccentricity (Meyerhof 1953), m; in plan the area that both eccentricities leave,
        /// m².
        width: f64,
        /// Bearing pressure times this width or area, N/m.
        capacity: f64,
        /// Normal force over capacity.
        ratio: f64,
    },
    /// The resultant of weight and loads passes through the base, but beyond the middle of its outermost element.
    ///
    /// The traction on an element is constant, so its resultant is in the middle.
    #[error(
        "the resultant of weight and loads at t = 0 passes at {} = {resultant:.4} m{}, but {}",
        axis.unwrap_or('x'),
        on(*ends, *across),
        grip(*elements, *reach, axis.unwrap_or('x'))
    )]
    Beyond {
        /// Left and right end of the base of the part, m.
        ends: [f64; 2],
        /// In plan: front and back end of that base along y, m; forces then act on the whole body.
        across: Option<[f64; 2]>,
        /// In plan: axis along which the resultant passes beyond the elements, `x` or `y`.
        axis: Option<char>,
        /// Number of elements of the base.
        elements: usize,
        /// Coordinate at which the resultant passes, m.
        resultant: f64,
        /// Middles of the first and the last element along that axis, m.
        reach: [f64; 2],
    },
    /// A bond of the interface breaks, and this failure follows.
    #[error("the bond of the interface breaks, and without it: {then}")]
    BondBreaks {
        /// Failure that follows.
        then: Box<StabilityError>,
    },
    /// Part of the structure has neither stiffness nor damping nor mass against a motion.
    #[error(
        "nothing resists a motion of {place}: neither stiffness nor damping nor mass of the structure (give it a mass: \
         the ground does not hold it while it is lifted)"
    )]
    Massless {
        /// The degrees of freedom of that motion, ascending.
        dofs: Vec<usize>,
        /// The structure's own names of them.
        place: String,
    },
    /// Part of the structure moves without resistance while the base is at rest.
    #[error(
        "the structure is a mechanism: with its base at rest nothing resists a motion of {place}"
    )]
    Mechanism {
        /// The degrees of freedom of that motion, ascending.
        dofs: Vec<usize>,
        /// The structure's own names of them.
        place: String,
    },
}

/// The end of the message of [`StabilityError::Beyond`].
fn grip(elements: usize, reach: [f64; 2], axis: char) -> String {
    if elements == 1 {
        "a base of one element resists no moment".to_owned()
    } else {
        let [left, right] = reach;
        format!(
            "{elements} elements, on each of which the traction is constant, carry it from {axis} = {left:.4} to \
             {right:.4} m only, the middles of the outermost ones (shorter ones there reach further)"
        )
    }
}

/// Text that names the base in a message.
fn on([left, right]: [f64; 2], across: Option<[f64; 2]>) -> String {
    let range = |ends: [f64; 2]| format!("{} to {} m", short(ends[0]), short(ends[1]));
    let depth = across.map_or(String::new(), |ends| format!(", y = {}", range(ends)));
    format!(" (base from x = {}{depth})", range([left, right]))
}

/// The unit of forces.
fn force(across: Option<[f64; 2]>) -> &'static str {
    if across.is_some() { "N" } else { "N/m" }
}

/// A line of a file, or the file as a whole.
pub(crate) fn place(file: &str, line: usize) -> String {
    if line == 0 { file.to_owned() } else { format!("{file}, line {line}") }
}

/// Text that names the axis in plan, empty in the plane.
pub(crate) fn along(axis: Option<char>) -> String {
    axis.map_or(String::new(), |axis| format!(" along {axis}"))
}

/// The edge over which the structure falls, in plan.
fn edge(axis: Option<char>, eccentricity: f64) -> &'static str {
    match (axis, eccentricity > 0.0) {
        (None, _) => "",
        (Some('x'), true) => " over its right edge",
        (Some('x'), false) => " over its left edge",
        (Some(_), true) => " over its back edge",
        (Some(_), false) => " over its front edge",
    }
}

/// A flexible base with too few contact elements: between them only the structure resists deformation.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "contact elements{} under foundation {foundation}: {elements}, but its flexible base needs about {needed}{}",
    along(*axis),
    twice_as_many(*difference)
)]
pub struct CoarseBaseError {
    /// Number of the foundation, from the left, from 0.
    pub foundation: usize,
    /// Elements of the foundation; in plan along its shorter side.
    pub elements: usize,
    /// Approximate number of elements needed.
    pub needed: usize,
    /// Relative change of its vertical static shape with twice the elements; `None` if that was not computed.
    pub difference: Option<f64>,
    /// In plan: `x` for elements of a row, `y` for elements of a column.
    pub axis: Option<char>,
}

fn twice_as_many(difference: Option<f64>) -> String {
    difference.map_or(String::new(), |own| {
        format!(" (twice as many change its static shape by {:.0} %)", 100.0 * own)
    })
}
