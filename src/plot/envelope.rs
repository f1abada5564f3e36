//! Pressure envelope under the base.

use super::axes::{Axis, chart, draw_curve, range_of};
use super::base::{Base, label_breaks};
use super::key::{Key, Sample};
use super::stroke::{COLORS, Stroke};
use super::svg::{Sheet, Svg};
use crate::error::Result;
use crate::results::{ElementEnvelope, Run};

/// Value of an element, as drawn.
type Value = fn(&ElementEnvelope) -> f64;

/// Largest, static and least pressure along the base, in steps as the elements have them; wide gaps
/// between foundations are drawn short.
///
/// # Errors
/// Those of drawing, for values beyond all bounds.
pub fn pressure_envelope(title: &str, run: &Run) -> Result<Svg> {
    let envelope = &run.envelope;
    let base = Base::of(envelope.iter().map(|e| e.element));
    let curves: [(&str, Value); 3] = [
        ("largest", |e| 1e-3 * e.pressure.highest.value),
        ("static", |e| 1e-3 * e.static_pressure),
        ("least", |e| 1e-3 * e.pressure.lowest.value),
    ];
    let steps = |value: Value| {
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(3 * envelope.len());
        for e in envelope {
            // A gap between two strips is a gap of the curve.
            let left = base.place(e.element.left);
            if points.last().is_some_and(|last| left - last.0 > 1e-6 * e.element.length()) {
                points.push((f64::NAN, f64::NAN));
            }
            points.extend([(left, value(e)), (left + e.element.length(), value(e))]);
        }
        points
    };
    let values = curves.iter().flat_map(|(_, value)| envelope.iter().map(value));
    let range = range_of(values.chain([0.0]));
    let strokes = [COLORS[1], COLORS[5], COLORS[0]].map(Stroke::plain);
    let key = curves.iter().zip(strokes).map(|((name, _), stroke)| (*name, Sample::Line(stroke)));
    Sheet::new(title, Key::of(key)).picture(|area| {
        let top = range.end - 0.04 * (range.end - range.start);
        let mut chart = chart(area, &base.axis(), &Axis::linear(range, "pressure, kPa"), true)?;
        label_breaks(&mut chart, &base, |place| (place, top))?;
        for ((_, value), stroke) in curves.into_iter().zip(strokes) {
            draw_curve(&mut chart, &steps(value), stroke, 2)?;
        }
        Ok(())
    })
}
