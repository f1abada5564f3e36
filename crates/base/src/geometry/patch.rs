//! Checked list of the contact elements of a ground.

use std::ops::Range;

use super::{COMPONENTS_IN_PLANE, ContactElement, ContactLayout, far_ends, middle};
use crate::error::{Error, MemoryError, Result, at_least, memory, require};

/// Contact elements of a ground, checked for sizes, order and overlaps.
#[derive(Debug, Clone)]
pub struct Patch {
    elements: Vec<ContactElement>,
    /// Area of each element inside the outline, m² (in the plane: length, m).
    areas: Vec<f64>,
    /// Elements that face down, side by side; all of them unless the ground has walls.
    floor: Range<usize>,
}

impl Patch {
    /// Elements of a ground.
    ///
    /// Returns an error unless all elements have a size and equally many directions, and none overlap; in the plane
    /// they must also run from left to right. Returns an error for more elements than matrices between all of them allow.
    pub fn new(elements: Vec<ContactElement>) -> Result<Self> {
        check_count(elements.len(), ContactLayout::for_elements(&elements).components())?;
        Self::of_any_count(elements)
    }

    /// The same, but in plan for any number of elements.
    pub fn of_any_count(elements: Vec<ContactElement>) -> Result<Self> {
        let layout = ContactLayout::for_elements(&elements);
        if elements.iter().any(|element| element.directions().len() != layout.components()) {
            return Err(Error::Scene {
                quantity: "contact elements of the ground",
                needed: "all of them, or none, in plan",
            });
        }
        if layout.is_plan() {
            check_cells(&elements)?;
        } else {
            check_order(&elements)?;
        }
        let areas = elements.iter().map(ContactElement::area).collect();
        let floor = floor(&elements)?;
        Ok(Self { elements, areas, floor })
    }

    /// Elements that face down; all of them unless the ground has walls.
    pub fn floor(&self) -> Range<usize> {
        self.floor.clone()
    }

    /// Whether elements face to the side.
    pub fn has_walls(&self) -> bool {
        self.floor.len() < self.elements.len()
    }

    /// Parts of each element in its place: halves, in plan quarters.
    pub fn finer(&self) -> Result<Self> {
        Self::new(self.elements.iter().flat_map(ContactElement::parts).collect())
    }

    /// Order of the numbers of a contact vector.
    pub fn layout(&self) -> ContactLayout {
        ContactLayout::for_elements(&self.elements)
    }

    /// Whether the ground is one in plan, of three directions.
    pub fn is_plan(&self) -> bool {
        self.layout().is_plan()
    }

    /// Areas of the elements inside the outline, m²; in the plane their lengths, m. Tractions refer to these
    /// areas.
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// Converts a matrix that takes tractions of whole elements to one that takes tractions inside the
    /// outline.
    pub fn refer_inside(&self, matrix: &mut [f64]) {
        let layout = self.layout();
        for row in matrix.chunks_exact_mut(layout.len()) {
            self.spread_inside(row);
        }
    }

    /// Converts tractions inside the outline to tractions spread over whole elements.
    pub fn spread_inside(&self, traction: &mut [f64]) {
        for component in traction.chunks_exact_mut(self.elements.len()) {
            let parts = component.iter_mut().zip(&self.elements);
            parts.for_each(|(value, element)| *value *= element.fraction_inside());
        }
    }

    /// Middle `[x, y]` of the bounding box of all elements, m.
    pub fn center(&self) -> [f64; 2] {
        [0, 1]
            .map(|axis| middle(far_ends(self.elements.iter().map(|element| element.ends()[axis]))))
    }
}

/// Elements that face down.
///
/// Returns an error unless they are neighbours in the list.
fn floor(elements: &[ContactElement]) -> Result<Range<usize>> {
    let floor = ContactElement::faces(elements).floor;
    if floor.is_empty() {
        return Err(Error::Scene {
            quantity: "contact elements of the ground",
            needed: "some that face down",
        });
    }
    if elements[floor.clone()].iter().all(ContactElement::faces_down) {
        return Ok(floor);
    }
    Err(Error::Scene {
        quantity: "contact elements of the ground",
        needed: "those that face down next to each other, between the walls",
    })
}

impl std::ops::Deref for Patch {
    type Target = [ContactElement];

    fn deref(&self) -> &[ContactElement] {
        &self.elements
    }
}

/// Memory for each pair of elements, bytes: a dozen matrices of 2 × 2 numbers.
///
/// With 300 to 800 elements, a pair takes 202 to 271 bytes when a simulation is built, and 385 to 436 after the first
/// step on a graded strip.
const BYTES_PER_PAIR: f64 = 400.0;

/// Error if the matrices between this many elements, with this number of components each, exceed the memory.
pub fn check_count(count: usize, components: usize) -> std::result::Result<(), MemoryError> {
    let count = count as f64;
    // As many elements in the plane have matrices of the same size.
    let plane_count = count * (components as f64 / COMPONENTS_IN_PLANE as f64);
    memory::check("contact elements", count, BYTES_PER_PAIR * plane_count * plane_count)
}

/// Error unless there are elements, and each has a size.
fn check_sizes(elements: &[ContactElement]) -> Result<()> {
    at_least("list of contact elements", elements.len(), 1)?;
    elements.iter().try_for_each(ContactElement::check)
}

/// Error unless the elements are in the plane and have positive length, in order, without overlap.
pub fn check_order(elements: &[ContactElement]) -> Result<()> {
    check_count(elements.len(), COMPONENTS_IN_PLANE)?;
    check_sizes(elements)?;
    if elements.iter().any(|element| element.directions().len() != COMPONENTS_IN_PLANE) {
        return Err(Error::Scene {
            quantity: "contact elements",
            needed: "elements in the plane: those in plan need a `Plan`",
        });
    }
    for pair in elements.windows(2) {
        let overlap = pair[0].right() - pair[1].left();
        let is_apart = overlap
            <= ContactElement::MAX_OVERLAP_FRACTION * pair[0].length().min(pair[1].length());
        let needed = "at or right of the end of the element before it";
        require("left end of a contact element", pair[1].left(), is_apart, needed)?;
    }
    Ok(())
}

/// Error unless the rectangles have a size and do not overlap.
fn check_cells(elements: &[ContactElement]) -> Result<()> {
    check_sizes(elements)?;
    // Sorted by left ends: an element that begins beyond another's right end cannot overlap it.
    let mut order: Vec<_> = elements.iter().collect();
    order.sort_by(|one, other| one.left().total_cmp(&other.left()));
    for (place, element) in order.iter().enumerate() {
        for other in &order[place + 1..] {
            if !element.overlaps(other, 0) {
                break;
            }
            let needed = "beside or behind all others: elements do not overlap";
            let is_apart = !element.overlaps(other, 1);
            require("left end of a contact element", other.left(), is_apart, needed)?;
        }
    }
    Ok(())
}
