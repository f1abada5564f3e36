//! Passivity check: whether the convolution weights of a layered ground can create energy.

use basemat_fourier::num_complex::Complex64;

use super::coefficients::Quadrature;
use super::threads::{on_threads, thread_count};
use super::wavenumber::Compliances;
use crate::error::{Error, ProgressReporter, Result};
use crate::history::PairClasses;
use crate::linalg::Complex;
use crate::text::check_sum::CheckSum;

/// Radius of the circle on which the mobility is checked.
pub(crate) const CHECK_RADIUS: f64 = 0.99;
/// Largest number of threads: each needs memory for two matrices of all pairs.
const MAX_CHECK_THREADS: usize = 8;

/// ln |z| and angle of `count` points on the upper half of the circle.
pub(crate) fn places(count: usize) -> impl Iterator<Item = [f64; 2]> {
    (0..count).map(move |point| {
        let angle = std::f64::consts::PI * (point as f64 + 0.5) / count as f64;
        [CHECK_RADIUS.ln(), angle]
    })
}

/// Fingerprint of the weights, after a check of Herm[(1−z) Ĝ(z)] ≥ 0.
///
/// The check uses [`Compliances::PASSIVITY_POINTS`] points of |z| = 0.99. It allows the tolerance of the quadrature
/// times the number of degrees of freedom, with every pair relative to the mobilities of its elements. The theorem
/// guarantees passivity; the check finds errors of the quadrature and damping laws that are not passive. The
/// fingerprint is a hash of all values at these points, of the `mesh` and of all other data on which a weight depends.
pub(crate) fn check<I: Compliances<KINDS>, const KINDS: usize>(
    quadrature: &Quadrature<I, KINDS>,
    classes: &PairClasses,
    mesh: &[f64],
    watch: &mut ProgressReporter,
) -> Result<u64> {
    let order = classes.layout().len();
    let allowed = -quadrature.tolerance * order as f64;
    let mut values = vec![[Complex::default(); KINDS]; I::PASSIVITY_POINTS * classes.count()];
    let points = places(I::PASSIVITY_POINTS).zip(values.chunks_mut(classes.count()));
    let check_point = |(work, scratch): &mut (_, Vec<_>), (place, values): ([f64; 2], &mut [_])| {
        scratch.resize(classes.count(), [Complex::default(); KINDS]);
        quadrature.mobility(place, work, scratch, values)?;
        if classes.exceeds(allowed, self_mobility(values), |_, pair| real(&values[pair.class])) {
            return Ok(());
        }
        let margin = margin(classes, values);
        if margin >= allowed {
            return Ok(());
        }
        let quantity = "mobility of the convolution weights";
        Err(Error::NotPassive { quantity, margin, allowed, angle: place[1], radius: CHECK_RADIUS })
    };
    on_threads(thread_count().min(MAX_CHECK_THREADS), points, check_point, |done| {
        watch.reach(done)
    })?;
    let mut fingerprint = CheckSum::default();
    fingerprint.add_number(quadrature.time_step);
    fingerprint.add_number(quadrature.tolerance);
    fingerprint.add_number(quadrature.stages.count() as f64);
    for number in mesh {
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
/// NaN if the matrix is not finite. By Betti's reciprocity the matrix is symmetric, so its Hermitian part is
/// its real part.
pub(crate) fn margin<const KINDS: usize>(
    classes: &PairClasses,
    values: &[[Complex; KINDS]],
) -> f64 {
    classes.smallest_eigenvalue(self_mobility(values), |_, pair| real(&values[pair.class]))
}

/// Absolute mobility of a class and component, above zero; for pairs of elements with themselves.
fn self_mobility<const KINDS: usize>(values: &[[Complex; KINDS]]) -> impl Fn(usize, usize) -> f64 {
    |class, component| values[class][component].inner().norm().max(f64::MIN_POSITIVE)
}

fn real<const KINDS: usize>(values: &[Complex; KINDS]) -> [f64; KINDS] {
    values.map(|value| value.re)
}

/// Matrix of all pairs in work form (2Q × 2Q, row-major): integrals over receiver and source.
pub(crate) fn assembled<const KINDS: usize>(
    classes: &PairClasses,
    values: &[[Complex; KINDS]],
) -> Vec<Complex64> {
    let mut matrix = vec![Complex64::default(); classes.layout().square()];
    classes.scatter(&mut matrix, |_, pair| values[pair.class].map(Complex::inner));
    matrix
}

#[cfg(test)]
mod tests;
