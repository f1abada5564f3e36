//! Shapes that a shell element accepts.

use crate::error::{Result, positive, require};
use crate::fem::vector::{add, cross, dot, length, unit};

/// Smallest sine of the angle between two sides; below it they count as parallel.
const MIN_CORNER_SINE: f64 = 1e-6;

/// Largest angle between the normal of a corner and the normal of the element, degrees.
const MAX_WARP_DEGREES: f64 = 45.0;

/// Checks that three nodes span an area.
pub(super) fn check_triangle(nodes: &[[f64; 3]; 3]) -> Result<()> {
    check_sides(nodes)?;
    let mut sine = f64::INFINITY;
    for node in 0..3 {
        sine = sine.min(length(corner_cross(nodes, node)));
    }
    let quantity = "sine of the smallest angle of a triangular shell";
    require(quantity, sine, sine > MIN_CORNER_SINE, "above 1e-6: nodes on no common line")?;
    Ok(())
}

/// Checks that four nodes span a convex quadrilateral with little warp.
pub(super) fn check_quadrilateral(nodes: &[[f64; 3]; 4]) -> Result<()> {
    check_sides(nodes)?;
    let first_diagonal = unit(add(nodes[2], -1.0, nodes[0]));
    let second_diagonal = unit(add(nodes[3], -1.0, nodes[1]));
    let across = cross(first_diagonal, second_diagonal);
    let sine = length(across);
    let normal = unit(across);
    let quantity = "sine of the angle between the diagonals of a shell";
    let needed = "above 1e-6: nodes on no common line, listed around the shell";
    require(quantity, sine, sine > MIN_CORNER_SINE, needed)?;
    for node in 0..4 {
        let across = corner_cross(nodes, node);
        let quantity = "sine of the angle at a corner of a shell";
        let needed = "above 1e-6: corners convex, listed around the shell";
        let sine = dot(across, normal);
        require(quantity, sine, sine > MIN_CORNER_SINE, needed)?;
        let cosine = (sine / length(across)).min(1.0);
        let quantity =
            "warp of a shell: angle between its normals at a corner and in the middle, in degrees";
        let warp = cosine.acos().to_degrees();
        let needed = "at most 45: take smaller elements or triangles";
        require(quantity, warp, warp <= MAX_WARP_DEGREES, needed)?;
    }
    Ok(())
}

/// Checks that neighbouring nodes are apart, and all distances finite.
fn check_sides<const N: usize>(nodes: &[[f64; 3]; N]) -> Result<()> {
    for node in 0..N {
        let length = length(sides(nodes, node)[0]);
        positive("length of a side of a shell", length)?;
    }
    Ok(())
}

/// Vector product of the unit vectors from a node to the next and to the previous one.
fn corner_cross<const N: usize>(nodes: &[[f64; 3]; N], node: usize) -> [f64; 3] {
    let [next, previous] = sides(nodes, node);
    cross(unit(next), unit(previous))
}

/// Vectors from a node to the next and to the previous one.
fn sides<const N: usize>(nodes: &[[f64; 3]; N], node: usize) -> [[f64; 3]; 2] {
    [(node + 1) % N, (node + N - 1) % N].map(|other| add(nodes[other], -1.0, nodes[node]))
}
