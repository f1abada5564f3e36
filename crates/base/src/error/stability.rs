//! Errors of structures that cannot stand on the ground.

use crate::error::number_text;

/// Reason why weight and loads at t = 0 have no stable equilibrium.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StabilityError {
    /// The loads lift the structure off, or it floats.
    #[error("{}{}", uplift_text(*upward, *buoyancy, force_unit(*across)), base_text(*ends, *across))]
    Uplift {
        /// Left and right end of the base of the lifted part, m.
        ends: [f64; 2],
        /// Front and back end of this base along y, m; `None` in the plane.
        ///
        /// In plan, forces are those of the whole body.
        across: Option<[f64; 2]>,
        /// Upward resultant, N/m; zero if no part of the base is under pressure.
        upward: f64,
        /// Upward force of the water on a floating part, N/m; zero for a part that the loads lift off.
        ///
        /// The part weighs `buoyancy` − `upward`.
        buoyancy: f64,
    },
    /// The horizontal load exceeds friction.
    #[error(
        "the load at t = 0 pushes it off: {horizontal:.4e} {0} along the base, {ratio:.3} times the \
         friction {resistance:.4e} {0} under a normal force of {normal:.4e} {0}{1}",
        force_unit(*across),
        base_text(*ends, *across)
    )]
    Sliding {
        /// Left and right end of the base of the sliding part, m.
        ends: [f64; 2],
        /// Front and back end of this base along y, m; `None` in the plane.
        ///
        /// In plan, forces are those of the whole body.
        across: Option<[f64; 2]>,
        /// Horizontal resultant, positive to the right, N/m; in plan the resultant of both directions.
        horizontal: f64,
        /// Normal force, N/m.
        normal: f64,
        /// Largest friction coefficient times the normal force, N/m.
        resistance: f64,
        /// Horizontal resultant divided by the friction; infinite without friction.
        ratio: f64,
    },
    /// In plan: the torque of the loads exceeds friction.
    #[error(
        "the load at t = 0 twists it: a torque of {torque:.4e} N·m, {ratio:.3} times the {resistance:.4e} N·m of friction \
         under an evenly spread normal force of {normal:.4e} N{}",
        base_text(*ends, Some(*across))
    )]
    Twisting {
        /// Left and right end of the base of the twisted part, m.
        ends: [f64; 2],
        /// Front and back end of this base along y, m.
        across: [f64; 2],
        /// Torque of the loads about the middle of the base, counter-clockwise from above, N·m.
        torque: f64,
        /// Normal force, N.
        normal: f64,
        /// Torque of the friction under even pressure, N·m.
        resistance: f64,
        /// Torque of the loads divided by that of the friction; infinite without friction.
        ratio: f64,
    },
    /// The resultant of weight and loads passes outside the base.
    #[error(
        "weight and loads at t = 0 overturn it{1}: moment {moment:.4e} N·m{0} about the middle of the base \
         under a normal force of {normal:.4e} N{0}, whose resultant passes {eccentricity:.4} m from it{2}, \
         {ratio:.3} times half the width{3}",
        if across.is_some() { "" } else { "/m" },
        edge_text(*axis, *eccentricity),
        axis_text(*axis),
        base_text(*ends, *across)
    )]
    Overturning {
        /// Left and right end of the base of the overturning part, m.
        ends: [f64; 2],
        /// Front and back end of this base along y, m; `None` in the plane.
        ///
        /// In plan, forces are those of the whole body.
        across: Option<[f64; 2]>,
        /// Axis along which it overturns in plan, `x` or `y`; `None` in the plane.
        axis: Option<char>,
        /// Moment of weight and loads about the middle of the base, counter-clockwise, N·m/m.
        ///
        /// In plan by the right-hand rule about the other axis: about y if it overturns to the left or the right.
        moment: f64,
        /// Normal force, N/m.
        normal: f64,
        /// Distance of the resultant from the middle of the base, m.
        ///
        /// It is positive to the right, in plan along the axis.
        eccentricity: f64,
        /// Eccentricity divided by half the width.
        ///
        /// In plan, for a base that is not rectangular, divided by the distance of the edge.
        ratio: f64,
    },
    /// The structure buckles under its weight (P–Δ), even with its base bonded to the ground.
    ///
    /// The static state of a symmetric structure is then an unstable equilibrium.
    #[error(
        "it buckles under its weight (P–Δ): the load factor is {factor:.4}, with its base bonded to the ground over the \
         contact area"
    )]
    Buckling {
        /// Buckling load divided by the static forces, below 1.
        factor: f64,
    },
    /// The structure tilts, uplifts and overturns because of P–Δ.
    ///
    /// With its base bonded to the ground it would be stable.
    #[error(
        "it tilts, uplifts and overturns (P–Δ): it is stable under at most {factor:.3} times {}, although it would be \
         stable with its base bonded to the ground",
        if *by_loads { "its loads at t = 0 in addition to its weight" } else { "its weight" }
    )]
    Toppling {
        /// Largest multiple of the weight, or of the loads, under which an equilibrium was found.
        ///
        /// The weight is increased from zero in increments of down to 1/64; the loads are increased in tenths.
        factor: f64,
        /// Whether the factor multiplies the loads at t = 0 instead of the weight.
        by_loads: bool,
    },
    /// Weight and loads exceed the bearing pressure of the interface.
    #[error(
        "weight and loads at t = 0 exceed the bearing capacity: a normal force of {normal:.4e} {0}, {ratio:.3} \
         times the capacity {capacity:.4e} {0} of the effective {3} {width:.4} {1} under the resultant{2}",
        force_unit(*across),
        if across.is_some() { "m²" } else { "m" },
        base_text(*ends, *across),
        if across.is_some() { "area" } else { "width" }
    )]
    BearingFailure {
        /// Left and right end of the base of the overloaded part, m.
        ends: [f64; 2],
        /// Front and back end of this base along y, m; `None` in the plane.
        ///
        /// In plan, forces are those of the whole body.
        across: Option<[f64; 2]>,
        /// Normal force, N/m.
        normal: f64,
        /// Effective width, m; in plan the effective area, m².
        ///
        /// The effective width is the width minus twice the eccentricity (Meyerhof 1953).
        width: f64,
        /// Bearing pressure times the effective width or area, N/m.
        capacity: f64,
        /// Normal force divided by the capacity.
        ratio: f64,
    },
    /// The resultant of weight and loads passes beyond the middle of the outermost element.
    ///
    /// It passes through the base, but the traction on an element is constant, with its resultant in the middle of the
    /// element.
    #[error(
        "the resultant of weight and loads at t = 0 passes at {} = {resultant:.4} m{}, but {}",
        axis.unwrap_or('x'),
        base_text(*ends, *across),
        center_range_text(*elements, *reach, axis.unwrap_or('x'))
    )]
    Beyond {
        /// Left and right end of the base of the part, m.
        ends: [f64; 2],
        /// Front and back end of this base along y, m; `None` in the plane.
        ///
        /// In plan, forces are those of the whole body.
        across: Option<[f64; 2]>,
        /// In plan: axis along which the resultant passes beyond the elements, `x` or `y`.
        axis: Option<char>,
        /// Number of elements of the base.
        elements: usize,
        /// Coordinate at which the resultant passes, m.
        resultant: f64,
        /// Middles of the first and the last element along this axis, m.
        reach: [f64; 2],
    },
    /// The bond of the interface breaks, and this failure follows.
    #[error("the bond of the interface breaks, and without it: {then}")]
    BondBreaks {
        /// The failure without the bond.
        then: Box<StabilityError>,
    },
    /// A part of the structure can move without resistance.
    #[error("{}", mechanism_text(.place, *.massless))]
    Mechanism {
        /// The degrees of freedom of this motion, ascending.
        dofs: Vec<usize>,
        /// Names of these degrees of freedom in the structure.
        place: String,
        /// Whether the part has neither mass nor damping.
        massless: bool,
    },
}

