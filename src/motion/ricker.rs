//! Ricker pulse of displacement, in closed form.

use super::FreeField;
use crate::error::{Error, Result, finite, positive};

/// Ricker pulse u(t) = A (1 − 2a²) e^(−a²), a = (t − center)/sigma, the same at all points.
///
/// Displacement and velocity are exact. The peak A is at t = `center`; the spectrum peaks at the
/// frequency 1/(π sigma) Hz, as in Ricker, "The form and laws of propagation of seismic
/// wavelets", Geophysics 18 (1953), 10–40. At and before t = 0 the field is zero, so the pulse
/// starts with a jump of A (1 − 2a₀²) e^(−a₀²), a₀ = center/sigma: 7e-10 A for a₀ = 5.
///
/// ```
/// use basemat::motion::{FreeField, RickerDisplacement};
/// let pulse = RickerDisplacement::new(0.1, 0.5, 3.0)?;
/// assert_eq!(pulse.displacement(0.0, 3.0), [0.1, 0.0]);
/// assert_eq!(pulse.velocity(0.0, 3.0), [0.0, 0.0]);
/// // a = 1: u = −A/e, v = −2 A/(e sigma)
/// assert!((pulse.displacement(0.0, 3.5)[0] + 0.1 * (-1.0_f64).exp()).abs() < 1e-16);
/// assert!((pulse.velocity(0.0, 3.5)[0] + 0.4 * (-1.0_f64).exp()).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RickerDisplacement {
    amplitude: [f64; 2],
    sigma: f64,
    center: f64,
}

/// Smallest center/sigma: the jump at t = 0 is 3.5e-6 of the peak there.
const LEAST_DELAY: f64 = 4.0;

impl RickerDisplacement {
    /// Horizontal pulse of peak `amplitude` (m, any sign), width `sigma` (s), peaking at `center`
    /// (s).
    ///
    /// # Errors
    /// [`Error::Input`] unless `amplitude` is finite, `sigma` positive and
    /// `center` at least 4 `sigma`, so that the pulse grows from rest.
    pub fn new(amplitude: f64, sigma: f64, center: f64) -> Result<Self> {
        finite("amplitude of the Ricker pulse", amplitude)?;
        positive("width of the Ricker pulse", sigma)?;
        if !(center.is_finite() && center >= LEAST_DELAY * sigma) {
            return Err(Error::Input {
                quantity: "center of the Ricker pulse",
                value: center,
                needed: "finite and at least four times its width",
            });
        }
        Ok(Self { amplitude: [amplitude, 0.0], sigma, center })
    }

    /// The same pulse, turned into the vertical (positive up).
    #[must_use]
    pub fn vertical(self) -> Self {
        let [horizontal, vertical] = self.amplitude;
        Self { amplitude: [vertical, horizontal], ..self }
    }
}

impl FreeField for RickerDisplacement {
    fn displacement(&self, _x: f64, time: f64) -> [f64; 2] {
        if time <= 0.0 {
            return [0.0; 2];
        }
        let square = ((time - self.center) / self.sigma).powi(2);
        self.amplitude.map(|amplitude| amplitude * (1.0 - 2.0 * square) * (-square).exp())
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        if time <= 0.0 {
            return [0.0; 2];
        }
        let phase = (time - self.center) / self.sigma;
        let square = phase * phase;
        let rate = phase * (4.0 * square - 6.0) * (-square).exp() / self.sigma;
        self.amplitude.map(|amplitude| amplitude * rate)
    }
}
