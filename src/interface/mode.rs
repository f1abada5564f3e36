//! Contact modes of an element in a step.

/// Contact mode of an element during a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Mode {
    /// Closed, no slip; the only mode of a bonded element.
    Stick,
    /// Closed; the structure slides to the left over the soil.
    SlipLeft,
    /// Closed; the structure slides to the right over the soil.
    SlipRight,
    /// Uplift; hard contact has no traction.
    Open,
    /// Closed, no slip; the soil yields under the pressure ([`Yielding`](super::Yielding)).
    Yield,
    /// Closed; the soil yields under the pressure, and the structure slides to the left.
    YieldLeft,
    /// Closed; the soil yields under the pressure, and the structure slides to the right.
    YieldRight,
    /// Slip in plan: closed; the structure slides along the soil's shear traction.
    Slip,
    /// Slip in plan on soil that yields under the pressure.
    YieldSlip,
    /// Closed, no slip; the soil follows a wall that moves away, at the soil's active pressure
    /// ([`EarthPressure`](super::EarthPressure)).
    Active,
    /// [`Active`](Mode::Active) soil over which the structure slides to the left.
    ActiveLeft,
    /// [`Active`](Mode::Active) soil over which the structure slides to the right.
    ActiveRight,
}

words! { pub Mode, "contact mode", {
    Stick = "stick",
    SlipLeft = "slip_left",
    SlipRight = "slip_right",
    Open = "open",
    Yield = "yield",
    YieldLeft = "yield_left",
    YieldRight = "yield_right",
    Slip = "slip",
    YieldSlip = "yield_slip",
    Active = "active",
    ActiveLeft = "active_left",
    ActiveRight = "active_right",
} }

impl Mode {
    /// Whether the element is closed.
    pub fn is_closed(self) -> bool {
        self != Mode::Open
    }

    /// Whether the element slides.
    pub fn is_slip(self) -> bool {
        matches!(self.elastic(), Mode::SlipLeft | Mode::SlipRight | Mode::Slip)
    }

    /// Whether the soil under the element yields.
    pub(crate) fn is_yield(self) -> bool {
        matches!(self, Mode::Yield | Mode::YieldLeft | Mode::YieldRight | Mode::YieldSlip)
    }

    /// Whether the soil follows the wall at its active pressure.
    pub(crate) fn is_active(self) -> bool {
        matches!(self, Mode::Active | Mode::ActiveLeft | Mode::ActiveRight)
    }

    /// The corresponding mode on soil that does not yield.
    #[must_use]
    pub(crate) fn elastic(self) -> Self {
        match self {
            Mode::Yield | Mode::Active => Mode::Stick,
            Mode::YieldLeft | Mode::ActiveLeft => Mode::SlipLeft,
            Mode::YieldRight | Mode::ActiveRight => Mode::SlipRight,
            Mode::YieldSlip => Mode::Slip,
            mode => mode,
        }
    }

    /// The corresponding mode on soil that yields; an open element stays open.
    #[must_use]
    pub(crate) fn yielding(self) -> Self {
        match self {
            Mode::Stick => Mode::Yield,
            Mode::SlipLeft => Mode::YieldLeft,
            Mode::SlipRight => Mode::YieldRight,
            Mode::Slip => Mode::YieldSlip,
            mode => mode,
        }
    }

    /// The corresponding mode on soil that follows the wall.
    ///
    /// `self` is a mode on soil that does not yield.
    pub(super) fn following(self) -> Self {
        match self {
            Mode::SlipLeft => Mode::ActiveLeft,
            Mode::SlipRight => Mode::ActiveRight,
            _ => Mode::Active,
        }
    }

    /// This mode without slip.
    pub(crate) fn sticking(self) -> Self {
        match self {
            Mode::Open => Mode::Open,
            mode if mode.is_active() => Mode::Active,
            mode if mode.is_yield() => Mode::Yield,
            _ => Mode::Stick,
        }
    }

    /// The corresponding mode on a ground in plan, where slip has any direction.
    pub(crate) fn in_any_direction(self) -> Self {
        match self {
            Mode::SlipLeft | Mode::SlipRight => Mode::Slip,
            Mode::YieldLeft | Mode::YieldRight => Mode::YieldSlip,
            mode => mode,
        }
    }

    /// All modes of a law with limits in the plane.
    pub(super) const WITH_LIMITS: &'static [Self] = &[
        Self::Stick,
        Self::SlipLeft,
        Self::SlipRight,
        Self::Open,
        Self::Yield,
        Self::YieldLeft,
        Self::YieldRight,
    ];

    /// The modes of a law with uplift and this friction coefficient, on soil that yields.
    pub(super) fn with_yield(friction: f64) -> &'static [Self] {
        if friction == 0.0 {
            &[Self::SlipRight, Self::Open, Self::YieldRight]
        } else if friction == f64::INFINITY {
            // In the slip modes of infinite friction the pressure is zero, so the soil does not yield.
            &[Self::Stick, Self::SlipLeft, Self::SlipRight, Self::Open, Self::Yield]
        } else {
            Self::WITH_LIMITS
        }
    }

    /// The modes on soil that yields and follows a wall.
    ///
    /// `friction`: friction coefficient. Elements do not open.
    pub(super) fn with_following(friction: f64) -> &'static [Self] {
        if friction == 0.0 {
            &[Self::SlipRight, Self::ActiveRight, Self::YieldRight]
        } else if friction == f64::INFINITY {
            &[Self::Stick, Self::Active, Self::Yield]
        } else {
            &[
                Self::Stick,
                Self::SlipLeft,
                Self::SlipRight,
                Self::Active,
                Self::ActiveLeft,
                Self::ActiveRight,
                Self::Yield,
                Self::YieldLeft,
                Self::YieldRight,
            ]
        }
    }

    /// The modes of a law with uplift and this friction coefficient.
    pub(super) fn with_friction(friction: f64) -> &'static [Self] {
        if friction == 0.0 {
            // Without friction both slip modes are the same, so one is enough.
            &[Self::SlipRight, Self::Open]
        } else {
            &[Self::Stick, Self::SlipLeft, Self::SlipRight, Self::Open]
        }
    }
}
