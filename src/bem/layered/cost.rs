//! What the coefficients of a layered ground cost, before it is paid.
//!
//! Work is counted and not timed. Where the contours are sampled is found by the rule of `contour`, with the
//! surface compliance at two wavenumbers for the mobility: it has the same resonances and the same
//! reflections, and costs a hundredth. What samples cost is found at some of them, by all that an integral
//! needs but its pairs.

use std::collections::HashMap;
use std::fmt;
use std::ops::Range;

use super::coefficients::{Block, Quadrature};
use super::contour::{self, Circle, Panels, Place};
use super::form_factors::{DEGREES, FormRow, LANES, POINTS};
use super::passivity;
use super::wavenumber::{Counts, Workspace};
use crate::error::{LayeredError, Result};
use crate::linalg::Complex;
use crate::soil::{Elastic, Relaxation};

/// Nanoseconds of one thread for an evaluation of the surface compliance, for each layer in it after the
/// first, for its moments if its panel is halved, for a form factor, for a product of the two, for the form
/// factors of a pair on a wide panel, and for a class at a point of a circle.
/// Measured (`benches/studies/src/layered_cost.rs`).
const EVALUATION: f64 = 95.0;
const LAYER: f64 = 130.0;
const MOMENTS: f64 = 110.0;
const FORM_FACTOR: f64 = 50.0;
const PRODUCT: f64 = 0.25;
const WIDE: f64 = 2500.0;
const POINT: f64 = 200.0;

/// Samples of each eigenvalue that are looked at.
const LOOKED_AT: usize = 16;
/// Wavenumbers at which the surface compliance stands for the mobility, times the length of the patch.
const WAVENUMBERS: [f64; 2] = [0.5, 2.0];
/// Halving makes no integral so many times as long as its panels, as a rule.
const MOST_HALVING: f64 = 50.0;

/// What step coefficients cost before the first step: by counting, not by a clock, so that the same is
/// said everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Cost {
    /// Processor time, s, of one thread of the processor in `docs/validation.md`. It is shared by
    /// all threads of rayon's pool with the feature `rayon`.
    pub seconds: f64,
    /// Evaluations of the surface compliance, at one wavenumber each.
    pub evaluations: f64,
    /// Most memory, bytes.
    pub memory: f64,
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seconds, evaluations, memory } = self;
        let megabytes = memory / 1e6;
        write!(f, "{seconds:.2} s of a processor, {megabytes:.0} MB, {evaluations:.1e} evaluations")
    }
}

/// Counts of a whole, and the most of any one Laplace variable.
#[derive(Default)]
struct Total {
    sum: Counts,
    most: Counts,
}

impl Quadrature {
    /// Cost of the blocks `missing`, and of the passivity gate if that is `open`.
    pub(super) fn cost(&self, missing: Range<usize>, open: bool) -> Result<Cost> {
        let total = self.counted(missing.clone(), open, &mut Workspace::default())?;
        Ok(self.priced(&total, missing))
    }

    /// Error if that is more than `limit` seconds.
    pub(super) fn afford(&self, missing: Range<usize>, open: bool, limit: f64) -> Result<()> {
        // Most grounds are told without an evaluation: as if every point of the circles were sampled.
        let circles = missing.clone().map(|number| Block::circle(number, self.tolerance));
        let points: usize = circles.map(Circle::points).sum();
        let shortest = 6.0 / self.time_step;
        let panels = self.integrals.widest(&self.profile, Complex::real(shortest))? as f64;
        let layers = self.profile.layers().len() as f64;
        let pairs = PRODUCT * (6 * LANES * self.integrals.forms.blocks()) as f64;
        let each = POINTS as f64 * panels * (EVALUATION + LAYER * layers + pairs);
        let samples = (points + passivity::POINTS) as f64 * self.stages.count() as f64;
        if 1e-9 * MOST_HALVING * samples * each <= limit {
            return Ok(());
        }
        let total = self.counted(missing.clone(), open, &mut Workspace::default())?;
        let seconds = self.priced(&total, missing.clone()).seconds;
        if seconds <= limit {
            return Ok(());
        }
        let cure = if 2.0 * total.sum.deep > total.sum.integrals {
            "a thicker top layer"
        } else if self.profile.soils().any(|(_, damping)| damping.identity() == Elastic.identity())
        {
            "damping of every layer"
        } else {
            "a longer time step"
        };
        let top = self.profile.layers().first();
        Err(LayeredError::TooCostly {
            seconds,
            limit,
            lags: missing.end.checked_sub(1).map_or(1, Block::last),
            time_step: self.time_step,
            element: self.integrals.shortest,
            layer: top.map_or(f64::INFINITY, |layer| layer.thickness),
            cure,
        }
        .into())
    }

    /// Counts of all samples, by a look at some of each eigenvalue.
    fn counted(&self, missing: Range<usize>, open: bool, work: &mut Workspace) -> Result<Total> {
        let mut total = Total::default();
        let gate = || passivity::places().filter(|_| open);
        for (node, blocks) in self.samples(missing, work)?.into_iter().enumerate() {
            let mut samples: Vec<_> = gate().chain(blocks.into_iter().flatten()).collect();
            samples.sort_by(|[one, a], [two, b]| a.total_cmp(b).then(one.total_cmp(two)));
            let stride = samples.len().div_ceil(LOOKED_AT).max(1);
            for some in samples.chunks(stride) {
                for node in self.nodes(some[some.len() / 2]).skip(node).take(1) {
                    let counts = self.integrals.counts(&self.profile, self.variable(node), work)?;
                    total.sum = total.sum.with(&counts, |sum, one| sum + some.len() as f64 * one);
                    total.most = total.most.with(&counts, f64::max);
                }
            }
        }
        Ok(total)
    }

