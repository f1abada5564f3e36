//! Form factors of a lattice on panels of wavenumbers, and their integrals beyond the last.
//!
//! Panels are so narrow that forms turn by at most 16 radians, which 16 Gauss points resolve. They are tabulated
//! up to the largest K in use. The first panels are sums over directions, and all others are waves from corners, so
//! that a table takes a time proportional to K*. Beyond K only the top layer contributes to the surface compliance, a
//! power series in q₂/k². All integrals there follow from
//!
//! `T_j`(K) = ∫_K^∞ k^(−2j) g dk.
//!
//! These are sums over the same points with a factor that fades out towards K*. The rest is known: ∫₀^∞ g dk has a
//! closed form, and beyond K* g is replaced by its mean, a power k⁻³.

use std::sync::OnceLock;

use super::corner_waves::{CornerWaves, WaveBuffers};
use super::forms::{AngularMeans, FORM_COUNT, integrals};
use crate::bem::layered::{LEGENDRE_DEGREES, PANEL_POINTS, legendre, on_grid, on_threads, threads};
use crate::error::{GroundError, Result, Watch, memory};
use crate::geometry::Lattice;
use crate::linalg::add_combined_rows;
use crate::linalg::gauss::Rule;

/// Terms of the series beyond K, including the static one.
///
/// At the smallest K the next is 2e-11 of the first or less for Poisson's ratios from 0 on, 1e-8 for -0.9.
pub(super) const TAIL_TERMS: usize = 16;
/// Smallest K relative to |√q₂|.
const MIN_RATIO_TO_ROOT: f64 = 2.5;
/// Angle by which forms turn over a panel.
const PANEL_PHASE: f64 = 16.0;
/// Smallest K × shorter side of a cell: static forms at larger wavenumbers are small enough.
const MIN_RESOLVED_SIDE: f64 = 8.0;
/// K* × shorter side of a cell if |√q₂| is 2/side.
const TABLE_END_SIDE: f64 = 64.0;
/// Smallest ratio of K* to |√q₂|.
const MIN_END_RATIO: f64 = 4.0;
/// Number of panels whose forms are computed before they are summed.
const PANEL_BATCH_SIZE: usize = 32;
/// Number of panels on which forms are sums over directions; beyond, they are waves from corners.
const DIRECT_PANEL_COUNT: usize = 64;
/// Largest number of operations for a table and for the compliances that use it: a minute or two.
const MAX_OPERATIONS: f64 = 3e11;
/// Operations for waves from a corner at one point, with the compliances of some 500 Laplace variables there.
const OPERATIONS_PER_WAVE: f64 = 2e3;
/// Number of cells that cost as much as the surface compliance.
const CELLS_PER_SURFACE_COMPLIANCE: f64 = 80.0;
/// Number of points for Legendre coefficients of the forms.
const LEGENDRE_POINT_COUNT: usize = LEGENDRE_DEGREES + 8;

/// Rows of forms: form by form, row by row, all classes.
#[derive(Debug)]
pub(super) struct FormRows {
    forms: [Vec<f64>; FORM_COUNT],
    classes: usize,
}

impl FormRows {
    fn new(count: usize, classes: usize) -> Self {
        Self { forms: [(); FORM_COUNT].map(|()| vec![0.0; count * classes]), classes }
    }

    /// Overwrites a row with values, form by form, all classes.
    fn set(&mut self, row: usize, values: &[f64]) {
        let range = row * self.classes..(row + 1) * self.classes;
        for (form, values) in self.forms.iter_mut().zip(values.chunks_exact(self.classes)) {
            form[range.clone()].copy_from_slice(values);
        }
    }

    /// Adds factor × values to a row.
    fn add(&mut self, row: usize, factor: f64, values: &[f64]) {
        let range = row * self.classes..(row + 1) * self.classes;
        for (form, values) in self.forms.iter_mut().zip(values.chunks_exact(self.classes)) {
            for (sum, value) in form[range.clone()].iter_mut().zip(values) {
                *sum += factor * value;
            }
        }
    }

    /// Adds Σ weight × row of one form to sums, for the first rows: `weights` has a column for each sum.
    pub(super) fn combine(&self, form: usize, weights: &[f64], sums: &mut [f64]) {
        let rows = weights.len() * self.classes / sums.len();
        let rows = &self.forms[form][..rows * self.classes];
        add_combined_rows(weights, rows, self.classes, 1.0, sums);
    }
}

/// Forms and their integrals beyond K.
#[derive(Debug)]
struct TabulatedForms {
    /// Forms at the Gauss points, panel by panel.
    values: FormRows,
    /// Number of panels up to K, and rows j of ∫ (k/κ)^(−2j) g dk beyond; j = 0 from zero on.
    tails: Vec<(usize, FormRows)>,
}

