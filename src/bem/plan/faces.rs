//! Faces: convex polygons that a mat consists of.

use crate::error::{PlanError, Result};

/// Distance that counts as touching, of a face's own size.
const TOUCHING: f64 = 1e-9;

/// A convex polygon, counter-clockwise seen from above.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Face {
    corners: Vec<[f64; 2]>,
    /// Distance that counts as touching, m.
    near: f64,
}

/// Twice the area to the left of the line from a to b that p spans with it.
pub(crate) fn side([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

impl Face {
    /// Face number `face` from its corners, in either order.
    ///
    /// # Errors
    /// [`PlanError::Face`].
    pub(crate) fn new(face: usize, corners: &[[f64; 2]]) -> Result<Self> {
        let fault = |reason| Err(PlanError::Face { face, reason }.into());
        if corners.len() < 3 {
            return fault("has less than three corners");
        }
        if !corners.iter().flatten().all(|x| x.is_finite()) {
            return fault("has a corner that is not finite");
        }
        let mut corners = corners.to_vec();
        let fan = |corners: &[[f64; 2]]| -> f64 {
            corners.windows(2).map(|pair| side([pair[0], pair[1]], corners[0])).sum()
        };
        if fan(&corners) < 0.0 {
            corners.reverse();
        }
        let area = 0.5 * fan(&corners);
        let mut face = Self { corners, near: 0.0 };
        let size = face.edges().map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1])).fold(0.0, f64::max);
        face.near = TOUCHING * size;
        if area.is_nan() || area <= face.near * size {
            return fault("has no area");
        }
        // Round once, and never to the right.
        let convex = face.corners.iter().all(|p| face.contains(*p));
        if convex { Ok(face) } else { fault("is not convex, or crosses itself") }
    }

    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(a, b)| [*a, *b])
    }

    /// Area, m².
    pub(super) fn area(&self) -> f64 {
        let fan = self.corners.windows(2).map(|pair| side([pair[0], pair[1]], self.corners[0]));
        0.5 * fan.sum::<f64>()
    }

    /// Whether a point lies inside or on the edge.
    pub(super) fn contains(&self, p: [f64; 2]) -> bool {
        self.edges().all(|[a, b]| {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            side([a, b], p) >= -self.near * length
        })
    }

    /// Whether a corner of one lies on the other.
    pub(super) fn touches(&self, other: &Self) -> bool {
        let meets = |one: &Self, two: &Self| one.corners.iter().any(|p| two.contains(*p));
        meets(self, other) || meets(other, self)
    }

    /// Least and greatest coordinates of all `faces`.
    pub(super) fn bounds(faces: &[Self]) -> [[f64; 2]; 2] {
        let corners = || faces.iter().flat_map(|face| &face.corners);
        [0, 1].map(|axis| {
            let least = corners().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let greatest = corners().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            [least, greatest]
        })
    }

    /// Number of the mat that each face belongs to: faces that touch are of one mat.
    pub(crate) fn mats(faces: &[Self]) -> Vec<usize> {
        let mut mats = vec![usize::MAX; faces.len()];
        let mut count = 0;
        for first in 0..faces.len() {
            if mats[first] != usize::MAX {
                continue;
            }
            mats[first] = count;
            let mut stack = vec![first];
            while let Some(face) = stack.pop() {
                for other in 0..faces.len() {
                    if mats[other] == usize::MAX && faces[face].touches(&faces[other]) {
                        mats[other] = count;
                        stack.push(other);
                    }
                }
            }
            count += 1;
        }
        mats
    }
}
