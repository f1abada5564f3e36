//! Error against run time in three directions: structures of shells on half-spaces, raft and cells refined together.
//!
//! Errors of the base shear and of the displacement of the top are estimated by `refine`, which extrapolates from 6, 12
//! and 24 cells and from three time steps. More settings are compared with its extrapolated series. The content of
//! `benches/studies/tables/precision.md` comes from
//!
//! ```text
//! cargo study precision --space --docs docs
//! ```

use std::collections::HashMap;
use std::fmt::Write as _;

use basemat::coupled::{Coordinates, Refinement, refine};
use basemat::fem::{Direction, Material, Mesh, Shell};
use basemat::motion::RickerDisplacement;
use basemat::prelude::*;
use basemat::results::Extremes;
use basemat::structure::{FemModel, RayleighDamping};
use cpu_time::ProcessTime;

use super::report::machine;
use crate::AnyError;
use crate::document::splice;

/// Errors for which the fastest setting is printed.
const ERRORS: [f64; 3] = [0.05, 0.01, 0.003];
/// Friction where the base may lift and slide.
const FRICTION: f64 = 0.5;
/// Quantities of a run.
const QUANTITIES: [&str; 2] = ["base shear", "top"];
/// Settings beside the six of `refine`, of which two have fewer elements than cells.
const MORE: [Setting; 4] = [[6, 6, 1], [24, 24, 4], [6, 12, 2], [12, 24, 2]];

/// Elements across, cells across, and the number of time steps in an interval of the series.
type Setting = [usize; 3];

/// A structure, its soil and a pulse.
struct Scene {
    name: &'static str,
    /// The model, and the degree of freedom of its top along x, by the number of cells across.
    model: fn(usize) -> basemat::Result<(FemModel, usize)>,
    /// Shear wave speed, m/s.
    speed: f64,
    /// Amplitude (m) and width (s) of the pulse.
    pulse: [f64; 2],
    /// Interval of the series, s: pressure waves cross a cell of the coarsest setting.
    interval: f64,
    intervals: usize,
}

const SCENES: [Scene; 2] = [
    Scene {
        name: "building on a square raft",
        model: building,
        speed: 200.0,
        pulse: [0.015, 0.12],
        interval: 0.01,
        intervals: 160,
    },
    Scene {
        name: "containment on a round raft",
        model: containment,
        speed: 500.0,
        pulse: [0.01, 0.1],
        interval: 0.01,
        intervals: 140,
    },
];

/// A core of walls under a heavy roof on a raft of 18 × 18 m, all with squares of a cell's side.
fn building(cells: usize) -> basemat::Result<(FemModel, usize)> {
    const SIDE: f64 = 18.0;
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    let roof = Material::new(30.0e9, 0.2, 6000.0)?;
    let mut mesh = Mesh::in_space();
    let mut known = HashMap::new();
    let side = SIDE / cells as f64;
    let mut node = |mesh: &mut Mesh, place: [usize; 3]| -> basemat::Result<usize> {
        if let Some(node) = known.get(&place) {
            return Ok(*node);
        }
        let [x, y, z] = place.map(|count| side * count as f64);
        let node = mesh.add_node_at([x - 0.5 * SIDE, y - 0.5 * SIDE, z])?;
        known.insert(place, node);
        Ok(node)
    };
    let mut add = |corners: [[usize; 3]; 4], material, thickness| -> basemat::Result<()> {
        let corners = corners.map(|place| node(&mut mesh, place));
        let corners = corners.into_iter().collect::<basemat::Result<Vec<_>>>()?;
        mesh.add(Shell::new(corners, material, thickness)?).map(|_| ())
    };
    let level = |i, j, k| [[i, j, k], [i + 1, j, k], [i + 1, j + 1, k], [i, j + 1, k]];
    for place in 0..cells * cells {
        add(level(place % cells, place / cells, 0), concrete, 0.8)?;
    }
    let (edge, core, rows) = (cells / 6, 2 * cells / 3, 2 * cells / 3);
    for (along, row) in (0..core).flat_map(|along| (0..rows).map(move |row| (edge + along, row))) {
        for across in [edge, edge + core] {
            let wall = |place: fn(usize, usize, usize) -> [usize; 3]| {
                let ends = [(along, row), (along + 1, row), (along + 1, row + 1), (along, row + 1)];
                ends.map(|(along, row)| place(along, across, row))
            };
            add(wall(|along, across, row| [along, across, row]), concrete, 0.3)?;
            add(wall(|along, across, row| [across, along, row]), concrete, 0.3)?;
        }
    }
    for place in 0..core * core {
        add(level(edge + place % core, edge + place / core, rows), roof, 0.6)?;
    }
    let top = known[&[cells / 2, cells / 2, rows]];
    standing(mesh, top)
}

