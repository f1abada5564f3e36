//! The base as a whole or one foundation after a step: sums and means over it, and its factors of safety against
//! sliding and overturning.
//!
//! Factors of safety are made of the contact tractions that did act. Tractions of a base that may open and slide
//! cannot go beyond its strength: such a factor stays at or above one, and reaches it when the base
//! does slide, or stands on its edge. Below one it falls on a bonded base only, where it says how
//! much the interface would have lacked.

use std::ops::Range;

use crate::coupled::{Foundation, State};
use crate::geometry::{Edge, Footing, far_ends};
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
        let each = || self.state.foundations.iter().zip(&self.state.context.footings);
        match self.own() {
            Some(own) => value(own, [0.0; 2]),
            None => each().fold(0.0, |sum, (own, footing)| sum + value(own, footing.center)),
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

    /// The least factor of safety of its foundations, each by its friction coefficients and pressed elements; NaN where
    /// none is known.
    pub(super) fn least(&self, factor: impl Fn(&[f64], &Pressed<'_>) -> f64) -> f64 {
        let context = &self.state.context;
        let of = |k: usize| {
            let own = self.state.foundations[k].elements.clone();
            let Some(footing) = context.footings.get(k) else { return f64::NAN };
            let friction = match context.friction.len() {
                0 | 1 => &context.friction[..],
                _ => context.friction.get(own.clone()).unwrap_or_default(),
            };
            let pressed = Pressed {
                footing,
                areas: context.elements.areas().get(own.clone()).unwrap_or_default(),
                contact: self.state.contact.get(own).unwrap_or_default(),
            };
            factor(friction, &pressed)
        };
        match self.foundation {
            Some(k) => of(k),
            None => (0..self.state.foundations.len()).map(of).fold(f64::NAN, f64::min),
        }
    }
}

/// Area of the open elements of a base.
pub(super) fn open_area(base: &Base<'_>) -> f64 {
    let open = base.areas().iter().zip(base.modes()).filter(|(_, mode)| !mode.is_closed());
    // An empty sum would be a negative zero.
    open.fold(0.0, |sum, (area, _)| sum + area)
}

/// A foundation with the tractions of its elements.
#[derive(Clone, Copy)]
pub(super) struct Pressed<'a> {
    pub(super) footing: &'a Footing,
    /// Area of each element, m²; in the plane its length.
    pub(super) areas: &'a [f64],
    pub(super) contact: &'a [ContactState],
}

impl Pressed<'_> {
    /// Area and state of each element.
    fn areas(&self) -> impl Iterator<Item = (f64, &ContactState)> {
        self.areas.iter().copied().zip(self.contact)
    }
}

/// Σ A φ p over |Σ A τ|, for one friction coefficient or one for each element; NaN without any. An infinite
/// coefficient holds wherever it is pressed on.
pub(super) fn against_sliding(friction: &[f64], pressed: &Pressed<'_>) -> f64 {
    if friction.is_empty() {
        return f64::NAN;
    }
    let (mut resistance, mut normal, mut shear, mut across) = (0.0, 0.0, 0.0, 0.0);
    for (e, (area, state)) in pressed.areas().enumerate() {
        let coefficient = friction[if friction.len() == 1 { 0 } else { e }];
        let force = area * state.pressure;
        // Infinity times zero is no resistance.
        if force != 0.0 && !(coefficient == f64::INFINITY && force < 0.0) {
            resistance += coefficient * force;
        }
        normal += force;
        shear += area * state.shear;
        across += area * state.shear_across;
    }
    ratio(normal, resistance, shear.hypot(across))
}

/// N b over the moment of the pressure about the middle of the base, b the half width. In plan the least of the edges
/// that face along `axis` (x 0, y 1), at their distances b from the middle of the outline; infinite along y in the plane.
pub(super) fn against_overturning(pressed: &Pressed<'_>, axis: usize) -> f64 {
    let Footing { arms, edges, .. } = pressed.footing;
    let (mut normal, mut moment) = (0.0, [0.0; 2]);
    for ((area, state), [x, y]) in pressed.areas().zip(arms) {
        let force = area * state.pressure;
        normal += force;
        moment[0] += force * x;
        moment[1] += force * y;
    }
    let factor =
        |(edge, reach): &(Edge, f64)| ratio(normal, normal * reach, edge.outward(moment).max(0.0));
    edges[axis].iter().map(factor).reduce(f64::min).unwrap_or(f64::INFINITY)
}

