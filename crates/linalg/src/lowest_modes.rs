//! Lowest modes K φ = λ M φ of a large sparse structure: shift-invert block Lanczos.
//!
//! | symbol | meaning |
//! |---|---|
//! | K, M | stiffness and mass |
//! | A | K⁻¹ M, symmetric in the inner product x·M y; its largest eigenvalues θ are 1/λ |
//! | V | basis, M-orthonormal, a row per vector |
//! | H | V M A Vᵀ |
//!
//! Every new vector is orthogonalised with respect to all earlier vectors, twice unless a large residual is allowed
//! (Parlett 1998, § 13), which excludes spurious copies of modes. A block finds as many modes of one frequency as it
//! has vectors.

use super::eigen::{Eigenpairs, symmetric_modes};
use super::orthonormal::{MinRemainder, OrthonormalRows};
use super::product::{add_combined_rows, row_products};
use super::sparse::SparseFactor;
use crate::SparseMatrix;

/// Number of vectors of one block: the largest number of equal frequencies in practice.
const VECTORS_PER_BLOCK: usize = 16;

/// Largest residual ‖A x − θ x‖ of a converged mode, relative to θ.
///
/// It is far below errors of a structural model.
const DEFAULT_RESIDUAL_TOLERANCE: f64 = 1e-9;

/// Largest error of V M Vᵀ without a second orthogonalisation, relative to the residual tolerance.
///
/// At [`DEFAULT_RESIDUAL_TOLERANCE`] it is below rounding errors: every vector is orthogonalised twice.
const ORTHOGONALITY_TOLERANCE_FACTOR: f64 = 1e-9;

/// The basis grows by its size over this divisor between two computations of Ritz pairs.
///
/// Each computation costs the cube of the size.
const RITZ_INTERVAL_DIVISOR: usize = 8;

/// Largest size of the basis in a search for modes up to a limit.
///
/// For more modes the caller has a cheaper method.
const MAX_LIMITED_BASIS_SIZE: usize = 800;

/// Fraction of a vector's length that must remain after its orthogonalisation.
///
/// Less is a rounding error.
const DEPENDENCE_TOLERANCE: f64 = 1e-10;

/// Limit at which a search for modes ends.
///
/// It then may have found fewer modes than requested.
#[derive(Debug, Clone, Copy)]
pub struct ModeLimit {
    /// Eigenvalue λ above which the search ends.
    ///
    /// The first eigenvalue above it is the last returned one.
    pub eigenvalue: f64,
    /// Largest residual of a converged mode, relative to θ.
    ///
    /// It may be large if the caller uses only the space that the modes span, because errors of responses in that space
    /// depend on the square of the residual.
    pub residual_tolerance: f64,
}

/// The lowest `count` eigenvalues λ of K φ = λ M φ, ascending, and their eigenvectors.
///
/// With a `limit` the search may end earlier, at the first eigenvalue above that limit.
///
/// Each eigenvector is a row of the returned matrix, with φ·M φ = 1. K is positive definite and passed as its factor; M
/// is positive semi-definite. Fewer pairs are returned if the rank of M is lower. `None` if the iteration fails, or if
/// 800 vectors do not contain all modes below the limit.
pub fn lowest_modes(
    stiffness: &SparseFactor,
    mass: &SparseMatrix,
    count: usize,
    limit: Option<ModeLimit>,
) -> Option<Eigenpairs> {
    let tolerance = limit.map_or(DEFAULT_RESIDUAL_TOLERANCE, |limit| limit.residual_tolerance);
    let max_eigenvalue = limit.map_or(f64::INFINITY, |limit| limit.eigenvalue);
    let basis = OrthonormalRows::new(mass, ORTHOGONALITY_TOLERANCE_FACTOR * tolerance);
    let mut krylov =
        KrylovSpace { stiffness, order: mass.order(), basis, columns: Vec::new(), random_state: 1 };
    let count = count.min(krylov.order);
    let mut next_ritz_size = if max_eigenvalue.is_finite() { 0 } else { count };
    loop {
        // Number of vectors to which A was applied.
        let image_count = krylov.columns.len();
        if image_count == krylov.basis.count() {
            // The iteration begins, or A yields no new vector. In the second case all modes in the basis are exact, but
            // modes are missing if a frequency has more of them than a block has vectors.
            krylov.extend_at_random();
            if image_count == krylov.basis.count() {
                return krylov.modes(&krylov.ritz_pairs(count, max_eigenvalue)?);
            }
        }
        krylov.extend();
        let image_count = krylov.columns.len();
        if image_count >= next_ritz_size {
            let ritz_pairs = krylov.ritz_pairs(count, max_eigenvalue)?;
            let exceeds_limit =
                ritz_pairs.theta.last().is_some_and(|theta| theta * max_eigenvalue < 1.0);
            if (exceeds_limit || image_count >= count) && ritz_pairs.residual <= tolerance {
                return krylov.modes(&ritz_pairs);
            }
            if max_eigenvalue.is_finite() && image_count > MAX_LIMITED_BASIS_SIZE {
                return None;
            }
            next_ritz_size = image_count + image_count / RITZ_INTERVAL_DIVISOR;
        }
    }
}

