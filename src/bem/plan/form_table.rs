//! Form factors of a lattice on panels of wavenumbers, and their integrals beyond the last panel.
//!
//! The phase of the forms changes by at most 16 radians over a panel, which 16 Gauss points resolve. The table reaches up
//! to the largest K in use, where K is the end of the numerical integrals at a Laplace variable. On the first panels forms
//! are sums over directions, on all others [waves from corners](super::corner_waves). The time for a table is then
//! proportional to its end K*. Beyond K only the top layer contributes to the surface compliance, a power series in q₂/k².
//! All integrals beyond K follow from
//!
//! `T_j`(K) = ∫_K^∞ k^(−2j) g dk.
//!
//! These integrals are sums over the same Gauss points with a factor that decreases to zero towards K*. The removed part
//! follows from two facts: ∫₀^∞ g dk has a closed form, and beyond K* the mean of g is a power k⁻³.

use std::sync::OnceLock;

use super::corner_waves::{CornerWaves, WaveBuffers};
use super::forms::{AngularMeans, FORM_COUNT, integrals};
use crate::bem::layered::{
    LEGENDRE_DEGREES, PANEL_POINTS, legendre, on_threads, rounded_panel_count, thread_count,
};
use crate::error::{GroundError, ProgressReporter, Result, memory};
use crate::geometry::Lattice;
use crate::linalg::add_combined_rows;
use crate::linalg::gauss::Rule;

/// Number of terms of the series beyond K, with the static term.
///
/// At the smallest K the first neglected term is at most 2e-11 of the static term for Poisson's ratios from 0 on, and 1e-8
/// for -0.9.
pub(super) const TAIL_TERMS: usize = 16;
/// Smallest K relative to |√q₂|, for a fast decay of the series.
const MIN_K_PER_ROOT: f64 = 2.5;
/// Largest change of a form's phase over a panel, rad, which 16 Gauss points resolve to rounding.
const PANEL_PHASE: f64 = 16.0;
/// Smallest product of K and the shorter side of a cell, beyond which static forms are small.
const MIN_K_TIMES_SIDE: f64 = 8.0;
/// Product of K* and the shorter side of a cell for |√q₂| = 2/side, with which the error beyond K* is small.
const TABLE_END_TIMES_SIDE: f64 = 64.0;
/// Smallest ratio of K* to |√q₂|, for a fast decay of the series beyond K*.
const MIN_END_PER_ROOT: f64 = 4.0;
/// Smallest ratio of K* to the largest K, so that sums beyond K have panels over which to decrease to zero.
const MIN_END_PER_K: f64 = 1.2;
/// Number of panels whose forms are computed in parallel before they are summed; it limits the memory.
const PANEL_BATCH_SIZE: usize = 32;
/// Smallest number of panels on which forms are sums over directions, which are faster there than waves from corners.
const DIRECT_PANEL_COUNT: usize = 64;
/// Largest number of operations for a table and its compliances, which take a minute or two.
const MAX_OPERATIONS: f64 = 3e11;
/// Number of operations for the waves of a corner at one wavenumber, with the compliances of some 500 Laplace variables.
const OPERATIONS_PER_WAVE: f64 = 2e3;
/// Number of cells whose forms need as much time as the surface compliance.
const CELLS_PER_SURFACE_COMPLIANCE: f64 = 80.0;
/// Number of Gauss points for Legendre coefficients of the forms, eight more than coefficients, so that these are precise.
const LEGENDRE_POINT_COUNT: usize = LEGENDRE_DEGREES + 8;

/// Rows of forms: form by form, row by row, all classes.
#[derive(Debug)]
pub(super) struct FormRows {
    forms: [Vec<f64>; FORM_COUNT],
    class_count: usize,
}

impl FormRows {
    /// Creates rows of zeros.
    fn new(row_count: usize, class_count: usize) -> Self {
        let forms = [(); FORM_COUNT].map(|()| vec![0.0; row_count * class_count]);
        Self { forms, class_count }
    }

