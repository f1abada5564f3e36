//! Trench of a base with walls: its cut through the soil, and marks behind its faces.

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

/// Corners (x, height), m, of a mark as long as the element, which reaches a `width` (m) into the soil.
pub(super) fn mark(element: &ContactElement, width: f64) -> [[f64; 2]; 4] {
    let half = 0.5 * element.length();
    [[-half, 0.0], [half, 0.0], [half, width], [-half, width]].map(|[along, into]| {
        let ([x, _, z], [dx, _, dz]) = (element.center(), element.vector([into, along, 0.0]));
        [x + dx, z + dz]
    })
}

#[cfg(test)]
mod tests {
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
