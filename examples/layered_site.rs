//! One building on four grounds: rock, half-plane, layers without and with damping.
//!
//! ```text
//! cargo run --release --example layered_site
//! ```
//!
//! The record, El Centro at 0.15 g, is the motion of the rock's outcrop. The input of a simulation is the motion of the
//! free surface. On rock this is the record itself; on the three soils `site::SoilColumn` computes it from the record
//! and the damped layers. The three soils have the same surface motion, so the results differ only because of the
//! ground under the building. The half-plane has the properties of the surface soil. The example writes floor spectra
//! to `target/layered_site.svg`.

use basemat::bem::ElasticGround;
use basemat::coupled::EnergyTerm;
use basemat::motion::SpectralOrdinate;
use basemat::prelude::*;
use basemat::results::log_spaced;
use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::ModalDamping;
use basemat::{Result, plot, unobserved};

/// Time step, s.
const TIME_STEP: f64 = 5.0e-3;
const STEP_COUNT: usize = 2000;
/// Number of contact elements.
const ELEMENT_COUNT: usize = 10;
const FRICTION_COEFFICIENT: f64 = 0.3;

/// Six metres of clay and twelve metres of sand on rock; damping ratios are multiplied by `damping_factor`.
fn site(damping_factor: f64) -> Result<SoilProfile> {
    let rock_damping = band_damping(0.01 * damping_factor)?;
    let profile = SoilProfile::on_half_plane(rock()?).with_bedrock_damping(rock_damping);
    let sand = Soil::from_shear_wave_speed(280.0, 0.35, 1950.0)?;
    let with_clay =
        profile.with_layer(clay()?, 6.0)?.with_damping(band_damping(0.05 * damping_factor)?);
    Ok(with_clay.with_layer(sand, 12.0)?.with_damping(band_damping(0.03 * damping_factor)?))
}

fn rock() -> Result<Soil> {
    Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)
}

fn clay() -> Result<Soil> {
    Soil::from_shear_wave_speed(150.0, 0.40, 1800.0)
}

/// Damping that is constant over the frequencies of record, building and layers.
fn band_damping(ratio: f64) -> Result<GeneralizedMaxwell> {
    GeneralizedMaxwell::constant_q(ratio, [0.2, 25.0], 2.0)
}

fn building() -> Result<ShearBuilding> {
    ShearBuilding::new(8.0, 60.0e3, 4.0e5, &[Storey::new(3.0, 24.0e3, 60.0e6); 5])
}

/// The ground under the building, for one of the sites.
fn ground(site: impl Into<SoilProfile>) -> Result<ElasticGround> {
    ElasticGround::under(site, &building()?, ELEMENT_COUNT)
}

/// Runs ten seconds of the building; returns the run and the spectrum of its roof.
fn shake(motion: &Record, ground: ElasticGround) -> Result<(Run, Vec<SpectralOrdinate>)> {
    let building = building()?;
    let roof = building.roof();
    let mut simulation = Simulation::builder(TIME_STEP)
        .ground(ground)
        .structure(ModalDamping::new(&[0.05])?.on_fixed_base(building)?)
        .interface(Coulomb::new(FRICTION_COEFFICIENT)?)
        .motion(motion.clone())
        .probe(Probe::acceleration("roof", roof))
        .expected_steps(STEP_COUNT)
        .build()?;
    let mut time_series = Recorder::new().start(&simulation)?;
    let run = simulation.run(STEP_COUNT, |state| time_series.record(state))?;
    Ok((run, time_series.floor_spectrum("roof", &log_spaced(0.05, 3.0, 121)?, 0.05)?))
}

fn main() -> Result<()> {
    let damped_site = site(1.0)?;
    println!("{damped_site}\n");
    let outcrop = el_centro_1940().scaled_to_peak(0.15 * STANDARD_GRAVITY)?.resampled(TIME_STEP)?;
    let column = SoilColumn::new(damped_site.clone(), VerticalWave::Shear)?;
    let surface = column.to_surface(
        ControlPoint::Outcrop,
        TIME_STEP,
        outcrop.accelerations(),
        &mut unobserved,
    )?;
    let surface = Record::new(TIME_STEP, surface.samples)?;

    let mut comparison = Comparison::default();
    let mut spectra = Vec::new();
    for (name, motion, ground) in [
        ("rock", &outcrop, ground(rock()?)?),
        ("clay throughout", &surface, ground(clay()?)?),
        ("layers, elastic", &surface, ground(site(0.0)?)?),
        ("layers, damped", &surface, ground(damped_site)?),
    ] {
        let (run, spectrum) = shake(motion, ground)?;
        let roof_peak = spectrum
            .iter()
            .fold(0.0_f64, |roof_peak, ordinate| roof_peak.max(ordinate.pseudo_acceleration));
        let soil_percent =
            100.0 * run.energy_balance.fraction(EnergyTerm::Soil).unwrap_or(f64::NAN);
        println!(
            "{name:<16} roof's spectrum {:.1} g, {soil_percent:.0} % of the energy to the soil",
            roof_peak / STANDARD_GRAVITY
        );
        comparison.add(name, run);
        spectra.push((name, spectrum));
    }
    println!("\n{comparison}");
    let spectra: Vec<_> = spectra.iter().map(|(name, spectrum)| (*name, &spectrum[..])).collect();
    plot::spectra("Spectra of the roof, 5 % damping", &spectra)?.save("target/layered_site.svg")
}
