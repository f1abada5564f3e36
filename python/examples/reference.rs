//! The same scenes as in Python's tests, by the Rust crate: `reference containment 0.4 2000` writes
//! every time series bit by bit, so do `block`, `storeys` and `raft` of scenes in plan and
//! `basement` with walls, and `reference time 0.4 54000` the seconds of a run that keeps them.

use std::time::Instant;

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::coupled::Face;
use basemat::fem::{BeamSection, LumpedMass, Material, Mesh, Shell, SpaceBeam};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{PlaneWave, Triaxial, el_centro_1940};
use basemat::results::Run;
use basemat::results::{Quantity, Recorder, TimeSeries};
use basemat::site::TrenchMotion;
use basemat::structure::{
    Bilinear, FemModel, PlanStorey, RayleighDamping, RigidBlock, RigidBody, StoreyBuilding,
    WithWalls,
};
use basemat::{Result, Simulation, Soil, unobserved};
use basemat_problems::containment::Containment;

/// The containment as the studies have it.
fn scene(friction: Option<f64>, steps: usize) -> Result<Simulation> {
    let scene = Containment::default();
    let model = scene.structure()?;
    let probes = scene.probes(&model)?;
    let builder = Simulation::builder(scene.time_step(0.5))
        .ground(ElasticGround::new(scene.soil()?, Strip::uniform(scene.base(), scene.elements)?)?)
        .motion(el_centro_1940())
        .expected_steps(steps)
        .probes(probes)
        .structure(model);
    match friction {
        None => builder.interface(Bonded),
        Some(friction) => builder.interface(Coulomb::new(friction)?),
    }
    .build()
}

/// A square block under three records.
fn block(friction: f64) -> Result<Simulation> {
    let body = RigidBody::cuboid([8.0, 8.0, 10.0], 400.0)?;
    let record = el_centro_1940();
    let motion = Triaxial {
        x: Some(record.clone()),
        y: Some(record.scaled(0.8)?),
        up: Some(record.scaled(0.5)?),
    };
    Simulation::builder(0.01)
        .ground(ElasticGround::under(Soil::new(80.0e6, 0.25, 1900.0)?, &body, 4)?)
        .motion(motion)
        .interface(Coulomb::new(friction)?)
        .structure(body)
        .build()
}

/// An eccentric building that yields, on springs, under an oblique SH wave.
fn storeys(friction: f64) -> Result<Simulation> {
    let mat = RigidBody::cuboid([18.0, 12.0, 1.0], 2500.0)?;
    let storey = PlanStorey::new(3.2, 250.0e3, [18.0, 12.0], [4.0e8, 3.0e8, 2.0e10]);
    let storey = PlanStorey { stiffness_center: [-4.0, 0.0], ..storey };
    let building = StoreyBuilding::new(mat, &[storey; 3])?.with_law(
        0,
        StoreyBuilding::DIRECTION_ACROSS,
        Bilinear::new(3.0e8, 1.0e6, 0.1)?,
    )?;
    let wave = PlaneWave::sh(Soil::new(80.0e6, 0.25, 1900.0)?, 0.5)?;
    let motion = wave.field_from_across(&el_centro_1940(), -12.0)?.with_azimuth(0.6)?;
    let ground = SpringGround::under(&building, 4, 30.0e6, 20.0e6)?.with_dashpots(4e5, 3e5)?;
    let builder = Simulation::builder(0.01).ground(ground).motion(motion);
    builder.interface(Coulomb::new(friction)?).structure(building).build()
}

/// A raft of shells that bends, with a tower of beams that carries a mass, under three records.
fn raft(friction: f64) -> Result<Simulation> {
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    let mut mesh = Mesh::in_space();
    let place = |row, column| [2.0 * column as f64 - 6.0, 2.0 * row as f64 - 4.0, 0.0];
    let floor = mesh.add_grid(5, 7, place)?;
    for (_, cell) in floor.cells() {
        mesh.add(Shell::new(cell, concrete, 0.8)?)?;
    }
    let section = BeamSection::new(1.5, [0.2, 0.25], 0.3)?.with_shear_areas([1.2, 1.25])?;
    let mut top = mesh.node_at_point([0.0; 3])?;
    for height in [4.0, 8.0, 12.0] {
        let ends = [top, mesh.add_node_at([0.0, 0.0, height])?];
        mesh.add(SpaceBeam::new(ends, concrete, section, [1.0, 0.0, 0.0])?)?;
        top = ends[1];
    }
    mesh.add(LumpedMass::in_space(top, 200.0e3, [4.0e5, 5.0e5, 6.0e5])?)?;
    let model = FemModel::on_base(mesh)?.with_rayleigh(RayleighDamping::new(0.2, 1e-3)?);
    let record = el_centro_1940();
    let motion = Triaxial {
        x: Some(record.clone()),
        y: Some(record.scaled(0.8)?),
        up: Some(record.scaled(0.5)?),
    };
    let ground = ElasticGround::under(Soil::new(80.0e6, 0.25, 1900.0)?, &model, 4)?;
    let builder = Simulation::builder(0.01).ground(ground).motion(motion);
    builder.interface(Coulomb::new(friction)?).structure(model).build()
}

