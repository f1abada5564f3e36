//! Boundary of a mat: the closed lines around the union of its faces.
//!
//! Edges that two faces share cancel, also where corners of one face divide the edge of another, and corners on straight
//! lines are left out. The lines therefore depend on the outline alone, whatever the faces that fill it.

use std::collections::HashMap;

use super::faces::{Face, side};
use super::points::{Point, Points, without_pairs};

/// Largest distance by which sharp corners move, relative to the distance of their edges.
const MAX_CORNER_MOVE: f64 = 3.0;
/// Sine of the angle between two edges that count as one.
const STRAIGHT_SINE: f64 = 1e-6;

/// Closed lines with the mat to their left: counter-clockwise around it, clockwise around its holes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Boundary {
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

impl Boundary {
    /// Boundary of each mat: faces that touch form one.
    pub(super) fn of_mats(faces: &[Face]) -> Vec<Self> {
        let mats = Face::mats(faces);
        let count = mats.iter().max().map_or(0, |last| last + 1);
        let mut members = vec![vec![]; count];
        faces.iter().zip(mats).for_each(|(face, mat)| members[mat].push(face));
        members.iter().map(|faces| Self::of(faces)).collect()
    }

    /// Boundary of some faces, the faces of one mat.
    fn of(faces: &[&Face]) -> Self {
        let near = faces.iter().map(|face| face.near()).fold(0.0, f64::max);
        let mut points = Points::new(near);
        let mut edges = vec![];
        for face in faces {
            let corners: Vec<_> =
                face.corners().iter().map(|corner| points.number(*corner)).collect();
            edges
                .extend((0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]));
        }
        let stops = points.on_edges(&without_pairs(edges));
        let parts = stops.iter().flat_map(|on| on.windows(2).map(|pair| [pair[0].1, pair[1].1]));
        let mut loops = closed_lines(&points, without_pairs(parts.collect()));
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

    /// Length of the edges whose angle to x and y has a larger sine, m.
    pub(super) fn oblique_length(&self, sine: f64) -> f64 {
        let steps = self.edges().map(|[a, b]| [b[0] - a[0], b[1] - a[1]]);
        let lengths = steps.map(|step| {
            let length = step[0].hypot(step[1]);
            if step[0].abs().min(step[1].abs()) > sine * length { length } else { 0.0 }
        });
        lengths.sum()
    }

    /// Closed lines whose edges lie farther out by a distance (m) that depends on their unit normal.
    ///
    /// Points about which the lines turn counter-clockwise at least once lie inside. Sharp corners are cut off at three
    /// times the distance.
    pub(super) fn moved_outwards(&self, distance: impl Fn(Point) -> f64) -> Vec<Vec<Point>> {
        let moved = |corners: &Vec<Point>| {
            let next = corners.iter().cycle().skip(1);
            let edge = |(a, b): (&Point, &Point)| {
                let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                let direction = [0, 1].map(|k| (b[k] - a[k]) / length);
                let distance = distance([direction[1], -direction[0]]);
                MovedEdge { end: *b, length, direction, distance }
            };
            let edges: Vec<MovedEdge> = corners.iter().zip(next).map(edge).collect();
            let after = edges.iter().cycle().skip(1);
            edges.iter().zip(after).flat_map(|(one, other)| one.corner_to(other)).collect()
        };
        self.loops.iter().map(moved).collect()
    }
}

impl MovedEdge {
    /// Point beyond the end of this edge (along it), or before the begin of the next one, at the distance outwards.
    fn beside(&self, corner: Point, along: f64) -> Point {
        let [x, y] = self.direction;
        let normal = [y, -x];
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
        let beyond = (next.distance - self.distance * cosine) / sine;
        let before = (self.distance - next.distance * cosine) / sine;
        let widest = self.distance.max(next.distance);
        let reach = (MAX_CORNER_MOVE * MAX_CORNER_MOVE - 1.0).sqrt() * widest;
        let limit = |along: f64, length: f64| {
            let room = if along < 0.0 { 0.5 * length } else { reach };
            room / along.abs()
        };
        let ratio = limit(beyond, self.length).min(limit(before, next.length));
        // A ratio without a number belongs to edges that do not move.
        if ratio.is_nan() || ratio >= 1.0 {
            return vec![self.beside(corner, beyond)];
        }
        let ends = [self.beside(corner, ratio * beyond), next.beside(corner, -ratio * before)];
        if sine > 0.0 { ends.to_vec() } else { vec![ends[0], corner, ends[1]] }
    }
}

/// Closed lines of these edges.
///
/// Where several edges leave a point, a line turns left as far as it can: it stays with its part of the mat.
fn closed_lines(points: &Points, edges: Vec<[usize; 2]>) -> Vec<Vec<Point>> {
    let mut leaving: HashMap<usize, Vec<usize>> = HashMap::new();
    for &[first, last] in &edges {
        leaving.entry(first).or_default().push(last);
    }
    let mut lines = vec![];
    for [first, last] in edges {
        let Some(place) =
            leaving.get(&first).and_then(|ends| ends.iter().position(|end| *end == last))
        else {
            continue;
        };
        leaving.entry(first).or_default().swap_remove(place);
        let mut line = vec![first, last];
        while let [_, second, ..] = line[..]
            && let [.., before, at] = line[..]
            && let Some(ends) = leaving.get_mut(&at)
        {
            let from = points.place(before);
            let here = points.place(at);
            let turn = |end: usize| clockwise([from, here], points.place(end));
            let by_turn =
                |one: &usize, other: &usize| turn(ends[*one]).total_cmp(&turn(ends[*other]));
            let Some(next) = (0..ends.len()).min_by(by_turn) else { break };
            if at == first && turn(second) <= turn(ends[next]) {
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
fn corners(points: &Points, line: &[usize]) -> Option<Vec<Point>> {
    let places: Vec<Point> = line.iter().map(|number| points.place(*number)).collect();
    let order = |one: &usize, other: &usize| {
        let one = places[*one];
        let other = places[*other];
        if (one[0] - other[0]).abs() <= points.near() {
            one[1].total_cmp(&other[1])
        } else {
            one[0].total_cmp(&other[0])
        }
    };
    let start = (0..places.len()).min_by(order)?;
    let mut corners = vec![places[start]];
    for k in 1..places.len() {
        let [place, next] = [k, k + 1].map(|k| places[(start + k) % places.len()]);
        let last = corners[corners.len() - 1];
        if points.along([last, next], place).is_none() {
            corners.push(place);
        }
    }
    (corners.len() > 2).then_some(corners)
}

/// Angle at the second point from the first one clockwise to `end`, above 0 and up to 2π.
fn clockwise([before, here]: [Point; 2], end: Point) -> f64 {
    let angle = |place: Point| (place[1] - here[1]).atan2(place[0] - here[0]);
    let turn = (angle(before) - angle(end)).rem_euclid(std::f64::consts::TAU);
    if turn > 0.0 { turn } else { std::f64::consts::TAU }
}
