//! Errors of structures that cannot stand on the ground.

use crate::error::short;

/// The reason why weight and loads at t = 0 have no equilibrium.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StabilityError {
    /// The loads lift the structure off.
    #[error("weight and loads at t = 0 lift it by {upward:.4e} {}{}", force_unit(*across), base_text(*ends, *across))]
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
        force_unit(*across),
        base_text(*ends, *across)
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
        base_text(*ends, Some(*across))
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
        base_text(*ends, *across)
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
    /// The weight makes it fall over or buckle (P–Δ), even with its base bonded to the ground.
    ///
    /// Also for an upright structure, whose static state is then an unstable equilibrium.
    #[error(
        "it falls over or buckles under its weight (P–Δ): the load factor is {factor:.4}, with its base bonded to the \
         ground where it touches it"
    )]
    Buckling {
        /// Multiple of the forces at rest at which it does, below 1.
        factor: f64,
    },
    /// It leans by its weight or loads and by its P–Δ, lifts its base off, and falls over.
    ///
    /// With its base bonded to the ground it would stand.
    #[error(
        "it leans, lifts its base off and falls over (P–Δ): it stands under {factor:.3} times {} at most, although it would \
         stand with its base bonded to the ground",
        if *by_loads { "its loads at t = 0 in addition to its weight" } else { "its weight" }
    )]
    Toppling {
        /// Largest multiple of the weight, or of the loads, under which an equilibrium was found.
        ///
        /// The equilibrium is followed from no weight in increments down to 1/64, and under loads in tenths.
        factor: f64,
        /// Whether the factor applies to the loads that come on after the weight.
        by_loads: bool,
    },
    /// The weight exceeds the bearing pressure of the interface.
    #[error(
        "weight and loads at t = 0 press it into the soil: a normal force of {normal:.4e} {0}, {ratio:.3} \
         times the {capacity:.4e} {0} that the bearing pressure gives on the {width:.4} {1} whose middle \
         is under the resultant{2}",
        force_unit(*across),
        if across.is_some() { "m²" } else { "m" },
        base_text(*ends, *across)
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
        base_text(*ends, *across),
        carried_range(*elements, *reach, axis.unwrap_or('x'))
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
    /// Part of the structure moves without resistance, while the base is at rest or at all.
    #[error("{}", unresisted(.place, *.massless))]
    Mechanism {
        /// The degrees of freedom of that motion, ascending.
        dofs: Vec<usize>,
        /// The structure's names of them.
        place: String,
        /// Whether the part has no mass either, and no damping.
        massless: bool,
    },
}

/// Message of [`StabilityError::Mechanism`].
fn unresisted(place: &str, massless: bool) -> String {
    if massless {
        format!(
            "nothing resists a motion of {place}: neither stiffness nor damping nor mass of the structure (give it a \
             mass: the ground does not hold it while it is lifted)"
        )
    } else {
        format!(
            "the structure is a mechanism: with its base at rest nothing resists a motion of {place}"
        )
    }
}

/// The end of the message of [`StabilityError::Beyond`].
fn carried_range(elements: usize, reach: [f64; 2], axis: char) -> String {
    if elements == 1 {
        "a base of one element resists no moment".to_owned()
    } else {
        format!(
            "{elements} elements, on each of which the traction is constant, carry it from {axis} = {:.4} to \
             {:.4} m only, the middles of the outermost ones (shorter ones there reach further)",
            reach[0], reach[1]
        )
    }
}

/// Text that names the base in a message.
fn base_text(ends: [f64; 2], across: Option<[f64; 2]>) -> String {
    let depth = across.map_or(String::new(), |ends| format!(", y = {}", range_text(ends)));
    format!(" (base from x = {}{depth})", range_text(ends))
}

fn range_text([start, end]: [f64; 2]) -> String {
    format!("{} to {} m", short(start), short(end))
}

/// Unit of forces.
fn force_unit(across: Option<[f64; 2]>) -> &'static str {
    if across.is_some() { "N" } else { "N/m" }
}

/// Text that names the axis in plan, empty in the plane.
pub fn along(axis: Option<char>) -> String {
    match axis {
        Some('z') => " of each wall".to_owned(),
        Some(axis) => format!(" along {axis}"),
        None => String::new(),
    }
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
    "contact elements{} under foundation {foundation}: {elements}, but its flexible base needs about {needed}{}{}",
    along(*axis),
    twice_as_many(*difference),
    of_units(*elements, *needed)
)]
pub struct CoarseBaseError {
    /// Number of the foundation, from the left, from 0.
    pub foundation: usize,
    /// Elements of the foundation; in plan along its shorter side.
    pub elements: usize,
    /// Approximate number of elements needed.
    pub needed: usize,
    /// Relative change of its static shape with twice the elements; `None` if that was not computed.
    pub difference: Option<f64>,
    /// In plan: `x` for elements of a row, `y` for elements of a column. In the plane `z` for elements of a wall.
    pub axis: Option<char>,
}

/// Ratio of needed to present elements from which the structure is far softer than any built one.
const SOFTEST_BUILT_RATIO: usize = 16;

/// Doubt about units of a base so soft that it needs many times its elements, as with moduli in GPa or lengths in mm.
pub fn of_units(elements: usize, needed: usize) -> &'static str {
    if needed / SOFTEST_BUILT_RATIO < elements {
        ""
    } else {
        "; so soft a base is rare: check the units (moduli in Pa, lengths in m, masses in kg)"
    }
}

/// Text for the change of the static shape with twice the elements.
fn twice_as_many(difference: Option<f64>) -> String {
    difference.map_or(String::new(), |change| {
        format!(" (twice as many change its static shape by {:.0} %)", 100.0 * change)
    })
}

/// Why a structure cannot stand on a ground, whatever its loads.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StructureError {
    /// A structure with stiffness to a fixed point: the ground alone must hold it up.
    #[error(
        "the structure must translate freely, without supports: moved {direction} by 1 m it meets \
         {force:.2e} N at degree of freedom {dof}, {ratio:.1e} of the stiffness around (entries of a \
         stiffness matrix in a file need eleven digits or more)"
    )]
    Restrained {
        /// Direction of the translation that is resisted.
        direction: &'static str,
        /// Force per metre of translation at the degree of freedom, N/m.
        ///
        /// If the structure can hardly translate, it is the force at the contact nodes.
        force: f64,
        /// The degree of freedom with the largest force relative to the stiffness around.
        dof: usize,
        /// That force relative to the stiffness around.
        ratio: f64,
    },
    /// A part of a structure that no stiffness connects to its contact nodes.
    ///
    /// It would neither weigh on the ground nor move.
    #[error(
        "part of the structure is not joined to its base by any stiffness: {place} (dashpots alone \
         hold nothing up)"
    )]
    Detached {
        /// The degrees of freedom of all such parts, ascending.
        dofs: Vec<usize>,
        /// The structure's names of them: see `Structure::describe`.
        place: String,
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
}
