//! Boundary of the soil: its contact elements and its traction-free elements.

use super::segment::{Segment, check_count, check_segments};
use crate::bem::{ContactElement, Strip};
use crate::error::{Error, Result, require};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout, check_order};
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

/// Displacements of all elements due to unit tractions on the contact elements.
pub(super) struct Mobility {
    /// Factor of H.
    pub(super) factor: DenseFactor,
    /// 2Q columns of length 2E.
    pub(super) columns: Vec<f64>,
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
        let first_length = mean_element_length(&strips[0]);
        let mut nodes: Vec<f64> =
            (1..=free).rev().map(|k| elements[0].left() - k as f64 * first_length).collect();
        let mut contact = Vec::with_capacity(elements.len());
        for (k, strip) in strips.iter().enumerate() {
            if k > 0 {
                // Elements in the gap between two strips.
                let begin = nodes.pop().unwrap_or_default();
                let end = strip.nodes()[0];
                nodes.push(begin);
                let length = mean_element_length(&strips[k - 1]).max(mean_element_length(strip));
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "≥ 0")]
                let count = ((end - begin) / length - 1e-9).ceil().clamp(0.0, 1e6) as usize;
                for piece in 1..count {
                    nodes.push(begin + (end - begin) * piece as f64 / count as f64);
                }
                if count == 0 {
                    nodes.pop();
                }
            }
            let first_segment = nodes.len();
            contact.extend((0..strip.nodes().len() - 1).map(|e| first_segment + e));
            nodes.extend_from_slice(strip.nodes());
        }
        let right = elements[elements.len() - 1].right();
        let last_length = mean_element_length(&strips[strips.len() - 1]);
        nodes.extend((1..=free).map(|k| right + k as f64 * last_length));
        let segments = nodes
            .windows(2)
            .map(|ends| Segment { from: [ends[0], 0.0], to: [ends[1], 0.0] })
            .collect();
        Self::new(segments, &contact)
    }

    /// Any boundary; `contact` lists the indices of the elements under the structure, from left to right.
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
            let is_horizontal = rise <= 1e-9 * segment.length();
            let needed = "none: contact elements are horizontal";
            require("rise of a contact element", rise, is_horizontal, needed)?;
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
        ContactLayout::new(COMPONENTS_IN_PLANE, self.segments.len())
    }

    /// Place of each component of a contact vector (2Q, down first) in vectors of the boundary.
    pub(super) fn places(&self) -> impl Iterator<Item = usize> + Clone {
        let contact = ContactLayout::new(COMPONENTS_IN_PLANE, self.contact.len());
        (0..contact.len()).map(move |k| {
            let [component, element] = contact.origin(k);
            self.layout().place(1 - component, self.contact[element])
        })
    }

    /// Solves for the displacements of all elements due to unit tractions on the contact elements.
    ///
    /// `g` and `h` are the coefficients.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub(super) fn mobility(&self, g: &[f64], h: &[f64]) -> Result<Mobility> {
        let size = self.layout().len();
        let mut factor = DenseFactor::with_capacity(size);
        if !factor.factor(h, size) {
            return Err(Error::Singular { matrix: "boundary operator", order: size });
        }
        let mut columns = vec![0.0; self.places().count() * size];
        for (column, source) in columns.chunks_exact_mut(size).zip(self.places()) {
            for (i, value) in column.iter_mut().enumerate() {
                *value = g[i * size + source];
            }
            factor.solve(column);
        }
        Ok(Mobility { factor, columns })
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
        self.segments.iter().all(|segment| {
            let tolerance = 1e-9 * segment.length();
            (segment.from[1] - level).abs() <= tolerance
                && (segment.to[1] - level).abs() <= tolerance
                && segment.to[0] > segment.from[0]
        })
    }
}

/// Mean length of a strip's elements, m.
fn mean_element_length(strip: &Strip) -> f64 {
    let nodes = strip.nodes();
    (nodes[nodes.len() - 1] - nodes[0]) / (nodes.len() - 1) as f64
}
