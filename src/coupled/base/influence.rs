//! Influence vectors: displacements under a translation of a connected part by 1 m.
//!
//! | symbol | meaning |
//! |---|---|
//! | R | influence vectors: for each part one to the right, one upwards and, in plan, one horizontally along y |
//! | y | mean translation of the free field under each part |

use crate::coupled::base::PlacedBase;
use crate::coupled::base::transformation::SparseVector;
use crate::error::{Error, Result};
use crate::linalg::matrix::dense_vector;
use crate::structure::BaseNode;

/// The influence vectors of all connected parts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Influence {
    parts: Vec<ConnectedPart>,
    /// Indices of the parts of the upper and of the lower side of each joint.
    joint_parts: Vec<[usize; 2]>,
    /// Number of directions of translation: right, up and, in plan, horizontally along y.
    direction_count: usize,
}

/// Index of the upward direction among right, up and along y.
pub(crate) const UPWARD_DIRECTION: usize = 1;

/// A connected part of the structure and the elements under it.
#[derive(Debug, Clone)]
pub(crate) struct ConnectedPart {
    /// Influence vectors to the right, upwards and horizontally along y.
    ///
    /// A vector is empty if the part cannot move in its direction.
    pub(crate) vectors: [SparseVector; 3],
    /// Ground elements under the part, or under the parts on which it stands.
    elements: Vec<usize>,
    /// The part on which it stands; `None` for a part with foundations.
    support: Option<Support>,
}

/// Joint by which a part without foundations stands on another part.
#[derive(Debug, Clone, Copy)]
struct Support {
    /// Index of the other part.
    part: usize,
    /// Contact element of the joint.
    element: usize,
    /// Sign of the part's displacement in the rows of B: −1 for the lower side.
    sign: f64,
}

impl Influence {
    /// Splits the rigid translations of the whole structure into translations of its parts.
    ///
    /// `part_labels` has a number for each degree of freedom; degrees of freedom of one part have equal numbers. Returns an
    /// error for a side of a joint with nodes of several parts, and for a part that no joints connect to the ground.
    pub(crate) fn split(
        base: &PlacedBase,
        translations: &[Vec<f64>],
        part_labels: &[usize],
    ) -> Result<Self> {
        let mut parts: Vec<(usize, ConnectedPart)> = Vec::new();
        let new_part = |part_label: usize, elements, support| {
            let vectors = [0, 1, 2].map(|direction| {
                let terms = translations.get(direction).into_iter().flatten().enumerate();
                let part_terms = terms.filter(|&(i, r)| part_labels[i] == part_label && *r != 0.0);
                part_terms.map(|(i, r)| (i, *r)).collect()
            });
            (part_label, ConnectedPart { vectors, elements, support })
        };
        for (nodes, elements) in base.foundations() {
            let Some(dof) = nodes.iter().find_map(|node| node.dofs().next()) else {
                continue;
            };
            let part_label = part_labels[dof];
            if let Some((_, part)) = parts.iter_mut().find(|(label, _)| *label == part_label) {
                part.elements.extend(elements);
                continue;
            }
            parts.push(new_part(part_label, elements.collect(), None));
        }
        let labels = joint_labels(base, part_labels)?;
        while let Some(next) = next_supported(base, &labels, &parts) {
            let NextPart { label, elements, support } = next;
            parts.push(new_part(label, elements, Some(support)));
        }
        let index = |label: usize| parts.iter().position(|(other, _)| *other == label);
        let mut joint_parts = Vec::with_capacity(labels.len());
        for [upper, lower] in labels {
            let (Some(upper), Some(lower)) = (index(upper), index(lower)) else {
                let needed = "must connect each part to the ground, directly or by other parts";
                return Err(Error::Scene { quantity: "joints", needed });
            };
            joint_parts.push([upper, lower]);
        }
        let parts = parts.into_iter().map(|(_, part)| part).collect();
        Ok(Self { parts, joint_parts, direction_count: translations.len() })
    }

