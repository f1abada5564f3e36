//! The base in plan: pressures and modes of its cells at an instant, and the largest pressures of a run.

use std::ops::Range;

use super::axes::{Axis, chart, drawable, nice};
use super::drawing::Stroke;
use super::key::{Key, Sample};
use super::shown::Shown;
use super::svg::{Sheet, Svg};
use super::text_width::short;
use crate::error::{Error, Result, finite, require_part};
use crate::geometry::{far_ends, middle};
use crate::interface::ContactState;
use crate::results::{Run, TimeSeries};
use plotters::prelude::*;

/// Approximate number of classes of pressure.
const CLASSES: f64 = 6.0;
/// Colours of the least and the largest pressure.
const PALE: [f64; 3] = [250.0, 240.0, 222.0];
const DARK: [f64; 3] = [150.0, 20.0, 30.0];
/// Width of the frame around the base, relative to its larger side.
const MARGIN: f64 = 0.06;
/// Length of an arrow and of its head, relative to the shorter side of a cell.
const ARROW: [f64; 2] = [0.36, 0.15];

/// A cell to be drawn: its sides along x and y, its colour, and the direction in which it slides.
struct Cell {
    sides: [[f64; 2]; 2],
    color: RGBColor,
    slides: Option<[f64; 2]>,
}

/// Picture of pressures and sliding directions of a base in plan, at the frame nearest to `time` (s).
///
/// Elements are coloured by pressure, open elements are marked, and arrows show how sliding elements move
/// over the soil.
///
/// # Errors
/// [`Error::Scene`] if no frames of contact were kept ([`crate::results::Recorder::contact`]) or the ground
/// is not in plan; [`Error::Input`] for a time that is not finite.
pub fn contact_plan(title: &str, time_series: &TimeSeries, time: f64) -> Result<Svg> {
    finite("time of a picture", time)?;
    let apart = |frame: &crate::results::ContactFrame<'_>| (frame.time - time).abs();
    let frames = time_series.contact_frames();
    let Some(frame) = frames.min_by(|a, b| apart(a).total_cmp(&apart(b))) else {
        let needed = "tell the recorder to keep the contact";
        return Err(Error::Scene { quantity: "contact in plan", needed });
    };
    check(time_series.in_plan())?;
    let largest = frame.states.iter().fold(0.0_f64, |most, own| own.pressure.max(most));
    let classes = Classes::to(largest);
    let both = frame.states.iter().zip(frame.modes);
    let shown: Vec<_> = both.map(|(state, mode)| Shown::new(*mode, state, largest)).collect();
    let slides = |state: &ContactState, shown: Shown| {
        let size = state.shear.hypot(state.shear_across);
        (shown == Shown::Slip && size > 0.0)
            .then(|| [state.shear / size, state.shear_across / size])
    };
    let elements = time_series.elements().iter();
    let cells =
        elements.zip(frame.states.iter().zip(&shown)).map(|(element, (state, what))| Cell {
            sides: element.ends(),
            color: match what {
                Shown::Open | Shown::Weightless => what.color(),
                _ => classes.color(state.pressure),
            },
            slides: slides(state, *what),
        });
    let cells: Vec<Cell> = cells.collect();
    let mut key = classes.key();
    for what in [Shown::Open, Shown::Weightless].into_iter().filter(|what| shown.contains(what)) {
        key.push((what.name().to_owned(), Sample::Area(what.color())));
    }
    if cells.iter().any(|cell| cell.slides.is_some()) {
        key.push(("slides towards".to_owned(), Sample::Line(Stroke::plain(BLACK))));
    }
    draw(&format!("{title}, {} s", short(frame.time)), &cells, &key)
}

/// The largest pressure under each element during a run on a ground in plan.
pub(super) fn largest_pressures(title: &str, run: &Run) -> Result<Svg> {
    check(run.in_plan)?;
    let largest = |own: &crate::results::ElementEnvelope| own.pressure.highest.value;
    let classes = Classes::to(run.envelope.iter().map(largest).fold(0.0, f64::max));
    let cell = |own: &crate::results::ElementEnvelope| Cell {
        sides: own.element.ends(),
        color: classes.color(largest(own)),
        slides: None,
    };
    let cells: Vec<Cell> = run.envelope.iter().map(cell).collect();
    draw(title, &cells, &classes.key())
}

