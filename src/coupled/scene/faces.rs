//! A base in plan: its faces, and the mean of its displacement over a contact element.

use std::ops::Range;

use super::base::{Base, Outline, check_covered, mean_settlement};
use super::transformation::Weights;
use crate::bem::plan::faces::{Face, side};
use crate::error::{Error, Result, require};
use crate::geometry::Patch;
use crate::structure::FaceNode;

/// Distance of the points of Gauss' rule from the middle of an interval, of its length: 1/(2√3).
const GAUSS: f64 = 0.288_675_134_594_812_9;
/// Newton's steps to the coordinates of a point within a quadrilateral, and their last, relative to its size.
const ITERATIONS: usize = 50;
const CONVERGED: f64 = 1e-14;
/// Area of a triangle that is none, relative to the square of its longest side.
const NO_AREA: f64 = 1e-12;

type Point = [f64; 2];

impl Base {
    /// The base of these faces: each mat of faces that touch is a foundation.
    pub(super) fn on_faces(faces: &[Vec<FaceNode>], patch: &Patch) -> Result<Self> {
        let mats = mats(faces)?;
        let nodes = mats.concat().concat();
        let corners: Vec<usize> = mats.iter().flatten().map(Vec::len).collect();
        let surface = Faces::new(&nodes, &corners)?;
        let mut foundations = Vec::with_capacity(mats.len());
        let mut first = 0;
        for mat in &mats {
            let own = first..first + mat.iter().map(Vec::len).sum::<usize>();
            let [rise, about_x, twist] = FaceNode::mean_rotations(&nodes[own.clone()]);
            // By the right-hand rule about y a rise to the right is negative.
            let rotations = [-rise, about_x, twist];
            let rotations = rotations.map(|row| Weights::Sparse(row.to_vec())).into();
            first = own.end;
            let corners = hull(nodes[own.clone()].iter());
            let settlement = mean_settlement(&nodes[own.clone()]);
            let elements = 0..0;
            foundations.push(Outline { nodes: own, elements, settlement, rotations, corners });
        }
        let mut weights = Vec::with_capacity(patch.len());
        for e in 0..patch.len() {
            let own = surface.mean_weights(e, patch)?;
            let mut owners = own.iter().filter_map(|(node, _)| {
                foundations.iter().position(|mat| mat.nodes.contains(node))
            });
            let owner = owners.next().unwrap_or(0);
            let one = owners.all(|other| other == owner);
            take(&mut foundations[owner].elements, e, one)?;
            weights.push(own);
        }
        check_covered(&foundations)?;
        Ok(Self::from_weights(nodes, foundations, weights, patch))
    }
}

/// Adds an element to those of a mat, which must follow one another; `one` if no other mat stands on it.
fn take(elements: &mut Range<usize>, e: usize, one: bool) -> Result<()> {
    let value = e as f64;
    let needed = "elements under one mat each";
    require("number of a contact element under two mats", value, one, needed)?;
    if elements.start == elements.end {
        elements.start = e;
    } else if elements.end != e {
        let quantity = "number of a contact element apart from the others of its mat";
        return Err(Error::Input {
            quantity,
            value,
            needed: "elements of a mat one after another",
        });
    }
    elements.end = e + 1;
    Ok(())
}

/// All faces, in triangles and quadrilaterals.
struct Faces<'a> {
    nodes: &'a [FaceNode],
    /// Corners of each piece, in order.
    pieces: Vec<Vec<usize>>,
}

impl<'a> Faces<'a> {
    /// Faces with these numbers of corners, whose `nodes` follow one another.
    fn new(nodes: &'a [FaceNode], faces: &[usize]) -> Result<Self> {
        let (mut all, mut first) = (Self { nodes, pieces: Vec::new() }, 0);
        for (number, &count) in faces.iter().enumerate() {
            let own: Vec<usize> = (first..first + count).collect();
            Face::new(number, &all.corners(&own))?;
            if count <= 4 {
                all.pieces.push(own);
            } else {
                let fan = own[1..].windows(2).map(|side| vec![own[0], side[0], side[1]]);
                let fan: Vec<_> = fan.filter(|triangle| all.has_area(triangle)).collect();
                all.pieces.extend(fan);
            }
            first += count;
        }
        Ok(all)
    }

    fn corners(&self, piece: &[usize]) -> Vec<Point> {
        piece.iter().map(|&node| self.nodes[node].place()).collect()
    }

