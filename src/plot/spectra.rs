//! Response spectra.

use super::axes::{Axis, chart, draw_curve, drawable};
use super::key::Key;
use super::stroke::Stroke;
use super::svg::{Sheet, Svg};
use crate::error::{Error, Result};
use crate::motion::SpectralOrdinate;

/// Periods that can be drawn, s.
const PERIODS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Pseudo-acceleration (m/s²) over the period, which is drawn in logarithms.
///
/// # Errors
/// [`Error::Size`] without an ordinate, [`Error::Input`] for a period that is not from 10⁻⁶ to 10⁶ s.
pub fn spectra(title: &str, spectra: &[(&str, &[SpectralOrdinate])]) -> Result<Svg> {
    let all = || spectra.iter().flat_map(|(_, spectrum)| spectrum.iter());
    let (mut first, mut last, mut top) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    for ordinate in all() {
        if !PERIODS.contains(&ordinate.period) {
            let (quantity, needed) = ("period of a spectrum", "from 1e-6 to 1e6 s");
            return Err(Error::Input { quantity, value: ordinate.period, needed });
        }
        first = first.min(ordinate.period);
        last = last.max(ordinate.period);
        if drawable(ordinate.pseudo_acceleration) {
            top = top.max(ordinate.pseudo_acceleration);
        }
    }
    if all().next().is_none() {
        return Err(Error::Size { quantity: "ordinates of a spectrum", found: 0, needed: 1 });
    }
    // A single period has no width, and nothing at all no height.
    let periods = if last > first { first..last } else { 0.5 * first..2.0 * first };
    let top = if top > 1e-60 { 1.08 * top } else { 1.0 };
    Sheet::new(title, Key::of_curves(spectra.iter().map(|(name, _)| *name))).picture(|area| {
        let x = Axis::logarithmic(periods, "period, s");
        let y = Axis::linear(0.0..top, "pseudo-acceleration, m/s²");
        let mut chart = chart(area, &x, &y, true)?;
        for (k, (_, spectrum)) in spectra.iter().enumerate() {
            let points = spectrum.iter().map(|o| (o.period.log10(), o.pseudo_acceleration));
            draw_curve(&mut chart, &points.collect::<Vec<_>>(), Stroke::nth(k), 2)?;
        }
        Ok(())
    })
}
