//! Mats in space beside their model in plane strain, and their error against run time.
//!
//! The error is of a block that lifts and slides in two directions.
//!
//! ```text
//! cargo study mats --docs docs
//! ```
//!
//! Mats are B wide along the motion and L long across it; the strip has the same section and is L long.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::PathBuf;

use basemat::analyses::{Refinement, refine};
use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{Grading, Strip};
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::reference::pais_kausel_impedances;
use basemat::soil::SoilProfile;
use basemat::structure::RigidBody;
use basemat::unobserved;
use plotters::prelude::SeriesLabelPosition;

use crate::AnyError;
use crate::document::splice;
use crate::figure::{CURVE_BLUE, CURVE_GREEN, CURVE_RED, Figure, FigurePanel};

/// Mats in space beside plane strain, and their error against run time.
#[derive(Debug, clap::Args)]
pub(crate) struct MatsOptions {
    /// Square mats and few steps, as a test.
    #[arg(long)]
    short: bool,
    /// Folder for the files.
    #[arg(long, default_value = "target/study/mats")]
    out: PathBuf,
    /// Folder of the documentation; with it the tables go to benches/studies/tables, and the picture to its images/.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

/// Length over width, cells along the width, and numbers of rows of cells in an element along the length, from the edge
/// to the middle, for the block that lifts off.
const MAT_CASES: [(f64, usize, &[usize]); 4] = [
    (1.0, 16, &[]),
    (2.0, 12, &[]),
    (4.0, 12, &[1, 1, 2, 2, 3, 3, 4]),
    (10.0, 8, &[1, 1, 2, 2, 4, 6, 8, 8, 8]),
];

/// ωb/c_S at which stiffness and damping are compared; b = B/2.
const DIMENSIONLESS_FREQUENCIES: [f64; 2] = [0.25, 0.5];

fn soil() -> basemat::Result<Soil> {
    Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)
}

/// Half the width and height of the block, m; mean density, kg/m³.
const HALF_WIDTH: f64 = 5.0;
const BLOCK_HEIGHT: f64 = 15.0;
const MASS_DENSITY: f64 = 500.0;
const FRICTION_COEFFICIENT: f64 = 0.5;
/// Factor of El Centro for the block.
const BLOCK_RECORD_FACTOR: f64 = 1.5;
/// Height of the tower of the same width, m, and its factor of El Centro.
const TOWER_HEIGHT: f64 = 25.0;
const TOWER_RECORD_FACTOR: f64 = 0.6;

/// Springs and dashpots of a strip as long as the mat, divided by those of the mat.
fn stiffness(short: bool) -> Result<String, AnyError> {
    let soil = soil()?;
    let profile = SoilProfile::from(soil);
    let frequency_scale = soil.shear_wave_speed() / (TAU * HALF_WIDTH);
    let frequencies = DIMENSIONLESS_FREQUENCIES.map(|a0| a0 * frequency_scale);
    let ground =
        ElasticGround::new(soil, Strip::new(-HALF_WIDTH..HALF_WIDTH, 32, Grading::Cosine)?)?;
    let strips = ground.impedances(&frequencies, StripContact::Bonded, &mut unobserved)?;
    let mut text = "| L : B | motion | static spring over Pais and Kausel | ωb/c | spring, strip/mat | dashpot, strip/mat | damping ratio of the mat, % | of the strip, % |\n|---|---|---|---|---|---|---|---|\n".to_owned();
    for (aspect, cells, _) in MAT_CASES.into_iter().take(if short { 1 } else { MAT_CASES.len() }) {
        let cells = if short { 6 } else { cells };
        let mat = Plan::rectangle(
            -HALF_WIDTH..HALF_WIDTH,
            -HALF_WIDTH * aspect..HALF_WIDTH * aspect,
            cells,
        )?;
        let with_static = [0.0, frequencies[0], frequencies[1]];
        let mats = impedances_in_plan(
            &profile,
            &mat,
            &with_static,
            StripContact::Bonded,
            &mut unobserved,
        )?;
        let sides = [2.0 * HALF_WIDTH, 2.0 * HALF_WIDTH * aspect];
        let formulas = pais_kausel_impedances(soil, sides, 0.0)?;
        for (k, name) in ["sway", "heave", "rocking"].into_iter().enumerate() {
            let axis = [0, 2, 4][k];
            let static_ratio = mats[0].matrix[axis][axis].re / formulas[[0, 2, 3][k]].re;
            for ((mat, strip), a0) in mats[1..].iter().zip(&strips).zip(DIMENSIONLESS_FREQUENCIES) {
                let mat = mat.matrix[axis][axis];
                let strip = [strip.horizontal, strip.vertical, strip.rocking][k];
                let length = 2.0 * HALF_WIDTH * aspect;
                writeln!(
                    text,
                    "| {aspect} | {name} | {static_ratio:.3} | {a0} | {:.2} | {:.2} | {:.1} | {:.1} |",
                    length * strip.re / mat.re,
                    length * strip.im / mat.im,
                    50.0 * mat.im / mat.re,
                    50.0 * strip.im / strip.re,
                )?;
            }
        }
    }
    Ok(text)
}

