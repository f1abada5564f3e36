//! Why a structure cannot stand on the ground.

/// The reason for which weight and loads at t = 0 have no equilibrium.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StandingError {
    /// The loads lift the structure off.
    #[error("weight and loads at t = 0 lift it by {upward:.4e} N/m")]
    Lifted {
        /// Resultant upwards, N/m; zero if nothing presses.
        upward: f64,
    },
    /// The horizontal load is beyond friction.
    #[error(
        "the load at t = 0 pushes it off: {horizontal:.4e} N/m along the base, {ratio:.3} times the \
         friction {resistance:.4e} N/m under a normal force of {normal:.4e} N/m"
    )]
    Slides {
        /// Horizontal resultant, positive to the right, N/m.
        horizontal: f64,
        /// Normal force, N/m.
        normal: f64,
        /// Largest friction coefficient times that, N/m.
        resistance: f64,
        /// Horizontal resultant over friction; infinite without friction.
        ratio: f64,
    },
    /// The resultant of weight and loads passes beside the base.
    #[error(
        "weight and loads at t = 0 overturn it: moment {moment:.4e} N·m/m about the middle of the base \
         under a normal force of {normal:.4e} N/m, whose resultant passes {eccentricity:.4} m from it, \
         {ratio:.3} times half the width"
    )]
    Overturns {
        /// Moment of weight and loads about the middle of the base, counter-clockwise, N·m/m.
        moment: f64,
        /// Normal force, N/m.
        normal: f64,
        /// Distance of the resultant from the middle of the base, positive to the right, m.
        eccentricity: f64,
        /// That over half the width.
        ratio: f64,
    },
    /// Part of the structure moves without resistance while the base is at rest.
    #[error(
        "the structure is a mechanism: with its base at rest nothing resists a motion of {place}"
    )]
    Mechanism {
        /// The unknowns that take part in it, ascending.
        unknowns: Vec<usize>,
        /// The structure's own names of them.
        place: String,
    },
}