/// Beginning of the message of [`StabilityError::Uplift`].
fn uplift_text(upward: f64, buoyancy: f64, unit: &str) -> String {
    if buoyancy > 0.0 {
        let weight = buoyancy - upward;
        format!(
            "it floats: the water lifts it with {buoyancy:.4e} {unit}, but it weighs {weight:.4e} {unit}"
        )
    } else {
        format!("weight and loads at t = 0 lift it off with {upward:.4e} {unit}")
    }
}

/// Message of [`StabilityError::Mechanism`].
fn mechanism_text(dof_names: &str, is_massless: bool) -> String {
    if is_massless {
        format!(
            "nothing resists a motion of {dof_names}: neither stiffness nor damping nor mass of the structure (give \
             these degrees of freedom a mass: the ground does not restrain them after uplift)"
        )
    } else {
        format!(
            "the structure is a mechanism: with its base at rest nothing resists a motion of {dof_names}"
        )
    }
}

/// End of the message of [`StabilityError::Beyond`].
fn center_range_text(element_count: usize, center_range: [f64; 2], axis: char) -> String {
    if element_count == 1 {
        "a base of one element resists no moment".to_owned()
    } else {
        format!(
            "{element_count} elements with constant tractions balance a resultant only between the middles of the \
             outer elements, {axis} = {:.4} to {:.4} m (shorten the outer elements)",
            center_range[0], center_range[1]
        )
    }
}

