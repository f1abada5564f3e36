//! Boundary of a mat: the closed lines around the union of its faces.
//!
//! Edges that two faces share cancel, also if corners of one face divide the edge of the other. Corners on straight lines
//! are removed. The lines therefore depend only on the outline, and not on the division into faces.

use std::collections::HashMap;

use super::faces::{MatFace, side};
use super::points::{Point, PointIndex, without_pairs};

/// Largest shift of a corner relative to the shift of its edges; sharper corners are cut off at this distance.
const MAX_CORNER_SHIFT: f64 = 3.0;
/// Largest sine of the angle between two edges on one line, because coordinates in files are rounded.
const MAX_STRAIGHT_SINE: f64 = 1e-6;

/// Closed lines with the mat to their left: counter-clockwise around it, clockwise around its holes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MatBoundary {
    pub(super) loops: Vec<Vec<Point>>,
}

/// Edge that is shifted outwards, parallel to itself.
#[derive(Clone, Copy)]
struct ShiftedEdge {
    /// End before the shift, m.
    end: Point,
    /// Length before the shift, m.
    length: f64,
    /// Unit vector from start to end.
    direction: Point,
    /// Outward distance of the shift, m.
    distance: f64,
}

impl MatBoundary {
    /// Boundary of each mat; faces that touch form one mat.
    pub(super) fn of_mats(faces: &[MatFace]) -> Vec<Self> {
        let face_mats = MatFace::mats(faces);
        let mat_count = face_mats.iter().max().map_or(0, |last| last + 1);
        let mut mat_faces = vec![vec![]; mat_count];
        for (face, mat) in faces.iter().zip(face_mats) {
            mat_faces[mat].push(face);
        }
        mat_faces.iter().map(|faces| Self::of_mat(faces)).collect()
    }

    /// Boundary of the faces of one mat.
    fn of_mat(faces: &[&MatFace]) -> Self {
        let touch_distance = faces.iter().map(|face| face.touch_distance()).fold(0.0, f64::max);
        let mut points = PointIndex::new(touch_distance);
        let mut edges = vec![];
        for face in faces {
            let corners: Vec<_> =
                face.corners().iter().map(|corner| points.index_of(*corner)).collect();
            for k in 0..corners.len() {
                edges.push([corners[k], corners[(k + 1) % corners.len()]]);
            }
        }
        // Pieces of edges between neighbouring points on the edges.
        let mut pieces = vec![];
        for edge_points in points.on_edges(&without_pairs(edges)) {
            pieces.extend(edge_points.windows(2).map(|pair| [pair[0].1, pair[1].1]));
        }
        let mut loops = closed_lines(&points, without_pairs(pieces));
        // The order depends on the corners alone: first their number, then their coordinates.
        loops.sort_by(|one, other| {
            let coordinates = one.iter().flatten().zip(other.iter().flatten());
            coordinates
                .fold(one.len().cmp(&other.len()), |order, (x, y)| order.then(x.total_cmp(y)))
        });
        Self { loops }
    }

    /// Ends of each edge.
    fn edges(&self) -> impl Iterator<Item = [Point; 2]> {
        self.loops.iter().flat_map(|corners| {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).map(|(a, b)| [*a, *b])
        })
    }

    /// Area inside, m².
    pub(super) fn area(&self) -> f64 {
        let Some(&origin) = self.loops.iter().flatten().next() else { return 0.0 };
        0.5 * self.edges().map(|edge| side(edge, origin)).sum::<f64>()
    }

    /// Closed lines with edges shifted outwards, by a distance (m) that depends on the edge's unit normal.
    ///
    /// A point is inside if the lines turn about it counter-clockwise at least once. Sharp corners are cut off at three
    /// times the distance.
    pub(super) fn shifted_outwards(&self, edge_shift: impl Fn(Point) -> f64) -> Vec<Vec<Point>> {
        let mut shifted_loops = Vec::with_capacity(self.loops.len());
        for corners in &self.loops {
            let mut edges = Vec::with_capacity(corners.len());
            for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                let direction = [0, 1].map(|k| (b[k] - a[k]) / length);
                let distance = edge_shift([direction[1], -direction[0]]);
                edges.push(ShiftedEdge { end: *b, length, direction, distance });
            }
            let mut shifted_corners = vec![];
            for (edge, next) in edges.iter().zip(edges.iter().cycle().skip(1)) {
                shifted_corners.extend(edge.corners_to(next));
            }
            shifted_loops.push(shifted_corners);
        }
        shifted_loops
    }
}

impl ShiftedEdge {
    /// Point on the line of the shifted edge, at a `distance_along` (m) from the edge's original `corner`.
    fn shifted_point(&self, corner: Point, distance_along: f64) -> Point {
        let normal = [self.direction[1], -self.direction[0]];
        [0, 1].map(|k| corner[k] + self.distance * normal[k] + distance_along * self.direction[k])
    }

