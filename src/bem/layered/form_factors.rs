//! Form factors of element pairs in the wavenumber domain, on fixed panels.
//!
//! The receiver of length `l_p` lies at the distance X to the right of the source of length `l_q`. The integrals of
//! e^(ik(x−ξ)) over both elements are `S_p` `S_q` cos kX and `S_p` `S_q` sin kX with S = 2 sin(kl/2)/k. Panels are so
//! narrow that the phase of these form factors changes by at most 16 radians, which 16 Gauss points resolve. Form factors
//! depend only on the mesh. The table of a panel is therefore computed once, at its first use.
//!
//! Wide panels, 2, 4, 8 … times as wide, also have 16 Gauss points. On a wide panel C/k² is a polynomial Σ cₙ Pₙ(x), and
//! `S_p` `S_q` k² is an exact sum of four waves e^(iky), with
//! ∫ Pₙ(x) e^(i(κ+hx)y) dx = 2 iⁿ jₙ(hy) e^(iκy) (Abramowitz & Stegun 10.1.14; Filon's quadrature).

use std::sync::OnceLock;

use crate::bem::ContactElement;
use crate::history::PairClasses;
use crate::linalg::gauss::Rule;

/// Number of Gauss points of a panel.
pub(crate) const PANEL_POINTS: usize = 16;
/// Number of Legendre coefficients of the form factors on a panel; the next one is about J₃₂(8) = 7e-17.
pub(crate) const LEGENDRE_DEGREES: usize = 32;
/// Phase change of the fastest form factor over a panel, rad, which 16 Gauss points resolve to rounding.
const PANEL_PHASE: f64 = 16.0;
/// Number of pairs in one block, summed by vector instructions.
pub(crate) const PAIR_LANES: usize = 4;
/// Number of panel widths, each twice the previous one.
pub(crate) const PANEL_LEVEL_COUNT: usize = 14;
/// Largest memory for tables at Gauss points, bytes; panels beyond it are computed at each use.
const MAX_TABLE_BYTES: usize = 256 << 20;
/// Largest number of stored narrow panels.
const MAX_STORED_PANELS: usize = 1 << 14;
/// Largest number of stored panels with Legendre coefficients, which only few panels need.
const MAX_STORED_LEGENDRE_PANELS: usize = 1 << 12;
/// Largest number of narrow panels of one integral that stored wide panels cover.
const MAX_COVERED_PANELS: usize = 1 << 17;
/// Largest half phase for which sin x/x equals its first two series terms to rounding.
const MAX_SINC_SERIES_ARGUMENT: f64 = 1e-4;
/// Additional Gauss points for Legendre coefficients, for their precision.
const EXTRA_PROJECTION_POINTS: usize = 8;

/// Sums for [`PAIR_LANES`] pairs: real and imaginary parts of zz, xx and zx.
pub(crate) type Sums = [[f64; PAIR_LANES]; 6];
/// Even and odd form factors of [`PAIR_LANES`] pairs.
pub(crate) type FormRow = [[f64; PAIR_LANES]; 2];

/// Lengths and distance of a pair of elements, for its form factors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairShape {
    /// Lengths of source and receiver, m.
    pub(crate) lengths: [f64; 2],
    /// Distance from the source's centre to the receiver's centre, m, positive to the right.
    pub(crate) offset: f64,
}

impl PairShape {
    fn new(source: ContactElement, receiver: ContactElement) -> Self {
        let lengths = [source.length(), receiver.length()];
        // The offset of a pair of an element with itself must be exactly zero.
        let offset =
            if source == receiver { 0.0 } else { receiver.center()[0] - source.center()[0] };
        Self { lengths, offset }
    }

    /// Even and odd form factor at the wavenumber `k`, m².
    fn form_factors(&self, k: f64) -> [f64; 2] {
        let factors = self.lengths.map(|length| {
            let half_phase = 0.5 * k * length;
            if half_phase < MAX_SINC_SERIES_ARGUMENT {
                length * (1.0 - half_phase * half_phase / 6.0)
            } else {
                length * half_phase.sin() / half_phase
            }
        });
        let phase = k * self.offset;
        let sin = phase.sin();
        let cos = phase.cos();
        [factors[0] * factors[1] * cos, factors[0] * factors[1] * sin]
    }

