//! Floor response spectra for equipment in a building.
//!
//! ```text
//! cargo run --release --example floor_spectra
//! ```
//!
//! The building's base is bonded, or may uplift and slide. An acceleration probe records the total acceleration of a
//! floor. It is the ground motion of equipment on that floor, so its response spectrum is the floor spectrum. Peaks are
//! broadened by 15 % for uncertain properties of soil and structure (U.S. NRC Regulatory Guide 1.122).

use basemat::prelude::*;
use basemat::results::{broadened, log_spaced};
use basemat::structure::ModalDamping;
use basemat::{Result, unobserved};

/// Damping ratio of the equipment.
const EQUIPMENT_DAMPING: f64 = 0.05;

/// Runs 20 s of a five-storey building; returns the time series of the probes on its first floor and roof.
fn shake(law: impl InterfaceLaw + 'static) -> Result<TimeSeries> {
    let storeys = [Storey::new(3.0, 30.0e3, 60.0e6); 5];
    let building = ShearBuilding::new(8.0, 60.0e3, 4.0e5, &storeys)?;
    let first_floor = building.floor(0)?;
    let roof = building.roof();
    // High modes excite the equipment, so each mode has 5 % of critical damping. Damping proportional to the stiffness
    // would give 34 % to the fifth mode.
    let damped_structure = ModalDamping::new(&[0.05])?.on_fixed_base(building)?;
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(5.0e-3)
        .ground(ElasticGround::under(soil, &damped_structure, 12)?)
        .structure(damped_structure)
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
    // 61 periods resolve the peaks. The table has every fourth period, and the period of the roof's peak.
    let periods = log_spaced(0.05, 2.0, 61)?;
    let bonded_series = shake(Bonded)?;
    let contact_series = shake(Coulomb::new(0.25)?)?;

    let ground_spectrum =
        el_centro_1940().response_spectrum(&periods, EQUIPMENT_DAMPING, &mut unobserved)?;
    let spectra = [
        ("free field", ground_spectrum),
        ("1st, bonded", bonded_series.floor_spectrum("first floor", &periods, EQUIPMENT_DAMPING)?),
        (
            "1st, contact",
            contact_series.floor_spectrum("first floor", &periods, EQUIPMENT_DAMPING)?,
        ),
        ("roof, bonded", bonded_series.floor_spectrum("roof", &periods, EQUIPMENT_DAMPING)?),
        ("roof, contact", contact_series.floor_spectrum("roof", &periods, EQUIPMENT_DAMPING)?),
        (
            "roof, ±15 %",
            broadened(&contact_series.floor_spectrum("roof", &periods, EQUIPMENT_DAMPING)?, 0.15)?,
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
    let peak_index =
        roof_contact.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(k, _)| k);
    for k in (0..periods.len()).filter(|&k| k % 4 == 0 || Some(k) == peak_index) {
        print!("{:>8.3}", periods[k]);
        for (_, spectrum) in &spectra {
            print!("{:>15.3}", spectrum[k].pseudo_acceleration / STANDARD_GRAVITY);
        }
        println!();
    }
    Ok(())
}
