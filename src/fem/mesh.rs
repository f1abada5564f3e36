//! Nodes and the elements between them.

use std::collections::HashMap;
use std::sync::Arc;

use super::element::{Element, MassKind};
use crate::error::{Error, Result, at_least, finite, in_bounds, not_negative, require_part};

/// Largest distance of a node from a given point at which it counts as the same point, relative to the mesh's size.
///
/// It is far below the size of any element and far above the rounding of a coordinate.
const SAME_POINT: f64 = 1e-6;

/// Relative difference below which matrix entries count as equal: rounding.
const ALIKE: f64 = 1e-12;

/// Nodes and elements.
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
    nodes: Vec<[f64; 2]>,
    elements: Vec<Arc<dyn Element>>,
    /// Indices of elements by sorted corner nodes or, for elements without corners, by all their nodes.
    places: HashMap<Vec<usize>, Vec<usize>>,
}

short_debug! {
    Mesh; self; nodes: self.nodes,
    elements: self.elements.iter().map(|element| element.nodes()).collect::<Vec<_>>()
}

impl Mesh {
    /// Mesh without nodes.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a node at (`x`, `y`), m, and returns its index.
    ///
    /// # Errors
    /// [`Error::Input`] unless both are finite.
    pub fn add_node(&mut self, x: f64, y: f64) -> Result<usize> {
        finite("x of the node", x)?;
        finite("y of the node", y)?;
        self.nodes.push([x, y]);
        Ok(self.nodes.len() - 1)
    }

    /// Adds an element and returns its index.
    ///
    /// Elements may share all their nodes: springs, dashpots, masses and beams of different sections act in
    /// parallel, and a beam may stiffen the edge of a quadrilateral.
    ///
    /// # Errors
    /// [`Error::Index`] when one of its nodes does not exist; [`Error::Size`] when it has no nodes or no
    /// directions; [`Error::Scene`] when a node or direction occurs twice. [`Error::Part`] when
    /// another element has the same [`corners`](Element::corners). [`Error::Part`] also when the
    /// element has mass and at least two nodes, and another element on these nodes has the same stiffness,
    /// mass and damping: enter two equal bars as one bar of twice the section. Any error of
    /// [`Element::check`].
    pub fn add(&mut self, element: impl Element + 'static) -> Result<usize> {
        let nodes = element.nodes();
        at_least("degrees of freedom of the element", element.order(), 1)?;
        let differ = !(repeats(nodes) || repeats(element.directions()));
        require_part("nodes and directions of the element", differ, "each only once")?;
        for &index in nodes {
            in_bounds("node of the element", index, self.nodes.len())?;
        }
        element.check(&self.coordinates(nodes))?;
        let key = place(&element);
        let others = self.places.get(&key).map_or(&[][..], Vec::as_slice);
        if let Some(&first) = others.iter().find(|&&other| self.counts_twice(other, &element)) {
            let item = format!("element on nodes {nodes:?}");
            let reason = format!("it lies where element {first} is, and would count twice");
            return Err(Error::part(item, reason));
        }
        self.places.entry(key).or_default().push(self.elements.len());
        self.elements.push(Arc::new(element));
        Ok(self.elements.len() - 1)
    }

    /// Whether `element` is a duplicate of the element `other` at the same nodes.
    fn counts_twice(&self, other: usize, element: &dyn Element) -> bool {
        let other = self.elements[other].as_ref();
        if !element.corners().is_empty() {
            return !other.corners().is_empty();
        }
        let (nodes, directions) = (element.nodes(), element.directions());
        let order = nodes.len() * directions.len();
        let alike = other.directions() == directions && other.corners().is_empty();
        if nodes.len() < 2 || !alike || [element.order(), other.order()] != [order; 2] {
            return false;
        }
        let (own, mass) = self.matrices_by_node(element);
        let (others, _) = self.matrices_by_node(other);
        let near = |a: &f64, b: &f64| (a - b).abs() <= ALIKE * a.abs().max(b.abs());
        mass && own.iter().zip(&others).all(|(a, b)| near(a, b))
    }

    /// Stiffness, mass and damping of an element with its nodes in ascending order, and whether it has mass.
    fn matrices_by_node(&self, element: &dyn Element) -> (Vec<f64>, bool) {
        let (nodes, points) = (element.nodes(), self.coordinates(element.nodes()));
        let (order, directions) = (element.order(), element.directions().len());
        let mut ascending: Vec<usize> = (0..nodes.len()).collect();
        ascending.sort_by_key(|&k| nodes[k]);
        let places: Vec<usize> =
            ascending.into_iter().flat_map(|k| k * directions..(k + 1) * directions).collect();
        let [mut stiffness, mut mass, mut damping] = [(); 3].map(|()| vec![0.0; order * order]);
        element.stiffness(&points, &mut stiffness);
        element.mass(&points, MassKind::default(), &mut mass);
        element.damping(&points, &mut damping);
        let has_mass = mass.iter().any(|mass| *mass != 0.0);
        let mut all = Vec::with_capacity(3 * order * order);
        for matrix in [stiffness, mass, damping] {
            let largest = matrix.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
            for &row in &places {
                // An entry that cancels keeps a rounding error, which depends on the order of the nodes.
                let entry = |&column: &usize| matrix[row * order + column];
                let clean = |entry: f64| if entry.abs() > ALIKE * largest { entry } else { 0.0 };
                all.extend(places.iter().map(entry).map(clean));
            }
        }
        (all, has_mass)
    }

