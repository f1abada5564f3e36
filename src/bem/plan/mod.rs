//! Ground under mats in plan, in three dimensions.
//!
//! All mats lie on the cells of one lattice. The compliance of a pair of cells is an integral over the wavenumber. Its
//! integrand is the surface compliance of the [layered ground](super::layered), in the plane of the wave and normal to
//! it, times form factors of the cells. Form factors are means over the direction of the wavenumber.
//!
//! x points to the right, y away from the reader, z up; rotations are right-handed about these axes.
//!
//! | file | contents |
//! |---|---|
//! | unions | contact elements of several cells |
//! | cells, faces, points, boundary | plan: cells on a lattice under faces, discs, masks; the boundary of faces |
//! | outline, region | cells cut at the outline |
//! | under, overhang | plan under the base of a structure, and how far cells extend beyond it |
//! | forms, corner_waves, form_table | form factors, at small and large wavenumbers, and their integrals |
//! | integrals | compliances of cells at a Laplace variable |
//! | kernel | convolution weights by convolution quadrature |
//! | sectors, impedance | rigid mats at one frequency |

mod boundary;
mod cells;
mod corner_waves;
pub(crate) mod faces;
mod form_table;
mod forms;
mod impedance;
mod integrals;
mod kernel;
mod outline;
mod overhang;
pub(crate) mod points;
mod region;
mod sectors;
mod under;
mod unions;

pub use cells::Plan;
pub use impedance::{PlanImpedance, impedances_in_plan};
pub(super) use kernel::{LatticeKernel, passivity_sample, static_compliance};
pub(super) use unions::{STEP_END_SPRING_RATIO, Unions};
