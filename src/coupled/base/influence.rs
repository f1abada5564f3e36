//! Influence vectors: displacements under a translation of a connected part by 1 m.
//!
//! | symbol | meaning |
//! |---|---|
//! | R | influence vectors: for each part one to the right, one upwards and, in plan, one horizontally along y |
//! | y | mean translation of the free field under each part |

use crate::coupled::base::PlacedBase;
use crate::coupled::base::transformation::SparseVector;
use crate::linalg::matrix::spread;
use crate::structure::BaseNode;

/// The influence vectors of all connected parts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Influence {
    parts: Vec<ConnectedPart>,
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
    elements: Vec<usize>,
}

impl Influence {
    /// Splits the rigid translations of the whole structure into translations of its parts.
    ///
    /// `part_labels` has a number for each degree of freedom; degrees of freedom of one part have equal numbers.
    pub(crate) fn split(
        base: &PlacedBase,
        translations: &[Vec<f64>],
        part_labels: &[usize],
    ) -> Self {
        let mut parts: Vec<(usize, ConnectedPart)> = Vec::new();
        for (nodes, elements) in base.foundations() {
            let Some(dof) = nodes.iter().find_map(|node| node.dofs().next()) else {
                continue;
            };
            let part_label = part_labels[dof];
            if let Some((_, part)) = parts.iter_mut().find(|(label, _)| *label == part_label) {
                part.elements.extend(elements);
                continue;
            }
            let vectors = [0, 1, 2].map(|direction| {
                let terms = translations.get(direction).into_iter().flatten().enumerate();
                let part_terms = terms.filter(|&(i, r)| part_labels[i] == part_label && *r != 0.0);
                part_terms.map(|(i, r)| (i, *r)).collect()
            });
            parts.push((part_label, ConnectedPart { vectors, elements: elements.collect() }));
        }
        let parts = parts.into_iter().map(|(_, part)| part).collect();
        Self { parts, direction_count: translations.len() }
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
        Self { parts, direction_count: self.direction_count }
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
        nonempty_vectors.flat_map(|vector| spread(vector, dofs)).collect()
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
    /// Contact elements of the part.
    pub(crate) fn elements(&self) -> &[usize] {
        &self.elements
    }

    /// The contact nodes of its foundations.
    pub(crate) fn nodes<'a>(&self, base: &'a PlacedBase) -> Vec<&'a BaseNode> {
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
        for &e in &self.elements {
            let values = base.elements()[e].components([right, along_y, up]);
            for (component, value) in (0..layout.components()).zip(values) {
                displacement[layout.place(component, e)] -= value;
            }
        }
    }
}