/// Row of a block under one horizontal record.
fn contact_row(name: &str, elements: usize, run: &Run) -> String {
    let whole = &run.whole;
    format!(
        "| {name} | {elements} | {:.2} | {:.0} | {:.1} | {:.1} | {:.3} | {:.0e} | {:.0} |\n",
        1e3 * whole.base_rotation.magnitude(),
        1e2 * whole.uplifted_fraction.magnitude(),
        1e3 * whole.mean_slip.magnitude(),
        1e3 * whole.residual_slip.abs(),
        run.shear_coefficient().unwrap_or(f64::NAN),
        run.energy_error,
        run.wall.as_secs_f64()
    )
}

/// A block that lifts and slides, on mats and on a strip.
fn contact(short: bool) -> Result<String, AnyError> {
    let step = 0.005;
    let steps = if short { 100 } else { 2000 };
    let record = el_centro_1940().scaled(TOWER_RECORD_FACTOR)?;
    let mut text = "| base | elements | rotation, mrad | open, % | peak slip, mm | residual slip, mm | shear / weight | energy error | s |\n|---|---|---|---|---|---|---|---|---|\n".to_owned();
    for (aspect, cells, unions) in
        MAT_CASES.into_iter().take(if short { 1 } else { MAT_CASES.len() })
    {
        // Fewer cells are enough here.
        let cells = if short { 4 } else { cells.min(8) };
        let body = RigidBody::cuboid(
            [2.0 * HALF_WIDTH, 2.0 * HALF_WIDTH * aspect, TOWER_HEIGHT],
            MASS_DENSITY,
        )?;
        let plan = Plan::rectangle(
            -HALF_WIDTH..HALF_WIDTH,
            -HALF_WIDTH * aspect..HALF_WIDTH * aspect,
            cells,
        )?;
        let rows = plan.count() / cells;
        let plan = match unions {
            [] => plan,
            _ => plan.with_unions(&vec![1; cells], &mirrored(unions, rows))?,
        };
        let ground = ElasticGround::in_plan(soil()?, plan)?;
        let mut simulation = Simulation::builder(step)
            .structure(body)
            .ground(ground)
            .interface(Coulomb::new(FRICTION_COEFFICIENT)?)
            .motion(Triaxial { x: Some(record.clone()), ..Triaxial::default() })
            .expected_steps(steps)
            .build()?;
        let run = simulation.run(steps, |_| {})?;
        let elements = simulation.state().contact.len();
        text.push_str(&contact_row(&format!("{aspect} : 1"), elements, &run));
    }
    let body = RigidBlock::new(2.0 * HALF_WIDTH, TOWER_HEIGHT, MASS_DENSITY)?;
    let run = Simulation::builder(step)
        .ground(ElasticGround::under(soil()?, &body, 16)?)
        .structure(body)
        .interface(Coulomb::new(FRICTION_COEFFICIENT)?)
        .motion(record)
        .build()?
        .run(steps, |_| {})?;
    text.push_str(&contact_row("plane strain", 16, &run));
    Ok(text)
}

/// Numbers of rows of cells in an element: `edge` from either edge, and the rest in the middle.
fn mirrored(edge: &[usize], rows: usize) -> Vec<usize> {
    let mut half = Vec::new();
    let mut rest = rows / 2;
    for &count in edge {
        let count = count.min(rest);
        if count > 0 {
            half.push(count);
        }
        rest -= count;
    }
    let middle = rows - 2 * half.iter().sum::<usize>();
    let reversed_half: Vec<usize> = half.iter().rev().copied().collect();
    half.into_iter().chain((middle > 0).then_some(middle)).chain(reversed_half).collect()
}

