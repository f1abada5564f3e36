//! Floor response spectra: what equipment on the roof of a building feels, with a base that is
//! held and with one that may uplift and slide.
//!
//! ```text
//! cargo run --release --example floor_spectra
//! cargo run --release --example floor_spectra -- --damping 0.02
//! ```
//!
//! A floor's total acceleration, read by an acceleration probe, is a ground motion for what stands
//! on it. Its response spectrum is the floor spectrum; peaks are broadened by 15 % for what is not
//! known of soil and structure (U.S. NRC Regulatory Guide 1.122).

use basemat::bem::HalfPlaneGround;
use basemat::coupled::Probe;
use basemat::interface::{Bonded, Coulomb, InterfaceLaw};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::results::{Histories, Recorder, broadened, log_spaced};
use basemat::structure::{ShearBuilding, Storey};
use basemat::{Result, Simulation, Soil};
use clap::Parser;

/// Floor spectra of a shear building.
#[derive(Parser)]
struct Options {
    /// Damping ratio of the equipment.
    #[arg(long, default_value_t = 0.05)]
    damping: f64,
}

fn shake(law: impl InterfaceLaw + 'static) -> Result<Histories> {
    let storeys = [Storey::new(3.0, 30.0e3, 60.0e6); 5];
    let building =
        ShearBuilding::new(8.0, 60.0e3, 4.0e5, &storeys)?.with_stiffness_damping(0.05)?;
    let (first, roof) = (building.floor(0)?, building.floor(4)?);
    let soil = Soil::new(1900.0 * 250.0_f64.powi(2), 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(5.0e-3)
        .structure(building)
        .ground(HalfPlaneGround::strip(soil, -4.0..4.0, 12)?)
        .interface(law)
        .motion(el_centro_1940())
        .probe(Probe::acceleration("first floor", vec![(first, 1.0)]))
        .probe(Probe::acceleration("roof", vec![(roof, 1.0)]))
        .build()?;
    let mut histories = Recorder::new().start(&simulation)?;
    histories.run(&mut simulation, 4000)?;
    Ok(histories)
}

fn main() -> Result<()> {
    let Options { damping } = Options::parse();
    // Fine enough for the peaks; every fourth line is printed.
    let periods = log_spaced(0.05, 2.0, 61)?;
    let (held, free) = (shake(Bonded)?, shake(Coulomb::new(0.25)?)?);

    let ground = el_centro_1940().response_spectrum(&periods, damping)?;
    let spectra = [
        ("free field", ground),
        ("1st, bonded", held.floor_spectrum("first floor", &periods, damping)?),
        ("1st, contact", free.floor_spectrum("first floor", &periods, damping)?),
        ("roof, bonded", held.floor_spectrum("roof", &periods, damping)?),
        ("roof, contact", free.floor_spectrum("roof", &periods, damping)?),
        ("broadened", broadened(&free.floor_spectrum("roof", &periods, damping)?, 0.15)?),
    ];
    println!("Pseudo-acceleration in g, damping {:.0} %, El Centro 1940\n", 100.0 * damping);
    print!("{:>8}", "T, s");
    for (name, _) in &spectra {
        print!("{name:>15}");
    }
    println!();
    for k in (0..periods.len()).step_by(4) {
        print!("{:>8.3}", periods[k]);
        for (_, spectrum) in &spectra {
            print!("{:>15.3}", spectrum[k].pseudo_acceleration / STANDARD_GRAVITY);
        }
        println!();
    }
    Ok(())
}
