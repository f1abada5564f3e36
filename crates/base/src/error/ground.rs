//! Errors of soils, of grounds and of mats in plan.

use crate::error::short;

/// Why waves do not travel through a soil as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SoilError {
    /// A damping law that exists at real frequencies only.
    #[error(
        "{law} damping of layer {layer} is not causal and cannot march in time (use \
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
    /// It is not finite, zero, or generates energy: Re(μ(s)/s) is negative although Re s > 0.
    #[error("{quantity} of layer {layer} is {value:e} at s = {} + {}i 1/s, but must be {needed}", s[0], s[1])]
    Modulus {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Name of the quantity: the modulus, or Re(μ/s)/|μ/s|.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// Real and imaginary part of s, 1/s.
        s: [f64; 2],
        /// Requirement.
        needed: &'static str,
    },
    /// An inclined wave without a first arrival.
    #[error(
        "wave is beyond the critical angle of layer {layer}: its horizontal slowness is {slowness} s/m, \
         but must be below {limit} s/m, that of its fastest waves there, to begin in time (its transfer \
         functions exist)"
    )]
    BeyondCritical {
        /// Layer, from 1 at the surface; the half-plane counts as the last.
        layer: usize,
        /// Horizontal slowness of the wave, absolute, s/m.
        slowness: f64,
        /// Slowness of pressure waves (SH: shear waves) in the layer at the highest frequency of the motion, s/m.
        limit: f64,
    },
}

/// Why the weights or the compliance of a ground cannot be computed or used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GroundError {
    /// A wavenumber integral that bisection does not resolve: a pole lies on the path.
    #[error(
        "wavenumber integral at s = {re} + {im}i 1/s is not resolved near k = {wavenumber} 1/m \
         (without damping the real frequency axis has poles on the path: give every layer some; \
         stiffnesses may also differ by more than double precision carries)"
    )]
    Unresolved {
        /// Re s, 1/s.
        re: f64,
        /// Im s, 1/s.
        im: f64,
        /// Wavenumber at which bisection stopped, 1/m.
        wavenumber: f64,
    },
    /// A time step, top layer or element too small relative to the contact: integrals would take too long.
    #[error(
        "contact of {span:.4} m needs wavenumbers up to {wavenumber:.3e} 1/m, but at most {most:.3e} 1/m, {:.2} times \
         less, are allowed (increase the time step, or lower the frequencies, by this factor; or take a thicker top \
         layer, a shorter contact or fewer elements)", wavenumber / most
    )]
    TooFine {
        /// Length of the contact, or diagonal of the mat, m.
        span: f64,
        /// Wavenumber up to which integrals would be computed, 1/m.
        wavenumber: f64,
        /// Largest wavenumber that is allowed, 1/m.
        most: f64,
    },
    /// A guided wave of undamped layers around a trench, near its cut-off frequency.
    #[error(
        "a guided wave of the layers around the trench begins near s = {re} + {im}i 1/s, and the model of the \
         half-plane below does not absorb it (give every layer some damping: 0.2 % are enough; another frequency \
         may also do)"
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
         fastest by {growth_per_step:.1e} per step (take a longer step or another kernel, or allow it)"
    )]
    Unstable {
        /// Factor minus one by which the fastest mode grows in a step.
        growth_per_step: f64,
        /// Number of growing modes.
        growing_modes: usize,
    },
}

/// Why a mat in plan cannot be divided into cells, or its cells are too large.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A mat or a mask without a cell.
    #[error("mat {mat} has no cell: cells are {} m x {} m (more of them help)", short(pitch[0]), short(pitch[1]))]
    NoCells {
        /// Mat, from 0 in the order of its first face.
        mat: usize,
        /// Sides of a cell, m.
        pitch: [f64; 2],
    },
    /// Two faces that overlap, so that a part of the base would touch the ground twice.
    #[error(
        "faces {} and {} overlap by {} m2 (give each part of the base once; faces of one mat share corners)",
        faces[0], faces[1], short(*area)
    )]
    Overlap {
        /// Numbers of the two faces.
        faces: [usize; 2],
        /// Area that they share, m².
        area: f64,
    },
    /// Faces too narrow for their cells.
    #[error(
        "cells inside the faces have an area of {} m2, but the faces together one of {} m2: the faces are too narrow for \
         cells of {} m x {} m (at most 1 % may differ)",
        short(*cells),
        short(*faces),
        short(pitch[0]),
        short(pitch[1])
    )]
    Uncovered {
        /// Area of the faces, m².
        faces: f64,
        /// Area of the cells that is inside the outline, m².
        cells: f64,
        /// Sides of a cell, m.
        pitch: [f64; 2],
    },
    /// Mats that share a cell, or have cells side by side.
    #[error(
        "mats {} and {} are closer to each other than one cell of {} m x {} m (more cells help; faces of one mat \
         share corners)", mats[0], mats[1], short(pitch[0]), short(pitch[1])
    )]
    TooClose {
        /// Numbers of the two mats, from 0 in the order of their first faces.
        mats: [usize; 2],
        /// Sides of a cell, m.
        pitch: [f64; 2],
    },
    /// Cells that do not resolve the waves of a frequency.
    #[error(
        "cells of {} m are too large for {} Hz: shear waves at the surface are {} m long there, \
         and at least {needed} cells are needed in one",
        short(*cell),
        short(*frequency),
        short(*wavelength)
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
