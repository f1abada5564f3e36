//! Two halves of a graph with few edges between them.

use std::collections::BinaryHeap;

use super::graph::Graph;

/// Largest weight of a half, in per cent of the graph's weight.
///
/// Equal halves would cut more edges.
const MAX_HALF_PERCENT: i64 = 55;
/// Largest number of improvement passes: most halves improve in two or three.
const MAX_IMPROVEMENT_PASSES: usize = 8;
/// Number of moves without a better cut after which a pass ends.
///
/// Longer passes seldom find one.
const MAX_MOVES_WITHOUT_GAIN: usize = 100;
/// Gain stored for a vertex that has already moved in a pass.
const GAIN_IF_MOVED: i64 = i64::MIN;

/// Two halves of a graph.
pub(super) struct GraphHalves<'a> {
    graph: &'a Graph,
    /// Whether each vertex is in the second half.
    pub(super) is_second: Vec<bool>,
    weights: [i64; 2],
    /// Weight of the edges between the halves.
    cut_weight: i64,
    /// Largest allowed weight of a half.
    max_half_weight: i64,
}

impl<'a> GraphHalves<'a> {
    /// Halves with these vertices in the second half.
    pub(super) fn new(graph: &'a Graph, is_second: Vec<bool>) -> Self {
        let mut weights = [0; 2];
        // Each cut edge is counted at both ends.
        let mut double_cut_weight = 0;
        for (v, is_v_second) in is_second.iter().enumerate() {
            weights[usize::from(*is_v_second)] += graph.vertex_weights[v];
            let cut_edges =
                graph.neighbours(v).iter().filter(|(u, _)| is_second[*u] != *is_v_second);
            double_cut_weight += cut_edges.map(|(_, weight)| weight).sum::<i64>();
        }
        let total_weight = weights[0] + weights[1];
        let max_vertex_weight = graph.vertex_weights.iter().max().copied().unwrap_or(0);
        let max_half_weight =
            (total_weight * MAX_HALF_PERCENT / 100).max(total_weight / 2 + max_vertex_weight);
        Self { graph, is_second, weights, cut_weight: double_cut_weight / 2, max_half_weight }
    }

    /// Halves whose first half grows from a vertex.
    ///
    /// It takes up the neighbour that cuts the fewest edges.
    pub(super) fn from_seed(graph: &'a Graph, seed: usize) -> Self {
        let mut halves = Self::new(graph, vec![true; graph.len()]);
        let mut heap = BinaryHeap::from([(halves.gain(seed), seed)]);
        let mut unvisited = 0..graph.len();
        while halves.weights[0] < halves.weights[1] {
            let Some((gain, v)) = heap.pop() else {
                // The graph is not connected: continue with its next component.
                let Some(new_seed) = unvisited.find(|v| halves.is_second[*v]) else { break };
                heap.push((halves.gain(new_seed), new_seed));
                continue;
            };
            if halves.is_second[v] && gain == halves.gain(v) {
                halves.move_vertex(v);
                let edges = graph.neighbours(v).iter().filter(|(u, _)| halves.is_second[*u]);
                heap.extend(edges.map(|&(u, _)| (halves.gain(u), u)));
            }
        }
        halves
    }

    /// Cost of these halves, in lexicographic order.
    ///
    /// Excess of a half over its largest weight, then the weight of the cut, then the difference of the halves.
    pub(super) fn cost(&self) -> [i64; 3] {
        let first_weight = self.weights[0];
        let second_weight = self.weights[1];
        let excess = (first_weight.max(second_weight) - self.max_half_weight).max(0);
        [excess, self.cut_weight, (first_weight - second_weight).abs()]
    }

    /// Decrease of the cut's weight if a vertex changes its half.
    fn gain(&self, v: usize) -> i64 {
        let mut gain = 0;
        for &(u, weight) in self.graph.neighbours(v) {
            let is_cut = self.is_second[u] != self.is_second[v];
            gain += if is_cut { weight } else { -weight };
        }
        gain
    }

    /// Moves a vertex to the other half.
    fn move_vertex(&mut self, v: usize) {
        self.cut_weight -= self.gain(v);
        let old_half = usize::from(self.is_second[v]);
        self.weights[old_half] -= self.graph.vertex_weights[v];
        self.weights[1 - old_half] += self.graph.vertex_weights[v];
        self.is_second[v] = old_half == 0;
    }

    /// Moves vertices between the halves while the cost decreases.
    pub(super) fn improve(&mut self) {
        let mut gains = vec![0; self.graph.len()];
        for _ in 0..MAX_IMPROVEMENT_PASSES {
            let old_cost = self.cost();
            self.improve_once(&mut gains);
            if self.cost() >= old_cost {
                break;
            }
        }
    }

    /// Moves each vertex at most once, largest gain first, and restores the best halves.
    fn improve_once(&mut self, gains: &mut [i64]) {
        let graph = self.graph;
        let mut heap = BinaryHeap::new();
        for v in 0..graph.len() {
            gains[v] = self.gain(v);
            let mut edges = graph.neighbours(v).iter();
            if edges.any(|(u, _)| self.is_second[*u] != self.is_second[v]) {
                heap.push((gains[v], v));
            }
        }
        let mut moves = Vec::new();
        let mut best_move_count = 0;
        let mut best_cost = self.cost();
        while let Some((gain, v)) = heap.pop() {
            let old_half = usize::from(self.is_second[v]);
            let new_weight = self.weights[1 - old_half] + graph.vertex_weights[v];
            let is_outdated = gains[v] != gain;
            let is_unbalanced =
                new_weight > self.max_half_weight && new_weight > self.weights[old_half];
            if is_outdated || is_unbalanced {
                continue;
            }
            self.move_vertex(v);
            gains[v] = GAIN_IF_MOVED;
            moves.push(v);
            for &(u, weight) in graph.neighbours(v) {
                if gains[u] != GAIN_IF_MOVED {
                    let is_cut = self.is_second[u] != self.is_second[v];
                    gains[u] += if is_cut { 2 * weight } else { -2 * weight };
                    heap.push((gains[u], u));
                }
            }
            let cost = self.cost();
            if cost < best_cost {
                best_cost = cost;
                best_move_count = moves.len();
            } else if moves.len() > best_move_count + MAX_MOVES_WITHOUT_GAIN {
                break;
            }
        }
        moves.drain(best_move_count..).rev().for_each(|v| self.move_vertex(v));
    }
}
