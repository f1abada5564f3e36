//! Errors of mats in plan.

/// Reasons why the cells of a mat in plan, or what they carry, cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A mat, or a mask, that no cell lies on.
    #[error("mat {mat} has no cell: cells are {} m x {} m (more of them help)", pitch[0], pitch[1])]
    NoCells {
        /// Mat, from 0 in the order of its first face.
        mat: usize,
        /// Sides of a cell, m.
        pitch: [f64; 2],
    },
    /// A face that is no convex polygon.
    #[error("face {face} {reason}")]
    Face {
        /// Face, from 0.
        face: usize,
        /// Fault of the face.
        reason: &'static str,
    },
    /// Faces that the cells do not cover, or that overlap.
    #[error(
        "cells inside the faces have an area of {cells} m2, but the faces one of {faces} m2: they overlap, or are too \
         narrow for cells of {} m x {} m (at most a tenth may be missing)", pitch[0], pitch[1]
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
         share corners)", mats[0], mats[1], pitch[0], pitch[1]
    )]
    TooClose {
        /// The two, from 0 in the order of their first faces.
        mats: [usize; 2],
        /// Sides of a cell, m.
        pitch: [f64; 2],
    },
    /// A top layer so thin, or cells so small beside the mat, that no one would wait for it.
    #[error(
        "a mat of {span} m needs wavenumbers up to {wavenumber:e} 1/m, which would take minutes (a thicker top layer, \
         lower frequencies or fewer cells help)"
    )]
    TooFine {
        /// Diagonal of the mat, m.
        span: f64,
        /// Wavenumber up to which form factors would be tabulated, 1/m.
        wavenumber: f64,
    },
    /// Cells that do not resolve the waves of a frequency.
    #[error(
        "cells of {cell} m are too large for {frequency} Hz: shear waves at the surface are {wavelength} m long there, \
         and at least {needed} cells are needed in one"
    )]
    CoarseCells {
        /// Longer side of a cell, m.
        cell: f64,
        /// Frequency, Hz.
        frequency: f64,
        /// Length of shear waves in the top layer, m.
        wavelength: f64,
        /// Least number of cells in a wavelength.
        needed: f64,
    },
}