    /// Numbers of samples of all eigenvalues, block by block.
    pub(super) fn expected(&self, missing: Range<usize>) -> Result<Vec<usize>> {
        let samples = self.samples(missing.clone(), &mut Workspace::default())?;
        let of_block = |place: usize| samples.iter().map(|blocks| blocks[place].len()).sum();
        Ok((0..missing.len()).map(of_block).collect())
    }

    /// Where shares of the eigenvalues in the mobility will be evaluated, as far as two wavenumbers tell: ln |z| and
    /// angle, block by block.
    fn samples(
        &self,
        missing: Range<usize>,
        work: &mut Workspace,
    ) -> Result<Vec<Vec<Vec<[f64; 2]>>>> {
        let of_node = |(node, panels): (usize, &Panels)| {
            let mut met: HashMap<Place, bool> = HashMap::new();
            let of_block = |number: usize| {
                let circle = Block::circle(number, self.tolerance);
                let mut samples = vec![];
                let (_, alone) = circle.covered(node, |places| {
                    let resolved = |place: &Place| {
                        let known = panels.known(*place).or_else(|| met.get(place).copied());
                        if let Some(known) = known {
                            return Ok(known);
                        }
                        samples.extend(place.places());
                        let found = self.looks_resolved(node, *place, work)?;
                        met.insert(*place, found);
                        Ok(found)
                    };
                    places.iter().map(resolved).collect()
                })?;
                samples.extend(alone.iter().map(|p| [circle.logarithm, circle.angle(*p)]));
                Ok(samples)
            };
            missing.clone().map(of_block).collect()
        };
        self.panels.iter().enumerate().map(of_node).collect()
    }

    /// Whether a panel is resolved for the surface compliance at two wavenumbers, and for waves along the patch.
    fn looks_resolved(&self, node: usize, place: Place, work: &mut Workspace) -> Result<bool> {
        let span = self.integrals.span;
        let mut values = vec![];
        for point in place.places() {
            let over = contour::factor(node, point).inverse();
            for node in self.nodes(point).skip(node).take(1) {
                work.compliance.set(&self.profile, self.variable(node))?;
                work.evaluations += WAVENUMBERS.len();
                let (_, q2, _) = work.compliance.top();
                let turn = q2.sqrt().scale(span);
                let one = Complex::real(1.0);
                let weight = node.weight * over * (one + (-turn).exp() / (one + turn));
                for wavenumber in WAVENUMBERS {
                    let c = work.compliance.at(wavenumber / span);
                    values.extend([c.zz, c.xx, c.xz].map(|value| weight * value));
                }
            }
        }
        let coefficients = contour::transformed(&values);
        Ok(contour::is_resolved(&coefficients, &[[0; 2], [1; 2]], self.tolerance))
    }

    fn priced(&self, Total { sum, most }: &Total, missing: Range<usize>) -> Cost {
        const ROW: f64 = size_of::<FormRow>() as f64;
        let forms = &self.integrals.forms;
        let (classes, blocks) = (self.classes as f64, forms.blocks() as f64);
        let (points, degrees) = (POINTS as f64, DEGREES as f64);
        // Tables are made once as far as there is room, and again for every use beyond.
        let mut factors = 0.0;
        let mut tables = 0.0;
        let narrow = sum.panels - sum.wide;
        let rows = [
            (points, points, narrow - sum.halved, most.panels - most.wide),
            (degrees, forms.projection(), sum.halved, most.halved),
        ];
        for ((rows, made, panels, longest), room) in rows.into_iter().zip(forms.room()) {
            let kept = longest.min(room as f64);
            let again = if longest > kept { panels * (1.0 - kept / longest) } else { 0.0 };
            factors += (kept + again) * made * classes;
            tables += kept * rows * blocks * ROW;
        }
        // No more wide panels than narrow ones up to K.
        let wide = sum.wide.min(most.reach);
        let products = 6.0
            * LANES as f64
            * blocks
            * (points * (sum.panels - sum.halved) + degrees * sum.halved);
        let circle = |number| Block::circle(number, self.tolerance);
        let on_circles: usize = missing.clone().map(|number| circle(number).points()).sum();
        let nanoseconds = LAYER * sum.layers
            + EVALUATION * sum.evaluations
            + MOMENTS * sum.halves
            + FORM_FACTOR * factors
            + WIDE * wide * classes
            + PRODUCT * products
            + POINT * on_circles as f64 * classes;
        let last = circle(missing.end.saturating_sub(1));
        let lags = missing.end.checked_sub(1).map_or(0, Block::last);
        let numbers = 24.0 * classes * lags as f64 + 48.0 * classes * last.points() as f64;
        let memory = tables + wide * points * blocks * ROW + numbers;
        Cost { seconds: 1e-9 * nanoseconds, evaluations: sum.evaluations, memory }
    }
}

#[cfg(test)]
mod tests;
