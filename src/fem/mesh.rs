//! Nodes and the elements between them.

use std::sync::Arc;

use super::element::Element;
use crate::error::{Error, Result, finite, not_negative};

/// Farthest that a node may be from where it is looked for, over the size of the mesh: far below
/// any element, far above the rounding of a coordinate.
const SAME_POINT: f64 = 1e-6;

/// Nodes and elements. Clones share their elements, which never change.
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
}

impl std::fmt::Debug for Mesh {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let connectivity: Vec<&[usize]> = self.elements.iter().map(|e| e.nodes()).collect();
        let mut fields = formatter.debug_struct("Mesh");
        fields.field("nodes", &self.nodes).field("elements", &connectivity).finish()
    }
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
    /// # Errors
    /// [`Error::Index`] when one of its nodes does not exist; [`Error::Size`] when it has no nodes
    /// or no directions; [`Error::Scene`] when a node or direction comes twice; and what
    /// [`Element::check`] finds.
    pub fn add(&mut self, element: impl Element + 'static) -> Result<usize> {
        let nodes = element.nodes();
        if element.order() == 0 {
            return Err(Error::Size { quantity: "unknowns of the element", found: 0, needed: 1 });
        }
        if repeats(nodes) || repeats(element.directions()) {
            return Err(Error::Scene {
                quantity: "nodes and directions of the element",
                needed: "each only once",
            });
        }
        for &index in nodes {
            if index >= self.nodes.len() {
                let bound = self.nodes.len();
                return Err(Error::Index { quantity: "node of the element", index, bound });
            }
        }
        element.check(&self.coordinates(nodes))?;
        self.elements.push(Arc::new(element));
        Ok(self.elements.len() - 1)
    }

    /// Coordinates [x, y] of all nodes, m.
    pub fn nodes(&self) -> &[[f64; 2]] {
        &self.nodes
    }

    /// All elements, in the order in which they were added.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = &dyn Element> + Clone {
        self.elements.iter().map(AsRef::as_ref)
    }

    /// The element of this index; `None` if there is none.
    pub fn element(&self, index: usize) -> Option<&dyn Element> {
        self.elements.get(index).map(AsRef::as_ref)
    }

    /// Node at (`x`, `y`), m: the nearest one, which may be a millionth of the mesh's size away.
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

    /// Node nearest to (`x`, `y`), however far that is, the first one when several are; `None` for
    /// an empty mesh. [`Mesh::node_at`] refuses a point without a node.
    pub fn nearest_node(&self, x: f64, y: f64) -> Option<usize> {
        let distance = |node: &[f64; 2]| (node[0] - x).hypot(node[1] - y);
        let pairs = self.nodes.iter().map(distance).enumerate();
        pairs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
    }

    /// Nodes whose height differs from `y` by no more than `tolerance` (m), from left to right.
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
    pub fn lowest(&self) -> f64 {
        self.nodes.iter().map(|node| node[1]).reduce(f64::min).unwrap_or(0.0)
    }

    /// A length far below that of any element: the default tolerance for equal heights, m.
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

    /// Replaces every element for which `other` returns one; its arguments are the element and the
    /// coordinates of its nodes.
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
            if changed.nodes() != element.nodes() || changed.directions() != element.directions() {
                let quantity = "element in the static state";
                return Err(Error::Scene { quantity, needed: "its own nodes and directions" });
            }
            *element = Arc::from(changed);
        }
        Ok(())
    }

    /// Coordinates of `nodes`, which must exist.
    pub(crate) fn coordinates(&self, nodes: &[usize]) -> Vec<[f64; 2]> {
        nodes.iter().map(|&index| self.nodes[index]).collect()
    }
}

fn repeats<T: PartialEq>(items: &[T]) -> bool {
    items.iter().enumerate().any(|(index, item)| items[..index].contains(item))
}