/// Error for a base in the plane.
fn check(in_plan: bool) -> Result<()> {
    let needed = "a ground of three directions: `mode_map` draws the base in the plane";
    require_part("contact in plan", in_plan, needed)
}

/// Classes of pressure from zero upwards, Pa.
struct Classes {
    step: f64,
    count: f64,
}

impl Classes {
    /// Classes up to the class of the largest pressure.
    fn to(largest: f64) -> Self {
        let largest = if drawable(largest) && largest > 0.0 { largest } else { 1.0 };
        let step = nice(largest / CLASSES);
        Self { step, count: (largest / step).ceil().max(1.0) }
    }

    /// The colour of a pressure; tension has the colour of zero pressure.
    fn color(&self, pressure: f64) -> RGBColor {
        let class = (pressure / self.step).floor().clamp(0.0, self.count - 1.0);
        let ratio = if class.is_nan() { 0.0 } else { class / (self.count - 1.0).max(1.0) };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let [red, green, blue] = [0, 1, 2].map(|k| (PALE[k] + ratio * (DARK[k] - PALE[k])) as u8);
        RGBColor(red, green, blue)
    }

    /// Names of the classes with their colours, the largest first.
    fn key(&self) -> Vec<(String, Sample)> {
        let mut key = Vec::new();
        let mut class = self.count - 1.0;
        while class >= 0.0 {
            let [from, to] = [class, class + 1.0].map(|limit| short(1e-3 * self.step * limit));
            let color = self.color((class + 0.5) * self.step);
            key.push((format!("{from} to {to} kPa"), Sample::Area(color)));
            class -= 1.0;
        }
        key
    }
}

/// Draws cells with one scale on both axes.
fn draw(title: &str, cells: &[Cell], key: &[(String, Sample)]) -> Result<Svg> {
    let sheet = Sheet::new(title, Key::new(key.iter().map(|(name, sample)| (&name[..], *sample))));
    let ends = [0, 1].map(|axis| far_ends(cells.iter().map(|cell| cell.sides[axis])));
    let spans = ends.map(|[low, high]| high - low);
    let margin = MARGIN * spans[0].max(spans[1]);
    let room = sheet.room();
    let pixel = (0..2).map(|k| (spans[k] + 2.0 * margin) / room[k]).fold(0.0, f64::max);
    let range = |axis: usize| -> Range<f64> {
        let (middle, half) = (middle(ends[axis]), 0.5 * pixel * room[axis]);
        middle - half..middle + half
    };
    sheet.picture(|area| {
        let [x, y] = [(0, "x, m"), (1, "y, m")].map(|(k, name)| Axis::linear(range(k), name));
        let mut chart = chart(area, &x, &y, false)?;
        let corners = |cell: &Cell| {
            let [[left, right], [front, back]] = cell.sides;
            [(left, front), (right, back)]
        };
        let fill = |cell| Rectangle::new(corners(cell), cell.color.filled());
        chart.draw_series(cells.iter().map(fill))?;
        let edge = WHITE.stroke_width(1);
        chart.draw_series(cells.iter().map(|cell| Rectangle::new(corners(cell), edge)))?;
        let arrows = cells.iter().filter_map(|cell| Some((cell, cell.slides?)));
        chart.draw_series(arrows.map(|(cell, [dx, dy])| {
            let [x, y] = cell.sides.map(middle);
            let side = cell.sides.iter().fold(f64::INFINITY, |side, [a, b]| side.min(b - a));
            let [length, head] = ARROW.map(|ratio| ratio * side);
            let tip = (x + length * dx, y + length * dy);
            let barb = |turn: f64| {
                let [back, aside] = [head * 0.87, turn * head * 0.5];
                (tip.0 - back * dx - aside * dy, tip.1 - back * dy + aside * dx)
            };
            let foot = (x - length * dx, y - length * dy);
            PathElement::new(vec![foot, tip, barb(1.0), tip, barb(-1.0)], BLACK.stroke_width(1))
        }))?;
        Ok(())
    })
}
