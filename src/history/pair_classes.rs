//! Classes of element pairs that share their coefficients.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::ops::Mul;

use crate::error::{Result, in_bounds, require};
use crate::geometry::{
    COMPLIANCES_PER_OFFSET, COMPONENTS_IN_PLANE, COMPONENTS_IN_SPACE, ContactElement,
    ContactLayout, Lattice, check_count, check_order, offset,
};
use crate::linalg::{MatrixScalar, hermitian_range, indefinite_pivot};

/// Number of kinds of coefficients of a pair: normal, tangential, and the coupling of both.
pub(crate) const STRIP_KINDS: usize = 3;

/// Kind of the coupling in the plane; it may end, unlike the other kinds.
pub(crate) const COUPLING_KIND: usize = 2;

/// Largest number of kinds in the plane: two couplings, where they are not equal up to the sign.
pub(crate) const MAX_PLANE_KINDS: usize = STRIP_KINDS + 1;

/// Number of integer units in the length of the patch: rounding of the nodes does not divide a class.
const LENGTH_KEY_UNITS: f64 = 1e12;

/// Length in integer units of the patch's length `span`, for comparison without rounding.
#[allow(clippy::cast_possible_truncation, reason = "at most 1e12")]
fn length_key(length: f64, span: f64) -> i64 {
    (length / span * LENGTH_KEY_UNITS).round() as i64
}

/// Effect of one traction component of the source on one displacement component of the receiver.
#[derive(Clone, Copy, Default)]
pub(crate) struct Term {
    /// Kind of coefficient.
    pub(crate) kind: usize,
    /// Components of displacement and traction.
    pub(crate) components: [usize; 2],
    /// Factor of the coefficient.
    pub(crate) factor: f64,
}

/// Class of a pair of elements, with the factors of its coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Index of the class that contains the pair.
    pub class: usize,
    /// 1/length of the receiver (1/m), which converts the integrals of a class to means.
    pub scale: f64,
    /// Sign of the coupling between normal and tangential components.
    ///
    /// It is +1 for a receiver to the right of the source, −1 to the left, 0 for an element on itself. Around a trench it
    /// is −1 for the mirror image of a pair of the class.
    pub sign: f64,
}

/// Smallest element length relative to the patch; classes of shorter elements could not be distinguished.
const MIN_LENGTH_RATIO: f64 = 1e-8;

/// Elements of a patch, and their pairs sorted into classes.
///
/// On a laterally homogeneous ground (any layering, but no change along the surface) a pair's coefficients depend on
/// the two lengths and the distance alone, and by reciprocity lₚ Gₚq = l_q G_qp. The Q² pairs therefore belong to fewer
/// classes: Q on a uniform strip, about Q²/4 on a graded one. A [`ConvolutionWeights`](super::ConvolutionWeights)
/// computes one pair of each class.
///
/// ```
/// use basemat::bem::Strip;
/// use basemat::history::PairClasses;
/// let strip = Strip::uniform(-5.0..5.0, 10)?;
/// let classes = PairClasses::new(strip.elements())?;
/// assert_eq!((classes.pairs().len(), classes.count()), (100, 10));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct PairClasses {
    elements: Vec<ContactElement>,
    pairs: Vec<Pair>,
    /// Representative (source, receiver) of each class, the receiver on the right.
    representatives: Vec<[ContactElement; 2]>,
    /// Lattice of elements in plan, and the column and row of each; `pairs` is then empty.
    plan: Option<(Lattice, Vec<[usize; 2]>)>,
    /// Number of kinds of coefficients.
    kinds: usize,
    /// For each pair, whether receiver and source of its class are exchanged; empty where that changes only the sign of
    /// the coupling.
    exchanged: Vec<bool>,
}