/// A block in a trench, with laws of its own for base and walls.
fn basement(friction: f64) -> Result<Simulation> {
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    let elements = Trench::new(-6.0..6.0, 5.0)?.elements(2, 2)?;
    let laws = elements.interfaces(Coulomb::new(0.5)?, Coulomb::new(friction)?);
    let ground = TrenchGround::new(soil, elements)?.with_pressure_at_rest(0.5)?;
    let record = el_centro_1940().padded(0.2, 0.0)?;
    Simulation::builder(0.02)
        .structure(WithWalls::new(RigidBlock::new(12.0, 20.0, 900.0)?, 5.0)?)
        .motion(TrenchMotion::new(&ground, record, &mut unobserved)?)
        .ground(ground)
        .interfaces(laws)
        .build()
}

fn run(simulation: &mut Simulation, steps: usize, recorder: Recorder) -> Result<(Run, TimeSeries)> {
    let mut histories = recorder.start(simulation)?;
    histories.reserve(steps)?;
    let run = simulation.run(steps, |state| histories.record(state))?;
    Ok((run, histories))
}

/// Every number as the sixteen digits of its bits: time, scalars, probes, energy balance's input.
fn write(histories: &TimeSeries) -> Result<()> {
    let mut columns = vec![histories.times().to_vec()];
    let quantities = Quantity::recorded(histories.in_plan());
    columns.extend(quantities.map(|quantity| histories.series(quantity).to_vec()));
    for probe in histories.probes() {
        columns.push(histories.probe(&probe.name)?.to_vec());
    }
    let walls = [Face::LeftWall, Face::RightWall];
    for face in walls.into_iter().filter(|face| histories.face(*face).any(|own| own.thrust > 0.0)) {
        columns.push(histories.face(face).map(|own| own.thrust).collect());
        columns.push(histories.face(face).map(|own| own.place).collect());
    }
    columns.push(
        histories
            .energy_balances()
            .iter()
            .map(|energy_balance| energy_balance.input)
            .collect(),
    );
    for k in 0..histories.times().len() {
        let row: Vec<String> =
            columns.iter().map(|column| format!("{:016x}", column[k].to_bits())).collect();
        println!("{}", row.join(" "));
    }
    Ok(())
}

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [task, friction, steps] = &arguments[..] else {
        return Err(
            "usage: reference containment|block|storeys|raft|basement|time FRICTION|bonded STEPS"
                .into(),
        );
    };
    let friction = if friction == "bonded" { None } else { Some(friction.parse()?) };
    let (steps, recorder) = (steps.parse()?, Recorder::new());
    match task.as_str() {
        "containment" => write(&run(&mut scene(friction, steps)?, steps, recorder)?.1)?,
        "block" => write(&run(&mut block(friction.unwrap_or(0.0))?, steps, recorder)?.1)?,
        "storeys" => write(&run(&mut storeys(friction.unwrap_or(0.0))?, steps, recorder)?.1)?,
        "raft" => write(&run(&mut raft(friction.unwrap_or(0.0))?, steps, recorder)?.1)?,
        "basement" => {
            let mut simulation = basement(friction.unwrap_or(0.0))?;
            write(&run(&mut simulation, steps, recorder.contact(1))?.1)?;
        }
        "time" => {
            let mut simulation = scene(friction, steps)?;
            let begin = Instant::now();
            let (run, _) = run(&mut simulation, steps, recorder)?;
            println!("{} {:e}", begin.elapsed().as_secs_f64(), run.whole.base_shear.magnitude());
        }
        _ => return Err(format!("there is no task '{task}'").into()),
    }
    Ok(())
}
