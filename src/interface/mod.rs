//! Interface laws between the base and the soil.

/// State of one contact element during a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Mode {
    /// Closed, no slip (and the only mode of a bonded element).
    Stick,
    /// Closed; the structure slides to the left over the soil.
    SlipLeft,
    /// Closed; the structure slides to the right over the soil.
    SlipRight,
    /// Uplifted: no traction.
    Open,
}