    fn has_area(&self, triangle: &[usize]) -> bool {
        let corners = self.corners(triangle);
        let size = (0..3).map(|k| distance(corners[k], corners[(k + 1) % 3])).fold(0.0, f64::max);
        side([corners[0], corners[1]], corners[2]).abs() > NO_AREA * size * size
    }

    /// (node, weight) of the mean over `element`, by 2 × 2 Gauss points. A point outside all faces continues the
    /// displacement of the nearest one; one that is farther off than half a side is an error.
    fn mean_weights(&self, element: usize, patch: &Patch) -> Result<Vec<(usize, f64)>> {
        let ([x, y], sides) = (patch.middle(element), patch.sides(element));
        let reach = 0.5 * sides[0].max(sides[1]);
        let mut weights = Vec::with_capacity(16);
        for [right, away] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let point = [x + GAUSS * right * sides[0], y + GAUSS * away * sides[1]];
            let (piece, corners, value) = self.nearest(point);
            let refuse = |value, needed| {
                let quantity = "distance of a contact element from the faces of the base, m";
                Err(Error::Input { quantity, value, needed })
            };
            if value.is_nan() || value > reach {
                return refuse(
                    value,
                    "half an element or less: all lie under the structure's base",
                );
            }
            let Some(shares) = shares(&corners, point) else {
                return refuse(value, "zero beside a face of this shape");
            };
            weights.extend(piece.iter().zip(shares).map(|(&node, share)| (node, 0.25 * share)));
        }
        Ok(weights)
    }

    /// The piece nearest to a point, its corners, and its distance.
    fn nearest(&self, point: Point) -> (&[usize], Vec<Point>, f64) {
        let mut found: (&[usize], Vec<Point>, f64) = (&[], Vec::new(), f64::INFINITY);
        for piece in &self.pieces {
            let corners = self.corners(piece);
            let distance = outside(&corners, point);
            if distance < found.2 {
                found = (piece, corners, distance);
            }
            if distance == 0.0 {
                break;
            }
        }
        found
    }
}

/// The faces of each mat, by their corners: those that touch are of one.
fn mats(faces: &[Vec<FaceNode>]) -> Result<Vec<Vec<Vec<FaceNode>>>> {
    let corners = |face: &Vec<FaceNode>| face.iter().map(FaceNode::place).collect();
    let checked = faces.iter().map(corners).enumerate();
    let checked: Result<Vec<_>> =
        checked.map(|(number, corners): (_, Vec<Point>)| Face::new(number, &corners)).collect();
    let owners = Face::mats(&checked?);
    let count = owners.iter().max().map_or(0, |last| last + 1);
    let mut mats = vec![Vec::new(); count];
    faces.iter().zip(owners).for_each(|(face, mat)| mats[mat].push(face.clone()));
    Ok(mats)
}

