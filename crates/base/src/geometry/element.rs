//! Contact element: its position, its directions and its area.

use std::ops::Range;

use super::middle;
use crate::error::{Result, finite, positive, require};

/// Directions of an element on the flat surface: down, to the right, away from the reader.
const SURFACE_DIRECTIONS: [[f64; 3]; 3] = [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// Ends along y of an element in the plane, m: it is one metre deep.
const UNIT_DEPTH_ENDS: [f64; 2] = [-0.5, 0.5];
/// Largest upward component of a normal that points down.
///
/// For normals of walls it is zero.
const MAX_DOWNWARD_COMPONENT: f64 = -0.5;

/// Contact element between base and soil: a flat rectangle.
///
/// Coordinates: x to the right, y away from the reader, z up, m. Tractions and displacements of an element have one
/// component along each of its [`directions`](ContactElement::directions): the normal into the soil, and the tangents.
/// An element in the plane has one tangent and is one metre deep.
///
/// ```
/// use basemat::bem::ContactElement;
/// let strip = ContactElement::new(-1.0, 2.0);
/// assert_eq!((strip.length(), strip.center()[0]), (3.0, 0.5));
/// let cell = ContactElement::in_plan([-1.0, 2.0], [0.0, 4.0]);
/// assert_eq!((cell.area(), cell.directions().len()), (12.0, 3));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ContactElement {
    /// Corner from which both tangents point into the element, and the opposite corner, m.
    corners: [[f64; 3]; 2],
    /// Unit vectors: the normal into the soil, and the tangents along both sides of the rectangle.
    directions: [[f64; 3]; 3],
    /// Whether the element has both tangents; in the plane it has only the first.
    in_plan: bool,
    /// Fraction of the area inside the outline of the base.
    inside: f64,
}

/// Indices of the elements of a foundation's faces, in order along its outline.
#[doc(hidden)]
#[derive(Debug, Clone)]
pub struct OutlineFaces {
    /// Elements of the left wall.
    pub left_wall: Range<usize>,
    /// Elements that face down.
    pub floor: Range<usize>,
    /// Elements of the right wall.
    pub right_wall: Range<usize>,
}

impl OutlineFaces {
    /// Left wall, floor and right wall.
    pub fn in_order(self) -> [Range<usize>; 3] {
        [self.left_wall, self.floor, self.right_wall]
    }
}

impl ContactElement {
    /// Element in the plane: the interval from `left` to `right` of the surface, m.
    pub const fn new(left: f64, right: f64) -> Self {
        Self { in_plan: false, ..Self::in_plan([left, right], UNIT_DEPTH_ENDS) }
    }

    /// Element in plan: a rectangle of the surface.
    ///
    /// The arguments are its ends along x and along y, m.
    pub const fn in_plan([left, right]: [f64; 2], [front, back]: [f64; 2]) -> Self {
        let corners = [[left, front, 0.0], [right, back, 0.0]];
        Self { corners, directions: SURFACE_DIRECTIONS, in_plan: true, inside: 1.0 }
    }

    /// Sets the fraction of the area that is inside the outline of the base.
    ///
    /// It is above 0 and at most 1. Pressures, shear tractions and strengths of a simulation refer to the area inside.
    /// Tractions of a ground are means over the whole element.
    #[must_use]
    pub const fn with_fraction_inside(self, fraction_inside: f64) -> Self {
        Self { inside: fraction_inside, ..self }
    }

    /// Left end, m.
    pub const fn left(&self) -> f64 {
        self.corners[0][0]
    }

    /// Right end, m.
    pub const fn right(&self) -> f64 {
        self.corners[1][0]
    }

    /// Front and back end along y, m; −½ and ½ in the plane.
    pub const fn depth(&self) -> [f64; 2] {
        [self.corners[0][1], self.corners[1][1]]
    }

    /// Lower and upper end along z, m; equal unless the element is of a wall.
    pub const fn heights(&self) -> [f64; 2] {
        let first_height = self.corners[0][2];
        let second_height = self.corners[1][2];
        // Adding zero removes the sign of a negative zero.
        [first_height.min(second_height) + 0.0, first_height.max(second_height) + 0.0]
    }

    /// Ends along x and along y, m.
    #[doc(hidden)]
    pub const fn ends(&self) -> [[f64; 2]; 2] {
        [[self.left(), self.right()], self.depth()]
    }

    /// Length along the first tangent, m.
    #[inline]
    pub fn length(&self) -> f64 {
        self.sides()[0]
    }

    /// Coordinates of both ends along the first tangent, m.
    #[doc(hidden)]
    #[inline]
    pub fn span(&self) -> [f64; 2] {
        self.corners.map(|corner| self.components(corner)[1])
    }

    /// Sides along the tangents, m; the second is one metre in the plane.
    #[inline]
    pub fn sides(&self) -> [f64; 2] {
        let diagonal = [0, 1, 2].map(|k| self.corners[1][k] - self.corners[0][k]);
        let components = self.components(diagonal);
        [components[1], components[2]]
    }

