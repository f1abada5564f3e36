//! Contact modes over base and time.

use plotters::prelude::*;

use super::axes::chart;
use super::key::{Sample, draw_key};
use super::svg::{Svg, picture};
use crate::error::{Error, Result};
use crate::interface::Mode;
use crate::results::Histories;

/// Columns of the map: more than pixels help nobody.
const COLUMNS: usize = 1000;

pub(super) const MODES: [(Mode, &str); 4] = [
    (Mode::Stick, "stick"),
    (Mode::SlipLeft, "slip to the left"),
    (Mode::SlipRight, "slip to the right"),
    (Mode::Open, "open"),
];

pub(super) fn color(mode: Mode) -> RGBColor {
    match mode {
        Mode::Stick => RGBColor(214, 222, 228),
        Mode::SlipLeft => RGBColor(255, 166, 43),
        Mode::SlipRight => RGBColor(214, 39, 40),
        Mode::Open => RGBColor(22, 72, 120),
    }
}

/// What shows where several modes share a column: the rarer.
fn rank(mode: Mode) -> u8 {
    match mode {
        Mode::Stick => 0,
        Mode::Open => 1,
        Mode::SlipLeft => 2,
        Mode::SlipRight => 3,
    }
}

/// The mode of every contact element over time; where frames share a column, the rarest mode shows.
///
/// # Errors
/// [`Error::Scene`] if fewer than two frames of contact were kept
/// ([`crate::results::Recorder::contact`]).
pub fn mode_map(title: &str, histories: &Histories) -> Result<Svg> {
    let frames: Vec<_> = histories.contact_frames().collect();
    let elements = histories.elements();
    let (Some(first), Some(last), true) = (elements.first(), elements.last(), frames.len() > 1)
    else {
        let needed = "tell the recorder to keep the contact";
        return Err(Error::Scene { quantity: "map of contact modes", needed });
    };
    let (begin, end) = (frames[0].time, frames[frames.len() - 1].time);
    let every = (frames.len() - 1).div_ceil(COLUMNS).max(1);
    let key = MODES.map(|(mode, name)| (name, Sample::Area(color(mode))));
    picture(|area| {
        let area = draw_key(area, &key)?;
        let (x, y) = ((begin..end, "time, s"), (first.left..last.right, "x along the base, m"));
        let mut chart = chart(&area, title, x, y, false)?;
        for (e, element) in elements.iter().enumerate() {
            let mode_of = |column: &[crate::results::ContactFrame<'_>]| {
                column.iter().map(|frame| frame.modes[e]).max_by_key(|mode| rank(*mode))
            };
            // The first frame is the start, before any step.
            let columns: Vec<(f64, Option<Mode>)> = frames[1..]
                .chunks(every)
                .map(|column| (column[column.len() - 1].time, mode_of(column)))
                .collect();
            let mut start = begin;
            let hair = 0.04 * element.length();
            for stretch in columns.chunk_by(|a, b| a.1 == b.1) {
                let stop = stretch[stretch.len() - 1].0;
                if let Some(mode) = stretch[0].1 {
                    let area = [(start, element.left + hair), (stop, element.right - hair)];
                    chart.draw_series([Rectangle::new(area, color(mode).filled())])?;
                }
                start = stop;
            }
        }
        Ok(())
    })
}
