//! Order of elimination of large sparse matrices by nested dissection.
//!
//! Rows with the same columns are one vertex of a graph. Removing a separator splits the graph into two halves.
//! Both halves are eliminated before the separator, and each is dissected in turn. Halves are found on a coarse
//! graph, whose vertices are pairs of pairs of vertices, and are improved while the graph is refined again
//! (Karypis & Kumar 1998; Fiduccia & Mattheyses 1982). For a block of bricks the factor has half as many entries
//! as with the minimum degree, and takes a third of the operations.

mod graph;
mod halves;

use std::collections::BinaryHeap;

pub(crate) use graph::Adjacency;
use graph::{CoarseGraph, Graph, MAX_COARSEST_VERTICES, NO_VERTEX, PatternGraph};
use halves::GraphHalves;

/// Graphs up to this number of vertices are not dissected further.
const MAX_LEAF_VERTICES: usize = 60;
/// Number of starts on the coarsest graph; the best halves are used.
const COARSEST_STARTS: usize = 12;
/// Part of the vertices in the separator; the halves are parts 0 and 1.
const SEPARATOR_PART: u8 = 2;

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
    let mut place = vec![NO_VERTEX; graph.len()];
    // Filled from the end: the separators first.
    let mut reversed: Vec<usize> = Vec::with_capacity(graph.len());
    let mut pending: Vec<Vec<usize>> = vec![(0..graph.len()).collect()];
    while let Some(vertices) = pending.pop() {
        let subgraph = graph.subgraph(&vertices, &mut place);
        let mut parts = [(); 3].map(|()| Vec::new());
        if subgraph.len() > MAX_LEAF_VERTICES {
            for (&v, side) in vertices.iter().zip(dissected(&subgraph)) {
                parts[usize::from(side)].push(v);
            }
        }
        let [first_half, second_half, separator] = parts;
        // The graph is small, or no separator was found.
        if first_half.is_empty() || second_half.is_empty() {
            let leaf_order = order_leaf(&subgraph.adjacency())?;
            reversed.extend(leaf_order.into_iter().rev().map(|k| vertices[k]));
            continue;
        }
        let separator_graph = graph.subgraph(&separator, &mut place);
        let separator_order = order_leaf(&separator_graph.adjacency())?;
        reversed.extend(separator_order.into_iter().rev().map(|k| separator[k]));
        pending.push(first_half);
        pending.push(second_half);
    }
    Some(reversed.into_iter().rev().flat_map(|v| rows[v].iter().copied()).collect())
}

/// Part of each vertex: 0, 1 or [`SEPARATOR_PART`].
fn dissected(graph: &Graph) -> Vec<u8> {
    let mut levels: Vec<CoarseGraph> = Vec::new();
    loop {
        let current = levels.last().map_or(graph, |level| &level.graph);
        if current.len() <= MAX_COARSEST_VERTICES {
            break;
        }
        let coarse = current.coarser();
        // Few vertices had a neighbour to join.
        if 20 * coarse.graph.len() > 19 * current.len() {
            break;
        }
        levels.push(coarse);
    }
    let coarsest = levels.last().map_or(graph, |level| &level.graph);
    let starts = COARSEST_STARTS.min(coarsest.len());
    let candidates = (0..starts).map(|k| {
        let mut halves = GraphHalves::grown(coarsest, k * coarsest.len() / starts);
        halves.improve();
        halves
    });
    let best = candidates.min_by_key(GraphHalves::cost);
    let mut is_second = best.map_or(Vec::new(), |halves| halves.is_second);
    while let Some(coarse) = levels.pop() {
        let finer = levels.last().map_or(graph, |level| &level.graph);
        let projected = coarse.coarse_vertex.iter().map(|vertex| is_second[*vertex]).collect();
        let mut halves = GraphHalves::new(finer, projected);
        halves.improve();
        is_second = halves.is_second;
    }
    separated(graph, &is_second)
}

/// Part of each vertex, with a separator of vertices taken from two halves.
///
/// Vertices move to the separator until no edge joins the remaining halves.
fn separated(graph: &Graph, is_second: &[bool]) -> Vec<u8> {
    let mut side: Vec<u8> = is_second.iter().map(|second| u8::from(*second)).collect();
    // The vertex with the largest number of edges to the other half moves first.
    let mut heap: BinaryHeap<(usize, usize)> = (0..graph.len())
        .map(|v| (edges_to_other_half(graph, &side, v), v))
        .filter(|(count, _)| *count > 0)
        .collect();
    while let Some((old_count, v)) = heap.pop() {
        let count = edges_to_other_half(graph, &side, v);
        if count == old_count {
            side[v] = SEPARATOR_PART;
        } else if count > 0 {
            heap.push((count, v));
        }
    }
    side
}

/// Number of edges from a vertex to the other half; 0 for a vertex of the separator.
fn edges_to_other_half(graph: &Graph, side: &[u8], v: usize) -> usize {
    if side[v] == SEPARATOR_PART {
        return 0;
    }
    graph.neighbours(v).iter().filter(|(u, _)| side[*u] == 1 - side[v]).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vertices of a block with a neighbour in all directions, twice each.
    fn block(sides: [usize; 3]) -> Vec<Vec<usize>> {
        let count: usize = sides.iter().product();
        let place = |v: usize| [v % sides[0], v / sides[0] % sides[1], v / sides[0] / sides[1]];
        let mut rows = Vec::new();
        for v in (0..2 * count).map(|i| i / 2) {
            let near =
                (0..count).filter(|u| (0..3).all(|k| place(v)[k].abs_diff(place(*u)[k]) <= 1));
            rows.push(near.flat_map(|u| [2 * u, 2 * u + 1]).collect());
        }
        rows
    }

    #[allow(clippy::unnecessary_wraps, reason = "the type of the function that it stands for")]
    fn natural_order(graph: &Adjacency) -> Option<Vec<usize>> {
        Some((0..graph.start.len() - 1).collect())
    }

    #[test]
    fn separators_of_a_block_are_planes_and_the_order_has_every_row() {
        let rows = block([6, 5, 11]);
        let PatternGraph { graph, rows: members } = PatternGraph::new(rows.len(), |i| &rows[i]);
        assert_eq!((graph.len(), rows.len()), (330, 660));
        assert!(members.iter().all(|rows| rows.len() == 2));
        let side = dissected(&graph);
        let mut counts = [0; 3];
        for part in &side {
            counts[usize::from(*part)] += 1;
        }
        assert_eq!(counts[usize::from(SEPARATOR_PART)], 30);
        assert!(counts[0].max(counts[1]) <= 180);
        for v in (0..graph.len()).filter(|v| side[*v] != SEPARATOR_PART) {
            assert!(graph.neighbours(v).iter().all(|(u, _)| side[*u] != 1 - side[v]));
        }
        let mut found = dissection(rows.len(), |i| &rows[i], natural_order).unwrap();
        assert_eq!(dissection(rows.len(), |i| &rows[i], natural_order).unwrap(), found);
        assert!(found[600..].iter().all(|i| side[i / 2] == SEPARATOR_PART));
        found.sort_unstable();
        assert!(found.into_iter().eq(0..660));
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
        let mut found = dissection(rows.len(), |i| &rows[i], natural_order).unwrap();
        found.sort_unstable();
        assert!(found.into_iter().eq(0..450));
    }
}
