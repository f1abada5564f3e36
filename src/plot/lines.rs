//! Curves over time or period: quantities, energy, spectra.

use super::axes::{Axis, chart, draw_curve, drawable, range_of};
use super::drawing::{Area, Drawing, Stroke};
use super::key::{Key, Sample};
use super::svg::{Sheet, Svg};
use crate::coupled::EnergyBalance;
use crate::error::{Result, at_least, require, require_part};
use crate::motion::SpectralOrdinate;
use crate::results::{Quantity, TimeSeries};
use crate::text::readable_number::{of_body, printed};
use plotters::prelude::*;

/// Largest number of stretches of a curve that are drawn by their extremes, about one per pixel.
const BUCKETS: usize = 1500;
/// Largest demand drawn; larger demands are drawn at this value.
const MOST_DEMAND: f64 = 4.0;
/// Colour of the line at a demand of one.
const LIMIT: RGBColor = RGBColor(120, 120, 120);

/// A named curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name in the legend.
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
    with_limit(title, x, y, curves, None)
}

/// Curves, and a horizontal line at one with the name `limit`.
fn with_limit(title: &str, x: &str, y: &str, curves: &[Curve], limit: Option<&str>) -> Result<Svg> {
    let all = || curves.iter().flat_map(|curve| &curve.points);
    at_least("points of a chart", all().count(), 1)?;
    let x_range = range_of(all().map(|point| point.0));
    let levels = limit.iter().flat_map(|_| [0.0, 1.0]);
    let y_range = range_of(all().map(|point| point.1).chain(levels));
    // Time needs no margin.
    let inner = (x_range.end - x_range.start) * 0.06 / 1.12;
    let x_range = x_range.start + inner..x_range.end - inner;
    let names = curves.iter().enumerate();
    let entries = names.map(|(k, curve)| (curve.name.as_str(), Sample::Line(Stroke::nth(k))));
    let limits = limit.map(|name| (name, Sample::Line(Stroke::plain(LIMIT))));
    Sheet::new(title, Key::new(entries.chain(limits))).picture(|area| {
        let (x, y) = (Axis::linear(x_range.clone(), x), Axis::linear(y_range, y));
        let mut chart = chart(area, &x, &y, true)?;
        if limit.is_some() {
            let ends = [(x_range.start, 1.0), (x_range.end, 1.0)];
            draw_curve(&mut chart, &ends, Stroke::plain(LIMIT), 2)?;
        }
        for (k, curve) in curves.iter().enumerate() {
            draw_curve(&mut chart, &thinned(&curve.points), Stroke::nth(k), 2)?;
        }
        Ok(())
    })
}

/// Chart of one quantity of one or more runs over time, in kN, mm, mrad or per cent.
///
/// Factors of safety are drawn as their inverse, demand over capacity. This curve starts at zero and reaches
/// one at the limit, while the factor itself would leave every chart. On a bonded base the demand can be
/// larger; values above four are drawn at four, and the axis states this.
///
/// # Errors
/// As for [`curves`]; [`Error::Scene`](crate::Error::Scene) for runs in the plane and in plan together, whose units
/// differ.
pub fn time_series(title: &str, runs: &[(&str, &TimeSeries)], quantity: Quantity) -> Result<Svg> {
    let limit = quantity.limit();
    let in_plan = runs.first().is_some_and(|(_, time_series)| time_series.in_plan());
    let (factor, unit) = quantity.printed(in_plan);
    let is_common = runs.iter().all(|(_, own)| quantity.printed(own.in_plan()).1 == unit);
    let needed = "the same in all runs: in the plane it is per metre";
    require_part("unit of a quantity", is_common, needed)?;
    let value = |&value: &f64| match limit {
        // Without a value, in flight or without a friction coefficient, nothing is drawn.
        Some(_) if value.is_nan() => f64::NAN,
        Some(_) => value.recip().min(MOST_DEMAND),
        None => factor * value,
    };
    let points = |time_series: &TimeSeries| -> Vec<(f64, f64)> {
        let values = time_series.series(quantity).iter().map(value);
        time_series.times().iter().copied().zip(values).collect()
    };
    let curve = |&(name, time_series): &(&str, &TimeSeries)| Curve {
        name: name.into(),
        points: points(time_series),
    };
    let list: Vec<Curve> = runs.iter().map(curve).collect();
    let name = quantity.name();
    let cut = list.iter().flat_map(|curve| &curve.points).any(|point| point.1 == MOST_DEMAND);
    let y = match (limit, unit) {
        (Some(_), _) if cut => format!("1 / {name} (larger ones drawn at {MOST_DEMAND})"),
        (Some(_), _) => format!("1 / {name}"),
        (None, unit) => with_unit(name, unit),
    };
    with_limit(title, "time, s", &y, &list, limit)
}

/// Chart of a probe of one or more runs over time, in the probe's or the engineer's unit.
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
    let (factor, unit) = printed(units.first().copied().unwrap_or_default());
    let curve = |&(name, time_series): &(&str, &TimeSeries)| {
        let values = time_series.probe(probe)?.iter().map(|value| factor * value);
        let points = time_series.times().iter().copied().zip(values).collect();
        Ok(Curve { name: name.to_owned(), points })
    };
    let list = runs.iter().map(curve).collect::<Result<Vec<Curve>>>()?;
    curves(title, "time, s", &with_unit(probe, unit), &list)
}

