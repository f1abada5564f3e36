//! Step coefficients of all pairs of elements on the half-plane, each kind of pair once.

use std::collections::HashMap;
use std::sync::Arc;

use super::influence::LateSeries;
use super::{ContactElement, InfluenceKernel};
use crate::error::{Error, Result};
use crate::history::Shelf;
use crate::soil::Soil;

/// How a pair of elements finds its coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Which class of pairs it belongs to.
    pub class: usize,
    /// 1/length of the receiver: class coefficients are integrals over it, not means.
    pub scale: f64,
    /// Sign of the coupling between normal and tangential components: +1 for a receiver to the
    /// right of the source, −1 to the left, 0 for an element on itself.
    pub sign: f64,
}

/// Shortest element over the length of the patch: shorter ones could not be told apart by class.
const SHORTEST: f64 = 1e-8;

/// Coefficients Gⁿ of a patch of surface elements for steps of one length.
///
/// A traction of 1 Pa on element q during one step moves element p, n steps later (n = 1: at the
/// step's own end), by a mean Gⁿ. By reciprocity lₚ Gₚq = l_q G_qp, and only the two lengths and
/// the distance matter, so pairs fall into classes: Q of them on a uniform strip instead of Q².
#[derive(Debug, Clone)]
pub struct PatchKernel {
    elements: Vec<ContactElement>,
    kernel: InfluenceKernel,
    /// One (source, receiver) per class, the receiver on the right.
    classes: Vec<(ContactElement, ContactElement)>,
    pairs: Vec<Pair>,
    /// Spectra, for histories to share.
    shelf: Arc<Shelf>,
}

impl PatchKernel {
    /// Kernel for `elements` (left to right, not overlapping) and steps of `time_step` seconds.
    ///
    /// # Errors
    /// [`Error::Input`] for a bad time step, lengths not positive or shorter than 1e-8 of the patch,
    /// or elements out of order;
    /// [`Error::Size`] for none.
    pub fn new(soil: Soil, elements: Vec<ContactElement>, time_step: f64) -> Result<Self> {
        check_order(&elements)?;
        let kernel = InfluenceKernel::new(soil, time_step)?;
        let span = elements[elements.len() - 1].right - elements[0].left;
        let shortest = elements.iter().map(ContactElement::length).fold(f64::INFINITY, f64::min);
        if shortest < SHORTEST * span {
            return Err(Error::Input {
                quantity: "length of the shortest contact element over that of the patch",
                value: shortest / span,
                needed: "at least 1e-8",
            });
        }
        let mut numbers = HashMap::new();
        let mut classes = Vec::new();
        let mut pairs = Vec::with_capacity(elements.len() * elements.len());
        for (p, receiver) in elements.iter().enumerate() {
            for (q, source) in elements.iter().enumerate() {
                let (left, right) = if p < q { (receiver, source) } else { (source, receiver) };
                // Rounding of the nodes must not split a class: 1e-12 of the patch is nothing.
                #[allow(clippy::cast_possible_truncation, reason = "at most 1e12")]
                let key = |length: f64| (length / span * 1e12).round() as i64;
                let (a, b) = (key(left.length()), key(right.length()));
                let distance = key(right.center() - left.center());
                let class = *numbers.entry((a.min(b), a.max(b), distance)).or_insert_with(|| {
                    classes.push((*left, *right));
                    classes.len() - 1
                });
                let sign = match p.cmp(&q) {
                    std::cmp::Ordering::Less => -1.0,
                    std::cmp::Ordering::Equal => 0.0,
                    std::cmp::Ordering::Greater => 1.0,
                };
                pairs.push(Pair { class, scale: 1.0 / receiver.length(), sign });
            }
        }
        Ok(Self { elements, kernel, classes, pairs, shelf: Arc::default() })
    }

    pub(crate) fn shelf(&self) -> &Shelf {
        &self.shelf
    }

    /// The elements, from left to right.
    pub fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// Number of classes of pairs.
    pub fn classes(&self) -> usize {
        self.classes.len()
    }

