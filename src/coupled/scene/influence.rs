//! Influence vectors: the unknowns when a connected part of the structure translates rigidly by 1 m.
//!
//! | symbol | meaning |
//! |---|---|
//! | R | influence vectors, one to the right and one upwards for each connected part |
//! | y | translation of each part's ground: the mean free field under it |
//! | N | displacements of the contact nodes |
//! | B | element means of the base displacement |
//!
//! Displacements are stepped relative to R y, so R has to be exact where the ground sees it: N R is
//! 1 or 0 to rounding, and then so is B R.

use super::base::Base;
use super::stepped_row::Terms;
use super::supports;
use crate::error::{Error, Result};
use crate::linalg::matrix::{SparseMatrix, spread};
use crate::linalg::{Partition, SparseFactor, largest};
use crate::structure::ContactNode;

/// Largest error of a contact node's displacement under a rigid translation of 1 m.
const EXACT: f64 = 1e-14;
/// Passes that refine the vectors.
const REFINEMENTS: usize = 3;

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
    /// The influence vectors of a structure with these matrices; `stiffness` contains the tangent
    /// of the nonlinear force at rest.
    ///
    /// A rigid translation leaves K u = 0 and moves the contact nodes by one, so that
    /// (K + γ NᵀN) r = γ Nᵀ 1 has it as its solution for every γ, whatever the unknowns mean.
    pub(crate) fn new(
        base: &Base,
        stiffness: &SparseMatrix,
        others: [&SparseMatrix; 2],
        check_sign: &dyn Fn(f64) -> Result<()>,
    ) -> Result<Self> {
        const NAME: &str = "stiffness matrix with its base held";
        let n = stiffness.order();
        let stiffest = largest(&stiffness.diagonal());
        let tie = if stiffest > 0.0 { stiffest } else { 1.0 };
        let (held, pulls) = base.held(stiffness, tie);
        let mut factor = SparseFactor::new(NAME, &held)?;
        if !factor.is_positive_definite() {
            check_sign(tie)?;
        }
        let held = SparseMatrix::new(NAME, &held)?;
        let mut translations = pulls.map(|pull| {
            let mut found = pull.clone();
            factor.solve(&mut found);
            for _ in 0..REFINEMENTS {
                let mut rest = pull.clone();
                held.multiply_add(-1.0, &found, &mut rest);
                factor.solve(&mut rest);
                found.iter_mut().zip(&rest).for_each(|(r, d)| *r += d);
            }
            found
        });
        if translations.iter().flatten().any(|r| !r.is_finite()) {
            return Err(Error::Singular { matrix: NAME, order: n });
        }
        supports::check(stiffness, &mut translations, |r| base.translation_error(r))?;
        for (direction, translation) in translations.iter_mut().enumerate() {
            base.translate_nodes(direction, translation);
        }
        let error = base.translation_error(&translations);
        if error > EXACT {
            return Err(Error::Input {
                quantity: "error of the base under a rigid translation of 1 m",
                value: error,
                needed: "1e-14 or less: contact nodes must be able to translate together",
            });
        }
        let mut parts = Partition::new(n);
        for matrix in [stiffness, others[0], others[1]] {
            parts.couple(matrix);
        }
        for (nodes, _) in base.foundations() {
            let mut unknowns = nodes.iter().flat_map(ContactNode::unknowns);
            if let Some(first) = unknowns.next() {
                unknowns.for_each(|unknown| parts.join(first, unknown));
            }
        }
        let roots: Vec<usize> = (0..n).map(|unknown| parts.root(unknown)).collect();
        let influence = Self::split(base, &translations, &roots);
        influence.check(base, n)?;
        Ok(influence)
    }

    /// Refuses a part whose base does not translate as a whole: B R must be 1 where it moves.
    fn check(&self, base: &Base, unknowns: usize) -> Result<()> {
        let count = base.lengths().len();
        let mut means = vec![0.0; 2 * count];
        // A mean is a sum over the nodes above an element, each of which may be rounded.
        let exact = 10.0 * EXACT + base.node_count() as f64 * f64::EPSILON;
        for part in &self.parts {
            for (direction, vector) in part.vectors.iter().enumerate() {
                base.means(&spread(vector, unknowns), &mut means);
                for &e in part.elements.iter().filter(|_| !vector.is_empty()) {
                    let moved = if direction == 0 { means[count + e] } else { -means[e] };
                    if (moved - 1.0).abs() > exact {
                        return Err(Error::Input {
                            quantity: "mean of the base under a rigid translation of 1 m",
                            value: moved,
                            needed: "1: all of a connected part's base must translate with it",
                        });
                    }
                }
            }
        }
        Ok(())
    }

    /// Splits the vectors of the whole structure into those of its parts.
    fn split(base: &Base, translations: &[Vec<f64>; 2], roots: &[usize]) -> Self {
        let mut parts: Vec<(usize, Part)> = Vec::new();
        for (nodes, elements) in base.foundations() {
            let Some(unknown) = nodes.iter().find_map(|node| node.unknowns().next()) else {
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
    pub(super) fn map(&mut self, convert: impl Fn(&Terms) -> Terms) {
        for part in &mut self.parts {
            for vector in &mut part.vectors {
                *vector = convert(vector);
            }
        }
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

    /// Both vectors of the whole structure, all parts together, over `unknowns` entries.
    pub(crate) fn of_all(&self, unknowns: usize) -> [Vec<f64>; 2] {
        [[1.0, 0.0], [0.0, 1.0]].map(|direction| {
            let mut vector = vec![0.0; unknowns];
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
        let count = displacement.len() / 2;
        for &e in &self.elements {
            displacement[e] += translation[1];
            displacement[count + e] -= translation[0];
        }
    }
}
