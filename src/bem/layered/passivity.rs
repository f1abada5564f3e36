//! Check that the convolution weights of a layered ground create no energy.

use basemat_fourier::num_complex::Complex64;

use super::coefficients::Quadrature;
use super::threads::{on_threads, thread_count};
use super::wavenumber::Compliances;
use crate::error::{Error, ProgressReporter, Result};
use crate::history::PairClasses;
use crate::linalg::Complex;
use crate::text::check_sum::CheckSum;

/// Radius of the circle of the passivity check: close to the unit circle, but with a smooth mobility.
pub(crate) const CHECK_RADIUS: f64 = 0.99;
/// Largest number of threads, each of which needs memory for two matrices of all pairs.
const MAX_CHECK_THREADS: usize = 8;

/// Points of the check: ln |z| and angle of `count` points on the upper half of the circle.
pub(crate) fn check_points(count: usize) -> impl Iterator<Item = [f64; 2]> {
    (0..count).map(move |point| {
        let angle = std::f64::consts::PI * (point as f64 + 0.5) / count as f64;
        [CHECK_RADIUS.ln(), angle]
    })
}

/// Fingerprint of the weights, after a check of Herm[(1−z) Ĝ(z)] ≥ 0.
///
/// The check uses [`Compliances::PASSIVITY_POINTS`] points of |z| = 0.99. It allows the tolerance of the quadrature
/// times the number of degrees of freedom, with every pair relative to the mobilities of its elements. Theory guarantees
/// passivity; the check detects errors of the quadrature and damping laws that are not passive. The fingerprint is a hash
/// of all values at these points, of `mesh_numbers` and of all other data on which a weight depends.
pub(crate) fn check<I: Compliances<KINDS>, const KINDS: usize>(
    quadrature: &Quadrature<I, KINDS>,
    classes: &PairClasses,
    mesh_numbers: &[f64],
    progress: &mut ProgressReporter,
) -> Result<u64> {
    let order = classes.layout().len();
    let min_margin = -quadrature.tolerance * order as f64;
    let mut values = vec![[Complex::default(); KINDS]; I::PASSIVITY_POINTS * classes.count()];
    let points = check_points(I::PASSIVITY_POINTS).zip(values.chunks_mut(classes.count()));
    let check_point = |(workspace, compliances): &mut (_, Vec<_>),
                       (log_z, values): ([f64; 2], &mut [_])| {
        compliances.resize(classes.count(), [Complex::default(); KINDS]);
        quadrature.mobility(log_z, workspace, compliances, values)?;
        let real_parts_of = |class: usize| real_parts(&values[class]);
        if classes.exceeds(min_margin, self_mobility(values), |_, pair| real_parts_of(pair.class)) {
            return Ok(());
        }
        let margin = margin(classes, values);
        if margin >= min_margin {
            return Ok(());
        }
        Err(Error::NotPassive {
            quantity: "mobility of the convolution weights",
            margin,
            allowed: min_margin,
            angle: log_z[1],
            radius: CHECK_RADIUS,
        })
    };
    let thread_count = thread_count().min(MAX_CHECK_THREADS);
    on_threads(thread_count, points, check_point, |completed| progress.reach(completed))?;
    let mut fingerprint = CheckSum::default();
    fingerprint.add_number(quadrature.time_step);
    fingerprint.add_number(quadrature.tolerance);
    fingerprint.add_number(quadrature.stages.count() as f64);
    for number in mesh_numbers {
        fingerprint.add_number(*number);
    }
    for value in values.iter().flatten() {
        fingerprint.add_number(value.re);
        fingerprint.add_number(value.im);
    }
    Ok(fingerprint.value())
}

/// Smallest eigenvalue of the Hermitian part of the matrix of all pairs, scaled by the absolute diagonal.
///
/// It is NaN if the matrix is not finite. The matrix is symmetric by Betti's reciprocity, so that its Hermitian part is its
/// real part.
pub(crate) fn margin<const KINDS: usize>(
    classes: &PairClasses,
    values: &[[Complex; KINDS]],
) -> f64 {
    classes.smallest_eigenvalue(self_mobility(values), |_, pair| real_parts(&values[pair.class]))
}

/// Absolute mobility of an element, by class of the pair with itself and component; above zero.
fn self_mobility<const KINDS: usize>(values: &[[Complex; KINDS]]) -> impl Fn(usize, usize) -> f64 {
    |class, component| values[class][component].to_complex64().norm().max(f64::MIN_POSITIVE)
}

/// Real parts of the components.
fn real_parts<const KINDS: usize>(values: &[Complex; KINDS]) -> [f64; KINDS] {
    values.map(|value| value.re)
}

/// Matrix of all pairs (2Q × 2Q, row-major): integrals over receiver and source.
pub(crate) fn assembled<const KINDS: usize>(
    classes: &PairClasses,
    values: &[[Complex; KINDS]],
) -> Vec<Complex64> {
    let mut matrix = vec![Complex64::default(); classes.layout().matrix_len()];
    classes.scatter(&mut matrix, |_, pair| values[pair.class].map(Complex::to_complex64));
    matrix
}

#[cfg(test)]
mod tests;
