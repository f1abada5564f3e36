//! Coherence between the means of the motion over contact elements.
//!
//! The mean of Γ over all pairs of points in two elements is computed with two Gauss points along each side, which is exact
//! for polynomials of the third degree: for Γ = exp(−b²d²) on a square of side l the error is (bl)⁴/180, 4e-4 for bl = ½.

use std::collections::HashMap;

use super::super::Coherence;
use crate::error::{Error, Result, require};
use crate::geometry::ContactElement;

/// Position of the two Gauss points, relative to half the side.
const GAUSS_POSITION: f64 = 0.577_350_269_189_625_8;
/// Difference of two vectors between elements, relative to the shortest side, that counts as rounding.
const OFFSET_TOLERANCE: f64 = 1e-9;

/// Reference point and elements, between which the coherence is computed.
pub(super) struct CellCoherence<'a> {
    coherence: &'a dyn Coherence,
    /// Points over which each mean is taken: one at the reference point, which is first, and then those of each element.
    points: Vec<Vec<[f64; 2]>>,
    /// Pairs whose coherence is computed.
    classes: Vec<[usize; 2]>,
    /// Class of each pair, for the lower triangle of the matrix row by row.
    pair_classes: Vec<usize>,
}

impl<'a> CellCoherence<'a> {
    /// Reference point `[x, y]` (m) and elements; returns an error for distances beyond those of the model.
    pub(super) fn new(
        coherence: &'a dyn Coherence,
        reference: [f64; 2],
        elements: &[ContactElement],
    ) -> Result<Self> {
        let mut points = vec![vec![reference]];
        points.extend(elements.iter().map(gauss_points));
        check_distances(coherence, &points)?;
        let mut classes = Vec::new();
        let mut pair_classes = Vec::with_capacity(points.len() * (points.len() + 1) / 2);
        let mut class_indices = HashMap::new();
        let min_side =
            elements.iter().flat_map(ContactElement::sides).fold(f64::INFINITY, f64::min);
        let unit = OFFSET_TOLERANCE * min_side;
        for i in 0..points.len() {
            for j in 0..=i {
                // The reference point is a class of its own with each element.
                let key = if coherence.is_homogeneous() && j > 0 {
                    offset_key(&elements[i - 1], &elements[j - 1], unit)
                } else {
                    None
                };
                let next_class = classes.len();
                let class = match key {
                    Some(key) => *class_indices.entry(key).or_insert(next_class),
                    None => next_class,
                };
                if class == next_class {
                    classes.push([i, j]);
                }
                pair_classes.push(class);
            }
        }
        Ok(Self { coherence, points, classes, pair_classes })
    }

    /// Number of rows of the matrix: the reference point and the elements.
    pub(super) fn order(&self) -> usize {
        self.points.len()
    }

    /// Whether all matrices are positive semi-definite.
    pub(super) fn is_semi_definite(&self) -> bool {
        self.coherence.is_semi_definite()
    }

    /// Row-major matrix of the coherence at a `frequency` (Hz).
    ///
    /// Returns an error for a coherence that is not between −1 and 1.
    pub(super) fn matrix(&self, frequency: f64) -> Result<Vec<f64>> {
        let mut class_values = Vec::with_capacity(self.classes.len());
        for [i, j] in &self.classes {
            class_values.push(self.mean(frequency, &self.points[*i], &self.points[*j])?);
        }
        let order = self.order();
        let mut matrix = vec![0.0; order * order];
        let mut pair_classes = self.pair_classes.iter();
        for i in 0..order {
            for (j, class) in (0..=i).zip(pair_classes.by_ref()) {
                matrix[i * order + j] = class_values[*class];
                matrix[j * order + i] = class_values[*class];
            }
        }
        Ok(matrix)
    }

    /// Mean of the coherence over all pairs of points.
    fn mean(&self, frequency: f64, receivers: &[[f64; 2]], sources: &[[f64; 2]]) -> Result<f64> {
        let mut sum = 0.0;
        for receiver in receivers {
            for source in sources {
                let value = self.coherence.between(frequency, *receiver, *source);
                let needed = "from -1 to 1";
                sum += require("coherence", value, (-1.0..=1.0).contains(&value), needed)
                    .map_err(|fault| at_frequency(frequency, fault))?;
            }
        }
        Ok(sum / (receivers.len() * sources.len()) as f64)
    }
}

/// Error of the coherence at a frequency, Hz.
pub(super) fn at_frequency(frequency: f64, fault: Error) -> Error {
    Error::Item { item: format!("coherence at {frequency} Hz"), r#source: Box::new(fault) }
}

/// Gauss points of an element: two along each side.
fn gauss_points(element: &ContactElement) -> Vec<[f64; 2]> {
    let center = element.center();
    let mut points = Vec::new();
    for part in element.parts() {
        // The middle of a half is at half of half the side.
        let shift = |axis: usize| 2.0 * GAUSS_POSITION * (part.center()[axis] - center[axis]);
        points.push([center[0] + shift(0), center[1] + shift(1)]);
    }
    points
}

/// Checks that no two points are farther apart than the model allows.
fn check_distances(coherence: &dyn Coherence, points: &[Vec<[f64; 2]>]) -> Result<()> {
    let max_distance = coherence.max_distance();
    if max_distance == f64::INFINITY {
        return Ok(());
    }
    for (i, receivers) in points.iter().enumerate() {
        for sources in &points[..i] {
            for ([x, y], [source_x, source_y]) in
                receivers.iter().flat_map(|receiver| sources.iter().map(move |s| (receiver, s)))
            {
                let distance = (x - source_x).hypot(y - source_y);
                let needed = "at most that for which the coherence is defined";
                require("distance of two points", distance, distance <= max_distance, needed)?;
            }
        }
    }
    Ok(())
}

/// Vector between two elements and their sides in whole numbers of a `unit` (m); the same for the opposite vector.
fn offset_key(receiver: &ContactElement, source: &ContactElement, unit: f64) -> Option<[i64; 6]> {
    let center = receiver.center();
    let source_center = source.center();
    let sides = receiver.sides();
    let source_sides = source.sides();
    let numbers = [
        center[0] - source_center[0],
        center[1] - source_center[1],
        sides[0],
        sides[1],
        source_sides[0],
        source_sides[1],
    ];
    let mut key = [0; 6];
    for (rounded, number) in key.iter_mut().zip(numbers) {
        let ratio = (number / unit).round();
        if ratio.abs() >= i64::MAX as f64 {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, reason = "checked")]
        let integer = ratio as i64;
        *rounded = integer;
    }
    let is_opposite = key[..2] < [0, 0][..];
    if is_opposite {
        key = [-key[0], -key[1], key[4], key[5], key[2], key[3]];
    }
    Some(key)
}
