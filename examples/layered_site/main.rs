//! One building on four grounds: rock, the half-plane of the soil at its surface, and the layers that
//! are really there, without and with damping.
//!
//! ```text
//! cargo run --release --example layered_site
//! cargo run --release --example layered_site -- --out somewhere
//! ```
//!
//! The record, El Centro at 0.15 g, is that of the rock's outcrop. A simulation takes the motion of the
//! free surface, so on rock it is the record itself, elsewhere what `site::Column` makes of it on the
//! way up through the damped layers. The three soils see the same surface motion: what differs in
//! their columns comes from the ground under the building alone. The last case has no damping on
//! the way up either, and belongs to none of them.

mod picture;

use std::path::PathBuf;

use basemat::Result;
use basemat::bem::{ElasticGround, SharedKernels};
use basemat::coupled::EnergyTerm;
use basemat::motion::SpectralOrdinate;
use basemat::prelude::*;
use basemat::results::log_spaced;
use basemat::site::{Column, ControlPoint, VerticalWave};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::ModalDamping;
use clap::Parser;
use cpu_time::ThreadTime;

const STEP: f64 = 5.0e-3;
const STEPS: usize = 2000;
const ELEMENTS: usize = 10;
const FRICTION: f64 = 0.3;
const STOREYS: usize = 5;

/// A building on rock, on a half-plane, on layers.
#[derive(Parser)]
struct Options {
    /// Folder for the picture and the table.
    #[arg(long, default_value = "target/layered_site")]
    out: PathBuf,
}

/// Six metres of soft clay and twelve of sand on rock; shear wave speed, ν, density, thickness,
/// damping ratio.
const LAYERS: [(f64, f64, f64, f64, f64); 2] =
    [(150.0, 0.40, 1800.0, 6.0, 0.05), (280.0, 0.35, 1950.0, 12.0, 0.03)];
const ROCK: (f64, f64, f64, f64) = (800.0, 0.25, 2300.0, 0.01);

fn site(damped: bool) -> Result<SoilProfile> {
    // Of the record's frequencies, and on either side of the storeys' and the layers'.
    let law = |ratio: f64| {
        GeneralizedMaxwell::constant_q(if damped { ratio } else { 0.0 }, [0.2, 25.0], 2.0)
    };
    let rock = Soil::from_shear_wave_speed(ROCK.0, ROCK.1, ROCK.2)?;
    let mut profile = SoilProfile::on_half_plane(rock).with_base_damping(law(ROCK.3)?);
    for (speed, poisson, density, thickness, ratio) in LAYERS {
        let soil = Soil::from_shear_wave_speed(speed, poisson, density)?;
        profile = profile.with_layer(soil, thickness)?.with_damping(law(ratio)?);
    }
    Ok(profile)
}

struct Case {
    name: &'static str,
    run: Run,
    /// Of the free surface and of the roof, 5 %.
    spectra: [Vec<SpectralOrdinate>; 2],
    /// Processor time before the first step, and of all of them, s.
    seconds: [f64; 2],
}

fn shake(
    name: &'static str,
    periods: &[f64],
    motion: &Record,
    ground: impl FnOnce(&dyn Structure) -> Result<Box<dyn Ground>>,
) -> Result<Case> {
    let storeys = [Storey::new(3.0, 24.0e3, 60.0e6); STOREYS];
    let building = ShearBuilding::new(8.0, 60.0e3, 4.0e5, &storeys)?;
    let roof = building.roof();
    let damped = ModalDamping::new(&[0.05])?.on(building)?;
    let begin = ThreadTime::now();
    let mut simulation = Simulation::builder(STEP)
        .ground(ground(&damped)?)
        .structure(damped)
        .interface(Coulomb::new(FRICTION)?)
        .motion(motion.clone())
        .probe(Probe::displacement("roof", roof))
        .probe(Probe::acceleration("roof, total", roof))
        .expected_steps(STEPS)
        .build()?;
    let ready = begin.elapsed().as_secs_f64();
    let mut histories = Recorder::new().start(&simulation)?;
    let run = simulation.run(STEPS, |state| histories.record(state))?;
    let seconds = [ready, begin.elapsed().as_secs_f64() - ready];
    let surface = motion.response_spectrum(periods, 0.05)?;
    let roof = histories.floor_spectrum("roof, total", periods, 0.05)?;
    Ok(Case { name, run, spectra: [surface, roof], seconds })
}

/// Motion of the free surface over a profile whose rock outcrop moves as `record`.
fn surface(profile: SoilProfile, record: &Record) -> Result<Record> {
    let column = Column::new(profile, VerticalWave::Shear)?;
    let outcrop = record.accelerations();
    Record::new(STEP, column.to_surface(ControlPoint::Outcrop, STEP, outcrop)?.samples)
}

