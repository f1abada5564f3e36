//! Coefficient α of the uplift law for mats on a half-space, under a static moment.
//!
//! ```text
//! cargo study uplift-law --docs docs
//! ```
//!
//! The law says M/(N L) and the contact for each rotation from α alone. α of a mat is the one whose moments are nearest
//! to its own, from the uplift to a contact of two fifths.

use std::fmt::Write as _;
use std::path::PathBuf;

use basemat::bem::plan::Plan;
use basemat::coupled::Load;
use basemat::prelude::*;
use basemat::reference::UpliftLaw;
use basemat::structure::RigidBody;

use crate::AnyError;
use crate::document::splice;

/// Coefficient of the uplift law for mats.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// One mat of few cells, to see that all works.
    #[arg(long)]
    short: bool,
    /// Folder for the files.
    #[arg(long, default_value = "target/study/uplift-law")]
    out: PathBuf,
    /// Folder of the documentation: given, the table goes to benches/studies/tables.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

/// Half the length along the motion, and height of the body, m.
const HALF: f64 = 5.0;
const HEIGHT: f64 = 10.0;
/// Moments over N L: the first without uplift, the others with.
const MOMENTS: [f64; 9] = [0.02, 0.25, 0.28, 0.31, 0.34, 0.37, 0.4, 0.42, 0.44];
const LEAST_CONTACT: f64 = 0.4;
/// Degree of freedom of a body: rotation about y.
const ABOUT_Y: usize = 4;

/// Plan and body of the mat with this name; `cells`: number of cells along the motion.
fn mat(name: &str, cells: usize) -> basemat::Result<(Plan, RigidBody)> {
    Ok(match name {
        "disc" => (Plan::disc([0.0; 2], HALF, cells)?, RigidBody::cylinder(HALF, HEIGHT, 2000.0)?),
        "2 : 1 along the motion" => (
            Plan::rectangle(-HALF..HALF, -0.5 * HALF..0.5 * HALF, cells / 2)?,
            RigidBody::cuboid([2.0 * HALF, HALF, HEIGHT], 2000.0)?,
        ),
        _ => (
            Plan::rectangle(-HALF..HALF, -HALF..HALF, cells)?,
            RigidBody::cuboid([2.0 * HALF, 2.0 * HALF, HEIGHT], 2000.0)?,
        ),
    })
}

/// Rotation (rad) and share in contact under a moment about y, over N L.
fn rest(name: &str, cells: usize, friction: f64, moment: f64) -> Result<[f64; 2], AnyError> {
    let (plan, body) = mat(name, cells)?;
    let push = moment * 2.0 * HALF * STANDARD_GRAVITY * body.total_mass();
    let simulation = Simulation::builder(0.05)
        .structure(body)
        .ground(ElasticGround::in_plan(
            Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?,
            plan,
        )?)
        .interface(Coulomb::new(friction)?)
        .load(Load::new(ABOUT_Y, move |_| push))
        .build()?;
    let rotation = simulation.static_displacement()[ABOUT_Y];
    Ok([rotation.abs(), 1.0 - simulation.state().uplifted_fraction])
}

/// Sum of squares of the law's errors at the points (M/(N L), rotation) with uplift, from the stiffness.
fn misfit(alpha: f64, compliance: f64, points: &[[f64; 3]]) -> Result<f64, AnyError> {
    let law = UpliftLaw::new(alpha)?;
    let error = |&[moment, rotation, _]: &[f64; 3]| -> Result<f64, AnyError> {
        Ok((law.moment_ratio(rotation * alpha / compliance)? / alpha - moment).powi(2))
    };
    points.iter().map(error).sum()
}

/// Runs the study.
pub(crate) fn run(options: &Options) -> Result<(), AnyError> {
    let mut text = "| mat | friction | cells along it | α | largest error of M/(N L) | of the contact |\n|---|---|---|---|---|---|\n".to_owned();
    let all: &[(&str, f64)] = &[
        ("square", 0.0),
        ("square", f64::INFINITY),
        ("2 : 1 along the motion", 0.0),
        ("disc", 0.0),
        ("disc", f64::INFINITY),
    ];
    let cells: &[usize] = if options.short { &[8] } else { &[16, 24] };
    for &(name, friction) in &all[..if options.short { 1 } else { all.len() }] {
        for &cells in cells {
            let mut points = Vec::new();
            for moment in MOMENTS {
                let [rotation, contact] = rest(name, cells, friction, moment)?;
                points.push([moment, rotation, contact]);
            }
            let compliance = points[0][1] / points[0][0];
            let lifted: Vec<_> = points[1..]
                .iter()
                .filter(|own| own[2] < 1.0 && own[2] > LEAST_CONTACT)
                .copied()
                .collect();
            // The misfit has one minimum between these.
            let (mut low, mut high) = (3.0, 8.0);
            for _ in 0..60 {
                let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                if misfit(a, compliance, &lifted)? < misfit(b, compliance, &lifted)? {
                    high = b;
                } else {
                    low = a;
                }
            }
            let law = UpliftLaw::new(low)?;
            let mut errors = [0.0_f64; 2];
            for [moment, rotation, contact] in &lifted {
                let ratio = rotation * low / compliance;
                errors[0] = errors[0].max((law.moment_ratio(ratio)? / low - moment).abs());
                errors[1] = errors[1].max((law.contact_ratio(ratio)? - contact).abs());
            }
            let friction = if friction == 0.0 { "none" } else { "infinite" };
            writeln!(
                text,
                "| {name} | {friction} | {cells} | {low:.2} | {:.3} | {:.2} |",
                errors[0], errors[1]
            )?;
        }
    }
    println!("{text}");
    std::fs::create_dir_all(&options.out)?;
    std::fs::write(options.out.join("alpha.md"), &text)?;
    if options.docs.is_some() {
        splice("uplift_law.md", "alpha", &text)?;
    }
    Ok(())
}