    /// Centre `[x, y, z]`, m.
    #[inline]
    pub fn center(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| middle([self.corners[0][k], self.corners[1][k]]))
    }

    /// Unit vectors of the element's components: the normal into the soil, and the tangents.
    ///
    /// One tangent in the plane, two in plan.
    #[inline]
    pub fn directions(&self) -> &[[f64; 3]] {
        &self.directions[..2 + usize::from(self.in_plan)]
    }

    /// Whether the soil is below the element, not beside it.
    #[doc(hidden)]
    #[inline]
    pub fn faces_down(&self) -> bool {
        self.directions[0][2] < MAX_DOWNWARD_COMPONENT
    }

    /// Whether any of the elements belongs to a wall.
    #[doc(hidden)]
    pub fn any_wall<'a>(elements: impl IntoIterator<Item = &'a Self>) -> bool {
        elements.into_iter().any(|element| !element.faces_down())
    }

    /// Faces of a list of elements along an outline.
    #[doc(hidden)]
    pub fn faces(elements: &[Self]) -> OutlineFaces {
        let count = elements.len();
        let floor_start = elements.iter().position(Self::faces_down).unwrap_or(count);
        let floor_end =
            elements.iter().rposition(Self::faces_down).map_or(count, |index| index + 1);
        OutlineFaces {
            left_wall: 0..floor_start,
            floor: floor_start..floor_end,
            right_wall: floor_end..count,
        }
    }

    /// Components of a vector `[x, y, z]` along the normal and both tangents.
    #[doc(hidden)]
    #[inline]
    pub fn components(&self, vector: [f64; 3]) -> [f64; 3] {
        if self.faces_down() {
            let [x, y, z] = vector;
            return [0.0 - z, 0.0 + x, 0.0 + y];
        }
        self.directions
            .map(|unit| unit[0] * vector[0] + unit[1] * vector[1] + unit[2] * vector[2])
    }

    /// The vector `[x, y, z]` with these components along the normal and both tangents.
    #[doc(hidden)]
    #[inline]
    pub fn vector(&self, components: [f64; 3]) -> [f64; 3] {
        if self.faces_down() {
            let [down, right, away] = components;
            return [0.0 + right, 0.0 + away, 0.0 - down];
        }
        let units = self.directions;
        [0, 1, 2].map(|k| {
            units[0][k] * components[0] + units[1][k] * components[1] + units[2][k] * components[2]
        })
    }

    /// Fraction of the area that is inside the outline of the base.
    pub const fn fraction_inside(&self) -> f64 {
        self.inside
    }

    /// Area inside the outline of the base, m²; in the plane the length, m.
    #[inline]
    pub fn area(&self) -> f64 {
        let sides = self.sides();
        sides[0] * sides[1] * self.inside
    }

    /// Corners in order around the element, m; in the plane both ends.
    #[doc(hidden)]
    pub fn outline(&self) -> impl Iterator<Item = [f64; 3]> {
        // Side along which each coordinate varies: the first side, or else the second.
        let varying_side = [0, 1, 2].map(|k| usize::from(self.directions[1][k] == 0.0));
        let ends_of_corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
        let corners =
            ends_of_corners.map(|ends| [0, 1, 2].map(|k| self.corners[ends[varying_side[k]]][k]));
        corners.into_iter().take(2 * (self.directions().len() - 1))
    }

    /// Halves of the element; in plan quarters: left front, right front, left back, right back.
    #[doc(hidden)]
    pub fn parts(&self) -> impl Iterator<Item = Self> {
        let side_count = self.directions().len() - 1;
        (0..1 << side_count).map(move |part: usize| {
            (0..side_count).fold(*self, |element, side| element.half(1 + side, part >> side & 1))
        })
    }

    /// First (0) or second (1) half of the element along a direction.
    fn half(mut self, direction: usize, half_index: usize) -> Self {
        let center = self.center();
        for k in (0..3).filter(|k| self.directions[direction][*k] != 0.0) {
            self.corners[1 - half_index][k] = center[k];
        }
        self
    }

    /// Returns an error for an element with an invalid number.
    ///
    /// Ends must be finite, sides positive, and the fraction inside above 0 and at most 1.
    pub(super) fn check(&self) -> Result<()> {
        let ends = self.ends();
        finite("left end of a contact element", ends[0][0])?;
        finite("right end of a contact element", ends[0][1])?;
        finite("front end of a contact element", ends[1][0])?;
        finite("back end of a contact element", ends[1][1])?;
        positive("length of a contact element", self.length())?;
        positive("depth of a contact element", self.sides()[1])?;
        let quantity = "fraction of an element inside the outline";
        let is_fraction = self.inside > 0.0 && self.inside <= 1.0;
        require(quantity, self.inside, is_fraction, "above 0 and at most 1").map(drop)
    }

    /// Largest overlap of neighbours relative to their sides: the rounding error of a common node.
    pub(super) const MAX_OVERLAP_FRACTION: f64 = 1e-9;

    /// Whether two elements overlap along `axis` by more than rounding.
    ///
    /// `axis`: 0 for x, 1 for y.
    pub(super) fn overlaps(&self, other: &Self, axis: usize) -> bool {
        let ends = self.ends()[axis];
        let other_ends = other.ends()[axis];
        let overlap = ends[1].min(other_ends[1]) - ends[0].max(other_ends[0]);
        overlap > Self::MAX_OVERLAP_FRACTION * self.sides()[axis].min(other.sides()[axis])
    }
}

impl ContactElement {
    /// Element of a wall in the plane between two points `[x, z]`, m.
    ///
    /// The soil is on the right-hand side of the vector from `start` to `end`.
    #[doc(hidden)]
    pub fn wall(start: [f64; 2], end: [f64; 2]) -> Self {
        let difference = [end[0] - start[0], end[1] - start[1]];
        let length = difference[0].hypot(difference[1]);
        let tangent_x = difference[0] / length;
        let tangent_z = difference[1] / length;
        let corners =
            [[start[0], UNIT_DEPTH_ENDS[0], start[1]], [end[0], UNIT_DEPTH_ENDS[1], end[1]]];
        let directions =
            [[tangent_z, 0.0, -tangent_x], [tangent_x, 0.0, tangent_z], [0.0, 1.0, 0.0]];
        Self { corners, directions, in_plan: false, inside: 1.0 }
    }
}
