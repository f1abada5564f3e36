//! A footing that rocks on dry sand and settles: a slow centrifuge test, measured and computed with interface laws.
//!
//! ```text
//! cargo study rocking-footing --docs docs
//! ```
//!
//! The source of the measured rows is stated in `tests/data/rocking/README.md`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use basemat::interface::{CyclicYielding, InterfaceLaw, Yielding};
use basemat_problems::rocking_footing::{
    BEARING_PRESSURE, RockingPacket, SlowRockingRun, SlowRockingTest, measured_packets,
};
use plotters::prelude::SeriesLabelPosition;

use crate::AnyError;
use crate::document::{file_stem, splice, write_csv};
use crate::figure::{CURVE_BLUE, CURVE_GRAY, Figure, FigurePanel};

/// A rocking footing on dry sand: moment, settlement and damping by packets of cycles, measured and computed.
///
/// Prints a table for each law, and writes series and a picture.
#[derive(Debug, clap::Args)]
pub(crate) struct RockingFootingOptions {
    /// Two packets of few steps, as a test.
    #[arg(long)]
    short: bool,
    /// Cells along the load.
    #[arg(long, default_value_t = 16)]
    cells: usize,
    /// Cells across the load.
    #[arg(long, default_value_t = 1)]
    cells_across: usize,
    /// Poisson's ratio of the half-space.
    #[arg(long, default_value_t = 0.35)]
    poisson: f64,
    /// Friction coefficient between footing and sand.
    #[arg(long, default_value_t = 0.6)]
    friction: f64,
    /// Steps of a cycle.
    #[arg(long, default_value_t = 200)]
    steps: usize,
    /// Folder for the files.
    #[arg(long, default_value = "target/study/rocking_footing")]
    out: PathBuf,
    /// Folder of the documentation; with it the tables go to benches/studies/tables, and the picture to its images/.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

/// Parameters of `CyclicYielding`, fitted to this test: w_r (m), η, and q_d (Pa/m).
const REFERENCE_SETTLEMENT: f64 = 5.0e-3;
const ELASTIC_RANGE: f64 = 0.1;
const DEPTH_GRADIENT: f64 = 1.4e6;

/// A law and its name.
type NamedLaw = (&'static str, Box<dyn InterfaceLaw>);

/// The laws that are compared with the test; the picture shows the last one.
fn laws(friction: f64) -> basemat::Result<Vec<NamedLaw>> {
    let cyclic = CyclicYielding::new(BEARING_PRESSURE, REFERENCE_SETTLEMENT, friction)?
        .with_elastic_range(ELASTIC_RANGE)?
        .with_depth_gradient(DEPTH_GRADIENT)?;
    Ok(vec![
        ("Yielding", Box::new(Yielding::new(BEARING_PRESSURE, friction)?)),
        ("CyclicYielding", Box::new(cyclic)),
    ])
}

/// Runs the study.
pub(crate) fn run(options: &RockingFootingOptions) -> Result<(), AnyError> {
    std::fs::create_dir_all(&options.out)?;
    let mut measured_rows = measured_packets();
    if options.short {
        measured_rows.truncate(2);
    }
    let test = SlowRockingTest {
        poisson: options.poisson,
        cells: [options.cells, options.cells_across],
        steps_per_cycle: if options.short { 40 } else { options.steps },
        ..SlowRockingTest::with_amplitudes(&measured_rows)
    };
    write_series(&options.out.join("measured.csv"), &measured_rows)?;
    let mut text = String::new();
    let mut figure = None;
    for (name, law) in laws(options.friction)? {
        let computed = test.run(law)?;
        write_series(&options.out.join(format!("{}.csv", file_stem(name))), &computed.packets)?;
        let table = table(name, &measured_rows, &computed)?;
        println!("{table}");
        println!(
            "{} steps in {:.1} s, energy error {:.0e}\n",
            computed.steps,
            computed.wall.as_secs_f64(),
            computed.energy_error
        );
        text.push_str(&table);
        figure = Some(picture(name, &measured_rows, &computed.packets));
    }
    if let Some(figure) = figure {
        figure.draw(&options.out.join("rocking_footing.svg"))?;
        if let Some(docs) = &options.docs {
            splice("rocking_footing.md", "rocking footing", &text)?;
            figure.draw(&docs.join("images/rocking_footing.svg"))?;
        }
    }
    println!("files in {}", options.out.display());
    Ok(())
}

/// Moment, settlement and damping of each packet, measured and computed.
fn table(
    name: &str,
    measured: &[RockingPacket],
    computed: &SlowRockingRun,
) -> Result<String, AnyError> {
    let mut text = format!(
        "**{name}**\n\n| packet | rotation, mrad | 2M/(P L), measured | computed | settlement/L, measured | computed | \
         damping, measured, % | computed, % |\n|---|---|---|---|---|---|---|---|\n"
    );
    for (measured, computed) in measured.iter().zip(&computed.packets) {
        writeln!(
            text,
            "| {} | {:.1} | {:.3} | {:.3} | {:.4} | {:.5} | {:.1} | {:.1} |",
            measured.name,
            1e3 * measured.rotation_amplitude(),
            measured.moment(),
            computed.moment(),
            measured.settlement(),
            computed.settlement(),
            1e2 * measured.equivalent_damping(),
            1e2 * computed.equivalent_damping(),
        )?;
    }
    text.push('\n');
    Ok(text)
}

/// Writes the rows of all packets.
fn write_series(path: &Path, packets: &[RockingPacket]) -> Result<(), AnyError> {
    let columns = [
        "packet",
        "normalized_shear",
        "normalized_moment",
        "normalized_settlement",
        "normalized_sliding",
        "rotation_rad",
    ];
    let rows = packets.iter().flat_map(|packet| {
        packet.rows.iter().map(|row| {
            let values = [row.shear, row.moment, row.settlement, row.sliding, row.rotation];
            let [shear, moment, settlement, sliding, rotation] = values.map(|x| format!("{x:.6}"));
            [packet.name.clone(), shear, moment, settlement, sliding, rotation]
        })
    });
    write_csv(path, columns, rows)
}

/// Moment and settlement over rotation.
fn picture(name: &str, measured_rows: &[RockingPacket], computed: &[RockingPacket]) -> Figure {
    let mut moments = FigurePanel::new("rotation, mrad", "moment, 2M/(P L)")
        .legend(SeriesLabelPosition::UpperLeft)
        .room(0.05, 0.25);
    let mut settlements = FigurePanel::new("rotation, mrad", "settlement/L")
        .legend(SeriesLabelPosition::UpperLeft)
        .room(0.05, 0.25);
    for (series, packets) in [("measured", measured_rows), (name, computed)] {
        let rows = packets.iter().flat_map(|packet| &packet.rows);
        let moment = rows.clone().map(|row| (1e3 * row.rotation, row.moment)).collect();
        let settlement = rows.map(|row| (1e3 * row.rotation, row.settlement)).collect();
        if series == "measured" {
            moments = moments.reference(series, CURVE_GRAY, moment);
            settlements = settlements.reference(series, CURVE_GRAY, settlement);
        } else {
            moments = moments.line(series, CURVE_BLUE, moment);
            settlements = settlements.line(series, CURVE_BLUE, settlement);
        }
    }
    Figure::new("A footing that rocks on dry sand: SSG02_03", 2, vec![moments, settlements])
}
