//! The base after a step, as a whole or one foundation: sums, means and extremes over its elements.

use std::ops::Range;

use crate::coupled::state::foundation::Derived;
use crate::coupled::{Foundation, State};
use crate::geometry::far_ends;
use crate::interface::{ContactState, Mode};

/// The whole base, or one foundation of it.
#[derive(Clone, Copy)]
pub(crate) struct BaseView<'a> {
    pub(crate) state: &'a State,
    pub(crate) foundation: Option<usize>,
}

impl<'a> BaseView<'a> {
    fn own(&self) -> Option<&'a Foundation> {
        self.foundation.map(|k| &self.state.foundations[k])
    }

    /// Value of the whole base, or of the foundation.
    pub(crate) fn pick(&self, whole: f64, own: fn(&Foundation) -> f64) -> f64 {
        self.own().map_or(whole, own)
    }

    /// Sum over all foundations, or the foundation's own value.
    ///
    /// `value` receives a foundation and its middle relative to the point of the base moment; for a single
    /// foundation zeros.
    pub(crate) fn sum(&self, value: impl Fn(&Foundation, [f64; 2]) -> f64) -> f64 {
        let each = || self.state.foundations.iter().zip(&self.state.context.footings);
        match self.own() {
            Some(own) => value(own, [0.0; 2]),
            None => each().fold(0.0, |sum, (own, footing)| sum + value(own, footing.center)),
        }
    }

    /// The value of largest magnitude among all foundations, or the foundation's own.
    pub(crate) fn largest(&self, value: fn(&Foundation) -> f64) -> f64 {
        let larger = |far: f64, own: f64| if own.abs() > far.abs() { own } else { far };
        let all = || self.state.foundations.iter().map(value).fold(0.0, larger);
        self.own().map_or_else(all, value)
    }

    /// Mean over the area; zero if a state has no such numbers.
    pub(crate) fn mean(&self, value: fn(&ContactState) -> f64) -> f64 {
        let each = self.areas().iter().zip(self.contact());
        let sums =
            each.fold([0.0; 2], |[sum, all], (area, own)| [sum + area * value(own), all + area]);
        if sums[0] == 0.0 { 0.0 } else { sums[0] / sums[1] }
    }

    pub(crate) fn elements(&self) -> Range<usize> {
        self.own().map_or(0..self.state.contact.len(), |own| own.elements.clone())
    }

    /// Contact states of its elements.
    ///
    /// The lists of a state are public and may have been shortened.
    pub(crate) fn contact(&self) -> &'a [ContactState] {
        self.state.contact.get(self.elements()).unwrap_or_default()
    }

    pub(crate) fn modes(&self) -> &'a [Mode] {
        self.state.modes.get(self.elements()).unwrap_or_default()
    }

    fn areas(&self) -> &'a [f64] {
        self.state.context.elements.areas().get(self.elements()).unwrap_or_default()
    }

    /// Left and right, front and back end: of the elements in the plane, of the outline in plan.
    pub(crate) fn ends(&self) -> [[f64; 2]; 2] {
        let footings = &self.state.context.footings;
        let own = self.foundation.map_or(0..footings.len(), |k| k..k + 1);
        let own = footings.get(own).unwrap_or_default();
        [0, 1].map(|axis| far_ends(own.iter().map(|own| own.ends[axis])))
    }

    /// The smallest factor of safety of its foundations; NaN if none is known.
    pub(crate) fn least(&self, factor: fn(&Derived) -> f64) -> f64 {
        let all = || self.state.foundations.iter().map(|own| factor(&own.derived));
        self.own().map_or_else(|| all().fold(f64::NAN, f64::min), |own| factor(&own.derived))
    }
}

/// Area of the open elements of a base.
pub(crate) fn open_area(base: &BaseView<'_>) -> f64 {
    let open = base.areas().iter().zip(base.modes()).filter(|(_, mode)| !mode.is_closed());
    // An empty sum would be a negative zero.
    open.fold(0.0, |sum, (area, _)| sum + area)
}
