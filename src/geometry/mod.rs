//! Geometry: contact elements and the order of their numbers, cells of a lattice, directions, and shapes of
//! foundations.

mod circle;
mod direction;
mod element;
mod footing;
mod lattice;
mod patch;

pub(crate) use circle::circle;
pub use direction::Direction;
pub(crate) use direction::{PLANE_DIRECTIONS, PLANE_TRANSLATIONS, SPACE_DIRECTIONS};
pub use element::ContactElement;
pub(crate) use footing::{Edge, Footing};
pub(crate) use lattice::{Lattice, SERIES_PER_OFFSET, lattice_cells, offset};
pub(crate) use patch::{Patch, check_count, check_order};

/// Directions of motion and traction at each element of a ground in the plane: down, along x.
pub(crate) const COMPONENTS_IN_PLANE: usize = 2;
/// Directions of motion and traction at each element of a ground in plan: down, along x, along y.
pub(crate) const COMPONENTS_IN_SPACE: usize = 3;

/// Order of the numbers in a contact vector: component by component, all elements in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ContactLayout {
    components: usize,
    elements: usize,
}

impl ContactLayout {
    /// Layout of elements with [`COMPONENTS_IN_PLANE`] or [`COMPONENTS_IN_SPACE`] components each.
    pub(crate) const fn new(components: usize, elements: usize) -> Self {
        Self { components, elements }
    }

    /// Layout of these elements, which have equally many directions.
    pub(crate) fn for_elements(elements: &[ContactElement]) -> Self {
        Self::new(
            elements.first().map_or(COMPONENTS_IN_PLANE, |own| own.directions().len()),
            elements.len(),
        )
    }

    /// Components of each element: down, along x, and in plan along y.
    pub(crate) const fn components(self) -> usize {
        self.components
    }

    /// Whether the ground is one in plan, of three directions.
    pub(crate) const fn is_plan(self) -> bool {
        self.components == COMPONENTS_IN_SPACE
    }

    /// Axes along the surface: x (0), and in plan y (1).
    pub(crate) const fn axes(self) -> std::ops::Range<usize> {
        0..self.components - 1
    }

    /// Base moment and rotation over those about y by the right-hand rule: 1 in plan.
    ///
    /// −1 in the plane, where they count counter-clockwise.
    pub(crate) const fn turn(self) -> f64 {
        [-1.0, 1.0][self.is_plan() as usize]
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

/// The smallest low end and the largest high end.
pub(crate) fn far_ends(ends: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    ends.fold(none, |[least, most], [low, high]| [least.min(low), most.max(high)])
}

/// The smallest and the largest value.
pub(crate) fn span(values: impl Iterator<Item = f64>) -> [f64; 2] {
    far_ends(values.map(|value| [value; 2]))
}

/// Distance between two ends that counts as rounding, relative to the interval.
const ROUNDING: f64 = 1e-9;

/// Number of intervals in a row: the fewest that lead from the first end to the last.
pub(crate) fn in_a_row(mut ends: Vec<[f64; 2]>) -> usize {
    ends.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let mut count = 0;
    let mut end = f64::NEG_INFINITY;
    let mut reach = f64::NEG_INFINITY;
    let mut rounding = 0.0;
    for [low, high] in ends {
        rounding = ROUNDING * (high - low);
        if low > end + rounding {
            count += 1;
            end = if low > reach + rounding { high } else { reach };
        }
        reach = reach.max(high);
    }
    count + usize::from(reach > end + rounding)
}

/// The middle between two ends.
pub(crate) fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// Name of the axis x (0) or y (1) in plan; `None` in the plane, which has one axis along the surface.
pub(crate) fn axis_name(is_plan: bool, axis: usize) -> Option<char> {
    is_plan.then_some(['x', 'y'][axis])
}

/// A number and its counterpart along y as one: with its sign in the plane, where that is zero.
pub(crate) fn resultant(along: f64, across: f64) -> f64 {
    if across == 0.0 { along } else { along.hypot(across) }
}