    /// Overwrites a row with values, form by form, all classes.
    fn set(&mut self, row: usize, values: &[f64]) {
        let range = row * self.class_count..(row + 1) * self.class_count;
        for (form, form_values) in self.forms.iter_mut().zip(values.chunks_exact(self.class_count))
        {
            form[range.clone()].copy_from_slice(form_values);
        }
    }

    /// Adds factor × values to a row.
    fn add_scaled(&mut self, row: usize, factor: f64, values: &[f64]) {
        let range = row * self.class_count..(row + 1) * self.class_count;
        for (form, form_values) in self.forms.iter_mut().zip(values.chunks_exact(self.class_count))
        {
            for (sum, value) in form[range.clone()].iter_mut().zip(form_values) {
                *sum += factor * value;
            }
        }
    }

    /// Adds combinations Σ weight × row of one form to `sums`.
    ///
    /// `weights`: one row for each of the first rows, one column for each sum.
    pub(super) fn combine(&self, form: usize, weights: &[f64], sums: &mut [f64]) {
        let row_count = weights.len() * self.class_count / sums.len();
        let rows = &self.forms[form][..row_count * self.class_count];
        add_combined_rows(weights, rows, self.class_count, 1.0, sums);
    }
}

/// Forms and their integrals beyond K.
#[derive(Debug)]
struct TabulatedForms {
    /// Forms at the Gauss points, panel by panel.
    values: FormRows,
    /// For each number of panels up to K: rows j of ∫ (k/κ)^(−2j) g dk, from K on for j > 0 and from zero on for j = 0.
    tails: Vec<(usize, FormRows)>,
}

/// Table of the forms of a lattice, for integrals over the wavenumber.
#[derive(Debug)]
pub(super) struct FormTable {
    lattice: Lattice,
    pub(super) class_count: usize,
    /// Width of a panel, 1/m.
    pub(super) panel_width: f64,
    pub(super) rule: Rule,
    /// Legendre polynomials at the Gauss points.
    pub(super) polynomials: Vec<[f64; LEGENDRE_DEGREES]>,
    tabulated_forms: OnceLock<TabulatedForms>,
    /// Legendre coefficients of a panel.
    legendre: Vec<OnceLock<FormRows>>,
    /// Smallest K at which the bottom of the top layer does not affect the surface, 1/m.
    top_layer_wavenumber: f64,
    /// Number of panels up to K*.
    pub(super) panel_count: usize,
    /// Number of the first panels, on which forms are sums over directions.
    pub(super) direct_panel_count: usize,
    /// Forms on the other panels.
    waves: CornerWaves,
}

/// Buffers of a thread for forms at points of a panel.
struct PanelForms<'a> {
    table: &'a FormTable,
    means: AngularMeans,
    wavenumbers: Vec<f64>,
    waves: WaveBuffers,
}

impl<'a> PanelForms<'a> {
    fn new(table: &'a FormTable) -> Self {
        let means = AngularMeans::new(&table.lattice);
        Self { table, means, wavenumbers: vec![], waves: WaveBuffers::default() }
    }

    /// Forms at `nodes` in −1 … 1 of a panel: node by node, form by form, all classes.
    fn forms(&mut self, panel: usize, nodes: &[f64]) -> &[f64] {
        let Self { table, means, wavenumbers, waves } = self;
        wavenumbers.clear();
        wavenumbers.extend(nodes.iter().map(|x| table.wavenumber(panel, *x)));
        if panel < table.direct_panel_count {
            waves.values.clear();
            for k in wavenumbers {
                waves.values.extend_from_slice(means.at(*k));
            }
        } else {
            table.waves.fill_forms(wavenumbers, waves);
        }
        &waves.values
    }
}

