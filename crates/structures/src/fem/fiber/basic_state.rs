//! States of a beam of fibres without its rigid motions.

use super::quadrature::BeamPoint;
use crate::fem::inelastic_force::FiberState;

/// Largest number of sections along a beam.
pub(super) const MAX_SECTIONS: usize = 5;

/// Basic forces, tangent, and deformations of the sections.
#[derive(Debug, Clone, Copy)]
pub(in crate::fem) struct BasicState<const N: usize, const B: usize> {
    pub(in crate::fem) forces: [f64; B],
    /// ∂q/∂v.
    pub(in crate::fem) stiffness: [[f64; B]; B],
    /// Deformations of each section, of which the first are in use.
    pub(super) deformations: [[f64; N]; MAX_SECTIONS],
}

/// Resultants and flexibilities of the sections of a beam by forces, and its stiffness.
#[derive(Debug, Clone, Copy)]
pub(super) struct BeamLinearisation<const N: usize, const B: usize> {
    /// Resultants of each section, of which the first are in use.
    pub(super) forces: [[f64; N]; MAX_SECTIONS],
    /// Inverse tangent of each section.
    pub(super) flexibilities: [[[f64; N]; N]; MAX_SECTIONS],
    /// ∂q/∂v.
    pub(super) stiffness: [[f64; B]; B],
}

impl<const N: usize, const B: usize> BeamLinearisation<N, B> {
    pub(super) fn zero() -> Self {
        Self {
            forces: [[0.0; N]; MAX_SECTIONS],
            flexibilities: [[[0.0; N]; N]; MAX_SECTIONS],
            stiffness: [[0.0; B]; B],
        }
    }
}

/// State of a section along a beam.
pub(in crate::fem) struct SectionState<const N: usize> {
    pub(in crate::fem) point: BeamPoint,
    pub(in crate::fem) deformations: [f64; N],
    pub(in crate::fem) forces: [f64; N],
    pub(in crate::fem) fibers: Vec<FiberState>,
}

/// State of a force-based element at the end of the last step.
pub(super) struct LastState<const N: usize, const B: usize> {
    pub(super) deformations: [[f64; N]; MAX_SECTIONS],
    pub(super) forces: [f64; B],
    pub(super) basic_deformations: [f64; B],
}

impl<const N: usize, const B: usize> BasicState<N, B> {
    pub(super) fn zero() -> Self {
        Self {
            forces: [0.0; B],
            stiffness: [[0.0; B]; B],
            deformations: [[0.0; N]; MAX_SECTIONS],
        }
    }
}
