//! Base of a structure on contact elements: means of displacement, and forces.

mod corner_weights;
pub(crate) mod faces;
pub(crate) mod fixed_base;
pub(crate) mod influence;
pub(crate) mod joint_line;
mod joints;
mod line;
mod tears;
pub(crate) mod transformation;
mod uncovered;
mod water;

use std::ops::Range;

use joint_line::{JointLine, PlacedJoint};
pub(crate) use tears::tears;

use crate::coupled::base::transformation::{
    Rows, SparseVector, Transformation, Weights, accumulate,
};
use crate::error::{Error, Result, at_least};
use crate::geometry::{ContactElement, ContactLayout, Patch};
use crate::linalg::dot;
use crate::structure::{Base, BaseNode, DofCombination, Structure};

/// Number of passes that correct the translations of the contact nodes.
///
/// Each pass removes the rounding of the pass before.
const TRANSLATION_CORRECTION_COUNT: usize = 4;

/// Base on contact elements.
///
/// B maps coordinates to element means of displacement, and BᵀA maps tractions to forces.
///
/// Normal components are positive downwards. The coordinates are the structure's degrees of freedom or its stepping
/// coordinates ([`stepped`](PlacedBase::stepped)). For elements between neighbouring nodes B is the matrix T of halves of
/// Patel & Spyrakos, eq. 14, and Bᵀ their eq. 15. `faces.rs` computes the means in plan.
#[derive(Debug, Clone)]
pub(crate) struct PlacedBase {
    /// Rows of B, component by component.
    rows: Rows,
    foundations: Vec<PlacedFoundation>,
    /// Elements of the ground.
    elements: Patch,
    joints: Vec<PlacedJoint>,
    /// Order of the numbers of a contact vector: elements of the ground, then of the joints.
    layout: ContactLayout,
    /// Areas of all elements, m².
    areas: Vec<f64>,
    /// Nodes of the foundations, then of the joints.
    nodes: Vec<BaseNode>,
    /// Integration points under flexible foundations; empty in stepping coordinates.
    points: Vec<BasePoint>,
}

/// Integration point under a flexible foundation.
#[derive(Debug, Clone)]
pub(crate) struct BasePoint {
    pub(crate) element: usize,
    /// Weight of the point in an integral over the area, m²; in the plane a length, m.
    pub(crate) area: f64,
    /// Indices of nodes, and their weights in the point's displacement.
    pub(crate) corner_weights: Vec<(usize, f64)>,
}

/// Foundation on contact elements.
#[derive(Debug, Clone)]
pub(crate) struct PlacedFoundation {
    /// Indices of its nodes in the base.
    pub(crate) nodes: Range<usize>,
    /// Indices of its contact elements.
    pub(crate) elements: Range<usize>,
    /// Settlement, downwards.
    pub(crate) settlement: Weights,
    /// Rotation of the chord in the plane; in plan three rotations.
    ///
    /// These are about y, about x and about the vertical.
    pub(crate) rotations: Vec<Weights>,
    /// Corners of the convex outline in plan, counter-clockwise; empty in the plane.
    pub(crate) corners: Vec<[f64; 2]>,
}

impl PlacedBase {
    /// Places the base of `structure` on the elements of a ground, with joints.
    pub(crate) fn of(
        structure: &dyn Structure,
        patch: &Patch,
        joints: &[JointLine],
    ) -> Result<Self> {
        joints.iter().try_for_each(|joint| joint.check(structure.dofs()))?;
        Self::on_ground(structure, patch)?.with_joints(joints)
    }

    /// Places the base of `structure` on the elements of a ground.
    fn on_ground(structure: &dyn Structure, patch: &Patch) -> Result<Self> {
        let base = structure.base();
        base.check(structure.dofs())?;
        let scene_error = |needed| Err(Error::Scene { quantity: "structure", needed });
        match (base, patch.is_plan()) {
            (Base::Lines(lines), false) => Self::on_lines(&lines, patch),
            (Base::Faces(faces), true) => Self::on_faces(&faces, patch),
            (Base::Lines(_), true) => scene_error(
                "must touch a ground in plan with faces: its base has lines of contact nodes, in the plane",
            ),
            (Base::Faces(_), false) => scene_error(
                "must touch a ground of the plane with lines of contact nodes: its base has faces, in plan",
            ),
        }
    }