impl FormTable {
    /// Empty table for `lattice` and Laplace variables with |√q₂| up to `max_root` (1/m).
    ///
    /// `top_layer_wavenumber`: smallest K (1/m) at which the bottom of the top layer does not affect the surface.
    ///
    /// # Errors
    /// [`GroundError::TooFine`]; [`Error::Memory`](crate::Error::Memory).
    pub(super) fn new(lattice: &Lattice, max_root: f64, top_layer_wavenumber: f64) -> Result<Self> {
        let class_count = lattice.classes().len();
        let panel_width = PANEL_PHASE / lattice.diagonal();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let panels_before_waves =
            (CornerWaves::min_wavenumber(lattice) / panel_width).ceil() as usize;
        let direct_panel_count = DIRECT_PANEL_COUNT.max(panels_before_waves);
        let mut table = Self {
            lattice: lattice.clone(),
            class_count,
            panel_width,
            rule: Rule::new(PANEL_POINTS),
            polynomials: vec![],
            tabulated_forms: OnceLock::new(),
            legendre: vec![],
            top_layer_wavenumber,
            panel_count: 0,
            direct_panel_count,
            waves: CornerWaves::new(lattice, 0.0, 0.0),
        };
        table.polynomials = table.rule.nodes.iter().map(|x| legendre(*x)).collect();
        let side = lattice.shorter_side();
        let cell_count = (lattice.counts[0] * lattice.counts[1]) as f64;
        let max_k =
            (MIN_K_TIMES_SIDE / side).max(top_layer_wavenumber).max(MIN_K_PER_ROOT * max_root);
        // The error beyond K* is about q₂ K*⁻⁵. Compliances decrease like 1/|√q₂| from |√q₂| = 2/side on.
        let relative_root = 0.5 * max_root * side;
        let exponent = if relative_root < 1.0 { 0.4 } else { 0.6 };
        let accurate_end = TABLE_END_TIMES_SIDE / side * relative_root.powf(exponent);
        let table_end = accurate_end.max(MIN_END_PER_ROOT * max_root).max(MIN_END_PER_K * max_k);
        let direct_end = direct_panel_count as f64 * panel_width;
        table.check_operations(table_end, direct_end, cell_count)?;
        // The table has values at all points, and rows of tails, which are fewer.
        let bytes =
            8.0 * (FORM_COUNT * PANEL_POINTS * class_count) as f64 * 2.0 * max_k / panel_width;
        memory::check("cells of a mat", cell_count, bytes)?;
        let max_panels_to_k = table.panels_to_k(max_root);
        table.legendre = (0..max_panels_to_k).map(|_| OnceLock::new()).collect();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let panel_count = (table_end / panel_width).ceil() as usize;
        table.panel_count = panel_count.max(max_panels_to_k + 1);
        let waves_end = table.panel_count as f64 * panel_width;
        table.waves = CornerWaves::new(lattice, direct_end, waves_end);
        Ok(table)
    }

    /// Error for a table up to `table_end` (1/m) that would need too many operations.
    fn check_operations(&self, table_end: f64, direct_end: f64, cell_count: f64) -> Result<()> {
        let span = self.span();
        let direct_operations = cell_count * (direct_end.min(table_end) * span).powi(2);
        let max_end = if direct_operations < MAX_OPERATIONS {
            let operations_per_wavenumber =
                OPERATIONS_PER_WAVE * (cell_count + CELLS_PER_SURFACE_COMPLIANCE) * span;
            direct_end + (MAX_OPERATIONS - direct_operations) / operations_per_wavenumber
        } else {
            (MAX_OPERATIONS / cell_count).sqrt() / span
        };
        if table_end.is_nan() || table_end > max_end {
            return Err(GroundError::TooFine { span, wavenumber: table_end, most: max_end }.into());
        }
        Ok(())
    }

