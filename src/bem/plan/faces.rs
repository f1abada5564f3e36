//! Faces: convex polygons that form a mat, and the mats of their cells.

use std::collections::HashMap;

use crate::error::{Error, PlanError, Result};
use crate::geometry::span;
use crate::linalg::Partition;

/// Area that two faces may share, relative to the smaller one: rounding of coordinates in files.
const OVERLAP_TOLERANCE: f64 = 1e-6;
/// Distance that counts as touching, relative to the size of a face.
const TOUCHING: f64 = 1e-9;

/// A convex polygon, counter-clockwise seen from above.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Face {
    corners: Vec<[f64; 2]>,
    /// Distance that counts as touching, m.
    near: f64,
}

/// Twice the area of the triangle a, b, p; positive if p is to the left of the line from a to b.
pub(crate) fn side([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

impl Face {
    /// Face number `face` from its corners, in either order.
    ///
    /// # Errors
    /// [`Error::Item`] of [`Error::Scene`].
    pub(crate) fn new(face: usize, corners: &[[f64; 2]]) -> Result<Self> {
        let fault = |needed| {
            let error = Error::Scene { quantity: "polygon", needed };
            Err(error.within(format!("face {face}")))
        };
        if corners.len() < 3 {
            return fault("it has less than three corners");
        }
        if !corners.iter().flatten().all(|x| x.is_finite()) {
            return fault("it has a corner that is not finite");
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
            return fault("it has no area");
        }
        // One turn in all, and never to the right.
        let convex = face.corners.iter().all(|p| face.contains(*p));
        if convex { Ok(face) } else { fault("it is not convex, or crosses itself") }
    }

    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(a, b)| [*a, *b])
    }

    /// Corners, counter-clockwise, m.
    pub(crate) fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// Distance that counts as touching, m.
    pub(crate) fn near(&self) -> f64 {
        self.near
    }

    /// Area, m².
    pub(super) fn area(&self) -> f64 {
        area(&self.corners)
    }

    /// Whether a point lies inside or on the edge.
    fn contains(&self, p: [f64; 2]) -> bool {
        self.edges().all(|[a, b]| {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            side([a, b], p) >= -self.near * length
        })
    }

    /// Whether a corner of one face lies on the other.
    fn touches(&self, other: &Self) -> bool {
        let meets = |one: &Self, two: &Self| one.corners.iter().any(|p| two.contains(*p));
        meets(self, other) || meets(other, self)
    }

    /// Error for two faces that overlap.
    ///
    /// # Errors
    /// [`PlanError::Overlap`].
    pub(crate) fn check_overlap(faces: &[Self]) -> Result<()> {
        for [one, other] in Self::neighbours(faces) {
            let area = faces[one].common_area(&faces[other]);
            if area > OVERLAP_TOLERANCE * faces[one].area().min(faces[other].area()) {
                return Err(PlanError::Overlap { faces: [one, other], area }.into());
            }
        }
        Ok(())
    }

    /// Pairs of faces whose bounding rectangles touch, each in ascending order.
    fn neighbours(faces: &[Self]) -> Vec<[usize; 2]> {
        let bounds: Vec<[[f64; 2]; 2]> = faces
            .iter()
            .map(|face| {
                [0, 1].map(|axis| {
                    let [low, high] = span(face.corners.iter().map(|p| p[axis]));
                    [low - face.near, high + face.near]
                })
            })
            .collect();
        let mut order: Vec<usize> = (0..faces.len()).collect();
        order.sort_by(|one, other| bounds[*one][0][0].total_cmp(&bounds[*other][0][0]));
        let mut pairs = vec![];
        for (place, &one) in order.iter().enumerate() {
            let [[_, right], [front, back]] = bounds[one];
            let beside =
                order[place + 1..].iter().take_while(|other| bounds[**other][0][0] <= right);
            let touching = beside.filter(|other| {
                let [low, high] = bounds[**other][1];
                low <= back && high >= front
            });
            pairs.extend(touching.map(|&other| [one.min(other), one.max(other)]));
        }
        pairs
    }

    /// Area inside both faces, m².
    fn common_area(&self, other: &Self) -> f64 {
        let mut corners = self.corners.clone();
        for edge in other.edges() {
            let mut inner = Vec::with_capacity(corners.len() + 1);
            for (k, &q) in corners.iter().enumerate() {
                let p = corners[(k + corners.len() - 1) % corners.len()];
                let before = side(edge, p);
                let after = side(edge, q);
                if (before < 0.0) != (after < 0.0) {
                    let ratio = before / (before - after);
                    inner.push([0, 1].map(|k| p[k] + ratio * (q[k] - p[k])));
                }
                if after >= 0.0 {
                    inner.push(q);
                }
            }
            corners = inner;
        }
        area(&corners)
    }

    /// Smallest and largest coordinates of all `faces`.
    pub(super) fn bounds(faces: &[Self]) -> [[f64; 2]; 2] {
        let corners = || faces.iter().flat_map(|face| &face.corners);
        [0, 1].map(|axis| {
            let least = corners().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let greatest = corners().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            [least, greatest]
        })
    }

    /// Number of the mat of each face: faces that touch form one mat.
    pub(crate) fn mats(faces: &[Self]) -> Vec<usize> {
        let mut joined = Partition::new(faces.len());
        for [one, other] in Self::neighbours(faces) {
            if faces[one].touches(&faces[other]) {
                joined.join(one, other);
            }
        }
        let mut mats = vec![0; faces.len()];
        for (number, mat) in joined.sets().into_iter().enumerate() {
            for face in mat {
                mats[face] = number;
            }
        }
        mats
    }
}