impl PairClasses {
    /// Sorts the pairs of `elements` (left to right, not overlapping) into classes.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for no elements, [`Error::Memory`](crate::Error::Memory) for more elements
    /// than their matrices allow, [`Error::Input`](crate::Error::Input) for lengths not positive or shorter than 1e-8
    /// of the patch, or elements out of order.
    pub fn new(elements: Vec<ContactElement>) -> Result<Self> {
        check_order(&elements)?;
        let span = elements[elements.len() - 1].right() - elements[0].left();
        let min_length = elements.iter().map(ContactElement::length).fold(f64::INFINITY, f64::min);
        let quantity = "length of the shortest contact element over that of the patch";
        let is_long_enough = min_length >= MIN_LENGTH_RATIO * span;
        require(quantity, min_length / span, is_long_enough, "at least 1e-8")?;
        let mut class_indices = HashMap::new();
        let mut representatives = Vec::new();
        let mut pairs = Vec::with_capacity(elements.len() * elements.len());
        for (p, receiver) in elements.iter().enumerate() {
            for (q, source) in elements.iter().enumerate() {
                let left_element = if p < q { receiver } else { source };
                let right_element = if p < q { source } else { receiver };
                let left_length = length_key(left_element.length(), span);
                let right_length = length_key(right_element.length(), span);
                let class_key = (
                    left_length.min(right_length),
                    left_length.max(right_length),
                    length_key(right_element.center()[0] - left_element.center()[0], span),
                );
                let class = *class_indices.entry(class_key).or_insert_with(|| {
                    representatives.push([*left_element, *right_element]);
                    representatives.len() - 1
                });
                let sign = match p.cmp(&q) {
                    Ordering::Less => -1.0,
                    Ordering::Equal => 0.0,
                    Ordering::Greater => 1.0,
                };
                pairs.push(Pair { class, scale: 1.0 / receiver.length(), sign });
            }
        }
        Ok(Self::of_pairs(elements, pairs, representatives, STRIP_KINDS, vec![]))
    }

    /// Classes with these `pairs`, receiver by receiver, and a source and receiver that represent each class.
    ///
    /// `kinds`: number of kinds of coefficients. `exchanged`: for each pair, whether its receiver and source are the source
    /// and the receiver of its class; empty where that changes only the sign of the coupling.
    pub(crate) fn of_pairs(
        elements: Vec<ContactElement>,
        pairs: Vec<Pair>,
        representatives: Vec<[ContactElement; 2]>,
        kinds: usize,
        exchanged: Vec<bool>,
    ) -> Self {
        Self { elements, pairs, representatives, plan: None, kinds, exchanged }
    }

    /// Classes of the pairs of `cells` (column and row) of a lattice in plan: [`Lattice::classes`].
    ///
    /// `corner`: smallest x and y of the lattice, m.
    ///
    /// # Errors
    /// As for [`check_count`].
    pub(crate) fn in_plan(
        lattice: Lattice,
        cells: Vec<[usize; 2]>,
        corner: [f64; 2],
    ) -> Result<Self> {
        check_count(cells.len(), COMPONENTS_IN_PLANE)?;
        let elements = cells
            .iter()
            .map(|cell| {
                let edges = [0, 1].map(|axis| {
                    [0, 1].map(|end| corner[axis] + lattice.pitch[axis] * (cell[axis] + end) as f64)
                });
                ContactElement::in_plan(edges[0], edges[1])
            })
            .collect();
        Ok(Self {
            elements,
            pairs: vec![],
            representatives: vec![],
            plan: Some((lattice, cells)),
            kinds: COMPLIANCES_PER_OFFSET,
            exchanged: vec![],
        })
    }

    /// Lattice and cells of elements in plan.
    pub(crate) fn plan(&self) -> Option<(&Lattice, &[[usize; 2]])> {
        self.plan.as_ref().map(|(lattice, cells)| (lattice, &cells[..]))
    }

