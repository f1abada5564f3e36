//! Lowest modes of a large sparse structure: shift-invert block Lanczos.
//!
//! | symbol | meaning |
//! |---|---|
//! | A | K⁻¹ M, symmetric in the inner product x·M y; its largest eigenvalues θ are 1/λ |
//! | V | basis, M-orthonormal, a row per vector |
//! | H | Vᵀ M A V |
//!
//! Every new vector is made orthogonal to all earlier ones, twice unless the residual may be large (Parlett 1998,
//! § 13), which excludes spurious copies of modes. A block finds as many modes of one frequency as it has vectors.

use super::eigen::{Eigenpairs, symmetric_modes};
use super::orthonormal::{MinRemainder, OrthonormalRows};
use super::product::{add_combined_rows, row_products};
use super::sparse::SparseFactor;
use crate::SparseMatrix;

/// Vectors of one block of the iteration.
const VECTORS_PER_BLOCK: usize = 16;

/// Largest residual ‖A x − θ x‖ of a converged mode, relative to θ.
const DEFAULT_RESIDUAL_TOLERANCE: f64 = 1e-9;

/// Largest error of the basis' orthonormality, relative to the residual's tolerance.
const BASIS_ROUNDING_FACTOR: f64 = 1e-9;

/// The basis grows by its size over this divisor between two searches for modes.
const SEARCH_INTERVAL_DIVISOR: usize = 8;

/// Largest size of the basis in a search for modes up to a limit.
const MAX_LIMITED_BASIS_SIZE: usize = 800;

/// A vector counts as dependent if orthogonalisation shortens it to this fraction of its length.
const DEPENDENCE_TOLERANCE: f64 = 1e-10;

/// The lowest `count` eigenvalues λ of K φ = λ M φ, ascending, and their eigenvectors.
///
/// `limit`: an eigenvalue, and the residual's tolerance relative to θ. The search ends at the first eigenvalue above
/// the limit, which is the last one returned. The tolerance may be loose if the caller uses only the space that the
/// modes span: errors of the modes enter it squared.
///
/// Each eigenvector is a row of the matrix returned, with φ·M φ = 1. K is positive definite, given by its
/// factor; M is positive semi-definite. Fewer pairs are returned if the rank of M is lower. `None` if the
/// iteration fails, or 800 vectors do not find all modes below `limit`.
pub fn lowest_modes(
    stiffness: &SparseFactor,
    mass: &SparseMatrix,
    count: usize,
    limit: Option<(f64, f64)>,
) -> Option<Eigenpairs> {
    let tolerance = limit.map_or(DEFAULT_RESIDUAL_TOLERANCE, |(_, tolerance)| tolerance);
    let limit = limit.map_or(f64::INFINITY, |(eigenvalue, _)| eigenvalue);
    let basis = OrthonormalRows::new(mass, BASIS_ROUNDING_FACTOR * tolerance);
    let mut krylov =
        KrylovSpace { stiffness, order: mass.order(), basis, columns: Vec::new(), seed: 1 };
    let count = count.min(krylov.order);
    let mut next_search_size = if limit.is_finite() { 0 } else { count };
    loop {
        let applied = krylov.columns.len();
        if applied == krylov.basis.count() {
            // The iteration begins, or A yields no new vector. In the second case the modes found are exact,
            // unless a frequency has more modes than a block has vectors.
            krylov.extend_at_random();
            if applied == krylov.basis.count() {
                return krylov.modes(&krylov.approximations(count, limit)?);
            }
        }
        krylov.step();
        let applied = krylov.columns.len();
        if applied >= next_search_size {
            let approximations = krylov.approximations(count, limit)?;
            let exceeds_limit =
                approximations.theta.last().is_some_and(|theta| theta * limit < 1.0);
            if (exceeds_limit || applied >= count) && approximations.residual <= tolerance {
                return krylov.modes(&approximations);
            }
            if limit.is_finite() && applied > MAX_LIMITED_BASIS_SIZE {
                return None;
            }
            next_search_size = applied + applied / SEARCH_INTERVAL_DIVISOR;
        }
    }
}

