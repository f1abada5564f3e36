//! Pictures of cells in the colours of their values, with one scale on both axes.

use std::ops::Range;

use super::axes::{Chart, ChartAxis, chart};
use super::drawing::Drawing;
use super::key::{KeySample, PictureKey};
use super::svg::{PictureLayout, Svg};
use crate::error::Result;
use crate::geometry::{middle, span};
use plotters::prelude::*;

/// Width of the margin around the cells, relative to the larger side of all cells.
const MARGIN_RATIO: f64 = 0.06;
/// Half the length of an arrow, relative to the shorter side of a cell.
const ARROW_LENGTH_RATIO: f64 = 0.36;
/// Length of the head of an arrow, relative to the shorter side of a cell.
const ARROW_HEAD_RATIO: f64 = 0.15;
/// Cosine of 30 degrees: the head of an arrow is an equilateral triangle.
const BARB_COSINE: f64 = 0.87;
/// Smallest side of a cell with a white outline, pixels.
///
/// White lines would hide the colours of smaller cells. Outlines of smaller cells without a value are paler.
const MIN_OUTLINED_SIDE: f64 = 6.0;
/// Colour of the outlines of cells without a value.
pub(super) const OUTLINE_COLOR: RGBColor = RGBColor(185, 185, 185);
/// Colour of bars.
const BAR_COLOR: RGBColor = RGBColor(70, 70, 70);

/// A cell to be drawn.
pub(super) struct PictureCell {
    /// Corners (x, y), m; the two ends of a bar.
    pub(super) corners: Vec<(f64, f64)>,
    /// Colour of the value; only the outline of a cell without a value is drawn.
    pub(super) color: Option<RGBColor>,
    /// Arrow in the direction in which the cell slides.
    pub(super) arrow: Option<Arrow>,
}

impl PictureCell {
    /// Whether the cell is a line between two nodes.
    pub(super) fn is_bar(&self) -> bool {
        self.corners.len() == 2
    }

    /// Line around the cell, or along the bar.
    fn outline(&self, metres_per_pixel: f64) -> PathElement<(f64, f64)> {
        let closed_outline = self.corners.iter().chain(self.corners.first()).copied();
        let relative_side = self.shorter_side() / (MIN_OUTLINED_SIDE * metres_per_pixel);
        let style = match self.color {
            None if self.is_bar() => BAR_COLOR.stroke_width(2),
            None => OUTLINE_COLOR.mix(relative_side.min(1.0)).stroke_width(1),
            Some(_) if relative_side >= 1.0 => WHITE.stroke_width(1),
            // An outline in the same colour closes the gaps between small cells.
            Some(color) => color.stroke_width(1),
        };
        PathElement::new(closed_outline.collect::<Vec<_>>(), style)
    }

    /// Width or height of the cell, whichever is smaller, m.
    fn shorter_side(&self) -> f64 {
        let [left, right] = span(self.corners.iter().map(|corner| corner.0));
        let [bottom, top] = span(self.corners.iter().map(|corner| corner.1));
        (right - left).min(top - bottom)
    }
}

/// An arrow in the middle of a cell.
pub(super) struct Arrow {
    pub(super) middle: [f64; 2],
    /// Unit vector.
    pub(super) direction: [f64; 2],
    /// Shorter side of the cell, m.
    pub(super) shorter_side: f64,
}

impl Arrow {
    fn path(&self) -> PathElement<(f64, f64)> {
        let Self { middle: [x, y], direction: [dx, dy], shorter_side } = *self;
        let length = ARROW_LENGTH_RATIO * shorter_side;
        let head = ARROW_HEAD_RATIO * shorter_side;
        let foot = (x - length * dx, y - length * dy);
        let tip = (x + length * dx, y + length * dy);
        let barb_length = head * BARB_COSINE;
        let barbs = [0.5, -0.5].map(|side| {
            let barb_width = side * head;
            (tip.0 - barb_length * dx - barb_width * dy, tip.1 - barb_length * dy + barb_width * dx)
        });
        PathElement::new(vec![foot, tip, barbs[0], tip, barbs[1]], BLACK.stroke_width(1))
    }
}

/// Picture of cells with one scale on both axes.
pub(super) fn cell_picture(
    title: &str,
    cells: &[PictureCell],
    key: &[(String, KeySample)],
) -> Result<Svg> {
    let layout = PictureLayout::new(
        title,
        PictureKey::new(key.iter().map(|(name, sample)| (&name[..], *sample))),
    );
    let corners = cells.iter().flat_map(|cell| &cell.corners);
    let x_ends = span(corners.clone().map(|corner| corner.0));
    let y_ends = span(corners.map(|corner| corner.1));
    let width = x_ends[1] - x_ends[0];
    let height = y_ends[1] - y_ends[0];
    let margin = MARGIN_RATIO * width.max(height);
    let chart_size = layout.chart_size();
    let metres_per_pixel = 0.0_f64
        .max((width + 2.0 * margin) / chart_size[0])
        .max((height + 2.0 * margin) / chart_size[1]);
    let x = range_around(middle(x_ends), 0.5 * metres_per_pixel * chart_size[0]);
    let y = range_around(middle(y_ends), 0.5 * metres_per_pixel * chart_size[1]);
    layout.picture(|area| {
        let x_axis = ChartAxis::linear(x, "x, m");
        let y_axis = ChartAxis::linear(y, "y, m");
        let mut chart = chart(area, &x_axis, &y_axis, false)?;
        draw_cells(&mut chart, cells, metres_per_pixel)
    })
}

/// Draws cells, bars and arrows.
///
/// Outlines of cells without a value lie over cells with a value. Bars and arrows lie over both.
fn draw_cells(
    chart: &mut Chart<'_, '_>,
    cells: &[PictureCell],
    metres_per_pixel: f64,
) -> Drawing<()> {
    let areas = cells.iter().filter_map(|cell| Some((cell, cell.color?)));
    chart.draw_series(
        areas.map(|(cell, color)| Polygon::new(cell.corners.clone(), color.filled())),
    )?;
    let mut ordered_cells: Vec<&PictureCell> = cells.iter().collect();
    ordered_cells.sort_by_key(|cell| (cell.color.is_none(), cell.is_bar()));
    chart.draw_series(ordered_cells.into_iter().map(|cell| cell.outline(metres_per_pixel)))?;
    let arrows = cells.iter().filter_map(|cell| cell.arrow.as_ref());
    chart.draw_series(arrows.map(Arrow::path))?;
    Ok(())
}

/// Range of this half width about a middle.
fn range_around(middle: f64, half_width: f64) -> Range<f64> {
    middle - half_width..middle + half_width
}
