//! The base after a step, as a whole or one foundation of it, and over a run: distance slid and slip events, uplift,
//! extremes of its elements.

use std::ops::Range;

use super::Extremes;
use super::peak::resultant;
use crate::bem::ContactElement;
use crate::coupled::foundation::Derived;
use crate::coupled::{Foundation, Peak, State, Warning};
use crate::geometry::{Patch, far_ends};
use crate::interface::{ContactState, Mode};

/// The base as a whole, or the foundation of this number.
#[derive(Clone, Copy)]
pub(super) struct BaseView<'a> {
    pub(super) state: &'a State,
    pub(super) foundation: Option<usize>,
}

impl<'a> BaseView<'a> {
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

    /// The least factor of safety of its foundations; NaN where none is known.
    pub(super) fn least(&self, factor: fn(&Derived) -> f64) -> f64 {
        let all = || self.state.foundations.iter().map(|own| factor(&own.derived));
        self.own().map_or_else(|| all().fold(f64::NAN, f64::min), |own| factor(&own.derived))
    }
}

/// Area of the open elements of a base.
pub(super) fn open_area(base: &BaseView<'_>) -> f64 {
    let open = base.areas().iter().zip(base.modes()).filter(|(_, mode)| !mode.is_closed());
    // An empty sum would be a negative zero.
    open.fold(0.0, |sum, (area, _)| sum + area)
}

/// A stretch of steps in which a whole base slid one way: some elements are closed, all closed
/// ones slide, and the mean slip does not turn round.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct SlipEvent {
    /// Beginning of its first step, s.
    pub start: f64,
    /// End of its last step, s.
    pub end: f64,
    /// Change of the mean slip, m; positive to the right.
    pub slip: f64,
    /// In plan: slip along y, m; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slip_across: f64,
}

impl SlipEvent {
    /// Distance that the base slipped, m.
    pub(crate) fn size(&self) -> f64 {
        resultant(self.slip, self.slip_across).abs()
    }
}

/// Sliding of a base in a run, by its mean slip: of one foundation, or of all as one base.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Sliding {
    /// Way slid, m: the sum of the events' |slip|.
    pub path: f64,
    /// Time in which the whole base slid, s.
    pub duration: f64,
    /// Events, in order.
    pub events: Vec<SlipEvent>,
    in_event: bool,
}

impl Sliding {
    /// Sliding before the first step, with memory for this many events.
    pub(super) fn with_capacity(events: usize) -> Self {
        Self { events: Vec::with_capacity(events), ..Self::default() }
    }

    /// A step between two `times` that ended in these `modes` of the base's elements, and changed
    /// the mean slip by `slip`, along x and y.
    pub(super) fn see(&mut self, modes: &[Mode], slip: [f64; 2], times: [f64; 2]) {
        let slides = modes.iter().any(|mode| mode.is_slip())
            && modes.iter().all(|mode| mode.is_slip() || !mode.is_closed());
        self.advance(slides, slip, times);
    }

    /// The mean slip changed by `slip` from the first to the second of `times`.
    fn advance(&mut self, slides: bool, [slip, slip_across]: [f64; 2], times: [f64; 2]) {
        if slides {
            self.path += resultant(slip, slip_across).abs();
            self.duration += times[1] - times[0];
            match self.events.last_mut() {
                Some(event)
                    if self.in_event
                        && event.slip * slip + event.slip_across * slip_across >= 0.0 =>
                {
                    event.slip += slip;
                    event.slip_across += slip_across;
                    event.end = times[1];
                }
                _ => {
                    let [start, end] = times;
                    self.events.push(SlipEvent { start, end, slip, slip_across });
                }
            }
        }
        self.in_event = slides;
    }

    /// Duration of the longest event, s.
    pub(crate) fn longest(&self) -> f64 {
        self.events.iter().map(|event| event.end - event.start).fold(0.0, f64::max)
    }

    /// The event with the largest |slip|.
    pub(crate) fn largest_event(&self) -> Option<SlipEvent> {
        let larger = |a: &SlipEvent, b: &SlipEvent| a.size().total_cmp(&b.size());
        self.events.iter().copied().max_by(larger)
    }
}

// Extremes of each contact element.

/// Envelopes of one contact element; tractions are means over it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct ElementEnvelope {
    /// The element.
    pub element: ContactElement,
    /// Front and back end of the element along y, m; 0 and 1 in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub depth: [f64; 2],
    /// Pressure at the start, Pa.
    pub static_pressure: f64,
    /// Smallest and largest pressure, Pa.
    pub pressure: Extremes,
    /// Shear traction of largest magnitude, with its sign, Pa.
    pub shear: Peak,
    /// Largest gap, m.
    pub gap: Peak,
    /// Slip of largest magnitude, with its sign, m.
    pub slip: Peak,
    /// Time open, s.
    pub open: f64,
    /// In plan: shear traction along y of largest magnitude, Pa; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub shear_across: Peak,
    /// In plan: slip along y of largest magnitude, m; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slip_across: Peak,
}

