//! Different points of faces, and edges between them.

use std::collections::HashMap;

use super::faces::side;

/// Point in plan, m.
pub(crate) type Point = [f64; 2];

/// Different points, by their numbers.
pub(crate) struct Points {
    /// Distance of points that count as one, m.
    near: f64,
    places: Vec<Point>,
    /// Numbers of the points in each square of a fine grid.
    grid: HashMap<[i64; 2], Vec<usize>>,
}

impl Points {
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

    /// For each edge its first point, the points within it in order, each with its place from 0 to 1, and its last point.
    ///
    /// Only ends of edges count as points.
    pub(crate) fn on_edges(&self, edges: &[[usize; 2]]) -> Vec<Vec<(f64, usize)>> {
        let mut ends: Vec<usize> = edges.iter().flatten().copied().collect();
        ends.sort_by(|one, other| self.places[*one][0].total_cmp(&self.places[*other][0]));
        let on_edge = |&[first, last]: &[usize; 2]| {
            let a = self.places[first];
            let b = self.places[last];
            let left = a[0].min(b[0]) - self.near;
            let right = a[0].max(b[0]) + self.near;
            let start = ends.partition_point(|end| self.places[*end][0] < left);
            let within = ends[start..].iter().take_while(|end| self.places[**end][0] <= right);
            let inner = within.filter(|end| **end != first && **end != last);
            let mut on = vec![(0.0, first), (1.0, last)];
            on.extend(inner.filter_map(|end| Some((self.along([a, b], self.places[*end])?, *end))));
            on.sort_by(|one, other| one.0.total_cmp(&other.0));
            on.dedup();
            on
        };
        edges.iter().map(on_edge).collect()
    }

    /// Place of `p` on the line from a to b, from 0 to 1; `None` if it is not on it.
    pub(super) fn along(&self, [a, b]: [Point; 2], p: Point) -> Option<f64> {
        let step = [b[0] - a[0], b[1] - a[1]];
        let length = step[0].hypot(step[1]);
        let along = (step[0] * (p[0] - a[0]) + step[1] * (p[1] - a[1])) / (length * length);
        let is_on = side([a, b], p).abs() <= self.near * length && along > 0.0 && along < 1.0;
        is_on.then_some(along)
    }
}

/// Edges without those that run to and fro between the same points.
pub(crate) fn without_pairs(mut edges: Vec<[usize; 2]>) -> Vec<[usize; 2]> {
    let key = |[a, b]: &[usize; 2]| [*a.min(b), *a.max(b)];
    edges.sort_by_key(|edge| (key(edge), edge[0]));
    let mut kept = vec![];
    for same in edges.chunk_by(|one, other| key(one) == key(other)) {
        let forth = same.iter().filter(|edge| edge[0] < edge[1]).count();
        let back = same.len() - forth;
        let [low, high] = key(&same[0]);
        let edge = if forth > back { [low, high] } else { [high, low] };
        kept.extend(std::iter::repeat_n(edge, forth.abs_diff(back)));
    }
    kept
}