    /// Number of kinds of coefficients of a pair, in the order of [`ConvolutionWeights::coefficients`].
    ///
    /// 3 for strips, 6 for cells of a lattice in plan, 4 around a trench.
    ///
    /// [`ConvolutionWeights::coefficients`]: super::ConvolutionWeights::coefficients
    pub fn kinds(&self) -> usize {
        self.kinds
    }

    /// Whether the couplings of normal and tangential components are of two kinds.
    pub(crate) fn has_two_couplings(&self) -> bool {
        !self.exchanged.is_empty()
    }

    /// Whether receiver and source of a pair are the source and the receiver of its class.
    #[inline]
    pub(crate) fn is_exchanged(&self, pair_index: usize) -> bool {
        self.exchanged.get(pair_index).is_some_and(|is_exchanged| *is_exchanged)
    }

    /// The elements, from left to right; cells in plan in the order given.
    pub fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// All pairs: receiver by receiver, Q sources each.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Number of classes.
    pub fn count(&self) -> usize {
        match &self.plan {
            Some((lattice, _)) => lattice.classes().len(),
            None => self.representatives.len(),
        }
    }

    /// Source and receiver of a pair that represents `class`.
    ///
    /// The receiver is the source itself or to the right of it.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a class that does not exist.
    pub fn representative(&self, class: usize) -> Result<[ContactElement; 2]> {
        let count = self.representatives.len();
        Ok(self.representatives[in_bounds("class of element pairs", class, count)?])
    }

    /// Order of the numbers of a contact vector.
    pub(crate) fn layout(&self) -> ContactLayout {
        let components =
            if self.plan.is_some() { COMPONENTS_IN_SPACE } else { COMPONENTS_IN_PLANE };
        ContactLayout::new(components, self.elements.len())
    }

    /// Calls `visit` for every pair, with its receiver and source, its class and its terms.
    pub(crate) fn each(&self, mut visit: impl FnMut([usize; 2], &Pair, &[Term])) {
        let count = self.elements.len();
        let mut terms = [Term::default(); 9];
        for (pair_index, pair) in self.pairs.iter().enumerate() {
            let coupling = self.coupling(pair_index);
            terms[0] = Term { kind: 0, components: [0, 0], factor: 1.0 };
            terms[1] = Term { kind: 1, components: [1, 1], factor: 1.0 };
            terms[2] = Term { kind: coupling[0].0, components: [0, 1], factor: coupling[0].1 };
            terms[3] = Term { kind: coupling[1].0, components: [1, 0], factor: coupling[1].1 };
            visit([pair_index / count, pair_index % count], pair, &terms[..4]);
        }
        let Some((lattice, cells)) = &self.plan else { return };
        let scale = 1.0 / (lattice.pitch[0] * lattice.pitch[1]);
        for (p, receiver) in cells.iter().enumerate() {
            for (q, source) in cells.iter().enumerate() {
                let (class, block_terms) = lattice.compliance_terms(offset(*receiver, *source));
                for (term_index, (kind, factor)) in block_terms.into_iter().flatten().enumerate() {
                    terms[term_index] =
                        Term { kind, components: [term_index / 3, term_index % 3], factor };
                }
                visit([p, q], &Pair { class, scale, sign: 1.0 }, &terms);
            }
        }
    }

    /// Kind and factor of a pair's coupling: normal displacement due to shear, tangential due to pressure.
    pub(crate) fn coupling(&self, pair_index: usize) -> [(usize, f64); 2] {
        let sign = self.pairs[pair_index].sign;
        if let Some(exchanged) = self.exchanged.get(pair_index) {
            let kinds = if *exchanged { [3, 2] } else { [2, 3] };
            return kinds.map(|kind| (kind, sign));
        }
        [(2, sign), (2, -sign)]
    }

