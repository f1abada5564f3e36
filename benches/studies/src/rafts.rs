//! Error against run time in three directions: a containment of shells and a building, on rafts that bend, lift and
//! slide.
//!
//! ```text
//! cargo study rafts --docs docs
//! ```
//!
//! Cells of the ground and time steps are refined; finite elements stay as they are.

use std::fmt::Write as _;

use basemat::coupled::{Refinement, refine};
use basemat::fem::{BeamSection, Direction, Material, Mesh};
use basemat::io::{GmshPart, GmshSpaceMesh};
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::{DofCombination, FemModel, RayleighDamping};

use crate::AnyError;
use crate::document::splice;

/// Error against run time of structures on rafts that bend.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Few steps, to see that all works.
    #[arg(long)]
    short: bool,
    /// Folder of the documentation: given, the table goes to benches/studies/tables.
    #[arg(long, conflicts_with = "short")]
    docs: Option<std::path::PathBuf>,
}

/// The mesh of the example `raft_from_gmsh`.
const MESH: &[u8] = include_bytes!("../../../examples/data/raft_building.msh");
/// Coarsest setting: cells across, the fewest under these rafts, and the time step (s), at which every setting takes samples.
const CELLS: usize = 8;
const COARSE: f64 = 0.01;
/// Errors for which the table names a setting.
const WANTED: [f64; 3] = [0.05, 0.01, 0.003];

/// A structure, its soil's speed of shear waves (m/s), its friction, and displacements of its top.
struct Scene {
    name: &'static str,
    model: FemModel,
    speed: f64,
    friction: f64,
    top: [DofCombination; 2],
}

/// The containment of the example `containment_in_space`: a raft of 3 m, a wall of 1.2 m, a dome of 1 m.
fn containment() -> basemat::Result<Scene> {
    let concrete = Material::new(32.0e9, 0.2, 2450.0)?;
    let (radius, height) = (20.0, 30.0);
    let part = |index: u32, of: u32| f64::from(index) / f64::from(of);
    let mut meridian: Vec<[f64; 2]> = (0..5).map(|i| [radius * part(i, 5), 0.0]).collect();
    meridian.extend((0..5).map(|i| [radius, height * part(i, 5)]));
    meridian.extend((0..=4).map(|i| {
        let angle = std::f64::consts::FRAC_PI_2 * part(i, 4);
        [if i == 4 { 0.0 } else { radius * angle.cos() }, height + radius * angle.sin()]
    }));
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, 24)?;
    let thickness = |row: usize| {
        if row < 5 {
            3.0
        } else if row < 10 {
            1.2
        } else {
            1.0
        }
    };
    for shell in surface.shells(concrete, thickness)? {
        mesh.add(shell)?;
    }
    let highest = |(_, a): &(usize, &[f64; 3]), (_, b): &(usize, &[f64; 3])| a[2].total_cmp(&b[2]);
    let apex = mesh.nodes().iter().enumerate().max_by(highest).map_or(0, |(node, _)| node);
    let damping = RayleighDamping::from_ratios([4.0, 25.0], [0.05, 0.05])?;
    let model = FemModel::on_base(mesh)?.with_rayleigh(damping);
    let top = [model.row(apex, Direction::X)?, model.row(apex, Direction::Y)?];
    Ok(Scene { name: "containment of shells", model, speed: 500.0, friction: 0.5, top })
}