fn main() -> std::result::Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let out = Options::parse().out;
    std::fs::create_dir_all(&out)?;
    let (damped, elastic) = (site(true)?, site(false)?);
    println!("{damped}\n");

    let outcrop = el_centro_1940().scaled_to_peak(0.15 * STANDARD_GRAVITY)?.resampled(STEP)?;
    let free_surface = surface(damped.clone(), &outcrop)?;
    let undamped_surface = surface(elastic.clone(), &outcrop)?;
    let clay = Soil::from_shear_wave_speed(LAYERS[0].0, LAYERS[0].1, LAYERS[0].2)?;
    let rock = Soil::from_shear_wave_speed(ROCK.0, ROCK.1, ROCK.2)?;

    let periods = log_spaced(0.05, 3.0, 121)?;
    let half_plane = |soil: Soil| {
        move |structure: &dyn Structure| -> Result<Box<dyn Ground>> {
            Ok(Box::new(ElasticGround::under(soil, structure, ELEMENTS)?))
        }
    };
    // Two cases stand on the elastic layers, whose coefficients are computed once.
    let kernels = SharedKernels::default();
    let layered = |profile: &SoilProfile| {
        let (profile, kernels) = (profile.clone(), kernels.clone());
        move |structure: &dyn Structure| -> Result<Box<dyn Ground>> {
            let ground = ElasticGround::under(profile, structure, ELEMENTS)?;
            Ok(Box::new(ground.with_shared_kernels(&kernels)))
        }
    };
    let cases = [
        shake("rock", &periods, &outcrop, half_plane(rock))?,
        shake("clay throughout", &periods, &free_surface, half_plane(clay))?,
        shake("layers, elastic", &periods, &free_surface, layered(&elastic))?,
        shake("layers, damped", &periods, &free_surface, layered(&damped))?,
        shake("no damping at all", &periods, &undamped_surface, layered(&elastic))?,
    ];

    let table =
        table(&cases, [&outcrop, &free_surface, &free_surface, &free_surface, &undamped_surface])?;
    println!("{table}");
    std::fs::write(out.join("table.txt"), &table)?;
    picture::draw(&out.join("layered_site.svg"), &damped, &cases[..4])?;
    println!("picture: {}", out.join("layered_site.svg").display());
    Ok(())
}

fn table(cases: &[Case], motions: [&Record; 5]) -> Result<String> {
    let line = |name: &str, cells: Vec<String>| {
        let cells = cells.iter().map(|cell| format!("{cell:>19}")).collect::<Vec<_>>();
        format!("{name:<28}{}\n", cells.concat())
    };
    let names = cases.iter().map(|case| case.name.to_owned());
    let mut text = line("10 s, friction 0.3", names.collect());
    let mut row = |name: &str, digits: usize, values: Vec<f64>| {
        text += &line(name, values.iter().map(|value| format!("{value:.digits$}")).collect());
    };
    let of = |what: &dyn Fn(&Case) -> f64| cases.iter().map(what).collect::<Vec<_>>();
    let probe = |name: &str| -> Result<Vec<f64>> {
        cases.iter().map(|case| Ok(case.run.probe(name)?.magnitude())).collect()
    };
    row(
        "free surface, peak, g",
        3,
        motions.map(|record| record.peak_acceleration() / STANDARD_GRAVITY).to_vec(),
    );
    row("base shear, kN/m", 1, of(&|case| 1e-3 * case.run.whole.base_shear.magnitude()));
    row("  over weight", 3, of(&|case| case.run.shear_coefficient().unwrap_or(f64::NAN)));
    row(
        "uplifted part, %",
        0,
        of(&|case| 100.0 * case.run.whole.uplifted_fraction.largest().value),
    );
    row("mean slip, peak, mm", 2, of(&|case| 1e3 * case.run.whole.mean_slip.magnitude()));
    row("mean slip, residual, mm", 2, of(&|case| 1e3 * case.run.whole.residual_slip));
    row("base rotation, mrad", 2, of(&|case| 1e3 * case.run.whole.base_rotation.magnitude()));
    row("roof, displacement, mm", 1, probe("roof")?.iter().map(|u| 1e3 * u).collect());
    let total = probe("roof, total")?;
    row("roof, acceleration, g", 3, total.iter().map(|a| a / STANDARD_GRAVITY).collect());
    let peak = |spectrum: &[SpectralOrdinate]| {
        spectrum.iter().fold(0.0_f64, |m, o| m.max(o.pseudo_acceleration)) / STANDARD_GRAVITY
    };
    row("roof's spectrum, peak, g", 3, of(&|case| peak(&case.spectra[1])));
    row(
        "energy to the soil, %",
        1,
        of(&|case| 100.0 * case.run.ledger.share(EnergyTerm::Soil).unwrap_or(f64::NAN)),
    );
    row("before the first step, s", 2, of(&|case| case.seconds[0]));
    row("2000 steps, s", 3, of(&|case| case.seconds[1]));
    let residuals = cases.iter().map(|case| format!("{:.1e}", case.run.ledger_residual));
    text += &line("ledger residual", residuals.collect());
    Ok(text)
}
