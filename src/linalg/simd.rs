//! Loops over long slices with the widest vector registers found at run time.

pub(crate) use pulp::{Simd, WithSimd};

/// Runs `loops`, compiled once for each set of instructions, with the best that there is. Its
/// `with_simd` and all that this calls must be `#[inline(always)]`.
#[inline]
pub(crate) fn vectorized<L: WithSimd>(loops: L) -> L::Output {
    pulp::Arch::new().dispatch(loops)
}
