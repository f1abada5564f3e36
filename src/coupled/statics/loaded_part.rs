//! Failure of a part of a structure whose load its base cannot bear.
//!
//! | symbol | meaning |
//! |---|---|
//! | M, N | moment of the load about the middle of the base, and its force into the ground |
//! | e | distance of the resultant from the middle of the base: M + N e = 0 |

use crate::coupled::statics::strength::Strength;
use crate::error::StabilityError;
use crate::geometry::{ContactLayout, Edge, axis_name, middle, span};

/// Fraction of the normal force, and of its moments, that counts as rounding.
const RESULTANT_ROUNDING: f64 = 1e-9;

/// A connected part of the structure, with the resultants of its load.
pub(super) struct LoadedPart {
    pub(super) layout: ContactLayout,
    /// Edges of the base; convex.
    pub(super) edges: Vec<Edge>,
    /// Ends of the base along x and along y, m.
    pub(super) bounds: [[f64; 2]; 2],
    /// Centre and area of each contact element.
    pub(super) elements: Vec<([f64; 3], f64)>,
    /// Strength of each contact element.
    pub(super) strengths: Vec<Strength>,
    pub(super) horizontal: f64,
    /// N.
    pub(super) normal: f64,
    /// M for both axes, and the torque.
    pub(super) moments: [f64; 3],
    /// N over the area of all elements, Pa.
    pub(super) pressure: f64,
}

impl LoadedPart {
    /// Way in which the base fails under the load; `None` if it bears the load.
    pub(super) fn failure(&self) -> Option<StabilityError> {
        if self.normal <= 0.0 {
            let ends = self.ends();
            let across = self.ends_across();
            let lifted = StabilityError::Uplift { ends, across, upward: -self.normal };
            return self.opens().then(|| self.once_parted(lifted));
        }
        let slides = self.slides();
        if slides.is_some() && !self.coheres() {
            return slides;
        }
        self.overturns()
            .or_else(|| self.bears_beyond())
            .or(slides)
            .or_else(|| self.twists())
            .or_else(|| self.is_pressed_in())
    }

    /// The resultant passes the edge of the base.
    fn overturns(&self) -> Option<StabilityError> {
        let (ratio, axis) = nearest_edge(&self.edges, self.middles(), self.eccentricities());
        if ratio < 1.0 || ratio.is_nan() || !self.opens() {
            return None;
        }
        // By the right-hand rule about y, a moment that lifts the right side is negative.
        let moment = [-self.layout.rotation_sign() * self.moments[0], self.moments[1]][axis];
        Some(self.once_parted(StabilityError::Overturning {
            ends: self.ends(),
            across: self.ends_across(),
            axis: axis_name(self.layout.is_plan(), axis),
            moment,
            normal: self.normal,
            eccentricity: self.eccentricities()[axis],
            ratio,
        }))
    }

    /// The resultant passes beyond the middles of the elements, where pressures act.
    fn bears_beyond(&self) -> Option<StabilityError> {
        for axis in self.layout.axes() {
            let resultant = self.middles()[axis] + self.eccentricities()[axis];
            let reach = span(self.elements.iter().map(|(center, _)| center[axis]));
            let slack = RESULTANT_ROUNDING * self.half_width(axis);
            if resultant < reach[0] - slack || resultant > reach[1] + slack {
                let axis = axis_name(self.layout.is_plan(), axis);
                let elements = self.elements.len();
                let ends = self.ends();
                let across = self.ends_across();
                let error =
                    StabilityError::Beyond { ends, across, axis, elements, resultant, reach };
                return self.opens().then(|| self.once_parted(error));
            }
        }
        None
    }

    /// The horizontal force is larger than friction.
    fn slides(&self) -> Option<StabilityError> {
        let horizontal = self.horizontal;
        let normal = self.normal;
        let resistance = self.friction() * normal;
        let ratio = horizontal.abs() / resistance;
        let ends = self.ends();
        let across = self.ends_across();
        let error = StabilityError::Sliding { ends, across, horizontal, normal, resistance, ratio };
        let is_beyond = horizontal.abs() > self.friction().max(RESULTANT_ROUNDING) * normal;
        is_beyond.then(|| self.once_sheared(error))
    }

    /// In plan: the torque is larger than the torque of friction.
    fn twists(&self) -> Option<StabilityError> {
        let across = self.ends_across()?;
        let ends = self.ends();
        let normal = self.normal;
        let torque = self.moments[2];
        let pressure_moment = self.pressure * area_moment(&self.elements, self.middles());
        let resistance = self.friction() * pressure_moment;
        let ratio = torque.abs() / resistance;
        let error = StabilityError::Twisting { ends, across, torque, normal, resistance, ratio };
        let is_beyond = torque.abs() > self.friction().max(RESULTANT_ROUNDING) * pressure_moment;
        is_beyond.then(|| self.once_sheared(error))
    }

