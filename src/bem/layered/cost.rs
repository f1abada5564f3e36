//! What the coefficients of a layered ground cost, before it is paid.
//!
//! Work is counted and not timed: panels of the wavenumber integrals by their formula, halved ones by
//! halving some of them, at some points of the circle of the last block. Points of smaller blocks and of
//! the passivity gate lie on the same contour but for their distance to the imaginary axis, and are
//! taken to cost the same. Only `on_circles` knows at how many points the compliances are evaluated.

use std::fmt;
use std::ops::Range;

use super::coefficients::{Block, Circle, Quadrature};
use super::form_factors::{DEGREES, DofCombination, LANES, POINTS};
use super::passivity;
use super::runge_kutta::on_circle;
use super::wavenumber::{Counts, Workspace};
use crate::error::{LayeredError, Result};
use crate::linalg::Complex;

/// Nanoseconds of one thread for an evaluation of the surface compliance, for each layer in it after the
/// first, for its moments if its panel is halved, for a form factor, and for a product of the two.
/// Measured (`benches/studies/src/layered_cost.rs`).
const EVALUATION: f64 = 95.0;
const LAYER: f64 = 130.0;
const MOMENTS: f64 = 110.0;
const FORM_FACTOR: f64 = 50.0;
const PRODUCT: f64 = 0.25;

/// Points of the circle that are looked at grow by this factor.
const APART: f64 = 1.4;
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
struct Total {
    sum: Counts,
    most: Counts,
}

impl Quadrature {
    /// Cost of the blocks `missing`, and of the passivity gate if that is `open`.
    pub(super) fn cost(&self, missing: Range<usize>, open: bool) -> Result<Cost> {
        let mut work = Workspace::default();
        let count = |s| self.integrals.counts(&self.profile, s, &mut work);
        let total = self.on_circles(missing.clone(), open, count)?;
        Ok(self.priced(&total, missing))
    }

    /// Error if that is more than `limit` seconds.
    pub(super) fn afford(&self, missing: Range<usize>, open: bool, limit: f64) -> Result<()> {
        let count = |s| self.integrals.counts_of_panels(&self.profile, s);
        let whole = self.on_circles(missing.clone(), open, count)?;
        let least = self.priced(&whole, missing.clone()).seconds;
        // Most grounds are told without an evaluation.
        if MOST_HALVING * least <= limit {
            return Ok(());
        }
        let seconds = self.cost(missing.clone(), open)?.seconds;
        if seconds <= limit {
            return Ok(());
        }
        let cure = if seconds > 3.0 * least {
            "damping of every layer"
        } else if 2.0 * whole.sum.deep > whole.sum.panels {
            "a thicker top layer"
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

    /// Counts of all points of the circles of the blocks `missing`, and of the gate if that is `open`,
    /// with those of one Laplace variable by `count`.
    fn on_circles(
        &self,
        missing: Range<usize>,
        open: bool,
        mut count: impl FnMut(Complex) -> Result<Counts>,
    ) -> Result<Total> {
        let circle = |number| Circle::new(number, self.tolerance);
        let points: usize = missing.clone().map(|number| circle(number).points()).sum();
        let all = points + if open { passivity::POINTS } else { 0 };
        let last = circle(missing.end.saturating_sub(1));
        let [mut sum, mut most] = [Counts::default(); 2];
        // Every point looked at stands for those before it that are nearer to it than to the last.
        let (mut place, mut done) = (0, 0.0);
        loop {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
            let next = (place + 1).max((place as f64 * APART) as usize).min(last.points() - 1);
            let end =
                if next > place { 0.5 * (place + next + 1) as f64 } else { last.points() as f64 };
            let share = (end - done) / last.points() as f64;
            let [z, rest] = on_circle(last.logarithm, last.angle(place));
            for node in self.stages.nodes(z, rest) {
                let counts = count(node.lambda.scale(1.0 / self.time_step))?;
                sum = sum.with(&counts, |sum, one| sum + all as f64 * share * one);
                most = most.with(&counts, f64::max);
            }
            if next == place {
                return Ok(Total { sum, most });
            }
            (place, done) = (next, end);
        }
    }

    fn priced(&self, Total { sum, most }: &Total, missing: Range<usize>) -> Cost {
        const ROW: f64 = size_of::<DofCombination>() as f64;
        let forms = &self.integrals.forms;
        let (classes, blocks) = (self.classes as f64, forms.blocks() as f64);
        let (points, degrees) = (POINTS as f64, DEGREES as f64);
        // Tables are made once as far as there is room, and again for every use beyond.
        let mut factors = 0.0;
        let mut tables = 0.0;
        let rows = [
            (points, points, sum.panels, most.panels),
            (degrees, forms.projection(), sum.halved, most.halved),
        ];
        for ((rows, made, panels, longest), room) in rows.into_iter().zip(forms.room()) {
            let kept = longest.min(room as f64);
            let again = if longest > kept { panels * (1.0 - kept / longest) } else { 0.0 };
            factors += (kept + again) * made * classes;
            tables += kept * rows * blocks * ROW;
        }
        let products = 6.0
            * LANES as f64
            * blocks
            * (points * (sum.panels - sum.halved) + degrees * sum.halved);
        let evaluations = points * sum.panels + sum.halves;
        let nanoseconds = LAYER * sum.layers
            + EVALUATION * evaluations
            + MOMENTS * sum.halves
            + FORM_FACTOR * factors
            + PRODUCT * products;
        let last = Circle::new(missing.end.saturating_sub(1), self.tolerance);
        let lags = missing.end.checked_sub(1).map_or(0, Block::last);
        let numbers = 24.0 * classes * lags as f64 + 48.0 * classes * last.points() as f64;
        Cost { seconds: 1e-9 * nanoseconds, evaluations, memory: tables + numbers }
    }
}

#[cfg(test)]
mod tests;
