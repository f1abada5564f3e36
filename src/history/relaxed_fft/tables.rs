//! Coefficients over short delays, class by class.

/// Coefficients that are summed directly.
///
/// Index d of a coefficient is the number of steps from the traction to the first step that sees
/// it as history: lag d + 1 of the kernel.
#[derive(Debug, Default)]
pub(crate) struct Tables {
    /// Per class: d = 0 … leaf − 1; the first is zero.
    pub(super) normal: Vec<Vec<f64>>,
    pub(super) tangential: Vec<Vec<f64>>,
    /// Per class: d = 0 … as long as it is not zero and summed directly.
    pub(super) coupling: Vec<Vec<f64>>,
}

impl Tables {
    /// Numbers held.
    pub(super) fn numbers(&self) -> usize {
        [&self.normal, &self.tangential, &self.coupling].into_iter().flatten().map(Vec::len).sum()
    }
}
