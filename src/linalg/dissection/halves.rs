//! Two halves of a graph with few edges between them.

use std::collections::BinaryHeap;

use super::graph::Graph;

/// Largest weight of a half, in hundredths of the graph's.
const HEAVIEST: i64 = 55;
/// Largest number of passes that improve two halves.
const PASSES: usize = 8;
/// Moves without a better cut after which a pass ends.
const PATIENCE: usize = 100;
/// Gain of a vertex that has moved in a pass.
const MOVED: i64 = i64::MIN;

/// Two halves of a graph.
pub(super) struct Halves<'a> {
    graph: &'a Graph,
    pub(super) is_second: Vec<bool>,
    weights: [i64; 2],
    /// Weight of the edges between the halves.
    cut: i64,
    /// Largest weight of a half.
    limit: i64,
}

impl<'a> Halves<'a> {
    pub(super) fn new(graph: &'a Graph, is_second: Vec<bool>) -> Self {
        let (mut weights, mut twice) = ([0; 2], 0);
        for (v, second) in is_second.iter().enumerate() {
            weights[usize::from(*second)] += graph.weight[v];
            let across = graph.neighbours(v).iter().filter(|(u, _)| is_second[*u] != *second);
            twice += across.map(|(_, weight)| weight).sum::<i64>();
        }
        let (total, heaviest) = (weights[0] + weights[1], graph.weight.iter().max());
        let limit = (total * HEAVIEST / 100).max(total / 2 + heaviest.copied().unwrap_or(0));
        Self { graph, is_second, weights, cut: twice / 2, limit }
    }

    /// The first half grows from a vertex, by the neighbour that cuts the fewest edges.
    pub(super) fn grown(graph: &'a Graph, seed: usize) -> Self {
        let mut own = Self::new(graph, vec![true; graph.len()]);
        let (mut heap, mut rest) = (BinaryHeap::from([(own.gain(seed), seed)]), 0..graph.len());
        while own.weights[0] < own.weights[1] {
            let Some((gain, v)) = heap.pop() else {
                // The next part of a graph that is not connected.
                let Some(other) = rest.find(|v| own.is_second[*v]) else { break };
                heap.push((own.gain(other), other));
                continue;
            };
            if own.is_second[v] && gain == own.gain(v) {
                own.shift(v);
                let outer = graph.neighbours(v).iter().filter(|(u, _)| own.is_second[*u]);
                heap.extend(outer.map(|&(u, _)| (own.gain(u), u)));
            }
        }
        own
    }

    /// Excess of a half over its limit, then the weight of the cut, then the difference of the halves.
    pub(super) fn cost(&self) -> [i64; 3] {
        let [one, other] = self.weights;
        [(one.max(other) - self.limit).max(0), self.cut, (one - other).abs()]
    }

    /// Decrease of the cut when a vertex changes its half.
    fn gain(&self, v: usize) -> i64 {
        let is_cut = |u: usize| self.is_second[u] != self.is_second[v];
        let edges = self.graph.neighbours(v).iter();
        edges.map(|&(u, weight)| if is_cut(u) { weight } else { -weight }).sum()
    }

    /// Moves a vertex to the other half.
    fn shift(&mut self, v: usize) {
        self.cut -= self.gain(v);
        let from = usize::from(self.is_second[v]);
        self.weights[from] -= self.graph.weight[v];
        self.weights[1 - from] += self.graph.weight[v];
        self.is_second[v] = from == 0;
    }

    /// Moves vertices between the halves while that is better.
    pub(super) fn improve(&mut self) {
        let mut gains = vec![0; self.graph.len()];
        for _ in 0..PASSES {
            let before = self.cost();
            self.pass(&mut gains);
            if self.cost() >= before {
                break;
            }
        }
    }

    /// Moves each vertex at most once, by the largest gain, and returns to the best halves.
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
        let (mut moves, mut kept, mut best) = (Vec::new(), 0, self.cost());
        while let Some((gain, v)) = heap.pop() {
            let from = usize::from(self.is_second[v]);
            let after = self.weights[1 - from] + graph.weight[v];
            if gains[v] != gain || after > self.limit && after > self.weights[from] {
                continue;
            }
            self.shift(v);
            gains[v] = MOVED;
            moves.push(v);
            for &(u, weight) in graph.neighbours(v) {
                if gains[u] != MOVED {
                    let is_cut = self.is_second[u] != self.is_second[v];
                    gains[u] += if is_cut { 2 * weight } else { -2 * weight };
                    heap.push((gains[u], u));
                }
            }
            let cost = self.cost();
            if cost < best {
                (best, kept) = (cost, moves.len());
            } else if moves.len() > kept + PATIENCE {
                break;
            }
        }
        moves.drain(kept..).rev().for_each(|v| self.shift(v));
    }
}