    /// A base in degrees of freedom, from the weights of its nodes.
    ///
    /// `weights` has pairs of a node's index and its weight in the mean displacement of each element.
    pub(crate) fn from_weights(
        nodes: Vec<BaseNode>,
        foundations: Vec<PlacedFoundation>,
        weights: Vec<Vec<(usize, f64)>>,
        elements: &Patch,
        points: Vec<BasePoint>,
    ) -> Self {
        let layout = elements.layout();
        let mut rows = vec![SparseVector::new(); layout.len()];
        for (e, element_weights) in weights.into_iter().enumerate() {
            let means = element_components(&nodes, &element_weights, &elements[e]);
            for (component, terms) in means.into_iter().enumerate() {
                rows[layout.index_of(component, e)] = terms;
            }
        }
        Self {
            rows: Rows::Sparse(rows),
            foundations,
            areas: elements.areas().to_vec(),
            elements: elements.clone(),
            joints: Vec::new(),
            layout,
            nodes,
            points,
        }
    }

    /// Whether a foundation can bend.
    pub(crate) fn is_flexible(&self) -> bool {
        !self.points.is_empty()
    }

    /// Integration points, with the deviation of their displacement from the mean over the element.
    ///
    /// Each deviation has one row for each component.
    pub(crate) fn deviations(&self) -> impl Iterator<Item = (&BasePoint, Vec<SparseVector>)> {
        let layout = self.layout();
        self.points.iter().map(move |point| {
            let mut rows = element_components(
                &self.nodes,
                &point.corner_weights,
                &self.elements[point.element],
            );
            for (component, terms) in rows.iter_mut().enumerate() {
                accumulate(terms, &self.mean_row(layout.index_of(component, point.element)), -1.0);
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
        for foundation in &mut foundations {
            let rotations = foundation.rotations.iter_mut();
            for weights in rotations.chain([&mut foundation.settlement]) {
                if let Weights::Sparse(terms) = weights {
                    *weights = transformation.weights(terms);
                }
            }
        }
        let points = Vec::new();
        Self { rows: transformation.rows(&self.rows), foundations, points, ..self.clone() }
    }

    /// This base with renumbered degrees of freedom; not for stepping coordinates.
    pub(crate) fn renumbered(&self, new_index: impl Fn(usize) -> usize) -> Self {
        let mut base = self.clone();
        for foundation in &mut base.foundations {
            let rotations = foundation.rotations.iter_mut();
            for weights in rotations.chain([&mut foundation.settlement]) {
                if let Weights::Sparse(terms) = weights {
                    for (dof, _) in terms.iter_mut() {
                        *dof = new_index(*dof);
                    }
                }
            }
        }
        if let Rows::Sparse(rows) = &mut base.rows {
            rows.iter_mut().flatten().for_each(|(dof, _)| *dof = new_index(*dof));
        }
        base.nodes.iter_mut().for_each(|node| node.map_rows(|row| row.map_dofs(&new_index)));
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
            .map(|foundation| (&self.nodes[foundation.nodes.clone()], foundation.elements.clone()))
    }

    /// Corners of the convex outline of each foundation in plan, counter-clockwise; empty in the plane.
    pub(crate) fn outlines(&self) -> impl Iterator<Item = &[[f64; 2]]> + '_ {
        self.foundations.iter().map(|foundation| &foundation.corners[..])
    }

    /// The contact elements of the ground.
    pub(crate) fn elements(&self) -> &Patch {
        &self.elements
    }

    /// Areas A of all elements, m²; in the plane their lengths.
    ///
    /// Elements of joints follow those of the ground.
    pub(crate) fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// Order of the numbers of a contact vector, of the ground and the joints.
    pub(crate) fn layout(&self) -> ContactLayout {
        self.layout
    }

    /// Area of the element of contact component `i`, m²; in the plane its length, m.
    pub(crate) fn area(&self, i: usize) -> f64 {
        self.areas()[self.layout().component_and_element(i)[1]]
    }

    /// Writes the element means B u to `means`.
    pub(crate) fn means(&self, u: &[f64], means: &mut [f64]) {
        self.rows.multiply(u, means);
    }

    /// Component `i` of the element means B u.
    pub(crate) fn component_mean(&self, i: usize, u: &[f64]) -> f64 {
        self.rows.row_value(i, u)
    }

    /// Displacement `[right, up, along_y]` of element `e`, from contact displacements.
    ///
    /// On an element of a joint it is that of the upper side relative to the lower side.
    pub(crate) fn element_displacement(&self, e: usize, displacement: &[f64]) -> [f64; 3] {
        let layout = self.layout();
        let mut components = [0.0; 3];
        for (component, value) in components.iter_mut().take(layout.components()).enumerate() {
            *value = displacement[layout.index_of(component, e)];
        }
        let vector = self.element(e).vector(components);
        [vector[0], vector[2], vector[1]]
    }

    /// Mean `[right, up, along_y]` of contact displacements over the area of the whole base.
    ///
    /// The component along y is zero in the plane.
    pub(crate) fn mean_displacement(&self, displacement: &[f64]) -> [f64; 3] {
        let layout = self.layout();
        let areas = self.elements.areas();
        let ground_count = areas.len();
        let [down, tangential_x, tangential_y] =
            layout.split(displacement).map(|values| &values[..ground_count.min(values.len())]);
        let total_area: f64 = areas.iter().sum();
        if self.elements.has_walls() {
            let mut mean = [0.0; 3];
            for (e, element_area) in areas.iter().enumerate() {
                for (sum, component) in
                    mean.iter_mut().zip(self.element_displacement(e, displacement))
                {
                    *sum += element_area / total_area * component;
                }
            }
            return mean;
        }
        let along_y =
            if tangential_y.is_empty() { 0.0 } else { dot(tangential_y, areas) / total_area };
        [dot(tangential_x, areas) / total_area, -(dot(down, areas) / total_area), along_y]
    }

    /// Adds the generalised forces factor · BᵀA τ of the tractions to `force`.
    pub(crate) fn add_forces(&self, factor: f64, traction: &[f64], force: &mut [f64]) {
        self.rows.add_transposed(factor, |i| self.area(i), traction, force);
    }

    /// Rotations of a foundation, rad.
    ///
    /// In the plane the only rotation is that of the chord, counter-clockwise. In plan the rotations are about y, about
    /// x and about the vertical, by the right-hand rule.
    pub(crate) fn rotations(&self, foundation: usize, u: &[f64]) -> impl Iterator<Item = f64> {
        self.foundations[foundation].rotations.iter().map(|rotation| rotation.value(u))
    }

    /// Settlement of a foundation, downwards, m.
    ///
    /// It is the mean displacement over the length of its floor, in plan the mean over its area.
    pub(crate) fn settlement(&self, foundation: usize, u: &[f64]) -> f64 {
        self.foundations[foundation].settlement.value(u)
    }

    /// Largest error of the contact nodes' displacements under translations of 1 m, m.
    ///
    /// The translations are to the right, upwards and horizontally along y. Components without terms are ignored.
    pub(crate) fn translation_error(&self, translations: &[Vec<f64>]) -> f64 {
        let mut max_error = 0.0_f64;
        for (direction, translation) in translations.iter().enumerate() {
            for (row, expected) in self.node_rows(direction) {
                max_error = max_error.max((row.value(translation) - expected).abs());
            }
        }
        max_error
    }

    /// Corrects `translation` so that the contact nodes move by exactly 1 m.
    ///
    /// Directions: 0 to the right, 1 upwards, 2 horizontally along y.
    pub(crate) fn translate_nodes(&self, direction: usize, translation: &mut [f64]) {
        for _ in 0..TRANSLATION_CORRECTION_COUNT {
            for (row, expected) in self.node_rows(direction) {
                let residual = expected - row.value(translation);
                let squared_norm: f64 = row.iter().map(|(_, weight)| weight * weight).sum();
                if residual != 0.0 && squared_norm > 0.0 {
                    for &(i, weight) in row {
                        translation[i] += residual * weight / squared_norm;
                    }
                }
            }
        }
    }

    /// Rows of the contact nodes' displacements, and their values under a translation of 1 m.
    fn node_rows(&self, direction: usize) -> impl Iterator<Item = (&DofCombination, f64)> {
        let rows = self.nodes.iter().flat_map(|node| node.rows().into_iter().enumerate());
        rows.filter(|(_, row)| !row.is_empty())
            .map(move |(component, row)| (row, if component == direction { 1.0 } else { 0.0 }))
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

/// Weighted displacement of nodes in the directions of an element: normal and tangential components.
fn element_components(
    nodes: &[BaseNode],
    weights: &[(usize, f64)],
    element: &ContactElement,
) -> Vec<SparseVector> {
    let mut components = Vec::new();
    for direction in element.directions() {
        let mut terms = SparseVector::new();
        for &(node, weight) in weights {
            let BaseNode { horizontal, across, vertical, .. } = &nodes[node];
            let rows = direction.iter().zip([horizontal, across, vertical]);
            for (cosine, row) in rows.filter(|(cosine, _)| **cosine != 0.0) {
                accumulate(&mut terms, row, cosine * weight);
            }
        }
        components.push(terms);
    }
    components
}

/// Returns an error for a foundation without elements.
pub(crate) fn check_covered(foundations: &[PlacedFoundation]) -> Result<()> {
    let quantity = "list of contact elements under a foundation";
    foundations
        .iter()
        .try_for_each(|foundation| at_least(quantity, foundation.elements.len(), 1))
}

#[cfg(test)]
mod tests;
