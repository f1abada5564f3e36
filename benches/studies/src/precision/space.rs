//! Error against run time in space: structures of shells on half-spaces.
//!
//! Elements of each part, cells and step are chosen one by one. Errors of the base shear and of the displacement of the
//! top are relative to finer runs, which `--reference` computes again. The content of
//! `benches/studies/tables/precision.md` comes from
//!
//! ```text
//! cargo study precision --space --reference --docs docs
//! cargo study precision --space --docs docs
//! ```

use std::fmt::Write as _;
use std::path::PathBuf;

use basemat::coupled::Coordinates;
use basemat::motion::RickerDisplacement;
use basemat::prelude::*;
use basemat::structure::FemModel;
use cpu_time::ProcessTime;

use super::report::machine;
use super::space_models::{building, containment};
use crate::AnyError;
use crate::document::{splice, write_csv};

/// Errors for which the fastest setting is printed.
const ALLOWED_ERRORS: [f64; 3] = [0.05, 0.01, 0.003];
/// Friction coefficient of a base that may lift and slide.
const FRICTION_COEFFICIENT: f64 = 0.5;
/// Divisor of the number of intervals in a short study.
const SHORT_DIVISOR: usize = 8;

#[derive(Debug, Clone, Copy)]
struct SpaceSetting {
    /// Elements of the parts of the model.
    elements: [usize; 4],
    /// Cells across the base.
    cells: usize,
    /// Time steps in an interval of the series.
    steps: usize,
}

const fn setting(elements: [usize; 4], cells: usize, steps: usize) -> SpaceSetting {
    SpaceSetting { elements, cells, steps }
}

/// A structure, its soil and a pulse.
struct SpaceScene {
    name: &'static str,
    /// The model and the degree of freedom of its top along x.
    model: fn([usize; 4]) -> basemat::Result<(FemModel, usize)>,
    /// Text for the elements of a model.
    elements_text: fn([usize; 4]) -> String,
    /// Shear wave speed, m/s.
    speed: f64,
    /// Amplitude of the pulse, m.
    pulse_amplitude: f64,
    /// Width of the pulse, s.
    pulse_width: f64,
    /// Interval of the series, s.
    interval: f64,
    intervals: usize,
    settings: &'static [SpaceSetting],
    /// The finest setting; half its elements; half its elements with fewer cells, and with twice the step.
    reference: [SpaceSetting; 4],
}

const SPACE_SCENES: [SpaceScene; 2] = [
    SpaceScene {
        name: "building on a square raft",
        model: building,
        elements_text: |[across, rows, ..]| format!("{across} × {rows}"),
        speed: 200.0,
        pulse_amplitude: 0.015,
        pulse_width: 0.12,
        interval: 0.01,
        intervals: 160,
        settings: &[
            setting([6, 1, 0, 0], 6, 1),
            setting([6, 1, 0, 0], 6, 2),
            setting([6, 2, 0, 0], 6, 1),
            setting([6, 2, 0, 0], 6, 2),
            setting([6, 2, 0, 0], 12, 2),
            setting([12, 1, 0, 0], 12, 2),
            setting([12, 2, 0, 0], 12, 2),
            setting([12, 2, 0, 0], 12, 4),
            setting([12, 2, 0, 0], 18, 4),
            setting([18, 2, 0, 0], 18, 4),
            setting([18, 2, 0, 0], 18, 8),
        ],
        reference: [
            setting([24, 2, 0, 0], 30, 4),
            setting([12, 2, 0, 0], 30, 4),
            setting([12, 2, 0, 0], 20, 4),
            setting([12, 2, 0, 0], 30, 2),
        ],
    },
    SpaceScene {
        name: "containment on a round raft",
        model: containment,
        elements_text: |[sectors, raft, wall, dome]| format!("{sectors} × {raft}, {wall}, {dome}"),
        speed: 500.0,
        pulse_amplitude: 0.01,
        pulse_width: 0.1,
        interval: 0.01,
        intervals: 140,
        settings: &[
            setting([12, 2, 2, 2], 6, 2),
            setting([24, 4, 4, 4], 12, 2),
            setting([8, 3, 3, 8], 6, 1),
            setting([8, 3, 3, 8], 6, 2),
            setting([12, 3, 3, 8], 8, 2),
            setting([12, 4, 4, 12], 12, 2),
            setting([16, 6, 4, 12], 12, 4),
            setting([16, 6, 4, 16], 16, 2),
            setting([16, 6, 4, 16], 16, 4),
            setting([20, 8, 4, 16], 16, 4),
            setting([24, 8, 6, 20], 24, 4),
            setting([24, 12, 6, 24], 24, 8),
            setting([40, 16, 8, 32], 29, 8),
            setting([44, 16, 8, 32], 30, 8),
        ],
        reference: [
            setting([32, 16, 8, 24], 32, 4),
            setting([16, 8, 4, 12], 32, 4),
            setting([16, 8, 4, 12], 24, 4),
            setting([16, 8, 4, 12], 32, 2),
        ],
    },
];

