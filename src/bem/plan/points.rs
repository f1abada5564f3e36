//! Distinct points of faces, and edges between them.

use std::collections::HashMap;

use super::faces::side;

/// Point in plan, m.
pub(crate) type Point = [f64; 2];

/// Distinct points with their indices; points closer than a distance are the same point.
pub(crate) struct PointIndex {
    /// Distance below which two points are the same point, m.
    touch_distance: f64,
    /// Coordinates of each distinct point.
    points: Vec<Point>,
    /// Indices of the points in each square of a grid with sides of twice the distance.
    grid: HashMap<[i64; 2], Vec<usize>>,
}

impl PointIndex {
    /// Empty index; `touch_distance`: distance below which two points are the same point, m.
    pub(crate) fn new(touch_distance: f64) -> Self {
        Self { touch_distance, points: vec![], grid: HashMap::new() }
    }

    /// Distance below which two points are the same point, m.
    pub(crate) fn touch_distance(&self) -> f64 {
        self.touch_distance
    }

    /// Coordinates of the point with this index, m.
    pub(crate) fn point(&self, index: usize) -> Point {
        self.points[index]
    }

    /// Index of a point; a new point is added.
    pub(crate) fn index_of(&mut self, point: Point) -> usize {
        #[allow(clippy::cast_possible_truncation, reason = "saturates")]
        let square = point.map(|x| (x / (2.0 * self.touch_distance)).floor() as i64);
        for step in 0..9 {
            let neighbour = [0, 1].map(|k| square[k].saturating_add([step % 3, step / 3][k] - 1));
            for &index in self.grid.get(&neighbour).into_iter().flatten() {
                let other = self.points[index];
                if (point[0] - other[0]).hypot(point[1] - other[1]) <= self.touch_distance {
                    return index;
                }
            }
        }
        self.points.push(point);
        self.grid.entry(square).or_default().push(self.points.len() - 1);
        self.points.len() - 1
    }

    /// Points on each edge in order, each with its position on the edge from 0 to 1.
    ///
    /// The first point and the last are the ends of the edge. The others are ends of other edges.
    pub(crate) fn on_edges(&self, edges: &[[usize; 2]]) -> Vec<Vec<(f64, usize)>> {
        let mut ends: Vec<usize> = edges.iter().flatten().copied().collect();
        ends.sort_by(|one, other| self.points[*one][0].total_cmp(&self.points[*other][0]));
        edges.iter().map(|edge| self.on_edge(*edge, &ends)).collect()
    }

    /// Points on one edge, as in [`PointIndex::on_edges`]; `ends` are sorted by x.
    fn on_edge(&self, edge: [usize; 2], ends: &[usize]) -> Vec<(f64, usize)> {
        let [start, end] = edge;
        let a = self.points[start];
        let b = self.points[end];
        let min_x = a[0].min(b[0]) - self.touch_distance;
        let max_x = a[0].max(b[0]) + self.touch_distance;
        let candidates = &ends[ends.partition_point(|end| self.points[*end][0] < min_x)..];
        let mut edge_points = vec![(0.0, start), (1.0, end)];
        for &candidate in candidates.iter().take_while(|end| self.points[**end][0] <= max_x) {
            if candidate != start
                && candidate != end
                && let Some(position) = self.position_on_edge([a, b], self.points[candidate])
            {
                edge_points.push((position, candidate));
            }
        }
        edge_points.sort_by(|one, other| one.0.total_cmp(&other.0));
        edge_points.dedup();
        edge_points
    }

    /// Position of `p` on the line from a to b, from 0 to 1; `None` for a point beside the line.
    pub(super) fn position_on_edge(&self, [a, b]: [Point; 2], p: Point) -> Option<f64> {
        let edge = [b[0] - a[0], b[1] - a[1]];
        let length = edge[0].hypot(edge[1]);
        let position = (edge[0] * (p[0] - a[0]) + edge[1] * (p[1] - a[1])) / (length * length);
        let is_on_line = side([a, b], p).abs() <= self.touch_distance * length;
        (is_on_line && position > 0.0 && position < 1.0).then_some(position)
    }
}

/// The edges that remain after pairs of opposite edges between the same points are removed.
pub(crate) fn without_pairs(mut edges: Vec<[usize; 2]>) -> Vec<[usize; 2]> {
    edges.sort_by_key(|edge| (ascending(*edge), edge[0]));
    let mut unpaired = vec![];
    for parallel_edges in edges.chunk_by(|one, other| ascending(*one) == ascending(*other)) {
        let forward_count = parallel_edges.iter().filter(|edge| edge[0] < edge[1]).count();
        let backward_count = parallel_edges.len() - forward_count;
        let mut edge = ascending(parallel_edges[0]);
        if forward_count <= backward_count {
            edge.reverse();
        }
        let unpaired_count = forward_count.abs_diff(backward_count);
        unpaired.extend(std::iter::repeat_n(edge, unpaired_count));
    }
    unpaired
}

/// The ends of an edge, the smaller index first.
fn ascending([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}