/// Resistance over demand: NaN without any pressure, infinite without demand, zero when the base is
/// pulled up on the whole.
fn ratio(normal: f64, resistance: f64, demand: f64) -> f64 {
    if normal == 0.0 {
        f64::NAN
    } else if normal < 0.0 || resistance <= 0.0 {
        0.0
    } else if demand == 0.0 || resistance == f64::INFINITY {
        f64::INFINITY
    } else {
        resistance / demand
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::ContactElement;
    use crate::geometry::Patch;

    const BASE: [ContactElement; 2] =
        [ContactElement { left: -1.0, right: 1.0 }, ContactElement { left: 1.0, right: 2.0 }];

    fn footing(outline: &[[f64; 2]], depths: [f64; 2]) -> Footing {
        let components = if outline.is_empty() { 2 } else { 3 };
        let depths = depths.map(|depth| [0.0, depth]).to_vec();
        let patch = Patch::new(components, BASE.to_vec(), depths, vec![1.0; 2]).unwrap();
        Footing::new(&patch, 0..2, outline, [0.0; 2])
    }

    fn in_plane() -> Footing {
        footing(&[], [1.0; 2])
    }

    fn on<'a>(footing: &'a Footing, contact: &'a [ContactState; 2]) -> Pressed<'a> {
        Pressed { footing, areas: &[2.0, 1.0], contact }
    }

    fn contact(pressure: [f64; 2], shear: [f64; 2]) -> [ContactState; 2] {
        [0, 1].map(|e| ContactState {
            pressure: pressure[e],
            shear: shear[e],
            ..Default::default()
        })
    }

    /// N = 2·30 + 10 = 70, H = −14, middle 0.5, half width 1.5, moment 60·(−0.5) + 10·1 = −20.
    #[test]
    fn by_hand() {
        let (base, state) = (in_plane(), contact([30.0, 10.0], [-10.0, 6.0]));
        let pressed = on(&base, &state);
        assert!((against_sliding(&[0.4], &pressed) - 0.4 * 70.0 / 14.0).abs() < 1e-14);
        assert!((against_sliding(&[0.5, 0.1], &pressed) - 31.0 / 14.0).abs() < 1e-14);
        assert!((against_overturning(&pressed, 0) - 70.0 * 1.5 / 20.0).abs() < 1e-14);
        assert_eq!(against_overturning(&pressed, 1), f64::INFINITY);
    }

    /// In plan, elements 3 m and 1 m deep: N = 180 + 10 = 190, H = −54 and 40, moments about the middle (0.5, 1.5)
    /// along x 180·(−0.5) + 10·1, along y 180·0 + 10·(−1).
    #[test]
    fn by_hand_in_plan() {
        let mut state = contact([30.0, 10.0], [-10.0, 6.0]);
        [state[0].shear_across, state[1].shear_across] = [5.0, 10.0];
        let base = footing(&[[-1.0, 0.0], [2.0, 0.0], [2.0, 3.0], [-1.0, 3.0]], [3.0, 1.0]);
        let pressed = Pressed { areas: &[6.0, 1.0], ..on(&base, &state) };
        let expected = 0.4 * 190.0 / 54.0_f64.hypot(40.0);
        assert!((against_sliding(&[0.4], &pressed) - expected).abs() < 1e-14);
        assert!((against_overturning(&pressed, 0) - 190.0 * 1.5 / 80.0).abs() < 1e-13);
        assert!((against_overturning(&pressed, 1) - 190.0 * 1.5 / 10.0).abs() < 1e-13);
        let one = contact([0.0, 10.0], [0.0; 2]);
        for axis in 0..2 {
            let factor = against_overturning(&on(&base, &one), axis);
            assert!((factor - 1.5).abs() < 1e-14);
        }
        // A diamond about the same middle, whose edges face both ways: (e · n)/h = 2/1.5.
        let base = footing(&[[-1.0, 1.5], [0.5, 0.0], [2.0, 1.5], [0.5, 3.0]], [3.0, 1.0]);
        for axis in 0..2 {
            let factor = against_overturning(&on(&base, &one), axis);
            assert!((factor - 0.75).abs() < 1e-14);
        }
    }

    #[test]
    fn limits() {
        let base = in_plane();
        let sliding = |friction: f64, state| against_sliding(&[friction], &on(&base, state));
        let overturning = |state| against_overturning(&on(&base, state), 0);
        let (flight, pressed) = (contact([0.0; 2], [0.0; 2]), contact([1.0; 2], [0.0; 2]));
        for friction in [0.0, 0.4, f64::INFINITY] {
            assert!(sliding(friction, &flight).is_nan());
        }
        assert!(overturning(&flight).is_nan());
        assert_eq!(sliding(0.4, &pressed), f64::INFINITY);
        assert_eq!(sliding(0.0, &pressed), 0.0);
        assert_eq!(sliding(f64::INFINITY, &contact([1.0, 0.0], [0.3, 0.0])), f64::INFINITY);
        // Resultant at the middle: 2 p₀ (−½) + p₁ (1) = 0.
        assert_eq!(overturning(&pressed), f64::INFINITY);
        // Pulled up on the whole: nothing resists.
        assert_eq!(overturning(&contact([-1.0; 2], [0.0; 2])), 0.0);
    }
}
