//! Contact along the base: modes over time, and the envelope of pressure.

use super::axes::{Axis, chart, draw_curve, range_of};
use super::base_axis::{BaseAxis, label_breaks, unrolled};
use super::drawing::{COLORS, Stroke};
use super::key::{Key, Sample};
use super::plan::largest_pressures;
use super::shown::{Shown, shown};
use super::svg::{Sheet, Svg};
use crate::error::{Result, require_part};
use crate::results::{ElementEnvelope, Run, TimeSeries};
use plotters::prelude::*;

/// Largest number of columns of the map, about one per pixel.
const COLUMNS: usize = 1000;

/// Picture of the contact mode of every element over time.
///
/// Where several frames share a column, the rarest mode is shown. Wide gaps between foundations are drawn
/// short. Walls continue the base to both sides.
///
/// An element in a mode of slip without pressure is shown as touching without pressure. With infinite
/// friction this is the state between stick and open, and nothing slides.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if fewer than two frames of contact were kept
/// ([`crate::results::Recorder::contact`]), or on a ground in plan.
pub fn mode_map(title: &str, time_series: &TimeSeries) -> Result<Svg> {
    let needed = "a base in the plane: `contact_plan` draws one in plan";
    require_part("map of contact modes", !time_series.in_plan(), needed)?;
    let frames: Vec<_> = time_series.contact_frames().collect();
    let elements = unrolled(time_series.elements().iter().copied());
    let needed = "tell the recorder to keep the contact";
    require_part("map of contact modes", !elements.is_empty() && frames.len() > 1, needed)?;
    let (begin, end) = (frames[0].time, frames[frames.len() - 1].time);
    let every = (frames.len() - 1).div_ceil(COLUMNS).max(1);
    let (shown, key) = shown(&frames, false);
    let key = key.into_iter().map(|what| (what.name(), Sample::Area(what.color())));
    let base = BaseAxis::new(elements.iter().copied());
    Sheet::new(title, Key::new(key)).picture(|area| {
        let mut chart = chart(area, &Axis::linear(begin..end, "time, s"), &base.axis(), false)?;
        label_breaks(&mut chart, &base, |place| (0.5 * (begin + end), place))?;
        for (e, element) in elements.iter().enumerate() {
            // The first frame is the start, before any step.
            let columns: Vec<(f64, Option<Shown>)> = frames[1..]
                .chunks(every)
                .zip(shown[1..].chunks(every))
                .map(|(frames, shown)| {
                    let rarest = shown.iter().map(|modes| modes[e]).max();
                    (frames[frames.len() - 1].time, rarest)
                })
                .collect();
            let mut start = begin;
            let hair = 0.04 * element.length();
            let low = base.place(element.left());
            for stretch in columns.chunk_by(|a, b| a.1 == b.1) {
                let stop = stretch[stretch.len() - 1].0;
                if let Some(what) = stretch[0].1 {
                    let area = [(start, low + hair), (stop, low + element.length() - hair)];
                    chart.draw_series([Rectangle::new(area, what.color().filled())])?;
                }
                start = stop;
            }
        }
        Ok(())
    })
}

/// Function that returns the value of an element to be drawn.
type Value = fn(&ElementEnvelope) -> f64;

/// Picture of the largest, static and smallest pressure along the base, constant in each element.
///
/// Wide gaps between foundations are drawn short. Walls continue the base to both sides. In plan, the largest pressure
/// under each element.
///
/// # Errors
/// Errors of drawing, for extremely large values.
pub fn pressure_envelope(title: &str, run: &Run) -> Result<Svg> {
    if run.in_plan {
        return largest_pressures(title, run);
    }
    let envelope = &run.envelope;
    let elements = unrolled(envelope.iter().map(|own| own.element));
    let base = BaseAxis::new(elements.iter().copied());
    let curves: [(&str, Value); 3] = [
        ("largest", |e| 1e-3 * e.pressure.highest.value),
        ("static", |e| 1e-3 * e.static_pressure),
        ("least", |e| 1e-3 * e.pressure.lowest.value),
    ];
    let steps = |value: Value| {
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(3 * envelope.len());
        for (e, element) in envelope.iter().zip(&elements) {
            // A gap between two strips is a gap in the curve.
            let left = base.place(element.left());
            if points.last().is_some_and(|last| left - last.0 > 1e-6 * element.length()) {
                points.push((f64::NAN, f64::NAN));
            }
            points.extend([(left, value(e)), (left + element.length(), value(e))]);
        }
        points
    };
    let values = curves.iter().flat_map(|(_, value)| envelope.iter().map(value));
    let range = range_of(values.chain([0.0]));
    let strokes = [COLORS[1], COLORS[5], COLORS[0]].map(Stroke::plain);
    let key = curves.iter().zip(strokes).map(|((name, _), stroke)| (*name, Sample::Line(stroke)));
    Sheet::new(title, Key::new(key)).picture(|area| {
        let top = range.end - 0.04 * (range.end - range.start);
        let mut chart = chart(area, &base.axis(), &Axis::linear(range, "pressure, kPa"), true)?;
        label_breaks(&mut chart, &base, |place| (place, top))?;
        for ((_, value), stroke) in curves.into_iter().zip(strokes) {
            draw_curve(&mut chart, &steps(value), stroke, 2)?;
        }
        Ok(())
    })
}
