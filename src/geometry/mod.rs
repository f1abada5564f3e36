//! Geometry: contact elements and the order of their numbers, cells of a lattice, directions, and shapes of
//! foundations.

mod footing;
mod lattice;

pub(crate) use footing::{Edge, Footing};
pub(crate) use lattice::{Lattice, SERIES, offset};

use crate::error::{MemoryError, Result, at_least, finite, memory, positive, require};

/// Boundary element of the base: the interval from `left` to `right` of the flat surface, m.
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
    /// Left and right half.
    pub(crate) fn halves(&self) -> [Self; 2] {
        let Self { left, right } = *self;
        let middle = self.center();
        [Self { left, right: middle }, Self { left: middle, right }]
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.right - self.left
    }

    /// Midpoint, m.
    pub fn center(&self) -> f64 {
        0.5 * (self.left + self.right)
    }
}

/// Directions of motion and traction at each element of a ground in the plane: down, along x.
pub(crate) const PLANE: usize = 2;
/// Directions of motion and traction at each element of a ground in plan: down, along x, along y.
pub(crate) const SPACE: usize = 3;

/// Order of the numbers in a contact vector: component by component, all elements in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ContactLayout {
    components: usize,
    elements: usize,
}

impl ContactLayout {
    /// Layout of elements with [`PLANE`] or [`SPACE`] components each.
    pub(crate) const fn new(components: usize, elements: usize) -> Self {
        Self { components, elements }
    }

    /// Components of each element: down, along x, and in plan along y.
    pub(crate) const fn components(self) -> usize {
        self.components
    }

    /// Whether the ground is one in plan, of three directions.
    pub(crate) const fn is_plan(self) -> bool {
        self.components == SPACE
    }

    /// Axes along the surface: x (0), and in plan y (1).
    pub(crate) const fn axes(self) -> std::ops::Range<usize> {
        0..self.components - 1
    }

    /// Number of elements Q.
    pub(crate) const fn elements(self) -> usize {
        self.elements
    }

    /// Numbers in a contact vector: components × Q.
    pub(crate) const fn len(self) -> usize {
        self.components * self.elements
    }

    /// Numbers in a matrix from contact vectors to contact vectors.
    pub(crate) const fn square(self) -> usize {
        self.len() * self.len()
    }

    /// Place of a component of `element`: 0 for the normal one.
    pub(crate) const fn place(self, component: usize, element: usize) -> usize {
        component * self.elements + element
    }

    /// Places of the first N components of `element`.
    pub(crate) fn places<const N: usize>(self, element: usize) -> [usize; N] {
        std::array::from_fn(|component| self.place(component, element))
    }

    /// Component and element to which a place belongs.
    pub(crate) const fn origin(self, place: usize) -> [usize; 2] {
        [place / self.elements, place % self.elements]
    }

    /// The first N components of a contact vector, each for all elements; a short vector gives short slices.
    pub(crate) fn split<T, const N: usize>(self, mut vector: &[T]) -> [&[T]; N] {
        std::array::from_fn(|_| {
            let (own, rest) = vector.split_at(self.elements.min(vector.len()));
            vector = rest;
            own
        })
    }

    /// Mutable components of a contact vector, split as by [`ContactLayout::split`].
    pub(crate) fn split_mut<T, const N: usize>(self, mut vector: &mut [T]) -> [&mut [T]; N] {
        std::array::from_fn(|_| {
            let all = std::mem::take(&mut vector);
            let (own, rest) = all.split_at_mut(self.elements.min(all.len()));
            vector = rest;
            own
        })
    }
}

/// The elements of a ground: rectangles of the surface, one metre deep in the plane.
#[derive(Debug, Clone)]
pub(crate) struct Patch {
    elements: Vec<ContactElement>,
    /// Front and back end of each element along y, m.
    depths: Vec<[f64; 2]>,
    /// Fraction of each element's area inside the mat's outline, and the area inside, m² (in the plane:
    /// length, m).
    inside: Vec<f64>,
    areas: Vec<f64>,
    components: usize,
}