    /// The normal force is larger than the bearing pressures.
    fn is_pressed_in(&self) -> Option<StabilityError> {
        // The area that the eccentricities leave (Meyerhof 1963).
        let area = self.elements.iter().map(|(_, area)| area).sum::<f64>();
        let effective_ratios = self.layout.axes().map(|axis| 1.0 - self.eccentricity_ratio(axis));
        let width = area * effective_ratios.product::<f64>();
        let normal = self.normal;
        let capacity = self.bearing_capacity(width);
        let ratio = normal / capacity;
        let ends = self.ends();
        let across = self.ends_across();
        let failure =
            StabilityError::BearingFailure { ends, across, normal, width, capacity, ratio };
        (ratio > 1.0).then_some(failure)
    }

    /// Capacity of the bearing pressures on all elements, N.
    ///
    /// At most the largest pressure on `width`, the area centred under the resultant.
    fn bearing_capacity(&self, width: f64) -> f64 {
        let mut total = 0.0;
        let mut max_pressure = 0.0_f64;
        for (strength, (_, area)) in self.strengths.iter().zip(&self.elements) {
            total += strength.bearing_pressure * area;
            max_pressure = max_pressure.max(strength.bearing_pressure);
        }
        (max_pressure * width).min(total)
    }

    /// A failure by separation: bonds that pull must have broken before.
    fn once_parted(&self, failure: StabilityError) -> StabilityError {
        let pulls = self.strengths.iter().any(|strength| strength.pulls);
        if pulls { after_bond(failure) } else { failure }
    }

    /// A failure by sliding: bonds that bear shear must have broken before.
    fn once_sheared(&self, failure: StabilityError) -> StabilityError {
        if self.coheres() { after_bond(failure) } else { failure }
    }

    fn opens(&self) -> bool {
        self.strengths.iter().any(|strength| strength.opens)
    }

    fn coheres(&self) -> bool {
        self.strengths.iter().any(|strength| strength.coheres)
    }

    /// Largest friction coefficient.
    fn friction(&self) -> f64 {
        self.strengths.iter().map(|strength| strength.friction).fold(0.0, f64::max)
    }

    /// Ends of the base along x, m.
    fn ends(&self) -> [f64; 2] {
        self.bounds[0]
    }

    /// Ends of the base along y, m; `None` in the plane.
    fn ends_across(&self) -> Option<[f64; 2]> {
        self.layout.is_plan().then_some(self.bounds[1])
    }

    fn middles(&self) -> [f64; 2] {
        self.bounds.map(middle)
    }

    fn half_width(&self, axis: usize) -> f64 {
        let bounds = self.bounds[axis];
        0.5 * (bounds[1] - bounds[0])
    }

    /// e along both axes, m.
    fn eccentricities(&self) -> [f64; 2] {
        [-self.moments[0] / self.normal, -self.moments[1] / self.normal]
    }

    /// Magnitude of e over half the width.
    fn eccentricity_ratio(&self, axis: usize) -> f64 {
        self.eccentricities()[axis].abs() / self.half_width(axis)
    }
}

/// A failure that only a broken bond explains: otherwise the static state would have been found.
fn after_bond(then: StabilityError) -> StabilityError {
    StabilityError::BondBreaks { then: Box::new(then) }
}

/// Sum of the areas of elements, each times its distance from `middle`.
///
/// `elements`: centre and area of each.
fn area_moment(elements: &[([f64; 3], f64)], middle: [f64; 2]) -> f64 {
    let moments =
        elements.iter().map(|([x, y, _], area)| (x - middle[0]).hypot(y - middle[1]) * area);
    moments.sum()
}

/// Largest ratio of a resultant's distance to an edge's distance, from `middle`, and the axis that this edge faces
/// more.
///
/// `distance`: of the resultant from the middle.
fn nearest_edge(edges: &[Edge], middle: [f64; 2], distance: [f64; 2]) -> (f64, usize) {
    let ratios = edges.iter().map(|edge| {
        let faces_y = edge.normal[1].abs() > edge.normal[0].abs();
        (edge.outward(distance) / edge.reach(middle), usize::from(faces_y))
    });
    ratios.max_by(|one, other| one.0.total_cmp(&other.0)).unwrap_or((0.0, 0))
}
