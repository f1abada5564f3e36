//! Step coefficients of a ground under cells of a lattice.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::OnceLock;

use super::cells::Plan;
use super::cost;
use super::integrals::{Integrals, Workspace};
use crate::bem::layered::{
    Block, Compliances, Cost, GATE_POINTS, KeptBlocks, Quadrature, Samples, Stages, copy_lags,
    last_block, on_circle, passive, threads,
};
use crate::error::{Error, Observer, Result, Watch, memory, positive, same_length};
use crate::geometry::{Lattice, SERIES, SPACE};
use crate::history::{ConvolutionWeights, PairClasses, SharedSpectra};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Cells that pass the gate all together; of more, so many at random.
const ALL_CELLS: usize = 512;
const SOME_CELLS: usize = 256;
/// Points of the unit circle on which the largest Laplace variable is looked for, and what it may miss.
const REACH_POINTS: usize = 256;
const REACH_MARGIN: f64 = 1.02;

/// Cells of a plan that pass the gate, and all, if these are too many.
pub(in crate::bem) fn gate_sample(plan: &Plan) -> Option<[usize; 2]> {
    (plan.count() > ALL_CELLS).then_some([SOME_CELLS, plan.count()])
}

/// Absolute errors of late lags, summed, over the 2/3 power of the tolerance and the sum of all coefficients. Measured: 0.4
/// to 4.8 (8 × 8 cells, half-space and damped layer, two steps, tolerances 1e-13 to 1e-10, to 32 768 lags).
const LATE_ERROR: f64 = 5.0;

/// Overwrites `matrix` (3Q × 3Q, row-major, m/Pa) with the mean static displacements of the cells of a plan.
pub(in crate::bem) fn static_compliance(
    profile: &SoilProfile,
    plan: &Plan,
    tolerance: f64,
    matrix: &mut [f64],
) -> Result<()> {
    let classes = plan.classes()?;
    same_length("static compliance", matrix.len(), classes.layout().square())?;
    let (s, mut watch) = (Complex::default(), Watch::nobody());
    let integrals = Integrals::new(&plan.lattice, profile, [s], tolerance, &mut watch)?;
    let mut values = vec![[Complex::default(); SERIES]; classes.count()];
    integrals.compliance(profile, s, &mut Workspace::default(), &mut values)?;
    classes.scatter(matrix, |_, pair| values[pair.class].map(|value| pair.scale * value.re));
    Ok(())
}

/// Step coefficients by Runge–Kutta convolution quadrature, in blocks of lags that are computed when they are needed
/// first: those of the [layered ground](crate::bem::layered::LayeredKernel), of six kinds.
#[derive(Debug)]
pub(in crate::bem) struct LatticeKernel {
    profile: SoilProfile,
    lattice: Lattice,
    classes: PairClasses,
    stages: Stages,
    time_step: f64,
    tolerance: f64,
    quadrature: OnceLock<Result<Quadrature<Integrals, SERIES>>>,
    kept: KeptBlocks,
    spectra: SharedSpectra,
    /// Most processor time that coefficients may take, s.
    limit: f64,
}

impl LatticeKernel {
    /// Kernel of `profile` under the cells of `plan` for steps of `time_step` seconds, to a relative `tolerance`, with
    /// coefficients from a file if it is given and has them, and at most `limit` seconds of a processor for others.
    ///
    /// # Errors
    /// [`Error::Input`] for a bad time step, [`LayeredError::NotCausal`](crate::LayeredError::NotCausal).
    pub(in crate::bem) fn new(
        profile: SoilProfile,
        plan: &Plan,
        [time_step, tolerance, limit]: [f64; 3],
        stages: Stages,
        file: Option<PathBuf>,
    ) -> Result<Self> {
        positive("time step", time_step)?;
        profile.check()?;
        profile.check_causal()?;
        let classes = plan.classes()?;
        let (lattice, count) = (plan.lattice.clone(), classes.count());
        Ok(Self {
            profile,
            lattice,
            classes,
            stages,
            time_step,
            tolerance,
            quadrature: OnceLock::new(),
            kept: KeptBlocks::new([count, SERIES], file),
            spectra: SharedSpectra::default(),
            limit,
        })
    }

    /// The quadrature without its forms.
    fn sketch(&self) -> Result<Quadrature<Integrals, SERIES>> {
        // λ is analytic in the unit disc, and so is √q₂: the largest lie on its edge.
        let nodes = (0..=REACH_POINTS).flat_map(|point| {
            let angle = std::f64::consts::PI * point as f64 / REACH_POINTS as f64;
            let [z, rest] = on_circle(0.0, angle);
            self.stages.nodes(z, rest)
        });
        let list = nodes.map(|node| node.lambda.scale(REACH_MARGIN / self.time_step));
        let integrals = Integrals::sketch(&self.lattice, &self.profile, list, self.tolerance)?;
        let own = vec![[0; 2]; self.classes.count()];
        let sizes = [self.time_step, self.tolerance];
        Ok(Quadrature::of(self.profile.clone(), integrals, own, self.stages, sizes))
    }

    /// The quadrature, made now if it has not been.
    fn quadrature(&self, watch: &mut Watch) -> Result<&Quadrature<Integrals, SERIES>> {
        self.kept.once(&self.quadrature, watch, |watch| {
            let mut quadrature = self.sketch()?;
            quadrature.integrals.table.tabulate(watch)?;
            Ok(quadrature)
        })
    }

    /// What the coefficients up to lag `lags` cost.
    pub(in crate::bem) fn cost(&self, lags: usize) -> Result<Cost> {
        cost::cost(&self.sketch()?, 0..last_block(lags.max(1))? + 1, Some(self.gate_order()))
    }

