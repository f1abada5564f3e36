//! The key to a chart's colours, in a strip of its own at the right: it hides nothing.

use plotters::prelude::*;

use super::svg::{Area, Drawing, SIZE};

/// Names beyond this are cut.
const LONGEST: usize = 30;
/// Pixels for a letter, and beside the names.
const LETTER: u32 = 8;
const SIDE: u32 = 46;
const LINE: i32 = 24;

/// How a name is shown.
#[derive(Clone, Copy)]
pub(super) enum Sample {
    Line(RGBColor),
    Area(RGBColor),
}

/// Width of the strip for these names, pixels.
pub(super) fn width<'n>(names: impl Iterator<Item = &'n str>) -> u32 {
    let longest = names.map(|name| name.chars().count().min(LONGEST)).max().unwrap_or(0);
    SIDE + LETTER * u32::try_from(longest).unwrap_or(0)
}

/// Draws the key, and gives back what it leaves of the sheet.
pub(super) fn draw_key<'b>(area: &Area<'b>, entries: &[(&str, Sample)]) -> Drawing<Area<'b>> {
    let strip = width(entries.iter().map(|(name, _)| *name));
    let (chart, key) = area.split_horizontally(SIZE.0 - strip);
    let mut y = 58;
    for (name, sample) in entries {
        match sample {
            Sample::Line(color) => {
                key.draw(&PathElement::new([(4, y), (28, y)], color.stroke_width(3)))?;
            }
            Sample::Area(color) => {
                key.draw(&Rectangle::new([(4, y - 7), (28, y + 7)], color.filled()))?;
            }
        }
        let shown: String = name.chars().take(LONGEST).collect();
        key.draw(&Text::new(shown, (36, y - 6), ("sans-serif", 15)))?;
        y += LINE;
    }
    Ok(chart)
}
