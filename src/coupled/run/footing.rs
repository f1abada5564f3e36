//! The base as a whole or one foundation after a step: sums and means over it, and its factors of safety against
//! sliding and overturning.
//!
//! Factors of safety are made of the contact tractions that did act. Tractions of a base that may open and slide
//! cannot go beyond its strength: such a factor stays at or above one, and reaches it when the base
//! does slide, or stands on its edge. Below one it falls on a bonded base only, where it says how
//! much the interface would have lacked.

use std::ops::Range;

use crate::bem::ContactElement;
use crate::coupled::{Foundation, State};
use crate::geometry::{Edge, far_ends, middle, span};
use crate::interface::{ContactState, Mode};

/// Components of an edge's normal that are equal but for rounding.
const ALIKE: f64 = 1.0 - 1e-9;

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

    /// Left and right, front and back ends (m): those of the elements in the plane, of the outline in plan.
    pub(super) fn ends(&self) -> [[f64; 2]; 2] {
        let context = &self.state.context;
        if !context.elements.is_plan() {
            let own = context.elements.get(self.elements()).unwrap_or_default();
            return [far_ends(own.iter().map(|element| [element.left, element.right])), [0.0; 2]];
        }
        let own = self.foundation.map_or(0..context.outlines.len(), |k| k..k + 1);
        let corners = || context.outlines[own.clone()].iter().flatten();
        [0, 1].map(|axis| span(corners().map(|corner| corner[axis])))
    }

    /// The least factor of safety of its foundations, by friction coefficients and contact; NaN where
    /// none is known.
    pub(super) fn least(&self, factor: impl Fn(&[f64], Footing<'_>) -> f64) -> f64 {
        let of = |k: usize| {
            let (own, context) = (self.state.foundations[k].elements.clone(), &self.state.context);
            let friction = match context.friction.len() {
                0 | 1 => &context.friction[..],
                _ => context.friction.get(own.clone()).unwrap_or_default(),
            };
            let footing = Footing {
                elements: context.elements.get(own.clone()).unwrap_or_default(),
                depths: context.elements.depths().get(own.clone()).unwrap_or_default(),
                areas: context.elements.areas().get(own.clone()).unwrap_or_default(),
                contact: self.state.contact.get(own).unwrap_or_default(),
                outline: context.outlines.get(k).map(Vec::as_slice).unwrap_or_default(),
            };
            factor(friction, footing)
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

/// Elements of a foundation with their tractions.
#[derive(Clone, Copy)]
pub(super) struct Footing<'a> {
    pub(super) elements: &'a [ContactElement],
    /// Front and back end of each element, m.
    pub(super) depths: &'a [[f64; 2]],
    /// Area of each element, m²; in the plane its length.
    pub(super) areas: &'a [f64],
    pub(super) contact: &'a [ContactState],
    /// Corners of the convex outline, counter-clockwise; none in the plane.
    pub(super) outline: &'a [[f64; 2]],
}

impl Footing<'_> {
    /// Area and state of each element.
    fn areas(&self) -> impl Iterator<Item = (f64, &ContactState)> {
        self.areas.iter().copied().zip(self.contact)
    }

    /// Ends of an element along x (0) or y (1), m.
    fn ends(&self, e: usize, axis: usize) -> [f64; 2] {
        if axis == 0 { [self.elements[e].left, self.elements[e].right] } else { self.depths[e] }
    }
}

/// Σ A φ p over |Σ A τ|, for one friction coefficient or one for each element; NaN without any. An infinite
/// coefficient holds wherever it is pressed on.
pub(super) fn against_sliding(friction: &[f64], footing: Footing<'_>) -> f64 {
    if friction.is_empty() {
        return f64::NAN;
    }
    let (mut resistance, mut normal, mut shear, mut across) = (0.0, 0.0, 0.0, 0.0);
    for (e, (area, state)) in footing.areas().enumerate() {
        let coefficient = friction[if friction.len() == 1 { 0 } else { e }];
        let pressed = area * state.pressure;
        // Infinity times zero is no resistance.
        if pressed != 0.0 && !(coefficient == f64::INFINITY && pressed < 0.0) {
            resistance += coefficient * pressed;
        }
        normal += pressed;
        shear += area * state.shear;
        across += area * state.shear_across;
    }
    ratio(normal, resistance, shear.hypot(across))
}

/// N b over the moment of the pressure about the middle of the base, b the half width. In plan the least of the edges
/// that face along `axis` (x 0, y 1), at their distances b from the middle of the outline; infinite along y in the
/// plane.
pub(super) fn against_overturning(footing: Footing<'_>, axis: usize) -> f64 {
    let Footing { elements, outline, .. } = footing;
    if elements.is_empty() || outline.is_empty() && axis > 0 {
        return f64::INFINITY;
    }
    let ends = |axis: usize| {
        if outline.is_empty() {
            return far_ends((0..elements.len()).map(|e| footing.ends(e, axis)));
        }
        span(outline.iter().map(|corner| corner[axis]))
    };
    // Resultant, and its moment about the middle along one axis.
    let pressed = |axis: usize, center: f64| {
        let each = footing.areas().enumerate().map(|(e, (area, state))| {
            let force = area * state.pressure;
            [force, force * (middle(footing.ends(e, axis)) - center)]
        });
        each.fold([0.0; 2], |[sum, moment], [force, own]| [sum + force, moment + own])
    };
    if outline.is_empty() {
        let [low, high] = ends(axis);
        let [normal, moment] = pressed(axis, middle([low, high]));
        return ratio(normal, normal * 0.5 * (high - low), moment.abs());
    }
    let center = [0, 1].map(|axis| middle(ends(axis)));
    let [[normal, along], [_, across]] = [0, 1].map(|axis| pressed(axis, center[axis]));
    let faces = |edge: &Edge| edge.normal[axis].abs() >= ALIKE * edge.normal[1 - axis].abs();
    let factor = |edge: Edge| {
        let moment = edge.outward([along, across]);
        ratio(normal, normal * edge.reach(center), moment.max(0.0))
    };
    Edge::all(outline).filter(faces).map(factor).reduce(f64::min).unwrap_or(f64::INFINITY)
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

    const BASE: [ContactElement; 2] =
        [ContactElement { left: -1.0, right: 1.0 }, ContactElement { left: 1.0, right: 2.0 }];

    fn on(contact: &[ContactState; 2]) -> Footing<'_> {
        Footing {
            elements: &BASE,
            depths: &[[0.0, 1.0]; 2],
            areas: &[2.0, 1.0],
            contact,
            outline: &[],
        }
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
        let state = contact([30.0, 10.0], [-10.0, 6.0]);
        assert!((against_sliding(&[0.4], on(&state)) - 0.4 * 70.0 / 14.0).abs() < 1e-14);
        let each = against_sliding(&[0.5, 0.1], on(&state));
        assert!((each - 31.0 / 14.0).abs() < 1e-14);
        assert!((against_overturning(on(&state), 0) - 70.0 * 1.5 / 20.0).abs() < 1e-14);
    }

    /// In plan, elements 3 m and 1 m deep: N = 180 + 10 = 190, H = −54 and 40, moments about the middle (0.5, 1.5)
    /// along x 180·(−0.5) + 10·1, along y 180·0 + 10·(−1).
    #[test]
    fn by_hand_in_plan() {
        let mut state = contact([30.0, 10.0], [-10.0, 6.0]);
        [state[0].shear_across, state[1].shear_across] = [5.0, 10.0];
        let depths = [[0.0, 3.0], [0.0, 1.0]];
        let outline = [[-1.0, 0.0], [2.0, 0.0], [2.0, 3.0], [-1.0, 3.0]];
        let footing =
            Footing { depths: &depths, areas: &[6.0, 1.0], outline: &outline, ..on(&state) };
        let expected = 0.4 * 190.0 / 54.0_f64.hypot(40.0);
        assert!((against_sliding(&[0.4], footing) - expected).abs() < 1e-14);
        assert!((against_overturning(footing, 0) - 190.0 * 1.5 / 80.0).abs() < 1e-13);
        assert!((against_overturning(footing, 1) - 190.0 * 1.5 / 10.0).abs() < 1e-13);
        let one = contact([0.0, 10.0], [0.0; 2]);
        let footing = Footing { contact: &one, ..footing };
        assert!((against_overturning(footing, 0) - 1.5).abs() < 1e-14);
        assert!((against_overturning(footing, 1) - 1.5).abs() < 1e-14);
        // A diamond about the same middle, whose edges face both ways: (e · n)/h = 2/1.5.
        let diamond = [[-1.0, 1.5], [0.5, 0.0], [2.0, 1.5], [0.5, 3.0]];
        let footing = Footing { outline: &diamond, ..footing };
        for axis in 0..2 {
            assert!((against_overturning(footing, axis) - 0.75).abs() < 1e-14);
        }
        assert_eq!(against_overturning(on(&one), 1), f64::INFINITY);
    }

    #[test]
    fn limits() {
        let (flight, pressed) = (contact([0.0; 2], [0.0; 2]), contact([1.0; 2], [0.0; 2]));
        for friction in [0.0, 0.4, f64::INFINITY] {
            assert!(against_sliding(&[friction], on(&flight)).is_nan());
        }
        assert!(against_overturning(on(&flight), 0).is_nan());
        assert_eq!(against_sliding(&[0.4], on(&pressed)), f64::INFINITY);
        assert_eq!(against_sliding(&[0.0], on(&pressed)), 0.0);
        let sheared = contact([1.0, 0.0], [0.3, 0.0]);
        assert_eq!(against_sliding(&[f64::INFINITY], on(&sheared)), f64::INFINITY);
        // Resultant at the middle: 2 p₀ (−½) + p₁ (1) = 0.
        assert_eq!(against_overturning(on(&pressed), 0), f64::INFINITY);
        // Pulled up on the whole: nothing resists.
        assert_eq!(against_overturning(on(&contact([-1.0; 2], [0.0; 2])), 0), 0.0);
    }
}
