//! The base's element means of displacement, and their transpose.

mod corner_weights;
pub(crate) mod faces;
pub(crate) mod fixed_base;
pub(crate) mod influence;
mod line;
mod tears;
pub(crate) mod transformation;

use std::ops::Range;

pub(crate) use tears::tears;

use crate::coupled::base::transformation::{Rows, Terms, Transformation, Weights, accumulate};
use crate::error::{Error, Result, at_least};
use crate::geometry::{ContactElement, ContactLayout, Patch, axis_name, far_ends, span};
use crate::linalg::dot;
use crate::structure::{Base, BaseNode, DofCombination, Structure};

/// Fraction of a foundation's length that may extend beyond the elements.
const MAX_UNCOVERED_FRACTION: f64 = 0.1;

/// B, from coordinates to element means of the base displacement, and BᵀA, from tractions to forces.
///
/// Normal components count down. The coordinates are the structure's degrees of freedom or its stepping
/// coordinates ([`stepped`](PlacedBase::stepped)). For elements between neighbouring nodes the means are the T matrix of
/// halves of Patel & Spyrakos, eq. 14, and the transpose is their eq. 15. `faces.rs` computes the means in plan.
#[derive(Debug, Clone)]
pub(crate) struct PlacedBase {
    /// Rows, component by component.
    rows: Rows,
    foundations: Vec<Outline>,
    elements: Patch,
    nodes: Vec<BaseNode>,
    /// Points under flexible foundations, for integrals over elements; empty in stepping coordinates.
    points: Vec<BasePoint>,
}

/// A point of a flexible base.
#[derive(Debug, Clone)]
pub(crate) struct BasePoint {
    pub(crate) element: usize,
    /// Area of the point in integrals, m²; in the plane a length.
    pub(crate) area: f64,
    /// Nodes, and their weights in the point's displacement.
    pub(crate) corner_weights: Vec<(usize, f64)>,
}

/// Foundation: its nodes, elements, settlement, rotations and outline.
///
/// In the plane it has the rotation of its chord; in plan also the rotations about the other axes, and the corners
/// of its convex outline.
#[derive(Debug, Clone)]
pub(crate) struct Outline {
    pub(crate) nodes: Range<usize>,
    pub(crate) elements: Range<usize>,
    pub(crate) settlement: Weights,
    pub(crate) rotations: Vec<Weights>,
    pub(crate) corners: Vec<[f64; 2]>,
}

impl PlacedBase {
    /// The base of `structure` on the elements of a ground.
    pub(crate) fn of(structure: &dyn Structure, patch: &Patch) -> Result<Self> {
        let base = structure.base();
        base.check(structure.dofs())?;
        let refuse = |needed| Err(Error::Scene { quantity: "structure", needed });
        match (base, patch.is_plan()) {
            (Base::Lines(lines), false) => Self::on_lines(&lines, patch),
            (Base::Faces(faces), true) => Self::on_faces(&faces, patch),
            (Base::Lines(_), true) => refuse(
                "must touch a ground in plan with faces: its base has lines of contact nodes, in the plane",
            ),
            (Base::Faces(_), false) => refuse(
                "must touch a ground of the plane with lines of contact nodes: its base has faces, in plan",
            ),
        }
    }

    /// A base of these foundations; `weights`: (node, weight) of the mean over each element.
    pub(crate) fn from_weights(
        nodes: Vec<BaseNode>,
        foundations: Vec<Outline>,
        weights: Vec<Vec<(usize, f64)>>,
        elements: &Patch,
        points: Vec<BasePoint>,
    ) -> Self {
        let layout = elements.layout();
        let mut rows = vec![Terms::new(); layout.len()];
        for (e, weights) in weights.into_iter().enumerate() {
            let means = components(&nodes, &weights, &elements[e]);
            for (component, terms) in means.into_iter().enumerate() {
                rows[layout.place(component, e)] = terms;
            }
        }
        let elements = elements.clone();
        Self { rows: Rows::Sparse(rows), foundations, elements, nodes, points }
    }

    /// Whether a foundation can bend.
    pub(crate) fn is_flexible(&self) -> bool {
        !self.points.is_empty()
    }

    /// Points under flexible foundations, each with its displacement minus the mean over its element.
    ///
    /// Component by component.
    pub(crate) fn deviations(&self) -> impl Iterator<Item = (&BasePoint, Vec<Terms>)> {
        let layout = self.layout();
        self.points.iter().map(move |point| {
            let mut rows =
                components(&self.nodes, &point.corner_weights, &self.elements[point.element]);
            for (component, terms) in rows.iter_mut().enumerate() {
                accumulate(terms, &self.mean_row(layout.place(component, point.element)), -1.0);
            }
            (point, rows)
        })
    }

