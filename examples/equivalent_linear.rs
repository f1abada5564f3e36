//! A building that may uplift on soft clay with strain-compatible soil properties.
//!
//! ```text
//! cargo run --release --example equivalent_linear
//! ```
//!
//! The record, El Centro at 0.3 g, is the motion of the rock's outcrop. Strain-compatible moduli and damping are
//! iterated with the curves of Vucetic & Dobry and of EPRI. They determine the building's ground and the motion of the
//! surface. For comparison, the same building is computed on soil with small-strain properties. The example writes wave
//! speeds, strains and spectra to `target/equivalent_linear.svg`.

use basemat::bem::ElasticGround;
use basemat::motion::SpectralOrdinate;
use basemat::prelude::*;
use basemat::results::log_spaced;
use basemat::site::{EquivalentLinear, EquivalentLinearOptions, SoilColumn, VerticalWave};
use basemat::soil::{GeneralizedMaxwell, SoilProfile, StrainCurves};
use basemat::structure::ModalDamping;
use basemat::{Result, plot, unobserved};

/// Time step, s.
const TIME_STEP: f64 = 0.01;
const STEP_COUNT: usize = 1500;

/// Clay over sand on rock, in layers of two metres, and the strain curves of each layer.
fn site() -> Result<(SoilProfile, Vec<StrainCurves>)> {
    let rock = Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)?;
    let mut profile = SoilProfile::on_half_plane(rock)
        .with_bedrock_damping(GeneralizedMaxwell::constant_q(0.01, [0.1, 30.0], 2.0)?);
    let mut curves = vec![];
    for k in 0..12 {
        let depth = 2.0 * f64::from(k) + 1.0;
        let soil = if k < 5 {
            curves.push(StrainCurves::VuceticDobry { plasticity_index: 30.0 });
            Soil::from_shear_wave_speed(140.0 + 4.0 * depth, 0.45, 1750.0)?
        } else {
            curves.push(StrainCurves::Epri { depth });
            Soil::from_shear_wave_speed(200.0 + 5.0 * depth, 0.35, 1950.0)?
        };
        profile = profile.with_layer(soil, 2.0)?;
    }
    Ok((profile, curves))
}

/// Runs fifteen seconds of a six-storey building; returns the run and the spectrum of its roof.
fn shake(site: &EquivalentLinear) -> Result<(Run, Vec<SpectralOrdinate>)> {
    let building = ShearBuilding::new(9.0, 60.0e3, 5.0e5, &[Storey::new(3.0, 25.0e3, 70.0e6); 6])?;
    let roof = building.roof();
    let damped_structure = ModalDamping::new(&[0.05])?.on_fixed_base(building)?;
    let mut simulation = Simulation::builder(TIME_STEP)
        .ground(ElasticGround::under(site.profile.clone(), &damped_structure, 8)?)
        .structure(damped_structure)
        .interface(Coulomb::new(0.5)?)
        .motion(site.surface.clone())
        .probe(Probe::acceleration("roof", roof))
        .expected_steps(STEP_COUNT)
        .build()?;
    let mut time_series = Recorder::new().start(&simulation)?;
    let run = simulation.run(STEP_COUNT, |state| time_series.record(state))?;
    Ok((run, time_series.floor_spectrum("roof", &log_spaced(0.05, 3.0, 121)?, 0.05)?))
}

fn main() -> Result<()> {
    let (profile, curves) = site()?;
    let record = el_centro_1940().scaled_to_peak(0.3 * STANDARD_GRAVITY)?.resampled(TIME_STEP)?;
    // Time for the site to come to rest after the record.
    let rock_motion = record.padded(0.0, 15.0)?;
    let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    let options = EquivalentLinearOptions::of_magnitude(6.9);
    let compatible = column.equivalent_linear(&rock_motion, &curves, &options, &mut unobserved)?;
    println!("{compatible}\n\n{}\n", compatible.profile);

    // The same site with small-strain properties.
    let mut small_strain_curves = vec![];
    for curve in &curves {
        small_strain_curves.push(StrainCurves::Linear { damping: curve.at(0.0)?[1] });
    }
    let linear =
        column.equivalent_linear(&rock_motion, &small_strain_curves, &options, &mut unobserved)?;

    let periods = log_spaced(0.05, 3.0, 121)?;
    let mut comparison = Comparison::default();
    let mut spectra =
        vec![("rock", rock_motion.response_spectrum(&periods, 0.05, &mut unobserved)?)];
    for (name, site) in [("linear", &linear), ("strain-compatible", &compatible)] {
        let (run, roof_spectrum) = shake(site)?;
        let roof_peak = roof_spectrum
            .iter()
            .fold(0.0_f64, |peak, ordinate| peak.max(ordinate.pseudo_acceleration));
        println!(
            "{name:<18} surface {:.2} g, peak of the roof's spectrum {:.1} g",
            site.peak_accelerations[0] / STANDARD_GRAVITY,
            roof_peak / STANDARD_GRAVITY
        );
        comparison.add(name, run);
        spectra.push((name, site.surface.response_spectrum(&periods, 0.05, &mut unobserved)?));
    }
    println!("\n{comparison}");
    let spectra: Vec<_> = spectra.iter().map(|(name, spectrum)| (*name, &spectrum[..])).collect();
    plot::site_response("Clay and sand under El Centro at 0.3 g", &compatible, &spectra)?
        .save("target/equivalent_linear.svg")
}
