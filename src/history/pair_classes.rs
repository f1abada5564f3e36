//! Pairs of elements, in classes that share their coefficients.

use std::cmp::Ordering;
use std::collections::HashMap;

use crate::error::{Error, Result};
use crate::geometry::{ContactElement, check_order};

/// Where a pair of elements finds its coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Which class of pairs it belongs to.
    pub class: usize,
    /// 1/length of the receiver, 1/m: class coefficients are integrals over it, not means.
    pub scale: f64,
    /// Sign of the coupling between normal and tangential components: +1 for a receiver to the
    /// right of the source, −1 to the left, 0 for an element on itself.
    pub sign: f64,
}

/// Shortest element over the length of the patch: shorter ones could not be told apart by class.
const SHORTEST: f64 = 1e-8;

/// Elements of a patch, and their pairs sorted into classes.
///
/// On a laterally homogeneous ground (any layering, but no change from place to place) a pair's
/// coefficients depend on the two lengths and the distance alone, and by reciprocity
/// lₚ Gₚq = l_q G_qp. So pairs fall into classes: Q of them on a uniform strip, about Q²/4 on a graded
/// one, instead of Q². Whoever writes a [`LagKernel`](super::LagKernel) computes one pair of each.
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
    /// One (source, receiver) per class, the receiver on the right.
    representatives: Vec<[ContactElement; 2]>,
}

impl PairClasses {
    /// Classes of the pairs of `elements` (left to right, not overlapping).
    ///
    /// # Errors
    /// [`Error::Size`] for no elements, [`Error::Input`] for lengths not positive or shorter than
    /// 1e-8 of the patch, or elements out of order.
    pub fn new(elements: Vec<ContactElement>) -> Result<Self> {
        check_order(&elements)?;
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
        let mut representatives = Vec::new();
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
                    representatives.push([*left, *right]);
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
        Ok(Self { elements, pairs, representatives })
    }

    /// The elements, from left to right.
    pub fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// All pairs: receiver by receiver, Q sources each.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Number of classes.
    pub fn count(&self) -> usize {
        self.representatives.len()
    }

    /// One pair of `class`: its source, and its receiver, which is the source itself or to the
    /// right of it.
    ///
    /// # Errors
    /// [`Error::Index`] for a class that does not exist.
    pub fn representative(&self, class: usize) -> Result<[ContactElement; 2]> {
        self.representatives.get(class).copied().ok_or(Error::Index {
            quantity: "class of element pairs",
            index: class,
            bound: self.representatives.len(),
        })
    }

    /// Length from the first element's left end to the last one's right end, m.
    pub fn span(&self) -> f64 {
        self.elements[self.elements.len() - 1].right - self.elements[0].left
    }
}
