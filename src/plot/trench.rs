//! Trench of a base with walls: its outline in the soil.

use crate::bem::ContactElement;
use crate::geometry::far_ends;

/// Outline of the trench (x, height), m, from its upper left corner; `None` without walls.
pub(super) fn outline(elements: &[ContactElement]) -> Option<[[f64; 2]; 4]> {
    ContactElement::any_wall(elements).then(|| {
        let [left, right] = far_ends(elements.iter().map(|own| own.ends()[0]));
        let [bottom, top] = far_ends(elements.iter().map(ContactElement::heights));
        [[left, top], [left, bottom], [right, bottom], [right, top]]
    })
}
