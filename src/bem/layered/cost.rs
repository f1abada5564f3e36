//! Estimate of the cost of a layered ground's convolution weights, before they are computed.
//!
//! Work is counted and not timed. Where the contours are sampled is estimated from the panels of some samples. What
//! samples cost is found at some of them, by all that an integral needs but its pairs.

use std::collections::HashMap;
use std::fmt;
use std::ops::Range;

use super::coefficients::{Block, DOUBT, Quadrature};
use super::contour::{Panels, Place};
use super::form_factors::{DEGREES, FormRow, LANES, POINTS, Panel};
use super::passivity;
use super::wavenumber::{Compliances, Counts, Wavenumbers, Workspace};
use crate::error::{LayeredError, Result};
use crate::history::KINDS;
use crate::linalg::Complex;
use crate::soil::{Elastic, Relaxation};

/// Nanoseconds of one thread for an evaluation of the surface compliance, for each layer in it after the
/// first, for its moments if its panel is halved, for a form factor, for a product of the two, for the form
/// factors of a pair on a wide panel, and for a class at a point of a circle.
/// Measured (`benches/studies/src/layered_cost.rs`).
const EVALUATION: f64 = 95.0;
const LAYER: f64 = 130.0;
const MOMENTS: f64 = 20.0;
const FORM_FACTOR: f64 = 50.0;
const PRODUCT: f64 = 0.25;
const WIDE: f64 = 2500.0;
const POINT: f64 = 170.0;

/// Samples per additional sample: errors of the integrals keep panels from being resolved that look so. Measured
/// (`cost/tests.rs`).
const MISJUDGED: usize = 5;
/// Samples for each that a look stands for.
const SUMMED: f64 = 1.0 + 1.0 / MISJUDGED as f64;
/// Samples of each eigenvalue that are evaluated for the estimate.
const LOOKED_AT: usize = 16;
/// Halving makes no integral so many times as long as its panels, as a rule.
pub(in crate::bem) const MOST_HALVING: f64 = 50.0;

/// Cost of convolution weights before the first step: by counting, not by a clock, so that it is the same
/// everywhere.
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

/// Counts of a whole.
#[derive(Default)]
struct Total {
    sum: Counts,
    /// Panels, and whether they are halved, of the samples that were evaluated.
    met: HashMap<(Panel, bool), Met>,
}

/// Samples of each eigenvalue, block by block: ln |z| and angle.
pub(crate) struct Outlook(Vec<Vec<Vec<[f64; 2]>>>);

impl Outlook {
    /// Numbers of samples of all eigenvalues, block by block.
    pub(crate) fn counts(&self) -> impl Iterator<Item = usize> {
        let blocks = self.0.first().map_or(0, Vec::len);
        (0..blocks).map(|place| {
            let looked: usize = self.0.iter().map(|blocks| blocks[place].len()).sum();
            looked + looked / MISJUDGED
        })
    }
}

/// Looks that met a panel, and how often all samples do.
#[derive(Clone, Copy, Default)]
struct Met {
    looks: usize,
    uses: f64,
}

/// Number of all kinds of which some were met, by those that were met once and twice (Chao, Scand. J. Statist. 11, 1984).
fn distinct(met: &[Met]) -> f64 {
    let of = |looks: usize| met.iter().filter(|met| met.looks == looks).count() as f64;
    let (once, twice) = (of(1), of(2));
    let uses: f64 = met.iter().map(|met| met.uses).sum();
    uses.min(met.len() as f64 + once * (once - 1.0) / (2.0 * (twice + 1.0)))
}

impl<I: Compliances<KINDS>, const KINDS: usize> Quadrature<I, KINDS> {
    /// Panels in which contributions of the eigenvalues to the mobility will be evaluated, as far as one wavenumber
    /// shows.
    pub(crate) fn outlook(
        &self,
        missing: Range<usize>,
        work: &mut I::Workspace,
    ) -> Result<Outlook> {
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
                        let looks = self.looks(node, *place, work)?;
                        if looks(DOUBT) {
                            samples.extend(place.places());
                        }
                        met.insert(*place, looks(1.0));
                        Ok(looks(1.0))
                    };
                    places.iter().map(resolved).collect()
                })?;
                samples.extend(alone.iter().map(|p| [circle.logarithm, circle.angle(*p)]));
                Ok(samples)
            };
            missing.clone().map(of_block).collect()
        };
        self.panels.iter().enumerate().map(of_node).collect::<Result<_>>().map(Outlook)
    }
}

