//! Weighted graphs, and their coarsening by joining neighbours.

use std::collections::HashMap;

/// Largest number of vertices of a graph that is not coarsened.
///
/// Halves of such a graph are found directly.
pub(super) const MAX_COARSEST_VERTICES: usize = 80;
/// Smallest number of coarse vertices.
///
/// A joined vertex has at most the graph's weight over this number.
const MIN_COARSE_VERTICES: i64 = 40;
/// Index that stands for no vertex: outside the subgraph, or without a partner.
pub(super) const NO_VERTEX: usize = usize::MAX;

/// Neighbouring vertex and weight of an edge.
type Edge = (usize, i64);

/// Multiplier of Knuth's multiplicative hash for 32 bits: 2³² over the golden ratio.
const HASH_MULTIPLIER: usize = 2_654_435_761;
/// Lowest 32 bits.
const HASH_MASK: usize = 0xffff_ffff;

/// Undirected graph with weights of vertices and edges.
pub(super) struct Graph {
    /// Index of the first edge of each vertex, then the number of edges.
    first_edges: Vec<usize>,
    edges: Vec<Edge>,
    pub(super) vertex_weights: Vec<i64>,
}

/// Neighbours of all vertices, without weights.
pub(crate) struct Adjacency {
    /// Index of the first neighbour of each vertex, then the number of neighbours.
    pub first_neighbours: Vec<usize>,
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
    /// Rows of the matrix that each vertex represents: they have the same columns.
    pub(super) rows: Vec<Vec<usize>>,
}

impl PatternGraph {
    /// Graph of the pattern with these ascending columns in each row.
    pub(super) fn new<'a>(order: usize, columns_of_row: impl Fn(usize) -> &'a [usize]) -> Self {
        let mut vertex_of_columns: HashMap<&[usize], usize> = HashMap::new();
        let mut rows: Vec<Vec<usize>> = Vec::new();
        let mut vertex_of_row = vec![0; order];
        for row in 0..order {
            let vertex = *vertex_of_columns.entry(columns_of_row(row)).or_insert(rows.len());
            if vertex == rows.len() {
                rows.push(Vec::new());
            }
            rows[vertex].push(row);
            vertex_of_row[row] = vertex;
        }
        let mut graph = Graph::new();
        // The vertex from which each vertex was reached last: it has only one edge to each neighbour.
        let mut last_visitor = vec![NO_VERTEX; rows.len()];
        for (v, vertex_rows) in rows.iter().enumerate() {
            last_visitor[v] = v;
            for &column in columns_of_row(vertex_rows[0]) {
                let neighbour = vertex_of_row[column];
                if std::mem::replace(&mut last_visitor[neighbour], v) != v {
                    graph.edges.push((neighbour, 1));
                }
            }
            graph.first_edges.push(graph.edges.len());
            graph.vertex_weights.push(i64::try_from(vertex_rows.len()).unwrap_or(i64::MAX));
        }
        Self { graph, rows }
    }
}

impl Graph {
    fn new() -> Self {
        Self { first_edges: vec![0], edges: Vec::new(), vertex_weights: Vec::new() }
    }

    /// Number of vertices.
    pub(super) fn len(&self) -> usize {
        self.vertex_weights.len()
    }

    /// Edges of a vertex.
    pub(super) fn neighbours(&self, vertex: usize) -> &[Edge] {
        &self.edges[self.first_edges[vertex]..self.first_edges[vertex + 1]]
    }

    /// The neighbours of all vertices, without weights.
    pub(super) fn adjacency(&self) -> Adjacency {
        let mut neighbours: Vec<usize> = self.edges.iter().map(|(v, _)| *v).collect();
        for ends in self.first_edges.windows(2) {
            neighbours[ends[0]..ends[1]].sort_unstable();
        }
        Adjacency { first_neighbours: self.first_edges.clone(), neighbours }
    }

    /// Subgraph of these vertices.
    ///
    /// `new_index`: scratch, [`NO_VERTEX`] for all vertices before and after.
    pub(super) fn subgraph(&self, vertices: &[usize], new_index: &mut [usize]) -> Self {
        let mut subgraph = Self::new();
        vertices.iter().enumerate().for_each(|(k, &v)| new_index[v] = k);
        for &v in vertices {
            let edges = self.neighbours(v).iter().filter(|(u, _)| new_index[*u] != NO_VERTEX);
            subgraph.edges.extend(edges.map(|&(u, weight)| (new_index[u], weight)));
            subgraph.first_edges.push(subgraph.edges.len());
            subgraph.vertex_weights.push(self.vertex_weights[v]);
        }
        for &v in vertices {
            new_index[v] = NO_VERTEX;
        }
        subgraph
    }

    /// Partner of each vertex: a neighbour, or the vertex itself.
    fn matching(&self) -> Vec<usize> {
        let n = self.len();
        let total_weight: i64 = self.vertex_weights.iter().sum();
        let max_weight = (total_weight / MIN_COARSE_VERTICES).max(2);
        // A pseudorandom order, the same in every run: the numbering of a mesh would pair vertices in one direction.
        let mut visits: Vec<usize> = (0..n).collect();
        visits.sort_by_key(|v| v.wrapping_mul(HASH_MULTIPLIER) & HASH_MASK);
        let mut partner_of = vec![NO_VERTEX; n];
        for v in visits {
            if partner_of[v] != NO_VERTEX {
                continue;
            }
            let candidates = self.neighbours(v).iter().filter(|(u, _)| {
                partner_of[*u] == NO_VERTEX
                    && self.vertex_weights[*u] + self.vertex_weights[v] <= max_weight
            });
            let best_edge = candidates
                .max_by_key(|(u, weight)| (*weight, -self.vertex_weights[*u], NO_VERTEX - u));
            let partner = best_edge.map_or(v, |(u, _)| *u);
            partner_of[v] = partner;
            partner_of[partner] = v;
        }
        partner_of
    }

    /// Coarser graph, whose vertices are pairs of joined neighbours.
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
        let mut coarse_graph = Self::new();
        // Index of the newest edge to each vertex. An index from the first edge of the current vertex on is its edge.
        let mut edge_to = vec![0; representatives.len()];
        for (new_vertex, &v) in representatives.iter().enumerate() {
            let first_edge = coarse_graph.edges.len();
            let pair = [v, partner_of[v]];
            let members = if pair[0] == pair[1] { &pair[..1] } else { &pair };
            for &(u, weight) in members.iter().flat_map(|member| self.neighbours(*member)) {
                let neighbour = coarse_vertex[u];
                if neighbour == new_vertex {
                    continue;
                }
                let edge_index = edge_to[neighbour];
                let edge =
                    coarse_graph.edges.get_mut(edge_index).filter(|_| edge_index >= first_edge);
                if let Some(edge) = edge.filter(|edge| edge.0 == neighbour) {
                    edge.1 += weight;
                } else {
                    edge_to[neighbour] = coarse_graph.edges.len();
                    coarse_graph.edges.push((neighbour, weight));
                }
            }
            coarse_graph.first_edges.push(coarse_graph.edges.len());
            coarse_graph
                .vertex_weights
                .push(members.iter().map(|member| self.vertex_weights[*member]).sum());
        }
        CoarseGraph { graph: coarse_graph, coarse_vertex }
    }
}