/// Description of an axis.
fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name}, {unit}") }
}

/// Reduces a curve to the extremes of its stretches; peaks and gaps are kept.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= 4 * BUCKETS {
        return points.to_vec();
    }
    let mut kept = Vec::with_capacity(4 * BUCKETS);
    for stretch in points.chunks(points.len().div_ceil(BUCKETS)) {
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let finite = || stretch.iter().filter(|point| point.1.is_finite());
        let ends = [stretch.first(), stretch.last()];
        let extremes = [finite().min_by(by_value), finite().max_by(by_value)];
        let gap = stretch.iter().find(|point| !point.1.is_finite());
        let mut few: Vec<_> =
            ends.into_iter().chain(extremes).chain([gap]).flatten().copied().collect();
        few.sort_by(|a, b| a.0.total_cmp(&b.0));
        few.dedup_by(|a, b| a.0 == b.0);
        kept.extend(few);
    }
    kept
}

/// The terms of the energy balance over time.
///
/// Terms that stay below a thousandth of the largest are left out.
///
/// # Errors
/// The errors of [`curves`].
pub fn energy(title: &str, time_series: &TimeSeries) -> Result<Svg> {
    // The input first, then its parts.
    let terms = |energy_balance: &EnergyBalance| {
        [vec![("input", energy_balance.input)], energy_balance.parts()].concat()
    };
    let rows: Vec<_> = time_series.energy_balances().iter().map(terms).collect();
    let largest = |k: usize| rows.iter().fold(0.0_f64, |m, row| m.max(row[k].1.abs()));
    let names: Vec<_> = rows.first().into_iter().flatten().map(|(name, _)| *name).collect();
    let scale = (0..names.len()).map(largest).fold(0.0, f64::max);
    let shown = (0..names.len()).filter(|k| *k == 0 || largest(*k) > 1e-3 * scale);
    let curve = |k: usize| Curve {
        name: names[k].to_owned(),
        points: time_series
            .times()
            .iter()
            .zip(&rows)
            .map(|(t, row)| (*t, 1e-3 * row[k].1))
            .collect(),
    };
    let y = with_unit("energy", of_body("kJ/m", time_series.in_plan()));
    curves(title, "time, s", &y, &shown.map(curve).collect::<Vec<_>>())
}

/// Periods that can be drawn, s.
const PERIODS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Response spectra: pseudo-acceleration (m/s²) over the period, with a logarithmic period axis.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without an ordinate, [`Error::Input`](crate::Error::Input) for a period
/// outside 10⁻⁶ to 10⁶ s.
pub fn spectra(title: &str, spectra: &[(&str, &[SpectralOrdinate])]) -> Result<Svg> {
    let axes = axes_of_spectra(spectra)?;
    Sheet::new(title, Key::of_curves(spectra.iter().map(|(name, _)| *name)))
        .picture(|area| draw_spectra(area, &axes, spectra))
}

/// Axes that hold the spectra.
pub(super) fn axes_of_spectra(spectra: &[(&str, &[SpectralOrdinate])]) -> Result<[Axis; 2]> {
    let all = || spectra.iter().flat_map(|(_, spectrum)| spectrum.iter());
    let (mut first, mut last, mut top) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    for ordinate in all() {
        let period = ordinate.period;
        require("period of a spectrum", period, PERIODS.contains(&period), "from 1e-6 to 1e6 s")?;
        first = first.min(ordinate.period);
        last = last.max(ordinate.period);
        if drawable(ordinate.pseudo_acceleration) {
            top = top.max(ordinate.pseudo_acceleration);
        }
    }
    at_least("ordinates of a spectrum", all().count(), 1)?;
    // A single period has no width, and a zero spectrum no height.
    let periods = if last > first { first..last } else { 0.5 * first..2.0 * first };
    let top = if top > 1e-60 { 1.08 * top } else { 1.0 };
    let y = Axis::linear(0.0..top, "pseudo-acceleration, m/s²");
    Ok([Axis::logarithmic(periods, "period, s"), y])
}

/// Draws the spectra, with colours in their order.
pub(super) fn draw_spectra(
    area: &Area<'_>,
    [x, y]: &[Axis; 2],
    spectra: &[(&str, &[SpectralOrdinate])],
) -> Drawing<()> {
    let mut chart = chart(area, x, y, true)?;
    for (k, (_, spectrum)) in spectra.iter().enumerate() {
        let points = spectrum.iter().map(|o| (o.period.log10(), o.pseudo_acceleration));
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
        let few = thinned(&points);
        assert!(few.len() < 6 * BUCKETS && few.windows(2).all(|pair| pair[1].0 > pair[0].0));
        for k in [34_567, 54_321] {
            assert!(few.contains(&points[k]));
        }
        assert_eq!(few.iter().filter(|point| point.1.is_nan()).count(), 1);
        assert_eq!(thinned(&points[..100]), points[..100]);
    }
}