    /// Component `i` of the element means as a weighted sum of degrees of freedom.
    ///
    /// Empty in stepping coordinates.
    pub(crate) fn mean_row(&self, i: usize) -> DofCombination {
        match &self.rows {
            Rows::Sparse(rows) => rows[i].iter().copied().collect(),
            Rows::Dense(_) => DofCombination::default(),
        }
    }

    /// This base in stepping coordinates.
    pub(crate) fn stepped(&self, transformation: &Transformation) -> Self {
        let mut foundations = self.foundations.clone();
        for footing in &mut foundations {
            for weights in footing.rotations.iter_mut().chain([&mut footing.settlement]) {
                if let Weights::Sparse(terms) = weights {
                    *weights = transformation.row(terms);
                }
            }
        }
        let points = Vec::new();
        Self { rows: transformation.rows(&self.rows), foundations, points, ..self.clone() }
    }

    /// This base with other numbers of the degrees of freedom; not in stepping coordinates.
    pub(crate) fn renumbered(&self, number: impl Fn(usize) -> usize) -> Self {
        let mut base = self.clone();
        for footing in &mut base.foundations {
            for weights in footing.rotations.iter_mut().chain([&mut footing.settlement]) {
                if let Weights::Sparse(terms) = weights {
                    for (dof, _) in terms.iter_mut() {
                        *dof = number(*dof);
                    }
                }
            }
        }
        if let Rows::Sparse(rows) = &mut base.rows {
            rows.iter_mut().flatten().for_each(|(dof, _)| *dof = number(*dof));
        }
        base.nodes.iter_mut().for_each(|node| node.map_rows(|row| row.map_dofs(&number)));
        base
    }

    /// The degrees of freedom that move contact nodes, ascending.
    pub(crate) fn dofs(&self) -> Vec<usize> {
        dofs_of(&self.nodes)
    }

