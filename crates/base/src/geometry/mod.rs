//! Geometry of contact elements, lattices, directions and foundations.

mod direction;
mod element;
mod footing;
mod lattice;
mod patch;

pub use direction::Direction;
pub use direction::{PLANE_DIRECTIONS, PLANE_TRANSLATIONS, SPACE_DIRECTIONS};
pub use element::ContactElement;
#[doc(hidden)]
pub use element::OutlineFaces;
pub use footing::{Edge, Footing, circle};
pub use lattice::{COMPLIANCES_PER_OFFSET, Lattice, lattice_cells, offset};
pub use patch::{Patch, check_count, check_order};

/// Number of components of a traction on an element in the plane: down, along x.
pub const COMPONENTS_IN_PLANE: usize = 2;
/// Number of components of a traction on an element in plan: down, along x, along y.
pub const COMPONENTS_IN_SPACE: usize = 3;

/// Cross product of two vectors in a plane: the component along its normal.
pub fn cross_in_plane(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Order of the entries of a contact vector: component by component, each over all elements.
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

    /// Layout of these elements, which have equal numbers of directions.
    pub fn for_elements(elements: &[ContactElement]) -> Self {
        Self::new(
            elements.first().map_or(COMPONENTS_IN_PLANE, |element| element.directions().len()),
            elements.len(),
        )
    }

    /// Number of components of each element: down, along x, and in plan along y.
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
    /// 1 in plan; −1 in the plane, where both are positive counter-clockwise.
    pub const fn rotation_sign(self) -> f64 {
        [-1.0, 1.0][self.is_plan() as usize]
    }

    /// Number of elements Q.
    pub const fn elements(self) -> usize {
        self.elements
    }

    /// Number of entries of a contact vector: components × Q.
    pub const fn len(self) -> usize {
        self.components * self.elements
    }

    /// Number of entries of a square matrix for contact vectors.
    pub const fn matrix_len(self) -> usize {
        self.len() * self.len()
    }

    /// Index in a contact vector of a component (0: the normal one) of `element`.
    pub const fn index_of(self, component: usize, element: usize) -> usize {
        component * self.elements + element
    }

    /// Indices in a contact vector of the first N components of `element`.
    pub fn indices_of<const N: usize>(self, element: usize) -> [usize; N] {
        std::array::from_fn(|component| self.index_of(component, element))
    }

    /// Component and element of an index in a contact vector.
    pub const fn component_and_element(self, index: usize) -> [usize; 2] {
        [index / self.elements, index % self.elements]
    }

    /// The first N components of a contact vector, each for all elements.
    ///
    /// A short vector gives short slices.
    pub fn split<T, const N: usize>(self, mut vector: &[T]) -> [&[T]; N] {
        std::array::from_fn(|_| {
            let entry_count = self.elements.min(vector.len());
            let component = &vector[..entry_count];
            vector = &vector[entry_count..];
            component
        })
    }

    /// Mutable components of a contact vector, split as by [`ContactLayout::split`].
    pub fn split_mut<T, const N: usize>(self, mut vector: &mut [T]) -> [&mut [T]; N] {
        std::array::from_fn(|_| {
            let entries = std::mem::take(&mut vector);
            let (component, other_components) =
                entries.split_at_mut(self.elements.min(entries.len()));
            vector = other_components;
            component
        })
    }
}

/// Smallest interval that contains all intervals.
pub fn enclosing_interval(intervals: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let mut interval = [f64::INFINITY, f64::NEG_INFINITY];
    for [low, high] in intervals {
        interval = [interval[0].min(low), interval[1].max(high)];
    }
    interval
}

/// Smallest and largest value.
pub fn span(values: impl Iterator<Item = f64>) -> [f64; 2] {
    enclosing_interval(values.map(|value| [value; 2]))
}

/// Distance between two ends that counts as a rounding error, relative to the interval.
const END_TOLERANCE_FACTOR: f64 = 1e-9;

/// Smallest number of the intervals that together cover all of them.
pub fn min_interval_count(mut intervals: Vec<[f64; 2]>) -> usize {
    intervals.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let mut count = 0;
    // End of the counted intervals, and the largest end of all intervals so far.
    let mut counted_end = f64::NEG_INFINITY;
    let mut largest_end = f64::NEG_INFINITY;
    let mut tolerance = 0.0;
    for [low, high] in intervals {
        tolerance = END_TOLERANCE_FACTOR * (high - low);
        if low > counted_end + tolerance {
            count += 1;
            counted_end = if low > largest_end + tolerance { high } else { largest_end };
        }
        largest_end = largest_end.max(high);
    }
    count + usize::from(largest_end > counted_end + tolerance)
}

/// Middle between two ends.
pub fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// Name of an axis along the surface in plan; `None` in the plane.
///
/// `axis`: 0 for x, 1 for y. The plane has only one axis along the surface.
pub fn axis_name(is_plan: bool, axis: usize) -> Option<char> {
    is_plan.then_some(['x', 'y'][axis])
}

/// Resultant of a component along x and a component along y.
///
/// If the component along y is zero, as in the plane, the resultant has the sign of the component along x.
#[inline]
pub fn resultant(x_component: f64, y_component: f64) -> f64 {
    if y_component == 0.0 { x_component } else { x_component.hypot(y_component) }
}