/// Krylov space of the iteration.
struct KrylovSpace<'a> {
    stiffness: &'a SparseFactor,
    order: usize,
    /// V.
    basis: OrthonormalRows<'a>,
    /// Columns of H, one for each vector to which A was applied.
    ///
    /// Each has a row for each vector that the basis had at that time.
    columns: Vec<Vec<f64>>,
    random_state: u64,
}

impl KrylovSpace<'_> {
    /// Appends a block of random vectors, multiplied by A to remove massless components.
    fn extend_at_random(&mut self) {
        let mut block: Vec<f64> =
            (0..VECTORS_PER_BLOCK * self.order).map(|_| self.random()).collect();
        block = self.basis.mass().times(&block);
        self.stiffness.solve_many(&mut block);
        self.basis.extend(block, MinRemainder::Fraction(DEPENDENCE_TOLERANCE));
    }

    /// Pseudorandom number in [−½, ½) by SplitMix64 (Steele, Lea & Flood 2014).
    fn random(&mut self) -> f64 {
        self.random_state = self.random_state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.random_state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }

    /// Applies A to the newest vectors and appends the independent results to the basis.
    fn extend(&mut self) {
        let mut images = self.basis.momenta()[self.columns.len() * self.order..].to_vec();
        self.stiffness.solve_many(&mut images);
        self.basis.extend(images.clone(), MinRemainder::Fraction(DEPENDENCE_TOLERANCE));
        let products = row_products(&images, self.basis.momenta(), self.order);
        self.columns.extend(products.chunks_exact(self.basis.count()).map(<[f64]>::to_vec));
    }

    /// Ritz pairs: the lowest modes in this space.
    ///
    /// At most `count`; the first one with λ above `max_eigenvalue` is the last.
    fn ritz_pairs(&self, count: usize, max_eigenvalue: f64) -> Option<RitzPairs> {
        let m = self.columns.len();
        // H, with zeros for the rows that a column does not have.
        let entry = |i: usize, j: usize| self.columns[j].get(i).copied().unwrap_or(0.0);
        let index_pairs = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
        // Each column of H has all entries down to the diagonal.
        let matrix: Vec<f64> = index_pairs.map(|(i, j)| entry(i.min(j), i.max(j))).collect();
        let Eigenpairs { values, vectors } = symmetric_modes(&matrix, m)?;
        let max_theta = values.last().copied().unwrap_or(0.0);
        let mut ritz_pairs = RitzPairs { theta: vec![], coordinates: vec![], residual: 0.0 };
        for k in (0..m).rev().take(count) {
            let theta = values[k];
            if !(theta.is_finite() && theta > f64::EPSILON * max_theta) {
                break;
            }
            let y: Vec<f64> = (0..m).map(|i| vectors[i * m + k]).collect();
            let residual_square: f64 = (m..self.basis.count())
                .map(|row| (0..m).map(|j| entry(row, j) * y[j]).sum::<f64>().powi(2))
                .sum();
            let residual = residual_square.sqrt() / theta;
            ritz_pairs.residual = ritz_pairs.residual.max(residual);
            ritz_pairs.theta.push(theta);
            ritz_pairs.coordinates.push(y);
            if theta * max_eigenvalue < 1.0 {
                break;
            }
        }
        Some(ritz_pairs)
    }

    /// λ and φ of Ritz pairs; `None` if they are not finite.
    fn modes(&self, ritz_pairs: &RitzPairs) -> Option<Eigenpairs> {
        let n = self.order;
        let m = self.columns.len();
        let mut modes = vec![0.0; ritz_pairs.theta.len() * n];
        let weights: Vec<f64> =
            (0..m).flat_map(|i| ritz_pairs.coordinates.iter().map(move |y| y[i])).collect();
        add_combined_rows(&weights, &self.basis.vectors()[..m * n], n, 1.0, &mut modes);
        let is_finite = modes.iter().all(|x| x.is_finite());
        let values = ritz_pairs.theta.iter().map(|theta| 1.0 / theta).collect();
        is_finite.then_some(Eigenpairs { values, vectors: modes })
    }
}

