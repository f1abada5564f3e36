//! The base as the ground sees it: element means of the base displacement, and their transpose.

use std::ops::Range;

use super::transformation::{Rows, Terms, Transformation, Weights};
use crate::bem::ContactElement;
use crate::error::{Error, Result};
use crate::geometry::ContactLayout;
use crate::linalg::dot;
use crate::structure::{
    ContactNode, DofCombination, Structure, check_contact_nodes, foundation_nodes,
};

/// B, which takes coordinates to element means of the base displacement (normal components down),
/// and BᵀA, which takes tractions to forces on the coordinates: the structure's degrees of freedom, or those
/// that are [stepped](Base::stepped).
///
/// For elements between neighbouring nodes the means are the T matrix of halves of Patel &
/// Spyrakos, eq. 14, and its transpose is their eq. 15.
#[derive(Debug, Clone)]
pub(crate) struct Base {
    /// Normal rows, then tangential rows.
    rows: Rows,
    foundations: Vec<Outline>,
    lengths: Vec<f64>,
    middles: Vec<f64>,
    nodes: Vec<ContactNode>,
}

/// One foundation: its nodes, its elements, and the rotation of its chord.
#[derive(Debug, Clone)]
struct Outline {
    nodes: Range<usize>,
    elements: Range<usize>,
    rotation: Weights,
}

impl Base {
    /// The base of `structure`.
    pub(crate) fn of(structure: &dyn Structure, elements: &[ContactElement]) -> Result<Self> {
        let ends = structure.foundation_ends();
        Self::new(structure.contact_nodes(), &ends, elements, structure.dofs())
    }

    /// Averages the piecewise straight base over each element. A foundation ends at each of `ends`,
    /// and at the last node.
    fn new(
        nodes: Vec<ContactNode>,
        ends: &[usize],
        elements: &[ContactElement],
        dofs: usize,
    ) -> Result<Self> {
        check_nodes(&nodes, dofs)?;
        let mut foundations = Vec::with_capacity(ends.len() + 1);
        let mut element = 0;
        for own in foundation_nodes(nodes.len(), ends)? {
            let last = own.end - 1;
            let end = nodes.get(own.end).map_or(elements.len(), |next| {
                let middle = 0.5 * (nodes[last].x + next.x);
                elements.partition_point(|element| element.center() < middle)
            });
            let footing = Outline {
                elements: element..end,
                rotation: Weights::Sparse(chord_rotation(&nodes[own.clone()])),
                nodes: own,
            };
            if end <= element {
                let quantity = "list of contact elements under a foundation";
                return Err(Error::Size { quantity, found: 0, needed: 1 });
            }
            foundations.push(footing);
            element = end;
        }
        let layout = ContactLayout::new(elements.len());
        let mut rows = vec![Terms::new(); layout.len()];
        for footing in &foundations {
            let own = &nodes[footing.nodes.clone()];
            for e in footing.elements.clone() {
                let [down, along] = layout.places(e);
                check_overlap(own, &elements[e])?;
                for (node, weight) in mean_weights(own, &elements[e]) {
                    accumulate(&mut rows[down], &own[node].vertical, -weight);
                    accumulate(&mut rows[along], &own[node].horizontal, weight);
                }
            }
        }
        let lengths = elements.iter().map(ContactElement::length).collect();
        let middles = elements.iter().map(ContactElement::center).collect();
        Ok(Self { rows: Rows::Sparse(rows), foundations, lengths, middles, nodes })
    }

    /// The same base of the coordinates that are stepped.
    pub(crate) fn stepped(&self, transformation: &Transformation) -> Self {
        let mut foundations = self.foundations.clone();
        for footing in &mut foundations {
            let terms = chord_rotation(&self.nodes[footing.nodes.clone()]);
            footing.rotation = transformation.row(&terms);
        }
        Self { rows: transformation.rows(&self.rows), foundations, ..self.clone() }
    }

    /// The degrees of freedom that move a contact node, some more than once.
    pub(crate) fn dofs(&self) -> Vec<usize> {
        self.nodes.iter().flat_map(ContactNode::dofs).collect()
    }

