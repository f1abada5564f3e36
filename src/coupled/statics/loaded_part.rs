//! Failure of a connected part whose load exceeds the strength of its base.
//!
//! | symbol | meaning |
//! |---|---|
//! | M, N | moment of the load about the middle of the base, and its force into the ground |
//! | e | eccentricity: distance of the resultant from the middle of the base, M + N e = 0 |

use crate::coupled::statics::strength::InterfaceStrength;
use crate::error::StabilityError;
use crate::geometry::{ContactLayout, Edge, axis_name, middle, span};

/// Fraction of the normal force, and of its moments, that counts as rounding.
const RESULTANT_ROUNDING_TOLERANCE: f64 = 1e-9;

/// A connected part of the structure, with the resultants of its load.
pub(super) struct LoadedPart {
    pub(super) layout: ContactLayout,
    /// Edges of the convex outline of the base.
    pub(super) edges: Vec<Edge>,
    /// Ends of the base along x and along y, m.
    pub(super) bounds: [[f64; 2]; 2],
    /// Centre and area of each contact element.
    pub(super) elements: Vec<([f64; 3], f64)>,
    /// Strength of each contact element.
    pub(super) strengths: Vec<InterfaceStrength>,
    /// Horizontal force of the load, N.
    pub(super) horizontal: f64,
    /// Normal force N of the load into the ground, N.
    pub(super) normal: f64,
    /// Moments M of the load for both axes, N m.
    pub(super) moments: [f64; 2],
    /// Torque of the load, N m.
    pub(super) torque: f64,
    /// Mean pressure: N over the area of all elements, Pa.
    pub(super) pressure: f64,
}

impl LoadedPart {
    /// Failure mode of the base under the load.
    ///
    /// `None` if the base resists the load.
    pub(super) fn failure(&self) -> Option<StabilityError> {
        if self.normal <= 0.0 {
            let ends = self.x_ends();
            let across = self.y_ends();
            let uplift =
                StabilityError::Uplift { ends, across, upward: -self.normal, buoyancy: 0.0 };
            return self.can_open().then(|| self.after_separation(uplift));
        }
        let sliding = self.sliding();
        if sliding.is_some() && !self.has_cohesion() {
            return sliding;
        }
        self.overturning()
            .or_else(|| self.resultant_beyond_elements())
            .or(sliding)
            .or_else(|| self.twisting())
            .or_else(|| self.bearing_failure())
    }

    /// Overturning, if the resultant passes the edge of the base.
    fn overturning(&self) -> Option<StabilityError> {
        let (ratio, axis) = largest_edge_ratio(&self.edges, self.middles(), self.eccentricities());
        if ratio < 1.0 || ratio.is_nan() || !self.can_open() {
            return None;
        }
        // By the right-hand rule about y, a moment that raises the right side is negative.
        let moment = [-self.layout.rotation_sign() * self.moments[0], self.moments[1]][axis];
        Some(self.after_separation(StabilityError::Overturning {
            ends: self.x_ends(),
            across: self.y_ends(),
            axis: axis_name(self.layout.is_plan(), axis),
            moment,
            normal: self.normal,
            eccentricity: self.eccentricities()[axis],
            ratio,
        }))
    }

    /// Failure if the resultant passes beyond the middles of the elements, where pressures act.
    fn resultant_beyond_elements(&self) -> Option<StabilityError> {
        for axis in self.layout.axes() {
            let resultant = self.middles()[axis] + self.eccentricities()[axis];
            let reach = span(self.elements.iter().map(|(center, _)| center[axis]));
            let tolerance = RESULTANT_ROUNDING_TOLERANCE * self.half_width(axis);
            if resultant < reach[0] - tolerance || resultant > reach[1] + tolerance {
                let axis = axis_name(self.layout.is_plan(), axis);
                let elements = self.elements.len();
                let ends = self.x_ends();
                let across = self.y_ends();
                let error =
                    StabilityError::Beyond { ends, across, axis, elements, resultant, reach };
                return self.can_open().then(|| self.after_separation(error));
            }
        }
        None
    }

    /// Sliding, if the horizontal force exceeds friction.
    fn sliding(&self) -> Option<StabilityError> {
        let horizontal = self.horizontal;
        let normal = self.normal;
        let resistance = self.friction() * normal;
        let ratio = horizontal.abs() / resistance;
        let ends = self.x_ends();
        let across = self.y_ends();
        let error = StabilityError::Sliding { ends, across, horizontal, normal, resistance, ratio };
        let is_beyond =
            horizontal.abs() > self.friction().max(RESULTANT_ROUNDING_TOLERANCE) * normal;
        is_beyond.then(|| self.after_shear_failure(error))
    }

