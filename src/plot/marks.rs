//! Marks of contact elements in the colours of their modes, and the key to the colours.

use std::fmt::Write;

use super::shown::{Shown, shown};
use super::svg::{changes, polygon};
use crate::bem::ContactElement;
use crate::results::TimeSeries;
use plotters::style::RGBColor;

/// x of the left end of key, scale and clock, pixels.
pub(super) const ASIDE: f64 = 725.0;
/// Width of a mark behind a face, pixels.
const WIDTH: f64 = 14.0;

pub(super) fn hex(RGBColor(red, green, blue): RGBColor) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The key to the colours of contact modes.
pub(super) fn key(modes: Vec<Shown>) -> String {
    let mut out = String::new();
    for (k, what) in modes.into_iter().enumerate() {
        let y = 80.0 + 26.0 * k as f64;
        let _ = writeln!(
            out,
            "<rect x=\"{ASIDE}\" y=\"{:.0}\" width=\"22\" height=\"14\" fill=\"{}\"/>\
             <text x=\"{}\" y=\"{y:.0}\">{}</text>",
            y - 12.0,
            hex(what.color()),
            ASIDE + 30.0,
            what.name()
        );
    }
    out
}

/// A rectangle for every contact element, coloured by its mode, and the key to the colours.
///
/// Behind its face, or for a flat base at the lower edge.
///
/// `scale`: pixels per metre; `place`: pixels of a place (x, height) in m; `edge`: pixel of the lower edge.
pub(super) fn base(
    time_series: &TimeSeries,
    (scale, place): (f64, impl Fn([f64; 2]) -> [f64; 2]),
    edge: f64,
    (frames, duration): (usize, &str),
) -> String {
    let contact: Vec<_> = time_series.contact_frames().collect();
    if contact.len() != frames {
        return String::new();
    }
    let (shown, modes) = shown(&contact, false);
    let mut out = key(modes);
    let walls = ContactElement::any_wall(time_series.elements());
    for (e, element) in time_series.elements().iter().enumerate() {
        let colors: Vec<String> = shown.iter().map(|modes| hex(modes[e].color())).collect();
        let change = changes("fill", &colors, duration);
        if walls {
            let mark = mark(element, WIDTH / scale).map(&place);
            let _ = writeln!(
                out,
                "<path d=\"{}\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"0.6\">{change}</path>",
                polygon(&mark),
                colors[0]
            );
            continue;
        }
        let [left, _] = place([element.left(), 0.0]);
        let [right, _] = place([element.right(), 0.0]);
        let _ = writeln!(
            out,
            "<rect x=\"{:.1}\" y=\"{}\" width=\"{:.1}\" height=\"14\" fill=\"{}\">{}</rect>",
            left + 0.5,
            edge + 12.0,
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
        let ([x, _, z], [dx, _, dz]) = (element.center(), element.vector([into, along, 0.0]));
        [x + dx, z + dz]
    })
}

#[cfg(test)]
mod tests {
    use super::super::trench::outline;
    use super::*;

    #[test]
    fn marks_lie_in_the_soil() {
        let corners = [[-3.0, 0.0], [-3.0, -5.0], [3.0, -5.0], [3.0, 0.0]];
        let elements: Vec<_> =
            corners.windows(2).map(|ends| ContactElement::wall(ends[0], ends[1])).collect();
        assert_eq!(outline(&elements), Some(corners));
        assert_eq!(outline(&[ContactElement::new(-3.0, 3.0)]), None);
        // Each begins at its face and reaches outwards by the width.
        for (e, far) in [(0, [-3.5, -5.0]), (1, [3.0, -5.5]), (2, [3.5, 0.0])] {
            let mark = mark(&elements[e], 0.5);
            assert_eq!(mark[..2], [corners[e], corners[e + 1]]);
            assert_eq!(mark[2], far);
        }
    }
}
