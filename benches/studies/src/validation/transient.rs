//! Structures on a bonded strip under a vertically incident pulse, against tables in time.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::State;
use basemat::interface::Bonded;
use basemat::motion::RickerDisplacement;
use basemat::structure::{RigidBlock, Structure};
use basemat::{Simulation, Soil};

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::sampled_block::{base_motion, moment, rotation, shear};
use basemat_problems::series::{RelativeError, TabledSeries, nearest_integer};
use basemat_problems::table;
use basemat_problems::tabled_structures::{Cantilever, three_storeys};

const ELEMENT_COUNT: usize = 16;
const TIME_STEP: f64 = 0.05;

/// A column of the table, and the same quantity of a state.
struct TabledQuantity<'a> {
    column: &'a str,
    name: &'a str,
    value: &'a dyn Fn(&State) -> f64,
    /// Whether it is a mean over the step, as forces are.
    mean: bool,
    limit: f64,
}

impl<'a> TabledQuantity<'a> {
    /// A quantity at the end of the step.
    fn at_end(
        column: &'a str,
        name: &'a str,
        value: &'a dyn Fn(&State) -> f64,
        limit: f64,
    ) -> Self {
        Self { column, name, value, mean: false, limit }
    }

    /// A mean over the step.
    fn mean(column: &'a str, name: &'a str, value: &'a dyn Fn(&State) -> f64, limit: f64) -> Self {
        Self { column, name, value, mean: true, limit }
    }
}

/// Time series of one quantity.
struct QuantitySeries {
    name: String,
    error: f64,
    limit: f64,
    times: Vec<f64>,
    computed: Vec<f64>,
    tabled: Vec<f64>,
}

/// All quantities of a run.
struct TabledRun {
    list: Vec<QuantitySeries>,
    energy_error: f64,
}

/// Runs a structure with degrees of freedom `[u_x, u_y, θ, …]` under the S wave of the tables.
///
/// The free field is a Ricker pulse with amplitude 1 and σ = 1 about t = 5, in units of b, c_S, μ.
fn time_series(
    file: &str,
    structure: impl Structure + 'static,
    poisson: f64,
    quantities: &[TabledQuantity],
) -> Result<TabledRun, AnyError> {
    let table = table(file);
    let columns: Vec<_> = quantities
        .iter()
        .map(|quantity| TabledSeries::new(&table, quantity.column))
        .collect();
    let soil = Soil::new(1.0, poisson, 1.0)?;
    let strip = Strip::new(-1.0..1.0, ELEMENT_COUNT, Grading::Cosine)?;
    let mut simulation = Simulation::builder(TIME_STEP)
        .structure(structure)
        .ground(ElasticGround::new(soil, strip)?)
        .interface(Bonded)
        .gravity(0.0)
        .motion(RickerDisplacement::new(1.0, 1.0, 5.0)?)
        .build()?;
    let mut time_series: Vec<_> = quantities
        .iter()
        .map(|quantity| QuantitySeries {
            name: quantity.name.to_owned(),
            error: 0.0,
            limit: quantity.limit,
            times: Vec::new(),
            computed: Vec::new(),
            tabled: Vec::new(),
        })
        .collect();
    let duration = columns.first().ok_or("no quantities")?.duration();
    let run = simulation.run(nearest_integer(duration / TIME_STEP), |state| {
        for ((series, quantity), column) in time_series.iter_mut().zip(quantities).zip(&columns) {
            // The force of a step is its mean over the step, in the middle of the step.
            if quantity.mean {
                series.times.push(state.time - 0.5 * TIME_STEP);
                series.tabled.push(column.mean(state.time, TIME_STEP));
            } else {
                series.times.push(state.time);
                series.tabled.push(column.at(state.time));
            }
            series.computed.push((quantity.value)(state));
        }
    })?;
    for series in &mut time_series {
        let mut error = RelativeError::default();
        series.computed.iter().zip(&series.tabled).for_each(|(a, b)| error.add(*a, *b));
        series.error = error.relative();
    }
    Ok(TabledRun { list: time_series, energy_error: run.energy_error })
}

