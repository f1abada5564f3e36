//! Memory of relaxed transforms.

use super::element_grid::takes_wavenumbers;
use super::plan_spectra::waves_in_plan;
use super::ring::LEAF;
use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;

/// Bytes of the blocks for `steps` steps, which grow by powers of two.
pub(crate) fn bytes_of_blocks(kernel: &dyn ConvolutionWeights, steps: usize) -> Result<f64> {
    let length = (steps as f64).max(2.0 * LEAF as f64).log2().ceil().exp2();
    let classes = kernel.classes();
    if let Some((lattice, _)) = classes.plan() {
        let [all, own] = waves_in_plan(lattice).map(|count| count as f64);
        return Ok((96.0 * own + 48.0 * all) * length + 48.0 * LEAF as f64 * (own + 2.0 * all));
    }
    // A coupling that does not end is a third series of coefficients; around a trench there are two.
    let kinds = if couples_without_end(kernel)? { classes.kinds() as f64 } else { 2.0 };
    let (q, classes) = (classes.elements().len() as f64, classes.count() as f64);
    Ok(if takes_wavenumbers(kernel) {
        ((32.0 + 16.0 * kinds) * q + 32.0) * length
    } else {
        (16.0 * kinds * classes + 24.0 * q + 16.0) * length
    })
}

/// Largest power of two of steps whose blocks fit into `memory` bytes; zero if the smallest blocks do not.
pub(super) fn most_steps(kernel: &dyn ConvolutionWeights, memory: f64) -> Result<usize> {
    let mut most = 0;
    for power in LEAF.ilog2() + 1..usize::BITS {
        if bytes_of_blocks(kernel, 1 << power)? > memory {
            break;
        }
        most = 1 << power;
    }
    Ok(most)
}

/// Whether the coupling of the pair farthest apart never ends.
fn couples_without_end(kernel: &dyn ConvolutionWeights) -> Result<bool> {
    let classes = kernel.classes();
    let farthest = classes.pairs().get(classes.elements().len() - 1);
    let class = farthest.map_or(classes.count() - 1, |pair| pair.class);
    Ok(kernel.last_coupling_lag(class)?.is_none())
}
