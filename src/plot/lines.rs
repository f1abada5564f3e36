//! Charts of curves over time or period: quantities, energy, spectra.

use super::axes::{ChartAxis, chart, draw_curve};
use super::drawing::{Area, Drawing, RANGE_MARGIN_RATIO, Stroke, is_drawable, range_of};
use super::key::{KeySample, PictureKey};
use super::svg::{PictureLayout, Svg};
use crate::error::{Result, at_least, require, require_part};
use crate::motion::SpectralOrdinate;
use crate::results::{Quantity, TimeSeries};
use crate::text::readable_number::{PrintedUnit, printed_unit, whole_body_unit};
use plotters::prelude::*;

/// Largest number of intervals of a long curve, about one per pixel; each is drawn by its extremes.
const MAX_INTERVALS: usize = 1500;
/// Largest demand drawn; larger demands are drawn at this value.
const MAX_DRAWN_DEMAND: f64 = 4.0;
/// Colour of the line at a demand of one.
const LIMIT_COLOR: RGBColor = RGBColor(120, 120, 120);

/// A named curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name in the key of the picture.
    pub name: String,
    /// Points; the curve is interrupted where a coordinate is not finite.
    pub points: Vec<(f64, f64)>,
}

/// Curves in one chart; `x` and `y` describe the axes, units included.
///
/// The first seven curves differ by colour, further curves also by markers.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without a point.
pub fn curves(title: &str, x: &str, y: &str, curves: &[Curve]) -> Result<Svg> {
    curves_with_limit(title, x, y, curves, None)
}

/// Chart of curves, and of a horizontal line at one with the name `limit`.
fn curves_with_limit(
    title: &str,
    x: &str,
    y: &str,
    curves: &[Curve],
    limit: Option<&str>,
) -> Result<Svg> {
    let points = curves.iter().flat_map(|curve| &curve.points);
    at_least("points of a chart", points.clone().count(), 1)?;
    let x_range = range_of(points.clone().map(|point| point.0));
    let y_levels: &[f64] = if limit.is_some() { &[0.0, 1.0] } else { &[] };
    let y_range = range_of(points.map(|point| point.1).chain(y_levels.iter().copied()));
    // Time needs no margin: its range is that of the values.
    let margin =
        (x_range.end - x_range.start) * RANGE_MARGIN_RATIO / (1.0 + 2.0 * RANGE_MARGIN_RATIO);
    let x_range = x_range.start + margin..x_range.end - margin;
    let mut key = Vec::new();
    for (k, curve) in curves.iter().enumerate() {
        key.push((curve.name.as_str(), KeySample::Line(Stroke::nth(k))));
    }
    if let Some(name) = limit {
        key.push((name, KeySample::Line(Stroke::plain(LIMIT_COLOR))));
    }
    PictureLayout::new(title, PictureKey::new(key)).picture(|area| {
        let x_axis = ChartAxis::linear(x_range.clone(), x);
        let y_axis = ChartAxis::linear(y_range, y);
        let mut chart = chart(area, &x_axis, &y_axis, true)?;
        if limit.is_some() {
            let ends = [(x_range.start, 1.0), (x_range.end, 1.0)];
            draw_curve(&mut chart, &ends, Stroke::plain(LIMIT_COLOR), 2)?;
        }
        for (k, curve) in curves.iter().enumerate() {
            draw_curve(&mut chart, &thinned(&curve.points), Stroke::nth(k), 2)?;
        }
        Ok(())
    })
}

/// Chart of one quantity of one or more runs over time, in kN, mm, mrad or per cent.
///
/// Factors of safety are drawn as their inverse, demand over capacity, because the factors themselves may be infinite. The
/// demand starts at zero and reaches one at the limit. On a bonded base the demand can be larger. Values above four are
/// drawn at four, and the description of the axis states this.
///
/// # Errors
/// As for [`curves`]; [`Error::Scene`](crate::Error::Scene) for runs in the plane and in plan together, whose units
/// differ.
pub fn time_series(title: &str, runs: &[(&str, &TimeSeries)], quantity: Quantity) -> Result<Svg> {
    let limit = quantity.limit_label();
    let in_plan = runs.first().is_some_and(|(_, time_series)| time_series.in_plan());
    let PrintedUnit { factor, symbol: unit } = quantity.printed_unit(in_plan);
    let have_same_unit =
        runs.iter().all(|(_, run)| quantity.printed_unit(run.in_plan()).symbol == unit);
    let needed = "the same in all runs: in the plane it is per metre";
    require_part("unit of a quantity", have_same_unit, needed)?;
    let mut curves = Vec::with_capacity(runs.len());
    for (name, time_series) in runs {
        let mut points = Vec::new();
        for (&time, &value) in time_series.times().iter().zip(time_series.series(quantity)) {
            let is_factor_of_safety = limit.is_some();
            points.push((
                time,
                if is_factor_of_safety { drawn_demand(value) } else { factor * value },
            ));
        }
        curves.push(Curve { name: (*name).to_owned(), points });
    }
    let name = quantity.name();
    let has_cut_values = curves
        .iter()
        .flat_map(|curve| &curve.points)
        .any(|point| point.1 == MAX_DRAWN_DEMAND);
    let y = match (limit, unit) {
        (Some(_), _) if has_cut_values => {
            format!("1 / {name} (larger ones drawn at {MAX_DRAWN_DEMAND})")
        }
        (Some(_), _) => format!("1 / {name}"),
        (None, unit) => with_unit(name, unit),
    };
    curves_with_limit(title, "time, s", &y, &curves, limit)
}

