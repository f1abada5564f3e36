//! The containment of Patel & Spyrakos by four schemes, on one mesh and record.
//!
//! The schemes are the paper's up to its end, the paper's with convolution quadrature in its soil, the paper's
//! with the soil of the half-plane, and the crate's.
//!
//! ```text
//! cargo study paper-scheme               # tables of docs/paper.md, CSV, plots
//! cargo study paper-scheme --stability
//! cargo study paper-scheme --limits       # steps and dampings that reach the end
//! cargo study paper-scheme --help
//! ```
//!
//! | | soil | interface | structure | contact iteration |
//! |---|---|---|---|---|
//! | paper | full-plane kernel, midpoint collocation, 5 free-surface elements a side | thin layer | Newmark | flow chart |
//! | BDF2 | the same by convolution quadrature | thin layer | Newmark | robust |
//! | half-plane | half-plane kernel, element means | thin layer | Newmark | robust |
//! | basemat | half-plane kernel, element means | Coulomb | midpoint rule | robust |
//!
//! The third separates the effect of the soil from the effects of interface and structure. Peaks and
//! differences of a run that grows are those before it differs from the third by 30 % of its peak.

mod case;
mod limits;
mod report;
mod scheme;
mod stability;

use std::path::PathBuf;

use basemat::contact::ContactSearch;
use basemat::motion::el_centro_1940;

use crate::AnyError;
use basemat_problems::containment::{
    Containment, PAPER_SHEARS, POUND_FORCE_PER_FOOT, TABLE_1_ROWS,
};
use case::{SchemeRow, march};
use scheme::{COMPARED_SCHEMES, PaperScene};

/// The paper's scheme, its soil by convolution quadrature, and this crate's, side by side.
#[derive(Debug, Clone, clap::Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct PaperSchemeOptions {
    /// Folder for summary.csv and plots.
    #[arg(long, default_value = "target/study/paper_scheme")]
    out: PathBuf,
    /// Folder of the documentation: the pictures of docs/paper.md go to images/ in it.
    #[arg(long)]
    docs: Option<PathBuf>,
    /// Seconds to compute, by default the whole record.
    #[arg(long)]
    duration: Option<f64>,
    /// Three seconds only.
    #[arg(long)]
    short: bool,
    /// Time step: the part of an element that a P wave crosses.
    #[arg(long, default_value_t = 0.5)]
    beta: f64,
    /// Traction-free elements on either side of the paper's base.
    #[arg(long, default_value_t = 5)]
    free: usize,
    /// Midpoint rules over this number of sub-elements in the paper's kernel (5 in the paper) in place
    /// of exact integrals.
    #[arg(long)]
    subelements: Option<usize>,
    /// Gauss points in each of these sub-elements; one is the midpoint rule.
    #[arg(long, default_value_t = 1)]
    gauss: usize,
    /// Thickness of the layer over the height of the elements beside it.
    #[arg(long, default_value_t = 0.1)]
    ratio: f64,
    /// Robust search for contact modes in the paper's scheme too.
    #[arg(long)]
    robust: bool,
    /// Only the table of steps and dampings with which the paper's scheme reaches the end.
    #[arg(long)]
    limits: bool,
    /// Only the table of growth and passivity of boundary equations over β.
    #[arg(long)]
    stability: bool,
}

pub(crate) fn run(options: &PaperSchemeOptions) -> Result<(), AnyError> {
    if options.stability {
        return stability::print_table();
    }
    std::fs::create_dir_all(&options.out)?;
    let containment = Containment::default();
    let record = el_centro_1940();
    let record_duration = record.duration();
    let scene = PaperScene {
        time_step: containment.time_step(options.beta),
        containment,
        record,
        free: options.free,
        subelements: options.subelements.map(|count| [count, options.gauss]),
        ratio: options.ratio,
        gamma: 0.5,
        search: if options.robust {
            ContactSearch::Robust
        } else {
            ContactSearch::FlowChart { iterations: 100 }
        },
    };
    let duration = if options.short { 3.0 } else { options.duration.unwrap_or(record_duration) };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "zero if not")]
    let steps = (duration / scene.time_step).round() as usize;
    if options.limits {
        return limits::print(&scene, duration, options.short);
    }
    println!("{steps} steps of {:.4} ms, β = {}", 1e3 * scene.time_step, options.beta);

    report::print_assessments(&scene, steps)?;
    let limit = 1e6 * PAPER_SHEARS[0] * POUND_FORCE_PER_FOOT;
    let mut rows = Vec::new();
    for ((name, friction), paper_peak) in TABLE_1_ROWS.into_iter().zip(PAPER_SHEARS) {
        let mut outcomes = Vec::new();
        for scheme in COMPARED_SCHEMES {
            let outcome = march(|| scheme.build(&scene, friction), steps, limit)
                .map_err(|error| format!("{name}, {}: {error}", scheme.name()))?;
            outcomes.push((scheme, outcome));
        }
        rows.push(SchemeRow { name, paper_peak, outcomes });
    }
    report::print_peaks(&rows);
    report::print_marches(&rows);
    report::write_summary(&options.out, &rows)?;
    report::draw(&options.out, &rows)?;
    if let Some(docs) = &options.docs {
        report::draw(&docs.join("images"), rows.iter().step_by(2).take(2))?;
    }
    println!("\nfiles in {}", options.out.display());
    Ok(())
}