    /// Mean translation `[right, up, along_y]` of each part's base, from element means of the displacement.
    pub(crate) fn base_translations<'a>(
        &'a self,
        base: &'a PlacedBase,
        means: &'a [f64],
    ) -> impl Iterator<Item = [f64; 3]> + 'a {
        self.parts.iter().map(move |part| self.base_translation(part, base, means))
    }

    /// Mean translation of the base of one part.
    ///
    /// For a part without foundations it is the sum of two terms: the translation of the part on which it stands, and
    /// the relative displacement at one element of the joint between both parts.
    pub(crate) fn base_translation(
        &self,
        part: &ConnectedPart,
        base: &PlacedBase,
        means: &[f64],
    ) -> [f64; 3] {
        let Some(Support { part: lower, element, sign }) = part.support else {
            return part.mean_translation(base, means);
        };
        let translation = self.base_translation(&self.parts[lower], base, means);
        let relative_displacement = base.element_displacement(element, means);
        [0, 1, 2].map(|k| translation[k] + sign * relative_displacement[k])
    }

    /// Sets the joints' entries of soil displacements relative to translating parts.
    ///
    /// The entries are the translation y of the ground under the lower side minus that under the upper side.
    pub(crate) fn set_joint_distortion(
        &self,
        base: &PlacedBase,
        translation: impl Fn(usize) -> [f64; 3],
        distortion: &mut [f64],
    ) {
        let layout = base.layout();
        for (joint, &[upper, lower]) in base.joints().iter().zip(&self.joint_parts) {
            let upper_translation = translation(upper);
            let lower_translation = translation(lower);
            let [right, up, along_y] =
                [0, 1, 2].map(|k| lower_translation[k] - upper_translation[k]);
            for e in joint.elements.clone() {
                let values = base.element(e).components([right, along_y, up]);
                for (component, value) in (0..layout.components()).zip(values) {
                    distortion[layout.index_of(component, e)] = value;
                }
            }
        }
    }

    /// The connected parts, ordered by their leftmost foundation.
    pub(crate) fn parts(&self) -> &[ConnectedPart] {
        &self.parts
    }

    /// Converts all vectors to other coordinates.
    pub(crate) fn converted(&self, convert: impl Fn(&SparseVector) -> SparseVector) -> Self {
        let mut parts = self.parts.clone();
        for vector in parts.iter_mut().flat_map(|part| &mut part.vectors) {
            *vector = convert(vector);
        }
        let joint_parts = self.joint_parts.clone();
        Self { parts, joint_parts, direction_count: self.direction_count }
    }

    /// Adds factor · R y to `displacement`.
    ///
    /// `translations` has the translation y, `[right, up, along_y]`, of each part.
    pub(crate) fn translate(
        &self,
        factor: f64,
        translations: impl IntoIterator<Item = [f64; 3]>,
        displacement: &mut [f64],
    ) {
        for (part, translation) in self.parts.iter().zip(translations) {
            for (vector, translation_component) in part.vectors.iter().zip(translation) {
                if translation_component != 0.0 {
                    for &(i, r) in vector {
                        displacement[i] += factor * r * translation_component;
                    }
                }
            }
        }
    }

    /// The vectors of all parts, one after the other, with `dofs` entries each.
    pub(crate) fn part_vectors(&self, dofs: usize) -> Vec<f64> {
        let vectors = self.parts.iter().flat_map(|part| &part.vectors);
        let nonempty_vectors = vectors.filter(|vector| !vector.is_empty());
        nonempty_vectors.flat_map(|vector| dense_vector(vector, dofs)).collect()
    }

    /// The vectors of the whole structure for all directions, with `dofs` entries each.
    pub(crate) fn whole_vectors(&self, dofs: usize) -> Vec<Vec<f64>> {
        (0..self.direction_count)
            .map(|direction| self.whole_vector(direction, dofs))
            .collect()
    }

    /// The vector of the whole structure for one direction.
    ///
    /// Direction 0 is to the right, [`UPWARD_DIRECTION`] upwards, 2 horizontally along y.
    pub(crate) fn whole_vector(&self, direction: usize, dofs: usize) -> Vec<f64> {
        let mut vector = vec![0.0; dofs];
        let unit = std::array::from_fn(|k| if k == direction { 1.0 } else { 0.0 });
        self.translate(1.0, std::iter::repeat(unit), &mut vector);
        vector
    }
}

impl ConnectedPart {
    /// Ground elements under the part's foundations.
    pub(crate) fn elements(&self) -> &[usize] {
        if self.support.is_some() { &[] } else { &self.elements }
    }