    /// How all pairs find their coefficients: receiver by receiver, Q sources each.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Overwrites the slices (of one length) with the coefficients of `class` for the lags from
    /// `first_lag` (≥ 1) on, m²/Pa: vertical due to vertical, horizontal due to horizontal, and
    /// vertical (down) due to horizontal with the receiver on the right.
    ///
    /// # Errors
    /// [`Error::Index`] for a class that does not exist, [`Error::Size`] for slices of different
    /// lengths, [`Error::Input`] for lag 0.
    pub fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        normal: &mut [f64],
        tangential: &mut [f64],
        coupling: &mut [f64],
    ) -> Result<()> {
        let (source, receiver) = self.class(class)?;
        self.kernel.pair(receiver, source)?.fill(first_lag, normal, tangential, coupling)?;
        let length = receiver.length();
        for values in [normal, tangential, coupling] {
            for value in values {
                *value *= length;
            }
        }
        Ok(())
    }

    /// Last lag at which the coupling of `class` is not zero; 0 if it always is.
    ///
    /// # Errors
    /// [`Error::Index`] for a class that does not exist.
    pub fn last_coupling_lag(&self, class: usize) -> Result<usize> {
        let (source, receiver) = self.class(class)?;
        Ok(self.kernel.pair(receiver, source)?.coupling_ends() - 1)
    }

    /// How all coefficients fall behind the Rayleigh wave.
    pub(crate) fn late_series(&self) -> LateSeries<'_> {
        self.kernel.late_series()
    }

    fn class(&self, class: usize) -> Result<(ContactElement, ContactElement)> {
        self.classes.get(class).copied().ok_or(Error::Index {
            quantity: "class of element pairs",
            index: class,
            bound: self.classes.len(),
        })
    }

    /// Overwrites `matrix` (2Q × 2Q, row-major) with the coefficients of lag 1.
    ///
    /// # Errors
    /// [`Error::Size`] for a slice of the wrong length.
    pub fn instantaneous(&self, matrix: &mut [f64]) -> Result<()> {
        let count = self.elements.len();
        crate::error::same_length("instantaneous operator", matrix.len(), 4 * count * count)?;
        let first = (0..self.classes())
            .map(|class| {
                let [mut zz, mut xx, mut zx] = [[0.0]; 3];
                self.coefficients(class, 1, &mut zz, &mut xx, &mut zx)?;
                Ok([zz[0], xx[0], zx[0]])
            })
            .collect::<Result<Vec<_>>>()?;
        for (p, pairs) in self.pairs.chunks_exact(count).enumerate() {
            for (q, pair) in pairs.iter().enumerate() {
                let [zz, xx, zx] = first[pair.class].map(|value| value * pair.scale);
                let mut set = |row: usize, column: usize, value: f64| {
                    matrix[row * 2 * count + column] = value;
                };
                set(p, q, zz);
                set(count + p, count + q, xx);
                set(p, count + q, pair.sign * zx);
                set(count + p, q, -pair.sign * zx);
            }
        }
        Ok(())
    }
}

/// Error unless the elements have positive length, in order, without overlap.
pub(crate) fn check_order(elements: &[ContactElement]) -> Result<()> {
    if elements.is_empty() {
        return Err(Error::Size { quantity: "list of contact elements", found: 0, needed: 1 });
    }
    for element in elements {
        crate::error::finite("left end of a contact element", element.left)?;
        crate::error::finite("right end of a contact element", element.right)?;
        crate::error::positive("length of a contact element", element.length())?;
    }
    for pair in elements.windows(2) {
        // Neighbours may differ by rounding of a common node.
        let overlap = pair[0].right - pair[1].left;
        if overlap > 1e-9 * pair[0].length().min(pair[1].length()) {
            return Err(Error::Input {
                quantity: "left end of a contact element",
                value: pair[1].left,
                needed: "at or right of the end of the element before it",
            });
        }
    }
    Ok(())
}
