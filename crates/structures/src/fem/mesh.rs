//! Nodes and the elements between them.

use std::collections::HashMap;
use std::sync::Arc;

use super::duplicate::{element_key, is_duplicate};
use super::element::Element;
use super::force_rotation::ForceRotation;
use super::vector::distance;
use crate::error::{
    Error, Result, at_least, finite, in_bounds, not_negative, require, require_part,
};
use crate::geometry::{Direction, PLANE_DIRECTIONS, SPACE_DIRECTIONS};

/// Largest distance of coincident points, relative to the largest extent of the mesh.
///
/// It is far below the size of any element and far above the rounding of a coordinate.
const COINCIDENCE_TOLERANCE: f64 = 1e-6;
/// Largest difference of equal heights, relative to the largest extent of the mesh.
///
/// It is above the rounding of a height that is a sum of layers.
const HEIGHT_TOLERANCE: f64 = 1e-9;

/// Nodes and elements, in the plane or in space.
///
/// A mesh in the plane ([`Mesh::new`]) has its nodes at [x, y, 0], with x to the right and y up. Its degrees of
/// freedom are X, Y and Rotation, and all its quantities are per metre of thickness. A mesh in space
/// ([`Mesh::in_space`]) has its nodes at [x, y, z], with x to the right, y away from the reader and z up. Its degrees
/// of freedom are X, Y, Z, RotationX, RotationY and RotationZ.
///
/// Clones share their elements, which never change.
///
/// ```
/// use basemat::fem::{Beam, LumpedMass, Mesh};
///
/// let mut mesh = Mesh::new();
/// let foot = mesh.add_node(0.0, 0.0)?;
/// let top = mesh.add_node(0.0, 3.0)?;
/// mesh.add(Beam::new([foot, top], 30.0e9, 0.4, 0.01, 2400.0)?)?;
/// mesh.add(LumpedMass::new(top, 5000.0)?)?;
/// assert_eq!(mesh.elements().len(), 2);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Clone, Default)]
pub struct Mesh {
    nodes: Vec<[f64; 3]>,
    elements: Vec<Arc<dyn Element>>,
    /// Indices of the elements with each [`element_key`].
    elements_by_key: HashMap<Vec<usize>, Vec<usize>>,
    has_depth: bool,
    /// Geometric stiffness of static forces that rotate with each element.
    ///
    /// Empty without a static state.
    force_rotations: Vec<Option<ForceRotation>>,
}

short_debug! {
    Mesh; self; nodes: self.nodes,
    elements: self.elements.iter().map(|element| element.nodes()).collect::<Vec<_>>()
}

impl Mesh {
    /// Mesh in the plane, without nodes.
    pub fn new() -> Self {
        Self::default()
    }

