//! Motions at elements relative to the motion at the reference point, at equally spaced frequencies.
//!
//! | symbol | meaning |
//! |---|---|
//! | Γ | coherence between the elements, means over pairs of points |
//! | γ | coherence of the elements with the reference point |
//! | L | factor of the conditional covariance, L Lᵀ = Γ − γ γᵀ |
//! | φ | independent random phases, uniform from 0 to 2π |
//!
//! Relative to the motion at the reference point the motion of element i is
//!
//! h_i = γ_i + Σ_k L_ik e^(iφ_k)
//!
//! Its mean is γ_i, and the mean of h_i h_j* is γ_i γ_j + (L Lᵀ)_ij = Γ_ij, as for a factor of the whole matrix whose first
//! pivot is the reference point with the phase zero. This is a conditional simulation (Kameda and Morikawa, "An
//! interpolating stochastic process for simulation of conditional random fields", Probab. Eng. Mech. 7 (1992), 243–254).

use std::f64::consts::{PI, TAU};

use basemat_fourier::num_complex::Complex64;

use super::cell_coherence::{CellCoherence, at_frequency};
use crate::error::{Error, Result, require};
use crate::linalg::{pivoted_cholesky, symmetric_modes};

/// Largest variance of an element's motion that the factor neglects.
const NEGLECTED_VARIANCE: f64 = 1e-10;
/// Largest magnitude of a negative eigenvalue that counts as rounding.
const EIGENVALUE_ROUNDING: f64 = 1e-9;

/// What happens to negative eigenvalues of the coherence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NegativeEigenvalues {
    /// They are errors.
    Rejected,
    /// They are replaced by zero.
    Clipped,
}

/// Coherence with the reference point, and factor of the conditional covariance, at one frequency.
pub(super) struct Factor {
    /// γ of each element.
    pub(super) means: Vec<f64>,
    /// Columns of L.
    pub(super) columns: Vec<Vec<f64>>,
    /// Smallest eigenvalue of the coherence, before it is clipped; zero if it is not computed.
    pub(super) min_eigenvalue: f64,
}

impl Factor {
    /// Factor of the coherence between elements at a `frequency`, Hz.
    pub(super) fn new(
        cells: &CellCoherence<'_>,
        negative_eigenvalues: NegativeEigenvalues,
        frequency: f64,
    ) -> Result<Self> {
        let order = cells.order();
        let mut matrix = cells.matrix(frequency)?;
        let mut min_eigenvalue = 0.0;
        if !cells.is_semi_definite() {
            min_eigenvalue = clip(&mut matrix, order, negative_eigenvalues)
                .map_err(|fault| at_frequency(frequency, fault))?;
        }
        let means: Vec<f64> = matrix[1..order].to_vec();
        let covariance = |i: usize, j: usize| matrix[(i + 1) * order + j + 1] - means[i] * means[j];
        let diagonal = (0..means.len()).map(|i| covariance(i, i)).collect();
        let columns =
            pivoted_cholesky(diagonal, NEGLECTED_VARIANCE, means.len(), |pivot, column| {
                for (i, value) in column.iter_mut().enumerate() {
                    *value = covariance(pivot, i);
                }
            });
        let singular_error = Error::Singular { matrix: "coherence between elements", order };
        let columns = columns.ok_or_else(|| at_frequency(frequency, singular_error))?;
        Ok(Self { means, columns, min_eigenvalue })
    }

    /// Standard deviation of each element's random part.
    pub(super) fn deviations(&self) -> Vec<f64> {
        let mut variances = vec![0.0; self.means.len()];
        for column in &self.columns {
            for (variance, factor) in variances.iter_mut().zip(column) {
                *variance += factor * factor;
            }
        }
        variances.into_iter().map(f64::sqrt).collect()
    }

    /// Random part of each element with the variance 1: the sum of the columns, each with a random phase.
    pub(super) fn unit_random_part(&self, phases: &mut PhaseSequence) -> Vec<Complex64> {
        self.unit_sum(|| Complex64::cis(phases.next_phase()))
    }

