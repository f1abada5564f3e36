//! Faces of mats, which are convex polygons, and the grouping of faces and cells to mats.

use std::collections::HashMap;

use crate::error::{Error, PlanError, Result};
use crate::geometry::span;
use crate::linalg::Partition;

/// Largest area that two faces may share, relative to the smaller face, because coordinates in files are rounded.
const OVERLAP_TOLERANCE: f64 = 1e-6;
/// Distance below which points touch, relative to the longest edge of a face: above the rounding of coordinates.
const TOUCH_TOLERANCE_FACTOR: f64 = 1e-9;

/// A convex polygon, counter-clockwise seen from above.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MatFace {
    corners: Vec<[f64; 2]>,
    /// Distance below which points touch, m.
    touch_distance: f64,
}

/// Twice the area of the triangle a, b, p; positive if p is to the left of the line from a to b.
pub(crate) fn side([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

impl MatFace {
    /// Creates a face from its corners in either order; `face` is its index, for errors.
    ///
    /// # Errors
    /// [`Error::Item`] of [`Error::Scene`].
    pub(crate) fn new(face: usize, corners: &[[f64; 2]]) -> Result<Self> {
        Self::checked(corners).map_err(|needed| {
            Error::Scene { quantity: "polygon", needed }.within(format!("face {face}"))
        })
    }

    /// Returns the face, or the error text of its corners.
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
        let mut face = Self { corners, touch_distance: 0.0 };
        let longest_edge =
            face.edges().map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1])).fold(0.0, f64::max);
        face.touch_distance = TOUCH_TOLERANCE_FACTOR * longest_edge;
        if area.is_nan() || area <= face.touch_distance * longest_edge {
            return Err("it has no area");
        }
        // All corners lie to the left of all edges only if the line turns left at each corner, and only once in total.
        if face.corners.iter().all(|p| face.contains(*p)) {
            Ok(face)
        } else {
            Err("it is not convex, or crosses itself")
        }
    }

    /// Ends of each edge, counter-clockwise.
    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(a, b)| [*a, *b])
    }

    /// Corners, counter-clockwise, m.
    pub(crate) fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// Distance below which points touch, m.
    pub(crate) fn touch_distance(&self) -> f64 {
        self.touch_distance
    }

    /// Area, m².
    pub(super) fn area(&self) -> f64 {
        area(&self.corners)
    }

    /// Whether a point lies inside or on the edge.
    fn contains(&self, p: [f64; 2]) -> bool {
        self.edges().all(|[a, b]| {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            side([a, b], p) >= -self.touch_distance * length
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
            let widened_bounds = Self::bounds(std::slice::from_ref(face))
                .map(|[min, max]| [min - face.touch_distance, max + face.touch_distance]);
            bounds.push(widened_bounds);
        }
        let mut order: Vec<usize> = (0..faces.len()).collect();
        order.sort_by(|one, other| bounds[*one][0][0].total_cmp(&bounds[*other][0][0]));
        let mut pairs = vec![];
        for (position, &one) in order.iter().enumerate() {
            let x_range = bounds[one][0];
            let y_range = bounds[one][1];
            for &other in &order[position + 1..] {
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
            // Clips the polygon at the line of the edge (Sutherland and Hodgman).
            let mut clipped_corners = Vec::with_capacity(corners.len() + 1);
            for (k, &q) in corners.iter().enumerate() {
                let p = corners[(k + corners.len() - 1) % corners.len()];
                let p_side = side(edge, p);
                let q_side = side(edge, q);
                if (p_side < 0.0) != (q_side < 0.0) {
                    let fraction = p_side / (p_side - q_side);
                    clipped_corners.push([0, 1].map(|k| p[k] + fraction * (q[k] - p[k])));
                }
                if q_side >= 0.0 {
                    clipped_corners.push(q);
                }
            }
            corners = clipped_corners;
        }
        area(&corners)
    }

    /// Smallest and largest coordinates of all `faces`.
    pub(super) fn bounds(faces: &[Self]) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            span(faces.iter().flat_map(|face| &face.corners).map(|corner| corner[axis]))
        })
    }

    /// Index of the mat of each face: faces that touch form one mat.
    pub(crate) fn mats(faces: &[Self]) -> Vec<usize> {
        let mut partition = Partition::new(faces.len());
        for [one, other] in Self::neighbours(faces) {
            if faces[one].touches(&faces[other]) {
                partition.join(one, other);
            }
        }
        let mut face_mats = vec![0; faces.len()];
        for (mat, mat_faces) in partition.sets().into_iter().enumerate() {
            for face in mat_faces {
                face_mats[face] = mat;
            }
        }
        face_mats
    }
}

