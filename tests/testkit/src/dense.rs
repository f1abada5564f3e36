//! Small dense linear algebra, simple enough to be checked by reading.

use super::random::Random;

/// Rows of a matrix.
pub type DenseMatrix = Vec<Vec<f64>>;

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

pub fn multiply(matrix: &DenseMatrix, vector: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}

/// aᵀ A b.
pub fn form(a: &[f64], matrix: &DenseMatrix, b: &[f64]) -> f64 {
    dot(a, &multiply(matrix, b))
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max, value| value.abs().max(max))
}

/// Rows and columns with these indices.
pub fn submatrix(matrix: &DenseMatrix, indices: &[usize]) -> DenseMatrix {
    indices.iter().map(|&i| indices.iter().map(|&j| matrix[i][j]).collect()).collect()
}

pub fn assert_symmetric(matrix: &DenseMatrix) {
    let scale = matrix.iter().map(|row| largest(row)).fold(0.0, f64::max);
    for i in 0..matrix.len() {
        for j in 0..i {
            assert!((matrix[i][j] - matrix[j][i]).abs() <= 1e-14 * scale, "({i}, {j})");
        }
    }
}

/// Gauss elimination with partial pivoting.
pub fn solve(matrix: &DenseMatrix, load: &[f64]) -> Vec<f64> {
    let n = load.len();
    let mut a: DenseMatrix = matrix.clone();
    let mut x = load.to_vec();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, pivot);
        x.swap(k, pivot);
        let row = a[k].clone();
        for i in k + 1..n {
            let factor = a[i][k] / row[k];
            if factor != 0.0 {
                for j in k..n {
                    a[i][j] -= factor * row[j];
                }
                x[i] -= factor * x[k];
            }
        }
    }
    for k in (0..n).rev() {
        x[k] = (x[k] - dot(&a[k][k + 1..], &x[k + 1..])) / a[k][k];
    }
    x
}

/// Displacements under `load`, with prescribed (degree of freedom, displacement) pairs.
pub fn solve_with_prescribed(
    matrix: &DenseMatrix,
    load: &[f64],
    prescribed: &[(usize, f64)],
) -> Vec<f64> {
    let mut x = vec![0.0; load.len()];
    for &(index, value) in prescribed {
        x[index] = value;
    }
    let free: Vec<usize> = (0..x.len())
        .filter(|index| prescribed.iter().all(|&(dof, _)| dof != *index))
        .collect();
    let reaction = multiply(matrix, &x);
    let free_load: Vec<f64> = free.iter().map(|&index| load[index] - reaction[index]).collect();
    for (&index, value) in free.iter().zip(solve(&submatrix(matrix, &free), &free_load)) {
        x[index] = value;
    }
    x
}

/// Eigenvalues of K x = λ M x, ascending, by Jacobi's method after a Cholesky factorisation of M.
pub fn eigenvalues(stiffness: &DenseMatrix, mass: &DenseMatrix) -> Vec<f64> {
    let n = mass.len();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let remainder = mass[i][j] - dot(&lower[i][..j], &lower[j][..j]);
            lower[i][j] = if i == j { remainder.sqrt() } else { remainder / lower[j][j] };
        }
    }
    let congruent = forward_substituted(&lower, &forward_substituted(&lower, stiffness));
    eigenpairs(&congruent).0
}

/// (L⁻¹ A)ᵀ.
fn forward_substituted(lower: &DenseMatrix, rows: &DenseMatrix) -> DenseMatrix {
    let order = lower.len();
    let mut columns = Vec::with_capacity(order);
    for column in 0..order {
        let mut x: Vec<f64> = Vec::with_capacity(order);
        for i in 0..order {
            let value = (rows[i][column] - dot(&lower[i][..i], &x)) / lower[i][i];
            x.push(value);
        }
        columns.push(x);
    }
    columns
}

/// Eigenvalues of a symmetric matrix, ascending, and their vectors, by Jacobi's method.
pub fn eigenpairs(matrix: &DenseMatrix) -> (Vec<f64>, DenseMatrix) {
    let n = matrix.len();
    let mut a = matrix.clone();
    // Row k becomes the k-th vector.
    let mut vectors: DenseMatrix =
        (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for _ in 0..60 {
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t / t.hypot(1.0);
                for k in 0..n {
                    let x = a[k][p];
                    let y = a[k][q];
                    a[k][p] = c * x - s * y;
                    a[k][q] = s * x + c * y;
                }
                for rows in [&mut a, &mut vectors] {
                    for k in 0..n {
                        let x = rows[p][k];
                        let y = rows[q][k];
                        rows[p][k] = c * x - s * y;
                        rows[q][k] = s * x + c * y;
                    }
                }
            }
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    let values = order.iter().map(|&k| a[k][k]).collect();
    (values, order.into_iter().map(|k| std::mem::take(&mut vectors[k])).collect())
}

/// Numbers between −1 and 1 that are the same in every run.
pub fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    (0..count).map(|_| random.within(-1.0, 1.0)).collect()
}

/// Inverse of a row-major matrix of this order, by Gauss–Jordan elimination with row exchanges.
pub fn inverse(matrix: &[f64], order: usize) -> Vec<f64> {
    let n = order;
    let mut a = matrix.to_vec();
    let mut inverse: Vec<f64> = (0..n * n).map(|i| f64::from(u8::from(i / n == i % n))).collect();
    for k in 0..n {
        let pivot =
            (k..n).max_by(|&i, &j| a[i * n + k].abs().total_cmp(&a[j * n + k].abs())).unwrap();
        for j in 0..n {
            a.swap(k * n + j, pivot * n + j);
            inverse.swap(k * n + j, pivot * n + j);
        }
        let scale = 1.0 / a[k * n + k];
        for j in 0..n {
            a[k * n + j] *= scale;
            inverse[k * n + j] *= scale;
        }
        for i in (0..n).filter(|i| *i != k) {
            let factor = a[i * n + k];
            if factor != 0.0 {
                for j in 0..n {
                    a[i * n + j] -= factor * a[k * n + j];
                    inverse[i * n + j] -= factor * inverse[k * n + j];
                }
            }
        }
    }
    inverse
}

/// ‖SAS‖₁ ‖(SAS)⁻¹‖₁ of a row-major matrix with sᵢ = |aᵢᵢ|^−½.
pub fn condition_by_inverse(matrix: &[f64], n: usize) -> f64 {
    let s: Vec<f64> = (0..n).map(|i| matrix[i * n + i].abs().sqrt()).collect();
    let scaled: Vec<f64> = (0..n * n).map(|k| matrix[k] / (s[k / n] * s[k % n])).collect();
    one_norm(&scaled, n) * one_norm(&inverse(&scaled, n), n)
}

/// Largest column sum of magnitudes of a row-major matrix.
fn one_norm(matrix: &[f64], n: usize) -> f64 {
    (0..n)
        .map(|j| (0..n).map(|i| matrix[i * n + j].abs()).sum::<f64>())
        .fold(0.0, f64::max)
}
