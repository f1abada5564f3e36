//! Boundary of the soil: its contact elements and its traction-free elements.

use super::segment::{Segment, check_segment_count, check_segments};
use crate::bem::{ContactElement, Strip};
use crate::error::{Error, Result, require};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout, check_order};
use crate::linalg::DenseFactor;

/// Largest difference of lengths that counts as rounding, relative to the length of an element.
const LENGTH_TOLERANCE_RATIO: f64 = 1e-9;

/// Largest number of elements in a gap: this number already exceeds the memory limit.
const MAX_GAP_ELEMENTS: f64 = 1e6;

/// A polygonal boundary of the soil, with the contact elements under the structure.
///
/// ```
/// use basemat::bem::Strip;
/// use basemat::bem::full_plane::Boundary;
/// // As in the paper: five free elements on either side of the footing.
/// let boundary = Boundary::flat(&[Strip::uniform(-5.0..5.0, 10)?], 5)?;
/// assert_eq!(boundary.segments().len(), 20);
/// assert!((boundary.segments()[0].from[0] + 10.0).abs() < 1e-12);
/// assert!(boundary.is_flat());
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    segments: Vec<Segment>,
    contact_indices: Vec<usize>,
    contact_elements: Vec<ContactElement>,
}

/// Displacements of all elements due to unit tractions on the contact elements.
pub(super) struct ContactCompliance {
    /// Factor of H.
    pub(super) factor: DenseFactor,
    /// 2Q columns of length 2E.
    pub(super) columns: Vec<f64>,
}

