//! Readings of the paper by Patel & Spyrakos, one at a time: which of them gives its peak base
//! shears, and what speaks for and against?
//!
//! ```text
//! cargo run --release --example paper_readings                     # all tables, minutes
//! cargo run --release --example paper_readings -- --short          # the same in seconds
//! cargo run --release --example paper_readings -- --limit lagged   # one reading
//! ```
//!
//! The structure, the soil and the record are those of the example `containment`; law, time scheme,
//! and contact iteration are the paper's, as far as the options do not say otherwise.

#[path = "../common/containment.rs"]
mod containment;
mod evidence;
mod forcing;
#[path = "../common/glue.rs"]
mod glue;
mod law;
mod options;
mod run;

use clap::Parser;

use options::Reading;

type AnyError = Box<dyn std::error::Error + Send + Sync>;

/// Every reading of the table, as command lines.
const READINGS: &[&str] = &[
    "",
    "--law hard --scheme midpoint",
    "--law hard",
    "--law hard --scheme hht",
    "--scheme midpoint",
    "--scheme hht",
    "--flow-chart",
    "--flow-chart --law hard --scheme midpoint",
    "--debonded 0",
    "--ratio 0.001",
    "--ratio 0.001 --debonded 0",
    "--ratio 0.01",
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
    "--sense last-velocity",
    "--lag-modes",
    "--slip-shear 0.001",
    "--slip-shear 0.001 --debonded 0",
    "--slip-normal 0.001",
    "--gravity 0",
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
    "--length-left-out --law hard --scheme midpoint",
    "--friction-factor 0.3048 --law hard --scheme midpoint",
    "--friction-factor 0.3006 --law hard --scheme midpoint",
    "--kinetic 0 --law hard --scheme midpoint",
    "--kinetic 0.5 --law hard --scheme midpoint",
    "--printed-forcing",
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

/// The readings that `--short` keeps.
const FEW: &[&str] = &["", "--length-left-out --law hard --scheme midpoint", "--printed-forcing"];

/// One reading, or all that were tried.
#[derive(Debug, Clone, Parser)]
struct Options {
    /// A few readings and geometries over three seconds.
    #[arg(long)]
    short: bool,
    #[command(flatten)]
    reading: Reading,
}

fn main() -> Result<(), AnyError> {
    let options = Options::parse();
    let words: Vec<_> = std::env::args().skip(1).collect();
    println!(
        "peak shear between foundation and superstructure, lb/ft (against the paper; shear under \
         the base; uplift; slip; steps in which the flow chart cycles); root mean square of \
         ln(peak/paper's) over all rows, and over those that slide\n"
    );
    println!(
        "| reading | bonded | uplift only | 0.4 | 0.3 | 0.2 | rms, all | rms, sliding |\n\
         |---|---|---|---|---|---|---|---|"
    );
    if !words.is_empty() && !options.short {
        options.reading.print(&words.join(" "));
        return Ok(());
    }
    let short = ["--duration", "3"];
    for line in if options.short { FEW } else { READINGS } {
        let words = line.split(' ').filter(|word| !word.is_empty());
        let words = words.chain(if options.short { &short[..] } else { &[] }.iter().copied());
        Options::try_parse_from(std::iter::once("").chain(words))?.reading.print(line);
    }
    let mut reading = options.reading;
    if options.short {
        reading.duration = 3.0;
    }
    evidence::print_meshes(&reading, options.short);
    evidence::print_geometries(&reading, options.short);
    evidence::print_search(&reading, options.short);
    Ok(())
}
