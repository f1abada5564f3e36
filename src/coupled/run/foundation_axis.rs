//! Elements and largest forces of a foundation along an axis, for the resolution of its rocking.

use crate::coupled::state::foundation::Foundation;
use crate::geometry::{Patch, far_ends, min_interval_count};

/// Ratio of base moment to base shear times width, above which a foundation needs this number of elements.
///
/// Below the last limit rocking does not matter.
const ROCKING_ELEMENTS: [(f64, usize); 2] = [(0.5, 4), (0.1, 3)];
/// Smallest number of elements of any foundation: a single element resists no moment and does not rock.
pub(crate) const MIN_FOUNDATION_ELEMENTS: usize = 2;
/// Distance of a ratio of sides from a whole number that counts as rounding.
const WHOLE_RATIO_TOLERANCE: f64 = 1e-6;

/// A foundation along one axis.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FoundationAxis {
    pub(crate) elements: usize,
    pub(crate) width: f64,
    static_moment: f64,
    /// Largest shear and change of moment.
    shear: f64,
    moment: f64,
}

impl FoundationAxis {
    /// Axis of elements with these `ends` along it.
    fn new(ends: Vec<[f64; 2]>, static_moment: f64) -> Self {
        let edges = far_ends(ends.iter().copied());
        Self {
            elements: min_interval_count(ends),
            width: edges[1] - edges[0],
            static_moment,
            ..Self::default()
        }
    }

    /// Extends the extremes by the shear and moment of a step.
    pub(crate) fn update(&mut self, shear: f64, moment: f64) {
        self.shear = self.shear.max(shear.abs());
        self.moment = self.moment.max((moment - self.static_moment).abs());
    }

    /// Smallest number of elements that the foundation's rocking needs.
    pub(crate) fn needed_elements(&self) -> usize {
        let arm = self.moment / (self.shear * self.width);
        for (arm_limit, needed) in ROCKING_ELEMENTS {
            if self.elements < MIN_FOUNDATION_ELEMENTS || arm > arm_limit {
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

/// Side of the cells along an axis, m.
///
/// The narrowest of unions is a cell, and so is the widest where others are parts of a cell.
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

/// Elements and static moments of a foundation along x and, in plan, y; without elements of walls.
pub(crate) fn axes_of(foundation: &Foundation, elements: &Patch) -> [FoundationAxis; 2] {
    let floor = elements.floor();
    let last = foundation.elements.end.min(floor.end);
    let first = foundation.elements.start.max(floor.start).min(last);
    let moments = [foundation.base_moment, foundation.moment_across];
    let unlimited = FoundationAxis { elements: usize::MAX, ..FoundationAxis::default() };
    let mut axes = [unlimited; 2];
    for (axis, moment) in elements.layout().axes().zip(moments) {
        let ends = elements[first..last].iter().map(|element| element.ends()[axis]).collect();
        axes[axis] = FoundationAxis::new(ends, moment);
    }
    axes
}
