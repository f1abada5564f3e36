//! Contact along the base: modes over time, and the envelope of pressure.

use super::axes::{Axis, Chart, LABEL, chart, draw_curve, linear, range_of};
use super::drawing::{COLORS, Drawing, Key, Sample, Stroke, short, width};
use super::plan::largest_pressures;
use super::shown::{Shown, shown};
use super::svg::{Sheet, Svg};
use crate::bem::ContactElement;
use crate::error::{Result, require_part};
use crate::results::{ElementEnvelope, Run, TimeSeries};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Largest number of columns of the map, about one per pixel.
const COLUMNS: usize = 1000;

/// Picture of the contact mode of every element over time.
///
/// Where several frames share a column, the rarest mode is shown. Wide gaps between foundations are drawn
/// short.
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
    let elements = time_series.elements();
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
/// Wide gaps between foundations are drawn short. In plan, the largest pressure under each element.
///
/// # Errors
/// Errors of drawing, for extremely large values.
pub fn pressure_envelope(title: &str, run: &Run) -> Result<Svg> {
    if run.in_plan {
        return largest_pressures(title, run);
    }
    let envelope = &run.envelope;
    let base = BaseAxis::new(envelope.iter().map(|e| e.element));
    let curves: [(&str, Value); 3] = [
        ("largest", |e| 1e-3 * e.pressure.highest.value),
        ("static", |e| 1e-3 * e.static_pressure),
        ("least", |e| 1e-3 * e.pressure.lowest.value),
    ];
    let steps = |value: Value| {
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(3 * envelope.len());
        for e in envelope {
            // A gap between two strips is a gap in the curve.
            let left = base.place(e.element.left());
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

// The base as an axis: wide gaps between foundations are drawn short.

/// Widest gap drawn to scale, relative to the length of all foundations.
const WIDEST: f64 = 0.1;
/// Number of marks of the whole axis.
const MARKS: usize = 11;

/// A foundation: adjacent elements without gaps.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    left: f64,
    right: f64,
    /// Drawn position of the left end, m.
    start: f64,
}

/// A gap that is drawn shorter than its true width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Break {
    /// Drawn positions of the ends, m.
    pub(super) from: f64,
    pub(super) to: f64,
    /// True width, m.
    pub(super) width: f64,
}

/// Axis along the base, on which wide gaps between foundations are drawn short.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BaseAxis {
    pieces: Vec<Piece>,
    pub(super) breaks: Vec<Break>,
}

impl BaseAxis {
    pub(super) fn new(elements: impl Iterator<Item = ContactElement>) -> Self {
        let mut elements: Vec<ContactElement> = elements.collect();
        elements.sort_by(|a, b| a.left().total_cmp(&b.left()));
        let mut pieces: Vec<Piece> = Vec::new();
        for element in &elements {
            match pieces.last_mut() {
                Some(last) if element.left() - last.right < 1e-6 * element.length() => {
                    last.right = element.right();
                }
                _ => pieces.push(Piece {
                    left: element.left(),
                    right: element.right(),
                    start: element.left(),
                }),
            }
        }
        let widest = WIDEST * pieces.iter().map(|piece| piece.right - piece.left).sum::<f64>();
        let mut breaks = Vec::new();
        for k in 1..pieces.len() {
            let last = pieces[k - 1];
            let (end, width) = (last.start + last.right - last.left, pieces[k].left - last.right);
            if width > widest {
                breaks.push(Break { from: end, to: end + widest, width });
            }
            pieces[k].start = end + width.min(widest);
        }
        Self { pieces, breaks }
    }

    /// Drawn position of a point of the base, m.
    pub(super) fn place(&self, x: f64) -> f64 {
        // Between two foundations nothing is drawn; the position refers to the foundation on the left.
        let piece = self.pieces.iter().rev().find(|p| p.left <= x).or(self.pieces.first());
        piece.map_or(x, |piece| piece.start + x - piece.left)
    }

    /// Axis along the base, with marks on the foundations only.
    pub(super) fn axis(&self) -> Axis {
        let description = "x along the base, m";
        let (Some(first), Some(last)) = (self.pieces.first(), self.pieces.last()) else {
            return Axis::linear(0.0..1.0, description);
        };
        let range = first.start..last.start + last.right - last.left;
        if self.breaks.is_empty() {
            return Axis::linear(range, description);
        }
        let mut marks = Vec::new();
        for piece in &self.pieces {
            let share = (piece.right - piece.left) / (range.end - range.start);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "to 11")]
            let count = ((share * MARKS as f64).round() as usize).max(2);
            let ticks = linear(&(piece.left..piece.right), count);
            if ticks.offset.is_some() {
                // Numbers too long for an axis: one mark with the approximate place.
                marks.push((piece.start, short(piece.left)));
                continue;
            }
            for (x, name) in ticks.marks {
                marks.push((piece.start + x - piece.left, name));
            }
        }
        Axis::marked(range, marks, description)
    }
}

/// Writes the omitted width into every break that has room for it.
///
/// `at` returns the middle of the text for the middle of the break.
pub(super) fn label_breaks(
    chart: &mut Chart<'_, '_>,
    base: &BaseAxis,
    at: impl Fn(f64) -> (f64, f64),
) -> Drawing<()> {
    let style = TextStyle::from(LABEL.into_font()).pos(Pos::new(HPos::Center, VPos::Center));
    let place = |point| chart.plotting_area().map_coordinate(&point);
    let mut texts = Vec::new();
    for gap in &base.breaks {
        let (from, to) = (place(at(gap.from)), place(at(gap.to)));
        let text = format!("gap {} m", short(gap.width));
        let (wide, high) = (from.0.abs_diff(to.0), from.1.abs_diff(to.1));
        if f64::from(wide) > width(&text, LABEL.1) || high >= LABEL.1 {
            texts.push(Text::new(text, at(0.5 * (gap.from + gap.to)), style.clone()));
        }
    }
    chart.draw_series(texts)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_gaps_are_short_and_marks_tell_where_one_is() {
        let elements = [(0.0, 4.0), (4.0, 8.0), (40.0, 48.0), (48.5, 50.0)];
        let elements = elements.map(|(left, right)| ContactElement::new(left, right));
        let base = BaseAxis::new(elements.into_iter());
        // 17.5 m of foundations: the gap of 32 m becomes 1.75 m; the gap of 0.5 m keeps its width.
        assert_eq!(base.breaks, [Break { from: 8.0, to: 9.75, width: 32.0 }]);
        for (x, place) in [(0.0, 0.0), (8.0, 8.0), (40.0, 9.75), (48.0, 17.75), (50.0, 19.75)] {
            assert!((base.place(x) - place).abs() < 1e-12, "{x}");
        }
    }
}