/// The building of the example `raft_from_gmsh`: floors and core of shells, columns of beams.
fn building() -> basemat::Result<Scene> {
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    let floor = Material::new(30.0e9, 0.2, 3700.0)?;
    let second_moment = 0.5_f64.powi(4) / 12.0;
    let column = BeamSection::new(0.25, [second_moment; 2], 0.1406 * 0.5_f64.powi(4))?;
    let gmsh = GmshSpaceMesh::from_reader("raft_building.msh", MESH)?;
    let mesh = gmsh.mesh(&[
        ("raft", GmshPart::Shell(concrete, 0.9)),
        ("floors", GmshPart::Shell(floor, 0.25)),
        ("core", GmshPart::Shell(concrete, 0.3)),
        ("columns", GmshPart::Beam(concrete, column, [1.0, 0.0, 0.0])),
    ])?;
    let corner = gmsh.cells(0, "roof corner")?[0][0];
    let damping = RayleighDamping::from_ratios([1.5, 15.0], [0.05, 0.05])?;
    let model = FemModel::on_faces(mesh, &gmsh.cells(2, "raft")?)?.with_rayleigh(damping);
    let top = [model.row(corner, Direction::X)?, model.row(corner, Direction::Y)?];
    Ok(Scene { name: "building", model, speed: 250.0, friction: 0.4, top })
}

/// Displacements of the top (m), every 0.01 s.
fn displacements(
    scene: &Scene,
    law: impl InterfaceLaw + 'static,
    steps: usize,
    (cells, step): (usize, f64),
) -> basemat::Result<Vec<f64>> {
    let record = el_centro_1940();
    let late = |factor: f64, quiet: f64| record.scaled(factor)?.padded(quiet, 0.0);
    let (y, up) = (Some(late(0.7, 0.3)?), Some(late(0.4, 0.6)?));
    let soil = Soil::from_shear_wave_speed(scene.speed, 1.0 / 3.0, 2000.0)?;
    // Steps are halved once or twice.
    let count = [1, 2, 4][usize::from(step < 0.75 * COARSE) + usize::from(step < 0.375 * COARSE)];
    let mut simulation = Simulation::builder(step)
        .ground(ElasticGround::under(soil, &scene.model, cells)?)
        .structure(scene.model.clone())
        .interface(law)
        .motion(Triaxial { x: Some(record.clone()), y, up })
        .expected_steps(steps * count)
        .build()?;
    let mut series = Vec::new();
    let mut number = 0;
    let run = simulation.run(steps * count, |state| {
        number += 1;
        if number % count == 0 {
            series.extend(scene.top.iter().map(|top| top.value(state.displacement())));
        }
    })?;
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    Ok(series)
}

/// Rows of the six settings, then of the fastest settings for the wanted errors.
fn rows(name: &str, found: &Refinement, text: &mut String) -> std::fmt::Result {
    for own in &found.settings {
        writeln!(
            text,
            "| {name} | {0} | {1} | {2:.1} | {3:.2} |",
            own.elements,
            1e3 * own.time_step,
            100.0 * own.error,
            own.wall.as_secs_f64(),
        )?;
    }
    for wanted in WANTED {
        let enough = found.settings.iter().filter(|own| own.error <= wanted);
        let fastest = enough.min_by_key(|own| own.wall);
        let setting = fastest.map_or("none of these".to_owned(), |own| {
            format!("{} cells, {} ms", own.elements, 1e3 * own.time_step)
        });
        println!("{name}, {} %: {setting}", 100.0 * wanted);
    }
    Ok(())
}

pub(crate) fn run(options: &Options) -> Result<(), AnyError> {
    let steps = if options.short { 10 } else { 300 };
    let mut text =
        "| structure | cells | Δt, ms | error, % | s |\n|---|---|---|---|---|\n".to_owned();
    for scene in [containment()?, building()?] {
        let lifts = Coulomb::new(scene.friction)?;
        let bonded = refine(CELLS, COARSE, |n, dt| displacements(&scene, Bonded, steps, (n, dt)))?;
        let sliding = refine(CELLS, COARSE, |n, dt| displacements(&scene, lifts, steps, (n, dt)))?;
        for (base, found) in [("bonded", &bonded), ("lifts and slides", &sliding)] {
            println!("{}, {base}\n{found}\n", scene.name);
            rows(&format!("{}, {base}", scene.name), found, &mut text)?;
        }
    }
    println!("{text}");
    if options.docs.is_some() {
        splice("rafts.md", "rafts errors", &text)?;
    }
    Ok(())
}
