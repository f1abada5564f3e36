//! The table of readings, on the screen and as readings.csv.

use std::fs::File;
use std::path::Path;

use basemat::Error;
use basemat::coupled::StepError;
use csv::Writer;

use super::options::PaperReading;
use super::run::root_mean_square;
use crate::AnyError;
use basemat_problems::containment::{PAPER_SHEARS, TABLE_1_ROWS};

/// A line per reading; in the file, a line per run.
pub(crate) struct ReadingsTable {
    writer: Writer<File>,
}

impl ReadingsTable {
    /// Prints the heading and creates readings.csv in `folder`.
    pub(crate) fn new(folder: &Path) -> Result<Self, AnyError> {
        std::fs::create_dir_all(folder)?;
        let mut writer = Writer::from_path(folder.join("readings.csv"))?;
        writer.write_record([
            "reading",
            "case",
            "peak_base_shear_lb_per_ft",
            "largest_slip_m",
            "max_uplift_fraction",
            "peak_roof_displacement_m",
            "peak_roof_rise_m",
            "flow_chart_cycles",
            "error",
        ])?;
        println!(
            "peak shear between foundation and superstructure, lb/ft (against Table 1; shear under the \
             base; uplift; slip; A to a side, A up; steps in which the flow chart cycles); root mean \
             square of ln(peak/Table 1) over all rows, and over those that slide\n\n\
             | reading | bonded | uplift only | 0.4 | 0.3 | 0.2 | rms, all | rms, sliding |\n\
             |---|---|---|---|---|---|---|---|"
        );
        Ok(Self { writer })
    }

    /// Runs the requested rows.
    pub(crate) fn add(&mut self, name: &str, reading: &PaperReading) -> Result<(), AnyError> {
        let name = if name.is_empty() { "the paper's layer, Newmark" } else { name };
        print!("| {name} |");
        let mut logarithms = Vec::new();
        for &row in &reading.rows {
            let row = row.min(4);
            let cells = match reading.run(row) {
                Ok(results) => {
                    let ratio = results.shear[0] / PAPER_SHEARS[row];
                    logarithms.push((row, ratio.ln()));
                    print!(
                        " {:.0} ({:+.0} %; {:.0}; {:.0} %; {:.0} mm; {:.0}, {:.1} mm; {}) |",
                        results.shear[0],
                        100.0 * (ratio - 1.0),
                        results.shear[1],
                        100.0 * results.uplift,
                        1e3 * results.slip.abs(),
                        1e3 * results.roof[0],
                        1e3 * results.roof[1],
                        results.cycles
                    );
                    let numbers = [
                        results.shear[0],
                        results.slip,
                        results.uplift,
                        results.roof[0],
                        results.roof[1],
                    ];
                    let mut cells = numbers.map(|number| number.to_string()).to_vec();
                    cells.extend([results.cycles.to_string(), String::new()]);
                    cells
                }
                Err(error) => {
                    match &error {
                        Error::Step { step, time, source: StepError::Contact { .. }, .. } => {
                            print!(" step {step} (t = {time:.3} s): no modes |");
                        }
                        _ => print!(" {error} |"),
                    }
                    let mut cells = vec![String::new(); 6];
                    cells.push(error.to_string());
                    cells
                }
            };
            let names = [name.to_owned(), TABLE_1_ROWS[row].0.to_owned()];
            self.writer.write_record(names.iter().chain(&cells))?;
        }
        for first in [0, 2] {
            let row_count = reading.rows.iter().filter(|row| **row >= first).count();
            let counted_rows = logarithms.iter().filter(|(row, _)| *row >= first);
            let counted_rows: Vec<f64> = counted_rows.map(|(_, logarithm)| *logarithm).collect();
            // Without a mean if a row of the reading failed.
            if counted_rows.len() == row_count && row_count > 0 {
                print!(" {:.2} |", root_mean_square(&counted_rows));
            } else {
                print!(" – |");
            }
        }
        println!();
        self.writer.flush()?;
        Ok(())
    }
}
