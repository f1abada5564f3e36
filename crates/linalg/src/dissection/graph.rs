//! Weighted graphs, made coarser by joining neighbours.

use std::collections::HashMap;

/// Graphs up to this number of vertices are not made coarser.
pub(super) const MAX_COARSEST_VERTICES: usize = 80;
/// Joined vertices weigh at most this fraction of the graph (one over the constant).
const MIN_COARSE_VERTICES: i64 = 40;
/// Number of a vertex that is not in the subgraph, or has no partner.
pub(super) const NO_VERTEX: usize = usize::MAX;

/// Neighbour and weight of an edge.
type Edge = (usize, i64);

/// Undirected graph: vertices and edges have weights.
pub(super) struct Graph {
    /// First edge of each vertex, and the number of edges.
    start: Vec<usize>,
    edges: Vec<Edge>,
    pub(super) weight: Vec<i64>,
}

/// Neighbours of all vertices, without weights.
pub(crate) struct Adjacency {
    /// Place of the first neighbour of each vertex, and the number of neighbours.
    pub start: Vec<usize>,
    /// The neighbours of each vertex, ascending.
    pub neighbours: Vec<usize>,
}

/// Graph whose vertices are one or two joined vertices of a finer graph.
pub(super) struct CoarseGraph {
    pub(super) graph: Graph,
    /// Vertex of this graph for each vertex of the finer graph.
    pub(super) coarse_vertex: Vec<usize>,
}

/// Graph of the symmetric pattern of a matrix.
pub(super) struct PatternGraph {
    pub(super) graph: Graph,
    /// Rows of each vertex, which have the same columns.
    pub(super) rows: Vec<Vec<usize>>,
}

impl PatternGraph {
    /// Graph of a pattern given by the ascending columns of each row.
    pub(super) fn new<'a>(order: usize, columns_of_row: impl Fn(usize) -> &'a [usize]) -> Self {
        let mut vertex_of_columns: HashMap<&[usize], usize> = HashMap::new();
        let mut rows: Vec<Vec<usize>> = Vec::new();
        let mut vertex = vec![0; order];
        for i in 0..order {
            let vertex_index = *vertex_of_columns.entry(columns_of_row(i)).or_insert(rows.len());
            if vertex_index == rows.len() {
                rows.push(Vec::new());
            }
            rows[vertex_index].push(i);
            vertex[i] = vertex_index;
        }
        let mut graph = Graph::new();
        let mut last = vec![NO_VERTEX; rows.len()];
        for (v, members) in rows.iter().enumerate() {
            last[v] = v;
            for &column in columns_of_row(members[0]) {
                let neighbour = vertex[column];
                if std::mem::replace(&mut last[neighbour], v) != v {
                    graph.edges.push((neighbour, 1));
                }
            }
            graph.start.push(graph.edges.len());
            graph.weight.push(i64::try_from(members.len()).unwrap_or(i64::MAX));
        }
        Self { graph, rows }
    }
}

impl Graph {
    fn new() -> Self {
        Self { start: vec![0], edges: Vec::new(), weight: Vec::new() }
    }

    pub(super) fn len(&self) -> usize {
        self.weight.len()
    }

    pub(super) fn neighbours(&self, vertex: usize) -> &[Edge] {
        &self.edges[self.start[vertex]..self.start[vertex + 1]]
    }

    /// The neighbours of all vertices, without weights.
    pub(super) fn adjacency(&self) -> Adjacency {
        let mut neighbours: Vec<usize> = self.edges.iter().map(|(v, _)| *v).collect();
        for ends in self.start.windows(2) {
            neighbours[ends[0]..ends[1]].sort_unstable();
        }
        Adjacency { start: self.start.clone(), neighbours }
    }

    /// Subgraph of these vertices; `place` is scratch without numbers.
    pub(super) fn subgraph(&self, vertices: &[usize], place: &mut [usize]) -> Self {
        let mut subgraph = Self::new();
        vertices.iter().enumerate().for_each(|(k, &v)| place[v] = k);
        for &v in vertices {
            let inner = self.neighbours(v).iter().filter(|(other, _)| place[*other] != NO_VERTEX);
            subgraph.edges.extend(inner.map(|&(other, weight)| (place[other], weight)));
            subgraph.start.push(subgraph.edges.len());
            subgraph.weight.push(self.weight[v]);
        }
        for &v in vertices {
            place[v] = NO_VERTEX;
        }
        subgraph
    }

    /// Partner of each vertex: a neighbour, or the vertex itself.
    fn matching(&self) -> Vec<usize> {
        let n = self.len();
        let total: i64 = self.weight.iter().sum();
        let max_weight = (total / MIN_COARSE_VERTICES).max(2);
        // An order without relation to the numbering, the same in every run.
        let mut visits: Vec<usize> = (0..n).collect();
        visits.sort_by_key(|v| v.wrapping_mul(2_654_435_761) & 0xffff_ffff);
        let mut partner_of = vec![NO_VERTEX; n];
        for v in visits {
            if partner_of[v] != NO_VERTEX {
                continue;
            }
            let free = self.neighbours(v).iter().filter(|(neighbour, _)| {
                partner_of[*neighbour] == NO_VERTEX
                    && self.weight[*neighbour] + self.weight[v] <= max_weight
            });
            let best = free.max_by_key(|(u, weight)| (*weight, -self.weight[*u], NO_VERTEX - u));
            let partner = best.map_or(v, |(neighbour, _)| *neighbour);
            partner_of[v] = partner;
            partner_of[partner] = v;
        }
        partner_of
    }

    /// The graph with neighbours joined in pairs.
    pub(super) fn coarser(&self) -> CoarseGraph {
        let n = self.len();
        let partner_of = self.matching();
        let mut coarse_vertex = vec![NO_VERTEX; n];
        let mut representatives = Vec::new();
        for v in 0..n {
            if coarse_vertex[v] == NO_VERTEX {
                coarse_vertex[v] = representatives.len();
                coarse_vertex[partner_of[v]] = representatives.len();
                representatives.push(v);
            }
        }
        let mut coarse = Self::new();
        // Edge to each neighbour, if it is at or beyond the first edge of the vertex.
        let mut edge_to = vec![0; representatives.len()];
        for (new_vertex, &v) in representatives.iter().enumerate() {
            let first_edge = coarse.edges.len();
            let pair = [v, partner_of[v]];
            let members = if pair[0] == pair[1] { &pair[..1] } else { &pair };
            for &(u, weight) in members.iter().flat_map(|member| self.neighbours(*member)) {
                let neighbour = coarse_vertex[u];
                if neighbour == new_vertex {
                    continue;
                }
                let place = edge_to[neighbour];
                let edge = coarse.edges.get_mut(place).filter(|_| place >= first_edge);
                if let Some(edge) = edge.filter(|edge| edge.0 == neighbour) {
                    edge.1 += weight;
                } else {
                    edge_to[neighbour] = coarse.edges.len();
                    coarse.edges.push((neighbour, weight));
                }
            }
            coarse.start.push(coarse.edges.len());
            coarse.weight.push(members.iter().map(|member| self.weight[*member]).sum());
        }
        CoarseGraph { graph: coarse, coarse_vertex }
    }
}
