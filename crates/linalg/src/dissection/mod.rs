//! Order of elimination of large sparse matrices by nested dissection.
//!
//! Rows with the same columns are one vertex of a graph. A separator splits the graph into two halves. Both halves are
//! eliminated before the separator, and each half is dissected in the same way. The halves are found on a coarse graph,
//! whose vertices are repeatedly joined pairs, and are improved while the graph is refined again (Karypis & Kumar 1998;
//! Fiduccia & Mattheyses 1982). For a block of bricks the factor has half as many entries as with the order of minimum
//! degree, and needs a third of the operations.

mod graph;
mod halves;

use std::collections::BinaryHeap;

pub(crate) use graph::Adjacency;
use graph::{CoarseGraph, Graph, MAX_COARSEST_VERTICES, NO_VERTEX, PatternGraph};
use halves::GraphHalves;

/// Largest number of vertices of a graph that is not dissected.
///
/// For so few vertices the order of minimum degree is as good.
const MAX_LEAF_VERTICES: usize = 60;
/// Number of halvings of the coarsest graph, of which the best is used.
///
/// A halving of so few vertices costs little.
const COARSEST_HALVING_COUNT: usize = 12;
/// Index of the separator among the parts; the halves are parts 0 and 1.
const SEPARATOR_PART: u8 = 2;
/// Largest size of a coarser graph, in per cent of the finer one.
///
/// With a slower reduction, further levels cost too much.
const MAX_COARSE_PERCENT: usize = 95;

/// Rows in the order of elimination.
///
/// `columns_of_row`: ascending columns of a row of a matrix with a symmetric pattern. `order_leaf` orders the
/// vertices of a small graph.
pub(super) fn dissection<'a>(
    order: usize,
    columns_of_row: impl Fn(usize) -> &'a [usize],
    order_leaf: impl Fn(&Adjacency) -> Option<Vec<usize>>,
) -> Option<Vec<usize>> {
    let PatternGraph { graph, rows } = PatternGraph::new(order, columns_of_row);
    let mut new_index = vec![NO_VERTEX; graph.len()];
    // Vertices in the reverse order of elimination: separators first.
    let mut reversed_order: Vec<usize> = Vec::with_capacity(graph.len());
    let mut pending: Vec<Vec<usize>> = vec![(0..graph.len()).collect()];
    while let Some(vertices) = pending.pop() {
        let subgraph = graph.subgraph(&vertices, &mut new_index);
        let mut parts = [(); 3].map(|()| Vec::new());
        if subgraph.len() > MAX_LEAF_VERTICES {
            for (&v, part) in vertices.iter().zip(vertex_parts(&subgraph)) {
                parts[usize::from(part)].push(v);
            }
        }
        let [first_half, second_half, separator] = parts;
        // The graph is small, or has no separator.
        if first_half.is_empty() || second_half.is_empty() {
            let leaf_order = order_leaf(&subgraph.adjacency())?;
            reversed_order.extend(leaf_order.into_iter().rev().map(|k| vertices[k]));
            continue;
        }
        let separator_graph = graph.subgraph(&separator, &mut new_index);
        let separator_order = order_leaf(&separator_graph.adjacency())?;
        reversed_order.extend(separator_order.into_iter().rev().map(|k| separator[k]));
        pending.push(first_half);
        pending.push(second_half);
    }
    Some(reversed_order.into_iter().rev().flat_map(|v| rows[v].iter().copied()).collect())
}

/// Part of each vertex: 0, 1 or [`SEPARATOR_PART`].
fn vertex_parts(graph: &Graph) -> Vec<u8> {
    let mut levels: Vec<CoarseGraph> = Vec::new();
    loop {
        let current_graph = levels.last().map_or(graph, |level| &level.graph);
        if current_graph.len() <= MAX_COARSEST_VERTICES {
            break;
        }
        let coarse_level = current_graph.coarser();
        if 100 * coarse_level.graph.len() > MAX_COARSE_PERCENT * current_graph.len() {
            break;
        }
        levels.push(coarse_level);
    }
    let coarsest_graph = levels.last().map_or(graph, |level| &level.graph);
    let start_count = COARSEST_HALVING_COUNT.min(coarsest_graph.len());
    let candidates = (0..start_count).map(|k| {
        let mut halves =
            GraphHalves::from_seed(coarsest_graph, k * coarsest_graph.len() / start_count);
        halves.improve();
        halves
    });
    let best_halves = candidates.min_by_key(GraphHalves::cost);
    let mut is_second = best_halves.map_or(Vec::new(), |halves| halves.is_second);
    while let Some(coarse_level) = levels.pop() {
        let finer_graph = levels.last().map_or(graph, |level| &level.graph);
        let is_finer_second =
            coarse_level.coarse_vertex.iter().map(|vertex| is_second[*vertex]).collect();
        let mut halves = GraphHalves::new(finer_graph, is_finer_second);
        halves.improve();
        is_second = halves.is_second;
    }
    parts_with_separator(graph, &is_second)
}

