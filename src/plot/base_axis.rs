//! The axis along a base, on which wide gaps between foundations are drawn short.

use super::axes::{Chart, ChartAxis, LABEL_FONT};
use super::drawing::Drawing;
use super::text_width::{short, width};
use super::ticks::linear_ticks;
use crate::bem::ContactElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Widest gap drawn to scale, relative to the length of all foundations.
const MAX_GAP_RATIO: f64 = 0.1;

/// Number of marks of the whole axis.
const AXIS_MARKS: usize = 11;

/// Distance between elements that is due to rounding, relative to the length of an element.
pub(super) const GAP_ROUNDING: f64 = 1e-6;

/// A foundation: adjacent elements without gaps.
#[derive(Debug, Clone, Copy, PartialEq)]
struct DrawnFoundation {
    /// x of the left end, m.
    left: f64,
    /// x of the right end, m.
    right: f64,
    /// Drawn position of the left end, m.
    start: f64,
}

/// A gap that is drawn shorter than its true width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ShortenedGap {
    /// Drawn position of the left end, m.
    pub(super) start: f64,
    /// Drawn position of the right end, m.
    pub(super) end: f64,
    /// True width, m.
    pub(super) width: f64,
}

/// Elements of a base on one line, which walls continue on both sides.
pub(super) fn unrolled(elements: impl Iterator<Item = ContactElement>) -> Vec<ContactElement> {
    let elements: Vec<ContactElement> = elements.collect();
    let floor_element = elements.iter().find(|element| element.faces_down());
    let bottom = floor_element.map_or(0.0, |element| element.center()[2]);
    let mut unrolled = Vec::with_capacity(elements.len());
    for element in &elements {
        if element.faces_down() {
            unrolled.push(*element);
        } else {
            let side = element.directions()[0][0].signum();
            let half_length = 0.5 * element.length();
            let middle = element.left() + side * (element.center()[2] - bottom);
            unrolled.push(ContactElement::new(middle - half_length, middle + half_length));
        }
    }
    unrolled
}

/// Axis along the base, on which wide gaps between foundations are drawn short.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BaseAxis {
    foundations: Vec<DrawnFoundation>,
    pub(super) gaps: Vec<ShortenedGap>,
}

impl BaseAxis {
    /// Axis along these elements, in any order.
    pub(super) fn new(elements: impl Iterator<Item = ContactElement>) -> Self {
        let mut elements: Vec<ContactElement> = elements.collect();
        elements.sort_by(|a, b| a.left().total_cmp(&b.left()));
        let mut foundations: Vec<DrawnFoundation> = Vec::new();
        for element in &elements {
            match foundations.last_mut() {
                Some(previous_foundation)
                    if element.left() - previous_foundation.right
                        < GAP_ROUNDING * element.length() =>
                {
                    previous_foundation.right = element.right();
                }
                _ => foundations.push(DrawnFoundation {
                    left: element.left(),
                    right: element.right(),
                    start: element.left(),
                }),
            }
        }
        let max_gap = MAX_GAP_RATIO
            * foundations.iter().map(|foundation| foundation.right - foundation.left).sum::<f64>();
        let mut gaps = Vec::new();
        for k in 1..foundations.len() {
            let previous_foundation = foundations[k - 1];
            let end =
                previous_foundation.start + previous_foundation.right - previous_foundation.left;
            let width = foundations[k].left - previous_foundation.right;
            if width > max_gap {
                gaps.push(ShortenedGap { start: end, end: end + max_gap, width });
            }
            foundations[k].start = end + width.min(max_gap);
        }
        Self { foundations, gaps }
    }

    /// Drawn position of a point of the base, m.
    pub(super) fn drawn_position(&self, x: f64) -> f64 {
        // Between two foundations nothing is drawn; the position refers to the foundation on the left.
        let foundation = self
            .foundations
            .iter()
            .rev()
            .find(|foundation| foundation.left <= x)
            .or(self.foundations.first());
        foundation.map_or(x, |foundation| foundation.start + x - foundation.left)
    }

    /// Axis along the base, with marks on the foundations only.
    pub(super) fn axis(&self) -> ChartAxis {
        let description = "x along the base, m";
        let (Some(leftmost), Some(rightmost)) = (self.foundations.first(), self.foundations.last())
        else {
            return ChartAxis::linear(0.0..1.0, description);
        };
        let range = leftmost.start..rightmost.start + rightmost.right - rightmost.left;
        if self.gaps.is_empty() {
            return ChartAxis::linear(range, description);
        }
        let mut marks = Vec::new();
        for foundation in &self.foundations {
            let fraction = (foundation.right - foundation.left) / (range.end - range.start);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "to 11")]
            let mark_count = ((fraction * AXIS_MARKS as f64).round() as usize).max(2);
            let ticks = linear_ticks(&(foundation.left..foundation.right), mark_count);
            if ticks.offset.is_some() {
                // The numbers are too long for an axis: one mark has the rounded coordinate.
                marks.push((foundation.start, short(foundation.left)));
                continue;
            }
            for (x, name) in ticks.marks {
                marks.push((foundation.start + x - foundation.left, name));
            }
        }
        ChartAxis::marked(range, marks, description)
    }
}

/// Writes the true width of every shortened gap into the gap, if there is space for the text.
///
/// `text_point` returns the middle of a text from its position on the axis.
pub(super) fn label_gaps(
    chart: &mut Chart<'_, '_>,
    base: &BaseAxis,
    text_point: impl Fn(f64) -> (f64, f64),
) -> Drawing<()> {
    let style = TextStyle::from(LABEL_FONT.into_font()).pos(Pos::new(HPos::Center, VPos::Center));
    let mut texts = Vec::new();
    for gap in &base.gaps {
        let start = chart.plotting_area().map_coordinate(&text_point(gap.start));
        let end = chart.plotting_area().map_coordinate(&text_point(gap.end));
        let text = format!("gap {} m", short(gap.width));
        let gap_width = start.0.abs_diff(end.0);
        let gap_height = start.1.abs_diff(end.1);
        if f64::from(gap_width) > width(&text, LABEL_FONT.1) || gap_height >= LABEL_FONT.1 {
            texts.push(Text::new(text, text_point(0.5 * (gap.start + gap.end)), style.clone()));
        }
    }
    chart.draw_series(texts)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_gaps_are_drawn_short() {
        let elements = [(0.0, 4.0), (4.0, 8.0), (40.0, 48.0), (48.5, 50.0)];
        let elements = elements.map(|(left, right)| ContactElement::new(left, right));
        let base = BaseAxis::new(elements.into_iter());
        // 17.5 m of foundations: the gap of 32 m becomes 1.75 m; the gap of 0.5 m keeps its width.
        assert_eq!(base.gaps, [ShortenedGap { start: 8.0, end: 9.75, width: 32.0 }]);
        for (x, position) in [(0.0, 0.0), (8.0, 8.0), (40.0, 9.75), (48.0, 17.75), (50.0, 19.75)] {
            assert!((base.drawn_position(x) - position).abs() < 1e-12, "{x}");
        }
    }
}