    /// Mesh in space, without nodes.
    ///
    /// ```
    /// use basemat::fem::{Direction, Mesh, Spring};
    ///
    /// let mut mesh = Mesh::in_space();
    /// let foot = mesh.add_node_at([0.0, 0.0, 0.0])?;
    /// let top = mesh.add_node_at([0.0, 0.0, 3.0])?;
    /// mesh.add(Spring::new([foot, top], Direction::Z, 1.0e9)?)?;
    /// assert_eq!(mesh.nodes_at_height(3.0, 1e-9)?, [top]);
    /// // The rotation of the plane does not exist in space.
    /// assert!(mesh.add(Spring::new([foot, top], Direction::Rotation, 1.0e9)?).is_err());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn in_space() -> Self {
        Self { has_depth: true, ..Self::default() }
    }

    /// Mesh without nodes and elements, in the plane or in space as this one.
    pub(super) fn empty_mesh(&self) -> Self {
        Self { has_depth: self.has_depth, ..Self::default() }
    }

    /// Directions of the mesh's degrees of freedom: X, Y and Rotation, or the six of space.
    pub fn directions(&self) -> &'static [Direction] {
        if self.has_depth { SPACE_DIRECTIONS } else { PLANE_DIRECTIONS }
    }

    /// Adds a node at (`x`, `y`), m, and returns its index.
    ///
    /// In space it lies at z = 0, where y points away.
    ///
    /// # Errors
    /// [`Error::Input`] unless both are finite.
    pub fn add_node(&mut self, x: f64, y: f64) -> Result<usize> {
        self.add_node_at([x, y, 0.0])
    }

    /// Adds a node at `[x, y, z]`, m, and returns its index.
    ///
    /// # Errors
    /// [`Error::Input`] unless all are finite, and for z other than zero in the plane.
    pub fn add_node_at(&mut self, point: [f64; 3]) -> Result<usize> {
        check_finite(point)?;
        require("z of the node", point[2], self.has_depth || point[2] == 0.0, "zero in the plane")?;
        self.nodes.push(point);
        Ok(self.nodes.len() - 1)
    }

    /// Adds an element and returns its index.
    ///
    /// Elements may share all their nodes: springs, dashpots, masses and beams of different sections act in
    /// parallel, and a beam may stiffen the edge of a quadrilateral.
    ///
    /// # Errors
    /// [`Error::Index`] when one of its nodes does not exist; [`Error::Size`] when it has no nodes or no
    /// directions; [`Error::Scene`] when a node or direction occurs twice, for a direction outside of
    /// [`Mesh::directions`], or for an element of the plane in space ([`Element::is_plane`]). [`Error::Part`] when
    /// the element and another one are solids with the same corners ([`Element::faces`]). [`Error::Part`] also when
    /// the element has mass and at least two nodes, and another element on these nodes has the same stiffness,
    /// mass and damping: enter two equal bars as one bar of twice the section. Also errors of
    /// [`Element::check`].
    pub fn add(&mut self, element: impl Element + 'static) -> Result<usize> {
        let nodes = element.nodes();
        at_least("degrees of freedom of the element", element.order(), 1)?;
        let all_differ = !(has_repetition(nodes) || has_repetition(element.directions()));
        require_part("nodes and directions of the element", all_differ, "each only once")?;
        let mesh_directions = self.directions();
        let has_mesh_directions =
            element.directions().iter().all(|direction| mesh_directions.contains(direction));
        let needed = if self.has_depth {
            "x, y, z, rotation_x, rotation_y or rotation_z in space"
        } else {
            "x, y or rotation in the plane"
        };
        require_part("direction of the element", has_mesh_directions, needed)?;
        if element.is_plane() {
            self.require_plane("element of the plane")?;
        }
        for &node in nodes {
            in_bounds("node of the element", node, self.nodes.len())?;
        }
        element.check(&self.coordinates(nodes))?;
        let key = element_key(&element);
        let candidates = self.elements_by_key.get(&key).map_or(&[][..], Vec::as_slice);
        if let Some(duplicate) = candidates.iter().find(|candidate| {
            is_duplicate(&element, self.elements[**candidate].as_ref(), &self.nodes)
        }) {
            let item = format!("element on nodes {nodes:?}");
            let reason = format!("it duplicates element {duplicate}, and would count twice");
            return Err(Error::part(item, reason));
        }
        self.elements_by_key.entry(key).or_default().push(self.elements.len());
        self.elements.push(Arc::new(element));
        Ok(self.elements.len() - 1)
    }

    /// Coordinates [x, y, z] of all nodes, m; z is zero in the plane.
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// All elements, in the order in which they were added.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = &dyn Element> + Clone {
        self.elements.iter().map(AsRef::as_ref)
    }

    /// All elements, as shared pointers.
    pub(crate) fn shared_elements(&self) -> impl Iterator<Item = &Arc<dyn Element>> {
        self.elements.iter()
    }

    /// Smallest and largest density of the elements with mass, kg/m³; `None` without any.
    pub(crate) fn densities(&self) -> Option<[f64; 2]> {
        let mut density_range: Option<[f64; 2]> = None;
        for density in self.elements().filter_map(Element::density).filter(|density| *density > 0.0)
        {
            density_range =
                Some(density_range.map_or([density; 2], |[min_density, max_density]| {
                    [density.min(min_density), density.max(max_density)]
                }));
        }
        density_range
    }

    /// Index of the node at (`x`, `y`), m, within a millionth of the mesh's size.
    ///
    /// In space the point lies at z = 0.
    ///
    /// # Errors
    /// As for [`Mesh::node_at_point`].
    pub fn node_at(&self, x: f64, y: f64) -> Result<usize> {
        self.node_at_point([x, y, 0.0])
    }

    /// Index of the node at `[x, y, z]`, m, within a millionth of the mesh's size.
    ///
    /// # Errors
    /// [`Error::Input`] unless all are finite, [`Error::Size`] for an empty mesh, [`Error::NoNode`]
    /// with the nearest node if there is none at this point.
    pub fn node_at_point(&self, point: [f64; 3]) -> Result<usize> {
        check_finite(point)?;
        let node = self.nearest_node_to(point).ok_or(Error::Size {
            quantity: "nodes",
            found: 0,
            needed: 1,
        })?;
        let nearest_point = self.nodes[node];
        let nearest_distance = distance(nearest_point, point);
        if nearest_distance <= COINCIDENCE_TOLERANCE * self.largest_extent() {
            Ok(node)
        } else {
            Err(Error::NoNode { point, nearest: nearest_point, distance: nearest_distance })
        }
    }

    /// Index of the node nearest to (`x`, `y`), at any distance.
    ///
    /// `None` for an empty mesh.
    ///
    /// In space the point lies at z = 0. Of several equally near nodes the first one is returned. [`Mesh::node_at`]
    /// returns an error for a point without a node.
    pub fn nearest_node(&self, x: f64, y: f64) -> Option<usize> {
        self.nearest_node_to([x, y, 0.0])
    }

    /// Index of the node nearest to `[x, y, z]`, as [`Mesh::nearest_node`].
    pub fn nearest_node_to(&self, point: [f64; 3]) -> Option<usize> {
        let distances = self.nodes.iter().map(|node| distance(*node, point)).enumerate();
        distances.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(node, _)| node)
    }

    /// Other nodes that coincide with `node`, which must exist.
    pub(crate) fn coincident_nodes(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        let tolerance = COINCIDENCE_TOLERANCE * self.largest_extent();
        (0..self.nodes.len()).filter(move |&other| {
            other != node && distance(self.nodes[other], self.nodes[node]) <= tolerance
        })
    }

    /// Indices of the nodes at a `height` (m), within `tolerance` (m).
    ///
    /// The height is y in the plane and z in space. Nodes are listed from left to right, in space at each x from front
    /// to back.
    ///
    /// # Errors
    /// [`Error::Input`] unless `height` is finite and `tolerance` finite and not negative.
    pub fn nodes_at_height(&self, height: f64, tolerance: f64) -> Result<Vec<usize>> {
        finite("height of the nodes", height)?;
        not_negative("tolerance of the height", tolerance)?;
        let up_axis = self.up_axis();
        let mut nodes: Vec<usize> = (0..self.nodes.len())
            .filter(|&node| (self.nodes[node][up_axis] - height).abs() <= tolerance)
            .collect();
        // In the plane this axis is z, along which all coordinates are zero.
        let depth_axis = 3 - up_axis;
        nodes.sort_by(|&first, &second| {
            let first_point = self.nodes[first];
            let second_point = self.nodes[second];
            first_point[0]
                .total_cmp(&second_point[0])
                .then(first_point[depth_axis].total_cmp(&second_point[depth_axis]))
        });
        Ok(nodes)
    }

    /// Whether the mesh lies in space.
    #[doc(hidden)]
    pub fn has_depth(&self) -> bool {
        self.has_depth
    }

    /// Returns an error that names `item` unless the mesh lies in space.
    ///
    /// # Errors
    /// [`Error::Scene`].
    #[doc(hidden)]
    pub fn require_space(&self, item: &'static str) -> Result<()> {
        let needed = "must be in a mesh in space, but this one is in the plane";
        require_part(item, self.has_depth, needed)
    }

    /// Returns an error that names `item` unless the mesh lies in the plane.
    ///
    /// # Errors
    /// [`Error::Scene`].
    #[doc(hidden)]
    pub fn require_plane(&self, item: &'static str) -> Result<()> {
        let needed = "must be in a mesh in the plane, but this one is in space";
        require_part(item, !self.has_depth, needed)
    }

    /// Direction of upward displacements: Y in the plane, Z in space.
    pub(crate) fn up_direction(&self) -> Direction {
        self.directions()[self.up_axis()]
    }

    /// Index of the axis that points up: y in the plane, z in space.
    pub(crate) fn up_axis(&self) -> usize {
        if self.has_depth { 2 } else { 1 }
    }

    /// Height of the lowest node, m; 0 for an empty mesh.
    pub(crate) fn lowest_height(&self) -> f64 {
        self.nodes.iter().map(|node| node[self.up_axis()]).reduce(f64::min).unwrap_or(0.0)
    }

    /// Largest difference of heights that count as equal, m; far below the size of any element.
    pub(crate) fn height_tolerance(&self) -> f64 {
        HEIGHT_TOLERANCE * self.largest_extent()
    }

    /// Width, depth or height of the mesh, whichever is largest, m.
    fn largest_extent(&self) -> f64 {
        let mut extent = 0.0_f64;
        for axis in 0..3 {
            let coordinates = self.nodes.iter().map(|node| node[axis]);
            let min_coordinate = coordinates.clone().fold(f64::INFINITY, f64::min);
            let max_coordinate = coordinates.fold(f64::NEG_INFINITY, f64::max);
            extent = extent.max(max_coordinate - min_coordinate);
        }
        extent
    }

    /// Replaces every element for which `replacement` returns a new element.
    ///
    /// The arguments of `replacement` are the element and the coordinates of its nodes.
    ///
    /// # Errors
    /// [`Error::Scene`] for a replacement with other nodes or directions.
    pub(crate) fn replace_elements(
        &mut self,
        mut replacement: impl FnMut(&dyn Element, &[[f64; 3]]) -> Option<Box<dyn Element>>,
    ) -> Result<()> {
        for element in &mut self.elements {
            let coordinates: Vec<[f64; 3]> =
                element.nodes().iter().map(|&node| self.nodes[node]).collect();
            let Some(new_element) = replacement(element.as_ref(), &coordinates) else {
                continue;
            };
            let has_same_dofs = new_element.nodes() == element.nodes()
                && new_element.directions() == element.directions();
            let needed = "the same nodes and directions";
            require_part("element in the static state", has_same_dofs, needed)?;
            *element = Arc::from(new_element);
        }
        Ok(())
    }

    /// Geometric stiffness of an element's static forces, which rotate with it.
    pub(super) fn force_rotation(&self, element: usize) -> Option<&ForceRotation> {
        self.force_rotations.get(element)?.as_ref()
    }

    pub(super) fn set_force_rotations(&mut self, force_rotations: Vec<Option<ForceRotation>>) {
        self.force_rotations = force_rotations;
    }

    /// Coordinates of `nodes`, which must exist.
    pub(crate) fn coordinates(&self, nodes: &[usize]) -> Vec<[f64; 3]> {
        nodes.iter().map(|&node| self.nodes[node]).collect()
    }
}

/// Returns an error unless all coordinates of a node are finite.
fn check_finite([x, y, z]: [f64; 3]) -> Result<()> {
    finite("x of the node", x)?;
    finite("y of the node", y)?;
    finite("z of the node", z).map(drop)
}

/// Whether an item occurs twice.
fn has_repetition<T: PartialEq>(items: &[T]) -> bool {
    items.iter().enumerate().any(|(index, item)| items[..index].contains(item))
}
