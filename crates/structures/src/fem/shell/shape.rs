//! Corners of a shell, and checks of its shape.

use crate::error::{Result, positive, require};
use crate::fem::vector::{add_scaled, cross, dot, norm, unit_vector};

/// Smallest sine of the angle between two sides; below it the sides count as parallel.
///
/// It is far above the rounding of coordinates.
const MIN_CORNER_SINE: f64 = 1e-6;

/// Largest angle between the normal of a corner and the normal of the element, degrees.
///
/// The projection of nodes on the element's plane changes lengths by too much at larger angles.
const MAX_WARP_DEGREES: f64 = 45.0;

/// Items of the four or three corners of a shell: nodes, or their coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Corners<T> {
    Four([T; 4]),
    Three([T; 3]),
}

impl<T: Copy> Corners<T> {
    /// Corners with these `items`, if there are four or three.
    pub(super) fn new(items: &[T]) -> Option<Self> {
        let four_items = items.try_into().ok().map(Self::Four);
        four_items.or_else(|| items.try_into().ok().map(Self::Three))
    }

    pub(super) fn as_slice(&self) -> &[T] {
        match self {
            Self::Four(items) => items,
            Self::Three(items) => items,
        }
    }
}

/// Returns an error unless three nodes span an area.
pub(super) fn check_triangle(nodes: &[[f64; 3]; 3]) -> Result<()> {
    check_sides(nodes)?;
    let mut min_sine = f64::INFINITY;
    for node in 0..3 {
        min_sine = min_sine.min(norm(corner_normal(nodes, node)));
    }
    let quantity = "sine of the smallest angle of a triangular shell";
    require(quantity, min_sine, min_sine > MIN_CORNER_SINE, "above 1e-6: nodes on no common line")?;
    Ok(())
}

/// Returns an error unless four nodes span a convex quadrilateral with little warp.
pub(super) fn check_quadrilateral(nodes: &[[f64; 3]; 4]) -> Result<()> {
    check_sides(nodes)?;
    let first_diagonal = unit_vector(add_scaled(nodes[2], -1.0, nodes[0]));
    let second_diagonal = unit_vector(add_scaled(nodes[3], -1.0, nodes[1]));
    let diagonal_product = cross(first_diagonal, second_diagonal);
    let diagonal_sine = norm(diagonal_product);
    let normal = unit_vector(diagonal_product);
    let quantity = "sine of the angle between the diagonals of a shell";
    let needed = "above 1e-6: nodes on no common line, listed around the shell";
    require(quantity, diagonal_sine, diagonal_sine > MIN_CORNER_SINE, needed)?;
    for node in 0..4 {
        let corner_normal = corner_normal(nodes, node);
        let quantity = "sine of the angle at a corner of a shell";
        let needed = "above 1e-6: corners convex, listed around the shell";
        let corner_sine = dot(corner_normal, normal);
        require(quantity, corner_sine, corner_sine > MIN_CORNER_SINE, needed)?;
        let warp_cosine = (corner_sine / norm(corner_normal)).min(1.0);
        let quantity =
            "warp of a shell: angle between its normals at a corner and in the middle, in degrees";
        let warp_degrees = warp_cosine.acos().to_degrees();
        let needed = "at most 45: take smaller elements or triangles";
        require(quantity, warp_degrees, warp_degrees <= MAX_WARP_DEGREES, needed)?;
    }
    Ok(())
}

/// Returns an error unless the sides have positive, finite lengths.
fn check_sides<const N: usize>(nodes: &[[f64; 3]; N]) -> Result<()> {
    for node in 0..N {
        let side_length = norm(sides(nodes, node)[0]);
        positive("length of a side of a shell", side_length)?;
    }
    Ok(())
}

/// Cross product of the unit vectors from a node to the next and to the previous one.
fn corner_normal<const N: usize>(nodes: &[[f64; 3]; N], node: usize) -> [f64; 3] {
    let [next_side, previous_side] = sides(nodes, node);
    cross(unit_vector(next_side), unit_vector(previous_side))
}

/// Vectors from a node to the next and to the previous one.
fn sides<const N: usize>(nodes: &[[f64; 3]; N], node: usize) -> [[f64; 3]; 2] {
    [(node + 1) % N, (node + N - 1) % N]
        .map(|neighbour| add_scaled(nodes[neighbour], -1.0, nodes[node]))
}
