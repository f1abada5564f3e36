//! The base after a step, as a whole or one foundation.
//!
//! It gives sums, means and extremes over the elements.

use std::ops::Range;

use crate::coupled::state::foundation::FoundationChecks;
use crate::coupled::{Foundation, State};
use crate::geometry::enclosing_interval;
use crate::interface::{ContactState, Mode};

/// The whole base, or one foundation of it.
#[derive(Clone, Copy)]
pub(crate) struct BaseView<'a> {
    pub(crate) state: &'a State,
    /// Number of the foundation, from 0; `None` for the whole base.
    pub(crate) foundation: Option<usize>,
}

impl<'a> BaseView<'a> {
    fn single_foundation(&self) -> Option<&'a Foundation> {
        self.foundation.map(|k| &self.state.foundations[k])
    }

    /// `whole_value` for the whole base, or `value` of the single foundation.
    pub(crate) fn whole_or(&self, whole_value: f64, value: fn(&Foundation) -> f64) -> f64 {
        self.single_foundation().map_or(whole_value, value)
    }

    /// Sum over all foundations, or the value of the single foundation.
    ///
    /// `value` receives a foundation and its middle relative to the point of the base moment; for a single
    /// foundation zeros.
    pub(crate) fn sum(&self, value: impl Fn(&Foundation, [f64; 2]) -> f64) -> f64 {
        if let Some(foundation) = self.single_foundation() {
            return value(foundation, [0.0; 2]);
        }
        let mut sum = 0.0;
        for (foundation, footing) in self.state.foundations.iter().zip(&self.state.context.footings)
        {
            sum += value(foundation, footing.center);
        }
        sum
    }

    /// The value of largest magnitude among all foundations, or the value of the single foundation.
    pub(crate) fn largest(&self, value: fn(&Foundation) -> f64) -> f64 {
        if let Some(foundation) = self.single_foundation() {
            return value(foundation);
        }
        let mut largest_value: f64 = 0.0;
        for candidate in self.state.foundations.iter().map(value) {
            if candidate.abs() > largest_value.abs() {
                largest_value = candidate;
            }
        }
        largest_value
    }

    /// The highest value of all foundations, with its sign, or the value of the single foundation.
    pub(crate) fn highest(&self, value: fn(&Foundation) -> f64) -> f64 {
        if let Some(foundation) = self.single_foundation() {
            return value(foundation);
        }
        self.state.foundations.iter().map(value).reduce(f64::max).unwrap_or(0.0)
    }

    /// Mean of `value` over the area of the base; zero without contact states.
    pub(crate) fn mean(&self, value: fn(&ContactState) -> f64) -> f64 {
        let mut integral = 0.0;
        let mut total_area = 0.0;
        for (area, contact) in self.areas().iter().zip(self.contact()) {
            integral += area * value(contact);
            total_area += area;
        }
        if integral == 0.0 { 0.0 } else { integral / total_area }
    }

    /// Indices of the elements of the base.
    pub(crate) fn elements(&self) -> Range<usize> {
        match self.single_foundation() {
            Some(foundation) => foundation.elements.clone(),
            None => 0..self.state.contact.len(),
        }
    }

    /// Contact states of the elements of the base.
    ///
    /// Empty if the caller has shortened the state's public list.
    pub(crate) fn contact(&self) -> &'a [ContactState] {
        self.state.contact.get(self.elements()).unwrap_or_default()
    }

    /// Contact modes of the elements of the base.
    pub(crate) fn modes(&self) -> &'a [Mode] {
        self.state.modes.get(self.elements()).unwrap_or_default()
    }

    fn areas(&self) -> &'a [f64] {
        self.state.context.elements.areas().get(self.elements()).unwrap_or_default()
    }

    /// Left and right end, front and back end.
    ///
    /// They are those of the elements in the plane, and those of the outline in plan.
    pub(crate) fn ends(&self) -> [[f64; 2]; 2] {
        let footings = &self.state.context.footings;
        let indices = self.foundation.map_or(0..footings.len(), |k| k..k + 1);
        let footings = footings.get(indices).unwrap_or_default();
        [0, 1].map(|axis| enclosing_interval(footings.iter().map(|footing| footing.ends[axis])))
    }

    /// The smallest factor of safety of the foundations; NaN if none has one.
    pub(crate) fn smallest_safety(&self, factor: fn(&FoundationChecks) -> f64) -> f64 {
        self.checks().iter().map(factor).fold(f64::NAN, f64::min)
    }

    fn checks(&self) -> &'a [FoundationChecks] {
        match self.foundation {
            Some(k) => &self.state.checks[k..=k],
            None => &self.state.checks,
        }
    }
}

/// Area of the open elements of a base, m²; in the plane their length, m.
pub(crate) fn open_area(base: &BaseView<'_>) -> f64 {
    let open_elements = base.areas().iter().zip(base.modes()).filter(|(_, mode)| !mode.is_closed());
    // `sum` of no elements would return negative zero.
    open_elements.fold(0.0, |sum, (area, _)| sum + area)
}

/// Largest |slip| of any element of a base, m.
pub(crate) fn largest_slip(base: &BaseView<'_>) -> f64 {
    base.checks().iter().fold(0.0, |largest, checks| checks.largest_slip.max(largest))
}
