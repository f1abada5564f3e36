//! Shapes that a shell element accepts.

use crate::error::{Result, positive, require};
use crate::fem::vector::{add, cross, direction, dot};

/// Sine of an angle between two sides below which they count as parallel.
const PARALLEL: f64 = 1e-6;

/// Largest angle between the normal of a corner and the normal of the element, degrees.
const LARGEST_WARP: f64 = 45.0;

/// Checks that three nodes span an area.
pub(super) fn check_triangle(nodes: &[[f64; 3]; 3]) -> Result<()> {
    check_sides(nodes)?;
    let sine = |node: usize| {
        let [next, previous] = sides(nodes, node);
        direction(cross(direction(next).1, direction(previous).1)).0
    };
    let sine = sine(0).min(sine(1)).min(sine(2));
    let quantity = "sine of the smallest angle of a triangular shell";
    require(quantity, sine, sine > PARALLEL, "above 1e-6: nodes on no common line")?;
    Ok(())
}

/// Checks that four nodes, seen along their normal, are the corners of a convex quadrilateral with little warp.
pub(super) fn check_quadrilateral(nodes: &[[f64; 3]; 4]) -> Result<()> {
    check_sides(nodes)?;
    let diagonal = |from: usize, to: usize| direction(add(nodes[to], -1.0, nodes[from])).1;
    let (sine, normal) = direction(cross(diagonal(0, 2), diagonal(1, 3)));
    let quantity = "sine of the angle between the diagonals of a shell";
    let needed = "above 1e-6: nodes on no common line, listed around the shell";
    require(quantity, sine, sine > PARALLEL, needed)?;
    for node in 0..4 {
        let [next, previous] = sides(nodes, node);
        let across = cross(direction(next).1, direction(previous).1);
        let quantity = "sine of the angle at a corner of a shell";
        let needed = "above 1e-6: corners convex, listed around the shell";
        let sine = dot(across, normal);
        require(quantity, sine, sine > PARALLEL, needed)?;
        let cosine = (sine / direction(across).0).min(1.0);
        let quantity =
            "warp of a shell: angle between its normals at a corner and in the middle, in degrees";
        let warp = cosine.acos().to_degrees();
        let needed = "at most 45: take smaller elements or triangles";
        require(quantity, warp, warp <= LARGEST_WARP, needed)?;
    }
    Ok(())
}

/// Checks that neighbouring nodes are apart, and all distances finite.
fn check_sides<const N: usize>(nodes: &[[f64; 3]; N]) -> Result<()> {
    for node in 0..N {
        let (side, _) = direction(sides(nodes, node)[0]);
        positive("length of a side of a shell", side)?;
    }
    Ok(())
}

/// Vectors from a node to the next and to the previous one.
fn sides<const N: usize>(nodes: &[[f64; 3]; N], node: usize) -> [[f64; 3]; 2] {
    [(node + 1) % N, (node + N - 1) % N].map(|other| add(nodes[other], -1.0, nodes[node]))
}
