//! Extremes of a run and when they occurred; factors of safety against sliding and overturning.
//!
//! Factors of safety are made of the contact tractions that did act. Tractions of a base that may open and slide
//! cannot go beyond its strength: such a factor stays at or above one, and reaches it when the base
//! does slide, or stands on its edge. Below one it falls on a bonded base only, where it says how
//! much the interface would have lacked.

use crate::bem::ContactElement;
use crate::error::{Error, Result};
use crate::interface::ContactState;

/// Σ A φ p over |Σ A τ|, for one friction coefficient or one for each element; NaN without any. An infinite
/// coefficient holds wherever it is pressed on.
pub(super) fn against_sliding(
    friction: &[f64],
    elements: &[ContactElement],
    contact: &[ContactState],
) -> f64 {
    if friction.is_empty() {
        return f64::NAN;
    }
    let (mut resistance, mut normal, mut shear) = (0.0, 0.0, 0.0);
    for (e, (element, state)) in elements.iter().zip(contact).enumerate() {
        let coefficient = friction[if friction.len() == 1 { 0 } else { e }];
        let pressed = element.length() * state.pressure;
        // Infinity times zero is no resistance.
        if pressed != 0.0 && !(coefficient == f64::INFINITY && pressed < 0.0) {
            resistance += coefficient * pressed;
        }
        normal += pressed;
        shear += element.length() * state.shear;
    }
    ratio(normal, resistance, shear.abs())
}

/// N b over the moment of the pressure about the middle of the base, b the half width.
pub(super) fn against_overturning(elements: &[ContactElement], contact: &[ContactState]) -> f64 {
    let (Some(first), Some(last)) = (elements.first(), elements.last()) else {
        return f64::INFINITY;
    };
    let (middle, half) = (0.5 * (first.left + last.right), 0.5 * (last.right - first.left));
    let (mut normal, mut moment) = (0.0, 0.0);
    for (element, state) in elements.iter().zip(contact) {
        let force = element.length() * state.pressure;
        normal += force;
        moment += force * (element.center() - middle);
    }
    ratio(normal, normal * half, moment.abs())
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

    fn base() -> [ContactElement; 2] {
        [ContactElement { left: -1.0, right: 1.0 }, ContactElement { left: 1.0, right: 2.0 }]
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
        assert!((against_sliding(&[0.4], &base(), &state) - 0.4 * 70.0 / 14.0).abs() < 1e-14);
        let each = against_sliding(&[0.5, 0.1], &base(), &state);
        assert!((each - 31.0 / 14.0).abs() < 1e-14);
        assert!((against_overturning(&base(), &state) - 70.0 * 1.5 / 20.0).abs() < 1e-14);
    }

    #[test]
    fn limits() {
        let (flight, pressed) = (contact([0.0; 2], [0.0; 2]), contact([1.0; 2], [0.0; 2]));
        for friction in [0.0, 0.4, f64::INFINITY] {
            assert!(against_sliding(&[friction], &base(), &flight).is_nan());
        }
        assert!(against_overturning(&base(), &flight).is_nan());
        assert_eq!(against_sliding(&[0.4], &base(), &pressed), f64::INFINITY);
        assert_eq!(against_sliding(&[0.0], &base(), &pressed), 0.0);
        let sheared = contact([1.0, 0.0], [0.3, 0.0]);
        assert_eq!(against_sliding(&[f64::INFINITY], &base(), &sheared), f64::INFINITY);
        // Resultant at the middle: 2 p₀ (−½) + p₁ (1) = 0.
        assert_eq!(against_overturning(&base(), &pressed), f64::INFINITY);
        // Pulled up on the whole: nothing resists.
        assert_eq!(against_overturning(&base(), &contact([-1.0; 2], [0.0; 2])), 0.0);
    }
}