/// Demand over capacity as drawn; NaN if there is no factor of safety.
fn drawn_demand(factor_of_safety: f64) -> f64 {
    if factor_of_safety.is_nan() {
        f64::NAN
    } else {
        factor_of_safety.recip().min(MAX_DRAWN_DEMAND)
    }
}

/// Chart of a probe of one or more runs over time, in the unit in which tables print it.
///
/// See [`Probe::in_unit`](crate::coupled::Probe::in_unit).
///
/// # Errors
/// [`Error::Name`](crate::Error::Name) if a run has no such probe, [`Error::Scene`](crate::Error::Scene) if the runs
/// have it in different units, and as for [`curves`].
pub fn probe_time_series(title: &str, runs: &[(&str, &TimeSeries)], probe: &str) -> Result<Svg> {
    let mut units = Vec::with_capacity(runs.len());
    for (_, time_series) in runs {
        units.push(&time_series.probes()[time_series.probe_index(probe)?].unit[..]);
    }
    let needed = "the same in all runs";
    require_part("unit of a probe", units.windows(2).all(|pair| pair[0] == pair[1]), needed)?;
    let PrintedUnit { factor, symbol: unit } =
        printed_unit(units.first().copied().unwrap_or_default());
    let mut probe_curves = Vec::with_capacity(runs.len());
    for &(name, time_series) in runs {
        let values = time_series.probe(probe)?.iter().map(|value| factor * value);
        let points = time_series.times().iter().copied().zip(values).collect();
        probe_curves.push(Curve { name: name.to_owned(), points });
    }
    curves(title, "time, s", &with_unit(probe, unit), &probe_curves)
}

/// Description of an axis: name and unit of its values.
pub(super) fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name}, {unit}") }
}

/// Points of a curve; a long curve is reduced to the extremes and gaps of its intervals.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= 4 * MAX_INTERVALS {
        return points.to_vec();
    }
    let mut drawn_points = Vec::with_capacity(4 * MAX_INTERVALS);
    for interval in points.chunks(points.len().div_ceil(MAX_INTERVALS)) {
        let finite_points = interval.iter().filter(|point| point.1.is_finite());
        let extremes = [
            interval.first(),
            interval.last(),
            finite_points.clone().min_by(|a, b| a.1.total_cmp(&b.1)),
            finite_points.max_by(|a, b| a.1.total_cmp(&b.1)),
            interval.iter().find(|point| !point.1.is_finite()),
        ];
        let mut interval_points: Vec<_> = extremes.into_iter().flatten().copied().collect();
        interval_points.sort_by(|a, b| a.0.total_cmp(&b.0));
        interval_points.dedup_by(|a, b| a.0 == b.0);
        drawn_points.extend(interval_points);
    }
    drawn_points
}

/// Chart of the terms of the energy balance over time.
///
/// Terms that stay below a thousandth of the largest term are omitted.
///
/// # Errors
/// The errors of [`curves`].
pub fn energy(title: &str, time_series: &TimeSeries) -> Result<Svg> {
    let mut term_curves: Vec<Curve> = Vec::new();
    for (time, balance) in time_series.times().iter().zip(time_series.energy_balances()) {
        let terms = [vec![("input", balance.input)], balance.parts()].concat();
        if term_curves.is_empty() {
            for (name, _) in &terms {
                term_curves.push(Curve { name: (*name).to_owned(), points: Vec::new() });
            }
        }
        for (curve, (_, energy)) in term_curves.iter_mut().zip(terms) {
            curve.points.push((*time, 1e-3 * energy));
        }
    }
    let largest_energy = term_curves.iter().map(largest_value).fold(0.0, f64::max);
    let mut is_input = true;
    term_curves.retain(|curve| {
        let is_shown = is_input || largest_value(curve) > ENERGY_TERM_THRESHOLD * largest_energy;
        is_input = false;
        is_shown
    });
    let y = with_unit("energy", whole_body_unit("kJ/m", time_series.in_plan()));
    curves(title, "time, s", &y, &term_curves)
}

