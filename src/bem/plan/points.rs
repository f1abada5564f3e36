//! Different points of faces, and edges between them.

use std::collections::HashMap;

use super::faces::side;

/// Point in plan, m.
pub(crate) type Point = [f64; 2];

/// Distinct points, numbered; points closer than a tolerance are one.
pub(crate) struct PointIndex {
    /// Distance of points that count as one, m.
    near: f64,
    places: Vec<Point>,
    /// Numbers of the points in each square of a fine grid.
    grid: HashMap<[i64; 2], Vec<usize>>,
}

impl PointIndex {
    /// No points; `near`: distance of points that count as one, m.
    pub(crate) fn new(near: f64) -> Self {
        Self { near, places: vec![], grid: HashMap::new() }
    }

    /// Distance of points that count as one, m.
    pub(crate) fn near(&self) -> f64 {
        self.near
    }

    /// Place of a point, m.
    pub(crate) fn place(&self, number: usize) -> Point {
        self.places[number]
    }

    /// Number of the point at `place`.
    pub(crate) fn number(&mut self, place: Point) -> usize {
        #[allow(clippy::cast_possible_truncation, reason = "saturates")]
        let square = place.map(|x| (x / (2.0 * self.near)).floor() as i64);
        for step in 0..9 {
            let around = [0, 1].map(|k| square[k].saturating_add([step % 3, step / 3][k] - 1));
            for &number in self.grid.get(&around).into_iter().flatten() {
                let other = self.places[number];
                if (place[0] - other[0]).hypot(place[1] - other[1]) <= self.near {
                    return number;
                }
            }
        }
        self.places.push(place);
        self.grid.entry(square).or_default().push(self.places.len() - 1);
        self.places.len() - 1
    }

    /// Points on each edge in order, each with its place on the edge from 0 to 1.
    ///
    /// The first and the last are the ends of the edge. Only ends of edges count as points.
    pub(crate) fn on_edges(&self, edges: &[[usize; 2]]) -> Vec<Vec<(f64, usize)>> {
        let mut ends: Vec<usize> = edges.iter().flatten().copied().collect();
        ends.sort_by(|one, other| self.places[*one][0].total_cmp(&self.places[*other][0]));
        edges.iter().map(|edge| self.on_edge(*edge, &ends)).collect()
    }

    /// Points on one edge, as of [`PointIndex::on_edges`]; `ends` are sorted by x.
    fn on_edge(&self, [first, last]: [usize; 2], ends: &[usize]) -> Vec<(f64, usize)> {
        let a = self.places[first];
        let b = self.places[last];
        let left = a[0].min(b[0]) - self.near;
        let right = a[0].max(b[0]) + self.near;
        let start = ends.partition_point(|end| self.places[*end][0] < left);
        let mut points = vec![(0.0, first), (1.0, last)];
        for &end in ends[start..].iter().take_while(|end| self.places[**end][0] <= right) {
            if end != first
                && end != last
                && let Some(fraction) = self.along([a, b], self.places[end])
            {
                points.push((fraction, end));
            }
        }
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        points.dedup();
        points
    }

    /// Place of `p` on the line from a to b, from 0 to 1; `None` if it is not on it.
    pub(super) fn along(&self, [a, b]: [Point; 2], p: Point) -> Option<f64> {
        let step = [b[0] - a[0], b[1] - a[1]];
        let length = step[0].hypot(step[1]);
        let fraction = (step[0] * (p[0] - a[0]) + step[1] * (p[1] - a[1])) / (length * length);
        let is_near = side([a, b], p).abs() <= self.near * length;
        (is_near && fraction > 0.0 && fraction < 1.0).then_some(fraction)
    }
}

/// Edges without those that run to and fro between the same points.
pub(crate) fn without_pairs(mut edges: Vec<[usize; 2]>) -> Vec<[usize; 2]> {
    edges.sort_by_key(|edge| (ascending(*edge), edge[0]));
    let mut unpaired = vec![];
    for same in edges.chunk_by(|one, other| ascending(*one) == ascending(*other)) {
        let forward_count = same.iter().filter(|edge| edge[0] < edge[1]).count();
        let backward_count = same.len() - forward_count;
        let mut edge = ascending(same[0]);
        if forward_count <= backward_count {
            edge.reverse();
        }
        let count = forward_count.abs_diff(backward_count);
        unpaired.extend(std::iter::repeat_n(edge, count));
    }
    unpaired
}

/// The ends of an edge, the smaller number first.
fn ascending([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}
