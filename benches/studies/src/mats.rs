//! Mats in plan: what a calculation in plane strain makes of them, and the error of a block that lifts and slides in
//! two directions against run time.
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
use crate::figure::{BLUE, Figure, GREEN, Panel, RED};

/// Mats in plan beside plane strain, and their error against run time.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Square mats and few steps, to see that all works.
    #[arg(long)]
    short: bool,
    /// Folder for the files.
    #[arg(long, default_value = "target/study/mats")]
    out: PathBuf,
    /// Folder of the documentation: given, the tables go to benches/studies/tables, and its images/ the picture.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

/// Length over width, cells along the width, and elements of several rows of cells along the length, from the edge
/// to the middle, for the block that lifts.
const MATS: [(f64, usize, &[usize]); 4] = [
    (1.0, 16, &[]),
    (2.0, 12, &[]),
    (4.0, 12, &[1, 1, 2, 2, 3, 3, 4]),
    (10.0, 8, &[1, 1, 2, 2, 4, 6, 8, 8, 8]),
];

/// ωb/c_S at which stiffness and damping are compared; b = B/2.
const FREQUENCIES: [f64; 2] = [0.25, 0.5];

fn soil() -> basemat::Result<Soil> {
    Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)
}

/// Half the width, height of the block, m; its density, kg/m³.
const HALF: f64 = 5.0;
const HEIGHT: f64 = 15.0;
const DENSITY: f64 = 500.0;
const FRICTION: f64 = 0.5;
/// Factor of El Centro.
const SCALE: f64 = 1.5;
/// Height of the tower of the same width, m, and its factor.
const TOWER: f64 = 25.0;
const GENTLE: f64 = 0.6;

