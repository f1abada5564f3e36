//! The boundary of the soil: its contact elements, its traction-free elements, and pairs of elements.

use std::collections::HashMap;

use crate::bem::{ContactElement, Strip};
use crate::error::{Error, MemoryError, Result, finite, memory, positive, require};
use crate::geometry::{ContactLayout, PLANE, check_order};
use crate::linalg::DenseFactor;

/// A polygonal boundary of the soil, with the contact elements under the structure.
///
/// ```
/// use basemat::bem::Strip;
/// use basemat::bem::full_plane::Boundary;
/// // The paper's: five free elements on either side of the footing.
/// let boundary = Boundary::flat(&[Strip::uniform(-5.0..5.0, 10)?], 5)?;
/// assert_eq!(boundary.segments().len(), 20);
/// assert!((boundary.segments()[0].from[0] + 10.0).abs() < 1e-12);
/// assert!(boundary.is_flat());
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    segments: Vec<Segment>,
    contact: Vec<usize>,
    elements: Vec<ContactElement>,
}

impl Boundary {
    /// Flat surface z = 0 with strips from left to right and free elements around them.
    ///
    /// `free` is the number of traction-free elements on either side. They are as long as the mean element of
    /// the adjacent strip. Gaps between strips are filled with elements of about this length.
    ///
    /// # Errors
    /// [`Error::Size`] for no strips, [`Error::Input`] for strips out of order or too many elements.
    pub fn flat(strips: &[Strip], free: usize) -> Result<Self> {
        let elements: Vec<_> = strips.iter().flat_map(Strip::elements).collect();
        check_order(&elements)?;
        check_count(free)?;
        let mean = |strip: &Strip| {
            let nodes = strip.nodes();
            (nodes[nodes.len() - 1] - nodes[0]) / (nodes.len() - 1) as f64
        };
        let (first, last) = (&strips[0], &strips[strips.len() - 1]);
        let mut nodes: Vec<f64> =
            (1..=free).rev().map(|k| elements[0].left() - k as f64 * mean(first)).collect();
        let mut contact = Vec::with_capacity(elements.len());
        for (k, strip) in strips.iter().enumerate() {
            if k > 0 {
                let (begin, end) = (nodes.pop().unwrap_or_default(), strip.nodes()[0]);
                nodes.push(begin);
                let size = mean(&strips[k - 1]).max(mean(strip));
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "≥ 0")]
                let pieces = ((end - begin) / size - 1e-9).ceil().clamp(0.0, 1e6) as usize;
                for piece in 1..pieces {
                    nodes.push(begin + (end - begin) * piece as f64 / pieces as f64);
                }
                if pieces == 0 {
                    nodes.pop();
                }
            }
            let from = nodes.len();
            contact.extend((0..strip.nodes().len() - 1).map(|e| from + e));
            nodes.extend_from_slice(strip.nodes());
        }
        let right = elements[elements.len() - 1].right();
        nodes.extend((1..=free).map(|k| right + k as f64 * mean(last)));
        let segments =
            nodes.windows(2).map(|n| Segment { from: [n[0], 0.0], to: [n[1], 0.0] }).collect();
        Self::new(segments, &contact)
    }

    /// Any boundary; `contact` holds the indices of the elements under the structure, from left to right.
    ///
    /// Contact elements must be horizontal with the soil below. All others are free of traction.
    ///
    /// # Errors
    /// [`Error::Size`] for no elements, [`Error::Index`] for an index out of range, [`Error::Input`] for an
    /// element without length, an element that passes through the midpoint of another, or contact elements
    /// that are not horizontal or out of order.
    pub fn new(segments: Vec<Segment>, contact: &[usize]) -> Result<Self> {
        check_segments(&segments)?;
        let mut elements = Vec::with_capacity(contact.len());
        for &index in contact {
            let segment = segments.get(index).ok_or(Error::Index {
                quantity: "contact element",
                index,
                bound: segments.len(),
            })?;
            let rise = (segment.to[1] - segment.from[1]).abs();
            let flat = rise <= 1e-9 * segment.length();
            let needed = "none: contact elements are horizontal";
            require("rise of a contact element", rise, flat, needed)?;
            elements.push(ContactElement::new(segment.from[0], segment.to[0]));
        }
        check_order(&elements)?;
        Ok(Self { segments, contact: contact.to_vec(), elements })
    }

    /// All elements.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Indices of the elements in contact.
    pub fn contact(&self) -> &[usize] {
        &self.contact
    }

    /// The contact elements as intervals of x.
    pub fn contact_elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// Order of vectors of the boundary (2E, x first).
    pub(super) fn layout(&self) -> ContactLayout {
        ContactLayout::new(PLANE, self.segments.len())
    }

    /// Place of each component of a contact vector (2Q, down first) in vectors of the boundary.
    pub(super) fn places(&self) -> impl Iterator<Item = usize> + Clone {
        let contact = ContactLayout::new(PLANE, self.contact.len());
        (0..contact.len()).map(move |k| {
            let [component, element] = contact.origin(k);
            self.layout().place(1 - component, self.contact[element])
        })
    }

    /// Factor of `h`, and displacements of all elements due to unit tractions on the contact elements.
    ///
    /// `g` and `h` are the coefficients. The displacements are 2Q columns of length 2E.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub(super) fn mobility(&self, g: &[f64], h: &[f64]) -> Result<(DenseFactor, Vec<f64>)> {
        let size = self.layout().len();
        let mut factor = DenseFactor::with_capacity(size);
        if !factor.factor(h, size) {
            return Err(Error::Singular { matrix: "boundary operator", order: size });
        }
        let mut mobility = vec![0.0; self.places().count() * size];
        for (column, source) in mobility.chunks_exact_mut(size).zip(self.places()) {
            for (i, value) in column.iter_mut().enumerate() {
                *value = g[i * size + source];
            }
            factor.solve(column);
        }
        Ok((factor, mobility))
    }

    /// Overwrites `matrix` (2Q × 2Q) with the rows of the contact elements in `mobility`.
    pub(super) fn compliance(&self, mobility: &[f64], matrix: &mut [f64]) {
        let width = self.places().count();
        for (k, column) in mobility.chunks_exact(self.layout().len()).enumerate() {
            for (i, place) in self.places().enumerate() {
                matrix[i * width + k] = column[place];
            }
        }
    }

    /// Whether all elements lie on one horizontal line with the soil below.
    pub fn is_flat(&self) -> bool {
        let level = self.segments[0].from[1];
        let on = |segment: &Segment| {
            let tolerance = 1e-9 * segment.length();
            (segment.from[1] - level).abs() <= tolerance
                && (segment.to[1] - level).abs() <= tolerance
                && segment.to[0] > segment.from[0]
        };
        self.segments.iter().all(on)
    }
}