/// TabulatedForms forms of a lattice.
#[derive(Debug)]
pub(super) struct FormTable {
    lattice: Lattice,
    pub(super) classes: usize,
    /// Width of a panel, 1/m.
    pub(super) width: f64,
    pub(super) rule: Rule,
    /// Legendre polynomials at the Gauss points.
    pub(super) polynomials: Vec<[f64; LEGENDRE_DEGREES]>,
    tabulated: OnceLock<TabulatedForms>,
    /// Legendre coefficients of a panel.
    legendre: Vec<OnceLock<FormRows>>,
    /// Smallest K at which the bottom of the top layer does not affect the surface, 1/m.
    deep: f64,
    /// Number of panels up to K*.
    pub(super) panel_count: usize,
    /// Number of the first panels, on which forms are sums over directions.
    pub(super) direct_panels: usize,
    /// Forms on the other panels.
    waves: CornerWaves,
}

/// Forms at points of one panel after the other.
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
        if panel < table.direct_panels {
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
    /// Empty table for `lattice`, for Laplace variables with |√q₂| up to `root` and K from `deep` on (1/m).
    ///
    /// # Errors
    /// [`GroundError::TooFine`]; [`Error::Memory`](crate::Error::Memory).
    pub(super) fn new(lattice: &Lattice, root: f64, deep: f64) -> Result<Self> {
        let classes = lattice.classes().len();
        let width = PANEL_PHASE / lattice.diagonal();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let panels_before_waves = (CornerWaves::min_wavenumber(lattice) / width).ceil() as usize;
        let direct_panels = DIRECT_PANEL_COUNT.max(panels_before_waves);
        let mut table = Self {
            lattice: lattice.clone(),
            classes,
            width,
            rule: Rule::new(PANEL_POINTS),
            polynomials: vec![],
            tabulated: OnceLock::new(),
            legendre: vec![],
            deep,
            panel_count: 0,
            direct_panels,
            waves: CornerWaves::new(lattice, 0.0, 0.0),
        };
        table.polynomials = table.rule.nodes.iter().map(|x| legendre(*x)).collect();
        let side = lattice.shorter_side();
        let cells = (lattice.counts[0] * lattice.counts[1]) as f64;
        let max_k = (MIN_RESOLVED_SIDE / side).max(deep).max(MIN_RATIO_TO_ROOT * root);
        // Beyond K* an error of about q₂ K*⁻⁵ is left. Compliances fall like 1/|√q₂| from |√q₂| = 2/side on.
        let size = 0.5 * root * side;
        let end = TABLE_END_SIDE / side * size.powf(if size < 1.0 { 0.4 } else { 0.6 });
        let end = end.max(MIN_END_RATIO * root).max(1.2 * max_k);
        let span = lattice.diagonal();
        let direct_end = direct_panels as f64 * width;
        let direct_operations = cells * (direct_end.min(end) * span).powi(2);
        let max_end = if direct_operations < MAX_OPERATIONS {
            let per_wavenumber =
                OPERATIONS_PER_WAVE * (cells + CELLS_PER_SURFACE_COMPLIANCE) * span;
            direct_end + (MAX_OPERATIONS - direct_operations) / per_wavenumber
        } else {
            (MAX_OPERATIONS / cells).sqrt() / span
        };
        if end.is_nan() || end > max_end {
            return Err(GroundError::TooFine { span, wavenumber: end, most: max_end }.into());
        }
        // Values at all points, and rows of tails, which are fewer.
        let bytes = 8.0 * (FORM_COUNT * PANEL_POINTS * classes) as f64 * 2.0 * max_k / width;
        memory::check("cells of a mat", cells, bytes)?;
        let max_panels_to_k = table.panels(root);
        table.legendre = (0..max_panels_to_k).map(|_| OnceLock::new()).collect();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let panel_count = (end / width).ceil() as usize;
        table.panel_count = panel_count.max(max_panels_to_k + 1);
        table.waves = CornerWaves::new(lattice, direct_end, table.panel_count as f64 * width);
        Ok(table)
    }

    /// Number of panels up to K for a |√q₂|.
    pub(super) fn panels(&self, root: f64) -> usize {
        let resolved = MIN_RESOLVED_SIDE / self.lattice.shorter_side();
        let min_k = resolved.max(self.deep).max(MIN_RATIO_TO_ROOT * root);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let count = (min_k / self.width).ceil() as usize;
        on_grid(count)
    }

    /// Wavenumber at a `node` in −1 … 1 of a panel, 1/m.
    fn wavenumber(&self, panel: usize, node: f64) -> f64 {
        self.width * (panel as f64 + 0.5 * (1.0 + node))
    }

    /// Diagonal of all cells, m.
    pub(super) fn span(&self) -> f64 {
        self.lattice.diagonal()
    }

    /// Number of panels up to the largest K.
    pub(super) fn max_panels_to_k(&self) -> usize {
        self.legendre.len()
    }

    /// κ, 1/m.
    pub(super) fn unit(&self) -> f64 {
        1.0 / self.lattice.shorter_side()
    }

    /// Computes forms at all points, from the last panel to the first, and the sums beyond each K.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped).
    pub(super) fn tabulate(&self, progress: &mut Watch) -> Result<()> {
        if self.tabulated.get().is_some() {
            return Ok(());
        }
        let classes = self.classes;
        let unit = self.unit();
        // Numbers of panels up to K of all Laplace variables.
        let panels_to_k = self.panels(0.0)..=self.max_panels_to_k();
        let max_panels_to_k = *panels_to_k.end();
        let values = FormRows::new(max_panels_to_k * PANEL_POINTS, classes);
        let mut tabulated = TabulatedForms { values, tails: vec![] };
        let mut sums = FormRows::new(TAIL_TERMS, classes);
        // Sums fade out towards K*: a sharp end would leave a wave of the forms. The removed part is like k⁻³.
        let fade_start = self.width * max_panels_to_k.max(self.panel_count / 2) as f64;
        let fade_end = self.width * self.panel_count as f64;
        let mut power = 1.0;
        let mut faded = [0.0; TAIL_TERMS];
        for (term, faded) in faded.iter_mut().enumerate() {
            power *= (unit / fade_end).powi(2);
            *faded = 0.5 * power / (term as f64 + 1.0);
        }
        self.for_each_panel_backwards(progress, |panel, values| {
            let rows = values.chunks_exact(FORM_COUNT * classes);
            for (i, (node, values)) in self.rule.nodes.iter().zip(rows).enumerate() {
                let k = self.wavenumber(panel, *node);
                if panel < max_panels_to_k {
                    tabulated.values.set(panel * PANEL_POINTS + i, values);
                }
                let fading = smooth_step((k - fade_start) / (fade_end - fade_start));
                let mut weight = 0.5 * self.width * self.rule.weights[i];
                let terms = if panel >= *panels_to_k.start() { TAIL_TERMS } else { 1 };
                for term in 0..terms {
                    sums.add(term, weight * (1.0 - fading), values);
                    faded[term] += weight * fading * (unit / k).powi(2) / k;
                    weight *= (unit / k).powi(2);
                }
            }
            if panels_to_k.contains(&panel) && on_grid(panel) == panel {
                let forms = sums.forms.clone();
                tabulated.tails.push((panel, FormRows { forms, classes }));
            }
        })?;
        // The integral beyond K* is the known total minus the sum.
        for (class, offset) in self.lattice.classes().iter().enumerate() {
            let totals = integrals(self.lattice.pitch, *offset);
            for (form, total) in totals.into_iter().enumerate() {
                let difference = total - sums.forms[form][class];
                for (_, rows) in &mut tabulated.tails {
                    rows.forms[form][class] = total;
                    for term in 1..TAIL_TERMS {
                        let beyond = difference * faded[term] / faded[0];
                        rows.forms[form][term * classes + class] += beyond;
                    }
                }
            }
        }
        // Another thread may have been first, with the same result.
        let _ = self.tabulated.set(tabulated);
        Ok(())
    }

    /// Calls `take` with each panel up to K*, from the last to the first, and its forms at all points.
    fn for_each_panel_backwards(
        &self,
        progress: &mut Watch,
        mut take: impl FnMut(usize, &[f64]),
    ) -> Result<()> {
        let panels: Vec<_> = (0..self.panel_count).rev().collect();
        let mut batch = vec![vec![]; PANEL_BATCH_SIZE];
        for panels in panels.chunks(PANEL_BATCH_SIZE) {
            let fill = |forms: &mut Option<_>, (panel, values): (&usize, &mut Vec<f64>)| {
                let forms = forms.get_or_insert_with(|| PanelForms::new(self));
                values.clear();
                values.extend_from_slice(forms.forms(*panel, &self.rule.nodes));
                Ok(())
            };
            on_threads(threads(), panels.iter().zip(&mut batch), fill, |_| progress.reach(0))?;
            for (panel, values) in panels.iter().zip(&batch) {
                take(*panel, values);
            }
        }
        Ok(())
    }

    /// Forms at all points, and integrals beyond the last of `panels`; `None` before [`FormTable::tabulate`].
    pub(super) fn tabulated(&self, panels: usize) -> Option<[&FormRows; 2]> {
        let TabulatedForms { values, tails } = self.tabulated.get()?;
        let (_, tail) = tails.iter().find(|(count, _)| *count == panels)?;
        Some([values, tail])
    }

    /// Rows of a panel for Legendre polynomials of degree 0, 1, …: weights of ∫ C Pₙ dk.
    pub(super) fn legendre(&self, panel: usize) -> &FormRows {
        self.legendre[panel].get_or_init(|| {
            let mut panel_forms = PanelForms::new(self);
            let rule = Rule::new(LEGENDRE_POINT_COUNT);
            let mut rows = FormRows::new(LEGENDRE_DEGREES, self.classes);
            let forms = panel_forms.forms(panel, &rule.nodes);
            for ((x, weight), values) in
                rule.points().zip(forms.chunks_exact(FORM_COUNT * self.classes))
            {
                for (degree, polynomial) in legendre(x).into_iter().enumerate() {
                    rows.add(degree, (degree as f64 + 0.5) * weight * polynomial, values);
                }
            }
            rows
        })
    }
}

/// Transition from 0 at x ≤ 0 to 1 at x ≥ 1, three times differentiable.
fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x.powi(4) * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x)))
}
