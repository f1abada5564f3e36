//! Boundary of a mat: the closed lines around the union of its faces.
//!
//! Edges that two faces share cancel, also where corners of one face divide the edge of another, and corners on straight
//! lines are left out. The lines therefore depend on the outline alone, whatever the faces that fill it.

use std::collections::HashMap;

use super::faces::{MatFace, side};
use super::points::{Point, PointIndex, without_pairs};

/// Largest distance by which sharp corners move, relative to the distance of their edges.
const MAX_CORNER_MOVE: f64 = 3.0;
/// Sine of the angle between two edges that count as one.
const STRAIGHT_SINE: f64 = 1e-6;

/// Closed lines with the mat to their left: counter-clockwise around it, clockwise around its holes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MatBoundary {
    pub(super) loops: Vec<Vec<Point>>,
}

/// Edge with its length, direction and outward distance.
#[derive(Clone, Copy)]
struct MovedEdge {
    end: Point,
    length: f64,
    direction: Point,
    distance: f64,
}

impl MatBoundary {
    /// Boundary of each mat: faces that touch form one.
    pub(super) fn of_mats(faces: &[MatFace]) -> Vec<Self> {
        let mats = MatFace::mats(faces);
        let count = mats.iter().max().map_or(0, |last| last + 1);
        let mut faces_of_mats = vec![vec![]; count];
        for (face, mat) in faces.iter().zip(mats) {
            faces_of_mats[mat].push(face);
        }
        faces_of_mats.iter().map(|faces| Self::of(faces)).collect()
    }

