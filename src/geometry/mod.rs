//! Geometry: contact elements, their order and that of their numbers; cells of a lattice; directions.

mod lattice;

pub(crate) use lattice::{Lattice, SERIES, offset};

use crate::error::{Error, MemoryError, Result, finite, memory, positive};

/// One boundary element of the base: the interval from `left` to `right` of the flat surface, m.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ContactElement {
    /// Left end, m.
    pub left: f64,
    /// Right end, m.
    pub right: f64,
}

impl ContactElement {
    /// Length, m.
    pub fn length(&self) -> f64 {
        self.right - self.left
    }

    /// Midpoint, m.
    pub fn center(&self) -> f64 {
        0.5 * (self.left + self.right)
    }
}

/// Components of motion and traction at each element: normal, tangential.
pub(crate) const COMPONENTS: usize = 2;

/// Order of the numbers in a contact vector: component by component, all elements from left to right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ContactLayout {
    elements: usize,
}

impl ContactLayout {
    pub(crate) const fn new(elements: usize) -> Self {
        Self { elements }
    }

    /// Numbers in a contact vector: 2Q.
    pub(crate) const fn len(self) -> usize {
        COMPONENTS * self.elements
    }

    /// Numbers in a matrix from contact vectors to contact vectors: 2Q × 2Q.
    pub(crate) const fn square(self) -> usize {
        self.len() * self.len()
    }

    /// Place of a component of `element`: 0 for the normal one, 1 for the tangential one.
    pub(crate) const fn place(self, component: usize, element: usize) -> usize {
        component * self.elements + element
    }

    /// Places of the components of `element`.
    pub(crate) const fn places(self, element: usize) -> [usize; COMPONENTS] {
        [element, self.elements + element]
    }

    /// Component and element to which a place belongs.
    pub(crate) const fn origin(self, place: usize) -> [usize; 2] {
        [place / self.elements, place % self.elements]
    }

    /// Normal and tangential numbers of a contact vector; short vectors lack some.
    pub(crate) fn split<T>(self, vector: &[T]) -> [&[T]; COMPONENTS] {
        vector.split_at(self.elements.min(vector.len())).into()
    }

    /// Normal and tangential numbers of a contact vector, to be changed.
    pub(crate) fn split_mut<T>(self, vector: &mut [T]) -> [&mut [T]; COMPONENTS] {
        vector.split_at_mut(self.elements.min(vector.len())).into()
    }
}

/// Bytes for each pair of elements: a dozen matrices of 2 × 2 numbers. Measured, 300 to 800
/// elements: 202 to 271 when a simulation is built, 385 to 436 after the first step on a graded strip.
const BYTES_PER_PAIR: f64 = 400.0;

/// Error for so many elements that the matrices between them would not fit into memory.
pub(crate) fn check_count(count: usize) -> std::result::Result<(), MemoryError> {
    let count = count as f64;
    memory::check("contact elements", count, BYTES_PER_PAIR * count * count)
}

/// Error unless the elements have positive length, in order, without overlap.
pub(crate) fn check_order(elements: &[ContactElement]) -> Result<()> {
    if elements.is_empty() {
        return Err(Error::Size { quantity: "list of contact elements", found: 0, needed: 1 });
    }
    check_count(elements.len())?;
    for element in elements {
        finite("left end of a contact element", element.left)?;
        finite("right end of a contact element", element.right)?;
        positive("length of a contact element", element.length())?;
    }
    for pair in elements.windows(2) {
        // Neighbours may differ by rounding of a common node.
        let overlap = pair[0].right - pair[1].left;
        if overlap > 1e-9 * pair[0].length().min(pair[1].length()) {
            return Err(Error::Input {
                quantity: "left end of a contact element",
                value: pair[1].left,
                needed: "at or right of the end of the element before it",
            });
        }
    }
    Ok(())
}

// Directions of degrees of freedom.

/// Direction of a degree of freedom at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Direction {
    /// Displacement to the right, m.
    X,
    /// Displacement upwards, m.
    Y,
    /// Rotation, counter-clockwise, rad.
    Rotation,
}

words! { Direction, "direction", {
    X = "x",
    Y = "y",
    Rotation = "rotation",
} }

/// Directions of elements without rotations.
pub(crate) const TRANSLATIONS: &[Direction] = &[Direction::X, Direction::Y];

/// Directions of beams and of masses with rotary inertia.
pub(crate) const FRAME: &[Direction] = &Direction::ALL;