/// Coarsest time step, s; every setting takes samples at its multiples.
const COARSEST_STEP: f64 = 0.01;

/// Rotations about both axes (rad) or displacements along them (m) of a block under three records.
fn block(
    law: impl InterfaceLaw + 'static,
    duration: f64,
    dofs: [usize; 2],
    cells: usize,
    step: f64,
) -> basemat::Result<Vec<f64>> {
    let record = el_centro_1940().scaled(BLOCK_RECORD_FACTOR)?;
    let body = RigidBody::cuboid([2.0 * HALF_WIDTH, 2.0 * HALF_WIDTH, BLOCK_HEIGHT], MASS_DENSITY)?;
    let mut simulation = Simulation::builder(step)
        .ground(ElasticGround::under(soil()?, &body, cells)?)
        .structure(body)
        .interface(law)
        .motion(Triaxial {
            y: Some(record.scaled(0.8)?.padded(0.3, 0.0)?),
            up: Some(record.scaled(0.4)?.padded(0.6, 0.0)?),
            x: Some(record.clone()),
        })
        .expected_steps(steps_in(duration, step))
        .build()?;
    let mut series = Vec::new();
    simulation.run(steps_in(duration, step), |state| {
        let sample = state.time / COARSEST_STEP;
        if (sample - sample.round()).abs() < 1e-6 {
            series.extend(dofs.map(|dof| state.displacement()[dof]));
        }
    })?;
    Ok(series)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "thousands")]
fn steps_in(duration: f64, step: f64) -> usize {
    (duration / step).round() as usize
}

/// Results by number of cells and time step.
type BlockSolution<'a> = dyn Fn(usize, f64) -> basemat::Result<Vec<f64>> + 'a;

/// Errors by `refine`: table and picture.
fn errors(short: bool) -> Result<(String, Figure), AnyError> {
    let duration = if short { 0.2 } else { 2.5 };
    let cells = if short { 2 } else { 4 };
    let mut text = String::new();
    let mut panel = FigurePanel::new("run time, s", "error, relative (root of the sum of squares)")
        .double_logarithmic()
        .legend(SeriesLabelPosition::LowerLeft);
    let friction = Coulomb::new(FRICTION_COEFFICIENT)?;
    let cases: [(&str, _, &BlockSolution); 3] = [
        ("bonded, rotations", CURVE_GREEN, &|n, step| block(Bonded, duration, [3, 4], n, step)),
        ("lifts and slides, rotations", CURVE_BLUE, &|n, step| {
            block(friction, duration, [3, 4], n, step)
        }),
        ("lifts and slides, displacements", CURVE_RED, &|n, step| {
            block(friction, duration, [0, 1], n, step)
        }),
    ];
    for (name, color, solution) in cases {
        let refinement: Refinement = refine(cells, COARSEST_STEP, solution)?;
        println!("{name}\n{refinement}\n");
        writeln!(
            text,
            "**{name}**: order {:.1} in the cells, {:.1} in the step, mismatch {:.0e}\n\n| cells | Δt, ms | error | s |\n|---|---|---|---|",
            refinement.mesh_order, refinement.step_order, refinement.mismatch
        )?;
        for setting in &refinement.settings {
            writeln!(
                text,
                "| {0} × {0} | {1} | {2:.1e} | {3:.2} |",
                setting.elements,
                1e3 * setting.time_step,
                setting.error,
                setting.wall.as_secs_f64()
            )?;
        }
        text.push('\n');
        let settings = refinement.settings.iter();
        let points = settings.map(|setting| (setting.wall.as_secs_f64(), setting.error));
        panel = panel.circles(name, color, points.collect());
    }
    Ok((text, Figure::new("A block of 10 × 10 × 15 m under three records", 1, vec![panel])))
}

pub(crate) fn run(options: &MatsOptions) -> Result<(), AnyError> {
    std::fs::create_dir_all(&options.out)?;
    let (errors, figure) = errors(options.short)?;
    let tables = [
        ("stiffness", stiffness(options.short)?),
        ("contact", contact(options.short)?),
        ("errors", errors),
    ];
    figure.draw(&options.out.join("mats_errors.svg"))?;
    for (name, text) in &tables {
        println!("{text}");
        if options.docs.is_some() {
            splice("mats.md", &format!("mats {name}"), text)?;
        }
    }
    if let Some(docs) = &options.docs {
        figure.draw(&docs.join("images/mats_errors.svg"))?;
    }
    Ok(())
}