    /// The contact nodes and the elements of each foundation.
    pub(crate) fn foundations(&self) -> impl Iterator<Item = (&[ContactNode], Range<usize>)> + '_ {
        let nodes = |footing: &Outline| &self.nodes[footing.nodes.clone()];
        self.foundations.iter().map(move |footing| (nodes(footing), footing.elements.clone()))
    }

    /// The foundations that reach beyond the ground's elements by more than their longest, and how far (m).
    pub(crate) fn uncovered(&self, ground: &[ContactElement]) -> Vec<(usize, f64)> {
        let reach = |(nodes, own): (&[ContactNode], Range<usize>)| {
            let own = &ground[own];
            let [first, last] = [own.first()?, own.last()?];
            let longest = own.iter().map(ContactElement::length).fold(0.0, f64::max);
            let beyond = nodes.iter().map(|node| (first.left - node.x).max(node.x - last.right));
            Some(beyond.fold(0.0, f64::max)).filter(|reach| *reach > longest)
        };
        let reaches = self.foundations().map(reach).enumerate();
        reaches.filter_map(|(foundation, reach)| Some((foundation, reach?))).collect()
    }

    /// Lengths A of the elements.
    pub(crate) fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// Order of the numbers of a contact vector.
    pub(crate) fn layout(&self) -> ContactLayout {
        ContactLayout::new(self.lengths.len())
    }

    /// Coordinate of the middle of an element.
    pub(crate) fn middle(&self, element: usize) -> f64 {
        self.middles[element]
    }

    /// Length that goes with contact component `i`.
    pub(crate) fn length(&self, i: usize) -> f64 {
        self.lengths[self.layout().origin(i)[1]]
    }

    /// out ← B u.
    pub(crate) fn means(&self, u: &[f64], out: &mut [f64]) {
        self.rows.multiply(u, out);
    }

    /// Mean `[right, up]` of contact displacements (2Q) over the whole base.
    pub(crate) fn mean(&self, displacement: &[f64]) -> [f64; 2] {
        let [down, along] = self.layout().split(displacement);
        let width: f64 = self.lengths.iter().sum();
        [dot(along, &self.lengths) / width, -dot(down, &self.lengths) / width]
    }

    /// f ← f + factor · BᵀA τ.
    pub(crate) fn add_forces(&self, factor: f64, traction: &[f64], force: &mut [f64]) {
        self.rows.add_transposed(factor, |i| self.length(i), traction, force);
    }

    /// Rotation of a foundation (counter-clockwise), from the chord between its ends.
    pub(crate) fn rotation(&self, foundation: usize, u: &[f64]) -> f64 {
        self.foundations[foundation].rotation.of(u)
    }

    /// Largest error of N r for translations of 1 to the right and 1 up, N the displacements of the
    /// contact nodes. A component without terms belongs to nothing that could move.
    pub(crate) fn translation_error(&self, translations: &[Vec<f64>; 2]) -> f64 {
        let mut worst = 0.0_f64;
        for (direction, translation) in translations.iter().enumerate() {
            for (terms, needed) in self.node_components(direction) {
                worst = worst.max((terms.value(translation) - needed).abs());
            }
        }
        worst
    }

    /// Moves `translation` (to the right: 0; upwards: 1) by the little that the contact nodes miss
    /// of 1 m.
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
        let components = self.nodes.iter().flat_map(|node| [&node.horizontal, &node.vertical]);
        let moved = move |(k, row)| (row, if k % 2 == direction { 1.0 } else { 0.0 });
        components.enumerate().map(moved).filter(|(row, _)| !row.is_empty())
    }

    /// The contact nodes.
    pub(crate) fn nodes(&self) -> &[ContactNode] {
        &self.nodes
    }
}

/// Refuses nodes that are none of these degrees of freedom', and nodes out of order.
fn check_nodes(nodes: &[ContactNode], dofs: usize) -> Result<()> {
    check_contact_nodes(nodes, dofs)?;
    match nodes.windows(2).find(|pair| pair[1].x <= pair[0].x) {
        None => Ok(()),
        Some(pair) => Err(Error::Input {
            quantity: "coordinate of a contact node",
            value: pair[1].x,
            needed: "to the right of the node before it",
        }),
    }
}

/// Refuses an element that is not wholly under the foundation with these nodes.
fn check_overlap(nodes: &[ContactNode], element: &ContactElement) -> Result<()> {
    let slack = 1e-9 * element.length();
    let (first, last) = (nodes[0].x, nodes[nodes.len() - 1].x);
    for value in [first - element.left, element.right - last] {
        if value > slack {
            return Err(Error::Input {
                quantity: "overhang of a contact element beyond the structure's base, m",
                value,
                needed: "zero: all elements of the ground lie between the structure's outermost contact nodes",
            });
        }
    }
    Ok(())
}

