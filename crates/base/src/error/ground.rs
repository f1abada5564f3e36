//! Errors of soils, of grounds and of mats in plan.

use crate::error::number_text;

/// Reason why a soil's waves cannot be computed as requested.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SoilError {
    /// A damping law that exists at real frequencies only.
    #[error(
        "{law} damping of layer {layer} is not causal and cannot be used in the time domain (use \
         GeneralizedMaxwell::constant_q with the same ratio over the band of the motion)"
    )]
    NotCausal {
        /// Name of the law.
        law: String,
        /// Layer, from 1 at the surface.
        layer: usize,
    },
    /// A damping law with a modulus that no passive soil has.
    ///
    /// The modulus is not finite, is zero, or generates energy: Re(μ(s)/s) is negative although Re s > 0.
    #[error("{quantity} of layer {layer} is {value:e} at s = {} + {}i 1/s, but must be {needed}", s[0], s[1])]
    Modulus {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Name of the quantity: the modulus, or Re(μ/s)/|μ/s|.
        quantity: &'static str,
        /// Value of this quantity.
        value: f64,
        /// Real and imaginary part of s, 1/s.
        s: [f64; 2],
        /// Requirement on this quantity.
        needed: &'static str,
    },
    /// An inclined wave without a first arrival.
    #[error(
        "wave is beyond the critical angle of layer {layer}: its horizontal slowness is {slowness} s/m, \
         but must be below {limit} s/m, the slowness of the fastest waves in this layer, so that a first arrival \
         exists (transfer functions exist without one)"
    )]
    BeyondCritical {
        /// Layer, from 1 at the surface; the half-plane counts as the last.
        layer: usize,
        /// Horizontal slowness of the wave, absolute, s/m.
        slowness: f64,
        /// Largest slowness: that of pressure waves in the layer, s/m; for SH waves that of shear waves.
        ///
        /// It belongs to the highest frequency of the motion.
        limit: f64,
    },
}

/// Reason why a ground's convolution weights or compliance cannot be computed or used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GroundError {
    /// Bisection does not resolve a wavenumber integral.
    ///
    /// A pole lies on its path, or the stiffnesses of the layers differ by more than double precision resolves.
    #[error(
        "wavenumber integral at s = {re} + {im}i 1/s is not resolved near k = {wavenumber} 1/m \
         (without damping, poles lie on the path at real frequencies: give every layer some damping; \
         or the stiffnesses of the layers differ by more than double precision resolves)"
    )]
    Unresolved {
        /// Re s, 1/s.
        re: f64,
        /// Im s, 1/s.
        im: f64,
        /// Wavenumber at which bisection stopped, 1/m.
        wavenumber: f64,
    },
    /// A time step, top layer or element is too small relative to the contact.
    ///
    /// The wavenumber integrals would take too long.
    #[error(
        "contact of {span:.4} m needs wavenumbers up to {wavenumber:.3e} 1/m, but at most {most:.3e} 1/m, {:.2} times \
         less, are allowed (increase the time step, or lower the frequencies, by this factor; or take a thicker top \
         layer, a shorter contact or fewer elements)", wavenumber / most
    )]
    TooFine {
        /// Length of the contact, or diagonal of the mat, m.
        span: f64,
        /// Upper end of the wavenumber integrals, 1/m.
        wavenumber: f64,
        /// Largest allowed wavenumber, 1/m.
        most: f64,
    },
    /// A guided wave of undamped layers around a trench, near its cut-off frequency.
    #[error(
        "a guided wave of the layers around the trench begins near s = {re} + {im}i 1/s, and the model of the \
         half-plane below does not absorb it (give every layer some damping, for example 0.2 %, or use another \
         frequency)"
    )]
    GuidedWave {
        /// Re s, 1/s.
        re: f64,
        /// Im s, 1/s.
        im: f64,
    },
    /// A boundary equation whose perturbations grow from step to step.
    #[error(
        "the boundary equation is unstable with this time step: {growing_modes} modes grow, the \
         fastest by {growth_per_step:.1e} per step (use a longer time step or another kernel, or allow the growth)"
    )]
    Unstable {
        /// Growth factor per step of the fastest growing mode, minus one.
        growth_per_step: f64,
        /// Number of growing modes.
        growing_modes: usize,
    },
}

/// Reason why a mat in plan cannot be divided into cells, or needs smaller cells.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A mat has no cell.
    ///
    /// No cell lies in its faces, or no entry of its mask is true.
    #[error("mat {mat} has no cell: cells are {} m x {} m (use more cells)", number_text(pitch[0]), number_text(pitch[1]))]
    NoCells {
        /// Number of the mat, from 0 in the order of the mats' first faces.
        mat: usize,
        /// Sides of a cell, m.
        pitch: [f64; 2],
    },
    /// Two faces overlap, so that their common area would count twice.
    #[error(
        "faces {} and {} overlap by {} m2 (give each part of the base once; faces of one mat share corners)",
        faces[0], faces[1], number_text(*area)
    )]
    Overlap {
        /// Numbers of the two faces, from 0.
        faces: [usize; 2],
        /// Area of the overlap, m².
        area: f64,
    },
    /// The faces are too narrow for their cells.
    #[error(
        "cells inside the faces have an area of {} m2, but the faces together have {} m2: the faces are too narrow for \
         cells of {} m x {} m (the areas may differ by at most 1 %)",
        number_text(*cells),
        number_text(*faces),
        number_text(pitch[0]),
        number_text(pitch[1])
    )]
    Uncovered {
        /// Area of the faces, m².
        faces: f64,
        /// Area of the parts of the cells inside the faces, m².
        cells: f64,
        /// Sides of a cell, m.
        pitch: [f64; 2],
    },
    /// Two mats share a cell, or have adjacent cells.
    #[error(
        "mats {} and {} are closer to each other than one cell of {} m x {} m (use more cells; faces of one mat \
         share corners)", mats[0], mats[1], number_text(pitch[0]), number_text(pitch[1])
    )]
    TooClose {
        /// Numbers of the two mats, from 0 in the order of their first faces.
        mats: [usize; 2],
        /// Sides of a cell, m.
        pitch: [f64; 2],
    },
    /// The cells do not resolve the waves of a frequency.
    #[error(
        "cells of {} m are too large for {} Hz: shear waves at the surface are {} m long at this frequency, \
         and at least {needed} cells are needed in one wavelength",
        number_text(*cell),
        number_text(*frequency),
        number_text(*wavelength)
    )]
    CoarseCells {
        /// Longer side of a cell, m.
        cell: f64,
        /// Frequency, Hz.
        frequency: f64,
        /// Length of shear waves in the top layer, m.
        wavelength: f64,
        /// Smallest number of cells in a wavelength.
        needed: f64,
    },
}
