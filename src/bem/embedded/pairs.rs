//! Pairs of elements around a trench: their classes, and the compliances of each class.

use std::sync::OnceLock;

use super::compliance::HalfCompliances;
use super::rational::RationalCompliances;
use super::sampling::{QuadratureDomain, sample};
use super::soil::TrenchSoil;
use crate::bem::layered::{Compliances, LayeredCompliance, SurrogateLengths, self_pair_classes};
use crate::error::{Error, ProgressReporter, Result};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, check_count};
use crate::history::{Pair, PairClasses};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Number of kinds of convolution weights.
///
/// Normal, tangential, normal displacement due to tangential traction, and tangential displacement due to normal
/// traction.
pub(super) const TRENCH_KINDS: usize = 4;

/// Components of receiver and source for each kind: 0 normal, 1 tangential.
const KIND_COMPONENTS: [[usize; 2]; TRENCH_KINDS] = [[0, 0], [1, 1], [0, 1], [1, 0]];

/// Sorts the pairs of elements around a trench into classes.
///
/// The elements follow the outline, and the second half mirrors the first one. i and j ≤ i count the elements of a half
/// from the axis. In class i(i + 1)/2 + j receiver i and source j are in the right half. An equal number of classes
/// follows, in which source j is in the left half.
///
/// # Errors
/// As for [`check_count`].
pub(super) fn trench_classes(elements: Vec<ContactElement>) -> Result<PairClasses> {
    check_count(elements.len(), COMPONENTS_IN_PLANE)?;
    let element_count = elements.len();
    let half_count = element_count / 2;
    let same_half_classes = half_count * (half_count + 1) / 2;
    let mut pairs = vec![];
    let mut exchanged = vec![];
    for (p, receiver) in elements.iter().enumerate() {
        for q in 0..element_count {
            let i = index_from_axis(p, half_count);
            let j = index_from_axis(q, half_count);
            let crosses_axis = (p < half_count) != (q < half_count);
            let first_class = if crosses_axis { same_half_classes } else { 0 };
            let class = i.max(j) * (i.max(j) + 1) / 2 + i.min(j) + first_class;
            let is_exchanged = i < j;
            // A receiver of the left half is the mirror image of a receiver of the right half.
            let is_mirrored = if is_exchanged { q < half_count } else { p < half_count };
            let sign = if is_mirrored { -1.0 } else { 1.0 };
            pairs.push(Pair { class, scale: 1.0 / receiver.length(), sign });
            exchanged.push(is_exchanged);
        }
    }
    let mut representatives = Vec::with_capacity(2 * same_half_classes);
    for source_is_right in [true, false] {
        for i in 0..half_count {
            for j in 0..=i {
                let source = if source_is_right { half_count + j } else { half_count - 1 - j };
                representatives.push([elements[source], elements[half_count + i]]);
            }
        }
    }
    Ok(PairClasses::of_pairs(elements, pairs, representatives, TRENCH_KINDS, exchanged))
}

/// Index of an element in its half, counted from the axis.
fn index_from_axis(element: usize, half_count: usize) -> usize {
    if element < half_count { half_count - 1 - element } else { element - half_count }
}

/// Compliances of the classes of [`trench_classes`].
#[derive(Debug)]
pub(super) struct TrenchPairs {
    soil: TrenchSoil,
    /// Degree of the finite elements, the same at all Laplace variables.
    degree: usize,
    /// Lengths of the shortest element and of the outline.
    lengths: SurrogateLengths,
    /// Laplace variables for which rational functions are sought; `None` to compute all compliances by finite elements.
    domain: Option<QuadratureDomain>,
    /// Rational functions in the domain, once sought; `None` if the compliances are too rough for them.
    rational: OnceLock<Option<RationalCompliances<TRENCH_KINDS>>>,
}

/// Row of a displacement component in the compliances of a half.
struct SignedRow {
    row: usize,
    /// −1 if the component has the opposite direction there.
    sign: f64,
}

impl TrenchPairs {
    /// Pairs of the elements around a trench.
    pub(super) fn new(soil: TrenchSoil, degree: usize) -> Self {
        let elements = soil.elements().elements();
        let lengths = elements.iter().map(ContactElement::length);
        let min_element_length = lengths.clone().fold(f64::INFINITY, f64::min);
        let lengths = SurrogateLengths { min_element_length, span: lengths.sum() };
        Self { soil, degree, lengths, domain: None, rational: OnceLock::new() }
    }

    /// The same pairs, with rational functions of the Laplace variable in a `domain`.
    pub(super) fn interpolated_in(self, domain: QuadratureDomain) -> Self {
        Self { domain: Some(domain), ..self }
    }