    /// Number of panels up to K for a |√q₂|.
    pub(super) fn panels_to_k(&self, root: f64) -> usize {
        let resolved_wavenumber = MIN_K_TIMES_SIDE / self.lattice.shorter_side();
        let min_k = resolved_wavenumber.max(self.top_layer_wavenumber).max(MIN_K_PER_ROOT * root);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let count = (min_k / self.panel_width).ceil() as usize;
        rounded_panel_count(count)
    }

    /// Wavenumber at a `node` in −1 … 1 of a panel, 1/m.
    fn wavenumber(&self, panel: usize, node: f64) -> f64 {
        self.panel_width * (panel as f64 + 0.5 * (1.0 + node))
    }

    /// Diagonal of all cells, m.
    pub(super) fn span(&self) -> f64 {
        self.lattice.diagonal()
    }

    /// Number of panels up to the largest K.
    pub(super) fn max_panels_to_k(&self) -> usize {
        self.legendre.len()
    }

    /// Wavenumber κ that scales the tail integrals, 1/m.
    pub(super) fn wavenumber_scale(&self) -> f64 {
        1.0 / self.lattice.shorter_side()
    }

    /// Computes forms at all points, from the last panel to the first, and the integrals beyond each K.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped).
    pub(super) fn tabulate(&self, progress: &mut ProgressReporter) -> Result<()> {
        if self.tabulated_forms.get().is_some() {
            return Ok(());
        }
        let class_count = self.class_count;
        let scale = self.wavenumber_scale();
        // Numbers of panels up to K of all Laplace variables.
        let panels_to_k = self.panels_to_k(0.0)..=self.max_panels_to_k();
        let max_panels_to_k = *panels_to_k.end();
        let values = FormRows::new(max_panels_to_k * PANEL_POINTS, class_count);
        let mut tabulated_forms = TabulatedForms { values, tails: vec![] };
        let mut sums = FormRows::new(TAIL_TERMS, class_count);
        // The factor of the sums decreases to zero towards K*, because an abrupt end would cause oscillations.
        let fade_start = self.panel_width * max_panels_to_k.max(self.panel_count / 2) as f64;
        let fade_end = self.panel_width * self.panel_count as f64;
        let mut removed_integrals = integrals_beyond(fade_end, scale);
        self.for_each_panel_backwards(progress, |panel, panel_values| {
            let rows = panel_values.chunks_exact(FORM_COUNT * class_count);
            for (i, (node, point_values)) in self.rule.nodes.iter().zip(rows).enumerate() {
                let k = self.wavenumber(panel, *node);
                if panel < max_panels_to_k {
                    tabulated_forms.values.set(panel * PANEL_POINTS + i, point_values);
                }
                let removed_fraction = smooth_step((k - fade_start) / (fade_end - fade_start));
                let mut weight = 0.5 * self.panel_width * self.rule.weights[i];
                let term_count = if panel >= *panels_to_k.start() { TAIL_TERMS } else { 1 };
                for term in 0..term_count {
                    sums.add_scaled(term, weight * (1.0 - removed_fraction), point_values);
                    removed_integrals[term] += weight * removed_fraction * (scale / k).powi(2) / k;
                    weight *= (scale / k).powi(2);
                }
            }
            if panels_to_k.contains(&panel) && rounded_panel_count(panel) == panel {
                let forms = sums.forms.clone();
                tabulated_forms.tails.push((panel, FormRows { forms, class_count }));
            }
        })?;
        self.add_removed_parts(&sums, &removed_integrals, &mut tabulated_forms.tails);
        // If another thread has stored the table first, both tables are equal.
        let _ = self.tabulated_forms.set(tabulated_forms);
        Ok(())
    }

