//! Error against run time in three directions: structures of shells on half-spaces.
//!
//! Elements of each part, cells and step are chosen one by one. Errors of the base shear and of the displacement of the top
//! are relative to finer runs, which `--reference` makes again. The content of `benches/studies/tables/precision.md` comes
//! from
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
use basemat::results::Extremes;
use basemat::structure::FemModel;
use cpu_time::ProcessTime;

use super::report::machine;
use super::space_models::{building, containment};
use crate::AnyError;
use crate::document::{splice, write_csv};

/// Errors for which the fastest setting is printed.
const ERRORS: [f64; 3] = [0.05, 0.01, 0.003];
/// Friction where the base may lift and slide.
const FRICTION: f64 = 0.5;
/// Parts of a scene in a short study.
const SHORT: usize = 8;

/// Elements of the model, cells across, and the number of time steps in an interval of the series.
type Setting = ([usize; 4], usize, usize);

/// A structure, its soil and a pulse.
struct Scene {
    name: &'static str,
    /// The model and the degree of freedom of its top along x.
    model: fn([usize; 4]) -> basemat::Result<(FemModel, usize)>,
    /// Words for the elements of a model.
    elements: fn([usize; 4]) -> String,
    /// Shear wave speed, m/s.
    speed: f64,
    /// Amplitude (m) and width (s) of the pulse.
    pulse: [f64; 2],
    /// Interval of the series, s.
    interval: f64,
    intervals: usize,
    settings: &'static [Setting],
    /// The finest; with half the elements; and with these fewer cells, or twice the step.
    reference: [Setting; 4],
}

const SCENES: [Scene; 2] = [
    Scene {
        name: "building on a square raft",
        model: building,
        elements: |[across, rows, ..]| format!("{across} × {rows}"),
        speed: 200.0,
        pulse: [0.015, 0.12],
        interval: 0.01,
        intervals: 160,
        settings: &[
            ([6, 1, 0, 0], 6, 1),
            ([6, 1, 0, 0], 6, 2),
            ([6, 2, 0, 0], 6, 1),
            ([6, 2, 0, 0], 6, 2),
            ([6, 2, 0, 0], 12, 2),
            ([12, 1, 0, 0], 12, 2),
            ([12, 2, 0, 0], 12, 2),
            ([12, 2, 0, 0], 12, 4),
            ([12, 2, 0, 0], 18, 4),
            ([18, 2, 0, 0], 18, 4),
            ([18, 2, 0, 0], 18, 8),
        ],
        reference: [
            ([24, 2, 0, 0], 30, 4),
            ([12, 2, 0, 0], 30, 4),
            ([12, 2, 0, 0], 20, 4),
            ([12, 2, 0, 0], 30, 2),
        ],
    },
    Scene {
        name: "containment on a round raft",
        model: containment,
        elements: |[sectors, raft, wall, dome]| format!("{sectors} × {raft}, {wall}, {dome}"),
        speed: 500.0,
        pulse: [0.01, 0.1],
        interval: 0.01,
        intervals: 140,
        settings: &[
            ([12, 2, 2, 2], 6, 2),
            ([24, 4, 4, 4], 12, 2),
            ([8, 3, 3, 8], 6, 1),
            ([8, 3, 3, 8], 6, 2),
            ([12, 3, 3, 8], 8, 2),
            ([12, 4, 4, 12], 12, 2),
            ([16, 6, 4, 12], 12, 4),
            ([16, 6, 4, 16], 16, 2),
            ([16, 6, 4, 16], 16, 4),
            ([20, 8, 4, 16], 16, 4),
            ([24, 8, 6, 20], 24, 4),
            ([24, 12, 6, 24], 24, 8),
            ([40, 16, 8, 32], 29, 8),
            ([44, 16, 8, 32], 30, 8),
        ],
        reference: [
            ([32, 16, 8, 24], 32, 4),
            ([16, 8, 4, 12], 32, 4),
            ([16, 8, 4, 12], 24, 4),
            ([16, 8, 4, 12], 32, 2),
        ],
    },
];

/// A run: both series, processor time of build and run (s), largest open fraction and slip (m).
struct Run {
    series: [Vec<f64>; 2],
    seconds: f64,
    contact: [f64; 2],
}

/// A scene, bonded or with friction.
struct Case<'a> {
    scene: &'a Scene,
    bonded: bool,
    intervals: usize,
}