/// The containment of the example of that name, with elements that grow with the cells.
fn containment(cells: usize) -> basemat::Result<(FemModel, usize)> {
    const RADIUS: f64 = 20.0;
    const HEIGHT: f64 = 30.0;
    let concrete = Material::new(32.0e9, 0.2, 2450.0)?;
    // Fewer faces than cells.
    let (sectors, rows) = (2 * cells, cells / 3);
    let part = |index: usize| index as f64 / rows as f64;
    let raft = (0..rows).map(|i| [RADIUS * part(i), 0.0]);
    let wall = (0..rows).map(|i| [RADIUS, HEIGHT * part(i)]);
    let dome = (0..=rows).map(|i| {
        let angle = std::f64::consts::FRAC_PI_2 * part(i);
        let radius = if i == rows { 0.0 } else { RADIUS * angle.cos() };
        [radius, HEIGHT + RADIUS * angle.sin()]
    });
    let meridian: Vec<_> = raft.chain(wall).chain(dome).collect();
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, sectors)?;
    for shell in surface.shells(concrete, |row| [3.0, 1.2, 1.0][row / rows])? {
        mesh.add(shell)?;
    }
    let pole = mesh.nodes().len() - 1;
    standing(mesh, pole)
}

/// A mesh on its base with damping by stiffness alone, 5 % at 5 Hz; the degree of freedom of the node `top` along x.
fn standing(mesh: Mesh, top: usize) -> basemat::Result<(FemModel, usize)> {
    let damping = RayleighDamping::new(0.0, 0.1 / (std::f64::consts::TAU * 5.0))?;
    let model = FemModel::on_base(mesh)?.with_rayleigh(damping);
    let dof =
        model.dof(top, Direction::X).ok_or(basemat::Error::part("top", "no motion along x"))?;
    Ok((model, dof))
}

/// A run: both series, processor time of build and run (s), largest open fraction and slip (m).
struct Run {
    setting: Setting,
    series: [Vec<f64>; 2],
    seconds: f64,
    contact: [f64; 2],
}

/// A scene, bonded or with friction, and its runs.
struct Case<'a> {
    scene: &'a Scene,
    bonded: bool,
    intervals: usize,
    runs: Vec<Run>,
}

