//! Structures on a bonded strip under a vertically incident pulse, against tables in time.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::State;
use basemat::interface::Bonded;
use basemat::motion::RickerDisplacement;
use basemat::structure::Structure;
use basemat::{Simulation, Soil};

use super::AnyError;
use super::chart::{BLUE, Panel, RED};
use super::outcome::Check;
use super::support::series::{Error, Series, whole};
use super::support::table;

pub(crate) const ELEMENTS: usize = 16;
pub(crate) const TIME_STEP: f64 = 0.05;

/// A column of the table, and the same quantity of a state.
pub(crate) struct Quantity<'a> {
    pub(crate) column: &'a str,
    pub(crate) name: &'a str,
    pub(crate) of: &'a dyn Fn(&State) -> f64,
    /// Whether it is a mean over the step, as forces are.
    pub(crate) mean: bool,
    pub(crate) limit: f64,
}

impl<'a> Quantity<'a> {
    /// A quantity at the end of the step.
    pub(crate) fn at_end(
        column: &'a str,
        name: &'a str,
        of: &'a dyn Fn(&State) -> f64,
        limit: f64,
    ) -> Self {
        Self { column, name, of, mean: false, limit }
    }

    /// A mean over the step.
    pub(crate) fn mean(
        column: &'a str,
        name: &'a str,
        of: &'a dyn Fn(&State) -> f64,
        limit: f64,
    ) -> Self {
        Self { column, name, of, mean: true, limit }
    }
}

/// Histories of one quantity.
pub(crate) struct History {
    pub(crate) name: String,
    pub(crate) error: f64,
    pub(crate) limit: f64,
    times: Vec<f64>,
    found: Vec<f64>,
    wanted: Vec<f64>,
}

/// Runs a structure with unknowns `[u_x, u_y, θ, …]` under the S wave of the tables: a Ricker pulse
/// of the free field with amplitude 1 and σ = 1 about t = 5, in units of b, c_S, μ.
pub(crate) fn histories(
    file: &str,
    structure: impl Structure + 'static,
    poisson: f64,
    quantities: &[Quantity],
) -> Result<(Vec<History>, f64), AnyError> {
    let table = table(file);
    let columns: Vec<_> = quantities.iter().map(|q| Series::new(&table, q.column)).collect();
    let soil = Soil::new(1.0, poisson, 1.0)?;
    let strip = Strip::new(-1.0..1.0, ELEMENTS, Grading::Cosine)?;
    let mut simulation = Simulation::builder(TIME_STEP)
        .structure(structure)
        .ground(ElasticGround::new(soil, strip)?)
        .interface(Bonded)
        .gravity(0.0)
        .motion(RickerDisplacement::new(1.0, 1.0, 5.0)?)
        .build()?;
    let mut histories: Vec<_> = quantities
        .iter()
        .map(|q| History {
            name: q.name.to_owned(),
            error: 0.0,
            limit: q.limit,
            times: Vec::new(),
            found: Vec::new(),
            wanted: Vec::new(),
        })
        .collect();
    let duration = columns.first().ok_or("no quantities")?.duration();
    let run = simulation.run(whole(duration / TIME_STEP), |state| {
        for ((history, q), column) in histories.iter_mut().zip(quantities).zip(&columns) {
            // The force of a step stands for its mean over the step, and belongs to its middle.
            let (time, wanted) = if q.mean {
                (state.time - 0.5 * TIME_STEP, column.mean(state.time, TIME_STEP))
            } else {
                (state.time, column.at(state.time))
            };
            history.times.push(time);
            history.found.push((q.of)(state));
            history.wanted.push(wanted);
        }
    })?;
    for history in &mut histories {
        let mut error = Error::default();
        history.found.iter().zip(&history.wanted).for_each(|(a, b)| error.add(*a, *b));
        history.error = error.relative();
    }
    Ok((histories, run.ledger_residual))
}

/// Checks of the histories, and of the ledger.
pub(crate) fn checks(histories: &[History], ledger: f64) -> Vec<Check> {
    let mut checks: Vec<_> = histories
        .iter()
        .map(|h| Check::below(format!("{}, relative L2", h.name), h.error, h.limit))
        .collect();
    checks.push(Check::below("energy ledger, residual", ledger, 1e-10));
    checks
}

/// A panel with the first 25 b/c_S of a history; what follows is small.
pub(crate) fn panel(history: &History, unit: &str) -> Panel {
    let points = |values: &[f64]| {
        let each = history.times.iter().copied().zip(values.iter().copied());
        each.take_while(|(time, _)| *time <= 25.0).collect()
    };
    Panel::new("t c_S / b", &format!("{}{unit}", history.name))
        .reference("frequency-domain table", RED, points(&history.wanted))
        .line("basemat", BLUE, points(&history.found))
}

/// The base's horizontal displacement.
pub(crate) fn base_motion(state: &State) -> f64 {
    state.absolute_displacement()[0]
}

/// The tables count rotations and moments clockwise.
pub(crate) fn rotation(state: &State) -> f64 {
    -state.absolute_displacement()[2]
}

/// Horizontal force on the soil.
pub(crate) fn shear(state: &State) -> f64 {
    state.base_shear
}

/// Moment on the soil.
pub(crate) fn moment(state: &State) -> f64 {
    -state.base_moment
}
