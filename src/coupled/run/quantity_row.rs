//! Row of the table of quantities.

use super::base_view::BaseView;

/// Row of the table of quantities: names, unit, value, and the summaries that show the quantity.
pub(super) struct QuantityRow {
    /// Word in files and programs, `base_shear`.
    pub(super) word: &'static str,
    /// Name in tables and pictures, `base shear`.
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) scale: Scale,
    pub(super) places: &'static [ShownIn],
    pub(super) value: fn(&BaseView) -> f64,
}

/// Scale for drawing and printing a quantity.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scale {
    /// Scale of the unit in which values are printed.
    Unit,
    /// A ratio, printed in per cent.
    Percent,
    /// A factor of safety, drawn as its inverse, with the label of its limit of one.
    Safety(&'static str),
}

/// Place where a summary of a quantity is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ShownIn {
    /// In every summary, but only on grounds in plan.
    Plan,
    /// Extremes on the page of a run.
    Page,
    /// Largest value, in the page's table of foundations.
    Foundations,
    /// Largest (or smallest) value in a comparison of runs.
    Comparison,
    /// Time of the value, in a comparison of runs.
    ComparisonTime,
}
