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

use super::eigen::symmetric_modes;
use super::orthonormal::{Least, OrthonormalRows};
use super::product::{add_combined_rows, row_products};
use super::sparse::SparseFactor;
use crate::linalg::SparseMatrix;

/// Vectors of a block.
const BLOCK: usize = 16;

/// Largest residual ‖A x − θ x‖ of a converged mode, relative to θ.
const TOLERANCE: f64 = 1e-9;

/// Rounding of the basis, relative to the residual.
const ROUNDING: f64 = 1e-9;

/// The number of vectors grows by one in so many from a search for modes to the next.
const SEARCHES: usize = 8;

/// Largest number of vectors in a search for modes up to a limit.
const VECTORS: usize = 800;

/// A vector counts as dependent if orthogonalisation shortens it to this fraction of its length.
const DEPENDENT: f64 = 1e-10;

/// Eigenvalues and eigenvectors.
type Pairs = (Vec<f64>, Vec<f64>);

/// The lowest `count` eigenvalues λ of K φ = λ M φ, ascending, and their eigenvectors.
///
/// `limit`: an eigenvalue, and a residual relative to θ. The search ends at the first eigenvalue above the limit, which is
/// the last one returned. The residual may be large where the modes span a space: their errors are squared in it.
///
/// Each eigenvector is a row of the matrix returned, with φ·M φ = 1. K is positive definite, given by its
/// factor; M is positive semi-definite. Fewer are returned if the rank of M is lower. `None` if the iteration
/// fails, or so many modes are below `limit` that 800 vectors do not find them.
pub(crate) fn lowest_modes(
    stiffness: &SparseFactor,
    mass: &SparseMatrix,
    count: usize,
    limit: Option<(f64, f64)>,
) -> Option<Pairs> {
    let (limit, tolerance) = limit.unwrap_or((f64::INFINITY, TOLERANCE));
    let basis = OrthonormalRows::new(mass, ROUNDING * tolerance);
    let mut space = Space { stiffness, order: mass.order(), basis, columns: Vec::new(), seed: 1 };
    let count = count.min(space.order);
    let mut next = if limit.is_finite() { 0 } else { count };
    loop {
        let applied = space.columns.len();
        if applied == space.basis.count() {
            // At the beginning, or when A yields no new vector. The modes found are then exact, unless a
            // frequency has more modes than a block has vectors.
            space.extend_at_random();
            if applied == space.basis.count() {
                return space.modes(&space.approximations(count, limit)?);
            }
        }
        space.step();
        let applied = space.columns.len();
        if applied >= next {
            let found = space.approximations(count, limit)?;
            let ends = found.theta.last().is_some_and(|theta| theta * limit < 1.0);
            if (ends || applied >= count) && found.residual <= tolerance {
                return space.modes(&found);
            }
            if limit.is_finite() && applied > VECTORS {
                return None;
            }
            next = applied + applied / SEARCHES;
        }
    }
}

/// The Krylov space built so far.
struct Space<'a> {
    stiffness: &'a SparseFactor,
    order: usize,
    /// V.
    basis: OrthonormalRows<'a>,
    /// Columns of H, for every vector to which A was applied, with the rows known by then.
    columns: Vec<Vec<f64>>,
    seed: u64,
}