impl Case<'_> {
    fn name(&self) -> String {
        let law = if self.bonded { "bonded" } else { "lifts and slides" };
        format!("{}, {law}", self.scene.name)
    }

    /// Mean base shear of each interval, and displacement of the top at its end.
    fn run(&self, setting: Setting) -> basemat::Result<Run> {
        let ((elements, cells, each), scene) = (setting, self.scene);
        let (begin, steps) = (ProcessTime::now(), self.intervals * each);
        let (model, top) = (scene.model)(elements)?;
        let soil = Soil::from_shear_wave_speed(scene.speed, 1.0 / 3.0, 1900.0)?;
        let [amplitude, width] = scene.pulse;
        let law: Box<dyn InterfaceLaw> =
            if self.bonded { Box::new(Bonded) } else { Box::new(Coulomb::new(FRICTION)?) };
        let mut simulation = Simulation::builder(scene.interval / each as f64)
            .ground(ElasticGround::under(soil, &model, cells)?)
            .structure(model)
            .interface(law)
            .motion(RickerDisplacement::new(amplitude, width, 4.0 * width)?)
            .coordinates(Coordinates::Physical)
            .expected_steps(steps)
            .build()?;
        let (mut shear, mut series, mut step) = (0.0, [vec![], vec![]], 0_usize);
        let run = simulation.run(steps, |state| {
            shear += state.base_shear / each as f64;
            step += 1;
            if step.is_multiple_of(each) {
                series[0].push(std::mem::take(&mut shear));
                series[1].push(state.displacement()[top]);
            }
        })?;
        let seconds = begin.elapsed().as_secs_f64();
        let (cells, whole) = (simulation.state().contact.len(), &run.whole);
        println!("{}, {setting:?}: {cells} cells, {seconds:.2} s", self.name());
        let contact = [&whole.uplifted_fraction, &whole.mean_slip].map(Extremes::magnitude);
        Ok(Run { series, seconds, contact })
    }

    /// Words for a setting.
    fn words(&self, (elements, cells, each): Setting) -> String {
        let (elements, step) = ((self.scene.elements)(elements), self.step(each));
        format!("{elements} on {cells}, {step} ms")
    }

    /// Time step, ms.
    fn step(&self, each: usize) -> f64 {
        1e3 * self.scene.interval / each as f64
    }

    /// Series without errors of second order in elements and step, and a row of the changes from which they follow.
    fn reference(&self) -> basemat::Result<([Vec<f64>; 2], String)> {
        let mut runs = vec![];
        for setting in self.scene.reference {
            runs.push(self.run(setting)?.series);
        }
        let [fine, coarse, fewer, slow] = [0, 1, 2, 3].map(|place: usize| &runs[place]);
        let series = [0, 1].map(|k| {
            // Half the elements and twice the step change the series by three times both errors together.
            let pairs = fine[k].iter().zip(&slow[k]);
            pairs.map(|(fine, slow)| fine + (fine - slow) / 3.0).collect()
        });
        let mut row = format!("| {} | {} ", self.name(), self.words(self.scene.reference[0]));
        for [one, other] in [[coarse, fine], [fewer, coarse], [slow, coarse]] {
            let [shear, top] = [0, 1].map(|k| error(&one[k], &other[k]));
            write!(row, "| {shear:.1e}; {top:.1e} ").unwrap_or_default();
        }
        Ok((series, row + "|\n"))
    }

    /// Table of all settings, and the row of the fastest one for each of [`ERRORS`].
    fn report(
        &self,
        reference: &[Vec<f64>; 2],
        settings: &[Setting],
    ) -> Result<[String; 2], AnyError> {
        let mut runs = vec![];
        for setting in settings {
            let run = self.run(*setting)?;
            let errors = [0, 1].map(|k| error(&run.series[k], &reference[k]));
            runs.push((*setting, run, errors));
        }
        let name = self.name();
        let [open, slip] = runs.last().map_or([0.0; 2], |(_, run, _)| run.contact);
        let (open, slip) = (100.0 * open, 1e3 * slip);
        let mut text = format!("**{name}** (open {open:.0} %, slip {slip:.1} mm)\n\n");
        text += "| elements | cells | Δt, ms | base shear | top | s |\n|---|---|---|---|---|---|\n";
        for ((elements, cells, each), run, [shear, top]) in &runs {
            let (elements, step) = ((self.scene.elements)(*elements), self.step(*each));
            let seconds = run.seconds;
            writeln!(
                text,
                "| {elements} | {cells} | {step} | {shear:.1e} | {top:.1e} | {seconds:.1} |"
            )?;
        }
        let mut row = format!("| {name} ");
        for allowed in ERRORS {
            let serves = |errors: &[f64; 2]| errors.iter().all(|error| *error <= allowed);
            // A setting serves if all that are at least as fine serve, too: errors of coarse ones may cancel.
            let finer = |one: &Setting, other: &Setting| {
                let elements = one.0.iter().zip(other.0).all(|(one, other)| *one >= other);
                elements && one.1 >= other.1 && one.2 >= other.2
            };
            let good = runs.iter().filter(|(setting, ..)| {
                runs.iter().all(|(other, _, errors)| !finer(other, setting) || serves(errors))
            });
            match good.min_by(|one, other| one.1.seconds.total_cmp(&other.1.seconds)) {
                None => row += "| not reached ",
                Some((setting, run, _)) => {
                    write!(row, "| {}: {:.1} s ", self.words(*setting), run.seconds)?;
                }
            }
        }
        Ok([text, row + "|\n"])
    }
}

