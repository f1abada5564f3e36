//! Response spectra.

use plotters::prelude::*;

use super::axes::{COLORS, DESCRIPTION, LABEL, TITLE, drawable};
use super::key::{Sample, draw_key};
use super::svg::{Svg, picture};
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
    let vertical = super::axes::label(&(0.0..top));
    let color = |k: usize| COLORS[k % COLORS.len()];
    let key: Vec<_> = (0..spectra.len()).map(|k| (spectra[k].0, Sample::Line(color(k)))).collect();
    picture(|area| {
        let area = draw_key(area, &key)?;
        let mut chart = ChartBuilder::on(&area)
            .caption(title, TITLE)
            .margin(14)
            .margin_right(24)
            .x_label_area_size(48)
            .y_label_area_size(88)
            .build_cartesian_2d(periods.log_scale(), 0.0..top)?;
        chart
            .configure_mesh()
            .x_desc("period, s")
            .y_desc("pseudo-acceleration, m/s²")
            .x_label_formatter(&|value| period(*value))
            .y_label_formatter(&vertical)
            .label_style(LABEL)
            .axis_desc_style(DESCRIPTION)
            .light_line_style(WHITE)
            .draw()?;
        for (k, (_, spectrum)) in spectra.iter().enumerate() {
            let points = spectrum.iter().map(|o| (o.period, o.pseudo_acceleration));
            let points = points.filter(|point| drawable(point.1));
            chart.draw_series(LineSeries::new(points, color(k).stroke_width(2)))?;
        }
        Ok(())
    })
}

/// 0.05, 0.1, 2, 10.
fn period(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