// Straight boundary elements.

/// A straight boundary element.
///
/// The soil is on the right-hand side when moving from `from` to `to`, seen with x to the right and z
/// **down** (on a flat surface: from left to right).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// First end, (x, z), m.
    pub from: [f64; 2],
    /// Second end, (x, z), m.
    pub to: [f64; 2],
}

impl Segment {
    /// Length, m.
    pub fn length(&self) -> f64 {
        (self.to[0] - self.from[0]).hypot(self.to[1] - self.from[1])
    }

    /// Midpoint (x, z), m: the collocation point of the boundary equation.
    pub fn center(&self) -> [f64; 2] {
        [0.5 * (self.from[0] + self.to[0]), 0.5 * (self.from[1] + self.to[1])]
    }

    /// Unit vector (x, z) along the element.
    pub fn direction(&self) -> [f64; 2] {
        let length = self.length();
        [(self.to[0] - self.from[0]) / length, (self.to[1] - self.from[1]) / length]
    }

    /// Unit normal (x, z) pointing out of the soil: (0, −1) on a flat surface.
    pub fn normal(&self) -> [f64; 2] {
        let [along, down] = self.direction();
        [down, -along]
    }

    /// Distance (m) of a point (x, z) from the element.
    fn distance(&self, point: [f64; 2]) -> f64 {
        let (d, n, y) = (self.direction(), self.normal(), self.center());
        let offset = [point[0] - y[0], point[1] - y[1]];
        let along = (offset[0] * d[0] + offset[1] * d[1]).abs() - 0.5 * self.length();
        along.max(0.0).hypot(offset[0] * n[0] + offset[1] * n[1])
    }
}

/// Bytes for each pair of elements: eight dense operators of 2 × 2 numbers.
const BYTES_PER_PAIR: f64 = 256.0;

/// Error if the operators between so many elements would not fit into memory.
pub(super) fn check_count(count: usize) -> std::result::Result<(), MemoryError> {
    let count = count as f64;
    memory::check("boundary elements", count, BYTES_PER_PAIR * count * count)
}

/// Error unless there are elements, all have length, and none passes through the midpoint of another.
pub(super) fn check_segments(segments: &[Segment]) -> Result<()> {
    if segments.is_empty() {
        return Err(Error::Size { quantity: "list of boundary elements", found: 0, needed: 1 });
    }
    check_count(segments.len())?;
    for segment in segments {
        for coordinate in segment.from.into_iter().chain(segment.to) {
            finite("end of a boundary element", coordinate)?;
        }
        positive("length of a boundary element", segment.length())?;
    }
    for (q, source) in segments.iter().enumerate() {
        for (p, receiver) in segments.iter().enumerate() {
            let distance = source.distance(receiver.center());
            let apart = p == q || distance >= 1e-6 * source.length().min(receiver.length());
            let quantity = "distance of a boundary element from the midpoint of another";
            require(quantity, distance, apart, "at least 1e-6 of the shorter")?;
        }
    }
    Ok(())
}