    /// Four waves whose sum is k² times the form factors.
    ///
    /// For each wave: the distance y ≥ 0 of cos ky and sin ky, and the factors of both.
    pub(crate) fn waves(&self) -> [(f64, [f64; 2]); 4] {
        let Self { lengths: [source_length, receiver_length], offset } = *self;
        let half_sum = 0.5 * (receiver_length + source_length);
        let half_difference = 0.5 * (receiver_length - source_length);
        let end_distances = [
            (offset + half_sum, -1.0),
            (offset - half_difference, 1.0),
            (offset + half_difference, 1.0),
            (offset - half_sum, -1.0),
        ];
        end_distances.map(|(y, sign)| {
            // The odd form factor of an element with itself is exactly zero.
            let direction = if offset == 0.0 { 0.0 } else { y.signum() };
            (y.abs(), [sign, sign * direction])
        })
    }
}

/// Panel of wavenumbers: the `index`-th of the panels 2^`level` times as wide as the narrowest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub(crate) struct Panel {
    pub(crate) level: u32,
    pub(crate) index: usize,
}

impl Panel {
    /// Two panels of half the width.
    pub(crate) fn halves(self) -> [Self; 2] {
        [0, 1].map(|half| Self { level: self.level - 1, index: 2 * self.index + half })
    }
}

/// Form factors of all classes of pairs, with tables of the used panels.
#[derive(Debug)]
pub(crate) struct FormFactors {
    pub(crate) shapes: Vec<PairShape>,
    /// Width of the narrowest panels, 1/m.
    pub(crate) width: f64,
    pub(crate) rule: Rule,
    /// Rule for Legendre coefficients of the form factors.
    projection_rule: Rule,
    /// Tables of the narrow panels: block by block of pairs, a row for each Gauss point.
    values: Tables,
    /// Tables of the narrow panels: block by block of pairs, a row for each Legendre polynomial.
    legendre: Tables,
    /// Tables of the wide panels of each level, as `values`.
    wide_values: [OnceLock<Tables>; PANEL_LEVEL_COUNT],
    /// Largest number of stored tables of one level.
    max_stored_tables: usize,
}

/// Tables of panels, each computed at its first use.
type Tables = Box<[OnceLock<Box<[FormRow]>>]>;

/// Tables of `panel_count` panels, not yet computed.
fn empty_tables(panel_count: usize) -> Tables {
    (0..panel_count).map(|_| OnceLock::new()).collect()
}

impl FormFactors {
    /// Form factors of all classes of pairs, not yet computed.
    pub(crate) fn new(classes: &PairClasses) -> Self {
        let shapes: Vec<_> = (0..classes.count())
            .filter_map(|class| classes.representative(class).ok())
            .map(|[source, receiver]| PairShape::new(source, receiver))
            .collect();
        let block_count = shapes.len().div_ceil(PAIR_LANES);
        let table_bytes = (block_count * PANEL_POINTS * size_of::<FormRow>()).max(1);
        // Tables of Legendre coefficients are twice as long, and may take half of the memory; tables of each wide level
        // may take an eighth.
        let max_tables = MAX_TABLE_BYTES / table_bytes;
        Self {
            width: PANEL_PHASE / classes.span(),
            rule: Rule::new(PANEL_POINTS),
            projection_rule: Rule::new(LEGENDRE_DEGREES + EXTRA_PROJECTION_POINTS),
            values: empty_tables(max_tables.min(MAX_STORED_PANELS)),
            legendre: empty_tables((max_tables / 4).clamp(1, MAX_STORED_LEGENDRE_PANELS)),
            wide_values: [const { OnceLock::new() }; PANEL_LEVEL_COUNT],
            max_stored_tables: (max_tables / 8).max(1),
            shapes,
        }
    }

    /// Number of blocks of [`PAIR_LANES`] pairs.
    pub(crate) fn block_count(&self) -> usize {
        self.shapes.len().div_ceil(PAIR_LANES)
    }

    /// Number of stored tables of a level of wide panels.
    fn wide_table_count(&self, level: u32) -> usize {
        self.max_stored_tables.min(MAX_COVERED_PANELS >> level)
    }

    /// Start of a panel and its width, 1/m.
    pub(crate) fn start_and_width(&self, Panel { level, index }: Panel) -> [f64; 2] {
        let width = self.width * (1_u64 << level) as f64;
        [width * index as f64, width]
    }

    /// Calls `apply` with the rows of `panel` at its Gauss points.
    pub(crate) fn with_values(&self, panel: Panel, apply: impl FnOnce(&[FormRow])) {
        let index = panel.index;
        if panel.level == 0 {
            return Self::with_table(&self.values, index, || self.table(index, &self.rule), apply);
        }
        let level = (panel.level as usize).min(PANEL_LEVEL_COUNT - 1);
        let tables = self.wide_values[level]
            .get_or_init(|| empty_tables(self.wide_table_count(panel.level)));
        Self::with_table(tables, index, || self.wide_table(panel), apply);
    }

