//! Linear algebra: the only crate that names faer.
//!
//! All functions run on one thread. A factor is built with the workspace of its solves.
#![forbid(unsafe_code)]
#![allow(
    missing_docs,
    missing_debug_implementations,
    clippy::len_without_is_empty,
    clippy::missing_errors_doc,
    clippy::missing_panics_doc,
    clippy::return_self_not_must_use,
    clippy::should_implement_trait,
    reason = "helpers of basemat, which documents its public items"
)]

#[macro_use]
extern crate basemat_base;

mod block;
mod block_lu;
mod complex;
mod complex_arithmetic;
mod compressed_matrix;
mod condition;
mod dense;
mod dissection;
mod eigen;
mod elimination;
pub mod gauss;
mod gauss_seidel_gmres;
mod hermitian;
mod lanes;
mod lattice_product;
mod lowest_modes;
mod many_vectors;
pub mod matrix;
#[cfg(feature = "io")]
mod matrix_market;
#[cfg(feature = "io")]
mod matrix_market_reader;
mod matrix_scalar;
mod matrix_values;
pub mod orthonormal;
mod partition;
mod pivoted_cholesky;
mod product;
mod sparse;
mod symmetry;
mod triplets;

pub use block::ComplexBlock;
pub use complex::Complex;
pub use complex_arithmetic::ComplexArithmetic;
pub use compressed_matrix::CompressedMatrix;
pub use condition::{condition_by_products, dense_condition, scale_by, sparse_condition};
pub use dense::DenseFactor;
pub use eigen::{Eigenpairs, generalised_modes, indefinite_pivot, symmetric_modes};
pub use elimination::Elimination;
pub use gauss_seidel_gmres::GaussSeidelGmres;
pub use hermitian::hermitian_range;
pub use lanes::Lanes;
pub use lattice_product::{LatticeProduct, LatticeScratch, next_smooth_even};
pub use lowest_modes::{ModeLimit, lowest_modes};
pub use matrix::SparseMatrix;
pub use matrix_scalar::MatrixScalar;
pub use partition::Partition;
pub use pivoted_cholesky::{PivotedCholesky, pivoted_cholesky};
pub use product::{
    Dot, Scalar, Simd, SimdSlice, SimdSliceMut, WithSimd, add_combined_rows, add_row, add_rows,
    dense_multiply_add, dot, largest, magnitude_sum, mixing_sum, row_products, symmetric_products,
    transposed_multiply_add, vectorized, weighted_dot,
};
pub use sparse::{ChangingFactor, SparseFactor, indefinite_row};
pub use triplets::Triplets;

use basemat_base::error;
pub use basemat_base::{Error, Result};