// Pairs of elements with the same relative position; each class is stored once.

/// Coefficients of a pair in G and in H: `[row][column]`, row the receiver's component.
pub(super) type PairBlocks = [[[f64; 2]; 2]; 2];

/// Classes of pairs of midpoint and element that are translations of each other.
///
/// For horizontal elements also mirror images belong to the same class.
#[derive(Debug, Clone)]
pub(super) struct PairClasses {
    /// Representative (receiver, source) of each class.
    pub(super) classes: Vec<(usize, usize)>,
    /// For each class, the index of its view in `views`.
    view_of: Vec<usize>,
    /// Ends along the element and height, as seen from the midpoint; on a circle there are E views for E²
    /// classes.
    views: Vec<([f64; 2], f64)>,
    /// For each receiver and source: the class, and whether the pair is its mirror image (xz and zx change
    /// sign).
    pub(super) pairs: Vec<(usize, bool)>,
}

impl PairClasses {
    pub(super) fn new(segments: &[Segment]) -> Self {
        let far = |s: &Segment| s.from.iter().chain(&s.to).fold(0.0_f64, |m, x| m.max(x.abs()));
        let span = segments.iter().map(far).fold(f64::MIN_POSITIVE, f64::max);
        // Rounding of the nodes must not split a class: 1e-12 of the boundary's size is negligible.
        #[allow(clippy::cast_possible_truncation, reason = "at most 2e12")]
        let key = |length: f64| (length / span * 1e12).round() as i64;
        let mut numbers = HashMap::new();
        let mut classes = Vec::new();
        let mut pairs = Vec::with_capacity(segments.len() * segments.len());
        for (p, receiver) in segments.iter().enumerate() {
            for (q, source) in segments.iter().enumerate() {
                let (x, y) = (receiver.center(), source.center());
                let across =
                    [key(source.to[0] - source.from[0]), key(source.to[1] - source.from[1])];
                let offset = [key(y[0] - x[0]), key(y[1] - x[1])];
                let mirrored = across[1] == 0 && offset[0] < 0;
                let place = [if mirrored { -offset[0] } else { offset[0] }, offset[1]];
                let (class, other) = *numbers.entry((across, place)).or_insert_with(|| {
                    classes.push((p, q));
                    (classes.len() - 1, mirrored)
                });
                pairs.push((class, mirrored != other));
            }
        }
        let (mut numbers, mut views) = (HashMap::new(), Vec::new());
        let view_of = classes
            .iter()
            .map(|&(p, q): &(usize, usize)| {
                let seen = view(segments[p].center(), &segments[q], p == q);
                let place = (key(seen.0[0]), key(seen.0[1]), key(seen.1));
                *numbers.entry(place).or_insert_with(|| {
                    views.push(seen);
                    views.len() - 1
                })
            })
            .collect();
        Self { classes, view_of, views, pairs }
    }

    /// Overwrites G and H with the blocks of all classes.
    ///
    /// `local` returns the block of a class in the axes (d, n) of the source. Its arguments are the source's
    /// ends along d and its height along n, relative to the receiver's midpoint.
    pub(super) fn fill(
        &self,
        segments: &[Segment],
        g: &mut [f64],
        h: &mut [f64],
        free_term: f64,
        local: impl Fn([f64; 2], f64) -> PairBlocks,
    ) {
        let (count, layout) = (segments.len(), ContactLayout::new(PLANE, segments.len()));
        let seen: Vec<PairBlocks> =
            self.views.iter().map(|&(ends, height)| local(ends, height)).collect();
        let blocks: Vec<PairBlocks> = self
            .classes
            .iter()
            .zip(&self.view_of)
            .map(|(&(_, q), &view)| {
                let axes = [segments[q].direction(), segments[q].normal()];
                seen[view].map(|block| turn(block, axes))
            })
            .collect();
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

/// Ends along the element's direction and height along its normal, relative to `point`.
pub(super) fn view(point: [f64; 2], element: &Segment, itself: bool) -> ([f64; 2], f64) {
    let half = 0.5 * element.length();
    if itself {
        return ([-half, half], 0.0);
    }
    let (d, n, y) = (element.direction(), element.normal(), element.center());
    let offset = [y[0] - point[0], y[1] - point[1]];
    let along = offset[0] * d[0] + offset[1] * d[1];
    let height = offset[0] * n[0] + offset[1] * n[1];
    // Up to rounding, points on the element's line have height zero.
    let size = offset[0].hypot(offset[1]);
    let height = if height.abs() < 1e-13 * size { 0.0 } else { height };
    ([along - half, along + half], height)
}

/// Components (x, z) of a block in the axes (d, n).
fn turn(block: [[f64; 2]; 2], axes: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
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
