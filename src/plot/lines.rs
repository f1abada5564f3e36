//! Histories over time.

use plotters::prelude::*;

use super::axes::{COLORS, chart, draw_curve, range_of};
use super::key::{Sample, draw_key};
use super::svg::{Svg, picture};
use crate::error::{Error, Result};
use crate::results::unit::printed;
use crate::results::{Histories, Quantity};

/// Stretches of a curve that are drawn by their extremes: more than pixels help nobody.
const BUCKETS: usize = 1500;
/// Factors of safety above this are not shown.
const MOST_SAFETY: f64 = 5.0;

/// A named curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name, for the legend.
    pub name: String,
    /// Its points; where one is not finite the curve is broken.
    pub points: Vec<(f64, f64)>,
}

/// Curves in one chart, with the descriptions of the axes, units included.
///
/// # Errors
/// [`Error::Size`] without a point.
pub fn curves(title: &str, x: &str, y: &str, curves: &[Curve]) -> Result<Svg> {
    let all = || curves.iter().flat_map(|curve| &curve.points);
    if all().next().is_none() {
        return Err(Error::Size { quantity: "points of a chart", found: 0, needed: 1 });
    }
    let x_range = range_of(all().map(|point| point.0));
    let y_range = range_of(all().map(|point| point.1));
    // Time needs no margin.
    let inner = (x_range.end - x_range.start) * 0.06 / 1.12;
    let x_range = x_range.start + inner..x_range.end - inner;
    let color = |k: usize| COLORS[k % COLORS.len()];
    let key: Vec<_> =
        (0..curves.len()).map(|k| (curves[k].name.as_str(), Sample::Line(color(k)))).collect();
    picture(|area| {
        let area = draw_key(area, &key)?;
        let mut chart = chart(&area, title, (x_range, x), (y_range, y), true)?;
        for (k, curve) in curves.iter().enumerate() {
            draw_curve(&mut chart, &thinned(&curve.points), color(k).stroke_width(2))?;
        }
        Ok(())
    })
}

/// One quantity of one or more runs over time, in kN, mm, mrad or per cent.
///
/// # Errors
/// As for [`curves`].
pub fn history(title: &str, runs: &[(&str, &Histories)], quantity: Quantity) -> Result<Svg> {
    let (factor, unit) = engineering_unit(quantity);
    let limited = matches!(quantity, Quantity::SlidingSafety | Quantity::OverturningSafety);
    let value = |&value: &f64| {
        if limited && value > MOST_SAFETY { f64::NAN } else { factor * value }
    };
    let curve = |&(name, histories): &(&str, &Histories)| Curve {
        name: name.to_owned(),
        points: histories
            .times()
            .iter()
            .copied()
            .zip(histories.series(quantity).iter().map(value))
            .collect(),
    };
    let list: Vec<Curve> = runs.iter().map(curve).collect();
    curves(title, "time, s", &with_unit(quantity.name(), unit), &list)
}

/// A probe of one or more runs over time, in its unit, or the one that engineers read for it (see
/// [`Probe::in_unit`](crate::coupled::Probe::in_unit)).
///
/// # Errors
/// [`Error::Name`] if a run has no such probe, [`Error::Scene`] if the runs have it in different
/// units, and as for [`curves`].
pub fn probe_history(title: &str, runs: &[(&str, &Histories)], probe: &str) -> Result<Svg> {
    let mut units = Vec::with_capacity(runs.len());
    for (_, histories) in runs {
        units.push(&histories.probes()[histories.probe_index(probe)?].unit[..]);
    }
    if units.windows(2).any(|pair| pair[0] != pair[1]) {
        return Err(Error::Scene { quantity: "unit of a probe", needed: "the same in all runs" });
    }
    let (factor, unit) = printed(units.first().copied().unwrap_or_default());
    let curve = |&(name, histories): &(&str, &Histories)| {
        let values = histories.probe(probe)?.iter().map(|value| factor * value);
        let points = histories.times().iter().copied().zip(values).collect();
        Ok(Curve { name: name.to_owned(), points })
    };
    let list = runs.iter().map(curve).collect::<Result<Vec<Curve>>>()?;
    curves(title, "time, s", &with_unit(probe, unit), &list)
}

/// Description of an axis.
fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name}, {unit}") }
}

/// Factor from SI, and the unit that engineers read.
fn engineering_unit(quantity: Quantity) -> (f64, &'static str) {
    match quantity {
        Quantity::UpliftedFraction => (1e2, "%"),
        other => printed(other.unit()),
    }
}

/// The same curve by the extremes of its stretches, peaks and gaps kept.
pub(super) fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
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
