//! Pictures of the base in plan: pressures and modes at an instant, largest pressures of a run.

use std::ops::Range;

use super::axes::{ChartAxis, chart};
use super::classes::Classes;
use super::drawing::Stroke;
use super::element_state::ElementState;
use super::key::{KeySample, PictureKey};
use super::svg::{PictureLayout, Svg};
use super::text_width::short;
use crate::error::{Error, Result, finite, require_part};
use crate::geometry::{ContactElement, middle, span};
use crate::interface::ContactState;
use crate::results::{ElementEnvelope, Run, TimeSeries};
use plotters::prelude::*;

/// Width of the margin around the base, relative to the larger side of the base.
const MARGIN_RATIO: f64 = 0.06;
/// Half the length of an arrow, relative to the shorter side of a cell.
const ARROW_LENGTH_RATIO: f64 = 0.36;
/// Length of the head of an arrow, relative to the shorter side of a cell.
const ARROW_HEAD_RATIO: f64 = 0.15;

/// Cosine of 30 degrees: the head of an arrow is an equilateral triangle.
const BARB_COSINE: f64 = 0.87;

/// A cell to be drawn.
pub(super) struct PlanCell {
    pub(super) corners: Vec<(f64, f64)>,
    pub(super) color: RGBColor,
    /// Arrow in the direction in which the cell slides.
    pub(super) arrow: Option<Arrow>,
}

impl PlanCell {
    /// Cell of a contact element; `slip_direction`: unit vector, `None` unless the element slides.
    fn of_element(
        element: &ContactElement,
        color: RGBColor,
        slip_direction: Option<[f64; 2]>,
    ) -> Self {
        let ends = element.ends();
        let [[left, right], [front, back]] = ends;
        let corners = vec![(left, front), (right, front), (right, back), (left, back)];
        let shorter_side = (right - left).min(back - front);
        let middle = ends.map(middle);
        let arrow = slip_direction.map(|direction| Arrow { middle, direction, shorter_side });
        Self { corners, color, arrow }
    }
}

/// An arrow in the middle of a cell.
pub(super) struct Arrow {
    middle: [f64; 2],
    /// Unit vector.
    direction: [f64; 2],
    /// Shorter side of the cell, m.
    shorter_side: f64,
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
    let nearest = time_series
        .contact_frames()
        .min_by(|a, b| (a.time - time).abs().total_cmp(&(b.time - time).abs()));
    let Some(frame) = nearest else {
        let needed = "the recorder must keep the contact (`Recorder::contact`)";
        return Err(Error::Scene { quantity: "contact in plan", needed });
    };
    check_in_plan(time_series.in_plan())?;
    let max_pressure = frame.states.iter().fold(0.0_f64, |max, state| state.pressure.max(max));
    let classes = Classes::between([0.0, max_pressure]);
    let mut cells = Vec::new();
    let mut drawn_states = Vec::new();
    for (e, element) in time_series.elements().iter().enumerate() {
        let state = &frame.states[e];
        let drawn_state = ElementState::new(frame.modes[e], state, max_pressure);
        let color = match drawn_state {
            ElementState::Open | ElementState::WithoutPressure => drawn_state.color(),
            _ => classes.color(state.pressure),
        };
        let slip_direction = shear_direction(state).filter(|_| drawn_state == ElementState::Slip);
        cells.push(PlanCell::of_element(element, color, slip_direction));
        drawn_states.push(drawn_state);
    }
    let mut key = classes.key(1e-3, " kPa");
    for state in [ElementState::Open, ElementState::WithoutPressure] {
        if drawn_states.contains(&state) {
            key.push((state.name().to_owned(), KeySample::Area(state.color())));
        }
    }
    if cells.iter().any(|cell| cell.arrow.is_some()) {
        key.push(("slides towards".to_owned(), KeySample::Line(Stroke::plain(BLACK))));
    }
    plan_picture(&format!("{title}, {} s", short(frame.time)), &cells, &key)
}

/// Direction of the shear on the soil, a unit vector; `None` without shear.
fn shear_direction(state: &ContactState) -> Option<[f64; 2]> {
    let magnitude = state.shear.hypot(state.shear_across);
    (magnitude > 0.0).then(|| [state.shear / magnitude, state.shear_across / magnitude])
}

/// Picture of the largest pressure under each element during a run on a ground in plan.
pub(super) fn largest_pressures(title: &str, run: &Run) -> Result<Svg> {
    check_in_plan(run.in_plan)?;
    let base_pressure = run.envelope.iter().map(max_pressure).fold(0.0, f64::max);
    let classes = Classes::between([0.0, base_pressure]);
    let mut cells = Vec::new();
    for envelope in &run.envelope {
        let color = classes.color(max_pressure(envelope));
        cells.push(PlanCell::of_element(&envelope.element, color, None));
    }
    plan_picture(title, &cells, &classes.key(1e-3, " kPa"))
}

/// Largest pressure of an element in a run, Pa.
fn max_pressure(envelope: &ElementEnvelope) -> f64 {
    envelope.pressure.highest.value
}

/// Error for a base in the plane.
fn check_in_plan(in_plan: bool) -> Result<()> {
    let needed = "a ground in plan: `mode_map` draws the base in the plane";
    require_part("contact in plan", in_plan, needed)
}

/// Picture of cells with one scale on both axes.
pub(super) fn plan_picture(
    title: &str,
    cells: &[PlanCell],
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
        chart.draw_series(
            cells.iter().map(|cell| Polygon::new(cell.corners.clone(), cell.color.filled())),
        )?;
        chart.draw_series(cells.iter().map(|cell| {
            let outline = cell.corners.iter().chain(cell.corners.first()).copied();
            PathElement::new(outline.collect::<Vec<_>>(), WHITE.stroke_width(1))
        }))?;
        let arrows = cells.iter().filter_map(|cell| cell.arrow.as_ref());
        chart.draw_series(arrows.map(Arrow::path))?;
        Ok(())
    })
}

/// Range of this half width about a middle.
fn range_around(middle: f64, half_width: f64) -> Range<f64> {
    middle - half_width..middle + half_width
}