    /// Coordinates [x, y] of all nodes, m.
    pub fn nodes(&self) -> &[[f64; 2]] {
        &self.nodes
    }

    /// All elements, in the order in which they were added.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = &dyn Element> + Clone {
        self.elements.iter().map(AsRef::as_ref)
    }

    /// Index of the node at (`x`, `y`), m, within a millionth of the mesh's size.
    ///
    /// # Errors
    /// [`Error::Input`] unless both are finite, [`Error::Size`] for an empty mesh, [`Error::NoNode`]
    /// with the nearest node if there is none at this point.
    pub fn node_at(&self, x: f64, y: f64) -> Result<usize> {
        finite("x of the node", x)?;
        finite("y of the node", y)?;
        let needed = 1;
        let found =
            self.nearest_node(x, y).ok_or(Error::Size { quantity: "nodes", found: 0, needed })?;
        let nearest = self.nodes[found];
        let distance = (nearest[0] - x).hypot(nearest[1] - y);
        if distance <= SAME_POINT * self.extent() {
            Ok(found)
        } else {
            Err(Error::NoNode { x, y, nearest, distance })
        }
    }

    /// Index of the node nearest to (`x`, `y`), at any distance; `None` for an empty mesh.
    ///
    /// If several nodes are equally near, the first. [`Mesh::node_at`] returns an error for a point without a
    /// node.
    pub fn nearest_node(&self, x: f64, y: f64) -> Option<usize> {
        let distance = |node: &[f64; 2]| (node[0] - x).hypot(node[1] - y);
        let pairs = self.nodes.iter().map(distance).enumerate();
        pairs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
    }

    /// Other nodes at the same point as `node`, which must exist.
    pub(crate) fn nodes_beside(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        let [x, y] = self.nodes[node];
        let near = SAME_POINT * self.extent();
        let beside = move |&other: &usize| {
            let [a, b] = self.nodes[other];
            other != node && (a - x).hypot(b - y) <= near
        };
        (0..self.nodes.len()).filter(beside)
    }

    /// Indices of the nodes at height `y` within `tolerance` (m), from left to right.
    ///
    /// # Errors
    /// [`Error::Input`] unless `y` is finite and `tolerance` finite and not negative.
    pub fn nodes_at_height(&self, y: f64, tolerance: f64) -> Result<Vec<usize>> {
        finite("height of the nodes", y)?;
        not_negative("tolerance of the height", tolerance)?;
        let near = |&index: &usize| (self.nodes[index][1] - y).abs() <= tolerance;
        let mut found: Vec<usize> = (0..self.nodes.len()).filter(near).collect();
        found.sort_by(|&a, &b| self.nodes[a][0].total_cmp(&self.nodes[b][0]));
        Ok(found)
    }

    /// Height of the lowest node, m; 0 for an empty mesh.
    pub(crate) fn lowest(&self) -> f64 {
        self.nodes.iter().map(|node| node[1]).reduce(f64::min).unwrap_or(0.0)
    }

    /// Default tolerance for equal heights, m; far below the size of any element.
    pub(crate) fn tolerance(&self) -> f64 {
        1e-9 * self.extent()
    }

    /// Width or height of the mesh, whichever is larger, m.
    fn extent(&self) -> f64 {
        let extent = |axis: usize| {
            let values = self.nodes.iter().map(|node| node[axis]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |range, value| {
                (range.0.min(value), range.1.max(value))
            });
            (high - low).max(0.0)
        };
        extent(0).max(extent(1))
    }

    /// Replaces every element for which `other` returns a new element.
    ///
    /// The arguments of `other` are the element and the coordinates of its nodes.
    ///
    /// # Errors
    /// [`Error::Scene`] for a replacement with other nodes or directions.
    pub(crate) fn replace_elements(
        &mut self,
        mut other: impl FnMut(&dyn Element, &[[f64; 2]]) -> Option<Box<dyn Element>>,
    ) -> Result<()> {
        for element in &mut self.elements {
            let points: Vec<[f64; 2]> =
                element.nodes().iter().map(|&index| self.nodes[index]).collect();
            let Some(changed) = other(element.as_ref(), &points) else { continue };
            let is_like =
                changed.nodes() == element.nodes() && changed.directions() == element.directions();
            let needed = "its own nodes and directions";
            require_part("element in the static state", is_like, needed)?;
            *element = Arc::from(changed);
        }
        Ok(())
    }

    /// Coordinates of `nodes`, which must exist.
    pub(crate) fn coordinates(&self, nodes: &[usize]) -> Vec<[f64; 2]> {
        nodes.iter().map(|&index| self.nodes[index]).collect()
    }
}

/// Corner nodes of an element that fills an area, and all nodes of other elements, sorted.
fn place(element: &dyn Element) -> Vec<usize> {
    let corners = element.corners();
    let mut key = if corners.is_empty() { element.nodes() } else { corners }.to_vec();
    key.sort_unstable();
    key
}

fn repeats<T: PartialEq>(items: &[T]) -> bool {
    items.iter().enumerate().any(|(index, item)| items[..index].contains(item))
}
