//! El Centro on the containment of Patel & Spyrakos, for docs/paper.md.
//!
//! Their paper is "Uplifting-sliding response of flexible structures to seismic loads". The page states the paper's
//! tables, figures and conclusions beside the crate's. The example `containment` shows how one such run is made.
//!
//! ```text
//! cargo study containment                   # 1 s
//! cargo study containment --sweep --meshes  # more friction coefficients, 15 elements: 7 s
//! ```

pub(crate) mod case;
mod report;

use std::path::PathBuf;

use basemat::fem::QuadFormulation;
use basemat::motion::el_centro_1940;
use basemat::sweep::Sweep;
use basemat_problems::containment::Containment;

use crate::AnyError;
use crate::document::write_csv;
use case::{ContainmentCase, ContainmentOutcome};

/// El Centro on the paper's containment: Table 1, conclusions, limits of service, figures.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct ContainmentOptions {
    /// Folder for the files.
    #[arg(long, default_value = "target/study/containment")]
    out: PathBuf,
    /// Friction coefficients of the sliding cases.
    #[arg(long, value_delimiter = ',', default_value = "0.4,0.3,0.2")]
    friction: Vec<f64>,
    /// Contact length, ft (the paper's figure is lost: calibrated on Table 1's first two rows).
    #[arg(long, default_value_t = 34.0)]
    width: f64,
    /// Height, ft (calibrated as the contact length is).
    #[arg(long, default_value_t = 80.0)]
    height: f64,
    /// Elements integrated at one point, with constant strain, as the paper says.
    #[arg(long)]
    one_point: bool,
    /// Also compute 15 elements along the base, and compare peaks and time series with 10 elements.
    #[arg(long)]
    meshes: bool,
    /// Also compute friction from 0.05 to 0.8.
    #[arg(long)]
    sweep: bool,
}

pub(crate) fn run(options: &ContainmentOptions) -> Result<(), AnyError> {
    let formulation =
        if options.one_point { QuadFormulation::OnePoint } else { QuadFormulation::Full };
    let width = options.width;
    let height = options.height;
    let scene = Containment { width, height, formulation, ..Containment::default() };
    let out = &options.out;
    // The folder is created first, so that an error comes before the runs.
    std::fs::create_dir_all(out)?;
    let duration = el_centro_1940().duration();
    let results = run_all(&ContainmentCase::list(&options.friction), scene, duration)?;
    report::print(&results, scene.weights());
    report::write(out, &results)?;
    report::draw(out, &results)?;
    if options.sweep {
        let frictions: Vec<f64> = (1..=16).map(|k| 0.05 * f64::from(k)).collect();
        let runs = run_all(&ContainmentCase::list(&frictions)[2..], scene, duration)?;
        write_csv(
            out.join("friction_sweep.csv"),
            ["friction", "peak_base_shear_n_per_m", "max_slip_m"],
            frictions.iter().zip(&runs).map(|(friction, outcome)| {
                let slip = outcome.run.whole.mean_slip.magnitude();
                [*friction, outcome.peak_shear, slip].map(|number| number.to_string())
            }),
        )?;
        report::draw_sweep(out, &frictions, &runs, results[1].peak_shear)?;
    }
    if options.meshes {
        let fine_scene = Containment { elements: 15, ..scene };
        let fine = run_all(&ContainmentCase::list(&options.friction), fine_scene, duration)?;
        report::compare_meshes(out, &results, &fine)?;
    }
    println!("\nfiles in {}", out.display());
    Ok(())
}

/// Runs the cases, as many at a time as there are processors.
pub(crate) fn run_all(
    cases: &[ContainmentCase],
    scene: Containment,
    duration: f64,
) -> Result<Vec<ContainmentOutcome>, AnyError> {
    let runs = Sweep::new(cases.len()).collect(|case| cases[case.index].run(scene, duration));
    let mut outcomes = Vec::new();
    for (case, run) in cases.iter().zip(runs) {
        outcomes.push(run.map_err(|error| format!("{}: {error}", case.name))?);
    }
    Ok(outcomes)
}
