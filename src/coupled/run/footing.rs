//! The base as a whole or one foundation after a step: sums and means over it.

use std::ops::Range;

use crate::coupled::foundation::Safety;
use crate::coupled::{Foundation, State};
use crate::geometry::far_ends;
use crate::interface::{ContactState, Mode};

/// The base as a whole, or the foundation of this number.
#[derive(Clone, Copy)]
pub(super) struct Base<'a> {
    pub(super) state: &'a State,
    pub(super) foundation: Option<usize>,
}

impl<'a> Base<'a> {
    fn own(&self) -> Option<&'a Foundation> {
        self.foundation.map(|k| &self.state.foundations[k])
    }

    /// Value of the whole base, or that of the foundation.
    pub(super) fn pick(&self, whole: f64, own: fn(&Foundation) -> f64) -> f64 {
        self.own().map_or(whole, own)
    }

    /// Sum over all foundations, each with its middle from the point of the base moment; or the foundation's own.
    pub(super) fn sum(&self, value: impl Fn(&Foundation, [f64; 2]) -> f64) -> f64 {
        let each = || self.state.foundations.iter().zip(&self.state.context.arms);
        match self.own() {
            Some(own) => value(own, [0.0; 2]),
            None => each().fold(0.0, |sum, (own, arm)| sum + value(own, *arm)),
        }
    }

    /// The largest of all foundations, or the foundation's own.
    pub(super) fn largest(&self, value: fn(&Foundation) -> f64) -> f64 {
        let larger = |far: f64, own: f64| if own.abs() > far.abs() { own } else { far };
        let all = || self.state.foundations.iter().map(value).fold(0.0, larger);
        self.own().map_or_else(all, value)
    }

    /// Mean over the area; zero of numbers that a state does not have.
    pub(super) fn mean(&self, value: fn(&ContactState) -> f64) -> f64 {
        let each = self.areas().iter().zip(self.contact());
        let sums =
            each.fold([0.0; 2], |[sum, all], (area, own)| [sum + area * value(own), all + area]);
        if sums[0] == 0.0 { 0.0 } else { sums[0] / sums[1] }
    }

    pub(super) fn elements(&self) -> Range<usize> {
        self.own().map_or(0..self.state.contact.len(), |own| own.elements.clone())
    }

    /// Contact of its elements. The lists of a state are public: they may have been cut.
    pub(super) fn contact(&self) -> &'a [ContactState] {
        self.state.contact.get(self.elements()).unwrap_or_default()
    }

    pub(super) fn modes(&self) -> &'a [Mode] {
        self.state.modes.get(self.elements()).unwrap_or_default()
    }

    fn areas(&self) -> &'a [f64] {
        self.state.context.elements.areas().get(self.elements()).unwrap_or_default()
    }

    /// Left and right, front and back end: of its elements in the plane, of its outline in plan.
    pub(super) fn ends(&self) -> [[f64; 2]; 2] {
        let footings = &self.state.context.footings;
        let own = self.foundation.map_or(0..footings.len(), |k| k..k + 1);
        let own = footings.get(own).unwrap_or_default();
        [0, 1].map(|axis| far_ends(own.iter().map(|own| own.ends[axis])))
    }

    /// The least factor of safety of its foundations; NaN where none is known.
    pub(super) fn least(&self, factor: fn(&Safety) -> f64) -> f64 {
        let all = || self.state.foundations.iter().map(|own| factor(&own.safety));
        self.own().map_or_else(|| all().fold(f64::NAN, f64::min), |own| factor(&own.safety))
    }
}

/// Area of the open elements of a base.
pub(super) fn open_area(base: &Base<'_>) -> f64 {
    let open = base.areas().iter().zip(base.modes()).filter(|(_, mode)| !mode.is_closed());
    // An empty sum would be a negative zero.
    open.fold(0.0, |sum, (area, _)| sum + area)
}