/// Checks of the time series, and of the energy balance.
fn checks(time_series: &TabledRun) -> Vec<ValidationCheck> {
    let mut checks = Vec::new();
    for series in &time_series.list {
        let name = format!("{}, relative L2", series.name);
        checks.push(ValidationCheck::below(name, series.error, series.limit));
    }
    checks.push(ValidationCheck::below(
        "energy balance, residual",
        time_series.energy_error,
        1e-10,
    ));
    checks
}

/// A panel with the first 25 b/c_S of a series; the rest is small.
fn panel(series: &QuantitySeries, unit: &str) -> FigurePanel {
    let points = |values: &[f64]| {
        let samples = series.times.iter().copied().zip(values.iter().copied());
        samples.take_while(|(time, _)| *time <= 25.0).collect()
    };
    FigurePanel::new("t c_S / b", &format!("{}{unit}", series.name))
        .reference("frequency-domain table", CURVE_RED, points(&series.tabled))
        .line("basemat", CURVE_BLUE, points(&series.computed))
}

pub(crate) const BLOCK_CASE: ValidationCase = ValidationCase {
    name: "block_sv_pulse",
    title: "Rigid block under an SV pulse",
    reference: "frequency-domain tables, Fourier synthesis",
    settings: "16 cosine-graded elements, Δt = 0.05 b/c_S, bonded, six blocks",
    run: blocks,
};

fn block(name: &str, poisson: f64, height: f64, density: f64) -> Result<TabledRun, AnyError> {
    let roof = |state: &State| {
        state.absolute_displacement()[0] - height * state.absolute_displacement()[2]
    };
    time_series(
        &format!("td_block_SV_{name}.csv"),
        RigidBlock::new(2.0, height, density)?,
        poisson,
        &[
            TabledQuantity::at_end("u_base", "base displacement", &base_motion, 4e-3),
            TabledQuantity::at_end("theta", "rotation", &rotation, 7.5e-3),
            TabledQuantity::at_end("u_roof", "roof displacement", &roof, 8e-3),
            TabledQuantity::mean("V", "base shear", &shear, 2.5e-3),
            TabledQuantity::mean("M", "base moment", &moment, 1.3e-2),
        ],
    )
}

fn blocks(short: bool) -> Result<ValidationOutcome, AnyError> {
    let third = 1.0 / 3.0;
    let list = [
        ("nu0333_h2_rho1", third, 2.0, 1.0),
        ("nu025_h2_rho1", 0.25, 2.0, 1.0),
        ("nu0333_h1_rho1", third, 1.0, 1.0),
        ("nu025_h1_rho1", 0.25, 1.0, 1.0),
        ("nu0333_h4_rho0.5", third, 4.0, 0.5),
        ("nu025_h4_rho0.5", 0.25, 4.0, 0.5),
    ];
    let list = if short { &list[..2] } else { &list[..] };
    let mut checks: Vec<ValidationCheck> = Vec::new();
    let mut worst_balance = 0.0_f64;
    let mut shown_curves = Vec::new();
    for (name, poisson, height, density) in list {
        let time_series = block(name, *poisson, *height, *density)?;
        worst_balance = worse(worst_balance, time_series.energy_error);
        for (k, series) in time_series.list.iter().enumerate() {
            match checks.get_mut(k) {
                Some(check) => check.value = worse(check.value, series.error),
                None => checks.push(ValidationCheck::below(
                    format!("{}, relative L2, worst block", series.name),
                    series.error,
                    series.limit,
                )),
            }
        }
        if shown_curves.is_empty() {
            shown_curves = time_series.list;
        }
    }
    checks.push(ValidationCheck::below("energy balance, residual", worst_balance, 1e-10));
    let units = [" / A", " b / A", " / A", " / (μ A)", " / (μ A b)"];
    let panels = [0, 1, 3, 4].map(|k| panel(&shown_curves[k], units[k]));
    let title = "Block of height 2b and the soil's density, ν = 1/3; the free field is a Ricker pulse of amplitude A";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, panels.into()) })
}

