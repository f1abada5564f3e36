//! A base in plan: faces, and mean displacements over contact elements.

use std::ops::Range;

use super::corner_weights::{Point, bilinear_weights, corner_weights, distance, distance_outside};
use super::transformation::{SparseVector, Weights, accumulate};
use super::{BasePoint, PlacedBase, PlacedFoundation, check_covered};
use crate::bem::plan::faces::{MatFace, side};
use crate::error::{Error, Result, require};
use crate::geometry::{ContactElement, Patch};
use crate::structure::BaseNode;

/// Distance of a Gauss point from the middle of its interval: 1/(2√3).
///
/// It is relative to the length of the interval.
pub(crate) const GAUSS_POINT_OFFSET: f64 = 0.288_675_134_594_812_9;
/// Smallest number of integration points of an element, as with 2 × 2 Gauss points.
const MIN_POINTS_PER_ELEMENT: usize = 4;
/// Area below which a triangle counts as degenerate, relative to the square of its longest side.
const DEGENERATE_AREA_FRACTION: f64 = 1e-12;

impl PlacedBase {
    /// Places faces on elements; faces that touch form one mat, and each mat is a foundation.
    pub(crate) fn on_faces(faces: &[Vec<BaseNode>], patch: &Patch) -> Result<Self> {
        let mats = mats(faces)?;
        let nodes = mats.concat().concat();
        let corner_counts: Vec<usize> = mats.iter().flatten().map(Vec::len).collect();
        let faces = DividedFaces::new(&nodes, &corner_counts)?;
        let mut foundations = Vec::with_capacity(mats.len());
        let mut first_node = 0;
        for mat in &mats {
            let mat_nodes = first_node..first_node + mat.iter().map(Vec::len).sum::<usize>();
            let mut rotations = BaseNode::mean_rotations(&nodes[mat_nodes.clone()]);
            // By the right-hand rule an upward slope to the right is a negative rotation about y.
            rotations[0] = -rotations[0].clone();
            let rotations = rotations.map(|row| Weights::Sparse(row.to_vec())).into();
            first_node = mat_nodes.end;
            let corners = hull(nodes[mat_nodes.clone()].iter());
            let settlement = faces.settlement(&mat_nodes);
            let elements = 0..0;
            foundations.push(PlacedFoundation {
                nodes: mat_nodes,
                elements,
                settlement,
                rotations,
                corners,
            });
        }
        let mut weights = Vec::with_capacity(patch.len());
        // Elements at an oblique outline are smaller than the others.
        let longest_side = patch.iter().flat_map(ContactElement::sides).fold(0.0, f64::max);
        for e in 0..patch.len() {
            let mean_weights = faces.mean_weights(e, patch, 0.5 * longest_side)?;
            let mut element_mats = mean_weights.iter().filter_map(|(node, _)| {
                foundations.iter().position(|mat| mat.nodes.contains(node))
            });
            let mat = element_mats.next().unwrap_or(0);
            let is_under_one_mat = element_mats.all(|other| other == mat);
            add_element(&mut foundations[mat].elements, e, is_under_one_mat)?;
            weights.push(mean_weights);
        }
        check_covered(&foundations)?;
        let mut points = Vec::new();
        for mat in &foundations {
            if !BaseNode::are_flat(&nodes[mat.nodes.clone()]) {
                points.extend(faces.integration_points(mat, patch));
            }
        }
        Ok(Self::from_weights(nodes, foundations, weights, patch, points))
    }
}

/// Adds an element to the elements of a mat.
///
/// Returns an error unless the elements are consecutive, and the element lies under this mat only.
fn add_element(elements: &mut Range<usize>, e: usize, is_under_one_mat: bool) -> Result<()> {
    let value = e as f64;
    let needed = "an element under one mat";
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

/// Faces of a base, divided into triangles and quadrilaterals.
struct DividedFaces<'a> {
    nodes: &'a [BaseNode],
    /// Indices of the nodes at the corners of each triangle or quadrilateral, in order.
    pieces: Vec<Vec<usize>>,
}

