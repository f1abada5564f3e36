//! Pictures of the base in plan: pressures and modes at an instant, largest pressures of a run.

use super::cells::{Arrow, PictureCell, cell_picture};
use super::classes::Classes;
use super::drawing::Stroke;
use super::element_state::ElementState;
use super::key::KeySample;
use super::svg::Svg;
use super::text_width::short;
use crate::error::{Error, Result, finite, require_part};
use crate::geometry::{ContactElement, middle};
use crate::interface::ContactState;
use crate::results::{ElementEnvelope, Run, TimeSeries};
use plotters::prelude::*;

/// Cell of a contact element; `slip_direction`: unit vector, `None` unless the element slides.
fn element_cell(
    element: &ContactElement,
    color: RGBColor,
    slip_direction: Option<[f64; 2]>,
) -> PictureCell {
    let ends = element.ends();
    let [[left, right], [front, back]] = ends;
    let corners = vec![(left, front), (right, front), (right, back), (left, back)];
    let shorter_side = (right - left).min(back - front);
    let middle = ends.map(middle);
    let arrow = slip_direction.map(|direction| Arrow { middle, direction, shorter_side });
    PictureCell { corners, color: Some(color), arrow }
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
    let nearest_frame = time_series
        .contact_frames()
        .min_by(|a, b| (a.time - time).abs().total_cmp(&(b.time - time).abs()));
    let Some(frame) = nearest_frame else {
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
        cells.push(element_cell(element, color, slip_direction));
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
    cell_picture(&format!("{title}, {} s", short(frame.time)), &cells, &key)
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
        cells.push(element_cell(&envelope.element, color, None));
    }
    cell_picture(title, &cells, &classes.key(1e-3, " kPa"))
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