struct SpaceRun {
    /// Base shear, N, and displacement of the top, m.
    series: [Vec<f64>; 2],
    /// Processor time of build and run, s.
    seconds: f64,
    largest_open_fraction: f64,
    /// Largest mean slip, m.
    largest_slip: f64,
}

/// A scene, bonded or with friction.
struct SpaceCase<'a> {
    scene: &'a SpaceScene,
    bonded: bool,
    intervals: usize,
}

impl SpaceCase<'_> {
    fn name(&self) -> String {
        let law = if self.bonded { "bonded" } else { "lifts and slides" };
        format!("{}, {law}", self.scene.name)
    }

    /// Mean base shear of each interval, and displacement of the top at its end.
    fn run(&self, setting: SpaceSetting) -> basemat::Result<SpaceRun> {
        let scene = self.scene;
        let start_time = ProcessTime::now();
        let steps = self.intervals * setting.steps;
        let (model, top) = (scene.model)(setting.elements)?;
        let soil = Soil::from_shear_wave_speed(scene.speed, 1.0 / 3.0, 1900.0)?;
        let law: Box<dyn InterfaceLaw> = if self.bonded {
            Box::new(Bonded)
        } else {
            Box::new(Coulomb::new(FRICTION_COEFFICIENT)?)
        };
        let mut simulation = Simulation::builder(scene.interval / setting.steps as f64)
            .ground(ElasticGround::under(soil, &model, setting.cells)?)
            .structure(model)
            .interface(law)
            .motion(RickerDisplacement::new(
                scene.pulse_amplitude,
                scene.pulse_width,
                4.0 * scene.pulse_width,
            )?)
            .coordinates(Coordinates::Physical)
            .expected_steps(steps)
            .build()?;
        let mut shear = 0.0;
        let mut series = [vec![], vec![]];
        let mut step = 0_usize;
        let run = simulation.run(steps, |state| {
            shear += state.base_shear / setting.steps as f64;
            step += 1;
            if step.is_multiple_of(setting.steps) {
                series[0].push(std::mem::take(&mut shear));
                series[1].push(state.displacement()[top]);
            }
        })?;
        let seconds = start_time.elapsed().as_secs_f64();
        let cells = simulation.state().contact.len();
        let whole = &run.whole;
        println!("{}, {}: {cells} cells, {seconds:.2} s", self.name(), self.text(setting));
        Ok(SpaceRun {
            series,
            seconds,
            largest_open_fraction: whole.uplifted_fraction.magnitude(),
            largest_slip: whole.mean_slip.magnitude(),
        })
    }

    /// Text for a setting.
    fn text(&self, setting: SpaceSetting) -> String {
        let elements = (self.scene.elements_text)(setting.elements);
        format!("{elements} on {}, {} ms", setting.cells, self.time_step(setting))
    }

    /// Time step, ms.
    fn time_step(&self, setting: SpaceSetting) -> f64 {
        1e3 * self.scene.interval / setting.steps as f64
    }

    /// Series without errors of second order in elements and step, and a row of the changes between the runs.
    fn reference(&self) -> basemat::Result<([Vec<f64>; 2], String)> {
        let mut runs = vec![];
        for setting in self.scene.reference {
            runs.push(self.run(setting)?.series);
        }
        let [fine, half_elements, fewer_cells, double_step] = &runs[..] else {
            return Err(basemat::Error::part("reference", "needs four runs"));
        };
        let series = [0, 1].map(|k| {
            // Half the elements and twice the step change the series by three times both errors together.
            let pairs = fine[k].iter().zip(&double_step[k]);
            pairs.map(|(fine, coarse)| fine + (fine - coarse) / 3.0).collect()
        });
        let mut row = format!("| {} | {} ", self.name(), self.text(self.scene.reference[0]));
        for [run, finer] in
            [[half_elements, fine], [fewer_cells, half_elements], [double_step, half_elements]]
        {
            let shear = error(&run[0], &finer[0]);
            let top = error(&run[1], &finer[1]);
            write!(row, "| {shear:.1e}; {top:.1e} ").unwrap_or_default();
        }
        Ok((series, row + "|\n"))
    }

    /// Table of all settings, and the row of the fastest one for each of [`ALLOWED_ERRORS`].
    fn report(
        &self,
        reference: &[Vec<f64>; 2],
        settings: &[SpaceSetting],
    ) -> Result<[String; 2], AnyError> {
        let mut runs = vec![];
        for setting in settings {
            let run = self.run(*setting)?;
            let errors = [0, 1].map(|k| error(&run.series[k], &reference[k]));
            runs.push((*setting, run, errors));
        }
        let name = self.name();
        let finest_run = &runs[runs.len() - 1].1;
        let mut text = format!(
            "**{name}** (open {:.0} %, slip {:.1} mm)\n\n",
            100.0 * finest_run.largest_open_fraction,
            1e3 * finest_run.largest_slip
        );
        text += "| elements | cells | Δt, ms | base shear | top | s |\n|---|---|---|---|---|---|\n";
        for (setting, run, [shear, top]) in &runs {
            writeln!(
                text,
                "| {} | {} | {} | {shear:.1e} | {top:.1e} | {:.1} |",
                (self.scene.elements_text)(setting.elements),
                setting.cells,
                self.time_step(*setting),
                run.seconds
            )?;
        }
        let mut row = format!("| {name} ");
        for allowed_error in ALLOWED_ERRORS {
            // All settings that are at least as fine must be accurate, because errors of coarse settings may cancel.
            let accurate = runs.iter().filter(|(setting, ..)| {
                runs.iter().all(|(other, _, errors)| {
                    !other.is_as_fine_as(setting)
                        || errors.iter().all(|error| *error <= allowed_error)
                })
            });
            match accurate.min_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds)) {
                None => row += "| not reached ",
                Some((setting, run, _)) => {
                    write!(row, "| {}: {:.1} s ", self.text(*setting), run.seconds)?;
                }
            }
        }
        Ok([text, row + "|\n"])
    }
}