/// Krylov space of the blocks applied so far.
struct KrylovSpace<'a> {
    stiffness: &'a SparseFactor,
    order: usize,
    /// V.
    basis: OrthonormalRows<'a>,
    /// Columns of H, one for each vector to which A was applied, with the rows computed by then.
    columns: Vec<Vec<f64>>,
    seed: u64,
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

    /// SplitMix64 (Steele, Lea & Flood 2014), in [−½, ½).
    fn random(&mut self) -> f64 {
        self.seed = self.seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }

    /// Applies A to the newest vectors and appends the independent results to the basis.
    fn step(&mut self) {
        let mut images = self.basis.momenta()[self.columns.len() * self.order..].to_vec();
        self.stiffness.solve_many(&mut images);
        self.basis.extend(images.clone(), MinRemainder::Fraction(DEPENDENCE_TOLERANCE));
        let products = row_products(&images, self.basis.momenta(), self.order);
        self.columns.extend(products.chunks_exact(self.basis.count()).map(<[f64]>::to_vec));
    }

    /// Approximations of the lowest `count` modes in this space.
    ///
    /// They end with the first one above `limit`.
    fn approximations(&self, count: usize, limit: f64) -> Option<Approximations> {
        let m = self.columns.len();
        let entry = |i: usize, j: usize| self.columns[j].get(i).copied().unwrap_or(0.0);
        let places = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
        // Each column has all entries down to the diagonal.
        let matrix: Vec<f64> = places.map(|(i, j)| entry(i.min(j), i.max(j))).collect();
        let Eigenpairs { values, vectors } = symmetric_modes(&matrix, m)?;
        let largest = values.last().copied().unwrap_or(0.0);
        let mut found = Approximations { theta: vec![], coordinates: vec![], residual: 0.0 };
        for k in (0..m).rev().take(count) {
            let theta = values[k];
            if !(theta.is_finite() && theta > f64::EPSILON * largest) {
                break;
            }
            let y: Vec<f64> = (0..m).map(|i| vectors[i * m + k]).collect();
            let residual_square: f64 = (m..self.basis.count())
                .map(|row| (0..m).map(|j| entry(row, j) * y[j]).sum::<f64>().powi(2))
                .sum();
            found.residual = found.residual.max(residual_square.sqrt() / theta);
            found.theta.push(theta);
            found.coordinates.push(y);
            if theta * limit < 1.0 {
                break;
            }
        }
        Some(found)
    }

    /// λ and φ of the approximations.
    fn modes(&self, found: &Approximations) -> Option<Eigenpairs> {
        let n = self.order;
        let m = self.columns.len();
        let mut modes = vec![0.0; found.theta.len() * n];
        let weights: Vec<f64> =
            (0..m).flat_map(|i| found.coordinates.iter().map(move |y| y[i])).collect();
        add_combined_rows(&weights, &self.basis.vectors()[..m * n], n, 1.0, &mut modes);
        let finite = modes.iter().all(|x| x.is_finite());
        let values = found.theta.iter().map(|theta| 1.0 / theta).collect();
        finite.then_some(Eigenpairs { values, vectors: modes })
    }
}

/// Eigenpairs of H.
struct Approximations {
    theta: Vec<f64>,
    /// Coordinates in the basis, one vector for each mode.
    coordinates: Vec<Vec<f64>>,
    /// Largest ‖A x − θ x‖/θ.
    residual: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Triplets, largest};

    struct Chains {
        stiffness: SparseMatrix,
        mass: SparseMatrix,
        factor: SparseFactor,
    }

    impl Chains {
        /// The lowest `count` eigenvalues, up to the first one above a limit.
        fn lowest_values(&self, count: usize, limit: Option<(f64, f64)>) -> Vec<f64> {
            lowest_modes(&self.factor, &self.mass, count, limit).unwrap().values
        }
    }

    /// `copies` equal chains of springs k = 1 and masses m = 1, fixed at one end:
    /// λ_j = 4 sin²((2j−1)π/(4n+2)), each `copies` times.
    fn chains(length: usize, copies: usize, massless: usize) -> Chains {
        let n = length * copies + massless;
        let mut stiffness = Triplets::new(n);
        let mut mass = Triplets::new(n);
        for copy in 0..copies {
            for i in 0..length {
                let at = copy * length + i;
                mass.add(at, at, 1.0);
                stiffness.add(at, at, 1.0);
                if i > 0 {
                    stiffness.add_spring(at - 1, at, 1.0);
                    stiffness.add(at, at, -1.0);
                }
            }
        }
        for i in n - massless..n {
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

    fn exact(length: usize, j: usize) -> f64 {
        let n = length as f64;
        let angle = (2.0 * j as f64 - 1.0) * std::f64::consts::PI / (4.0 * n + 2.0);
        4.0 * angle.sin().powi(2)
    }

    #[test]
    fn chains_have_their_frequencies_each_as_often_as_it_comes() {
        for (length, copies, count) in [(300, 1, 20), (100, 2, 12), (60, 5, 23), (40, 12, 30)] {
            let Chains { stiffness, mass, factor } = chains(length, copies, 0);
            let Eigenpairs { values, vectors: modes } =
                lowest_modes(&factor, &mass, count, None).unwrap();
            assert_eq!(values.len(), count);
            let n = mass.order();
            for (k, value) in values.iter().enumerate() {
                let expected = exact(length, k / copies + 1);
                assert!((value / expected - 1.0).abs() < 1e-11, "{copies} copies, mode {k}");
                let mode = &modes[k * n..(k + 1) * n];
                let mut force = vec![0.0; n];
                stiffness.multiply_add(1.0, mode, &mut force);
                mass.multiply_add(-value, mode, &mut force);
                assert!(largest(&force) < 1e-8 * value.max(1e-3), "{:e}", largest(&force));
                for (other, row) in modes.chunks_exact(n).enumerate() {
                    let product = mass.form(mode, row);
                    assert!((product - f64::from(u8::from(other == k))).abs() < 1e-12);
                }
            }
        }
    }

    /// With a limit, all modes below it and one above.
    #[test]
    fn a_limit_ends_the_search() {
        let chains = chains(100, 2, 0);
        for (limit, below) in [(0.5 * exact(100, 1), 0), (1.01 * exact(100, 7), 14)] {
            let values = chains.lowest_values(200, Some((limit, 1e-5)));
            assert_eq!(values.len(), below + 1);
            for (k, value) in values.iter().enumerate() {
                assert!((value / exact(100, k / 2 + 1) - 1.0).abs() < 1e-9, "mode {k}");
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