/// Area of a polygon, positive if its corners run counter-clockwise.
fn area(corners: &[[f64; 2]]) -> f64 {
    0.5 * corners.windows(2).map(|pair| side([pair[0], pair[1]], corners[0])).sum::<f64>()
}

// Cells of mats.

/// Error for cells of two mats side by side or corner to corner.
pub(super) fn apart(owners: &[Option<usize>], columns: usize, pitch: [f64; 2]) -> Result<()> {
    for (place, owner) in owners.iter().enumerate() {
        let Some(owner) = owner else { continue };
        let left = place % columns > 0;
        let right = place % columns + 1 < columns;
        let steps = [(right, 1), (left, columns - 1), (true, columns), (right, columns + 1)];
        for (_, step) in steps.into_iter().filter(|(there, _)| *there) {
            if let Some(Some(other)) = owners.get(place + step)
                && other != owner
            {
                return Err(PlanError::TooClose { mats: [*owner, *other], pitch }.into());
            }
        }
    }
    Ok(())
}

/// Sorts cells by mats.
///
/// Mats come in the order of their first cells, and the cells of each in the given order. Cells that touch, also
/// at corners, belong to one mat.
pub(super) fn mat_by_mat(cells: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let places: HashMap<_, _> = cells.iter().enumerate().map(|(k, cell)| (*cell, k)).collect();
    let mut mats = Partition::new(cells.len());
    for (cell, [i, j]) in cells.iter().enumerate() {
        for step in 0..9 {
            let around = [(i + step % 3).checked_sub(1), (j + step / 3).checked_sub(1)];
            let [Some(column), Some(row)] = around else { continue };
            if let Some(&other) = places.get(&[column, row]) {
                mats.join(cell, other);
            }
        }
    }
    // Mats by their first cells, and the cells of each in the order given.
    mats.sets().concat().into_iter().map(|cell| cells[cell]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two mats beside each other, and a third whose rows end between theirs.
    #[test]
    fn cells_of_a_mat_follow_one_another() {
        let text = ["##.#", "##.#", "....", ".##."];
        let on = |[i, j]: [usize; 2]| text[j].as_bytes()[i] == b'#';
        let all = (0..16).map(|place| [place % 4, place / 4]);
        let cells: Vec<_> = all.filter(|cell| on(*cell)).collect();
        let sorted = mat_by_mat(&cells);
        let expected = [[0, 0], [1, 0], [0, 1], [1, 1], [3, 0], [3, 1], [1, 3], [2, 3]];
        assert_eq!(sorted, expected);
        // A ring and cells that share corners are one mat.
        for text in ["####.##.", "#..##..#"] {
            let on = |place: usize| text.as_bytes()[place] == b'#';
            let cells: Vec<_> = (0..8).filter(|k| on(*k)).map(|k| [k % 3, k / 3]).collect();
            assert_eq!(mat_by_mat(&cells), cells, "{text}");
        }
    }
}
