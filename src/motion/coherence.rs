//! Coherence of the ground motion at two points.

use crate::error::{Result, not_negative, positive};

/// Coherence between the ground motions at two points; implement this trait for your model.
///
/// The coherence Γ is the correlation of the Fourier coefficients of both motions at a frequency, without the delay of a wave
/// that passes. It is 1 if both points move together and 0 if their motions are independent. The functions for closures
/// are [`CoherenceFn::new`] and [`CoherenceFn::of_separation`].
pub trait Coherence: Send + Sync {
    /// Coherence of the motions at two points `[x, y]` (m) at a `frequency` (Hz).
    ///
    /// From −1 to 1; 1 if the points are equal or the frequency is zero. It does not change if the points are exchanged.
    fn between(&self, frequency: f64, first: [f64; 2], second: [f64; 2]) -> f64;

    /// Whether the coherence depends on the vector between both points only. Default: no.
    ///
    /// Cells on a lattice have few different vectors between them, so that the set-up takes less time.
    fn is_homogeneous(&self) -> bool {
        false
    }

    /// Whether the matrix of Γ between any points is positive semi-definite. Default: no.
    ///
    /// If not, the smallest eigenvalue of each matrix is computed and checked.
    fn is_semi_definite(&self) -> bool {
        false
    }

    /// Largest distance (m) between two points for which the model is valid. Default: infinite.
    fn max_distance(&self) -> f64 {
        f64::INFINITY
    }
}

/// Function of frequency and two points.
type PointFunction = Box<dyn Fn(f64, [f64; 2], [f64; 2]) -> f64 + Send + Sync>;

/// Coherence from a closure.
///
/// ```
/// use basemat::motion::{Coherence, CoherenceFn};
/// // Coherence that decays with frequency and distance.
/// let decay = CoherenceFn::of_separation(|frequency, [x, y]| (-2e-3 * frequency * x.hypot(y)).exp());
/// assert!((decay.between(10.0, [0.0, 0.0], [30.0, 40.0]) - (-1.0_f64).exp()).abs() < 1e-15);
/// ```
pub struct CoherenceFn {
    function: PointFunction,
    is_homogeneous: bool,
}

short_debug! { CoherenceFn; self; is_homogeneous: self.is_homogeneous }

impl CoherenceFn {
    /// Coherence from a function of frequency (Hz) and two points (m).
    pub fn new(function: impl Fn(f64, [f64; 2], [f64; 2]) -> f64 + Send + Sync + 'static) -> Self {
        Self { function: Box::new(function), is_homogeneous: false }
    }

    /// Coherence from a function of frequency (Hz) and the vector between two points (m).
    ///
    /// The function has the same value for the opposite vector.
    pub fn of_separation(function: impl Fn(f64, [f64; 2]) -> f64 + Send + Sync + 'static) -> Self {
        let of_points = move |frequency, first: [f64; 2], second: [f64; 2]| {
            function(frequency, separation(first, second))
        };
        Self { function: Box::new(of_points), is_homogeneous: true }
    }
}

impl Coherence for CoherenceFn {
    fn between(&self, frequency: f64, first: [f64; 2], second: [f64; 2]) -> f64 {
        (self.function)(frequency, first, second)
    }

    fn is_homogeneous(&self) -> bool {
        self.is_homogeneous
    }
}

/// Vector from one point to another, m.
fn separation(first: [f64; 2], second: [f64; 2]) -> [f64; 2] {
    [second[0] - first[0], second[1] - first[1]]
}

/// Distance between two points, m.
fn distance(first: [f64; 2], second: [f64; 2]) -> f64 {
    let [x, y] = separation(first, second);
    x.hypot(y)
}

/// Coherence of Luco and Wong: Γ = exp(−(α ω d/c)²).
///
/// d is the distance of two points, c the speed of shear waves in the soil, α a number without dimension (Luco and Wong,
/// "Response of a rigid foundation to a spatially random ground motion", Earthquake Eng. Struct. Dyn. 14 (1986), 891–908).
///
/// ```
/// use basemat::motion::{Coherence, LucoWong};
/// let coherence = LucoWong::new(0.25, 300.0)?;
/// // α ω d/c = 0.25 · 2π · 6 Hz · 40 m / 300 m/s
/// assert!((coherence.between(6.0, [0.0, 0.0], [0.0, 40.0]) - 0.20615).abs() < 1e-5);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LucoWong {
    /// α/c, s/m.
    slowness: f64,
}

impl LucoWong {
    /// Coherence of the parameter α, on soil of this `shear_wave_speed` (m/s).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless α is finite and not negative, and the speed positive.
    pub fn new(alpha: f64, shear_wave_speed: f64) -> Result<Self> {
        not_negative("parameter of the coherence", alpha)?;
        positive("speed of shear waves", shear_wave_speed)?;
        Ok(Self { slowness: alpha / shear_wave_speed })
    }
}

impl Coherence for LucoWong {
    fn between(&self, frequency: f64, first: [f64; 2], second: [f64; 2]) -> f64 {
        let angular_frequency = std::f64::consts::TAU * frequency;
        (-(self.slowness * angular_frequency * distance(first, second)).powi(2)).exp()
    }

    fn is_homogeneous(&self) -> bool {
        true
    }

    /// Γ is the Fourier transform of a positive function.
    fn is_semi_definite(&self) -> bool {
        true
    }
}