impl<'a> DividedFaces<'a> {
    /// Divides faces of more than four corners into triangles.
    ///
    /// `nodes` has the corners of all faces, one face after the other. `corner_counts` has the number of corners of each
    /// face.
    fn new(nodes: &'a [BaseNode], corner_counts: &[usize]) -> Result<Self> {
        let mut faces = Self { nodes, pieces: Vec::new() };
        let mut first_node = 0;
        for (face_number, &corner_count) in corner_counts.iter().enumerate() {
            let face: Vec<usize> = (first_node..first_node + corner_count).collect();
            MatFace::new(face_number, &faces.corners(&face))?;
            if corner_count <= 4 {
                faces.pieces.push(face);
            } else {
                let fan = face[1..].windows(2).map(|side| vec![face[0], side[0], side[1]]);
                let triangles: Vec<_> = fan.filter(|triangle| faces.has_area(triangle)).collect();
                faces.pieces.extend(triangles);
            }
            first_node += corner_count;
        }
        Ok(faces)
    }

    /// Corners of a piece in plan, m.
    fn corners(&self, piece: &[usize]) -> Vec<Point> {
        piece.iter().map(|&node| self.nodes[node].place()).collect()
    }

    /// Whether the corners of a triangle are not collinear.
    fn has_area(&self, triangle: &[usize]) -> bool {
        let corners = self.corners(triangle);
        let longest_side =
            (0..3).map(|k| distance(corners[k], corners[(k + 1) % 3])).fold(0.0, f64::max);
        side([corners[0], corners[1]], corners[2]).abs()
            > DEGENERATE_AREA_FRACTION * longest_side * longest_side
    }

    /// Mean displacement over the area of the mat with these nodes, downwards.
    fn settlement(&self, mat_nodes: &Range<usize>) -> Weights {
        let mut weights = vec![0.0; mat_nodes.len()];
        for piece in self.pieces.iter().filter(|piece| mat_nodes.contains(&piece[0])) {
            let corners = self.corners(piece);
            // Both divisions of a quadrilateral into triangles, each with half of the weight.
            let triangles: &[[usize; 3]] = match corners.len() {
                3 => &[[0, 1, 2]],
                _ => &[[0, 1, 2], [0, 2, 3], [1, 2, 3], [1, 3, 0]],
            };
            for triangle in triangles {
                let points = triangle.map(|k| corners[k]);
                let area =
                    side([points[0], points[1]], points[2]).abs() / triangles.len().min(2) as f64;
                for &k in triangle {
                    weights[piece[k] - mat_nodes.start] += area;
                }
            }
        }
        let sum: f64 = weights.iter().sum();
        let mut terms = SparseVector::new();
        for (node, weight) in self.nodes[mat_nodes.clone()].iter().zip(weights) {
            accumulate(&mut terms, &node.vertical, -weight / sum);
        }
        Weights::Sparse(terms)
    }

    /// Indices and weights of nodes in the mean displacement of an element.
    ///
    /// The mean is that of 2 × 2 Gauss points. A point outside all faces has the continued displacement of the nearest
    /// face. A point with a distance of more than `max_distance` (m) from the faces is an error that names the element.
    fn mean_weights(
        &self,
        element: usize,
        patch: &Patch,
        max_distance: f64,
    ) -> Result<Vec<(usize, f64)>> {
        let mut weights = Vec::with_capacity(16);
        for point in gauss_points(element, patch) {
            let (corner_weights, distance) = self.corner_weights(point);
            if distance.is_nan() || distance > max_distance {
                let quantity = "distance of a contact element from the faces of the base, m";
                let needed =
                    "half an element or less: all elements must lie under the structure's base";
                let error = Error::Input { quantity, value: distance, needed };
                return Err(error.within(format!("contact element {element}")));
            }
            weights.extend(corner_weights.into_iter().map(|(node, weight)| (node, 0.25 * weight)));
        }
        Ok(weights)
    }

