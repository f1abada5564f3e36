//! Floor response spectra for equipment in a building.
//!
//! ```text
//! cargo run --release --example floor_spectra
//! ```
//!
//! The building's base is bonded, or may uplift and slide. An acceleration probe records the total acceleration of a floor. It is the ground motion of equipment on
//! that floor, so its response spectrum is the floor spectrum. Peaks are broadened by 15 % for uncertain
//! properties of soil and structure (U.S. NRC Regulatory Guide 1.122).

use basemat::prelude::*;
use basemat::results::{broadened, log_spaced};
use basemat::structure::ModalDamping;
use basemat::{Result, unobserved};

/// Damping ratio of the equipment.
const EQUIPMENT_DAMPING: f64 = 0.05;

fn shake(law: impl InterfaceLaw + 'static) -> Result<TimeSeries> {
    let storeys = [Storey::new(3.0, 30.0e3, 60.0e6); 5];
    let building = ShearBuilding::new(8.0, 60.0e3, 4.0e5, &storeys)?;
    let first_floor = building.floor(0)?;
    let roof = building.roof();
    // High modes excite the equipment, so each mode has 5 %; damping proportional to stiffness would give the
    // fifth 34 %.
    let damped = ModalDamping::new(&[0.05])?.on_fixed_base(building)?;
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(5.0e-3)
        .ground(ElasticGround::under(soil, &damped, 12)?)
        .structure(damped)
        .interface(law)
        .motion(el_centro_1940())
        .probe(Probe::acceleration("first floor", first_floor))
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
    let bonded = shake(Bonded)?;
    let free = shake(Coulomb::new(0.25)?)?;

    let ground =
        el_centro_1940().response_spectrum(&periods, EQUIPMENT_DAMPING, &mut unobserved)?;
    let spectra = [
        ("free field", ground),
        ("1st, bonded", bonded.floor_spectrum("first floor", &periods, EQUIPMENT_DAMPING)?),
        ("1st, contact", free.floor_spectrum("first floor", &periods, EQUIPMENT_DAMPING)?),
        ("roof, bonded", bonded.floor_spectrum("roof", &periods, EQUIPMENT_DAMPING)?),
        ("roof, contact", free.floor_spectrum("roof", &periods, EQUIPMENT_DAMPING)?),
        (
            "roof, ±15 %",
            broadened(&free.floor_spectrum("roof", &periods, EQUIPMENT_DAMPING)?, 0.15)?,
        ),
    ];
    println!(
        "Pseudo-acceleration in g, damping {:.0} %, El Centro 1940\n",
        100.0 * EQUIPMENT_DAMPING
    );
    print!("{:>8}", "T, s");
    for (name, _) in &spectra {
        print!("{name:>15}");
    }
    println!();
    let roof_contact = spectra[4].1.iter().map(|ordinate| ordinate.pseudo_acceleration);
    let peak = roof_contact.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(k, _)| k);
    for k in (0..periods.len()).filter(|&k| k % 4 == 0 || Some(k) == peak) {
        print!("{:>8.3}", periods[k]);
        for (_, spectrum) in &spectra {
            print!("{:>15.3}", spectrum[k].pseudo_acceleration / STANDARD_GRAVITY);
        }
        println!();
    }
    Ok(())
}
