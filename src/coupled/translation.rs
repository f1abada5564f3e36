//! Translation of the ground under a connected part of the structure.

use super::scheme::SchemeCoefficients;

/// Mean translation of the free field under a part, `[right, up]`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Translation {
    /// y at the end of the step, m.
    pub(crate) displacement: [f64; 2],
    /// Δy, m.
    pub(crate) increment: [f64; 2],
    /// Velocity at v*, as the time scheme sees it, so that a structure that translates with the
    /// ground meets no damping force.
    pub(crate) velocity: [f64; 2],
    /// Velocity and acceleration at the end of the step, likewise.
    pub(crate) new_velocity: [f64; 2],
    pub(crate) new_acceleration: [f64; 2],
}

impl Translation {
    /// The next one, which ends at `displacement`.
    pub(crate) fn next(&self, displacement: [f64; 2], c: &SchemeCoefficients) -> Self {
        let increment: [f64; 2] = std::array::from_fn(|k| displacement[k] - self.displacement[k]);
        let stepped = |coefficients| -> [f64; 2] {
            std::array::from_fn(|k| {
                let (v, a) = (self.new_velocity[k], self.new_acceleration[k]);
                SchemeCoefficients::apply(coefficients, increment[k], v, a)
            })
        };
        Self {
            displacement,
            increment,
            velocity: stepped(c.velocity),
            new_velocity: stepped(c.new_velocity),
            new_acceleration: stepped(c.new_acceleration),
        }
    }
}
