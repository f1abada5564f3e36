//! The same scenes as in Python's tests, by the Rust crate: `reference containment 0.4 2000` writes
//! every time series bit by bit, `reference time 0.4 54000` the seconds of a run that keeps them.

use std::time::Instant;

use basemat::bem::{ElasticGround, Strip};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::el_centro_1940;
use basemat::results::Run;
use basemat::results::{Quantity, Recorder, TimeSeries};
use basemat::{Result, Simulation};
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

fn run(simulation: &mut Simulation, steps: usize) -> Result<(Run, TimeSeries)> {
    let mut histories = Recorder::new().start(simulation)?;
    histories.reserve(steps);
    let run = simulation.run(steps, |state| histories.record(state))?;
    Ok((run, histories))
}

/// Every number as the sixteen digits of its bits: time, scalars, probes, energy balance's input.
fn write(histories: &TimeSeries) -> Result<()> {
    let mut columns = vec![histories.times().to_vec()];
    columns.extend(Quantity::ALL.map(|quantity| histories.series(quantity).to_vec()));
    for probe in histories.probes() {
        columns.push(histories.probe(&probe.name)?.to_vec());
    }
    columns.push(
        histories.energy_balances().iter().map(|energy_balance| energy_balance.input).collect(),
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
        return Err("usage: reference containment|time FRICTION|bonded STEPS".into());
    };
    let friction = if friction == "bonded" { None } else { Some(friction.parse()?) };
    let steps = steps.parse()?;
    match task.as_str() {
        "containment" => write(&run(&mut scene(friction, steps)?, steps)?.1)?,
        "time" => {
            let mut simulation = scene(friction, steps)?;
            let begin = Instant::now();
            let (run, _) = run(&mut simulation, steps)?;
            println!("{} {:e}", begin.elapsed().as_secs_f64(), run.whole.base_shear.magnitude());
        }
        _ => return Err("the first argument is `containment` or `time`".into()),
    }
    Ok(())
}