impl Space<'_> {
    /// Appends a block of random vectors, multiplied by A to remove their parts without mass.
    fn extend_at_random(&mut self) {
        let mut block: Vec<f64> = (0..BLOCK * self.order).map(|_| self.random()).collect();
        block = self.basis.mass().times(&block);
        self.stiffness.solve_many(&mut block);
        self.basis.extend(block, Least::Fraction(DEPENDENT));
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
        self.basis.extend(images.clone(), Least::Fraction(DEPENDENT));
        let shares = row_products(&images, self.basis.momenta(), self.order);
        self.columns.extend(shares.chunks_exact(self.basis.count()).map(<[f64]>::to_vec));
    }

    /// The best approximations of the lowest `count` modes in this space, up to the first one above `limit`.
    fn approximations(&self, count: usize, limit: f64) -> Option<Approximations> {
        let m = self.columns.len();
        let entry = |i: usize, j: usize| self.columns[j].get(i).copied().unwrap_or(0.0);
        let square = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
        // A column has all rows up to its own.
        let matrix: Vec<f64> = square.map(|(i, j)| entry(i.min(j), i.max(j))).collect();
        let (values, vectors) = symmetric_modes(&matrix, m)?;
        let top = values.last().copied().unwrap_or(0.0);
        let mut found = Approximations { theta: vec![], shares: vec![], residual: 0.0 };
        for k in (0..m).rev().take(count) {
            let theta = values[k];
            if !(theta.is_finite() && theta > f64::EPSILON * top) {
                break;
            }
            let y: Vec<f64> = (0..m).map(|i| vectors[i * m + k]).collect();
            let outside = |row: usize| (0..m).map(|j| entry(row, j) * y[j]).sum::<f64>();
            let square: f64 = (m..self.basis.count()).map(|row| outside(row).powi(2)).sum();
            found.residual = found.residual.max(square.sqrt() / theta);
            found.theta.push(theta);
            found.shares.push(y);
            if theta * limit < 1.0 {
                break;
            }
        }
        Some(found)
    }

    /// λ and φ of the approximations.
    fn modes(&self, found: &Approximations) -> Option<Pairs> {
        let (n, m) = (self.order, self.columns.len());
        let mut modes = vec![0.0; found.theta.len() * n];
        let weights: Vec<f64> =
            (0..m).flat_map(|i| found.shares.iter().map(move |y| y[i])).collect();
        add_combined_rows(&weights, &self.basis.vectors()[..m * n], n, 1.0, &mut modes);
        let finite = modes.iter().all(|x| x.is_finite());
        finite.then(|| (found.theta.iter().map(|theta| 1.0 / theta).collect(), modes))
    }
}

/// Eigenpairs of H.
struct Approximations {
    theta: Vec<f64>,
    /// Coordinates in the basis, one vector for each mode.
    shares: Vec<Vec<f64>>,
    /// Largest ‖A x − θ x‖/θ.
    residual: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{Triplets, largest};

    /// `copies` equal chains of springs k = 1 and masses m = 1, fixed at one end:
    /// λ_j = 4 sin²((2j−1)π/(4n+2)), each `copies` times.
    fn chains(length: usize, copies: usize, massless: usize) -> [SparseMatrix; 2] {
        let n = length * copies + massless;
        let (mut stiffness, mut mass) = (Triplets::new(n), Triplets::new(n));
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
        [stiffness, mass].map(|m| SparseMatrix::new("test", &m).unwrap())
    }

    fn exact(length: usize, j: usize) -> f64 {
        let n = length as f64;
        let angle = (2.0 * j as f64 - 1.0) * std::f64::consts::PI / (4.0 * n + 2.0);
        4.0 * angle.sin().powi(2)
    }

    #[test]
    fn chains_have_their_frequencies_each_as_often_as_it_comes() {
        for (length, copies, count) in [(300, 1, 20), (100, 2, 12), (60, 5, 23), (40, 12, 30)] {
            let [stiffness, mass] = chains(length, copies, 0);
            let factor = SparseFactor::positive_definite("test", &stiffness).unwrap();
            let (values, modes) = lowest_modes(&factor, &mass, count, None).unwrap();
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
        let [stiffness, mass] = chains(100, 2, 0);
        let factor = SparseFactor::positive_definite("test", &stiffness).unwrap();
        for (limit, below) in [(0.5 * exact(100, 1), 0), (1.01 * exact(100, 7), 14)] {
            let (values, _) = lowest_modes(&factor, &mass, 200, Some((limit, 1e-5))).unwrap();
            assert_eq!(values.len(), below + 1);
            for (k, value) in values.iter().enumerate() {
                assert!((value / exact(100, k / 2 + 1) - 1.0).abs() < 1e-9, "mode {k}");
            }
        }
    }

    #[test]
    fn what_has_no_mass_has_no_mode() {
        let [stiffness, mass] = chains(5, 1, 4);
        let factor = SparseFactor::positive_definite("test", &stiffness).unwrap();
        let (values, _) = lowest_modes(&factor, &mass, 9, None).unwrap();
        assert_eq!(values.len(), 5);
        let (none, _) = lowest_modes(&factor, &mass, 0, None).unwrap();
        assert!(none.is_empty());
    }
}
