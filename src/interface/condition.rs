//! Linear condition on the gap, slip and tractions of an element.

/// Linear condition on an element at the end of a step.
///
/// `gap·g + slip·s + pressure·p + shear·τ = value`, with the coefficients in the fields.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Condition {
    /// Coefficient of the gap.
    pub gap: f64,
    /// Coefficient of the slip.
    pub slip: f64,
    /// Coefficient of the pressure.
    pub pressure: f64,
    /// Coefficient of the shear traction.
    pub shear: f64,
    /// Right-hand side.
    pub value: f64,
}

impl Condition {
    /// Condition that the gap is `value`.
    pub fn gap_is(value: f64) -> Self {
        Self { gap: 1.0, value, ..Self::default() }
    }

    /// Condition that the slip is `value`.
    pub fn slip_is(value: f64) -> Self {
        Self { slip: 1.0, value, ..Self::default() }
    }

    /// Condition that the pressure is `value`.
    pub fn pressure_is(value: f64) -> Self {
        Self { pressure: 1.0, value, ..Self::default() }
    }

    /// Condition that the shear traction is `value`.
    pub fn shear_is(value: f64) -> Self {
        Self { shear: 1.0, value, ..Self::default() }
    }

    /// Sum that is finite only if all coefficients and the right-hand side are.
    pub(crate) fn sum(&self) -> f64 {
        self.gap + self.slip + self.pressure + self.shear + self.value
    }

    /// The first coefficient or right-hand side that is not finite, with its name.
    pub(crate) fn not_finite(&self) -> Option<(&'static str, f64)> {
        let Self { gap, slip, pressure, shear, value } = *self;
        [
            ("coefficient of the gap", gap),
            ("coefficient of the slip", slip),
            ("coefficient of the pressure", pressure),
            ("coefficient of the shear traction", shear),
            ("right-hand side of a condition", value),
        ]
        .into_iter()
        .find(|(_, number)| !number.is_finite())
    }

    /// The gap that this condition prescribes at a pressure.
    ///
    /// `None` if other quantities occur in it.
    pub(crate) fn gap_at(&self, pressure: f64) -> Option<f64> {
        (self.gap != 0.0 && self.slip == 0.0 && self.shear == 0.0)
            .then(|| (self.value - self.pressure * pressure) / self.gap)
    }

    /// The pressure that this condition prescribes; `None` if other quantities occur in it.
    pub(crate) fn pressure_alone(&self) -> Option<f64> {
        let has_other_terms = self.gap != 0.0 || self.slip != 0.0 || self.shear != 0.0;
        (!has_other_terms && self.pressure != 0.0).then(|| self.value / self.pressure)
    }

    /// Component of traction that this condition prescribes: 0 normal, 1 tangential.
    ///
    /// `None` if the condition contains the gap, the slip, or both tractions.
    #[inline]
    pub(crate) fn fixed_component(&self) -> Option<usize> {
        match *self {
            Self { gap, slip, .. } if gap != 0.0 || slip != 0.0 => None,
            Self { pressure, shear: 0.0, .. } if pressure != 0.0 => Some(0),
            Self { pressure: 0.0, shear, .. } if shear != 0.0 => Some(1),
            _ => None,
        }
    }
}