/// Error of a series relative to another one, which may be longer.
fn error(found: &[f64], wanted: &[f64]) -> f64 {
    let norm = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::hypot);
    let size = norm(&mut wanted.iter().take(found.len()).copied());
    norm(&mut found.iter().zip(wanted).map(|(a, b)| a - b)) / size
}

/// File of the references.
fn file() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tables/precision_space.csv")
}

/// Reads the reference of a case.
fn known(name: &str) -> Result<[Vec<f64>; 2], AnyError> {
    let mut series = [vec![], vec![]];
    for row in csv::Reader::from_path(file())?.into_records() {
        let row = row?;
        if row.get(0) == Some(name) {
            for (place, values) in series.iter_mut().enumerate() {
                values.push(row.get(place + 1).unwrap_or_default().parse()?);
            }
        }
    }
    Ok(series)
}

/// Makes the references of all cases again, and a table of what they rest on.
fn references(cases: &[Case]) -> Result<String, AnyError> {
    let (mut rows, mut text) = (vec![], String::new());
    for case in cases {
        let (series, row) = case.reference()?;
        println!("{row}");
        text += &row;
        let pairs = series[0].iter().zip(&series[1]);
        rows.extend(
            pairs.map(|(shear, top)| [case.name(), format!("{shear:.8e}"), format!("{top:.8e}")]),
        );
    }
    write_csv(file(), ["case", "mean base shear, N", "top, m"], rows)?;
    let head = "| reference | finest run | half the elements | fewer cells | twice the step |\n";
    Ok(format!("{head}|---|---|---|---|---|\n{text}"))
}

/// Runs both scenes, bonded and with friction, and prints their tables; `quoted` ones go into the document. Or makes the
/// references `again`.
pub(crate) fn run(short: bool, quoted: bool, again: bool) -> Result<(), AnyError> {
    let part = if short { SHORT } else { 1 };
    let scenes = SCENES.iter().flat_map(|scene| [(scene, true), (scene, false)]);
    let case = |(scene, bonded): (&'static Scene, bool)| Case {
        scene,
        bonded,
        intervals: scene.intervals / part,
    };
    let cases: Vec<_> = scenes.map(case).collect();
    let quote = |name: &str, text: &str| {
        println!("{text}");
        if quoted { splice("precision.md", name, text) } else { Ok(()) }
    };
    if again {
        return quote("work_precision reference", &references(&cases)?);
    }
    let (mut tables, mut rows) = (String::new(), String::new());
    for case in &cases {
        let settings = case.scene.settings;
        let count = if short { 3 } else { settings.len() };
        let [text, row] = case.report(&known(&case.name())?, &settings[..count])?;
        println!("\n{text}\n{row}");
        writeln!(tables, "{text}")?;
        rows += &row;
    }
    let head =
        "| scene: elements on cells across, Δt: time | 5 % | 1 % | 0.3 % |\n|---|---|---|---|";
    quote("work_precision space", &format!("{}\n\n{head}\n{rows}\n{tables}", machine()))
}
