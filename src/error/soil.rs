//! Errors of soils.

/// Why waves do not travel through a soil as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SoilError {
    /// A damping law that exists at real frequencies only.
    #[error(
        "{law} damping of layer {layer} is not causal and cannot march in time (use \
         GeneralizedMaxwell::constant_q with the same ratio over the band of the motion)"
    )]
    NotCausal {
        /// Name of the law.
        law: String,
        /// Layer, from 1 at the surface.
        layer: usize,
    },
    /// A damping law with a modulus that no passive soil has: not finite, zero, or with energy given away, where
    /// Re(μ(s)/s) is negative although Re s > 0.
    #[error("{quantity} of layer {layer} is {value:e} at s = {} + {}i 1/s, but must be {needed}", s[0], s[1])]
    Modulus {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Name of the quantity: the modulus, or Re(μ/s)/|μ/s|.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// Real and imaginary part of s, 1/s.
        s: [f64; 2],
        /// Requirement.
        needed: &'static str,
    },
    /// An inclined wave without a first arrival.
    #[error(
        "wave is beyond the critical angle of layer {layer}: its horizontal slowness is {slowness} s/m, \
         but must be below {limit} s/m, that of its fastest waves there, to begin in time (its transfer \
         functions exist)"
    )]
    BeyondCritical {
        /// Layer, from 1 at the surface; the half-plane counts as the last.
        layer: usize,
        /// Horizontal slowness of the wave, absolute, s/m.
        slowness: f64,
        /// Slowness of pressure waves (SH: shear waves) in the layer at the highest frequency of the motion, s/m.
        limit: f64,
    },
}
