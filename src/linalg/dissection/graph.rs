//! Graphs with weights, made coarser by joining neighbours.

use std::collections::HashMap;

/// Vertices of a graph that is not made coarser.
pub(super) const COARSE: usize = 80;
/// Number of joined vertices of the largest weight that make up a graph.
const PARTS: i64 = 40;
/// Vertex without a number.
pub(super) const NONE: usize = usize::MAX;

/// Neighbour and weight of an edge.
type Edge = (usize, i64);

/// Undirected graph: vertices and edges have weights.
pub(super) struct Graph {
    /// First edge of each vertex, and the number of edges.
    start: Vec<usize>,
    edges: Vec<Edge>,
    pub(super) weight: Vec<i64>,
}

impl Graph {
    fn new() -> Self {
        Self { start: vec![0], edges: Vec::new(), weight: Vec::new() }
    }

    /// Graph of a pattern, and the rows of each vertex.
    pub(super) fn of_pattern<'a>(
        order: usize,
        row: impl Fn(usize) -> &'a [usize],
    ) -> (Self, Vec<Vec<usize>>) {
        let mut known: HashMap<&[usize], usize> = HashMap::new();
        let (mut rows, mut vertex): (Vec<Vec<usize>>, _) = (Vec::new(), vec![0; order]);
        for i in 0..order {
            let at = *known.entry(row(i)).or_insert(rows.len());
            if at == rows.len() {
                rows.push(Vec::new());
            }
            rows[at].push(i);
            vertex[i] = at;
        }
        let mut graph = Self::new();
        let mut last = vec![NONE; rows.len()];
        for (v, own) in rows.iter().enumerate() {
            last[v] = v;
            for &column in row(own[0]) {
                let other = vertex[column];
                if std::mem::replace(&mut last[other], v) != v {
                    graph.edges.push((other, 1));
                }
            }
            graph.start.push(graph.edges.len());
            graph.weight.push(i64::try_from(own.len()).unwrap_or(i64::MAX));
        }
        (graph, rows)
    }

    pub(super) fn len(&self) -> usize {
        self.weight.len()
    }

    pub(super) fn neighbours(&self, vertex: usize) -> &[Edge] {
        &self.edges[self.start[vertex]..self.start[vertex + 1]]
    }

    /// First neighbour of each vertex, and the neighbours of each vertex in ascending order.
    pub(super) fn pattern(&self) -> (Vec<usize>, Vec<usize>) {
        let mut neighbours: Vec<usize> = self.edges.iter().map(|(v, _)| *v).collect();
        for ends in self.start.windows(2) {
            neighbours[ends[0]..ends[1]].sort_unstable();
        }
        (self.start.clone(), neighbours)
    }

    /// Subgraph of these vertices; `place` is scratch without numbers.
    pub(super) fn part(&self, vertices: &[usize], place: &mut [usize]) -> Self {
        let mut part = Self::new();
        vertices.iter().enumerate().for_each(|(k, &v)| place[v] = k);
        for &v in vertices {
            let inner = self.neighbours(v).iter().filter(|(other, _)| place[*other] != NONE);
            part.edges.extend(inner.map(|&(other, weight)| (place[other], weight)));
            part.start.push(part.edges.len());
            part.weight.push(self.weight[v]);
        }
        for &v in vertices {
            place[v] = NONE;
        }
        part
    }

    /// The graph with neighbours joined in pairs, and the new vertex of each vertex.
    pub(super) fn coarser(&self) -> (Self, Vec<usize>) {
        let n = self.len();
        let total: i64 = self.weight.iter().sum();
        let heaviest = (total / PARTS).max(2);
        // An order without relation to the numbering, the same in every run.
        let mut visits: Vec<usize> = (0..n).collect();
        visits.sort_by_key(|v| v.wrapping_mul(2_654_435_761) & 0xffff_ffff);
        let mut mate = vec![NONE; n];
        for v in visits {
            if mate[v] != NONE {
                continue;
            }
            let free = self.neighbours(v).iter().filter(|(other, _)| {
                mate[*other] == NONE && self.weight[*other] + self.weight[v] <= heaviest
            });
            let best = free.max_by_key(|(u, weight)| (*weight, -self.weight[*u], NONE - u));
            let other = best.map_or(v, |(other, _)| *other);
            mate[v] = other;
            mate[other] = v;
        }
        let (mut new, mut firsts) = (vec![NONE; n], Vec::new());
        for v in 0..n {
            if new[v] == NONE {
                new[v] = firsts.len();
                new[mate[v]] = firsts.len();
                firsts.push(v);
            }
        }
        let mut coarse = Self::new();
        // Edge to each neighbour, if it is at or beyond the first edge of the vertex.
        let mut edge_to = vec![0; firsts.len()];
        for (own, &v) in firsts.iter().enumerate() {
            let (first, pair) = (coarse.edges.len(), [v, mate[v]]);
            let members = if pair[0] == pair[1] { &pair[..1] } else { &pair };
            for &(u, weight) in members.iter().flat_map(|member| self.neighbours(*member)) {
                let at = edge_to[new[u]];
                if new[u] == own {
                    continue;
                }
                if coarse.edges.get(at).is_some_and(|edge| at >= first && edge.0 == new[u]) {
                    coarse.edges[at].1 += weight;
                } else {
                    edge_to[new[u]] = coarse.edges.len();
                    coarse.edges.push((new[u], weight));
                }
            }
            coarse.start.push(coarse.edges.len());
            coarse.weight.push(members.iter().map(|member| self.weight[*member]).sum());
        }
        (coarse, new)
    }
}