    /// Adds the removed parts, which `sums` over all panels do not contain, to the tails.
    ///
    /// The removed part of a form is its total, in closed form, minus its sum. In this part the mean of a form is
    /// proportional to k⁻³. All terms are therefore proportional to `removed_integrals`, the integrals of k⁻³.
    fn add_removed_parts(
        &self,
        sums: &FormRows,
        removed_integrals: &[f64; TAIL_TERMS],
        tails: &mut [(usize, FormRows)],
    ) {
        for (class, offset) in self.lattice.classes().iter().enumerate() {
            let totals = integrals(self.lattice.pitch, *offset);
            for (form, total) in totals.into_iter().enumerate() {
                let difference = total - sums.forms[form][class];
                for (_, rows) in &mut *tails {
                    rows.forms[form][class] = total;
                    for term in 1..TAIL_TERMS {
                        let removed_part =
                            difference * removed_integrals[term] / removed_integrals[0];
                        rows.forms[form][term * self.class_count + class] += removed_part;
                    }
                }
            }
        }
    }

    /// Calls `use_panel` with each panel up to K*, from the last to the first, and its forms at all points.
    fn for_each_panel_backwards(
        &self,
        progress: &mut ProgressReporter,
        mut use_panel: impl FnMut(usize, &[f64]),
    ) -> Result<()> {
        let panels: Vec<_> = (0..self.panel_count).rev().collect();
        let mut batch_values = vec![vec![]; PANEL_BATCH_SIZE];
        for batch in panels.chunks(PANEL_BATCH_SIZE) {
            let fill_panel = |forms: &mut Option<_>, (panel, values): (&usize, &mut Vec<f64>)| {
                let panel_forms = forms.get_or_insert_with(|| PanelForms::new(self));
                values.clear();
                values.extend_from_slice(panel_forms.forms(*panel, &self.rule.nodes));
                Ok(())
            };
            let jobs = batch.iter().zip(&mut batch_values);
            on_threads(thread_count(), jobs, fill_panel, |_| progress.reach(0))?;
            for (panel, values) in batch.iter().zip(&batch_values) {
                use_panel(*panel, values);
            }
        }
        Ok(())
    }

    /// Forms at all points, and integrals beyond `panel_count` panels; `None` before [`FormTable::tabulate`].
    pub(super) fn tabulated_forms(&self, panel_count: usize) -> Option<[&FormRows; 2]> {
        let TabulatedForms { values, tails } = self.tabulated_forms.get()?;
        let (_, tail) = tails.iter().find(|(count, _)| *count == panel_count)?;
        Some([values, tail])
    }

    /// Rows of a panel for Legendre polynomials of degree 0, 1, …: weights of the moments ∫ C Pₙ dk.
    pub(super) fn legendre(&self, panel: usize) -> &FormRows {
        self.legendre[panel].get_or_init(|| {
            let mut panel_forms = PanelForms::new(self);
            let rule = Rule::new(LEGENDRE_POINT_COUNT);
            let mut rows = FormRows::new(LEGENDRE_DEGREES, self.class_count);
            let forms = panel_forms.forms(panel, &rule.nodes);
            let point_forms = forms.chunks_exact(FORM_COUNT * self.class_count);
            for ((x, weight), values) in rule.points().zip(point_forms) {
                for (degree, polynomial) in legendre(x).into_iter().enumerate() {
                    rows.add_scaled(degree, (degree as f64 + 0.5) * weight * polynomial, values);
                }
            }
            rows
        })
    }
}

/// Integrals ∫ (k/κ)^(−2j) κ² k⁻³ dk from `start` on, for `scale` κ.
fn integrals_beyond(start: f64, scale: f64) -> [f64; TAIL_TERMS] {
    let mut power = 1.0;
    let mut integrals = [0.0; TAIL_TERMS];
    for (term, integral) in integrals.iter_mut().enumerate() {
        power *= (scale / start).powi(2);
        *integral = 0.5 * power / (term as f64 + 1.0);
    }
    integrals
}

/// Transition from 0 at x ≤ 0 to 1 at x ≥ 1, three times differentiable.
fn smooth_step(x: f64) -> f64 {
    let t = x.clamp(0.0, 1.0);
    t.powi(4) * (35.0 + t * (-84.0 + t * (70.0 - 20.0 * t)))
}