    /// Calls `apply` with the rows of a narrow panel for Legendre polynomials of degree 0, 1, ….
    ///
    /// Rows are weights of the moments ∫ C Pₙ dk.
    pub(crate) fn with_legendre(&self, panel: usize, apply: impl FnOnce(&[FormRow])) {
        Self::with_table(&self.legendre, panel, || self.legendre_table(panel), apply);
    }

    /// Calls `apply` with the stored or newly computed table of a panel.
    fn with_table(
        tables: &[OnceLock<Box<[FormRow]>>],
        panel: usize,
        compute: impl FnOnce() -> Box<[FormRow]>,
        apply: impl FnOnce(&[FormRow]),
    ) {
        match tables.get(panel) {
            Some(table) => apply(table.get_or_init(compute)),
            None => apply(&compute()),
        }
    }

    /// Rows of a narrow panel at the points of a rule.
    fn table(&self, panel: usize, rule: &Rule) -> Box<[FormRow]> {
        let point_count = rule.nodes.len();
        let mut rows = vec![FormRow::default(); self.block_count() * point_count];
        for (class, shape) in self.shapes.iter().enumerate() {
            for (i, node) in rule.nodes.iter().enumerate() {
                let k = self.width * (panel as f64 + 0.5 * (1.0 + node));
                let row = &mut rows[class / PAIR_LANES * point_count + i];
                for (parity, value) in shape.form_factors(k).into_iter().enumerate() {
                    row[parity][class % PAIR_LANES] = value;
                }
            }
        }
        rows.into_boxed_slice()
    }

    /// Rows of a wide panel at its Gauss points, from exact moments of the form factors.
    fn wide_table(&self, panel: Panel) -> Box<[FormRow]> {
        let [start, width] = self.start_and_width(panel);
        let half_width = 0.5 * width;
        let middle = start + 0.5 * width;
        let mut rows = vec![FormRow::default(); self.block_count() * PANEL_POINTS];
        let polynomials: Vec<_> = self.rule.nodes.iter().map(|x| legendre(*x)).collect();
        for (class, shape) in self.shapes.iter().enumerate() {
            let mut moments = [[0.0; 2]; PANEL_POINTS];
            for (y, factors) in shape.waves() {
                let phase = middle * y;
                let sin = phase.sin();
                let cos = phase.cos();
                // Real and imaginary part of iⁿ e^(iκy), n = 0 … 3.
                let phases = [[cos, sin], [-sin, cos], [-cos, -sin], [sin, -cos]];
                for (n, bessel) in spherical_bessel(half_width * y).into_iter().enumerate() {
                    for parity in 0..2 {
                        let amplitude = 2.0 * (n as f64 + 0.5) * bessel;
                        moments[n][parity] += factors[parity] * amplitude * phases[n % 4][parity];
                    }
                }
            }
            for (i, (node, polynomials)) in self.rule.nodes.iter().zip(&polynomials).enumerate() {
                let k = middle + half_width * node;
                let row = &mut rows[class / PAIR_LANES * PANEL_POINTS + i];
                for parity in 0..2 {
                    let terms = moments.iter().zip(polynomials);
                    let form_factor: f64 = terms.map(|(moment, p)| moment[parity] * p).sum();
                    row[parity][class % PAIR_LANES] = form_factor / (k * k);
                }
            }
        }
        rows.into_boxed_slice()
    }

    /// Rows of a narrow panel for Legendre polynomials.
    fn legendre_table(&self, panel: usize) -> Box<[FormRow]> {
        let point_count = self.projection_rule.nodes.len();
        let values = self.table(panel, &self.projection_rule);
        let mut rows = vec![FormRow::default(); self.block_count() * LEGENDRE_DEGREES];
        for (i, (node, weight)) in
            self.projection_rule.nodes.iter().zip(&self.projection_rule.weights).enumerate()
        {
            let polynomials = legendre(*node);
            for block in 0..self.block_count() {
                let point_row = &values[block * point_count + i];
                for (degree, polynomial) in polynomials.iter().enumerate() {
                    let factor = (degree as f64 + 0.5) * weight * polynomial;
                    let row = &mut rows[block * LEGENDRE_DEGREES + degree];
                    for parity in 0..2 {
                        for lane in 0..PAIR_LANES {
                            row[parity][lane] += factor * point_row[parity][lane];
                        }
                    }
                }
            }
        }
        rows.into_boxed_slice()
    }
}