    /// Cells that pass the gate, times three.
    fn gate_order(&self) -> usize {
        let cells = self.classes.elements().len();
        SPACE * if cells <= ALL_CELLS { cells } else { SOME_CELLS }
    }

    /// Passes the gate, unless what is missing of the blocks of `wanted` costs too much: quadrature and fingerprint of the
    /// coefficients.
    fn admit(
        &self,
        wanted: Range<usize>,
        watch: &mut Watch,
    ) -> Result<(&Quadrature<Integrals, SERIES>, u64)> {
        let gate = (!self.kept.is_checked()).then(|| self.gate_order());
        let missing = self.kept.missing(wanted.clone());
        // A file may hold all that is wanted.
        let late = gate.is_some() && self.kept.file.is_some();
        if gate.is_some() || !missing.is_empty() {
            let first = if late { 0..0 } else { missing };
            match self.quadrature.get() {
                Some(Ok(quadrature)) => cost::afford(quadrature, first, gate, self.limit)?,
                _ => cost::afford(&self.sketch()?, first, gate, self.limit)?,
            }
        }
        let quadrature = self.quadrature(watch)?;
        let fingerprint = self.kept.gate(watch, |watch| {
            let Lattice { pitch, counts } = &self.lattice;
            let sizes = pitch.iter().copied().chain(counts.iter().map(|count| *count as f64));
            let cells = self.classes.plan().map_or(&[][..], |(_, cells)| cells);
            if cells.len() <= ALL_CELLS {
                return passive(quadrature, &self.classes, sizes, watch);
            }
            let some = PairClasses::in_plan(self.lattice.clone(), scattered(cells), 0.0)?;
            passive(quadrature, &some, sizes, watch)
        })?;
        let rest = self.kept.missing(wanted);
        if late && !rest.is_empty() {
            cost::afford(quadrature, rest, None, self.limit)?;
        }
        Ok((quadrature, fingerprint))
    }

    /// Block `number`, computed now if it has not been.
    fn block(&self, number: usize, watch: &mut Watch, before: usize) -> Result<&Block> {
        let (quadrature, _) = self.admit(number..number + 1, watch)?;
        self.kept.block(number, watch, |watch| {
            let expected = before..before + self.samples(number);
            quadrature.block(number, threads(), Samples::new(watch, expected))
        })
    }

    /// Most samples of block `number`.
    fn samples(&self, number: usize) -> usize {
        self.stages.count() * Block::circle(number, self.tolerance).points()
    }

    /// Error unless the blocks up to number `last` may be in memory.
    fn fits(&self, last: usize) -> Result<()> {
        let bytes = cost::memory(last + 1, self.classes.count(), self.tolerance);
        Ok(memory::check("lags of a ground in plan", Block::last(last) as f64, bytes)?)
    }

    fn make_ready(&self, lags: usize, observer: Option<&mut Observer<'_>>) -> Result<()> {
        let last = last_block(lags.max(1))?;
        let missing = self.kept.missing(0..last + 1);
        if missing.is_empty() {
            return Ok(());
        }
        self.fits(last)?;
        let total = GATE_POINTS + missing.clone().map(|number| self.samples(number)).sum::<usize>();
        let mut watch = match observer {
            Some(observer) => Watch::new("step coefficients of a ground in plan", total, observer),
            None => Watch::nobody(),
        };
        let (_, fingerprint) = self.admit(0..last + 1, &mut watch)?;
        let mut done = GATE_POINTS;
        for number in missing {
            self.block(number, &mut watch, done)?;
            done += self.samples(number);
        }
        watch.reach(total)?;
        self.kept.write(fingerprint)
    }
}

/// Some of many cells, without a pattern that a lattice could have.
fn scattered(cells: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut order: Vec<_> = (0..cells.len()).collect();
    let mut state = 1_u64;
    let mut random = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).unwrap_or(0)
    };
    for place in 0..SOME_CELLS.min(cells.len()) {
        let other = place + random() % (cells.len() - place);
        order.swap(place, other);
    }
    order.into_iter().take(SOME_CELLS).map(|place| cells[place]).collect()
}

impl ConvolutionWeights for LatticeKernel {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    fn prepare(&self, lags: usize) -> Result<()> {
        self.make_ready(lags, None)
    }

    fn prepare_observed(&self, lags: usize, observer: &mut Observer<'_>) -> Result<()> {
        self.make_ready(lags, Some(observer))
    }

    fn coefficients(&self, _: usize, _: usize, _: [&mut [f64]; 3]) -> Result<()> {
        Err(NOT_IN_PLAN)
    }

    fn coefficients_in_plan(
        &self,
        class: usize,
        first_lag: usize,
        values: [&mut [f64]; SERIES],
    ) -> Result<()> {
        let bound = self.classes.count();
        if class >= bound {
            let quantity = "class of pairs of cells";
            return Err(Error::Index { quantity, index: class, bound });
        }
        copy_lags(class, first_lag, values, |number| {
            if !self.kept.has(number) {
                self.fits(number)?;
            }
            self.block(number, &mut Watch::nobody(), 0)
        })
    }

    fn late_error(&self) -> f64 {
        LATE_ERROR * self.tolerance.powf(2.0 / 3.0)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        Some(&self.spectra)
    }
}

const NOT_IN_PLAN: Error = Error::Scene {
    quantity: "kernel of a ground in plan",
    needed: "`coefficients_in_plan` of cells of a lattice",
};

#[cfg(test)]
mod tests;
