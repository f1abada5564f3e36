//! Damping proportional to mass and stiffness.

use std::f64::consts::TAU;

use crate::error::{Result, damping_ratio, not_negative, positive, require};

/// Rayleigh damping C = α M + β K.
///
/// ```
/// use basemat::structure::RayleighDamping;
///
/// let damping = RayleighDamping::from_ratios([1.0, 5.0], [0.05, 0.05])?;
/// assert!((damping.ratio(1.0) - 0.05).abs() < 1e-15);
/// assert!(damping.ratio(2.0) < 0.05);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RayleighDampingForm"))]
pub struct RayleighDamping {
    /// Factor α of the mass, 1/s.
    mass: f64,
    /// Factor β of the stiffness, s.
    stiffness: f64,
}

validated! {
    RayleighDamping as RayleighDampingForm { mass: f64, stiffness: f64 }
    => RayleighDamping::new(mass, stiffness)
}

impl RayleighDamping {
    /// Damping from α (`mass`, 1/s) and β (`stiffness`, s).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are finite and not negative.
    pub fn new(mass: f64, stiffness: f64) -> Result<Self> {
        not_negative("mass-proportional damping", mass)?;
        not_negative("stiffness-proportional damping", stiffness)?;
        Ok(Self { mass, stiffness })
    }

    /// Damping with prescribed damping ratios at two frequencies (Hz).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) when the frequencies are not positive or equal, a ratio is not from 0 to
    /// below 1, or the ratios differ so much that α or β would be negative.
    pub fn from_ratios(frequencies: [f64; 2], ratios: [f64; 2]) -> Result<Self> {
        for (frequency, ratio) in frequencies.into_iter().zip(ratios) {
            positive("frequency of Rayleigh damping", frequency)?;
            damping_ratio("damping ratio", ratio)?;
        }
        let [first_circular, second_circular] = frequencies.map(|frequency| TAU * frequency);
        let squared_difference =
            (second_circular - first_circular) * (second_circular + first_circular);
        let needed = "different from the first";
        require(
            "second frequency of Rayleigh damping",
            frequencies[1],
            squared_difference != 0.0,
            needed,
        )?;
        // Solves ζ = α/(2ω) + βω/2 at both frequencies.
        let mass = 2.0
            * first_circular
            * second_circular
            * (ratios[0] * second_circular - ratios[1] * first_circular)
            / squared_difference;
        let stiffness =
            2.0 * (ratios[1] * second_circular - ratios[0] * first_circular) / squared_difference;
        Self::new(mass, stiffness)
    }

    /// Factor α of the mass, 1/s.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Factor β of the stiffness, s.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Damping ratio ζ = α/(2ω) + βω/2 of a mode of `frequency` (Hz).
    pub fn ratio(&self, frequency: f64) -> f64 {
        let circular_frequency = TAU * frequency;
        0.5 * (self.mass / circular_frequency + self.stiffness * circular_frequency)
    }
}