/// Compliances whose cost is known beforehand.
pub(crate) trait Priced<const KINDS: usize>: Compliances<KINDS> + Sized {
    /// Shortest side of an element, m.
    fn shortest(&self) -> f64;

    /// Most seconds that `samples` of the mobility take, and the gate for a matrix of order `gate`, estimated without
    /// an evaluation.
    ///
    /// # Errors
    /// As for [`Compliances::compliance`].
    fn most(quadrature: &Quadrature<Self, KINDS>, samples: f64, gate: Option<usize>)
    -> Result<f64>;

    /// Cost of the blocks `missing`, of which `outlook` has the samples, and of the gate for a matrix of order `gate`;
    /// and what would lower it most.
    ///
    /// # Errors
    /// As for [`Compliances::compliance`].
    fn cost(
        quadrature: &Quadrature<Self, KINDS>,
        outlook: &Outlook,
        missing: Range<usize>,
        gate: Option<usize>,
    ) -> Result<(Cost, &'static str)>;
}

impl<I: Priced<KINDS>, const KINDS: usize> Quadrature<I, KINDS> {
    /// Cost of the blocks `missing`, and of the gate for a matrix of order `gate`; and what would lower it most.
    pub(super) fn cost(
        &self,
        missing: Range<usize>,
        gate: Option<usize>,
    ) -> Result<(Cost, &'static str)> {
        let outlook = self.outlook(missing.clone(), &mut I::Workspace::default())?;
        I::cost(self, &outlook, missing, gate)
    }

    /// Error if that is more than `limit` seconds, with the `outlook` of these blocks if it is known.
    pub(super) fn afford(
        &self,
        missing: Range<usize>,
        gate: Option<usize>,
        limit: f64,
        outlook: Option<&Outlook>,
    ) -> Result<()> {
        // Most grounds are estimated without an evaluation: as if every point of the circles were sampled.
        let samples = (self.points(&missing) + passivity::POINTS) * self.stages.count();
        if I::most(self, samples as f64, gate)? <= limit {
            return Ok(());
        }
        let (Cost { seconds, .. }, cure) = match outlook {
            Some(outlook) => I::cost(self, outlook, missing.clone(), gate)?,
            None => self.cost(missing.clone(), gate)?,
        };
        if seconds <= limit {
            return Ok(());
        }
        let top = self.profile.layers().first();
        Err(LayeredError::TooCostly {
            seconds,
            limit,
            lags: missing.end.checked_sub(1).map_or(1, Block::last),
            time_step: self.time_step,
            element: self.integrals.shortest(),
            layer: top.map_or(f64::INFINITY, |layer| layer.thickness),
            cure,
        }
        .into())
    }

    /// Calls `look` with the Laplace variables of some samples of each eigenvalue, and of the gate if that is `open`,
    /// and the number of samples that each stands for.
    pub(in crate::bem) fn look(
        &self,
        Outlook(nodes): &Outlook,
        open: bool,
        mut look: impl FnMut(Complex, f64) -> Result<()>,
    ) -> Result<()> {
        for (number, blocks) in nodes.iter().enumerate() {
            let gate = passivity::places().filter(|_| open);
            let mut samples: Vec<_> = gate.chain(blocks.iter().flatten().copied()).collect();
            samples.sort_by(|[one, a], [two, b]| a.total_cmp(b).then(one.total_cmp(two)));
            let stride = samples.len().div_ceil(LOOKED_AT).max(1);
            for some in samples.chunks(stride) {
                let Some(node) = self.nodes(some[some.len() / 2]).nth(number) else { continue };
                look(self.variable(node), SUMMED * some.len() as f64)?;
            }
        }
        Ok(())
    }

    /// Points of the circles of some blocks.
    pub(in crate::bem) fn points(&self, blocks: &Range<usize>) -> usize {
        blocks.clone().map(|number| Block::circle(number, self.tolerance).points()).sum()
    }

