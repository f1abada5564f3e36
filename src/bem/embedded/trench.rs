//! Trenches and the contact elements of their faces.

use std::f64::consts::PI;
use std::ops::Range;

use crate::error::{Result, finite, not_negative, positive, require_part};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, check_count};
use crate::interface::InterfaceLaw;

/// Rectangular trench in the surface of the ground, in the plane.
///
/// ```
/// use basemat::bem::embedded::Trench;
/// let trench = Trench::new(-6.0..6.0, 5.0)?;
/// // Eight elements of the base, six of each wall.
/// let elements = trench.elements(8, 6)?;
/// assert_eq!(elements.elements().len(), 20);
/// // Along the outline: down the left wall, to the right along the base, up the right wall.
/// assert_eq!(elements.elements()[0].directions()[0], [-1.0, 0.0, 0.0]);
/// assert!((elements.elements()[6].center()[2] + 5.0).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "TrenchForm"))]
pub struct Trench {
    left: f64,
    right: f64,
    depth: f64,
}

validated! {
    Trench as TrenchForm { left: f64, right: f64, depth: f64 }
    => Trench::new(left..right, depth)
}

impl Trench {
    /// Trench between two `sides` (x, m), with its `depth` in m.
    ///
    /// A trench of depth 0 is a strip of the surface.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for sides that are not finite or not in order, or a depth below zero or not
    /// finite.
    pub fn new(sides: Range<f64>, depth: f64) -> Result<Self> {
        let Range { start: left, end: right } = sides;
        finite("left side of a trench", left)?;
        finite("right side of a trench", right)?;
        positive("width of a trench", right - left)?;
        not_negative("depth of a trench", depth)?;
        Ok(Self { left, right, depth })
    }

    /// Positions x of the left and the right wall, m.
    pub fn sides(&self) -> [f64; 2] {
        [self.left, self.right]
    }

    /// Depth of the base below the surface, m.
    pub fn depth(&self) -> f64 {
        self.depth
    }

    /// Half of the width, m.
    pub(super) fn half_width(&self) -> f64 {
        0.5 * (self.right - self.left)
    }

    /// Divides the faces into `base_count` elements of the base and `wall_count` of each wall.
    ///
    /// Elements are shorter towards both ends of each face, where tractions are singular. Impedances converge with
    /// second order: with 10 elements in all (4 and 3) errors are about 2 %, with 20 (8 and 6) 0.4 %.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) for a number of base elements that is zero or odd, or for walls without
    /// elements, or elements of walls without depth; [`Error::Memory`](crate::Error::Memory) for more elements than their
    /// matrices allow.
    pub fn elements(&self, base_count: usize, wall_count: usize) -> Result<TrenchElements> {
        let element_count = base_count.saturating_add(wall_count.saturating_mul(2));
        check_count(element_count, COMPONENTS_IN_PLANE)?;
        let is_even = base_count > 0 && base_count.is_multiple_of(2);
        require_part("base elements of a trench", is_even, "an even number above zero")?;
        let has_needed_walls = (wall_count > 0) == (self.depth > 0.0);
        require_part(
            "wall elements of a trench",
            has_needed_walls,
            "some if the trench has a depth, else none",
        )?;
        let half_width = self.half_width();
        // From the axis outwards; both halves are equal to the last bit.
        let mut base_ends = vec![];
        for k in 0..base_count / 2 {
            base_ends.push(half_width * (PI * k as f64 / base_count as f64).sin());
        }
        base_ends.push(half_width);
        let mut wall_ends = vec![];
        for k in 0..wall_count {
            let cosine = (PI * k as f64 / wall_count as f64).cos();
            wall_ends.push(0.5 * self.depth * (1.0 - cosine));
        }
        wall_ends.push(self.depth);
        Ok(TrenchElements { trench: *self, base_ends, wall_ends })
    }
}

/// Ends of elements with the middle of each element between its ends.
fn with_middles(element_ends: &[f64]) -> Vec<f64> {
    let coordinates = element_ends.windows(2).flat_map(|ends| [ends[0], 0.5 * (ends[0] + ends[1])]);
    coordinates.chain(element_ends.last().copied()).collect()
}

/// Contact elements of the faces of a [`Trench`].
#[derive(Debug, Clone, PartialEq)]
pub struct TrenchElements {
    trench: Trench,
    /// Distances of the ends of base elements from the axis, m.
    base_ends: Vec<f64>,
    /// Depths of the ends of wall elements, m.
    wall_ends: Vec<f64>,
}

impl TrenchElements {
    /// The trench.
    pub fn trench(&self) -> &Trench {
        &self.trench
    }

    /// Contact elements along the outline.
    ///
    /// The order is down the left wall, along the base to the right, and up the right wall. Normals lead into the soil.
    pub fn elements(&self) -> Vec<ContactElement> {
        let Trench { left, right, depth } = self.trench;
        let middle = 0.5 * (left + right);
        let bottom = -depth;
        let mut nodes: Vec<[f64; 2]> = self.wall_ends.iter().map(|z| [left, -z]).collect();
        nodes.extend(self.base_ends.iter().rev().skip(1).map(|x| [middle - x, bottom]));
        nodes.extend(self.base_ends.iter().skip(1).map(|x| [middle + x, bottom]));
        nodes.extend(self.wall_ends.iter().rev().skip(1).map(|z| [right, -z]));
        nodes.windows(2).map(|ends| ContactElement::wall(ends[0], ends[1])).collect()
    }

    /// The same faces with each element divided into two.
    pub(super) fn halved(&self) -> Self {
        let base_ends = with_middles(&self.base_ends);
        Self { trench: self.trench, base_ends, wall_ends: with_middles(&self.wall_ends) }
    }

    /// Interface laws of all elements: one for the base and one for both walls.
    ///
    /// The laws are for [`interfaces`](crate::coupled::SimulationBuilder::interfaces) of the builder.
    pub fn interfaces(
        &self,
        base: impl InterfaceLaw + Clone + 'static,
        walls: impl InterfaceLaw + Clone + 'static,
    ) -> Vec<Box<dyn InterfaceLaw>> {
        let laws = self.elements().into_iter().map(move |element| -> Box<dyn InterfaceLaw> {
            if element.faces_down() { Box::new(base.clone()) } else { Box::new(walls.clone()) }
        });
        laws.collect()
    }

    /// Ends of the base elements of the right half, m from the axis.
    pub(super) fn base_ends(&self) -> &[f64] {
        &self.base_ends
    }

    /// Ends of the elements of a wall, m below the surface.
    pub(super) fn wall_ends(&self) -> &[f64] {
        &self.wall_ends
    }
}
