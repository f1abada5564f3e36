//! The table of readings, on the screen and as readings.csv.

use std::fs::File;
use std::path::Path;

use basemat::Error;
use basemat::coupled::StepError;
use csv::Writer;

use super::options::Reading;
use super::run::root_mean_square;
use crate::AnyError;
use basemat_problems::containment::{PAPER_SHEARS, ROWS};

/// A line per reading; in the file, a line per run.
pub(crate) struct Table {
    writer: Writer<File>,
}

impl Table {
    /// Prints the heading and makes readings.csv in `folder`.
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
    pub(crate) fn add(&mut self, name: &str, reading: &Reading) -> Result<(), AnyError> {
        let name = if name.is_empty() { "the paper's layer, Newmark" } else { name };
        print!("| {name} |");
        let mut logarithms = Vec::new();
        for &row in &reading.rows {
            let row = row.min(4);
            let cells = match reading.run(row) {
                Ok(r) => {
                    let ratio = r.shear[0] / PAPER_SHEARS[row];
                    logarithms.push((row, ratio.ln()));
                    print!(
                        " {:.0} ({:+.0} %; {:.0}; {:.0} %; {:.0} mm; {:.0}, {:.1} mm; {}) |",
                        r.shear[0],
                        100.0 * (ratio - 1.0),
                        r.shear[1],
                        100.0 * r.uplift,
                        1e3 * r.slip.abs(),
                        1e3 * r.roof[0],
                        1e3 * r.roof[1],
                        r.cycles
                    );
                    let numbers = [r.shear[0], r.slip, r.uplift, r.roof[0], r.roof[1]];
                    let mut cells = numbers.map(|x| x.to_string()).to_vec();
                    cells.extend([r.cycles.to_string(), String::new()]);
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
            let names = [name.to_owned(), ROWS[row].0.to_owned()];
            self.writer.write_record(names.iter().chain(&cells))?;
        }
        for first in [0, 2] {
            let wanted = reading.rows.iter().filter(|row| **row >= first).count();
            let found = logarithms.iter().filter(|(row, _)| *row >= first).map(|(_, l)| *l);
            let found: Vec<f64> = found.collect();
            // A reading that some row does not survive has none.
            if found.len() == wanted && wanted > 0 {
                print!(" {:.2} |", root_mean_square(&found));
            } else {
                print!(" – |");
            }
        }
        println!();
        self.writer.flush()?;
        Ok(())
    }
}