/// Text for the ends of the base along x, and in plan along y.
fn base_text(x_ends: [f64; 2], y_ends: Option<[f64; 2]>) -> String {
    let y_text = y_ends.map_or(String::new(), |y_ends| format!(", y = {}", range_text(y_ends)));
    format!(" (base from x = {}{y_text})", range_text(x_ends))
}

/// Text for an interval in metres.
fn range_text([start, end]: [f64; 2]) -> String {
    format!("{} to {} m", number_text(start), number_text(end))
}

/// Unit of forces; in plan, where the base has ends along y, that of the whole body.
fn force_unit(y_ends: Option<[f64; 2]>) -> &'static str {
    if y_ends.is_some() { "N" } else { "N/m" }
}

/// Text that names the axis of elements in plan, or their wall; empty in the plane.
pub fn axis_text(axis: Option<char>) -> String {
    match axis {
        Some('z') => " of each wall".to_owned(),
        Some(axis) => format!(" along {axis}"),
        None => String::new(),
    }
}

/// Text for the edge over which the structure overturns; empty in the plane.
fn edge_text(axis: Option<char>, eccentricity: f64) -> &'static str {
    match (axis, eccentricity > 0.0) {
        (None, _) => "",
        (Some('x'), true) => " over its right edge",
        (Some('x'), false) => " over its left edge",
        (Some(_), true) => " over its back edge",
        (Some(_), false) => " over its front edge",
    }
}

/// A flexible base has too few contact elements for its static shape.
///
/// Between the elements' middles only the structure resists deformation.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "contact elements{} under foundation {foundation}: {elements}, but its flexible base needs about {needed}{}{}",
    axis_text(*axis),
    shape_change_text(*difference),
    units_hint(*elements, *needed)
)]
pub struct CoarseBaseError {
    /// Number of the foundation, from the left, from 0.
    pub foundation: usize,
    /// Number of elements of the foundation; in plan along its shorter side.
    pub elements: usize,
    /// Approximate number of elements needed.
    pub needed: usize,
    /// Relative change of the static shape with twice the elements; `None` if it was not computed.
    pub difference: Option<f64>,
    /// Axis along which the elements follow each other.
    ///
    /// In plan `x` for elements of a row, `y` for elements of a column. In the plane `z` for elements of a wall, `None`
    /// for elements of a base.
    pub axis: Option<char>,
}

/// Largest plausible ratio of needed to existing elements.
///
/// A larger ratio implies a softer base than any real one.
const MAX_PLAUSIBLE_ELEMENT_RATIO: usize = 16;

/// Hint to check the units if a base is implausibly soft; empty otherwise.
///
/// Moduli in GPa or lengths in mm make a base so soft.
pub fn units_hint(element_count: usize, needed_count: usize) -> &'static str {
    if needed_count / MAX_PLAUSIBLE_ELEMENT_RATIO < element_count {
        ""
    } else {
        "; such a soft base is implausible: check the units (moduli in Pa, lengths in m, masses in kg)"
    }
}

/// Text for the change of the static shape with twice the elements.
fn shape_change_text(difference: Option<f64>) -> String {
    difference.map_or(String::new(), |change| {
        format!(" (twice as many elements change its static shape by {:.0} %)", 100.0 * change)
    })
}

/// Reason why a structure cannot stand on a ground, for any loads.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StructureError {
    /// The structure has a stiffness to a fixed point: only the ground may support it.
    #[error(
        "the structure must translate freely, without supports: a translation {direction} by 1 m causes a force of \
         {force:.2e} N at degree of freedom {dof}, {ratio:.1e} of the stiffness coefficients in its row (entries of a \
         stiffness matrix in a file need eleven digits or more)"
    )]
    Restrained {
        /// Direction of the resisted translation.
        direction: &'static str,
        /// Force per metre of translation at the degree of freedom, N/m.
        ///
        /// If the structure can hardly translate, this is the force at the contact nodes.
        force: f64,
        /// The degree of freedom with the largest force relative to the stiffness coefficients in its row.
        dof: usize,
        /// This force relative to the stiffness coefficients.
        ratio: f64,
    },
    /// No stiffness connects a part of the structure to its contact nodes.
    ///
    /// The ground would neither carry the weight of this part nor move it.
    #[error(
        "no stiffness connects a part of the structure to its base: {place} (dashpots carry no weight)"
    )]
    Detached {
        /// The degrees of freedom of all such parts, ascending.
        dofs: Vec<usize>,
        /// Names of these degrees of freedom in the structure: see `Structure::describe`.
        place: String,
    },
    /// With fixed contact nodes the structure buckles under its static axial forces.
    #[error(
        "the structure buckles under the axial forces of its static state: with fixed contact nodes it carries \
         {factor:.3e} of these forces"
    )]
    Buckling {
        /// Fraction of the axial forces at which it buckles.
        factor: f64,
    },
}