    /// Corners between this edge and the next edge, both shifted outwards.
    ///
    /// In general there is one corner, where the shifted edges meet. If an edge is too short for this, or the corner too
    /// sharp, both edges end before they meet. A salient corner is then cut off, and edges at a reentrant corner cross
    /// each other.
    fn corners_to(&self, next: &Self) -> Vec<Point> {
        let corner = self.end;
        let sine = self.direction[0] * next.direction[1] - self.direction[1] * next.direction[0];
        let cosine = self.direction[0] * next.direction[0] + self.direction[1] * next.direction[1];
        if sine.abs() <= MAX_STRAIGHT_SINE {
            return vec![self.shifted_point(corner, 0.0), next.shifted_point(corner, 0.0)];
        }
        // Extensions of this edge beyond its end, and of the next edge before its start, to their intersection.
        let extension = (next.distance - self.distance * cosine) / sine;
        let next_extension = (self.distance - next.distance * cosine) / sine;
        let max_extension =
            (MAX_CORNER_SHIFT * MAX_CORNER_SHIFT - 1.0).sqrt() * self.distance.max(next.distance);
        let fraction = self
            .allowed_fraction(extension, max_extension)
            .min(next.allowed_fraction(next_extension, max_extension));
        // The fraction of edges without a shift is 0/0.
        if fraction.is_nan() || fraction >= 1.0 {
            return vec![self.shifted_point(corner, extension)];
        }
        let edge_end = self.shifted_point(corner, fraction * extension);
        let next_start = next.shifted_point(corner, -fraction * next_extension);
        if sine > 0.0 {
            vec![edge_end, next_start]
        } else {
            vec![edge_end, corner, next_start]
        }
    }

    /// Largest allowed fraction of an extension, with which the edge loses at most half its length.
    fn allowed_fraction(&self, extension: f64, max_extension: f64) -> f64 {
        let allowed_extension = if extension < 0.0 { 0.5 * self.length } else { max_extension };
        allowed_extension / extension.abs()
    }
}

/// Closed lines of these edges.
///
/// If several edges start at a point, the line continues with the leftmost turn, along its part of the mat.
fn closed_lines(points: &PointIndex, edges: Vec<[usize; 2]>) -> Vec<Vec<Point>> {
    let mut edge_ends: HashMap<usize, Vec<usize>> = HashMap::new();
    for &[start, end] in &edges {
        edge_ends.entry(start).or_default().push(end);
    }
    let mut lines = vec![];
    for [start, end] in edges {
        let Some(ends) = edge_ends.get_mut(&start) else { continue };
        let Some(position) = ends.iter().position(|candidate| *candidate == end) else {
            continue;
        };
        ends.swap_remove(position);
        let mut line = vec![start, end];
        while let [_, second, ..] = line[..]
            && let [.., previous, current] = line[..]
            && let Some(ends) = edge_ends.get_mut(&current)
        {
            let last_edge = [points.point(previous), points.point(current)];
            let turn = |end: usize| clockwise_angle(last_edge, points.point(end));
            let Some(leftmost) = (0..ends.len())
                .min_by(|one, other| turn(ends[*one]).total_cmp(&turn(ends[*other])))
            else {
                break;
            };
            if current == start && turn(second) <= turn(ends[leftmost]) {
                break;
            }
            line.push(ends.swap_remove(leftmost));
        }
        line.pop();
        lines.push(line);
    }
    lines.iter().filter_map(|line| corners(points, line)).collect()
}

/// Corners of a closed line, from the lowest of its leftmost corners; `None` if the line encloses no area.
fn corners(points: &PointIndex, line: &[usize]) -> Option<Vec<Point>> {
    let line_points: Vec<Point> = line.iter().map(|index| points.point(*index)).collect();
    let start = (0..line_points.len()).min_by(|one, other| {
        let one = line_points[*one];
        let other = line_points[*other];
        if (one[0] - other[0]).abs() <= points.touch_distance() {
            one[1].total_cmp(&other[1])
        } else {
            one[0].total_cmp(&other[0])
        }
    })?;
    let mut corners = vec![line_points[start]];
    for k in 1..line_points.len() {
        let point = line_points[(start + k) % line_points.len()];
        let next_point = line_points[(start + k + 1) % line_points.len()];
        let last_corner = corners[corners.len() - 1];
        if points.position_on_edge([last_corner, next_point], point).is_none() {
            corners.push(point);
        }
    }
    (corners.len() > 2).then_some(corners)
}

/// Angle at the second point from the first point clockwise to `end`, above 0 and up to 2π.
fn clockwise_angle([first, second]: [Point; 2], end: Point) -> f64 {
    let first_angle = (first[1] - second[1]).atan2(first[0] - second[0]);
    let end_angle = (end[1] - second[1]).atan2(end[0] - second[0]);
    let angle = (first_angle - end_angle).rem_euclid(std::f64::consts::TAU);
    if angle > 0.0 { angle } else { std::f64::consts::TAU }
}
