//! Marks of contact elements in the colours of their modes, and the key to the colours.

use std::fmt::Write;

use super::element_state::{ElementState, ElementStates};
use super::svg::{discrete_animation, polygon};
use crate::bem::ContactElement;
use crate::results::TimeSeries;
use plotters::style::RGBColor;

/// x of the left end of key, scale and clock, pixels.
pub(super) const KEY_LEFT: f64 = 725.0;
/// y of the first line of the key, pixels.
const KEY_TOP: f64 = 80.0;
/// Height of a line of the key, pixels.
const KEY_LINE_HEIGHT: f64 = 26.0;

/// A rectangle of the picture, pixels.
pub(super) struct PixelBox {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

/// Width of a mark behind a face, pixels.
const MARK_WIDTH: f64 = 14.0;

/// A colour as SVG writes it.
pub(super) fn hex(RGBColor(red, green, blue): RGBColor) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The key to the colours of contact modes, as SVG.
pub(super) fn color_key(states: Vec<ElementState>) -> String {
    let mut svg_text = String::new();
    for (k, state) in states.into_iter().enumerate() {
        let y = KEY_TOP + KEY_LINE_HEIGHT * k as f64;
        let _ = writeln!(
            svg_text,
            "<rect x=\"{KEY_LEFT}\" y=\"{:.0}\" width=\"22\" height=\"14\" fill=\"{}\"/>\
             <text x=\"{}\" y=\"{y:.0}\">{}</text>",
            y - 12.0,
            hex(state.color()),
            KEY_LEFT + 30.0,
            state.name()
        );
    }
    svg_text
}

/// Marks of all contact elements, coloured by their modes, and the key to the colours, as SVG.
///
/// With walls the marks lie behind the faces of the elements, otherwise at the lower edge of the picture.
///
/// `scale`: pixels per metre; `to_pixels`: pixels of a point (x, height) in m; `lower_edge`: of the picture, pixels;
/// `frame_count`: of the animation; `duration`: of the animation, as in SMIL. Empty unless there is a frame of contact for
/// every frame of the animation.
pub(super) fn element_marks(
    time_series: &TimeSeries,
    scale: f64,
    to_pixels: impl Fn([f64; 2]) -> [f64; 2],
    lower_edge: f64,
    frame_count: usize,
    duration: &str,
) -> String {
    let contact: Vec<_> = time_series.contact_frames().collect();
    if contact.len() != frame_count {
        return String::new();
    }
    let states = ElementStates::new(&contact, false);
    let mut svg_text = color_key(states.key_states);
    let has_walls = ContactElement::any_wall(time_series.elements());
    for (e, element) in time_series.elements().iter().enumerate() {
        let colors: Vec<String> =
            states.frame_states.iter().map(|frame| hex(frame[e].color())).collect();
        let color_changes = discrete_animation("fill", &colors, duration);
        if has_walls {
            let mark = mark_corners(element, MARK_WIDTH / scale).map(&to_pixels);
            let _ = writeln!(
                svg_text,
                "<path d=\"{}\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"0.6\">{color_changes}</path>",
                polygon(&mark),
                colors[0]
            );
            continue;
        }
        let left = to_pixels([element.left(), 0.0])[0];
        let right = to_pixels([element.right(), 0.0])[0];
        let _ = writeln!(
            svg_text,
            "<rect x=\"{:.1}\" y=\"{}\" width=\"{:.1}\" height=\"14\" fill=\"{}\">{}</rect>",
            left + 0.5,
            lower_edge + 12.0,
            (right - left - 1.0).max(0.5),
            colors[0],
            color_changes
        );
    }
    svg_text
}

/// Corners (x, height), m, of a mark of the element's length and of this `width` (m) into the soil.
fn mark_corners(element: &ContactElement, width: f64) -> [[f64; 2]; 4] {
    let half_length = 0.5 * element.length();
    let local_corners =
        [[-half_length, 0.0], [half_length, 0.0], [half_length, width], [-half_length, width]];
    local_corners.map(|[tangential, depth]| {
        let center = element.center();
        let offset = element.vector([depth, tangential, 0.0]);
        [center[0] + offset[0], center[2] + offset[2]]
    })
}

#[cfg(test)]
mod tests {
    use super::super::deformed::trench_outline;
    use super::*;

    #[test]
    fn marks_lie_in_the_soil() {
        let corners = [[-3.0, 0.0], [-3.0, -5.0], [3.0, -5.0], [3.0, 0.0]];
        let elements: Vec<_> =
            corners.windows(2).map(|ends| ContactElement::wall(ends[0], ends[1])).collect();
        assert_eq!(trench_outline(&elements), Some(corners));
        assert_eq!(trench_outline(&[ContactElement::new(-3.0, 3.0)]), None);
        // Each mark begins at its face and extends outwards by the width.
        for (e, outer_corner) in [(0, [-3.5, -5.0]), (1, [3.0, -5.5]), (2, [3.5, 0.0])] {
            let mark = mark_corners(&elements[e], 0.5);
            assert_eq!(mark[..2], [corners[e], corners[e + 1]]);
            assert_eq!(mark[2], outer_corner);
        }
    }
}
