//! Order of elimination of large sparse matrices by nested dissection.
//!
//! Rows with the same columns are one vertex of a graph. The graph falls into two halves without a separator: both
//! halves are eliminated first, and each is dissected in turn. Halves are found on a coarse graph, whose vertices
//! are pairs of pairs of vertices, and are improved while the graph is made finer again (Karypis & Kumar 1998;
//! Fiduccia & Mattheyses 1982). The factor of a block of bricks has half as many entries as with the minimum
//! degree, and takes a third of the operations.

mod graph;
mod halves;

use std::collections::BinaryHeap;

use graph::{COARSE, Graph, NONE};
use halves::Halves;

/// Vertices of a graph that is not dissected further.
const LEAF: usize = 60;
/// Number of starts on the coarsest graph, of which the best is taken.
const STARTS: usize = 12;
/// Part of a vertex in the separator; the halves are parts 0 and 1.
const SEPARATOR: u8 = 2;

/// Rows in the order of elimination.
///
/// `row`: columns of a row, ascending, of a matrix with a symmetric pattern. `leaf` orders the vertices of a small
/// graph: pointers to the neighbours of each vertex, and neighbours.
pub(super) fn dissection<'a>(
    order: usize,
    row: impl Fn(usize) -> &'a [usize],
    leaf: impl Fn(&[usize], &[usize]) -> Option<Vec<usize>>,
) -> Option<Vec<usize>> {
    let (graph, rows) = Graph::of_pattern(order, row);
    let mut place = vec![NONE; graph.len()];
    // Filled from the end: the separators first.
    let mut reversed: Vec<usize> = Vec::with_capacity(graph.len());
    let mut left: Vec<Vec<usize>> = vec![(0..graph.len()).collect()];
    while let Some(vertices) = left.pop() {
        let part = graph.part(&vertices, &mut place);
        let mut parts = [(); 3].map(|()| Vec::new());
        if part.len() > LEAF {
            for (&v, side) in vertices.iter().zip(dissected(&part)) {
                parts[usize::from(side)].push(v);
            }
        }
        let [one, other, separator] = parts;
        if one.is_empty() || other.is_empty() {
            let (start, neighbours) = part.pattern();
            reversed.extend(leaf(&start, &neighbours)?.into_iter().rev().map(|k| vertices[k]));
            continue;
        }
        let (start, neighbours) = graph.part(&separator, &mut place).pattern();
        reversed.extend(leaf(&start, &neighbours)?.into_iter().rev().map(|k| separator[k]));
        left.push(one);
        left.push(other);
    }
    Some(reversed.into_iter().rev().flat_map(|v| rows[v].iter().copied()).collect())
}

/// Part of each vertex: 0, 1 or [`SEPARATOR`].
fn dissected(graph: &Graph) -> Vec<u8> {
    let mut levels: Vec<(Graph, Vec<usize>)> = Vec::new();
    loop {
        let finest = levels.last().map_or(graph, |(coarse, _)| coarse);
        if finest.len() <= COARSE {
            break;
        }
        let (coarse, new) = finest.coarser();
        if 20 * coarse.len() > 19 * finest.len() {
            break;
        }
        levels.push((coarse, new));
    }
    let coarsest = levels.last().map_or(graph, |(coarse, _)| coarse);
    let starts = STARTS.min(coarsest.len());
    let grown = (0..starts).map(|k| {
        let mut own = Halves::grown(coarsest, k * coarsest.len() / starts);
        own.improve();
        own
    });
    let mut is_second = grown.min_by_key(Halves::cost).map_or(Vec::new(), |own| own.is_second);
    while let Some((_, new)) = levels.pop() {
        let finer = levels.last().map_or(graph, |(coarse, _)| coarse);
        let mut halves = Halves::new(finer, new.iter().map(|own| is_second[*own]).collect());
        halves.improve();
        is_second = halves.is_second;
    }
    separated(graph, &is_second)
}

/// Parts from two halves: the separator takes vertices until no edge joins the rest of the halves.
fn separated(graph: &Graph, is_second: &[bool]) -> Vec<u8> {
    let mut side: Vec<u8> = is_second.iter().map(|second| u8::from(*second)).collect();
    let cut = |side: &[u8], v: usize| {
        let across = graph.neighbours(v).iter().filter(|(u, _)| side[*u] == 1 - side[v]);
        if side[v] == SEPARATOR { 0 } else { across.count() }
    };
    // The vertex with the most edges to the other half first.
    let mut heap: BinaryHeap<(usize, usize)> =
        (0..graph.len()).map(|v| (cut(&side, v), v)).filter(|own| own.0 > 0).collect();
    while let Some((count, v)) = heap.pop() {
        let now = cut(&side, v);
        if now == count {
            side[v] = SEPARATOR;
        } else if now > 0 {
            heap.push((now, v));
        }
    }
    side
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vertices of a block with a neighbour in all directions, twice each.
    fn block(sides: [usize; 3]) -> Vec<Vec<usize>> {
        let [a, b, c] = sides;
        let place = |v: usize| [v % a, v / a % b, v / a / b];
        let near = |v: usize, u: usize| (0..3).all(|k| place(v)[k].abs_diff(place(u)[k]) <= 1);
        let row =
            |v: usize| (0..a * b * c).filter(move |u| near(v, *u)).flat_map(|u| [2 * u, 2 * u + 1]);
        (0..2 * a * b * c).map(|i| row(i / 2).collect()).collect()
    }

    #[test]
    fn separators_of_a_block_are_planes_and_the_order_has_every_row() {
        let rows = block([6, 5, 11]);
        let (graph, members) = Graph::of_pattern(rows.len(), |i| &rows[i]);
        assert_eq!((graph.len(), rows.len()), (330, 660));
        assert!(members.iter().all(|own| own.len() == 2));
        let side = dissected(&graph);
        let count = |part: u8| side.iter().map(|own| usize::from(*own == part)).sum::<usize>();
        assert_eq!(count(SEPARATOR), 30);
        assert!(count(0).max(count(1)) <= 180);
        for v in (0..graph.len()).filter(|v| side[*v] != SEPARATOR) {
            assert!(graph.neighbours(v).iter().all(|(u, _)| side[*u] != 1 - side[v]));
        }
        let natural = |start: &[usize], _: &[usize]| Some((0..start.len() - 1).collect());
        let mut found = dissection(rows.len(), |i| &rows[i], natural).unwrap();
        assert_eq!(dissection(rows.len(), |i| &rows[i], natural).unwrap(), found);
        assert!(found[600..].iter().all(|i| side[i / 2] == SEPARATOR));
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
        let natural = |start: &[usize], _: &[usize]| Some((0..start.len() - 1).collect());
        let mut found = dissection(rows.len(), |i| &rows[i], natural).unwrap();
        found.sort_unstable();
        assert!(found.into_iter().eq(0..450));
    }
}