/// Spherical Bessel functions jₙ(t), n = 0 … 15, for t ≥ 0.
fn spherical_bessel(t: f64) -> [f64; PANEL_POINTS] {
    /// Degree at the start of the downward recurrence: the returned degrees are then exact for t up to their number.
    const DOWNWARD_START_DEGREE: usize = 64;
    let mut values = [0.0; PANEL_POINTS];
    if t < 1.0 {
        // tⁿ/(2n+1)!! (1 − t²/2/(2n+3) (1 − t²/4/(2n+5) (1 − …)))
        let mut power = 1.0;
        for (n, value) in values.iter_mut().enumerate() {
            let two_n_plus_one = (2 * n + 1) as f64;
            let terms = (1..=10).rev().map(f64::from);
            let series = terms
                .fold(1.0, |sum, i| 1.0 - sum * t * t / (2.0 * i * (two_n_plus_one + 2.0 * i)));
            *value = power * series;
            power *= t / (two_n_plus_one + 2.0);
        }
        return values;
    }
    let sin = t.sin();
    let cos = t.cos();
    if t > PANEL_POINTS as f64 {
        values[0] = sin / t;
        values[1] = (sin / t - cos) / t;
        for n in 1..PANEL_POINTS - 1 {
            values[n + 1] = (2 * n + 1) as f64 / t * values[n] - values[n - 1];
        }
        return values;
    }
    // The start is so small that the recurrence does not overflow.
    let mut next_value = 0.0;
    let mut value = 1e-200;
    for n in (1..=DOWNWARD_START_DEGREE).rev() {
        let previous_value = (2 * n + 1) as f64 / t * value - next_value;
        next_value = value;
        value = previous_value;
        if n <= PANEL_POINTS {
            values[n - 1] = value;
        }
    }
    // The recurrence yields multiples of the functions. The larger of j₀ and j₁, which is not zero, determines the factor.
    let j0 = sin / t;
    let j1 = (sin / t - cos) / t;
    let scale = if j0.abs() > j1.abs() { j0 / values[0] } else { j1 / values[1] };
    values.map(|value| scale * value)
}

/// Legendre polynomials of degree 0, 1, … at x.
pub(crate) fn legendre(x: f64) -> [f64; LEGENDRE_DEGREES] {
    legendre_at([x]).map(|[value]| value)
}

/// Legendre polynomials of degree 0, 1, … at several x.
pub(crate) fn legendre_at<const N: usize>(x: [f64; N]) -> [[f64; N]; LEGENDRE_DEGREES] {
    let mut values = [[1.0; N]; LEGENDRE_DEGREES];
    values[1] = x;
    for n in 2..LEGENDRE_DEGREES {
        let factors = LEGENDRE_RECURRENCE[n];
        for i in 0..N {
            values[n][i] = factors[0] * x[i] * values[n - 1][i] - factors[1] * values[n - 2][i];
        }
    }
    values
}

/// Factors (2n−1)/n and (n−1)/n of [`next_legendre`](crate::linalg::gauss::next_legendre), divided at compile
/// time.
const LEGENDRE_RECURRENCE: [[f64; 2]; LEGENDRE_DEGREES] = {
    let mut factors = [[0.0; 2]; LEGENDRE_DEGREES];
    let mut n = 1;
    while n < LEGENDRE_DEGREES {
        factors[n] = [(2 * n - 1) as f64 / n as f64, (n - 1) as f64 / n as f64];
        n += 1;
    }
    factors
};

/// Adds Σ coefficient × row to the sums of all pairs.
///
/// With many pairs, this function takes nearly all computing time.
pub(crate) fn accumulate(rows: &[FormRow], coefficients: &[[f64; 6]], sums: &mut [Sums]) {
    for (block_rows, block_sums) in rows.chunks_exact(coefficients.len()).zip(sums) {
        // A local copy stays in registers.
        let mut local_sums = *block_sums;
        for (row, c) in block_rows.iter().zip(coefficients) {
            for lane in 0..PAIR_LANES {
                local_sums[0][lane] += c[0] * row[0][lane];
                local_sums[1][lane] += c[1] * row[0][lane];
                local_sums[2][lane] += c[2] * row[0][lane];
                local_sums[3][lane] += c[3] * row[0][lane];
                local_sums[4][lane] += c[4] * row[1][lane];
                local_sums[5][lane] += c[5] * row[1][lane];
            }
        }
        *block_sums = local_sums;
    }
}

#[cfg(test)]
mod tests;