    /// Overwrites `matrix` (row-major) with the coefficients of all pairs.
    ///
    /// `pair_values` returns the coefficients of a receiver and a source, kind by kind, the coupling as if the receiver
    /// were to the right of the source and behind it.
    pub(crate) fn scatter<T, const N: usize>(
        &self,
        matrix: &mut [T],
        mut pair_values: impl FnMut([usize; 2], &Pair) -> [T; N],
    ) where
        T: Copy + Mul<f64, Output = T>,
    {
        let layout = self.layout();
        self.each(|[receiver, source], pair, terms| {
            let values = pair_values([receiver, source], pair);
            for Term { kind, components: [displacement, traction], factor } in terms {
                let row = layout.index_of(*displacement, receiver);
                let column = layout.index_of(*traction, source);
                matrix[row * layout.len() + column] = values[*kind] * *factor;
            }
        });
    }

    /// Smallest eigenvalue of the Hermitian part of a symbol, normalised by `diagonal`.
    ///
    /// The symbol is the matrix of z-transformed coefficients at one z; `pair_values` returns its values as for
    /// [`PairClasses::scatter`]. `diagonal(class, component)` returns a reference value for each element on itself. NaN if
    /// the symbol is not finite.
    ///
    /// For the symbol (1−z) Ĝ(z), integrated over receivers and sources, the eigenvalue shows whether a ground can create
    /// energy: by Parseval the work of any tractions is not negative if this eigenvalue is not negative anywhere on
    /// |z| = 1.
    pub(crate) fn smallest_eigenvalue<T, const N: usize>(
        &self,
        diagonal: impl Fn(usize, usize) -> f64,
        pair_values: impl FnMut([usize; 2], &Pair) -> [T; N],
    ) -> f64
    where
        T: MatrixScalar + Default + Mul<f64, Output = T>,
    {
        let matrix = self.scaled_matrix(diagonal, pair_values);
        hermitian_range(&matrix, self.layout().len()).map_or(f64::NAN, |[smallest, _]| smallest)
    }

    /// Whether the smallest eigenvalue of a real symbol is above `bound`.
    ///
    /// The test is a factorization, which is much faster than the eigenvalues. Close to `bound` it may return false.
    pub(crate) fn exceeds<const N: usize>(
        &self,
        bound: f64,
        diagonal: impl Fn(usize, usize) -> f64,
        pair_values: impl FnMut([usize; 2], &Pair) -> [f64; N],
    ) -> bool {
        let mut matrix = self.scaled_matrix(diagonal, pair_values);
        let order = self.layout().len();
        matrix.iter_mut().step_by(order + 1).for_each(|value| *value -= bound);
        matrix.iter().all(|value| value.is_finite()) && indefinite_pivot(&matrix, order).is_none()
    }

    /// Matrix of a symbol with rows and columns divided by the square roots of `diagonal`.
    fn scaled_matrix<T, const N: usize>(
        &self,
        diagonal: impl Fn(usize, usize) -> f64,
        pair_values: impl FnMut([usize; 2], &Pair) -> [T; N],
    ) -> Vec<T>
    where
        T: Copy + Default + Mul<f64, Output = T>,
    {
        let layout = self.layout();
        let mut matrix = vec![T::default(); layout.matrix_len()];
        self.scatter(&mut matrix, pair_values);
        let mut scales = Vec::with_capacity(layout.len());
        for matrix_index in 0..layout.len() {
            let [component, element] = layout.component_and_element(matrix_index);
            // Class 0 of a lattice is a cell on itself.
            let self_pair = self.pairs.get(element * (self.elements.len() + 1));
            scales.push(1.0 / diagonal(self_pair.map_or(0, |pair| pair.class), component).sqrt());
        }
        for (row_values, row) in matrix.chunks_exact_mut(layout.len()).zip(&scales) {
            for (value, column) in row_values.iter_mut().zip(&scales) {
                *value = *value * *row * *column;
            }
        }
        matrix
    }

    /// Length from the first element's left end to the last one's right end, m.
    pub(crate) fn span(&self) -> f64 {
        self.elements[self.elements.len() - 1].right() - self.elements[0].left()
    }
}
