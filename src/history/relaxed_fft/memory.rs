//! Memory of relaxed transforms.

use super::element_grid::uses_wavenumbers;
use super::plan_spectra::waves_in_plan;
use super::ring::LEAF_STEPS;
use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;

/// Bytes of the blocks for `steps` steps; blocks grow by powers of two.
///
/// In the plane the factors are sums over the bytes in the table of [`RelaxedFftHistory`](super::RelaxedFftHistory).
pub(crate) fn bytes_of_blocks(kernel: &dyn ConvolutionWeights, steps: usize) -> Result<f64> {
    let lag_count = (steps as f64).max(2.0 * LEAF_STEPS as f64).log2().ceil().exp2();
    let classes = kernel.classes();
    if let Some((lattice, _)) = classes.plan() {
        let waves = waves_in_plan(lattice);
        let wave_count = waves.count as f64;
        let with_spectra = waves.with_spectra as f64;
        let leaf_bytes = 48.0 * LEAF_STEPS as f64 * (with_spectra + 2.0 * wave_count);
        return Ok((96.0 * with_spectra + 48.0 * wave_count) * lag_count + leaf_bytes);
    }
    // A coupling that does not end is a third series of coefficients; around a trench there are two.
    let kind_count = if couples_without_end(kernel)? { classes.kinds() as f64 } else { 2.0 };
    let element_count = classes.elements().len() as f64;
    Ok(if uses_wavenumbers(kernel) {
        ((32.0 + 16.0 * kind_count) * element_count + 32.0) * lag_count
    } else {
        (16.0 * kind_count * classes.count() as f64 + 24.0 * element_count + 16.0) * lag_count
    })
}

/// Largest number of steps, a power of two, whose blocks fit into `memory` bytes.
///
/// Zero if the smallest blocks do not.
pub(super) fn max_steps(kernel: &dyn ConvolutionWeights, memory: f64) -> Result<usize> {
    let mut max_step_count = 0;
    for power in LEAF_STEPS.ilog2() + 1..usize::BITS {
        if bytes_of_blocks(kernel, 1 << power)? > memory {
            break;
        }
        max_step_count = 1 << power;
    }
    Ok(max_step_count)
}

/// Whether the coupling of the most distant pair never ends.
fn couples_without_end(kernel: &dyn ConvolutionWeights) -> Result<bool> {
    let classes = kernel.classes();
    let farthest = classes.pairs().get(classes.elements().len() - 1);
    let class = farthest.map_or(classes.count() - 1, |pair| pair.class);
    Ok(kernel.last_coupling_lag(class)?.is_none())
}
