//! Pairs of elements with the same relative position, each class stored once.

use std::collections::HashMap;

use super::segment::Segment;
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};

/// Coefficients of a pair in G and in H: `[row][column]`, row the receiver's component.
pub(super) type PairBlocks = [[[f64; 2]; 2]; 2];

/// Classes of pairs of midpoint and element that are translations of each other.
///
/// For horizontal elements also mirror images belong to the same class.
#[derive(Debug, Clone)]
pub(super) struct SegmentPairClasses {
    /// Representative (receiver, source) of each class.
    pub(super) classes: Vec<(usize, usize)>,
    /// For each class, the index of its view in `views`.
    view_of: Vec<usize>,
    /// Elements as seen from midpoints; on a circle there are E views for E² classes.
    views: Vec<SegmentView>,
    /// For each receiver and source: the class, and whether the pair is its mirror image (xz and zx change
    /// sign).
    pub(super) pairs: Vec<(usize, bool)>,
}

/// An element as seen from a midpoint.
#[derive(Debug, Clone, Copy)]
pub(super) struct SegmentView {
    /// Ends along the element's direction, m.
    pub(super) ends: [f64; 2],
    /// Height along the element's normal, m.
    pub(super) height: f64,
}

impl SegmentPairClasses {
    /// Classes of all pairs.
    pub(super) fn new(segments: &[Segment]) -> Self {
        let coordinates = segments.iter().flat_map(|segment| [segment.from, segment.to]).flatten();
        let span = coordinates.fold(f64::MIN_POSITIVE, |span, x| span.max(x.abs()));
        // Rounding of the nodes must not split a class: 1e-12 of the boundary's size is negligible.
        #[allow(clippy::cast_possible_truncation, reason = "at most 2e12")]
        let key = |length: f64| (length / span * 1e12).round() as i64;
        let mut numbers = HashMap::new();
        let mut classes = Vec::new();
        let mut pairs = Vec::with_capacity(segments.len() * segments.len());
        for (p, receiver) in segments.iter().enumerate() {
            for (q, source) in segments.iter().enumerate() {
                let x = receiver.center();
                let y = source.center();
                let across =
                    [key(source.to[0] - source.from[0]), key(source.to[1] - source.from[1])];
                let offset = [key(y[0] - x[0]), key(y[1] - x[1])];
                let mirrored = across[1] == 0 && offset[0] < 0;
                let place = [if mirrored { -offset[0] } else { offset[0] }, offset[1]];
                // Class, and whether its representative is the mirror image of the place.
                let class = *numbers.entry((across, place)).or_insert_with(|| {
                    classes.push((p, q));
                    (classes.len() - 1, mirrored)
                });
                pairs.push((class.0, mirrored != class.1));
            }
        }
        let mut numbers = HashMap::new();
        let mut views = Vec::new();
        let mut view_of = Vec::with_capacity(classes.len());
        for &(p, q) in &classes {
            let view = segment_view(segments[p].center(), &segments[q], p == q);
            let place = (key(view.ends[0]), key(view.ends[1]), key(view.height));
            view_of.push(*numbers.entry(place).or_insert_with(|| {
                views.push(view);
                views.len() - 1
            }));
        }
        Self { classes, view_of, views, pairs }
    }

    /// Overwrites G and H with the blocks of all classes.
    ///
    /// `local` returns the block of a view in the axes (d, n) of the source.
    pub(super) fn fill(
        &self,
        segments: &[Segment],
        g: &mut [f64],
        h: &mut [f64],
        free_term: f64,
        local: impl Fn(SegmentView) -> PairBlocks,
    ) {
        let count = segments.len();
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, segments.len());
        let local_blocks: Vec<PairBlocks> = self.views.iter().map(|view| local(*view)).collect();
        let mut blocks: Vec<PairBlocks> = Vec::with_capacity(self.classes.len());
        for (&(_, q), &view) in self.classes.iter().zip(&self.view_of) {
            let axes = [segments[q].direction(), segments[q].normal()];
            blocks.push(local_blocks[view].map(|block| rotate_block(block, axes)));
        }
        for (p, pairs) in self.pairs.chunks_exact(count).enumerate() {
            for (q, &(class, mirrored)) in pairs.iter().enumerate() {
                for (block, matrix) in blocks[class].iter().zip([&mut *g, &mut *h]) {
                    for i in 0..2 {
                        for j in 0..2 {
                            let value = if mirrored && i != j { -block[i][j] } else { block[i][j] };
                            matrix[layout.place(i, p) * layout.len() + layout.place(j, q)] = value;
                        }
                    }
                }
            }
        }
        for k in 0..layout.len() {
            h[k * (layout.len() + 1)] += free_term;
        }
    }
}

/// An element as seen from `point`; `is_self`: the point is the element's midpoint.
fn segment_view(point: [f64; 2], element: &Segment, is_self: bool) -> SegmentView {
    let half_length = 0.5 * element.length();
    if is_self {
        return SegmentView { ends: [-half_length, half_length], height: 0.0 };
    }
    let d = element.direction();
    let n = element.normal();
    let y = element.center();
    let offset = [y[0] - point[0], y[1] - point[1]];
    let along = offset[0] * d[0] + offset[1] * d[1];
    let height = offset[0] * n[0] + offset[1] * n[1];
    // Up to rounding, points on the element's line have height zero.
    let distance = offset[0].hypot(offset[1]);
    let height = if height.abs() < 1e-13 * distance { 0.0 } else { height };
    SegmentView { ends: [along - half_length, along + half_length], height }
}

/// Components (x, z) of a block in the axes (d, n).
fn rotate_block(block: [[f64; 2]; 2], axes: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let mut out = [[0.0; 2]; 2];
    for (i, row) in out.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            for a in 0..2 {
                for b in 0..2 {
                    *value += axes[a][i] * block[a][b] * axes[b][j];
                }
            }
        }
    }
    out
}
