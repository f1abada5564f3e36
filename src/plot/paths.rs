//! Charts of paths, such as loops of a moment over a rotation, beside measured points.

use std::ops::Range;

use super::axes::{Chart, ChartAxis, chart, draw_curve};
use super::drawing::{Drawing, Stroke, is_drawable, range_of};
use super::key::{KeySample, PictureKey};
use super::lines::Curve;
use super::svg::{PictureLayout, Svg};
use super::ticks::{Ticks, linear_ticks};
use crate::error::{Result, at_least};
use plotters::prelude::*;

/// Number of points of a path above which close points are omitted.
const MAX_DRAWN_POINTS: usize = 6000;
/// Distance between points of a long path, over the range of the picture: about half a pixel.
const POINT_DISTANCE: f64 = 5e-4;
/// Number of marks of an axis of values that increase downwards.
const DOWNWARD_MARKS: usize = 10;

/// Paths and measured points of y over x, in the units of the picture.
pub(super) struct PathChart {
    /// Each path is a line through its points, in their order.
    pub(super) paths: Vec<Curve>,
    /// Each point is drawn by itself.
    pub(super) measured_points: Vec<Curve>,
    /// Name and unit of x.
    pub(super) x_description: String,
    /// Name and unit of y.
    pub(super) y_description: String,
    /// Whether y is the negative of values that increase downwards.
    pub(super) is_downward: bool,
}

impl PathChart {
    /// Picture of the chart; an error without a point.
    pub(super) fn picture(&self, title: &str) -> Result<Svg> {
        let points = self.paths.iter().chain(&self.measured_points).flat_map(|curve| &curve.points);
        at_least("points of a chart", points.clone().count(), 1)?;
        let x_range = range_of(points.clone().map(|point| point.0));
        let y_range = range_of(points.map(|point| point.1));
        let mut key = Vec::new();
        for (k, curve) in self.paths.iter().enumerate() {
            key.push((curve.name.as_str(), KeySample::Line(Stroke::nth(k))));
        }
        for (k, curve) in self.measured_points.iter().enumerate() {
            key.push((curve.name.as_str(), KeySample::Point(Stroke::points(k))));
        }
        PictureLayout::new(title, PictureKey::new(key)).picture(|area| {
            let x_axis = ChartAxis::linear(x_range.clone(), &self.x_description);
            let y_axis = if self.is_downward {
                downward_axis(&y_range, &self.y_description)
            } else {
                ChartAxis::linear(y_range.clone(), &self.y_description)
            };
            let mut chart = chart(area, &x_axis, &y_axis, true)?;
            for (k, curve) in self.paths.iter().enumerate() {
                let path = thinned_path(&curve.points, [&x_range, &y_range]);
                draw_curve(&mut chart, &path, Stroke::nth(k), 2)?;
            }
            for (k, curve) in self.measured_points.iter().enumerate() {
                draw_points(&mut chart, &curve.points, Stroke::points(k))?;
            }
            Ok(())
        })
    }
}

/// Axis of values that increase downwards; `range` is that of the negatives of the values.
fn downward_axis(range: &Range<f64>, description: &str) -> ChartAxis {
    let Ticks { marks, offset } = linear_ticks(&(-range.end..-range.start), DOWNWARD_MARKS);
    let marks = marks.into_iter().rev().map(|(value, name)| (0.0 - value, name)).collect();
    let description = match offset {
        Some(offset) => format!("{description} (plus {offset})"),
        None => description.to_owned(),
    };
    ChartAxis::marked(range.clone(), marks, &description)
}

/// Draws a marker at each point.
fn draw_points(chart: &mut Chart<'_, '_>, points: &[(f64, f64)], stroke: Stroke) -> Drawing<()> {
    let Some(marker) = stroke.marker else { return Ok(()) };
    let drawable_points =
        points.iter().copied().filter(|(x, y)| is_drawable(*x) && is_drawable(*y));
    let style = stroke.color.filled();
    // Half as large as on a curve: a measurement has hundreds of points.
    let corners: Vec<_> = marker.iter().map(|(x, y)| (x / 2, y / 2)).collect();
    chart.draw_series(
        drawable_points.map(|point| EmptyElement::at(point) + Polygon::new(corners.clone(), style)),
    )?;
    Ok(())
}

/// Points of a path; in a path of many points, points that are close to the previous point are omitted.
fn thinned_path(points: &[(f64, f64)], ranges: [&Range<f64>; 2]) -> Vec<(f64, f64)> {
    if points.len() <= MAX_DRAWN_POINTS {
        return points.to_vec();
    }
    let min_distances = ranges.map(|range| POINT_DISTANCE * (range.end - range.start));
    let mut drawn_points = vec![points[0]];
    for (k, point) in points.iter().enumerate().skip(1) {
        let previous_point = drawn_points[drawn_points.len() - 1];
        // Comparisons with NaN are false, so that a point with NaN remains and interrupts the curve.
        let is_close = (point.0 - previous_point.0).abs() < min_distances[0]
            && (point.1 - previous_point.1).abs() < min_distances[1];
        if !is_close || k + 1 == points.len() {
            drawn_points.push(*point);
        }
    }
    drawn_points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_paths_keep_their_shape() {
        let mut points = Vec::new();
        for k in 0..200_000 {
            let angle = 1e-4 * f64::from(k);
            points.push((angle.cos(), 2.0 * angle.sin()));
        }
        points[70_001].1 = f64::NAN;
        let range = -1.06..1.06;
        let path = thinned_path(&points, [&range, &(-2.12..2.12)]);
        assert!(path.len() > 5000 && path.len() < 60_000, "{}", path.len());
        assert_eq!(path.iter().filter(|point| point.1.is_nan()).count(), 1);
        assert_eq!((path[0], path[path.len() - 1]), (points[0], points[199_999]));
        for pair in path.windows(2).filter(|pair| !(pair[0].1 + pair[1].1).is_nan()) {
            let step = (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
            assert!(step < 5e-3, "{pair:?}");
        }
        assert_eq!(thinned_path(&points[..100], [&range, &range]), points[..100]);
    }

    #[test]
    fn settlement_increases_downwards() {
        let axis = downward_axis(&(-20.0..1.0), "settlement, mm");
        let marks = vec![(-20.0, "20"), (-15.0, "15"), (-10.0, "10"), (-5.0, "5"), (0.0, "0")];
        let marks = marks.into_iter().map(|(value, name)| (value, name.to_owned())).collect();
        assert_eq!(axis, ChartAxis::marked(-20.0..1.0, marks, "settlement, mm"));
    }
}