impl Patch {
    /// Elements of a ground with this number of directions.
    ///
    /// `depths`: front and back end of each element along y, m. `inside`: fraction of each element's area
    /// inside the outline. Returns an error unless all elements have a size and none overlap; in the plane
    /// they must also run from left to right.
    pub(crate) fn new(
        components: usize,
        elements: Vec<ContactElement>,
        depths: Vec<[f64; 2]>,
        inside: Vec<f64>,
    ) -> Result<Self> {
        for &part in &inside {
            let quantity = "fraction of an element inside the outline";
            require(quantity, part, part > 0.0 && part <= 1.0, "above 0 and at most 1")?;
        }
        match components {
            SPACE => check_cells(&elements, &depths)?,
            _ => check_order(&elements)?,
        }
        let sides = elements.iter().zip(&depths);
        let areas = sides.map(|(along, [front, back])| along.length() * (back - front));
        let areas = areas.zip(&inside).map(|(area, part)| area * part).collect();
        Ok(Self { elements, depths, inside, areas, components })
    }

    /// Both halves of each element in its place, in plan its quarters: left front, right front, left back, right back.
    pub(crate) fn finer(&self) -> Result<Self> {
        let (mut elements, mut depths, mut inside) = (vec![], vec![], vec![]);
        for (e, element) in self.elements.iter().enumerate() {
            let [front, back] = self.depths[e];
            let middle = 0.5 * (front + back);
            let rows = [[front, middle], [middle, back]];
            for ends in if self.is_plan() { &rows[..] } else { &self.depths[e..=e] } {
                elements.extend(element.halves());
                depths.extend([*ends; 2]);
                inside.extend([self.inside[e]; 2]);
            }
        }
        Self::new(self.components, elements, depths, inside)
    }

    /// Order of the numbers of a contact vector.
    pub(crate) fn layout(&self) -> ContactLayout {
        ContactLayout::new(self.components, self.elements.len())
    }

    /// Whether the ground is one in plan, of three directions.
    pub(crate) fn is_plan(&self) -> bool {
        self.layout().is_plan()
    }

    /// Front and back end of each element along y, m; `[0, 1]` in the plane.
    pub(crate) fn depths(&self) -> &[[f64; 2]] {
        &self.depths
    }

    /// Sides of an element along x and y, m.
    pub(crate) fn sides(&self, element: usize) -> [f64; 2] {
        let [front, back] = self.depths[element];
        [self.elements[element].length(), back - front]
    }

    /// Areas of the elements inside the outline, m²; in the plane their lengths, m. Tractions refer to these
    /// areas.
    pub(crate) fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// Converts a matrix that takes tractions of whole elements to one that takes tractions inside the
    /// outline.
    pub(crate) fn refer_inside(&self, matrix: &mut [f64]) {
        let layout = self.layout();
        for row in matrix.chunks_exact_mut(layout.len()) {
            self.spread_inside(row);
        }
    }

    /// Converts tractions inside the outline to tractions spread over whole elements.
    pub(crate) fn spread_inside(&self, traction: &mut [f64]) {
        for component in traction.chunks_exact_mut(self.elements.len()) {
            component.iter_mut().zip(&self.inside).for_each(|(value, part)| *value *= part);
        }
    }

    /// Middle `[x, y]` of the bounding box of all elements, m.
    pub(crate) fn center(&self) -> [f64; 2] {
        let along = self.elements.iter().map(|element| [element.left, element.right]);
        [far_ends(along), far_ends(self.depths.iter().copied())].map(middle)
    }

    /// Midpoint of an element `[x, y]`, m.
    pub(crate) fn middle(&self, element: usize) -> [f64; 2] {
        let [front, back] = self.depths[element];
        [self.elements[element].center(), 0.5 * (front + back)]
    }
}

/// The smallest low end and the largest high end.
pub(crate) fn far_ends(ends: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    ends.fold(none, |[least, most], [low, high]| [least.min(low), most.max(high)])
}