    /// Number of nodes of the rational functions, if there are any.
    #[cfg(test)]
    pub(super) fn node_count(&self) -> Option<usize> {
        self.rational.get().and_then(Option::as_ref).map(RationalCompliances::node_count)
    }

    /// Overwrites `values`, one per class, with the compliances at `s` by finite elements.
    fn by_finite_elements(&self, s: Complex, values: &mut [[Complex; TRENCH_KINDS]]) -> Result<()> {
        let chosen = self.soil.mesh_of_degree(s, self.degree)?;
        let compliances = match chosen.compliances {
            Some(compliances) => compliances,
            None => self.soil.compliances(s, &chosen.mesh)?,
        };
        self.fill_classes(&compliances, values);
        Ok(())
    }

    /// Rows of an element in the compliances of a half: normal, tangential.
    ///
    /// `element` counts the elements of the right half from the axis along the outline.
    fn component_rows(&self, element: usize) -> [SignedRow; 2] {
        let elements = self.soil.elements();
        let base_count = elements.base_ends().len() - 1;
        let wall_count = elements.wall_ends().len() - 1;
        if element < base_count {
            return [
                SignedRow { row: 2 * element + 1, sign: 1.0 },
                SignedRow { row: 2 * element, sign: 1.0 },
            ];
        }
        // The compliances count the elements of the wall from the surface down; the tangent of the wall leads up.
        let row = 2 * (2 * base_count + wall_count - 1 - element);
        [SignedRow { row, sign: 1.0 }, SignedRow { row: row + 1, sign: -1.0 }]
    }

    /// Overwrites `values`, one per class, with compliances from those of symmetric and antisymmetric fields.
    pub(super) fn fill_classes(
        &self,
        compliances: &HalfCompliances,
        values: &mut [[Complex; TRENCH_KINDS]],
    ) {
        let HalfCompliances { symmetric, antisymmetric } = compliances;
        // Pairs on one side of the axis, then pairs across the axis.
        let same_side_classes = values.len() / 2;
        let mut class = 0;
        for i in 0..symmetric.rows() / 2 {
            let receiver = self.component_rows(i);
            for j in 0..=i {
                let source = self.component_rows(j);
                for (kind, [a, b]) in KIND_COMPONENTS.into_iter().enumerate() {
                    let row = receiver[a].row;
                    let column = source[b].row;
                    let even = symmetric[(row, column)];
                    let odd = antisymmetric[(row, column)];
                    let factor = 0.5 * receiver[a].sign * source[b].sign;
                    // A mirror changes the sign of tangential components.
                    let mirrored_factor = if b == 0 { factor } else { -factor };
                    let same_side = (even + odd) * factor;
                    let opposite_side = (even - odd) * mirrored_factor;
                    values[class][kind] = Complex::new(same_side.re, same_side.im);
                    values[same_side_classes + class][kind] =
                        Complex::new(opposite_side.re, opposite_side.im);
                }
                class += 1;
            }
        }
    }
}

impl Compliances<TRENCH_KINDS> for TrenchPairs {
    type Workspace = LayeredCompliance;

    const PASSIVITY_POINTS: usize = 12;

    fn make_ready(&self, progress: &mut ProgressReporter) -> Result<()> {
        let Some(domain) = self.domain.filter(|_| self.rational.get().is_none()) else {
            return Ok(());
        };
        let classes = trench_classes(self.soil.elements().elements())?;
        let self_pairs = self_pair_classes(&classes);
        let compute = |s, values: &mut [_]| self.by_finite_elements(s, values);
        // Samples are nearer to the axis than the points of short histories. A point that fails itself reports its error.
        let rational = match sample(domain, &self_pairs, compute, progress) {
            Err(error @ Error::Stopped(_)) => return Err(error),
            outcome => outcome.ok().flatten(),
        };
        // Two calls at the same time have the same result.
        self.rational.get_or_init(|| rational);
        Ok(())
    }

    fn compliance(
        &self,
        _profile: &SoilProfile,
        s: Complex,
        _work: &mut Self::Workspace,
        values: &mut [[Complex; TRENCH_KINDS]],
    ) -> Result<()> {
        let rational = self.rational.get().and_then(Option::as_ref);
        match rational.filter(|_| self.domain.is_some_and(|domain| domain.contains(s))) {
            Some(rational) => rational.evaluate(s, values),
            None => self.by_finite_elements(s, values)?,
        }
        Ok(())
    }

    fn surrogate_lengths(&self) -> SurrogateLengths {
        self.lengths
    }

    fn surface_compliance(workspace: &mut LayeredCompliance) -> &mut LayeredCompliance {
        workspace
    }
}