/// Ritz pairs: approximate modes from the eigenpairs of H.
struct RitzPairs {
    /// Eigenvalues θ, descending.
    theta: Vec<f64>,
    /// Coordinates of each mode in the basis.
    coordinates: Vec<Vec<f64>>,
    /// Largest ‖A x − θ x‖/θ of the modes.
    residual: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Triplets, largest};

    /// Chains of springs and masses.
    struct Chains {
        stiffness: SparseMatrix,
        mass: SparseMatrix,
        factor: SparseFactor,
    }

    impl Chains {
        /// The lowest `count` eigenvalues, up to the first one above a limit.
        fn lowest_values(&self, count: usize, limit: Option<ModeLimit>) -> Vec<f64> {
            lowest_modes(&self.factor, &self.mass, count, limit).unwrap().values
        }
    }

    /// Equal chains with one fixed end, and massless degrees of freedom.
    ///
    /// Springs have k = 1, and masses m = 1. Each [`exact_eigenvalue`] occurs once for each copy.
    fn chains(length: usize, copies: usize, massless_count: usize) -> Chains {
        let n = length * copies + massless_count;
        let mut stiffness = Triplets::new(n);
        let mut mass = Triplets::new(n);
        for copy in 0..copies {
            for i in 0..length {
                let dof = copy * length + i;
                mass.add(dof, dof, 1.0);
                stiffness.add(dof, dof, 1.0);
                if i > 0 {
                    stiffness.add_spring(dof - 1, dof, 1.0);
                    stiffness.add(dof, dof, -1.0);
                }
            }
        }
        for i in n - massless_count..n {
            stiffness.add(i, i, 2.0);
            stiffness.add_spring(i, 0, 1e-3);
        }
        let stiffness = SparseMatrix::new("test", &stiffness).unwrap();
        Chains {
            factor: SparseFactor::positive_definite("test", &stiffness).unwrap(),
            mass: SparseMatrix::new("test", &mass).unwrap(),
            stiffness,
        }
    }

    /// Eigenvalue λ_j = 4 sin²((2j−1)π/(4n+2)) of a chain of n masses.
    fn exact_eigenvalue(length: usize, j: usize) -> f64 {
        let n = length as f64;
        let angle = (2.0 * j as f64 - 1.0) * std::f64::consts::PI / (4.0 * n + 2.0);
        4.0 * angle.sin().powi(2)
    }

    #[test]
    fn chains_have_all_their_multiple_frequencies() {
        for (length, copies, count) in [(300, 1, 20), (100, 2, 12), (60, 5, 23), (40, 12, 30)] {
            let Chains { stiffness, mass, factor } = chains(length, copies, 0);
            let Eigenpairs { values, vectors: modes } =
                lowest_modes(&factor, &mass, count, None).unwrap();
            assert_eq!(values.len(), count);
            let n = mass.order();
            for (k, value) in values.iter().enumerate() {
                let expected = exact_eigenvalue(length, k / copies + 1);
                assert!((value / expected - 1.0).abs() < 1e-11, "{copies} copies, mode {k}");
                let mode = &modes[k * n..(k + 1) * n];
                let mut residual = vec![0.0; n];
                stiffness.multiply_add(1.0, mode, &mut residual);
                mass.multiply_add(-value, mode, &mut residual);
                let max_residual = largest(&residual);
                assert!(max_residual < 1e-8 * value.max(1e-3), "{max_residual:e}");
                for (other, row) in modes.chunks_exact(n).enumerate() {
                    let product = mass.form(mode, row);
                    assert!((product - f64::from(u8::from(other == k))).abs() < 1e-12);
                }
            }
        }
    }

    /// A search with a limit returns all modes below the limit and one mode above it.
    #[test]
    fn searches_end_above_their_limit() {
        let chains = chains(100, 2, 0);
        for (eigenvalue, count_below) in
            [(0.5 * exact_eigenvalue(100, 1), 0), (1.01 * exact_eigenvalue(100, 7), 14)]
        {
            let limit = ModeLimit { eigenvalue, residual_tolerance: 1e-5 };
            let values = chains.lowest_values(200, Some(limit));
            assert_eq!(values.len(), count_below + 1);
            for (k, value) in values.iter().enumerate() {
                assert!((value / exact_eigenvalue(100, k / 2 + 1) - 1.0).abs() < 1e-9, "mode {k}");
            }
        }
    }

    #[test]
    fn massless_degrees_of_freedom_have_no_mode() {
        let chains = chains(5, 1, 4);
        assert_eq!(chains.lowest_values(9, None).len(), 5);
        assert!(chains.lowest_values(0, None).is_empty());
    }
}
