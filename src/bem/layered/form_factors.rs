//! Form factors of element pairs in the wavenumber domain, on fixed panels.
//!
//! For a source of length `l_q` and a receiver of length `l_p`, X to its right, integrals over both
//! of e^(ik(x−ξ)) are `S_p` `S_q` cos kX and `S_p` `S_q` sin kX with S = 2 sin(kl/2)/k. Panels are so
//! narrow that these turn by at most 16 radians, which 16 Gauss points resolve; they depend on the
//! mesh alone, so they are computed once, panel by panel, when they are needed first.

use std::sync::OnceLock;

use crate::bem::ContactElement;
use crate::history::PairClasses;
use crate::linalg::gauss::Rule;

/// Gauss points of a panel.
pub(crate) const POINTS: usize = 16;
/// Legendre coefficients of the form factors on a panel: J₃₂(8) is 7e-17.
pub(crate) const DEGREES: usize = 32;
/// Angle by which the fastest form factor turns over a panel.
const TURN: f64 = 16.0;
/// Pairs that are summed together.
pub(crate) const LANES: usize = 4;
/// Most memory for tables at Gauss points, bytes; panels beyond it are computed each time.
const MEMORY: usize = 256 << 20;

/// zz, xx, zx: real and imaginary part of each, for [`LANES`] pairs.
pub(crate) type Sums = [[f64; LANES]; 6];
/// Even and odd form factors of [`LANES`] pairs.
pub(crate) type DofCombination = [[f64; LANES]; 2];

/// A pair of elements as the wavenumber domain sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairShape {
    /// Lengths of source and receiver, m.
    pub(crate) lengths: [f64; 2],
    /// From the source's centre to the receiver's, m.
    pub(crate) offset: f64,
}

impl PairShape {
    fn new(source: ContactElement, receiver: ContactElement) -> Self {
        let lengths = [source.length(), receiver.length()];
        // The centres of an element and itself do not differ by rounding.
        let offset = if source == receiver { 0.0 } else { receiver.center() - source.center() };
        Self { lengths, offset }
    }

    /// Even and odd form factor at the wavenumber `k`, m².
    fn at(&self, k: f64) -> [f64; 2] {
        let [one, two] = self.lengths.map(|length| {
            let half = 0.5 * k * length;
            if half < 1e-4 {
                length * (1.0 - half * half / 6.0)
            } else {
                length * half.sin() / half
            }
        });
        let (sin, cos) = (k * self.offset).sin_cos();
        [one * two * cos, one * two * sin]
    }
}

/// The form factors of a patch.
#[derive(Debug)]
pub(crate) struct FormFactors {
    pub(crate) shapes: Vec<PairShape>,
    /// Width of a panel, 1/m.
    pub(crate) width: f64,
    pub(crate) rule: Rule,
    fine: Rule,
    /// Per panel: blocks of pairs, rows of Gauss points.
    values: Vec<OnceLock<Box<[DofCombination]>>>,
    /// Per panel: blocks of pairs, rows of Legendre coefficients.
    legendre: Vec<OnceLock<Box<[DofCombination]>>>,
}

impl FormFactors {
    pub(crate) fn new(classes: &PairClasses) -> Self {
        let shapes: Vec<_> = (0..classes.count())
            .filter_map(|class| classes.representative(class).ok())
            .map(|[source, receiver]| PairShape::new(source, receiver))
            .collect();
        let blocks = shapes.len().div_ceil(LANES);
        let panels = MEMORY / (blocks * POINTS * size_of::<DofCombination>()).max(1);
        let empty = |count: usize| (0..count).map(|_| OnceLock::new()).collect::<Vec<_>>();
        Self {
            width: TURN / classes.span(),
            rule: Rule::new(POINTS),
            fine: Rule::new(DEGREES + 8),
            values: empty(panels.min(1 << 14)),
            legendre: empty((panels / 4).clamp(1, 1 << 12)),
            shapes,
        }
    }

    /// Number of blocks of [`LANES`] pairs.
    pub(crate) fn blocks(&self) -> usize {
        self.shapes.len().div_ceil(LANES)
    }

    /// Panels whose tables are kept, at Gauss points and by Legendre coefficients.
    pub(crate) fn room(&self) -> [usize; 2] {
        [self.values.len(), self.legendre.len()]
    }

