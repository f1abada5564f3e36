//! Geometry: contact elements and the order of their numbers, cells of a lattice, directions, and shapes of
//! foundations.

mod circle;
mod direction;
mod element;
mod footing;
mod lattice;
mod patch;

pub use circle::circle;
pub use direction::Direction;
pub use direction::{PLANE_DIRECTIONS, PLANE_TRANSLATIONS, SPACE_DIRECTIONS};
pub use element::ContactElement;
#[doc(hidden)]
pub use element::OutlineFaces;
pub use footing::{Edge, Footing};
pub use lattice::{Lattice, SERIES_PER_OFFSET, lattice_cells, offset};
pub use patch::{Patch, check_count, check_order};

/// Components of a traction on an element in the plane: down, along x.
pub const COMPONENTS_IN_PLANE: usize = 2;
/// Components of a traction on an element in plan: down, along x, along y.
pub const COMPONENTS_IN_SPACE: usize = 3;

/// Order of the numbers in a contact vector: component by component, all elements in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ContactLayout {
    components: usize,
    elements: usize,
}

impl ContactLayout {
    /// Layout of elements with [`COMPONENTS_IN_PLANE`] or [`COMPONENTS_IN_SPACE`] components each.
    pub const fn new(components: usize, elements: usize) -> Self {
        Self { components, elements }
    }

    /// Layout of these elements, which have equally many directions.
    pub fn for_elements(elements: &[ContactElement]) -> Self {
        Self::new(
            elements.first().map_or(COMPONENTS_IN_PLANE, |element| element.directions().len()),
            elements.len(),
        )
    }

    /// Components of each element: down, along x, and in plan along y.
    pub const fn components(self) -> usize {
        self.components
    }

    /// Whether the elements are in plan: three components each.
    pub const fn is_plan(self) -> bool {
        self.components == COMPONENTS_IN_SPACE
    }

    /// Axes along the surface: x (0), and in plan y (1).
    pub const fn axes(self) -> std::ops::Range<usize> {
        0..self.components - 1
    }

    /// Sign of base moment and rotation relative to the right-hand rule about y.
    ///
    /// 1 in plan; −1 in the plane, where they count counter-clockwise.
    pub const fn turn(self) -> f64 {
        [-1.0, 1.0][self.is_plan() as usize]
    }

    /// Number of elements Q.
    pub const fn elements(self) -> usize {
        self.elements
    }

    /// Numbers in a contact vector: components × Q.
    pub const fn len(self) -> usize {
        self.components * self.elements
    }

    /// Numbers in a matrix from contact vectors to contact vectors.
    pub const fn square(self) -> usize {
        self.len() * self.len()
    }

    /// Place of a component of `element`: 0 for the normal one.
    pub const fn place(self, component: usize, element: usize) -> usize {
        component * self.elements + element
    }

    /// Places of the first N components of `element`.
    pub fn places<const N: usize>(self, element: usize) -> [usize; N] {
        std::array::from_fn(|component| self.place(component, element))
    }

    /// Component and element to which a place belongs.
    pub const fn origin(self, place: usize) -> [usize; 2] {
        [place / self.elements, place % self.elements]
    }

    /// The first N components of a contact vector, each for all elements; a short vector gives short slices.
    pub fn split<T, const N: usize>(self, mut vector: &[T]) -> [&[T]; N] {
        std::array::from_fn(|_| {
            let count = self.elements.min(vector.len());
            let component = &vector[..count];
            vector = &vector[count..];
            component
        })
    }

    /// Mutable components of a contact vector, split as by [`ContactLayout::split`].
    pub fn split_mut<T, const N: usize>(self, mut vector: &mut [T]) -> [&mut [T]; N] {
        std::array::from_fn(|_| {
            let remaining = std::mem::take(&mut vector);
            let (component, rest) = remaining.split_at_mut(self.elements.min(remaining.len()));
            vector = rest;
            component
        })
    }
}

/// The smallest low end and the largest high end.
pub fn far_ends(ends: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let mut far = [f64::INFINITY, f64::NEG_INFINITY];
    for [low, high] in ends {
        far = [far[0].min(low), far[1].max(high)];
    }
    far
}

/// The smallest and the largest value.
pub fn span(values: impl Iterator<Item = f64>) -> [f64; 2] {
    far_ends(values.map(|value| [value; 2]))
}

/// Distance between two ends that counts as rounding, relative to the interval.
const END_TOLERANCE_FACTOR: f64 = 1e-9;

/// Number of intervals in a row: the fewest that lead from the first end to the last.
pub fn in_a_row(mut ends: Vec<[f64; 2]>) -> usize {
    ends.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let mut count = 0;
    // End of the intervals counted so far, and the largest end of all intervals so far.
    let mut counted_end = f64::NEG_INFINITY;
    let mut largest_end = f64::NEG_INFINITY;
    let mut tolerance = 0.0;
    for [low, high] in ends {
        tolerance = END_TOLERANCE_FACTOR * (high - low);
        if low > counted_end + tolerance {
            count += 1;
            counted_end = if low > largest_end + tolerance { high } else { largest_end };
        }
        largest_end = largest_end.max(high);
    }
    count + usize::from(largest_end > counted_end + tolerance)
}

/// The middle between two ends.
pub fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// Name of the axis x (0) or y (1) in plan; `None` in the plane, which has one axis along the surface.
pub fn axis_name(is_plan: bool, axis: usize) -> Option<char> {
    is_plan.then_some(['x', 'y'][axis])
}

/// Resultant of a component along x and one along y.
///
/// In the plane, where the component along y is zero, it keeps the sign of the component along x.
pub fn resultant(along: f64, across: f64) -> f64 {
    if across == 0.0 { along } else { along.hypot(across) }
}