/// Largest magnitude of an omitted term of the energy balance, relative to the largest term.
const ENERGY_TERM_THRESHOLD: f64 = 1e-3;

/// Largest magnitude of a curve.
fn largest_value(curve: &Curve) -> f64 {
    curve.points.iter().fold(0.0_f64, |largest, point| largest.max(point.1.abs()))
}

/// Upper end of the axis of a spectrum, over its largest ordinate.
const SPECTRUM_AXIS_FACTOR: f64 = 1.08;
/// Largest ordinate of a spectrum that is drawn as zero, m/s².
const MIN_DRAWN_ORDINATE: f64 = 1e-60;
/// Periods that can be drawn, s.
const DRAWN_PERIODS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Chart of response spectra: pseudo-acceleration (m/s²) over the period, with a logarithmic period axis.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without an ordinate, [`Error::Input`](crate::Error::Input) for a period
/// outside 10⁻⁶ to 10⁶ s.
pub fn spectra(title: &str, spectra: &[(&str, &[SpectralOrdinate])]) -> Result<Svg> {
    let axes = axes_of_spectra(spectra)?;
    PictureLayout::new(title, PictureKey::of_curves(spectra.iter().map(|(name, _)| *name)))
        .picture(|area| draw_spectra(area, &axes, spectra))
}

/// Axes of period and pseudo-acceleration that contain all spectra.
pub(super) fn axes_of_spectra(spectra: &[(&str, &[SpectralOrdinate])]) -> Result<[ChartAxis; 2]> {
    let ordinates = spectra.iter().flat_map(|(_, spectrum)| spectrum.iter());
    let mut min_period = f64::INFINITY;
    let mut max_period = 0.0_f64;
    let mut max_acceleration = 0.0_f64;
    for ordinate in ordinates.clone() {
        let period = ordinate.period;
        let is_drawn = DRAWN_PERIODS.contains(&period);
        require("period of a spectrum", period, is_drawn, "from 1e-6 to 1e6 s")?;
        min_period = min_period.min(period);
        max_period = max_period.max(period);
        if is_drawable(ordinate.pseudo_acceleration) {
            max_acceleration = max_acceleration.max(ordinate.pseudo_acceleration);
        }
    }
    at_least("ordinates of a spectrum", ordinates.count(), 1)?;
    // A single period has no width, and a zero spectrum no height.
    let periods = if max_period > min_period {
        min_period..max_period
    } else {
        0.5 * min_period..2.0 * min_period
    };
    let axis_end = if max_acceleration > MIN_DRAWN_ORDINATE {
        SPECTRUM_AXIS_FACTOR * max_acceleration
    } else {
        1.0
    };
    let y = ChartAxis::linear(0.0..axis_end, "pseudo-acceleration, m/s²");
    Ok([ChartAxis::logarithmic(periods, "period, s"), y])
}

/// Draws the spectra, with colours in their order.
pub(super) fn draw_spectra(
    area: &Area<'_>,
    [x, y]: &[ChartAxis; 2],
    spectra: &[(&str, &[SpectralOrdinate])],
) -> Drawing<()> {
    let mut chart = chart(area, x, y, true)?;
    for (k, (_, spectrum)) in spectra.iter().enumerate() {
        let points = spectrum
            .iter()
            .map(|ordinate| (ordinate.period.log10(), ordinate.pseudo_acceleration));
        draw_curve(&mut chart, &points.collect::<Vec<_>>(), Stroke::nth(k), 2)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_peaks_and_gaps() {
        let mut points: Vec<(f64, f64)> =
            (0..100_000).map(|k| (f64::from(k), f64::from(k).sin())).collect();
        points[34_567].1 = 7.0;
        points[54_321].1 = -9.0;
        points[70_001].1 = f64::NAN;
        let drawn_points = thinned(&points);
        assert!(drawn_points.len() < 6 * MAX_INTERVALS);
        assert!(drawn_points.windows(2).all(|pair| pair[1].0 > pair[0].0));
        for k in [34_567, 54_321] {
            assert!(drawn_points.contains(&points[k]));
        }
        assert_eq!(drawn_points.iter().filter(|point| point.1.is_nan()).count(), 1);
        assert_eq!(thinned(&points[..100]), points[..100]);
    }
}
