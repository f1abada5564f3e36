//! One building on four grounds: rock, half-plane, and layers without and with damping.
//!
//! The half-plane has the properties of the surface soil.
//!
//! ```text
//! cargo run --release --example layered_site
//! ```
//!
//! The record, El Centro at 0.15 g, is the motion of the rock's outcrop. A simulation takes the motion of the
//! free surface. On rock this is the record itself; elsewhere `site::SoilColumn` computes it from the record
//! and the damped layers. The three soils have the same surface motion, so differences come only from the
//! ground under the building. Writes floor spectra to `target/layered_site.svg`.

use basemat::bem::{ElasticGround, SharedKernels};
use basemat::coupled::EnergyTerm;
use basemat::motion::SpectralOrdinate;
use basemat::prelude::*;
use basemat::results::log_spaced;
use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::ModalDamping;
use basemat::{Result, plot, unobserved};

const STEP: f64 = 5.0e-3;
const ELEMENTS: usize = 10;
const FRICTION: f64 = 0.3;

/// Six metres of soft clay and twelve of sand on rock.
///
/// Shear wave speed (m/s), ν, density (kg/m³), thickness (m), damping ratio.
const LAYERS: [(f64, f64, f64, f64, f64); 2] =
    [(150.0, 0.40, 1800.0, 6.0, 0.05), (280.0, 0.35, 1950.0, 12.0, 0.03)];
const ROCK: (f64, f64, f64, f64) = (800.0, 0.25, 2300.0, 0.01);

fn site(damped: bool) -> Result<SoilProfile> {
    // The band contains the frequencies of the record, the building and the layers.
    let law = |ratio: f64| {
        GeneralizedMaxwell::constant_q(if damped { ratio } else { 0.0 }, [0.2, 25.0], 2.0)
    };
    let rock = Soil::from_shear_wave_speed(ROCK.0, ROCK.1, ROCK.2)?;
    let mut profile = SoilProfile::on_half_plane(rock).with_bedrock_damping(law(ROCK.3)?);
    for (speed, poisson, density, thickness, ratio) in LAYERS {
        let soil = Soil::from_shear_wave_speed(speed, poisson, density)?;
        profile = profile.with_layer(soil, thickness)?.with_damping(law(ratio)?);
    }
    Ok(profile)
}

/// Runs ten seconds of a building; returns the run and the spectrum of its roof.
fn shake(
    motion: &Record,
    ground: impl FnOnce(&dyn Structure) -> Result<Box<dyn Ground>>,
) -> Result<(Run, Vec<SpectralOrdinate>)> {
    let storeys = [Storey::new(3.0, 24.0e3, 60.0e6); 5];
    let building = ShearBuilding::new(8.0, 60.0e3, 4.0e5, &storeys)?;
    let roof = building.roof();
    let damped = ModalDamping::new(&[0.05])?.on_fixed_base(building)?;
    let mut simulation = Simulation::builder(STEP)
        .ground(ground(&damped)?)
        .structure(damped)
        .interface(Coulomb::new(FRICTION)?)
        .motion(motion.clone())
        .probe(Probe::acceleration("roof", roof))
        .expected_steps(2000)
        .build()?;
    let mut time_series = Recorder::new().start(&simulation)?;
    let run = simulation.run(2000, |state| time_series.record(state))?;
    Ok((run, time_series.floor_spectrum("roof", &log_spaced(0.05, 3.0, 121)?, 0.05)?))
}

fn main() -> Result<()> {
    let (damped, elastic) = (site(true)?, site(false)?);
    println!("{damped}\n");
    let outcrop = el_centro_1940().scaled_to_peak(0.15 * STANDARD_GRAVITY)?.resampled(STEP)?;
    let column = SoilColumn::new(damped.clone(), VerticalWave::Shear)?;
    let surface =
        column.to_surface(ControlPoint::Outcrop, STEP, outcrop.accelerations(), &mut unobserved)?;
    let surface = Record::new(STEP, surface.samples)?;

    let half_plane = |speed, poisson, density| {
        move |structure: &dyn Structure| -> Result<Box<dyn Ground>> {
            let soil = Soil::from_shear_wave_speed(speed, poisson, density)?;
            Ok(Box::new(ElasticGround::under(soil, structure, ELEMENTS)?))
        }
    };
    // The convolution weights of a repeated profile are computed once.
    let kernels = SharedKernels::default();
    let layered = |profile: &SoilProfile| {
        let (profile, kernels) = (profile.clone(), kernels.clone());
        move |structure: &dyn Structure| -> Result<Box<dyn Ground>> {
            let ground = ElasticGround::under(profile, structure, ELEMENTS)?;
            Ok(Box::new(ground.with_shared_kernels(&kernels)))
        }
    };
    let (clay, names) =
        (LAYERS[0], ["rock", "clay throughout", "layers, elastic", "layers, damped"]);
    let [rock, clay, elastic, damped] = [
        shake(&outcrop, half_plane(ROCK.0, ROCK.1, ROCK.2))?,
        shake(&surface, half_plane(clay.0, clay.1, clay.2))?,
        shake(&surface, layered(&elastic))?,
        shake(&surface, layered(&damped))?,
    ];

    let mut comparison = Comparison::default();
    let mut spectra = Vec::new();
    for (name, (run, spectrum)) in names.into_iter().zip([rock, clay, elastic, damped]) {
        let peak = spectrum.iter().fold(0.0_f64, |m, o| m.max(o.pseudo_acceleration));
        let soil = 100.0 * run.energy_balance.fraction(EnergyTerm::Soil).unwrap_or(f64::NAN);
        println!(
            "{name:<16} roof's spectrum {:.1} g, {soil:.0} % of the energy to the soil",
            peak / STANDARD_GRAVITY
        );
        comparison.add(name, run);
        spectra.push((name, spectrum));
    }
    println!("\n{comparison}");
    let spectra: Vec<_> = spectra.iter().map(|(name, spectrum)| (*name, &spectrum[..])).collect();
    plot::spectra("Spectra of the roof, 5 % damping", &spectra)?.save("target/layered_site.svg")
}