impl Case<'_> {
    /// The run of a setting, which is made unless it is there.
    fn run(&mut self, setting: Setting) -> basemat::Result<&Run> {
        let known = self.runs.iter().position(|run| run.setting == setting);
        if known.is_none() {
            self.runs.push(self.made(setting)?);
        }
        Ok(&self.runs[known.unwrap_or(self.runs.len() - 1)])
    }

    /// Mean base shear of each interval, and displacement of the top at its end.
    fn made(&self, setting: Setting) -> basemat::Result<Run> {
        let ([elements, cells, each], scene) = (setting, self.scene);
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
        println!("{setting:?}: {} cells, {seconds:.2} s", simulation.state().contact.len());
        let whole = &run.whole;
        let contact = [&whole.uplifted_fraction, &whole.mean_slip].map(Extremes::magnitude);
        Ok(Run { setting, series, seconds, contact })
    }

    /// `refine` of each quantity, with `first` cells and two steps an interval at first.
    fn refined(&mut self, first: usize) -> basemat::Result<[Refinement; 2]> {
        let interval = self.scene.interval;
        let mut of = |place: usize| {
            refine(first, 0.5 * interval, |cells, step| {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few")]
                let each = (interval / step).round() as usize;
                Ok(self.run([cells, cells, each])?.series[place].clone())
            })
        };
        Ok([of(0)?, of(1)?])
    }

    /// Table of all runs, and the row of settings for each of [`ERRORS`].
    fn report(&self, found: &[Refinement; 2]) -> Result<[String; 2], AnyError> {
        let law = if self.bonded { "bonded" } else { "lifts and slides" };
        let name = format!("{}, {law}", self.scene.name);
        let errors = |run: &Run| [0, 1].map(|k| error(&run.series[k], &found[k].extrapolated));
        let largest = |own: fn(&Run) -> f64| self.runs.iter().map(own).fold(0.0, f64::max);
        let mut text = format!(
            "**{name}** (open {:.0} %, slip {:.1} mm)\n\n",
            100.0 * largest(|run| run.contact[0]),
            1e3 * largest(|run| run.contact[1])
        );
        for (quantity, own) in QUANTITIES.iter().zip(found) {
            let Refinement { mesh_order, step_order, mismatch, .. } = own;
            writeln!(
                text,
                "{quantity}: order {mesh_order:.1} in the cells, {step_order:.1} in the step, mismatch {mismatch:.1e}.\n"
            )?;
        }
        text += "| elements | cells | Δt, ms | base shear | top | s |\n|---|---|---|---|---|---|\n";
        let step = |each: usize| 1e3 * self.scene.interval / each as f64;
        for run in &self.runs {
            let ([elements, cells, each], [shear, top]) = (run.setting, errors(run));
            let (step, seconds) = (step(each), run.seconds);
            writeln!(
                text,
                "| {elements} | {cells} | {step} | {shear:.1e} | {top:.1e} | {seconds:.1} |"
            )?;
        }
        let mut row = format!("| {name} ");
        for allowed in ERRORS {
            // A setting serves if all that are at least as fine serve, too: errors of coarse ones may cancel.
            let serves = |run: &Run| errors(run).into_iter().all(|error| error <= allowed);
            let finer = |run: &Run, other: &Run| (0..3).all(|k| other.setting[k] >= run.setting[k]);
            let good = |run: &&Run| self.runs.iter().all(|own| !finer(run, own) || serves(own));
            let best = self.runs.iter().filter(good);
            match best.min_by(|one, other| one.seconds.total_cmp(&other.seconds)) {
                None => row += "| not reached ",
                Some(Run { setting: [_, cells, each], seconds, .. }) => {
                    write!(row, "| {cells}, {} ms: {seconds:.1} s ", step(*each))?;
                }
            }
        }
        Ok([text, row + "|\n"])
    }
}

/// Error of a series relative to another one.
fn error(found: &[f64], wanted: &[f64]) -> f64 {
    let norm = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::hypot);
    norm(&mut found.iter().zip(wanted).map(|(a, b)| a - b)) / norm(&mut wanted.iter().copied())
}

/// Runs both scenes, bonded and with friction, and prints their tables; `quoted` ones go into the document.
pub(crate) fn run(short: bool, quoted: bool) -> Result<(), AnyError> {
    let (first, part) = if short { (3, 8) } else { (6, 1) };
    let (mut tables, mut rows) = (String::new(), String::new());
    for (scene, bonded) in SCENES.iter().flat_map(|scene| [(scene, true), (scene, false)]) {
        let mut case = Case { scene, bonded, intervals: scene.intervals / part, runs: vec![] };
        let found = case.refined(first)?;
        for setting in MORE.into_iter().filter(|_| !short) {
            case.run(setting)?;
        }
        let [text, row] = case.report(&found)?;
        println!("\n{text}\n{row}");
        writeln!(tables, "{text}")?;
        rows += &row;
    }
    let head = "| scene: cells across, Δt: time | 5 % | 1 % | 0.3 % |\n|---|---|---|---|";
    let text = format!("{}\n\n{head}\n{rows}\n{tables}", machine());
    if quoted {
        splice("precision.md", "work_precision space", &text)?;
    }
    println!("{text}");
    Ok(())
}
