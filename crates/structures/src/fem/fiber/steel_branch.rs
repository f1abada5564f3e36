//! Curved branches of steel, of one fibre or of many at once.
//!
//! | symbol | meaning |
//! |---|---|
//! | ε* | strain since the reversal, relative to that at which the asymptotes meet |
//! | R | exponent of the transition |
//! | q | \|ε*\|^R up to \|ε*\| = 1, its reciprocal beyond: at most 1 |
//! | b, E | hardening ratio, Young's modulus |

#![allow(clippy::inline_always, reason = "the caller compiles them for its instruction set")]

use super::elementary::{exponential, logarithm};
use super::{UniaxialResponse, padded_count};
use crate::linalg::{Simd, WithSimd};

/// Smallest logarithm of q and of its root: smaller ones have no effect.
const MIN_POWER_LOGARITHM: f64 = -700.0;
/// Largest number of branches of a loop.
///
/// A branch is a long chain of operations that wait for each other. Processors work on several vectors of a loop at a time.
pub(super) const MAX_LOOP_BRANCHES: usize = 32;

/// Curve from a reversal to the asymptote of a half cycle.
#[derive(Debug, Clone, Copy)]
pub(super) struct SteelBranch {
    /// R; zero for a straight line of the slope b E.
    pub(super) exponent: f64,
    /// Strain from the reversal to the intersection of the asymptotes, with sign; not zero.
    pub(super) strain_range: f64,
    /// Strain and stress (Pa) at the reversal.
    pub(super) reversal: [f64; 2],
}

impl SteelBranch {
    /// Straight line of the slope b E from a reversal.
    pub(super) fn line(reversal: [f64; 2], yield_strain: f64) -> Self {
        Self { exponent: 0.0, strain_range: yield_strain, reversal }
    }

    /// Stress and tangent at a strain on the branch.
    ///
    /// σ* = b ε* + (1 − b) ε*/(1 + |ε*|^R)^(1/R). The fraction is ±(1 + q)^(−1/R) beyond |ε*| = 1: nothing overflows.
    #[inline(always)]
    pub(super) fn response(self, modulus: f64, b: f64, strain: f64) -> UniaxialResponse {
        let Self { exponent, strain_range, reversal } = self;
        let is_line = exponent == 0.0;
        let curvature = if is_line { 0.0 } else { 1.0 - b };
        let inverse_exponent = 1.0 / if is_line { 1.0 } else { exponent };
        let offset = strain - reversal[0];
        let ratio = offset / strain_range;
        let magnitude = ratio.abs().max(f64::MIN_POSITIVE);
        let power_logarithm = -exponent * logarithm(magnitude).abs();
        let power = exponential(power_logarithm.max(MIN_POWER_LOGARITHM));
        let sum = 1.0 + power;
        let root_logarithm = -inverse_exponent * logarithm(sum);
        let inverse_root = exponential(root_logarithm.max(MIN_POWER_LOGARITHM));
        let is_beyond = magnitude > 1.0;
        let numerator = if is_beyond { 1.0_f64.copysign(ratio) } else { ratio };
        let slope_numerator = if is_beyond { power } else { 1.0 };
        let slope_denominator = if is_beyond { sum * magnitude } else { sum };
        let curved_strain = curvature * (numerator * inverse_root) * strain_range;
        let slope = curvature * (slope_numerator * inverse_root / slope_denominator);
        UniaxialResponse {
            stress: modulus * (b * offset + curved_strain) + reversal[1],
            tangent: modulus * (b + slope),
        }
    }
}

/// Branches and strains of several fibres, as a list of each quantity.
#[derive(Clone, Copy)]
pub(super) struct SteelBranches {
    exponents: [f64; MAX_LOOP_BRANCHES],
    strain_ranges: [f64; MAX_LOOP_BRANCHES],
    reversal_strains: [f64; MAX_LOOP_BRANCHES],
    reversal_stresses: [f64; MAX_LOOP_BRANCHES],
    strains: [f64; MAX_LOOP_BRANCHES],
}

impl SteelBranches {
    /// Branches of fibres without strain, with which loops fill their vectors.
    pub(super) const WITHOUT_STRAIN: Self = Self {
        exponents: [1.0; MAX_LOOP_BRANCHES],
        strain_ranges: [1.0; MAX_LOOP_BRANCHES],
        reversal_strains: [0.0; MAX_LOOP_BRANCHES],
        reversal_stresses: [0.0; MAX_LOOP_BRANCHES],
        strains: [0.0; MAX_LOOP_BRANCHES],
    };

    /// Sets strain and branch of a fibre.
    #[inline]
    pub(super) fn set(&mut self, fiber: usize, strain: f64, branch: SteelBranch) {
        self.exponents[fiber] = branch.exponent;
        self.strain_ranges[fiber] = branch.strain_range;
        self.reversal_strains[fiber] = branch.reversal[0];
        self.reversal_stresses[fiber] = branch.reversal[1];
        self.strains[fiber] = strain;
    }
}

/// Stresses and tangents of several fibres, at most [`MAX_LOOP_BRANCHES`].
pub(super) struct BranchLoops<'a> {
    pub(super) branches: &'a SteelBranches,
    /// E, Pa.
    pub(super) modulus: f64,
    /// b.
    pub(super) hardening_ratio: f64,
    pub(super) responses: &'a mut [UniaxialResponse],
}

impl WithSimd for BranchLoops<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let SteelBranches {
            exponents,
            strain_ranges,
            reversal_strains,
            reversal_stresses,
            strains,
        } = self.branches;
        let mut stresses = [0.0; MAX_LOOP_BRANCHES];
        let mut tangents = [0.0; MAX_LOOP_BRANCHES];
        for k in 0..padded_count(self.responses.len(), MAX_LOOP_BRANCHES) {
            let branch = SteelBranch {
                exponent: exponents[k],
                strain_range: strain_ranges[k],
                reversal: [reversal_strains[k], reversal_stresses[k]],
            };
            let response = branch.response(self.modulus, self.hardening_ratio, strains[k]);
            stresses[k] = response.stress;
            tangents[k] = response.tangent;
        }
        for (k, response) in self.responses.iter_mut().enumerate() {
            *response = UniaxialResponse { stress: stresses[k], tangent: tangents[k] };
        }
    }
}