/// Area of a polygon, positive if its corners run counter-clockwise.
fn area(corners: &[[f64; 2]]) -> f64 {
    0.5 * corners.windows(2).map(|pair| side([pair[0], pair[1]], corners[0])).sum::<f64>()
}

/// Error for cells of two mats side by side or corner to corner.
///
/// `cell_mats`: mat of each cell of the lattice, row by row of `columns`.
pub(super) fn check_apart(
    cell_mats: &[Option<usize>],
    columns: usize,
    pitch: [f64; 2],
) -> Result<()> {
    for (cell, mat) in cell_mats.iter().enumerate() {
        let Some(mat) = mat else { continue };
        let has_left = cell % columns > 0;
        let has_right = cell % columns + 1 < columns;
        // Neighbours on the right, and on the left, in the middle and on the right of the next row.
        let neighbours =
            [(has_right, 1), (has_left, columns - 1), (true, columns), (has_right, columns + 1)];
        for (_, step) in neighbours.into_iter().filter(|(exists, _)| *exists) {
            if let Some(Some(other_mat)) = cell_mats.get(cell + step)
                && other_mat != mat
            {
                return Err(PlanError::TooClose { mats: [*mat, *other_mat], pitch }.into());
            }
        }
    }
    Ok(())
}

/// Sorts cells by mats.
///
/// Mats are in the order of their first cells, and the cells of each mat in the order of `cells`. Cells that touch, also
/// at corners, belong to one mat.
pub(super) fn sort_by_mat(cells: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let cell_indices: HashMap<_, _> =
        cells.iter().enumerate().map(|(k, cell)| (*cell, k)).collect();
    let mut mats = Partition::new(cells.len());
    for (cell, [i, j]) in cells.iter().enumerate() {
        for step in 0..9 {
            let neighbour = [(i + step % 3).checked_sub(1), (j + step / 3).checked_sub(1)];
            let [Some(column), Some(row)] = neighbour else { continue };
            if let Some(&other) = cell_indices.get(&[column, row]) {
                mats.join(cell, other);
            }
        }
    }
    mats.sets().concat().into_iter().map(|cell| cells[cell]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two mats side by side, and a third mat whose rows end between the rows of the two.
    #[test]
    fn cells_of_a_mat_follow_one_another() {
        let sorted_cells = sort_by_mat(&cells("##.###.#.....##.", 4));
        let expected = [[0, 0], [1, 0], [0, 1], [1, 1], [3, 0], [3, 1], [1, 3], [2, 3]];
        assert_eq!(sorted_cells, expected);
        // A ring and cells that share corners are one mat.
        for text in ["####.##.", "#..##..#"] {
            let cells = cells(text, 3);
            assert_eq!(sort_by_mat(&cells), cells, "{text}");
        }
    }

    /// Cells marked by `#` in rows of `columns` characters.
    fn cells(text: &str, columns: usize) -> Vec<[usize; 2]> {
        let marked_cells = text.bytes().enumerate().filter(|(_, mark)| *mark == b'#');
        marked_cells.map(|(index, _)| [index % columns, index / columns]).collect()
    }
}
