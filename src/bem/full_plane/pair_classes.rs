//! Classes of pairs of elements with the same relative position.

use std::collections::HashMap;

use super::segment::Segment;
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};

/// Number of integer units of a key in the extent of the boundary.
const KEYS_PER_EXTENT: f64 = 1e12;
/// Largest height over distance that counts as rounding.
const HEIGHT_TOLERANCE: f64 = 1e-13;

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
    view_indices: Vec<usize>,
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
    /// Sorts all pairs into classes.
    pub(super) fn new(segments: &[Segment]) -> Self {
        let coordinates = segments.iter().flat_map(|segment| [segment.from, segment.to]).flatten();
        let extent = coordinates.fold(f64::MIN_POSITIVE, |extent, x| extent.max(x.abs()));
        // Rounding of the nodes must not divide a class: 1e-12 of the extent is negligible.
        #[allow(clippy::cast_possible_truncation, reason = "at most 2e12")]
        let key = |length: f64| (length / extent * KEYS_PER_EXTENT).round() as i64;
        let mut class_of_key = HashMap::new();
        let mut classes = Vec::new();
        let mut pairs = Vec::with_capacity(segments.len() * segments.len());
        for (p, receiver) in segments.iter().enumerate() {
            for (q, source) in segments.iter().enumerate() {
                let x = receiver.center();
                let y = source.center();
                let segment_key =
                    [key(source.to[0] - source.from[0]), key(source.to[1] - source.from[1])];
                let offset_key = [key(y[0] - x[0]), key(y[1] - x[1])];
                let is_mirrored = segment_key[1] == 0 && offset_key[0] < 0;
                let x_key = if is_mirrored { -offset_key[0] } else { offset_key[0] };
                // Class, and whether its representative is the mirror image of the pair with this key.
                let pair_key = (segment_key, [x_key, offset_key[1]]);
                let (class, is_representative_mirrored) =
                    *class_of_key.entry(pair_key).or_insert_with(|| {
                        classes.push((p, q));
                        (classes.len() - 1, is_mirrored)
                    });
                pairs.push((class, is_mirrored != is_representative_mirrored));
            }
        }
        let mut view_of_key = HashMap::new();
        let mut views = Vec::new();
        let mut view_indices = Vec::with_capacity(classes.len());
        for &(p, q) in &classes {
            let view = segment_view(segments[p].center(), &segments[q], p == q);
            let view_key = (key(view.ends[0]), key(view.ends[1]), key(view.height));
            view_indices.push(*view_of_key.entry(view_key).or_insert_with(|| {
                views.push(view);
                views.len() - 1
            }));
        }
        Self { classes, view_indices, views, pairs }
    }

    /// Overwrites G and H with the blocks of all classes.
    ///
    /// `view_block` returns the block of a view in the axes (d, n) of the source. `free_term` is added to the diagonal
    /// of H.
    pub(super) fn fill(
        &self,
        segments: &[Segment],
        g: &mut [f64],
        h: &mut [f64],
        free_term: f64,
        view_block: impl Fn(SegmentView) -> PairBlocks,
    ) {
        let segment_count = segments.len();
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, segment_count);
        let view_blocks: Vec<_> = self.views.iter().map(|view| view_block(*view)).collect();
        let mut blocks: Vec<PairBlocks> = Vec::with_capacity(self.classes.len());
        for (&(_, q), &view) in self.classes.iter().zip(&self.view_indices) {
            let axes = [segments[q].direction(), segments[q].normal()];
            blocks.push(view_blocks[view].map(|block| rotate_block(block, axes)));
        }
        for (p, receiver_pairs) in self.pairs.chunks_exact(segment_count).enumerate() {
            for (q, &(class, is_mirrored)) in receiver_pairs.iter().enumerate() {
                for (block, matrix) in blocks[class].iter().zip([&mut *g, &mut *h]) {
                    for i in 0..2 {
                        for j in 0..2 {
                            let changes_sign = is_mirrored && i != j;
                            let value = if changes_sign { -block[i][j] } else { block[i][j] };
                            matrix[layout.index_of(i, p) * layout.len() + layout.index_of(j, q)] =
                                value;
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

/// View of an element from `point`; `is_self`: the point is the element's midpoint.
fn segment_view(point: [f64; 2], element: &Segment, is_self: bool) -> SegmentView {
    let half_length = 0.5 * element.length();
    if is_self {
        return SegmentView { ends: [-half_length, half_length], height: 0.0 };
    }
    let d = element.direction();
    let n = element.normal();
    let y = element.center();
    let offset = [y[0] - point[0], y[1] - point[1]];
    let tangential_offset = offset[0] * d[0] + offset[1] * d[1];
    let normal_offset = offset[0] * n[0] + offset[1] * n[1];
    // Up to rounding, points on the line of the element have height zero.
    let distance = offset[0].hypot(offset[1]);
    let is_on_line = normal_offset.abs() < HEIGHT_TOLERANCE * distance;
    let height = if is_on_line { 0.0 } else { normal_offset };
    let ends = [tangential_offset - half_length, tangential_offset + half_length];
    SegmentView { ends, height }
}

/// Components (x, z) of a block in the axes (d, n).
fn rotate_block(block: [[f64; 2]; 2], axes: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let mut rotated_block = [[0.0; 2]; 2];
    for (i, row) in rotated_block.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            for a in 0..2 {
                for b in 0..2 {
                    *value += axes[a][i] * block[a][b] * axes[b][j];
                }
            }
        }
    }
    rotated_block
}
