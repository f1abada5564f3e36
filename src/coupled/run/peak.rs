//! Extremes of a run and when they occurred; factors of safety against sliding and overturning.
//!
//! Factors of safety are made of the contact tractions that did act. Tractions of a base that may open and slide
//! cannot go beyond its strength: such a factor stays at or above one, and reaches it when the base
//! does slide, or stands on its edge. Below one it falls on a bonded base only, where it says how
//! much the interface would have lacked.

use crate::bem::ContactElement;
use crate::error::{Error, Result};
use crate::geometry::far_ends;
use crate::interface::ContactState;

/// Elements of a foundation, with what they carry.
#[derive(Clone, Copy)]
pub(super) struct Footing<'a> {
    pub(super) elements: &'a [ContactElement],
    /// Front and back end of each element, m.
    pub(super) depths: &'a [[f64; 2]],
    /// Area of each element, m²; in the plane its length.
    pub(super) areas: &'a [f64],
    pub(super) contact: &'a [ContactState],
    /// Whether they are of a ground in plan.
    pub(super) is_plan: bool,
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

/// N b over the moment of the pressure about the middle of the base, b the half width; in plan the less of both axes.
pub(super) fn against_overturning(footing: Footing<'_>) -> f64 {
    if footing.elements.is_empty() {
        return f64::INFINITY;
    }
    let axes = if footing.is_plan { 0..2 } else { 0..1 };
    let about = |axis: usize| {
        let ends = (0..footing.elements.len()).map(|e| footing.ends(e, axis));
        let [low, high] = far_ends(ends);
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let (mut normal, mut moment) = (0.0, 0.0);
        for (e, (area, state)) in footing.areas().enumerate() {
            let (force, [low, high]) = (area * state.pressure, footing.ends(e, axis));
            normal += force;
            moment += force * (0.5 * (low + high) - middle);
        }
        ratio(normal, normal * half, moment.abs())
    };
    axes.map(about).reduce(f64::min).unwrap_or(f64::INFINITY)
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

// Largest and smallest values of a run, and when they occurred.

/// A value of largest magnitude, with its sign, and when it occurred.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Peak {
    /// The value, with its sign.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::words::number"))]
    pub value: f64,
    /// When, s.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::words::number"))]
    pub time: f64,
}

impl Peak {
    /// The value without its sign.
    pub(crate) fn magnitude(&self) -> f64 {
        self.value.abs()
    }

    pub(crate) fn see(&mut self, value: f64, time: f64) {
        if value.abs() > self.value.abs() {
            *self = Self { value, time };
        }
    }
}

/// Smallest and largest value, and when they occurred; of equal ones the first. NaN does not count
/// unless there is nothing else.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Extremes {
    /// The smallest value.
    pub lowest: Peak,
    /// The largest value.
    pub highest: Peak,
}

impl Extremes {
    /// Of one value.
    pub(crate) fn of(value: f64, time: f64) -> Self {
        let peak = Peak { value, time };
        Self { lowest: peak, highest: peak }
    }

    pub(crate) fn see(&mut self, value: f64, time: f64) {
        if value < self.lowest.value || self.lowest.value.is_nan() {
            self.lowest = Peak { value, time };
        }
        if value > self.highest.value || self.highest.value.is_nan() {
            self.highest = Peak { value, time };
        }
    }

    /// The one of larger magnitude, with its sign.
    pub fn largest(&self) -> Peak {
        if self.lowest.value.abs() > self.highest.value.abs() { self.lowest } else { self.highest }
    }

    /// Its value without its sign.
    pub fn magnitude(&self) -> f64 {
        self.largest().magnitude()
    }
}

/// Smallest and largest value of a probe.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct ProbeExtremes {
    /// Name of the probe.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The values, and when.
    pub extremes: Extremes,
}

/// Place of the probe called `name` in a list.
pub(crate) fn probe_index<T>(
    list: &[T],
    name: &str,
    name_of: impl Fn(&T) -> &String + Copy,
) -> Result<usize> {
    let unknown = || Error::no_name("probe", name, list.iter().map(name_of));
    list.iter().position(|entry| name_of(entry) == name).ok_or_else(unknown)
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
            is_plan: false,
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
        assert!((against_overturning(on(&state)) - 70.0 * 1.5 / 20.0).abs() < 1e-14);
    }

    /// In plan, elements 3 m and 1 m deep: N = 180 + 10 = 190, H = −54 and 40, middle y 1.5, moments about it
    /// 180·0 + 10·(−1) and along x 180·(−0.5) + 10·1.
    #[test]
    fn by_hand_in_plan() {
        let mut state = contact([30.0, 10.0], [-10.0, 6.0]);
        [state[0].shear_across, state[1].shear_across] = [5.0, 10.0];
        let depths = [[0.0, 3.0], [0.0, 1.0]];
        let in_plan =
            |state| Footing { depths: &depths, areas: &[6.0, 1.0], is_plan: true, ..on(state) };
        let footing = in_plan(&state);
        let expected = 0.4 * 190.0 / 54.0_f64.hypot(40.0);
        assert!((against_sliding(&[0.4], footing) - expected).abs() < 1e-14);
        assert!((against_overturning(footing) - 190.0 * 1.5 / 80.0).abs() < 1e-14);
        let along = contact([0.0, 10.0], [0.0; 2]);
        let footing = Footing { contact: &along, ..footing };
        assert!((against_overturning(footing) - 1.5).abs() < 1e-14);
    }

    #[test]
    fn limits() {
        let (flight, pressed) = (contact([0.0; 2], [0.0; 2]), contact([1.0; 2], [0.0; 2]));
        for friction in [0.0, 0.4, f64::INFINITY] {
            assert!(against_sliding(&[friction], on(&flight)).is_nan());
        }
        assert!(against_overturning(on(&flight)).is_nan());
        assert_eq!(against_sliding(&[0.4], on(&pressed)), f64::INFINITY);
        assert_eq!(against_sliding(&[0.0], on(&pressed)), 0.0);
        let sheared = contact([1.0, 0.0], [0.3, 0.0]);
        assert_eq!(against_sliding(&[f64::INFINITY], on(&sheared)), f64::INFINITY);
        // Resultant at the middle: 2 p₀ (−½) + p₁ (1) = 0.
        assert_eq!(against_overturning(on(&pressed)), f64::INFINITY);
        // Pulled up on the whole: nothing resists.
        assert_eq!(against_overturning(on(&contact([-1.0; 2], [0.0; 2]))), 0.0);
    }
}
