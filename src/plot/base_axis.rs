//! Base as an axis: wide gaps between foundations are drawn short.

use super::axes::{Axis, Chart, LABEL, linear};
use super::drawing::Drawing;
use super::text_width::{short, width};
use crate::bem::ContactElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

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

/// Elements of a base on its line: walls continue it to both sides.
pub(super) fn unrolled(elements: impl Iterator<Item = ContactElement>) -> Vec<ContactElement> {
    let elements: Vec<ContactElement> = elements.collect();
    let below = elements.iter().find(|own| own.faces_down());
    let bottom = below.map_or(0.0, |own| own.center()[2]);
    let line = |own: &ContactElement| {
        if own.faces_down() {
            return *own;
        }
        let (side, half) = (own.directions()[0][0].signum(), 0.5 * own.length());
        let middle = own.left() + side * (own.center()[2] - bottom);
        ContactElement::new(middle - half, middle + half)
    };
    elements.iter().map(line).collect()
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