/// Rise of the last node over the first, per distance.
fn chord_rotation(nodes: &[ContactNode]) -> Terms {
    let (first, last) = (&nodes[0], &nodes[nodes.len() - 1]);
    let mut terms = Terms::new();
    accumulate(&mut terms, &last.vertical, 1.0 / (last.x - first.x));
    accumulate(&mut terms, &first.vertical, -1.0 / (last.x - first.x));
    terms
}

fn accumulate(row: &mut Terms, terms: &DofCombination, factor: f64) {
    for &(index, weight) in terms {
        match row.iter_mut().find(|(j, _)| *j == index) {
            Some((_, sum)) => *sum += factor * weight,
            None => row.push((index, factor * weight)),
        }
    }
}

/// (node, weight) of the mean over `element` of the piecewise linear interpolation.
fn mean_weights(nodes: &[ContactNode], element: &ContactElement) -> Vec<(usize, f64)> {
    let mut weights = Vec::new();
    for (k, pair) in nodes.windows(2).enumerate() {
        let (x0, x1) = (pair[0].x, pair[1].x);
        // The outermost segments also carry what rounding leaves outside them.
        let from = if k == 0 { element.left } else { element.left.max(x0) };
        let to = if k + 2 == nodes.len() { element.right } else { element.right.min(x1) };
        if to > from {
            let middle = (0.5 * (from + to) - x0) / (x1 - x0);
            let share = (to - from) / element.length();
            weights.push((k, share * (1.0 - middle)));
            weights.push((k + 1, share * middle));
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matching_meshes_give_halves() {
        let nodes: Vec<_> = (0..4).map(|k| ContactNode::free(k as f64, 2 * k, 2 * k + 1)).collect();
        let elements: Vec<_> = (0..3)
            .map(|k| ContactElement { left: f64::from(k), right: f64::from(k + 1) })
            .collect();
        let base = Base::new(nodes, &[], &elements, 8).unwrap();
        let Rows::Sparse(rows) = base.rows else { panic!("rows of degrees of freedom") };
        assert_eq!(rows[1], vec![(3, -0.5), (5, -0.5)]);
        assert_eq!(rows[3 + 2], vec![(4, 0.5), (6, 0.5)]);
    }

    #[test]
    fn means_of_a_linear_field_are_exact_on_any_mesh() {
        let xs = [-1.0, -0.3, 0.45, 2.0];
        let nodes: Vec<_> =
            xs.iter().enumerate().map(|(k, &x)| ContactNode::free(x, 2 * k, 2 * k + 1)).collect();
        let ends = [-1.0, -0.8, 0.1, 1.3, 2.0];
        let elements: Vec<_> =
            ends.windows(2).map(|w| ContactElement { left: w[0], right: w[1] }).collect();
        let base = Base::new(nodes, &[], &elements, 8).unwrap();
        let u: Vec<f64> = xs.iter().flat_map(|x| [2.0 + 3.0 * x, 1.0 - 0.5 * x]).collect();
        let mut means = vec![0.0; 8];
        base.means(&u, &mut means);
        for (e, element) in elements.iter().enumerate() {
            let x = element.center();
            assert!((means[e] + (1.0 - 0.5 * x)).abs() < 1e-14);
            assert!((means[4 + e] - (2.0 + 3.0 * x)).abs() < 1e-14);
        }
        assert!((base.rotation(0, &u) + 0.5).abs() < 1e-14);
        // The transpose does the same work: (BᵀAτ)·u = Σ A τ·(B u).
        let traction: Vec<f64> = (0..8).map(|i| f64::from(i).cos()).collect();
        let mut force = vec![0.0; 8];
        base.add_forces(1.0, &traction, &mut force);
        let left: f64 = force.iter().zip(&u).map(|(f, u)| f * u).sum();
        let right: f64 = (0..8).map(|i| base.length(i) * traction[i] * means[i]).sum();
        assert!((left - right).abs() < 1e-13);
    }

    #[test]
    fn bad_bases_are_errors() {
        let element = [ContactElement { left: 0.0, right: 1.0 }];
        let node = |x| ContactNode::free(x, 0, 1);
        assert!(Base::new(vec![node(0.0)], &[], &element, 2).is_err());
        assert!(Base::new(vec![node(0.0), node(0.0)], &[], &element, 2).is_err());
        assert!(Base::new(vec![node(0.0), node(f64::NAN)], &[], &element, 2).is_err());
        assert!(Base::new(vec![node(0.0), node(0.9)], &[], &element, 2).is_err());
        assert!(Base::new(vec![node(0.0), node(1.0)], &[], &element, 1).is_err());
        assert!(Base::new(vec![node(0.0), node(1.0)], &[], &element, 2).is_ok());
    }
}
