//! Checked list of the contact elements of a ground.

use std::ops::Range;

use super::{COMPONENTS_IN_PLANE, ContactElement, ContactLayout, enclosing_interval, middle};
use crate::error::{Error, MemoryError, Result, at_least, memory, require};

/// Contact elements of a ground, checked for sizes, order and overlaps.
#[derive(Debug, Clone)]
pub struct Patch {
    elements: Vec<ContactElement>,
    /// Area of each element inside the outline, m² (in the plane: length, m).
    areas: Vec<f64>,
    /// Indices of the adjacent elements that face down; all of them unless the ground has walls.
    floor: Range<usize>,
}

impl Patch {
    /// Checked elements of a ground.
    ///
    /// Returns an error unless all elements have positive sides and equal numbers of directions, and none overlap; in
    /// the plane they must also be in order from left to right. Returns an error for so many elements that the matrices
    /// between all pairs exceed the memory limit.
    pub fn new(elements: Vec<ContactElement>) -> Result<Self> {
        check_count(elements.len(), ContactLayout::for_elements(&elements).components())?;
        Self::of_any_count(elements)
    }

    /// Checked elements of a ground, in plan for any number of elements.
    pub fn of_any_count(elements: Vec<ContactElement>) -> Result<Self> {
        let layout = ContactLayout::for_elements(&elements);
        if elements.iter().any(|element| element.directions().len() != layout.components()) {
            return Err(Error::Scene {
                quantity: "contact elements of the ground",
                needed: "all elements in plan, or all in the plane",
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

    /// Indices of the elements that face down; all of them unless the ground has walls.
    pub fn floor(&self) -> Range<usize> {
        self.floor.clone()
    }

    /// Whether any element belongs to a wall.
    pub fn has_walls(&self) -> bool {
        self.floor.len() < self.elements.len()
    }

    /// The patch with each element halved, or quartered in plan.
    pub fn refined(&self) -> Result<Self> {
        Self::new(self.elements.iter().flat_map(ContactElement::parts).collect())
    }

    /// Order of the entries of a contact vector.
    pub fn layout(&self) -> ContactLayout {
        ContactLayout::for_elements(&self.elements)
    }

    /// Whether the elements are in plan, with three components each.
    pub fn is_plan(&self) -> bool {
        self.layout().is_plan()
    }

    /// Areas of the elements inside the outline, m²; in the plane their lengths, m.
    ///
    /// Tractions refer to these areas.
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// Converts a matrix for tractions on whole elements to a matrix for tractions inside the outline.
    pub fn refer_inside(&self, matrix: &mut [f64]) {
        let layout = self.layout();
        for row in matrix.chunks_exact_mut(layout.len()) {
            self.spread_inside(row);
        }
    }

    /// Converts tractions inside the outline to tractions spread over whole elements.
    pub fn spread_inside(&self, traction: &mut [f64]) {
        for component in traction.chunks_exact_mut(self.elements.len()) {
            for (value, element) in component.iter_mut().zip(&self.elements) {
                *value *= element.fraction_inside();
            }
        }
    }

    /// Middle `[x, y]` of the bounding box of all elements, m.
    pub fn center(&self) -> [f64; 2] {
        [0, 1].map(|axis| {
            middle(enclosing_interval(self.elements.iter().map(|element| element.ends()[axis])))
        })
    }
}

/// Indices of the elements that face down.
///
/// Returns an error unless these elements are adjacent in the list.
fn floor(elements: &[ContactElement]) -> Result<Range<usize>> {
    let floor = ContactElement::faces(elements).floor;
    if floor.is_empty() {
        return Err(Error::Scene {
            quantity: "contact elements of the ground",
            needed: "at least one element that faces down",
        });
    }
    if elements[floor.clone()].iter().all(ContactElement::faces_down) {
        return Ok(floor);
    }
    Err(Error::Scene {
        quantity: "contact elements of the ground",
        needed: "all elements that face down adjacent in the list, between those of the walls",
    })
}

impl std::ops::Deref for Patch {
    type Target = [ContactElement];

    fn deref(&self) -> &[ContactElement] {
        &self.elements
    }
}

/// Memory for each pair of elements, bytes: about twelve matrices of 2 × 2 numbers.
///
/// With 300 to 800 elements, a pair needs 202 to 271 bytes when a simulation is built, and 385 to 436 bytes after the
/// first step on a graded strip.
const BYTES_PER_PAIR: f64 = 400.0;

/// Returns an error if the matrices between all pairs of elements exceed the memory limit.
///
/// `component_count`: number of components of each element.
pub fn check_count(
    element_count: usize,
    component_count: usize,
) -> std::result::Result<(), MemoryError> {
    let count = element_count as f64;
    // This number of elements in the plane has matrices of the same size.
    let plane_count = count * (component_count as f64 / COMPONENTS_IN_PLANE as f64);
    memory::check("contact elements", count, BYTES_PER_PAIR * plane_count * plane_count)
}

/// Returns an error unless there are elements, all with positive sides.
fn check_sizes(elements: &[ContactElement]) -> Result<()> {
    at_least("list of contact elements", elements.len(), 1)?;
    elements.iter().try_for_each(ContactElement::check)
}

/// Returns an error unless the elements are a base in the plane.
///
/// They must have positive lengths, be in order, and not overlap.
pub fn check_order(elements: &[ContactElement]) -> Result<()> {
    check_count(elements.len(), COMPONENTS_IN_PLANE)?;
    check_sizes(elements)?;
    if elements.iter().any(|element| element.directions().len() != COMPONENTS_IN_PLANE) {
        return Err(Error::Scene {
            quantity: "contact elements",
            needed: "elements in the plane: elements in plan need a `Plan`",
        });
    }
    for pair in elements.windows(2) {
        let overlap = pair[0].right() - pair[1].left();
        let is_apart = overlap
            <= ContactElement::MAX_OVERLAP_FRACTION * pair[0].length().min(pair[1].length());
        let needed = "at or right of the right end of the previous element";
        require("left end of a contact element", pair[1].left(), is_apart, needed)?;
    }
    Ok(())
}

/// Returns an error unless the rectangles have positive sides and do not overlap.
fn check_cells(elements: &[ContactElement]) -> Result<()> {
    check_sizes(elements)?;
    // The elements are sorted by left ends: if one begins beyond the right end of `element`, so do all later elements.
    let mut sorted_elements: Vec<_> = elements.iter().collect();
    sorted_elements.sort_by(|one, other| one.left().total_cmp(&other.left()));
    for (k, element) in sorted_elements.iter().enumerate() {
        for other in &sorted_elements[k + 1..] {
            if !element.overlaps(other, 0) {
                break;
            }
            let needed = "outside all other elements: elements must not overlap";
            let is_apart = !element.overlaps(other, 1);
            require("left end of a contact element", other.left(), is_apart, needed)?;
        }
    }
    Ok(())
}
