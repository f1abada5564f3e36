//! Marks of contact elements in the colours of their modes, and the key to the colours.

use std::fmt::Write;

use super::shown::{ElementState, ShownStates};
use super::svg::{changes, polygon};
use crate::bem::ContactElement;
use crate::results::TimeSeries;
use plotters::style::RGBColor;

/// x of the left end of key, scale and clock, pixels.
pub(super) const KEY_LEFT: f64 = 725.0;
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

/// The key to the colours of contact modes.
pub(super) fn key(states: Vec<ElementState>) -> String {
    let mut out = String::new();
    for (k, state) in states.into_iter().enumerate() {
        let y = 80.0 + 26.0 * k as f64;
        let _ = writeln!(
            out,
            "<rect x=\"{KEY_LEFT}\" y=\"{:.0}\" width=\"22\" height=\"14\" fill=\"{}\"/>\
             <text x=\"{}\" y=\"{y:.0}\">{}</text>",
            y - 12.0,
            hex(state.color()),
            KEY_LEFT + 30.0,
            state.name()
        );
    }
    out
}

/// A rectangle for every contact element, coloured by its mode, and the key to the colours.
///
/// Behind its face, or for a flat base at the lower edge.
///
/// `scale`: pixels per metre; `to_pixels`: pixels of a place (x, height) in m; `lower_edge`: its pixel; `frames`: number of
/// frames of the animation; `duration`: as SMIL writes it.
pub(super) fn base(
    time_series: &TimeSeries,
    scale: f64,
    to_pixels: impl Fn([f64; 2]) -> [f64; 2],
    lower_edge: f64,
    frames: usize,
    duration: &str,
) -> String {
    let contact: Vec<_> = time_series.contact_frames().collect();
    if contact.len() != frames {
        return String::new();
    }
    let states = ShownStates::new(&contact, false);
    let mut out = key(states.in_key);
    let has_walls = ContactElement::any_wall(time_series.elements());
    for (e, element) in time_series.elements().iter().enumerate() {
        let colors: Vec<String> =
            states.by_frame.iter().map(|frame| hex(frame[e].color())).collect();
        let change = changes("fill", &colors, duration);
        if has_walls {
            let mark = mark(element, MARK_WIDTH / scale).map(&to_pixels);
            let _ = writeln!(
                out,
                "<path d=\"{}\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"0.6\">{change}</path>",
                polygon(&mark),
                colors[0]
            );
            continue;
        }
        let left = to_pixels([element.left(), 0.0])[0];
        let right = to_pixels([element.right(), 0.0])[0];
        let _ = writeln!(
            out,
            "<rect x=\"{:.1}\" y=\"{}\" width=\"{:.1}\" height=\"14\" fill=\"{}\">{}</rect>",
            left + 0.5,
            lower_edge + 12.0,
            (right - left - 1.0).max(0.5),
            colors[0],
            change
        );
    }
    out
}

/// Corners (x, height), m, of a mark as long as the element, which reaches a `width` (m) into the soil.
fn mark(element: &ContactElement, width: f64) -> [[f64; 2]; 4] {
    let half = 0.5 * element.length();
    [[-half, 0.0], [half, 0.0], [half, width], [-half, width]].map(|[along, into]| {
        let center = element.center();
        let from_center = element.vector([into, along, 0.0]);
        [center[0] + from_center[0], center[2] + from_center[2]]
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
        // Each begins at its face and reaches outwards by the width.
        for (e, far) in [(0, [-3.5, -5.0]), (1, [3.0, -5.5]), (2, [3.5, 0.0])] {
            let mark = mark(&elements[e], 0.5);
            assert_eq!(mark[..2], [corners[e], corners[e + 1]]);
            assert_eq!(mark[2], far);
        }
    }
}
