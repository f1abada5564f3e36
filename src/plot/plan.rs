//! The base in plan: pressures and modes of its cells at an instant, and the largest pressures of a run.

use std::ops::Range;

use super::axes::{Axis, chart};
use super::classes::Classes;
use super::drawing::Stroke;
use super::key::{Key, Sample};
use super::shown::Shown;
use super::svg::{Sheet, Svg};
use super::text_width::short;
use crate::error::{Error, Result, finite, require_part};
use crate::geometry::{ContactElement, middle, span};
use crate::interface::ContactState;
use crate::results::{Run, TimeSeries};
use plotters::prelude::*;

/// Width of the frame around the base, relative to its larger side.
const MARGIN: f64 = 0.06;
/// Length of an arrow and of its head, relative to the shorter side of a cell.
const ARROW: [f64; 2] = [0.36, 0.15];

/// A cell to be drawn: its corners, its colour, and where it slides.
pub(super) struct Cell {
    pub(super) corners: Vec<(f64, f64)>,
    pub(super) color: RGBColor,
    pub(super) slides: Option<Arrow>,
}

impl Cell {
    /// A contact element, which moves in the direction `slides`.
    fn of_element(element: &ContactElement, color: RGBColor, slides: Option<[f64; 2]>) -> Self {
        let sides @ [[left, right], [front, back]] = element.ends();
        let corners = vec![(left, front), (right, front), (right, back), (left, back)];
        let side = (right - left).min(back - front);
        let arrow = |direction| Arrow { middle: sides.map(middle), direction, side };
        Self { corners, color, slides: slides.map(arrow) }
    }
}

/// An arrow in a cell whose shorter side is known, m; the direction is a unit vector.
pub(super) struct Arrow {
    middle: [f64; 2],
    direction: [f64; 2],
    side: f64,
}

impl Arrow {
    fn drawn(&self) -> PathElement<(f64, f64)> {
        let ([x, y], [dx, dy]) = (self.middle, self.direction);
        let [length, head] = ARROW.map(|ratio| ratio * self.side);
        let tip = (x + length * dx, y + length * dy);
        let barb = |turn: f64| {
            let [back, aside] = [head * 0.87, turn * head * 0.5];
            (tip.0 - back * dx - aside * dy, tip.1 - back * dy + aside * dx)
        };
        let foot = (x - length * dx, y - length * dy);
        PathElement::new(vec![foot, tip, barb(1.0), tip, barb(-1.0)], BLACK.stroke_width(1))
    }
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
    let classes = Classes::between([0.0, largest]);
    let both = frame.states.iter().zip(frame.modes);
    let shown: Vec<_> = both.map(|(state, mode)| Shown::new(*mode, state, largest)).collect();
    let slides = |state: &ContactState, shown: Shown| {
        let size = state.shear.hypot(state.shear_across);
        (shown == Shown::Slip && size > 0.0)
            .then(|| [state.shear / size, state.shear_across / size])
    };
    let elements = time_series.elements().iter();
    let cells = elements.zip(frame.states.iter().zip(&shown)).map(|(element, (state, what))| {
        let color = match what {
            Shown::Open | Shown::Weightless => what.color(),
            _ => classes.color(state.pressure),
        };
        Cell::of_element(element, color, slides(state, *what))
    });
    let cells: Vec<Cell> = cells.collect();
    let mut key = classes.key(1e-3, " kPa");
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
    let classes = Classes::between([0.0, run.envelope.iter().map(largest).fold(0.0, f64::max)]);
    let cell = |own: &crate::results::ElementEnvelope| {
        Cell::of_element(&own.element, classes.color(largest(own)), None)
    };
    let cells: Vec<Cell> = run.envelope.iter().map(cell).collect();
    draw(title, &cells, &classes.key(1e-3, " kPa"))
}

/// Error for a base in the plane.
fn check(in_plan: bool) -> Result<()> {
    let needed = "a ground of three directions: `mode_map` draws the base in the plane";
    require_part("contact in plan", in_plan, needed)
}

/// Draws cells with one scale on both axes.
pub(super) fn draw(title: &str, cells: &[Cell], key: &[(String, Sample)]) -> Result<Svg> {
    let sheet = Sheet::new(title, Key::new(key.iter().map(|(name, sample)| (&name[..], *sample))));
    let corners = || cells.iter().flat_map(|cell| &cell.corners);
    let ends = [span(corners().map(|corner| corner.0)), span(corners().map(|corner| corner.1))];
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
        let fill = |cell: &Cell| Polygon::new(cell.corners.clone(), cell.color.filled());
        chart.draw_series(cells.iter().map(fill))?;
        let edge = |cell: &Cell| {
            let closed = cell.corners.iter().chain(cell.corners.first()).copied();
            PathElement::new(closed.collect::<Vec<_>>(), WHITE.stroke_width(1))
        };
        chart.draw_series(cells.iter().map(edge))?;
        let arrows = cells.iter().filter_map(|cell| cell.slides.as_ref());
        chart.draw_series(arrows.map(Arrow::drawn))?;
        Ok(())
    })
}
