//! A footing that rocks on dry sand and settles: a slow centrifuge test, measured and computed with interface laws.
//!
//! ```text
//! cargo study rocking-footing --docs docs
//! ```
//!
//! The source of the measured rows is stated in `tests/data/rocking/README.md`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use basemat::interface::{InterfaceLaw, Yielding};
use basemat_problems::rocking_footing::{
    BEARING_PRESSURE, FRICTION_COEFFICIENT, RockingPacket, SlowRockingTest, fitted_law,
    measured_packets,
};
use plotters::prelude::SeriesLabelPosition;

use crate::AnyError;
use crate::document::{file_stem, splice, write_csv};
use crate::figure::{CURVE_BLUE, CURVE_GRAY, CURVE_ORANGE, Figure, FigurePanel};

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
    #[arg(long, default_value_t = FRICTION_COEFFICIENT)]
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

/// Measured rows from one cross of the picture to the next.
const CROSS_INTERVAL: usize = 3;

/// A law and its name.
type NamedLaw = (&'static str, Box<dyn InterfaceLaw>);

/// The laws that are compared with the test.
fn laws(friction: f64) -> basemat::Result<[NamedLaw; 2]> {
    Ok([
        ("Yielding", Box::new(Yielding::new(BEARING_PRESSURE, friction)?)),
        ("CyclicYielding", Box::new(fitted_law(friction)?)),
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
    let mut panels = measured_panels(&measured_rows);
    for (name, law) in laws(options.friction)? {
        let computed = test.run(law)?;
        write_series(&options.out.join(format!("{}.csv", file_stem(name))), &computed.packets)?;
        let table = table(name, &measured_rows, &computed.packets)?;
        println!("{table}");
        println!(
            "{} steps in {:.1} s, energy error {:.0e}\n",
            computed.steps,
            computed.wall.as_secs_f64(),
            computed.energy_error
        );
        text.push_str(&table);
        let curves = curves_of(&computed.packets);
        panels = if name == "Yielding" {
            with_curves(panels, curves, |panel, points| panel.dashed(name, CURVE_ORANGE, points))
        } else {
            with_curves(panels, curves, |panel, points| panel.line(name, CURVE_BLUE, points))
        };
    }
    let title = "A footing that rocks on dry sand: SSG02_03";
    let figure = Figure::new(title, 2, panels.into());
    figure.draw(&options.out.join("rocking_footing.svg"))?;
    if let Some(docs) = &options.docs {
        splice("rocking_footing.md", "rocking footing", &text)?;
        figure.draw(&docs.join("images/rocking_footing.svg"))?;
    }
    println!("files in {}", options.out.display());
    Ok(())
}

/// Moment, settlement and damping of each packet, measured and computed.
fn table(
    name: &str,
    measured: &[RockingPacket],
    computed: &[RockingPacket],
) -> Result<String, AnyError> {
    let mut text = format!(
        "**{name}**\n\n| packet | rotation, mrad | 2M/(P L), measured (left, right) | computed (left, right) | \
         settlement/L, measured | computed | damping, measured, % | computed, % |\n|---|---|---|---|---|---|---|---|\n"
    );
    for (measured, computed) in measured.iter().zip(computed) {
        let measured_ways = measured.moments_both_ways();
        let computed_ways = computed.moments_both_ways();
        writeln!(
            text,
            "| {} | {:.1} | {:.3} ({:.3}, {:.3}) | {:.3} ({:.3}, {:.3}) | {:.4} | {:.5} | {:.1} | {:.1} |",
            measured.name,
            1e3 * measured.rotation_amplitude(),
            measured.moment(),
            measured_ways[0],
            measured_ways[1],
            computed.moment(),
            computed_ways[0],
            computed_ways[1],
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

/// Points of a curve or markers.
type FigurePoints = Vec<(f64, f64)>;

/// Moment, and settlement, over rotation in mrad.
fn curves_of(packets: &[RockingPacket]) -> [FigurePoints; 2] {
    let rows = packets.iter().flat_map(|packet| &packet.rows);
    let moments = rows.clone().map(|row| (1e3 * row.rotation, row.moment)).collect();
    let settlements = rows.map(|row| (1e3 * row.rotation, row.settlement)).collect();
    [moments, settlements]
}

/// Adds a curve to each panel.
fn with_curves(
    [moments, settlements]: [FigurePanel; 2],
    [moment_points, settlement_points]: [FigurePoints; 2],
    add: impl Fn(FigurePanel, FigurePoints) -> FigurePanel,
) -> [FigurePanel; 2] {
    [add(moments, moment_points), add(settlements, settlement_points)]
}

/// Panels of moments and of settlements, with the measured rows.
fn measured_panels(packets: &[RockingPacket]) -> [FigurePanel; 2] {
    let moments = FigurePanel::new("rotation, mrad", "moment, 2M/(P L)")
        .legend(SeriesLabelPosition::UpperLeft)
        .room(0.05, 0.25);
    let settlements = FigurePanel::new("rotation, mrad", "settlement/L")
        .downward()
        .legend(SeriesLabelPosition::LowerLeft);
    with_curves([moments, settlements], curves_of(packets), |panel, points| {
        let points = points.into_iter().step_by(CROSS_INTERVAL).collect();
        panel.crosses("measured", CURVE_GRAY, points)
    })
}