    /// Boundary of some faces, the faces of one mat.
    fn of(faces: &[&MatFace]) -> Self {
        let near = faces.iter().map(|face| face.near()).fold(0.0, f64::max);
        let mut points = PointIndex::new(near);
        let mut edges = vec![];
        for face in faces {
            let corners: Vec<_> =
                face.corners().iter().map(|corner| points.number(*corner)).collect();
            for k in 0..corners.len() {
                edges.push([corners[k], corners[(k + 1) % corners.len()]]);
            }
        }
        // Parts of edges between neighbouring points on them.
        let mut parts = vec![];
        for on_edge in points.on_edges(&without_pairs(edges)) {
            parts.extend(on_edge.windows(2).map(|pair| [pair[0].1, pair[1].1]));
        }
        let mut loops = closed_lines(&points, without_pairs(parts));
        loops.sort_by(|one, other| {
            let corners = one.iter().flatten().zip(other.iter().flatten());
            corners.fold(one.len().cmp(&other.len()), |order, (x, y)| order.then(x.total_cmp(y)))
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

    /// Closed lines whose edges lie farther out by a distance (m) that depends on their unit normal.
    ///
    /// Points about which the lines turn counter-clockwise at least once lie inside. Sharp corners are cut off at three
    /// times the distance.
    pub(super) fn moved_outwards(&self, distance: impl Fn(Point) -> f64) -> Vec<Vec<Point>> {
        let mut moved_loops = Vec::with_capacity(self.loops.len());
        for corners in &self.loops {
            let mut edges = Vec::with_capacity(corners.len());
            for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                let direction = [0, 1].map(|k| (b[k] - a[k]) / length);
                let distance = distance([direction[1], -direction[0]]);
                edges.push(MovedEdge { end: *b, length, direction, distance });
            }
            let mut moved = vec![];
            for (edge, next) in edges.iter().zip(edges.iter().cycle().skip(1)) {
                moved.extend(edge.corner_to(next));
            }
            moved_loops.push(moved);
        }
        moved_loops
    }
}

impl MovedEdge {
    /// Point on the moved edge, at the distance `along` from the edge's `corner`.
    fn beside(&self, corner: Point, along: f64) -> Point {
        let normal = [self.direction[1], -self.direction[0]];
        [0, 1].map(|k| corner[k] + self.distance * normal[k] + along * self.direction[k])
    }

    /// Corner between this edge and the next one, both moved outwards.
    ///
    /// It is the point where the moved edges meet. Where an edge is too short for this, or the corner too sharp, both
    /// end before: a corner of the mat is then cut off, and in a corner of its surroundings edges pass one another.
    fn corner_to(&self, next: &Self) -> Vec<Point> {
        let corner = self.end;
        let one = self.direction;
        let other = next.direction;
        let sine = one[0] * other[1] - one[1] * other[0];
        let cosine = one[0] * other[0] + one[1] * other[1];
        if sine.abs() <= STRAIGHT_SINE {
            return vec![self.beside(corner, 0.0), next.beside(corner, 0.0)];
        }
        // Lengths by which this edge grows beyond its end, and the next one before its start, until they meet.
        let growth = (next.distance - self.distance * cosine) / sine;
        let next_growth = (self.distance - next.distance * cosine) / sine;
        let max_growth =
            (MAX_CORNER_MOVE * MAX_CORNER_MOVE - 1.0).sqrt() * self.distance.max(next.distance);
        let ratio = self
            .allowed_fraction(growth, max_growth)
            .min(next.allowed_fraction(next_growth, max_growth));
        // Edges that do not move have no ratio (0/0).
        if ratio.is_nan() || ratio >= 1.0 {
            return vec![self.beside(corner, growth)];
        }
        let end = self.beside(corner, ratio * growth);
        let next_start = next.beside(corner, -ratio * next_growth);
        if sine > 0.0 { vec![end, next_start] } else { vec![end, corner, next_start] }
    }

    /// Largest fraction of a growth that the edge allows; it may be reduced by half its length.
    fn allowed_fraction(&self, growth: f64, max_growth: f64) -> f64 {
        let allowed = if growth < 0.0 { 0.5 * self.length } else { max_growth };
        allowed / growth.abs()
    }
}

/// Closed lines of these edges.
///
/// Where several edges leave a point, a line turns left as far as it can: it stays with its part of the mat.
fn closed_lines(points: &PointIndex, edges: Vec<[usize; 2]>) -> Vec<Vec<Point>> {
    let mut leaving: HashMap<usize, Vec<usize>> = HashMap::new();
    for &[first, last] in &edges {
        leaving.entry(first).or_default().push(last);
    }
    let mut lines = vec![];
    for [first, last] in edges {
        let Some(ends) = leaving.get_mut(&first) else { continue };
        let Some(place) = ends.iter().position(|end| *end == last) else { continue };
        ends.swap_remove(place);
        let mut line = vec![first, last];
        while let [_, second, ..] = line[..]
            && let [.., previous, current] = line[..]
            && let Some(ends) = leaving.get_mut(&current)
        {
            let corner = [points.place(previous), points.place(current)];
            let turn = |end: usize| clockwise(corner, points.place(end));
            let Some(next) = (0..ends.len())
                .min_by(|one, other| turn(ends[*one]).total_cmp(&turn(ends[*other])))
            else {
                break;
            };
            if current == first && turn(second) <= turn(ends[next]) {
                break;
            }
            line.push(ends.swap_remove(next));
        }
        line.pop();
        lines.push(line);
    }
    lines.iter().filter_map(|line| corners(points, line)).collect()
}

/// Corners of a closed line, from the lowest of its leftmost ones; `None` if it encloses nothing.
fn corners(points: &PointIndex, line: &[usize]) -> Option<Vec<Point>> {
    let places: Vec<Point> = line.iter().map(|number| points.place(*number)).collect();
    let start = (0..places.len()).min_by(|one, other| {
        let one = places[*one];
        let other = places[*other];
        if (one[0] - other[0]).abs() <= points.near() {
            one[1].total_cmp(&other[1])
        } else {
            one[0].total_cmp(&other[0])
        }
    })?;
    let mut corners = vec![places[start]];
    for k in 1..places.len() {
        let place = places[(start + k) % places.len()];
        let next = places[(start + k + 1) % places.len()];
        let last = corners[corners.len() - 1];
        if points.along([last, next], place).is_none() {
            corners.push(place);
        }
    }
    (corners.len() > 2).then_some(corners)
}

/// Angle at the second point from the first one clockwise to `end`, above 0 and up to 2π.
fn clockwise([first, second]: [Point; 2], end: Point) -> f64 {
    let first_angle = (first[1] - second[1]).atan2(first[0] - second[0]);
    let end_angle = (end[1] - second[1]).atan2(end[0] - second[0]);
    let turn = (first_angle - end_angle).rem_euclid(std::f64::consts::TAU);
    if turn > 0.0 { turn } else { std::f64::consts::TAU }
}