/// Part of each vertex, with a separator of vertices from both halves.
///
/// Vertices move to the separator until no edge joins the remaining halves.
fn parts_with_separator(graph: &Graph, is_second: &[bool]) -> Vec<u8> {
    let mut parts: Vec<u8> = is_second.iter().map(|is_second| u8::from(*is_second)).collect();
    // The vertex with the largest number of edges to the other half moves first.
    let mut heap: BinaryHeap<(usize, usize)> = (0..graph.len())
        .map(|v| (cut_edge_count(graph, &parts, v), v))
        .filter(|(count, _)| *count > 0)
        .collect();
    while let Some((old_count, v)) = heap.pop() {
        let count = cut_edge_count(graph, &parts, v);
        if count == old_count {
            parts[v] = SEPARATOR_PART;
        } else if count > 0 {
            heap.push((count, v));
        }
    }
    parts
}

/// Number of edges from a vertex to the other half.
///
/// Zero for a vertex of the separator.
fn cut_edge_count(graph: &Graph, parts: &[u8], v: usize) -> usize {
    if parts[v] == SEPARATOR_PART {
        return 0;
    }
    graph.neighbours(v).iter().filter(|(u, _)| parts[*u] == 1 - parts[v]).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns of the rows of a block of nodes.
    ///
    /// Each node has two rows, and neighbours in all directions.
    fn block_pattern(sides: [usize; 3]) -> Vec<Vec<usize>> {
        let count: usize = sides.iter().product();
        let position = |v: usize| [v % sides[0], v / sides[0] % sides[1], v / sides[0] / sides[1]];
        let mut rows = Vec::new();
        for v in (0..2 * count).map(|i| i / 2) {
            let neighbours = (0..count)
                .filter(|u| (0..3).all(|k| position(v)[k].abs_diff(position(*u)[k]) <= 1));
            rows.push(neighbours.flat_map(|u| [2 * u, 2 * u + 1]).collect());
        }
        rows
    }

    #[allow(clippy::unnecessary_wraps, reason = "`dissection` takes a fallible function")]
    fn natural_order(graph: &Adjacency) -> Option<Vec<usize>> {
        Some((0..graph.first_neighbours.len() - 1).collect())
    }

    #[test]
    fn separators_of_a_block_are_planes_and_the_order_has_every_row() {
        let rows = block_pattern([6, 5, 11]);
        let PatternGraph { graph, rows: vertex_rows } = PatternGraph::new(rows.len(), |i| &rows[i]);
        assert_eq!((graph.len(), rows.len()), (330, 660));
        assert!(vertex_rows.iter().all(|rows| rows.len() == 2));
        let parts = vertex_parts(&graph);
        let mut vertex_counts = [0; 3];
        for part in &parts {
            vertex_counts[usize::from(*part)] += 1;
        }
        assert_eq!(vertex_counts[usize::from(SEPARATOR_PART)], 30);
        assert!(vertex_counts[0].max(vertex_counts[1]) <= 180);
        for v in (0..graph.len()).filter(|v| parts[*v] != SEPARATOR_PART) {
            assert!(graph.neighbours(v).iter().all(|(u, _)| parts[*u] != 1 - parts[v]));
        }
        let mut order = dissection(rows.len(), |i| &rows[i], natural_order).unwrap();
        assert_eq!(dissection(rows.len(), |i| &rows[i], natural_order).unwrap(), order);
        assert!(order[600..].iter().all(|i| parts[i / 2] == SEPARATOR_PART));
        order.sort_unstable();
        assert!(order.into_iter().eq(0..660));
    }

    /// Separate chains, and rows without any entry.
    #[test]
    fn graphs_that_are_not_connected_are_ordered() {
        let mut rows: Vec<Vec<usize>> = (0..400)
            .map(|i: usize| {
                let ends = [i / 100 * 100, i / 100 * 100 + 99];
                (i.max(ends[0] + 1) - 1..=(i + 1).min(ends[1])).collect()
            })
            .collect();
        rows.extend((0..50).map(|_| Vec::new()));
        let mut order = dissection(rows.len(), |i| &rows[i], natural_order).unwrap();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..450));
    }
}