    /// Most bytes of the first `blocks` blocks while the last is made.
    pub(in crate::bem) fn memory(&self, blocks: usize) -> f64 {
        let Some(last) = blocks.checked_sub(1) else { return 0.0 };
        let points = Block::circle(last, self.tolerance).points() as f64;
        let own = 8.0 * Block::last(last) as f64 + size_of::<Complex>() as f64 * points;
        own * (KINDS * self.classes) as f64
    }
}

impl Priced<KINDS> for Wavenumbers {
    fn shortest(&self) -> f64 {
        self.shortest
    }

    fn most(quadrature: &Quadrature, samples: f64, _gate: Option<usize>) -> Result<f64> {
        let Quadrature { integrals, profile, time_step, .. } = quadrature;
        let panels = integrals.widest(profile, Complex::real(6.0 / time_step))? as f64;
        let layers = profile.layers().len() as f64;
        let pairs = PRODUCT * (6 * LANES * integrals.forms.blocks()) as f64;
        let each = POINTS as f64 * panels * (EVALUATION + LAYER * layers + pairs);
        Ok(1e-9 * MOST_HALVING * samples * each)
    }

    fn cost(
        quadrature: &Quadrature,
        outlook: &Outlook,
        missing: Range<usize>,
        gate: Option<usize>,
    ) -> Result<(Cost, &'static str)> {
        let total = quadrature.total(outlook, gate.is_some(), &mut Workspace::default())?;
        let damping = |law: &dyn Relaxation| law.identity() == Elastic.identity();
        let cure = if 2.0 * total.sum.deep > total.sum.integrals {
            "a thicker top layer"
        } else if quadrature.profile.soils().any(|(_, law)| damping(law)) {
            "damping of every layer"
        } else {
            "a longer time step"
        };
        Ok((quadrature.priced(&total, missing), cure))
    }
}

impl Quadrature {
    /// Counts of all samples, by a look at some of each eigenvalue.
    fn total(&self, outlook: &Outlook, open: bool, work: &mut Workspace) -> Result<Total> {
        let mut total = Total::default();
        self.look(outlook, open, |s, uses| {
            let met = &mut total.met;
            let meet = |panel: Panel, halved: bool| {
                let met = met.entry((panel, halved)).or_default();
                *met = Met { looks: met.looks + 1, uses: met.uses + uses };
            };
            let counts = self.integrals.counts(&self.profile, s, work, meet)?;
            total.sum = total.sum.with(&counts, |sum, one| sum + uses * one);
            Ok(())
        })?;
        Ok(total)
    }

    /// Tables of the narrowest panels, wide and halved ones: those that are kept, and how often they are made.
    fn tables(&self, met: &HashMap<(Panel, bool), Met>) -> [[f64; 2]; 3] {
        let forms = &self.integrals.forms;
        [(false, false), (true, false), (false, true)].map(|kind| {
            let mut beyond = 0.0;
            let mut kept = vec![];
            for ((panel, halved), met) in met {
                if (panel.level > 0, *halved) != kind {
                } else if forms.keeps(*panel, *halved) {
                    kept.push(*met);
                } else {
                    beyond += met.uses;
                }
            }
            // Made once as far as there is room, and again for every use beyond.
            [distinct(&kept), distinct(&kept) + beyond]
        })
    }

    fn priced(&self, Total { sum, met }: &Total, missing: Range<usize>) -> Cost {
        const ROW: f64 = size_of::<FormRow>() as f64;
        let forms = &self.integrals.forms;
        let (classes, blocks) = (self.classes as f64, forms.blocks() as f64);
        let (points, degrees) = (POINTS as f64, DEGREES as f64);
        let [narrow, wide, halved] = self.tables(met);
        let factors = (points * narrow[1] + forms.projection() * halved[1]) * classes;
        let rows = points * (narrow[0] + wide[0]) + degrees * halved[0];
        let products = 6.0
            * LANES as f64
            * blocks
            * (points * (sum.panels - sum.halved) + degrees * sum.halved);
        let nanoseconds = LAYER * sum.layers
            + EVALUATION * sum.evaluations
            + MOMENTS * sum.halves
            + FORM_FACTOR * factors
            + WIDE * wide[1] * classes
            + PRODUCT * products
            + POINT * self.points(&missing) as f64 * classes;
        let memory = rows * blocks * ROW + self.memory(missing.end);
        Cost { seconds: 1e-9 * nanoseconds, evaluations: sum.evaluations, memory }
    }
}

#[cfg(test)]
mod tests;
