//! Contact modes over base and time.

use plotters::prelude::*;

use super::axes::{Axis, chart};
use super::base::{Base, label_breaks};
use super::key::{Key, Sample};
use super::svg::{Sheet, Svg};
use crate::error::{Error, Result};
use crate::interface::{ContactState, Mode};
use crate::results::{ContactFrame, Histories};

/// Columns of the map: more than pixels help nobody.
const COLUMNS: usize = 1000;

/// State of an element, as drawn; where several share a column the greater shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Shown {
    Stick,
    Open,
    /// Touching without a pressure: what "slip" is with infinite friction, the one state between
    /// stick and open.
    Weightless,
    SlipLeft,
    SlipRight,
}

impl Shown {
    pub(super) const ALL: [Self; 5] =
        [Self::Stick, Self::SlipLeft, Self::SlipRight, Self::Open, Self::Weightless];

    /// Mode and tractions of an element, of a base whose largest pressure is `scale`.
    pub(super) fn of(mode: Mode, state: &ContactState, scale: f64) -> Self {
        match mode.elastic() {
            Mode::Open => Self::Open,
            _ if state.pressure.abs() <= 1e-9 * scale => Self::Weightless,
            Mode::SlipLeft => Self::SlipLeft,
            Mode::SlipRight => Self::SlipRight,
            _ => Self::Stick,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::SlipLeft => "slip to the left",
            Self::SlipRight => "slip to the right",
            Self::Open => "open",
            Self::Weightless => "touching without pressure",
        }
    }

    pub(super) fn color(self) -> RGBColor {
        match self {
            Self::Stick => RGBColor(214, 222, 228),
            Self::SlipLeft => RGBColor(255, 166, 43),
            Self::SlipRight => RGBColor(214, 39, 40),
            Self::Open => RGBColor(22, 72, 120),
            Self::Weightless => RGBColor(118, 172, 214),
        }
    }
}

/// State of every element in every frame, and the states that the key shows: the modes always,
/// touching without pressure where it occurs.
pub(super) fn shown(frames: &[ContactFrame<'_>]) -> (Vec<Vec<Shown>>, Vec<Shown>) {
    let pressures = frames.iter().flat_map(|frame| frame.states).map(|state| state.pressure.abs());
    let scale = pressures.fold(0.0, f64::max);
    let of_frame = |frame: &ContactFrame<'_>| -> Vec<Shown> {
        let both = frame.modes.iter().zip(frame.states);
        both.map(|(mode, state)| Shown::of(*mode, state, scale)).collect()
    };
    let all: Vec<Vec<Shown>> = frames.iter().map(of_frame).collect();
    let occurs = |what: Shown| all.iter().flatten().any(|shown| *shown == what);
    let key = Shown::ALL.into_iter().filter(|what| *what != Shown::Weightless || occurs(*what));
    let key = key.collect();
    (all, key)
}

/// The mode of every contact element over time; where frames share a column, the rarest mode shows.
/// Wide gaps between foundations are drawn short.
///
/// An element in a mode of slip that bears no pressure is shown as touching without pressure: with
/// infinite friction this is what lies between stick and open, and nothing slides.
///
/// # Errors
/// [`Error::Scene`] if fewer than two frames of contact were kept
/// ([`crate::results::Recorder::contact`]).
pub fn mode_map(title: &str, histories: &Histories) -> Result<Svg> {
    let frames: Vec<_> = histories.contact_frames().collect();
    let elements = histories.elements();
    if elements.is_empty() || frames.len() < 2 {
        let needed = "tell the recorder to keep the contact";
        return Err(Error::Scene { quantity: "map of contact modes", needed });
    }
    let (begin, end) = (frames[0].time, frames[frames.len() - 1].time);
    let every = (frames.len() - 1).div_ceil(COLUMNS).max(1);
    let (shown, key) = shown(&frames);
    let key = key.into_iter().map(|what| (what.name(), Sample::Area(what.color())));
    let base = Base::of(elements.iter().copied());
    Sheet::new(title, Key::of(key)).picture(|area| {
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
            let low = base.place(element.left);
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