/// Warning of the largest tension under a base with static pressures, among elements that cannot open; `None` below the
/// limit.
pub(super) fn tension(
    envelope: &[ElementEnvelope],
    in_plan: bool,
    opens: impl Fn(usize) -> bool,
) -> Option<Warning> {
    let pressures = envelope.iter().map(|element| element.static_pressure);
    let limit = Warning::TENSION_LIMIT * pressures.fold(0.0, f64::max);
    let held = envelope.iter().enumerate().filter(|(e, _)| !opens(*e));
    let least = |own: &ElementEnvelope| own.pressure.lowest.value;
    let (_, own) = held.min_by(|(_, a), (_, b)| least(a).total_cmp(&least(b)))?;
    let (tension, time) = (-least(own), own.pressure.lowest.time);
    let (x, [front, back]) = (own.element.center(), own.depth);
    let y = in_plan.then_some(0.5 * (front + back));
    (limit > 0.0 && tension > limit).then_some(Warning::Tension { tension, x, y, time })
}

/// Envelopes of all elements at the start of a run.
pub(super) fn start(elements: &Patch, state: &State) -> Vec<ElementEnvelope> {
    let envelope = |((element, depth), contact): ((&ContactElement, &[f64; 2]), &ContactState)| {
        let peak = |value| Peak { value, time: state.time };
        ElementEnvelope {
            element: *element,
            depth: *depth,
            static_pressure: contact.pressure,
            pressure: Extremes::of(contact.pressure, state.time),
            shear: peak(contact.shear),
            gap: peak(contact.gap),
            slip: peak(contact.slip),
            open: 0.0,
            shear_across: peak(contact.shear_across),
            slip_across: peak(contact.slip_across),
        }
    };
    elements.iter().zip(elements.depths()).zip(&state.contact).map(envelope).collect()
}

/// Extends the envelopes by a step of length `step`.
pub(super) fn see(envelopes: &mut [ElementEnvelope], state: &State, step: f64) {
    let modes = state.modes.iter();
    for ((envelope, contact), mode) in envelopes.iter_mut().zip(&state.contact).zip(modes) {
        envelope.pressure.see(contact.pressure, state.time);
        envelope.shear.see(contact.shear, state.time);
        envelope.gap.see(contact.gap, state.time);
        envelope.slip.see(contact.slip, state.time);
        envelope.shear_across.see(contact.shear_across, state.time);
        envelope.slip_across.see(contact.slip_across, state.time);
        if !mode.is_closed() {
            envelope.open += step;
        }
    }
}

// For how long the base left the ground.

/// Uplift of a run. A stretch begins with the first step that ends with an open element, and ends
/// with the first one that ends without.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Uplift {
    /// Time with any part uplifted, s.
    pub duration: f64,
    /// Time without any contact at all, s.
    pub flight: f64,
    /// Number of stretches.
    pub count: usize,
    /// Longest stretch, s.
    pub longest: f64,
    current: f64,
}

impl Uplift {
    /// A step that began at `begin`.
    pub(super) fn see(&mut self, uplifted: f64, modes: &[Mode], step: f64) {
        self.advance(uplifted, step, modes.iter().any(|mode| mode.is_closed()));
    }

    /// A step of length `step`, and whether any element is closed at its end.
    fn advance(&mut self, fraction: f64, step: f64, closed: bool) {
        if fraction <= 0.0 {
            self.current = 0.0;
            return;
        }
        if self.current == 0.0 {
            self.count += 1;
        }
        self.duration += step;
        self.current += step;
        self.longest = self.longest.max(self.current);
        if !closed {
            self.flight += step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_end_with_sticking_and_with_turning() {
        let mut sliding = Sliding::default();
        let steps = [
            (false, 0.5),
            (true, 1.0),
            (true, 2.0),
            (true, -4.0),
            (true, -1.0),
            (false, 0.0),
            (true, -3.0),
            (false, 0.1),
        ];
        for (k, (slides, slip)) in steps.into_iter().enumerate() {
            sliding.advance(slides, [slip, 0.0], [k as f64, (k + 1) as f64]);
        }
        let event = |start, end, slip| SlipEvent { start, end, slip, slip_across: 0.0 };
        let known = [event(1.0, 3.0, 3.0), event(3.0, 5.0, -5.0), event(6.0, 7.0, -3.0)];
        assert_eq!(sliding.events, known);
        assert_eq!((sliding.path, sliding.duration), (11.0, 5.0));
        assert_eq!(sliding.largest_event(), Some(known[1]));
        assert_eq!(Sliding::default().largest_event(), None);
        // In plan: 3 to the right and 4 away, then back at an angle of more than a right one.
        let mut sliding = Sliding::default();
        for (k, slip) in [[3.0, 4.0], [-4.0, 3.0], [-0.1, -6.0]].into_iter().enumerate() {
            sliding.advance(true, slip, [k as f64, (k + 1) as f64]);
        }
        assert_eq!(sliding.events.len(), 2);
        assert_eq!((sliding.events[0].slip, sliding.events[0].slip_across), (-1.0, 7.0));
        assert_eq!(sliding.path, 10.0 + 0.1_f64.hypot(6.0));
    }
}

#[cfg(test)]
mod uplift_tests {
    use super::*;

    #[test]
    fn by_hand() {
        let mut uplift = Uplift::default();
        for fraction in [0.0, 0.2, 0.5, 0.0, 1.0, 1.0, 0.3, 0.0] {
            uplift.advance(fraction, 0.1, fraction < 1.0);
        }
        assert_eq!(uplift.count, 2);
        for (found, known) in [(uplift.duration, 0.5), (uplift.flight, 0.2), (uplift.longest, 0.3)]
        {
            assert!((found - known).abs() < 1e-15);
        }
    }
}