/// Springs and dashpots of a strip as long as the mat, divided by the mat's.
fn stiffness(short: bool) -> Result<String, AnyError> {
    let soil = soil()?;
    let profile = SoilProfile::from(soil);
    let unit = soil.shear_wave_speed() / (TAU * HALF);
    let frequencies = FREQUENCIES.map(|a0| a0 * unit);
    let ground = ElasticGround::new(soil, Strip::new(-HALF..HALF, 32, Grading::Cosine)?)?;
    let strips = ground.impedances(&frequencies, StripContact::Bonded, &mut unobserved)?;
    let mut text = "| L : B | motion | static spring over Pais and Kausel | ωb/c | spring, strip/mat | dashpot, strip/mat | damping ratio of the mat, % | of the strip, % |\n|---|---|---|---|---|---|---|---|\n".to_owned();
    for (aspect, cells, _) in MATS.into_iter().take(if short { 1 } else { MATS.len() }) {
        let cells = if short { 6 } else { cells };
        let mat = Plan::rectangle(-HALF..HALF, -HALF * aspect..HALF * aspect, cells)?;
        let all = [0.0, frequencies[0], frequencies[1]];
        let mats = impedances_in_plan(&profile, &mat, &all, StripContact::Bonded, &mut unobserved)?;
        let sides = [2.0 * HALF, 2.0 * HALF * aspect];
        let formulas = pais_kausel_impedances(soil, sides, 0.0)?;
        for (k, name) in ["sway", "heave", "rocking"].into_iter().enumerate() {
            let axis = [0, 2, 4][k];
            let known = mats[0].matrix[axis][axis].re / formulas[[0, 2, 3][k]].re;
            for ((mat, strip), a0) in mats[1..].iter().zip(&strips).zip(FREQUENCIES) {
                let mat = mat.matrix[axis][axis];
                let strip = [strip.horizontal, strip.vertical, strip.rocking][k];
                let length = 2.0 * HALF * aspect;
                writeln!(
                    text,
                    "| {aspect} | {name} | {known:.3} | {a0} | {:.2} | {:.2} | {:.1} | {:.1} |",
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

/// Response of a block to one horizontal record: rotation (mrad), share of the base that lifts (%), peak and residual
/// slip (mm), base shear over the weight.
fn found(run: &Run) -> [f64; 5] {
    let whole = &run.whole;
    [
        1e3 * whole.base_rotation.magnitude(),
        1e2 * whole.uplifted_fraction.magnitude(),
        1e3 * whole.mean_slip.magnitude(),
        1e3 * whole.residual_slip.abs(),
        run.shear_coefficient().unwrap_or(f64::NAN),
    ]
}

/// A block that lifts and slides, on mats and on a strip.
fn contact(short: bool) -> Result<String, AnyError> {
    let (step, steps) = (0.005, if short { 100 } else { 2000 });
    let record = el_centro_1940().scaled(GENTLE)?;
    let mut text = "| base | elements | rotation, mrad | open, % | peak slip, mm | residual slip, mm | shear / weight | energy error | s |\n|---|---|---|---|---|---|---|---|---|\n".to_owned();
    let mut row = |name: String, elements: usize, run: &Run| {
        let [rotation, open, peak, residual, shear] = found(run);
        writeln!(
            text,
            "| {name} | {elements} | {rotation:.2} | {open:.0} | {peak:.1} | {residual:.1} | {shear:.3} | {:.0e} | {:.0} |",
            run.energy_error,
            run.wall.as_secs_f64()
        )
    };
    for (aspect, cells, unions) in MATS.into_iter().take(if short { 1 } else { MATS.len() }) {
        // A quarter of the cells is enough here.
        let cells = if short { 4 } else { cells.min(8) };
        let body = RigidBody::cuboid([2.0 * HALF, 2.0 * HALF * aspect, TOWER], DENSITY)?;
        let plan = Plan::rectangle(-HALF..HALF, -HALF * aspect..HALF * aspect, cells)?;
        let rows = plan.count() / cells;
        let plan = match unions {
            [] => plan,
            _ => plan.with_unions(&vec![1; cells], &mirrored(unions, rows))?,
        };
        let ground = ElasticGround::in_plan(soil()?, plan)?;
        let mut simulation = Simulation::builder(step)
            .structure(body)
            .ground(ground)
            .interface(Coulomb::new(FRICTION)?)
            .motion(Triaxial { x: Some(record.clone()), ..Triaxial::default() })
            .expected_steps(steps)
            .build()?;
        let run = simulation.run(steps, |_| {})?;
        row(format!("{aspect} : 1"), simulation.state().contact.len(), &run)?;
    }
    let body = RigidBlock::new(2.0 * HALF, TOWER, DENSITY)?;
    let run = Simulation::builder(step)
        .ground(ElasticGround::under(soil()?, &body, 16)?)
        .structure(body)
        .interface(Coulomb::new(FRICTION)?)
        .motion(record)
        .build()?
        .run(steps, |_| {})?;
    row("plane strain".to_owned(), 16, &run)?;
    Ok(text)
}

/// Rows of cells taken together: these from either edge, and equal ones that fill up the middle.
fn mirrored(edge: &[usize], rows: usize) -> Vec<usize> {
    let mut half = Vec::new();
    let mut left = rows / 2;
    for &count in edge {
        let count = count.min(left);
        if count > 0 {
            half.push(count);
        }
        left -= count;
    }
    let middle = rows - 2 * half.iter().sum::<usize>();
    let back: Vec<usize> = half.iter().rev().copied().collect();
    half.into_iter().chain((middle > 0).then_some(middle)).chain(back).collect()
}

/// Every setting takes samples at the coarsest step.
const COARSE: f64 = 0.01;

/// Rotations about both axes (rad) or displacements along them (m) of a cube-like block under three records.
fn block(
    law: impl InterfaceLaw + 'static,
    duration: f64,
    dofs: [usize; 2],
    (cells, step): (usize, f64),
) -> basemat::Result<Vec<f64>> {
    let record = el_centro_1940().scaled(SCALE)?;
    let late = |factor: f64, quiet: f64| record.scaled(factor)?.padded(quiet, 0.0);
    let body = RigidBody::cuboid([2.0 * HALF, 2.0 * HALF, HEIGHT], DENSITY)?;
    let mut simulation = Simulation::builder(step)
        .ground(ElasticGround::under(soil()?, &body, cells)?)
        .structure(body)
        .interface(law)
        .motion(Triaxial {
            y: Some(late(0.8, 0.3)?),
            up: Some(late(0.4, 0.6)?),
            x: Some(record.clone()),
        })
        .expected_steps(steps_in(duration, step))
        .build()?;
    let mut series = Vec::new();
    simulation.run(steps_in(duration, step), |state| {
        let place = state.time / COARSE;
        if (place - place.round()).abs() < 1e-6 {
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
type Scene<'a> = dyn Fn(usize, f64) -> basemat::Result<Vec<f64>> + 'a;

/// Errors by `refine`, and what the picture shows of them.
fn errors(short: bool) -> Result<(String, Figure), AnyError> {
    let duration = if short { 0.2 } else { 2.5 };
    let cells = if short { 2 } else { 4 };
    let mut text = String::new();
    let mut panel = Panel::new("run time, s", "error, relative (root of the sum of squares)")
        .double_logarithmic()
        .legend(SeriesLabelPosition::LowerLeft);
    let lifts = Coulomb::new(FRICTION)?;
    let cases: [(&str, _, &Scene); 3] = [
        ("bonded, rotations", GREEN, &|n, step| block(Bonded, duration, [3, 4], (n, step))),
        ("lifts and slides, rotations", BLUE, &|n, step| block(lifts, duration, [3, 4], (n, step))),
        ("lifts and slides, displacements", RED, &|n, step| {
            block(lifts, duration, [0, 1], (n, step))
        }),
    ];
    for (name, color, scene) in cases {
        let found: Refinement = refine(cells, COARSE, scene)?;
        println!("{name}\n{found}\n");
        writeln!(
            text,
            "**{name}**: order {:.1} in the cells, {:.1} in the step, mismatch {:.0e}\n\n| cells | Δt, ms | error | s |\n|---|---|---|---|",
            found.mesh_order, found.step_order, found.mismatch
        )?;
        for own in &found.settings {
            writeln!(
                text,
                "| {0} × {0} | {1} | {2:.1e} | {3:.2} |",
                own.elements,
                1e3 * own.time_step,
                own.error,
                own.wall.as_secs_f64()
            )?;
        }
        text.push('\n');
        let points = found.settings.iter().map(|own| (own.wall.as_secs_f64(), own.error));
        panel = panel.circles(name, color, points.collect());
    }
    Ok((text, Figure::new("A block of 10 × 10 × 15 m under three records", 1, vec![panel])))
}

pub(crate) fn run(options: &Options) -> Result<(), AnyError> {
    std::fs::create_dir_all(&options.out)?;
    let (errors, figure) = errors(options.short)?;
    let parts = [
        ("stiffness", stiffness(options.short)?),
        ("contact", contact(options.short)?),
        ("errors", errors),
    ];
    figure.draw(&options.out.join("mats_errors.svg"))?;
    for (name, text) in &parts {
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
