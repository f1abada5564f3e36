//! Two halves of a graph with few edges between them.

use std::collections::BinaryHeap;

use super::graph::Graph;

/// Largest weight of a half, in per cent of the graph's weight.
const MAX_HALF_PERCENT: i64 = 55;
/// Largest number of passes that improve two halves.
const MAX_IMPROVEMENT_PASSES: usize = 8;
/// Moves without a better cut after which a pass ends.
const MAX_MOVES_WITHOUT_GAIN: usize = 100;
/// Gain stored for a vertex that has already moved in a pass.
const GAIN_IF_MOVED: i64 = i64::MIN;

/// Two halves of a graph.
pub(super) struct GraphHalves<'a> {
    graph: &'a Graph,
    pub(super) is_second: Vec<bool>,
    weights: [i64; 2],
    /// Weight of the edges between the halves.
    cut: i64,
    /// Largest weight of a half.
    limit: i64,
}

impl<'a> GraphHalves<'a> {
    pub(super) fn new(graph: &'a Graph, is_second: Vec<bool>) -> Self {
        let mut weights = [0; 2];
        let mut double_cut = 0;
        for (v, second) in is_second.iter().enumerate() {
            weights[usize::from(*second)] += graph.weight[v];
            let across = graph.neighbours(v).iter().filter(|(u, _)| is_second[*u] != *second);
            double_cut += across.map(|(_, weight)| weight).sum::<i64>();
        }
        let total = weights[0] + weights[1];
        let heaviest = graph.weight.iter().max();
        let limit =
            (total * MAX_HALF_PERCENT / 100).max(total / 2 + heaviest.copied().unwrap_or(0));
        Self { graph, is_second, weights, cut: double_cut / 2, limit }
    }

    /// Grows the first half from a vertex, by the neighbour that cuts the fewest edges.
    pub(super) fn grown(graph: &'a Graph, seed: usize) -> Self {
        let mut halves = Self::new(graph, vec![true; graph.len()]);
        let mut heap = BinaryHeap::from([(halves.gain(seed), seed)]);
        let mut unvisited = 0..graph.len();
        while halves.weights[0] < halves.weights[1] {
            let Some((gain, v)) = heap.pop() else {
                // The graph is not connected: continue with the next component.
                let Some(other) = unvisited.find(|v| halves.is_second[*v]) else { break };
                heap.push((halves.gain(other), other));
                continue;
            };
            if halves.is_second[v] && gain == halves.gain(v) {
                halves.shift(v);
                let outer = graph.neighbours(v).iter().filter(|(u, _)| halves.is_second[*u]);
                heap.extend(outer.map(|&(u, _)| (halves.gain(u), u)));
            }
        }
        halves
    }

    /// Cost of these halves, compared entry by entry.
    ///
    /// Excess of a half over its limit, then the weight of the cut, then the difference of the halves.
    pub(super) fn cost(&self) -> [i64; 3] {
        let first = self.weights[0];
        let second = self.weights[1];
        [(first.max(second) - self.limit).max(0), self.cut, (first - second).abs()]
    }

    /// Decrease of the cut when a vertex changes its half.
    fn gain(&self, v: usize) -> i64 {
        let mut gain = 0;
        for &(u, weight) in self.graph.neighbours(v) {
            let is_cut = self.is_second[u] != self.is_second[v];
            gain += if is_cut { weight } else { -weight };
        }
        gain
    }

    /// Moves a vertex to the other half.
    fn shift(&mut self, v: usize) {
        self.cut -= self.gain(v);
        let from = usize::from(self.is_second[v]);
        self.weights[from] -= self.graph.weight[v];
        self.weights[1 - from] += self.graph.weight[v];
        self.is_second[v] = from == 0;
    }

    /// Moves vertices between the halves while the cost falls.
    pub(super) fn improve(&mut self) {
        let mut gains = vec![0; self.graph.len()];
        for _ in 0..MAX_IMPROVEMENT_PASSES {
            let before = self.cost();
            self.pass(&mut gains);
            if self.cost() >= before {
                break;
            }
        }
    }

    /// Moves each vertex at most once, largest gain first, and returns to the best halves.
    fn pass(&mut self, gains: &mut [i64]) {
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
        let mut kept_moves = 0;
        let mut best = self.cost();
        while let Some((gain, v)) = heap.pop() {
            let from = usize::from(self.is_second[v]);
            let after = self.weights[1 - from] + graph.weight[v];
            if gains[v] != gain || after > self.limit && after > self.weights[from] {
                continue;
            }
            self.shift(v);
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
            if cost < best {
                best = cost;
                kept_moves = moves.len();
            } else if moves.len() > kept_moves + MAX_MOVES_WITHOUT_GAIN {
                break;
            }
        }
        moves.drain(kept_moves..).rev().for_each(|v| self.shift(v));
    }
}