    /// Indices and weights of nodes in the displacement of a point.
    ///
    /// The second result is the distance of the point from the faces, m.
    fn corner_weights(&self, point: Point) -> (Vec<(usize, f64)>, f64) {
        let (piece, corners, distance) = self.nearest_piece(point);
        (piece.iter().copied().zip(corner_weights(&corners, point)).collect(), distance)
    }

    /// Integration points for the elements of a mat.
    ///
    /// They are the Gauss points of the mat's faces. An element that contains fewer than four of these has the 2 × 2
    /// Gauss points of the element instead.
    fn integration_points(&self, mat: &PlacedFoundation, patch: &Patch) -> Vec<BasePoint> {
        let mut weights_by_element = vec![Vec::new(); mat.elements.len()];
        for piece in self.pieces.iter().filter(|piece| mat.nodes.contains(&piece[0])) {
            let corners = self.corners(piece);
            for corner_weights in gauss_weights(corners.len()) {
                let point = [0, 1].map(|k| {
                    let terms = corners
                        .iter()
                        .zip(&corner_weights)
                        .map(|(corner, weight)| weight * corner[k]);
                    terms.sum::<f64>()
                });
                if let Some(e) = mat.elements.clone().find(|e| is_on_element(&patch[*e], point)) {
                    weights_by_element[e - mat.elements.start]
                        .push(piece.iter().copied().zip(corner_weights).collect::<Vec<_>>());
                }
            }
        }
        let mut points = Vec::new();
        for (e, mut weights) in mat.elements.clone().zip(weights_by_element) {
            if weights.len() < MIN_POINTS_PER_ELEMENT {
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

    /// The triangle or quadrilateral nearest to a point, its corners, and its distance, m.
    fn nearest_piece(&self, point: Point) -> (&[usize], Vec<Point>, f64) {
        let mut nearest_piece: (&[usize], Vec<Point>, f64) = (&[], Vec::new(), f64::INFINITY);
        for piece in &self.pieces {
            let corners = self.corners(piece);
            let distance = distance_outside(&corners, point);
            if distance < nearest_piece.2 {
                nearest_piece = (piece, corners, distance);
            }
            if distance == 0.0 {
                break;
            }
        }
        nearest_piece
    }
}

/// Groups faces into mats; faces that touch belong to one mat.
fn mats(faces: &[Vec<BaseNode>]) -> Result<Vec<Vec<Vec<BaseNode>>>> {
    let mut mat_faces = Vec::with_capacity(faces.len());
    for (face_number, face) in faces.iter().enumerate() {
        let corners: Vec<Point> = face.iter().map(BaseNode::place).collect();
        mat_faces.push(MatFace::new(face_number, &corners)?);
    }
    MatFace::check_overlap(&mat_faces)?;
    let mat_numbers = MatFace::mats(&mat_faces);
    let mat_count = mat_numbers.iter().max().map_or(0, |last| last + 1);
    let mut mats = vec![Vec::new(); mat_count];
    faces.iter().zip(mat_numbers).for_each(|(face, mat)| mats[mat].push(face.clone()));
    Ok(mats)
}

/// The corners of the convex hull of some nodes, counter-clockwise.
pub(crate) fn hull<'a>(nodes: impl Iterator<Item = &'a BaseNode>) -> Vec<Point> {
    let mut sorted_points: Vec<Point> = nodes.map(BaseNode::place).collect();
    sorted_points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut hull: Vec<Point> = Vec::new();
    // Adds one side of the hull: first the lower side from left to right, then the upper side back (Andrew 1979).
    let mut add_side = |points: &mut dyn Iterator<Item = &Point>| {
        let start = hull.len();
        for point in points {
            while let [.., a, b] = hull[start..] {
                if side([a, b], *point) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(*point);
        }
        hull.pop();
    };
    add_side(&mut sorted_points.iter());
    add_side(&mut sorted_points.iter().rev());
    hull
}

/// Whether a point lies on an element in plan.
fn is_on_element(element: &ContactElement, point: Point) -> bool {
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

/// Weights of the corners of a triangle or a quadrilateral at its Gauss points.
fn gauss_weights(corner_count: usize) -> Vec<Vec<f64>> {
    if corner_count == 3 {
        let mut points = vec![vec![1.0 / 6.0; 3]; 3];
        for (k, weights) in points.iter_mut().enumerate() {
            weights[k] = 2.0 / 3.0;
        }
        return points;
    }
    let coordinates = [0.5 - GAUSS_POINT_OFFSET, 0.5 + GAUSS_POINT_OFFSET];
    coordinates
        .into_iter()
        .flat_map(|s| coordinates.map(|t| bilinear_weights([s, t]).to_vec()))
        .collect()
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

    /// Mean over a cell `[left, right, front, back]` of a field with values at the corners.
    fn mean(
        corners: &[Point],
        corner_counts: &[usize],
        cell: [f64; 4],
        field: fn(Point) -> f64,
    ) -> f64 {
        let cell = ContactElement::in_plan([cell[0], cell[1]], [cell[2], cell[3]]);
        let patch = Patch::new(vec![cell]).unwrap();
        let nodes = nodes(corners);
        let mut sum = 0.0;
        let faces = DividedFaces::new(&nodes, corner_counts).unwrap();
        for (node, weight) in faces.mean_weights(0, &patch, 1.0).unwrap() {
            sum += weight * field(corners[node]);
        }
        sum
    }

    #[test]
    fn means_of_a_linear_field_are_exact_on_all_faces_and_beyond() {
        let field = |[x, y]: Point| 2.0 - 3.0 * x + 0.7 * y;
        let triangle = [[0.0, 0.0], [4.0, 1.0], [1.0, 3.0]];
        let distorted_quadrilateral = [[0.0, 0.0], [1.0, 3.0], [5.0, 4.0], [4.0, -1.0]];
        let pentagon = [[0.0, 0.0], [2.0, -1.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        // Two corners on a line with the first corner.
        let straight_pentagon = [[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        for corners in [&triangle[..], &distorted_quadrilateral, &pentagon, &straight_pentagon] {
            for cell in [[0.5, 1.5, 0.5, 1.0], [-0.2, 1.0, -0.3, 0.8], [2.0, 3.5, 0.4, 1.4]] {
                let expected = field([0.5 * (cell[0] + cell[1]), 0.5 * (cell[2] + cell[3])]);
                let computed = mean(corners, &[corners.len()], cell, field);
                assert!(
                    (computed - expected).abs() < 1e-13,
                    "{corners:?} {cell:?} {computed} {expected}"
                );
            }
        }
    }

    /// The field x y is bilinear on a rectangle; a triangle is next to it.
    #[test]
    fn faces_side_by_side_have_displacements_of_their_own() {
        let corners =
            [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [4.0, 3.0], [4.0, 0.0], [7.0, 0.0]];
        let product = |[x, y]: Point| if x <= 4.0 { x * y } else { 0.0 };
        let computed = mean(&corners, &[4, 3], [1.0, 2.0, 0.0, 2.0], product);
        assert!((computed - 1.5).abs() < 1e-14, "{computed}");
        // On the triangle the field is 4 y.
        let computed = mean(&corners, &[4, 3], [4.5, 5.0, 0.5, 1.0], product);
        assert!((computed - 3.0).abs() < 1e-14, "{computed}");
        // Half of the cell is on each face: x y to the left, 4 y to the right.
        let computed = mean(&corners, &[4, 3], [3.0, 5.0, 0.0, 1.0], product);
        let gauss = 0.5 * (0.5 * (4.0 - 2.0 * GAUSS_POINT_OFFSET) + 0.5 * 4.0);
        assert!((computed - gauss).abs() < 1e-14, "{computed}");
    }
}