/// The smallest and the largest value.
pub(crate) fn span(values: impl Iterator<Item = f64>) -> [f64; 2] {
    far_ends(values.map(|value| [value; 2]))
}

/// The middle between two ends.
pub(crate) fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// Name of the axis x (0) or y (1) in plan; `None` in the plane, which has one axis along the surface.
pub(crate) fn axis_name(is_plan: bool, axis: usize) -> Option<char> {
    is_plan.then_some(['x', 'y'][axis])
}

impl std::ops::Deref for Patch {
    type Target = [ContactElement];

    fn deref(&self) -> &[ContactElement] {
        &self.elements
    }
}

/// Bytes for each pair of elements: a dozen matrices of 2 × 2 numbers. Measured with 300 to 800 elements: 202
/// to 271 when a simulation is built, 385 to 436 after the first step on a graded strip.
const BYTES_PER_PAIR: f64 = 400.0;

/// Error if the matrices between this many elements, with this number of components each, exceed the memory.
pub(crate) fn check_count(count: usize, components: usize) -> std::result::Result<(), MemoryError> {
    let count = count as f64;
    let numbers = count * (components as f64 / PLANE as f64);
    memory::check("contact elements", count, BYTES_PER_PAIR * numbers * numbers)
}

/// Error unless each element has finite ends, the left one first, and there are not too many.
fn check_lengths(elements: &[ContactElement], components: usize) -> Result<()> {
    at_least("list of contact elements", elements.len(), 1)?;
    check_count(elements.len(), components)?;
    for element in elements {
        finite("left end of a contact element", element.left)?;
        finite("right end of a contact element", element.right)?;
        positive("length of a contact element", element.length())?;
    }
    Ok(())
}

/// Fraction of an element's side by which neighbours may overlap, for the rounding of a common node.
const OVERLAP: f64 = 1e-9;

/// Error unless the elements have positive length, in order, without overlap.
pub(crate) fn check_order(elements: &[ContactElement]) -> Result<()> {
    check_lengths(elements, PLANE)?;
    for pair in elements.windows(2) {
        let overlap = pair[0].right - pair[1].left;
        let is_apart = overlap <= OVERLAP * pair[0].length().min(pair[1].length());
        let needed = "at or right of the end of the element before it";
        require("left end of a contact element", pair[1].left, is_apart, needed)?;
    }
    Ok(())
}

/// Error unless the rectangles have a size and do not overlap.
fn check_cells(elements: &[ContactElement], depths: &[[f64; 2]]) -> Result<()> {
    check_lengths(elements, SPACE)?;
    for [front, back] in depths {
        finite("front end of a contact element", *front)?;
        finite("back end of a contact element", *back)?;
        positive("depth of a contact element", back - front)?;
    }
    // Sorted by left ends: an element that begins beyond another's right end cannot overlap it.
    let mut order: Vec<_> = elements.iter().zip(depths).collect();
    order.sort_by(|one, other| one.0.left.total_cmp(&other.0.left));
    for (place, (element, [front, back])) in order.iter().enumerate() {
        for (other, [near, far]) in &order[place + 1..] {
            let along = element.right.min(other.right) - other.left;
            if along <= OVERLAP * element.length().min(other.length()) {
                break;
            }
            let across = back.min(*far) - front.max(*near);
            let is_apart = across <= OVERLAP * (back - front).min(far - near);
            let needed = "beside or behind all others: elements do not overlap";
            require("left end of a contact element", other.left, is_apart, needed)?;
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

words! { pub(crate) Direction, "direction", {
    X = "x",
    Y = "y",
    Rotation = "rotation",
} }

/// Directions of elements without rotations.
pub(crate) const TRANSLATIONS: &[Direction] = &[Direction::X, Direction::Y];

/// Directions of beams and of masses with rotary inertia.
pub(crate) const FRAME: &[Direction] = &Direction::ALL;

/// A number and its counterpart along y as one: with its sign in the plane, where that is zero.
pub(crate) fn resultant(along: f64, across: f64) -> f64 {
    if across == 0.0 { along } else { along.hypot(across) }
}