impl Boundary {
    /// Flat surface z = 0 with strips from left to right and free elements around them.
    ///
    /// `free_count` is the number of traction-free elements on either side. Their length is the mean length of the
    /// elements of the adjacent strip. Elements of about this length fill the gaps between strips.
    ///
    /// # Errors
    /// [`Error::Size`] for no strips, [`Error::Input`] for strips out of order, [`Error::Memory`] for too many elements.
    pub fn flat(strips: &[Strip], free_count: usize) -> Result<Self> {
        let elements: Vec<_> = strips.iter().flat_map(Strip::elements).collect();
        check_order(&elements)?;
        check_segment_count(free_count)?;
        let first_length = mean_element_length(&strips[0]);
        let mut nodes: Vec<f64> = (1..=free_count)
            .rev()
            .map(|k| elements[0].left() - k as f64 * first_length)
            .collect();
        let mut contact_indices = Vec::with_capacity(elements.len());
        for (k, strip) in strips.iter().enumerate() {
            if k > 0 {
                // Elements in the gap between two strips.
                let begin = nodes.pop().unwrap_or_default();
                let end = strip.nodes()[0];
                nodes.push(begin);
                let length = mean_element_length(&strips[k - 1]).max(mean_element_length(strip));
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "≥ 0")]
                let gap_count = ((end - begin) / length - LENGTH_TOLERANCE_RATIO)
                    .ceil()
                    .clamp(0.0, MAX_GAP_ELEMENTS) as usize;
                for k in 1..gap_count {
                    nodes.push(begin + (end - begin) * k as f64 / gap_count as f64);
                }
                if gap_count == 0 {
                    nodes.pop();
                }
            }
            let first_segment = nodes.len();
            contact_indices.extend((0..strip.nodes().len() - 1).map(|e| first_segment + e));
            nodes.extend_from_slice(strip.nodes());
        }
        let right = elements[elements.len() - 1].right();
        let last_length = mean_element_length(&strips[strips.len() - 1]);
        nodes.extend((1..=free_count).map(|k| right + k as f64 * last_length));
        let segments = nodes
            .windows(2)
            .map(|ends| Segment { from: [ends[0], 0.0], to: [ends[1], 0.0] })
            .collect();
        Self::new(segments, &contact_indices)
    }

    /// Creates any boundary from its elements and the indices of the contact elements.
    ///
    /// `contact_indices`: elements under the structure, from left to right. Contact elements must be horizontal with the
    /// soil below. All others are free of traction.
    ///
    /// # Errors
    /// [`Error::Size`] for no elements, [`Error::Index`] for an index out of range, [`Error::Input`] for an
    /// element without length, an element that passes through the midpoint of another, or contact elements
    /// that are not horizontal or out of order.
    pub fn new(segments: Vec<Segment>, contact_indices: &[usize]) -> Result<Self> {
        check_segments(&segments)?;
        let mut contact_elements = Vec::with_capacity(contact_indices.len());
        for &index in contact_indices {
            let segment = segments.get(index).ok_or(Error::Index {
                quantity: "contact element",
                index,
                bound: segments.len(),
            })?;
            let rise = (segment.to[1] - segment.from[1]).abs();
            let is_horizontal = rise <= LENGTH_TOLERANCE_RATIO * segment.length();
            let needed = "none: contact elements are horizontal";
            require("rise of a contact element", rise, is_horizontal, needed)?;
            contact_elements.push(ContactElement::new(segment.from[0], segment.to[0]));
        }
        check_order(&contact_elements)?;
        Ok(Self { segments, contact_indices: contact_indices.to_vec(), contact_elements })
    }

    /// All elements.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Indices of the elements in contact.
    pub fn contact(&self) -> &[usize] {
        &self.contact_indices
    }

    /// The contact elements as intervals of x.
    pub fn contact_elements(&self) -> &[ContactElement] {
        &self.contact_elements
    }

    /// Layout of vectors of the boundary (2E, x first).
    pub(super) fn layout(&self) -> ContactLayout {
        ContactLayout::new(COMPONENTS_IN_PLANE, self.segments.len())
    }

    /// Row in vectors of the boundary for each component of a contact vector (2Q, down first).
    pub(super) fn contact_rows(&self) -> impl Iterator<Item = usize> + Clone {
        let contact_layout = ContactLayout::new(COMPONENTS_IN_PLANE, self.contact_indices.len());
        (0..contact_layout.len()).map(move |k| {
            let [component, element] = contact_layout.component_and_element(k);
            self.layout().index_of(1 - component, self.contact_indices[element])
        })
    }

    /// Displacements of all elements due to unit tractions on the contact elements.
    ///
    /// `g` and `h` are the coefficients of lag 0.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub(super) fn contact_compliance(&self, g: &[f64], h: &[f64]) -> Result<ContactCompliance> {
        let order = self.layout().len();
        let mut factor = DenseFactor::with_capacity(order);
        if !factor.factor(h, order) {
            return Err(Error::Singular { matrix: "boundary operator", order });
        }
        let mut columns = vec![0.0; self.contact_rows().count() * order];
        for (column, source_row) in columns.chunks_exact_mut(order).zip(self.contact_rows()) {
            for (i, value) in column.iter_mut().enumerate() {
                *value = g[i * order + source_row];
            }
            factor.solve(column);
        }
        Ok(ContactCompliance { factor, columns })
    }

    /// Overwrites `matrix` with the compliance of the contact elements (2Q × 2Q).
    ///
    /// `compliance_columns`: of a [`ContactCompliance`].
    pub(super) fn compliance(&self, compliance_columns: &[f64], matrix: &mut [f64]) {
        let contact_order = self.contact_rows().count();
        for (k, column) in compliance_columns.chunks_exact(self.layout().len()).enumerate() {
            for (i, row) in self.contact_rows().enumerate() {
                matrix[i * contact_order + k] = column[row];
            }
        }
    }

    /// Whether all elements lie on one horizontal line with the soil below.
    pub fn is_flat(&self) -> bool {
        let surface_z = self.segments[0].from[1];
        self.segments.iter().all(|segment| {
            let tolerance = LENGTH_TOLERANCE_RATIO * segment.length();
            (segment.from[1] - surface_z).abs() <= tolerance
                && (segment.to[1] - surface_z).abs() <= tolerance
                && segment.to[0] > segment.from[0]
        })
    }
}

/// Mean length of a strip's elements, m.
fn mean_element_length(strip: &Strip) -> f64 {
    let nodes = strip.nodes();
    (nodes[nodes.len() - 1] - nodes[0]) / (nodes.len() - 1) as f64
}
