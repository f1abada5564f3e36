//! Response spectra.

use plotters::prelude::*;

use super::axes::{COLORS, drawable};
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
    picture(|area| {
        let mut chart = ChartBuilder::on(area)
            .caption(title, ("sans-serif", 22))
            .margin(14)
            .margin_right(30)
            .x_label_area_size(48)
            .y_label_area_size(88)
            .build_cartesian_2d(periods.log_scale(), 0.0..top)?;
        chart
            .configure_mesh()
            .x_desc("period, s")
            .y_desc("pseudo-acceleration, m/s²")
            .x_label_formatter(&|value| period(*value))
            .y_label_formatter(&vertical)
            .label_style(("sans-serif", 15))
            .axis_desc_style(("sans-serif", 17))
            .light_line_style(WHITE)
            .draw()?;
        for (k, (name, spectrum)) in spectra.iter().enumerate() {
            let style = COLORS[k % COLORS.len()].stroke_width(2);
            let points = spectrum.iter().map(|o| (o.period, o.pseudo_acceleration));
            let points = points.filter(|point| drawable(point.1));
            chart.draw_series(LineSeries::new(points, style))?.label(*name).legend(
                move |(x, y)| PathElement::new(vec![(x, y), (x + 22, y)], style.stroke_width(3)),
            );
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 15))
            .draw()?;
        Ok(())
    })
}

/// 0.05, 0.1, 2, 10.
fn period(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
