//! Readings of the paper by Patel & Spyrakos, compared with its peak base shears.
//!
//! ```text
//! cargo study paper-readings                     # the readings of docs/paper.md
//! cargo study paper-readings --all            # all, then geometries: minutes
//! cargo study paper-readings --limit lagged   # one
//! ```
//!
//! Structure, soil and record are as in the example `containment`, the soil by the crate's half-plane. The interface is
//! the paper's layer and the time scheme Newmark's, unless other options are set.

mod evidence;
mod forcing;
mod law;
mod options;
mod run;
mod table;

use std::path::PathBuf;

use clap::Parser;

use crate::AnyError;

use options::PaperReading;
use table::ReadingsTable;

/// The readings of docs/paper.md, as command lines.
const PAPER_READINGS: &[&str] = &[
    "",
    "--law hard --scheme midpoint",
    "--debonded 0",
    "--ratio 0.01",
    "--ratio 0.001",
    "--ratio 0.001 --debonded 0",
    "--sense last-velocity",
    "--gravity 0",
    "--gravity 0.3006 --law hard --scheme midpoint",
    "--kinetic 0 --law hard --scheme midpoint",
    "--kinetic 0.05 --law hard --scheme midpoint",
    "--friction-factor 0.3006 --law hard --scheme midpoint",
    "--length-left-out --law hard --scheme midpoint",
    "--length-left-out --elements 15 --law hard --scheme midpoint",
    "--printed-forcing",
];

/// The other readings, with `--all`.
const OTHER_READINGS: &[&str] = &[
    "--law hard",
    "--law hard --scheme hht",
    "--scheme midpoint",
    "--scheme hht",
    "--flow-chart",
    "--flow-chart --law hard --scheme midpoint",
    "--ratio 1",
    "--ratio 1 --debonded 0",
    "--one-point",
    "--limit lagged",
    "--limit dynamic",
    "--limit compression",
    "--limit static",
    "--limit static --lag-modes",
    "--limit weight --lag-modes",
    "--sense velocity",
    "--lag-modes",
    "--slip-shear 0.001",
    "--slip-shear 0.001 --debonded 0",
    "--slip-normal 0.001",
    "--gravity 0 --limit weight --lag-modes",
    "--gravity 0.3",
    "--gravity 0.5",
    "--friction-factor 0.5",
    "--friction-factor 0.3333",
    "--friction-factor 0.31",
    "--friction-factor 0.25",
    "--friction-factor 0.31 --law hard --scheme midpoint",
    "--friction-factor 0.3 --limit weight --lag-modes",
    "--length-left-out",
    "--length-left-out --elements 20 --law hard --scheme midpoint",
    "--friction-factor 0.3048 --law hard --scheme midpoint",
    "--kinetic 0.1 --law hard --scheme midpoint",
    "--kinetic 0.5 --law hard --scheme midpoint",
    "--printed-forcing --law hard --scheme midpoint",
    "--limit lagged --static-share 0.25",
    "--foundation-density 0.3333",
    "--damping 0.05",
    "--gamma 0.6",
    "--gamma 1",
    "--record 0.5",
    "--neighbour 3.4",
    "--soil-density 2.8",
    "--soil-density 4.2",
    "--width 28 --height 80.6 --law hard --scheme midpoint",
    "--width 40 --height 79.2 --law hard --scheme midpoint",
];

/// Processor time of a run over the duration of its record, on a core of 2024.
const COST_RATIO: f64 = 0.009;

/// Runs of the geometries and searches.
const EVIDENCE_RUNS: f64 = 1900.0;

/// One reading, the readings of docs/paper.md, or all that were tried.
#[derive(Debug, Clone, Parser)]
pub(crate) struct PaperReadingsOptions {
    /// All readings, then geometries and searches.
    #[arg(long)]
    all: bool,
    /// Three seconds of the record, few readings and geometries, as a test.
    #[arg(long)]
    short: bool,
    /// Folder for readings.csv.
    #[arg(long, default_value = "target/study/paper_readings")]
    out: PathBuf,
    #[command(flatten)]
    reading: PaperReading,
}

pub(crate) fn run(mut options: PaperReadingsOptions) -> Result<(), AnyError> {
    if options.short {
        options.reading.duration = 3.0;
    }
    let duration = options.reading.duration;
    let mut lines: Vec<&str> = PAPER_READINGS.to_vec();
    if options.short {
        lines.truncate(2);
    } else if options.all {
        lines.extend(OTHER_READINGS);
    }
    let mut readings = Vec::new();
    for line in lines {
        let words = line.split(' ').filter(|word| !word.is_empty());
        let reading =
            PaperReadingsOptions::try_parse_from(std::iter::once("").chain(words))?.reading;
        readings.push((line.to_owned(), PaperReading { duration, ..reading }));
    }
    let default_reading = PaperReading { duration, ..readings[0].1.clone() };
    if options.reading != default_reading {
        let words: Vec<_> = std::env::args().skip(2).collect();
        readings = vec![(words.join(" "), options.reading.clone())];
    }

    let runs = readings.iter().map(|(_, reading)| reading.rows.len()).sum::<usize>() as f64;
    let evidence = options.all && !options.short;
    let total_runs = runs + if evidence { EVIDENCE_RUNS } else { 0.0 };
    println!(
        "{runs} runs over {duration} s of the record{}: about {:.0} s of processor time\n",
        if evidence { ", then some 1900 for geometries and searches" } else { "" },
        (COST_RATIO * duration * total_runs).max(1.0)
    );
    let mut table = ReadingsTable::new(&options.out)?;
    for (line, reading) in &readings {
        table.add(line, reading)?;
    }
    if options.all {
        evidence::print_calibration(&options.reading, options.short);
        evidence::print_geometries(&options.reading, options.short);
        evidence::print_search(&options.reading, options.short);
    }
    Ok(())
}