    /// Random part that tends to random delays at low frequencies: imaginary, so that it is smooth at frequency zero.
    pub(super) fn unit_random_delays(&self, phases: &mut PhaseSequence) -> Vec<Complex64> {
        self.unit_sum(|| Complex64::new(0.0, if phases.next_phase() < PI { 1.0 } else { -1.0 }))
    }

    /// Sum of the columns, each times a random number, divided by the standard deviation of each element.
    fn unit_sum(&self, mut next_number: impl FnMut() -> Complex64) -> Vec<Complex64> {
        let mut sum = vec![Complex64::default(); self.means.len()];
        for column in &self.columns {
            let number = next_number();
            for (value, factor) in sum.iter_mut().zip(column) {
                *value += number * factor;
            }
        }
        for (value, deviation) in sum.iter_mut().zip(self.deviations()) {
            *value /= if deviation > 0.0 { deviation } else { 1.0 };
        }
        sum
    }
}

/// Replaces negative eigenvalues of a symmetric matrix by zero, with its diagonal unchanged.
///
/// Rows and columns are scaled so that the diagonal stays. Returns the smallest eigenvalue, or an error if it is negative and
/// must not be clipped. Eigenvalues that are negative by rounding count as zero.
fn clip(
    matrix: &mut [f64],
    order: usize,
    negative_eigenvalues: NegativeEigenvalues,
) -> Result<f64> {
    let failed_error = Error::Singular { matrix: "coherence between elements", order };
    let modes = symmetric_modes(matrix, order).ok_or(failed_error)?;
    let min_eigenvalue = modes.values.iter().copied().fold(f64::INFINITY, f64::min);
    if min_eigenvalue >= -EIGENVALUE_ROUNDING {
        return Ok(0.0);
    }
    let quantity = "smallest eigenvalue of the coherence between elements";
    let needed = "zero or more, unless it is clipped (see `Incoherence::clipped`)";
    let is_clipped = negative_eigenvalues == NegativeEigenvalues::Clipped;
    require(quantity, min_eigenvalue, is_clipped, needed)?;
    let diagonal: Vec<f64> = (0..order).map(|i| matrix[i * (order + 1)]).collect();
    for (mode, eigenvalue) in modes.values.iter().enumerate().filter(|(_, value)| **value < 0.0) {
        let vector: Vec<f64> = (0..order).map(|i| modes.vectors[i * order + mode]).collect();
        for (row, component) in matrix.chunks_exact_mut(order).zip(&vector) {
            let factor = eigenvalue * component;
            for (value, other_component) in row.iter_mut().zip(&vector) {
                *value -= factor * other_component;
            }
        }
    }
    let scales: Vec<f64> = diagonal
        .iter()
        .enumerate()
        .map(|(i, value)| (value.max(0.0) / matrix[i * (order + 1)]).sqrt())
        .collect();
    for i in 0..order {
        for j in 0..order {
            matrix[i * order + j] *= scales[i] * scales[j];
        }
    }
    Ok(min_eigenvalue)
}

/// Random phases from a seed, the same on every machine.
///
/// The generator is SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
pub(super) struct PhaseSequence {
    state: u64,
}

impl PhaseSequence {
    /// Phases of a component of the motion (0, 1 or 2).
    pub(super) fn new(seed: u64, component: usize) -> Self {
        let mut sequence = Self { state: seed };
        for _ in 0..=component {
            sequence.state = sequence.next_integer();
        }
        sequence
    }

    /// Next phase, from 0 to 2π.
    fn next_phase(&mut self) -> f64 {
        let fraction = (self.next_integer() >> 11) as f64 / (1_u64 << 53) as f64;
        TAU * fraction
    }

    /// Next integer.
    fn next_integer(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed_bits = self.state;
        mixed_bits = (mixed_bits ^ (mixed_bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed_bits = (mixed_bits ^ (mixed_bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed_bits ^ (mixed_bits >> 31)
    }
}
