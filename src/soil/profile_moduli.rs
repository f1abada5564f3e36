//! Complex shear moduli of a profile at Laplace variables, and the check that they are passive.

use super::SoilProfile;
use crate::error::{Result, SoilError};
use crate::linalg::Complex;

/// Largest |Re(μ/s)|/|μ/s| that counts as zero, because the modulus has rounding errors.
const PASSIVITY_TOLERANCE: f64 = 1e-12;
/// Square of Re(μ/s)/|μ/s| above which a modulus is passive without the exact check.
const MIN_SQUARED_PASSIVITY: f64 = 1e-20;
/// Values of |μ|² |s|² for which no product overflows or loses digits.
const SAFE_SQUARE_RANGE: std::ops::RangeInclusive<f64> = 1e-280..=1e280;

impl SoilProfile {
    /// Overwrites `moduli` with the complex shear moduli μ(s) from the surface down, Pa.
    pub(crate) fn moduli(&self, s: Complex, moduli: &mut Vec<Complex>) -> Result<()> {
        moduli.clear();
        for (index, (soil, damping)) in self.soils().enumerate() {
            let modulus = damping.modulus(s).scale(soil.shear_modulus());
            check_modulus(index, s, modulus)?;
            moduli.push(modulus);
        }
        Ok(())
    }

    /// Overwrites `moduli` with the complex shear moduli μ(s) at each of `s`, Pa.
    ///
    /// All moduli of the first soil come first, then all moduli of the next soil down.
    pub(crate) fn moduli_at(&self, s: &[Complex], moduli: &mut Vec<Complex>) -> Result<()> {
        moduli.clear();
        // Adjacent soils with the same damping law share μ(s)/μ₀.
        let mut modulus_ratios = vec![Complex::default(); s.len()];
        let mut stored_law: Option<Vec<f64>> = None;
        for (index, (soil, damping)) in self.soils().enumerate() {
            let law = damping.identity();
            if law.is_none() || law != stored_law {
                damping.moduli(s, &mut modulus_ratios);
                stored_law = law;
            }
            let first_modulus = moduli.len();
            moduli.extend_from_slice(&modulus_ratios);
            let soil_moduli = &mut moduli[first_modulus..];
            // Where Re(μ/s) is clearly positive and no product overflows, the exact check is not needed.
            let mut are_clearly_passive = true;
            for (modulus, s) in soil_moduli.iter_mut().zip(s) {
                *modulus = modulus.scale(soil.shear_modulus());
                let power = modulus.re * s.re + modulus.im * s.im;
                let squared_product = modulus.squared_modulus() * s.squared_modulus();
                are_clearly_passive &= power > 0.0
                    && power * power > MIN_SQUARED_PASSIVITY * squared_product
                    && SAFE_SQUARE_RANGE.contains(&squared_product);
            }
            if !are_clearly_passive {
                for (modulus, s) in soil_moduli.iter().zip(s) {
                    check_modulus(index, *s, *modulus)?;
                }
            }
        }
        Ok(())
    }
}

/// Returns an error unless a passive soil can have this modulus at `s`.
///
/// `index`: number of the soil, from 0 at the surface.
fn check_modulus(index: usize, s: Complex, modulus: Complex) -> Result<()> {
    let layer = index + 1;
    let is_static = s == Complex::default();
    if !(modulus.is_finite() && modulus.abs() > 0.0) || (is_static && modulus.re <= 0.0) {
        let needed = if is_static { "finite and above zero" } else { "finite and not zero" };
        let quantity = "shear modulus (Pa)";
        let s = [s.re, s.im];
        return Err(SoilError::Modulus { layer, quantity, value: modulus.re, s, needed }.into());
    }
    let modulus_ratio = modulus / s;
    let value = modulus_ratio.re / modulus_ratio.abs();
    // On the imaginary axis Re(μ/s) of an elastic law is zero up to rounding. Its modulus must then be positive.
    let is_passive =
        value >= PASSIVITY_TOLERANCE || (value >= -PASSIVITY_TOLERANCE && modulus.re > 0.0);
    if !(is_static || is_passive) {
        let quantity = "Re(mu/s)/|mu/s|";
        let needed = "not negative: the damping law creates energy";
        return Err(SoilError::Modulus { layer, quantity, value, s: [s.re, s.im], needed }.into());
    }
    Ok(())
}