/// The corners of the convex hull of some nodes, counter-clockwise.
pub(crate) fn hull<'a>(nodes: impl Iterator<Item = &'a FaceNode>) -> Vec<Point> {
    let mut sorted: Vec<Point> = nodes.map(FaceNode::place).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut hull: Vec<Point> = Vec::new();
    // From left to right below, and back above.
    let mut half = |points: &mut dyn Iterator<Item = &Point>| {
        let first = hull.len();
        for point in points {
            while let [.., a, b] = hull[first..] {
                if side([a, b], *point) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(*point);
        }
        hull.pop();
    };
    half(&mut sorted.iter());
    half(&mut sorted.iter().rev());
    hull
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Distance of a point from a convex polygon; zero within.
fn outside(corners: &[Point], p: Point) -> f64 {
    let edges = || (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]);
    let areas = || edges().map(|edge| side(edge, p));
    if areas().all(|area| area >= 0.0) || areas().all(|area| area <= 0.0) {
        return 0.0;
    }
    let from = |[a, b]: [Point; 2]| {
        let along = [b[0] - a[0], b[1] - a[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let share = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / square;
        let share = share.clamp(0.0, 1.0);
        distance(p, [a[0] + share * along[0], a[1] + share * along[1]])
    };
    edges().map(from).fold(f64::INFINITY, f64::min)
}

/// Shares of the corners in the displacement of a point: linear over a triangle, bilinear over a quadrilateral, and
/// continued beyond; `None` where that is not possible.
fn shares(corners: &[Point], p: Point) -> Option<Vec<f64>> {
    if let [a, b, c] = *corners {
        let all = side([a, b], c);
        let [one, two] = [side([b, c], p) / all, side([c, a], p) / all];
        return Some(vec![one, two, 1.0 - one - two]);
    }
    let [a, b, c, d] = *corners else { return None };
    let blend = |weights: [f64; 4], k: usize| {
        weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k] + weights[3] * d[k]
    };
    // Coordinates s, t from 0 to 1 within.
    let [mut s, mut t] = [0.5_f64; 2];
    for _ in 0..ITERATIONS {
        let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
        let rest = [0, 1].map(|k| p[k] - blend(weights, k));
        let by_s = [0, 1].map(|k| blend([t - 1.0, 1.0 - t, t, -t], k));
        let by_t = [0, 1].map(|k| blend([s - 1.0, -s, s, 1.0 - s], k));
        let determinant = by_s[0] * by_t[1] - by_s[1] * by_t[0];
        let ds = (rest[0] * by_t[1] - rest[1] * by_t[0]) / determinant;
        let dt = (by_s[0] * rest[1] - by_s[1] * rest[0]) / determinant;
        (s, t) = (s + ds, t + dt);
        if !(s.is_finite() && t.is_finite()) {
            return None;
        }
        if ds.abs().max(dt.abs()) <= CONVERGED * s.abs().max(t.abs()).max(1.0) {
            return Some(vec![(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t]);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{ContactElement, SPACE};

    fn nodes(corners: &[Point]) -> Vec<FaceNode> {
        corners.iter().map(|&place| FaceNode::rigid(place, [0.0; 2], [0, 1, 2, 3, 4, 5])).collect()
    }

    /// Mean of a field, given at the corners, over a cell.
    fn mean(corners: &[Point], faces: &[usize], cell: [f64; 4], field: fn(Point) -> f64) -> f64 {
        let [left, right, front, back] = cell;
        let cell = ContactElement { left, right };
        let patch = Patch::new(SPACE, vec![cell], vec![[front, back]], vec![1.0]).unwrap();
        let (nodes, mut sum) = (nodes(corners), 0.0);
        let faces = Faces::new(&nodes, faces).unwrap();
        for (node, weight) in faces.mean_weights(0, &patch).unwrap() {
            sum += weight * field(corners[node]);
        }
        sum
    }

    #[test]
    fn means_of_a_linear_field_are_exact_on_all_faces_and_beyond() {
        let field = |[x, y]: Point| 2.0 - 3.0 * x + 0.7 * y;
        let triangle = [[0.0, 0.0], [4.0, 1.0], [1.0, 3.0]];
        let distorted = [[0.0, 0.0], [1.0, 3.0], [5.0, 4.0], [4.0, -1.0]];
        let pentagon = [[0.0, 0.0], [2.0, -1.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        // Two corners on one line with the first.
        let straight = [[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        for corners in [&triangle[..], &distorted, &pentagon, &straight] {
            for cell in [[0.5, 1.5, 0.5, 1.0], [-0.2, 1.0, -0.3, 0.8], [2.0, 3.5, 0.4, 1.4]] {
                let exact = field([0.5 * (cell[0] + cell[1]), 0.5 * (cell[2] + cell[3])]);
                let found = mean(corners, &[corners.len()], cell, field);
                assert!((found - exact).abs() < 1e-13, "{corners:?} {cell:?} {found} {exact}");
            }
        }
    }

    /// x y of a rectangle is bilinear; next to it, a triangle.
    #[test]
    fn faces_side_by_side_have_displacements_of_their_own() {
        let corners =
            [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [4.0, 3.0], [4.0, 0.0], [7.0, 0.0]];
        let product = |[x, y]: Point| if x <= 4.0 { x * y } else { 0.0 };
        let found = mean(&corners, &[4, 3], [1.0, 2.0, 0.0, 2.0], product);
        assert!((found - 1.5).abs() < 1e-14, "{found}");
        // Over the triangle it falls from 4 y at x = 4 to zero at x = 7: 4 y.
        let found = mean(&corners, &[4, 3], [4.5, 5.0, 0.5, 1.0], product);
        assert!((found - 3.0).abs() < 1e-14, "{found}");
        // Half in each: y x to the left, 4 y to the right.
        let found = mean(&corners, &[4, 3], [3.0, 5.0, 0.0, 1.0], product);
        let gauss = 0.5 * (0.5 * (4.0 - 2.0 * GAUSS) + 0.5 * 4.0);
        assert!((found - gauss).abs() < 1e-14, "{found}");
    }
}