    /// The contact nodes of the part's foundations.
    ///
    /// For a part without foundations they are the nodes on its side of the joint that supports it.
    pub(crate) fn nodes<'a>(&self, base: &'a PlacedBase) -> Vec<&'a BaseNode> {
        if let Some(Support { element, sign, .. }) = self.support {
            let joint = base.joints().iter().find(|joint| joint.elements.contains(&element));
            let side = usize::from(sign < 0.0);
            return joint.into_iter().flat_map(|joint| &joint.line.sides()[side]).collect();
        }
        base.foundations()
            .filter(|(_, elements)| self.elements.contains(&elements.start))
            .flat_map(|(nodes, _)| nodes)
            .collect()
    }

    /// Resultants Rᵀ f of forces: to the right, upwards and horizontally along y.
    pub(crate) fn resultants(&self, force: &[f64]) -> [f64; 3] {
        [0, 1, 2].map(|k| self.vectors[k].iter().map(|&(i, r)| r * force[i]).sum())
    }

    /// Mean translation `[right, up, along_y]` of contact displacements over this part's elements.
    ///
    /// Normal components of contact displacements are positive downwards. The mean is zero in directions in which the part
    /// cannot move. It is exact if all displacements are equal.
    pub(crate) fn mean_translation(&self, base: &PlacedBase, displacement: &[f64]) -> [f64; 3] {
        let Some(&first_element) = self.elements.first() else { return [0.0; 3] };
        let areas = base.areas();
        let total_area: f64 = self.elements.iter().map(|&e| areas[e]).sum();
        let first_displacement = base.element_displacement(first_element, displacement);
        // Sums of differences from the first element, which are exactly zero for equal displacements.
        let mut weighted_differences = [0.0; 3];
        for &e in &self.elements {
            let element_displacement = base.element_displacement(e, displacement);
            for (k, sum) in weighted_differences.iter_mut().enumerate() {
                *sum += areas[e] * (element_displacement[k] - first_displacement[k]);
            }
        }
        [0, 1, 2].map(|k| {
            if self.vectors[k].is_empty() {
                0.0
            } else {
                first_displacement[k] + weighted_differences[k] / total_area
            }
        })
    }

    /// Subtracts a translation `[right, up, along_y]` from the contact displacements of this part's elements.
    pub(crate) fn subtract_translation(
        &self,
        base: &PlacedBase,
        [right, up, along_y]: [f64; 3],
        displacement: &mut [f64],
    ) {
        let layout = base.layout();
        for &e in self.elements() {
            let values = base.elements()[e].components([right, along_y, up]);
            for (component, value) in (0..layout.components()).zip(values) {
                displacement[layout.index_of(component, e)] -= value;
            }
        }
    }
}

/// Labels of the parts of the upper and of the lower side of each joint.
///
/// Returns an error for a side with nodes of several parts, and for nodes without degrees of freedom.
fn joint_labels(base: &PlacedBase, part_labels: &[usize]) -> Result<Vec<[usize; 2]>> {
    let needed = "must have nodes of one connected part on each side";
    let fault = Error::Scene { quantity: "joint", needed };
    let mut labels = Vec::with_capacity(base.joints().len());
    for joint in base.joints() {
        let mut side_labels = [0; 2];
        for (side_label, nodes) in side_labels.iter_mut().zip(joint.line.sides()) {
            let mut dofs = nodes.iter().flat_map(BaseNode::dofs);
            *side_label = part_labels[dofs.next().ok_or_else(|| fault.clone())?];
            if !dofs.all(|dof| part_labels[dof] == *side_label) {
                return Err(fault);
            }
        }
        labels.push(side_labels);
    }
    Ok(labels)
}

/// The next part without foundations, the ground elements below it, and its support.
struct NextPart {
    label: usize,
    elements: Vec<usize>,
    support: Support,
}

/// Finds a part that stands on, or hangs from, a part connected to the ground.
fn next_supported(
    base: &PlacedBase,
    joint_labels: &[[usize; 2]],
    parts: &[(usize, ConnectedPart)],
) -> Option<NextPart> {
    let index = |label: usize| parts.iter().position(|(other, _)| *other == label);
    // Sides of the part, and whether all parts below it must be connected: a part that stands on others comes before one
    // that hangs from others.
    [(0, true), (0, false), (1, false)].into_iter().find_map(|(side, needs_all)| {
        let is_complete = |label: usize| {
            let mut joints_below = joint_labels.iter().filter(|labels| labels[side] == label);
            !needs_all || joints_below.all(|labels| index(labels[1 - side]).is_some())
        };
        let mut joints = joint_labels.iter().zip(base.joints());
        let (labels, first_joint) = joints.find(|(labels, _)| {
            index(labels[side]).is_none()
                && index(labels[1 - side]).is_some()
                && is_complete(labels[side])
        })?;
        let label = labels[side];
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let element = first_joint.elements.start;
        let support = Support { part: index(labels[1 - side])?, element, sign };
        let supporting = joint_labels
            .iter()
            .filter(|labels| labels[side] == label)
            .filter_map(|labels| index(labels[1 - side]));
        let mut elements: Vec<usize> = Vec::new();
        for e in supporting.flat_map(|part| &parts[part].1.elements) {
            if !elements.contains(e) {
                elements.push(*e);
            }
        }
        Some(NextPart { label, elements, support })
    })
}
