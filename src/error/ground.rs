//! Errors of layered grounds, mats in plan and site response.

use super::Error;
use super::requirement::{fault_of_file, short};

/// Reasons why a layered ground cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LayeredError {
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
    /// A damping law that generates energy: Re(μ(s)/s) must not be negative where Re s > 0.
    #[error(
        "damping law of layer {layer} gives energy away: Re(mu(s)/s) is {value:e} of |mu/s| at \
         s = {re} + {im}i 1/s, but must not be negative"
    )]
    ActiveDamping {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Re(μ(s)/s)·|s/μ(s)|.
        value: f64,
        /// Re s, 1/s.
        re: f64,
        /// Im s, 1/s.
        im: f64,
    },
    /// A modulus that is not finite or is zero.
    #[error(
        "shear modulus of layer {layer} is {value} Pa at s = {re} + {im}i 1/s, but must be {needed}"
    )]
    Modulus {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Real part of the modulus, Pa.
        value: f64,
        /// Re s, 1/s.
        re: f64,
        /// Im s, 1/s.
        im: f64,
        /// Condition that the value must meet.
        needed: &'static str,
    },
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
    /// A time step or top layer so small relative to the patch that no computer would finish.
    #[error(
        "the patch of {span} m needs wavenumbers up to {wavenumber:e} 1/m, more than 1e6 of its own (a \
         longer time step, a shorter patch or a thicker top layer helps)"
    )]
    TooFine {
        /// Length of the patch, m.
        span: f64,
        /// Wavenumber up to which C must be integrated, 1/m.
        wavenumber: f64,
    },
    /// Damping that no mechanisms reproduce over the band.
    #[error(
        "no generalised Maxwell body has a damping ratio of {ratio} over the band: the best is {worst} \
         off"
    )]
    Fit {
        /// Requested damping ratio.
        ratio: f64,
        /// Largest deviation in the band, relative.
        worst: f64,
    },
    /// Inclined waves over a rigid base, which transmits none.
    #[error(
        "waves at an angle come from a half-plane below the layers, not from a rigid base \
         (site::SoilColumn takes the motion of a rigid base to the surface)"
    )]
    InclinedOverRigidBase,
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
    /// Convolution weights that could generate energy.
    #[error(
        "convolution weights are not passive: least eigenvalue {margin:e} of the mobility, relative to \
         the largest, at {angle} radians on the circle |z| = {radius}; at least {allowed:e} is needed"
    )]
    NotPassive {
        /// Least eigenvalue of the Hermitian part over its trace.
        margin: f64,
        /// Smallest accepted value.
        allowed: f64,
        /// Angle on the circle, radians per step.
        angle: f64,
        /// Radius of the circle.
        radius: f64,
    },
    /// A file of convolution weights that cannot be used.
    #[error("{file} {reason}")]
    File {
        /// Name of the file.
        file: String,
        /// Fault of the file.
        reason: KernelFileError,
    },
}

/// Fault of a file of convolution weights.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KernelFileError {
    /// The file could not be read.
    #[error("cannot be read: {}", fault_of_file(*.0))]
    Unreadable(std::io::ErrorKind),
    /// The file does not begin like a file of convolution weights; it stays unchanged.
    #[error("is no file of convolution weights, and is not written over")]
    NotAKernel,
    /// The file is shorter or longer than it states.
    #[error("has a wrong length of {found} bytes (delete it to have it made anew)")]
    Length {
        /// Bytes found.
        found: u64,
        /// Bytes needed; `None` if the file does not state them.
        needed: Option<u64>,
    },
    /// The numbers differ from the numbers written.
    #[error("is damaged: its checksum is wrong (delete it to have it made anew)")]
    Damaged,
}

// Mats in plan.

/// Reasons why a mat in plan cannot be divided into cells or computed.
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
    /// A face that is not a convex polygon.
    #[error("face {face} {reason}")]
    Face {
        /// Face, from 0.
        face: usize,
        /// Fault of the face.
        reason: &'static str,
    },
    /// Faces that overlap, or that the cells do not cover.
    #[error(
        "cells inside the faces have an area of {} m2, but the faces one of {} m2: they overlap, or are too narrow for \
         cells of {} m x {} m (at most a tenth may be missing)",
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
    /// The top layer is too thin, or the cells too small, for the weights to be computed in reasonable time.
    #[error(
        "a mat of {span:.4} m needs wavenumbers up to {wavenumber:.3e} 1/m, which would take minutes: up to {most:.3e} 1/m \
         are allowed, {:.2} times less (a time step so many times as long, frequencies so many times lower, a thicker top \
         layer or fewer cells)", wavenumber / most
    )]
    TooFine {
        /// Diagonal of the mat, m.
        span: f64,
        /// Wavenumber up to which form factors would be tabulated, 1/m.
        wavenumber: f64,
        /// Largest wavenumber that is allowed for this number of cells, 1/m.
        most: f64,
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

// Site response.

/// Reasons why a soil profile is invalid, or its strain-compatible properties are not found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SiteError {
    /// A quantity of one layer out of its range.
    #[error("{quantity} of layer {layer} is {}, but must be {needed}", short(*value))]
    Layer {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Name of the quantity.
        quantity: &'static str,
        /// The value that was given.
        value: f64,
        /// Requirement.
        needed: &'static str,
    },
    /// A number of curves that differs from the number of layers.
    #[error("{curves} strain curves were given for {layers} layers: each layer needs its own")]
    Curves {
        /// Strain curves that were given.
        curves: usize,
        /// Layers of the profile.
        layers: usize,
    },
    /// A column of pressure waves.
    #[error("strain curves are those of shear: the column must be one of shear waves")]
    PressureWaves,
}

impl SiteError {
    /// An error of one layer's quantity; layers count from 0.
    pub(crate) fn of_layer(index: usize, error: Error) -> Error {
        match error {
            Error::Input { quantity, value, needed } => {
                Self::Layer { layer: index + 1, quantity, value, needed }.into()
            }
            other => other,
        }
    }
}
