//! Number of elements that the rocking of a foundation needs along an axis.

use crate::coupled::state::foundation::Foundation;
use crate::geometry::{Patch, enclosing_interval, min_interval_count};

/// Limits of base moment over base shear and width, with the needed number of elements.
///
/// A foundation needs this number of elements above the limit. Below the last ratio rocking is negligible.
const ELEMENTS_FOR_ROCKING: [(f64, usize); 2] = [(0.5, 4), (0.1, 3)];
/// Smallest number of elements of any foundation.
///
/// A single element resists no moment and does not rock.
pub(crate) const MIN_FOUNDATION_ELEMENTS: usize = 2;
/// Deviation of a ratio of sides from a whole number that is due to rounding.
const WHOLE_RATIO_TOLERANCE: f64 = 1e-6;

/// Elements and largest forces of a foundation along one axis.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FoundationAxis {
    pub(crate) element_count: usize,
    pub(crate) width: f64,
    static_moment: f64,
    /// Largest shear so far, N (in the plane N/m).
    max_shear: f64,
    /// Largest change of the moment from the static one so far, N·m (in the plane N·m/m).
    max_moment_change: f64,
}

impl FoundationAxis {
    /// Axis before the first step; `element_ends`: coordinates of each element's ends along the axis, m.
    fn new(element_ends: Vec<[f64; 2]>, static_moment: f64) -> Self {
        let edges = enclosing_interval(element_ends.iter().copied());
        Self {
            element_count: min_interval_count(element_ends),
            width: edges[1] - edges[0],
            static_moment,
            ..Self::default()
        }
    }

    /// Extends the extremes by the shear and moment of a step.
    pub(crate) fn update(&mut self, shear: f64, moment: f64) {
        self.max_shear = self.max_shear.max(shear.abs());
        self.max_moment_change = self.max_moment_change.max((moment - self.static_moment).abs());
    }

    /// Smallest number of elements that the foundation's rocking needs.
    pub(crate) fn needed_elements(&self) -> usize {
        let moment_ratio = self.max_moment_change / (self.max_shear * self.width);
        for (ratio_limit, needed) in ELEMENTS_FOR_ROCKING {
            if self.element_count < MIN_FOUNDATION_ELEMENTS || moment_ratio > ratio_limit {
                return needed;
            }
        }
        MIN_FOUNDATION_ELEMENTS
    }
}

/// Longest side of elements along an axis, m.
pub(crate) fn longest_side(elements: &Patch, axis: usize) -> f64 {
    elements.iter().map(|element| element.sides()[axis]).fold(0.0, f64::max)
}

/// Side of a cell of the grid along an axis, m.
///
/// Sides of unions of cells are whole multiples of the narrowest side, which is then a cell's. Otherwise some elements
/// are parts of cells, and the widest element is a whole cell.
pub(crate) fn cell_side(elements: &Patch, axis: usize) -> f64 {
    let sides = elements.iter().map(|element| element.sides()[axis]);
    let narrowest = sides.clone().fold(f64::INFINITY, f64::min);
    for side in sides {
        let ratio = side / narrowest;
        let is_whole = (ratio.round() - ratio).abs() < WHOLE_RATIO_TOLERANCE;
        if !is_whole {
            return longest_side(elements, axis);
        }
    }
    narrowest
}

/// Axes of a foundation before the first step: x and, in plan, y.
///
/// Elements of walls do not count. In the plane the axis y never needs more elements.
pub(crate) fn foundation_axes(foundation: &Foundation, elements: &Patch) -> [FoundationAxis; 2] {
    let floor = elements.floor();
    let end = foundation.elements.end.min(floor.end);
    let start = foundation.elements.start.max(floor.start).min(end);
    let static_moments = [foundation.base_moment, foundation.moment_across];
    let unchecked_axis = FoundationAxis { element_count: usize::MAX, ..FoundationAxis::default() };
    let mut axes = [unchecked_axis; 2];
    for (axis, static_moment) in elements.layout().axes().zip(static_moments) {
        let element_ends =
            elements[start..end].iter().map(|element| element.ends()[axis]).collect();
        axes[axis] = FoundationAxis::new(element_ends, static_moment);
    }
    axes
}
