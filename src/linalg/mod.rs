//! Linear algebra: the only module that names faer.
//!
//! Everything runs sequentially. A factor allocates the workspace of its solves when it is made.

#[cfg(feature = "embedded")]
mod block;
mod complex;
mod condition;
mod dense;
mod dissection;
mod eigen;
mod elimination;
pub(crate) mod gauss;
mod hermitian;
mod lanes;
mod lattice_product;
mod lowest_modes;
mod many_vectors;
pub(crate) mod matrix;
mod number;
pub(crate) mod orthonormal;
mod partition;
mod pivoted_cholesky;
mod product;
mod sparse;
mod symmetry;
mod thinned;
mod triplets;

#[cfg(feature = "embedded")]
pub(crate) use block::ComplexBlock;
pub use complex::Complex;
pub(crate) use condition::{condition_by_products, dense_condition, scale_by, sparse_condition};
pub(crate) use dense::DenseFactor;
pub(crate) use eigen::{generalised_modes, indefinite_pivot, symmetric_modes};
pub(crate) use elimination::Elimination;
pub(crate) use faer::traits::ComplexField;
pub(crate) use hermitian::hermitian_range;
pub(crate) use lanes::Lanes;
pub(crate) use lattice_product::{LatticeProduct, LatticeScratch, next_smooth_even};
pub(crate) use lowest_modes::lowest_modes;
pub(crate) use matrix::SparseMatrix;
pub(crate) use number::ComplexArithmetic;
pub(crate) use partition::Partition;
pub(crate) use pivoted_cholesky::pivoted_cholesky;
pub(crate) use product::{
    Dot, Scalar, Simd, SimdSlice, SimdSliceMut, WithSimd, add_combined_rows, add_row, add_rows,
    dense_multiply_add, dot, largest, magnitude, mixed, row_products, symmetric_products,
    transposed_multiply_add, vectorized, weighted_dot,
};
pub(crate) use sparse::{SparseFactor, indefinite_row};
pub(crate) use thinned::CompressedMatrix;
pub use triplets::Triplets;
