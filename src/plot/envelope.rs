//! Pressure envelope under the base.

use plotters::prelude::*;

use super::axes::{COLORS, chart, draw_curve, range_of};
use super::key::{Sample, draw_key};
use super::svg::{Svg, picture};
use crate::error::Result;
use crate::results::{ElementEnvelope, Histories};

/// Value of an element, as drawn.
type Value = fn(&ElementEnvelope) -> f64;

/// Largest, static and least pressure along the base, in steps as the elements have them.
///
/// # Errors
/// Those of drawing, for values beyond all bounds.
pub fn pressure_envelope(title: &str, histories: &Histories) -> Result<Svg> {
    let envelope = histories.envelope();
    let curves: [(&str, Value); 3] = [
        ("largest", |e| 1e-3 * e.pressure.highest.value),
        ("static", |e| 1e-3 * e.static_pressure),
        ("least", |e| 1e-3 * e.pressure.lowest.value),
    ];
    let steps = |value: Value| {
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(3 * envelope.len());
        for e in envelope {
            // A gap between two strips is a gap of the curve.
            if points.last().is_some_and(|last| e.element.left - last.0 > 1e-6 * e.element.length())
            {
                points.push((f64::NAN, f64::NAN));
            }
            points.extend([(e.element.left, value(e)), (e.element.right, value(e))]);
        }
        points
    };
    let (left, right) = (
        envelope.first().map_or(0.0, |e| e.element.left),
        envelope.last().map_or(1.0, |e| e.element.right),
    );
    let values = curves.iter().flat_map(|(_, value)| envelope.iter().map(value));
    let range = range_of(values.chain([0.0]));
    let colors = [COLORS[1], COLORS[5], COLORS[0]];
    let key: Vec<_> =
        curves.iter().zip(colors).map(|((name, _), color)| (*name, Sample::Line(color))).collect();
    picture(|area| {
        let area = draw_key(area, &key)?;
        let y = (range, "pressure, kPa");
        let mut chart = chart(&area, title, (left..right, "x along the base, m"), y, true)?;
        for ((_, value), color) in curves.into_iter().zip(colors) {
            draw_curve(&mut chart, &steps(value), color.stroke_width(2))?;
        }
        Ok(())
    })
}
