//! Trench of a base with walls: its outline in the soil.

use crate::bem::ContactElement;
use crate::geometry::far_ends;

/// Outline of the trench (x, height), m, from its upper left corner; `None` without walls.
pub(super) fn outline(elements: &[ContactElement]) -> Option<[[f64; 2]; 4]> {
    if !ContactElement::any_wall(elements) {
        return None;
    }
    let x = far_ends(elements.iter().map(|element| element.ends()[0]));
    let z = far_ends(elements.iter().map(ContactElement::heights));
    Some([[x[0], z[1]], [x[0], z[0]], [x[1], z[0]], [x[1], z[1]]])
}