pub(crate) const CANTILEVER_CASE: ValidationCase = ValidationCase {
    name: "cantilever",
    title: "Cantilever on the strip",
    reference: "exact beam functions in the frequency domain",
    settings: "8 beams, 16 cosine-graded elements, Δt = 0.05 b/c_S, bonded, ν = 1/3",
    run: cantilever,
};

fn cantilever(_short: bool) -> Result<ValidationOutcome, AnyError> {
    let cantilever = Cantilever::new(8);
    let top = cantilever.top();
    let time_series = time_series(
        "td_EBcantilever_SV_nu0333.csv",
        cantilever,
        1.0 / 3.0,
        &[
            TabledQuantity::at_end("u_base", "base displacement", &base_motion, 3.6e-3),
            TabledQuantity::at_end("theta", "rotation", &rotation, 6.5e-3),
            TabledQuantity::at_end(
                "u_top",
                "top displacement",
                &|state: &State| state.absolute_displacement()[top],
                5.7e-3,
            ),
            // Without the inertia of the base of mass 1.
            TabledQuantity::mean(
                "V_beam",
                "shear at the beam's foot",
                &|state: &State| -state.base_shear - state.acceleration()[0],
                3.4e-3,
            ),
            TabledQuantity::mean("V", "base shear", &shear, 3e-3),
            TabledQuantity::mean("M", "base moment", &moment, 1.25e-2),
        ],
    )?;
    let units = [" / A", " b / A", " / A", " / (μ A)", " / (μ A)", " / (μ A b)"];
    let panels = [0, 2, 3, 5].map(|k| panel(&time_series.list[k], units[k]));
    let title = "Euler–Bernoulli cantilever of height 4b on a massive rigid base, ν = 1/3";
    let figure = Figure::new(title, 2, panels.into());
    Ok(ValidationOutcome { checks: checks(&time_series), figure })
}

pub(crate) const THREE_STOREY_CASE: ValidationCase = ValidationCase {
    name: "three_storeys",
    title: "Three-storey building on the strip",
    reference: "frequency-domain table, Fourier synthesis",
    settings: "16 cosine-graded elements, Δt = 0.05 b/c_S, bonded, ν = 1/3",
    run: storeys,
};

/// Displacement of a floor relative to the frame of the base.
fn floor_motion(state: &State, floor: u8) -> f64 {
    let u = state.absolute_displacement();
    u[2 + usize::from(floor)] - u[0] + f64::from(floor) * u[2]
}

fn storeys(_short: bool) -> Result<ValidationOutcome, AnyError> {
    let building = three_storeys()?;
    let rows = building.shear(0)?;
    let time_series = time_series(
        "td_shearbuilding3_SV_nu0333_sig1.csv",
        building,
        1.0 / 3.0,
        &[
            TabledQuantity::at_end("u_base", "base displacement", &base_motion, 3.1e-3),
            TabledQuantity::at_end("theta", "rotation", &rotation, 4.3e-3),
            TabledQuantity::at_end(
                "v1",
                "first floor, relative",
                &|state| floor_motion(state, 1),
                3.6e-3,
            ),
            TabledQuantity::at_end(
                "v3",
                "third floor, relative",
                &|state| floor_motion(state, 3),
                7.2e-3,
            ),
            TabledQuantity::at_end(
                "V1",
                "first storey's shear",
                &|state: &State| {
                    let velocity = state.velocity();
                    rows.value(state.absolute_displacement(), velocity, state.acceleration())
                },
                3.3e-3,
            ),
            TabledQuantity::mean("V", "base shear", &shear, 2e-3),
            TabledQuantity::mean("M", "base moment", &moment, 1.1e-2),
        ],
    )?;
    let units = [" / A", " b / A", " / A", " / A", " / (μ A)", " / (μ A)", " / (μ A b)"];
    let panels = [0, 3, 4, 6].map(|k| panel(&time_series.list[k], units[k]));
    let title =
        "Three storeys of height b on a massive rigid base, 5 % damping in the first mode, ν = 1/3";
    let figure = Figure::new(title, 2, panels.into());
    Ok(ValidationOutcome { checks: checks(&time_series), figure })
}