    /// The contact nodes and the elements of each foundation.
    pub(crate) fn foundations(&self) -> impl Iterator<Item = (&[BaseNode], Range<usize>)> + '_ {
        self.foundations
            .iter()
            .map(|footing| (&self.nodes[footing.nodes.clone()], footing.elements.clone()))
    }

    /// Corners of the convex outline of each foundation in plan, counter-clockwise; empty in the plane.
    pub(crate) fn outlines(&self) -> impl Iterator<Item = &[[f64; 2]]> + '_ {
        self.foundations.iter().map(|footing| &footing.corners[..])
    }

    /// Foundations that extend too far beyond the ground's elements, the axis in plan, and how far (m).
    ///
    /// Too far: more than their longest side there or a tenth of the foundation.
    pub(crate) fn uncovered(&self) -> Vec<(usize, Option<char>, f64)> {
        let mut uncovered = Vec::new();
        for (foundation, (nodes, elements)) in self.foundations().enumerate() {
            for axis in self.layout().axes() {
                let ends =
                    self.elements[elements.clone()].iter().map(|element| element.ends()[axis]);
                let sides = ends.clone().map(|[low, high]| high - low);
                let longest_side = sides.fold(0.0, |longest: f64, side| side.max(longest));
                let edges = far_ends(ends);
                let corners = span(nodes.iter().map(|node| node.place()[axis]));
                let limit = longest_side.min(MAX_UNCOVERED_FRACTION * (corners[1] - corners[0]));
                let reach = (edges[0] - corners[0]).max(corners[1] - edges[1]);
                if reach > limit {
                    let axis = axis_name(self.elements.is_plan(), axis);
                    uncovered.push((foundation, axis, reach));
                }
            }
        }
        uncovered
    }

    /// The contact elements.
    pub(crate) fn elements(&self) -> &Patch {
        &self.elements
    }

    /// Areas A of the elements, m²; in the plane their lengths.
    pub(crate) fn areas(&self) -> &[f64] {
        self.elements.areas()
    }

    /// Order of the numbers of a contact vector.
    pub(crate) fn layout(&self) -> ContactLayout {
        self.elements.layout()
    }

    /// Area of contact component `i`.
    pub(crate) fn area(&self, i: usize) -> f64 {
        self.areas()[self.layout().origin(i)[1]]
    }

    /// out ← B u.
    pub(crate) fn means(&self, u: &[f64], out: &mut [f64]) {
        self.rows.multiply(u, out);
    }

    /// Component `i` of B u.
    pub(crate) fn component_mean(&self, i: usize, u: &[f64]) -> f64 {
        self.rows.sum(i, u)
    }

    /// Displacement `[right, up, away]` of element `e` from contact displacements.
    pub(crate) fn motion_of(&self, e: usize, displacement: &[f64]) -> [f64; 3] {
        let layout = self.layout();
        let mut components = [0.0; 3];
        for (component, value) in components.iter_mut().take(layout.components()).enumerate() {
            *value = displacement[layout.place(component, e)];
        }
        let vector = self.elements[e].vector(components);
        [vector[0], vector[2], vector[1]]
    }

    /// Mean `[right, up, away]` of contact displacements over the whole base.
    ///
    /// Nothing moves away in the plane.
    pub(crate) fn mean(&self, displacement: &[f64]) -> [f64; 3] {
        let layout = self.layout();
        let [down, along, across] = layout.split(displacement);
        let areas = self.areas();
        let area: f64 = areas.iter().sum();
        if self.elements.has_walls() {
            let mut mean = [0.0; 3];
            for (e, element_area) in areas.iter().enumerate() {
                for (sum, motion) in mean.iter_mut().zip(self.motion_of(e, displacement)) {
                    *sum += element_area / area * motion;
                }
            }
            return mean;
        }
        let away = if across.is_empty() { 0.0 } else { dot(across, areas) / area };
        [dot(along, areas) / area, -(dot(down, areas) / area), away]
    }

    /// f ← f + factor · BᵀA τ.
    pub(crate) fn add_forces(&self, factor: f64, traction: &[f64], force: &mut [f64]) {
        self.rows.add_transposed(factor, |i| self.area(i), traction, force);
    }

    /// Rotation of a foundation (counter-clockwise), from the chord between its ends.
    ///
    /// In plan: the rotations about y, about x and about the vertical, by the right-hand rule.
    pub(crate) fn rotations(&self, foundation: usize, u: &[f64]) -> impl Iterator<Item = f64> {
        self.foundations[foundation].rotations.iter().map(|rotation| rotation.of(u))
    }

    /// Settlement of a foundation, downwards: mean displacement over its length, in plan over its area.
    pub(crate) fn settlement(&self, foundation: usize, u: &[f64]) -> f64 {
        self.foundations[foundation].settlement.of(u)
    }

    /// Largest error of N r for translations of 1 to the right, 1 up and 1 away.
    ///
    /// N: displacements of the contact nodes. Components without terms are ignored.
    pub(crate) fn translation_error(&self, translations: &[Vec<f64>]) -> f64 {
        let mut max_error = 0.0_f64;
        for (direction, translation) in translations.iter().enumerate() {
            for (terms, needed) in self.node_components(direction) {
                max_error = max_error.max((terms.value(translation) - needed).abs());
            }
        }
        max_error
    }

    /// Corrects `translation` so that the contact nodes move by exactly 1 m.
    ///
    /// Directions: 0 to the right, 1 upwards, 2 away.
    pub(crate) fn translate_nodes(&self, direction: usize, translation: &mut [f64]) {
        for _ in 0..4 {
            for (terms, needed) in self.node_components(direction) {
                let missing = needed - terms.value(translation);
                let square: f64 = terms.iter().map(|(_, weight)| weight * weight).sum();
                if missing != 0.0 && square > 0.0 {
                    for &(i, weight) in terms {
                        translation[i] += missing * weight / square;
                    }
                }
            }
        }
    }

    /// Rows of the contact nodes, and their values under a translation of 1 m.
    fn node_components(&self, direction: usize) -> impl Iterator<Item = (&DofCombination, f64)> {
        let rows = self.nodes.iter().flat_map(|node| node.rows().into_iter().enumerate());
        rows.filter(|(_, row)| !row.is_empty())
            .map(move |(k, row)| (row, if k == direction { 1.0 } else { 0.0 }))
    }

    /// The contact nodes.
    pub(crate) fn nodes(&self) -> &[BaseNode] {
        &self.nodes
    }
}

/// The degrees of freedom that move contact nodes, ascending.
fn dofs_of(nodes: &[BaseNode]) -> Vec<usize> {
    let mut dofs: Vec<_> = nodes.iter().flat_map(BaseNode::dofs).collect();
    dofs.sort_unstable();
    dofs.dedup();
    dofs
}

/// Displacement by (node, weight) terms along the directions of an element.
fn components(
    nodes: &[BaseNode],
    weights: &[(usize, f64)],
    element: &ContactElement,
) -> Vec<Terms> {
    let mut components = Vec::new();
    for direction in element.directions() {
        let mut component = Terms::new();
        for &(node, weight) in weights {
            let BaseNode { horizontal, across, vertical, .. } = &nodes[node];
            let rows = direction.iter().zip([horizontal, across, vertical]);
            for (part, row) in rows.filter(|(part, _)| **part != 0.0) {
                accumulate(&mut component, row, part * weight);
            }
        }
        components.push(component);
    }
    components
}

/// Error for a foundation without elements.
pub(crate) fn check_covered(foundations: &[Outline]) -> Result<()> {
    let quantity = "list of contact elements under a foundation";
    foundations
        .iter()
        .try_for_each(|footing| at_least(quantity, footing.elements.len(), 1))
}

#[cfg(test)]
mod tests;
