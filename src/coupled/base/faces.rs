//! A base in plan: its faces, and its mean displacement over a contact element.

use std::ops::Range;

use super::corner_weights::{Point, bilinear, corner_weights, distance, outside};
use super::transformation::{Terms, Weights, accumulate};
use super::{BasePoint, Outline, PlacedBase, check_covered};
use crate::bem::plan::faces::{MatFace, side};
use crate::error::{Error, Result, require};
use crate::geometry::{ContactElement, Patch};
use crate::structure::BaseNode;

/// Distance of a Gauss point from the middle of an interval, relative to its length: 1/(2√3).
pub(crate) const GAUSS_POINT_OFFSET: f64 = 0.288_675_134_594_812_9;
/// Area below which a triangle counts as degenerate, relative to the square of its longest side.
const DEGENERATE_AREA_FRACTION: f64 = 1e-12;

impl PlacedBase {
    /// The base of these faces: faces that touch form one mat, and each mat is a foundation.
    pub(crate) fn on_faces(faces: &[Vec<BaseNode>], patch: &Patch) -> Result<Self> {
        let mats = mats(faces)?;
        let nodes = mats.concat().concat();
        let corners: Vec<usize> = mats.iter().flatten().map(Vec::len).collect();
        let surface = Faces::new(&nodes, &corners)?;
        let mut foundations = Vec::with_capacity(mats.len());
        let mut first = 0;
        for mat in &mats {
            let range = first..first + mat.iter().map(Vec::len).sum::<usize>();
            let mut rotations = BaseNode::mean_rotations(&nodes[range.clone()]);
            // By the right-hand rule a rise to the right is a negative rotation about y.
            rotations[0] = -rotations[0].clone();
            let rotations = rotations.map(|row| Weights::Sparse(row.to_vec())).into();
            first = range.end;
            let corners = hull(nodes[range.clone()].iter());
            let settlement = surface.settlement(&range);
            let elements = 0..0;
            foundations.push(Outline { nodes: range, elements, settlement, rotations, corners });
        }
        let mut weights = Vec::with_capacity(patch.len());
        // Elements at an oblique outline are smaller than the others.
        let widest = patch.iter().flat_map(ContactElement::sides).fold(0.0, f64::max);
        for e in 0..patch.len() {
            let mean = surface.mean_weights(e, patch, 0.5 * widest)?;
            let mut mats = mean.iter().filter_map(|(node, _)| {
                foundations.iter().position(|mat| mat.nodes.contains(node))
            });
            let mat = mats.next().unwrap_or(0);
            let is_under_one_mat = mats.all(|other| other == mat);
            add_element(&mut foundations[mat].elements, e, is_under_one_mat)?;
            weights.push(mean);
        }
        check_covered(&foundations)?;
        let mut points = Vec::new();
        for mat in &foundations {
            if !BaseNode::are_flat(&nodes[mat.nodes.clone()]) {
                points.extend(surface.points(mat, patch));
            }
        }
        Ok(Self::from_weights(nodes, foundations, weights, patch, points))
    }
}

/// Adds an element to the elements of a mat.
///
/// Returns an error unless these are consecutive, and no other mat stands on the element.
fn add_element(elements: &mut Range<usize>, e: usize, is_under_one_mat: bool) -> Result<()> {
    let value = e as f64;
    let needed = "elements under one mat each";
    require("number of a contact element under two mats", value, is_under_one_mat, needed)?;
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

/// All faces, divided into triangles and quadrilaterals.
struct Faces<'a> {
    nodes: &'a [BaseNode],
    /// Corners of each piece, in order.
    pieces: Vec<Vec<usize>>,
}

