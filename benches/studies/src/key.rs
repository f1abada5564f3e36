//! The key to a chart in a strip beside it.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::AnyError;

pub(crate) type SheetArea<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Sample of a curve or marker beside its name.
#[derive(Debug, Clone, Copy)]
pub(crate) enum LegendSample {
    Line(RGBColor),
    Circle(RGBColor),
    Ring(RGBColor),
    Triangle(RGBColor),
    Cross(RGBColor),
}

/// Pixels beside the names, for a letter of a name, and for a line of the key.
const NAME_MARGIN: usize = 52;
const LETTER_WIDTH: usize = 8;
const LINE_HEIGHT: i32 = 24;

/// Draws the key at the right of the sheet from `top` down; returns the rest of the sheet.
pub(crate) fn draw<'b>(
    sheet: &SheetArea<'b>,
    top: i32,
    entries: &[(String, LegendSample)],
) -> Result<SheetArea<'b>, AnyError> {
    let name_length = entries.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let strip = u32::try_from(NAME_MARGIN + LETTER_WIDTH * name_length)?;
    let (chart, key) = sheet.split_horizontally(sheet.dim_in_pixel().0.saturating_sub(strip));
    let mut y = top;
    for (name, sample) in entries {
        match *sample {
            LegendSample::Line(color) => {
                key.draw(&PathElement::new([(4, y), (28, y)], color.stroke_width(3)))?;
            }
            LegendSample::Circle(color) => key.draw(&Circle::new((16, y), 4, color.filled()))?,
            LegendSample::Ring(color) => key.draw(&Circle::new((16, y), 4, color))?,
            LegendSample::Triangle(color) => {
                key.draw(&TriangleMarker::new((16, y), 5, color.filled()))?;
            }
            LegendSample::Cross(color) => key.draw(&Cross::new((16, y), 4, color))?,
        }
        key.draw(&Text::new(name.clone(), (36, y - 6), ("sans-serif", 15)))?;
        y += LINE_HEIGHT;
    }
    Ok(chart)
}
