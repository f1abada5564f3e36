//! Dynamic stiffness of a rigid strip over frequency on three grounds.
//!
//! ```text
//! cargo run --release --example impedances
//! ```
//!
//! A strip 6 m wide is bonded to soil of 150 m/s in three cases: an undamped half-plane; a layer of 6 m with 5 %
//! damping on rock of 450 m/s with 1 %; and the same layer on a rigid base. Every dynamic stiffness K(ω) is split into
//! a spring Re K and a dashpot Im K/ω. The dashpots of the half-plane represent radiation damping only. The dashpots of
//! the layers contain the soil's own damping, and almost nothing else below the first frequency of the layer, 6.25 Hz.
//! A half-plane therefore overestimates the damping of such a site.

use std::error::Error;
use std::path::Path;

use basemat::bem::layered::{StripContact, StripImpedance};
use basemat::bem::{ElasticGround, Strip};
use basemat::plot::{Curve, curves};
use basemat::prelude::*;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::unobserved;

/// Half the strip's width, m.
const HALF_WIDTH: f64 = 3.0;
/// Number of graded elements, enough for errors below 1 %.
const ELEMENT_COUNT: usize = 24;
const COMPONENT_NAMES: [&str; 4] = ["hh", "vv", "rr", "hr"];

/// A ground's name and its impedances.
type Case = (&'static str, Vec<StripImpedance>);

/// Real and imaginary parts of K_hh/μ, K_vv/μ, K_rr/(μ B²) and K_hr/(μ B), as in published tables.
fn normalized(impedance: &StripImpedance, soil: Soil) -> [[f64; 2]; 4] {
    let scales =
        [1.0, 1.0, HALF_WIDTH * HALF_WIDTH, HALF_WIDTH].map(|scale| soil.shear_modulus() * scale);
    let StripImpedance { horizontal, vertical, rocking, coupling, .. } = *impedance;
    let values = [horizontal, vertical, rocking, coupling];
    std::array::from_fn(|i| [values[i].re / scales[i], values[i].im / scales[i]])
}

/// Prints a table for each case; `frequency_scale` is the frequency (Hz) of a₀ = 1.
fn print_tables(cases: &[Case], soil: Soil, frequency_scale: f64) {
    println!("K over mu (hh, vv), mu B^2 (rr), mu B (hr); a0 = omega B/c");
    for (name, impedances) in cases {
        println!(
            "\n{name}\n   f (Hz)   a0             hh              vv              rr              hr"
        );
        for impedance in impedances.iter().skip(4).step_by(5) {
            let frequency = impedance.frequency;
            print!("{frequency:>9.2} {:>4.2}", frequency / frequency_scale);
            for [re, im] in normalized(impedance, soil) {
                print!("  {re:>6.3} {im:>+6.3}i");
            }
            println!();
        }
    }
}

/// One curve over frequency for each case, in 10⁶ units.
fn case_curves(cases: &[Case], value: impl Fn(&StripImpedance) -> f64) -> Vec<Curve> {
    let mut curves = Vec::new();
    for (name, impedances) in cases {
        let points =
            impedances.iter().map(|impedance| (impedance.frequency, 1e-6 * value(impedance)));
        curves.push(Curve { name: (*name).to_owned(), points: points.collect() });
    }
    curves
}

fn draw(cases: &[Case], folder: &Path) -> basemat::Result<()> {
    for (i, (name, unit)) in
        COMPONENT_NAMES.into_iter().zip(["MN/m²", "MN/m²", "MN", "MN/m"]).enumerate()
    {
        let springs = case_curves(cases, |impedance| impedance.stiffnesses()[i]);
        curves(&format!("Spring Re K_{name}"), "frequency, Hz", unit, &springs)?
            .save(folder.join(format!("spring_{name}.svg")))?;
        let dashpots = case_curves(cases, |impedance| impedance.dashpots()[i]);
        let unit = format!("{unit} · s");
        curves(&format!("Dashpot Im K_{name}/ω"), "frequency, Hz", &unit, &dashpots)?
            .save(folder.join(format!("dashpot_{name}.svg")))?;
    }
    Ok(())
}

/// Adds the layer of 6 m with 5 % damping.
fn with_layer(profile: SoilProfile, soil: Soil) -> basemat::Result<SoilProfile> {
    Ok(profile.with_layer(soil, 2.0 * HALF_WIDTH)?.with_damping(constant_damping(0.05)?))
}

/// Damping that is constant over the band; the moduli of the soils apply at 4 Hz.
fn constant_damping(ratio: f64) -> basemat::Result<GeneralizedMaxwell> {
    GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 4.0)
}

/// Impedances of the bonded strip on a ground.
fn strip_impedances(
    soil: impl Into<SoilProfile>,
    frequencies: &[f64],
) -> basemat::Result<Vec<StripImpedance>> {
    let ground = ElasticGround::new(soil, Strip::graded(-HALF_WIDTH..HALF_WIDTH, ELEMENT_COUNT)?)?;
    ground.impedances(frequencies, StripContact::Bonded, &mut unobserved)
}

fn main() -> Result<(), Box<dyn Error>> {
    let soil = Soil::from_shear_wave_speed(150.0, 1.0 / 3.0, 1800.0)?;
    let rock = Soil::from_shear_wave_speed(450.0, 0.3, 2160.0)?;
    let half_plane_of_rock =
        SoilProfile::on_half_plane(rock).with_bedrock_damping(constant_damping(0.01)?);
    let on_rock = with_layer(half_plane_of_rock, soil)?;
    let on_rigid_bedrock = with_layer(SoilProfile::on_rigid_bedrock(), soil)?;
    println!("layer on rock:\n{on_rock}\n\nlayer on a rigid base:\n{on_rigid_bedrock}\n");

    // a₀ = ωB/c from 0.05 to 2.5.
    let frequency_scale = soil.shear_wave_speed() / (std::f64::consts::TAU * HALF_WIDTH);
    let frequencies: Vec<f64> = (1..=50).map(|i| 0.05 * f64::from(i) * frequency_scale).collect();
    let cases = [
        ("half-plane", strip_impedances(soil, &frequencies)?),
        ("layer on rock, 5 %", strip_impedances(on_rock, &frequencies)?),
        ("layer on a rigid base, 5 %", strip_impedances(on_rigid_bedrock, &frequencies)?),
    ];

    print_tables(&cases, soil, frequency_scale);
    let folder = Path::new("target/impedances");
    draw(&cases, folder)?;
    println!("\npictures in {}", folder.display());

    // Im K/μ, horizontal and vertical, at a₀ = 0.5, from tables of other programs.
    for ((name, impedances), references) in
        cases.iter().zip([[1.315, 2.019], [0.602, 0.934], [0.256, 0.490]])
    {
        let components = normalized(&impedances[9], soil);
        for ([_, computed], reference) in components.into_iter().zip(references) {
            let error = (computed / reference - 1.0).abs();
            assert!(error < 0.01, "{name}: {computed}, not {reference}");
        }
    }
    Ok(())
}
