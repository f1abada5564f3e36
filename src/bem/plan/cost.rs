//! What step coefficients of a ground in plan cost, before it is paid: by counting, as for [strips](crate::bem::layered).

use std::ops::Range;

use super::integrals::{Integrals, Workspace};
use crate::bem::layered::{Block, Cost, GATE_POINTS, Look, POINTS, Quadrature, SUMMED};
use crate::error::{LayeredError, Result};
use crate::geometry::SERIES;
use crate::linalg::Complex;

/// Nanoseconds of one thread for an evaluation of the surface compliance, for each layer in it after the first, for a
/// product of a kernel and a form, for a direction of the forms at a wavenumber and for a product there, for a multiply–add
/// of the gate's factorisation, for an entry of its matrix, and for a class at a point of a circle. Measured.
const EVALUATION: f64 = 200.0;
const LAYER: f64 = 200.0;
const PRODUCT: f64 = 0.2;
const DIRECTION: f64 = 170.0;
const MEAN: f64 = 0.2;
const FACTOR: f64 = 0.1;
const ENTRY: f64 = 15.0;
const POINT: f64 = 300.0;
/// Products for a class at a wavenumber: two numbers of each sum that a form goes into.
const SUMS: f64 = 16.0;
/// Products for an offset of two cells in a direction.
const MEANS: f64 = 5.0;
/// Halving makes no integral so many times as long as its panels, as a rule.
const MOST_HALVING: f64 = 50.0;

type LatticeQuadrature = Quadrature<Integrals, SERIES>;

/// Most bytes of the first `blocks` blocks of so many classes while the last is made.
pub(super) fn memory(blocks: usize, classes: usize, tolerance: f64) -> f64 {
    let Some(last) = blocks.checked_sub(1) else { return 0.0 };
    let points = Block::circle(last, tolerance).points() as f64;
    let own = 8.0 * Block::last(last) as f64 + size_of::<Complex>() as f64 * points;
    own * (SERIES * classes) as f64
}

/// Points of the circles of some blocks.
fn points(blocks: &Range<usize>, tolerance: f64) -> usize {
    blocks.clone().map(|number| Block::circle(number, tolerance).points()).sum()
}

/// Cost of the blocks `missing`, and of the forms and of the gate for so many numbers of contact vectors.
pub(super) fn cost(
    quadrature: &LatticeQuadrature,
    missing: Range<usize>,
    gate: Option<usize>,
) -> Result<Cost> {
    let (table, classes) = (&quadrature.integrals.table, quadrature.classes as f64);
    let layers = quadrature.profile.layers().len() as f64;
    let mut work = Workspace::default();
    let outlook = quadrature.outlook(missing.clone(), &mut work)?;
    let mut nanoseconds = gate.map_or(0.0, |order| {
        let order = order as f64;
        let check = order.powi(2) * (FACTOR * order / 6.0 + ENTRY);
        let offsets = table.offsets() as f64;
        table.directions() as f64 * (DIRECTION + MEAN * MEANS * offsets)
            + GATE_POINTS as f64 * check
    });
    let mut evaluations = 0.0;
    for Look { node, place, samples } in outlook.looks(gate.is_some()) {
        for node in quadrature.nodes(place).skip(node).take(1) {
            let before = work.evaluations;
            let s = quadrature.variable(node);
            let [panels, halved] =
                quadrature.integrals.counts(&quadrature.profile, s, &mut work)?;
            let own = (work.evaluations - before) as f64;
            let samples = SUMMED * samples as f64;
            let rows = (POINTS * (panels + halved)) as f64;
            evaluations += samples * own;
            let each = own * (EVALUATION + LAYER * layers) + rows * classes * SUMS * PRODUCT;
            nanoseconds += samples * each;
        }
    }
    nanoseconds += POINT * points(&missing, quadrature.tolerance) as f64 * classes;
    let memory = table.memory() + memory(missing.end, quadrature.classes, quadrature.tolerance);
    Ok(Cost { seconds: 1e-9 * nanoseconds, evaluations, memory })
}

/// Error if that is more than `limit` seconds.
pub(super) fn afford(
    quadrature: &LatticeQuadrature,
    missing: Range<usize>,
    gate: Option<usize>,
    limit: f64,
) -> Result<()> {
    let table = &quadrature.integrals.table;
    let layers = quadrature.profile.layers().len() as f64;
    // Most grounds are told without an evaluation: as if every point of the circles were sampled.
    let points = points(&missing, quadrature.tolerance);
    let each =
        MOST_HALVING * (EVALUATION + LAYER * layers) + SUMS * PRODUCT * quadrature.classes as f64;
    let samples = ((points + GATE_POINTS) * quadrature.stages.count()) as f64;
    if gate.is_none() && 1e-9 * samples * (POINTS * table.most_panels()) as f64 * each <= limit {
        return Ok(());
    }
    let Cost { seconds, .. } = cost(quadrature, missing.clone(), gate)?;
    if seconds <= limit {
        return Ok(());
    }
    let top = quadrature.profile.layers().first();
    Err(LayeredError::TooCostly {
        seconds,
        limit,
        lags: missing.end.checked_sub(1).map_or(1, Block::last),
        time_step: quadrature.time_step,
        element: quadrature.integrals.finest,
        layer: top.map_or(f64::INFINITY, |layer| layer.thickness),
        cure: "larger cells",
    }
    .into())
}
