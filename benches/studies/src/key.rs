//! The key to a chart, in a strip beside it: it hides nothing.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::AnyError;

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Sample shown with a name.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sample {
    Line(RGBColor),
    Circle(RGBColor),
    Ring(RGBColor),
    Triangle(RGBColor),
    Cross(RGBColor),
}

/// Pixels beside the names, for a letter of theirs, and for a line.
const SIDE: usize = 52;
const LETTER: usize = 8;
const LINE: i32 = 24;

/// Draws the key at the right of the sheet, from `top` down; gives back what is left of it.
pub(crate) fn draw<'b>(
    sheet: &Area<'b>,
    top: i32,
    entries: &[(String, Sample)],
) -> Result<Area<'b>, AnyError> {
    let longest = entries.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let strip = u32::try_from(SIDE + LETTER * longest)?;
    let (chart, key) = sheet.split_horizontally(sheet.dim_in_pixel().0.saturating_sub(strip));
    let mut y = top;
    for (name, sample) in entries {
        match *sample {
            Sample::Line(color) => {
                key.draw(&PathElement::new([(4, y), (28, y)], color.stroke_width(3)))?;
            }
            Sample::Circle(color) => key.draw(&Circle::new((16, y), 4, color.filled()))?,
            Sample::Ring(color) => key.draw(&Circle::new((16, y), 4, color))?,
            Sample::Triangle(color) => {
                key.draw(&TriangleMarker::new((16, y), 5, color.filled()))?;
            }
            Sample::Cross(color) => key.draw(&Cross::new((16, y), 4, color))?,
        }
        key.draw(&Text::new(name.clone(), (36, y - 6), ("sans-serif", 15)))?;
        y += LINE;
    }
    Ok(chart)
}
