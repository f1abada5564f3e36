//! Floor response spectra for equipment in a building whose base is bonded, or may uplift and slide.
//!
//! ```text
//! cargo run --release --example floor_spectra
//! ```
//!
//! An acceleration probe records the total acceleration of a floor. It is the ground motion of equipment on
//! that floor, so its response spectrum is the floor spectrum. Peaks are broadened by 15 % for uncertain
//! properties of soil and structure (U.S. NRC Regulatory Guide 1.122).

use basemat::prelude::*;
use basemat::results::{broadened, log_spaced};
use basemat::structure::ModalDamping;
use basemat::{Result, unobserved};

/// Damping ratio of the equipment.
const DAMPING: f64 = 0.05;

fn shake(law: impl InterfaceLaw + 'static) -> Result<TimeSeries> {
    let storeys = [Storey::new(3.0, 30.0e3, 60.0e6); 5];
    let building = ShearBuilding::new(8.0, 60.0e3, 4.0e5, &storeys)?;
    let (first, roof) = (building.floor(0)?, building.roof());
    // High modes excite the equipment, so each mode has 5 %; damping proportional to stiffness would give the
    // fifth 34 %.
    let damped = ModalDamping::new(&[0.05])?.on_fixed_base(building)?;
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(5.0e-3)
        .ground(ElasticGround::under(soil, &damped, 12)?)
        .structure(damped)
        .interface(law)
        .motion(el_centro_1940())
        .probe(Probe::acceleration("first floor", first))
        .probe(Probe::acceleration("roof", roof))
        .build()?;
    let steps = simulation.steps_for(20.0);
    let mut time_series = Recorder::new().start(&simulation)?;
    simulation.run(steps, |state| time_series.record(state))?;
    Ok(time_series)
}

fn main() -> Result<()> {
    // Periods are fine enough for the peaks; every fourth one is printed, and the period of the roof's peak.
    let periods = log_spaced(0.05, 2.0, 61)?;
    let (held, free) = (shake(Bonded)?, shake(Coulomb::new(0.25)?)?);

    let ground = el_centro_1940().response_spectrum(&periods, DAMPING, &mut unobserved)?;
    let spectra = [
        ("free field", ground),
        ("1st, bonded", held.floor_spectrum("first floor", &periods, DAMPING)?),
        ("1st, contact", free.floor_spectrum("first floor", &periods, DAMPING)?),
        ("roof, bonded", held.floor_spectrum("roof", &periods, DAMPING)?),
        ("roof, contact", free.floor_spectrum("roof", &periods, DAMPING)?),
        ("roof, ±15 %", broadened(&free.floor_spectrum("roof", &periods, DAMPING)?, 0.15)?),
    ];
    println!("Pseudo-acceleration in g, damping {:.0} %, El Centro 1940\n", 100.0 * DAMPING);
    print!("{:>8}", "T, s");
    for (name, _) in &spectra {
        print!("{name:>15}");
    }
    println!();
    let roof = |k: usize| spectra[4].1[k].pseudo_acceleration;
    let peak = (0..periods.len()).max_by(|&a, &b| roof(a).total_cmp(&roof(b)));
    for k in (0..periods.len()).filter(|&k| k % 4 == 0 || Some(k) == peak) {
        print!("{:>8.3}", periods[k]);
        for (_, spectrum) in &spectra {
            print!("{:>15.3}", spectrum[k].pseudo_acceleration / STANDARD_GRAVITY);
        }
        println!();
    }
    Ok(())
}