impl SpaceSetting {
    fn is_as_fine_as(&self, other: &Self) -> bool {
        let mut elements = self.elements.iter().zip(other.elements);
        elements.all(|(count, other)| *count >= other)
            && self.cells >= other.cells
            && self.steps >= other.steps
    }
}

/// Error of a series relative to a reference, which may be longer.
fn error(computed: &[f64], reference: &[f64]) -> f64 {
    let scale = reference.iter().take(computed.len()).copied().fold(0.0, f64::hypot);
    let difference = computed.iter().zip(reference).map(|(a, b)| a - b);
    difference.fold(0.0, f64::hypot) / scale
}

/// File of the references.
fn reference_file() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tables/precision_space.csv")
}

/// Reads the reference of a case.
fn read_reference(name: &str) -> Result<[Vec<f64>; 2], AnyError> {
    let mut series = [vec![], vec![]];
    for row in csv::Reader::from_path(reference_file())?.into_records() {
        let row = row?;
        if row.get(0) == Some(name) {
            for (column, values) in series.iter_mut().enumerate() {
                values.push(row.get(column + 1).unwrap_or_default().parse()?);
            }
        }
    }
    Ok(series)
}

/// Computes the references of all cases, and a table of their runs.
fn references(cases: &[SpaceCase]) -> Result<String, AnyError> {
    let mut rows = vec![];
    let mut text = String::new();
    for case in cases {
        let (series, row) = case.reference()?;
        println!("{row}");
        text += &row;
        let pairs = series[0].iter().zip(&series[1]);
        rows.extend(
            pairs.map(|(shear, top)| [case.name(), format!("{shear:.8e}"), format!("{top:.8e}")]),
        );
    }
    write_csv(reference_file(), ["case", "mean base shear, N", "top, m"], rows)?;
    let head = "| reference | finest run | half the elements | fewer cells | twice the step |\n";
    Ok(format!("{head}|---|---|---|---|---|\n{text}"))
}

/// Runs both scenes, bonded and with friction, or computes their references.
///
/// Prints tables; with `to_document` they also go into the document.
pub(crate) fn run(
    short: bool,
    to_document: bool,
    compute_references: bool,
) -> Result<(), AnyError> {
    let divisor = if short { SHORT_DIVISOR } else { 1 };
    let mut cases = Vec::new();
    for scene in &SPACE_SCENES {
        for bonded in [true, false] {
            cases.push(SpaceCase { scene, bonded, intervals: scene.intervals / divisor });
        }
    }
    if compute_references {
        return publish("work_precision reference", &references(&cases)?, to_document);
    }
    let mut tables = String::new();
    let mut rows = String::new();
    for case in &cases {
        let settings = case.scene.settings;
        let count = if short { 3 } else { settings.len() };
        let [text, row] = case.report(&read_reference(&case.name())?, &settings[..count])?;
        println!("\n{text}\n{row}");
        writeln!(tables, "{text}")?;
        rows += &row;
    }
    let head =
        "| scene: elements on cells across, Δt: time | 5 % | 1 % | 0.3 % |\n|---|---|---|---|";
    let text = format!("{}\n\n{head}\n{rows}\n{tables}", machine());
    publish("work_precision space", &text, to_document)
}

/// Prints a text, and puts it between the markers of this name in the document.
fn publish(name: &str, text: &str, to_document: bool) -> Result<(), AnyError> {
    println!("{text}");
    if to_document { splice("precision.md", name, text) } else { Ok(()) }
}
