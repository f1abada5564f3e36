//! Pictures of the contact along the base: modes over time, and the envelope of pressure.

use super::axes::{ChartAxis, chart, draw_curve};
use super::base_axis::{BaseAxis, GAP_ROUNDING, label_gaps, unrolled};
use super::drawing::{CURVE_COLORS, Stroke, range_of};
use super::element_state::{ElementState, ElementStates};
use super::key::{KeySample, PictureKey};
use super::plan::largest_pressures;
use super::svg::{PictureLayout, Svg};
use crate::bem::ContactElement;
use crate::error::{Result, require_part};
use crate::results::{ContactFrame, ElementEnvelope, Run, TimeSeries};
use plotters::prelude::*;

/// Half the distance between the rectangles of neighbouring elements, over the length of an element.
const ELEMENT_MARGIN_RATIO: f64 = 0.04;
/// Distance of the labels of gaps from the upper end of the pressure axis, over the length of the axis.
const LABEL_DISTANCE_RATIO: f64 = 0.04;
/// Largest number of columns of the map, about one per pixel.
const MAX_MAP_COLUMNS: usize = 1000;

/// Picture of the contact mode of every element over time.
///
/// Where several frames share a column, one of their states is shown: slip before touching without pressure, open and
/// stick. Wide gaps between foundations are drawn short. Walls continue the base to both sides.
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
    let needed = "the recorder must keep the contact (`Recorder::contact`)";
    require_part("map of contact modes", !elements.is_empty() && frames.len() > 1, needed)?;
    let begin_time = frames[0].time;
    let end_time = frames[frames.len() - 1].time;
    let frames_per_column = (frames.len() - 1).div_ceil(MAX_MAP_COLUMNS).max(1);
    let states = ElementStates::new(&frames, false);
    let key = states.key_states.iter().map(|state| (state.name(), KeySample::Area(state.color())));
    let base = BaseAxis::new(elements.iter().copied());
    PictureLayout::new(title, PictureKey::new(key)).picture(|area| {
        let mut chart =
            chart(area, &ChartAxis::linear(begin_time..end_time, "time, s"), &base.axis(), false)?;
        label_gaps(&mut chart, &base, |position| (0.5 * (begin_time + end_time), position))?;
        for (e, element) in elements.iter().enumerate() {
            let columns = mode_columns(&frames, &states, e, frames_per_column);
            let mut start_time = begin_time;
            let margin = ELEMENT_MARGIN_RATIO * element.length();
            let low = base.drawn_position(element.left());
            let high = low + element.length();
            for equal_columns in columns.chunk_by(|a, b| a.state == b.state) {
                let end_time = equal_columns[equal_columns.len() - 1].end;
                let corners = [(start_time, low + margin), (end_time, high - margin)];
                let color = equal_columns[0].state.color();
                chart.draw_series([Rectangle::new(corners, color.filled())])?;
                start_time = end_time;
            }
        }
        Ok(())
    })
}

/// State of an element during several frames.
struct ModeColumn {
    /// Time of the last of these frames, s.
    end: f64,
    /// The state that is drawn: the largest of these frames, in the order of [`ElementState`].
    state: ElementState,
}

/// Columns of an element in the map, each for `frames_per_column` frames.
fn mode_columns(
    frames: &[ContactFrame<'_>],
    states: &ElementStates,
    element: usize,
    frames_per_column: usize,
) -> Vec<ModeColumn> {
    let mut columns = Vec::new();
    // The first frame is the start, before any step.
    let frame_groups = frames[1..].chunks(frames_per_column);
    let state_groups = states.frame_states[1..].chunks(frames_per_column);
    for (frame_group, state_group) in frame_groups.zip(state_groups) {
        if let Some(state) = state_group.iter().map(|frame| frame[element]).max() {
            columns.push(ModeColumn { end: frame_group[frame_group.len() - 1].time, state });
        }
    }
    columns
}

/// Function that returns the value of an element to be drawn.
type ElementValue = fn(&ElementEnvelope) -> f64;

/// Picture of the largest, static and smallest pressure along the base, constant in each element.
///
/// Wide gaps between foundations are drawn short. Walls continue the base to both sides. In plan the picture has the
/// largest pressure under each element.
///
/// # Errors
/// Errors of drawing, for extremely large values.
pub fn pressure_envelope(title: &str, run: &Run) -> Result<Svg> {
    if run.in_plan {
        return largest_pressures(title, run);
    }
    let envelope = &run.envelope;
    let elements = unrolled(envelope.iter().map(|element| element.element));
    let base = BaseAxis::new(elements.iter().copied());
    let curves: [(&str, ElementValue); 3] = [
        ("largest", |element| 1e-3 * element.pressure.highest.value),
        ("static", |element| 1e-3 * element.static_pressure),
        ("least", |element| 1e-3 * element.pressure.lowest.value),
    ];
    let values = curves.iter().flat_map(|(_, value)| envelope.iter().map(value));
    let range = range_of(values.chain([0.0]));
    let strokes = [CURVE_COLORS[1], CURVE_COLORS[5], CURVE_COLORS[0]].map(Stroke::plain);
    let names = curves.iter().map(|(name, _)| *name);
    let key = names.zip(strokes.map(KeySample::Line));
    PictureLayout::new(title, PictureKey::new(key)).picture(|area| {
        let label_pressure = range.end - LABEL_DISTANCE_RATIO * (range.end - range.start);
        let pressure_axis = ChartAxis::linear(range, "pressure, kPa");
        let mut chart = chart(area, &base.axis(), &pressure_axis, true)?;
        label_gaps(&mut chart, &base, |position| (position, label_pressure))?;
        for ((_, value), stroke) in curves.into_iter().zip(strokes) {
            let points = steps_along_base(envelope, &elements, &base, value);
            draw_curve(&mut chart, &points, stroke, 2)?;
        }
        Ok(())
    })
}

/// A value along the base, constant in each element.
fn steps_along_base(
    envelope: &[ElementEnvelope],
    elements: &[ContactElement],
    base: &BaseAxis,
    value: ElementValue,
) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(3 * envelope.len());
    for (extremes, element) in envelope.iter().zip(elements) {
        // A gap between two foundations is a gap in the curve.
        let left = base.drawn_position(element.left());
        if points
            .last()
            .is_some_and(|last_point| left - last_point.0 > GAP_ROUNDING * element.length())
        {
            points.push((f64::NAN, f64::NAN));
        }
        points.push((left, value(extremes)));
        points.push((left + element.length(), value(extremes)));
    }
    points
}
