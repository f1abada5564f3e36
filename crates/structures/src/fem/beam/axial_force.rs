//! Axial force of a beam, for its P–Δ effect.

/// Axial compression of a beam in the static state.
///
/// It varies linearly along the beam because of the beam's weight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct AxialForce {
    /// Mean over the length, N (negative for tension).
    pub(super) compression: f64,
    /// Excess of the first end over the second end, N.
    pub(super) taper: f64,
    /// Whether the user prescribed the force; a static state then does not change it.
    pub(super) is_prescribed: bool,
}

impl AxialForce {
    /// Constant force from the user, N.
    pub(super) fn prescribed(compression: f64) -> Self {
        Self { compression, taper: 0.0, is_prescribed: true }
    }

    /// Whether there is no P–Δ effect.
    pub(super) fn is_zero(&self) -> bool {
        self.compression == 0.0 && self.taper == 0.0
    }

    /// Compression at s = x/L, N.
    pub(super) fn at(&self, s: f64) -> f64 {
        self.compression + self.taper * (0.5 - s)
    }
}