impl<'a> Faces<'a> {
    /// `faces`: number of corners of each face; `nodes`: the corners of all faces, one face after the other.
    fn new(nodes: &'a [BaseNode], faces: &[usize]) -> Result<Self> {
        let mut all = Self { nodes, pieces: Vec::new() };
        let mut first = 0;
        for (number, &count) in faces.iter().enumerate() {
            let face: Vec<usize> = (first..first + count).collect();
            MatFace::new(number, &all.corners(&face))?;
            if count <= 4 {
                all.pieces.push(face);
            } else {
                let fan = face[1..].windows(2).map(|side| vec![face[0], side[0], side[1]]);
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
        side([corners[0], corners[1]], corners[2]).abs() > DEGENERATE_AREA_FRACTION * size * size
    }

    /// Mean displacement over the area of the mat with these nodes, downwards.
    fn settlement(&self, nodes: &Range<usize>) -> Weights {
        let mut weights = vec![0.0; nodes.len()];
        for piece in self.pieces.iter().filter(|piece| nodes.contains(&piece[0])) {
            let corners = self.corners(piece);
            // Both divisions of a quadrilateral into triangles.
            let triangles: &[[usize; 3]] = match corners.len() {
                3 => &[[0, 1, 2]],
                _ => &[[0, 1, 2], [0, 2, 3], [1, 2, 3], [1, 3, 0]],
            };
            for triangle in triangles {
                let points = triangle.map(|k| corners[k]);
                let area =
                    side([points[0], points[1]], points[2]).abs() / triangles.len().min(2) as f64;
                for &k in triangle {
                    weights[piece[k] - nodes.start] += area;
                }
            }
        }
        let sum: f64 = weights.iter().sum();
        let mut terms = Terms::new();
        for (node, weight) in self.nodes[nodes.clone()].iter().zip(weights) {
            accumulate(&mut terms, &node.vertical, -weight / sum);
        }
        Weights::Sparse(terms)
    }

    /// (node, weight) of the mean over `element`, by 2 × 2 Gauss points.
    ///
    /// A point outside all faces moves with the continued displacement of the nearest face. A point farther off
    /// than `reach` (m) is an error that names the element.
    fn mean_weights(&self, element: usize, patch: &Patch, reach: f64) -> Result<Vec<(usize, f64)>> {
        let mut weights = Vec::with_capacity(16);
        for point in gauss_points(element, patch) {
            let (corner_weights, value) = self.corner_weights(point);
            if value.is_nan() || value > reach {
                let quantity = "distance of a contact element from the faces of the base, m";
                let needed = "half an element or less: all lie under the structure's base";
                let fault = Error::Input { quantity, value, needed };
                return Err(fault.within(format!("contact element {element}")));
            }
            weights.extend(corner_weights.into_iter().map(|(node, weight)| (node, 0.25 * weight)));
        }
        Ok(weights)
    }

    /// (node, weight) of the displacement of a point, and its distance from the faces, m.
    fn corner_weights(&self, point: Point) -> (Vec<(usize, f64)>, f64) {
        let (piece, corners, distance) = self.nearest(point);
        (piece.iter().copied().zip(corner_weights(&corners, point)).collect(), distance)
    }

    /// Points for integrals over the elements of a mat.
    ///
    /// Gauss points of its faces; 2 × 2 Gauss points of an element that contains fewer than four of these.
    fn points(&self, mat: &Outline, patch: &Patch) -> Vec<BasePoint> {
        let mut found = vec![Vec::new(); mat.elements.len()];
        for piece in self.pieces.iter().filter(|piece| mat.nodes.contains(&piece[0])) {
            let corners = self.corners(piece);
            for corner_weights in face_points(corners.len()) {
                let place = [0, 1].map(|k| {
                    let terms = corners
                        .iter()
                        .zip(&corner_weights)
                        .map(|(corner, weight)| weight * corner[k]);
                    terms.sum::<f64>()
                });
                if let Some(e) = mat.elements.clone().find(|e| is_on(&patch[*e], place)) {
                    found[e - mat.elements.start]
                        .push(piece.iter().copied().zip(corner_weights).collect::<Vec<_>>());
                }
            }
        }
        let mut points = Vec::new();
        for (e, mut weights) in mat.elements.clone().zip(found) {
            if weights.len() < 4 {
                weights = gauss_points(e, patch).map(|point| self.corner_weights(point).0).into();
            }
            let area = patch.areas()[e] / weights.len() as f64;
            points.extend(weights.into_iter().map(|corner_weights| BasePoint {
                element: e,
                area,
                corner_weights,
            }));
        }
        points
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

/// The faces of each mat, by their corners; faces that touch belong to one mat.
fn mats(faces: &[Vec<BaseNode>]) -> Result<Vec<Vec<Vec<BaseNode>>>> {
    let mut checked = Vec::with_capacity(faces.len());
    for (number, face) in faces.iter().enumerate() {
        let corners: Vec<Point> = face.iter().map(BaseNode::place).collect();
        checked.push(MatFace::new(number, &corners)?);
    }
    MatFace::check_overlap(&checked)?;
    let mat_numbers = MatFace::mats(&checked);
    let count = mat_numbers.iter().max().map_or(0, |last| last + 1);
    let mut mats = vec![Vec::new(); count];
    faces.iter().zip(mat_numbers).for_each(|(face, mat)| mats[mat].push(face.clone()));
    Ok(mats)
}

/// The corners of the convex hull of some nodes, counter-clockwise.
pub(crate) fn hull<'a>(nodes: impl Iterator<Item = &'a BaseNode>) -> Vec<Point> {
    let mut sorted: Vec<Point> = nodes.map(BaseNode::place).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut hull: Vec<Point> = Vec::new();
    // From left to right along the lower side, and back along the upper.
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

/// Whether a point lies on an element in plan.
fn is_on(element: &ContactElement, point: Point) -> bool {
    let middle = element.center();
    let sides = element.sides();
    (0..2).all(|k| (point[k] - middle[k]).abs() <= 0.5 * sides[k])
}

/// The 2 × 2 Gauss points of an element.
fn gauss_points(element: usize, patch: &Patch) -> [Point; 4] {
    let center = patch[element].center();
    let sides = patch[element].sides();
    let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    signs.map(|signs| [0, 1].map(|k| center[k] + GAUSS_POINT_OFFSET * signs[k] * sides[k]))
}

/// Weights of the corners of a triangle or a quadrilateral in the displacements of its Gauss points.
fn face_points(corners: usize) -> Vec<Vec<f64>> {
    if corners == 3 {
        let mut points = vec![vec![1.0 / 6.0; 3]; 3];
        for (k, weights) in points.iter_mut().enumerate() {
            weights[k] = 2.0 / 3.0;
        }
        return points;
    }
    let ends = [0.5 - GAUSS_POINT_OFFSET, 0.5 + GAUSS_POINT_OFFSET];
    ends.into_iter().flat_map(|s| ends.map(|t| bilinear([s, t]).to_vec())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes(corners: &[Point]) -> Vec<BaseNode> {
        corners
            .iter()
            .map(|&place| BaseNode::rigid_in_plan(place, [0.0; 2], [0, 1, 2, 3, 4, 5]))
            .collect()
    }

    /// Mean over a cell of a field given at the corners.
    fn mean(corners: &[Point], faces: &[usize], cell: [f64; 4], field: fn(Point) -> f64) -> f64 {
        let cell = ContactElement::in_plan([cell[0], cell[1]], [cell[2], cell[3]]);
        let patch = Patch::new(vec![cell]).unwrap();
        let nodes = nodes(corners);
        let mut sum = 0.0;
        let faces = Faces::new(&nodes, faces).unwrap();
        for (node, weight) in faces.mean_weights(0, &patch, 1.0).unwrap() {
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
        // Two corners on a line with the first corner.
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
        let gauss = 0.5 * (0.5 * (4.0 - 2.0 * GAUSS_POINT_OFFSET) + 0.5 * 4.0);
        assert!((found - gauss).abs() < 1e-14, "{found}");
    }
}