    /// Twisting in plan, if the torque exceeds the torque of friction.
    fn twisting(&self) -> Option<StabilityError> {
        let across = self.y_ends()?;
        let ends = self.x_ends();
        let normal = self.normal;
        let torque = self.torque;
        let pressure_moment = self.pressure * area_moment(&self.elements, self.middles());
        let resistance = self.friction() * pressure_moment;
        let ratio = torque.abs() / resistance;
        let error = StabilityError::Twisting { ends, across, torque, normal, resistance, ratio };
        let is_beyond =
            torque.abs() > self.friction().max(RESULTANT_ROUNDING_TOLERANCE) * pressure_moment;
        is_beyond.then(|| self.after_shear_failure(error))
    }

    /// Bearing failure, if the normal force exceeds the bearing capacity.
    fn bearing_failure(&self) -> Option<StabilityError> {
        // Effective area of an eccentric load (Meyerhof 1963).
        let area = self.elements.iter().map(|(_, area)| area).sum::<f64>();
        let effective_ratios = self.layout.axes().map(|axis| 1.0 - self.eccentricity_ratio(axis));
        let effective_area = area * effective_ratios.product::<f64>();
        let normal = self.normal;
        let capacity = self.bearing_capacity(effective_area);
        let ratio = normal / capacity;
        let ends = self.x_ends();
        let across = self.y_ends();
        let width = effective_area;
        let failure =
            StabilityError::BearingFailure { ends, across, normal, width, capacity, ratio };
        (ratio > 1.0).then_some(failure)
    }

    /// Bearing capacity, N.
    ///
    /// It is the sum over all elements, but at most the largest bearing pressure times the effective area.
    fn bearing_capacity(&self, effective_area: f64) -> f64 {
        let mut total_capacity = 0.0;
        let mut max_pressure = 0.0_f64;
        for (strength, (_, area)) in self.strengths.iter().zip(&self.elements) {
            total_capacity += strength.bearing_pressure * area;
            max_pressure = max_pressure.max(strength.bearing_pressure);
        }
        (max_pressure * effective_area).min(total_capacity)
    }

    /// A failure by separation, after the failure of bonds in tension if there are any.
    fn after_separation(&self, failure: StabilityError) -> StabilityError {
        let has_tension_bond = self.strengths.iter().any(|strength| strength.resists_tension);
        if has_tension_bond { after_bond_failure(failure) } else { failure }
    }

    /// A failure by sliding, after the failure of bonds in shear if there are any.
    fn after_shear_failure(&self, failure: StabilityError) -> StabilityError {
        if self.has_cohesion() { after_bond_failure(failure) } else { failure }
    }

    fn can_open(&self) -> bool {
        self.strengths.iter().any(|strength| strength.can_open)
    }

    fn has_cohesion(&self) -> bool {
        self.strengths.iter().any(|strength| strength.has_cohesion)
    }

    /// Largest friction coefficient.
    fn friction(&self) -> f64 {
        self.strengths.iter().map(|strength| strength.friction).fold(0.0, f64::max)
    }

    /// Ends of the base along x, m.
    fn x_ends(&self) -> [f64; 2] {
        self.bounds[0]
    }

    /// Ends of the base along y, m; `None` in the plane.
    fn y_ends(&self) -> Option<[f64; 2]> {
        self.layout.is_plan().then_some(self.bounds[1])
    }

    /// Middle of the base along x and along y, m.
    fn middles(&self) -> [f64; 2] {
        self.bounds.map(middle)
    }

    /// Half the width of the base along an axis, m.
    fn half_width(&self, axis: usize) -> f64 {
        let bounds = self.bounds[axis];
        0.5 * (bounds[1] - bounds[0])
    }

    /// Eccentricity e along both axes, m.
    fn eccentricities(&self) -> [f64; 2] {
        [-self.moments[0] / self.normal, -self.moments[1] / self.normal]
    }

    /// Magnitude of the eccentricity over half the width of the base.
    fn eccentricity_ratio(&self, axis: usize) -> f64 {
        self.eccentricities()[axis].abs() / self.half_width(axis)
    }
}

/// Failure of a bond, with the failure of the base that follows.
///
/// With an intact bond there would be a static state.
fn after_bond_failure(consequence: StabilityError) -> StabilityError {
    StabilityError::BondBreaks { then: Box::new(consequence) }
}

/// Sum of the areas of elements times their distances from `middle`, m³.
///
/// `elements` has the centre and the area of each.
fn area_moment(elements: &[([f64; 3], f64)], middle: [f64; 2]) -> f64 {
    let moments =
        elements.iter().map(|([x, y, _], area)| (x - middle[0]).hypot(y - middle[1]) * area);
    moments.sum()
}

/// Largest ratio of the eccentricity to the distance of an edge, with an axis.
///
/// Distances are from `middle`. The axis is the one along which the normal has its larger component.
fn largest_edge_ratio(edges: &[Edge], middle: [f64; 2], eccentricities: [f64; 2]) -> (f64, usize) {
    let ratios = edges.iter().map(|edge| {
        let faces_y = edge.normal[1].abs() > edge.normal[0].abs();
        (edge.outward(eccentricities) / edge.reach(middle), usize::from(faces_y))
    });
    ratios.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0))
}
