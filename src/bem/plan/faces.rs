//! Faces: convex polygons that form a mat, and the mats of their cells.

use std::collections::HashMap;

use crate::error::{Error, PlanError, Result};
use crate::geometry::span;
use crate::linalg::Partition;

/// Area that two faces may share, relative to the smaller one: rounding of coordinates in files.
const OVERLAP_TOLERANCE: f64 = 1e-6;
/// Distance that counts as touching, relative to the size of a face.
const TOUCH_TOLERANCE_FACTOR: f64 = 1e-9;

/// A convex polygon, counter-clockwise seen from above.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MatFace {
    corners: Vec<[f64; 2]>,
    /// Distance that counts as touching, m.
    near: f64,
}

/// Twice the area of the triangle a, b, p; positive if p is to the left of the line from a to b.
pub(crate) fn side([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

impl MatFace {
    /// Face number `face` from its corners, in either order.
    ///
    /// # Errors
    /// [`Error::Item`] of [`Error::Scene`].
    pub(crate) fn new(face: usize, corners: &[[f64; 2]]) -> Result<Self> {
        Self::checked(corners).map_err(|needed| {
            Error::Scene { quantity: "polygon", needed }.within(format!("face {face}"))
        })
    }

    /// The face, or the fault of its corners.
    fn checked(corners: &[[f64; 2]]) -> std::result::Result<Self, &'static str> {
        if corners.len() < 3 {
            return Err("it has less than three corners");
        }
        if !corners.iter().flatten().all(|x| x.is_finite()) {
            return Err("it has a corner that is not finite");
        }
        let mut corners = corners.to_vec();
        if area(&corners) < 0.0 {
            corners.reverse();
        }
        let area = area(&corners);
        let mut face = Self { corners, near: 0.0 };
        let size = face.edges().map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1])).fold(0.0, f64::max);
        face.near = TOUCH_TOLERANCE_FACTOR * size;
        if area.is_nan() || area <= face.near * size {
            return Err("it has no area");
        }
        // All corners lie to the left of all edges only if the line turns left everywhere, and once in all.
        if face.corners.iter().all(|p| face.contains(*p)) {
            Ok(face)
        } else {
            Err("it is not convex, or crosses itself")
        }
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
        self.corners.iter().any(|p| other.contains(*p))
            || other.corners.iter().any(|p| self.contains(*p))
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
        let mut bounds: Vec<[[f64; 2]; 2]> = Vec::with_capacity(faces.len());
        for face in faces {
            let widened = Self::bounds(std::slice::from_ref(face))
                .map(|[low, high]| [low - face.near, high + face.near]);
            bounds.push(widened);
        }
        let mut order: Vec<usize> = (0..faces.len()).collect();
        order.sort_by(|one, other| bounds[*one][0][0].total_cmp(&bounds[*other][0][0]));
        let mut pairs = vec![];
        for (place, &one) in order.iter().enumerate() {
            let x_range = bounds[one][0];
            let y_range = bounds[one][1];
            for &other in &order[place + 1..] {
                if bounds[other][0][0] > x_range[1] {
                    break;
                }
                let other_y_range = bounds[other][1];
                if other_y_range[0] <= y_range[1] && other_y_range[1] >= y_range[0] {
                    pairs.push([one.min(other), one.max(other)]);
                }
            }
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
        [0, 1].map(|axis| {
            span(faces.iter().flat_map(|face| &face.corners).map(|corner| corner[axis]))
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
pub(super) fn check_apart(owners: &[Option<usize>], columns: usize, pitch: [f64; 2]) -> Result<()> {
    for (place, owner) in owners.iter().enumerate() {
        let Some(owner) = owner else { continue };
        let has_left = place % columns > 0;
        let has_right = place % columns + 1 < columns;
        // Neighbours on the right, and on the left, in the middle and on the right of the next row.
        let neighbours =
            [(has_right, 1), (has_left, columns - 1), (true, columns), (has_right, columns + 1)];
        for (_, step) in neighbours.into_iter().filter(|(exists, _)| *exists) {
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
/// Mats come in the order of their first cells, and the cells of each in the order of the list. Cells that touch, also
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
    mats.sets().concat().into_iter().map(|cell| cells[cell]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two mats beside each other, and a third whose rows end between theirs.
    #[test]
    fn cells_of_a_mat_follow_one_another() {
        let sorted = mat_by_mat(&cells("##.###.#.....##.", 4));
        let expected = [[0, 0], [1, 0], [0, 1], [1, 1], [3, 0], [3, 1], [1, 3], [2, 3]];
        assert_eq!(sorted, expected);
        // A ring and cells that share corners are one mat.
        for text in ["####.##.", "#..##..#"] {
            let cells = cells(text, 3);
            assert_eq!(mat_by_mat(&cells), cells, "{text}");
        }
    }

    /// Cells marked by `#` in rows of `columns` characters.
    fn cells(text: &str, columns: usize) -> Vec<[usize; 2]> {
        let marked = text.bytes().enumerate().filter(|(_, mark)| *mark == b'#');
        marked.map(|(place, _)| [place % columns, place / columns]).collect()
    }
}
