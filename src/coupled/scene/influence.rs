//! Influence vectors: the degrees of freedom when a connected part of the structure translates rigidly by 1 m.
//!
//! | symbol | meaning |
//! |---|---|
//! | R | influence vectors, one to the right and one upwards for each connected part |
//! | y | translation of each part's ground: the mean free field under it |

use super::base::Base;
use super::transformation::Terms;
use crate::geometry::{COMPONENTS, ContactLayout};
use crate::linalg::matrix::spread;
use crate::structure::ContactNode;

/// The influence vectors of all connected parts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Influence {
    parts: Vec<Part>,
}

/// A connected part of the structure and the elements under it.
#[derive(Debug, Clone)]
pub(crate) struct Part {
    /// R to the right and upwards; without terms for what cannot move that way.
    pub(crate) vectors: [Terms; 2],
    elements: Vec<usize>,
}

impl Influence {
    /// Splits the rigid translations of the whole structure into those of its parts; `roots` has the
    /// same number for the degrees of freedom of one part.
    pub(crate) fn split(base: &Base, translations: &[Vec<f64>; 2], roots: &[usize]) -> Self {
        let mut parts: Vec<(usize, Part)> = Vec::new();
        for (nodes, elements) in base.foundations() {
            let Some(unknown) = nodes.iter().find_map(|node| node.dofs().next()) else {
                continue;
            };
            let root = roots[unknown];
            if let Some((_, part)) = parts.iter_mut().find(|(own, _)| *own == root) {
                part.elements.extend(elements);
                continue;
            }
            let vectors = [0, 1].map(|direction| {
                let vector = translations[direction].iter().enumerate();
                let own = vector.filter(|&(i, r)| roots[i] == root && *r != 0.0);
                own.map(|(i, r)| (i, *r)).collect()
            });
            parts.push((root, Part { vectors, elements: elements.collect() }));
        }
        Self { parts: parts.into_iter().map(|(_, part)| part).collect() }
    }

    /// The connected parts, from left to right by their leftmost foundation.
    pub(crate) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The same vectors in other coordinates.
    pub(crate) fn converted(&self, convert: impl Fn(&Terms) -> Terms) -> Self {
        let mut parts = self.parts.clone();
        for vector in parts.iter_mut().flat_map(|part| &mut part.vectors) {
            *vector = convert(vector);
        }
        Self { parts }
    }

    /// Adds factor · R y to `displacement`, y the translation `[right, up]` of each part.
    pub(crate) fn translate(
        &self,
        factor: f64,
        translations: impl IntoIterator<Item = [f64; 2]>,
        displacement: &mut [f64],
    ) {
        for (part, translation) in self.parts.iter().zip(translations) {
            for (vector, amount) in part.vectors.iter().zip(translation) {
                if amount != 0.0 {
                    for &(i, r) in vector {
                        displacement[i] += factor * r * amount;
                    }
                }
            }
        }
    }

    /// The vectors of all parts, one after the other, each over `dofs` entries.
    pub(crate) fn translations(&self, dofs: usize) -> Vec<f64> {
        let vectors = self.parts.iter().flat_map(|part| &part.vectors);
        let moving = vectors.filter(|vector| !vector.is_empty());
        moving.flat_map(|vector| spread(vector, dofs)).collect()
    }

    /// Both vectors of the whole structure, all parts together, over `dofs` entries.
    pub(crate) fn of_all(&self, dofs: usize) -> [Vec<f64>; 2] {
        [[1.0, 0.0], [0.0, 1.0]].map(|direction| {
            let mut vector = vec![0.0; dofs];
            self.translate(1.0, std::iter::repeat(direction), &mut vector);
            vector
        })
    }
}

impl Part {
    /// Its contact elements.
    pub(crate) fn elements(&self) -> &[usize] {
        &self.elements
    }

    /// The contact nodes of its foundations.
    pub(crate) fn nodes<'a>(&self, base: &'a Base) -> Vec<&'a ContactNode> {
        base.foundations()
            .filter(|(_, elements)| self.elements.contains(&elements.start))
            .flat_map(|(nodes, _)| nodes)
            .collect()
    }

    /// Rᵀ f: the resultants to the right and upwards.
    pub(crate) fn resultants(&self, force: &[f64]) -> [f64; 2] {
        [0, 1].map(|k| self.vectors[k].iter().map(|&(i, r)| r * force[i]).sum())
    }

    /// Mean translation `[right, up]` of contact displacements (2Q, normal components down) over
    /// this part's elements; zero where the part cannot follow. Exact if all are equal.
    pub(crate) fn mean(&self, base: &Base, displacement: &[f64]) -> [f64; 2] {
        let lengths = base.lengths();
        let offset = [lengths.len(), 0];
        let signs = [1.0, -1.0];
        let Some(&first) = self.elements.first() else { return [0.0; 2] };
        let width: f64 = self.elements.iter().map(|&e| lengths[e]).sum();
        [0, 1].map(|k| {
            if self.vectors[k].is_empty() {
                return 0.0;
            }
            let at = |e: usize| displacement[offset[k] + e];
            let apart: f64 = self.elements.iter().map(|&e| lengths[e] * (at(e) - at(first))).sum();
            signs[k] * (at(first) + apart / width)
        })
    }

    /// Subtracts a translation `[right, up]` from contact displacements (2Q).
    pub(crate) fn subtract(&self, translation: [f64; 2], displacement: &mut [f64]) {
        let layout = ContactLayout::new(displacement.len() / COMPONENTS);
        for &e in &self.elements {
            let [down, along] = layout.places(e);
            displacement[down] += translation[1];
            displacement[along] -= translation[0];
        }
    }
}
