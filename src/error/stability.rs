//! Why a structure cannot stand on the ground.

/// The reason for which weight and loads at t = 0 have no equilibrium.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StabilityError {
    /// The loads lift the structure off.
    #[error("weight and loads at t = 0 lift it by {upward:.4e} N/m{}", on(ends))]
    Uplift {
        /// Left and right end of the base of the part that is lifted, m.
        ends: [f64; 2],
        /// Resultant upwards, N/m; zero if nothing presses.
        upward: f64,
    },
    /// The horizontal load is beyond friction.
    #[error(
        "the load at t = 0 pushes it off: {horizontal:.4e} N/m along the base, {ratio:.3} times the \
         friction {resistance:.4e} N/m under a normal force of {normal:.4e} N/m{}",
        on(ends)
    )]
    Sliding {
        /// Left and right end of the base of the part that slides, m.
        ends: [f64; 2],
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
         {ratio:.3} times half the width{}",
        on(ends)
    )]
    Overturning {
        /// Left and right end of the base of the part that overturns, m.
        ends: [f64; 2],
        /// Moment of weight and loads about the middle of the base, counter-clockwise, N·m/m.
        moment: f64,
        /// Normal force, N/m.
        normal: f64,
        /// Distance of the resultant from the middle of the base, positive to the right, m.
        eccentricity: f64,
        /// That over half the width.
        ratio: f64,
    },
    /// The bearing pressure of the interface does not carry the weight.
    #[error(
        "weight and loads at t = 0 press it into the soil: a normal force of {normal:.4e} N/m, {ratio:.3} \
         times the {capacity:.4e} N/m that the bearing pressure gives on the {width:.4} m whose middle \
         is under the resultant{}",
        on(ends)
    )]
    BearingFailure {
        /// Left and right end of the base of the part that sinks in, m.
        ends: [f64; 2],
        /// Normal force, N/m.
        normal: f64,
        /// Width less twice the eccentricity (Meyerhof 1953), m.
        width: f64,
        /// Bearing pressure times that, N/m.
        capacity: f64,
        /// Normal force over capacity.
        ratio: f64,
    },
    /// The resultant of weight and loads passes through the base, but beyond the middle of its outermost
    /// element: the traction on an element is constant, so that its resultant is there.
    #[error(
        "the resultant of weight and loads at t = 0 passes at x = {resultant:.4} m{}, but {}",
        on(ends),
        grip(*elements, *reach)
    )]
    Beyond {
        /// Left and right end of the base of the part, m.
        ends: [f64; 2],
        /// Number of its elements.
        elements: usize,
        /// Where the resultant passes, m.
        resultant: f64,
        /// Middles of the first and the last element, m.
        reach: [f64; 2],
    },
    /// A bond of the interface breaks, and without it the rest follows.
    #[error("the bond of the interface breaks, and without it: {then}")]
    BondBreaks {
        /// What follows.
        then: Box<StabilityError>,
    },
    /// Part of the structure has neither stiffness nor damping nor mass against a motion.
    #[error("nothing resists a motion of {place}: neither stiffness nor damping nor mass")]
    Massless {
        /// The degrees of freedom that take part in it, ascending.
        dofs: Vec<usize>,
        /// The structure's own names of them.
        place: String,
    },
    /// Part of the structure moves without resistance while the base is at rest.
    #[error(
        "the structure is a mechanism: with its base at rest nothing resists a motion of {place}"
    )]
    Mechanism {
        /// The degrees of freedom that take part in it, ascending.
        dofs: Vec<usize>,
        /// The structure's own names of them.
        place: String,
    },
}

/// The end of the message of [`StabilityError::Beyond`].
fn grip(elements: usize, reach: [f64; 2]) -> String {
    if elements == 1 {
        "a base of one element resists no moment".to_owned()
    } else {
        let [left, right] = reach;
        format!(
            "{elements} elements, on each of which the traction is constant, carry it from x = {left:.4} to \
             {right:.4} m only, the middles of the outermost ones (shorter ones there reach further)"
        )
    }
}

/// The base that is meant.
fn on([left, right]: &[f64; 2]) -> String {
    format!(" (base from x = {left} to {right} m)")
}