    /// Points that Legendre coefficients are made of.
    pub(crate) fn projection(&self) -> f64 {
        self.fine.nodes.len() as f64
    }

    /// Calls `apply` with the rows of `panel` at its Gauss points.
    pub(crate) fn with_values(&self, panel: usize, apply: impl FnOnce(&[DofCombination])) {
        Self::with(&self.values, panel, || self.table(panel, &self.rule), apply);
    }

    /// Calls `apply` with the rows of `panel` for Legendre polynomials of degree 0, 1, …: weights of
    /// ∫ C Pₙ dk.
    pub(crate) fn with_legendre(&self, panel: usize, apply: impl FnOnce(&[DofCombination])) {
        Self::with(&self.legendre, panel, || self.projected(panel), apply);
    }

    fn with(
        tables: &[OnceLock<Box<[DofCombination]>>],
        panel: usize,
        make: impl FnOnce() -> Box<[DofCombination]>,
        apply: impl FnOnce(&[DofCombination]),
    ) {
        match tables.get(panel) {
            Some(table) => apply(table.get_or_init(make)),
            None => apply(&make()),
        }
    }

    fn table(&self, panel: usize, rule: &Rule) -> Box<[DofCombination]> {
        let points = rule.nodes.len();
        let mut rows = vec![DofCombination::default(); self.blocks() * points];
        for (class, shape) in self.shapes.iter().enumerate() {
            for (i, node) in rule.nodes.iter().enumerate() {
                let k = self.width * (panel as f64 + 0.5 * (1.0 + node));
                let [even, odd] = shape.at(k);
                let row = &mut rows[class / LANES * points + i];
                (row[0][class % LANES], row[1][class % LANES]) = (even, odd);
            }
        }
        rows.into_boxed_slice()
    }

    fn projected(&self, panel: usize) -> Box<[DofCombination]> {
        let points = self.fine.nodes.len();
        let values = self.table(panel, &self.fine);
        let mut rows = vec![DofCombination::default(); self.blocks() * DEGREES];
        for (i, (node, weight)) in self.fine.nodes.iter().zip(&self.fine.weights).enumerate() {
            let polynomials = legendre(*node);
            for block in 0..self.blocks() {
                let value = &values[block * points + i];
                for (degree, polynomial) in polynomials.iter().enumerate() {
                    let factor = (degree as f64 + 0.5) * weight * polynomial;
                    let row = &mut rows[block * DEGREES + degree];
                    for part in 0..2 {
                        for lane in 0..LANES {
                            row[part][lane] += factor * value[part][lane];
                        }
                    }
                }
            }
        }
        rows.into_boxed_slice()
    }
}

/// Legendre polynomials at x.
pub(crate) fn legendre(x: f64) -> [f64; DEGREES] {
    let mut values = [1.0; DEGREES];
    values[1] = x;
    for n in 2..DEGREES {
        let [one, two] = RECURRENCE[n];
        values[n] = one * x * values[n - 1] - two * values[n - 2];
    }
    values
}

/// (2n−1)/n and (n−1)/n of [`next_legendre`](crate::linalg::gauss::next_legendre), divided beforehand.
const RECURRENCE: [[f64; 2]; DEGREES] = {
    let mut factors = [[0.0; 2]; DEGREES];
    let mut n = 1;
    while n < DEGREES {
        factors[n] = [(2 * n - 1) as f64 / n as f64, (n - 1) as f64 / n as f64];
        n += 1;
    }
    factors
};

/// Adds Σ coefficient × row to the sums of all pairs: the whole cost of many pairs.
pub(crate) fn accumulate(rows: &[DofCombination], coefficients: &[[f64; 6]], sums: &mut [Sums]) {
    for (rows, sums) in rows.chunks_exact(coefficients.len()).zip(sums) {
        let mut local = *sums;
        for (row, c) in rows.iter().zip(coefficients) {
            for lane in 0..LANES {
                local[0][lane] += c[0] * row[0][lane];
                local[1][lane] += c[1] * row[0][lane];
                local[2][lane] += c[2] * row[0][lane];
                local[3][lane] += c[3] * row[0][lane];
                local[4][lane] += c[4] * row[1][lane];
                local[5][lane] += c[5] * row[1][lane];
            }
        }
        *sums = local;
    }
}
