//! Limits of an element's tractions, for contact in plan.

use crate::error::{Result, finite, not_negative, require};

/// Bounds of the tractions of an element in plan during a step.
///
/// See [`InterfaceLaw::limits`](super::InterfaceLaw::limits).
///
/// | | |
/// |---|---|
/// | pressure p | −`tension` ≤ p ≤ `pressure_cap` |
/// | gap g | `gap_offset` or more where p = −`tension`, less where p is at the cap, else `gap_offset` |
/// | shear traction τ, slip Δs | \|τ\| ≤ R, Δs = 0 or along τ with \|τ\| = R |
/// | R | `friction` · max(p + `attraction`, 0) + `shear_strength` |
///
/// An element with a tension, an attraction or a shear strength loses them in the step in which it opens.
/// Elastic layers are in addition to these limits: see
/// [`InterfaceLaw::compliance`](super::InterfaceLaw::compliance) of the mode stick. The default is
/// frictionless and hard contact.
///
/// ```
/// use basemat::interface::{Coulomb, ContactState, InterfaceLaw, Limits, Mode, PreviousContact};
/// let start = PreviousContact::new(ContactState::default(), Mode::Stick, 0.01);
/// let limits = Coulomb::new(0.4)?.limits(&start)?;
/// assert_eq!(limits, Limits { friction: 0.4, ..Limits::default() });
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Limits {
    /// Friction coefficient; infinite where nothing slides. With 3 or more, a step may have several solutions: see
    /// [`Coulomb::new`](super::Coulomb::new).
    pub friction: f64,
    /// Pressure that is added to p for friction, Pa.
    pub attraction: f64,
    /// Shear strength in addition to friction, Pa.
    pub shear_strength: f64,
    /// Tensile strength, Pa.
    pub tension: f64,
    /// Largest pressure, Pa; infinite if there is no bound.
    pub pressure_cap: f64,
    /// Gap of a closed element, m; −∞ if the element cannot close in this step.
    pub gap_offset: f64,
    /// Whether base and soil neither separate nor slide, for any tractions.
    pub bonded: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            friction: 0.0,
            attraction: 0.0,
            shear_strength: 0.0,
            tension: 0.0,
            pressure_cap: f64::INFINITY,
            gap_offset: 0.0,
            bonded: false,
        }
    }
}

impl Limits {
    /// These limits without friction, attraction and shear strength, as they act in a frictionless gravity stage.
    pub(crate) fn frictionless(self) -> Self {
        Self { friction: 0.0, attraction: 0.0, shear_strength: 0.0, ..self }
    }

    /// Returns these limits, or an error if one is not possible.
    pub(crate) fn checked(self) -> Result<Self> {
        for (quantity, value) in
            [("friction coefficient", self.friction), ("greatest pressure", self.pressure_cap)]
        {
            require(quantity, value, value >= 0.0, "zero or more, or infinite")?;
        }
        not_negative("attraction of the interface", self.attraction)?;
        not_negative("shear strength of the interface", self.shear_strength)?;
        not_negative("tensile strength of the interface", self.tension)?;
        if self.gap_offset != f64::NEG_INFINITY {
            finite("gap of a closed element", self.gap_offset)?;
        }
        Ok(self)
    }
}