/// Plane-wave coherence of Abrahamson (2007), from dense arrays of seismometers.
///
/// ```text
/// Γ = (1 + (f tanh(0.4 d)/f_c)^n₁)^−½ · (1 + (f tanh(0.4 d)/a₂)^n₂)^−½
/// ```
///
/// f is the frequency in Hz and d the distance in m, at most 150 m; f_c, n₁, n₂ and a₂ depend on site, direction and d
/// (N. A. Abrahamson, "Effects of spatial incoherence on seismic ground motions", EPRI 1015110, 2007, equations 6-1 and
/// 7-1, tables 6-1, 6-2, 7-1 and 7-2). Matrices of this coherence can have negative eigenvalues:
/// [`Incoherence::clipped`](super::Incoherence::clipped) removes them.
///
/// ```
/// use basemat::motion::{AbrahamsonCoherence, Coherence};
/// // Figure 6-2 of the report at 10 m and 20 Hz: 0.675.
/// let rock = AbrahamsonCoherence::HardRockVertical;
/// assert!((rock.between(20.0, [0.0, 0.0], [10.0, 0.0]) - 0.6758).abs() < 1e-4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum AbrahamsonCoherence {
    /// Horizontal motion on hard rock.
    HardRockHorizontal,
    /// Vertical motion on hard rock.
    HardRockVertical,
    /// Horizontal motion on soil with shear waves of 180 to 290 m/s, from frequencies up to 20 Hz.
    SoilHorizontal,
    /// Vertical motion on such soil.
    SoilVertical,
}

/// Factor of the distance in the argument of the hyperbolic tangent, 1/m.
const SATURATION_RATE: f64 = 0.4;
/// Largest distance of Abrahamson's models, m.
const MAX_ABRAHAMSON_DISTANCE: f64 = 150.0;

/// Coefficients of Abrahamson's coherence at one distance.
struct AbrahamsonCoefficients {
    /// f_c, Hz.
    first_frequency: f64,
    /// n₁.
    first_exponent: f64,
    /// a₂, Hz.
    second_frequency: f64,
    /// n₂.
    second_exponent: f64,
}

impl AbrahamsonCoherence {
    /// Coefficients at a `distance` (m).
    fn coefficients(self, distance: f64) -> AbrahamsonCoefficients {
        let log_distance = (distance + 1.0).ln();
        let squared_shift = (log_distance - 3.6).powi(2);
        match self {
            Self::HardRockHorizontal => AbrahamsonCoefficients {
                first_frequency: 27.9 - 4.82 * log_distance + 1.24 * squared_shift,
                first_exponent: 3.80 - 0.040 * log_distance + 0.0105 * squared_shift,
                second_frequency: 40.0,
                second_exponent: 16.4,
            },
            Self::HardRockVertical => AbrahamsonCoefficients {
                first_frequency: 29.2 - 5.20 * log_distance + 1.45 * squared_shift,
                first_exponent: 2.03 + 0.41 * log_distance - 0.078 * squared_shift,
                second_frequency: 200.0,
                second_exponent: 10.0,
            },
            Self::SoilHorizontal => AbrahamsonCoefficients {
                first_frequency: 14.3 - 2.35 * log_distance,
                first_exponent: 3.0,
                second_frequency: 15.8 - 0.044 * distance,
                second_exponent: 15.0,
            },
            Self::SoilVertical => AbrahamsonCoefficients {
                first_frequency: (2.25 - 0.021 * distance).exp(),
                first_exponent: 1.3,
                second_frequency: 100.0,
                second_exponent: 3.0,
            },
        }
    }
}

impl Coherence for AbrahamsonCoherence {
    fn between(&self, frequency: f64, first: [f64; 2], second: [f64; 2]) -> f64 {
        let distance = distance(first, second);
        let coefficients = self.coefficients(distance);
        let saturated_frequency = frequency * (SATURATION_RATE * distance).tanh();
        let first_ratio = saturated_frequency / coefficients.first_frequency;
        let second_ratio = saturated_frequency / coefficients.second_frequency;
        let first_factor = 1.0 + first_ratio.powf(coefficients.first_exponent);
        let second_factor = 1.0 + second_ratio.powf(coefficients.second_exponent);
        1.0 / (first_factor * second_factor).sqrt()
    }

    fn is_homogeneous(&self) -> bool {
        true
    }

    fn max_distance(&self) -> f64 {
        MAX_ABRAHAMSON_DISTANCE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of the report's figures 6-1, 6-2, 7-1 and 7-2, read to 0.005 (the last to 0.02).
    #[test]
    fn abrahamson_coherence_agrees_with_the_figures() {
        use AbrahamsonCoherence::{
            HardRockHorizontal, HardRockVertical, SoilHorizontal, SoilVertical,
        };
        for (model, distance, frequency, figure, tolerance) in [
            (HardRockHorizontal, 10.0, 20.0, 0.637, 0.01),
            (HardRockVertical, 10.0, 20.0, 0.675, 0.01),
            (HardRockVertical, 10.0, 30.0, 0.4545, 0.01),
            (HardRockVertical, 25.0, 30.0, 0.222, 0.01),
            (HardRockVertical, 50.0, 20.0, 0.226, 0.01),
            (SoilHorizontal, 10.0, 10.0, 0.628, 0.01),
            (SoilHorizontal, 10.0, 14.0, 0.391, 0.01),
            (SoilVertical, 10.0, 10.0, 0.644, 0.01),
            (SoilVertical, 150.0, 1.0, 0.49, 0.02),
        ] {
            let coherence = model.between(frequency, [0.0, 3.0], [distance, 3.0]);
            assert!((coherence - figure).abs() < tolerance, "{model:?} {distance} {coherence}");
            assert_eq!(model.between(0.0, [0.0; 2], [distance, 0.0]), 1.0);
            assert_eq!(model.between(frequency, [2.0; 2], [2.0; 2]), 1.0);
        }
    }
}
